//! The region's outline, where strokes and dots end, their width too.

use crate::geom::clip::{Frame, Ranges};
use crate::geom::{Length, Point, Rect};
use crate::region::Region;
use crate::scene::{Cap, Hatch};

/// Strokes and dots may reach over an outline by this many millimetres, so that one that only touches it stays.
const TOUCH: f64 = 5e-7;

/// A region that strokes end at.
pub(super) struct Bank<'a> {
    region: &'a Region,
}

/// How far a stroke's ink reaches from its line, in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Nib {
    /// To either side.
    pub(super) half: f64,
    /// Beyond both ends.
    pub(super) cap: f64,
}

impl Nib {
    /// That of a straight stroke of the hatch's pen.
    pub(super) fn of(hatch: &Hatch) -> Self {
        let half = hatch.pen.to_mm() / 2.0;
        let cap = match hatch.cap {
            Cap::Butt => 0.0,
            Cap::Round => half,
        };
        Self { half, cap }
    }
}

/// Memory that is used again for every stroke.
#[derive(Default)]
pub(super) struct Scratch {
    spans: Vec<(f64, f64)>,
    kept: Ranges,
}

impl<'a> Bank<'a> {
    pub(super) fn new(region: &'a Region) -> Self {
        Self { region }
    }

    /// The region.
    pub(super) fn region(&self) -> &'a Region {
        self.region
    }

    /// Whether a disc lies in the region.
    pub(super) fn holds_disc(&self, centre: Point, radius: f64) -> bool {
        self.region.signed_distance(centre) >= radius - TOUCH
    }

    /// The distance of a place from the outline in millimetres, positive inside.
    pub(super) fn distance(&self, place: Point) -> f64 {
        self.region.signed_distance(place)
    }

    /// Whether a straight line lies in the region; what it reaches over the outline at its ends by a touch is not counted.
    pub(super) fn holds_line(&self, a: Point, b: Point, spans: &mut Vec<(f64, f64)>) -> bool {
        spans.clear();
        self.region.clip_line(a, b, spans);
        let touch = TOUCH / a.distance(b);
        matches!(spans.as_slice(), [(start, end)] if *start <= touch && *end >= 1.0 - touch)
    }

    /// Keeps the ranges of the line at `v` along which a stroke lies in the region in its whole width, caps included.
    ///
    /// Where the middle of a stroke lies in the region, its width does unless a piece of the outline runs through it there:
    /// what is lost are the ranges over which pieces of the outline lie in the stroke.
    pub(super) fn clip(&self, frame: &Frame, v: f64, nib: Nib, ranges: &mut Ranges, scratch: &mut Scratch) {
        let (Some(first), Some(last)) = (ranges.as_slice().first(), ranges.as_slice().last()) else { return };
        let Nib { half, cap } = nib;
        let half = half - TOUCH.min(half / 2.0);
        let (from, to) = (first.0 - cap, last.1 + cap);
        let Scratch { spans, kept } = scratch;
        let (start, end) = (frame.page(from, v), frame.page(to, v));
        spans.clear();
        self.region.clip_line(start, end, spans);
        for span in spans.iter_mut() {
            // Ends stay exactly what they were, so that strokes inside are not changed by rounding.
            let at = |t: f64| if t >= 1.0 { to } else { from + t * (to - from) };
            *span = (at(span.0), at(span.1));
        }
        kept.set(spans);
        self.region.outline_beside(start, end, Length::mm(half), |a, b| {
            if let Some((start, end)) = shadow(frame.local(a), frame.local(b), (v - half, v + half)) {
                kept.subtract(start, end);
            }
        });
        kept.shrink(cap);
        ranges.intersect(kept.as_slice());
    }

    /// How a box lies to the region.
    pub(super) fn standing(&self, bounds: Rect) -> Contact {
        if self.region.touches_outline(bounds) {
            Contact::Crossing
        } else if self.region.contains(bounds.centre()) {
            Contact::Inside
        } else {
            Contact::Outside
        }
    }
}

/// How a box lies to the region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contact {
    /// Wholly inside.
    Inside,
    /// Wholly outside.
    Outside,
    /// The outline comes into it.
    Crossing,
}

