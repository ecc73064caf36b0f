//! Curves as lines: pieces of curves in, points within a tolerance of them out.

use std::f64::consts::TAU;

use super::FLATTENING;
use crate::geom::{Angle, Length, Point, Vec2};

/// The most lines that stand for one curve; reached by curves of many metres.
const MOST_LINES: f64 = 16_384.0;

/// The corners of a polygon that stands for an ellipse; none where a radius is not above zero.
pub(super) fn ellipse(centre: Point, rx: Length, ry: Length) -> Vec<Point> {
    let (rx, ry) = (rx.to_mm(), ry.to_mm());
    if !(rx > 0.0 && ry > 0.0) {
        return Vec::new();
    }
    // A multiple of four, so that the extreme points are corners and the bounds exact.
    let count = (lines_of_arc(rx.max(ry), TAU) / 4.0).ceil() as usize * 4;
    (0..count)
        .map(|i| {
            let (sin, cos) = corner_sin_cos(i, count);
            centre + Vec2::new(rx * cos, ry * sin)
        })
        .collect()
}

/// Sine and cosine of a share of the full turn; exact at the quarters.
fn corner_sin_cos(i: usize, count: usize) -> (f64, f64) {
    let quarter = count / 4;
    let (sin, cos) = Angle::radians(TAU * (i % quarter) as f64 / count as f64).sin_cos();
    match i / quarter {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// How many lines stand for an arc: the sagitta of each, r (1 - cos(angle / 2)), is within the tolerance.
fn lines_of_arc(radius: f64, sweep: f64) -> f64 {
    let share = (FLATTENING.to_mm() / radius).min(1.0);
    let step = (2.0 * libm::acos(1.0 - share)).min(TAU / 16.0);
    (sweep.abs() / step).ceil().clamp(1.0, MOST_LINES)
}
