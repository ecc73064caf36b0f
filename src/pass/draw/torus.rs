//! Pages that repeat: images of tiles before drawing, and images of marks after it.
//!
//! Every tile is drawn once, as if the page had no borders; what hides it beyond a border are images of other tiles. Its
//! marks are then repeated wherever they come onto the page a period away, so that what leaves the page on one side and
//! what enters it on the other is the same mark, moved.

use rayon::prelude::*;

use crate::drawing::{Curves, Dots, Layer, Strokes, Tapers};
use crate::geom::{Angle, Length, Period, Point, Rect, Vec2, ring_bounds};
use crate::scene::{Ground, Paint};
use crate::stage::{Angles, Graph, Sites, Tiles, Torus};

use super::budget::Exceeded;
use super::{Stages, ground, solid};

/// How far straight strokes run on beyond a border, in pens: far enough that what a border leaves of a stroke is never
/// taken for a crumb when a later paint cuts it.
const OVERHANG: f64 = 3.0;

/// An area that holds all that can be drawn: a kilometre each way, in millimetres.
pub(super) const EVERYWHERE: Rect = Rect::new(Point::new(-1e6, -1e6), Point::new(1e6, 1e6));

/// How far beyond the page a stroke of this width is drawn, in millimetres.
pub(super) fn overhang(pen: Length) -> f64 {
    pen.to_mm() * OVERHANG
}

/// A paint's stages with images of the tiles near the borders.
pub(super) struct Unrolled<'a> {
    sites: Sites,
    graph: &'a Graph,
    angles: Angles,
    tiles: Tiles,
}

impl<'a> Unrolled<'a> {
    /// With images of all tiles that come as near to the page as `reach` millimetres; none on a page with an end.
    pub(super) fn new(stages: &Stages<'a>, reach: f64) -> Option<Self> {
        let period = stages.sites.period()?;
        let area = period.area().grown(reach + widest(stages));
        let mut images: Vec<(u32, Vec2)> = Vec::new();
        for (site, &p) in (0u32..).zip(&stages.sites.points) {
            images
                .extend(period.ways(&Rect::new(p, p), &area).filter(|way| *way != Vec2::default()).map(|w| (site, w)));
        }
        let mut sites = stages.sites.clone();
        sites.points.extend(images.iter().map(|&(site, way)| stages.sites.points[site as usize] + way));
        sites.torus = Some(Torus { period, images: images.iter().map(|&(site, _)| site).collect() });
        let turned: Vec<Angle> = images.iter().map(|&(site, _)| stages.angles.0[site as usize]).collect();
        let angles = Angles(stages.angles.0.iter().copied().chain(turned).collect());
        Some(Self { sites, graph: stages.graph, angles, tiles: stages.tiles.with_images(&images) })
    }

    pub(super) fn stages(&self) -> Stages<'_> {
        Stages { sites: &self.sites, graph: self.graph, angles: &self.angles, tiles: &self.tiles }
    }
}

/// The farthest that a drawn tile reaches from its site, in millimetres.
fn widest(stages: &Stages<'_>) -> f64 {
    let drawn = (0..stages.tiles.len()).into_par_iter().filter(|&tile| stages.tiles.is_drawn(tile));
    drawn.map(|tile| radius(stages.tiles.outline(tile), stages.sites.points[tile])).reduce(|| 0.0, f64::max)
}

fn radius(ring: &[Point], site: Point) -> f64 {
    ring.iter().map(|&p| p.distance_squared(site)).fold(0.0, f64::max).sqrt()
}

/// How far beyond the page a paint's own tiles and its ground look for others, in millimetres.
pub(super) fn reach(paint: &Paint, stages: &Stages<'_>) -> f64 {
    let ground = match &paint.tone.ground {
        None => 0.0,
        Some(Ground::Fill { fill, .. }) => ground::beyond(fill),
        Some(Ground::Nearest) => {
            let delaunay = ground::delaunay(paint, stages.sites);
            let around = ground::Around::new(paint, stages.sites, delaunay.as_ref().unwrap_or(stages.graph));
            let reach = |(ring, spare): &mut (Vec<Point>, Vec<Point>), tile: usize| {
                around.outline(tile, ring, spare);
                radius(ring, stages.sites.points[tile])
            };
            let tiles = (0..stages.sites.own()).into_par_iter();
            tiles.map_init(|| (Vec::new(), Vec::new()), reach).reduce(|| 0.0, f64::max)
        }
    };
    let hatches = paint.tone.fill.iter().filter_map(|fill| fill.kind.hatch());
    let hand = hatches.map(|hatch| paint.tone.hand.reach(hatch.pen).to_mm()).fold(0.0, f64::max);
    ground.max(widest(stages)) + hand
}

