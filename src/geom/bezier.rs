//! Cubic Bézier curves: places and directions on them, parts of them, and lines that stand for them.
//!
//! A curve's parameter runs from 0 to 1. Everything is plain arithmetic without trigonometry, so that every machine gets
//! the same bits.

use super::{Length, Point, Rect, Vec2};

/// The most lines that stand for one curve; reached by curves of many metres.
const MOST_LINES: f64 = 16_384.0;

/// A cubic Bézier curve: where it starts, two control points, where it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic(pub [Point; 4]);

impl Cubic {
    /// A straight line, run through evenly.
    #[must_use]
    pub fn line(a: Point, b: Point) -> Self {
        Self([a, a.lerp(b, 1.0 / 3.0), b.lerp(a, 1.0 / 3.0), b])
    }

    /// The quadratic curve from `a` to `c` with the control point `b`, as a cubic one.
    #[must_use]
    pub fn quadratic(a: Point, b: Point, c: Point) -> Self {
        Self([a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c])
    }

    /// Where it starts.
    #[must_use]
    pub fn start(self) -> Point {
        self.0[0]
    }

    /// Where it ends.
    #[must_use]
    pub fn end(self) -> Point {
        self.0[3]
    }

    /// The place at a parameter (de Casteljau).
    #[must_use]
    pub fn at(self, t: f64) -> Point {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
        ab.lerp(bc, t).lerp(bc.lerp(cd, t), t)
    }

    /// The derivative at a parameter, in millimetres per unit of it.
    #[must_use]
    pub fn velocity(self, t: f64) -> Vec2 {
        let [a, b, c, d] = self.0;
        let s = 1.0 - t;
        ((b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t)) * 3.0
    }

    /// The second derivative at a parameter.
    #[must_use]
    pub fn acceleration(self, t: f64) -> Vec2 {
        let [a, b, c, d] = self.0;
        (((c - b) - (b - a)) * (1.0 - t) + ((d - c) - (c - b)) * t) * 6.0
    }

    /// The unit vector in which it runs at a parameter, also where control points coincide with an end; none where it
    /// is a mere point. At a cusp it is the way on from it.
    #[must_use]
    pub fn tangent(self, t: f64) -> Option<Vec2> {
        let [a, b, c, d] = self.0;
        let ways = if t <= 0.0 {
            [b - a, c - a, d - a]
        } else if t >= 1.0 {
            [d - c, d - b, d - a]
        } else {
            [self.velocity(t), self.acceleration(t), d - a]
        };
        ways.into_iter().find_map(Vec2::unit)
    }

    /// The curve up to a parameter, and from there on.
    #[must_use]
    pub fn split(self, t: f64) -> [Self; 2] {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
        let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
        let middle = abc.lerp(bcd, t);
        [Self([a, ab, abc, middle]), Self([middle, bcd, cd, d])]
    }

    /// The curve between two parameters. What lies at 0 and 1 stays exactly where it is.
    #[must_use]
    pub fn part(self, from: f64, to: f64) -> Self {
        let head = if to < 1.0 { self.split(to)[0] } else { self };
        if from > 0.0 { head.split(if to > 0.0 { from / to.min(1.0) } else { 1.0 })[1] } else { head }
    }

    /// The same curve run through from its end.
    #[must_use]
    pub fn reversed(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([d, c, b, a])
    }

    /// The same with every point moved by a function. Moves that keep lines straight and evenly divided (affine maps)
    /// move the whole curve with its points.
    #[must_use]
    pub fn map(self, f: impl FnMut(Point) -> Point) -> Self {
        Self(self.0.map(f))
    }

    /// A box around its points, and so around it.
    #[must_use]
    pub fn bounds(self) -> Rect {
        self.0.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(p))
    }

    /// How many lines over equal steps of the parameter keep within a tolerance of it: Wang's formula (Goldman, "Pyramid
    /// Algorithms", 2003, section 5.6.3).
    #[must_use]
    pub fn steps(self, tolerance: Length) -> u32 {
        let [a, b, c, d] = self.0;
        let bend = ((c - b) - (b - a)).length_squared().max(((d - c) - (c - b)).length_squared()).sqrt();
        // What is not a number becomes 0, and then one.
        ((0.75 * bend / tolerance.to_mm()).sqrt().ceil().clamp(1.0, MOST_LINES) as u32).max(1)
    }

    /// The ends of lines that keep within a tolerance of it, without its start; the last is its end itself.
    pub fn flatten(self, tolerance: Length) -> impl Iterator<Item = Point> {
        let count = self.steps(tolerance);
        (1..=count).map(move |i| if i == count { self.end() } else { self.at(f64::from(i) / f64::from(count)) })
    }

    /// How long it is, to a relative error below 1e-4, and far below it away from cusps: the mean of chord and control polygon
    /// (Gravesen, "Adaptive subdivision and the length and energy of Bézier curves", 1997) over equal parts of it.
    #[must_use]
    pub fn length(self) -> Length {
        let [a, b, c, d] = self.0;
        let size = a.distance(b) + b.distance(c) + c.distance(d);
        if size <= a.distance(d) {
            return Length::mm(size);
        }
        let count = self.steps(Length::mm(size * 1e-4)).max(4);
        let mut sum = 0.0;
        for i in 0..count {
            let [from, to] = [i, i + 1].map(|i| f64::from(i) / f64::from(count));
            let [a, b, c, d] = self.part(from, to).0;
            sum += 0.5 * (a.distance(d) + a.distance(b) + b.distance(c) + c.distance(d));
        }
        Length::mm(sum)
    }
}

