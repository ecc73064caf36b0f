//! What of a curve or a straight piece lies in a convex polygon.
//!
//! A hull is a convex ring seen from a frame. A chain of n cubic Béziers has a parameter from 0 to n: its whole part counts
//! the curves, its fraction is the parameter of one. Along a half-plane's normal a Bézier is a Bézier of numbers, whose
//! zeros are found to rounding, so that nothing is flattened.

use super::bezier::Cubic;
use super::clip::{Frame, HalfPlane, TOLERANCE};
use super::{Point, Rect};

/// Halvings in the search for zeros that lie close together; nearer ones count as none.
const DEPTH: u32 = 24;

/// Rounds in the search for one zero. Each at least halves the range.
const ROUNDS: u32 = 60;

/// How near a zero is found, in a curve's parameter.
const ZERO: f64 = 1e-12;

/// The search for a zero begins no nearer to either end than this: a curve may end on the outline and cross it elsewhere, and
/// at such an end rounding decides the sign.
const AWAY: f64 = 1e-6;

/// A convex polygon in a frame's coordinates.
#[derive(Debug, Clone, Default)]
pub struct Hull {
    corners: Vec<Point>,
    planes: Vec<HalfPlane>,
    bounds: Option<Rect>,
    /// Zeros along the curve at hand.
    zeros: Vec<f64>,
}

impl Hull {
    /// Takes the place of another polygon, keeping the memory. The ring runs clockwise on the page.
    pub fn set(&mut self, ring: &[Point], frame: &Frame) {
        self.corners.clear();
        self.planes.clear();
        self.corners.extend(ring.iter().map(|&corner| frame.local(corner)));
        self.bounds = None;
        let Some(&last) = self.corners.last() else { return };
        self.bounds = Some(self.corners.iter().fold(Rect::EMPTY, |bounds, &corner| bounds.including(corner)));
        let mut start = last;
        for &end in &self.corners {
            self.planes.extend(HalfPlane::inside(start, end));
            start = end;
        }
    }

    /// The corners in the frame.
    #[must_use]
    pub fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// The box around the polygon; none where it has no corners.
    #[must_use]
    pub const fn bounds(&self) -> Option<Rect> {
        self.bounds
    }

    /// Whether a box may share a point with the polygon.
    #[must_use]
    pub fn may_meet(&self, area: &Rect) -> bool {
        self.bounds.is_some_and(|bounds| bounds.touches(area))
    }

    /// How far along the frame the polygon reaches between two places across it.
    #[must_use]
    pub fn along(&self, across: (f64, f64)) -> Option<(f64, f64)> {
        self.reach(across, |p| (p.y, p.x))
    }

    /// How far across the frame the polygon reaches between two places along it.
    #[must_use]
    pub fn across(&self, along: (f64, f64)) -> Option<(f64, f64)> {
        self.reach(along, |p| (p.x, p.y))
    }

    fn reach(&self, (low, high): (f64, f64), axes: impl Fn(Point) -> (f64, f64)) -> Option<(f64, f64)> {
        let mut reach = (f64::INFINITY, f64::NEG_INFINITY);
        let mut add = |v: f64| reach = (reach.0.min(v), reach.1.max(v));
        let (mut at, mut value) = axes(*self.corners.last()?);
        for &corner in &self.corners {
            let (next, other) = axes(corner);
            for limit in [low, high] {
                if (at < limit) != (next < limit) {
                    add(value + (other - value) * ((limit - at) / (next - at)));
                }
            }
            if (low..=high).contains(&next) {
                add(other);
            }
            (at, value) = (next, other);
        }
        (reach.0 < reach.1).then_some(reach)
    }

