//! What is drawn where no tile is, before the tiles.
//!
//! A fill of its own runs over the whole region, its lines at the exact pitch and measured from the middle of the page, and
//! is left out under the tiles. Where the page repeats, lines take the direction and the pitch next to these that go round,
//! and run on a little beyond the borders. `nearest` continues the pattern of every tile over its Voronoi cell, or of a
//! tiling over the cell that the tile was drawn in from. Both end at the region's outline whatever the tiles do there.

use rayon::prelude::*;

use crate::geom::bezier::cubics;
use crate::geom::clip::{Frame, Profile, convex_clearance};
use crate::geom::{Angle, Length, Point, Vec2, chain, ring_bounds};
use crate::pass::cut::voronoi::Cells;
use crate::pass::link;
use crate::region::{FillRule, Region};
use crate::scene::{Canvas, Fill, FillKind, Ground, Hatch, Link, Paint, Shape};
use crate::stage::{Graph, Sites, Tiling};

use super::arcs::Arcs;
use super::budget::{BANK, DOT, Exceeded, LINE, PROFILE};
use super::crosses::{ARMS, Crossing, draw_arm};
use super::curves::{Course, clip, disc, emit, trace};
use super::dashes::Dashes;
use super::dots::{Dot, Dotting, end_row};
use super::edge::{Bank, Contact};
use super::hand::{Bundle, Pull};
use super::job::{Job, Piece, Scratch};
use super::lattice::Lattice;
use super::motif::Motif;
use super::palette::Batch;
use super::scribble::Scribble;
use super::solid;
use super::stroke::Stroke;
use super::torus::overhang;
use super::wander::{Line, Wander};
use super::waves::Waves;
use super::weave::{Along, Bond, Weave};

/// Lines that one thread draws at a time; they also make a bundle.
const BAND: usize = 64;

/// Draws the ground of a paint, if it has one.
pub(super) fn draw(job: &Job<'_>, canvas: &Canvas) -> Result<Vec<Vec<Batch>>, Exceeded> {
    match &job.paint.tone.ground {
        None => Ok(Vec::new()),
        Some(Ground::Nearest) => nearest(job),
        Some(Ground::Fill { fill, angle }) => even(job, canvas, fill, *angle),
    }
}

/// The areas over which tiles are continued: the cells of their tiling, or the Voronoi cells of their sites.
pub(super) struct Around<'a> {
    tiling: Option<&'a Tiling>,
    cells: Cells<'a>,
}

impl<'a> Around<'a> {
    /// `delaunay` links the sites by their triangulation.
    pub(super) fn new(paint: &Paint, sites: &'a Sites, delaunay: &'a Graph) -> Self {
        let tiling = match paint.tone.shape {
            Shape::Cell { .. } => sites.tiling.as_ref(),
            Shape::Rect { .. }
            | Shape::Hexagon { .. }
            | Shape::Triangle { .. }
            | Shape::Trapezoid { .. }
            | Shape::Stamp { .. }
            | Shape::Voronoi { .. } => None,
        };
        Self { tiling, cells: Cells::new(sites, delaunay, Length::ZERO, Length::ZERO) }
    }

    /// Writes the area of a tile; `spare` is overwritten.
    pub(super) fn outline(&self, tile: usize, area: &mut Vec<Point>, spare: &mut Vec<Point>) {
        match self.tiling {
            Some(tiling) => {
                area.clear();
                area.extend_from_slice(tiling.cell(tile));
            }
            None => self.cells.outline(tile, area, spare),
        }
    }
}

