//! The direction in which a field changes, from the structure tensor of a window (Förstner and Gülch, "A fast operator
//! for detection and precise location of distinct points, corners and centres of circular features", 1987).
//!
//! Gradients are averaged as tensors, not as vectors: on the two sides of a dark line they point against each other
//! and still have one direction. Derivatives are Scharr's, whose directions are true to a fraction of a degree.

use std::f64::consts::FRAC_PI_2;

use super::Field;
use crate::geom::{Angle, Length, Point, Vec2};

/// Samples from the middle of the window to its edge.
const REACH: usize = 4;

/// Samples in a row of the window.
const ROW: usize = 2 * REACH + 1;

/// Weights of the gradients by their distance from the middle: a Gaussian of half the window's radius, `exp(-i^2 / 8)`.
const WEIGHTS: [f64; REACH] = [1.0, 0.882_496_902_584_595_4, 0.606_530_659_712_633_4, 0.324_652_467_358_349_75];

/// How often the window is made twice as wide where nothing in it changes.
const WIDENINGS: u32 = 6;

/// How often the field is evaluated for one direction, at most.
pub(super) const SAMPLES: u64 = (ROW * ROW) as u64 * WIDENINGS as u64;

/// Changes below this share of the values are what rounding leaves, of samples in single precision too.
const ROUNDING: f64 = 1e-6;

/// Differences of the tensor's two strengths below this share of their sum are no direction.
const EVEN: f64 = 1e-6;

/// Where a field changes, seen from its window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sense {
    /// The way in which it changes most: along its gradient.
    Gradient,
    /// The way in which it does not change: along its level lines.
    Level,
}

/// The distance of samples in a window that is `scale` wide each way.
#[must_use]
pub fn sample_distance(scale: Length) -> Length {
    scale * (1.0 / REACH as f64)
}

/// The direction at a point, in [0, pi). Where nothing changes within `scale`, nor in windows up to 32 times as wide, 0.
pub(super) fn direction(field: &Field, p: Point, scale: Length, sense: Sense) -> f64 {
    let mut step = sample_distance(scale).to_mm();
    for _ in 0..WIDENINGS {
        if let Some(gradient) = in_window(field, p, step) {
            let turn = match sense {
                Sense::Gradient => 0.0,
                Sense::Level => FRAC_PI_2,
            };
            return Angle::radians(gradient + turn).direction().to_radians();
        }
        step *= 2.0;
    }
    0.0
}

/// The direction of the gradient in a window of samples `step` apart, if there is one.
fn in_window(field: &Field, p: Point, step: f64) -> Option<f64> {
    let mut samples = [[0.0f64; ROW]; ROW];
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (row, line) in samples.iter_mut().enumerate() {
        for (column, sample) in line.iter_mut().enumerate() {
            let offset = Vec2::new(column as f64 - REACH as f64, row as f64 - REACH as f64);
            *sample = field.at(p + offset * step);
            (least, most) = (least.min(*sample), most.max(*sample));
        }
    }
    let range = most - least;
    if !range.is_finite() || range <= ROUNDING * least.abs().max(most.abs()) {
        return None;
    }
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (row, lines) in samples.windows(3).enumerate() {
        for column in 0..ROW - 2 {
            // In shares of the range, so that no square overflows or vanishes.
            let at = |i: usize, j: usize| (lines[i][column + j] - least) / range;
            let x = 3.0 * (at(0, 2) - at(0, 0)) + 10.0 * (at(1, 2) - at(1, 0)) + 3.0 * (at(2, 2) - at(2, 0));
            let y = 3.0 * (at(2, 0) - at(0, 0)) + 10.0 * (at(2, 1) - at(0, 1)) + 3.0 * (at(2, 2) - at(0, 2));
            let weight = weight(row) * weight(column);
            xx += weight * x * x;
            yy += weight * y * y;
            xy += weight * x * y;
        }
    }
    let (difference, twice) = (xx - yy, 2.0 * xy);
    let strength = (difference * difference + twice * twice).sqrt();
    (strength > EVEN * (xx + yy)).then(|| libm::atan2(twice, difference) / 2.0)
}

/// The weight of the gradients in a row or column of them.
fn weight(line: usize) -> f64 {
    WEIGHTS[line.abs_diff(REACH - 1)]
}
