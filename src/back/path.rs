//! Path data of an SVG: points in millimetres go in, text comes out.
//!
//! Every subpath starts with an absolute move; steps from there are relative, which is shorter, and lead from where the
//! text has arrived rather than from where it should have, so that rounding never adds up.

use super::number;
use super::taper::{Edge, Ring};
use crate::geom::bezier::cubics;
use crate::geom::{Cubic, Point};

/// After so many steps that are given relative to the point before, a point is given absolutely: readers that add up in
/// single precision drift less than a step of the rounding.
const ANCHOR: usize = 64;

/// A point in units of the number format.
fn units(p: Point) -> [i64; 2] {
    [number::units(p.x), number::units(p.y)]
}

/// Writes a command with two numbers to the beginning of `text` and says how many bytes it took.
#[inline]
fn put_pair(command: u8, pair: [i64; 2], text: &mut [u8]) -> usize {
    text[0] = command;
    1 + put_numbers(pair, &mut text[1..])
}

/// Writes two numbers to the beginning of `text` and says how many bytes it took.
#[inline]
fn put_numbers([x, y]: [i64; 2], text: &mut [u8]) -> usize {
    let mut at = number::put(x, text);
    // A sign separates as well as a space does.
    if y >= 0 {
        text[at] = b' ';
        at += 1;
    }
    at + number::put(y, &mut text[at..])
}

/// Writes the step to a point at a distance in units to the beginning of `text` and says how many bytes it took.
#[inline]
fn put_step([x, y]: [i64; 2], text: &mut [u8]) -> usize {
    if y == 0 {
        text[0] = b'h';
        1 + number::put(x, &mut text[1..])
    } else if x == 0 {
        text[0] = b'v';
        1 + number::put(y, &mut text[1..])
    } else {
        put_pair(b'l', [x, y], text)
    }
}

/// Room for a command with two numbers.
const COMMAND: usize = 2 + 2 * number::LONGEST;

/// Writes a straight stroke.
pub(super) fn write_line(&[a, b]: &[Point; 2], text: &mut Vec<u8>) {
    let (a, b) = (units(a), units(b));
    let mut line = [0; 2 * COMMAND];
    let mut at = put_pair(b'M', a, &mut line);
    at += put_step([b[0] - a[0], b[1] - a[1]], &mut line[at..]);
    text.extend_from_slice(&line[..at]);
}

/// Writes a curved stroke, closed where it ends at its first point.
pub(super) fn write_curve(chain: &[Point], text: &mut Vec<u8>) {
    let (Some(first), Some(last)) = (chain.first(), chain.last()) else { return };
    let mut writer = Writer::start(*first, text);
    for Cubic([_, b, c, d]) in cubics(chain) {
        writer.curve(b, c, d, text);
    }
    if first == last {
        text.push(b'z');
    }
}

/// Writes a closed ring of lines and curves.
pub(super) fn write_outline(ring: &Ring, text: &mut Vec<u8>) {
    let mut writer = Writer::start(ring.start, text);
    for &edge in &ring.edges {
        match edge {
            Edge::Line(p) => writer.line(p, text),
            Edge::Curve(b, c, d) => writer.curve(b, c, d, text),
        }
    }
    text.push(b'z');
}

/// Writes a stroke of several points, closed where it ends at its first.
pub(super) fn write_polyline(points: &[Point], text: &mut Vec<u8>) {
    match points {
        [first, open @ .., last] if open.len() > 1 && first == last => {
            write_points(points[..points.len() - 1].iter().copied(), text);
            text.push(b'z');
        }
        points => write_points(points.iter().copied(), text),
    }
}

/// Writes a closed ring, unless it has no point.
pub(super) fn write_ring(points: impl Iterator<Item = Point>, text: &mut Vec<u8>) {
    let before = text.len();
    write_points(points, text);
    if text.len() > before {
        text.push(b'z');
    }
}

/// Writes a move to the first point and steps to the others.
fn write_points(mut points: impl Iterator<Item = Point>, text: &mut Vec<u8>) {
    let Some(first) = points.next() else { return };
    let mut writer = Writer::start(first, text);
    for p in points {
        writer.line(p, text);
    }
}

/// Where a subpath has arrived. Each step is taken from there, in whole units, so that rounding does not add up.
struct Writer {
    here: [i64; 2],
    steps: usize,
}

impl Writer {
    fn start(p: Point, text: &mut Vec<u8>) -> Self {
        let mut command = [0; COMMAND];
        let here = units(p);
        let length = put_pair(b'M', here, &mut command);
        text.extend_from_slice(&command[..length]);
        Self { here, steps: 0 }
    }

    fn line(&mut self, p: Point, text: &mut Vec<u8>) {
        let there = units(p);
        let step = self.step_to(there);
        if step == [0, 0] && self.steps > 0 {
            return;
        }
        self.steps += 1;
        let mut command = [0; COMMAND];
        let length = if self.steps.is_multiple_of(ANCHOR) {
            put_pair(b'L', there, &mut command)
        } else {
            put_step(step, &mut command)
        };
        text.extend_from_slice(&command[..length]);
        self.here = there;
    }

    fn curve(&mut self, b: Point, c: Point, d: Point, text: &mut Vec<u8>) {
        let points = [b, c, d].map(units);
        self.steps += 1;
        let mut command = [0; 3 * COMMAND];
        let is_anchor = self.steps.is_multiple_of(ANCHOR);
        let mut at = 0;
        for (i, &p) in points.iter().enumerate() {
            let pair = if is_anchor { p } else { self.step_to(p) };
            // A sign separates as well as a space does; the command itself does so too.
            let lead = match (i, is_anchor) {
                (0, true) => b'C',
                (0, false) => b'c',
                (_, _) => b' ',
            };
            if i > 0 && pair[0] < 0 {
                at += put_numbers(pair, &mut command[at..]);
            } else {
                at += put_pair(lead, pair, &mut command[at..]);
            }
        }
        text.extend_from_slice(&command[..at]);
        self.here = points[2];
    }

    fn step_to(&self, [x, y]: [i64; 2]) -> [i64; 2] {
        [x - self.here[0], y - self.here[1]]
    }
}
