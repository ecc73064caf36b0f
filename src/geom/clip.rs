//! Cutting: parallel lines against convex polygons, convex polygons against half-planes, and ranges along a line.
//!
//! Convex rings run clockwise on the page, so that their inside lies where the vector product with an edge is positive.
//! All of it works in millimetres and allocates only to grow buffers that are handed in.

use super::{Point, Vec2};

/// Differences of place below this many millimetres mean nothing: it is far above the rounding of coordinates and far
/// below anything that is drawn.
pub const TOLERANCE: f64 = 1e-9;

/// A frame whose first axis runs along the lines of a hatching.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Where both coordinates are zero.
    pub origin: Point,
    /// The unit vector along the lines.
    pub along: Vec2,
}

impl Frame {
    /// From its origin and the direction of its first axis.
    #[must_use]
    pub const fn new(origin: Point, along: Vec2) -> Self {
        Self { origin, along }
    }

    /// The coordinates of a point: x along the lines, y across them.
    #[must_use]
    pub fn local(&self, p: Point) -> Point {
        let v = p - self.origin;
        Point::new(v.dot(self.along), self.along.cross(v))
    }

    /// The point at these coordinates.
    #[must_use]
    pub fn page(&self, u: f64, v: f64) -> Point {
        self.origin + self.along * u + self.along.turned() * v
    }
}

/// A convex polygon as the lines along a frame see it: where each of them enters and leaves it.
#[derive(Debug, Clone, Default)]
pub struct Profile {
    /// Range of the polygon across the lines.
    across: (f64, f64),
    /// Range of the polygon along the lines.
    along: (f64, f64),
    /// Edges that bound it from below: a place across, the bound there, and how the bound grows.
    lower: Vec<[f64; 3]>,
    /// Edges that bound it from above.
    upper: Vec<[f64; 3]>,
}

impl Profile {
    /// Takes the profile of another polygon, keeping the memory.
    pub fn set(&mut self, ring: &[Point], frame: &Frame) {
        self.lower.clear();
        self.upper.clear();
        self.across = (f64::INFINITY, f64::NEG_INFINITY);
        self.along = self.across;
        let Some(&last) = ring.last() else { return };
        let mut a = frame.local(last);
        for &corner in ring {
            let b = frame.local(corner);
            self.across = (self.across.0.min(b.y), self.across.1.max(b.y));
            self.along = (self.along.0.min(b.x), self.along.1.max(b.x));
            let rise = b.y - a.y;
            // Edges along the lines bound the range across, which is known already.
            if rise.abs() > TOLERANCE {
                let edge = [a.y, a.x, (b.x - a.x) / rise];
                if rise > 0.0 {
                    self.upper.push(edge);
                } else {
                    self.lower.push(edge);
                }
            }
            a = b;
        }
    }

    /// The polygon's range across the lines; the first is above the second where it has no corners.
    #[must_use]
    pub const fn across(&self) -> (f64, f64) {
        self.across
    }

    /// The polygon's range along the lines.
    #[must_use]
    pub const fn along(&self) -> (f64, f64) {
        self.along
    }

    /// Where the line at `v` lies in the polygon. A line along its frame counts as inside.
    #[must_use]
    pub fn span(&self, v: f64) -> Option<(f64, f64)> {
        let (low, high) = (self.across.0 + TOLERANCE, self.across.1 - TOLERANCE);
        // Written so that a polygon without area, whose range is empty, has no line in it.
        if !(low < high && v > low - 2.0 * TOLERANCE && v < high + 2.0 * TOLERANCE) {
            return None;
        }
        let v = v.clamp(low, high);
        let at = |edge: &[f64; 3]| edge[1] + (v - edge[0]) * edge[2];
        let start = self.lower.iter().map(at).fold(f64::NEG_INFINITY, f64::max);
        let end = self.upper.iter().map(at).fold(f64::INFINITY, f64::min);
        (start < end && start.is_finite() && end.is_finite()).then_some((start, end))
    }
}

/// Ranges along a line, ascending and apart from each other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ranges {
    list: Vec<(f64, f64)>,
    spare: Vec<(f64, f64)>,
}

impl Ranges {
    /// Holds one range from now on, or none where its start is not below its end.
    pub fn reset(&mut self, start: f64, end: f64) {
        self.list.clear();
        if start < end {
            self.list.push((start, end));
        }
    }

    /// Holds these ranges from now on, which ascend and lie apart.
    pub fn set(&mut self, ranges: &[(f64, f64)]) {
        self.list.clear();
        self.list.extend_from_slice(ranges);
    }

    /// The ranges.
    #[must_use]
    pub fn as_slice(&self) -> &[(f64, f64)] {
        &self.list
    }

    /// Whether nothing is left.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Takes a range away.
    pub fn subtract(&mut self, start: f64, end: f64) {
        let mut i = 0;
        while let Some(&(a, b)) = self.list.get(i) {
            if a >= end {
                break;
            }
            if b <= start {
                i += 1;
                continue;
            }
            match (a < start, end < b) {
                (true, true) => {
                    self.list[i].1 = start;
                    self.list.insert(i + 1, (end, b));
                    break;
                }
                (true, false) => {
                    self.list[i].1 = start;
                    i += 1;
                }
                (false, true) => {
                    self.list[i].0 = end;
                    break;
                }
                (false, false) => {
                    self.list.remove(i);
                }
            }
        }
    }

