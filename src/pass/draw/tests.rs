//! Whole paints, from placing to drawing, held against brute force.

#![allow(clippy::unwrap_used, clippy::panic)]

mod curves;
mod hand;
mod laws;

use super::*;
use crate::diag::Code;
use crate::field::{Field, Node};
use crate::geom::clip::convex_clearance;
use crate::geom::{Angle, Length, Point, Rect, Vec2};
use crate::pass::fixture::{self, canvas};
use crate::pass::{cut, link, place, turn};
use crate::region::Region;
use crate::scene::{
    AngleRule, Asked, Bfs, Blend, Cap, Colour, Draw, Edge, Fill, FillKind, GridSize, Ground, Hatch, LayerGroup, Link,
    Outline, Over, Placement, Scene, Shape,
};
use crate::stage::Standing;
use crate::stop::Stop;

const NEAR: f64 = 1e-6;

fn hatch(pitch: f64, pen: f64) -> Hatch {
    Hatch { pitch: Length::mm(pitch), pen: Length::mm(pen), inset: 0.5, shortest: Length::ZERO, cap: Cap::Butt }
}

fn fill(kind: FillKind) -> Fill {
    Fill { kind, ink: None }
}

fn dots(pitch: f64, spacing: f64, radius: f64) -> FillKind {
    FillKind::Dots { hatch: hatch(pitch, 0.1), spacing: Length::mm(spacing), radius: Length::mm(radius) }
}

fn rect_shape(size: Option<f64>, overlap: Option<f64>) -> Shape {
    Shape::Rect { width: size.map(Length::mm), height: None, overlap, upright: false }
}

fn voronoi(inset: f64, round: f64) -> Shape {
    Shape::Voronoi { inset: Length::mm(inset), round: Length::mm(round) }
}

/// A star with five points, which is not convex.
fn star(radius: f64) -> Shape {
    let corner = |i: i32| {
        let radius = if i % 2 == 0 { radius } else { radius * 0.45 };
        Point::default() + Angle::degrees(36.0 * f64::from(i)).unit() * radius
    };
    Shape::Stamp { outline: (0..10).map(corner).collect(), size: None, overlap: None, upright: false }
}

/// Voronoi cells are those of the sites, whichever of them are neighbours.
#[test]
fn voronoi_cells_do_not_hang_on_the_links() {
    let canvas = canvas(12.0, 12.0);
    let mut paint = paint(&canvas);
    paint.tone.place = Placement::Pinwheel { edge: Length::mm(1.5) };
    paint.tone.shape = voronoi(0.0, 0.0);
    let outlines = |paint: &Paint| {
        let run = Run::new(paint, &canvas);
        (0..run.tiles.len()).map(|tile| run.tiles.outline(tile).to_vec()).collect::<Vec<_>>()
    };
    let delaunay = outlines(&paint);
    paint.tone.link = Link::Edges;
    assert_eq!(outlines(&paint), delaunay);
    paint.tone.ground = Some(Ground::Nearest);
    paint.tone.shape = rect_shape(Some(0.6), None);
    let drawn = |paint: &Paint| lines(&layers(paint, &canvas, &Run::new(paint, &canvas)));
    paint.tone.angle = AngleRule::Fixed(Angle::ZERO);
    let edges = drawn(&paint);
    paint.tone.link = Link::Delaunay;
    assert_eq!(drawn(&paint), edges);
}

fn linear(to: Point, start: f64, end: f64) -> Field {
    Field::new(Node::Linear { from: Point::default(), to, start, end })
}

/// One kake of lines on Poisson-disk squares over the whole canvas.
fn paint(canvas: &Canvas) -> Paint {
    let place = Placement::Poisson { radius: Length::mm(1.5), tries: 30, density: None };
    let mut paint = fixture::paint(canvas, place, AngleRule::Bfs(Bfs::default()));
    paint.seed = 1;
    paint.tone.bleed = None;
    paint.tone.fill = vec![fill(FillKind::Lines(hatch(0.31, 0.1)))];
    paint
}

