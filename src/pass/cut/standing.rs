//! Where a tile lies relative to the painted region.

use crate::geom::clip::convex_clearance;
use crate::geom::{Figure, Point, Rect, ring_bounds};
use crate::region::Region;
use crate::scene::Paint;
use crate::stage::Standing;

/// Tiles that reach over an outline by less than this many millimetres only touch it, so that upright squares on a grid
/// may fill a canvas exactly.
const TOUCH: f64 = 1e-6;

/// The painted part of the page.
pub(super) struct Ground<'a> {
    region: &'a Region,
    /// A corner of every ring, which tells whether the ring lies inside a tile that it does not cross.
    corners: Vec<Point>,
    /// How far strokes reach beyond the tile they belong to, in millimetres.
    margin: f64,
}

/// How a tile lies to the region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Contact {
    Inside,
    Outside,
    Crossing,
}

impl<'a> Ground<'a> {
    /// The visible part of a paint's region.
    pub(super) fn new(region: &'a Region, paint: &Paint) -> Self {
        let corners = region.polygons().iter().flat_map(|polygon| polygon.rings()).filter_map(|ring| ring.first());
        let hatches = paint.tone.fill.iter().filter_map(|fill| fill.kind.hatch());
        let margin = hatches.map(|hatch| paint.tone.hand.reach(hatch.pen).to_mm()).fold(0.0, f64::max);
        Self { region, corners: corners.copied().collect(), margin: margin + TOUCH }
    }

    /// Whether a site lies in it.
    pub(super) fn contains(&self, site: Point) -> bool {
        self.region.contains(site)
    }

    /// The standing where strokes end at the outline.
    pub(super) fn clip(&self, figure: Figure<'_>) -> Standing {
        if figure.outline().is_empty() {
            return Standing::Absent;
        }
        let bounds = ring_bounds(figure.outline());
        if !self.region.touches_outline(bounds.grown(self.margin)) {
            return if self.region.contains(bounds.centre()) { Standing::Whole } else { Standing::Absent };
        }
        match self.contact(figure) {
            Contact::Outside => Standing::Absent,
            Contact::Inside | Contact::Crossing => Standing::Clipped,
        }
    }

    /// The standing where only tiles wholly inside are drawn.
    pub(super) fn whole(&self, figure: Figure<'_>) -> Standing {
        if self.contact(figure) == Contact::Inside { Standing::Whole } else { Standing::Absent }
    }

    /// How a tile lies to the region: as all its pieces do. One without an outline lies outside.
    fn contact(&self, figure: Figure<'_>) -> Contact {
        let mut contacts = figure.pieces().map(|piece| self.convex_contact(piece, &ring_bounds(piece)));
        let first = contacts.next().unwrap_or(Contact::Outside);
        if contacts.all(|contact| contact == first) { first } else { Contact::Crossing }
    }

    fn convex_contact(&self, ring: &[Point], bounds: &Rect) -> Contact {
        let side = |is_inside| if is_inside { Contact::Inside } else { Contact::Outside };
        if !self.region.touches_outline(*bounds) {
            return side(self.region.contains(bounds.centre()));
        }
        // Corners move towards their mean, which lies inside a convex ring, as the middle of its box may not.
        let sum = ring.iter().fold(Point::default(), |sum, p| Point::new(sum.x + p.x, sum.y + p.y));
        let centre = Point::new(sum.x / ring.len() as f64, sum.y / ring.len() as f64);
        let inwards = |p: Point| p.lerp(centre, (TOUCH / p.distance(centre).max(TOUCH)).min(1.0));
        let Some(&last) = ring.last() else { return Contact::Outside };
        let (mut a, mut spans) = (inwards(last), Vec::new());
        let mut first = None;
        for &corner in ring {
            let b = inwards(corner);
            spans.clear();
            self.region.clip_line(a, b, &mut spans);
            let covered: f64 = spans.iter().map(|(start, end)| end - start).sum();
            let is_inside = covered > 0.5;
            // The share of an edge that is as long as the tolerance.
            let touch = TOUCH / a.distance(b).max(TOUCH);
            let is_mixed = touch < covered && covered < 1.0 - touch;
            if is_mixed || *first.get_or_insert(is_inside) != is_inside {
                return Contact::Crossing;
            }
            a = b;
        }
        let swallows = |&corner: &Point| {
            bounds.min.x < corner.x
                && corner.x < bounds.max.x
                && bounds.min.y < corner.y
                && corner.y < bounds.max.y
                && convex_clearance(ring, corner) > TOUCH
        };
        if self.corners.iter().any(swallows) { Contact::Crossing } else { side(first == Some(true)) }
    }
}
