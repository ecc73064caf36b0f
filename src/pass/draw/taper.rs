//! Strokes whose width runs out towards one end, as where a nib is lifted.

/// Along a stroke that runs out, measured from its tip: the share of the way, and the share of the full width there. A nib
/// that is lifted narrows slowly at first.
const TIP: [(f64, f64); 3] = [(0.0, 0.0), (0.35, 0.5), (1.0, 1.0)];

/// Differences of less mean nothing in shares of a width.
const ROUNDING: f64 = 1e-9;

/// How a line's width runs out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taper {
    /// Over which share of the whole stroke.
    pub(super) share: f64,
    /// Whether the tip lies where the stroke starts.
    pub(super) is_at_start: bool,
}

impl Taper {
    /// The taper of a stroke from one place to another.
    pub(super) fn over(self, whole: (f64, f64)) -> RunOut {
        let length = self.share * (whole.1 - whole.0);
        if self.is_at_start { RunOut { tip: whole.0, length } } else { RunOut { tip: whole.1, length: -length } }
    }
}

/// How the width of one stroke runs out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RunOut {
    /// Where the width is nothing, as a place along the stroke.
    tip: f64,
    /// From there to where it is full; negative where that is nearer to the stroke's start.
    length: f64,
}

impl RunOut {
    /// Calls `visit` with the places between two others where the width begins to change in another way, in any order.
    pub(super) fn joints(&self, (from, to): (f64, f64), mut visit: impl FnMut(f64)) {
        for (way, _) in TIP {
            let u = self.tip + way * self.length;
            if from < u && u < to {
                visit(u);
            }
        }
    }

    /// The share of the full width at a place.
    pub(super) fn at(&self, u: f64) -> f64 {
        // Joints lie where rounding puts them: what is all but full is full, and what is all but nothing is nothing.
        let way = (u - self.tip) / self.length;
        if way > 1.0 - ROUNDING {
            return 1.0;
        }
        let mut pieces = TIP.iter().zip(&TIP[1..]);
        let width = pieces
            .find(|(_, end)| way < end.0)
            .map_or(1.0, |(start, end)| start.1 + (end.1 - start.1) * (way - start.0) / (end.0 - start.0));
        if width < ROUNDING { 0.0 } else { width }
    }
}
