//! Angles and directions.

use std::f64::consts::PI;
use std::ops::{Add, Mul, Neg, Sub};

use serde::Serialize;

use super::Vec2;

/// An angle in radians, from +x towards +y (clockwise on the page).
///
/// As the direction of a stroke it is read on the real projective line: a stroke at 0 and one at pi look alike.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default, Serialize)]
#[serde(transparent)]
pub struct Angle(f64);

/// How layers are turned against their tile, in eighths of a turn.
const LAYER_TURNS: [f64; 4] = [0.0, 2.0, 1.0, 3.0];

impl Angle {
    /// Along +x.
    pub const ZERO: Self = Self(0.0);
    /// A quarter of a turn.
    pub const RIGHT: Self = Self(PI / 2.0);

    /// From radians.
    #[must_use]
    pub const fn radians(value: f64) -> Self {
        Self(value)
    }

    /// From degrees.
    #[must_use]
    pub fn degrees(value: f64) -> Self {
        Self(value * (PI / 180.0))
    }

    /// In radians.
    #[must_use]
    pub const fn to_radians(self) -> f64 {
        self.0
    }

    /// The same direction in [0, pi).
    #[must_use]
    pub fn direction(self) -> Self {
        let reduced = self.0.rem_euclid(PI);
        // rem_euclid of a tiny negative number rounds to pi itself.
        Self(if reduced < PI { reduced } else { 0.0 })
    }

    /// The distance of two directions on the real projective line, in [0, pi/2].
    #[must_use]
    pub fn rp1_distance(self, other: Self) -> Self {
        let difference = (self.0 - other.0).abs() % PI;
        Self(difference.min(PI - difference))
    }

    /// The least RP1 distance between any direction of a tile of so many layers turned by this angle and any of a tile
    /// turned by the other: layers are turned by 0, 90, 45 and 135 degrees against their tile. None where a tile has no
    /// layer and so no direction; what is beyond four layers is not looked at.
    #[must_use]
    pub fn layered_distance(self, layers: u8, other: Self, other_layers: u8) -> Option<Self> {
        let turns = |layers: u8| LAYER_TURNS.into_iter().take(usize::from(layers)).map(|turn| turn * (PI / 4.0));
        let pairs = turns(layers).flat_map(|a| turns(other_layers).map(move |b| (a, b)));
        pairs.map(|(a, b)| Self(self.0 + a).rp1_distance(Self(other.0 + b))).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Sine and cosine, the same on every machine.
    #[must_use]
    pub fn sin_cos(self) -> (f64, f64) {
        libm::sincos(self.0)
    }

    /// The unit vector in this direction.
    #[must_use]
    pub fn unit(self) -> Vec2 {
        let (sin, cos) = self.sin_cos();
        Vec2::new(cos, sin)
    }

    /// The angle of a vector, in (-pi, pi].
    #[must_use]
    pub fn of(v: Vec2) -> Self {
        Self(libm::atan2(v.y, v.x))
    }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Angle {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul<f64> for Angle {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}