    /// The part of a straight piece in the polygon, as shares of the way; the outline counts.
    #[must_use]
    pub fn line(&self, a: Point, b: Point) -> Option<(f64, f64)> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for plane in &self.planes {
            let (start, end) = (plane.beyond(a), plane.beyond(b));
            match (start > TOLERANCE, end > TOLERANCE) {
                (true, true) => return None,
                (true, false) => from = from.max(start / (start - end)),
                (false, true) => to = to.min(start / (start - end)),
                (false, false) => {}
            }
        }
        (from < to && !self.planes.is_empty()).then_some((from, to))
    }

    /// Appends the ranges of curve `number` of a chain that lie in the polygon, ascending; one that goes on where the last
    /// of the list ends is joined to it.
    pub fn cut(&mut self, cubic: &Cubic, number: usize, out: &mut Vec<(f64, f64)>) {
        if self.planes.is_empty() {
            return;
        }
        let first = number as f64;
        let mut add = |from: f64, to: f64| match out.last_mut() {
            Some(last) if last.1 == first + from => last.1 = first + to,
            _ => out.push((first + from, first + to)),
        };
        self.zeros.clear();
        let mut crossed = 0;
        let mut starts_in = true;
        for plane in &self.planes {
            let beyond = cubic.0.map(|p| plane.beyond(p));
            if beyond.iter().all(|&b| b <= TOLERANCE) {
                continue;
            }
            if beyond.iter().all(|&b| b > TOLERANCE) {
                return;
            }
            crossed += 1;
            // As the search for zeros sees it.
            starts_in = beyond[0] < 0.0;
            zeros(beyond, &mut self.zeros);
        }
        match (crossed, self.zeros.as_slice()) {
            (0, _) => return add(0.0, 1.0),
            // Across one side and once, as curves mostly do.
            (1, &[zero]) => return if starts_in { add(0.0, zero) } else { add(zero, 1.0) },
            _ => {}
        }
        let is_in = |t: f64| {
            let p = cubic.at(t);
            self.planes.iter().all(|plane| plane.beyond(p) <= TOLERANCE)
        };
        self.zeros.push(1.0);
        self.zeros.sort_unstable_by(f64::total_cmp);
        let mut from = 0.0;
        for &to in &self.zeros {
            if to > from {
                if is_in((from + to) / 2.0) {
                    add(from, to);
                }
                from = to;
            }
        }
    }
}

/// Appends the zeros between 0 and 1 of a Bézier of numbers. It has at most as many as its coefficients change sign: where
/// they do once it is looked for, where more often the curve is halved.
fn zeros(coefficients: [f64; 4], out: &mut Vec<f64>) {
    let mut open = [([0.0; 4], 0.0, 0.0, 0); DEPTH as usize + 2];
    open[0] = (coefficients, 0.0, 1.0, 0);
    let mut count = 1;
    while count > 0 {
        count -= 1;
        let (c, from, to, depth) = open[count];
        match changes(&c) {
            0 => {}
            1 => out.push(from + (to - from) * zero(&c)),
            _ if depth < DEPTH => {
                let [left, right] = halves(&c);
                let middle = (from + to) / 2.0;
                open[count] = (right, middle, to, depth + 1);
                open[count + 1] = (left, from, middle, depth + 1);
                count += 2;
            }
            _ => {}
        }
    }
}

/// How often numbers change their sign; zero counts as positive.
fn changes(c: &[f64; 4]) -> usize {
    c.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count()
}

fn halves(c: &[f64; 4]) -> [[f64; 4]; 2] {
    let mean = |a: f64, b: f64| (a + b) / 2.0;
    let (ab, bc, cd) = (mean(c[0], c[1]), mean(c[1], c[2]), mean(c[2], c[3]));
    let (abc, bcd) = (mean(ab, bc), mean(bc, cd));
    let middle = mean(abc, bcd);
    [[c[0], ab, abc, middle], [middle, bcd, cd, c[3]]]
}

