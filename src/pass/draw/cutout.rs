//! An outline as curves see it: where they run into it and out again.

use crate::geom::bezier::cubics;
use crate::geom::clip::Frame;
use crate::geom::hull::Hull;
use crate::geom::{Figure, Point, Rect, chain};

/// Ranges that come so near to each other, in a curve's parameter, are one: pieces of an outline share sides.
const SEAM: f64 = 1e-9;

/// An outline in a frame, with the convex pieces it is made of.
#[derive(Debug, Clone, Default)]
pub(super) struct Cutout {
    /// The outline; its half-planes mean nothing where it is not convex.
    outline: Hull,
    /// The pieces of an outline that is not convex; the list may be longer than they are many.
    pieces: Vec<Hull>,
    count: usize,
}

impl Cutout {
    /// Takes the place of another outline, keeping the memory.
    pub(super) fn set(&mut self, figure: Figure<'_>, frame: &Frame) {
        self.outline.set(figure.outline(), frame);
        self.count = 0;
        if figure.is_convex() {
            return;
        }
        for piece in figure.pieces() {
            if self.pieces.len() == self.count {
                self.pieces.push(Hull::default());
            }
            self.pieces[self.count].set(piece, frame);
            self.count += 1;
        }
    }

    /// The corners of the outline in the frame.
    pub(super) fn corners(&self) -> &[Point] {
        self.outline.corners()
    }

    /// The box around it; none where it is empty.
    pub(super) fn bounds(&self) -> Option<Rect> {
        self.outline.bounds()
    }

    /// Whether a box may share a point with it.
    pub(super) fn may_meet(&self, area: &Rect) -> bool {
        self.outline.may_meet(area)
    }

    /// How far along the frame it reaches between two places across.
    pub(super) fn along(&self, across: (f64, f64)) -> Option<(f64, f64)> {
        self.outline.along(across)
    }

    /// How far across the frame it reaches at a place along.
    pub(super) fn across(&self, along: f64) -> Option<(f64, f64)> {
        self.outline.across((along, along))
    }

    fn pieces(&self) -> &[Hull] {
        if self.count == 0 { std::slice::from_ref(&self.outline) } else { &self.pieces[..self.count] }
    }

    /// Calls `visit` with the parts of a straight way that lie in it, as shares of the way.
    pub(super) fn line(&self, a: Point, b: Point, visit: impl FnMut((f64, f64))) {
        self.pieces().iter().filter_map(|piece| piece.line(a, b)).for_each(visit);
    }

    /// The ranges of a chain that lie in it, ascending, as far as they may share something with other ranges of it. `boxes` lie
    /// around the chain's curves.
    pub(super) fn cut_within(
        &mut self,
        chain: &[Point],
        boxes: &[Rect],
        ranges: &[(f64, f64)],
        found: &mut Vec<(f64, f64)>,
    ) {
        found.clear();
        let pieces =
            if self.count == 0 { std::slice::from_mut(&mut self.outline) } else { &mut self.pieces[..self.count] };
        for piece in pieces.iter_mut() {
            let mut done = 0;
            for &(start, end) in ranges {
                let last = (end.ceil() as usize).min(boxes.len());
                for (number, area) in boxes.iter().enumerate().take(last).skip(done.max(start as usize)) {
                    if piece.may_meet(area)
                        && let Some(cubic) = chain::curve(chain, number)
                    {
                        piece.cut(&cubic, number, found);
                    }
                }
                done = done.max(last);
            }
        }
        if self.count > 0 {
            unite(found);
        }
    }

    /// The ranges of a chain that lie in it, ascending. `number` is that of the chain's first curve.
    pub(super) fn cut(&mut self, chain: &[Point], number: usize, found: &mut Vec<(f64, f64)>) {
        found.clear();
        let pieces =
            if self.count == 0 { std::slice::from_mut(&mut self.outline) } else { &mut self.pieces[..self.count] };
        for piece in pieces.iter_mut() {
            for (i, cubic) in cubics(chain).enumerate() {
                piece.cut(&cubic, number + i, found);
            }
        }
        if self.count > 0 {
            unite(found);
        }
    }
}

/// Sorts ranges and makes one of those that touch.
pub(super) fn unite(ranges: &mut Vec<(f64, f64)>) {
    ranges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    ranges.dedup_by(|next, last| {
        let touches = next.0 <= last.1 + SEAM;
        if touches {
            last.1 = last.1.max(next.1);
        }
        touches
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Cubic, Pieces, Vec2};

    #[test]
    fn a_curve_runs_through_the_pieces_of_an_arrow() {
        let ring = [(0.0, 0.0), (4.0, 2.0), (0.0, 4.0), (1.0, 2.0)].map(|(x, y)| Point::new(x, y));
        let pieces = Pieces::of(&ring);
        let corners: Vec<Point> = pieces.corners(&ring).collect();
        let figure = Figure::new(&ring, &pieces, &corners);
        let frame = Frame::new(Point::new(0.0, 0.0), Vec2::new(1.0, 0.0));
        let mut cutout = Cutout::default();
        cutout.set(figure, &frame);
        // Down through both barbs, and along the shaft over the seam.
        for (a, b, expected) in [
            (
                Point::new(0.5, -1.0),
                Point::new(0.5, 5.0),
                vec![(0.25 / 6.0 + 1.0 / 6.0, 2.0 / 6.0), (4.0 / 6.0, 4.75 / 6.0)],
            ),
            (Point::new(-1.0, 2.0), Point::new(5.0, 2.0), vec![(2.0 / 6.0, 5.0 / 6.0)]),
        ] {
            let mut found = Vec::new();
            cutout.cut(&Cubic::line(a, b).0, 0, &mut found);
            assert_eq!(found.len(), expected.len(), "{found:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found.0 - expected.0).abs() < 1e-9 && (found.1 - expected.1).abs() < 1e-9, "{found:?}");
            }
        }
    }
}
