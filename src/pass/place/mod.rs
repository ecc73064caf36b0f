//! Placement: where the tiles of a paint lie.
//!
//! In: a paint and the canvas. Out: [`Sites`] over the paint's domain and its bleed. How many tiles there will be is
//! estimated before anything is allocated, so that a slip in a radius ends in a diagnostic and not in all the memory.
//! A placement is one file here and one line in `find`.

mod around;
mod budget;
mod grid;
mod hex;
mod patch;
mod penrose;
mod pinwheel;
mod poisson;
mod relaxed;
mod rows;
mod triangles;
mod uniform;

use crate::diag::Diagnostic;
use crate::geom::{Period, Point, Rect};
use crate::random::{Key, Stream};
use crate::scene::{Amount, Canvas, Domain, GridSize, Limits, Link, Paint, Placement, Shape};
use crate::stage::{Sites, Torus};
use crate::stop::Stop;
use budget::Budget;

/// Finds the sites of a paint. There may be none, for instance where the domain is empty.
///
/// # Errors
/// Where the placement would find more tiles than the limits allow; the diagnostic stands at the tone's `place`.
pub fn place(paint: &Paint, canvas: &Canvas, limits: &Limits) -> Result<Sites, Diagnostic> {
    let tone = &paint.tone;
    let domain = if is_counted(&tone.place) {
        paint.region.bounds()
    } else {
        match (tone.domain, canvas.period()) {
            // A lattice or a distance that ended at the region's box would not go on beyond the border.
            (Domain::Canvas, _) | (Domain::Region, Some(_)) => canvas.bounds(),
            (Domain::Region, None) => paint.region.bounds(),
        }
    };
    // What counts its tiles in a smaller box than the page goes round nothing.
    let torus = canvas.period().filter(|_| domain == canvas.bounds());
    let ground = Ground {
        domain: if domain.is_empty() { Rect::new(Point::default(), Point::default()) } else { domain },
        // A torus has no edges that should be full.
        bleed: if torus.is_some() { Some(0.0) } else { tone.bleed.map(|bleed| bleed.to_mm()) },
        seed: paint.seed,
        name: &paint.name,
        wants_cells: tone.link == Link::Edges || matches!(tone.shape, Shape::Cell { .. }),
        budget: Budget::new(limits.tiles, tone.place_span),
        torus,
        stop: &limits.stop,
    };
    let mut sites = find(&tone.place, &ground)?;
    if let Some(period) = canvas.period() {
        sites.points.iter_mut().for_each(|site| *site = period.wrapped(*site));
        sites.torus = Some(Torus { period, images: Vec::new() });
    }
    Ok(sites)
}

/// Whether a placement has so many tiles in its domain, which is then the region's box and has no bleed of its own.
fn is_counted(placement: &Placement) -> bool {
    match placement {
        Placement::Uniform { amount: Amount::Count { .. } | Amount::AsMany(_) }
        | Placement::Grid(GridSize::Cells { .. }) => true,
        Placement::Uniform { amount: Amount::Density { .. } }
        | Placement::Poisson { .. }
        | Placement::Grid(GridSize::Spacing(_))
        | Placement::Hex { .. }
        | Placement::Triangles { .. }
        | Placement::Penrose { .. }
        | Placement::Pinwheel { .. }
        | Placement::Points(_) => false,
        Placement::Relaxed { placement, .. } => is_counted(placement),
    }
}

/// The sites that one placement finds.
fn find(placement: &Placement, ground: &Ground<'_>) -> Result<Sites, Diagnostic> {
    if ground.domain.is_empty() && !matches!(placement, Placement::Points(_)) {
        return Ok(ground.sites(Vec::new(), FALLBACK_SPACING, 0.0));
    }
    if let Some(round) = ground.torus.and_then(|period| around::Round::of(placement, period)) {
        return round.place(placement, ground, |even| find(placement, even));
    }
    match placement {
        Placement::Poisson { radius, tries, density } => {
            let disk = poisson::Disk { radius: radius.to_mm(), tries: *tries, density: density.as_ref() };
            poisson::place(placement, ground, &disk)
        }
        Placement::Uniform { amount } => uniform::place(placement, ground, amount),
        Placement::Grid(size) => grid::place(placement, ground, *size),
        Placement::Hex { spacing } => hex::place(placement, ground, spacing.to_mm()),
        Placement::Triangles { edge } => triangles::place(placement, ground, edge.to_mm()),
        Placement::Penrose { edge } => penrose::place(placement, ground, edge.to_mm()),
        Placement::Pinwheel { edge } => pinwheel::place(placement, ground, edge.to_mm()),
        Placement::Relaxed { placement: inner, rounds } => relaxed::place(placement, ground, inner, *rounds),
        Placement::Points(points) => {
            ground.budget.expect(placement, points.len() as f64)?;
            let spacing = ground.mean_spacing(points.len());
            Ok(ground.sites(points.clone(), spacing, spacing))
        }
    }
}

/// What spacing is called where there is neither an area nor a length to take it from, in millimetres. Nothing is drawn
/// at such a size.
const FALLBACK_SPACING: f64 = 1.0;

/// How far beyond an edge a lattice site may lie by rounding and still be on it, as a share of the spacing.
const ON_EDGE: f64 = 1e-9;

/// Where sites are looked for, and the streams that random ones are drawn from.
struct Ground<'a> {
    domain: Rect,
    bleed: Option<f64>,
    seed: u64,
    name: &'a str,
    /// Whether the cells of tilings and their shared edges are asked for, not only their sites.
    wants_cells: bool,
    budget: Budget,
    /// The period, where the domain goes on beyond its borders.
    torus: Option<Period>,
    stop: &'a Stop,
}

impl Ground<'_> {
    /// The domain grown by the bleed, or by `default` where the tone says nothing about it.
    fn extent(&self, default: f64) -> Rect {
        self.domain.grown(self.bleed.unwrap_or(default))
    }

    /// The sequential stream of one purpose.
    fn stream(&self, purpose: &str) -> Stream {
        Key { seed: self.seed, name: self.name, purpose }.stream()
    }

    /// The spacing of `count` tiles that share the domain's area.
    fn mean_spacing(&self, count: usize) -> f64 {
        let area = self.domain.width() * self.domain.height();
        let spacing = (area / count.max(1) as f64).sqrt();
        if spacing > 0.0 { spacing } else { FALLBACK_SPACING }
    }

    /// Sites without cells.
    fn sites(&self, points: Vec<Point>, spacing: f64, default_bleed: f64) -> Sites {
        Sites {
            points,
            domain: self.domain,
            extent: self.extent(default_bleed),
            spacing,
            cells: None,
            tiling: None,
            torus: None,
        }
    }
}

/// A point that is uniform in a box.
fn point_in(rect: &Rect, stream: &mut Stream) -> Point {
    // The sum may round up to the far side, which belongs to the next box.
    let mut between = |min: f64, max: f64| (min + stream.unit() * (max - min)).min(max.next_down()).max(min);
    let x = between(rect.min.x, rect.max.x);
    Point::new(x, between(rect.min.y, rect.max.y))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