/// How far beyond the page marks reach, in millimetres.
pub(super) fn protrusion(layers: &[Layer], period: Period) -> f64 {
    let mut bounds = period.area();
    let mut include = |p: &Point, by: f64| {
        let by = Vec2::new(by, by);
        bounds = bounds.including(*p - by).including(*p + by);
    };
    for layer in layers {
        for strokes in &layer.strokes {
            let lines = strokes.lines.iter().flatten().chain(strokes.polylines.iter().flatten());
            lines.chain(strokes.curves.iter().flatten()).for_each(|p| include(p, 0.0));
        }
        layer.tapers.spines.iter().flatten().for_each(|p| include(p, 0.0));
        layer.dots.iter().for_each(|dots| dots.centres.iter().for_each(|p| include(p, dots.radius.to_mm())));
        layer.areas.iter().flatten().flatten().for_each(|p| include(p, 0.0));
    }
    let page = period.area();
    [page.min.x - bounds.min.x, page.min.y - bounds.min.y, bounds.max.x - page.max.x, bounds.max.y - page.max.y]
        .into_iter()
        .fold(0.0, f64::max)
}

/// Repeats the marks of a layer wherever they come onto the page, and leaves out what does not.
///
/// # Errors
/// If marks go round so often that there would be more than `most`.
pub(super) fn wrap(layer: Layer, period: Period, most: u64) -> Result<Layer, Exceeded> {
    let mut wrapper = Wrapper { period, page: period.area(), left: most };
    let mut strokes: Vec<Strokes> =
        layer.strokes.iter().map(|strokes| wrapper.strokes(strokes)).collect::<Result<_, _>>()?;
    strokes.retain(|strokes| !(strokes.lines.is_empty() && strokes.polylines.is_empty() && strokes.curves.is_empty()));
    let mut dots: Vec<Dots> = layer.dots.iter().map(|dots| wrapper.dots(dots)).collect::<Result<_, _>>()?;
    dots.retain(|dots| !dots.centres.is_empty());
    let tapers = wrapper.tapers(&layer.tapers)?;
    let areas = wrapper.areas(layer.areas)?;
    Ok(Layer { strokes, dots, tapers, areas, ..Layer::new(layer.groups, layer.name, layer.ink) })
}

struct Wrapper {
    period: Period,
    page: Rect,
    /// How many marks there may still be.
    left: u64,
}

impl Wrapper {
    /// The ways to all images of a box on the page or on what is `by` millimetres beside it.
    fn ways(&mut self, bounds: &Rect, by: f64, marks: usize) -> Result<impl Iterator<Item = Vec2> + use<>, Exceeded> {
        let seen = self.page.grown(by);
        let count = self.period.count(bounds, &seen) * marks as f64;
        if count > self.left as f64 {
            return Err(Exceeded::Marks);
        }
        Ok(self.period.ways(bounds, &seen))
    }

    /// Whether all of a box lies on the page, and `by` millimetres from its borders.
    fn is_inside(&self, bounds: &Rect, by: f64) -> bool {
        let inner = self.page.grown(-by);
        inner.min.x <= bounds.min.x
            && inner.min.y <= bounds.min.y
            && bounds.max.x <= inner.max.x
            && bounds.max.y <= inner.max.y
    }

    fn strokes(&mut self, strokes: &Strokes) -> Result<Strokes, Exceeded> {
        let half = strokes.pen.to_mm() / 2.0;
        let kept = self.page.grown(overhang(strokes.pen));
        let mut wrapped = Strokes::new(strokes.pen, strokes.cap);
        for bundle in strokes.bundles() {
            let bounds = bounds_of(bundle.as_flattened());
            if self.is_inside(&bounds, half) {
                wrapped.lines.extend_from_slice(bundle);
                wrapped.bundle_ends.push(wrapped.lines.len());
                continue;
            }
            for way in self.ways(&bounds, half, bundle.len())? {
                let start = wrapped.lines.len();
                for line in bundle {
                    let [a, b] = line.map(|p| p + way);
                    if touches(&bounds_of(&[a, b]), &self.page.grown(half)) {
                        wrapped.lines.extend(trimmed(a, b, &kept));
                    }
                }
                if wrapped.lines.len() > start {
                    wrapped.bundle_ends.push(wrapped.lines.len());
                }
            }
        }
        for polyline in &strokes.polylines {
            for way in self.ways(&bounds_of(polyline), half, polyline.len())? {
                let moved: Vec<Point> = polyline.iter().map(|&p| p + way).collect();
                seen_runs(&moved, &self.page.grown(half), &mut wrapped.polylines);
            }
        }
        self.curves(&strokes.curves, half, &mut wrapped.curves)?;
        Ok(wrapped)
    }

