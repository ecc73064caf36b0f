//! What tiles look like.

use std::rc::Rc;

use crate::geom::Length;
use crate::scene::Shape;

use super::super::call::{Call, Signature, optional};
use super::super::convert::Slot;
use super::super::value::{Kind, Value};
use crate::diag::{Code, Diagnostic};

const LENGTH: Slot = Slot::of(Kind::Length);
const NUMBER: Slot = Slot::of(Kind::Number);
const BOOL: Slot = Slot::of(Kind::Bool);

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "rect",
        result: Some(Kind::Shape),
        params: &[
            optional("size", LENGTH),
            optional("width", LENGTH),
            optional("height", LENGTH),
            optional("overlap", NUMBER),
            optional("upright", BOOL),
        ],
        build: rect,
    },
    Signature {
        name: "hexagon",
        result: Some(Kind::Shape),
        params: &[optional("size", LENGTH), optional("overlap", NUMBER), optional("upright", BOOL)],
        build: |call| {
            let size = call.maybe_positive("size");
            let overlap = overlap(call);
            shape(Shape::Hexagon { size: size?, overlap: overlap?, upright: call.flag("upright") })
        },
    },
    Signature {
        name: "voronoi",
        result: Some(Kind::Shape),
        params: &[optional("inset", LENGTH), optional("round", LENGTH)],
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
