//! Paints for the tests of the passes.

use crate::field::Field;
use crate::geom::{Length, Point, Rect};
use crate::region::Region;
use crate::scene::{
    AngleRule, Asked, Blend, Canvas, Cap, Colour, Depth, Domain, Edge, Fill, FillKind, Hand, Hatch, Link, Over, Paint,
    Placement, Repeat, Shape, Stack, Tone,
};
use crate::span::{Sources, Span, Syntax};

/// A canvas of so many millimetres.
pub(crate) fn canvas(width: f64, height: f64) -> Canvas {
    Canvas {
        width: Length::mm(width),
        height: Length::mm(height),
        bleed: Length::ZERO,
        pixels: [512, 512],
        dpi: 600.0,
        paper: None,
        ink: Colour::BLACK,
        depth: Depth::Eight,
        unit: Length::mm(1.0),
        repeat: Repeat::Off,
        gain: Length::ZERO,
    }
}

/// A paint of the whole canvas, called "paint", with square tiles and no bleed.
pub(crate) fn paint(canvas: &Canvas, place: Placement, angle: AngleRule) -> Paint {
    let span = Span::new(Sources::new().add("test", "", Syntax::Kake), 0, 0);
    let hatch = Hatch {
        pitch: Length::mm(0.08),
        pen: Length::mm(0.005),
        inset: 0.5,
        shortest: Length::mm(0.01),
        cap: Cap::Butt,
    };
    Paint {
        name: "paint".to_owned(),
        tone_name: "tone".to_owned(),
        seed: 0,
        region: Region::rect(canvas.bounds()),
        tone: Tone {
            place,
            place_span: span,
            domain: Domain::Canvas,
            bleed: Some(Length::ZERO),
            shape: Shape::Rect { width: None, height: None, overlap: None, upright: false },
            link: Link::Delaunay,
            angle,
            angle_span: span,
            fill: vec![Fill { kind: FillKind::Lines(hatch), ink: None }],
            asked: Asked::K(Field::constant(1.0)),
            asked_span: span,
            blend: Blend::Step,
            stack: Stack::Cover,
            over: Over::Print,
            ground: None,
            edge: Edge::Clip,
            hand: Hand::RULED,
            hand_span: span,
        },
        span,
    }
}

/// An upright box by its corners.
pub(crate) fn rect(x0: f64, y0: f64, x1: f64, y1: f64) -> Rect {
    Rect::new(Point::new(x0, y0), Point::new(x1, y1))
}
