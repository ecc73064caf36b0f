//! The hexagonal lattice: rows of sites, every other one moved by half a spacing.

use crate::diag::Diagnostic;
use crate::geom::Point;
use crate::scene::Placement;
use crate::stage::Sites;

use super::{Ground, ON_EDGE};

/// A lattice whose sites are `spacing` from their six neighbours, centred in the domain, that goes on into the bleed as
/// far as sites lie in it; row by row.
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
