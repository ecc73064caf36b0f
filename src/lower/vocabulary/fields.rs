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
        about: "A gradient from `start` to `end`: between two points, or over the box of a region.",
        result: Some(Kind::Field),
        params: &[
            optional("from", POINT, "from across", "where the field is `start`"),
            optional("to", POINT, "from across", "where the field is `end`"),
            optional("start", ANY, "from stops", "the value at the beginning"),
            optional("end", ANY, "from stops", "the value at the end, of the same unit"),
            optional("across", Slot::of(Kind::Region), "from and to", "the region whose box the gradient spans"),
            optional("angle", Slot::of(Kind::Angle), "0deg", "direction across the region, 0 from left to right"),
            optional(
                "stops",
                LIST,
                "start and end",
                "pairs of a place from 0 to 1 and a value: `[(0, 1), (40%, 3), (1, 4)]`",
            ),
            optional("ease", gradients::EASE, "linear", "how each value passes into the next"),
        ],
        build: gradients::linear,
    },
    Signature {
        name: "radial",
        about: "A gradient from `start` in the centre to `end` at the radius.",
        result: Some(Kind::Field),
        params: &[
            required("center", POINT, "the middle"),
            required("radius", LENGTH, "where the field is `end`, above 0"),
            optional("start", ANY, "from stops", "the value at the beginning"),
            optional("end", ANY, "from stops", "the value at the end, of the same unit"),
            optional(
                "stops",
                LIST,
                "start and end",
                "pairs of a place from 0 to 1 and a value: `[(0, 1), (40%, 3), (1, 4)]`",
            ),
            optional("ease", gradients::EASE, "linear", "how each value passes into the next"),
        ],
        build: gradients::radial,
    },
    Signature {
        name: "noise",
        about: "Smooth noise from 0 to 1, keyed by the name it is declared under.",
        result: Some(Kind::Field),
        params: &[
            required("scale", LENGTH, "size of its features, above 0"),
            optional("seed", NUMBER, "the scene's", "a seed of its own"),
            optional("octaves", NUMBER, "1", "layers of ever finer noise, 1 to 16"),
        ],
        build: noise,
    },
    Signature {
        name: "image",
        about: "The light of a PNG or JPEG, 0 black to 1 white.",
        result: Some(Kind::Field),
        params: &[
            required("file", Slot::of(Kind::String), "path from the folder of this file"),
            required("fit", Slot::of(Kind::Box), "the box that the image is fitted into, as large as can be"),
            optional(
                "channel",
                Slot::words(&["luminance", "red", "green", "blue", "alpha"]),
                "luminance",
                "what is read of the image",
            ),
            optional("gamma", NUMBER, "1", "the light to the power of 1 / gamma, 0.1 to 10"),
            optional("levels", Slot::of(Kind::Range), "0 .. 1", "what becomes black and what white, both from 0 to 1"),
            optional("invert", Slot::of(Kind::Bool), "false", "1 less the light"),
            optional("blur", LENGTH, "0mm", "standard deviation of a Gaussian on the page, not negative"),
        ],
        build: images::image,
    },
    Signature {
        name: "flow",
        about: "Angles along the gradient of a field, or along the edge of a region.",
        result: Some(Kind::Field),
        params: &[
            required("of", ANY, "a field, or a region whose edge is followed"),
            optional("scale", LENGTH, "2mm", "radius of the window that is looked at, above 0"),
        ],
        build: directions::flow,
    },
    Signature {
        name: "contour",
        about: "Angles along the level lines of a field.",
        result: Some(Kind::Field),
        params: &[
            required("of", ANY, "a field"),
            optional("scale", LENGTH, "2mm", "radius of the window that is looked at, above 0"),
        ],
        build: directions::contour,
    },
    Signature {
        name: "steps",
        about: "A field in bands, each of one value.",
        result: Some(Kind::Field),
        params: &[
            required("field", ANY, "the field that is cut into bands"),
            optional("count", NUMBER, "from at", "how many bands, 2 to 256"),
            optional("start", ANY, "0", "value of the first band"),
            optional("end", ANY, "1", "value of the last band"),
            optional("at", LIST, "from count", "the bounds between bands, in order"),
        ],
        build: directions::steps,
    },
    Signature {
        name: "lightness",
        about: "How light a linear luminance looks: L* / 100 (CIE 1976).",
        result: None,
        params: &[required("field", ANY, "a linear luminance, as `image` gives")],
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
        about: "The distance to a region's outline as a length, positive inside.",
        result: Some(Kind::Field),
        params: &[required("region", Slot::of(Kind::Region), "the region")],
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
