//! The index of an outline: segments in a grid of cells, so that a point or a line looks only at what lies near it.
//!
//! A cell lists every segment that comes into it and knows whether its middle is inside. A point is inside when the
//! way from it to the middle of its cell, first level and then upright, crosses the outline an even number of times
//! and the middle is inside, or neither. Ties are broken as if the point lay a little to the right and, far less,
//! downwards (simulation of simplicity, Edelsbrunner and Mücke 1990), in one and the same way on both legs.

use crate::geom::{Point, Polygon, Rect, ring_bounds};

/// Cells for each segment: more make searches faster and the index larger.
const CELLS_PER_SEGMENT: f64 = 6.0;

/// Most rows or columns.
const MOST_LINES: f64 = 1024.0;

/// Crossings nearer to a line's end than this many millimetres are decided along the whole line.
const NEAR: f64 = 1e-7;

/// Segments at a smaller angle to a line than this many radians, and near it, count as running along it.
const ALONG: f64 = 1e-4;

/// A straight piece of an outline; `a` is the upper end, of level pieces the right one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) a: Point,
    pub(super) b: Point,
}

impl Segment {
    /// Positive where `p` lies to the left on the page, which for level pieces is above. A tie counts as right, or
    /// below.
    fn side(&self, p: Point) -> f64 {
        (self.b - self.a).cross(p - self.a)
    }

    /// Whether a level way at `p` could cross it.
    fn spans_y(&self, p: Point) -> bool {
        self.a.y <= p.y && p.y < self.b.y
    }

    /// Whether an upright way at `p` could cross it.
    fn spans_x(&self, p: Point) -> bool {
        (self.a.x <= p.x) != (self.b.x <= p.x)
    }
}

/// The index.
#[derive(Debug)]
pub(super) struct Index {
    bounds: Rect,
    columns: usize,
    rows: usize,
    /// The size of a cell.
    cell: [f64; 2],
    /// Cells in a millimetre. What this rounds otherwise than division does, the hair's breadth of `cells_along` covers.
    per_mm: [f64; 2],
    segments: Vec<Segment>,
    /// Where the segments of a cell start in `listed`; one more than there are cells.
    offsets: Vec<u32>,
    listed: Vec<u32>,
    /// Whether the middle of each cell is inside.
    inside: Vec<bool>,
}

impl Index {
    pub(super) fn new(polygons: &[Polygon]) -> Self {
        let mut segments = Vec::new();
        let mut bounds = Rect::EMPTY;
        for polygon in polygons {
            let outer = ring_bounds(&polygon.outer);
            bounds = bounds.including(outer.min).including(outer.max);
            for ring in polygon.rings() {
                let Some(&last) = ring.last() else { continue };
                let mut p = last;
                for &q in ring {
                    segments.push(if is_downwards(p, q) { Segment { a: p, b: q } } else { Segment { a: q, b: p } });
                    p = q;
                }
            }
        }
        let (columns, rows) = lines(&bounds, segments.len());
        let cell = [(bounds.width() / columns as f64).max(1e-9), (bounds.height() / rows as f64).max(1e-9)];
        let mut index = Self {
            bounds,
            columns,
            rows,
            cell,
            per_mm: cell.map(f64::recip),
            segments,
            offsets: Vec::new(),
            listed: Vec::new(),
            inside: Vec::new(),
        };
        if !index.segments.is_empty() {
            index.list_segments();
            index.mark_middles();
        }
        index
    }

    pub(super) fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Two passes over the cells of every segment: the first counts, the second writes.
    fn list_segments(&mut self) {
        let mut offsets = vec![0u32; self.columns * self.rows + 1];
        for segment in &self.segments {
            self.cells_along(segment.a, segment.b, |cells| cells.for_each(|cell| offsets[cell + 1] += 1));
        }
        for i in 1..offsets.len() {
            offsets[i] += offsets[i - 1];
        }
        let mut next = offsets.clone();
        let mut listed = vec![0u32; offsets.last().map_or(0, |&n| n as usize)];
        for (i, segment) in self.segments.iter().enumerate() {
            self.cells_along(segment.a, segment.b, |cells| {
                cells.for_each(|cell| {
                    listed[next[cell] as usize] = i as u32;
                    next[cell] += 1;
                });
            });
        }
        self.offsets = offsets;
        self.listed = listed;
    }

