//! The hexagonal lattice: rows of sites, every other one moved by half a spacing.

use crate::diag::Diagnostic;
use crate::geom::Point;
use crate::geom::clip::convex_overlap;
use crate::scene::Placement;
use crate::stage::{Sites, Tiling};

use super::rows::Rows;
use super::{Ground, ON_EDGE};

/// A lattice whose sites are `spacing` from their six neighbours, centred in the domain, that goes on into the bleed as
/// far as sites lie in it, or where cells are asked for as far as those touch it; row by row.
///
/// Columns are counted in half spacings, even ones in even rows and odd ones in odd rows, and a coordinate is computed
/// from its number alone: rows, and columns of one parity, are straight to the last bit.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, spacing: f64) -> Result<Sites, Diagnostic> {
    let domain = &ground.domain;
    let extent = ground.extent(spacing);
    let centre = domain.centre();
    let (half, pitch) = (spacing * 0.5, spacing * (3f64.sqrt() * 0.5));
    let columns = (domain.width() / spacing).round().max(1.0);
    let rows = (domain.height() / pitch).round().max(1.0);
    // The last column that is used: an odd one as soon as there is an odd row.
    let last_column = 2.0 * (columns - 1.0) + if rows > 1.0 { 1.0 } else { 0.0 };
    let across = Axis { centre: centre.x, middle: last_column * 0.5, step: half };
    let down = Axis { centre: centre.y, middle: (rows - 1.0) * 0.5, step: pitch };
    // From a site to the corners of its cell; what touches the extent only there or along a side is left out.
    let corner = pitch * (2.0 / 3.0);
    let reach = |far: f64| if ground.wants_cells { far - 2.0 * ON_EDGE * spacing } else { 0.0 };
    let columns = across.range(extent.min.x, extent.max.x, reach(half));
    let rows = down.range(extent.min.y, extent.max.y, reach(corner));
    ground.budget.expect(placement, (columns[1] - columns[0] + 1.0) * 0.5 * (rows[1] - rows[0] + 1.0))?;
    let (mut points, mut tiling) = (Vec::new(), Tiling::default());
    let mut lattice = Rows::new(rows[0] as i64, 2);
    let frame = extent.corners();
    for row in rows[0] as i64..=rows[1] as i64 {
        let y = down.at(row);
        // Heights of corners belong to rows, each of which has its upper ones where the row before has its lower.
        let (above, below) = (down.between(row - 1), down.between(row));
        let cell = |column: i64| {
            let [left, x, right] = [column - 1, column, column + 1].map(|column| across.at(column));
            [
                Point::new(x, above[0]),
                Point::new(right, above[1]),
                Point::new(right, below[0]),
                Point::new(x, below[1]),
                Point::new(left, below[0]),
                Point::new(left, above[1]),
            ]
        };
        let (mut first, mut last) = (columns[0] as i64, columns[1] as i64);
        first += (first + row).rem_euclid(2);
        last -= (last - first).rem_euclid(2);
        if ground.wants_cells {
            // At both ends the slanted sides of a cell may miss a corner of the extent.
            let is_off = |column: i64| first <= last && !convex_overlap(&cell(column), &frame);
            let (trim_first, trim_last) = (is_off(first), is_off(last));
            first += if trim_first { 2 } else { 0 };
            last -= if trim_last { 2 } else { 0 };
        }
        let start = points.len();
        points.extend((first..=last).step_by(2).map(|column| Point::new(across.at(column), y)));
        lattice.push(first, points.len() - start);
        if ground.wants_cells {
            (first..=last).step_by(2).for_each(|column| tiling.push(&cell(column)));
        }
    }
    let mut sites = ground.sites(points, spacing, spacing);
    if ground.wants_cells {
        let next = |row: i64, column: i64| [(row, column + 2), (row + 1, column - 1), (row + 1, column + 1)].map(Some);
        tiling.edges = lattice.pairs(next);
        sites.tiling = Some(tiling);
    }
    Ok(sites)
}

/// Equal steps along one direction, the middle of those in the domain in its centre.
struct Axis {
    centre: f64,
    middle: f64,
    step: f64,
}

impl Axis {
    fn at(&self, number: i64) -> f64 {
        self.centre + (number as f64 - self.middle) * self.step
    }

    /// The places of corners between a row and the next: those farther up, which are the next row's points, and those
    /// farther down.
    fn between(&self, number: i64) -> [f64; 2] {
        [1.0 / 3.0, 2.0 / 3.0].map(|share| self.centre + (number as f64 + share - self.middle) * self.step)
    }

    /// The first and the last number from `min` to `max` or no farther than `reach` beyond.
    fn range(&self, min: f64, max: f64, reach: f64) -> [f64; 2] {
        let number = |x: f64| (x - self.centre) / self.step + self.middle;
        [(number(min - reach) - ON_EDGE).ceil(), (number(max + reach) + ON_EDGE).floor()]
    }
}