    /// Keeps what also lies in one of `others`, which ascend and lie apart.
    pub fn intersect(&mut self, others: &[(f64, f64)]) {
        self.spare.clear();
        let mut first = 0;
        for &(a, b) in &self.list {
            while others.get(first).is_some_and(|other| other.1 <= a) {
                first += 1;
            }
            for &(start, end) in &others[first..] {
                if start >= b {
                    break;
                }
                let (low, high) = (a.max(start), b.min(end));
                if low < high {
                    self.spare.push((low, high));
                }
            }
        }
        std::mem::swap(&mut self.list, &mut self.spare);
    }

    /// Draws every range in by `margin` at both ends.
    pub fn shrink(&mut self, margin: f64) {
        for range in &mut self.list {
            *range = (range.0 + margin, range.1 - margin);
        }
        self.list.retain(|range| range.0 < range.1);
    }
}

/// The points whose product with a unit normal is at most an offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// A unit vector that points out of it.
    pub normal: Vec2,
    /// The border's distance from the origin along the normal, in millimetres.
    pub offset: f64,
}

impl HalfPlane {
    /// What lies nearer to `a` than to `b`; none where they coincide.
    #[must_use]
    pub fn nearer(a: Point, b: Point) -> Option<Self> {
        let way = b - a;
        let length = way.length();
        if length <= TOLERANCE {
            return None;
        }
        let normal = way * (1.0 / length);
        let middle = a.lerp(b, 0.5);
        Some(Self { normal, offset: normal.x * middle.x + normal.y * middle.y })
    }

    /// What lies on the inner side of the edge from `a` to `b` of a clockwise ring; none where they coincide.
    #[must_use]
    pub fn inside(a: Point, b: Point) -> Option<Self> {
        let way = b - a;
        let length = way.length();
        if length <= TOLERANCE {
            return None;
        }
        let normal = Vec2::new(way.y, -way.x) * (1.0 / length);
        Some(Self { normal, offset: normal.x * a.x + normal.y * a.y })
    }

    /// The same with its border moved inwards by so many millimetres.
    #[must_use]
    pub fn inset(self, by: f64) -> Self {
        Self { offset: self.offset - by, ..self }
    }

    /// How far a point lies beyond the border in millimetres; negative inside.
    #[must_use]
    pub fn beyond(&self, p: Point) -> f64 {
        self.normal.x * p.x + self.normal.y * p.y - self.offset
    }
}

/// Cuts a convex ring down to a half-plane (Sutherland and Hodgman 1974). `spare` is overwritten.
pub fn clip_convex(ring: &mut Vec<Point>, half: &HalfPlane, spare: &mut Vec<Point>) {
    let Some(&last) = ring.last() else { return };
    spare.clear();
    let (mut a, mut before) = (last, half.beyond(last));
    for &b in ring.iter() {
        let after = half.beyond(b);
        if (before > 0.0) != (after > 0.0) {
            spare.push(a.lerp(b, before / (before - after)));
        }
        if after <= 0.0 {
            spare.push(b);
        }
        (a, before) = (b, after);
    }
    spare.dedup_by(|b, a| a.distance_squared(*b) <= TOLERANCE * TOLERANCE);
    while spare.len() > 1 && spare[0].distance_squared(spare[spare.len() - 1]) <= TOLERANCE * TOLERANCE {
        spare.pop();
    }
    if spare.len() < 3 {
        spare.clear();
    }
    std::mem::swap(ring, spare);
}

