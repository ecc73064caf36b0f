//! What a canvas that repeats asks of paints: regions folded into one period, and a word on what does not go round.

use crate::diag::{Code, Diagnostic, grouped};
use crate::field::Field;
use crate::geom::{Angle, Length, Period, Point, Rect, ring_bounds, whole_steps};
use crate::region::{FillRule, Operation, Region};
use crate::scene::{
    Amount, AngleRule, Asked, FillKind, GridSize, Ground, IRREGULAR_OVERLAP, POINTED_OVERLAP, Placement, Shape, Tone,
};
use crate::span::Span;

use super::cx::Cx;
use super::tone::ToneValue;

/// Most periods that a region may reach over.
const MOST_PERIODS: f64 = 4096.0;

/// Corners are on a border within so many millimetres.
const ON_BORDER: f64 = 1e-6;

/// From which share on a lattice that was stretched is worth a word.
const STRETCH: f64 = 0.02;

/// Places along each border where fields are compared.
const PLACES: u32 = 48;

/// Fields differ at opposite borders where they do by more than this share of their range over the page.
const DIFFERENCE: f64 = 0.05;

/// A region with what leaves the page on one side come in at the other: what is left lies on the page.
pub(super) fn folded(cx: &mut Cx<'_, '_>, period: Period, region: Region, span: Span) -> Option<Region> {
    let (page, bounds) = (period.area(), region.bounds());
    let is_within = |low: f64, high: f64, end: f64| -ON_BORDER <= low && high <= end + ON_BORDER;
    if region.is_empty()
        || (is_within(bounds.min.x, bounds.max.x, page.max.x) && is_within(bounds.min.y, bounds.max.y, page.max.y))
    {
        return Some(region);
    }
    let whole = Region::rect(page);
    if whole.difference(&region).is_empty() {
        return Some(whole);
    }
    let count = period.count(&bounds, &page);
    if count > MOST_PERIODS {
        let message = format!("the region reaches over {} periods of the canvas", grouped(count as u64));
        let limit = grouped(MOST_PERIODS as u64);
        cx.report_value(
            Diagnostic::error(Code::Limit, span, message)
                .label("too large to go round")
                .hint(format!("the limit is {limit}; a smaller region, or a larger canvas, reaches over fewer")),
        );
        return None;
    }
    let rings = || region.polygons().iter().flat_map(|polygon| polygon.rings());
    let moved = period
        .ways(&bounds, &page)
        .flat_map(|way| rings().map(move |ring| ring.iter().map(|&p| p + way).collect::<Vec<Point>>()));
    let united = Region::try_from_rings(moved.collect(), FillRule::NonZero);
    match united.and_then(|united| united.try_combined(&whole, Operation::Intersection)) {
        Ok(folded) => Some(folded),
        Err(tangled) => {
            cx.report_value(Diagnostic::error(Code::Limit, span, tangled.to_string()));
            None
        }
    }
}

/// Checks that a paint goes round.
pub(super) fn check(
    cx: &mut Cx<'_, '_>,
    period: Period,
    region: &Region,
    (tone, given): (&Tone, &ToneValue),
    span: Span,
) {
    if let Some(diagnostic) = aperiodic(tone) {
        cx.report(diagnostic.note(span, "painted here"));
        return;
    }
    if let Some(diagnostic) = too_small(period, region, (tone, given)) {
        cx.report(diagnostic.note(span, "painted here"));
        return;
    }
    if let Some(diagnostic) = odd(period, region, (tone, given)) {
        cx.report(diagnostic.note(span, "painted here"));
        return;
    }
    if let Some(diagnostic) = curled(tone, given) {
        cx.report(diagnostic.note(span, "painted here"));
        return;
    }
    if let Some(diagnostic) = stretched(period, tone) {
        cx.report(diagnostic.note(span, "painted here"));
    }
    if meets_border(region, period) {
        for (what, field, unit, at) in fields(tone, given) {
            if let Some(diagnostic) = seam(period, what, field, unit, at) {
                cx.report(diagnostic.note(span, "painted here"));
            }
        }
    }
}

/// A length for people.
fn millimetres(length: Length) -> String {
    format!("{}mm", (length.to_mm() * 1e3).round() / 1e3)
}

