//! Axes: which part of the numbers is shown, and where its ticks are.

use super::sheet::{Anchor, FAINT, GREY, INK, SMALL, Sheet, TEXT, width_of};

/// The greatest number shown; differences of such are still numbers.
const GREATEST: f64 = 1e100;

/// Ranges that are smaller than this share of their numbers are one value to the eye.
const SAME: f64 = 1e-9;

/// A number that can be drawn.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then(|| value.clamp(-GREATEST, GREATEST))
}

/// A range of numbers, not empty, with its ticks.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    /// An axis that shows all of these values with some air around them, and about so many ticks. Zero to one where there
    /// are none.
    pub(super) fn over(values: impl IntoIterator<Item = f64>, ticks: f64) -> Self {
        let (low, high) = range(values);
        let air = (high - low) * 0.04;
        Self::new(low - air, high + air, ticks)
    }

    /// The same, but an axis that begins at zero, as lengths of bars must.
    pub(super) fn from_zero(values: impl IntoIterator<Item = f64>, ticks: f64) -> Self {
        let greatest = values.into_iter().filter_map(finite).fold(0.0, f64::max);
        Self::new(0.0, if greatest > 0.0 { greatest * 1.06 } else { 1.0 }, ticks)
    }

    /// An axis of just this range, of which `low` is less.
    pub(super) fn new(low: f64, high: f64, ticks: f64) -> Self {
        let rough = (high - low) / ticks.max(1.0);
        let power = libm::pow(10.0, libm::floor(libm::log10(rough)));
        let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
        let step = steps.into_iter().find(|&step| step >= rough).unwrap_or(steps[3]);
        Self { low, high, step }
    }

    /// Where a value lies, as a share of the axis.
    pub(super) fn share(&self, value: f64) -> f64 {
        ((finite(value).unwrap_or(self.low) - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }

    /// Whether the axis runs over a value.
    pub(super) fn holds(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// Every tick with its text.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let first = libm::ceil(self.low / self.step - SAME);
        let count = libm::floor(self.high / self.step + SAME) - first;
        let count = if count.is_finite() { count.clamp(0.0, 40.0) as u32 } else { 0 };
        let greatest = self.low.abs().max(self.high.abs());
        // A step such as 0.05 has its first digit in the second place.
        let places = libm::ceil(-libm::log10(self.step) - SAME).max(0.0);
        let is_plain = greatest < 1e6 && places <= 6.0;
        let text = |value: f64| match value {
            0.0 => "0".to_owned(),
            value if is_plain => format!("{value:.*}", places as usize).replace('-', "\u{2212}"),
            value => scientific(value, libm::log10(greatest / self.step)),
        };
        (0..=count)
            .map(|i| {
                let value = (first + f64::from(i)) * self.step;
                // Near zero nothing but rounding is left.
                let value = if value.abs() < self.step * 1e-6 { 0.0 } else { value };
                (value, text(value))
            })
            .collect()
    }
}

/// A number as `1.25e9`, with so many digits that values of an axis differ.
fn scientific(value: f64, digits: f64) -> String {
    let text = format!("{value:.*e}", digits.clamp(0.0, 12.0).ceil() as usize);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{mantissa}e{exponent}").replace('-', "\u{2212}")
}

/// The least range that holds all values; a range around them where they are one.
fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let values = values.into_iter().filter_map(finite);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    if high - low > size * SAME {
        return (low, high);
    }
    let around = if size > 0.0 { size * 0.1 } else { 1.0 };
    (low - around, high + around)
}

/// The part of a sheet that data are drawn in, in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    /// Where a share of the horizontal axis lies.
    pub(super) fn x(&self, share: f64) -> f64 {
        self.left + (self.right - self.left) * share
    }

    /// Where a share of the vertical axis lies, which runs upwards.
    pub(super) fn y(&self, share: f64) -> f64 {
        self.bottom + (self.top - self.bottom) * share
    }
}

/// The space that the texts of a vertical axis take.
pub(super) fn width(axis: &Axis) -> f64 {
    axis.ticks().iter().map(|(_, text)| width_of(text, SMALL)).fold(0.0, f64::max)
}

/// Draws the horizontal axis below the area, with faint lines up through it.
pub(super) fn draw_below(sheet: &mut Sheet, area: &Area, axis: &Axis, title: &str) {
    for (value, text) in axis.ticks() {
        let x = area.x(axis.share(value));
        sheet.line([x, area.top], [x, area.bottom], FAINT, 1.0);
        sheet.line([x, area.bottom], [x, area.bottom + 4.0], GREY, 1.0);
        sheet.text([x, area.bottom + 16.0], Anchor::Middle, SMALL, INK, &text);
    }
    sheet.line([area.left, area.bottom], [area.right, area.bottom], GREY, 1.0);
    sheet.text([area.x(0.5), area.bottom + 35.0], Anchor::Middle, TEXT, INK, title);
}

/// Draws the vertical axis left of the area, with faint lines across it.
pub(super) fn draw_beside(sheet: &mut Sheet, area: &Area, axis: &Axis, title: &str) {
    for (value, text) in axis.ticks() {
        let y = area.y(axis.share(value));
        sheet.line([area.left, y], [area.right, y], FAINT, 1.0);
        sheet.line([area.left - 4.0, y], [area.left, y], GREY, 1.0);
        sheet.text([area.left - 8.0, y + 4.0], Anchor::End, SMALL, INK, &text);
    }
    sheet.line([area.left, area.top], [area.left, area.bottom], GREY, 1.0);
    sheet.upright([area.left - width(axis) - 22.0, area.y(0.5)], TEXT, INK, title);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64) -> Vec<String> {
        Axis::new(low, high, 5.0).ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(texts(0.0, 1.0), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(-0.4, 0.21), ["\u{2212}0.4", "\u{2212}0.2", "0", "0.2"]);
        assert_eq!(texts(0.0, 700.0), ["0", "200", "400", "600"]);
        assert_eq!(texts(0.0, 3e9), ["0", "1e9", "2e9", "3e9"]);
        assert_eq!(texts(0.0, 4e-9), ["0", "1e\u{2212}9", "2e\u{2212}9", "3e\u{2212}9", "4e\u{2212}9"]);
    }

    #[test]
    fn every_range_can_be_drawn() {
        let odd = [&[][..], &[0.5], &[0.0, 0.0], &[1e300, -1e300], &[f64::NAN, f64::INFINITY], &[1.0, 1.0 + 1e-15]];
        for values in odd {
            for axis in [Axis::over(values.iter().copied(), 5.0), Axis::from_zero(values.iter().copied(), 5.0)] {
                let ticks = axis.ticks();
                assert!((1..=12).contains(&ticks.len()), "{values:?}: {ticks:?}");
                assert!(values.iter().all(|&v| (0.0..=1.0).contains(&axis.share(v))));
            }
        }
    }
}