/// The distance of a point from a convex ring's outline in millimetres, positive inside; minus infinity for no ring.
#[must_use]
pub fn convex_clearance(ring: &[Point], p: Point) -> f64 {
    let mut beyond = f64::NEG_INFINITY;
    let mut nearest = f64::INFINITY;
    let Some(&last) = ring.last() else { return f64::NEG_INFINITY };
    let mut a = last;
    for &b in ring {
        let edge = b - a;
        if edge.length_squared() > TOLERANCE * TOLERANCE {
            let outwards = Vec2::new(edge.y, -edge.x);
            beyond = beyond.max((p - a).dot(outwards) / edge.length());
            let t = ((p - a).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(a.lerp(b, t).distance_squared(p));
        }
        a = b;
    }
    if beyond <= 0.0 { -beyond } else { -nearest.sqrt() }
}

/// Whether two convex rings share more than their outlines; by the separating axis theorem, over the edges of both.
#[must_use]
pub fn convex_overlap(a: &[Point], b: &[Point]) -> bool {
    !separates(a, b) && !separates(b, a)
}

/// Whether some edge of `ring` has all of `other` on its outer side.
fn separates(ring: &[Point], other: &[Point]) -> bool {
    let Some(&last) = ring.last() else { return true };
    let mut start = last;
    ring.iter().any(|&end| {
        let half = HalfPlane::inside(start, end);
        start = end;
        half.is_some_and(|half| other.iter().all(|&p| half.beyond(p) >= -TOLERANCE))
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::{Angle, Rect, ring_area};

    fn square(side: f64) -> Vec<Point> {
        Rect::new(Point::new(-side / 2.0, -side / 2.0), Point::new(side / 2.0, side / 2.0)).corners().to_vec()
    }

    /// A convex ring: a square of side 4 cut down by some half-planes that leave its middle.
    fn convex() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec((0.0..7.0, 0.3..2.5), 0..6).prop_map(|cuts| {
            let mut ring = square(4.0);
            for (angle, offset) in cuts {
                let half = HalfPlane { normal: Angle::radians(angle).unit(), offset };
                clip_convex(&mut ring, &half, &mut Vec::new());
            }
            ring
        })
    }

    #[test]
    fn lines_cross_a_square() {
        let mut profile = Profile::default();
        profile.set(&square(2.0), &Frame::new(Point::default(), Vec2::new(1.0, 0.0)));
        assert_eq!(profile.span(0.5), Some((-1.0, 1.0)));
        // The frame itself belongs to the square, what lies beyond does not.
        assert_eq!(profile.span(1.0), Some((-1.0, 1.0)));
        assert_eq!(profile.span(1.0 + 1e-6), None);
        profile.set(&square(2.0), &Frame::new(Point::default(), Angle::degrees(45.0).unit()));
        let (a, b) = profile.span(0.0).unwrap();
        assert!((a + 2f64.sqrt()).abs() < 1e-12 && (b - 2f64.sqrt()).abs() < 1e-12);
        profile.set(&[], &Frame::new(Point::default(), Vec2::new(1.0, 0.0)));
        assert_eq!(profile.span(0.0), None);
    }

    #[test]
    fn clearance_is_the_distance_to_the_outline() {
        let ring = square(2.0);
        assert!((convex_clearance(&ring, Point::new(0.25, 0.0)) - 0.75).abs() < 1e-12);
        assert!((convex_clearance(&ring, Point::new(4.0, 5.0)) + 5.0).abs() < 1e-12);
    }

    #[test]
    fn squares_side_by_side_do_not_overlap() {
        let moved = |x: f64| square(2.0).iter().map(|&p| p + Vec2::new(x, 0.0)).collect::<Vec<_>>();
        assert!(!convex_overlap(&square(2.0), &moved(2.0)));
        assert!(convex_overlap(&square(2.0), &moved(1.999)));
        assert!(!convex_overlap(&square(2.0), &[]));
    }

    proptest! {
        #[test]
        fn a_span_is_what_lies_inside(ring in convex(), angle in 0.0..3.2, u in -3.0..3.0, v in -3.0..3.0) {
            let frame = Frame::new(Point::new(0.1, -0.2), Angle::radians(angle).unit());
            let mut profile = Profile::default();
            profile.set(&ring, &frame);
            let clearance = convex_clearance(&ring, frame.page(u, v));
            let held = profile.span(v).is_some_and(|(a, b)| a <= u && u <= b);
            prop_assume!(clearance.abs() > 1e-6);
            prop_assert_eq!(held, clearance > 0.0);
        }

        #[test]
        fn both_sides_of_a_cut_make_up_the_whole(ring in convex(), angle in 0.0..6.3, offset in -2.0..2.0) {
            let normal = Angle::radians(angle).unit();
            let (mut near, mut far) = (ring.clone(), ring.clone());
            clip_convex(&mut near, &HalfPlane { normal, offset }, &mut Vec::new());
            clip_convex(&mut far, &HalfPlane { normal: -normal, offset: -offset }, &mut Vec::new());
            prop_assert!((ring_area(&near) + ring_area(&far) - ring_area(&ring)).abs() < 1e-9);
        }

        #[test]
        fn ranges_are_sets(
            cuts in prop::collection::vec((0.0..10.0, 0.0..4.0), 0..8),
            kept in prop::collection::vec((0.1..2.0, 0.1..2.0), 0..5),
            probe in 0.0..10.0,
        ) {
            let mut ranges = Ranges::default();
            ranges.reset(1.0, 9.0);
            for &(start, length) in &cuts {
                ranges.subtract(start, start + length);
            }
            let mut end = 0.0;
            let kept: Vec<_> = kept.iter().map(|&(gap, length)| { let a: f64 = end + gap; end = a + length; (a, end) }).collect();
            let hidden = cuts.iter().any(|&(start, length)| start < probe && probe < start + length);
            let expected = (1.0..9.0).contains(&probe) && !hidden;
            let holds = |ranges: &Ranges| ranges.as_slice().iter().any(|&(a, b)| a <= probe && probe < b);
            prop_assert_eq!(holds(&ranges), expected);
            ranges.intersect(&kept);
            prop_assert_eq!(holds(&ranges), expected && kept.iter().any(|&(a, b)| a <= probe && probe < b));
            prop_assert!(ranges.as_slice().windows(2).all(|pair| pair[0].1 <= pair[1].0));
        }
    }
}
