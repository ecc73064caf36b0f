//! Which drawn tiles lie near a place.
//!
//! Points are sorted into the cells of a square grid that has about as many cells as there are points, in two flat lists,
//! so that a million tiles cost a few bytes each.

use crate::geom::{Figure, Point, Rect};
use crate::stage::{Sites, Tiles};

/// Most cells along one side of a grid, so that points strung along a line cannot ask for many empty ones.
const MOST_CELLS: f64 = 4096.0;

/// Points in cells.
pub(super) struct Buckets {
    bounds: Rect,
    /// The side of a cell in millimetres.
    cell: f64,
    columns: usize,
    rows: usize,
    /// Where the points of a cell start in `listed`; one more than there are cells.
    starts: Vec<u32>,
    listed: Vec<u32>,
}

impl Buckets {
    /// Sorts points, of which `index` names some, into cells of at least `cell` millimetres.
    fn new(points: &[Point], index: impl Iterator<Item = usize> + Clone, cell: f64) -> Self {
        let bounds = index.clone().fold(Rect::EMPTY, |bounds, i| bounds.including(points[i]));
        let count = index.clone().count();
        if count == 0 {
            return Self { bounds, cell: 1.0, columns: 0, rows: 0, starts: vec![0], listed: Vec::new() };
        }
        let (width, height) = (bounds.width(), bounds.height());
        let even = (width * height / count as f64).sqrt();
        let cell = cell.max(even).max(width / MOST_CELLS).max(height / MOST_CELLS).max(f64::MIN_POSITIVE);
        let (columns, rows) = ((width / cell) as usize + 1, (height / cell) as usize + 1);
        let mut buckets =
            Self { bounds, cell, columns, rows, starts: vec![0; columns * rows + 1], listed: vec![0; count] };
        for i in index.clone() {
            let at = buckets.cell_of(points[i]);
            buckets.starts[at + 1] += 1;
        }
        for i in 1..buckets.starts.len() {
            buckets.starts[i] += buckets.starts[i - 1];
        }
        let mut next = buckets.starts.clone();
        for i in index {
            let at = buckets.cell_of(points[i]);
            buckets.listed[next[at] as usize] = i as u32;
            next[at] += 1;
        }
        buckets
    }

    fn column(&self, x: f64) -> usize {
        // A cast of what is negative gives 0.
        (((x - self.bounds.min.x) / self.cell) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.bounds.min.y) / self.cell) as usize).min(self.rows - 1)
    }

    fn cell_of(&self, p: Point) -> usize {
        self.row(p.y) * self.columns + self.column(p.x)
    }

    /// How many points [`Self::visit`] would visit.
    fn count(&self, area: &Rect) -> u64 {
        if self.listed.is_empty() || !self.bounds.touches(area) {
            return 0;
        }
        let (left, right) = (self.column(area.min.x), self.column(area.max.x));
        let in_row = |row: usize| {
            let start = self.starts[row * self.columns + left];
            u64::from(self.starts[row * self.columns + right + 1] - start)
        };
        (self.row(area.min.y)..=self.row(area.max.y)).map(in_row).sum()
    }

    /// Calls `visit` with all points whose cells touch a box.
    fn visit(&self, area: &Rect, mut visit: impl FnMut(u32)) {
        if self.listed.is_empty() || !self.bounds.touches(area) {
            return;
        }
        let (left, right) = (self.column(area.min.x), self.column(area.max.x));
        for row in self.row(area.min.y)..=self.row(area.max.y) {
            let start = self.starts[row * self.columns + left] as usize;
            let end = self.starts[row * self.columns + right + 1] as usize;
            self.listed[start..end].iter().for_each(|&i| visit(i));
        }
    }
}

/// The drawn tiles of a paint by place.
pub(super) struct Nearby<'a> {
    sites: &'a Sites,
    tiles: &'a Tiles,
    buckets: Buckets,
    /// The radius of the least disc round its site that holds the tile, for every tile.
    radii: Vec<f64>,
    /// The greatest of them.
    reach: f64,
}

impl<'a> Nearby<'a> {
    pub(super) fn new(sites: &'a Sites, tiles: &'a Tiles) -> Self {
        let radius = |i: usize| {
            let corners = tiles.outline(i).iter();
            corners.map(|&corner| sites.points[i].distance_squared(corner)).fold(0.0, f64::max).sqrt()
        };
        let radii: Vec<f64> = (0..tiles.len()).map(|i| if tiles.is_drawn(i) { radius(i) } else { 0.0 }).collect();
        let reach = radii.iter().copied().fold(0.0, f64::max);
        let drawn = (0..tiles.len()).filter(|&i| tiles.is_drawn(i));
        let buckets = Buckets::new(&sites.points, drawn, reach);
        Self { sites, tiles, buckets, radii, reach }
    }

    /// The radius of a drawn tile about its site in millimetres.
    pub(super) fn radius(&self, tile: usize) -> f64 {
        self.radii[tile]
    }

    /// A tile's outline with its pieces.
    pub(super) fn figure(&self, tile: u32) -> Figure<'a> {
        self.tiles.figure(tile as usize)
    }

    /// How many tiles [`Self::near`] looks at.
    pub(super) fn candidates(&self, place: Point, within: f64) -> u64 {
        self.buckets.count(&Rect::new(place, place).grown(within + self.reach))
    }

    /// Calls `visit` with every drawn tile that may come nearer to a place than `within` millimetres.
    pub(super) fn near(&self, place: Point, within: f64, mut visit: impl FnMut(u32)) {
        let area = Rect::new(place, place).grown(within + self.reach);
        self.buckets.visit(&area, |i| {
            let reach = within + self.radii[i as usize];
            if self.sites.points[i as usize].distance_squared(place) < reach * reach {
                visit(i);
            }
        });
    }

    /// Calls `visit` with every drawn tile that a line may cross, some of them more than once. The line is taken piece by
    /// piece, since the disc round a long one holds most of the page.
    pub(super) fn along(&self, a: Point, b: Point, mut visit: impl FnMut(u32)) {
        self.pieces(a, b).for_each(|(middle, within)| self.near(middle, within, &mut visit));
    }

    /// How many tiles [`Self::along`] looks at.
    pub(super) fn candidates_along(&self, a: Point, b: Point) -> u64 {
        self.pieces(a, b).map(|(middle, within)| self.candidates(middle, within)).sum()
    }

    /// A line in pieces: their middles, and half their length.
    fn pieces(&self, a: Point, b: Point) -> impl Iterator<Item = (Point, f64)> + use<> {
        let length = a.distance(b);
        let pieces = (length / (2.0 * self.buckets.cell)).ceil().clamp(1.0, MOST_CELLS) as u32;
        let half = length / f64::from(pieces) / 2.0;
        (0..pieces).map(move |piece| (a.lerp(b, (f64::from(piece) + 0.5) / f64::from(pieces)), half))
    }
}
