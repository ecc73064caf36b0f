//! Strokes of changing width as outlines: a spine and its widths go in, closed rings of lines and cubic Béziers come out.
//!
//! The sides follow the true offset of the spine within [`TOLERANCE`]. All rings run clockwise on the page, so that the
//! non-zero rule fills what any of them covers. Where the spine has a corner, and where its bends are too tight for sides of
//! that width, round joins are rings of their own.

use crate::geom::bezier::cubics;
use crate::geom::{Cubic, Point, Vec2};

/// How far, in millimetres, a side may stray from where it should be: a tenth of a pixel at 2,500 pixels an inch.
const TOLERANCE: f64 = 0.001;
/// How often a curve is halved to meet it; what is left then is short, and straight sides with round joins stand for it.
const HALVINGS: u32 = 7;
/// The control points of a quarter of a circle, as a share of the radius from its ends.
const QUARTER: f64 = 0.552_284_749_830_793_4;

/// A closed ring; it ends where it starts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ring {
    pub(super) start: Point,
    pub(super) edges: Vec<Edge>,
}

/// A piece of a ring, from where the one before ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Edge {
    Line(Point),
    /// Two control points and the end.
    Curve(Point, Point, Point),
}

impl Edge {
    pub(super) fn end(self) -> Point {
        match self {
            Self::Line(end) | Self::Curve(_, _, end) => end,
        }
    }
}

/// The outline of a stroke: a chain of Béziers and the width at each joint, in millimetres.
pub(super) fn outline(spine: &[Point], widths: &[f64]) -> Vec<Ring> {
    let mut sides = Sides::default();
    let mut before: Option<Vec2> = None;
    for (cubic, width) in cubics(spine).zip(widths.windows(2)) {
        let strip = Strip { cubic, halves: [width[0] / 2.0, width[1] / 2.0] };
        let Some(along) = cubic.tangent(0.0) else { continue };
        if let Some(before) = before {
            sides.join(cubic.start(), strip.halves[0], before, along);
        }
        sides.add(strip);
        before = cubic.tangent(1.0);
    }
    sides.finish()
}

/// A curve with half of the width at its ends; between them it changes evenly with the parameter.
#[derive(Clone, Copy)]
struct Strip {
    cubic: Cubic,
    halves: [f64; 2],
}

/// A place on a side and how the side runs there.
#[derive(Clone, Copy)]
struct Pose {
    place: Point,
    /// The derivative by the curve's parameter.
    velocity: Vec2,
}

impl Strip {
    fn half(&self, t: f64) -> f64 {
        self.halves[0] + (self.halves[1] - self.halves[0]) * t
    }

    /// The offset to one side (1: where the tangent turned clockwise points; -1: the other) at a parameter.
    fn side(&self, t: f64, sign: f64) -> Option<Pose> {
        let along = self.cubic.tangent(t)?;
        let (normal, half) = (along.turned(), sign * self.half(t));
        let velocity = self.cubic.velocity(t);
        let speed = velocity.length();
        // How fast the normal turns: the curvature times the speed.
        let turning = if speed > 0.0 { velocity.cross(self.cubic.acceleration(t)) / (speed * speed) } else { 0.0 };
        let widening = sign * (self.halves[1] - self.halves[0]);
        let velocity = along * (speed - half * turning) + normal * widening;
        Some(Pose { place: self.cubic.at(t) + normal * half, velocity })
    }

    /// One side between two parameters as a single edge, if that comes near enough (Hermite's interpolation).
    fn edge(&self, from: f64, to: f64, sign: f64) -> Option<[Point; 4]> {
        let (a, b) = (self.side(from, sign)?, self.side(to, sign)?);
        let third = (to - from) / 3.0;
        let edge = [a.place, a.place + a.velocity * third, b.place + b.velocity * -third, b.place];
        let near = [0.25, 0.5, 0.75].into_iter().all(|t| {
            let wanted = self.side(from + (to - from) * t, sign);
            wanted.is_some_and(|wanted| wanted.place.distance(Cubic(edge).at(t)) <= TOLERANCE)
        });
        near.then_some(edge)
    }
}

