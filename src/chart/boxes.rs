//! Box plots: how values spread in each of several groups.
//!
//! Groups lie below each other, so that long names and many groups have room. A box reaches from the first to the third
//! quartile (linear between order statistics), its line is the median and the diamond the mean; whiskers end at the
//! farthest values within 1.5 boxes of it (Tukey 1977), and what lies beyond is drawn one by one.

use super::Titles;
use super::axis::{Area, Axis, draw_below, finite};
use super::sheet::{Anchor, GREY, INK, Sheet, TEXT, WIDTH, colour, shortened, width_of};

/// Values that belong together.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// What they are called.
    pub name: &'a str,
    /// The values, in any order.
    pub values: &'a [f64],
}

/// From group to group, and the thickness of a box, in pixels.
const ROW: f64 = 30.0;
const BOX: f64 = 15.0;

/// The greatest width of names.
const NAMES: f64 = 240.0;

/// How far whiskers reach, in boxes.
const REACH: f64 = 1.5;

/// Draws box plots of groups. The horizontal axis is that of the values; `titles.y` is not used.
#[must_use]
pub fn boxes(titles: &Titles<'_>, groups: &[Group<'_>]) -> String {
    let height = 34.0 + ROW * groups.len().max(1) as f64 + 46.0;
    let mut sheet = Sheet::new(WIDTH, height, titles.title);
    let names = groups.iter().map(|group| width_of(group.name, TEXT)).fold(0.0, f64::max).min(NAMES);
    let area = Area { left: 18.0 + names, top: 34.0, right: WIDTH - 16.0, bottom: height - 46.0 };
    let axis = Axis::over(groups.iter().flat_map(|group| group.values).copied(), 6.0);
    draw_below(&mut sheet, &area, &axis, titles.x);
    for (i, group) in groups.iter().enumerate() {
        let y = area.top + ROW * (i as f64 + 0.5);
        let name = shortened(group.name, TEXT, NAMES);
        sheet.text([area.left - 8.0, y + 4.0], Anchor::End, TEXT, INK, &name);
        let mut values: Vec<f64> = group.values.iter().copied().filter_map(finite).collect();
        values.sort_by(f64::total_cmp);
        if values.is_empty() {
            sheet.text([area.left + 8.0, y + 4.0], Anchor::Start, TEXT, GREY, "no data");
        } else {
            draw(&mut sheet, &values, |value| area.x(axis.share(value)), y, i);
        }
    }
    sheet.finish()
}

/// Draws the box of sorted values, at least one.
fn draw(sheet: &mut Sheet, values: &[f64], x: impl Fn(f64) -> f64, y: f64, series: usize) {
    let [q1, median, q3] = [0.25, 0.5, 0.75].map(|share| quantile(values, share));
    let reach = (q3 - q1) * REACH;
    let within = |value: &&f64| (q1 - reach..=q3 + reach).contains(*value);
    let low = values.iter().find(within).copied().unwrap_or(q1).min(q1);
    let high = values.iter().rev().find(within).copied().unwrap_or(q3).max(q3);
    let (top, bottom) = (y - BOX / 2.0, y + BOX / 2.0);
    sheet.line([x(low), y], [x(q1), y], INK, 1.0);
    sheet.line([x(q3), y], [x(high), y], INK, 1.0);
    for end in [low, high] {
        sheet.line([x(end), y - 4.0], [x(end), y + 4.0], INK, 1.0);
    }
    sheet.rectangle([x(q1), top], [x(q3), bottom], colour(series), 0.45, INK);
    sheet.line([x(median), top], [x(median), bottom], INK, 2.0);
    for &value in values.iter().filter(|value| !within(value)) {
        sheet.ring([x(value), y], 2.2, INK);
    }
    let mean = values.iter().map(|value| value / values.len() as f64).sum();
    let (x, size) = (x(mean), 3.6);
    sheet.polygon(&[[x, y - size], [x + size, y], [x, y + size], [x - size, y]], "#ffffff", 1.0);
    sheet.polygon(&[[x, y - size + 1.2], [x + size - 1.2, y], [x, y + size - 1.2], [x - size + 1.2, y]], INK, 1.0);
}

/// A quantile of sorted values, at least one: linear between order statistics.
pub(super) fn quantile(values: &[f64], share: f64) -> f64 {
    let place = share * (values.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(values.len() - 1);
    values[below] + (values[above] - values[below]) * (place - below as f64)
}
