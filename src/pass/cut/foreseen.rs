//! What can be said of a tile's layers before it is turned.
//!
//! Layers follow from k and the tile's place, and so are known before angles are. Only two things are not: how far layers
//! that end along the field reach into a tile, and the layers that a darkness asks for, which depend on how the turned tile
//! is cut. For the first a square round the site stands for the tile; for the second layers are counted until they cover
//! as much as the field asks for at the site, each by the share that its marks have of the ground. Angles that are chosen
//! by this see a tile near such a border with a layer more or less than is drawn.

use std::f64::consts::PI;

use crate::field::Field;
use crate::geom::{Point, Vec2};
use crate::region::Region;
use crate::scene::{Asked, Blend, Darkness, Fill, FillKind, Paint, Range};
use crate::stage::{Graph, Sites};

use super::{clamp, layers};

/// How many layers are seen of every tile, as far as that can be said before tiles are turned: 0 to 4.
pub(in crate::pass) fn foreseen(paint: &Paint, sites: &Sites, graph: &Graph) -> Vec<u8> {
    match &paint.tone.asked {
        Asked::K(field) => {
            let k = || sites.points.iter().map(|&p| clamp(field.at(p), layers::MOST));
            match paint.tone.blend {
                Blend::Step => k().map(|k| layers::step(k).seen()).collect(),
                Blend::Partial => k().map(|k| layers::partial(k).seen()).collect(),
                Blend::Dither => {
                    layers::dither(&k().collect::<Vec<f64>>(), graph).into_iter().map(|layers| layers.seen()).collect()
                }
                Blend::Contour => sites.points.iter().map(|&p| around(field, p, sites.spacing)).collect(),
            }
        }
        Asked::Darkness(darkness) => of_darkness(darkness, &paint.tone.fill, &paint.region, &sites.points),
    }
}

/// The most layers in a square round a site.
fn around(field: &Field, site: Point, spacing: f64) -> u8 {
    let half = spacing / 2.0;
    let ring = [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| site + Vec2::new(x, y));
    layers::most(field, site, &ring)
}

/// The layers that cover as much as is asked for.
fn of_darkness(darkness: &Darkness, fill: &[Fill], region: &Region, points: &[Point]) -> Vec<u8> {
    // What each number of layers covers: marks lie on those of other layers as chance has it.
    let mut paper = 1.0;
    let reach: Vec<f64> = (0..layers::MOST as usize)
        .filter_map(|layer| fill.get(layer).or(fill.last()))
        .map(|fill| {
            paper *= 1.0 - share(&fill.kind);
            1.0 - paper
        })
        .collect();
    let top = reach.last().copied().unwrap_or(0.0);
    let asked: Vec<f64> = points.iter().map(|&p| darkness.field.at(p)).collect();
    let (low, high) = match darkness.range {
        Range::Clip => (0.0, 1.0),
        Range::Fit => points
            .iter()
            .zip(&asked)
            .filter(|&(&p, value)| value.is_finite() && region.contains(p))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, &v)| (low.min(v), high.max(v))),
    };
    let wanted = |value: f64| match darkness.range {
        Range::Fit if high > low => clamp((value - low) / (high - low), 1.0) * darkness.solid.map_or(top, |_| 1.0),
        Range::Fit | Range::Clip => clamp(value, 1.0),
    };
    let layers = |wanted: f64| {
        if wanted <= 0.0 || darkness.solid.is_some_and(|solid| wanted >= solid) {
            return 0;
        }
        let enough = reach.iter().position(|&reach| reach >= wanted).unwrap_or(reach.len().saturating_sub(1));
        enough as u8 + 1
    };
    asked.into_iter().map(|value| layers(wanted(value))).collect()
}

/// The share of the ground that the marks of a layer cover, by their width and distance.
fn share(kind: &FillKind) -> f64 {
    let Some(hatch) = kind.hatch() else { return 1.0 };
    let lines = hatch.pen / hatch.pitch;
    let share = match kind {
        FillKind::Dots { spacing, radius, .. } => PI * (*radius / hatch.pitch) * (*radius / *spacing),
        FillKind::Dashes { dash, gap, .. } => lines * (*dash / (*dash + *gap)),
        FillKind::Crosses { spacing, size, .. } => 2.0 * lines * (*size / *spacing),
        FillKind::Lines(_)
        | FillKind::Arcs(_)
        | FillKind::Waves { .. }
        | FillKind::Scribble { .. }
        | FillKind::Nawaami { .. }
        | FillKind::Motif { .. } => lines,
        FillKind::Solid => 1.0,
    };
    clamp(share, 1.0)
}
