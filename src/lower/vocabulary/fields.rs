//! Fields.

use crate::field::{Field, Function, Noise};
use crate::random::Key;

use super::super::call::{Call, Signature, optional, required};
use super::super::convert::Slot;
use super::super::ops::{self, Operand};
use super::super::value::{FieldUnit, Kind, Value};
use super::{directions, field, gradients, images};
use crate::diag::{Code, Diagnostic};

const ANY: Slot = Slot::ANY;
const POINT: Slot = Slot::of(Kind::Point);
const NUMBER: Slot = Slot::of(Kind::Number);
const LENGTH: Slot = Slot::of(Kind::Length);
const LIST: Slot = Slot::of(Kind::List);

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "linear",
        result: Some(Kind::Field),
        params: &[
            optional("from", POINT),
            optional("to", POINT),
            optional("start", ANY),
            optional("end", ANY),
            optional("across", Slot::of(Kind::Region)),
            optional("angle", Slot::of(Kind::Angle)),
            optional("stops", LIST),
            optional("ease", gradients::EASE),
        ],
        build: gradients::linear,
    },
    Signature {
        name: "radial",
        result: Some(Kind::Field),
        params: &[
            required("center", POINT),
            required("radius", LENGTH),
            optional("start", ANY),
            optional("end", ANY),
            optional("stops", LIST),
            optional("ease", gradients::EASE),
        ],
        build: gradients::radial,
    },
    Signature {
        name: "noise",
        result: Some(Kind::Field),
        params: &[required("scale", LENGTH), optional("seed", NUMBER), optional("octaves", NUMBER)],
        build: noise,
    },
    Signature {
        name: "image",
        result: Some(Kind::Field),
        params: &[
            required("file", Slot::of(Kind::String)),
            required("fit", Slot::of(Kind::Box)),
            optional("channel", Slot::words(&["luminance", "red", "green", "blue", "alpha"])),
            optional("gamma", NUMBER),
            optional("levels", Slot::of(Kind::Range)),
            optional("invert", Slot::of(Kind::Bool)),
            optional("blur", LENGTH),
        ],
        build: images::image,
    },
    Signature {
        name: "flow",
        result: Some(Kind::Field),
        params: &[required("of", ANY), optional("scale", LENGTH)],
        build: directions::flow,
    },
    Signature {
        name: "contour",
        result: Some(Kind::Field),
        params: &[required("of", ANY), optional("scale", LENGTH)],
        build: directions::contour,
    },
    Signature {
        name: "steps",
        result: Some(Kind::Field),
        params: &[
            required("field", ANY),
            optional("count", NUMBER),
            optional("start", ANY),
            optional("end", ANY),
            optional("at", LIST),
        ],
        build: directions::steps,
    },
    Signature {
        name: "lightness",
        result: None,
        params: &[required("field", ANY)],
        build: |call| {
            let value = call.value("field")?;
            match Operand::of(&value).filter(|operand| operand.unit() == FieldUnit::Number) {
                Some(operand) => Some(ops::map(operand, Function::Lightness, FieldUnit::Number).value()),
                None => {
                    let message = format!("`lightness` takes a luminance, not {}", value.describe());
                    call.cx.report(Diagnostic::error(Code::Type, call.span_of("field"), message));
                    None
                }
            }
        },
    },
    Signature {
        name: "distance",
        result: Some(Kind::Field),
        params: &[required("region", Slot::of(Kind::Region))],
        build: |call| field(Field::distance(call.region("region")?), FieldUnit::Length),
    },
];

fn noise(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let scale = call.positive("scale", None);
    let octaves = call.whole("octaves", 1, 16, Some(1));
    let seed = call.whole("seed", 0, u32::MAX, Some(0));
    let (scale, octaves, seed) = (scale?, octaves?, seed?);
    let seed = if call.has("seed") { u64::from(seed) } else { call.cx.seed };
    // A noise is keyed by the name it is declared under, so that adding one leaves the others as they were.
    let name = match call.cx.naming.last_mut() {
        Some((name, count)) => {
            *count += 1;
            if *count == 1 { name.clone() } else { format!("{name} {count}") }
        }
        None => String::new(),
    };
    let mut stream = Key { seed, name: &name, purpose: "noise" }.stream();
    let noise = Noise::new(scale, octaves, stream.below(u64::MAX));
    let noise = match call.cx.period {
        Some(period) => noise.repeating(period.width, period.height),
        None => noise,
    };
    field(Field::new(crate::field::Node::Noise(noise)), FieldUnit::Number)
}
