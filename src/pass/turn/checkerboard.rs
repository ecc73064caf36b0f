//! Tiles that lie along x and y by turns.

use crate::geom::Angle;
use crate::stage::Sites;

/// 0 where column and row of a grid add up to an even number, a quarter turn elsewhere. Lowering lets only grids come
/// here; sites without cells would all lie along x.
pub(super) fn turn(sites: &Sites) -> Vec<Angle> {
    let Some(cells) = &sites.cells else { return vec![Angle::ZERO; sites.points.len()] };
    // Cells in the bleed have negative numbers.
    let is_even = |[column, row]: [i32; 2]| (column ^ row) & 1 == 0;
    cells.iter().map(|&cell| if is_even(cell) { Angle::ZERO } else { Angle::RIGHT }).collect()
}
