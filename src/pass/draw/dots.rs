//! Stipple: dots along the hatch lines, each drawn whole or not at all.

use crate::geom::clip::{TOLERANCE, convex_clearance};
use crate::geom::{Length, Point};
use crate::scene::{Blend, Hatch};

use super::budget::Exceeded;
use super::job::{Job, Layer, Scratch};
use super::lattice::{Lattice, is_drawn};
use super::lines::spread;
use super::palette::Batch;

/// How dots are set.
pub(super) struct Dotting<'a> {
    pub(super) hatch: &'a Hatch,
    spacing: f64,
    pub(super) radius: f64,
}

impl<'a> Dotting<'a> {
    pub(super) fn new(hatch: &'a Hatch, spacing: Length, radius: Length) -> Self {
        Self { hatch, spacing: spacing.to_mm(), radius: radius.to_mm() }
    }

    /// Places along lines at the exact spacing.
    pub(super) fn along(&self, range: (f64, f64)) -> Lattice {
        Lattice::cell(range, 0.0, self.spacing)
    }
}

/// Draws the dots of a layer.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    dotting: &Dotting<'_>,
    scratch: &mut Scratch,
    out: &mut Batch,
) -> Result<(), Exceeded> {
    let (lines, along) = lattices(job, layer, dotting, scratch);
    let radius = dotting.radius;
    let inner = |(low, high): (f64, f64)| (low + radius, high - radius);
    let lines = lines.over(inner(scratch.area.across()));
    job.budget.work(lines.count())?;
    let mut is_backwards = false;
    for (i, v) in lines.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        let Some(span) = scratch.area.span(v) else { continue };
        let row = along.over(inner(span));
        job.budget.work(row.count())?;
        let start = out.dots.len();
        for (_, u) in row.places() {
            let centre = layer.frame.page(u, v);
            if is_free(job, layer, centre, radius, &scratch.covers) {
                out.dots.push(centre);
            }
        }
        if is_backwards {
            out.dots[start..].reverse();
        }
        is_backwards = !is_backwards;
        if out.dots.len() > job.budget.limit() {
            return Err(Exceeded);
        }
    }
    Ok(())
}

/// Where lines lie, and dots along them, so that no dot falls on one of an earlier layer.
///
/// The second layer is moved by half a pitch and half a spacing: its dots could fall on the first layer's only if the
/// product of two odd numbers were even. In the same way the fourth keeps off the third. These two lie askew to the
/// first: at the exact pitch, which no diagonal of a tile is a multiple of, and without a dot in the middle.
fn lattices(job: &Job<'_>, layer: &Layer<'_>, dotting: &Dotting<'_>, scratch: &mut Scratch) -> (Lattice, Lattice) {
    let lines = spread(job, layer, dotting.hatch, scratch);
    let (across, along) = (scratch.whole.across(), scratch.whole.along());
    let is_exact = job.paint.tone.shape.is_cell();
    let exactly = |range: (f64, f64), step: f64| {
        let middle = if is_exact { 0.0 } else { (range.0 + range.1) / 2.0 };
        Lattice::cell(range, middle, step)
    };
    let pitch = dotting.hatch.pitch.to_mm();
    let row = if is_exact || layer.number > 2 {
        exactly(along, dotting.spacing)
    } else {
        Lattice::stamp(along, dotting.spacing, 0.5, 1)
    };
    match layer.number {
        0 | 1 => (lines, row),
        2 => (lines.moved(0.5), row.moved(0.5)),
        3 => (exactly(across, pitch).moved(0.5), row),
        _ => (exactly(across, pitch).moved(0.5), row.moved(0.5)),
    }
}

/// Whether a dot lies wholly in the layer's area and in the region and clear of all covers.
fn is_free(job: &Job<'_>, layer: &Layer<'_>, centre: Point, radius: f64, covers: &[u32]) -> bool {
    let least = radius - TOLERANCE;
    if convex_clearance(layer.area, centre) < least {
        return false;
    }
    if job.paint.tone.blend == Blend::Contour && job.paint.tone.k.at(centre) < f64::from(layer.number) - 0.5 {
        return false;
    }
    let is_covered = |&cover: &u32| {
        let reach = job.nearby.radius(cover as usize) + radius;
        job.sites.points[cover as usize].distance_squared(centre) < reach * reach
            && convex_clearance(job.nearby.outline(cover), centre) > -least
    };
    !covers.iter().any(is_covered) && (!layer.is_clipped || job.bank.holds_disc(centre, radius))
}
