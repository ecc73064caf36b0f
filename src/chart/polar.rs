//! Histograms of directions on a circle.

use super::Titles;
use super::axis::{Axis, finite};
use super::sheet::{Anchor, FAINT, GREY, INK, SMALL, Sheet, TEXT, colour, number};
use crate::geom::Angle;

/// How often directions of one range occur.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sector {
    /// The share of all directions, in [0, 1].
    pub share: f64,
    /// How far it spreads, low and high.
    pub spread: Option<[f64; 2]>,
}

const SIZE: f64 = 400.0;
const RADIUS: f64 = 150.0;
const CENTRE: [f64; 2] = [SIZE / 2.0, 204.0];

/// Draws how often directions occur: sectors of equal ranges of half a turn, the first from 0 on. As a stroke has no
/// head, every sector is drawn on both sides, as it would lie on the page: 0 to the right, 90 degrees downwards. Areas are
/// as shares. `titles.x` stands below; `titles.y` is not used.
#[must_use]
pub fn directions(titles: &Titles<'_>, sectors: &[Sector]) -> String {
    let mut sheet = Sheet::new(SIZE, SIZE + 12.0, titles.title);
    let share = |sector: &Sector| finite(sector.share).unwrap_or(0.0).max(0.0);
    let spread = |sector: &Sector| sector.spread.and_then(|[low, high]| Some([finite(low)?, finite(high)?]));
    let greatest = sectors.iter().flat_map(|sector| spread(sector).into_iter().flatten().chain([share(sector)]));
    let axis = Axis::from_zero(greatest, 3.0);
    let radius = |share: f64| RADIUS * axis.share(share).sqrt();
    for (value, _) in axis.ticks().iter().skip(1) {
        sheet.ring(CENTRE, radius(*value), FAINT);
    }
    for degrees in (0..180).step_by(30) {
        let way = Angle::degrees(f64::from(degrees));
        let [to, from] = [RADIUS, -RADIUS].map(|radius| place(way, radius));
        sheet.line(from, to, FAINT, 1.0);
        for (side, degrees) in [(1.0, degrees), (-1.0, degrees + 180)] {
            let [x, y] = place(way, side * (RADIUS + 16.0));
            sheet.text([x, y + 4.0], Anchor::Middle, SMALL, GREY, &format!("{degrees}°"));
        }
    }
    let step = 180.0 / sectors.len().max(1) as f64;
    if sectors.iter().all(|sector| share(sector) == 0.0) {
        sheet.no_data(CENTRE);
    }
    for (i, sector) in sectors.iter().enumerate() {
        let [from, to] = [i as f64, i as f64 + 1.0].map(|edge| Angle::degrees(edge * step));
        let middle = Angle::degrees((i as f64 + 0.5) * step);
        for side in [1.0, -1.0] {
            let reach = radius(share(sector));
            if reach > 0.0 {
                let [start, end] = [from, to].map(|angle| place(angle, side * reach));
                let point = |[x, y]: [f64; 2]| format!("{} {}", number(x), number(y));
                let (centre, reach) = (point(CENTRE), number(reach));
                // Arcs turn with angles, which is clockwise on the page.
                let data = format!("M{centre}L{}A{reach} {reach} 0 0 1 {}z", point(start), point(end));
                sheet.area(&data, colour(0), 0.6);
            }
            if let Some([low, high]) = spread(sector).filter(|[low, high]| high > low) {
                let [low, high] = [low, high].map(|share| place(middle, side * radius(share.max(0.0))));
                sheet.line(low, high, INK, 1.0);
            }
        }
    }
    for (value, _) in axis.ticks().iter().skip(1) {
        // Between the labelled spokes, on white so that sectors do not hide it.
        let [x, y] = place(Angle::degrees(-75.0), radius(*value));
        let text = format!("{} %", number(value * 100.0));
        sheet.rectangle([x - 16.0, y - 7.0], [x + 16.0, y + 7.0], "#ffffff", 0.75, "none");
        sheet.text([x, y + 4.0], Anchor::Middle, SMALL, INK, &text);
    }
    sheet.text([CENTRE[0], SIZE], Anchor::Middle, TEXT, INK, titles.x);
    sheet.finish()
}

/// So far from the centre in a direction.
fn place(way: Angle, radius: f64) -> [f64; 2] {
    let unit = way.unit();
    [CENTRE[0] + unit.x * radius, CENTRE[1] + unit.y * radius]
}