/// Hatches the gaps as the nearest tile is hatched. Tiles that are left out at the region's edge have gaps too.
fn nearest(job: &Job<'_>) -> Result<Vec<Vec<Batch>>, Exceeded> {
    let Some(around) = job.around else { return Ok(Vec::new()) };
    let hand = &job.paint.tone.hand;
    let hatches = job.paint.tone.fill.iter().filter_map(|fill| fill.kind.hatch());
    let margin = hatches.map(|hatch| hand.reach(hatch.pen).to_mm()).fold(0.0, f64::max);
    job.in_chunks(|scratch, tile, out| {
        let outline = job.tiles.outline(tile);
        if job.tiles.layers[tile].is_blank() || outline.is_empty() {
            return Ok(());
        }
        let (mut cell, mut spare) = (Vec::new(), Vec::new());
        around.outline(tile, &mut cell, &mut spare);
        // Of an outline that is not convex corners alone do not tell.
        let is_gapless = job.tiles.is_drawn(tile)
            && job.tiles.figure(tile).is_convex()
            && cell.iter().all(|&p| convex_clearance(outline, p) >= 0.0);
        let contact = job.bank.standing(ring_bounds(&cell).grown(margin));
        if is_gapless || contact == Contact::Outside {
            return Ok(());
        }
        let site = job.sites.points[tile];
        let reach = cell.iter().map(|&p| p.distance_squared(site)).fold(0.0, f64::max).sqrt();
        scratch.covers.clear();
        job.budget.look(&mut scratch.looks, job.nearby.candidates(site, reach))?;
        job.nearby.near(site, reach, |other| scratch.covers.push(other));
        let (beyond, is_clipped) = (Some(cell.as_slice()), contact == Contact::Crossing);
        let partner = hand.has_ends().then(|| job.tiles.figure(tile));
        job.draw_layers(&Piece { tile, beyond, is_clipped, partner }, scratch, out)
    })
}

/// The triangulation that bounds Voronoi cells, where the links of the tiles are others: cells that share edges are not all
/// the neighbours.
pub(super) fn delaunay(paint: &Paint, sites: &Sites) -> Option<Graph> {
    match paint.tone.link {
        Link::Delaunay => None,
        Link::Edges => Some(link::link(&sites.without_images(), Link::Delaunay)),
    }
}

/// Draws one fill over all that is left of the region.
fn even(job: &Job<'_>, canvas: &Canvas, fill: &Fill, angle: Angle) -> Result<Vec<Vec<Batch>>, Exceeded> {
    let Some(period) = canvas.period() else { return even_over(job, canvas, fill, (angle.unit(), None)) };
    let area = Region::rect(canvas.bounds().grown(beyond(fill)));
    let region = job.bank.region().intersection(&area);
    let bank = Bank::new(&region);
    let job = Job { bank: &bank, ..*job };
    let Some(hatch) = fill.kind.hatch() else { return even_over(&job, canvas, fill, (angle.unit(), None)) };
    let weave = Weave::new(period, angle.unit(), hatch.pitch);
    let mut fill = fill.clone();
    match &mut fill.kind {
        FillKind::Lines(hatch)
        | FillKind::Dashes { hatch, .. }
        | FillKind::Dots { hatch, .. }
        | FillKind::Crosses { hatch, .. }
        | FillKind::Motif { hatch, .. } => hatch.pitch = Length::mm(weave.pitch),
        // Lowering lets none of the curves come here that do not go round.
        FillKind::Arcs(_)
        | FillKind::Waves { .. }
        | FillKind::Nawaami { .. }
        | FillKind::Scribble { .. }
        | FillKind::Solid => {}
    }
    even_over(&job, canvas, &fill, (weave.along, Some(&weave)))
}

/// How far beyond the borders of a page that repeats a ground is drawn, in millimetres: so far that nothing on the page is
/// left out because too little of it lies on this side.
pub(super) fn beyond(fill: &Fill) -> f64 {
    match &fill.kind {
        FillKind::Lines(hatch) | FillKind::Dashes { hatch, .. } => overhang(hatch.pen) + hatch.shortest.to_mm(),
        FillKind::Dots { radius, .. } => 2.0 * radius.to_mm(),
        FillKind::Crosses { hatch, size, .. } => overhang(hatch.pen) + hatch.shortest.to_mm() + size.to_mm(),
        FillKind::Motif { hatch, spacing, figure } => {
            let reach = Motif { hatch, spacing: *spacing, figure }.reach();
            overhang(hatch.pen) + hatch.shortest.to_mm() + reach * 2.0
        }
        FillKind::Arcs(hatch)
        | FillKind::Waves { hatch, .. }
        | FillKind::Nawaami { hatch, .. }
        | FillKind::Scribble { hatch, .. } => overhang(hatch.pen) + hatch.shortest.to_mm(),
        FillKind::Solid => BLEED,
    }
}

