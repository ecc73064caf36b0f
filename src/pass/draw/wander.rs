//! Lines that a hand cannot hold straight.

use crate::geom::Point;
use crate::geom::clip::{Frame, Profile};
use crate::random::Table;

use super::silhouette::Meet;

/// How much of a stroke's wandering its whole bundle shares, the turn of the wrist.
const SHARED: f64 = 0.5;

/// A smooth curve through numbers between -1 and 1 reaches 1.25 at most (Catmull and Rom 1974, half way between two equal
/// ones whose neighbours lie opposite).
const CURVE: f64 = 0.8;

/// A curve through such numbers rises by no more than this in one step from number to number.
const STEEPEST: f64 = 3.0;

/// A line that strokes are drawn along.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) frame: Frame,
    /// Its number in the lattice.
    pub(super) number: i64,
    /// Its place across the frame.
    pub(super) v: f64,
    /// How it wanders about that place.
    pub(super) wander: Wander,
}

impl Line {
    /// A line that does not stray.
    pub(super) fn ruled(frame: &Frame, number: i64, v: f64) -> Self {
        Self { frame: *frame, number, v, wander: Wander::NONE }
    }

    /// A place along it on the page.
    pub(super) fn page(&self, u: f64) -> Point {
        if self.wander.is_none() {
            return self.frame.page(u, self.v);
        }
        self.frame.page(u, self.v + self.wander.at(u).0)
    }
}

impl Meet for Line {
    fn meet(&self, profile: &Profile) -> Option<(f64, f64)> {
        let (start, end) = profile.span(self.v)?;
        if self.wander.is_none() {
            return Some((start, end));
        }
        // One step towards where the line as it wanders meets the outline: what is left is the square of its slope.
        let near = |u: f64| profile.span(self.v + self.wander.at(u).0).unwrap_or((start, end));
        let (start, end) = (near(start).0, near(end).1);
        (start < end).then_some((start, end))
    }
}

/// How a line wanders: a smooth curve through random numbers at equal steps along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wander {
    /// The farthest it comes off its line in millimetres.
    pub(super) amplitude: f64,
    /// From number to number in millimetres.
    pub(super) wave: f64,
    /// Where along the line the first lies, in waves.
    pub(super) phase: f64,
    /// What the bundle wanders by, and the line.
    pub(super) shared: Table,
    pub(super) own: Table,
}

impl Wander {
    /// Straight on.
    pub(super) const NONE: Self = Self { amplitude: 0.0, wave: 1.0, phase: 0.0, shared: Table::ZERO, own: Table::ZERO };

    /// Whether it goes straight on.
    pub(super) fn is_none(&self) -> bool {
        self.amplitude == 0.0
    }

    /// The farthest that a line comes off its place in millimetres.
    pub(super) fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// How much a line rises at the most for what it goes.
    pub(super) fn steepest(&self) -> f64 {
        self.amplitude * CURVE * STEEPEST / self.wave
    }

    /// How far the line lies off its place at `u`, and how much it rises there.
    pub(super) fn at(&self, u: f64) -> (f64, f64) {
        let place = u / self.wave + self.phase;
        let first = place.floor();
        let t = place - first;
        let knot = |i: i64| {
            let place = first as i64 + i;
            let even = |table: Table| 2.0 * table.unit(place) - 1.0;
            SHARED * even(self.shared) + (1.0 - SHARED) * even(self.own)
        };
        let [a, b, c, d] = [knot(-1), knot(0), knot(1), knot(2)];
        // The cubic through b and c whose slopes there are those of the lines from a to c and from b to d.
        let (m, n) = ((c - a) / 2.0, (d - b) / 2.0);
        let (square, cube) = (2.0 * m + n + 3.0 * (b - c), m + n + 2.0 * (b - c));
        let scale = self.amplitude * CURVE;
        let offset = b + t * (m + t * (cube * t - square));
        let slope = m + t * (3.0 * cube * t - 2.0 * square);
        (scale * offset, scale * slope / self.wave)
    }

    /// Makes a chain of Béziers wander, as smooth as it is.
    pub(super) fn bend(&self, chain: &mut [Point]) {
        if self.is_none() {
            return;
        }
        for joint in (0..chain.len()).step_by(3) {
            let place = chain[joint];
            let (offset, slope) = self.at(place.x);
            for i in joint.saturating_sub(1)..(joint + 2).min(chain.len()) {
                chain[i].y += offset + slope * (chain[i].x - place.x);
            }
        }
    }

    /// Calls `visit` with the places between two others where one cubic ends and the next begins, in order.
    pub(super) fn joints(&self, (from, to): (f64, f64), mut visit: impl FnMut(f64)) {
        let mut place = (from / self.wave + self.phase).floor() + 1.0;
        loop {
            let u = (place - self.phase) * self.wave;
            if u >= to {
                break;
            }
            if u > from {
                visit(u);
            }
            place += 1.0;
        }
    }

    /// The two control points between two places of one cubic, as ways across the line.
    pub(super) fn controls(&self, from: f64, to: f64) -> (f64, f64) {
        // At a joint the cubic that is meant is the one between them.
        let third = (to - from) / 3.0;
        let (start, end) = (self.at(from), self.at(to));
        (start.0 + start.1 * third, end.0 - end.1 * third)
    }
}
