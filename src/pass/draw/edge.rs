//! The region's outline, where strokes and dots end, their width too.

use crate::geom::clip::{Frame, Ranges};
use crate::geom::{Point, Rect};
use crate::region::Region;
use crate::scene::{Cap, Hatch};

use super::nearby::Corners;

/// Strokes and dots may reach over an outline by this many millimetres, so that one that only touches it stays.
const TOUCH: f64 = 5e-7;

/// How far beside a corner of the outline lines are tried, in millimetres.
const BESIDE: f64 = 1e-7;

/// A region that strokes end at.
pub(super) struct Bank<'a> {
    region: &'a Region,
    corners: Corners,
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
    corners: Vec<Point>,
}

impl<'a> Bank<'a> {
    pub(super) fn new(region: &'a Region) -> Self {
        let corners = region.polygons().iter().flat_map(|polygon| polygon.rings()).flatten().copied();
        Self { region, corners: Corners::new(corners.collect()) }
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
    /// Between two neighbouring corners the outline is straight, so that what a line across the stroke's width meets is
    /// bounded by what lines beside the corners and along the stroke's edges meet: only those are tried.
    pub(super) fn clip(&self, frame: &Frame, v: f64, nib: Nib, ranges: &mut Ranges, scratch: &mut Scratch) {
        let (Some(first), Some(last)) = (ranges.as_slice().first(), ranges.as_slice().last()) else { return };
        let Nib { half, cap } = nib;
        let half = half - TOUCH.min(half / 2.0);
        let ends = (first.0 - cap, last.1 + cap);
        let Scratch { spans, kept, corners } = scratch;
        kept.reset(ends.0, ends.1);
        for beside in [0.0, -half, half] {
            self.keep(frame, v + beside, ends, kept, spans);
        }
        let (Some(&(start, _)), Some(&(_, end))) = (kept.as_slice().first(), kept.as_slice().last()) else {
            ranges.reset(0.0, 0.0);
            return;
        };
        let stroke = [(start, -half), (start, half), (end, -half), (end, half)];
        let bounds = stroke.iter().fold(Rect::EMPTY, |bounds, &(u, w)| bounds.including(frame.page(u, v + w)));
        corners.clear();
        self.corners.within(&bounds, |corner| {
            let Point { x: u, y: w } = frame.local(corner);
            if (w - v).abs() < half && start < u && u < end {
                corners.push(Point::new(u, w));
            }
        });
        for corner in corners.iter() {
            // An earlier corner may have cut this one off.
            if kept.as_slice().iter().any(|&(a, b)| a < corner.x && corner.x < b) {
                self.keep(frame, corner.y - BESIDE, ends, kept, spans);
                self.keep(frame, corner.y + BESIDE, ends, kept, spans);
            }
        }
        kept.shrink(cap);
        ranges.intersect(kept.as_slice());
    }

    /// Keeps what the line at `v` has in the region.
    fn keep(&self, frame: &Frame, v: f64, (from, to): (f64, f64), kept: &mut Ranges, spans: &mut Vec<(f64, f64)>) {
        if kept.is_empty() {
            return;
        }
        spans.clear();
        self.region.clip_line(frame.page(from, v), frame.page(to, v), spans);
        for span in spans.iter_mut() {
            // Ends stay exactly what they were, so that strokes inside are not changed by rounding.
            let at = |t: f64| if t >= 1.0 { to } else { from + t * (to - from) };
            *span = (at(span.0), at(span.1));
        }
        kept.intersect(spans);
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