/// How far beyond the borders of a page that repeats areas reach, in millimetres.
const BLEED: f64 = 0.5;

/// Draws one fill in a direction; on a page that repeats, as a weave has it.
fn even_over(
    job: &Job<'_>,
    canvas: &Canvas,
    fill: &Fill,
    (direction, weave): (Vec2, Option<&Weave>),
) -> Result<Vec<Vec<Batch>>, Exceeded> {
    let frame = Frame::new(canvas.bounds().centre(), direction);
    let mut region = Profile::default();
    region.set(&job.bank.region().bounds().corners(), &frame);
    // A hand's unevenness does not go round, so that what goes round is ruled.
    let is_ruled = job.paint.tone.hand.is_ruled() || weave.is_some();
    let bundle = (!is_ruled).then(|| Bundle::ground(job.paint));
    let plane = Plane { job, frame, region, bundle };
    let rows = |spacing: Length| match weave {
        Some(weave) => weave.along(spacing, Bond::Rows),
        None => Along { step: spacing.to_mm(), drift: 0.0 },
    };
    match &fill.kind {
        FillKind::Lines(hatch) => plane.lines(hatch, None),
        FillKind::Dashes { hatch, dash, gap } => {
            let dashes = Dashes::new(*dash, *gap);
            let dashes = match weave {
                Some(weave) => dashes.woven(weave.along(*dash + *gap, Bond::Bricks)),
                None => dashes,
            };
            plane.lines(hatch, Some(&dashes))
        }
        FillKind::Dots { hatch, spacing, radius } => {
            let Along { step, drift } = rows(*spacing);
            plane.dots(&Dotting::new(hatch, Length::mm(step), *radius), drift)
        }
        FillKind::Crosses { hatch, spacing, size } => {
            let Along { step, drift } = rows(*spacing);
            plane.crosses(&Crossing { hatch, spacing: Length::mm(step), size: *size }, drift)
        }
        FillKind::Arcs(hatch) => plane.curves(hatch, &Arcs { centre: Point::default() }, plane.rings()),
        FillKind::Waves { hatch, swing } | FillKind::Nawaami { hatch, swing } => {
            plane.curves(hatch, &Waves::new(swing), plane.region.across())
        }
        FillKind::Scribble { hatch, loops, spacing } => {
            let scribble = Scribble::new(job.paint, usize::MAX, 0, *loops, *spacing);
            plane.curves(hatch, &scribble, plane.region.across())
        }
        FillKind::Motif { hatch, spacing, figure } => {
            let Along { step, drift } = rows(*spacing);
            plane.motif(&Motif { hatch, spacing: Length::mm(step), figure }, drift)
        }
        FillKind::Solid => {
            let drawn = (0..job.tiles.len()).filter(|&tile| job.tiles.is_drawn(tile));
            let outlines = drawn.map(|tile| job.tiles.outline(tile).to_vec()).collect();
            let mut batches = job.palette.batches();
            let batch = &mut batches[job.palette.ground_slots().start];
            solid::push(&job.bank.region().difference(&Region::from_rings(outlines, FillRule::NonZero)), batch);
            job.budget.mark(batch.len())?;
            Ok(vec![batches])
        }
    }
}

/// A region to be filled along one direction.
struct Plane<'a> {
    job: &'a Job<'a>,
    frame: Frame,
    /// The box around it.
    region: Profile,
    /// How a hand draws it, if not ruled.
    bundle: Option<Bundle>,
}