    /// Chains are kept whole.
    fn curves(&mut self, curves: &Curves, half: f64, out: &mut Curves) -> Result<(), Exceeded> {
        let mut start = 0;
        for end in curves.bundle_ends().iter().copied().chain([curves.len()]) {
            let chains = || (start..end).map(|i| curves.chain(i));
            let bounds = chains().flatten().fold(Rect::EMPTY, |bounds, &p| bounds.including(p));
            if end > start {
                for way in self.ways(&bounds, half, end - start)? {
                    for chain in chains() {
                        let moved: Vec<Point> = chain.iter().map(|&p| p + way).collect();
                        if touches(&bounds_of(&moved), &self.page.grown(half)) {
                            out.push(&moved);
                        }
                    }
                    out.end_bundle();
                }
            }
            start = end;
        }
        Ok(())
    }

    fn tapers(&mut self, tapers: &Tapers) -> Result<Tapers, Exceeded> {
        let mut wrapped = Tapers::default();
        let mut ends = tapers.spines.bundle_ends().iter().peekable();
        for (i, (spine, widths)) in tapers.iter().enumerate() {
            let half = widths.iter().copied().fold(0.0, f64::max) / 2.0;
            for way in self.ways(&bounds_of(spine), half, 1)? {
                let moved: Vec<Point> = spine.iter().map(|&p| p + way).collect();
                wrapped.push(&moved, widths);
            }
            if ends.next_if(|&&end| end == i + 1).is_some() {
                wrapped.spines.end_bundle();
            }
        }
        Ok(wrapped)
    }

    fn dots(&mut self, dots: &Dots) -> Result<Dots, Exceeded> {
        let radius = dots.radius.to_mm();
        let mut wrapped = Dots::new(dots.radius);
        for bundle in dots.bundles() {
            for way in self.ways(&bounds_of(bundle), radius, bundle.len())? {
                let start = wrapped.centres.len();
                let seen = self.page.grown(radius);
                let moved = bundle.iter().map(|&p| p + way);
                wrapped.centres.extend(moved.filter(|&p| touches(&Rect::new(p, p), &seen)));
                if wrapped.centres.len() > start {
                    wrapped.bundle_ends.push(wrapped.centres.len());
                }
            }
        }
        Ok(wrapped)
    }

    fn areas(&mut self, areas: Vec<Vec<Vec<Point>>>) -> Result<Vec<Vec<Vec<Point>>>, Exceeded> {
        let mut wrapped = Vec::with_capacity(areas.len());
        let mut is_moved = false;
        for area in areas {
            let bounds = area.first().map_or(Rect::EMPTY, |ring| ring_bounds(ring));
            if self.is_inside(&bounds, 0.0) {
                wrapped.push(area);
                continue;
            }
            is_moved = true;
            for way in self.ways(&bounds, 0.0, 1)? {
                wrapped.push(area.iter().map(|ring| ring.iter().map(|&p| p + way).collect()).collect());
            }
        }
        Ok(if is_moved { solid::united(wrapped) } else { wrapped })
    }
}

fn bounds_of(points: &[Point]) -> Rect {
    points.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(p))
}

/// Whether a box, which may be a line or a point, comes into an area and not only to its edge.
fn touches(bounds: &Rect, area: &Rect) -> bool {
    bounds.min.x < area.max.x && area.min.x < bounds.max.x && bounds.min.y < area.max.y && area.min.y < bounds.max.y
}

/// The part of a line in a box (Liang and Barsky 1984); an end that lies in it stays what it is.
fn trimmed(a: Point, b: Point, area: &Rect) -> Option<[Point; 2]> {
    let way = b - a;
    let (mut start, mut end) = (0.0f64, 1.0f64);
    for (step, low, high) in [(way.x, area.min.x - a.x, area.max.x - a.x), (way.y, area.min.y - a.y, area.max.y - a.y)]
    {
        if step == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enters, leaves) = if step > 0.0 { (low / step, high / step) } else { (high / step, low / step) };
        (start, end) = (start.max(enters), end.min(leaves));
    }
    let at = |t: f64| if t >= 1.0 { b } else { a.lerp(b, t) };
    (start < end).then(|| [at(start), at(end)])
}