/// The same with one tile, at angle 0.
fn single(canvas: &Canvas, site: Point, size: f64) -> Paint {
    let mut paint = paint(canvas);
    paint.tone.place = Placement::Points(vec![site]);
    paint.tone.angle = AngleRule::Fixed(Angle::ZERO);
    paint.tone.shape = rect_shape(Some(size), None);
    paint
}

/// A disc with a hole that hangs over the canvas's right side.
fn lens(canvas: &Canvas) -> Region {
    let (width, height) = (canvas.width, canvas.height.to_mm());
    let disc = Region::circle(Point::new(width.to_mm() - 2.2, height / 2.0), Length::mm(height * 0.45));
    let hole =
        [(width.to_mm() - 3.0, height / 2.0), (width.to_mm() - 1.0, height * 0.4), (width.to_mm() - 1.4, height * 0.6)];
    disc.difference(&Region::polygon(&hole.map(|(x, y)| Point::new(x, y))).unwrap())
}

/// All stages of a paint.
struct Run {
    sites: Sites,
    graph: Graph,
    angles: Angles,
    tiles: Tiles,
    warnings: Vec<Diagnostic>,
    visible: Region,
}

impl Run {
    fn new(paint: &Paint, canvas: &Canvas) -> Self {
        let sites = place::place(paint, canvas, &Limits::default()).unwrap();
        let graph = link::link(&sites, paint.tone.link);
        let angles = turn::turn(paint, &sites, &graph, &Stop::default());
        let mut warnings = Vec::new();
        let tiles = cut::cut(paint, canvas, &sites, &graph, &angles, &mut warnings);
        Self { sites, graph, angles, tiles, warnings, visible: visible(paint, canvas) }
    }

    fn stages(&self) -> Stages<'_> {
        Stages { sites: &self.sites, graph: &self.graph, angles: &self.angles, tiles: &self.tiles }
    }

    /// The drawn tile that lies on top at a place.
    fn top(&self, p: Point) -> Option<usize> {
        (0..self.tiles.len()).rev().find(|&i| self.tiles.is_drawn(i) && self.tiles.figure(i).clearance(p) > 0.0)
    }
}

fn setting() -> Setting {
    Setting { groups: Vec::new(), ink: Colour::BLACK }
}

fn layers(paint: &Paint, canvas: &Canvas, run: &Run) -> Vec<Layer> {
    draw(paint, canvas, &setting(), &run.stages(), &Limits::default()).unwrap()
}

fn lines(layers: &[Layer]) -> Vec<[Point; 2]> {
    layers.iter().flat_map(|layer| &layer.strokes).flat_map(|strokes| &strokes.lines).copied().collect()
}

fn centres(layers: &[Layer]) -> Vec<Point> {
    layers.iter().flat_map(|layer| &layer.dots).flat_map(|dots| &dots.centres).copied().collect()
}

fn length(lines: &[[Point; 2]]) -> f64 {
    lines.iter().map(|[a, b]| a.distance(*b)).sum()
}

/// Points along a line, its ends left out by a hair.
fn samples([a, b]: [Point; 2]) -> impl Iterator<Item = Point> {
    (0..=16).map(move |i| a.lerp(b, 1e-9 + (1.0 - 2e-9) * f64::from(i) / 16.0))
}

/// Both edges of a stroke.
fn edges([a, b]: [Point; 2], pen: f64) -> [[Point; 2]; 2] {
    let side = (b - a).turned() * (0.5 * pen / a.distance(b));
    [[a + side, b + side], [a - side, b - side]]
}

