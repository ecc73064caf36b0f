//! The drawing: what back ends see. Layers of strokes, dots and filled outlines in millimetres, already cut.
//!
//! Layers lie from the bottom up. Within a layer marks are grouped by their pen and lie one after the other in long lists;
//! bundles, one for each tile, are ranges of these, so that a million tiles cost no million small lists. Curves are chains
//! of cubic Béziers and stay so up to the back ends.

use crate::geom::{Length, Point};
use crate::scene::{Cap, Colour, Depth};

/// A whole picture.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// The sheet.
    pub page: Page,
    /// What is on it, from the bottom up.
    pub layers: Vec<Layer>,
}

/// The sheet. Its top left corner is the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Its width when it is trimmed.
    pub width: Length,
    /// Its height when it is trimmed.
    pub height: Length,
    /// How far the drawing goes on beyond each side, to be trimmed off; not negative.
    pub bleed: Length,
    /// Width and height of a raster.
    pub pixels: [u32; 2],
    /// Pixels per inch.
    pub dpi: f64,
    /// Its colour; none is transparent.
    pub paper: Option<Colour>,
    /// Levels of a raster.
    pub depth: Depth,
}

/// What one paint or outline puts on the sheet with one ink. All of it has one colour, so that its order only matters to
/// a plotter.
#[derive(Debug, Clone)]
pub struct Layer {
    /// The names of the groups it lies in, outermost first.
    pub groups: Vec<String>,
    /// The paint's name.
    pub name: String,
    /// The colour of all of it.
    pub ink: Colour,
    /// Filled outlines by the even-odd rule, each a list of rings.
    pub areas: Vec<Vec<Vec<Point>>>,
    /// Strokes, one entry for each width and cap.
    pub strokes: Vec<Strokes>,
    /// Strokes whose width runs out along them.
    pub tapers: Tapers,
    /// Dots, one entry for each size.
    pub dots: Vec<Dots>,
}

impl Layer {
    /// Without a mark as yet.
    #[must_use]
    pub fn new(groups: Vec<String>, name: String, ink: Colour) -> Self {
        let (areas, strokes, dots) = (Vec::new(), Vec::new(), Vec::new());
        Self { groups, name, ink, areas, strokes, tapers: Tapers::default(), dots }
    }

    /// How many strokes, dots and filled outlines it has.
    #[must_use]
    pub fn marks(&self) -> u64 {
        let strokes: usize = self.strokes.iter().map(|s| s.lines.len() + s.polylines.len() + s.curves.len()).sum();
        let dots: usize = self.dots.iter().map(|d| d.centres.len()).sum();
        (self.areas.len() + strokes + self.tapers.spines.len() + dots) as u64
    }
}

/// Strokes of one width and cap, in drawing order.
#[derive(Debug, Clone, PartialEq)]
pub struct Strokes {
    /// Their width.
    pub pen: Length,
    /// How they end.
    pub cap: Cap,
    /// Straight strokes, each from its first point to its second, those of one tile after those of another.
    pub lines: Vec<[Point; 2]>,
    /// Where each tile's lines end in `lines`, ascending; the last is the number of lines. No tile is empty.
    pub bundle_ends: Vec<usize>,
    /// Strokes of more points, with round joins; one that ends at its first point is closed.
    pub polylines: Vec<Vec<Point>>,
    /// Curved strokes, with round joins, those of one tile after those of another; one that ends at its first point is
    /// closed.
    pub curves: Curves,
}

impl Strokes {
    /// None as yet.
    #[must_use]
    pub fn new(pen: Length, cap: Cap) -> Self {
        let (lines, bundle_ends, polylines) = (Vec::new(), Vec::new(), Vec::new());
        Self { pen, cap, lines, bundle_ends, polylines, curves: Curves::default() }
    }

    /// The straight strokes of one tile after the other.
    pub fn bundles(&self) -> impl Iterator<Item = &[[Point; 2]]> {
        bundles(&self.lines, &self.bundle_ends)
    }
}

/// Chains of cubic Béziers, one after the other in one list of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Curves {
    points: Vec<Point>,
    /// Where each chain ends in `points`.
    ends: Vec<usize>,
    /// Where each tile's chains end in `ends`, ascending; the last is the number of chains.
    bundle_ends: Vec<usize>,
}

impl Curves {
    /// Adds a chain: its first point, and for every Bézier two control points and its end, so 3n + 1 points, n at least
    /// 1. What is no chain is left out.
    pub fn push(&mut self, chain: &[Point]) {
        if chain.len() >= 4 && chain.len() % 3 == 1 {
            self.points.extend_from_slice(chain);
            self.ends.push(self.points.len());
        }
    }

    /// Ends the chains of a tile, if it has any.
    pub fn end_bundle(&mut self) {
        if self.ends.len() > self.bundle_ends.last().copied().unwrap_or(0) {
            self.bundle_ends.push(self.ends.len());
        }
    }

    /// Adds all chains of another list; those that no bundle of it holds become one.
    pub fn append(&mut self, other: &Self) {
        self.end_bundle();
        let (points, chains) = (self.points.len(), self.ends.len());
        self.points.extend_from_slice(&other.points);
        self.ends.extend(other.ends.iter().map(|end| points + end));
        self.bundle_ends.extend(other.bundle_ends.iter().map(|end| chains + end));
        self.end_bundle();
    }