/// The curves of a chain: its first point, and for every curve two control points and its end. Points that are no whole
/// curve are left out.
pub fn cubics(chain: &[Point]) -> impl Iterator<Item = Cubic> {
    chain.windows(4).step_by(3).filter_map(|points| points.try_into().ok().map(Cubic))
}

/// A chain as lines that keep within a tolerance of it: its first point and the ends of all lines. No point follows
/// itself.
#[must_use]
pub fn flatten(chain: &[Point], tolerance: Length) -> Vec<Point> {
    let mut points: Vec<Point> = chain.first().copied().into_iter().collect();
    for p in cubics(chain).flat_map(|cubic| cubic.flatten(tolerance)) {
        if points.last() != Some(&p) {
            points.push(p);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Point> {
        (-50.0..50.0, -50.0..50.0).prop_map(|(x, y)| Point::new(x, y))
    }

    fn cubic() -> impl Strategy<Value = Cubic> {
        [point(), point(), point(), point()].prop_map(Cubic)
    }

    /// The distance of a point to a line between two.
    fn off(p: Point, a: Point, b: Point) -> f64 {
        let way = b - a;
        let t = if way.length_squared() > 0.0 { (p - a).dot(way) / way.length_squared() } else { 0.0 };
        p.distance(a.lerp(b, t.clamp(0.0, 1.0)))
    }

    /// The usual curve for a quarter of a circle.
    const QUARTER: Cubic = {
        const K: f64 = 0.552_284_749_830_793_4;
        Cubic([Point::new(1.0, 0.0), Point::new(1.0, K), Point::new(K, 1.0), Point::new(0.0, 1.0)])
    };

    #[test]
    fn a_quarter_of_a_circle() {
        assert!((QUARTER.length().to_mm() - std::f64::consts::FRAC_PI_2).abs() < 3e-4);
        assert!((QUARTER.at(0.5).x - 0.5f64.sqrt()).abs() < 1e-9);
        assert_eq!(QUARTER.tangent(0.0), Some(Vec2::new(0.0, 1.0)));
        assert_eq!(QUARTER.steps(Length::mm(0.01)), 6);
        assert!((Cubic::line(Point::default(), Point::new(3.0, 4.0)).length().to_mm() - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_tangent_where_points_coincide() {
        let (o, p, q) = (Point::default(), Point::new(2.0, 0.0), Point::new(2.0, 2.0));
        assert_eq!(Cubic([o, o, p, q]).tangent(0.0), Some(Vec2::new(1.0, 0.0)));
        assert_eq!(Cubic([o, p, q, q]).tangent(1.0), Some(Vec2::new(0.0, 1.0)));
        assert_eq!(Cubic([o, o, o, p]).tangent(0.0), Some(Vec2::new(1.0, 0.0)));
        assert_eq!(Cubic([o; 4]).tangent(0.5), None);
        // A cusp at the middle, from which the curve runs down.
        let cusp = Cubic([o, Point::new(1.0, 1.0), Point::new(0.0, 1.0), Point::new(1.0, 0.0)]);
        assert_eq!(cusp.velocity(0.5), Vec2::default());
        assert_eq!(cusp.tangent(0.5), Some(Vec2::new(0.0, -1.0)));
    }

    #[test]
    fn chains_fall_into_curves() {
        let points: Vec<Point> = (0..7).map(|i| Point::new(f64::from(i), f64::from(i % 3))).collect();
        assert_eq!(cubics(&points).map(Cubic::end).collect::<Vec<_>>(), [points[3], points[6]]);
        assert_eq!(cubics(&points[..6]).count(), 1);
        assert_eq!(cubics(&points[..3]).count(), 0);
        assert_eq!(flatten(&[points[0]; 4], Length::mm(0.1)), [points[0]]);
    }

    proptest! {
        #[test]
        fn lines_keep_within_the_tolerance(cubic in cubic(), tolerance in 0.001..1.0f64) {
            let points = flatten(&cubic.0, Length::mm(tolerance));
            prop_assert_eq!(points.last(), Some(&cubic.end()));
            for i in 0..=200 {
                let p = cubic.at(f64::from(i) / 200.0);
                let nearest = points.windows(2).map(|line| off(p, line[0], line[1])).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= tolerance * (1.0 + 1e-9), "{} {}", nearest, tolerance);
            }
        }

        #[test]
        fn parts_lie_on_the_whole(cubic in cubic(), from in 0.0..1.0f64, to in 0.0..1.0f64, t in 0.0..1.0f64) {
            let (from, to) = (from.min(to), from.max(to));
            let part = cubic.part(from, to);
            prop_assert!(part.at(t).distance(cubic.at(from + (to - from) * t)) < 1e-9);
            let [head, tail] = cubic.split(t);
            prop_assert_eq!(head.end(), tail.start());
            let (parts, whole) = ((head.length() + tail.length()).to_mm(), cubic.length().to_mm());
            // Both are lengths to a relative error of 1e-4.
            prop_assert!((parts - whole).abs() < 2e-4 * whole, "{} {}", parts, whole);
            prop_assert_eq!(cubic.part(0.0, 1.0), cubic);
        }

        #[test]
        fn length_is_what_fine_lines_have(cubic in cubic()) {
            let fine: f64 = (0..20_000)
                .map(|i| cubic.at(f64::from(i) / 20_000.0).distance(cubic.at(f64::from(i + 1) / 20_000.0)))
                .sum();
            prop_assert!((cubic.length().to_mm() - fine).abs() < 1e-4 * fine, "{:?} {}", cubic.length(), fine);
        }
    }
}