/// The error that a tiling never repeats.
fn aperiodic(tone: &Tone) -> Option<Diagnostic> {
    let mut place = &tone.place;
    while let Placement::Relaxed { placement, .. } = place {
        place = placement;
    }
    let name = match place {
        Placement::Penrose { .. } => "penrose",
        Placement::Pinwheel { .. } => "pinwheel",
        Placement::Poisson { .. }
        | Placement::Uniform { .. }
        | Placement::Grid(_)
        | Placement::Hex { .. }
        | Placement::Triangles { .. }
        | Placement::Points(_)
        | Placement::Relaxed { .. } => return None,
    };
    let message = format!("`{name}` never repeats, so it has no place on a canvas that does");
    Some(
        Diagnostic::error(Code::Repeat, tone.place_span, message).label("a tiling without a period").hint(
            "`grid`, `hex` and `triangles` are tilings that repeat; `poisson` is irregular and goes round as well",
        ),
    )
}

/// The error that a side of the page is shorter than two tiles.
fn too_small(period: Period, region: &Region, (tone, given): (&Tone, &ToneValue)) -> Option<Diagnostic> {
    let spacing = spacing(&tone.place, region);
    let tile = tile_size(tone, spacing);
    let (side, what, at) = match (tile, spacing) {
        (Some(tile), spacing) if spacing.is_none_or(|spacing| tile >= spacing) => {
            (tile, "tiles", given.span_of("shape").unwrap_or(tone.place_span))
        }
        (_, Some(spacing)) => (spacing, "tiles at a distance", tone.place_span),
        (_, None) => return None,
    };
    if period.shorter() >= side * 2.0 - Length::mm(ON_BORDER) {
        return None;
    }
    let (side, page) = (millimetres(side), period.shorter());
    let message = format!("{what} of {side} are too large for a canvas that repeats after {}", millimetres(page));
    Some(
        Diagnostic::error(Code::Repeat, at, message)
            .label("a tile would meet its own copy")
            .hint("each side of the canvas takes two tiles at the least: enlarge it, or take smaller tiles"),
    )
}

/// The distance of neighbouring sites, where the placement says it or counts them over the region's box.
fn spacing(place: &Placement, region: &Region) -> Option<Length> {
    let bounds = region.bounds();
    let mean = |count: usize| Length::mm((bounds.width() * bounds.height() / count.max(1) as f64).sqrt());
    match place {
        Placement::Poisson { radius, .. } => Some(*radius),
        Placement::Grid(GridSize::Spacing(spacing)) | Placement::Hex { spacing } => Some(*spacing),
        Placement::Triangles { edge } | Placement::Penrose { edge } | Placement::Pinwheel { edge } => Some(*edge),
        Placement::Uniform { amount: Amount::AsMany(like) } | Placement::Relaxed { placement: like, .. } => {
            spacing(like, region)
        }
        Placement::Uniform { amount: Amount::Count { count, .. } } => Some(mean(*count as usize)),
        Placement::Points(points) => Some(mean(points.len())),
        Placement::Grid(GridSize::Cells { columns, rows }) => {
            let cell = (bounds.width() / f64::from(*columns)).max(bounds.height() / f64::from(*rows));
            Some(Length::mm(cell))
        }
        Placement::Uniform { amount: Amount::Density { .. } } => None,
    }
}

/// The longer side of a stamp, where it is known before sites are placed. Cells never meet their own copies.
fn tile_size(tone: &Tone, spacing: Option<Length>) -> Option<Length> {
    let sized = |sizes: [Option<Length>; 2], overlap: Option<f64>, irregular: f64| {
        let given = sizes.into_iter().flatten().reduce(Length::max);
        let is_plain = given.is_some() || tone.place.is_lattice();
        let scale = overlap.unwrap_or(if is_plain { 1.0 } else { irregular });
        given.or(spacing).map(|side| side * scale)
    };
    match &tone.shape {
        Shape::Rect { width, height, overlap, .. } => sized([*width, *height], *overlap, IRREGULAR_OVERLAP),
        Shape::Hexagon { size, overlap, .. } => sized([*size, None], *overlap, IRREGULAR_OVERLAP),
        Shape::Triangle { size, overlap, .. } => sized([*size, None], *overlap, POINTED_OVERLAP),
        // Its wide end is longer than the mean of both.
        Shape::Trapezoid { taper, size, overlap, .. } => {
            sized([*size, None], *overlap, POINTED_OVERLAP).map(|side| side * (2.0 / (2.0 - taper)))
        }
        Shape::Stamp { outline, size, overlap, .. } => {
            let bounds = ring_bounds(outline);
            let drawn = Length::mm(bounds.width().max(bounds.height()));
            sized([Some(size.unwrap_or(drawn)), None], *overlap, IRREGULAR_OVERLAP)
        }
        Shape::Cell { .. } | Shape::Voronoi { .. } => None,
    }
}

