//! Blurred images: Gaussian blur along rows and columns. Edges go on outwards.
//!
//! Deviations of one sample to [`MOST_WEIGHED`] are weighed with the Gaussian itself. Samples of a narrower one would not have
//! its variance, and a wider one costs too much: for these, extended boxes (Gwosdek, Grewenig, Bruhn and Weickert,
//! "Theoretical foundations of Gaussian convolution by extended box filtering", SSVM 2011) follow each other. An extended
//! box has a share of a sample more at either end, so that its variance is exact for every width and its cost is the same
//! for all.

use super::Image;

/// How many boxes stand for a Gaussian. The height of five is within 3.1 % of its own along a line, and so a dot's within
/// 6.1 %: of n equal boxes it is lower by about 0.15 / n.
const PASSES: usize = 5;

/// The least and the greatest deviation, in samples, of which every weight is reckoned.
const LEAST_WEIGHED: f64 = 1.0;
const MOST_WEIGHED: f64 = 8.0;

/// Where the weights of a Gaussian end, in deviations: what is left out would add 2e-5 to its variance.
const TAIL: f64 = 5.0;

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
}

/// What a line is blurred with.
enum Kernel {
    /// The weights of the middle and of the samples on either side of it.
    Weights(Vec<f64>),
    /// To be applied [`PASSES`] times.
    Box(ExtendedBox),
}

impl Kernel {
    /// That of a standard deviation in samples.
    fn new(deviation: f64) -> Self {
        if !(LEAST_WEIGHED..=MOST_WEIGHED).contains(&deviation) {
            return Self::Box(ExtendedBox::new(deviation));
        }
        let reach = (TAIL * deviation).ceil() as usize;
        let weight = |i: usize| libm::exp(-((i * i) as f64) / (2.0 * deviation * deviation));
        let mut weights: Vec<f64> = (0..=reach).map(weight).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Self::Weights(weights)
    }

    /// Blurs a line; `other` is of the same length.
    fn smooth(&self, line: &mut Vec<f64>, other: &mut Vec<f64>) {
        match self {
            Self::Weights(weights) => {
                weigh(weights, line, other);
                std::mem::swap(line, other);
            }
            Self::Box(extended) => {
                for _ in 0..PASSES {
                    extended.apply(line, other);
                    std::mem::swap(line, other);
                }
            }
        }
    }
}

/// Averages a line with the weights of the middle and of either side; `from` and `to` are of one length.
fn weigh(weights: &[f64], from: &[f64], to: &mut [f64]) {
    let Some(last) = from.len().checked_sub(1) else { return };
    for (i, out) in to.iter_mut().enumerate() {
        let pair = |j: usize| from[i.saturating_sub(j)] + from[(i + j).min(last)];
        *out = weights.iter().enumerate().skip(1).fold(weights[0] * from[i], |sum, (j, weight)| sum + weight * pair(j));
    }
}

impl Image {
    /// Blurred by a Gaussian of a standard deviation, in samples and at least 0.
    #[must_use]
    pub fn blurred(&self, deviation: f64) -> Self {
        let kernel = Kernel::new(deviation);
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
