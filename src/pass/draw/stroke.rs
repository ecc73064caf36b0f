//! From what is left of a line to marks: straight strokes, curved ones, and such as run out.

use crate::geom::Point;
use crate::geom::clip::TOLERANCE;
use crate::scene::Hatch;

use super::budget::Exceeded;
use super::dashes::Dashes;
use super::edge::Nib;
use super::hand::{Bundle, Pull};
use super::job::{self, Job};
use super::palette::Batch;
use super::wander::Line;

/// Pieces of no more than this many millimetres are rounding, however short strokes may be.
pub(super) const CRUMB: f64 = 1e-6;

/// Memory that is used again for every stroke.
#[derive(Default)]
pub(super) struct Scratch {
    joints: Vec<f64>,
    spine: Vec<Point>,
    widths: Vec<f64>,
}

/// A line of which some ranges are to be drawn.
pub(super) struct Stroke {
    pub(super) line: Line,
    pull: Pull,
    /// Whether the pen comes from the far end: it turns round at the end of every line.
    is_backwards: bool,
}

impl Stroke {
    /// A stroke along a line as the hand of a bundle draws it, or ruled.
    pub(super) fn new(line: Line, bundle: Option<&Bundle>, hatch: &Hatch, is_backwards: bool) -> Self {
        Self { line, pull: Pull::line(bundle, hatch, line.number), is_backwards }
    }

    /// How far its ink reaches from its line.
    pub(super) fn nib(&self) -> Nib {
        let nib = Nib::of(&self.pull.hatch);
        let wander = &self.line.wander;
        // The end of a stroke that rises lies askew, its one corner farther out.
        Nib { half: nib.half + wander.amplitude(), cap: nib.cap + nib.half * wander.steepest().min(1.0) }
    }

    /// Draws what is left in `scratch.ranges` and long enough. From where to where it is drawn in one go stands in
    /// `scratch.wholes`.
    pub(super) fn emit(
        &self,
        job: &Job<'_>,
        dashes: Option<&Dashes>,
        scratch: &mut job::Scratch,
        out: &mut [Batch],
    ) -> Result<(), Exceeded> {
        let mut shortest = self.pull.hatch.shortest.to_mm();
        if let Some(dashes) = dashes {
            scratch.others.clear();
            for &range in scratch.ranges.as_slice() {
                job.budget.work(dashes.count(range))?;
                dashes.cut(range, (self.line.number, self.line.v), &mut scratch.others);
            }
            scratch.ranges.intersect(&scratch.others);
            // Dashes that are meant to be short are not too short.
            shortest = shortest.min(dashes.length());
        }
        let shortest = (shortest - TOLERANCE).max(CRUMB);
        let ranges = scratch.ranges.as_slice();
        let out = &mut out[self.pull.weight];
        for i in 0..ranges.len() {
            let (from, to) = ranges[if self.is_backwards { ranges.len() - 1 - i } else { i }];
            if to - from >= shortest {
                let middle = (from + to) / 2.0;
                // Every dash is a stroke of its own.
                let whole = match dashes {
                    Some(dashes) => Some(dashes.around(middle, (self.line.number, self.line.v))),
                    None => scratch.wholes.iter().copied().find(|whole| middle < whole.1),
                };
                self.piece(whole, (from, to), &mut scratch.stroke, out);
            }
        }
        if out.len() > job.budget.limit() { Err(Exceeded::Marks) } else { Ok(()) }
    }

    /// Draws a piece of the stroke that is drawn in one go over `whole`.
    fn piece(&self, whole: Option<(f64, f64)>, (from, to): (f64, f64), scratch: &mut Scratch, out: &mut Batch) {
        let taper = self.pull.taper.zip(whole).map(|(taper, whole)| taper.over(whole));
        let taper = taper.filter(|taper| taper.at(from) < 1.0 || taper.at(to) < 1.0);
        let wander = &self.line.wander;
        if taper.is_none() && wander.is_none() {
            let (start, end) = if self.is_backwards { (to, from) } else { (from, to) };
            out.lines.push([self.line.page(start), self.line.page(end)]);
            return;
        }
        let Scratch { joints, spine, widths } = scratch;
        joints.clear();
        joints.push(from);
        if !wander.is_none() {
            wander.joints((from, to), |u| joints.push(u));
        }
        if let Some(taper) = taper {
            taper.joints((from, to), |u| joints.push(u));
        }
        joints.push(to);
        joints.sort_unstable_by(f64::total_cmp);
        joints.dedup_by(|b, a| *b - *a <= CRUMB);
        spine.clear();
        spine.push(self.line.page(from));
        for pair in joints.windows(2) {
            let (start, end) = (pair[0], pair[1]);
            let third = (end - start) / 3.0;
            let (a, b) = if wander.is_none() { (0.0, 0.0) } else { wander.controls(start, end) };
            let Line { frame, v, .. } = &self.line;
            spine.extend([frame.page(start + third, v + a), frame.page(end - third, v + b), self.line.page(end)]);
        }
        if self.is_backwards {
            spine.reverse();
        }
        let Some(taper) = taper else {
            out.curves.push(spine);
            return;
        };
        widths.clear();
        widths.extend(joints.iter().map(|&u| self.pull.hatch.pen.to_mm() * taper.at(u)));
        if self.is_backwards {
            widths.reverse();
        }
        out.tapers.push(spine, widths);
    }
}
