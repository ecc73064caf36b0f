//! Stipple: dots along the hatch lines, each drawn whole or not at all.

use crate::geom::clip::TOLERANCE;
use crate::geom::{Length, Point};
use crate::scene::{Blend, Hatch};

use super::budget::{BANK, Budget, DOT, Exceeded, LINE};
use super::hand::{Bundle, weighed};
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

/// A dot of a row.
pub(super) struct Dot {
    /// Its place along the row.
    pub(super) u: f64,
    pub(super) radius: f64,
    /// Its place among the weights of its size.
    pub(super) weight: usize,
}

impl Dot {
    /// The dot `mark` of row `number`, which stands at `u` where no hand moves it.
    pub(super) fn new(
        bundle: Option<&Bundle>,
        dotting: &Dotting<'_>,
        (number, mark): (i64, i64),
        u: f64,
        step: f64,
    ) -> Self {
        let Some(bundle) = bundle else { return Self { u, radius: dotting.radius, weight: 0 } };
        let weight = bundle.weight_of(number, mark);
        let radius = weighed(Length::mm(dotting.radius), bundle.hand(), weight).to_mm();
        Self { u: u + bundle.shift_along(number, mark, step), radius, weight }
    }
}

/// Draws the dots of a layer.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    dotting: &Dotting<'_>,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    let (lines, along) = interleaved(job, layer, dotting.hatch, dotting.spacing, scratch);
    let radius = dotting.radius;
    let hand = &job.paint.tone.hand;
    let inner = |(low, high): (f64, f64), step: f64| {
        // Dots may stray into the area from places outside it.
        let margin = radius * (1.0 - hand.pen) - hand.spacing * step;
        (low + margin, high - margin)
    };
    let lines = lines.over(inner(scratch.area.across(), lines.step()));
    job.budget.work(lines.count() * LINE as f64)?;
    let cost = DOT + if layer.is_clipped { BANK } else { 0 };
    let mut is_backwards = false;
    for (i, v) in lines.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        let v = layer.bundle.map_or(v, |bundle| v + bundle.shift(i, lines.step()));
        scratch.area.ranges(&v, &mut scratch.others);
        if scratch.others.is_empty() {
            continue;
        }
        let starts: Vec<usize> = out.iter().map(|batch| batch.dots.len()).collect();
        let mut last = i64::MIN;
        for span in 0..scratch.others.len() {
            let row = along.over(inner(scratch.others[span], along.step()));
            job.budget.work(row.count() * cost as f64)?;
            for (j, u) in row.places() {
                // One that could stray into two spans is drawn once.
                if j <= last {
                    continue;
                }
                last = j;
                let dot = Dot::new(layer.bundle.as_ref(), dotting, (i, j), u, along.step());
                let centre = layer.frame.page(dot.u, v);
                if is_free(job, layer, centre, dot.radius, scratch)? {
                    out[dot.weight].dots.push(centre);
                }
            }
        }
        end_row(out, &starts, is_backwards, job.budget)?;
        is_backwards = !is_backwards;
    }
    Ok(())
}

/// Turns the new dots of a row round where the pen comes from its far end. `starts` says where they start.
pub(super) fn end_row(
    out: &mut [Batch],
    starts: &[usize],
    is_backwards: bool,
    budget: &Budget,
) -> Result<(), Exceeded> {
    for (batch, &start) in out.iter_mut().zip(starts) {
        if is_backwards {
            batch.dots[start..].reverse();
        }
        if batch.dots.len() > budget.limit() {
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
    if job.paint.tone.blend == Blend::Contour && job.paint.tone.asked.field().at(centre) < f64::from(layer.number) - 0.5
    {
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
