//! Regions: areas of the page as polygons in millimetres.
//!
//! Shapes, path data, SVG files and traced images come in; what goes out can be tested against points, lines and boxes
//! and combined. A region's polygons do not cross themselves or each other, so that the even-odd and the non-zero rule
//! agree; outer rings run clockwise on the page and holes the other way. Curves become lines within [`FLATTENING`].
//! Nothing here depends on the machine but the numbers of SVG files, see [`svg`].

pub mod chain;
mod curve;
pub mod flood;
mod index;
mod nearest;
mod overlay;
pub mod path;
pub mod svg;
mod tangle;
#[cfg(test)]
mod tests;

use std::sync::{Arc, OnceLock};

use serde::{Serialize, Serializer};

use crate::geom::{Angle, Length, Point, Polygon, Rect, Vec2, ring_bounds};
use index::Index;
use nearest::Nearest;

pub use curve::Subpath;
pub use overlay::Operation;
pub use path::{PathError, PathProblem};
pub use tangle::Tangled;

/// The farthest that the lines which stand for a curve may lie from it.
pub const FLATTENING: Length = Length::mm(0.005);

/// An area. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Region(Arc<Data>);

#[derive(Debug)]
struct Data {
    polygons: Vec<Polygon>,
    bounds: Rect,
    /// Made when first asked for.
    index: OnceLock<Index>,
    /// Made when first asked for.
    nearest: OnceLock<Nearest>,
}

/// Which points crossing rings enclose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FillRule {
    /// Those that the rings run round in one sense more often than in the other.
    NonZero,
    /// Those that an odd number of rings runs round.
    EvenOdd,
}

impl Region {
    /// Nothing.
    #[must_use]
    pub fn empty() -> Self {
        Self::from_resolved(Vec::new())
    }

    /// An upright box; nothing where the box holds nothing.
    #[must_use]
    pub fn rect(area: Rect) -> Self {
        let is_finite = area.corners().iter().all(|p| p.x.is_finite() && p.y.is_finite());
        if area.is_empty() || !is_finite {
            return Self::empty();
        }
        Self::from_resolved(vec![Polygon { outer: area.corners().to_vec(), holes: Vec::new() }])
    }

    /// A disc.
    #[must_use]
    pub fn circle(centre: Point, radius: Length) -> Self {
        Self::ellipse(centre, radius, radius)
    }

    /// An ellipse with its axes along x and y.
    #[must_use]
    pub fn ellipse(centre: Point, rx: Length, ry: Length) -> Self {
        Self::from_rings(vec![curve::ellipse(centre, rx, ry)], FillRule::NonZero)
    }

    /// A polygon, which may cross itself: what it runs round is inside, in whatever sense.
    ///
    /// # Errors
    /// Where it crosses itself too often.
    pub fn polygon(corners: &[Point]) -> Result<Self, Tangled> {
        Self::try_from_rings(vec![corners.to_vec()], FillRule::NonZero)
    }

    /// As [`Region::from_rings`], for rings that come from outside.
    ///
    /// # Errors
    /// Where they cross too often.
    pub fn try_from_rings(rings: Vec<Vec<Point>>, rule: FillRule) -> Result<Self, Tangled> {
        overlay::check(&rings)?;
        Ok(Self::from_rings(rings, rule))
    }

    /// What rings enclose; they may cross themselves and each other. Rings with a coordinate that is not finite are
    /// left out, and so are areas below a square of a thousandth of a millimetre. Time and memory grow with the crossings.
    #[must_use]
    pub fn from_rings(rings: Vec<Vec<Point>>, rule: FillRule) -> Self {
        Self::from_resolved(overlay::resolve(&rings, rule))
    }

    /// From polygons that do not cross.
    fn from_resolved(polygons: Vec<Polygon>) -> Self {
        let bounds = polygons.iter().fold(Rect::EMPTY, |bounds, polygon| {
            let outer = ring_bounds(&polygon.outer);
            bounds.including(outer.min).including(outer.max)
        });
        Self(Arc::new(Data { polygons, bounds, index: OnceLock::new(), nearest: OnceLock::new() }))
    }

