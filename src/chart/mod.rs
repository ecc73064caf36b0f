//! Charts: plain data in, the text of an SVG out.
//!
//! All charts look alike: white ground, hairline axes, ticks at round numbers, text as text in a plain sans-serif, the
//! colours of Okabe and Ito (2008), which readers tell apart whatever colours they see, and for more series than colours
//! dashes and other markers. Every text is escaped. The same data give the same bytes. Values that are not finite are left
//! out, so that no chart holds a number that is none; a chart without data says so. An SVG holds no ids, so that a page may
//! hold many.

mod axis;
mod bars;
mod boxes;
mod effects;
mod lines;
mod matrix;
mod polar;
mod sheet;
#[cfg(test)]
mod tests;

pub use bars::{Bars, Mark, histogram};
pub use boxes::{Group, boxes};
pub use effects::{Effect, Estimate, effects};
pub use lines::{Look, Series, Spot, lines};
pub use matrix::matrix;
pub use polar::{Sector, directions};

/// What a chart is called, and what its axes are. Texts may be empty.
#[derive(Debug, Clone, Copy, Default)]
pub struct Titles<'a> {
    /// Above the chart.
    pub title: &'a str,
    /// Along the horizontal axis.
    pub x: &'a str,
    /// Along the vertical axis.
    pub y: &'a str,
}
