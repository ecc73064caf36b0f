//! Poisson-disk sampling: random sites of which no two are closer than a radius.
//!
//! The algorithm is Bridson's, "Fast Poisson disk sampling in arbitrary dimensions" (SIGGRAPH 2007 sketches): `tries`
//! candidates round an active site that is picked at random, at a distance that is uniform in [r, 2r) and in a uniform
//! direction; the first that keeps its distance becomes a site, and a site all of whose candidates fail is active no
//! longer. The order of the sites is that of their discovery. All draws come from one stream, read in sequence.
//!
//! With a density d, clamped to [0, 1], a place has a local radius of r / sqrt(d), and no site where d is below 1/64. A
//! candidate keeps its own local radius from every earlier site, so that no two sites are ever closer than r. What grows
//! from one seed may not reach an island beyond a stretch of white: after it has run dry, one point in every empty cell of
//! the grid, row by row, is offered as a further seed. The same is done in a strip so narrow that a site's candidates
//! mostly miss it. Elsewhere it is left out, for it would pack the sites closer than Bridson's algorithm does.
//!
//! On a torus candidates beyond a border come in at the opposite one, and distances are taken the shortest way round.

use crate::diag::Diagnostic;
use crate::field::Field;
use crate::geom::{Period, Point, Rect, Vec2};
use crate::random::Stream;
use crate::scene::Placement;
use crate::stage::Sites;

use super::{Ground, point_in};

/// Sites of Bridson's sampling in a square of side r, as measured over large areas.
const SITES_A_SQUARE: f64 = 0.65;

/// Where the density is below it no site is placed.
const LEAST_DENSITY: f64 = 1.0 / 64.0;

/// Below how many radii an extent is a strip that growth may not get along.
const NARROW: f64 = 2.0;

/// How many places a side a density is looked at for the estimate.
const SAMPLES: u32 = 64;

/// What is asked of the sampling.
pub(super) struct Disk<'a> {
    /// In millimetres.
    pub(super) radius: f64,
    /// Candidates round a site.
    pub(super) tries: u32,
    /// From 0 to 1.
    pub(super) density: Option<&'a Field>,
}

impl Disk<'_> {
    /// How far a site at `p` keeps from earlier ones; none where there is no site.
    fn local_radius(&self, p: Point) -> Option<f64> {
        let Some(density) = self.density else { return Some(self.radius) };
        let d = density.at(p).min(1.0);
        (d >= LEAST_DENSITY).then(|| self.radius / d.sqrt())
    }

    /// About how many sites there will be.
    fn estimate(&self, extent: &Rect) -> f64 {
        // A strip that is narrower than the radius holds a row of sites.
        let across = (extent.width() / self.radius).max(1.0);
        let down = (extent.height() / self.radius).max(1.0);
        let share = self.density.map_or(1.0, |density| {
            let step = Vec2::new(extent.width() / f64::from(SAMPLES), extent.height() / f64::from(SAMPLES));
            let mut sum = 0.0;
            for row in 0..SAMPLES {
                for column in 0..SAMPLES {
                    let way = Vec2::new((f64::from(column) + 0.5) * step.x, (f64::from(row) + 0.5) * step.y);
                    let d = density.at(extent.min + way).min(1.0);
                    sum += if d >= LEAST_DENSITY { d } else { 0.0 };
                }
            }
            sum / f64::from(SAMPLES * SAMPLES)
        });
        SITES_A_SQUARE * across * down * share
    }
}

/// Sites that keep their distance, over the whole extent.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, disk: &Disk<'_>) -> Result<Sites, Diagnostic> {
    let extent = ground.extent(disk.radius);
    ground.budget.expect(placement, disk.estimate(&extent))?;
    let mut growth = Growth {
        placement,
        ground,
        disk,
        extent,
        grid: Grid::new(placement, ground, &extent, disk.radius)?,
        points: Vec::new(),
        radii: Vec::new(),
        active: Vec::new(),
        stream: ground.stream("poisson"),
    };
    let seed = point_in(&extent, &mut growth.stream);
    growth.offer(seed)?;
    growth.grow()?;
    if disk.density.is_some() || extent.width().min(extent.height()) < NARROW * disk.radius {
        growth.sow()?;
    }
    Ok(ground.sites(growth.points, disk.radius, disk.radius))
}

