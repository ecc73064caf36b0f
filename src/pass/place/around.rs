//! Lattices on a torus: the plane's lattice, stretched so that a whole number of cells goes round, and one period of it.

use std::collections::BTreeMap;

use crate::diag::Diagnostic;
use crate::geom::{Length, Period, Point, Rect, Vec2, whole_steps};
use crate::scene::{GridSize, Placement};
use crate::stage::{Sites, Tiling};

use super::Ground;

/// From row to row of an even triangular lattice, in spacings.
const ROW: f64 = 0.866_025_403_784_438_6;

/// How far beyond the page the lattice is laid out, in cells, so that every link across a border is found.
const BEYOND: f64 = 2.5;

/// Cells of the search for sites in one place, in each cell of the lattice.
const FINE: f64 = 1024.0;

/// A lattice that goes round.
pub(super) struct Round {
    /// How many cells lie across and down.
    counts: [f64; 2],
    /// Width and height of a cell before it is stretched.
    cell: [Length; 2],
}

impl Round {
    /// How a placement goes round, if it is a lattice.
    pub(super) fn of(placement: &Placement, period: Period) -> Option<Self> {
        let fitted = |cell: [Length; 2], multiple: u32| Self {
            counts: [whole_steps(period.width, cell[0], 1), whole_steps(period.height, cell[1], multiple)],
            cell,
        };
        match *placement {
            Placement::Grid(GridSize::Spacing(side)) => Some(fitted([side, side], 1)),
            Placement::Grid(GridSize::Cells { columns, rows }) => {
                let counts = [f64::from(columns), f64::from(rows)];
                Some(Self { counts, cell: [period.width * (1.0 / counts[0]), period.height * (1.0 / counts[1])] })
            }
            Placement::Hex { spacing } => Some(fitted([spacing, spacing * ROW], 2)),
            Placement::Triangles { edge } => Some(fitted([edge, edge * ROW], 2)),
            Placement::Poisson { .. }
            | Placement::Uniform { .. }
            | Placement::Penrose { .. }
            | Placement::Pinwheel { .. }
            | Placement::Relaxed { .. }
            | Placement::Points(_) => None,
        }
    }

    /// Lays the lattice out with `plane`, which finds it on a page without borders, and keeps one period.
    pub(super) fn place(
        &self,
        placement: &Placement,
        ground: &Ground<'_>,
        plane: impl Fn(&Ground<'_>) -> Result<Sites, Diagnostic>,
    ) -> Result<Sites, Diagnostic> {
        ground.budget.expect(placement, self.counts[0] * self.counts[1])?;
        let size = Vec2::new(self.counts[0] * self.cell[0].to_mm(), self.counts[1] * self.cell[1].to_mm());
        let even = Ground {
            domain: Rect::new(Point::default(), Point::default() + size),
            bleed: Some(BEYOND * self.cell[0].max(self.cell[1]).to_mm()),
            torus: None,
            ..*ground
        };
        let found = plane(&even)?;
        let page = ground.domain;
        let scale = [page.width() / size.x, page.height() / size.y];
        let stretched = |p: Point| Point::new(p.x * scale[0], p.y * scale[1]);
        // Places are told apart by numbers, so that rounding at a border makes no site double and none missing.
        let place = |p: Point| {
            let number = |x: f64, axis: usize| {
                let steps = self.counts[axis] * FINE;
                (x / self.cell[axis].to_mm() * FINE).round().rem_euclid(steps) as u64
            };
            (number(p.y, 1), number(p.x, 0))
        };
        let mut own: BTreeMap<(u64, u64), u32> = BTreeMap::new();
        let mut sites = ground.sites(Vec::new(), found.spacing * (scale[0] * scale[1]).sqrt(), 0.0);
        let (mut cells, mut tiling) = (Vec::new(), Tiling::default());
        // A little before the page and a little before its end, so that what lies on a border is in once.
        let first = Rect::new(Point::default(), Point::default() + size);
        let shift = Vec2::new(self.cell[0].to_mm(), self.cell[1].to_mm()) * (0.5 / FINE);
        for (i, &p) in found.points.iter().enumerate() {
            if !first.contains(p + shift) {
                continue;
            }
            let number = sites.points.len() as u32;
            if own.contains_key(&place(p)) {
                continue;
            }
            own.insert(place(p), number);
            // What rounding left before the border is on it, as its cell is.
            sites.points.push(stretched(Point::new(p.x.max(0.0), p.y.max(0.0))));
            cells.extend(found.cells.as_ref().map(|cells| cells[i]));
            if let Some(found) = &found.tiling {
                let ring: Vec<Point> = found.cell(i).iter().map(|&corner| stretched(corner)).collect();
                tiling.push(&ring);
            }
        }
        if let Some(found_tiling) = &found.tiling {
            let number = |site: u32| own.get(&place(found.points[site as usize])).copied();
            let pairs = found_tiling.edges.iter().filter_map(|&[a, b]| Some([number(a)?, number(b)?]));
            tiling.edges = pairs.filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)]).collect();
            tiling.edges.sort_unstable();
            tiling.edges.dedup();
            sites.tiling = Some(tiling);
        }
        sites.cells = found.cells.as_ref().map(|_| cells);
        Ok(sites)
    }
}