#[test]
fn the_reports_square_has_twelve_lines_and_then_ten() {
    let canvas = canvas(6.0, 6.0);
    let mut paint = single(&canvas, Point::new(3.0, 3.0), 0.88);
    paint.tone.fill = vec![fill(FillKind::Lines(Hatch { inset: 0.0, ..hatch(0.08, 0.4 / 75.0) }))];
    let mut counts = Vec::new();
    for k in 0..=4 {
        paint.tone.asked = Asked::K(Field::constant(f64::from(k)));
        let run = Run::new(&paint, &canvas);
        counts.push(lines(&layers(&paint, &canvas, &run)).len());
    }
    // The diagonal is 15.56 pitches: 16 steps, without the corners 15 lines.
    assert_eq!(counts, [0, 12, 22, 37, 52]);
    paint.tone.asked = Asked::K(Field::constant(1.0));
    let run = Run::new(&paint, &canvas);
    let drawn = lines(&layers(&paint, &canvas, &run));
    for (i, [a, b]) in drawn.iter().enumerate() {
        // From left to right and back, from the upper edge to the lower.
        let y = 3.0 - 0.44 + 0.08 * i as f64;
        let (from, to) = if i % 2 == 0 { (2.56, 3.44) } else { (3.44, 2.56) };
        assert!(a.distance(Point::new(from, y)) < NEAR && b.distance(Point::new(to, y)) < NEAR, "{i}: {a:?} {b:?}");
    }
}

#[test]
fn a_share_of_the_lines_is_drawn() {
    let canvas = canvas(6.0, 6.0);
    let mut paint = single(&canvas, Point::new(3.0, 3.0), 3.1);
    paint.tone.blend = Blend::Partial;
    paint.tone.asked = Asked::K(Field::constant(1.3));
    let run = Run::new(&paint, &canvas);
    // Ten lines of the first layer and three of the second.
    assert_eq!(lines(&layers(&paint, &canvas, &run)).len(), 13);
}

#[test]
fn layers_end_along_the_field() {
    let canvas = canvas(8.0, 8.0);
    let mut paint = single(&canvas, Point::new(4.0, 4.0), 8.0);
    paint.tone.blend = Blend::Contour;
    paint.tone.asked = Asked::K(linear(Point::new(8.0, 0.0), 0.0, 4.0));
    let run = Run::new(&paint, &canvas);
    assert_eq!(run.tiles.layers[0].full, 4);
    let drawn = lines(&layers(&paint, &canvas, &run));
    let of_direction = |along: Vec2| {
        let along = move |[a, b]: &&[Point; 2]| (*b - *a).cross(along).abs() < 1e-9 * a.distance(*b);
        drawn.iter().filter(along).copied().collect::<Vec<_>>()
    };
    for (layer, along) in [(1, (1.0, 0.0)), (2, (0.0, 1.0)), (3, (1.0, 1.0)), (4, (-1.0, 1.0))] {
        let drawn = of_direction(Vec2::new(along.0, along.1));
        let end = f64::from(layer) * 2.0 - 1.0;
        let least = drawn.iter().flatten().map(|p| p.x).fold(f64::INFINITY, f64::min);
        assert!(least >= end - NEAR, "layer {layer} begins at {least}");
        // Each layer covers what lies beyond its end, at the pitch of the lines.
        let expected = 8.0 * (8.0 - end) / 0.31;
        assert!((length(&drawn) / expected - 1.0).abs() < 0.1, "layer {layer}: {} of {expected}", length(&drawn));
    }
    // The ends of the first layer lie on its contour, not merely beyond it.
    let first = of_direction(Vec2::new(1.0, 0.0));
    assert!(first.iter().all(|[a, b]| (a.x.min(b.x) - 1.0).abs() < NEAR));
}