/// A sampling under way.
struct Growth<'a> {
    placement: &'a Placement,
    ground: &'a Ground<'a>,
    disk: &'a Disk<'a>,
    extent: Rect,
    grid: Grid,
    points: Vec<Point>,
    /// The local radius of every site; empty without a density.
    radii: Vec<f64>,
    active: Vec<u32>,
    stream: Stream,
}

impl Growth<'_> {
    /// Finds sites round the active ones until none is active, or an end is asked for.
    fn grow(&mut self) -> Result<(), Diagnostic> {
        let mut near = Near::new();
        // Rounding to f32 moves a distance by far less than this share of it.
        let surely_closer = (self.disk.radius * self.disk.radius * (1.0 - 1e-5)) as f32;
        while !self.active.is_empty() && !self.ground.stop.is_asked() {
            let pick = self.stream.below(self.active.len() as u64) as usize;
            let site = self.active[pick] as usize;
            let origin = self.points[site];
            let radius = self.radii.get(site).copied().unwrap_or(self.disk.radius);
            near.gather(&self.grid, &self.points, origin);
            let mut found = false;
            for _ in 0..self.disk.tries {
                let way = annulus(&mut self.stream, radius);
                if !near.is_closer(way, surely_closer) && self.offer(origin + way)? {
                    found = true;
                    break;
                }
            }
            if !found {
                self.active.swap_remove(pick);
            }
        }
        Ok(())
    }

    /// Offers a seed in every empty cell, and lets each that is taken grow.
    fn sow(&mut self) -> Result<(), Diagnostic> {
        for row in (0..self.grid.rows).take_while(|_| !self.ground.stop.is_asked()) {
            for column in 0..self.grid.columns {
                if self.grid.cells[self.grid.index(column, row)] != EMPTY {
                    continue;
                }
                // Cells at the far sides reach beyond the extent.
                let area = self.grid.cell(column, row).intersection(&self.extent);
                let seed = point_in(&area, &mut self.stream);
                if self.offer(seed)? {
                    self.grow()?;
                }
            }
        }
        Ok(())
    }

    /// Takes a candidate as a site if it lies in the extent and keeps its distance from all others.
    fn offer(&mut self, candidate: Point) -> Result<bool, Diagnostic> {
        let candidate = match self.grid.torus {
            Some(period) => period.wrapped(candidate),
            None => candidate,
        };
        if !self.extent.contains(candidate) {
            return Ok(false);
        }
        let cell = self.grid.cell_of(candidate);
        if self.grid.cells[cell] != EMPTY {
            return Ok(false);
        }
        let Some(radius) = self.disk.local_radius(candidate) else { return Ok(false) };
        if self.grid.has_closer(&self.points, candidate, radius) {
            return Ok(false);
        }
        self.ground.budget.one_more(self.placement, self.points.len())?;
        let index = self.points.len() as u32;
        self.grid.cells[cell] = index;
        self.points.push(candidate);
        if self.disk.density.is_some() {
            self.radii.push(radius);
        }
        self.active.push(index);
        Ok(true)
    }
}

/// A vector whose length is uniform in [r, 2r) and whose direction is uniform.
///
/// The direction is that of a point uniform in the unit disc. The square of that point's distance from the centre is
/// itself uniform and independent of the direction (Marsaglia 1962), so it serves as the length's share too.
fn annulus(stream: &mut Stream, radius: f64) -> Vec2 {
    loop {
        let [x, y] = stream.signed_pair();
        let square = x * x + y * y;
        if square < 1.0 && square > 0.0 {
            return Vec2::new(x, y) * (radius * (1.0 + square) / square.sqrt());
        }
    }
}

