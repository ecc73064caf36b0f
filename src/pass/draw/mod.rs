//! Draw: tiles in, marks out, cut to what is seen of them.
//!
//! A paint becomes one layer of the drawing for each ink it uses. Every stroke ends where its tile, a later tile that
//! hides it or the region ends; nothing is left to the back ends. Tiles are drawn in parallel and put together in the
//! order of their sites, so that the drawing does not depend on threads. [`Assembly`] lays paints and outlines over each
//! other.

mod arcs;
mod assemble;
mod budget;
mod crosses;
mod curves;
mod cutout;
mod dashes;
mod dots;
mod edge;
mod forecast;
mod ground;
mod hand;
pub(in crate::pass) mod job;
mod knockout;
pub(in crate::pass) mod lattice;
mod lines;
mod motif;
mod nawaami;
mod nearby;
mod palette;
mod run;
mod scribble;
pub(in crate::pass) mod silhouette;
mod solid;
mod stroke;
mod taper;
mod wander;
mod waves;

#[cfg(test)]
mod tests;

pub use assemble::{Assembly, Item, Setting, items};
pub use nawaami::tangents;

use crate::diag::Diagnostic;
use crate::drawing::Layer;
use crate::pass::cut::visible;
use crate::pass::link;
use crate::scene::{Canvas, Ground, Limits, Link, Paint};
use crate::stage::{Angles, Graph, Sites, Tiles};

use budget::{Budget, Exceeded};
use edge::Bank;
use ground::Around;
use job::Job;
use nearby::Nearby;
use palette::{Batch, Palette};

/// What the earlier passes found for one paint.
#[derive(Debug, Clone, Copy)]
pub struct Stages<'a> {
    /// Where its tiles lie.
    pub sites: &'a Sites,
    /// Which are neighbours.
    pub graph: &'a Graph,
    /// How they are turned.
    pub angles: &'a Angles,
    /// The tiles themselves.
    pub tiles: &'a Tiles,
}

/// Draws a paint: one layer for each ink, from the bottom up; none where nothing is seen.
///
/// # Errors
/// If it has more marks than the limit allows.
pub fn draw(
    paint: &Paint,
    canvas: &Canvas,
    setting: &Setting,
    stages: &Stages<'_>,
    limits: &Limits,
) -> Result<Vec<Layer>, Diagnostic> {
    let visible = visible(paint, canvas);
    let &Stages { sites, graph, angles, tiles } = stages;
    let (bank, nearby) = (Bank::new(&visible), Nearby::new(sites, tiles));
    let (palette, budget) = (Palette::new(paint, setting.ink), Budget::new(limits));
    let is_continued = paint.tone.ground == Some(Ground::Nearest);
    // Cells that share edges are not all the neighbours that bound a Voronoi cell.
    let delaunay = match paint.tone.link {
        Link::Delaunay => None,
        Link::Edges => is_continued.then(|| link::link(sites, Link::Delaunay)),
    };
    let around = is_continued.then(|| Around::new(paint, sites, delaunay.as_ref().unwrap_or(graph)));
    let job = Job {
        paint,
        sites,
        angles,
        tiles,
        bank: &bank,
        nearby: &nearby,
        palette: &palette,
        budget: &budget,
        around: around.as_ref(),
    };
    let chunks = chunks(&job, canvas).map_err(|exceeded| match exceeded {
        Exceeded::Overlap { .. } => exceeded.diagnostic(limits, paint.tone.place_span).note(paint.span, "painted here"),
        _ => exceeded.diagnostic(limits, paint.span),
    })?;
    Ok(palette.layers(&paint.name, &setting.groups, chunks))
}

/// The ground and then the tiles.
fn chunks(job: &Job<'_>, canvas: &Canvas) -> Result<Vec<Vec<Batch>>, Exceeded> {
    forecast::check(job)?;
    let mut chunks = ground::draw(job, canvas)?;
    chunks.extend(job.in_chunks(|scratch, tile, out| job.draw_tile(scratch, tile, out))?);
    Ok(chunks)
}
