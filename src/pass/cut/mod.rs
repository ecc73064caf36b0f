//! Cut: sites, links and angles in, tiles out.
//!
//! Every tile gets its outline, its number of layers and its standing towards the painted region. Tiles are worked out
//! in parallel and do not depend on each other but for dithering, which passes its errors on in the order of sites.

mod darkness;
mod foreseen;
mod layers;
mod stamp;
mod standing;
mod unsteady;
pub(crate) mod voronoi;

use std::borrow::Cow;

use rayon::prelude::*;

use crate::diag::{Code, Diagnostic};
use crate::geom::{Figure, Length, Period, Pieces, Point, Rect, Vec2, ring_area};
use crate::pass::link;
use crate::region::{FillRule, Region};
use crate::scene::{Asked, Blend, Canvas, Edge, Paint, Range, Shape};
use crate::stage::{Angles, Graph, Layers, Sites, Standing, Tiles, Tiling};
use darkness::Bed;
pub(in crate::pass) use foreseen::foreseen;
use stamp::Stamp;
use standing::Ground;

/// Tiles that one thread works out at a time.
const CHUNK: usize = 1024;

/// Values of k that leave 0 to 4 by less are rounding, not a mistake.
const ROUNDING: f64 = 1e-9;

/// Cells are convex.
static NO_PIECES: Pieces = Pieces::NONE;

/// The tiles of some neighbouring sites.
#[derive(Default)]
struct Chunk {
    corners: Vec<Point>,
    lengths: Vec<usize>,
    standing: Vec<Standing>,
    inside: Vec<bool>,
    /// What is asked for, as it is: the field's value at the site, or where it is a darkness, its mean over the tile.
    asked: Vec<f64>,
    /// The layers that occur somewhere in the tile; only where layers end along the field.
    most: Vec<u8>,
}

impl Chunk {
    /// The outline of every tile.
    fn rings(&self) -> impl Iterator<Item = &[Point]> {
        let mut start = 0;
        self.lengths.iter().map(move |&length| {
            start += length;
            &self.corners[start - length..start]
        })
    }
}

/// Cuts the tiles of a paint. Sites, links and angles belong to the same paint. One warning is added where k
/// had to be clamped on tiles that are drawn, one where no tile lies on the region, and one for each thing that the hand
/// does too much of.
pub fn cut(
    paint: &Paint,
    canvas: &Canvas,
    sites: &Sites,
    graph: &Graph,
    angles: &Angles,
    warnings: &mut Vec<Diagnostic>,
) -> Tiles {
    let visible = visible(paint, canvas);
    let ground = Ground::new(&visible, paint);
    let links = match paint.tone.shape {
        Shape::Voronoi { .. } => link::delaunay_links(sites, graph, paint.tone.link),
        Shape::Rect { .. }
        | Shape::Hexagon { .. }
        | Shape::Triangle { .. }
        | Shape::Trapezoid { .. }
        | Shape::Stamp { .. }
        | Shape::Cell { .. } => Cow::Borrowed(graph),
    };
    let shaper = Shaper::new(paint, sites, &links, angles);
    let chunks: Vec<Chunk> = (0..sites.points.len().div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(sites.points.len());
            cut_chunk(paint, sites, &ground, &shaper, range)
        })
        .collect();
    let field: Vec<f64> = chunks.iter().flat_map(|chunk| &chunk.asked).copied().collect();
    let standing: Vec<Standing> = chunks.iter().flat_map(|chunk| &chunk.standing).copied().collect();
    let inside: Vec<bool> = chunks.iter().flat_map(|chunk| &chunk.inside).copied().collect();
    // What is fitted into a range has no other one to leave.
    let greatest = match &paint.tone.asked {
        Asked::K(_) => Some(layers::MOST),
        Asked::Darkness(darkness) => match darkness.range {
            Range::Clip => Some(1.0),
            Range::Fit => None,
        },
    };
    let within = |value: f64| greatest.map_or(value, |greatest| clamp(value, greatest));
    let asked: Vec<f64> = field.iter().map(|&value| within(value)).collect();
    warnings.extend(greatest.and_then(|greatest| clamped(paint, &field, &standing, greatest)));
    let rings = chunks.iter().flat_map(Chunk::rings);
    let blank = vec![Layers::new(0, 0.0); asked.len()];
    let tiles = Tiles::new(rings, asked, blank, standing, inside).in_pieces(shaper.pieces());
    let asked = &tiles.k;
    let (k, layers) = match &paint.tone.asked {
        Asked::K(_) => {
            let layers: Vec<Layers> = match paint.tone.blend {
                Blend::Step => asked.iter().map(|&k| layers::step(k)).collect(),
                Blend::Partial => asked.iter().map(|&k| layers::partial(k)).collect(),
                Blend::Dither => layers::dither(asked, graph),
                Blend::Contour => {
                    chunks.iter().flat_map(|chunk| &chunk.most).map(|&full| Layers::new(full, 0.0)).collect()
                }
            };
            (asked.clone(), layers)
        }
        Asked::Darkness(darkness) => {
            let bed = Bed { paint, canvas, sites, graph, angles, tiles: &tiles };
            let (layers, warning) = darkness::layers(&bed, darkness);
            warnings.extend(warning);
            (layers.iter().map(|layers| f64::from(layers.full) - 1.0 + layers.last + layers.part).collect(), layers)
        }
    };
    warnings.extend(unsteady::warnings(paint, sites));
    // A region off the canvas was warned of where it was found.
    if !visible.is_empty() && tiles.standing.iter().all(|&standing| standing == Standing::Absent) {
        let message = format!("`{}` has no tile on its region", paint.name);
        warnings.push(Diagnostic::warning(Code::NoTiles, paint.span, message));
    }
    tiles.with_layers(k, layers)
}

