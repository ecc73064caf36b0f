//! The drawing: what back ends see. Layers of strokes, dots and filled outlines in millimetres, already cut.
//!
//! Layers lie from the bottom up. Within a layer marks are grouped by their pen and lie one after the other in long lists;
//! bundles, one for each tile, are ranges of these, so that a million tiles cost no million small lists.

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

/// The sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Its width.
    pub width: Length,
    /// Its height.
    pub height: Length,
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
    /// Dots, one entry for each size.
    pub dots: Vec<Dots>,
}

impl Layer {
    /// How many strokes, dots and filled outlines it has.
    #[must_use]
    pub fn marks(&self) -> u64 {
        let strokes: usize = self.strokes.iter().map(|s| s.lines.len() + s.polylines.len()).sum();
        let dots: usize = self.dots.iter().map(|d| d.centres.len()).sum();
        (self.areas.len() + strokes + dots) as u64
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
}

impl Strokes {
    /// None as yet.
    #[must_use]
    pub fn new(pen: Length, cap: Cap) -> Self {
        Self { pen, cap, lines: Vec::new(), bundle_ends: Vec::new(), polylines: Vec::new() }
    }

    /// The straight strokes of one tile after the other.
    pub fn bundles(&self) -> impl Iterator<Item = &[[Point; 2]]> {
        bundles(&self.lines, &self.bundle_ends)
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
