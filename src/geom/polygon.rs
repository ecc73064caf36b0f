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

/// Whether a ring holds a point, by the even-odd rule. Looks at every side; a point on the outline may count either way.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(corners: &[[f64; 2]]) -> Vec<Point> {
        corners.iter().map(|&[x, y]| Point::new(x, y)).collect()
    }

    #[test]
    fn areas_are_positive_clockwise_on_the_page() {
        let square = ring(&[[10.0, 10.0], [14.0, 10.0], [14.0, 13.0], [10.0, 13.0]]);
        assert_eq!(ring_area(&square), 12.0);
        let reversed: Vec<Point> = square.iter().rev().copied().collect();
        assert_eq!(ring_area(&reversed), -12.0);
        let hole = ring(&[[11.0, 11.0], [11.0, 12.0], [12.0, 12.0], [12.0, 11.0]]);
        let polygon = Polygon { outer: square, holes: vec![hole] };
        assert_eq!(polygon.area(), 11.0);
        assert_eq!(polygon.rings().count(), 2);
        assert_eq!(ring_area(&[]), 0.0);
    }

    #[test]
    fn a_ring_holds_what_it_runs_round() {
        let arrow = ring(&[[0.0, 0.0], [4.0, 2.0], [0.0, 4.0], [1.0, 2.0]]);
        let holds = |x: f64, y: f64| ring_contains(&arrow, Point::new(x, y));
        // Level with a corner, too.
        assert!(holds(2.0, 2.0) && holds(1.5, 1.5) && holds(0.3, 0.3));
        assert!(!holds(0.5, 2.0) && !holds(-1.0, 2.0) && !holds(5.0, 2.0) && !holds(0.1, 1.0));
        assert!(!ring_contains(&[], Point::new(0.0, 0.0)));
        assert_eq!(ring_bounds(&arrow), Rect::new(Point::new(0.0, 0.0), Point::new(4.0, 4.0)));
    }
}