/// From where to where along the frame a straight piece lies between two places across it.
fn shadow(a: Point, b: Point, (low, high): (f64, f64)) -> Option<(f64, f64)> {
    let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
    if b.y <= low || a.y >= high {
        return None;
    }
    let at = |v: f64| a.x + (b.x - a.x) * ((v - a.y) / (b.y - a.y));
    let start = if a.y < low { at(low) } else { a.x };
    let end = if b.y > high { at(high) } else { b.x };
    Some((start.min(end), start.max(end)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::Vec2;
    use crate::region::FillRule;

    /// What of a stroke along the x axis, from 0 to 10 and 1 wide, lies in a page without a triangle.
    fn kept(hole: [(f64, f64); 3], cap: f64) -> (Region, Vec<(f64, f64)>) {
        let page = Region::rect(Rect::new(Point::new(-5.0, -5.0), Point::new(15.0, 5.0)));
        let hole = Region::from_rings(vec![hole.map(|(x, y)| Point::new(x, y)).to_vec()], FillRule::NonZero);
        let region = page.difference(&hole);
        let mut ranges = Ranges::default();
        ranges.reset(0.0, 10.0);
        let frame = Frame::new(Point::default(), Vec2::new(1.0, 0.0));
        Bank::new(&region).clip(&frame, 0.0, Nib { half: 0.5, cap }, &mut ranges, &mut Scratch::default());
        (region, ranges.as_slice().to_vec())
    }

    fn assert_near(found: &[(f64, f64)], expected: &[(f64, f64)]) {
        // What only touches is let through, so that slanting sides are met a little later.
        let is_near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-4 && (a.1 - b.1).abs() < 1e-4;
        assert!(found.len() == expected.len() && found.iter().zip(expected).all(is_near), "{found:?} {expected:?}");
    }

    #[test]
    fn a_point_that_leans_over_a_stroke_keeps_it_out_below() {
        // The point comes in between 3 and 4 and reaches to 8, beside the middle of the stroke.
        let leaning = [(3.0, 0.5), (4.0, 0.5), (8.0, 0.2)];
        assert_near(&kept(leaning, 0.0).1, &[(0.0, 3.0), (8.0, 10.0)]);
        assert_near(&kept(leaning, 0.25).1, &[(0.0, 2.75), (8.25, 10.0)]);
        // One that reaches beyond the end of the stroke, and one that stands in it.
        assert_near(&kept([(3.0, 0.5), (4.0, 0.5), (12.0, 0.2)], 0.0).1, &[(0.0, 3.0)]);
        assert_near(&kept([(3.0, 0.1), (5.0, 0.4), (4.0, 0.3)], 0.0).1, &[(0.0, 3.0), (5.0, 10.0)]);
        // One that only touches it.
        assert_near(&kept([(3.0, 1.0), (5.0, 1.0), (4.0, 0.5)], 0.0).1, &[(0.0, 10.0)]);
    }

    proptest! {
        #[test]
        fn what_is_kept_is_where_the_whole_width_lies_inside(
            hole in [(-1.0..11.0f64, -1.5..1.5f64), (-1.0..11.0, -1.5..1.5), (-1.0..11.0, -1.5..1.5)],
        ) {
            let (region, kept) = kept(hole, 0.0);
            for i in 0..=200 {
                let u = f64::from(i) / 20.0;
                let is_kept = kept.iter().any(|&(from, to)| from <= u && u <= to);
                if kept.iter().any(|&(from, to)| (u - from).abs() < 1e-3 || (u - to).abs() < 1e-3) {
                    continue;
                }
                let is_inside = |half: f64| {
                    let across = Rect::new(Point::new(u, -half), Point::new(u, half));
                    region.contains(Point::new(u, 0.0)) && !region.touches_outline(across)
                };
                // Where the outline comes as near as that to the stroke's edge, it may count as touching it.
                if is_inside(0.49999) == is_inside(0.50001) {
                    prop_assert!(is_kept == is_inside(0.5), "{} {:?}", u, kept);
                }
            }
        }
    }
}