/// A cell without a site.
const EMPTY: u32 = u32::MAX;

/// Empty cells round the grid, so that the cells near a site can be looked at without minding the border.
const BORDER: usize = 3;

/// A grid of cells of side r / sqrt(2), each of which holds at most one site. On a torus they are a little smaller, so
/// that a whole number of them goes round.
struct Grid {
    min: Point,
    /// Width and height of a cell.
    side: [f64; 2],
    torus: Option<Period>,
    columns: usize,
    rows: usize,
    /// Indices of sites, row by row, the border included.
    cells: Vec<u32>,
    /// The way in `cells` to each of the cells that [`Near`] looks at.
    around: Vec<isize>,
}

impl Grid {
    fn new(placement: &Placement, ground: &Ground<'_>, extent: &Rect, radius: f64) -> Result<Self, Diagnostic> {
        let side = radius * std::f64::consts::FRAC_1_SQRT_2;
        let count = |length: f64| match ground.torus {
            Some(_) => (length / side).ceil().max(1.0),
            // A column more than the width needs, since a quotient may round up to a whole number.
            None => (length / side).floor() + 1.0,
        };
        let (columns, rows) = (count(extent.width()), count(extent.height()));
        let sides = match ground.torus {
            Some(_) => [extent.width() / columns, extent.height() / rows],
            None => [side; 2],
        };
        let border = 2.0 * BORDER as f64;
        let cells = ground.budget.grid(placement, columns + border, rows + border)?;
        let (columns, rows) = (columns as usize, rows as usize);
        let stride = (columns + 2 * BORDER) as isize;
        let reach = BORDER as isize;
        let around = (-reach..=reach)
            .flat_map(|row| (-reach..=reach).map(move |column| row * stride + column))
            .filter(|&way| way != 0)
            .collect();
        Ok(Self { min: extent.min, side: sides, torus: ground.torus, columns, rows, cells, around })
    }

    fn stride(&self) -> usize {
        self.columns + 2 * BORDER
    }

    /// Where a cell stands in `cells`.
    fn index(&self, column: usize, row: usize) -> usize {
        (row + BORDER) * self.stride() + column + BORDER
    }

    fn column_and_row(&self, p: Point) -> (usize, usize) {
        let way = p - self.min;
        // A conversion from a float stops at 0 on its own.
        (((way.x / self.side[0]) as usize).min(self.columns - 1), ((way.y / self.side[1]) as usize).min(self.rows - 1))
    }

    fn cell_of(&self, p: Point) -> usize {
        let (column, row) = self.column_and_row(p);
        self.index(column, row)
    }

    /// The area of a cell.
    fn cell(&self, column: usize, row: usize) -> Rect {
        let [width, height] = self.side;
        let min = self.min + Vec2::new(column as f64 * width, row as f64 * height);
        Rect::new(min, min + Vec2::new(width, height))
    }

    /// Whether a site is closer to `p` than `radius`.
    fn has_closer(&self, points: &[Point], p: Point, radius: f64) -> bool {
        let (column, row) = self.column_and_row(p);
        let reach = (radius / self.side[0].min(self.side[1])) as usize + 1;
        let limit = radius * radius;
        if let Some(period) = self.torus
            && self.is_near_border(column, row, reach)
        {
            return self.round(column, row, reach).any(|site| {
                let way = period.shortest(points[site as usize] - p);
                way.length_squared() < limit
            });
        }
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
        rows.into_iter().any(|row| {
            self.cells[self.index(columns.start, row)..self.index(columns.end, row)]
                .iter()
                .any(|&site| site != EMPTY && points[site as usize].distance_squared(p) < limit)
        })
    }
}

impl Grid {
    /// Whether cells within a reach of one lie beyond a border.
    fn is_near_border(&self, column: usize, row: usize, reach: usize) -> bool {
        column < reach || row < reach || column + reach >= self.columns || row + reach >= self.rows
    }

