//! How many tiles a placement may have, and the words for too many.

use crate::diag::{self, Code, Diagnostic};
use crate::scene::{Amount, GridSize, Placement};
use crate::span::Span;

/// Sites are named by 32-bit indices, and their links by as many again: no `--limit` goes beyond this.
const MOST_TILES: u64 = 1 << 29;

/// Cells of a search grid for every tile that is allowed. Lattices of cells are at most this much finer than the tiles.
const CELLS_A_TILE: f64 = 32.0;

/// Moves in rounds of relaxation for every tile that is allowed: at the limit of tiles they take some minutes.
const MOVES_A_TILE: f64 = 32.0;

/// The limit of tiles.
#[derive(Clone, Copy)]
pub(super) struct Budget {
    tiles: u64,
    span: Span,
}

impl Budget {
    pub(super) fn new(tiles: u64, span: Span) -> Self {
        Self { tiles: tiles.min(MOST_TILES), span }
    }

    /// Asks for an estimated number of tiles.
    pub(super) fn expect(&self, placement: &Placement, tiles: f64) -> Result<(), Diagnostic> {
        if tiles <= self.tiles as f64 {
            return Ok(());
        }
        let limit = grouped(self.tiles as f64);
        let about = about(tiles);
        let call = describe(placement);
        Err(self.exceeded(placement, format!("`{call}` would place {about} tiles; the limit is {limit}")))
    }

    /// Asks for one tile more than the `tiles` there are.
    pub(super) fn one_more(&self, placement: &Placement, tiles: usize) -> Result<(), Diagnostic> {
        if (tiles as u64) < self.tiles {
            return Ok(());
        }
        let limit = grouped(self.tiles as f64);
        let call = describe(placement);
        Err(self.exceeded(placement, format!("`{call}` places more than {limit} tiles, which is the limit")))
    }

    /// Asks for `rounds` in which all of the `tiles` are moved.
    pub(super) fn expect_moves(&self, placement: &Placement, tiles: usize, rounds: u32) -> Result<(), Diagnostic> {
        let (moves, most) = (tiles as f64 * f64::from(rounds), self.tiles as f64 * MOVES_A_TILE);
        if moves <= most {
            return Ok(());
        }
        let (moves, most, limit) = (grouped(rounded(moves)), grouped(most), grouped(self.tiles as f64));
        let call = describe(placement);
        let message = format!("`{call}` would move tiles {moves} times; a limit of {limit} tiles allows {most}");
        Err(self.exceeded(placement, message).label("too many rounds"))
    }

    /// A search grid of `columns * rows` empty cells.
    pub(super) fn grid(&self, placement: &Placement, columns: f64, rows: f64) -> Result<Vec<u32>, Diagnostic> {
        let cells = columns * rows;
        let most = self.tiles as f64 * CELLS_A_TILE + 65_536.0;
        let mut grid = Vec::new();
        if cells <= most && grid.try_reserve_exact(cells as usize).is_ok() {
            grid.resize(cells as usize, u32::MAX);
            return Ok(grid);
        }
        let limit = grouped(self.tiles as f64);
        let call = describe(placement);
        let about = about(cells);
        Err(self.exceeded(
            placement,
            format!("`{call}` would search a grid of {about} cells, too many for a limit of {limit} tiles"),
        ))
    }

    fn exceeded(&self, placement: &Placement, message: String) -> Diagnostic {
        let remedy = match placement {
            Placement::Poisson { .. } => "use a larger radius",
            Placement::Uniform { amount: Amount::Count { .. } } => "use a smaller count",
            Placement::Uniform { amount: Amount::AsMany(_) | Amount::Density { .. } } => "use a lower density",
            Placement::Grid(GridSize::Spacing(_)) | Placement::Hex { .. } => "use a larger spacing",
            Placement::Grid(GridSize::Cells { .. }) => "use fewer columns and rows",
            Placement::Triangles { .. } | Placement::Penrose { .. } | Placement::Pinwheel { .. } => "use a longer edge",
            Placement::Points(_) => "use fewer points",
            Placement::Relaxed { .. } => "use fewer rounds",
        };
        let hint = if self.tiles < MOST_TILES {
            format!("`--limit tiles=N` lifts it, or {remedy}")
        } else {
            format!("{remedy}; no more tiles than these can be counted")
        };
        Diagnostic::error(Code::Limit, self.span, message).label("too many tiles").hint(hint)
    }
}

/// A placement as it might have been written.
fn describe(placement: &Placement) -> String {
    match placement {
        Placement::Poisson { radius, .. } => format!("poisson(radius: {})", millimetres(radius.to_mm())),
        Placement::Uniform { amount: Amount::Count { count, .. } } => format!("uniform(count: {count})"),
        Placement::Uniform { amount: Amount::AsMany(inner) } => format!("uniform(count: {})", describe(inner)),
        Placement::Uniform { amount: Amount::Density { .. } } => "uniform(density)".to_owned(),
        Placement::Grid(GridSize::Spacing(spacing)) => format!("grid(spacing: {})", millimetres(spacing.to_mm())),
        Placement::Grid(GridSize::Cells { columns, rows }) => format!("grid(columns: {columns}, rows: {rows})"),
        Placement::Hex { spacing } => format!("hex(spacing: {})", millimetres(spacing.to_mm())),
        Placement::Triangles { edge } => format!("triangles(edge: {})", millimetres(edge.to_mm())),
        Placement::Penrose { edge } => format!("penrose(edge: {})", millimetres(edge.to_mm())),
        Placement::Pinwheel { edge } => format!("pinwheel(edge: {})", millimetres(edge.to_mm())),
        Placement::Points(_) => "points([...])".to_owned(),
        Placement::Relaxed { placement, rounds } => format!("relaxed({}, rounds: {rounds})", describe(placement)),
    }
}

/// A length with as many digits as help a reader.
fn millimetres(value: f64) -> String {
    let short = (value * 1e6).round() / 1e6;
    if short > 0.0 { format!("{short}mm") } else { format!("{value:e}mm") }
}

/// A large number with three digits that count.
fn rounded(value: f64) -> f64 {
    let mut unit = 1.0;
    while value / unit >= 1000.0 && unit < 1e15 {
        unit *= 10.0;
    }
    (value / unit).ceil() * unit
}

/// An estimate in words.
fn about(number: f64) -> String {
    let count = grouped(rounded(number));
    if number < 1e15 { format!("about {count}") } else { count }
}

/// A number with commas between its thousands.
fn grouped(value: f64) -> String {
    if value.is_nan() || value >= 1e15 {
        return "more than 1,000,000,000,000,000".to_owned();
    }
    diag::grouped(value as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped() {
        let cases = [(0.0, "0"), (999.0, "999"), (1000.0, "1,000"), (2e6, "2,000,000"), (25_162_500.0, "25,200,000")];
        for (number, text) in cases {
            assert_eq!(grouped(rounded(number)), text);
        }
        assert_eq!(grouped(rounded(f64::INFINITY)), "more than 1,000,000,000,000,000");
        assert_eq!(grouped(rounded(f64::NAN)), "more than 1,000,000,000,000,000");
    }

    #[test]
    fn lengths_are_short() {
        assert_eq!(millimetres(25.4 / 3.0), "8.466667mm");
        assert_eq!(millimetres(0.001), "0.001mm");
        assert_eq!(millimetres(1e-9), "1e-9mm");
    }
}