#[test]
fn dots_of_four_layers_never_coincide() {
    let canvas = canvas(9.0, 9.0);
    for shape in [rect_shape(Some(8.0), None), voronoi(0.5, 0.0)] {
        for (pitch, spacing) in [(0.8, 0.8), (0.8, 0.4), (0.5, 1.0)] {
            let mut paint = single(&canvas, Point::new(4.5, 4.5), 8.0);
            paint.tone.shape = shape.clone();
            paint.tone.bleed = Some(Length::ZERO);
            paint.tone.fill = vec![fill(dots(pitch, spacing, 0.05))];
            paint.tone.asked = Asked::K(Field::constant(4.0));
            let run = Run::new(&paint, &canvas);
            let drawn = centres(&layers(&paint, &canvas, &run));
            let expected = 4.0 * 64.0 / (pitch * spacing);
            assert!((drawn.len() as f64 / expected - 1.0).abs() < 0.25, "{} of {expected}", drawn.len());
            for (i, a) in drawn.iter().enumerate() {
                // On stamps the steps are nearest to pitch and spacing, not less than these by a tenth.
                let least = 0.45 * pitch.min(spacing);
                assert!(drawn[i + 1..].iter().all(|b| a.distance(*b) > least), "{shape:?} {pitch} {spacing} {a:?}");
            }
        }
    }
}

#[test]
fn threads_do_not_change_the_drawing() {
    let canvas = canvas(24.0, 24.0);
    let mut paint = paint(&canvas);
    paint.region = lens(&canvas);
    paint.tone.asked = Asked::K(linear(Point::new(24.0, 24.0), 0.0, 4.0));
    paint.tone.ground = Some(Ground::Nearest);
    let with_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let run = Run::new(&paint, &canvas);
            format!("{:?}{:?}", run.tiles, layers(&paint, &canvas, &run))
        })
    };
    let one = with_threads(1);
    assert!(one.len() > 10_000);
    assert!(one == with_threads(4));
}

#[test]
fn limits_are_met_before_memory_is() {
    let canvas = canvas(20.0, 20.0);
    let mut paint = paint(&canvas);
    let run = Run::new(&paint, &canvas);
    let marks = layers(&paint, &canvas, &run).iter().map(Layer::marks).sum();
    let drawn = |paint: &Paint, strokes| {
        draw(paint, &canvas, &setting(), &run.stages(), &Limits { strokes, ..Limits::default() })
    };
    assert!(drawn(&paint, marks).is_ok());
    assert_eq!(drawn(&paint, marks - 1).unwrap_err().code, Code::Limit);
    let tiny = hatch(1e-12, 1e-13);
    let fills = [
        FillKind::Lines(tiny),
        FillKind::Dashes { hatch: hatch(0.3, 0.1), dash: Length::mm(1e-12), gap: Length::mm(1e-12) },
        FillKind::Dots { hatch: hatch(0.3, 0.1), spacing: Length::mm(1e-12), radius: Length::mm(1e-13) },
    ];
    for kind in fills {
        let lines = fill(FillKind::Lines(hatch(0.3, 0.1)));
        paint.tone.fill = vec![lines, fill(kind.clone())];
        paint.tone.asked = Asked::K(Field::constant(2.0));
        paint.tone.ground = None;
        let run = Run::new(&paint, &canvas);
        let limits = Limits { strokes: 100_000, ..Limits::default() };
        let drawn = draw(&paint, &canvas, &setting(), &run.stages(), &limits);
        assert_eq!(drawn.unwrap_err().code, Code::Limit, "{kind:?}");
        paint.tone.fill.truncate(1);
        paint.tone.ground = Some(Ground::Fill { fill: fill(kind.clone()), angle: Angle::ZERO });
        let drawn = draw(&paint, &canvas, &setting(), &run.stages(), &limits);
        assert_eq!(drawn.unwrap_err().code, Code::Limit, "{kind:?}");
    }
}

#[test]
fn hopeless_paints_are_refused_before_they_are_drawn() {
    let canvas = canvas(60.0, 30.0);
    let refused = |spacing: f64, size: Option<f64>, kind: FillKind| {
        let mut paint = paint(&canvas);
        paint.tone.place = Placement::Hex { spacing: Length::mm(spacing) };
        paint.tone.shape = rect_shape(size, None);
        paint.tone.angle = AngleRule::Fixed(Angle::ZERO);
        paint.tone.fill = vec![fill(kind)];
        let run = Run::new(&paint, &canvas);
        draw(&paint, &canvas, &setting(), &run.stages(), &Limits::default()).unwrap_err()
    };
    let lines = FillKind::Lines(hatch(1.0, 0.1));
    assert!(refused(3.0, None, dots(1e-4, 1e-4, 1e-5)).message.ends_with("dots"));
    assert!(refused(1.0, Some(1e6), lines.clone()).message.ends_with("lines"));
    let overlap = refused(0.2, Some(200.0), FillKind::Lines(hatch(20.0, 0.1)));
    assert!(overlap.message.starts_with("tiles of 200mm at a distance of 0.2mm overlap"), "{}", overlap.message);
}

