//! Curves as lines: pieces of curves in, points within a tolerance of them out.

use std::f64::consts::{PI, TAU};

use super::FLATTENING;
use crate::geom::{Angle, Cubic, Length, Point, Vec2};

/// The most lines that stand for one arc; reached by arcs of many metres.
const MOST_LINES: f64 = 16_384.0;

/// A line of straight pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Subpath {
    /// Its corners; at least two, and no two that follow each other are the same.
    pub points: Vec<Point>,
    /// Whether it returns to its first point, which is not repeated.
    pub is_closed: bool,
}

/// What draws lines, curves and arcs.
pub(super) trait Draw {
    /// Starts anew at a point.
    fn move_to(&mut self, p: Point);

    /// A straight line.
    fn line_to(&mut self, p: Point);

    /// A quadratic Bézier curve.
    fn quadratic_to(&mut self, b: Point, c: Point);

    /// A cubic Bézier curve.
    fn cubic_to(&mut self, b: Point, c: Point, d: Point);

    /// A piece of an ellipse, as SVG describes it (SVG 2, appendix B.2.4 and 5).
    fn arc_to(&mut self, arc: Arc, end: Point);

    /// Back to the first point; what follows starts there.
    fn close(&mut self);
}

/// Collects lines, curves and arcs and flattens them.
#[derive(Debug, Default)]
pub(super) struct Pen {
    done: Vec<Subpath>,
    current: Vec<Point>,
}

impl Pen {
    fn cubic(&mut self, cubic: Cubic) {
        cubic.flatten(FLATTENING).for_each(|p| self.line_to(p));
    }

    /// What has been drawn.
    pub(super) fn finish(mut self) -> Vec<Subpath> {
        self.end(false);
        self.done
    }

    fn end(&mut self, is_closed: bool) {
        let mut points = std::mem::take(&mut self.current);
        if is_closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() > 1 {
            self.done.push(Subpath { points, is_closed });
        }
    }
}

impl Draw for Pen {
    fn move_to(&mut self, p: Point) {
        self.end(false);
        self.current.push(p);
    }

    fn line_to(&mut self, p: Point) {
        if self.current.last() != Some(&p) {
            self.current.push(p);
        }
    }

    fn quadratic_to(&mut self, b: Point, c: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic::quadratic(a, b, c));
    }

    fn cubic_to(&mut self, b: Point, c: Point, d: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic([a, b, c, d]));
    }

    fn arc_to(&mut self, arc: Arc, end: Point) {
        let Some(&start) = self.current.last() else { return };
        if let Some(ellipse) = arc.ellipse(start, end) {
            let count = lines_of_arc(ellipse.radii[0].max(ellipse.radii[1]), ellipse.sweep);
            for i in 1..count as u32 {
                self.line_to(ellipse.at(ellipse.from + ellipse.sweep * f64::from(i) / count));
            }
        }
        self.line_to(end);
    }

    fn close(&mut self) {
        let first = self.current.first().copied();
        self.end(true);
        self.current.extend(first);
    }
}

/// Collects lines, curves and arcs as chains of cubic Béziers. A closed chain ends at its first point.
#[derive(Debug, Default)]
pub(super) struct CurvePen {
    done: Vec<Vec<Point>>,
    current: Vec<Point>,
}

impl CurvePen {
    /// What has been drawn: chains of at least one curve.
    pub(super) fn finish(mut self) -> Vec<Vec<Point>> {
        self.end();
        self.done
    }

    fn end(&mut self) {
        let chain = std::mem::take(&mut self.current);
        if chain.len() > 1 {
            self.done.push(chain);
        }
    }

    fn cubic(&mut self, Cubic([a, b, c, d]): Cubic) {
        if [b, c, d] != [a; 3] {
            self.current.extend([b, c, d]);
        }
    }
}

impl Draw for CurvePen {
    fn move_to(&mut self, p: Point) {
        self.end();
        self.current.push(p);
    }

    fn line_to(&mut self, p: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic::line(a, p));
    }

    fn quadratic_to(&mut self, b: Point, c: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic::quadratic(a, b, c));
    }

    fn cubic_to(&mut self, b: Point, c: Point, d: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic([a, b, c, d]));
    }

    fn arc_to(&mut self, arc: Arc, end: Point) {
        let Some(&start) = self.current.last() else { return };
        let Some(ellipse) = arc.ellipse(start, end) else { return self.line_to(end) };
        // Eighths of a turn lie within a few millionths of the radius of the ellipse.
        let count = (ellipse.sweep.abs() / (PI / 4.0)).ceil().clamp(1.0, 8.0);
        let step = ellipse.sweep / count;
        let (sin, cos) = Angle::radians(step / 4.0).sin_cos();
        let handle = 4.0 / 3.0 * sin / cos;
        for i in 0..count as u32 {
            let [from, to] = [i, i + 1].map(|i| ellipse.from + step * f64::from(i));
            let last = f64::from(i) + 1.0 >= count;
            let place = if last { end } else { ellipse.at(to) };
            let Some(&at) = self.current.last() else { return };
            self.cubic(Cubic([at, at + ellipse.velocity(from) * handle, place - ellipse.velocity(to) * handle, place]));
        }
    }

    fn close(&mut self) {
        let Some(&first) = self.current.first() else { return };
        self.line_to(first);
        self.end();
        self.current.push(first);
    }
}

