//! Stamps: outlines of one size that are set on every site, turned with the tile's angle or upright.

use crate::geom::{Angle, Length, Pieces, Point, Vec2, ring_bounds};
use crate::scene::{IRREGULAR_OVERLAP, POINTED_OVERLAP, Placement, Shape};

/// The side of an equilateral triangle whose area is 1: 2 / ⁴√3.
const SIDE_OF_UNIT_TRIANGLE: f64 = 1.519_671_371_303_185_2;

/// An outline round the origin at angle 0, clockwise on the page.
pub(super) struct Stamp {
    corners: Vec<Vec2>,
    /// The convex pieces of one that is not convex.
    pieces: Pieces,
    upright: bool,
}

impl Stamp {
    /// The stamp of a shape; cells have none and give an empty one. `spacing` is the distance of neighbouring sites in
    /// millimetres.
    pub(super) fn new(shape: &Shape, place: &Placement, spacing: f64) -> Self {
        let scale = |overlap: Option<f64>, is_sized: bool, irregular: f64| match overlap {
            Some(overlap) => overlap,
            None if is_sized => 1.0,
            None if place.is_lattice() => 1.0,
            None => irregular,
        };
        let or_spacing = |size: Option<Length>| size.map_or(spacing, Length::to_mm);
        let convex = |corners, upright| Self { corners, pieces: Pieces::NONE, upright };
        match *shape {
            Shape::Rect { width, height, overlap, upright } => {
                let scale = scale(overlap, width.or(height).is_some(), IRREGULAR_OVERLAP);
                let w = or_spacing(width) * scale / 2.0;
                let h = height.map_or(or_spacing(width), Length::to_mm) * scale / 2.0;
                let corners = vec![Vec2::new(-w, -h), Vec2::new(w, -h), Vec2::new(w, h), Vec2::new(-w, h)];
                convex(corners, upright)
            }
            Shape::Hexagon { size, overlap, upright } => {
                let radius = or_spacing(size) * scale(overlap, size.is_some(), IRREGULAR_OVERLAP) / 3f64.sqrt();
                // The first corner lies a twelfth of a turn from +x, so that a flat faces it.
                let corners = (0..6).map(|i| Angle::degrees(30.0 + 60.0 * f64::from(i)).unit() * radius).collect();
                convex(corners, upright)
            }
            Shape::Triangle { size, overlap, upright } => {
                let side = size.map_or(spacing * SIDE_OF_UNIT_TRIANGLE, Length::to_mm);
                let radius = side * scale(overlap, size.is_some(), POINTED_OVERLAP) / 3f64.sqrt();
                // The first corner lies a quarter of a turn before +x: the base faces +y, the foot of the page.
                let corners = (0..3).map(|i| Angle::degrees(120.0 * f64::from(i) - 90.0).unit() * radius).collect();
                convex(corners, upright)
            }
            Shape::Trapezoid { taper, size, overlap, upright } => {
                // The mean of both ends is as long as their distance, so that it covers what a square of its size does.
                let wide = 2.0 / (2.0 - taper);
                let narrow = wide * (1.0 - taper);
                let size = or_spacing(size) * scale(overlap, size.is_some(), POINTED_OVERLAP);
                let before = (wide + 2.0 * narrow) / (3.0 * (wide + narrow));
                let (left, right) = (-before, 1.0 - before);
                let mut corners = vec![Vec2::new(left, -wide / 2.0), Vec2::new(right, -narrow / 2.0)];
                if narrow > 0.0 {
                    corners.push(Vec2::new(right, narrow / 2.0));
                }
                corners.push(Vec2::new(left, wide / 2.0));
                convex(corners.into_iter().map(|corner| corner * size).collect(), upright)
            }
            Shape::Stamp { ref outline, size, overlap, upright } => {
                let bounds = ring_bounds(outline);
                let own = bounds.width().max(bounds.height());
                let factor = size.map_or(1.0, |size| size.to_mm() / own) * overlap.unwrap_or(1.0);
                let corners = outline.iter().map(|&corner| (corner - Point::default()) * factor).collect();
                Self { corners, pieces: Pieces::of(outline), upright }
            }
            Shape::Voronoi { .. } | Shape::Cell { .. } => convex(Vec::new(), true),
        }
    }

