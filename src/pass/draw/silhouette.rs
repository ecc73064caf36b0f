//! A tile as parallel lines see it: where each of them enters and leaves it, convex or not.

use crate::geom::Figure;
use crate::geom::clip::{Frame, Profile, TOLERANCE};

/// A line that runs into convex outlines and out again.
pub(in crate::pass) trait Meet {
    /// Where it lies in an outline.
    fn meet(&self, profile: &Profile) -> Option<(f64, f64)>;
}

/// The straight line at a place across.
impl Meet for f64 {
    fn meet(&self, profile: &Profile) -> Option<(f64, f64)> {
        profile.span(*self)
    }
}

/// The profiles of a figure's convex pieces.
#[derive(Default)]
pub(in crate::pass) struct Silhouette {
    /// The list may be longer than there are pieces, so that memory is used again.
    profiles: Vec<Profile>,
    count: usize,
}

impl Silhouette {
    /// Takes the profiles of another figure.
    pub(in crate::pass) fn set(&mut self, figure: Figure<'_>, frame: &Frame) {
        self.count = 0;
        for piece in figure.pieces() {
            if self.profiles.len() == self.count {
                self.profiles.push(Profile::default());
            }
            self.profiles[self.count].set(piece, frame);
            self.count += 1;
        }
    }

    fn profiles(&self) -> &[Profile] {
        &self.profiles[..self.count]
    }

    /// The range across the lines; the first is above the second where there is nothing.
    pub(in crate::pass) fn across(&self) -> (f64, f64) {
        self.profiles().iter().map(Profile::across).fold((f64::INFINITY, f64::NEG_INFINITY), widened)
    }

    /// The range along the lines.
    pub(in crate::pass) fn along(&self) -> (f64, f64) {
        self.profiles().iter().map(Profile::along).fold((f64::INFINITY, f64::NEG_INFINITY), widened)
    }

    /// Calls `visit` with the ranges of a line that lie in the pieces. They may touch and come in no order: whoever
    /// takes them away need not care.
    pub(in crate::pass) fn spans(&self, line: &impl Meet, visit: impl FnMut((f64, f64))) {
        self.profiles().iter().filter_map(|profile| line.meet(profile)).for_each(visit);
    }

    /// Writes the ranges of a line that lie in the figure, ascending, those of touching pieces joined.
    pub(in crate::pass) fn ranges(&self, line: &impl Meet, out: &mut Vec<(f64, f64)>) {
        out.clear();
        self.spans(line, |span| out.push(span));
        if out.len() > 1 {
            out.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            out.dedup_by(|next, range| {
                let touches = next.0 <= range.1 + TOLERANCE;
                if touches {
                    range.1 = range.1.max(next.1);
                }
                touches
            });
        }
    }
}

fn widened(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Pieces, Point, Vec2};

    #[test]
    fn lines_run_through_the_seams_of_pieces_and_stop_at_gaps() {
        let comb = [(0, 0), (7, 0), (7, 3), (6, 3), (6, 1), (4, 1), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3)];
        let comb: Vec<Point> = comb.iter().map(|&(x, y)| Point::new(f64::from(x), f64::from(y))).collect();
        let pieces = Pieces::of(&comb);
        let corners: Vec<Point> = pieces.corners(&comb).collect();
        let mut silhouette = Silhouette::default();
        let figure = Figure::new(&comb, &pieces, &corners);
        silhouette.set(figure, &Frame::new(Point::default(), Vec2::new(1.0, 0.0)));
        assert_eq!(silhouette.across(), (0.0, 3.0));
        let mut out = Vec::new();
        silhouette.ranges(&0.5, &mut out);
        assert_eq!(out, [(0.0, 7.0)]);
        silhouette.ranges(&2.0, &mut out);
        assert_eq!(out, [(0.0, 1.0), (3.0, 4.0), (6.0, 7.0)]);
        silhouette.ranges(&3.5, &mut out);
        assert!(out.is_empty());
    }
}
