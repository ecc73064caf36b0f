//! What tiles look like.

use std::rc::Rc;

use crate::geom::{BadOutline, Length, Point, simple_outline};
use crate::scene::Shape;

use super::super::call::{Call, Signature, optional, required};
use super::super::convert::{Slot, coerce};
use super::super::value::{Kind, Value};
use crate::diag::{Code, Diagnostic};

const LENGTH: Slot = Slot::of(Kind::Length);
const NUMBER: Slot = Slot::of(Kind::Number);
const BOOL: Slot = Slot::of(Kind::Bool);

/// By how much the narrow end of a trapezoid is shorter.
const DEFAULT_TAPER: f64 = 0.5;

/// The most corners of a stamp: every tile has them all.
const MOST_CORNERS: usize = 256;

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "rect",
        about: "Rectangular stamps, turned with their tiles: squares unless both sides are given.",
        result: Some(Kind::Shape),
        params: &[
            optional("size", LENGTH, "the spacing", "how large the stamp is, above 0"),
            optional("width", LENGTH, "the spacing", "side along the first layer's strokes, above 0"),
            optional("height", LENGTH, "the width", "side across the first layer's strokes, above 0"),
            optional(
                "overlap",
                NUMBER,
                "1 or 1.6",
                "scales the stamp, 0.1 to 10: 1 where a size is given and on lattices",
            ),
            optional("upright", BOOL, "false", "keep the stamp level while its strokes turn"),
        ],
        build: rect,
    },
    Signature {
        name: "hexagon",
        about: "Hexagonal stamps, turned with their tiles.",
        result: Some(Kind::Shape),
        params: &[
            optional("size", LENGTH, "the spacing", "how large the stamp is, above 0"),
            optional(
                "overlap",
                NUMBER,
                "1 or 1.6",
                "scales the stamp, 0.1 to 10: 1 where a size is given and on lattices",
            ),
            optional("upright", BOOL, "false", "keep the stamp level while its strokes turn"),
        ],
        build: |call| {
            let size = call.maybe_positive("size");
            let overlap = overlap(call);
            shape(Shape::Hexagon { size: size?, overlap: overlap?, upright: call.flag("upright") })
        },
    },
    Signature {
        name: "triangle",
        about: "Equilateral stamps that stand on their side at angle 0.",
        result: Some(Kind::Shape),
        params: &[
            optional("size", LENGTH, "the spacing", "how large the stamp is, above 0"),
            optional(
                "overlap",
                NUMBER,
                "1 or 1.6",
                "scales the stamp, 0.1 to 10: 1 where a size is given and on lattices",
            ),
            optional("upright", BOOL, "false", "keep the stamp level while its strokes turn"),
        ],
        build: |call| {
            let size = call.maybe_positive("size");
            let overlap = overlap(call);
            shape(Shape::Triangle { size: size?, overlap: overlap?, upright: call.flag("upright") })
        },
    },
    Signature {
        name: "trapezoid",
        about: "Stamps that narrow along the first layer's strokes.",
        result: Some(Kind::Shape),
        params: &[
            optional("taper", NUMBER, "0.5", "by what share the narrow end is shorter, 0 to 1"),
            optional("size", LENGTH, "the spacing", "distance of the ends and their mean length, above 0"),
            optional(
                "overlap",
                NUMBER,
                "1 or 1.6",
                "scales the stamp, 0.1 to 10: 1 where a size is given and on lattices",
            ),
            optional("upright", BOOL, "false", "keep the stamp level while its strokes turn"),
        ],
        build: |call| {
            let taper = call.within("taper", 0.0, 1.0, DEFAULT_TAPER);
            let size = call.maybe_positive("size");
            let overlap = overlap(call);
            let upright = call.flag("upright");
            shape(Shape::Trapezoid { taper: taper?, size: size?, overlap: overlap?, upright })
        },
    },
    Signature {
        name: "stamp",
        about: "Stamps of any outline that does not cross itself.",
        result: Some(Kind::Shape),
        params: &[
            required("points", Slot::of(Kind::List), "3 to 256 corners in canvas units, seen from the site"),
            optional("size", LENGTH, "its own measures", "longer side of the stamp's box, above 0"),
            optional(
                "overlap",
                NUMBER,
                "1 or 1.6",
                "scales the stamp, 0.1 to 10: 1 where a size is given and on lattices",
            ),
            optional("upright", BOOL, "false", "keep the stamp level while its strokes turn"),
        ],
        build: |call| {
            let outline = outline(call);
            let size = call.maybe_positive("size");
            let overlap = overlap(call);
            let upright = call.flag("upright");
            shape(Shape::Stamp { outline: outline?, size: size?, overlap: overlap?, upright })
        },
    },
    Signature {
        name: "cell",
        about: "The cells of a tiling, side by side.",
        result: Some(Kind::Shape),
        params: &[optional("inset", LENGTH, "0mm", "how far the cell is drawn in, not negative")],
        build: |call| {
            let inset = call.not_negative("inset", Length::ZERO)?;
            shape(Shape::Cell { inset })
        },
    },
    Signature {
        name: "voronoi",
        about: "The Voronoi cell of every site, side by side.",
        result: Some(Kind::Shape),
        params: &[
            optional("inset", LENGTH, "0mm", "how far the cell is drawn in, not negative"),
            optional("round", LENGTH, "0mm", "radius of the corners, not negative"),
        ],
        build: |call| {
            let inset = call.not_negative("inset", Length::ZERO);
            let round = call.not_negative("round", Length::ZERO);
            shape(Shape::Voronoi { inset: inset?, round: round? })
        },
    },
];

