//! What a pen does between being lowered and lifted.

use crate::geom::bezier::cubics;
use crate::geom::{Cubic, Point};

/// A stroke of a plotter: a dot has one point, a stroke that ends at its first point is closed.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Path {
    /// Straight lines between points; at least one.
    Straight(Vec<Point>),
    /// A chain of cubic Béziers: 3n + 1 points, n at least 1.
    Curved(Vec<Point>),
}

impl Path {
    pub(super) fn points(&self) -> &[Point] {
        match self {
            Self::Straight(points) | Self::Curved(points) => points,
        }
    }

    fn points_mut(&mut self) -> &mut Vec<Point> {
        match self {
            Self::Straight(points) | Self::Curved(points) => points,
        }
    }

    /// Its first point and its last.
    pub(super) fn ends(&self) -> [Point; 2] {
        let points = self.points();
        [points.first(), points.last()].map(|p| p.copied().unwrap_or_default())
    }

    /// Whether its points are numbers, and there is one.
    pub(super) fn is_sound(&self) -> bool {
        !self.points().is_empty() && self.points().iter().all(|p| p.x.is_finite() && p.y.is_finite())
    }

    /// Whether it is more than a dot and ends where it starts.
    pub(super) fn is_closed(&self) -> bool {
        let [start, end] = self.ends();
        self.points().len() > 2 && start == end
    }

    /// How far the pen goes, in millimetres.
    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Straight(points) => points.windows(2).map(|pair| pair[0].distance(pair[1])).sum(),
            Self::Curved(points) => cubics(points).map(|cubic| cubic.length().to_mm()).sum(),
        }
    }

    pub(super) fn reverse(&mut self) {
        self.points_mut().reverse();
    }

    /// Goes on along another path, straight to its start if there is a gap.
    pub(super) fn append(&mut self, other: &Self) {
        let [start, _] = other.ends();
        match (&mut *self, other) {
            (Self::Straight(points), Self::Straight(more)) => {
                let skip = usize::from(points.last() == Some(&start));
                points.extend_from_slice(&more[skip..]);
            }
            (Self::Straight(points), Self::Curved(_)) => {
                let mut curve = vec![points.first().copied().unwrap_or_default()];
                points.windows(2).for_each(|pair| curve.extend_from_slice(&Cubic::line(pair[0], pair[1]).0[1..]));
                *self = Self::Curved(curve);
                self.append(other);
            }
            (Self::Curved(points), other) => {
                let mut here = points.last().copied().unwrap_or_default();
                if here != start {
                    points.extend_from_slice(&Cubic::line(here, start).0[1..]);
                    here = start;
                }
                match other {
                    Self::Curved(more) => points.extend_from_slice(&more[1..]),
                    Self::Straight(more) => {
                        for &p in &more[1..] {
                            points.extend_from_slice(&Cubic::line(here, p).0[1..]);
                            here = p;
                        }
                    }
                }
            }
        }
    }

    /// How many joints a closed path has that it may start at.
    fn joints(&self) -> usize {
        match self {
            Self::Straight(points) => points.len() - 1,
            Self::Curved(points) => points.len() / 3,
        }
    }

    /// Lets a closed path start where the way from `before` and on to `after` is shortest.
    pub(super) fn turn(&mut self, before: Option<Point>, after: Option<Point>) {
        if !self.is_closed() {
            return;
        }
        let step = match self {
            Self::Straight(_) => 1,
            Self::Curved(_) => 3,
        };
        let detour = |joint: usize| {
            let p = self.points()[joint * step];
            before.map_or(0.0, |before| p.distance(before)) + after.map_or(0.0, |after| p.distance(after))
        };
        let best = (0..self.joints()).map(|joint| (detour(joint), joint)).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, joint)) = best else { return };
        let points = self.points_mut();
        points.pop();
        points.rotate_left(joint * step);
        points.extend(points.first().copied());
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::samples::ring;
    use super::*;

    #[test]
    fn paths_of_both_kinds_run_on() {
        let mut path = Path::Straight(ring(&[(0.0, 0.0), (3.0, 0.0)]));
        path.append(&Path::Straight(ring(&[(3.0, 0.0), (3.0, 3.0)])));
        path.append(&Path::Straight(ring(&[(4.0, 3.0)])));
        assert_eq!(path.points().len(), 4);
        path.append(&Path::Curved(ring(&[(4.0, 3.0), (5.0, 3.0), (6.0, 3.0), (7.0, 3.0)])));
        assert_eq!(path.points().len(), 13);
        path.append(&Path::Straight(ring(&[(7.0, 4.0), (7.0, 6.0)])));
        assert_eq!(path.points().len(), 19);
        assert!((path.length() - (3.0 + 3.0 + 1.0 + 3.0 + 3.0)).abs() < 1e-9);
        path.reverse();
        assert_eq!(path.ends(), [Point::new(7.0, 6.0), Point::new(0.0, 0.0)]);
    }

    #[test]
    fn closed_paths_start_where_the_pen_comes_from() {
        let square = ring(&[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0)]);
        let mut path = Path::Straight(square.clone());
        path.turn(Some(Point::new(9.0, 9.0)), None);
        assert_eq!(path.ends(), [Point::new(3.0, 3.0); 2]);
        assert_eq!(path.points().len(), 5);
        assert!((path.length() - 12.0).abs() < 1e-9);
        let mut open = Path::Straight(square[..4].to_vec());
        open.turn(Some(Point::new(9.0, 9.0)), None);
        assert_eq!(open.points(), &square[..4]);
    }
}
