//! The hexagonal lattice: rows of sites, every other one moved by half a spacing.

use crate::diag::Diagnostic;
use crate::geom::{Length, Period, Point, whole_steps};
use crate::scene::Placement;
use crate::stage::Sites;

use super::{Ground, ON_EDGE};

/// A lattice whose sites are `spacing` from their six neighbours, centred in the domain, that goes on into the bleed as
/// far as sites lie in it; row by row.
///
/// On a torus it is stretched, across and down by themselves, to whole columns and an even number of rows.
///
/// Columns are counted in half spacings, even ones in even rows and odd ones in odd rows, and a coordinate is computed
/// from its number alone: rows, and columns of one parity, are straight to the last bit.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, spacing: f64) -> Result<Sites, Diagnostic> {
    let domain = &ground.domain;
    let extent = ground.extent(spacing);
    let centre = domain.centre();
    if let Some(period) = ground.torus {
        return around(placement, ground, period, spacing);
    }
    let (half, pitch) = (spacing * 0.5, spacing * ROW);
    let columns = (domain.width() / spacing).round().max(1.0);
    let rows = (domain.height() / pitch).round().max(1.0);
    // The last column that is used: an odd one as soon as there is an odd row.
    let last_column = 2.0 * (columns - 1.0) + if rows > 1.0 { 1.0 } else { 0.0 };
    let across = Axis { centre: centre.x, middle: last_column * 0.5, step: half };
    let down = Axis { centre: centre.y, middle: (rows - 1.0) * 0.5, step: pitch };
    let columns = across.range(extent.min.x, extent.max.x);
    let rows = down.range(extent.min.y, extent.max.y);
    ground.budget.expect(placement, (columns[1] - columns[0] + 1.0) * 0.5 * (rows[1] - rows[0] + 1.0))?;
    let mut points = Vec::new();
    for row in rows[0] as i64..=rows[1] as i64 {
        let y = down.at(row);
        let first = columns[0] as i64;
        let first = first + (first + row).rem_euclid(2);
        points.extend((first..=columns[1] as i64).step_by(2).map(|column| Point::new(across.at(column), y)));
    }
    Ok(ground.sites(points, spacing, spacing))
}

/// From row to row, in spacings.
const ROW: f64 = 0.866_025_403_784_438_6;

/// The lattice on a torus. Its spacing is that of an even lattice with as many sites.
fn around(placement: &Placement, ground: &Ground<'_>, period: Period, spacing: f64) -> Result<Sites, Diagnostic> {
    let columns = whole_steps(period.width, Length::mm(spacing), 1);
    let rows = whole_steps(period.height, Length::mm(spacing * ROW), 2);
    ground.budget.expect(placement, columns * rows)?;
    let (step, pitch) = (period.width.to_mm() / columns, period.height.to_mm() / rows);
    let site = |row: u64, column: u64| {
        let shift = if row % 2 == 0 { 0.25 } else { 0.75 };
        Point::new((column as f64 + shift) * step, (row as f64 + 0.5) * pitch)
    };
    let points = (0..rows as u64).flat_map(|row| (0..columns as u64).map(move |column| site(row, column))).collect();
    Ok(ground.sites(points, (step * pitch / ROW).sqrt(), 0.0))
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

    fn range(&self, min: f64, max: f64) -> [f64; 2] {
        let number = |x: f64| (x - self.centre) / self.step + self.middle;
        [(number(min) - ON_EDGE).ceil(), (number(max) + ON_EDGE).floor()]
    }
}
