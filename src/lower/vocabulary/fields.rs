//! Fields.

use crate::field::{Field, Function, Noise};
use crate::geom::{Angle, Point, Rect};
use crate::random::Key;

use super::super::call::{Call, Signature, later, optional, required};
use super::super::convert::Slot;
use super::super::files;
use super::super::ops::{self, Operand};
use super::super::value::{FieldUnit, Kind, Value};
use super::field;
use crate::diag::{Code, Diagnostic};

const ANY: Slot = Slot::ANY;
const POINT: Slot = Slot::of(Kind::Point);
const NUMBER: Slot = Slot::of(Kind::Number);

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "linear",
        result: Some(Kind::Field),
        params: &[
            optional("from", POINT),
            optional("to", POINT),
            required("start", ANY),
            required("end", ANY),
            optional("across", Slot::of(Kind::Region)),
            optional("angle", Slot::of(Kind::Angle)),
        ],
        build: linear,
    },
    Signature {
        name: "radial",
        result: Some(Kind::Field),
        params: &[
            required("center", POINT),
            required("radius", Slot::of(Kind::Length)),
            required("start", ANY),
            required("end", ANY),
        ],
        build: |call| {
            let centre = call.point("center")?;
            let radius = call.positive("radius", None)?;
            let (start, end, unit) = ends(call)?;
            field(Field::radial(centre, radius, start, end), unit)
        },
    },
    Signature {
        name: "noise",
        result: Some(Kind::Field),
        params: &[required("scale", Slot::of(Kind::Length)), optional("seed", NUMBER), optional("octaves", NUMBER)],
        build: noise,
    },
    Signature {
        name: "image",
        result: Some(Kind::Field),
        params: &[
            required("file", Slot::of(Kind::String)),
            required("fit", Slot::of(Kind::Box)),
            optional("channel", Slot::words(&["luminance", "red", "green", "blue", "alpha"])),
            later("gamma"),
            later("levels"),
            later("invert"),
            later("blur"),
        ],
        build: |call| {
            let fit = call.area("fit")?;
            let channel = call.word("channel").unwrap_or("luminance");
            let image = files::image(call, channel)?;
            field(Field::image(image, fit), FieldUnit::Number)
        },
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

/// `start` and `end`, brought to one unit.
fn ends(call: &mut Call<'_, '_, '_>) -> Option<(f64, f64, FieldUnit)> {
    let (start, end) = (call.value("start")?, call.value("end")?);
    let operands = match (Operand::of(&start), Operand::of(&end)) {
        (Some(a), Some(b)) => ops::agree(call.cx, a, b),
        _ => None,
    };
    let settled = operands.and_then(|(a, b, unit)| Some((a.value().number()?, b.value().number()?, unit)));
    if settled.is_none() {
        let message = format!("a field goes from number to number, not {} to {}", start.describe(), end.describe());
        let span = call.span_of("start").to(call.span_of("end"));
        call.cx.report(Diagnostic::error(Code::Type, span, message).hint("both are numbers, lengths or angles"));
    }
    settled
}

fn linear(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let (start, end, unit) = ends(call)?;
    if call.has("across") {
        for name in ["from", "to"] {
            if call.has(name) {
                let message = format!("`{name}` does not go with `across`");
                call.cx.report(Diagnostic::error(Code::Type, call.span_of(name), message));
                return None;
            }
        }
        let bounds: Rect = call.region("across")?.bounds();
        let angle = call.angle("angle").unwrap_or(Angle::ZERO);
        return field(Field::linear_across(bounds, angle, start, end), unit);
    }
    if call.has("angle") {
        let message = "`angle` goes with `across: region`";
        call.cx.report(Diagnostic::error(Code::Type, call.span_of("angle"), message));
        return None;
    }
    let (from, to): (Option<Point>, Option<Point>) = (call.point("from"), call.point("to"));
    let (Some(from), Some(to)) = (from, to) else {
        let message = "`linear` needs `from` and `to`, or `across`";
        call.cx.report(Diagnostic::error(Code::Missing, call.span, message));
        return None;
    };
    if from == to {
        return call.refuse("to", "`from` and `to` are the same point".to_owned());
    }
    field(Field::linear(from, to, start, end), unit)
}

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