/// The error that a checkerboard's colours do not alternate across a border.
fn odd(period: Period, region: &Region, (tone, given): (&Tone, &ToneValue)) -> Option<Diagnostic> {
    let AngleRule::Checkerboard = tone.angle else { return None };
    let (columns, rows) = match tone.place {
        Placement::Grid(GridSize::Spacing(side)) => {
            (whole_steps(period.width, side, 1), whole_steps(period.height, side, 1))
        }
        Placement::Grid(GridSize::Cells { columns, rows }) if covers(region.bounds(), period) => {
            (f64::from(columns), f64::from(rows))
        }
        _ => return None,
    };
    let is_odd = |count: f64| count.rem_euclid(2.0) != 0.0;
    if !is_odd(columns) && !is_odd(rows) {
        return None;
    }
    let message = format!("a checkerboard of {columns} by {rows} does not come out even on a canvas that repeats");
    let even = |count: f64| if is_odd(count) { count + 1.0 } else { count };
    let hint = format!("take an even number of columns and rows, such as {} by {}", even(columns), even(rows));
    Some(
        Diagnostic::error(Code::Repeat, given.span_of("angle").unwrap_or(tone.place_span), message)
            .label("tiles on either side of a border would be alike")
            .note(tone.place_span, "the grid")
            .hint(hint),
    )
}

/// The error that a ground does not go round.
fn curled(tone: &Tone, given: &ToneValue) -> Option<Diagnostic> {
    let Some(Ground::Fill { fill, .. }) = &tone.ground else { return None };
    let name = match &fill.kind {
        FillKind::Arcs(_) => "arcs",
        FillKind::Waves { .. } => "waves",
        FillKind::Nawaami { .. } => "nawaami",
        FillKind::Scribble { .. } => "scribble",
        FillKind::Lines(_)
        | FillKind::Dashes { .. }
        | FillKind::Dots { .. }
        | FillKind::Crosses { .. }
        | FillKind::Motif { .. }
        | FillKind::Solid => return None,
    };
    let message = format!("a ground of `{name}` does not go round a canvas that repeats");
    Some(
        Diagnostic::error(Code::Repeat, given.span_of("ground").unwrap_or(tone.place_span), message)
            .label("it would break at the borders")
            .hint("lines, dashes, dots, crosses and motifs go round, and so does `ground: nearest`, whatever the fill"),
    )
}

fn covers(bounds: Rect, period: Period) -> bool {
    let page = period.area();
    bounds.min.x <= ON_BORDER
        && bounds.min.y <= ON_BORDER
        && bounds.max.x >= page.max.x - ON_BORDER
        && bounds.max.y >= page.max.y - ON_BORDER
}

fn meets_border(region: &Region, period: Period) -> bool {
    let (bounds, page) = (region.bounds(), period.area());
    bounds.min.x <= ON_BORDER
        || bounds.min.y <= ON_BORDER
        || bounds.max.x >= page.max.x - ON_BORDER
        || bounds.max.y >= page.max.y - ON_BORDER
}

/// The warning that a lattice is other than it was asked for.
fn stretched(period: Period, tone: &Tone) -> Option<Diagnostic> {
    let (spacing, steps) = match &tone.place {
        Placement::Grid(GridSize::Spacing(side)) => (*side, [(period.width, *side, 1), (period.height, *side, 1)]),
        Placement::Hex { spacing } => {
            let row = *spacing * (3f64.sqrt() * 0.5);
            (*spacing, [(period.width, *spacing, 1), (period.height, row, 2)])
        }
        Placement::Triangles { edge } => {
            (*edge, [(period.width, *edge, 1), (period.height, *edge * (3f64.sqrt() * 0.5), 2)])
        }
        Placement::Poisson { .. }
        | Placement::Uniform { .. }
        | Placement::Grid(GridSize::Cells { .. })
        | Placement::Penrose { .. }
        | Placement::Pinwheel { .. }
        | Placement::Relaxed { .. }
        | Placement::Points(_) => return None,
    };
    let scales = steps.map(|(side, pitch, multiple)| side / pitch / whole_steps(side, pitch, multiple));
    if scales.iter().all(|scale| (scale - 1.0).abs() <= STRETCH) {
        return None;
    }
    let [across, down] = scales.map(|scale| millimetres(spacing * scale));
    let [width, height] = steps.map(|(side, pitch, multiple)| millimetres(pitch * whole_steps(side, pitch, multiple)));
    let asked = millimetres(spacing);
    let message = format!("a spacing of {asked} does not go round the canvas a whole number of times");
    Some(
        Diagnostic::warning(Code::Stretched, tone.place_span, message)
            .label(format!("stretched to {across} across and {down} down"))
            .hint(format!("a canvas of {width} by {height} would stretch nothing")),
    )
}

