//! Square and oblong lattices, row by row.

use crate::diag::Diagnostic;
use crate::geom::{Length, Point, whole_steps};
use crate::scene::{GridSize, Placement};
use crate::stage::Sites;

use super::{Ground, ON_EDGE};

/// A lattice over the domain that goes on into the bleed as far as sites lie in it.
///
/// With a spacing it is centred, with as many columns as come nearest to filling the domain; with columns and rows, and
/// on a torus, it fills the domain exactly. The spacing of oblong cells is the side of a square of the same area.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, size: GridSize) -> Result<Sites, Diagnostic> {
    let domain = &ground.domain;
    let (across, down, spacing) = match size {
        GridSize::Spacing(side) if ground.torus.is_some() => {
            let count = |length: f64| whole_steps(Length::mm(length), side, 1);
            let (columns, rows) = (count(domain.width()), count(domain.height()));
            let across = Axis::filled(domain.min.x, domain.width(), columns);
            let down = Axis::filled(domain.min.y, domain.height(), rows);
            (across, down, (domain.width() / columns * (domain.height() / rows)).sqrt())
        }
        GridSize::Spacing(side) => {
            let side = side.to_mm();
            let across = Axis::centred(domain.min.x, domain.max.x, side);
            (across, Axis::centred(domain.min.y, domain.max.y, side), side)
        }
        GridSize::Cells { columns, rows } => {
            let (columns, rows) = (f64::from(columns), f64::from(rows));
            let across = Axis::filled(domain.min.x, domain.width(), columns);
            let down = Axis::filled(domain.min.y, domain.height(), rows);
            (across, down, (domain.width() / columns * (domain.height() / rows)).sqrt())
        }
    };
    let default_bleed = match size {
        GridSize::Spacing(_) => spacing,
        GridSize::Cells { .. } => 0.0,
    };
    let extent = ground.extent(default_bleed);
    let (columns, rows) = (across.range(extent.min.x, extent.max.x), down.range(extent.min.y, extent.max.y));
    ground.budget.expect(placement, (columns[1] - columns[0] + 1.0) * (rows[1] - rows[0] + 1.0))?;
    let mut sites = ground.sites(Vec::new(), spacing, default_bleed);
    let mut cells = Vec::new();
    for row in rows[0] as i32..=rows[1] as i32 {
        let y = down.at(row);
        for column in columns[0] as i32..=columns[1] as i32 {
            sites.points.push(Point::new(across.at(column), y));
            cells.push([column, row]);
        }
    }
    sites.cells = Some(cells);
    Ok(sites)
}

/// Equal cells along one direction; number 0 is the first in the domain.
enum Axis {
    /// At a distance of `step`, the middle of all in the domain's.
    Centred {
        /// The domain's middle.
        centre: f64,
        /// Cells in the domain.
        count: f64,
        /// From cell to cell.
        step: f64,
    },
    /// So many from one side of the domain to the other.
    Filled {
        /// The domain's lower side.
        start: f64,
        /// The domain's width.
        width: f64,
        /// Cells in the domain.
        count: f64,
    },
}

impl Axis {
    fn centred(min: f64, max: f64, step: f64) -> Self {
        Self::Centred { centre: min + (max - min) * 0.5, count: ((max - min) / step).round().max(1.0), step }
    }

    fn filled(start: f64, width: f64, count: f64) -> Self {
        Self::Filled { start, width, count }
    }

    /// The middle of a cell. Written so that a grid of 8 over 6 mm stands at 0.375 + 0.75 i to the last bit.
    fn at(&self, cell: i32) -> f64 {
        let cell = f64::from(cell);
        match *self {
            Self::Centred { centre, count, step } => centre + (cell - (count - 1.0) * 0.5) * step,
            Self::Filled { start, width, count } => start + (cell + 0.5) * width / count,
        }
    }

    /// The first and the last cell whose middles lie from `min` to `max`.
    fn range(&self, min: f64, max: f64) -> [f64; 2] {
        let (zero, step) = match *self {
            Self::Centred { centre, count, step } => (centre - (count - 1.0) * 0.5 * step, step),
            Self::Filled { start, width, count } => (start + 0.5 * width / count, width / count),
        };
        [((min - zero) / step - ON_EDGE).ceil(), ((max - zero) / step + ON_EDGE).floor()]
    }
}