/// The two sides of a stroke and the round joins.
#[derive(Default)]
struct Sides {
    /// Against the normal, from the start; then along it. Both run the way of the spine.
    sides: [Vec<[Point; 4]>; 2],
    joins: Vec<Ring>,
}

/// Which way of the normal each of the sides lies.
const SIGNS: [f64; 2] = [-1.0, 1.0];

impl Sides {
    fn add(&mut self, strip: Strip) {
        // Parts still to do, the next one last: where each starts and ends, and how often it may be halved.
        let mut parts = vec![(0.0, 1.0, HALVINGS)];
        while let Some((from, to, halvings)) = parts.pop() {
            let edges = SIGNS.map(|sign| strip.edge(from, to, sign));
            if let [Some(left), Some(right)] = edges {
                self.sides[0].push(left);
                self.sides[1].push(right);
            } else if halvings > 0 {
                let middle = (from + to) / 2.0;
                parts.push((middle, to, halvings - 1));
                parts.push((from, middle, halvings - 1));
            } else {
                self.bar(strip, from, to);
            }
        }
    }

    /// Straight sides with round joins.
    fn bar(&mut self, strip: Strip, from: f64, to: f64) {
        let (a, b) = (strip.cubic.at(from), strip.cubic.at(to));
        let Some(normal) = (b - a).unit().map(Vec2::turned) else { return };
        let halves = [strip.half(from), strip.half(to)];
        for (side, sign) in self.sides.iter_mut().zip(SIGNS) {
            side.push(Cubic::line(a + normal * (sign * halves[0]), b + normal * (sign * halves[1])).0);
        }
        // Where the stroke itself starts or ends it is cut straight, bends or no bends.
        if from > 0.0 {
            self.joins.push(circle(a, halves[0]));
        }
        if to < 1.0 {
            self.joins.push(circle(b, halves[1]));
        }
    }

    /// A join between two curves, unless they run on smoothly.
    fn join(&mut self, p: Point, half: f64, before: Vec2, after: Vec2) {
        let cos_half = ((1.0 + before.dot(after)) / 2.0).max(0.0).sqrt();
        if half * (1.0 - cos_half) > TOLERANCE {
            self.joins.push(circle(p, half));
        }
    }

    /// Forth along one side and back along the other.
    fn finish(self) -> Vec<Ring> {
        let [there, back] = self.sides;
        let Some(first) = there.first() else { return self.joins };
        let mut ring = Ring { start: first[0], edges: Vec::with_capacity(there.len() + back.len() + 2) };
        for [a, b, c, d] in there.into_iter().chain(back.into_iter().rev().map(|[a, b, c, d]| [d, c, b, a])) {
            let here = ring.edges.last().map_or(ring.start, |edge| edge.end());
            if here != a {
                ring.edges.push(Edge::Line(a));
            }
            if is_straight([a, b, c, d]) {
                ring.edges.push(Edge::Line(d));
            } else {
                ring.edges.push(Edge::Curve(b, c, d));
            }
        }
        let mut rings = vec![ring];
        rings.extend(self.joins);
        rings
    }
}

/// Whether a line does for a curve: its control points lie by the line and in order.
fn is_straight([a, b, c, d]: [Point; 4]) -> bool {
    let way = d - a;
    let reach = way.length();
    let near = |p: Point| (p - a).cross(way).abs() <= 0.5 * TOLERANCE * reach;
    let (to_b, to_c) = ((b - a).dot(way), (c - a).dot(way));
    near(b) && near(c) && 0.0 <= to_b && to_b <= to_c && to_c <= reach * reach
}

