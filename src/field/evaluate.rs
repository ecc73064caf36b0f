//! The values of fields: a tree and a point come in, a number goes out that is never NaN.

use super::{Blender, Field, Function, Node, Operator, direction};
use crate::geom::Point;

/// Below it L* is a straight line (CIE 15:2004, section 8.2.1).
const LIGHTNESS_KNEE: f64 = 216.0 / 24389.0;

/// The slope of that line.
const LIGHTNESS_SLOPE: f64 = 24389.0 / 27.0;

impl Field {
    /// The value at a point. It calls itself as deep as the tree, see [`Field::depth`].
    #[must_use]
    pub fn at(&self, p: Point) -> f64 {
        let value = match self.node() {
            Node::Constant(value) => *value,
            Node::X(unit) => p.x / unit.to_mm(),
            Node::Y(unit) => p.y / unit.to_mm(),
            Node::Linear { from, to, start, end } => {
                let way = *to - *from;
                blend(*start, *end, (p - *from).dot(way) / way.length_squared())
            }
            Node::Radial { centre, radius, start, end } => blend(*start, *end, p.distance(*centre) / radius.to_mm()),
            Node::Noise(noise) => noise.at(p),
            Node::Image { image, place } => image.at(place, p),
            Node::Distance(region) => region.signed_distance(p),
            Node::Ramp(ramp, a) => ramp.at(a.at(p)),
            Node::Steps(steps, a) => steps.apply(a.at(p)),
            Node::Direction { of, scale, sense } => direction::direction(of, p, *scale, *sense),
            Node::Tangent(region) => region.tangent(p).to_radians(),
            Node::Unary(function, a) => function.apply(a.at(p)),
            Node::Binary(operator, a, b) => operator.apply(a.at(p), b.at(p)),
            Node::Ternary(blender, a, b, c) => blender.apply(a.at(p), b.at(p), c.at(p)),
            Node::Select(condition, then, otherwise) => {
                if condition.at(p) == 0.0 {
                    otherwise.at(p)
                } else {
                    then.at(p)
                }
            }
        };
        number(value)
    }
}

/// 0 for what is no number.
fn number(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}

/// From `start` to `end` by a share that is clamped to [0, 1]; where it is no number (the gradient has no length),
/// `start`.
fn blend(start: f64, end: f64, share: f64) -> f64 {
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    // Exact at both ends.
    start * (1.0 - share) + end * share
}

fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { 0.0 }
}

impl Function {
    /// Its value, never NaN.
    #[must_use]
    pub fn apply(self, a: f64) -> f64 {
        number(match self {
            Self::Negate => -a,
            Self::Not => truth(a == 0.0),
            Self::Abs => a.abs(),
            Self::Sin => libm::sin(a),
            Self::Cos => libm::cos(a),
            Self::Tan => libm::tan(a),
            Self::Asin => libm::asin(a.clamp(-1.0, 1.0)),
            Self::Acos => libm::acos(a.clamp(-1.0, 1.0)),
            Self::Atan => libm::atan(a),
            Self::Sqrt => a.max(0.0).sqrt(),
            Self::Exp => libm::exp(a),
            Self::Ln if a > 0.0 => libm::log(a),
            Self::Ln => f64::NEG_INFINITY,
            Self::Floor => a.floor(),
            Self::Ceil => a.ceil(),
            Self::Round => {
                let below = a.floor();
                // Not floor(a + 0.5), whose sum is rounded too.
                if a - below >= 0.5 { below + 1.0 } else { below }
            }
            Self::Sign => truth(a > 0.0) - truth(a < 0.0),
            Self::Lightness => lightness(a),
        })
    }
}

/// L* / 100 of a luminance, which is clamped to [0, 1].
fn lightness(luminance: f64) -> f64 {
    let y = luminance.clamp(0.0, 1.0);
    if y > LIGHTNESS_KNEE { 1.16 * libm::cbrt(y) - 0.16 } else { LIGHTNESS_SLOPE * y / 100.0 }
}

impl Operator {
    /// Its value, never NaN.
    #[must_use]
    pub fn apply(self, a: f64, b: f64) -> f64 {
        number(match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide if b == 0.0 => 0.0,
            Self::Divide => a / b,
            Self::Remainder => remainder(a, b),
            Self::Power => libm::pow(a, b),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Atan2 => libm::atan2(a, b),
            Self::Less => truth(a < b),
            Self::LessEqual => truth(a <= b),
            Self::Equal => truth(a == b),
            Self::And => truth(a != 0.0 && b != 0.0),
            Self::Or => truth(a != 0.0 || b != 0.0),
        })
    }
}

/// The remainder with the sign of `b`; 0 where `b` is 0.
fn remainder(a: f64, b: f64) -> f64 {
    if b == 0.0 {
        return 0.0;
    }
    let rest = a % b;
    if rest != 0.0 && (rest < 0.0) != (b < 0.0) { rest + b } else { rest }
}

impl Blender {
    /// Its value, never NaN.
    #[must_use]
    pub fn apply(self, a: f64, b: f64, c: f64) -> f64 {
        number(match self {
            Self::Clamp => a.max(b).min(c),
            Self::Mix => a * (1.0 - c) + b * c,
            Self::Smoothstep => {
                if a == b {
                    return truth(c >= a);
                }
                let t = number((c - a) / (b - a)).clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            }
        })
    }
}
