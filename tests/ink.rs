//! Measuring tone: how far the ink of a rendered page is from what was asked for, seen from so far that tiles blur.

use kakeami::back::raster::{Pixels, render};
use kakeami::drawing::Drawing;
use kakeami::field::Field;
use kakeami::geom::Point;

/// The share of ink of every pixel of a grey picture, row by row.
pub(crate) fn ink(pixels: &Pixels) -> Vec<f64> {
    assert_eq!(pixels.data.len(), pixels.width * pixels.height, "the picture is grey");
    pixels.data.iter().map(|&value| 1.0 - f64::from(value) / 255.0).collect()
}

/// A picture of numbers whose rectangles are summed at once (Crow, "Summed-area tables for texture mapping", 1984).
pub(crate) struct Sums {
    width: usize,
    sums: Vec<f64>,
}

impl Sums {
    pub(crate) fn new(width: usize, values: &[f64]) -> Self {
        let mut sums = vec![0.0; (width + 1) * (values.len() / width + 1)];
        for (y, row) in values.chunks_exact(width).enumerate() {
            let mut sum = 0.0;
            for (x, value) in row.iter().enumerate() {
                sum += value;
                sums[(y + 1) * (width + 1) + x + 1] = sum + sums[y * (width + 1) + x + 1];
            }
        }
        Self { width, sums }
    }

    /// The mean over a rectangle that lies in the picture.
    pub(crate) fn mean(&self, x: [usize; 2], y: [usize; 2]) -> f64 {
        let at = |x: usize, y: usize| self.sums[y * (self.width + 1) + x];
        let sum = at(x[1], y[1]) - at(x[0], y[1]) - at(x[1], y[0]) + at(x[0], y[0]);
        sum / ((x[1] - x[0]) * (y[1] - y[0])) as f64
    }
}

/// How far a page is from what it should look like.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Error {
    /// The mean of the absolute differences.
    pub(crate) mean: f64,
    /// The mean of the differences: above 0 where the page is too dark.
    pub(crate) bias: f64,
}

/// Compares a drawing with the darkness that was asked for, clamped to `greatest`, both blurred by a square box of
/// `side` millimetres, wherever the box lies in the page.
pub(crate) fn error(drawing: &Drawing, asked: &Field, greatest: f64, side: f64) -> Error {
    let pixels = render(drawing);
    let (width, height) = (pixels.width, pixels.height);
    let step = drawing.page.width.to_mm() / width as f64;
    let place = |i: usize| Point::new(((i % width) as f64 + 0.5) * step, ((i / width) as f64 + 0.5) * step);
    let wanted: Vec<f64> = (0..width * height).map(|i| asked.at(place(i)).clamp(0.0, greatest)).collect();
    let (wanted, found) = (Sums::new(width, &wanted), Sums::new(width, &ink(&pixels)));
    let side = (side / step).round() as usize;
    let (mut sum, mut bias, mut count) = (0.0, 0.0, 0.0);
    for y in 0..=height - side {
        for x in 0..=width - side {
            let (x, y) = ([x, x + side], [y, y + side]);
            let off = found.mean(x, y) - wanted.mean(x, y);
            sum += off.abs();
            bias += off;
            count += 1.0;
        }
    }
    Error { mean: sum / count, bias: bias / count }
}
