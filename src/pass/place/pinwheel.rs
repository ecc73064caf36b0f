//! The pinwheel tiling of Conway and Radin: right triangles with legs 1 and 2 in infinitely many directions.
//!
//! A triangle is cut into five of its kind, smaller by the square root of five (C. Radin, "The pinwheel tilings of the
//! plane", Annals of Mathematics 139, 1994). Scaled by a power of five, every vertex is a Gaussian integer: each cut
//! divides by 1 + 2i or 1 - 2i, both of which divide 5.
//!
//! Cells do not meet edge to edge, but hypotenuses only meet hypotenuses, and legs meet legs at whole numbers of short
//! legs: a long leg taken as two halves, all sides meet side to side.

use std::ops::{Add, Mul, Neg, Sub};

use crate::diag::Diagnostic;
use crate::geom::Point;
use crate::random::Stream;
use crate::scene::Placement;
use crate::stage::Sites;

use super::Ground;
use super::patch::{Cell, MOST_REACH, Patch};

/// How often the great triangle is cut: its short leg is 5^12 edges long.
const CUTS: u32 = 24;

/// The length of an edge in integer units: 5^(CUTS / 2).
const EDGE: i64 = 244_140_625;

/// The short leg of the great triangle in integer units.
const GREAT: i64 = EDGE * EDGE;

/// The area of a cell in square edges.
const AREA: f64 = 1.0;

/// Cells whose short leg is `edge` millimetres long. The stream chooses which part of the tiling lies on the domain.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, edge: f64) -> Result<Sites, Diagnostic> {
    let mut patch = Patch::new(placement, ground, edge, AREA)?;
    let origin = origin(&mut ground.stream("pinwheel"));
    let great = Triangle { right: -origin, short: Gauss { x: GREAT, y: 0 }, is_clockwise: true, cuts: CUTS };
    let mut stack = vec![great];
    while let Some(triangle) = stack.pop() {
        let Triangle { right, short, cuts, .. } = triangle;
        let far = triangle.long() * 2;
        let corners = [right, right + short, right + far].map(local);
        if !patch.comes_near(&corners, 0.0) {
            continue;
        }
        if cuts > 0 {
            stack.extend(triangle.cut());
            continue;
        }
        let [c, b, a] = corners;
        let clockwise = if triangle.is_clockwise { [c, b, a] } else { [c, a, b] };
        // Doubled, the middles are exact.
        let half = |doubled: Gauss| Point::new(local(doubled).x / 2.0, local(doubled).y / 2.0);
        let twice = right * 2;
        let sides = [twice + short, twice + triangle.long(), twice + triangle.long() * 3, twice + short + far];
        let third = local(right * 3 + short + far);
        let site = Point::new(third.x / 3.0, third.y / 3.0);
        patch.offer(&Cell { corners: &clockwise, site, sides: &sides.map(half) });
    }
    Ok(patch.finish())
}

/// A random point deep enough in the great triangle for the greatest patch round it.
fn origin(stream: &mut Stream) -> Gauss {
    // The inscribed circle has its middle as far from both legs as its radius.
    let radius = (3.0 - 5f64.sqrt()) / 2.0 * GREAT as f64;
    let free = (radius - MOST_REACH * EDGE as f64) * std::f64::consts::FRAC_1_SQRT_2;
    let [x, y] = stream.signed_pair().map(|part| (radius + part * free) as i64);
    Gauss { x, y }
}

/// A Gaussian integer: a place or a way in units of which [`EDGE`] make an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Gauss {
    x: i64,
    y: i64,
}

impl Gauss {
    /// Turned by a quarter from +x towards +y.
    fn turned(self) -> Self {
        Self { x: -self.y, y: self.x }
    }
}

impl Add for Gauss {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl Sub for Gauss {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Gauss {
    type Output = Self;
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}

impl Mul<i64> for Gauss {
    type Output = Self;
    fn mul(self, factor: i64) -> Self {
        Self { x: self.x * factor, y: self.y * factor }
    }
}

/// A place in edges.
fn local(p: Gauss) -> Point {
    Point::new(p.x as f64 / EDGE as f64, p.y as f64 / EDGE as f64)
}

/// A triangle of the tiling or one that is still to be cut.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    /// The corner with the right angle.
    right: Gauss,
    /// The way from there along the short leg.
    short: Gauss,
    /// Whether the long leg lies clockwise of the short one on the page.
    is_clockwise: bool,
    /// How often it is still to be cut.
    cuts: u32,
}

impl Triangle {
    /// The way along half of the long leg.
    fn long(&self) -> Gauss {
        if self.is_clockwise { self.short.turned() } else { -self.short.turned() }
    }

    /// The five triangles it consists of.
    ///
    /// The height falls on the hypotenuse at a fifth of its length; beyond it lie four equal triangles, of which two make
    /// a rectangle at the height's foot.
    fn cut(&self) -> [Self; 5] {
        let Self { right, short, is_clockwise, .. } = *self;
        let cuts = self.cuts - 1;
        // Along the hypotenuse to the end of the short leg, and from the height's foot towards the right angle.
        let along = short - self.long() * 2;
        let along = Gauss { x: along.x / 5, y: along.y / 5 };
        let up = if is_clockwise { -along.turned() } else { along.turned() };
        let foot = right + short - along;
        let middle = foot + up;
        let corner = foot - along * 2;
        let part = |right: Gauss, short: Gauss, keeps: Keeps| Self {
            right,
            short,
            is_clockwise: is_clockwise == (keeps == Keeps::Hand),
            cuts,
        };
        [
            part(foot, along, Keeps::Nothing),
            part(corner, up, Keeps::Nothing),
            part(corner, up, Keeps::Hand),
            part(middle, -up, Keeps::Hand),
            part(middle, up, Keeps::Nothing),
        ]
    }
}

/// Whether a part is a mirror image of the whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keeps {
    Hand,
    Nothing,
}
