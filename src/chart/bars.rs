//! Histograms: how often values occur.

use super::Titles;
use super::axis::{Area, Axis, draw_below, draw_beside, finite, width};
use super::sheet::{Anchor, INK, Sheet, TEXT, WIDTH, colour, width_of};

/// How often values of equal ranges occur.
#[derive(Debug, Clone)]
pub struct Bars<'a> {
    /// Where the first bar begins and the last ends; the first is less.
    pub range: [f64; 2],
    /// How high each bar is, not negative.
    pub heights: &'a [f64],
    /// How far the height of each spreads, low and high; empty where nothing is known of it.
    pub spreads: &'a [[f64; 2]],
    /// Values that are marked.
    pub marks: &'a [Mark<'a>],
}

/// A value that a line marks.
#[derive(Debug, Clone, Copy)]
pub struct Mark<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The value; outside the range of the bars it is not drawn.
    pub value: f64,
}

const HEIGHT: f64 = 220.0;

/// Draws a histogram.
#[must_use]
pub fn histogram(titles: &Titles<'_>, bars: &Bars<'_>) -> String {
    let heights: Vec<f64> = bars.heights.iter().map(|&height| finite(height).unwrap_or(0.0).max(0.0)).collect();
    let spreads = bars.spreads.iter().flatten().copied();
    let across = Axis::from_zero(heights.iter().copied().chain(spreads), 5.0);
    let [low, high] = bars.range.map(|end| finite(end).unwrap_or(0.0));
    let along = Axis::new(low, if high > low { high } else { low + 1.0 }, 8.0);
    let marks: Vec<&Mark<'_>> = bars.marks.iter().filter(|mark| along.holds(mark.value)).collect();
    let top = 34.0 + 16.0 * marks.len() as f64;
    let area = Area { left: 38.0 + width(&across), top, right: WIDTH - 16.0, bottom: top + HEIGHT };
    let mut sheet = Sheet::new(WIDTH, area.bottom + 46.0, titles.title);
    draw_below(&mut sheet, &area, &along, titles.x);
    draw_beside(&mut sheet, &area, &across, titles.y);
    if heights.iter().all(|&height| height == 0.0) {
        sheet.no_data([area.x(0.5), area.y(0.5)]);
    }
    let count = heights.len() as f64;
    for (i, &height) in heights.iter().enumerate() {
        let [from, to] = [i as f64, i as f64 + 1.0].map(|edge| area.x(edge / count));
        if height > 0.0 {
            sheet.rectangle([from, area.bottom], [to, area.y(across.share(height))], colour(0), 0.6, "#ffffff");
        }
        if let Some([low, high]) = bars.spreads.get(i).filter(|[low, high]| high > low) {
            let x = (from + to) / 2.0;
            sheet.line([x, area.y(across.share(*low))], [x, area.y(across.share(*high))], INK, 1.2);
        }
    }
    for (row, mark) in marks.iter().enumerate() {
        let (x, y) = (area.x(along.share(mark.value)), 40.0 + 16.0 * row as f64);
        sheet.dashed([x, y + 4.0], [x, area.bottom], colour(1), "5 3");
        // The text stands on the side where it has room.
        let fits = x + width_of(mark.name, TEXT) < WIDTH - 8.0;
        let anchor = if fits { Anchor::Start } else { Anchor::End };
        sheet.text([if fits { x - 2.0 } else { x + 2.0 }, y], anchor, TEXT, INK, mark.name);
    }
    sheet.finish()
}
