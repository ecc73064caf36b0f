//! The ground of tones that say nothing about it: gaps between stamps that are meant to lie on each other are accidents, and
//! are hatched as the nearest tile is. Gaps of smaller stamps were asked for.

use crate::geom::{Length, ring_area, ring_bounds};
use crate::scene::{Amount, Edge, Ground, IRREGULAR_OVERLAP, POINTED_OVERLAP, Placement, Shape, Stack, Tone};

/// Stamps as large as squares whose sides are so much longer than the distance of sites are meant to lie on each other.
const LAID: f64 = 1.2;

/// The ground of a tone, all other properties of which are decided.
pub(super) fn default(tone: &Tone) -> Option<Ground> {
    let is_laid = tone.stack == Stack::Cover && tone.edge == Edge::Clip;
    let spacing = irregular(&tone.place)?;
    (is_laid && area(&tone.shape, spacing)? >= LAID * LAID).then_some(Ground::Nearest)
}

/// The spacing of irregular sites, where it is known before they are placed.
fn irregular(place: &Placement) -> Option<Option<Length>> {
    match place {
        Placement::Poisson { radius, density: None, .. } => Some(Some(*radius)),
        Placement::Uniform { amount: Amount::Count { density: None, .. } | Amount::AsMany(_) } => Some(None),
        Placement::Relaxed { placement, .. } => irregular(placement),
        // Where tiles stand more or less densely, their gaps are part of that.
        Placement::Poisson { density: Some(_), .. }
        | Placement::Uniform { .. }
        | Placement::Grid(_)
        | Placement::Hex { .. }
        | Placement::Triangles { .. }
        | Placement::Penrose { .. }
        | Placement::Pinwheel { .. }
        | Placement::Points(_) => None,
    }
}

/// The area of a stamp in squares of the spacing; none where it is a cell, or where its size cannot be held against the
/// spacing.
fn area(shape: &Shape, spacing: Option<Length>) -> Option<f64> {
    let side = |size: Option<Length>| match (size, spacing) {
        (None, _) => Some(1.0),
        (Some(size), Some(spacing)) => Some(size / spacing),
        (Some(_), None) => None,
    };
    let scale = |overlap: Option<f64>, is_sized: bool, irregular: f64| {
        let scale = overlap.unwrap_or(if is_sized { 1.0 } else { irregular });
        scale * scale
    };
    match shape {
        Shape::Rect { width, height, overlap, .. } => {
            let across = side(height.or(*width))?;
            Some(side(*width)? * across * scale(*overlap, width.or(*height).is_some(), IRREGULAR_OVERLAP))
        }
        Shape::Hexagon { size, overlap, .. } => {
            let side = side(*size)?;
            Some(side * side * 0.75f64.sqrt() * scale(*overlap, size.is_some(), IRREGULAR_OVERLAP))
        }
        Shape::Triangle { size, overlap, .. } => {
            let side = side(*size)?;
            let share = if size.is_some() { 0.1875f64.sqrt() } else { 1.0 };
            Some(side * side * share * scale(*overlap, size.is_some(), POINTED_OVERLAP))
        }
        Shape::Trapezoid { size, overlap, .. } => {
            let side = side(*size)?;
            Some(side * side * scale(*overlap, size.is_some(), POINTED_OVERLAP))
        }
        Shape::Stamp { outline, size, overlap, .. } => {
            let bounds = ring_bounds(outline);
            let longer = Length::mm(bounds.width().max(bounds.height()));
            let grown = side(Some(size.unwrap_or(longer)))? / longer.to_mm();
            Some(ring_area(outline).abs() * grown * grown * scale(*overlap, true, IRREGULAR_OVERLAP))
        }
        Shape::Voronoi { .. } | Shape::Cell { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(size: Option<f64>, overlap: Option<f64>) -> Shape {
        Shape::Rect { width: size.map(Length::mm), height: None, overlap, upright: false }
    }

    #[test]
    fn stamps_that_lie_on_each_other_leave_gaps_by_accident() {
        let spacing = Some(Length::mm(5.0));
        let is_laid = |shape: &Shape| area(shape, spacing).is_some_and(|area| area >= LAID * LAID);
        assert!(is_laid(&square(None, None)) && is_laid(&square(Some(8.0), None)) && is_laid(&square(None, Some(1.3))));
        assert!(!is_laid(&square(Some(5.0), None)) && !is_laid(&square(None, Some(1.1))));
        assert_eq!(area(&square(Some(8.0), None), None), None);
        assert_eq!(area(&square(None, None), None), Some(1.6 * 1.6));
        let place = |density| Placement::Poisson { radius: Length::mm(5.0), tries: 30, density };
        assert_eq!(irregular(&place(None)), Some(spacing));
        assert_eq!(irregular(&place(Some(crate::field::Field::constant(1.0)))), None);
    }
}
