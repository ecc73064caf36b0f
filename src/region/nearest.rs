//! The nearest point of an outline: a tree of boxes over its segments.
//!
//! Segments that follow each other on a ring lie near each other, so consecutive ones share a box, consecutive boxes
//! share a larger one, and so on up; no sorting is needed.

use super::index::Segment;
use crate::geom::{Angle, Point, Rect, Vec2};

/// Children of a box.
const FAN: usize = 8;

/// Points nearer to a segment than this many millimetres lie on it.
const ON: f64 = 1e-9;

/// The nearest segment that was found.
#[derive(Debug, Clone, Copy)]
struct Found {
    distance_squared: f64,
    /// Its number; beyond the last where there is none.
    segment: usize,
}

/// The tree.
#[derive(Debug)]
pub(super) struct Nearest {
    /// Boxes by level, from those over segments up to the last level, which has at most [`FAN`].
    levels: Vec<Vec<Rect>>,
}

impl Nearest {
    pub(super) fn new(segments: &[Segment]) -> Self {
        let around = |boxes: &[Rect]| boxes.iter().fold(Rect::EMPTY, |all, b| all.including(b.min).including(b.max));
        let of_segments =
            |group: &[Segment]| group.iter().fold(Rect::EMPTY, |all, s| all.including(s.a).including(s.b));
        let mut level: Vec<Rect> = segments.chunks(FAN).map(of_segments).collect();
        let mut levels = Vec::new();
        while level.len() > FAN {
            let above = level.chunks(FAN).map(around).collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Self { levels }
    }

    /// The square of the distance from `p` to the nearest of the segments that the tree was made of; infinite where
    /// there is none.
    pub(super) fn distance_squared(&self, segments: &[Segment], p: Point) -> f64 {
        self.find(segments, p).distance_squared
    }

    /// The direction in which the outline runs where it is nearest to `p`: along the segment on it, and round the
    /// corner before one.
    pub(super) fn tangent(&self, segments: &[Segment], p: Point) -> Option<Angle> {
        let segment = segments.get(self.find(segments, p).segment)?;
        let away = p - segment.nearest(p);
        let along = if away.length_squared() > ON * ON { Vec2::new(-away.y, away.x) } else { segment.b - segment.a };
        Some(Angle::of(along).direction())
    }

    fn find(&self, segments: &[Segment], p: Point) -> Found {
        let mut best = Found { distance_squared: f64::INFINITY, segment: usize::MAX };
        let top = self.levels.len() - 1;
        self.descend(top, 0..self.levels[top].len(), segments, p, &mut best);
        best
    }

    /// Shows the numbers of the segments that may lie within `reach` millimetres of a point, of the `count` that the tree
    /// was made of, in no order that means anything; what `look` returns is the reach from then on.
    pub(super) fn search(&self, count: usize, p: Point, reach: f64, mut look: impl FnMut(usize) -> f64) {
        let mut reach = reach;
        let top = self.levels.len() - 1;
        let mut open: Vec<(usize, usize)> = (0..self.levels[top].len()).map(|i| (top, i)).collect();
        while let Some((level, i)) = open.pop() {
            if to_box(&self.levels[level][i], p).sqrt() > reach {
                continue;
            }
            let start = i * FAN;
            if level == 0 {
                (start..count.min(start + FAN)).for_each(|segment| reach = look(segment));
            } else {
                let end = self.levels[level - 1].len().min(start + FAN);
                open.extend((start..end).map(|below| (level - 1, below)));
            }
        }
    }

    /// Looks into the boxes of one level, the nearest first. As deep as the tree is high.
    fn descend(&self, level: usize, boxes: std::ops::Range<usize>, segments: &[Segment], p: Point, best: &mut Found) {
        let mut near = [(f64::INFINITY, 0); FAN];
        let mut count = 0;
        for i in boxes {
            let distance = to_box(&self.levels[level][i], p);
            if distance < best.distance_squared {
                // Sorted as it grows; a box that is no nearer than another stays behind it.
                let at = near[..count].partition_point(|&(d, _)| d <= distance);
                near.copy_within(at..count, at + 1);
                near[at] = (distance, i);
                count += 1;
            }
        }
        for &(distance, i) in &near[..count] {
            if distance >= best.distance_squared {
                break;
            }
            let start = i * FAN;
            if level == 0 {
                for (i, segment) in segments.iter().enumerate().skip(start).take(FAN) {
                    let distance_squared = p.distance_squared(segment.nearest(p));
                    // Of equal ones the first that is met stays.
                    if distance_squared < best.distance_squared {
                        *best = Found { distance_squared, segment: i };
                    }
                }
            } else {
                let end = self.levels[level - 1].len().min(start + FAN);
                self.descend(level - 1, start..end, segments, p, best);
            }
        }
    }
}

fn to_box(area: &Rect, p: Point) -> f64 {
    let x = (area.min.x - p.x).max(p.x - area.max.x).max(0.0);
    let y = (area.min.y - p.y).max(p.y - area.max.y).max(0.0);
    x * x + y * y
}

impl Segment {
    /// Its point that is nearest to another.
    fn nearest(&self, p: Point) -> Point {
        let way = self.b - self.a;
        let length_squared = way.length_squared();
        let share = if length_squared > 0.0 { ((p - self.a).dot(way) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
        self.a + way * share
    }
}
