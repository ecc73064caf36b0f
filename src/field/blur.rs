//! Blurred images: Gaussian blur by three extended boxes (Gwosdek, Grewenig, Bruhn and Weickert, "Theoretical
//! foundations of Gaussian convolution by extended box filtering", SSVM 2011).
//!
//! An extended box has a share of a sample more at either end, so that its variance is exact for every width and its
//! cost is the same for all. Edges go on outwards.

use super::Image;

/// How many boxes stand for a Gaussian: three are within 5 % of its height.
const PASSES: usize = 3;

/// A box with a share of a sample more at both ends.
#[derive(Debug, Clone, Copy)]
struct ExtendedBox {
    /// Whole samples on either side of the middle.
    reach: usize,
    /// The weight of these.
    inner: f64,
    /// The weight of the samples at the ends.
    outer: f64,
}

impl ExtendedBox {
    /// The box that makes a Gaussian of a standard deviation, in samples, when it is applied [`PASSES`] times.
    fn new(deviation: f64) -> Self {
        let variance = deviation * deviation / PASSES as f64;
        let reach = (((12.0 * variance + 1.0).sqrt() - 1.0) / 2.0).floor();
        let share = (2.0 * reach + 1.0) * (reach * (reach + 1.0) - 3.0 * variance)
            / (6.0 * (variance - (reach + 1.0) * (reach + 1.0)));
        let width = 2.0 * reach + 1.0 + 2.0 * share;
        Self { reach: reach as usize, inner: 1.0 / width, outer: share / width }
    }

    /// Averages a line, whose ends go on outwards; `from` and `to` are of one length.
    fn apply(self, from: &[f64], to: &mut [f64]) {
        let Some(last) = from.len().checked_sub(1) else { return };
        let at = |i: usize, back: usize| from[(i.saturating_sub(back)).min(last)];
        // The samples under the inner box round the first sample: it stands as often as the box goes beyond the line.
        let inside = from.iter().skip(1).take(self.reach).sum::<f64>();
        let beyond = self.reach.saturating_sub(last) as f64;
        let mut sum = from[0] * (self.reach + 1) as f64 + inside + from[last] * beyond;
        for (i, out) in to.iter_mut().enumerate() {
            let (left, right) = (at(i, self.reach + 1), at(i + self.reach + 1, 0));
            *out = self.inner * sum + self.outer * (left + right);
            sum += right - at(i, self.reach);
        }
    }

    /// Applies the box as often as a Gaussian takes; `other` is of the line's length.
    fn smooth(self, line: &mut Vec<f64>, other: &mut Vec<f64>) {
        for _ in 0..PASSES {
            self.apply(line, other);
            std::mem::swap(line, other);
        }
    }
}

impl Image {
    /// Blurred by a Gaussian of a standard deviation, in samples and at least 0.
    #[must_use]
    pub fn blurred(&self, deviation: f64) -> Self {
        let kernel = ExtendedBox::new(deviation);
        let mut samples = self.samples.clone();
        let width = self.width as usize;
        let (mut line, mut other) = (Vec::new(), Vec::new());
        for row in samples.chunks_mut(width) {
            line.clear();
            line.extend(row.iter().copied().map(f64::from));
            other.resize(line.len(), 0.0);
            kernel.smooth(&mut line, &mut other);
            row.iter_mut().zip(&line).for_each(|(sample, &value)| *sample = value as f32);
        }
        for column in 0..width {
            line.clear();
            line.extend(samples.iter().skip(column).step_by(width).copied().map(f64::from));
            other.resize(line.len(), 0.0);
            kernel.smooth(&mut line, &mut other);
            let column = samples.iter_mut().skip(column).step_by(width);
            column.zip(&line).for_each(|(sample, &value)| *sample = value as f32);
        }
        Self { samples, ..*self }
    }
}
