//! Square and oblong lattices, row by row.

use crate::diag::Diagnostic;
use crate::geom::{Point, Rect};
use crate::scene::{GridSize, Placement};
use crate::stage::{Sites, Tiling};

use super::rows::Rows;
use super::{Ground, ON_EDGE};

/// A lattice over the domain that goes on into the bleed as far as sites lie in it.
///
/// With a spacing it is centred, with as many columns as come nearest to filling the domain; with columns and rows it
/// fills the domain exactly. Where cells are asked for it goes on as far as they touch the extent. The spacing of oblong cells is the side of a square of the same area.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, size: GridSize) -> Result<Sites, Diagnostic> {
    let domain = &ground.domain;
    let (across, down, spacing) = match size {
        GridSize::Spacing(side) => {
            let side = side.to_mm();
            let across = Axis::centred(domain.min.x, domain.max.x, side);
            (across, Axis::centred(domain.min.y, domain.max.y, side), side)
        }
        GridSize::Cells { columns, rows } => {
            let across = Axis::filled(domain.min.x, domain.width(), columns);
            let down = Axis::filled(domain.min.y, domain.height(), rows);
            (across, down, (domain.width() / f64::from(columns) * (domain.height() / f64::from(rows))).sqrt())
        }
    };
    let default_bleed = match size {
        GridSize::Spacing(_) => spacing,
        GridSize::Cells { .. } => 0.0,
    };
    let extent = ground.extent(default_bleed);
    // A cell that touches the extent only along its side is left out.
    let reach = |step: f64| if ground.wants_cells { step * (0.5 - 2.0 * ON_EDGE) } else { 0.0 };
    let columns = across.range(extent.min.x, extent.max.x, reach(across.step()));
    let rows = down.range(extent.min.y, extent.max.y, reach(down.step()));
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
    if ground.wants_cells {
        let mut tiling = Tiling::default();
        let mut lattice = Rows::new(rows[0] as i64, 1);
        for row in rows[0] as i32..=rows[1] as i32 {
            let [top, bottom] = down.sides(row);
            for column in columns[0] as i32..=columns[1] as i32 {
                let [left, right] = across.sides(column);
                tiling.push(&Rect::new(Point::new(left, top), Point::new(right, bottom)).corners());
            }
            lattice.push(columns[0] as i64, (columns[1] - columns[0] + 1.0) as usize);
        }
        tiling.edges = lattice.pairs(|row, column| [Some((row, column + 1)), Some((row + 1, column))]);
        sites.tiling = Some(tiling);
    }
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

    fn filled(start: f64, width: f64, count: u32) -> Self {
        Self::Filled { start, width, count: f64::from(count) }
    }

    /// The middle of a cell. Written so that a grid of 8 over 6 mm stands at 0.375 + 0.75 i to the last bit.
    fn at(&self, cell: i32) -> f64 {
        let cell = f64::from(cell);
        match *self {
            Self::Centred { centre, count, step } => centre + (cell - (count - 1.0) * 0.5) * step,
            Self::Filled { start, width, count } => start + (cell + 0.5) * width / count,
        }
    }

    /// From cell to cell.
    fn step(&self) -> f64 {
        match *self {
            Self::Centred { step, .. } => step,
            Self::Filled { width, count, .. } => width / count,
        }
    }

    /// Where a cell begins and ends: just where its neighbours end and begin.
    fn sides(&self, cell: i32) -> [f64; 2] {
        [cell, cell + 1].map(|side| match *self {
            Self::Centred { centre, count, step } => centre + (f64::from(side) - count * 0.5) * step,
            Self::Filled { start, width, count } => start + f64::from(side) * width / count,
        })
    }

    /// The first and the last cell whose middles lie from `min` to `max` or no farther than `reach` beyond.
    fn range(&self, min: f64, max: f64, reach: f64) -> [f64; 2] {
        let (zero, step) = match *self {
            Self::Centred { centre, count, step } => (centre - (count - 1.0) * 0.5 * step, step),
            Self::Filled { start, width, count } => (start + 0.5 * width / count, width / count),
        };
        [((min - reach - zero) / step - ON_EDGE).ceil(), ((max + reach - zero) / step + ON_EDGE).floor()]
    }
}
