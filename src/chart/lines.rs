//! Lines with bands, and points: series over a common horizontal axis.

use super::Titles;
use super::axis::{Area, Axis, draw_below, draw_beside, finite, width};
use super::sheet::{GREY, Sheet, WIDTH, colour, dashes, legend};

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// A line through its spots, with a marker at each.
    Joined,
    /// A line alone, as for fitted curves.
    Line,
    /// Markers alone: a scatter plot.
    Markers,
}

/// One value of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Where along the horizontal axis.
    pub x: f64,
    /// The value.
    pub y: f64,
    /// How far it spreads: the lower and upper edge of its band.
    pub band: Option<[f64; 2]>,
}

/// Values that belong together.
#[derive(Debug, Clone)]
pub struct Series<'a> {
    /// What they are called; empty for none.
    pub name: &'a str,
    /// How they are drawn.
    pub look: Look,
    /// The values in the order in which lines join them.
    pub spots: Vec<Spot>,
}

/// The height of the part that data are drawn in.
const HEIGHT: f64 = 270.0;

/// How opaque bands are.
const BAND: f64 = 0.16;

/// The widths of edges of bands, so that those of equal series are seen.
const EDGE: &str = "1 3";

/// Draws series of values. Where values of both signs are shown, a line marks zero. `range` is the vertical range that is
/// shown at least, so that charts beside each other can be compared.
#[must_use]
pub fn lines(titles: &Titles<'_>, series: &[Series<'_>], range: Option<[f64; 2]>) -> String {
    let drawn: Vec<Vec<Spot>> = series.iter().map(|series| series.spots.iter().filter_map(spot).collect()).collect();
    let spots = || drawn.iter().flatten();
    let values = spots().flat_map(|spot| [spot.y].into_iter().chain(spot.band.into_iter().flatten()));
    let across = Axis::over(values.chain(range.into_iter().flatten()), 6.0);
    let along = Axis::over(spots().map(|spot| spot.x), 8.0);
    let names: Vec<&str> = series.iter().map(|series| series.name).collect();
    let left = 38.0 + width(&across);
    // How high the legend is is known when it is drawn.
    let top = 30.0 + legend(&mut Sheet::new(WIDTH, 0.0, ""), &names, left, WIDTH - 16.0, 0.0);
    let area = Area { left, top: top + 4.0, right: WIDTH - 16.0, bottom: top + 4.0 + HEIGHT };
    let mut sheet = Sheet::new(WIDTH, area.bottom + 46.0, titles.title);
    legend(&mut sheet, &names, left, WIDTH - 16.0, 30.0);
    draw_below(&mut sheet, &area, &along, titles.x);
    draw_beside(&mut sheet, &area, &across, titles.y);
    if across.holds(0.0) {
        let y = area.y(across.share(0.0));
        sheet.line([area.left, y], [area.right, y], GREY, 1.0);
    }
    if spots().next().is_none() {
        sheet.no_data([area.x(0.5), area.y(0.5)]);
    }
    let place = |x: f64, y: f64| [area.x(along.share(x)), area.y(across.share(y))];
    for (i, spots) in drawn.iter().enumerate() {
        let edge = |side: usize| spots.iter().filter_map(move |spot| spot.band.map(|band| place(spot.x, band[side])));
        let (lower, upper): (Vec<[f64; 2]>, Vec<[f64; 2]>) = (edge(0).collect(), edge(1).collect());
        let outline: Vec<[f64; 2]> = lower.iter().chain(upper.iter().rev()).copied().collect();
        sheet.polygon(&outline, colour(i), BAND);
        sheet.polyline(&lower, colour(i), Some(EDGE));
        sheet.polyline(&upper, colour(i), Some(EDGE));
    }
    for (i, (series, spots)) in series.iter().zip(&drawn).enumerate() {
        let places: Vec<[f64; 2]> = spots.iter().map(|spot| place(spot.x, spot.y)).collect();
        match series.look {
            Look::Joined => {
                sheet.polyline(&places, colour(i), dashes(i));
                places.iter().for_each(|&place| sheet.marker(place, 3.2, i));
            }
            Look::Line => sheet.polyline(&places, colour(i), dashes(i)),
            Look::Markers => places.iter().for_each(|&place| sheet.marker(place, 2.6, i)),
        }
    }
    sheet.finish()
}

/// A spot that can be drawn.
fn spot(spot: &Spot) -> Option<Spot> {
    let band = spot.band.and_then(|[low, high]| Some([finite(low)?, finite(high)?]));
    Some(Spot { x: finite(spot.x)?, y: finite(spot.y)?, band })
}
