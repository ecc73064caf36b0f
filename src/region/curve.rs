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

/// Collects lines, curves and arcs and flattens them.
#[derive(Debug, Default)]
pub(super) struct Pen {
    done: Vec<Subpath>,
    current: Vec<Point>,
}

impl Pen {
    /// Starts anew at a point.
    pub(super) fn move_to(&mut self, p: Point) {
        self.end(false);
        self.current.push(p);
    }

    /// A straight line.
    pub(super) fn line_to(&mut self, p: Point) {
        if self.current.last() != Some(&p) {
            self.current.push(p);
        }
    }

    /// A quadratic Bézier curve.
    pub(super) fn quadratic_to(&mut self, b: Point, c: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic::quadratic(a, b, c));
    }

    /// A cubic Bézier curve.
    pub(super) fn cubic_to(&mut self, b: Point, c: Point, d: Point) {
        let Some(&a) = self.current.last() else { return };
        self.cubic(Cubic([a, b, c, d]));
    }

    fn cubic(&mut self, cubic: Cubic) {
        cubic.flatten(FLATTENING).for_each(|p| self.line_to(p));
    }

    /// A piece of an ellipse, as SVG describes it (SVG 2, appendix B.2.4 and 5).
    pub(super) fn arc_to(&mut self, arc: Arc, end: Point) {
        let Some(&start) = self.current.last() else { return };
        let (mut rx, mut ry) = (arc.radii[0].abs(), arc.radii[1].abs());
        if start == end {
            return;
        }
        if !(rx > 0.0 && ry > 0.0) {
            self.line_to(end);
            return;
        }
        let (sin, cos) = arc.rotation.sin_cos();
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
        let sense = if arc.is_large == arc.is_clockwise { -1.0 } else { 1.0 };
        let (cx, cy) = (sense * squared * rx * y / ry, -sense * squared * ry * x / rx);
        let centre = start.lerp(end, 0.5) + Vec2::new(cos * cx - sin * cy, sin * cx + cos * cy);
        let from = libm::atan2((y - cy) / ry, (x - cx) / rx);
        let to = libm::atan2((-y - cy) / ry, (-x - cx) / rx);
        let mut sweep = to - from;
        if arc.is_clockwise && sweep < 0.0 {
            sweep += TAU;
        } else if !arc.is_clockwise && sweep > 0.0 {
            sweep -= TAU;
        }
        let count = lines_of_arc(rx.max(ry), sweep);
        for i in 1..count as u32 {
            let (s, c) = Angle::radians(from + sweep * f64::from(i) / count).sin_cos();
            self.line_to(centre + Vec2::new(cos * rx * c - sin * ry * s, sin * rx * c + cos * ry * s));
        }
        self.line_to(end);
    }

    /// Back to the first point; what follows starts there.
    pub(super) fn close(&mut self) {
        let first = self.current.first().copied();
        self.end(true);
        self.current.extend(first);
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
