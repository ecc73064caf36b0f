//! Tiles inked all over: what is seen of them, as outlines.

use crate::field::{Field, Node};
use crate::geom::{Point, Rect, ring_bounds};
use crate::region::{FillRule, Region};
use crate::scene::{Blend, FillKind};

use super::job::{Job, Layer};
use super::palette::Batch;

/// Shares of a layer's lines from here on fill the tile: a solid area has no lines to leave out.
const HALF: f64 = 0.5;

/// Cells over the longer side of an area whose end along the field is looked for.
const CELLS: f64 = 32.0;

/// Draws what is seen of a layer's area. Crumbs are dropped by the region's booleans.
pub(super) fn draw(job: &Job<'_>, layer: &Layer<'_>, covers: &[u32], out: &mut Batch) {
    if layer.share < HALF {
        return;
    }
    let (field, area) = (job.paint.tone.asked.field(), layer.area.outline());
    let has_contour = job.paint.tone.blend == Blend::Contour && !matches!(field.node(), Node::Constant(_));
    // What a cover of the same ink hides it inks itself.
    let fills = &job.paint.tone.fill;
    let is_one_ink =
        !has_contour && fills.iter().all(|fill| matches!(fill.kind, FillKind::Solid) && fill.ink == fills[0].ink);
    let inks = |&cover: &u32| is_one_ink && job.tiles.layers[job.sites.original(cover as usize)].full > 0;
    let hidden: Vec<Vec<Point>> = covers
        .iter()
        .filter(|cover| !inks(cover))
        .map(|&cover| job.nearby.figure(cover))
        .filter(|figure| figure.overlaps(layer.area))
        .map(|figure| figure.outline().to_vec())
        .collect();
    if hidden.is_empty() && !layer.is_clipped && !has_contour {
        if area.len() > 2 {
            out.areas.push(vec![area.to_vec()]);
        }
        return;
    }
    let mut seen = Region::from_rings(vec![area.to_vec()], FillRule::NonZero);
    if !hidden.is_empty() {
        seen = seen.difference(&Region::from_rings(hidden, FillRule::NonZero));
    }
    if layer.is_clipped {
        seen = seen.intersection(job.bank.region());
    }
    if has_contour {
        seen = seen.intersection(&above(field, f64::from(layer.number) - 0.5, &ring_bounds(area)));
    }
    push(&seen, out);
}

/// Adds a region's polygons to the areas.
pub(super) fn push(region: &Region, out: &mut Batch) {
    let rings = |polygon: &crate::geom::Polygon| polygon.rings().cloned().collect();
    out.areas.extend(region.polygons().iter().map(rings));
}

/// Areas of one ink as one: drawn side by side, each would be smoothed at its own edges and the paper would shine through
/// where they meet.
pub(super) fn united(areas: Vec<Vec<Vec<Point>>>) -> Vec<Vec<Vec<Point>>> {
    if areas.len() < 2 {
        return areas;
    }
    let whole = Region::from_rings(areas.into_iter().flatten().collect(), FillRule::NonZero);
    whole.polygons().iter().map(|polygon| polygon.rings().cloned().collect()).collect()
}

/// Where in a box a field is at least `threshold`: square cells are halved along a diagonal, and over each half the field
/// is taken to be even between its corners.
fn above(field: &Field, threshold: f64, bounds: &Rect) -> Region {
    let cell = bounds.width().max(bounds.height()) / CELLS;
    let lines = |extent: f64| (extent / cell).ceil().clamp(1.0, CELLS) as usize;
    let (columns, rows) = (lines(bounds.width()), lines(bounds.height()));
    let corner = |column: usize, row: usize| {
        let p = Point::new(bounds.min.x + column as f64 * cell, bounds.min.y + row as f64 * cell);
        (p, field.at(p) - threshold)
    };
    let mut rings = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [corner(column, row), corner(column + 1, row)];
            let [c, d] = [corner(column + 1, row + 1), corner(column, row + 1)];
            rings.extend([[a, b, c], [a, c, d]].iter().map(part).filter(|ring| ring.len() > 2));
        }
    }
    Region::from_rings(rings, FillRule::NonZero)
}

/// The part of a triangle where a value that is even between its corners is not negative.
fn part(triangle: &[(Point, f64); 3]) -> Vec<Point> {
    let mut ring = Vec::with_capacity(4);
    let mut before = triangle[2];
    for &corner in triangle {
        if (before.1 >= 0.0) != (corner.1 >= 0.0) {
            ring.push(before.0.lerp(corner.0, before.1 / (before.1 - corner.1)));
        }
        if corner.1 >= 0.0 {
            ring.push(corner.0);
        }
        before = corner;
    }
    ring
}
