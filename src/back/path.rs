//! Path data of an SVG: points in millimetres go in, text comes out.
//!
//! Every subpath starts with an absolute move; steps from there are relative, which is shorter, and lead from where the
//! text has arrived rather than from where it should have, so that rounding never adds up.

use super::number;
use crate::geom::Point;

/// After so many steps that are given relative to the point before, a point is given absolutely: readers that add up in
/// single precision drift less than a step of the rounding.
const ANCHOR: usize = 64;

/// A point in units of the number format.
fn units(p: Point) -> [i64; 2] {
    [number::units(p.x), number::units(p.y)]
}

/// Writes a command with two numbers to the beginning of `text` and says how many bytes it took.
#[inline]
fn put_pair(command: u8, [x, y]: [i64; 2], text: &mut [u8]) -> usize {
    text[0] = command;
    let mut at = 1 + number::put(x, &mut text[1..]);
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

/// Writes a move to the first point and steps to the others. Each step is taken from where the text has arrived, in
/// whole units, so that rounding does not add up.
fn write_points(mut points: impl Iterator<Item = Point>, text: &mut Vec<u8>) {
    let Some(first) = points.next() else { return };
    let mut command = [0; COMMAND];
    let mut here = units(first);
    let length = put_pair(b'M', here, &mut command);
    text.extend_from_slice(&command[..length]);
    let mut steps = 0;
    for p in points {
        let there = units(p);
        let step = [there[0] - here[0], there[1] - here[1]];
        if step == [0, 0] && steps > 0 {
            continue;
        }
        steps += 1;
        let length =
            if steps % ANCHOR == 0 { put_pair(b'L', there, &mut command) } else { put_step(step, &mut command) };
        text.extend_from_slice(&command[..length]);
        here = there;
    }
}
