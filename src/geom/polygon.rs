//! Polygons as rings of points; a ring closes itself and does not repeat its first point.

use serde::Serialize;

use super::{Point, Rect};

/// An area with one outer ring and any number of holes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Polygon {
    /// The outline.
    pub outer: Vec<Point>,
    /// What is cut out of it.
    pub holes: Vec<Vec<Point>>,
}

impl Polygon {
    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Point>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// The area in square millimetres.
    #[must_use]
    pub fn area(&self) -> f64 {
        ring_area(&self.outer).abs() - self.holes.iter().map(|hole| ring_area(hole).abs()).sum::<f64>()
    }
}

/// The signed area of a ring in square millimetres; positive where it runs clockwise on the page.
#[must_use]
pub fn ring_area(ring: &[Point]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    // Measured from a corner, so that rings far from the origin lose no digits.
    ring.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum::<f64>() / 2.0
}

/// The least box around a ring.
#[must_use]
pub fn ring_bounds(ring: &[Point]) -> Rect {
    ring.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(p))
}

/// Whether a ring holds a point, by the even-odd rule.
#[must_use]
pub fn ring_contains(ring: &[Point], p: Point) -> bool {
    let Some(&last) = ring.last() else { return false };
    let mut inside = false;
    let mut a = last;
    for &b in ring {
        if (a.y <= p.y) != (b.y <= p.y) {
            let side = (b - a).cross(p - a);
            if (side > 0.0) == (b.y > a.y) {
                inside = !inside;
            }
        }
        a = b;
    }
    inside
}