    /// How outlines fall into convex pieces.
    pub(super) fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    /// Writes the outline on a site.
    pub(super) fn outline(&self, site: Point, angle: Angle, ring: &mut Vec<Point>) {
        let along = if self.upright { Vec2::new(1.0, 0.0) } else { angle.unit() };
        let across = along.turned();
        ring.clear();
        ring.extend(self.corners.iter().map(|corner| site + along * corner.x + across * corner.y));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{ring_area, ring_bounds};

    const GRID: Placement = Placement::Hex { spacing: Length::mm(2.0) };

    fn outline(shape: &Shape, place: &Placement, angle: f64) -> Vec<Point> {
        let mut ring = Vec::new();
        Stamp::new(shape, place, 2.0).outline(Point::new(5.0, 3.0), Angle::degrees(angle), &mut ring);
        ring
    }

    #[test]
    fn sizes_default_to_the_spacing_and_overlaps_to_what_fills_the_page() {
        let rect = |width, height, overlap| Shape::Rect { width, height, overlap, upright: false };
        let area = |shape: &Shape, place: &Placement| ring_area(&outline(shape, place, 33.0));
        let points = Placement::Points(Vec::new());
        let mm = |value| Some(Length::mm(value));
        assert!((area(&rect(None, None, None), &GRID) - 4.0).abs() < 1e-12);
        assert!((area(&rect(None, None, None), &points) - 4.0 * 1.6 * 1.6).abs() < 1e-12);
        assert!((area(&rect(None, None, Some(0.5)), &points) - 1.0).abs() < 1e-12);
        assert!((area(&rect(mm(3.0), None, None), &points) - 9.0).abs() < 1e-12);
        assert!((area(&rect(None, mm(3.0), Some(2.0)), &GRID) - 24.0).abs() < 1e-12);
    }

    #[test]
    fn widths_run_along_the_strokes() {
        let shape = |upright| {
            let (width, height) = (Some(Length::mm(4.0)), Some(Length::mm(1.0)));
            Shape::Rect { width, height, overlap: None, upright }
        };
        let turned = ring_bounds(&outline(&shape(false), &GRID, 90.0));
        assert!((turned.width() - 1.0).abs() < 1e-12 && (turned.height() - 4.0).abs() < 1e-12);
        let upright = ring_bounds(&outline(&shape(true), &GRID, 90.0));
        assert!((upright.width() - 4.0).abs() < 1e-12 && (upright.height() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn triangles_and_trapezoids_are_as_large_as_squares() {
        let points = Placement::Points(Vec::new());
        let triangle = |size, overlap| Shape::Triangle { size, overlap, upright: false };
        let trapezoid = |taper, size| Shape::Trapezoid { taper, size, overlap: None, upright: false };
        let area = |shape: &Shape, place: &Placement| ring_area(&outline(shape, place, 71.0));
        assert!((area(&triangle(None, None), &GRID) - 4.0).abs() < 1e-12);
        assert!((area(&triangle(None, None), &points) - 4.0 * 1.7 * 1.7).abs() < 1e-12);
        assert!((area(&triangle(Some(Length::mm(4.0)), None), &points) - 4.0 * 3f64.sqrt()).abs() < 1e-12);
        for taper in [0.0, 0.6, 1.0] {
            assert!((area(&trapezoid(taper, None), &GRID) - 4.0).abs() < 1e-12);
            let sized = area(&trapezoid(taper, Some(Length::mm(4.0))), &points);
            assert!((sized - 16.0).abs() < 1e-12);
        }
        assert_eq!(outline(&trapezoid(1.0, None), &GRID, 0.0).len(), 3);
    }

    #[test]
    fn triangles_stand_and_trapezoids_narrow_along_the_strokes() {
        let size = Some(Length::mm(3.0));
        let ring = outline(&Shape::Triangle { size, overlap: None, upright: true }, &GRID, 45.0);
        // Apex up; the site is the middle.
        assert!(ring[0].x == 5.0 && (ring[0].y - (3.0 - 3f64.sqrt())).abs() < 1e-12);
        assert!((ring[1].y - ring[2].y).abs() < 1e-12);
        let ring = outline(&Shape::Trapezoid { taper: 0.6, size, overlap: None, upright: true }, &GRID, 45.0);
        let bounds = ring_bounds(&ring);
        let (wide, narrow) = (3.0 / 0.7, 1.2 / 0.7);
        assert!((bounds.width() - 3.0).abs() < 1e-12 && (bounds.height() - wide).abs() < 1e-12);
        assert!((ring[2].y - ring[1].y - narrow).abs() < 1e-12 && ring[1].x > ring[0].x);
        // The centre of its area lies on the site.
        assert!((bounds.min.x - (5.0 - 3.0 * 1.8 / 4.2)).abs() < 1e-12);
    }

    #[test]
    fn stamps_keep_their_own_coordinates_unless_they_are_sized() {
        let arrow = [(0.0, 0.0), (4.0, 2.0), (0.0, 4.0), (1.0, 2.0)].map(|(x, y)| Point::new(x, y));
        let shape = |size, overlap| Shape::Stamp { outline: arrow.to_vec(), size, overlap, upright: true };
        let ring = outline(&shape(None, None), &GRID, 10.0);
        assert!(ring.iter().zip(arrow).all(|(p, corner)| p.x == 5.0 + corner.x && p.y == 3.0 + corner.y));
        let bounds = ring_bounds(&outline(&shape(Some(Length::mm(8.0)), Some(0.5)), &GRID, 10.0));
        assert!((bounds.width() - 4.0).abs() < 1e-12);
        assert!(!Stamp::new(&shape(None, None), &GRID, 2.0).pieces().is_empty());
    }

    #[test]
    fn hexagons_are_measured_across_their_flats() {
        let shape = Shape::Hexagon { size: None, overlap: None, upright: true };
        let ring = outline(&shape, &GRID, 10.0);
        let bounds = ring_bounds(&ring);
        // Two vertical sides lie the spacing apart, so that the stamps fill a hexagonal lattice.
        assert!((bounds.width() - 2.0).abs() < 1e-12);
        assert!((bounds.height() - 4.0 / 3f64.sqrt()).abs() < 1e-12);
        assert!((ring_area(&ring) - 2.0 * 3f64.sqrt()).abs() < 1e-12);
    }
}