    /// What either holds.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        if self.is_empty() {
            return other.clone();
        }
        if other.is_empty() {
            return self.clone();
        }
        self.combined(other, Operation::Union)
    }

    /// What this one holds and the other does not.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        if !self.bounds().touches(&other.bounds()) {
            return self.clone();
        }
        self.combined(other, Operation::Difference)
    }

    /// What both hold.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        if !self.bounds().touches(&other.bounds()) {
            return Self::empty();
        }
        self.combined(other, Operation::Intersection)
    }

    /// As [`Region::union`], [`Region::difference`] or [`Region::intersection`], for outlines that come from outside.
    ///
    /// # Errors
    /// Where the outlines cross too often.
    pub fn try_combined(&self, other: &Self, operation: Operation) -> Result<Self, Tangled> {
        if self.bounds().touches(&other.bounds()) {
            overlay::check(self.polygons().iter().chain(other.polygons()).flat_map(Polygon::rings))?;
        }
        Ok(match operation {
            Operation::Union => self.union(other),
            Operation::Difference => self.difference(other),
            Operation::Intersection => self.intersection(other),
        })
    }

    fn combined(&self, other: &Self, operation: Operation) -> Self {
        Self::from_resolved(overlay::combine(self.polygons(), other.polygons(), operation))
    }

    /// What lies deeper inside than a distance; where the distance is negative, what lies no farther outside. Corners
    /// that grow are rounded.
    #[must_use]
    pub fn inset(&self, distance: Length) -> Self {
        // A distance that is no number changes nothing, like none.
        if self.is_empty() || distance.to_mm().is_nan() || distance == Length::ZERO {
            return self.clone();
        }
        Self::from_resolved(overlay::grow(self.polygons(), -distance))
    }

    /// As [`Region::inset`], for outlines that come from outside.
    ///
    /// # Errors
    /// Where the outline is so detailed that, moved, it crosses itself too often.
    pub fn try_inset(&self, distance: Length) -> Result<Self, Tangled> {
        overlay::check_growth(self.polygons(), -distance)?;
        Ok(self.inset(distance))
    }

    /// Moved.
    #[must_use]
    pub fn translated(&self, by: Vec2) -> Self {
        self.mapped(|p| p + by)
    }

    /// Turned from +x towards +y about a point.
    #[must_use]
    pub fn rotated(&self, angle: Angle, about: Point) -> Self {
        let (sin, cos) = angle.sin_cos();
        self.mapped(|p| {
            let v = p - about;
            about + Vec2::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos)
        })
    }

    /// Scaled by a factor along x and one along y, either of which may be negative, from a fixed point.
    #[must_use]
    pub fn scaled(&self, factors: [f64; 2], about: Point) -> Self {
        self.mapped(|p| {
            let v = p - about;
            about + Vec2::new(v.x * factors[0], v.y * factors[1])
        })
    }

    /// With every corner moved by an affine map. Rounding may make corners cross, so the result is resolved again.
    fn mapped(&self, map: impl Fn(Point) -> Point) -> Self {
        let rings: Vec<Vec<Point>> = self
            .polygons()
            .iter()
            .flat_map(Polygon::rings)
            .map(|ring| ring.iter().map(|&p| map(p)).collect())
            .collect();
        Self::from_rings(rings, FillRule::NonZero)
    }

    /// The polygons it is made of.
    #[must_use]
    pub fn polygons(&self) -> &[Polygon] {
        &self.0.polygons
    }

    /// The least box around it; [`Rect::EMPTY`] for the empty region.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        self.0.bounds
    }

    /// Its area in square millimetres.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.polygons().iter().map(Polygon::area).sum()
    }

    /// Whether it holds nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.polygons().is_empty()
    }

    /// Whether a point is inside. On the outline, upper and left sides count.
    #[must_use]
    pub fn contains(&self, p: Point) -> bool {
        self.index().contains(p)
    }

    /// Appends the pieces of the line from `a` to `b` that are inside, in order, each as the shares of the way at which
    /// it starts and ends.
    pub fn clip_line(&self, a: Point, b: Point, out: &mut Vec<(f64, f64)>) {
        self.index().clip_line(a, b, out);
    }

    /// Calls `visit` with the ends of every straight piece of the outline that comes within `reach` of the line from `a` to
    /// `b`, some of them more than once, and with some that lie farther away.
    pub fn outline_beside(&self, a: Point, b: Point, reach: Length, visit: impl FnMut(Point, Point)) {
        self.index().beside(a, b, reach.to_mm(), visit);
    }

    /// Whether any piece of the outline comes into a closed box. Where none does, the box lies wholly inside or wholly
    /// outside.
    #[must_use]
    pub fn touches_outline(&self, area: Rect) -> bool {
        self.index().touches(&area)
    }

    /// The distance to the outline in millimetres, positive inside; for the empty region minus infinity.
    #[must_use]
    pub fn signed_distance(&self, p: Point) -> f64 {
        let segments = self.index().segments();
        let distance = self.nearest().distance_squared(segments, p).sqrt();
        if self.contains(p) { distance } else { -distance }
    }

    /// The direction of the outline where it is nearest to a point, in [0, pi); 0 for the empty region.
    #[must_use]
    pub fn tangent(&self, p: Point) -> Angle {
        self.nearest().tangent(self.index().segments(), p).unwrap_or(Angle::ZERO)
    }

    fn nearest(&self) -> &Nearest {
        self.0.nearest.get_or_init(|| Nearest::new(self.index().segments()))
    }

    fn index(&self) -> &Index {
        self.0.index.get_or_init(|| Index::new(self.polygons()))
    }
}

/// The box of given proportions that fits into another, as large as can be and in its middle. The other box itself
/// where the proportions are not above zero.
#[must_use]
pub fn contained(width: f64, height: f64, fit: Rect) -> Rect {
    let scale = (fit.width() / width).min(fit.height() / height);
    if !(width > 0.0 && height > 0.0 && scale.is_finite()) {
        return fit;
    }
    let half = Vec2::new(width, height) * (scale / 2.0);
    Rect::new(fit.centre() - half, fit.centre() + half)
}

impl Serialize for Region {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.polygons().serialize(serializer)
    }
}
