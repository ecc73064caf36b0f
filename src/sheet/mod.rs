//! Contact sheets: what is known of several pictures goes in, one page with a place for each and its captions comes out.
//!
//! A sheet is laid out before there is a picture: pictures then come in any order, and none has to wait for another. All
//! lies on one page, in rows; every picture keeps its proportions. The back ends put pictures and page together.

mod layout;
pub mod letters;

use crate::drawing::{Layer, Page};
use crate::geom::{Length, Point, Rect};
use crate::scene::Colour;

/// The colours of a sheet.
const INK: Colour = Colour { r: 0x22, g: 0x22, b: 0x22, a: 255 };
const GREY: Colour = Colour { r: 0x76, g: 0x76, b: 0x76, a: 255 };
const FAINT: Colour = Colour { r: 0xc4, g: 0xc4, b: 0xc4, a: 255 };

/// What goes on a sheet.
#[derive(Debug, Clone, Default)]
pub struct Grid {
    /// The large line on top; none where it is empty.
    pub title: String,
    /// Smaller lines below it.
    pub subtitle: Vec<String>,
    /// What stands over the columns; nothing where it is empty.
    pub heads: Vec<String>,
    /// The rows from the top down.
    pub rows: Vec<Row>,
    /// How pictures of different sizes compare.
    pub scale: Scale,
    /// The longest side that a picture has on the sheet.
    pub side: Length,
}

/// How pictures of different sizes compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// As they are: one that is twice as wide is shown twice as wide.
    #[default]
    Common,
    /// Each is as large as its place allows.
    Each,
}

/// A row of pictures.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// A line over the row, where something new begins.
    pub heading: Option<String>,
    /// What stands left of it, the first line larger.
    pub label: Vec<String>,
    /// Its places from the left.
    pub slots: Vec<Slot>,
}

/// A place on a sheet.
#[derive(Debug, Clone)]
pub struct Slot {
    /// What the picture is called in files that name their parts.
    pub name: String,
    /// The lines under it.
    pub caption: Vec<String>,
    /// What is in it.
    pub holds: Holds,
}

/// What a place holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Holds {
    /// A picture of this width and height.
    Picture([Length; 2]),
    /// Why there is no picture.
    Words(String),
}

/// A sheet that waits for its pictures.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// The page, white.
    pub page: Page,
    /// Where pictures go, those of one row after those of another. Places without a picture are not among them.
    pub places: Vec<Place>,
    /// What is written.
    pub texts: Vec<Text>,
    /// The edges of pictures and of places without one.
    pub frames: Vec<Rect>,
}

/// Where a picture goes.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// Which slot it is, counted through all rows.
    pub slot: usize,
    /// What it is called.
    pub name: String,
    /// Where it lies, in millimetres; it has the picture's proportions.
    pub area: Rect,
}

impl Place {
    /// A line in the middle of it.
    #[must_use]
    pub fn says(&self, words: &str) -> Text {
        layout::in_the_middle(&self.area, words)
    }
}

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// Its characters.
    pub text: String,
    /// A point of its baseline: where it starts, or its middle.
    pub at: Point,
    /// Which.
    pub anchor: Anchor,
    /// The letters' size.
    pub size: Length,
    /// Their colour.
    pub ink: Colour,
}

/// Which point of a line of text is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its start.
    Start,
    /// Its middle.
    Middle,
}

impl Text {
    /// Its letters as areas.
    #[must_use]
    pub fn areas(&self) -> Vec<Vec<Vec<Point>>> {
        let back = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => letters::width(&self.text, self.size).to_mm() / 2.0,
        };
        letters::areas(&self.text, Point::new(self.at.x - back, self.at.y), self.size)
    }
}

impl Sheet {
    /// Lays a grid out.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        layout::lay_out(grid)
    }

    /// The frames as a layer of hairlines.
    #[must_use]
    pub fn frame_layer(&self) -> Layer {
        layout::frames(&self.frames)
    }

    /// The texts as layers of filled outlines, one for each colour.
    #[must_use]
    pub fn text_layers(&self) -> Vec<Layer> {
        [INK, GREY]
            .into_iter()
            .map(|ink| {
                let mut layer = Layer::new(Vec::new(), "captions".to_owned(), ink);
                layer.areas = self.texts.iter().filter(|text| text.ink == ink).flat_map(Text::areas).collect();
                layer
            })
            .collect()
    }
}

#[cfg(test)]
mod tests;