    /// Row by row: a middle is inside where an odd number of segments lie to its right.
    fn mark_middles(&mut self) {
        let mut inside = vec![false; self.columns * self.rows];
        // Segments by the first row whose middle they span, so that rows need not look at all of them.
        let mut starts: Vec<Vec<u32>> = vec![Vec::new(); self.rows];
        for (i, segment) in self.segments.iter().enumerate() {
            starts[self.row(segment.a.y)].push(i as u32);
        }
        let mut active: Vec<u32> = Vec::new();
        for row in 0..self.rows {
            active.extend(&starts[row]);
            let y = self.middle(0, row).y;
            active.retain(|&i| self.segments[i as usize].b.y > y);
            for &i in &active {
                let segment = &self.segments[i as usize];
                if !segment.spans_y(Point::new(0.0, y)) {
                    continue;
                }
                // The columns whose middles lie left of the segment are those before `end`. Rounding may put the
                // guess one off, and only the exact rule of `contains` may decide.
                let t = (y - segment.a.y) / (segment.b.y - segment.a.y);
                let x = segment.a.x + (segment.b.x - segment.a.x) * t;
                let mut end = self.column(x);
                let is_left = |column: usize| segment.side(self.middle(column, row)) > 0.0;
                while end > 0 && !is_left(end - 1) {
                    end -= 1;
                }
                while end < self.columns && is_left(end) {
                    end += 1;
                }
                for flag in &mut inside[row * self.columns..row * self.columns + end] {
                    *flag = !*flag;
                }
            }
        }
        self.inside = inside;
    }