/// What the values of a field are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    Number,
    /// Radians, of which half a turn is none.
    Direction,
}

/// The fields of a tone, with what they are called and where they stand.
fn fields<'t>(tone: &'t Tone, given: &ToneValue) -> Vec<(&'static str, &'t Field, Unit, Span)> {
    let name = match tone.asked {
        Asked::K(_) => "k",
        Asked::Darkness(_) => "darkness",
    };
    let mut fields = vec![(name, tone.asked.field(), Unit::Number, tone.asked_span)];
    match &tone.angle {
        AngleRule::Along(field) => {
            let at = given.span_of("angle").unwrap_or(tone.place_span);
            fields.push(("angle", field, Unit::Direction, at));
        }
        AngleRule::Bfs(_)
        | AngleRule::Tuned(_)
        | AngleRule::Coloured { .. }
        | AngleRule::Random
        | AngleRule::Checkerboard
        | AngleRule::Fixed(_) => {}
    }
    fields.extend(density(&tone.place).map(|field| ("density", field, Unit::Number, tone.place_span)));
    fields
}

fn density(place: &Placement) -> Option<&Field> {
    match place {
        Placement::Poisson { density, .. } | Placement::Uniform { amount: Amount::Count { density, .. } } => {
            density.as_ref()
        }
        Placement::Uniform { amount: Amount::Density { density, .. } } => Some(density),
        Placement::Relaxed { placement, .. } => density(placement),
        Placement::Uniform { amount: Amount::AsMany(_) }
        | Placement::Grid(_)
        | Placement::Hex { .. }
        | Placement::Triangles { .. }
        | Placement::Penrose { .. }
        | Placement::Pinwheel { .. }
        | Placement::Points(_) => None,
    }
}

/// The warning that a field has other values at one border than at the opposite one.
fn seam(period: Period, what: &str, field: &Field, unit: Unit, at: Span) -> Option<Diagnostic> {
    if field.as_constant().is_some() {
        return None;
    }
    let page = period.area();
    let part = |i: u32| (f64::from(i) + 0.5) / f64::from(PLACES);
    let distance = |a: f64, b: f64| match unit {
        Unit::Number => (a - b).abs(),
        Unit::Direction => Angle::radians(a).rp1_distance(Angle::radians(b)).to_radians(),
    };
    // The mean over a border, so that one sharp edge of an image that runs across it counts for little.
    let across = |i: u32| (Point::new(0.0, part(i) * page.max.y), Point::new(page.max.x, part(i) * page.max.y));
    let down = |i: u32| (Point::new(part(i) * page.max.x, 0.0), Point::new(part(i) * page.max.x, page.max.y));
    let mean = |pair: &dyn Fn(u32) -> (Point, Point)| {
        let differences = (0..PLACES).map(|i| {
            let (a, b) = pair(i);
            distance(field.at(a), field.at(b))
        });
        differences.sum::<f64>() / f64::from(PLACES)
    };
    let (across, down) = (mean(&across), mean(&down));
    let range = match unit {
        Unit::Number => {
            let places = (0..PLACES).flat_map(|row| (0..PLACES).map(move |column| (column, row)));
            let values = places.map(|(x, y)| field.at(Point::new(part(x) * page.max.x, part(y) * page.max.y)));
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
            high - low
        }
        Unit::Direction => std::f64::consts::FRAC_PI_2,
    };
    let differs = |difference: f64| difference > DIFFERENCE * range && difference > ON_BORDER;
    let borders = match (differs(across), differs(down)) {
        (false, false) => return None,
        (true, false) => "at the left border than at the right one",
        (false, true) => "at the upper border than at the lower one",
        (true, true) => "at each border than at the opposite one",
    };
    Some(
        Diagnostic::warning(Code::Seam, at, format!("`{what}` has other values {borders}"))
            .label("this does not repeat")
            .hint("noise repeats, and so does what is the same at opposite borders; strokes continue all the same"),
    )
}
