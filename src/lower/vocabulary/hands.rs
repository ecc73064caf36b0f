//! How unevenly strokes are drawn.

use crate::diag::{Code, Diagnostic};
use crate::geom::{Angle, Length};
use crate::scene::Hand;

use super::super::call::{Call, Signature, optional};
use super::super::convert::Slot;
use super::super::value::{Kind, Value};

const ANGLE: Slot = Slot::of(Kind::Angle);
const LENGTH: Slot = Slot::of(Kind::Length);
const SHARE: Slot = Slot::of(Kind::Percentage);

/// The hand of someone who has done this for years: what `hand()` stands for.
const STEADY_DEGREES: f64 = 2.0;
const STEADY: Hand = Hand {
    angle: Angle::ZERO,
    spacing: 0.08,
    pen: 0.08,
    taper: 0.2,
    overshoot: Length::mm(0.15),
    wobble: Length::mm(0.04),
};

/// A bundle turned further lies nearer to the direction of another layer than to its own.
const MOST_DEGREES: f64 = 45.0;

/// No tile is as large: beyond that a length is a slip.
const MOST_MM: f64 = 100.0;

pub(super) const SIGNATURES: &[Signature] = &[Signature {
    name: "hand",
    about: "How unevenly strokes are drawn; `hand()` is the hand of a professional, and what is not given is 0.",
    result: Some(Kind::Hand),
    params: &[
        optional("angle", ANGLE, "0deg", "bundles are turned by up to this, 0 to 45deg"),
        optional("spacing", SHARE, "0%", "lines lie off by up to this share of a step, 0 to 50%"),
        optional("pen", SHARE, "0%", "strokes are thinner or wider by up to this share, 0 to 90%"),
        optional("taper", SHARE, "0%", "strokes run out over up to this share of their length, 0 to 100%"),
        optional("overshoot", LENGTH, "0mm", "strokes end beyond the tile's edge by up to this, at most 100mm"),
        optional("wobble", LENGTH, "0mm", "strokes wander to either side by up to this, at most 100mm"),
    ],
    build: |call| {
        if call.signature.params.iter().all(|param| !call.has(param.name)) {
            return Some(Value::Hand(Hand { angle: Angle::degrees(STEADY_DEGREES), ..STEADY }));
        }
        // Arguments are all looked at before any is given up, so that each one's mistake is told.
        let angle = angle(call);
        // Lines that stray by more than half a step may change places.
        let spacing = share(call, "spacing", 0.5);
        // A stroke has some width.
        let pen = share(call, "pen", 0.9);
        let taper = share(call, "taper", 1.0);
        let overshoot = length(call, "overshoot");
        let wobble = length(call, "wobble");
        Some(Value::Hand(Hand {
            angle: angle?,
            spacing: spacing?,
            pen: pen?,
            taper: taper?,
            overshoot: overshoot?,
            wobble: wobble?,
        }))
    },
}];

fn angle(call: &mut Call<'_, '_, '_>) -> Option<Angle> {
    let angle = call.angle("angle").unwrap_or(Angle::ZERO);
    if angle >= Angle::ZERO && angle <= Angle::degrees(MOST_DEGREES) {
        return Some(angle);
    }
    call.refuse("angle", format!("`angle` must lie between 0deg and {MOST_DEGREES}deg"))
}

fn share(call: &mut Call<'_, '_, '_>, name: &str, most: f64) -> Option<f64> {
    let share = call.number(name).unwrap_or(0.0);
    if (0.0..=most).contains(&share) {
        return Some(share);
    }
    let message = format!("`{name}` must lie between 0% and {}%", most * 100.0);
    let diagnostic = Diagnostic::error(Code::Range, call.span_of(name), message);
    // A number without its sign is many times too much.
    let is_per_cent = share > 2.0 && share <= most * 100.0;
    call.cx.report_value(
        diagnostic.maybe_hint(is_per_cent.then(|| format!("a share is written in per cent: `{share}%`"))),
    );
    None
}

fn length(call: &mut Call<'_, '_, '_>, name: &str) -> Option<Length> {
    let length = call.not_negative(name, Length::ZERO)?;
    if length <= Length::mm(MOST_MM) {
        return Some(length);
    }
    call.refuse(name, format!("`{name}` must be at most {MOST_MM}mm"))
}