    /// How many chains there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// How many points all chains have.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points.len()
    }

    /// All points of all chains, to be moved.
    pub fn points_mut(&mut self) -> impl Iterator<Item = &mut Point> {
        self.points.iter_mut()
    }

    /// Where each tile's chains end, as numbers of chains, ascending. Chains after the last end belong to no tile.
    #[must_use]
    pub fn bundle_ends(&self) -> &[usize] {
        &self.bundle_ends
    }

    /// A chain: 3n + 1 points; none where there are fewer chains.
    #[must_use]
    pub fn chain(&self, i: usize) -> &[Point] {
        let start = self.start(i);
        let end = self.ends.get(i).copied().unwrap_or(start);
        self.points.get(start..end).unwrap_or_default()
    }

    /// Where a chain starts in `points`.
    fn start(&self, i: usize) -> usize {
        if i == 0 { 0 } else { self.ends.get(i - 1).copied().unwrap_or(0) }
    }

    /// All chains in order.
    pub fn iter(&self) -> impl Iterator<Item = &[Point]> {
        (0..self.len()).map(|i| self.chain(i))
    }
}

/// Strokes that change their width along them: to a back end they are filled outlines, to a plotter plain strokes along
/// their spines.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tapers {
    /// What they run along.
    pub spines: Curves,
    /// The width at every joint of every spine in millimetres, not negative: a chain of n Béziers has n + 1 joints. Between
    /// two joints the width changes evenly with the curve's parameter. Ends are cut straight across.
    pub widths: Vec<f64>,
}

impl Tapers {
    /// Adds a stroke: a chain of n Béziers and the width at each of its n + 1 joints. What does not fit is left out.
    pub fn push(&mut self, spine: &[Point], widths: &[f64]) {
        if spine.len() >= 4 && spine.len() + 2 == 3 * widths.len() {
            self.spines.push(spine);
            self.widths.extend_from_slice(widths);
        }
    }

    /// Adds all strokes of another list.
    pub fn append(&mut self, other: &Self) {
        self.spines.append(&other.spines);
        self.widths.extend_from_slice(&other.widths);
    }

    /// A stroke: spine, and the widths at its joints; none where there are fewer.
    #[must_use]
    pub fn stroke(&self, i: usize) -> Option<(&[Point], &[f64])> {
        let spine = self.spines.chain(i);
        // Each chain before has 3n + 1 points and n + 1 widths.
        let start = (self.spines.start(i) + 2 * i) / 3;
        let widths = self.widths.get(start..start + spine.len() / 3 + 1)?;
        (!spine.is_empty()).then_some((spine, widths))
    }

    /// All strokes in order: spine, and the widths at its joints.
    pub fn iter(&self) -> impl Iterator<Item = (&[Point], &[f64])> {
        (0..self.spines.len()).filter_map(|i| self.stroke(i))
    }
}

/// Dots of one size.
#[derive(Debug, Clone, PartialEq)]
pub struct Dots {
    /// Their radius.
    pub radius: Length,
    /// Their centres, those of one tile after those of another.
    pub centres: Vec<Point>,
    /// Where each tile's dots end in `centres`, ascending; the last is the number of dots. No tile is empty.
    pub bundle_ends: Vec<usize>,
}

impl Dots {
    /// None as yet.
    #[must_use]
    pub fn new(radius: Length) -> Self {
        Self { radius, centres: Vec::new(), bundle_ends: Vec::new() }
    }

    /// The dots of one tile after the other.
    pub fn bundles(&self) -> impl Iterator<Item = &[Point]> {
        bundles(&self.centres, &self.bundle_ends)
    }
}

/// `items` cut at `ends`.
fn bundles<'a, T>(items: &'a [T], ends: &'a [usize]) -> impl Iterator<Item = &'a [T]> {
    let mut start = 0;
    ends.iter().map(move |&end| {
        let bundle = items.get(start..end).unwrap_or_default();
        start = end;
        bundle
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(start: f64, cubics: usize) -> Vec<Point> {
        (0..=3 * cubics).map(|i| Point::new(start + i as f64, 0.0)).collect()
    }

    #[test]
    fn curves_keep_chains_and_bundles() {
        let (mut first, mut second) = (Curves::default(), Curves::default());
        first.push(&chain(0.0, 1));
        first.push(&chain(10.0, 2));
        first.end_bundle();
        first.end_bundle();
        second.push(&chain(20.0, 1));
        second.push(&chain(0.0, 1)[..3]);
        first.append(&second);
        assert_eq!(first.iter().map(<[Point]>::len).collect::<Vec<_>>(), [4, 7, 4]);
        assert_eq!(first.chain(2)[0], Point::new(20.0, 0.0));
        assert_eq!(first.bundle_ends(), [2, 3]);
        assert!(first.chain(3).is_empty());
    }

    #[test]
    fn tapers_know_their_widths() {
        let (mut tapers, mut more) = (Tapers::default(), Tapers::default());
        tapers.push(&chain(0.0, 2), &[0.2, 0.2, 0.0]);
        tapers.push(&chain(0.0, 2), &[0.2, 0.0]);
        more.push(&chain(5.0, 1), &[0.3, 0.1]);
        tapers.append(&more);
        let found: Vec<(usize, &[f64])> = tapers.iter().map(|(spine, widths)| (spine.len(), widths)).collect();
        assert_eq!(found, [(7, [0.2, 0.2, 0.0].as_slice()), (4, [0.3, 0.1].as_slice())]);
    }
}
