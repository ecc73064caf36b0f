//! How fields are made: trees come out, with parts that are the same everywhere worked out already.

use std::sync::Arc;

use super::{Blender, Field, Function, Image, Node, Operator, Ramp, Sense, Steps, Tree, direction};
use crate::geom::{Angle, Length, Point, Rect};
use crate::region::{Region, contained};

impl Field {
    /// From its tree.
    #[must_use]
    pub fn new(node: Node) -> Self {
        let children: [Option<&Self>; 3] = match &node {
            Node::Constant(_)
            | Node::X(_)
            | Node::Y(_)
            | Node::Linear { .. }
            | Node::Radial { .. }
            | Node::Noise(_)
            | Node::Image { .. }
            | Node::Distance(_)
            | Node::Tangent(_) => [None; 3],
            Node::Ramp(_, a) | Node::Steps(_, a) | Node::Direction { of: a, .. } => [Some(a), None, None],
            Node::Unary(_, a) => [Some(a), None, None],
            Node::Binary(_, a, b) => [Some(a), Some(b), None],
            Node::Ternary(_, a, b, c) | Node::Select(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        let children = || children.iter().flatten();
        let depth = children().map(|child| child.depth()).max().unwrap_or(0).saturating_add(1);
        let times = if let Node::Direction { .. } = node { direction::SAMPLES } else { 1 };
        let cost = children().fold(1u64, |cost, child| cost.saturating_add(child.cost().saturating_mul(times)));
        Self(Arc::new(Tree { node, depth, cost }))
    }

    /// The same everywhere.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::new(Node::Constant(value))
    }

    /// The value, if it is the same everywhere.
    #[must_use]
    pub fn as_constant(&self) -> Option<f64> {
        match self.node() {
            Node::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// A function of this field.
    #[must_use]
    pub fn map(self, function: Function) -> Self {
        match self.as_constant() {
            Some(a) => Self::constant(function.apply(a)),
            None => Self::new(Node::Unary(function, self)),
        }
    }

    /// A function of this field and another.
    #[must_use]
    pub fn zip(self, other: Self, operator: Operator) -> Self {
        match (self.as_constant(), other.as_constant()) {
            (Some(a), Some(b)) => Self::constant(operator.apply(a, b)),
            _ => Self::new(Node::Binary(operator, self, other)),
        }
    }

    /// A function of three fields.
    #[must_use]
    pub fn blend(blender: Blender, a: Self, b: Self, c: Self) -> Self {
        match (a.as_constant(), b.as_constant(), c.as_constant()) {
            (Some(a), Some(b), Some(c)) => Self::constant(blender.apply(a, b, c)),
            _ => Self::new(Node::Ternary(blender, a, b, c)),
        }
    }

    /// Where `condition` is not zero `then`, else `otherwise`.
    #[must_use]
    pub fn select(condition: Self, then: Self, otherwise: Self) -> Self {
        match condition.as_constant() {
            Some(0.0) => otherwise,
            Some(_) => then,
            None => Self::new(Node::Select(condition, then, otherwise)),
        }
    }

    /// From `start` at one point to `end` at another, clamped beyond them.
    #[must_use]
    pub fn linear(from: Point, to: Point, start: f64, end: f64) -> Self {
        Self::new(Node::Linear { from, to, start, end })
    }

    /// From `start` where a box begins in a direction to `end` where it ends, clamped beyond: the lines of equal value
    /// that touch the box on either side take the two values.
    #[must_use]
    pub fn linear_across(bounds: Rect, angle: Angle, start: f64, end: f64) -> Self {
        let unit = angle.unit();
        let half = ((bounds.width() * unit.x).abs() + (bounds.height() * unit.y).abs()) / 2.0;
        Self::linear(bounds.centre() - unit * half, bounds.centre() + unit * half, start, end)
    }

    /// From `start` in the centre to `end` at the radius, clamped beyond it.
    #[must_use]
    pub fn radial(centre: Point, radius: Length, start: f64, end: f64) -> Self {
        Self::new(Node::Radial { centre, radius, start, end })
    }

    /// The brightness of an image that is fitted into a box: as large as can be and in its middle.
    #[must_use]
    pub fn image(image: Arc<Image>, fit: Rect) -> Self {
        let place = contained(f64::from(image.width), f64::from(image.height), fit);
        Self::new(Node::Image { image, place })
    }

    /// The distance to a region's outline in millimetres, positive inside.
    #[must_use]
    pub fn distance(region: Region) -> Self {
        Self::new(Node::Distance(region))
    }

    /// The direction of a region's outline at its nearest point.
    #[must_use]
    pub fn tangent(region: Region) -> Self {
        Self::new(Node::Tangent(region))
    }

    /// A ramp over this field, which gives the share of the way.
    #[must_use]
    pub fn ramp(self, ramp: Ramp) -> Self {
        match self.as_constant() {
            Some(share) => Self::constant(ramp.at(share)),
            None => Self::new(Node::Ramp(ramp, self)),
        }
    }

    /// This field in bands.
    #[must_use]
    pub fn steps(self, steps: Steps) -> Self {
        match self.as_constant() {
            Some(value) => Self::constant(steps.apply(value)),
            None => Self::new(Node::Steps(steps, self)),
        }
    }

    /// The direction in which this field changes, or does not.
    #[must_use]
    pub fn direction(self, scale: Length, sense: Sense) -> Self {
        Self::new(Node::Direction { of: self, scale, sense })
    }

    /// The same field of other images: `change` gives each its own for the place it takes. `None` where it does.
    ///
    /// It calls itself as deep as the tree, and visits shared parts wherever they stand.
    pub fn with_images(&self, change: &mut impl FnMut(&Arc<Image>, &Rect) -> Option<Arc<Image>>) -> Option<Self> {
        let mut part = |field: &Self| field.with_images(change);
        let node = match self.node() {
            Node::Constant(_)
            | Node::X(_)
            | Node::Y(_)
            | Node::Linear { .. }
            | Node::Radial { .. }
            | Node::Noise(_)
            | Node::Distance(_)
            | Node::Tangent(_) => return Some(self.clone()),
            Node::Image { image, place } => Node::Image { image: change(image, place)?, place: *place },
            Node::Ramp(ramp, a) => Node::Ramp(ramp.clone(), part(a)?),
            Node::Steps(steps, a) => Node::Steps(steps.clone(), part(a)?),
            Node::Direction { of, scale, sense } => Node::Direction { of: part(of)?, scale: *scale, sense: *sense },
            Node::Unary(function, a) => Node::Unary(*function, part(a)?),
            Node::Binary(operator, a, b) => Node::Binary(*operator, part(a)?, part(b)?),
            Node::Ternary(blender, a, b, c) => Node::Ternary(*blender, part(a)?, part(b)?, part(c)?),
            Node::Select(a, b, c) => Node::Select(part(a)?, part(b)?, part(c)?),
        };
        Some(Self::new(node))
    }
}