/// The one zero of a Bézier of numbers whose coefficients change sign once: Newton's steps, and halvings where they leave
/// the range.
fn zero(&[a, b, c, d]: &[f64; 4]) -> f64 {
    // In powers of the parameter.
    let (linear, square, cube) = (3.0 * (b - a), 3.0 * ((c - b) - (b - a)), (d - a) - 3.0 * (c - b));
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = (a / (a - d)).clamp(AWAY, 1.0 - AWAY);
    for _ in 0..ROUNDS {
        let value = a + t * (linear + t * (square + t * cube));
        if (value < 0.0) == (a < 0.0) {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / (linear + t * (2.0 * square + t * 3.0 * cube));
        let next = if newton > low && newton < high { newton } else { (low + high) / 2.0 };
        if (next - t).abs() <= ZERO {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::Vec2;
    use crate::geom::clip::convex_clearance;

    const PAGE: Frame = Frame::new(Point::new(0.0, 0.0), Vec2::new(1.0, 0.0));

    fn hexagon() -> Vec<Point> {
        [(2.0, 0.0), (1.0, 1.7), (-1.0, 1.7), (-2.0, 0.0), (-1.0, -1.7), (1.0, -1.7)]
            .map(|(x, y)| Point::new(x, y))
            .to_vec()
    }

    fn hull(ring: &[Point]) -> Hull {
        let mut hull = Hull::default();
        hull.set(ring, &PAGE);
        hull
    }

    #[test]
    fn a_polygon_reaches_between_its_edges_and_corners() {
        let hull = hull(&hexagon());
        assert_eq!(hull.along((-0.1, 0.1)), Some((-2.0, 2.0)));
        let (low, high) = hull.along((0.85, 3.0)).unwrap();
        assert!((low + 1.5).abs() < 1e-12 && (high - 1.5).abs() < 1e-12);
        assert_eq!(hull.across((-0.5, 0.5)), Some((-1.7, 1.7)));
        assert_eq!(hull.along((1.8, 3.0)), None);
    }

    #[test]
    fn a_straight_piece_is_cut() {
        let hull = hull(&hexagon());
        assert_eq!(hull.line(Point::new(-4.0, 0.0), Point::new(4.0, 0.0)), Some((0.25, 0.75)));
        assert_eq!(hull.line(Point::new(-4.0, 3.0), Point::new(4.0, 3.0)), None);
        assert_eq!(Hull::default().line(Point::new(0.0, 0.0), Point::new(1.0, 0.0)), None);
    }

    #[test]
    fn a_curve_may_start_on_the_outline() {
        let mut hull = hull(&hexagon());
        for (start, kept) in
            [(-2.0, (0.0, 0.4)), (-2.0 + 1e-10, (0.0, 0.4)), (-2.0 - 1e-10, (0.0, 0.4)), (-2.5, (0.05, 0.45))]
        {
            let mut out = Vec::new();
            hull.cut(&Cubic::line(Point::new(start, 0.0), Point::new(start + 10.0, 0.0)), 0, &mut out);
            assert_eq!(out.len(), 1, "{start}: {out:?}");
            assert!((out[0].0 - kept.0).abs() < 1e-9 && (out[0].1 - kept.1).abs() < 1e-9, "{start}: {out:?}");
            // The same into it and to its end there.
            out.clear();
            hull.cut(&Cubic::line(Point::new(start, 0.0), Point::new(0.0, 0.0)), 0, &mut out);
            assert!(out.len() == 1 && out[0].1 == 1.0 && out[0].0 < 0.3, "{start}: {out:?}");
        }
    }

    #[test]
    fn a_curve_that_swings_about_a_side_is_cut_in_its_middle() {
        // Both ends lie on the side y = 1.7, but for rounding; the first half swings out and the second in, or turned round.
        let rounding = [-3e-16, -1e-16, 0.0, 1e-16, 3e-16];
        for (from, to) in rounding.iter().flat_map(|from| rounding.map(|to| (*from, to))) {
            for (swing, kept) in [(0.4, (0.5, 1.0)), (-0.4, (0.0, 0.5))] {
                let points = [(-0.3, from), (-0.1, swing), (0.1, -swing), (0.3, to)];
                let mut out = Vec::new();
                let cubic = Cubic(points.map(|(x, y)| Point::new(x, y)));
                let planes = vec![HalfPlane { normal: Vec2::new(0.0, 1.0), offset: 0.0 }];
                Hull { planes, ..hull(&hexagon()) }.cut(&cubic, 0, &mut out);
                out.retain(|(from, to)| to - from > 1e-9);
                assert_eq!(out.len(), 1, "{from} {to}: {out:?}");
                assert!((out[0].0 - kept.0).abs() < 1e-9 && (out[0].1 - kept.1).abs() < 1e-9, "{from} {to}: {out:?}");
            }
        }
    }

    #[test]
    fn ranges_go_on_from_curve_to_curve() {
        let mut hull = hull(&hexagon());
        let mut out = Vec::new();
        let (a, b, c) = (Point::new(-4.0, 0.0), Point::new(0.0, 0.0), Point::new(4.0, 0.0));
        hull.cut(&Cubic::line(a, b), 0, &mut out);
        hull.cut(&Cubic::line(b, c), 1, &mut out);
        assert_eq!(out.len(), 1);
        assert!((out[0].0 - 0.5).abs() < 1e-9 && (out[0].1 - 1.5).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn what_is_kept_lies_inside(points in [[-4.0..4.0f64, -4.0..4.0f64], [-4.0..4.0, -4.0..4.0], [-4.0..4.0, -4.0..4.0], [-4.0..4.0, -4.0..4.0]]) {
            let cubic = Cubic(points.map(|[x, y]| Point::new(x, y)));
            let mut out = Vec::new();
            hull(&hexagon()).cut(&cubic, 0, &mut out);
            prop_assert!(out.windows(2).all(|pair| pair[0].1 < pair[1].0));
            for i in 0..=500 {
                let t = f64::from(i) / 500.0;
                let clearance = convex_clearance(&hexagon(), cubic.at(t));
                let kept = out.iter().any(|&(from, to)| from <= t && t <= to);
                prop_assert!(clearance.abs() < 1e-6 || kept == (clearance > 0.0), "{} {}", t, clearance);
            }
        }
    }
}