    /// The sites in the cells within a reach of one, round the torus; none of them twice.
    fn round(&self, column: usize, row: usize, reach: usize) -> impl Iterator<Item = u32> + '_ {
        let numbers = move |at: usize, count: usize| {
            let first = (at + count - reach.min(count) % count) % count;
            (0..(2 * reach + 1).min(count)).map(move |i| (first + i) % count)
        };
        let rows = numbers(row, self.rows);
        let cells = rows.flat_map(move |row| numbers(column, self.columns).map(move |column| self.index(column, row)));
        cells.map(|cell| self.cells[cell]).filter(|&site| site != EMPTY)
    }
}

/// Cells that are looked at round a site.
const AROUND: usize = (2 * BORDER + 1) * (2 * BORDER + 1);

/// The sites near an active one, relative to it, as a quick way to discard its candidates.
///
/// Nearly all candidates fail, most of them on a site close by. Gathering those once for all candidates of a pick and
/// comparing without branches takes half the time of walking the grid for each; what passes is compared exactly.
struct Near {
    x: [f32; AROUND + LANES],
    y: [f32; AROUND + LANES],
    /// Rounded up to whole lanes.
    count: usize,
}

/// Distances that are compared at once.
const LANES: usize = 4;

impl Near {
    fn new() -> Self {
        Self { x: [0.0; AROUND + LANES], y: [0.0; AROUND + LANES], count: 0 }
    }

    fn gather(&mut self, grid: &Grid, points: &[Point], origin: Point) {
        if let Some(period) = grid.torus {
            let (column, row) = grid.column_and_row(origin);
            if grid.is_near_border(column, row, BORDER) {
                self.gather_round(grid, period, points, origin);
                return;
            }
        }
        let centre = grid.cell_of(origin);
        let mut sites = [EMPTY; AROUND];
        let mut count = 0;
        for &way in &grid.around {
            let site = grid.cells[centre.wrapping_add_signed(way)];
            // Written always and kept if there is one: whether a cell is empty is a coin toss to branch prediction.
            sites[count] = site;
            count += usize::from(site != EMPTY);
        }
        for (i, &site) in sites[..count].iter().enumerate() {
            let way = points[site as usize] - origin;
            self.x[i] = way.x as f32;
            self.y[i] = way.y as f32;
        }
        self.fill_up(count);
    }

    /// The same across the borders of a torus.
    fn gather_round(&mut self, grid: &Grid, period: Period, points: &[Point], origin: Point) {
        let (column, row) = grid.column_and_row(origin);
        let mut count = 0;
        for site in grid.round(column, row, BORDER) {
            let way = period.shortest(points[site as usize] - origin);
            // The site itself stands in nobody's way.
            if way.length_squared() > 0.0 {
                self.x[count] = way.x as f32;
                self.y[count] = way.y as f32;
                count += 1;
            }
        }
        self.fill_up(count);
    }

    /// Fills the last lanes with what is far away.
    fn fill_up(&mut self, count: usize) {
        self.count = count.next_multiple_of(LANES);
        self.x[count..self.count].fill(f32::INFINITY);
        self.y[count..self.count].fill(f32::INFINITY);
    }

    /// Whether one of them is closer to the end of `way` than the root of `limit`.
    fn is_closer(&self, way: Vec2, limit: f32) -> bool {
        let (x, y) = (way.x as f32, way.y as f32);
        let mut least = [f32::INFINITY; LANES];
        let (xs, _) = self.x[..self.count].as_chunks::<LANES>();
        let (ys, _) = self.y[..self.count].as_chunks::<LANES>();
        for (xs, ys) in xs.iter().zip(ys) {
            for lane in 0..LANES {
                let (dx, dy) = (xs[lane] - x, ys[lane] - y);
                let square = dx * dx + dy * dy;
                least[lane] = if square < least[lane] { square } else { least[lane] };
            }
        }
        least.iter().any(|&square| square < limit)
    }
}
