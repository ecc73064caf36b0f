//! Where parallel lines lie in a tile, and dots along them.

use crate::geom::clip::TOLERANCE;

/// How near a number of steps may come to a half before it counts as one. Equal tiles at different angles have widths
/// that differ by rounding, and all of them should get the same number of lines.
const TIE: f64 = 1e-9;

/// Lines of cells stay this many millimetres off the cell's frame, where a neighbour's could lie too.
const FRAME: f64 = 1e-6;

/// Places at equal steps: `origin + i * step` for whole i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::pass) struct Lattice {
    origin: f64,
    step: f64,
    /// The first and last i of the tile that the lattice was made for.
    range: (f64, f64),
}

impl Lattice {
    /// Lines over a stamp of this range: the number of equal steps that is nearest to the pitch, the outermost lines
    /// `inset` steps from the frame. Where the outermost lines lie on the frame itself, layers after the first leave
    /// them out.
    pub(in crate::pass) fn stamp((low, high): (f64, f64), pitch: f64, inset: f64, layer: u8) -> Self {
        let width = high - low;
        let steps = (width / pitch - 2.0 * inset + 0.5 + TIE).floor().max(0.0);
        if steps + 2.0 * inset <= 0.0 {
            // Two lines on the frames of a tile much narrower than the pitch are one in its middle.
            return Self { origin: low + width / 2.0, step: pitch, range: (0.0, 0.0) };
        }
        let step = width / (steps + 2.0 * inset);
        let origin = low + inset * step;
        if inset == 0.0 && layer > 1 {
            return Self { origin, step, range: (1.0, steps - 1.0) };
        }
        Self { origin, step, range: (0.0, steps) }
    }

    /// Lines over a cell of this range: at the exact pitch, one of them through `middle`, none on the frame.
    pub(in crate::pass) fn cell((low, high): (f64, f64), middle: f64, pitch: f64) -> Self {
        Self { origin: middle, step: pitch, range: (0.0, -1.0) }.over((low + FRAME, high - FRAME))
    }

    /// Moved by a share of a step.
    pub(in crate::pass) fn moved(self, share: f64) -> Self {
        Self { origin: self.origin + share * self.step, ..self }
    }

    /// Continued over another range.
    pub(in crate::pass) fn over(self, (low, high): (f64, f64)) -> Self {
        let first = ((low - self.origin - TOLERANCE) / self.step).ceil();
        let last = ((high - self.origin + TOLERANCE) / self.step).floor();
        Self { range: (first, last), ..self }
    }

    /// From place to place.
    pub(in crate::pass) fn step(&self) -> f64 {
        self.step
    }

    /// How many places there are. It may be too great for a whole number.
    pub(in crate::pass) fn count(&self) -> f64 {
        (self.range.1 - self.range.0 + 1.0).max(0.0)
    }

    /// A place with its number, by how many lie before it.
    pub(super) fn place(&self, i: u64) -> Option<(i64, f64)> {
        let number = self.range.0 + i as f64;
        (number <= self.range.1).then_some((number as i64, self.origin + number * self.step))
    }

    /// The places with their numbers, in order.
    pub(in crate::pass) fn places(self) -> impl DoubleEndedIterator<Item = (i64, f64)> {
        let range =
            if self.count() > 0.0 { self.range.0 as i64..(self.range.1 as i64).saturating_add(1) } else { 0..0 };
        range.map(move |i| (i, self.origin + i as f64 * self.step))
    }
}

/// Whether line i is one of an even share of all lines.
pub(in crate::pass) fn is_drawn(i: i64, share: f64) -> bool {
    share >= 1.0 || ((i + 1) as f64 * share).floor() > (i as f64 * share).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(lattice: Lattice) -> Vec<f64> {
        lattice.places().map(|(_, place)| place).collect()
    }

    #[test]
    fn the_reports_square_has_twelve_lines_and_then_ten() {
        let first = places(Lattice::stamp((-0.44, 0.44), 0.08, 0.0, 1));
        assert_eq!(first.len(), 12);
        assert!((first[0] + 0.44).abs() < 1e-12 && (first[11] - 0.44).abs() < 1e-12);
        let second = places(Lattice::stamp((-0.44, 0.44), 0.08, 0.0, 2));
        assert_eq!(second.len(), 10);
        assert!((second[0] + 0.36).abs() < 1e-12);
    }

    #[test]
    fn half_an_inset_keeps_lines_off_the_frame() {
        let lines = places(Lattice::stamp((-2.0, 2.0), 0.9, 0.5, 1));
        // 4 / 0.9 is nearest to 4 steps.
        assert_eq!(lines.len(), 4);
        assert!((lines[0] + 1.5).abs() < 1e-12 && (lines[3] - 1.5).abs() < 1e-12);
    }

    #[test]
    fn ties_do_not_hang_on_rounding() {
        for noise in [-1e-14, 0.0, 1e-14] {
            assert_eq!(places(Lattice::stamp((0.0, 0.84 + noise), 0.08, 0.5, 1)).len(), 11);
        }
    }

    #[test]
    fn tiles_narrower_than_the_pitch_have_one_line() {
        for inset in [0.0, 0.5, 3.0] {
            let lines = places(Lattice::stamp((1.0, 1.2), 1.0, inset, 1));
            assert_eq!(lines.len(), 1);
            assert!((lines[0] - 1.1).abs() < 1e-12);
        }
    }

    #[test]
    fn lines_of_cells_go_through_the_site_and_spare_the_frame() {
        let lines = places(Lattice::cell((-1.0, 1.2), 0.0, 0.5));
        assert_eq!(lines, [-0.5, 0.0, 0.5, 1.0]);
    }

    #[test]
    fn shares_are_even() {
        for (share, of_twelve) in [(0.25, 3), (0.5, 6), (0.75, 9), (1.0, 12)] {
            assert_eq!((-5..7).filter(|&i| is_drawn(i, share)).count(), of_twelve);
        }
    }
}