/// The share of the paper that the tiles of a paint cover with ink, reckoned from their layers: the mean over the tiles
/// whose sites lie in its region; 0 where there are none. Sites, links, angles and tiles belong to the paint.
#[must_use]
pub fn reckon(paint: &Paint, canvas: &Canvas, sites: &Sites, graph: &Graph, angles: &Angles, tiles: &Tiles) -> f64 {
    darkness::reckon(&Bed { paint, canvas, sites, graph, angles, tiles })
}

/// The share of the paper that layers of a paint ink, in [0, 1]: what they cover of a large area, as wide as pens are. Ink
/// that spreads, later tiles that hide it and lines that a tile's edge cuts off do not count. `outlines` are those of the
/// tiles.
#[must_use]
pub fn inked(paint: &Paint, layers: &[Layers], outlines: &[Vec<Point>]) -> Vec<f64> {
    let area: f64 = outlines.iter().map(|outline| ring_area(outline).abs()).sum();
    let radius = (area / outlines.len().max(1) as f64 / std::f64::consts::PI).sqrt();
    // Where there is no tile there is nothing to reckon.
    darkness::shares(paint, layers, Length::mm(if radius > 0.0 { radius } else { 1.0 }))
}

/// The part of a paint's region that lies on the canvas: what is off the canvas is neither drawn nor measured. Where the
/// canvas repeats, the region goes on a whole period beyond it on every side, which no tile of a site on it leaves.
pub(crate) fn visible(paint: &Paint, canvas: &Canvas) -> Region {
    if let Some(period) = canvas.period() {
        return repeated(&paint.region, period);
    }
    let (page, bounds) = (canvas.bounds(), paint.region.bounds());
    let is_on_canvas = page.min.x <= bounds.min.x
        && page.min.y <= bounds.min.y
        && bounds.max.x <= page.max.x
        && bounds.max.y <= page.max.y;
    if is_on_canvas { paint.region.clone() } else { paint.region.intersection(&Region::rect(page)) }
}

/// A region that lies in the first period with its images in all periods next to it.
fn repeated(region: &Region, period: Period) -> Region {
    let page = period.area();
    let size = page.max - page.min;
    if Region::rect(page).difference(region).is_empty() {
        return Region::rect(Rect::new(page.min - size, page.max + size));
    }
    let rings = || region.polygons().iter().flat_map(|polygon| polygon.rings());
    let ways = [-1.0, 0.0, 1.0].map(|row| [-1.0, 0.0, 1.0].map(|column| Vec2::new(column * size.x, row * size.y)));
    let moved =
        ways.as_flattened().iter().flat_map(|&way| rings().map(move |ring| ring.iter().map(|&p| p + way).collect()));
    Region::from_rings(moved.collect(), FillRule::NonZero)
}