/// How an arc gets from one point to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub(super) radii: [f64; 2],
    /// Of the first radius from +x.
    pub(super) rotation: Angle,
    /// Whether it is the one of more than half a turn.
    pub(super) is_large: bool,
    /// Whether its angle grows: clockwise on the page.
    pub(super) is_clockwise: bool,
}

impl Arc {
    /// The ellipse that it is a piece of; none where it is a straight line, or nothing.
    fn ellipse(self, start: Point, end: Point) -> Option<Ellipse> {
        let (mut rx, mut ry) = (self.radii[0].abs(), self.radii[1].abs());
        if start == end || !(rx > 0.0 && ry > 0.0) {
            return None;
        }
        let (sin, cos) = self.rotation.sin_cos();
        // In the ellipse's own axes, from the middle of the chord.
        let half = (start - end) * 0.5;
        let (x, y) = (cos * half.x + sin * half.y, cos * half.y - sin * half.x);
        let reach = (x / rx) * (x / rx) + (y / ry) * (y / ry);
        if reach > 1.0 {
            // Radii that are too small to reach are scaled up until they do.
            rx *= reach.sqrt();
            ry *= reach.sqrt();
        }
        let squared = (1.0 / reach.min(1.0) - 1.0).max(0.0).sqrt();
        let sense = if self.is_large == self.is_clockwise { -1.0 } else { 1.0 };
        let (cx, cy) = (sense * squared * rx * y / ry, -sense * squared * ry * x / rx);
        let centre = start.lerp(end, 0.5) + Vec2::new(cos * cx - sin * cy, sin * cx + cos * cy);
        let from = libm::atan2((y - cy) / ry, (x - cx) / rx);
        let to = libm::atan2((-y - cy) / ry, (-x - cx) / rx);
        let mut sweep = to - from;
        if self.is_clockwise && sweep < 0.0 {
            sweep += TAU;
        } else if !self.is_clockwise && sweep > 0.0 {
            sweep -= TAU;
        }
        Some(Ellipse { centre, radii: [rx, ry], turn: (sin, cos), from, sweep })
    }
}

/// A piece of an ellipse by the angle in it, in radians.
struct Ellipse {
    centre: Point,
    radii: [f64; 2],
    /// Sine and cosine of its rotation.
    turn: (f64, f64),
    from: f64,
    sweep: f64,
}

impl Ellipse {
    fn at(&self, angle: f64) -> Point {
        let ((sin, cos), [rx, ry]) = (self.turn, self.radii);
        let (s, c) = Angle::radians(angle).sin_cos();
        self.centre + Vec2::new(cos * rx * c - sin * ry * s, sin * rx * c + cos * ry * s)
    }

    /// The derivative by the angle.
    fn velocity(&self, angle: f64) -> Vec2 {
        let ((sin, cos), [rx, ry]) = (self.turn, self.radii);
        let (s, c) = Angle::radians(angle).sin_cos();
        Vec2::new(-cos * rx * s - sin * ry * c, cos * ry * c - sin * rx * s)
    }
}

/// The corners of a polygon that stands for an ellipse; none where a radius is not above zero.
pub(super) fn ellipse(centre: Point, rx: Length, ry: Length) -> Vec<Point> {
    let (rx, ry) = (rx.to_mm(), ry.to_mm());
    if !(rx > 0.0 && ry > 0.0) {
        return Vec::new();
    }
    // A multiple of four, so that the extreme points are corners and the bounds exact.
    let count = (lines_of_arc(rx.max(ry), TAU) / 4.0).ceil() as usize * 4;
    (0..count)
        .map(|i| {
            let (sin, cos) = corner_sin_cos(i, count);
            centre + Vec2::new(rx * cos, ry * sin)
        })
        .collect()
}

/// Sine and cosine of a share of the full turn; exact at the quarters.
fn corner_sin_cos(i: usize, count: usize) -> (f64, f64) {
    let quarter = count / 4;
    let (sin, cos) = Angle::radians(TAU * (i % quarter) as f64 / count as f64).sin_cos();
    match i / quarter {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// How many lines stand for an arc: the sagitta of each, r (1 - cos(angle / 2)), is within the tolerance.
fn lines_of_arc(radius: f64, sweep: f64) -> f64 {
    let share = (FLATTENING.to_mm() / radius).min(1.0);
    let step = (2.0 * libm::acos(1.0 - share)).min(PI / 8.0);
    (sweep.abs() / step).ceil().clamp(1.0, MOST_LINES)
}
