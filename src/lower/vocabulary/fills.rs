//! What is drawn in tiles.

use std::rc::Rc;

use crate::geom::Length;
use crate::scene::{Cap, Fill, FillKind, Hatch};

use super::super::call::{Call, Param, Signature, optional, required};
use super::super::convert::Slot;
use super::super::value::{Kind, Value};

const LENGTH: Slot = Slot::of(Kind::Length);
const PITCH: Param = required("pitch", LENGTH);
const PEN: Param = optional("pen", LENGTH);
const INK: Param = optional("ink", Slot::of(Kind::Colour));
const INSET: Param = optional("inset", Slot::of(Kind::Number));
const SHORTEST: Param = optional("shortest", LENGTH);
const CAP: Param = optional("cap", Slot::words(&["butt", "round"]));

/// The width of a stroke where none is given: that of a fine nib.
pub(in super::super) const DEFAULT_PEN: Length = Length::mm(0.2);

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "lines",
        result: Some(Kind::Fill),
        params: &[PITCH, PEN, INSET, SHORTEST, CAP, INK],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN)?;
            fill(call, FillKind::Lines(hatch))
        },
    },
    Signature {
        name: "dashes",
        result: Some(Kind::Fill),
        params: &[PITCH, PEN, required("dash", LENGTH), optional("gap", LENGTH), INSET, SHORTEST, CAP, INK],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN);
            let dash = call.positive("dash", None);
            let gap = call.positive("gap", dash.or(Some(DEFAULT_PEN)));
            fill(call, FillKind::Dashes { hatch: hatch?, dash: dash?, gap: gap? })
        },
    },
    Signature {
        name: "dots",
        result: Some(Kind::Fill),
        params: &[PITCH, optional("spacing", LENGTH), optional("radius", LENGTH), PEN, INSET, INK],
        build: |call| {
            // A dot without a radius is the touch of the pen.
            let pen = if call.has("radius") { DEFAULT_PEN } else { call.positive("pen", Some(DEFAULT_PEN))? };
            let radius = call.positive("radius", Some(pen / 2.0));
            let hatch = hatch(call, radius.map_or(pen, |radius| radius * 2.0));
            let pitch = hatch.map_or(pen, |hatch| hatch.pitch);
            let spacing = call.positive("spacing", Some(pitch));
            fill(call, FillKind::Dots { hatch: hatch?, spacing: spacing?, radius: radius? })
        },
    },
    Signature {
        name: "solid",
        result: Some(Kind::Fill),
        params: &[INK, PEN],
        build: |call| {
            call.positive("pen", Some(DEFAULT_PEN))?;
            fill(call, FillKind::Solid)
        },
    },
];

fn fill(call: &Call<'_, '_, '_>, kind: FillKind) -> Option<Value> {
    let ink = match call.value("ink") {
        Some(Value::Colour(ink)) => Some(ink),
        _ => None,
    };
    Some(Value::Fill(Rc::new(Fill { kind, ink })))
}

fn hatch(call: &mut Call<'_, '_, '_>, pen: Length) -> Option<Hatch> {
    // Arguments are all looked at before any is given up, so that each one's mistake is told.
    let pitch = call.positive("pitch", None);
    let pen = call.positive("pen", Some(pen));
    let inset = call.within("inset", 0.0, f64::INFINITY, 0.5);
    // Shorter than two pens a stroke is a crumb rather than a line.
    let shortest = call.not_negative("shortest", pen.unwrap_or(DEFAULT_PEN) * 2.0);
    let cap = match call.word("cap") {
        Some("round") => Cap::Round,
        _ => Cap::Butt,
    };
    Some(Hatch { pitch: pitch?, pen: pen?, inset: inset?, shortest: shortest?, cap })
}
