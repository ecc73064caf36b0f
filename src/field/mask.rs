//! Tracing: an image comes in, the outlines of its dark part go out.
//!
//! Marching squares (Lorensen and Cline 1987, in the plane) between the middles of the samples; the outline stands where
//! the brightness, taken as linear along the way from one sample to the next, passes the threshold. Where four samples
//! are dark and bright crosswise, the dark ones stay apart.

use std::fmt;

use super::Image;
use crate::geom::{Point, Rect, Vec2};
use crate::region::{FillRule, Region, contained};

/// A place where the outline passes from one sample to the next: the sample's number, twice, and 1 more where the next
/// one is that below and not that to the right.
type Passage = u64;

/// Most corners of an outline that is traced: several times what a page of line art has at 600 dots per inch.
pub const MOST_CORNERS: usize = 4_000_000;

/// The dark part of an image has an outline of more than [`MOST_CORNERS`] corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooDetailed;

impl fmt::Display for TooDetailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the outline of the picture's dark part has more than four million corners")
    }
}

impl std::error::Error for TooDetailed {}

/// The part of an image whose brightness is below a threshold, with the image fitted into a box as large as can be and
/// in its middle.
///
/// # Errors
/// Where its outline has too many corners.
pub fn mask(image: &Image, threshold: f64, fit: Rect) -> Result<Region, TooDetailed> {
    let place = contained(f64::from(image.width), f64::from(image.height), fit);
    let traced = Tracer { image, threshold, place }.rings()?;
    // Samples are traced as far as one beyond the edge, so that the outline meets the image's edge squarely.
    Ok(Region::from_rings(traced, FillRule::NonZero).intersection(&Region::rect(place)))
}

struct Tracer<'a> {
    image: &'a Image,
    threshold: f64,
    place: Rect,
}

impl Tracer<'_> {
    /// Columns and rows, with one sample more on every side and, round these, one that is bright.
    fn extent(&self) -> (usize, usize) {
        (self.image.width as usize + 4, self.image.height as usize + 4)
    }

    /// The brightness of a sample less the threshold: negative inside. The two rings round the image repeat its edge
    /// and are bright.
    fn height(&self, column: usize, row: usize) -> f64 {
        let (columns, rows) = self.extent();
        if column == 0 || row == 0 || column + 1 == columns || row + 1 == rows {
            return 1.0;
        }
        let inner = |i: usize, count: u32| i.saturating_sub(2).min(count as usize - 1);
        self.image.sample(inner(column, self.image.width), inner(row, self.image.height)) - self.threshold
    }

    fn rings(&self) -> Result<Vec<Vec<Point>>, TooDetailed> {
        if self.image.width == 0 || self.image.height == 0 {
            return Ok(Vec::new());
        }
        let mut steps = self.steps()?;
        // Every passage is left once and entered once, so the steps sorted by their start lead round the rings.
        steps.sort_unstable();
        let mut is_done = vec![false; steps.len()];
        let mut rings = Vec::new();
        for first in 0..steps.len() {
            let mut ring = Vec::new();
            let mut at = first;
            while !is_done[at] {
                is_done[at] = true;
                let (from, to) = steps[at];
                ring.push(self.place_of(from));
                match steps.binary_search_by_key(&to, |&(from, _)| from) {
                    Ok(next) => at = next,
                    Err(_) => break,
                }
            }
            if ring.len() > 2 {
                rings.push(ring);
            }
        }
        Ok(rings)
    }

    /// The steps from passage to passage, the dark part to the right on the page.
    fn steps(&self) -> Result<Vec<(Passage, Passage)>, TooDetailed> {
        let (columns, rows) = self.extent();
        let mut steps = Vec::new();
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let is_dark = |dx: usize, dy: usize| self.height(column + dx, row + dy) < 0.0;
                let number = (row * columns + column) as u64;
                let top = number * 2;
                let left = number * 2 + 1;
                let right = (number + 1) * 2 + 1;
                let bottom = (number + columns as u64) * 2;
                // Top left, top right, bottom right, bottom left.
                match (is_dark(0, 0), is_dark(1, 0), is_dark(1, 1), is_dark(0, 1)) {
                    (false, false, false, false) | (true, true, true, true) => {}
                    (true, false, false, false) => steps.push((top, left)),
                    (false, true, false, false) => steps.push((right, top)),
                    (false, false, true, false) => steps.push((bottom, right)),
                    (false, false, false, true) => steps.push((left, bottom)),
                    (true, true, false, false) => steps.push((right, left)),
                    (false, true, true, false) => steps.push((bottom, top)),
                    (false, false, true, true) => steps.push((left, right)),
                    (true, false, false, true) => steps.push((top, bottom)),
                    (false, true, true, true) => steps.push((left, top)),
                    (true, false, true, true) => steps.push((top, right)),
                    (true, true, false, true) => steps.push((right, bottom)),
                    (true, true, true, false) => steps.push((bottom, left)),
                    (true, false, true, false) => steps.extend([(top, left), (bottom, right)]),
                    (false, true, false, true) => steps.extend([(right, top), (left, bottom)]),
                }
            }
            if steps.len() > MOST_CORNERS {
                return Err(TooDetailed);
            }
        }
        Ok(steps)
    }

    /// Where on the page a passage lies.
    fn place_of(&self, passage: Passage) -> Point {
        let (columns, _) = self.extent();
        let (number, downwards) = ((passage / 2) as usize, passage % 2 == 1);
        let (column, row) = (number % columns, number / columns);
        let (dx, dy) = if downwards { (0, 1) } else { (1, 0) };
        let (here, next) = (self.height(column, row), self.height(column + dx, row + dy));
        let share = (here / (here - next)).clamp(0.0, 1.0);
        // The first sample of the image is the third of its row, and its middle is half a sample from the edge.
        let x = column as f64 + dx as f64 * share - 1.5;
        let y = row as f64 + dy as f64 * share - 1.5;
        let size = Vec2::new(
            self.place.width() / f64::from(self.image.width),
            self.place.height() / f64::from(self.image.height),
        );
        self.place.min + Vec2::new(x * size.x, y * size.y)
    }
}
