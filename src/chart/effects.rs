//! Effect plots: means of a measure over the levels of a factor, a line for each level of another one. Lines that run
//! side by side say that the factors do not act on each other.

use super::Titles;
use super::axis::{Area, Axis, draw_beside, finite, width};
use super::sheet::{Anchor, GREY, INK, SMALL, Sheet, TEXT, WIDTH, colour, dashes, legend, shortened};

/// A mean and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its confidence interval.
    pub interval: Option<[f64; 2]>,
}

/// The means of one level of the second factor.
#[derive(Debug, Clone)]
pub struct Effect<'a> {
    /// The level's name; empty where there is no second factor.
    pub name: &'a str,
    /// One for each level of the first factor.
    pub means: Vec<Option<Estimate>>,
}

const HEIGHT: f64 = 200.0;

/// A mean with its interval, as far as they can be drawn.
type Shown = (f64, Option<[f64; 2]>);

/// Draws means over the levels of a factor.
#[must_use]
pub fn effects(titles: &Titles<'_>, levels: &[&str], effects: &[Effect<'_>]) -> String {
    let mean = |estimate: &Estimate| Some((finite(estimate.mean)?, estimate.interval.and_then(interval)));
    let means: Vec<Vec<Option<Shown>>> = effects
        .iter()
        .map(|effect| effect.means.iter().take(levels.len()).map(|e| e.as_ref().and_then(mean)).collect())
        .collect();
    let shown = || means.iter().flatten().flatten();
    let values = shown().flat_map(|(mean, interval)| [*mean].into_iter().chain(interval.iter().flatten().copied()));
    let axis = Axis::over(values, 5.0);
    let names: Vec<&str> = effects.iter().map(|effect| effect.name).collect();
    let left = 38.0 + width(&axis);
    let size = WIDTH * 0.75;
    let top = 34.0 + legend(&mut Sheet::new(size, 0.0, ""), &names, left, size - 16.0, 0.0);
    let area = Area { left, top, right: size - 16.0, bottom: top + HEIGHT };
    let mut sheet = Sheet::new(size, area.bottom + 46.0, titles.title);
    legend(&mut sheet, &names, left, size - 16.0, 30.0);
    draw_beside(&mut sheet, &area, &axis, titles.y);
    sheet.line([area.left, area.bottom], [area.right, area.bottom], GREY, 1.0);
    let step = 1.0 / levels.len().max(1) as f64;
    for (i, level) in levels.iter().enumerate() {
        let x = area.x((i as f64 + 0.5) * step);
        let text = shortened(level, SMALL, (area.right - area.left) * step - 4.0);
        sheet.line([x, area.bottom], [x, area.bottom + 4.0], GREY, 1.0);
        sheet.text([x, area.bottom + 16.0], Anchor::Middle, SMALL, INK, &text);
    }
    sheet.text([area.x(0.5), area.bottom + 35.0], Anchor::Middle, TEXT, INK, titles.x);
    if shown().next().is_none() {
        sheet.no_data([area.x(0.5), area.y(0.5)]);
    }
    // Lines stand a little beside each other, so that intervals of equal means are seen.
    let apart = (area.right - area.left) * step * 0.08 / effects.len().max(1) as f64;
    for (series, means) in means.iter().enumerate() {
        let aside = (series as f64 - (effects.len() as f64 - 1.0) / 2.0) * apart;
        let x = |level: usize| area.x((level as f64 + 0.5) * step) + aside;
        let there = means.iter().enumerate().filter_map(|(level, mean)| mean.map(|mean| (level, mean)));
        let places: Vec<[f64; 2]> =
            there.clone().map(|(level, (mean, _))| [x(level), area.y(axis.share(mean))]).collect();
        sheet.polyline(&places, colour(series), dashes(series));
        for (level, (_, interval)) in there {
            if let Some([low, high]) = interval {
                let [low, high] = [low, high].map(|end| area.y(axis.share(end)));
                sheet.line([x(level), low], [x(level), high], colour(series), 1.4);
                for y in [low, high] {
                    sheet.line([x(level) - 4.0, y], [x(level) + 4.0, y], colour(series), 1.4);
                }
            }
        }
        places.iter().for_each(|&place| sheet.marker(place, 3.6, series));
    }
    sheet.finish()
}

fn interval([low, high]: [f64; 2]) -> Option<[f64; 2]> {
    Some([finite(low)?, finite(high)?])
}
