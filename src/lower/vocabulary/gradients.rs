//! Gradients: from one value to another, or over stops, evenly or eased.

use crate::diag::{Code, Diagnostic};
use crate::field::{Ease, Field, Ramp, Stop};
use crate::geom::{Angle, Point, Rect};
use crate::span::Span;

use super::super::call::Call;
use super::super::convert::Slot;
use super::super::ops::{self, Operand};
use super::super::value::{FieldUnit, Value};
use super::field;

/// How a gradient may ease.
pub(super) const EASE: Slot = Slot::words(&["linear", "in", "out", "in_out"]);

/// The values along a gradient.
enum Course {
    /// From one to the other, evenly.
    Even(f64, f64),
    Ramp(Ramp),
}

impl Course {
    /// The field, from the one that `between` makes of the values at both ends.
    fn over(self, between: impl FnOnce(f64, f64) -> Field) -> Field {
        match self {
            Self::Even(start, end) => between(start, end),
            Self::Ramp(ramp) => between(0.0, 1.0).ramp(ramp),
        }
    }
}

/// `start` and `end` or `stops`, with the unit of their values.
fn course(call: &mut Call<'_, '_, '_>) -> Option<(Course, FieldUnit)> {
    let ease = match call.word("ease") {
        Some("in") => Ease::In,
        Some("out") => Ease::Out,
        Some("in_out") => Ease::InOut,
        _ => Ease::Linear,
    };
    if !call.has("stops") {
        let (start, end, unit) = ends(call)?;
        if ease == Ease::Linear {
            return Some((Course::Even(start, end), unit));
        }
        let stops = vec![Stop { at: 0.0, value: start }, Stop { at: 1.0, value: end }];
        return Some((Course::Ramp(Ramp { stops, ease }), unit));
    }
    for name in ["start", "end"] {
        if call.has(name) {
            let message = format!("`{name}` does not go with `stops`");
            let hint = "the first and the last stop are the ends";
            call.cx.report(Diagnostic::error(Code::Type, call.span_of(name), message).hint(hint));
            return None;
        }
    }
    let (stops, unit) = stops(call)?;
    Some((Course::Ramp(Ramp { stops, ease }), unit))
}

/// `start` and `end`, brought to one unit.
fn ends(call: &mut Call<'_, '_, '_>) -> Option<(f64, f64, FieldUnit)> {
    for name in ["start", "end"] {
        if !call.has(name) {
            let message = format!("`{}` needs `{name}`", call.signature.name);
            let hint = "`start` and `end`, or `stops: [(0, 1), (0.4, 3), (1, 4)]`";
            call.cx.report(Diagnostic::error(Code::Missing, call.span, message).hint(hint));
            return None;
        }
    }
    let (start, end) = (call.value("start")?, call.value("end")?);
    let settled = settled(call, &start, &end);
    if settled.is_none() {
        let message = format!("a field goes from number to number, not {} to {}", start.describe(), end.describe());
        let span = call.span_of("start").to(call.span_of("end"));
        call.cx.report(Diagnostic::error(Code::Type, span, message).hint("both are numbers, lengths or angles"));
    }
    settled
}

/// Two values of one unit, a plain number beside a length in canvas units.
fn settled(call: &Call<'_, '_, '_>, a: &Value, b: &Value) -> Option<(f64, f64, FieldUnit)> {
    let (a, b, unit) = ops::agree(call.cx, Operand::of(a)?, Operand::of(b)?)?;
    Some((a.value().number()?, b.value().number()?, unit))
}

/// The stops of `stops`.
fn stops(call: &mut Call<'_, '_, '_>) -> Option<(Vec<Stop>, FieldUnit)> {
    let Some(Value::List(members)) = call.value("stops") else { return None };
    let span = call.span_of("stops");
    if members.len() < 2 {
        return refuse(call, span, Code::Range, "`stops` needs at least two stops".to_owned());
    }
    let mut pairs = Vec::with_capacity(members.len());
    for member in members.iter() {
        let pair = match member {
            Value::Tuple(pair) => match &**pair {
                [Value::Number(at) | Value::Percent(at), value] => Some((*at, value)),
                _ => None,
            },
            _ => None,
        };
        let Some((at, value)) = pair else {
            let message = format!("a stop is a pair of a place and a value, not {}", member.text());
            return refuse(call, span, Code::Type, message);
        };
        if !(0.0..=1.0).contains(&at) {
            let message = format!("the place of a stop must lie between 0 and 1, and one lies at {at}");
            return refuse(call, span, Code::Range, message);
        }
        match pairs.last() {
            Some(&(before, _)) if before > at => {
                let message = format!("the stop at {at} stands behind the one at {before}");
                return refuse(call, span, Code::Range, message);
            }
            _ => pairs.push((at, value)),
        }
    }
    // One length makes lengths of plain numbers, so each is held against all.
    let mut measure = pairs[0].1;
    for (_, value) in &pairs {
        match settled(call, measure, value) {
            Some((_, _, unit)) if Operand::of(value).is_some_and(|operand| operand.unit() == unit) => measure = value,
            Some(_) => {}
            None => {
                let message =
                    format!("a field goes from number to number, not {} to {}", measure.describe(), value.describe());
                return refuse(call, span, Code::Type, message);
            }
        }
    }
    let mut stops = Vec::with_capacity(pairs.len());
    let mut of = FieldUnit::Number;
    for (at, value) in pairs {
        let (_, value, unit) = settled(call, measure, value)?;
        of = unit;
        stops.push(Stop { at, value });
    }
    Some((stops, of))
}

fn refuse<T>(call: &mut Call<'_, '_, '_>, span: Span, code: Code, message: String) -> Option<T> {
    let hint = "places from 0 to 1 in order, each with a value: `[(0, 1), (0.4, 3), (1, 4)]`";
    let diagnostic = Diagnostic::error(code, span, message).hint(hint);
    if code == Code::Range {
        call.cx.report_value(diagnostic)
    } else {
        call.cx.report(diagnostic)
    }
    None
}

pub(super) fn radial(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let centre = call.point("center")?;
    let radius = call.positive("radius", None)?;
    let (course, unit) = course(call)?;
    field(course.over(|start, end| Field::radial(centre, radius, start, end)), unit)
}

pub(super) fn linear(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let (course, unit) = course(call)?;
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
        return field(course.over(|start, end| Field::linear_across(bounds, angle, start, end)), unit);
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
    field(course.over(|start, end| Field::linear(from, to, start, end)), unit)
}
