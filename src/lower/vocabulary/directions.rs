//! Fields of what other fields do: the directions in which they change, and their values in bands.

use crate::diag::{Code, Diagnostic};
use crate::field::{Field, Sense, Steps, sample_distance};
use crate::geom::Length;

use super::super::call::Call;
use super::super::files;
use super::super::ops::Operand;
use super::super::value::{FieldUnit, TypedField, Value};
use super::field;

/// The window that directions are averaged over, where none is given: a few strokes wide.
const SCALE: Length = Length::mm(2.0);

/// Most bands of a field.
const MOST_STEPS: u32 = 256;

/// `flow`: along the gradient of a field, or along the edge of a region.
pub(super) fn flow(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    match call.value("of")? {
        // With a scale the edge is that of the distance, whose level lines run along it.
        Value::Region(region) if call.has("scale") => directed(call, Field::distance(region), Sense::Level),
        Value::Region(region) => field(Field::tangent(region), FieldUnit::Angle),
        Value::Field(of) => checked(call, of, Sense::Gradient),
        other => refuse(call, "a field, such as an image, or a region", &other),
    }
}

/// `contour`: along the level lines of a field.
pub(super) fn contour(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    match call.value("of")? {
        Value::Field(of) => checked(call, of, Sense::Level),
        other => refuse(call, "a field, such as an image", &other),
    }
}

fn refuse(call: &mut Call<'_, '_, '_>, wanted: &str, found: &Value) -> Option<Value> {
    let message = format!("`{}` takes {wanted}, not {}", call.signature.name, found.describe());
    let hint = match found {
        Value::Region(_) => Some("`flow(region)` runs along the edge of a region"),
        Value::Field(_) => Some("`if … then 1 else 0` makes numbers of a condition"),
        _ => Operand::of(found).map(|_| "what is the same everywhere has no direction"),
    };
    let diagnostic = Diagnostic::error(Code::Type, call.span_of("of"), message);
    call.cx.report(diagnostic.maybe_hint(hint.map(str::to_owned)));
    None
}

fn checked(call: &mut Call<'_, '_, '_>, of: TypedField, sense: Sense) -> Option<Value> {
    if of.unit == FieldUnit::Bool {
        return refuse(call, "a field of numbers, lengths or angles", &Value::Field(of));
    }
    directed(call, of.field, sense)
}

fn directed(call: &mut Call<'_, '_, '_>, of: Field, sense: Sense) -> Option<Value> {
    let scale = call.positive("scale", Some(SCALE))?;
    // What is finer than the samples are apart would be seen by chance.
    let of = files::smoothed(call, "of", &of, sample_distance(scale) / 2.0)?;
    field(of.direction(scale, sense), FieldUnit::Angle)
}

/// `steps`: a field in bands.
pub(super) fn steps(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let value = call.value("field")?;
    let TypedField { field: of, unit } = match (&value, value.number(), Operand::of(&value).map(|of| of.unit())) {
        (Value::Field(of), ..) if of.unit != FieldUnit::Bool => of.clone(),
        (_, Some(number), Some(unit)) => TypedField { field: Field::constant(number), unit },
        _ => {
            let message = format!("`steps` takes a field of numbers, lengths or angles, not {}", value.describe());
            call.cx.report(Diagnostic::error(Code::Type, call.span_of("field"), message));
            return None;
        }
    };
    if call.has("at") {
        return at_bounds(call, of, unit);
    }
    if !call.has("count") {
        let message = "`steps` needs `count`, or `at` with the bounds between bands";
        call.cx.report(Diagnostic::error(Code::Missing, call.span, message));
        return None;
    }
    let count = call.whole("count", 2, MOST_STEPS, None)?;
    let (start, end) = (level(call, "start", unit, 0.0)?, level(call, "end", unit, 1.0)?);
    if start >= end {
        return call.refuse("end", "`end` must be greater than `start`".to_owned());
    }
    field(of.steps(Steps::even(count, start, end)), unit)
}

/// Bands with bounds that are given. Their values need not be of the field's unit.
fn at_bounds(call: &mut Call<'_, '_, '_>, of: Field, unit: FieldUnit) -> Option<Value> {
    if call.has("count") {
        let message = "`count` does not go with `at`, whose bounds make one band more than there are";
        call.cx.report(Diagnostic::error(Code::Type, call.span_of("count"), message));
        return None;
    }
    let Some(Value::List(members)) = call.value("at") else { return None };
    let mut bounds: Vec<f64> = Vec::with_capacity(members.len());
    for member in members.iter() {
        let Some(bound) = in_unit(call, member, unit) else {
            let message = format!("the bounds of {} cannot be {}", unit.noun(), member.describe());
            call.cx.report(Diagnostic::error(Code::Unit, call.span_of("at"), message));
            return None;
        };
        bounds.push(bound);
    }
    if bounds.is_empty() || bounds.len() >= MOST_STEPS as usize {
        return call.refuse("at", format!("`at` needs 1 to {} bounds", MOST_STEPS - 1));
    }
    if !bounds.is_sorted_by(|a, b| a < b) {
        return call.refuse("at", "the bounds of `at` must stand in order, each above the one before".to_owned());
    }
    let of_values = ["start", "end"].into_iter().find_map(|name| Operand::of(&call.value(name)?));
    let values = of_values.map_or(FieldUnit::Number, |operand| operand.unit());
    let (start, end) = (level(call, "start", values, 0.0)?, level(call, "end", values, 1.0)?);
    field(of.steps(Steps { bounds, start, end }), values)
}

/// The value of the first or the last band, in the unit of the field.
fn level(call: &mut Call<'_, '_, '_>, name: &str, unit: FieldUnit, default: f64) -> Option<f64> {
    let Some(value) = call.value(name) else {
        if unit == FieldUnit::Number {
            return Some(default);
        }
        let message = format!("`steps` needs `{name}` for {}", unit.noun());
        call.cx.report(Diagnostic::error(Code::Missing, call.span, message));
        return None;
    };
    let level = in_unit(call, &value, unit);
    if level.is_none() {
        let message = format!("`{name}` cannot be {} for {}", value.describe(), unit.noun());
        call.cx.report(Diagnostic::error(Code::Unit, call.span_of(name), message));
    }
    level
}

/// A plain value in the unit of a field; a bare number is a length in canvas units.
fn in_unit(call: &Call<'_, '_, '_>, value: &Value, unit: FieldUnit) -> Option<f64> {
    let number = value.number()?;
    match (Operand::of(value)?.unit(), unit) {
        (from, to) if from == to => Some(number),
        (FieldUnit::Number, FieldUnit::Length) => Some(number * call.cx.unit),
        (FieldUnit::Number, FieldUnit::Angle) if number == 0.0 => Some(number),
        _ => None,
    }
}
