//! Crosses along the hatch lines: two short strokes each, one along the line and one across it.
//!
//! A cross is drawn where its middle is seen, and its arms end where the tile does; one that would lose more than a little
//! is left out.

use crate::geom::clip::{Frame, TOLERANCE};
use crate::geom::{Length, Point, Vec2};
use crate::scene::{Blend, Hatch};

use super::budget::{BANK, DOT, Exceeded, LINE};
use super::curves::look;
use super::edge::Nib;
use super::hand::Pull;
use super::job::{Job, Layer, Scratch};
use super::lattice::is_drawn;
use super::lines::interleaved;
use super::palette::Batch;
use super::stroke::CRUMB;

/// The least share of its arms that is left of a cross: what has lost more is a splinter.
const KEPT: f64 = 0.7;

/// How crosses are set.
pub(super) struct Crossing<'a> {
    pub(super) hatch: &'a Hatch,
    pub(super) spacing: Length,
    /// From end to end of an arm.
    pub(super) size: Length,
}

/// The arms of a cross in its frame.
pub(super) const ARMS: [Vec2; 2] = [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)];

/// Draws the crosses of a layer.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    crossing: &Crossing<'_>,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    let (lines, along) = interleaved(job, layer, crossing.hatch, crossing.spacing, scratch);
    look(job, layer, scratch);
    let Some(bounds) = scratch.curves.area.bounds() else { return Ok(()) };
    let lines = lines.over((bounds.min.y, bounds.max.y));
    job.budget.work(lines.count() * LINE as f64)?;
    let cost = 2 * (DOT + if layer.is_clipped { BANK } else { 0 });
    let mut is_backwards = false;
    let bundle = layer.bundle.as_ref();
    for (i, v) in lines.places() {
        let v = bundle.map_or(v, |bundle| v + bundle.shift(i, lines.step()));
        let Some(span) = scratch.curves.area.along((v, v)).filter(|_| is_drawn(i, layer.share)) else { continue };
        let row = along.over(span);
        job.budget.work(row.count() * cost as f64)?;
        let count = row.count() as u64;
        for place in 0..count {
            let Some((mark, u)) = row.place(if is_backwards { count - 1 - place } else { place }) else { continue };
            let pull = Pull::mark(bundle, crossing.hatch, i, mark);
            let u = bundle.map_or(u, |bundle| u + bundle.shift_along(i, mark, row.step()));
            let crossing = Crossing { hatch: &pull.hatch, ..*crossing };
            cross(job, layer, &crossing, Point::new(u, v), scratch, &mut out[pull.weight])?;
        }
        is_backwards = !is_backwards;
        if out.iter().any(|batch| batch.lines.len() > job.budget.limit()) {
            return Err(Exceeded::Marks);
        }
    }
    Ok(())
}

/// Draws one cross, if its middle is seen.
fn cross(
    job: &Job<'_>,
    layer: &Layer<'_>,
    crossing: &Crossing<'_>,
    middle: Point,
    scratch: &mut Scratch,
    out: &mut Batch,
) -> Result<(), Exceeded> {
    let covers = scratch.covers.len();
    job.budget.look(&mut scratch.looks, covers as u64)?;
    let page = layer.frame.page(middle.x, middle.y);
    let is_hidden = |&cover: &u32| {
        let reach = job.nearby.radius(cover as usize);
        job.sites.points[cover as usize].distance_squared(page) < reach * reach
            && job.nearby.figure(cover).clearance(page) > 0.0
    };
    let clearance = layer.area.clearance(page);
    if clearance < -TOLERANCE || scratch.covers.iter().any(is_hidden) {
        return Ok(());
    }
    // An arm does not lie on the frame, where one of a neighbour could lie too.
    let pen = crossing.hatch.pen.to_mm();
    let is_on_frame = |frame: &Frame, half: f64| {
        clearance < pen && [-half, half].iter().all(|&u| layer.area.clearance(frame.page(u, 0.0)).abs() < pen)
    };
    if job.paint.tone.blend == Blend::Contour && job.paint.tone.asked.field().at(page) < f64::from(layer.number) - 0.5 {
        return Ok(());
    }
    let half = crossing.size.to_mm() / 2.0;
    let first = out.lines.len();
    for arm in ARMS {
        let frame = Frame::new(page, layer.frame.along * arm.x + layer.frame.along.turned() * arm.y);
        if is_on_frame(&frame, half / 2.0) {
            continue;
        }
        let (start, end) = (middle + arm * -half, middle + arm * half);
        let place = |share: f64| 2.0 * half * share - half;
        let Scratch { ranges, others, curves, .. } = &mut *scratch;
        others.clear();
        curves.area.line(start, end, |(from, to)| others.push((place(from), place(to))));
        others.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        // Pieces of an outline that share a side are one on the arm.
        others.dedup_by(|next, last| {
            let touches = next.0 <= last.1 + TOLERANCE;
            if touches {
                last.1 = last.1.max(next.1);
            }
            touches
        });
        ranges.set(others);
        for cover in &curves.hidden[..covers] {
            cover.line(start, end, |(from, to)| ranges.subtract(place(from), place(to)));
        }
        draw_arm(job, crossing, &frame, layer.is_clipped, scratch, out);
    }
    let left: f64 = out.lines[first..].iter().map(|[start, end]| start.distance(*end)).sum();
    if left < KEPT * 4.0 * half {
        out.lines.truncate(first);
    }
    Ok(())
}

/// Draws what is left in `scratch.ranges` of an arm, if it still goes through the middle, which is the frame's origin.
pub(super) fn draw_arm(
    job: &Job<'_>,
    crossing: &Crossing<'_>,
    frame: &Frame,
    is_clipped: bool,
    scratch: &mut Scratch,
    out: &mut Batch,
) {
    if is_clipped {
        job.bank.clip(frame, 0.0, Nib::of(crossing.hatch), &mut scratch.ranges, &mut scratch.edge);
    }
    // Arms that are meant to be short are not too short.
    let shortest = (crossing.hatch.shortest.min(crossing.size).to_mm() - TOLERANCE).max(CRUMB);
    let left = scratch
        .ranges
        .as_slice()
        .iter()
        .find(|(from, to)| *from <= TOLERANCE && -TOLERANCE <= *to && to - from >= shortest);
    if let Some(&(from, to)) = left {
        out.lines.push([frame.page(from, 0.0), frame.page(to, 0.0)]);
    }
}