impl Plane<'_> {
    /// Runs over the lines in bands, in parallel. The batches come back in the order of the lines.
    fn in_bands(
        &self,
        pitch: Length,
        across: (f64, f64),
        draw: impl Fn(&mut Scratch, &[(i64, f64)], &mut [Batch]) -> Result<(), Exceeded> + Sync,
    ) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let lattice = Lattice::cell(across, 0.0, pitch.to_mm());
        self.job.budget.work(lattice.count() * (LINE + BANK) as f64)?;
        if lattice.count() > self.job.budget.limit() as f64 {
            return Err(Exceeded::Marks);
        }
        // Lines stray by less than half a step, so that they stay in order.
        let shift = |number| self.bundle.map_or(0.0, |bundle| bundle.shift(number, lattice.step()));
        let lines: Vec<(i64, f64)> = lattice.places().map(|(number, v)| (number, v + shift(number))).collect();
        lines
            .par_chunks(BAND)
            .map(|band| {
                let mut batches = self.job.palette.batches();
                let own = &mut batches[self.job.palette.ground_slots()];
                let mut scratch = Scratch::default();
                draw(&mut scratch, band, own)?;
                self.job.budget.work(scratch.looks as f64)?;
                own.iter_mut().for_each(Batch::end_bundle);
                self.job.budget.mark(own.iter().map(Batch::len).sum())?;
                Ok(batches)
            })
            .collect()
    }

    /// How far a mark lies off its place along its line in millimetres.
    fn shift_along(&self, number: i64, mark: i64, step: f64) -> f64 {
        self.bundle.map_or(0.0, |bundle| bundle.shift_along(number, mark, step))
    }

    /// How a line wanders.
    fn wander(&self, number: i64) -> Wander {
        let (start, end) = self.region.along();
        self.bundle.map_or(Wander::NONE, |bundle| bundle.wander(number, end - start))
    }

    fn lines(&self, hatch: &Hatch, dashes: Option<&Dashes>) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let ranges = self.tile_ranges();
        let along = self.region.along();
        self.in_bands(hatch.pitch, self.region.across(), |scratch, band, out| {
            let hidden = self.hidden(band, &ranges, scratch)?;
            for (&(number, v), mut hidden) in band.iter().zip(hidden) {
                // From the end to the start, so that what is left lies as one range before each.
                hidden.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
                scratch.ranges.reset(along.0, along.1);
                for (start, end) in hidden {
                    scratch.ranges.subtract(start, end);
                }
                let wander = self.wander(number);
                let line = Line { wander, ..Line::ruled(&self.frame, number, v) };
                let stroke = Stroke::new(line, self.bundle.as_ref(), hatch, number.rem_euclid(2) == 1);
                self.job.bank.clip(&self.frame, v, stroke.nib(), &mut scratch.ranges, &mut scratch.edge);
                stroke.emit(self.job, dashes, scratch, out)?;
            }
            Ok(())
        })
    }

    /// Dots that lie further back by `drift` on every line a millimetre across.
    fn dots(&self, dotting: &Dotting<'_>, drift: f64) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let along = self.region.along();
        let row = dotting.along(along, 0.0);
        let count = row.count() * Lattice::cell(self.region.across(), 0.0, dotting.hatch.pitch.to_mm()).count();
        if count * (DOT + BANK) as f64 > self.job.budget.most_work() as f64 {
            return Err(Exceeded::Places { what: "dots of ground", count: count as u64 });
        }
        self.in_bands(dotting.hatch.pitch, self.region.across(), |scratch, band, out| {
            for &(number, v) in band {
                self.job.budget.work(row.count() * (DOT + BANK) as f64)?;
                let starts: Vec<usize> = out.iter().map(|batch| batch.dots.len()).collect();
                for (mark, u) in dotting.along(along, -v * drift).places() {
                    let dot = Dot::new(self.bundle.as_ref(), dotting, (number, mark), u, row.step());
                    let centre = self.frame.page(dot.u, v);
                    if self.is_free(centre, dot.radius, scratch)? {
                        out[dot.weight].dots.push(centre);
                    }
                }
                end_row(out, &starts, number.rem_euclid(2) == 1, self.job.budget)?;
            }
            Ok(())
        })
    }

    /// The range of radii about the frame's origin that come into the box around the region.
    fn rings(&self) -> (f64, f64) {
        let ((left, right), (top, bottom)) = (self.region.along(), self.region.across());
        let away = |(low, high): (f64, f64)| (low.max(-high).max(0.0), high.max(-low));
        let ((near_u, far_u), (near_v, far_v)) = (away((left, right)), away((top, bottom)));
        (Vec2::new(near_u, near_v).length(), Vec2::new(far_u, far_v).length())
    }

    fn curves(
        &self,
        hatch: &Hatch,
        course: &impl Course,
        (low, high): (f64, f64),
    ) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let along = self.region.along();
        let reach = course.reach();
        self.in_bands(hatch.pitch, (low - reach, high + reach), |scratch, band, out| {
            for &line in band {
                trace(self.job, course, line, along, &mut scratch.curves.chain)?;
                self.wander(line.0).bend(&mut scratch.curves.chain);
                let pull = Pull::line(self.bundle.as_ref(), hatch, line.0);
                self.stroke(&pull, line.0.rem_euclid(2) == 1, scratch, out)?;
            }
            Ok(())
        })
    }

    /// Figures that lie further back by `drift` on every line a millimetre across.
    fn motif(&self, motif: &Motif<'_>, drift: f64) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let (reach, cost) = (motif.reach(), motif.cost());
        let grown = |(low, high): (f64, f64)| (low - reach, high + reach);
        let row = |middle: f64| Lattice::cell(grown(self.region.along()), middle, motif.spacing.to_mm());
        self.in_bands(motif.hatch.pitch, grown(self.region.across()), |scratch, band, out| {
            for &(number, v) in band {
                let row = row(-v * drift);
                self.job.budget.work(row.count() * (cost + BANK) as f64)?;
                for (mark, u) in row.places() {
                    let pull = Pull::mark(self.bundle.as_ref(), motif.hatch, number, mark);
                    let u = u + self.shift_along(number, mark, row.step());
                    for strokes in motif.figure.0.iter() {
                        scratch.curves.chain.clear();
                        scratch.curves.chain.extend(strokes.iter().map(|&p| p + Vec2::new(u, v)));
                        self.stroke(&pull, false, scratch, out)?;
                    }
                }
            }
            Ok(())
        })
    }

    /// Draws what no tile lies on of the stroke in `scratch`.
    fn stroke(
        &self,
        pull: &Pull,
        is_backwards: bool,
        scratch: &mut Scratch,
        out: &mut [Batch],
    ) -> Result<(), Exceeded> {
        let Scratch { curves, looks, .. } = scratch;
        curves.ranges.reset(0.0, chain::count(&curves.chain) as f64);
        let region = self.job.bank.region().bounds();
        for (number, cubic) in cubics(&curves.chain).enumerate() {
            let page = cubic.map(|p| self.frame.page(p.x, p.y)).bounds();
            if !page.touches(&region) {
                curves.ranges.subtract(number as f64, number as f64 + 1.0);
                continue;
            }
            let (middle, within) = disc(&page);
            self.job.budget.look(looks, self.job.nearby.candidates(middle, within) * PROFILE)?;
            let (ranges, cutout, found) = (&mut curves.ranges, &mut curves.area, &mut curves.found);
            self.job.nearby.near(middle, within, |tile| {
                cutout.set(self.job.nearby.figure(tile), &self.frame);
                cutout.cut(&cubic.0, number, found);
                found.iter().for_each(|&(start, end)| ranges.subtract(start, end));
            });
        }
        clip(self.job, &self.frame, &pull.hatch, scratch)?;
        emit(self.job, &self.frame, pull, is_backwards, &mut scratch.curves, out)?;
        Ok(())
    }

    /// Crosses that lie further back by `drift` on every line a millimetre across.
    fn crosses(&self, crossing: &Crossing<'_>, drift: f64) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let row = |middle: f64| Lattice::cell(self.region.along(), middle, crossing.spacing.to_mm());
        self.in_bands(crossing.hatch.pitch, self.region.across(), |scratch, band, out| {
            for &(number, v) in band {
                let row = row(-v * drift);
                self.job.budget.work(row.count() * (DOT + BANK) as f64)?;
                let starts: Vec<usize> = out.iter().map(|batch| batch.lines.len()).collect();
                for (mark, u) in row.places() {
                    let pull = Pull::mark(self.bundle.as_ref(), crossing.hatch, number, mark);
                    let crossing = Crossing { hatch: &pull.hatch, ..*crossing };
                    let middle = self.frame.page(u + self.shift_along(number, mark, row.step()), v);
                    self.cross(&crossing, middle, scratch, &mut out[pull.weight])?;
                }
                for (batch, start) in out.iter_mut().zip(starts) {
                    if number.rem_euclid(2) == 1 {
                        batch.lines[start..].reverse();
                    }
                    if batch.lines.len() > self.job.budget.limit() {
                        return Err(Exceeded::Marks);
                    }
                }
            }
            Ok(())
        })
    }

    /// Draws a cross whose middle lies in the region and on no tile.
    fn cross(
        &self,
        crossing: &Crossing<'_>,
        middle: Point,
        scratch: &mut Scratch,
        out: &mut Batch,
    ) -> Result<(), Exceeded> {
        if !self.job.bank.region().contains(middle) {
            return Ok(());
        }
        let half = crossing.size.to_mm() / 2.0;
        self.job.budget.look(&mut scratch.looks, self.job.nearby.candidates(middle, half) * PROFILE)?;
        for arm in ARMS {
            let frame = Frame::new(middle, self.frame.along * arm.x + self.frame.along.turned() * arm.y);
            scratch.ranges.reset(-half, half);
            let Scratch { ranges, area, .. } = scratch;
            self.job.nearby.near(middle, half, |tile| {
                area.set(self.job.nearby.figure(tile), &frame);
                area.spans(&0.0, |(start, end)| ranges.subtract(start, end));
            });
            draw_arm(self.job, crossing, &frame, true, scratch, out);
        }
        Ok(())
    }

    /// Whether a dot lies in the region and clear of all tiles.
    fn is_free(&self, centre: Point, radius: f64, scratch: &mut Scratch) -> Result<bool, Exceeded> {
        if !self.job.bank.holds_disc(centre, radius) {
            return Ok(false);
        }
        self.job.budget.look(&mut scratch.looks, self.job.nearby.candidates(centre, radius))?;
        let mut is_free = true;
        self.job.nearby.near(centre, radius, |tile| {
            is_free = is_free && self.job.nearby.figure(tile).clearance(centre) <= -radius;
        });
        Ok(is_free)
    }

    /// The drawn tiles with their ranges across the lines.
    fn tile_ranges(&self) -> Vec<(u32, (f64, f64))> {
        let tiles = self.job.tiles;
        (0..tiles.len())
            .into_par_iter()
            .filter(|&tile| tiles.is_drawn(tile))
            .map(|tile| {
                let across = tiles.outline(tile).iter().map(|&corner| self.frame.local(corner).y);
                let range = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
                (tile as u32, range)
            })
            .collect()
    }

    /// What tiles hide of each line of a band.
    fn hidden(
        &self,
        band: &[(i64, f64)],
        tiles: &[(u32, (f64, f64))],
        scratch: &mut Scratch,
    ) -> Result<Vec<Vec<(f64, f64)>>, Exceeded> {
        self.job.budget.work(tiles.len() as f64)?;
        let mut hidden = vec![Vec::new(); band.len()];
        let (Some(first), Some(last)) = (band.first(), band.last()) else { return Ok(hidden) };
        for &(tile, (low, high)) in tiles {
            if high < first.1 || low > last.1 {
                continue;
            }
            scratch.area.set(self.job.nearby.figure(tile), &self.frame);
            let start = band.partition_point(|line| line.1 < low);
            for (line, hidden) in band.iter().zip(&mut hidden).skip(start).take_while(|(line, _)| line.1 <= high) {
                scratch.area.spans(&line.1, |span| hidden.push(span));
                scratch.looks += 1;
            }
            self.job.budget.look(&mut scratch.looks, PROFILE)?;
        }
        Ok(hidden)
    }
}
