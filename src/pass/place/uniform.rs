//! Independent points, spread evenly or in proportion to a weight.
//!
//! The points in the domain come first and are just as many as were asked for; those of the bleed follow, strip by strip
//! round the domain, at the same density. All draws come from one stream, read in sequence.

use crate::diag::Diagnostic;
use crate::field::{Field, Node};
use crate::geom::{Point, Rect, Vec2};
use crate::random::Stream;
use crate::scene::{Amount, Placement};
use crate::stage::Sites;

use super::{Ground, find, point_in};

/// Points over the domain and its bleed.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, amount: &Amount) -> Result<Sites, Diagnostic> {
    let even = Field::constant(1.0);
    let weight = match amount {
        Amount::Count { density, .. } => density.as_ref().unwrap_or(&even),
        Amount::AsMany(_) => &even,
        Amount::Density { density, .. } => density,
    };
    let spread = Spread::new(ground.domain, weight);
    let count = match amount {
        // A weight that is nowhere greater than zero leaves no place for any.
        Amount::Count { count, .. } => f64::from(*count) * if spread.total > 0.0 { 1.0 } else { 0.0 },
        Amount::AsMany(inner) => {
            let found = find(inner, ground)?;
            found.points.iter().filter(|&&p| ground.domain.contains(p)).count() as f64
        }
        Amount::Density { unit, .. } => (spread.total / (unit.to_mm() * unit.to_mm())).round(),
    };
    ground.budget.expect(placement, count)?;
    let spacing = ground.mean_spacing(count as usize);
    let default_bleed = match amount {
        Amount::Count { .. } | Amount::AsMany(_) => 0.0,
        Amount::Density { .. } => spacing,
    };
    let mut parts = vec![(spread, count)];
    for strip in strips(&ground.domain, &ground.extent(default_bleed)) {
        let spread = Spread::new(strip, weight);
        let share = if count > 0.0 { spread.total / parts[0].0.total } else { 0.0 };
        parts.push((spread, (count * share).round()));
    }
    ground.budget.expect(placement, parts.iter().map(|(_, count)| count).sum())?;
    let mut stream = ground.stream("uniform");
    let mut points = Vec::new();
    for (spread, count) in &parts {
        points.extend((0..*count as usize).map(|_| spread.draw(&mut stream)));
    }
    Ok(ground.sites(points, spacing, default_bleed))
}

/// The frame between a box and a greater one: above, below, left and right.
fn strips(inner: &Rect, outer: &Rect) -> impl Iterator<Item = Rect> {
    [
        Rect::new(outer.min, Point::new(outer.max.x, inner.min.y)),
        Rect::new(Point::new(outer.min.x, inner.max.y), outer.max),
        Rect::new(Point::new(outer.min.x, inner.min.y), Point::new(inner.min.x, inner.max.y)),
        Rect::new(Point::new(inner.max.x, inner.min.y), Point::new(outer.max.x, inner.max.y)),
    ]
    .into_iter()
    .filter(|strip| !strip.is_empty())
}

/// Cells a side of an area that a weight is sampled on.
const CELLS: usize = 64;

/// Samples a side of a cell.
const SAMPLES: usize = 3;

/// A weight beyond which nothing changes; it keeps sums finite.
const GREATEST_WEIGHT: f64 = 1e100;

/// Tries of a point before the last one stands, where a weight is too ragged for its samples.
const TRIES: u32 = 1000;

/// A weight over an area, ready to be drawn from.
///
/// The area is cut into 64 x 64 cells with 3 x 3 samples each. A point is proposed in a cell picked in proportion to the
/// greatest sample, and kept in proportion to the weight at the point: rejection against a maximum, taken cell by cell
/// so that a small dark spot in a white area costs no more than an even grey. A weight that rises above the samples of
/// its cell counts as the greatest of them.
struct Spread<'a> {
    area: Rect,
    weight: &'a Field,
    /// The integral of the weight over the area, weights times square millimetres.
    total: f64,
    /// The greatest sample of every cell; empty where the weight is the same everywhere.
    greatest: Vec<f64>,
    /// The sum of `greatest` up to and with every cell.
    sums: Vec<f64>,
}

impl<'a> Spread<'a> {
    fn new(area: Rect, weight: &'a Field) -> Self {
        let size = area.width() * area.height();
        if let Node::Constant(value) = weight.node() {
            return Self { area, weight, total: value.max(0.0) * size, greatest: Vec::new(), sums: Vec::new() };
        }
        let mut spread = Self { area, weight, total: 0.0, greatest: Vec::new(), sums: Vec::new() };
        let (mut sum, mut reached) = (0.0, 0.0);
        for cell in 0..CELLS * CELLS {
            let rect = spread.cell(cell);
            let mut greatest = 0.0f64;
            for sample in 0..SAMPLES * SAMPLES {
                let part = |number: usize| (number as f64 + 0.5) / SAMPLES as f64;
                let way = Vec2::new(part(sample % SAMPLES) * rect.width(), part(sample / SAMPLES) * rect.height());
                let value = spread.at(rect.min + way);
                greatest = greatest.max(value);
                sum += value;
            }
            reached += greatest;
            spread.greatest.push(greatest);
            spread.sums.push(reached);
        }
        spread.total = sum / (CELLS * CELLS * SAMPLES * SAMPLES) as f64 * size;
        spread
    }

    fn at(&self, p: Point) -> f64 {
        let weight = self.weight.at(p);
        // This way round, what is no number is no weight either.
        if weight > 0.0 { weight.min(GREATEST_WEIGHT) } else { 0.0 }
    }

    fn cell(&self, number: usize) -> Rect {
        let part = |number: usize| number as f64 / CELLS as f64;
        let corner = |column: usize, row: usize| {
            self.area.min + Vec2::new(self.area.width() * part(column), self.area.height() * part(row))
        };
        let (column, row) = (number % CELLS, number / CELLS);
        Rect::new(corner(column, row), corner(column + 1, row + 1))
    }

    /// A point in proportion to the weight, which is greater than zero somewhere.
    fn draw(&self, stream: &mut Stream) -> Point {
        let Some(&all) = self.sums.last() else { return point_in(&self.area, stream) };
        let mut tries = 1;
        loop {
            let reached = stream.unit() * all;
            let number = self.sums.partition_point(|&sum| sum <= reached).min(self.sums.len() - 1);
            let p = point_in(&self.cell(number), stream);
            if stream.unit() * self.greatest[number] < self.at(p) || tries == TRIES {
                return p;
            }
            tries += 1;
        }
    }
}
