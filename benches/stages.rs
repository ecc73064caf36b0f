//! How long the stages take on canvases of ten thousand to a million tiles: `cargo bench`.

use divan::Bencher;
use kakeami::field::Field;
use kakeami::geom::Length;
use kakeami::pass::{link, place, turn};
use kakeami::region::Region;
use kakeami::scene::{
    AngleRule, Blend, Canvas, Cap, Colour, Depth, Domain, Edge, Fill, FillKind, Hatch, Limits, Link, Over, Paint,
    Placement, Shape, Stack, Tone,
};
use kakeami::span::{Sources, Span, Syntax};
use kakeami::stage::{Graph, Sites};

/// About how many tiles there are.
const TILES: [u32; 3] = [10_000, 100_000, 1_000_000];

/// The distance of two sites in millimetres.
const RADIUS: f64 = 0.6;

fn main() {
    divan::main();
}

/// The report's tone on a canvas of so many tiles.
fn scene(tiles: u32) -> (Canvas, Paint) {
    // Poisson-disk sampling finds 0.627 sites in a square of the radius.
    let side = Length::mm(RADIUS * (f64::from(tiles) / 0.627).sqrt());
    let canvas = Canvas {
        width: side,
        height: side,
        pixels: [512, 512],
        dpi: 600.0,
        paper: Some(Colour::WHITE),
        ink: Colour::BLACK,
        depth: Depth::Eight,
        unit: Length::mm(1.0),
    };
    let span = Span::new(Sources::new().add("bench", "", Syntax::Kake), 0, 0);
    let hatch = Hatch {
        pitch: Length::mm(0.08),
        pen: Length::mm(0.02),
        inset: 0.5,
        shortest: Length::mm(0.04),
        cap: Cap::Butt,
    };
    let tone = Tone {
        place: Placement::Poisson { radius: Length::mm(RADIUS), tries: 30, density: None },
        place_span: span,
        domain: Domain::Canvas,
        bleed: None,
        shape: Shape::Rect { width: Some(Length::mm(0.88)), height: None, overlap: None, upright: false },
        link: Link::Delaunay,
        angle: AngleRule::Bfs { candidates: 360 },
        fill: vec![Fill { kind: FillKind::Lines(hatch), ink: None }],
        k: Field::constant(2.0),
        k_span: span,
        blend: Blend::Step,
        stack: Stack::Cover,
        over: Over::Print,
        ground: None,
        edge: Edge::Clip,
    };
    let region = Region::rect(canvas.bounds());
    let paint = Paint { name: "plate".to_owned(), tone_name: "plate".to_owned(), seed: 1, region, tone, span };
    (canvas, paint)
}

fn sites(tiles: u32) -> (Paint, Sites) {
    let (canvas, paint) = scene(tiles);
    match place::place(&paint, &canvas, &Limits::default()) {
        Ok(sites) => (paint, sites),
        Err(diagnostic) => unreachable!("{}", diagnostic.message),
    }
}

fn linked(tiles: u32) -> (Paint, Sites, Graph) {
    let (paint, sites) = sites(tiles);
    let graph = link::link(&sites, Link::Delaunay);
    (paint, sites, graph)
}

#[divan::bench(args = TILES, sample_count = 5)]
fn place(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    bencher.bench(|| place::place(&paint, &canvas, &Limits::default()));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn link(bencher: Bencher<'_, '_>, tiles: u32) {
    let (_, sites) = sites(tiles);
    bencher.bench(|| link::link(&sites, Link::Delaunay));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn turn(bencher: Bencher<'_, '_>, tiles: u32) {
    let (paint, sites, graph) = linked(tiles);
    bencher.bench(|| turn::turn(&paint, &sites, &graph));
}