    fn column(&self, x: f64) -> usize {
        // A cast of what is negative or no number gives 0.
        (((x - self.bounds.min.x) * self.per_mm[0]) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.bounds.min.y) * self.per_mm[1]) as usize).min(self.rows - 1)
    }

    fn middle(&self, column: usize, row: usize) -> Point {
        Point::new(
            self.bounds.min.x + (column as f64 + 0.5) * self.cell[0],
            self.bounds.min.y + (row as f64 + 0.5) * self.cell[1],
        )
    }

    fn listed_in(&self, cell: usize) -> &[u32] {
        &self.listed[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }

    /// Calls `visit` with the cells of every row that the line from `a` to `b` comes into, a hair's breadth more on
    /// either side, so that two lines that meet share a cell whatever the rounding. Cells off the grid are those at
    /// its rim.
    fn cells_along(&self, a: Point, b: Point, visit: impl FnMut(std::ops::Range<usize>)) {
        self.cells_beside(a, b, 0.0, visit);
    }

    /// The same with every cell that holds a place within `reach` millimetres of the line.
    fn cells_beside(&self, a: Point, b: Point, reach: f64, mut visit: impl FnMut(std::ops::Range<usize>)) {
        let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
        let hair = [self.cell[0] * 1e-6 + reach, self.cell[1] * 1e-6 + reach];
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        // Where a line is all but level, rounding of y would be a long way in x.
        let is_steep = slope.abs() < 1e4;
        let (left, right) = (a.x.min(b.x), a.x.max(b.x));
        for row in self.row(top.y - hair[1])..=self.row(bottom.y + hair[1]) {
            let y0 = (self.bounds.min.y + row as f64 * self.cell[1] - hair[1]).max(top.y);
            let y1 = (self.bounds.min.y + (row + 1) as f64 * self.cell[1] + hair[1]).min(bottom.y);
            let (x0, x1) = if is_steep {
                let (u, v) = (top.x + (y0 - top.y) * slope, top.x + (y1 - top.y) * slope);
                (u.min(v).max(left), u.max(v).min(right))
            } else {
                (left, right)
            };
            let (from, to) = (self.column(x0 - hair[0]), self.column(x1 + hair[0]));
            visit(row * self.columns + from..row * self.columns + to.max(from) + 1);
        }
    }

    /// Whether a point is inside.
    pub(super) fn contains(&self, p: Point) -> bool {
        let outside = !(self.bounds.min.x <= p.x
            && p.x <= self.bounds.max.x
            && self.bounds.min.y <= p.y
            && p.y <= self.bounds.max.y);
        if outside || self.segments.is_empty() {
            return false;
        }
        let (column, row) = (self.column(p.x), self.row(p.y));
        let cell = row * self.columns + column;
        let mut inside = self.inside[cell];
        let listed = self.listed_in(cell);
        if listed.is_empty() {
            return inside;
        }
        let middle = self.middle(column, row);
        let corner = Point::new(middle.x, p.y);
        for &i in listed {
            let segment = &self.segments[i as usize];
            let level = segment.spans_y(p);
            let upright = segment.spans_x(corner);
            if !(level || upright) {
                continue;
            }
            let at_corner = segment.side(corner) > 0.0;
            if level && (segment.side(p) > 0.0) != at_corner {
                inside = !inside;
            }
            if upright && (segment.side(middle) > 0.0) != at_corner {
                inside = !inside;
            }
        }
        inside
    }

    /// Whether any piece of the outline comes into a box or touches it.
    pub(super) fn touches(&self, area: &Rect) -> bool {
        let is_box = area.min.x <= area.max.x && area.min.y <= area.max.y;
        if self.segments.is_empty() || !is_box || !self.bounds.touches(area) {
            return false;
        }
        let (left, right) = (self.column(area.min.x), self.column(area.max.x));
        (self.row(area.min.y)..=self.row(area.max.y)).any(|row| {
            let start = self.offsets[row * self.columns + left] as usize;
            let end = self.offsets[row * self.columns + right + 1] as usize;
            self.listed[start..end].iter().any(|&i| meets_box(&self.segments[i as usize], area))
        })
    }

    /// Calls `visit` with the ends of every piece of the outline that comes within `reach` millimetres of the line from
    /// `a` to `b`, some of them more than once, and with some that lie farther away.
    pub(super) fn beside(&self, a: Point, b: Point, reach: f64, mut visit: impl FnMut(Point, Point)) {
        let area = Rect::EMPTY.including(a).including(b).grown(reach);
        if self.segments.is_empty() || !self.bounds.touches(&area) {
            return;
        }
        self.cells_beside(a, b, reach, |cells| {
            let listed = self.offsets[cells.start] as usize..self.offsets[cells.end] as usize;
            for &i in &self.listed[listed] {
                let Segment { a, b } = self.segments[i as usize];
                visit(a, b);
            }
        });
    }

    /// Appends the parameter intervals of the line from `a` to `b` that are inside, in order.
    pub(super) fn clip_line(&self, a: Point, b: Point, out: &mut Vec<(f64, f64)>) {
        let length = a.distance(b);
        // A line without a length, and one with a coordinate that is no number.
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let ends = Rect::EMPTY.including(a).including(b);
        if self.segments.is_empty() || !self.bounds.touches(&ends) {
            return;
        }
        let mut crossings = Vec::new();
        let Some(mut is_sure) = self.crossings(a, b, (a, b), &mut crossings) else {
            if self.contains(a) {
                out.push((0.0, 1.0));
            }
            return;
        };
        let near = NEAR / length;
        is_sure &= crossings.iter().all(|&(t, _)| t.abs() > near && (t - 1.0).abs() > near);
        crossings.retain(|&(t, _)| 0.0 < t && t < 1.0);
        let mut inside = self.contains(a);
        let ends_inside = inside != (crossings.len() % 2 == 1);
        if !(is_sure && ends_inside == self.contains(b)) {
            // An end lies on the outline, where rounding has the last word. All along the line the crossings come in
            // pairs, whatever happens: a corner lies on one side of it or the other for both of its segments.
            let reach = 1.0 + (self.bounds.grown(length).width() + self.bounds.grown(length).height()) / length;
            crossings.clear();
            self.crossings(a, b, (a.lerp(b, -reach), a.lerp(b, reach)), &mut crossings);
            inside = false;
        }
        let mut start = 0.0;
        let mut emit = |from: f64, to: f64| {
            let (from, to) = (from.max(0.0), to.min(1.0));
            if from < to {
                out.push((from, to));
            }
        };
        for &(t, _) in &crossings {
            if inside {
                emit(start, t);
            }
            inside = !inside;
            start = t;
        }
        if inside {
            emit(start, 1.0);
        }
    }

    /// The crossings of the endless line through `a` and `b` with the segments near the piece `along`, in order. Returns
    /// whether no segment runs along the line, and nothing where there is no segment near at all.
    fn crossings(&self, a: Point, b: Point, along: (Point, Point), out: &mut Vec<(f64, u32)>) -> Option<bool> {
        let way = b - a;
        let length_squared = way.length_squared();
        let length = length_squared.sqrt();
        // Which corners count as lying to the left must not depend on the line's sense.
        let sense = if is_downwards(a, b) { 1.0 } else { -1.0 };
        let mut is_sure = None;
        self.cells_along(along.0, along.1, |cells| {
            let listed = self.offsets[cells.start] as usize..self.offsets[cells.end] as usize;
            for &i in &self.listed[listed] {
                let Segment { a: p, b: q } = self.segments[i as usize];
                let (u, v) = (way.cross(p - a) * sense, way.cross(q - a) * sense);
                let tilt = (q.x - p.x).abs() + (q.y - p.y);
                let is_apart = u.abs().max(v.abs()) > (NEAR + ALONG * tilt) * length;
                is_sure = Some(is_sure.unwrap_or(true) && is_apart);
                if (u >= 0.0) != (v >= 0.0) {
                    let crossing = p.lerp(q, u / (u - v));
                    out.push((way.dot(crossing - a) / length_squared, i));
                }
            }
        });
        // A segment is listed in every cell it comes into, but always crossed at the same place.
        out.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        out.dedup();
        is_sure
    }
}

/// Whether the way from one point to another leads down the page, or level to the left.
fn is_downwards(from: Point, to: Point) -> bool {
    (from.y, -from.x) < (to.y, -to.x)
}

/// How many columns and rows cover the bounds: square cells, a few for each segment.
fn lines(bounds: &Rect, segments: usize) -> (usize, usize) {
    let (width, height) = (bounds.width().max(1e-9), bounds.height().max(1e-9));
    let side = (width * height / (segments as f64 * CELLS_PER_SEGMENT).max(1.0)).sqrt();
    let lines = |extent: f64| (extent / side).ceil().clamp(1.0, MOST_LINES) as usize;
    (lines(width), lines(height))
}

/// Whether a segment and a closed box share a point.
fn meets_box(segment: &Segment, area: &Rect) -> bool {
    let Segment { a, b } = *segment;
    let apart = a.y > area.max.y || b.y < area.min.y || a.x.min(b.x) > area.max.x || a.x.max(b.x) < area.min.x;
    if apart {
        return false;
    }
    let sides = area.corners().map(|corner| segment.side(corner));
    !(sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0))
}
