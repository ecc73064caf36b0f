//! Ramps and steps: a number comes in, the value between stops or of a band goes out.

use serde::Serialize;

/// Values at stops, with a way from each to the next.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ramp {
    /// At least one, their places in order. Of several at one place the last begins there and the first ends there.
    pub stops: Vec<Stop>,
    /// How a stop's value passes into the next.
    pub ease: Ease,
}

/// A place with its value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stop {
    /// A share of the way, from 0 to 1.
    pub at: f64,
    /// The value there.
    pub value: f64,
}

/// How one value passes into the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ease {
    /// Evenly.
    Linear,
    /// Slowly first: the square of the way.
    In,
    /// Slowly last.
    Out,
    /// Slowly first and last, and level at both ends: `t^2 (3 - 2 t)`.
    InOut,
}

impl Ease {
    /// The share of the change at a share of the way, both from 0 to 1.
    #[must_use]
    pub fn apply(self, t: f64) -> f64 {
        match self {
            Self::Linear => t,
            Self::In => t * t,
            Self::Out => t * (2.0 - t),
            Self::InOut => t * t * (3.0 - 2.0 * t),
        }
    }
}

impl Ramp {
    /// The value at a share of the way; before the first stop and after the last it is theirs.
    #[must_use]
    pub fn at(&self, share: f64) -> f64 {
        let next = self.stops.partition_point(|stop| stop.at <= share);
        let before = next.checked_sub(1).and_then(|i| self.stops.get(i));
        match (before, self.stops.get(next)) {
            (Some(a), Some(b)) => {
                let t = self.ease.apply((share - a.at) / (b.at - a.at));
                a.value * (1.0 - t) + b.value * t
            }
            (Some(only), None) | (None, Some(only)) => only.value,
            (None, None) => 0.0,
        }
    }
}

/// Bands of values, each with one value for all of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Steps {
    /// Where a band ends and the next begins, in order; a value on a bound belongs to the band that begins there.
    pub bounds: Vec<f64>,
    /// The value of the first band.
    pub start: f64,
    /// The value of the last band; those between lie evenly between the two.
    pub end: f64,
}

impl Steps {
    /// Bands of one width from `start` to `end`, which are also the values of the first and the last; at least two.
    #[must_use]
    pub fn even(count: u32, start: f64, end: f64) -> Self {
        let bound = |i: u32| start + (end - start) * (f64::from(i) / f64::from(count));
        Self { bounds: (1..count).map(bound).collect(), start, end }
    }

    /// The value of the band that a value falls into.
    #[must_use]
    pub fn apply(&self, value: f64) -> f64 {
        let band = self.bounds.partition_point(|&bound| bound <= value);
        let share = band as f64 / self.bounds.len().max(1) as f64;
        // Exact at both ends.
        self.start * (1.0 - share) + self.end * share
    }
}
