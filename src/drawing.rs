//! The drawing: what back ends see. Layers of strokes, dots and filled outlines in millimetres, already cut.
//!
//! Layers lie from the bottom up. Within a layer marks come in bundles, one for each tile and pen, in drawing order.

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

/// What one paint or outline puts on the sheet with one ink.
#[derive(Debug, Clone)]
pub struct Layer {
    /// The names of the groups it lies in, outermost first.
    pub groups: Vec<String>,
    /// The paint's name.
    pub name: String,
    /// The colour of all of it.
    pub ink: Colour,
    /// The marks, in drawing order.
    pub bundles: Vec<Bundle>,
}

/// Marks that belong together: one tile's, or an outline's.
#[derive(Debug, Clone, Default)]
pub struct Bundle {
    /// Strokes of one width.
    pub strokes: Vec<Strokes>,
    /// Dots of one size.
    pub dots: Vec<Dots>,
    /// Filled outlines by the even-odd rule, each a list of rings.
    pub areas: Vec<Vec<Vec<Point>>>,
}

/// Strokes of one width and cap, in drawing order.
#[derive(Debug, Clone, PartialEq)]
pub struct Strokes {
    /// Their width.
    pub pen: Length,
    /// How they end.
    pub cap: Cap,
    /// Straight strokes, each from its first point to its second.
    pub lines: Vec<[Point; 2]>,
    /// Strokes of more points; one that ends at its first point is closed.
    pub polylines: Vec<Vec<Point>>,
}

/// Dots of one size.
#[derive(Debug, Clone, PartialEq)]
pub struct Dots {
    /// Their radius.
    pub radius: Length,
    /// Their centres.
    pub centres: Vec<Point>,
}