fn circle(centre: Point, radius: f64) -> Ring {
    let quarters = [Vec2::new(radius, 0.0), Vec2::new(0.0, radius), Vec2::new(-radius, 0.0), Vec2::new(0.0, -radius)];
    let edge = |from: Vec2| {
        let to = from.turned();
        Edge::Curve(centre + from + to * QUARTER, centre + to + from * QUARTER, centre + to)
    };
    Ring { start: centre + quarters[0], edges: quarters.map(edge).to_vec() }
}

#[cfg(test)]
mod tests {
    use super::super::samples::ring;
    use super::*;

    /// The area within a ring, clockwise positive, from many lines.
    fn area(ring: &Ring) -> f64 {
        let (mut sum, mut here) = (0.0, ring.start);
        for &edge in &ring.edges {
            let cubic = match edge {
                Edge::Line(end) => Cubic::line(here, end),
                Edge::Curve(b, c, d) => Cubic([here, b, c, d]),
            };
            for i in 0..1000 {
                let [p, q] = [i, i + 1].map(|i| cubic.at(f64::from(i) / 1000.0));
                sum += p.x * q.y - q.x * p.y;
            }
            here = edge.end();
        }
        assert!(here == ring.start || here.distance(ring.start) > 1e-6);
        (sum + here.x * ring.start.y - ring.start.x * here.y) / 2.0
    }

    #[test]
    fn a_straight_one_is_a_polygon() {
        let spine = Cubic::line(Point::new(1.0, 1.0), Point::new(4.0, 1.0)).0;
        let rings = outline(&spine, &[1.0, 0.0]);
        assert_eq!(rings.len(), 1);
        assert_eq!(rings[0].start, Point::new(1.0, 0.5));
        let ends = [Point::new(4.0, 1.0), Point::new(1.0, 1.5)];
        assert_eq!(rings[0].edges, ends.map(Edge::Line));
    }

    #[test]
    fn sides_of_an_arc_are_arcs() {
        let k = 10.0 * QUARTER;
        let spine = ring(&[(10.0, 0.0), (10.0, k), (k, 10.0), (0.0, 10.0)]);
        let rings = outline(&spine, &[2.0, 2.0]);
        let [ring] = rings.as_slice() else { panic!("{rings:?}") };
        let wanted = std::f64::consts::FRAC_PI_4 * (11.0 * 11.0 - 9.0 * 9.0);
        assert!((area(ring) - wanted).abs() < 0.01, "{}", area(ring));
        assert!(ring.edges.len() < 20, "{}", ring.edges.len());
        for edge in &ring.edges {
            let off = edge.end().distance(Point::default());
            assert!((off - 11.0).abs() < 0.01 || (off - 9.0).abs() < 0.01, "{off}");
        }
    }

    #[test]
    fn corners_and_tight_bends_get_round_joins() {
        let corner: Vec<Point> = {
            let [a, b, c] = [(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)].map(|(x, y)| Point::new(x, y));
            let mut points = Cubic::line(a, b).0.to_vec();
            points.extend_from_slice(&Cubic::line(b, c).0[1..]);
            points
        };
        assert_eq!(outline(&corner, &[1.0, 1.0, 1.0]).len(), 2);
        // There and back again within its own width.
        let cusp = ring(&[(0.0, 0.0), (4.0, 4.0), (0.0, 4.0), (4.0, 0.0)]);
        let rings = outline(&cusp, &[1.0, 1.0]);
        assert!(rings.len() > 1);
        assert!(rings[1..].iter().all(|ring| area(ring) > 0.0));
        let bounds = rings.iter().flat_map(|ring| &ring.edges).map(|edge| edge.end());
        assert!(bounds.into_iter().all(|p| (-0.6..4.6).contains(&p.x) && (-0.6..3.6).contains(&p.y)));
    }

    #[test]
    fn what_has_no_length_has_no_outline() {
        assert!(outline(&[Point::new(1.0, 1.0); 4], &[1.0, 1.0]).is_empty());
        assert!(outline(&[], &[]).is_empty());
    }
}
