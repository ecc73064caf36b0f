//! Even patterns on a page that repeats: the direction and the steps nearest to those asked for that go round.
//!
//! Lines go round where a whole number of them is crossed on the way across the page and another on the way down. That
//! number, each way, is rounded; direction and pitch follow from the two. What lies along the lines is rounded likewise.

use crate::geom::{Length, Period, Vec2};

/// How dashes or dots of neighbouring lines lie to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bond {
    /// Side by side.
    Rows,
    /// Those of every other line beside the gaps, like bricks.
    Bricks,
}

/// Lines that go round a page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weave {
    period: Period,
    /// How many lines are crossed across and down.
    lines: [f64; 2],
    /// The unit vector along them.
    pub(super) along: Vec2,
    /// From line to line in millimetres.
    pub(super) pitch: f64,
}

/// Places along the lines of a weave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Along {
    /// From place to place in millimetres.
    pub(super) step: f64,
    /// By how much the places lie further back on a line a millimetre across, in millimetres.
    pub(super) drift: f64,
}

impl Weave {
    /// The lines nearest to those in a direction, at a pitch.
    pub(super) fn new(period: Period, along: Vec2, pitch: Length) -> Self {
        let normal = along.turned();
        let wanted = crossings(period, normal, pitch);
        let mut lines = wanted.map(f64::round);
        if lines == [0.0; 2] {
            // So coarse that no line would be met: one, the way that is crossed more.
            let more = usize::from(wanted[1].abs() > wanted[0].abs());
            lines[more] = 1f64.copysign(wanted[more]);
        }
        let density = waves(period, lines);
        let pitch = 1.0 / density.length();
        let normal = density * pitch;
        Self { period, lines, along: Vec2::new(normal.y, -normal.x), pitch }
    }

    /// The places along the lines that are nearest to those at a spacing.
    pub(super) fn along(&self, spacing: Length, bond: Bond) -> Along {
        let wanted = crossings(self.period, self.along, spacing);
        // A line further is half a step further where every other line is moved.
        let shift = match bond {
            Bond::Rows => [0.0; 2],
            Bond::Bricks => self.lines.map(|lines| lines.rem_euclid(2.0) / 2.0),
        };
        let nearest = [0, 1].map(|axis: usize| (wanted[axis] - shift[axis]).round() + shift[axis]);
        let around = [0.0, -1.0, 1.0];
        let candidates = around.iter().flat_map(|column| around.iter().map(move |row| [*column, *row]));
        let density = |way: [f64; 2]| waves(self.period, [nearest[0] + way[0], nearest[1] + way[1]]);
        let target = self.along * (1.0 / spacing.to_mm());
        // On a page of few steps the nearest may lie across the lines, where it is none along them: then the one that runs
        // along them most.
        let share = |density: Vec2| (density.dot(self.along) * spacing.to_mm()).min(0.5);
        let best = candidates.map(density).min_by(|&a, &b| {
            let distance = |density: Vec2| (density - target).length_squared();
            share(b).total_cmp(&share(a)).then(distance(a).total_cmp(&distance(b)))
        });
        let best = best.unwrap_or(target);
        let step = 1.0 / best.dot(self.along);
        Along { step, drift: best.dot(self.along.turned()) * step }
    }
}

/// How many steps in a direction lie across the page and down.
fn crossings(period: Period, way: Vec2, step: Length) -> [f64; 2] {
    [period.width / step * way.x, period.height / step * way.y]
}

/// Steps a millimetre, in the direction in which they follow each other.
fn waves(period: Period, steps: [f64; 2]) -> Vec2 {
    Vec2::new(steps[0] / period.width.to_mm(), steps[1] / period.height.to_mm())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::Angle;

    fn is_whole(x: f64) -> bool {
        (x - x.round()).abs() < 1e-9
    }

    proptest! {
        #[test]
        fn lines_and_places_go_round(
            (width, height) in (5.0..60.0f64, 5.0..60.0f64),
            degrees in 0.0..180.0f64,
            (pitch, spacing) in (0.2..2.0f64, 0.2..2.0f64),
            bricks: bool,
        ) {
            let period = Period::new(Length::mm(width), Length::mm(height));
            let weave = Weave::new(period, Angle::degrees(degrees).unit(), Length::mm(pitch));
            let bond = if bricks { Bond::Bricks } else { Bond::Rows };
            let along = weave.along(Length::mm(spacing), bond);
            for way in [Vec2::new(width, 0.0), Vec2::new(0.0, height)] {
                let line = way.dot(weave.along.turned()) / weave.pitch;
                prop_assert!(is_whole(line));
                let parity = if bricks { line.round().rem_euclid(2.0) / 2.0 } else { 0.0 };
                let across = way.dot(weave.along.turned());
                prop_assert!(is_whole((way.dot(weave.along) + across * along.drift) / along.step - parity));
            }
            // Nothing is far from what was asked for: half a step over the page's shorter side.
            let slack = 0.75 / width.min(height);
            prop_assert!((1.0 / weave.pitch - 1.0 / pitch).abs() < slack);
            prop_assert!((1.0 / along.step - 1.0 / spacing).abs() < 2.0 * slack);
        }
    }

    #[test]
    fn lines_along_the_page_stay_so() {
        let period = Period::new(Length::mm(10.0), Length::mm(7.0));
        let weave = Weave::new(period, Vec2::new(1.0, 0.0), Length::mm(0.98));
        assert_eq!((weave.along, weave.pitch), (Vec2::new(1.0, 0.0), 1.0));
        let along = weave.along(Length::mm(2.4), Bond::Rows);
        assert_eq!((along.step, along.drift), (2.5, 0.0));
        let coarse = Weave::new(period, Vec2::new(1.0, 0.0), Length::mm(50.0));
        assert_eq!(coarse.pitch, 7.0);
    }
}