#[test]
fn a_paint_that_draws_nothing_is_warned_of() {
    let canvas = canvas(6.0, 6.0);
    let mut paint = single(&canvas, Point::new(3.0, 3.0), 1.0);
    let limits = Limits::default();
    let warning = |paint: &Paint| {
        let mut assembly = Assembly::new(&canvas, &limits);
        assembly.paint(paint, &setting(), &Run::new(paint, &canvas).stages()).unwrap()
    };
    assert!(warning(&paint).is_none());
    paint.tone.fill = vec![fill(FillKind::Lines(Hatch { shortest: Length::mm(2.0), ..hatch(0.3, 0.1) }))];
    assert_eq!(warning(&paint).unwrap().code, Code::NoTiles);
    // Where k is nothing, nothing is meant to be drawn.
    paint.tone.asked = Asked::K(Field::constant(0.0));
    assert!(warning(&paint).is_none());
}

#[test]
fn clamped_values_are_reported_once() {
    let canvas = canvas(12.0, 12.0);
    let mut paint = paint(&canvas);
    paint.tone.asked = Asked::K(linear(Point::new(12.0, 0.0), 0.0, 6.0));
    let run = Run::new(&paint, &canvas);
    assert_eq!(run.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(), [Code::Clamped]);
    assert!(run.tiles.k.iter().all(|k| (0.0..=4.0).contains(k)));
    // Only tiles on the region count.
    paint.region = Region::rect(Rect::new(Point::default(), Point::new(3.0, 12.0)));
    assert!(Run::new(&paint, &canvas).warnings.is_empty());
    paint.region = Region::rect(Rect::new(Point::new(20.0, 0.0), Point::new(23.0, 12.0)));
    // A region off the canvas was warned of where it was found.
    assert!(Run::new(&paint, &canvas).warnings.is_empty());
}

#[test]
fn edges_decide_which_tiles_stand() {
    let canvas = canvas(8.0, 8.0);
    let mut paint = paint(&canvas);
    paint.tone.place = Placement::Grid(GridSize::Spacing(Length::mm(2.0)));
    paint.tone.bleed = Some(Length::ZERO);
    paint.tone.angle = AngleRule::Fixed(Angle::ZERO);
    paint.tone.edge = Edge::Whole;
    let drawn = |paint: &Paint, standing: Standing| {
        let run = Run::new(paint, &canvas);
        run.tiles.standing.iter().filter(|&&s| s == standing).count()
    };
    // Tiles that fill the canvas exactly lie inside.
    assert_eq!(drawn(&paint, Standing::Whole), 16);
    paint.region = Region::rect(Rect::new(Point::default(), Point::new(5.5, 8.0)));
    assert_eq!(drawn(&paint, Standing::Whole), 8);
    paint.tone.edge = Edge::Centre;
    assert_eq!(drawn(&paint, Standing::Whole), 12);
    paint.tone.edge = Edge::Clip;
    assert_eq!(drawn(&paint, Standing::Absent), 4);
    // A hole within one tile, and a region within one.
    let dot = Region::circle(Point::new(3.0, 3.0), Length::mm(0.5));
    paint.region = Region::rect(canvas.bounds()).difference(&dot);
    paint.tone.edge = Edge::Whole;
    assert_eq!(drawn(&paint, Standing::Absent), 1);
    paint.region = dot;
    paint.tone.edge = Edge::Clip;
    assert_eq!(drawn(&paint, Standing::Clipped), 1);
    assert_eq!(drawn(&paint, Standing::Absent), 15);
}

