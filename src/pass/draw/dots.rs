//! Stipple: dots along the hatch lines, each drawn whole or not at all.

use crate::geom::clip::TOLERANCE;
use crate::geom::{Length, Point};
use crate::scene::{Blend, Hatch};

use super::budget::{BANK, DOT, Exceeded, LINE};
use super::job::{Job, Layer, Scratch};
use super::lattice::{Lattice, is_drawn};
use super::lines::interleaved;
use super::palette::Batch;

/// How dots are set.
pub(super) struct Dotting<'a> {
    pub(super) hatch: &'a Hatch,
    spacing: Length,
    pub(super) radius: f64,
}

impl<'a> Dotting<'a> {
    pub(super) fn new(hatch: &'a Hatch, spacing: Length, radius: Length) -> Self {
        Self { hatch, spacing, radius: radius.to_mm() }
    }

    /// Places along lines at the exact spacing, one of them, or one that would continue them, at `middle`.
    pub(super) fn along(&self, range: (f64, f64), middle: f64) -> Lattice {
        Lattice::cell(range, middle, self.spacing.to_mm())
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
    let (lines, along) = interleaved(job, layer, dotting.hatch, dotting.spacing, scratch);
    let radius = dotting.radius;
    let inner = |(low, high): (f64, f64)| (low + radius, high - radius);
    let lines = lines.over(inner(scratch.area.across()));
    job.budget.work(lines.count() * LINE as f64)?;
    let cost = DOT + if layer.is_clipped { BANK } else { 0 };
    let mut is_backwards = false;
    for (i, v) in lines.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        scratch.area.ranges(v, &mut scratch.others);
        if scratch.others.is_empty() {
            continue;
        }
        let start = out.dots.len();
        for span in 0..scratch.others.len() {
            let row = along.over(inner(scratch.others[span]));
            job.budget.work(row.count() * cost as f64)?;
            for (_, u) in row.places() {
                let centre = layer.frame.page(u, v);
                if is_free(job, layer, centre, radius, scratch)? {
                    out.dots.push(centre);
                }
            }
        }
        if is_backwards {
            out.dots[start..].reverse();
        }
        is_backwards = !is_backwards;
        if out.dots.len() > job.budget.limit() {
            return Err(Exceeded::Marks);
        }
    }
    Ok(())
}

/// Whether a dot lies wholly in the layer's area and in the region and clear of all covers.
fn is_free(
    job: &Job<'_>,
    layer: &Layer<'_>,
    centre: Point,
    radius: f64,
    scratch: &mut Scratch,
) -> Result<bool, Exceeded> {
    let least = radius - TOLERANCE;
    if layer.area.clearance(centre) < least {
        return Ok(false);
    }
    if job.paint.tone.blend == Blend::Contour && job.paint.tone.k.at(centre) < f64::from(layer.number) - 0.5 {
        return Ok(false);
    }
    let is_cover = |&cover: &u32| {
        let reach = job.nearby.radius(cover as usize) + radius;
        job.sites.points[cover as usize].distance_squared(centre) < reach * reach
            && job.nearby.figure(cover).clearance(centre) > -least
    };
    let found = scratch.covers.iter().position(is_cover);
    let looks = found.map_or(scratch.covers.len(), |at| at + 1);
    job.budget.look(&mut scratch.looks, looks as u64)?;
    Ok(found.is_none() && (!layer.is_clipped || job.bank.holds_disc(centre, radius)))
}
