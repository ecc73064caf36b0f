use super::*;
use crate::drawing::{Drawing, Page};
use crate::geom::ring_area;
use crate::pass::fixture::{canvas, paint};
use crate::scene::{AngleRule, Depth, GridSize, Limits, Placement, Repeat};
use crate::{PaintStages, back};

/// A grid of two by two tiles on four by four millimetres, turned by 0 and 90 degrees like a checkerboard.
fn small() -> (Canvas, Pattern) {
    let canvas = canvas(4.0, 4.0);
    let grid = Placement::Grid(GridSize::Cells { columns: 2, rows: 2 });
    let paint = paint(&canvas, grid, AngleRule::Checkerboard);
    (canvas.clone(), pattern(&paint, &canvas))
}

fn pattern(paint: &Paint, canvas: &Canvas) -> Pattern {
    let stages = PaintStages::new(paint, canvas, &Limits::default(), &mut (), &mut Vec::new()).unwrap();
    Pattern::new(paint, canvas, &stages.borrow())
}

fn svg(canvas: &Canvas, layers: Vec<Layer>) -> String {
    let page = Page {
        width: canvas.width,
        height: canvas.height,
        bleed: Length::ZERO,
        pixels: canvas.pixels,
        dpi: canvas.dpi,
        paper: None,
        depth: Depth::Eight,
    };
    let mut out = Vec::new();
    back::svg::write(&Drawing { page, layers }, None, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn a_small_pattern_with_all_overlays() {
    let (canvas, pattern) = small();
    insta::assert_snapshot!(svg(&canvas, layers(&Overlay::ALL, &[pattern], &canvas)));
}

#[test]
fn overlays_lie_on_each_other_in_one_order_whatever_is_asked_for() {
    let (canvas, pattern) = small();
    let patterns = [pattern];
    let names = |overlays: &[Overlay]| -> Vec<String> {
        let mut names: Vec<String> =
            layers(overlays, &patterns, &canvas).into_iter().flat_map(|layer| layer.groups).collect();
        names.dedup();
        names
    };
    let order = ["overlay angles", "overlay graph", "overlay sites"];
    assert_eq!(names(&[Overlay::Sites, Overlay::Angles, Overlay::Graph, Overlay::Sites]), order);
    assert!(names(&[]).is_empty());
}

#[test]
fn names_lead_back_to_overlays() {
    assert!(Overlay::ALL.into_iter().all(|overlay| Overlay::from_name(overlay.name()) == Some(overlay)));
    assert_eq!(Overlay::from_name("site"), None);
}

/// The area of all cells, in square millimetres.
fn covered(cells: &[Vec<Area>]) -> f64 {
    cells.iter().flatten().flatten().map(|ring| ring_area(ring)).sum()
}

#[test]
fn cells_share_out_the_region() {
    let canvas = canvas(20.0, 15.0);
    let place = Placement::Poisson { radius: Length::mm(1.5), tries: 30, density: None };
    let mut paint = paint(&canvas, place, AngleRule::Random);
    let disc = Region::circle(Point::new(9.0, 8.0), Length::mm(6.0));
    let hole = Region::circle(Point::new(8.0, 7.0), Length::mm(2.0));
    paint.region = disc.difference(&hole);
    let found = pattern(&paint, &canvas);
    assert!(found.measured.sites.len() > 20);
    assert!((covered(&found.cells) - paint.region.area()).abs() < 1e-3);
    // On a page that repeats the cells go on beyond its borders and cover it just once.
    let canvas = Canvas { repeat: Repeat::Both, ..canvas };
    paint.region = Region::rect(canvas.bounds());
    let found = pattern(&paint, &canvas);
    assert!((covered(&found.cells) - 300.0).abs() < 1e-3);
    // Links are as short there as elsewhere.
    let links: Vec<[Point; 2]> = found.measured.graph.edges().map(|edge| found.link(edge)).collect();
    assert!(links.len() > 60 && links.iter().all(|[a, b]| a.distance(*b) < 6.0));
}