#[test]
fn groups_and_inks_are_inherited() {
    let canvas = canvas(8.0, 8.0);
    let (red, blue) = (Colour { r: 255, ..Colour::BLACK }, Colour { b: 255, ..Colour::BLACK });
    let region = Region::circle(Point::new(4.0, 4.0), Length::mm(2.0));
    let outline = Outline { region, pen: Length::mm(0.3), span: paint(&canvas).span };
    let mut two = paint(&canvas);
    two.tone.asked = Asked::K(Field::constant(2.0));
    two.tone.fill.push(Fill { ink: Some(blue), ..fill(FillKind::Solid) });
    let inner = LayerGroup { name: "b".to_owned(), ink: None, draws: vec![Draw::Paint(Box::new(two.clone()))] };
    let draws = vec![Draw::Layer(inner), Draw::Outline(outline)];
    let group = LayerGroup { name: "a".to_owned(), ink: Some(red), draws };
    let plain = paint(&canvas);
    let scene = Scene {
        canvas: canvas.clone(),
        seed: 0,
        params: Vec::new(),
        draws: vec![Draw::Paint(Box::new(plain)), Draw::Layer(group)],
        experiments: Vec::new(),
    };
    let limits = Limits::default();
    let mut assembly = Assembly::new(&scene.canvas, &limits);
    for (setting, item) in items(&scene) {
        match item {
            Item::Paint(paint) => {
                assembly.paint(paint, &setting, &Run::new(paint, &canvas).stages()).unwrap();
            }
            Item::Outline(outline) => assembly.outline(outline, &setting).unwrap(),
            Item::Ink(ink) => assembly.ink(ink, &setting).unwrap(),
        }
    }
    let drawing = assembly.finish();
    let found: Vec<_> = drawing.layers.iter().map(|l| (l.groups.join("/"), l.name.as_str(), l.ink)).collect();
    let expected = [("", "paint", Colour::BLACK), ("a/b", "paint", red), ("a/b", "paint", blue), ("a", "outline", red)];
    assert_eq!(found, expected.map(|(groups, name, ink)| (groups.to_owned(), name, ink)));
    let ring = &drawing.layers[3].strokes[0].polylines[0];
    assert_eq!(ring.first(), ring.last());
}

#[test]
fn solid_tiles_cover_what_they_should() {
    let canvas = canvas(16.0, 16.0);
    let mut paint = paint(&canvas);
    paint.region = lens(&canvas);
    paint.tone.fill = vec![fill(FillKind::Solid)];
    paint.tone.ground = Some(Ground::Fill { fill: fill(FillKind::Solid), angle: Angle::ZERO });
    let run = Run::new(&paint, &canvas);
    let areas: Vec<_> = layers(&paint, &canvas, &run).into_iter().flat_map(|layer| layer.areas).collect();
    // Tiles and ground share out the region: united they are the region itself, without a seam.
    let area = |rings: Vec<Vec<Point>>| Region::from_rings(rings, crate::region::FillRule::EvenOdd).area();
    let sum: f64 = areas.iter().cloned().map(area).sum();
    let union = Region::from_rings(areas.concat(), crate::region::FillRule::NonZero).area();
    assert!((sum - run.visible.area()).abs() < 1e-3, "{sum} {}", run.visible.area());
    assert!((union - run.visible.area()).abs() < 1e-3);
    assert_eq!(areas.len(), run.visible.polygons().len());
}

#[test]
fn solid_layers_end_along_the_field() {
    let canvas = canvas(8.0, 8.0);
    let mut paint = single(&canvas, Point::new(4.0, 4.0), 8.0);
    paint.tone.blend = Blend::Contour;
    paint.tone.asked = Asked::K(linear(Point::new(8.0, 0.0), 0.0, 1.0));
    paint.tone.fill = vec![fill(FillKind::Solid)];
    let run = Run::new(&paint, &canvas);
    let areas: Vec<_> = layers(&paint, &canvas, &run).into_iter().flat_map(|layer| layer.areas).collect();
    let region = Region::from_rings(areas.concat(), crate::region::FillRule::EvenOdd);
    assert!((region.area() - 32.0).abs() < NEAR);
    assert!((region.bounds().min.x - 4.0).abs() < NEAR);
}