/// The runs of a polyline's segments that come into an area. A closed one that lies in it stays closed.
fn seen_runs(polyline: &[Point], area: &Rect, out: &mut Vec<Vec<Point>>) {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let mut is_open = false;
    for pair in polyline.windows(2) {
        let is_seen = touches(&bounds_of(pair), area);
        match runs.last_mut().filter(|_| is_open) {
            Some(run) if is_seen => run.push(pair[1]),
            _ if is_seen => runs.push(pair.to_vec()),
            _ => {}
        }
        is_open = is_seen;
    }
    // One that is left open elsewhere runs on through its first point.
    if runs.len() > 1 && is_open && polyline.first() == polyline.last() && runs[0].first() == polyline.first() {
        let first = runs.remove(0);
        if let Some(last) = runs.last_mut() {
            last.extend_from_slice(&first[1..]);
        }
    }
    out.extend(runs);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Cap, Colour};

    const PERIOD: Period = Period::new(Length::mm(10.0), Length::mm(6.0));

    fn layer() -> Layer {
        Layer::new(Vec::new(), "paint".to_owned(), Colour::BLACK)
    }

    fn wrapped(layer: Layer) -> Layer {
        wrap(layer, PERIOD, 1000).unwrap_or_else(|_| self::layer())
    }

    fn points(list: &[(f64, f64)]) -> Vec<Point> {
        list.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn strokes_enter_where_they_leave() {
        let mut one = layer();
        let mut strokes = Strokes::new(Length::mm(0.2), Cap::Butt);
        strokes.lines =
            vec![[Point::new(8.0, 3.0), Point::new(13.0, 3.0)], [Point::new(8.0, 4.0), Point::new(9.0, 4.0)]];
        strokes.bundle_ends = vec![2];
        one.strokes.push(strokes);
        let found = wrapped(one);
        let lines: Vec<Vec<[Point; 2]>> = found.strokes[0].bundles().map(<[_]>::to_vec).collect();
        let overhang = overhang(Length::mm(0.2));
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0][0], [Point::new(8.0, 3.0), Point::new(10.0 + overhang, 3.0)]);
        assert_eq!(lines[0][1], [Point::new(8.0, 4.0), Point::new(9.0, 4.0)]);
        assert_eq!(lines[1].len(), 1);
        assert!((lines[1][0][0].x + overhang).abs() < 1e-12);
        assert_eq!(lines[1][0][1], Point::new(3.0, 3.0));
    }

    #[test]
    fn marks_over_a_corner_are_there_four_times() {
        let mut one = layer();
        let mut dots = Dots::new(Length::mm(0.5));
        dots.centres = points(&[(0.1, 5.9), (5.0, 3.0), (0.5, 3.0)]);
        dots.bundle_ends = vec![1, 3];
        one.dots.push(dots);
        one.areas.push(vec![points(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])]);
        let mut curves = Strokes::new(Length::mm(0.2), Cap::Round);
        curves.curves.push(&points(&[(9.0, 3.0), (9.5, 2.0), (10.5, 2.0), (11.0, 3.0)]));
        one.strokes.push(curves);
        one.tapers.push(&points(&[(5.0, -0.1), (6.0, -0.2), (7.0, -0.2), (8.0, -0.1)]), &[0.5, 0.0]);
        let found = wrapped(one);
        assert_eq!(found.dots[0].bundle_ends, [1, 2, 3, 4, 6]);
        assert_eq!(found.areas.len(), 4);
        assert_eq!(found.strokes[0].curves.len(), 2);
        assert_eq!(found.tapers.spines.len(), 2);
    }

    #[test]
    fn outlines_run_on_and_round() {
        let mut one = layer();
        let mut strokes = Strokes::new(Length::mm(0.2), Cap::Butt);
        strokes.polylines = vec![points(&[(8.0, 2.0), (12.0, 2.0), (12.0, 4.0), (8.0, 4.0), (8.0, 2.0)])];
        one.strokes.push(strokes);
        let found = wrapped(one);
        let runs = &found.strokes[0].polylines;
        assert_eq!(runs[0], points(&[(12.0, 4.0), (8.0, 4.0), (8.0, 2.0), (12.0, 2.0)]));
        assert_eq!(runs.len(), 2);
    }

    #[test]
    fn what_goes_round_too_often_is_refused() {
        let mut one = layer();
        let mut strokes = Strokes::new(Length::mm(0.2), Cap::Butt);
        strokes.polylines = vec![points(&[(0.0, 0.0), (1e6, 1e6), (1e6, 0.0)])];
        one.strokes.push(strokes);
        assert_eq!(wrap(one, PERIOD, 1000).err(), Some(Exceeded::Marks));
    }
}
