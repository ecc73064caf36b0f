//! The unevenness of a drawn line.

use serde::Serialize;

use crate::geom::{Angle, Length};

/// How far a hand strays from the plain drawing. Every number is the most it strays by; at zero it does not stray.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Hand {
    /// How far a bundle of strokes is turned either way, from 0 to an eighth of a turn.
    pub angle: Angle,
    /// How far a line lies off its place, in steps from line to line, from 0 to 0.5.
    pub spacing: f64,
    /// How much thinner or wider a stroke is than its pen, as a share of it, from 0 to 0.9.
    pub pen: f64,
    /// The share of a stroke's length over which its width runs out, from 0 to 1.
    pub taper: f64,
    /// How far a stroke may run beyond its tile's edge; not negative.
    pub overshoot: Length,
    /// How far a stroke wanders to either side of its line; not negative.
    pub wobble: Length,
}

impl Hand {
    /// A hand that does not stray.
    pub const RULED: Self =
        Self { angle: Angle::ZERO, spacing: 0.0, pen: 0.0, taper: 0.0, overshoot: Length::ZERO, wobble: Length::ZERO };

    /// How far the ink of a stroke of this pen may come beyond its tile: half its width, and what the hand strays by.
    #[must_use]
    pub fn reach(&self, pen: Length) -> Length {
        pen * (0.5 * (1.0 + self.pen)) + self.overshoot + self.wobble
    }

    /// Whether it does something to the ends of strokes.
    #[must_use]
    pub fn has_ends(&self) -> bool {
        self.taper > 0.0 || self.overshoot > Length::ZERO
    }

    /// Whether it draws what a machine would.
    #[must_use]
    pub fn is_ruled(&self) -> bool {
        *self == Self::RULED
    }
}
