//! Waves: strokes that swing about their lines, those of one tile side by side.

use crate::geom::course::half_wave;
use crate::geom::{Cubic, Point};
use crate::scene::Swing;

use super::curves::Course;

/// Sine waves, one Bézier for each half from crest to crest. The line's origin lies midway between two crests.
pub(super) struct Waves {
    /// The length of half a wave in millimetres.
    half: f64,
    amplitude: f64,
    rise: Cubic,
}

impl Waves {
    pub(super) fn new(swing: &Swing) -> Self {
        let half = swing.wavelength / 2.0;
        Self { half: half.to_mm(), amplitude: swing.amplitude.to_mm(), rise: half_wave(half, swing.amplitude) }
    }
}

impl Course for Waves {
    fn reach(&self) -> f64 {
        self.amplitude
    }

    fn count(&self, (start, end): (f64, f64)) -> f64 {
        (end - start) / self.half + 2.0
    }

    fn trace(&self, _number: i64, v: f64, (start, end): (f64, f64), chain: &mut Vec<Point>) {
        let first = (start / self.half - 0.5).floor();
        let count = (end / self.half - 0.5).ceil() - first;
        for i in 0..count as u64 {
            let number = first + i as f64;
            let side = if (number / 2.0).fract() == 0.0 { -1.0 } else { 1.0 };
            let from = (number + 0.5) * self.half;
            let at = |p: Point| Point::new(from + p.x, v + side * p.y);
            push(self.rise.map(at), chain);
        }
    }
}

/// Adds a Bézier to a chain, which starts with it or ends where it starts.
pub(super) fn push(Cubic([a, b, c, d]): Cubic, chain: &mut Vec<Point>) {
    if chain.is_empty() {
        chain.push(a);
    }
    chain.extend([b, c, d]);
}