fn cut_chunk(
    paint: &Paint,
    sites: &Sites,
    ground: &Ground<'_>,
    shaper: &Shaper<'_>,
    range: std::ops::Range<usize>,
) -> Chunk {
    let mut chunk = Chunk::default();
    let (mut ring, mut spare) = (Vec::new(), Vec::new());
    let pieces = shaper.pieces();
    let mut corners = Vec::new();
    for i in range {
        let site = sites.points[i];
        shaper.outline(i, &mut ring, &mut spare);
        corners.clear();
        corners.extend(pieces.corners(&ring));
        let figure = Figure::new(&ring, pieces, &corners);
        let inside = ground.contains(site);
        chunk.inside.push(inside);
        chunk.standing.push(match paint.tone.edge {
            Edge::Clip => ground.clip(figure),
            Edge::Whole => ground.whole(figure),
            Edge::Centre if inside && !ring.is_empty() => Standing::Whole,
            Edge::Centre => Standing::Absent,
        });
        chunk.asked.push(match &paint.tone.asked {
            Asked::K(field) => field.at(site),
            Asked::Darkness(darkness) => darkness::mean(&darkness.field, site, &ring),
        });
        if paint.tone.blend == Blend::Contour {
            chunk.most.push(layers::most(paint.tone.asked.field(), site, &ring));
        }
        chunk.corners.extend_from_slice(&ring);
        chunk.lengths.push(ring.len());
    }
    chunk
}

/// A value brought into 0..=greatest; what is no number counts as nothing.
fn clamp(value: f64, greatest: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value.clamp(0.0, greatest) }
}

/// The warning that some values were clamped, if any were on tiles that are drawn.
fn clamped(paint: &Paint, field: &[f64], standing: &[Standing], greatest: f64) -> Option<Diagnostic> {
    let excess = |k: f64| if k.is_nan() { f64::INFINITY } else { (-k).max(k - greatest) };
    let drawn = || field.iter().zip(standing).filter(|(_, standing)| **standing != Standing::Absent).map(|(&k, _)| k);
    let count = drawn().filter(|&k| excess(k) > ROUNDING).count();
    // The first of those that go farthest.
    let mut extreme = None;
    for k in drawn() {
        if excess(k) > extreme.map_or(ROUNDING, excess) {
            extreme = Some(k);
        }
    }
    let extreme = extreme?;
    let name = match paint.tone.asked {
        Asked::K(_) => "k",
        Asked::Darkness(_) => "darkness",
    };
    let tiles = if count == 1 { "1 tile".to_owned() } else { format!("{count} tiles") };
    Some(
        Diagnostic::warning(
            Code::Clamped,
            paint.tone.asked_span,
            format!("`{name}` leaves the range from 0 to {greatest} on {tiles} of `{}`", paint.name),
        )
        .label(format!("reaches {}", (extreme * 1e3).round() / 1e3))
        .hint(format!("the values were clamped; `clamp(…, 0, {greatest})` says so in the scene"))
        .note(paint.span, "painted here"),
    )
}

/// Makes the outlines of one paint's tiles.
enum Shaper<'a> {
    Stamp { stamp: Stamp, sites: &'a Sites, angles: &'a Angles },
    Cells(voronoi::Cells<'a>),
    Tiling { tiling: Option<&'a Tiling>, inset: Length },
}

impl<'a> Shaper<'a> {
    fn new(paint: &Paint, sites: &'a Sites, graph: &'a Graph, angles: &'a Angles) -> Self {
        match &paint.tone.shape {
            shape @ (Shape::Rect { .. }
            | Shape::Hexagon { .. }
            | Shape::Triangle { .. }
            | Shape::Trapezoid { .. }
            | Shape::Stamp { .. }) => {
                Self::Stamp { stamp: Stamp::new(shape, &paint.tone.place, sites.spacing), sites, angles }
            }
            &Shape::Voronoi { inset, round } => Self::Cells(voronoi::Cells::new(sites, graph, inset, round)),
            // Lowering lets only tilings come here, and placement makes their cells for this shape.
            &Shape::Cell { inset } => Self::Tiling { tiling: sites.tiling.as_ref(), inset },
        }
    }

    /// How outlines fall into convex pieces.
    fn pieces(&self) -> &Pieces {
        match self {
            Self::Stamp { stamp, .. } => stamp.pieces(),
            Self::Cells(_) | Self::Tiling { .. } => &NO_PIECES,
        }
    }

    /// Writes the outline of a tile.
    fn outline(&self, tile: usize, ring: &mut Vec<Point>, spare: &mut Vec<Point>) {
        match self {
            Self::Stamp { stamp, sites, angles } => stamp.outline(sites.points[tile], angles.0[tile], ring),
            Self::Cells(cells) => cells.outline(tile, ring, spare),
            Self::Tiling { tiling, inset } => {
                ring.clear();
                ring.extend_from_slice(tiling.map_or(&[], |tiling| tiling.cell(tile)));
                if *inset > Length::ZERO {
                    voronoi::shrink(ring, inset.to_mm(), spare);
                }
            }
        }
    }
}
