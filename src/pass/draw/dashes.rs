//! Broken strokes: where dashes lie along a line.

use crate::geom::Length;

use super::weave::Along;

/// A pattern of dashes. Seen from the site they are set like bricks: on even lines the middle of a dash, on odd lines the
/// middle of a gap lies beside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dashes {
    dash: f64,
    period: f64,
    /// By how much they lie further back on a line a millimetre across.
    drift: f64,
}

impl Dashes {
    pub(super) fn new(dash: Length, gap: Length) -> Self {
        Self { dash: dash.to_mm(), period: (dash + gap).to_mm(), drift: 0.0 }
    }

    /// The same dashes, with other gaps.
    pub(super) fn woven(self, along: Along) -> Self {
        Self { period: along.step, drift: along.drift, ..self }
    }

    /// The length of a dash in millimetres.
    pub(super) fn length(&self) -> f64 {
        self.dash
    }

    /// The most dashes that reach into a range.
    pub(super) fn count(&self, (start, end): (f64, f64)) -> f64 {
        ((end - start + self.dash) / self.period).ceil() + 1.0
    }

    /// The middle of a dash of line `number`, which lies at `v`.
    fn middle(&self, (number, v): (i64, f64)) -> f64 {
        let bond = if number.rem_euclid(2) == 0 { 0.0 } else { self.period / 2.0 };
        bond - v * self.drift
    }

    /// The dash of a line whose middle is nearest to a place.
    pub(super) fn around(&self, u: f64, line: (i64, f64)) -> (f64, f64) {
        let middle = self.middle(line);
        let middle = middle + ((u - middle) / self.period).round() * self.period;
        (middle - self.dash / 2.0, middle + self.dash / 2.0)
    }

    /// Appends the dashes of a line that reach into a range, in order.
    pub(super) fn cut(&self, (start, end): (f64, f64), line: (i64, f64), out: &mut Vec<(f64, f64)>) {
        let middle = self.middle(line);
        let first = ((start - middle - self.dash / 2.0) / self.period).ceil();
        for i in 0..=self.count((start, end)) as u64 {
            let dash = middle + (first + i as f64) * self.period - self.dash / 2.0;
            if dash >= end {
                break;
            }
            // A dash that reaches into two ranges is listed once.
            if out.last().is_none_or(|last| last.0 < dash) {
                out.push((dash, dash + self.dash));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_are_set_like_bricks() {
        let dashes = Dashes::new(Length::mm(2.0), Length::mm(1.0));
        let cut = |number| {
            let mut out = Vec::new();
            dashes.cut((-1.5, 3.0), (number, 0.0), &mut out);
            out
        };
        assert_eq!(cut(0), [(-1.0, 1.0), (2.0, 4.0)]);
        assert_eq!(cut(-1), [(-2.5, -0.5), (0.5, 2.5)]);
        assert_eq!(cut(3), cut(-1));
        assert_eq!([0.9, 2.1].map(|u| dashes.around(u, (0, 0.0))), cut(0)[..]);
    }

    #[test]
    fn a_dash_over_two_ranges_is_one() {
        let dashes = Dashes::new(Length::mm(2.0), Length::mm(1.0));
        let mut out = Vec::new();
        dashes.cut((-0.5, 0.0), (0, 0.0), &mut out);
        dashes.cut((0.5, 0.7), (0, 0.0), &mut out);
        assert_eq!(out, [(-1.0, 1.0)]);
    }
}
