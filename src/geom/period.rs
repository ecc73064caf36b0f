//! The period of a page that repeats: a torus as wide and as high as the page.

use super::{Length, Point, Rect, Vec2};

/// After which width and height a page repeats. Both are greater than zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Period {
    /// To the right.
    pub width: Length,
    /// Downwards.
    pub height: Length,
}

impl Period {
    /// From the page's size.
    #[must_use]
    pub const fn new(width: Length, height: Length) -> Self {
        Self { width, height }
    }

    /// One period from the origin on.
    #[must_use]
    pub fn area(self) -> Rect {
        Rect::new(Point::default(), Point::new(self.width.to_mm(), self.height.to_mm()))
    }

    /// The shorter of width and height.
    #[must_use]
    pub fn shorter(self) -> Length {
        self.width.min(self.height)
    }

    /// The image of a point in the first period, whose right and lower sides do not count.
    #[must_use]
    pub fn wrapped(self, p: Point) -> Point {
        let wrap = |x: f64, length: Length| {
            let rest = x.rem_euclid(length.to_mm());
            // Just below zero the rest rounds up to the whole length.
            if rest < length.to_mm() { rest } else { 0.0 }
        };
        Point::new(wrap(p.x, self.width), wrap(p.y, self.height))
    }

    /// The way to the nearest image of where a way leads.
    #[must_use]
    pub fn shortest(self, way: Vec2) -> Vec2 {
        let shorten = |x: f64, length: Length| x - (x / length.to_mm()).round() * length.to_mm();
        Vec2::new(shorten(way.x, self.width), shorten(way.y, self.height))
    }

    /// By how much a box is to be moved so that it shares more than an edge with an area: one way for each image that
    /// does, row by row, no way at all first where it is among them.
    pub fn ways(self, bounds: &Rect, area: &Rect) -> impl Iterator<Item = Vec2> + use<> {
        let columns = numbers(bounds.min.x, bounds.max.x, area.min.x, area.max.x, self.width);
        let rows = numbers(bounds.min.y, bounds.max.y, area.min.y, area.max.y, self.height);
        let (width, height) = (self.width.to_mm(), self.height.to_mm());
        let is_there = columns.contains(&0) && rows.contains(&0);
        let all = rows.flat_map(move |row| columns.clone().map(move |column| (column, row)));
        let others = all.filter(move |&(column, row)| !(is_there && column == 0 && row == 0));
        let own = is_there.then_some((0, 0));
        own.into_iter().chain(others).map(move |(column, row)| Vec2::new(column as f64 * width, row as f64 * height))
    }

    /// How many ways [`Self::ways`] has. It may be too great for a whole number.
    #[must_use]
    pub fn count(self, bounds: &Rect, area: &Rect) -> f64 {
        let count = |extent: f64, length: Length| (extent / length.to_mm()).floor() + 1.0;
        count(bounds.width() + area.width(), self.width) * count(bounds.height() + area.height(), self.height)
    }
}

/// How many equal steps of nearly `pitch` a length is cut into: the nearest number that is a multiple of `multiple`, at
/// least one multiple. It may be too great for a whole number.
#[must_use]
pub fn whole_steps(length: Length, pitch: Length, multiple: u32) -> f64 {
    let multiple = f64::from(multiple);
    (length / pitch / multiple).round().max(1.0) * multiple
}

/// The numbers of periods by which a range is moved so that it reaches into another.
fn numbers(low: f64, high: f64, from: f64, to: f64, period: Length) -> std::ops::RangeInclusive<i64> {
    let period = period.to_mm();
    // Ranges that merely touch do not count. What lies on an edge by all but rounding does, to be safe.
    let first = ((from - high) / period).floor() + 1.0;
    let last = ((to - low) / period).ceil() - 1.0;
    first as i64..=last as i64
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const PERIOD: Period = Period::new(Length::mm(4.0), Length::mm(3.0));

    proptest! {
        #[test]
        fn points_are_wrapped_into_the_first_period(x in -50.0..50.0f64, y in -50.0..50.0f64) {
            let wrapped = PERIOD.wrapped(Point::new(x, y));
            prop_assert!(PERIOD.area().contains(wrapped));
            let way = PERIOD.shortest(wrapped - Point::new(x, y));
            prop_assert!(way.length() < 1e-12);
        }

        #[test]
        fn ways_are_those_that_reach_the_area(
            (x, y) in (-9.0..9.0f64, -9.0..9.0f64),
            (w, h) in (0.01..9.0f64, 0.01..9.0f64),
            margin in 0.0..5.0f64,
        ) {
            let bounds = Rect::new(Point::new(x, y), Point::new(x + w, y + h));
            let area = PERIOD.area().grown(margin);
            let found: Vec<Vec2> = PERIOD.ways(&bounds, &area).collect();
            let all = (-9..=9).flat_map(|row| (-9..=9).map(move |column| (column, row)));
            let reach = all
                .map(|(column, row)| Vec2::new(f64::from(column) * 4.0, f64::from(row) * 3.0))
                .filter(|&way| !Rect::new(bounds.min + way, bounds.max + way).intersection(&area).is_empty());
            prop_assert_eq!(found.len(), reach.clone().count());
            prop_assert!(reach.clone().all(|way| found.contains(&way)));
            prop_assert!(!found.contains(&Vec2::default()) || found[0] == Vec2::default());
            prop_assert!(found.len() as f64 <= PERIOD.count(&bounds, &area));
        }
    }

    #[test]
    fn steps_are_whole() {
        let steps = |pitch, multiple| whole_steps(Length::mm(10.0), Length::mm(pitch), multiple);
        assert_eq!([steps(2.4, 1), steps(2.4, 2), steps(30.0, 1), steps(30.0, 2)], [4.0, 4.0, 1.0, 2.0]);
    }

    #[test]
    fn the_far_sides_belong_to_the_next_period() {
        assert_eq!(PERIOD.wrapped(Point::new(4.0, 3.0)), Point::default());
        assert_eq!(PERIOD.wrapped(Point::new(-1e-300, -0.0)), Point::default());
        let page = PERIOD.area();
        assert_eq!(PERIOD.ways(&page, &page).collect::<Vec<_>>(), [Vec2::default()]);
    }
}
