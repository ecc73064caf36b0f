//! Equilateral triangles in strips, pointing up and down by turns.

use crate::diag::Diagnostic;
use crate::geom::Point;
use crate::geom::clip::convex_overlap;
use crate::scene::Placement;
use crate::stage::{Sites, Tiling};

use super::rows::Rows;
use super::{Ground, ON_EDGE};

/// All triangles that touch the extent, strip by strip; their sites are their middles. As many strips as come nearest to
/// filling the domain are centred in it, with vertices above and below its middle or half an edge beside it.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, edge: f64) -> Result<Sites, Diagnostic> {
    let lattice = Lattice::new(ground, edge);
    // The side of a square as large as a triangle.
    let spacing = (edge * lattice.height / 2.0).sqrt();
    let extent = ground.extent(spacing);
    let strips = span(extent.min.y, extent.max.y, lattice.origin.y, lattice.height);
    let columns = span(extent.min.x, extent.max.x, lattice.origin.x, lattice.half);
    ground.budget.expect(placement, (strips[1] - strips[0] + 1.0) * (columns[1] - columns[0] + 2.0))?;
    let (top, left) = (strips[0] as i64, columns[0] as i64);
    let (bottom, right) = (strips[1] as i64, columns[1] as i64);
    let frame = extent.corners();
    let (mut points, mut tiling, mut rows) = (Vec::new(), Tiling::default(), Rows::new(top, 1));
    for strip in top..=bottom {
        let touches = |column: &i64| convex_overlap(&lattice.triangle(strip, *column), &frame);
        // A triangle is two columns wide: the one before the first may come in too.
        let Some(first) = (left - 1..=right).find(touches) else { continue };
        let last = (first..=right).rev().find(touches).unwrap_or(first);
        rows.push(first, (last - first + 1) as usize);
        for column in first..=last {
            points.push(lattice.middle(strip, column));
            if ground.wants_cells {
                tiling.push(&lattice.triangle(strip, column));
            }
        }
    }
    let mut sites = ground.sites(points, spacing, spacing);
    if ground.wants_cells {
        tiling.edges = rows.pairs(|strip, column| {
            let below = (!has_base_above(strip, column)).then_some((strip + 1, column));
            [Some((strip, column + 1)), below]
        });
        sites.tiling = Some(tiling);
    }
    Ok(sites)
}

/// The cells of a row, each `step` wide, that lie between two places: the first and the last.
fn span(min: f64, max: f64, origin: f64, step: f64) -> [f64; 2] {
    [((min - origin) / step + ON_EDGE).floor(), ((max - origin) / step - ON_EDGE).ceil() - 1.0]
}

/// Whether the base of a triangle lies above its point on the page.
fn has_base_above(strip: i64, column: i64) -> bool {
    (strip ^ column) & 1 == 0
}

/// Where strips and columns lie: vertices stand in columns half an edge apart, even ones in even rows and odd ones in odd
/// rows.
struct Lattice {
    /// Row 0, column 0.
    origin: Point,
    /// From column to column.
    half: f64,
    /// From row to row.
    height: f64,
}

impl Lattice {
    fn new(ground: &Ground<'_>, edge: f64) -> Self {
        let (domain, half, height) = (&ground.domain, edge * 0.5, edge * (3f64.sqrt() * 0.5));
        let start = |min: f64, max: f64, step: f64| {
            let count = ((max - min) / step).round().max(1.0);
            min + (max - min) * 0.5 - count * 0.5 * step
        };
        let origin = Point::new(start(domain.min.x, domain.max.x, half), start(domain.min.y, domain.max.y, height));
        Self { origin, half, height }
    }

    fn vertex(&self, row: i64, column: i64) -> Point {
        Point::new(self.origin.x + column as f64 * self.half, self.origin.y + row as f64 * self.height)
    }

    /// The triangle from a column to the next but one, clockwise on the page.
    fn triangle(&self, strip: i64, column: i64) -> [Point; 3] {
        if has_base_above(strip, column) {
            [self.vertex(strip, column), self.vertex(strip, column + 2), self.vertex(strip + 1, column + 1)]
        } else {
            [self.vertex(strip, column + 1), self.vertex(strip + 1, column + 2), self.vertex(strip + 1, column)]
        }
    }

    fn middle(&self, strip: i64, column: i64) -> Point {
        let down = if has_base_above(strip, column) { 1.0 / 3.0 } else { 2.0 / 3.0 };
        let p = self.vertex(strip, column + 1);
        Point::new(p.x, p.y + down * self.height)
    }
}