fn shape(shape: Shape) -> Option<Value> {
    Some(Value::Shape(Rc::new(shape)))
}

/// From a tenth to ten times: beyond that a tile is lost among its neighbours or hides them all.
fn overlap(call: &mut Call<'_, '_, '_>) -> Option<Option<f64>> {
    if !call.has("overlap") {
        return Some(None);
    }
    call.within("overlap", 0.1, 10.0, 1.0).map(Some)
}

fn rect(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    // Arguments are all looked at before any is given up, so that each one's mistake is told.
    let size = call.maybe_positive("size");
    let width = call.maybe_positive("width");
    let height = call.maybe_positive("height");
    let overlap = overlap(call);
    let (size, width, height, overlap) = (size?, width?, height?, overlap?);
    if size.is_some() && (width.is_some() || height.is_some()) {
        let message = "`rect` takes `size`, or `width` and `height`, not both";
        call.cx.report(Diagnostic::error(Code::Duplicate, call.span, message));
        return None;
    }
    shape(Shape::Rect { width: width.or(size), height: height.or(size), overlap, upright: call.flag("upright") })
}

/// The corners of a stamp as seen from its site.
fn outline(call: &mut Call<'_, '_, '_>) -> Option<Vec<Point>> {
    let Some(Value::List(members)) = call.value("points") else { return None };
    let span = call.span_of("points");
    if members.len() > MOST_CORNERS {
        return call.refuse("points", format!("a stamp has at most {MOST_CORNERS} corners, not {}", members.len()));
    }
    let corners: Option<Vec<Point>> =
        members.iter().map(|member| coerce(call.cx, member.clone(), Slot::of(Kind::Point), span).as_point()).collect();
    match simple_outline(&corners?) {
        Ok(outline) => Some(outline),
        Err(BadOutline::FewCorners) => {
            call.refuse("points", "a stamp needs at least three corners in different places".to_owned())
        }
        Err(BadOutline::Flat) => call.refuse("points", "the corners of the stamp lie on one line".to_owned()),
        Err(BadOutline::Crossing) => call.refuse("points", "the outline of the stamp crosses itself".to_owned()),
    }
}
