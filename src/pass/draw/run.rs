//! How the width of a curved stroke runs out along it.

use crate::geom::{Point, chain};

use super::hand::Pull;
use super::taper::RunOut;

/// Memory that is used again for every stroke: places along a chain, and how long the way to them is.
#[derive(Default)]
pub(super) struct Run {
    /// Places where one curve of the chain ends, each with the way to it from the start of the stroke in millimetres.
    ways: Vec<(f64, f64)>,
    piece: Vec<Point>,
    joints: Vec<f64>,
    widths: Vec<f64>,
}

impl Run {
    /// How a piece of a stroke runs out, if it does; the places where its curves then end are [`Self::joints`]. `wholes` says
    /// from where to where strokes are drawn in one go. Along one curve the way grows evenly with its parameter, but for a
    /// little that a width cannot show.
    pub(super) fn out(
        &mut self,
        chain: &[Point],
        wholes: &[(f64, f64)],
        pull: &Pull,
        (from, to): (f64, f64),
    ) -> Option<RunOut> {
        let (taper, middle) = (pull.taper?, (from + to) / 2.0);
        let whole = *wholes.iter().find(|whole| middle < whole.1)?;
        let is_closed = chain.first() == chain.last() && whole == (0.0, chain::count(chain) as f64);
        if is_closed {
            return None;
        }
        self.ways.clear();
        self.ways.push((whole.0, 0.0));
        let mut way = 0.0;
        for (number, start, end) in chain::parts(chain, whole) {
            self.piece.clear();
            chain::part(chain, (number as f64 + start, number as f64 + end), &mut self.piece);
            way += chain::length(&self.piece);
            self.ways.push((number as f64 + end, way));
        }
        let run = taper.over((0.0, way));
        if run.at(self.way(from)) >= 1.0 && run.at(self.way(to)) >= 1.0 {
            return None;
        }
        self.joints.clear();
        self.joints.extend([from, to]);
        self.joints.extend(self.ways.iter().map(|&(place, _)| place).filter(|&place| from < place && place < to));
        let (ways, joints) = (&self.ways, &mut self.joints);
        run.joints((0.0, way), |way| joints.extend(place(ways, way).filter(|&place| from < place && place < to)));
        self.joints.sort_unstable_by(f64::total_cmp);
        self.joints.dedup_by(|b, a| {
            let is_same = *b - *a <= SAME;
            // No two joints may have the end of a curve between them.
            if is_same && b.fract() == 0.0 {
                *a = *b;
            }
            is_same
        });
        Some(run)
    }

    /// The places along the chain where the curves of the piece end.
    pub(super) fn joints(&self) -> &[f64] {
        &self.joints
    }

    /// The widths there.
    pub(super) fn widths(&mut self, run: &RunOut, pull: &Pull, is_backwards: bool) -> &[f64] {
        self.widths.clear();
        for i in 0..self.joints.len() {
            self.widths.push(pull.hatch.pen.to_mm() * run.at(self.way(self.joints[i])));
        }
        if is_backwards {
            self.widths.reverse();
        }
        &self.widths
    }

    /// The way to a place.
    fn way(&self, place: f64) -> f64 {
        let ends = self.ways.iter().zip(self.ways.iter().skip(1));
        let mut reached = ends.filter(|(_, end)| place <= end.0);
        let last = self.ways.last().map_or(0.0, |end| end.1);
        reached.next().map_or(last, |(start, end)| {
            let share = (place - start.0) / (end.0 - start.0);
            start.1 + (end.1 - start.1) * share.clamp(0.0, 1.0)
        })
    }
}

/// Joints nearer to each other than this, in a curve's parameter, are one.
const SAME: f64 = 1e-6;

/// The place that a way leads to.
fn place(ways: &[(f64, f64)], way: f64) -> Option<f64> {
    let mut ends = ways.iter().zip(ways.iter().skip(1));
    let (start, end) = ends.find(|(start, end)| way <= end.1 && end.1 > start.1)?;
    Some(start.0 + (end.0 - start.0) * ((way - start.1) / (end.1 - start.1)).clamp(0.0, 1.0))
}
