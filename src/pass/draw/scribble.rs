//! Scribble: rows of loops, as of a pen that runs to and fro and is not lifted.

use crate::geom::course::loop_handles;
use crate::geom::{Cubic, Length, Point, Vec2};
use crate::random::{Key, Table};
use crate::scene::Paint;

use super::curves::Course;
use super::waves::push;

/// By how much of its height a loop may be higher or lower than the others, at either end.
const UNEVEN: f64 = 0.2;

/// By how much of the spacing a loop may lie before or behind its place.
const JITTER: f64 = 0.25;

/// How loops lean forwards: so much of a millimetre for each one upwards.
const SLANT: f64 = 0.22;

/// By how much the ends of loops may rise or fall for what they run on.
const TILT: f64 = 0.15;

/// How wide a loop may be against the others.
const WIDTH: f64 = 0.3;

/// One layer of one tile.
pub(super) struct Scribble {
    loops: f64,
    spacing: f64,
    table: Table,
}

impl Scribble {
    /// `key` is the number that the tile's random draws are keyed by.
    pub(super) fn new(paint: &Paint, key: usize, layer: u8, loops: Length, spacing: Length) -> Self {
        let purpose = Key { seed: paint.seed, name: &paint.name, purpose: "scribble" };
        let table = purpose.table(key).row(i64::from(layer));
        Self { loops: loops.to_mm(), spacing: spacing.to_mm(), table }
    }

    /// The top or bottom of a loop with its way on: even numbers are tops. Numbers are drawn by place, so that a row does not
    /// depend on where it is begun.
    fn node(&self, row: Table, number: i64) -> (Point, Vec2) {
        let own = row.row(number);
        let is_top = number.rem_euclid(2) == 0;
        let side = if is_top { -0.5 } else { 0.5 };
        let v = self.loops * (side + UNEVEN * own.stray(0));
        let u = self.spacing * (number as f64 / 2.0 + JITTER * own.stray(1)) - SLANT * v;
        let [fore, back] = loop_handles(self.loops, self.spacing);
        let width = 1.0 + WIDTH * own.stray(2);
        let way = if is_top { fore } else { -back } * width;
        (Point::new(u, v), Vec2::new(way, way * TILT * own.stray(3)))
    }
}

impl Course for Scribble {
    fn reach(&self) -> f64 {
        self.loops * (0.5 + UNEVEN)
    }

    fn count(&self, (start, end): (f64, f64)) -> f64 {
        2.0 * (end - start + 2.0 * self.loops) / self.spacing + 6.0
    }

    fn trace(&self, number: i64, v: f64, (start, end): (f64, f64), chain: &mut Vec<Point>) {
        let row = self.table.row(number);
        // Loops reach over their places.
        let first = (2.0 * (start - self.loops) / self.spacing).floor() - 2.0;
        let last = (2.0 * (end + self.loops) / self.spacing).ceil() + 2.0;
        let (first, last) = (first as i64, last as i64);
        let across = Vec2::new(0.0, v);
        let (mut from, mut way) = self.node(row, first);
        for next in first + 1..=last {
            let (to, on) = self.node(row, next);
            push(Cubic([from, from + way, to - on, to].map(|p| p + across)), chain);
            (from, way) = (to, on);
        }
    }
}