#[test]
fn knockout_removes_what_lies_under_its_tiles() {
    let canvas = canvas(14.0, 14.0);
    let mut below = paint(&canvas);
    below.tone.asked = Asked::K(Field::constant(2.0));
    below.tone.fill = vec![fill(FillKind::Lines(hatch(0.31, 0.01))), fill(dots(0.7, 0.7, 0.1))];
    below.tone.ground = Some(Ground::Fill { fill: fill(FillKind::Solid), angle: Angle::ZERO });
    let circle = Outline { region: lens(&canvas), pen: Length::mm(0.01), span: below.span };
    let mut above = paint(&canvas);
    above.seed = 2;
    above.region = Region::circle(Point::new(7.0, 7.0), Length::mm(4.0));
    above.tone.place = Placement::Grid(GridSize::Spacing(Length::mm(1.7)));
    above.tone.shape = rect_shape(Some(1.2), None);
    above.tone.over = Over::Knockout;
    let (under, over) = (Run::new(&below, &canvas), Run::new(&above, &canvas));
    let limits = Limits::default();
    let assemble = |is_knocked_out: bool| {
        let mut assembly = Assembly::new(&canvas, &limits);
        assembly.paint(&below, &setting(), &under.stages()).unwrap();
        assembly.outline(&circle, &setting()).unwrap();
        if is_knocked_out {
            assembly.paint(&above, &setting(), &over.stages()).unwrap();
        }
        assembly.finish().layers
    };
    let (whole, cut) = (assemble(false), assemble(true));
    let left = &cut[..2];

    let is_under = |p: Point, margin: f64| {
        over.visible.signed_distance(p) > margin
            && (0..over.tiles.len())
                .any(|i| over.tiles.is_drawn(i) && convex_clearance(over.tiles.outline(i), p) > margin)
    };
    for line in lines(left) {
        assert!(samples(line).all(|p| !is_under(p, NEAR)), "{line:?}");
    }
    // What is seen of each stroke is still there, but for pieces shorter than two pens.
    let seen: f64 = lines(&whole)
        .iter()
        .map(|&[a, b]| {
            let steps = (a.distance(b) / 0.002).ceil();
            let seen = (0..steps as u32).filter(|&i| !is_under(a.lerp(b, (f64::from(i) + 0.5) / steps), 0.0)).count();
            a.distance(b) * seen as f64 / steps
        })
        .sum();
    let drawn = length(&lines(left));
    assert!((drawn / seen - 1.0).abs() < 2e-3, "{drawn} {seen}");
    for p in centres(left) {
        assert!(!is_under(p, -0.1 / 2f64.sqrt()));
    }
    assert!(centres(left).len() * 2 > centres(&whole).len() && centres(left).len() < centres(&whole).len());
    let outline = |layers: &[Layer]| layers[1].strokes[0].polylines.clone();
    assert_eq!(outline(&whole).len(), 2);
    for piece in outline(left) {
        for pair in piece.windows(2) {
            assert!(samples([pair[0], pair[1]]).all(|p| !is_under(p, NEAR)));
        }
    }
    let path =
        |lines: Vec<Vec<Point>>| lines.iter().flat_map(|l| l.windows(2)).map(|p| p[0].distance(p[1])).sum::<f64>();
    let (before, after) = (path(outline(&whole)), path(outline(left)));
    assert!(after < before * 0.95 && after > before * 0.3, "{before} {after}");
    let region = |layers: &[Layer]| Region::from_rings(layers[0].areas.concat(), crate::region::FillRule::EvenOdd);
    assert!(region(left).polygons().iter().flat_map(|p| &p.outer).all(|&p| !is_under(p, NEAR)));
    assert!(region(left).area() <= region(&whole).area());
}
