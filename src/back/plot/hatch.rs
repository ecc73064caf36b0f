//! Filled areas as strokes: rings go in, level lines that lie a pen apart come out, joined back and forth where they can be.
//!
//! All lines of a pen lie on one grid of the page, so that areas that touch are hatched through. They end half a pen
//! within the area; what is too narrow for the pen gets a line or a dot in its middle.

use super::path::Path;
use crate::geom::{Length, Point, Rect};

/// How far, in pens, the ends of neighbouring lines may lie apart to be joined.
const JOINED: f64 = 2.0;

/// Hatches an area by the even-odd rule.
pub(super) fn hatch(rings: &[Vec<Point>], pen: Length) -> Vec<Path> {
    let pen = pen.to_mm();
    let bounds = rings.iter().flatten().fold(Rect::EMPTY, |bounds, &p| bounds.including(p));
    if !(bounds.width().is_finite() && bounds.height().is_finite()) {
        return Vec::new();
    }
    // Line i lies at (i + 1/2) pens; what lies between two lines gets one of its own.
    let first = (bounds.min.y / pen - 0.5).ceil();
    let count = (bounds.max.y / pen - 0.5 - first).floor() + 1.0;
    let level = |i: usize| (first + i as f64 + 0.5) * pen;
    if count < 1.0 {
        let y = bounds.centre().y;
        return spans(rings, &[y], pen).into_iter().flatten().map(|span| Path::Straight(span.points(y))).collect();
    }
    let levels: Vec<f64> = (0..count as usize).map(level).collect();
    join(&levels, spans(rings, &levels, pen), pen)
}

/// A piece of a level line.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// Where the area is entered and left.
    area: [f64; 2],
    /// Where the pen starts and ends.
    pen: [f64; 2],
}

impl Span {
    fn points(self, y: f64) -> Vec<Point> {
        let [from, to] = self.pen.map(|x| Point::new(x, y));
        if from == to { vec![from] } else { vec![from, to] }
    }
}

/// What of each level lies in the area, from left to right. Levels ascend.
fn spans(rings: &[Vec<Point>], levels: &[f64], pen: f64) -> Vec<Vec<Span>> {
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); levels.len()];
    for ring in rings {
        let Some(&last) = ring.last() else { continue };
        let mut a = last;
        for &b in ring {
            let (upper, lower) = if a.y <= b.y { (a, b) } else { (b, a) };
            // An edge holds its upper end and not its lower one.
            let from = levels.partition_point(|&y| y < upper.y);
            let to = levels.partition_point(|&y| y < lower.y);
            for i in from..to {
                let t = (levels[i] - upper.y) / (lower.y - upper.y);
                crossings[i].push(upper.x + (lower.x - upper.x) * t);
            }
            a = b;
        }
    }
    let inner = |pair: &[f64]| {
        let (left, right) = (pair[0] + pen / 2.0, pair[1] - pen / 2.0);
        let middle = (pair[0] + pair[1]) / 2.0;
        Span { area: [pair[0], pair[1]], pen: if left < right { [left, right] } else { [middle; 2] } }
    };
    crossings
        .into_iter()
        .map(|mut at| {
            at.sort_unstable_by(f64::total_cmp);
            at.chunks_exact(2).filter(|pair| pair[0] < pair[1]).map(inner).collect()
        })
        .collect()
}

/// A line that goes back and forth.
struct Snake {
    points: Vec<Point>,
    /// Its last piece.
    span: Span,
    /// Whether it went to the right there.
    goes_right: bool,
}

/// Joins the ends of pieces that lie below each other, at most one to one.
fn join(levels: &[f64], spans: Vec<Vec<Span>>, pen: f64) -> Vec<Path> {
    let mut done = Vec::new();
    let mut open: Vec<Snake> = Vec::new();
    for (&y, spans) in levels.iter().zip(spans) {
        let mut going_on: Vec<Snake> = Vec::with_capacity(spans.len());
        let mut above = open.into_iter().peekable();
        for span in spans {
            // What ends to the left of this piece goes on nowhere.
            while let Some(snake) = above.next_if(|snake| snake.span.area[1] < span.area[0]) {
                done.push(Path::Straight(snake.points));
            }
            let end = usize::from(above.peek().is_some_and(|snake| snake.goes_right));
            let joins = |snake: &Snake| {
                snake.span.area[0] < span.area[1] && (snake.span.pen[end] - span.pen[end]).abs() <= JOINED * pen
            };
            let [left, right] = span.pen.map(|x| Point::new(x, y));
            if let Some(mut snake) = above.next_if(joins) {
                let pieces = if snake.goes_right { [right, left] } else { [left, right] };
                for p in pieces {
                    if snake.points.last() != Some(&p) {
                        snake.points.push(p);
                    }
                }
                going_on.push(Snake { span, goes_right: !snake.goes_right, ..snake });
            } else {
                going_on.push(Snake { points: span.points(y), span, goes_right: true });
            }
        }
        done.extend(above.map(|snake| Path::Straight(snake.points)));
        open = going_on;
    }
    done.extend(open.into_iter().map(|snake| Path::Straight(snake.points)));
    done
}

#[cfg(test)]
mod tests {
    use super::super::super::samples::ring;
    use super::*;

    const PEN: Length = Length::mm(0.5);

    #[test]
    fn a_square_is_one_stroke() {
        let square = ring(&[(1.0, 1.0), (4.0, 1.0), (4.0, 3.0), (1.0, 3.0)]);
        let paths = hatch(&[square], PEN);
        let [path] = paths.as_slice() else { panic!("{paths:?}") };
        let wanted = [
            (1.25, 1.25),
            (3.75, 1.25),
            (3.75, 1.75),
            (1.25, 1.75),
            (1.25, 2.25),
            (3.75, 2.25),
            (3.75, 2.75),
            (1.25, 2.75),
        ];
        assert_eq!(path.points(), ring(&wanted));
    }

    #[test]
    fn holes_stay_free_and_slivers_are_seen() {
        let outer = ring(&[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]);
        let hole = ring(&[(3.0, 3.0), (6.0, 3.0), (6.0, 6.0), (3.0, 6.0)]);
        let paths = hatch(&[outer, hole], PEN);
        for path in &paths {
            for pair in path.points().windows(2) {
                let middle = pair[0].lerp(pair[1], 0.5);
                assert!(!((3.0..6.0).contains(&middle.x) && (3.0..6.0).contains(&middle.y)), "{pair:?}");
            }
        }
        // Each line is as much shorter as the pen is wide; what joins two lines is a pen long.
        let length: f64 = paths.iter().map(Path::length).sum();
        let wanted = 12.0 * 8.5 + 6.0 * 5.0 + 22.0 * 0.5;
        assert!((length - wanted).abs() < 1.5, "{length} instead of {wanted}");
        let sliver = ring(&[(0.0, 0.3), (5.0, 0.3), (5.0, 0.4), (0.0, 0.4)]);
        assert_eq!(hatch(&[sliver], PEN).len(), 1);
        let crumb = ring(&[(0.0, 0.3), (0.1, 0.3), (0.1, 0.4)]);
        assert_eq!(hatch(&[crumb], PEN)[0].points().len(), 1);
        assert!(hatch(&[], PEN).is_empty());
        assert!(hatch(&[ring(&[(0.0, f64::NAN), (f64::INFINITY, 1.0), (2.0, 2.0)])], PEN).is_empty());
    }
}
