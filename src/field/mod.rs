//! Fields: values that vary over the page, as trees that can be evaluated anywhere.
//!
//! A field yields a number, a length in millimetres or an angle in radians; lowering has checked which. Points outside
//! an image or beyond a gradient's ends take the nearest value. A value is never NaN, and infinite only where
//! arithmetic overflows.

mod blur;
mod build;
mod direction;
mod evaluate;
mod image;
mod mask;
mod noise;
mod ramp;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::geom::{Length, Point, Rect};
use crate::region::Region;

pub use direction::{Sense, sample_distance};
pub use image::{Channel, Image, ImageError};
pub use mask::{MOST_CORNERS, TooDetailed, mask};
pub use noise::Noise;
pub use ramp::{Ease, Ramp, Steps, Stop};

/// A value at every point of the page. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Field(Arc<Tree>);

#[derive(Debug)]
struct Tree {
    node: Node,
    depth: u32,
    cost: u64,
}

/// How a field's value is found.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Node {
    /// The same everywhere.
    Constant(f64),
    /// The point's place to the right, in units of so many millimetres.
    X(Length),
    /// The point's place downwards, in units of so many millimetres.
    Y(Length),
    /// From `start` at one point to `end` at another, and clamped beyond them.
    Linear {
        /// Where it is `start`.
        from: Point,
        /// Where it is `end`.
        to: Point,
        /// The first value.
        start: f64,
        /// The last value.
        end: f64,
    },
    /// From `start` in the centre to `end` at the radius, and clamped beyond it.
    Radial {
        /// The centre.
        centre: Point,
        /// Greater than zero.
        radius: Length,
        /// The value in the centre.
        start: f64,
        /// The value at the radius.
        end: f64,
    },
    /// Smooth noise in [0, 1].
    Noise(Noise),
    /// The brightness of an image, 0 black to 1 white, in linear light.
    Image {
        /// The samples.
        image: Arc<Image>,
        /// Where the image lies on the page.
        place: Rect,
    },
    /// The distance to a region's outline in millimetres, positive inside.
    Distance(Region),
    /// The value of a ramp at the share of the way that a field gives.
    Ramp(Ramp, Field),
    /// The value of the band that a field's value falls into.
    Steps(Steps, Field),
    /// The direction in which a field changes, or does not change, in [0, pi).
    Direction {
        /// The field that is looked at.
        of: Field,
        /// The radius of the window that directions are averaged over, greater than zero.
        scale: Length,
        /// Which of the two.
        sense: Sense,
    },
    /// The direction of a region's outline at its nearest point, in [0, pi); 0 for the empty region.
    Tangent(Region),
    /// A function of one field.
    Unary(Function, Field),
    /// A function of two fields.
    Binary(Operator, Field, Field),
    /// A function of three fields.
    Ternary(Blender, Field, Field, Field),
    /// Where the first is not zero the second, else the third.
    Select(Field, Field, Field),
}

/// Functions of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Function {
    /// `-a`
    Negate,
    /// 1 where a is 0, else 0.
    Not,
    /// Without its sign.
    Abs,
    /// Of an angle in radians.
    Sin,
    /// Of an angle in radians.
    Cos,
    /// Of an angle in radians.
    Tan,
    /// The angle with this sine, in radians; of the nearest of -1 and 1 where there is none.
    Asin,
    /// The angle with this cosine, in radians; of the nearest of -1 and 1 where there is none.
    Acos,
    /// The angle with this tangent, in radians.
    Atan,
    /// Square root; 0 of what is negative.
    Sqrt,
    /// e to the power of a.
    Exp,
    /// Natural logarithm; minus infinity of what is not above 0.
    Ln,
    /// The greatest whole number not above.
    Floor,
    /// The least whole number not below.
    Ceil,
    /// The nearest whole number, halves up.
    Round,
    /// -1, 0 or 1.
    Sign,
    /// L* / 100 of a linear luminance in [0, 1] (CIE 1976).
    Lightness,
}

/// Functions of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Operator {
    /// `a + b`
    Add,
    /// `a - b`
    Subtract,
    /// `a * b`
    Multiply,
    /// `a / b`; 0 where b is 0.
    Divide,
    /// The remainder with the sign of b; 0 where b is 0.
    Remainder,
    /// `a ^ b`; 0 where there is no real power.
    Power,
    /// The smaller.
    Min,
    /// The greater.
    Max,
    /// The angle of the vector (b, a), in radians.
    Atan2,
    /// 1 where it holds, else 0.
    Less,
    /// 1 where it holds, else 0.
    LessEqual,
    /// 1 where it holds, else 0.
    Equal,
    /// 1 where neither is 0, else 0.
    And,
    /// 1 where not both are 0, else 0.
    Or,
}

/// Functions of three values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Blender {
    /// a, but not below b and not above c.
    Clamp,
    /// From a to b by the share c, which may lie outside [0, 1].
    Mix,
    /// 0 where c is at a or before it, 1 at b or beyond, smooth in between; a step where a is b.
    Smoothstep,
}

impl Field {
    /// Its tree.
    #[must_use]
    pub fn node(&self) -> &Node {
        &self.0.node
    }

    /// The length of the longest way down the tree. Evaluating and dropping a field need stack in proportion to it, so
    /// whoever builds fields from a scene's text bounds it.
    #[must_use]
    pub fn depth(&self) -> u32 {
        self.0.depth
    }

    /// How many nodes are visited to find a value. Shared parts count wherever they stand, so doubling a field over and
    /// over makes this grow without its text growing; whoever builds fields from a scene's text bounds it.
    #[must_use]
    pub fn cost(&self) -> u64 {
        self.0.cost
    }
}

impl Serialize for Field {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.node().serialize(serializer)
    }
}
