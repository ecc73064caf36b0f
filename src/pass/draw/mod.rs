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
mod torus;
mod wander;
mod waves;
mod weave;

#[cfg(test)]
mod tests;

pub use assemble::{Assembly, Item, Setting, items};
pub use nawaami::tangents;

use crate::diag::Diagnostic;
use crate::drawing::Layer;
use crate::pass::cut::visible;
use crate::scene::{Canvas, Ground, Limits, Paint};
use crate::stage::{Angles, Graph, Sites, Tiles};

use budget::{Budget, Exceeded};
use edge::Bank;
use ground::Around;
use job::Job;
use nearby::Nearby;
use palette::Palette;
use torus::Unrolled;

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
    let unrolled = stages.sites.torus.as_ref().and_then(|_| Unrolled::new(stages, torus::reach(paint, stages)));
    let &Stages { sites, graph, angles, tiles } = &unrolled.as_ref().map_or(*stages, Unrolled::stages);
    let (bank, nearby) = (Bank::new(&visible), Nearby::new(sites, tiles));
    let (palette, budget) = (Palette::new(paint, setting.ink), Budget::new(limits));
    let is_continued = paint.tone.ground == Some(Ground::Nearest);
    let delaunay = if is_continued { ground::delaunay(paint, sites) } else { None };
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
    layers(&job, canvas, setting).map_err(|exceeded| match exceeded {
        Exceeded::Overlap { .. } => exceeded.diagnostic(limits, paint.tone.place_span).note(paint.span, "painted here"),
        _ => exceeded.diagnostic(limits, paint.span),
    })
}

/// The ground and then the tiles.
fn layers(job: &Job<'_>, canvas: &Canvas, setting: &Setting) -> Result<Vec<Layer>, Exceeded> {
    forecast::check(job)?;
    let ground = ground::draw(job, canvas)?;
    let tiles = job.in_chunks(|scratch, tile, out| job.draw_tile(scratch, tile, out))?;
    let layers = |chunks| job.palette.layers(&job.paint.name, &setting.groups, chunks);
    let Some(period) = canvas.period() else { return Ok(layers(ground.into_iter().chain(tiles).collect())) };
    // A ground of its own is drawn beyond the borders already; what belongs to tiles is drawn once.
    let (mut done, once) = match &job.paint.tone.ground {
        Some(Ground::Fill { .. }) => (layers(ground), tiles),
        Some(Ground::Nearest) | None => (Vec::new(), ground.into_iter().chain(tiles).collect()),
    };
    for layer in layers(once) {
        done.push(torus::wrap(layer, period, job.budget.limit() as u64)?);
    }
    done.retain(|layer| layer.marks() > 0);
    Ok(done)
}
