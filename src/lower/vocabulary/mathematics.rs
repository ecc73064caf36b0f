//! The usual mathematics, on numbers and, where it makes sense, on lengths, angles and fields.

use crate::field::{Function, Operator};

use super::super::call::{Call, Signature, required};
use super::super::convert::Slot;
use super::super::ops::{self, Operand};
use super::super::value::{FieldUnit, Kind, Value};
use crate::diag::{Code, Diagnostic};

const ANY: Slot = Slot::ANY;
/// Operands of functions may be fields, and so may use `x` and `y`.
const A: &[super::super::call::Param] = &[required("a", ANY, "a value, or a field of values")];
const AB: &[super::super::call::Param] =
    &[required("a", ANY, "a value, or a field of values"), required("b", ANY, "another of the same unit")];

/// A function that takes and yields plain numbers.
macro_rules! plain {
    ($name:literal, $about:literal, $function:expr) => {
        Signature {
            name: $name,
            about: $about,
            result: None,
            params: A,
            build: |call| one(call, $function, Takes::Number),
        }
    };
}

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "sin",
        about: "The sine of an angle, or of a number of radians.",
        result: None,
        params: A,
        build: |call| one(call, Function::Sin, Takes::Angle),
    },
    Signature {
        name: "cos",
        about: "The cosine of an angle, or of a number of radians.",
        result: None,
        params: A,
        build: |call| one(call, Function::Cos, Takes::Angle),
    },
    Signature {
        name: "tan",
        about: "The tangent of an angle, or of a number of radians.",
        result: None,
        params: A,
        build: |call| one(call, Function::Tan, Takes::Angle),
    },
    Signature {
        name: "asin",
        about: "The angle whose sine this is.",
        result: None,
        params: A,
        build: |call| one(call, Function::Asin, Takes::ToAngle),
    },
    Signature {
        name: "acos",
        about: "The angle whose cosine this is.",
        result: None,
        params: A,
        build: |call| one(call, Function::Acos, Takes::ToAngle),
    },
    Signature {
        name: "atan",
        about: "The angle whose tangent this is.",
        result: None,
        params: A,
        build: |call| one(call, Function::Atan, Takes::ToAngle),
    },
    Signature {
        name: "abs",
        about: "The size of a number, length or angle, without its sign.",
        result: None,
        params: A,
        build: |call| one(call, Function::Abs, Takes::Any),
    },
    plain!("sqrt", "The square root of a number.", Function::Sqrt),
    plain!("exp", "e to the power of a number.", Function::Exp),
    plain!("ln", "The natural logarithm of a number.", Function::Ln),
    plain!("floor", "The greatest whole number that is not above.", Function::Floor),
    plain!("ceil", "The least whole number that is not below.", Function::Ceil),
    plain!("round", "The nearest whole number; halves go up.", Function::Round),
    plain!("sign", "-1, 0 or 1.", Function::Sign),
    Signature {
        name: "atan2",
        about: "The angle of the way (x, y).",
        result: None,
        params: &[required("y", ANY, "the way down"), required("x", ANY, "the way across, of the same unit")],
        build: atan2,
    },
    Signature {
        name: "min",
        about: "The lesser of two values of one unit.",
        result: None,
        params: AB,
        build: |call| two(call, Operator::Min),
    },
    Signature {
        name: "max",
        about: "The greater of two values of one unit.",
        result: None,
        params: AB,
        build: |call| two(call, Operator::Max),
    },
    Signature {
        name: "clamp",
        about: "A value held between two others.",
        result: None,
        params: &[
            required("value", ANY, "the value"),
            required("low", ANY, "the lower bound"),
            required("high", ANY, "the upper bound"),
        ],
        build: clamp,
    },
    Signature {
        name: "mix",
        about: "`a + (b - a) * share`.",
        result: None,
        params: &[
            required("a", ANY, "a value, or a field of values"),
            required("b", ANY, "another of the same unit"),
            required("share", ANY, "0 for `a`, 1 for `b`"),
        ],
        build: mix,
    },
    Signature {
        name: "step",
        about: "0 below the edge, 1 from there on.",
        result: None,
        params: &[required("edge", ANY, "from where on it is 1"), required("value", ANY, "the value")],
        build: |call| {
            let (edge, value, _) = pair(call, "edge", "value")?;
            Some(ops::combine(edge, value, Operator::LessEqual, FieldUnit::Number).value())
        },
    },
    Signature {
        name: "smoothstep",
        about: "From 0 at `low` to 1 at `high`, smoothly.",
        result: None,
        params: &[
            required("low", ANY, "the lower bound"),
            required("high", ANY, "the upper bound"),
            required("value", ANY, "the value"),
        ],
        build: smoothstep,
    },
    Signature {
        name: "len",
        about: "How many members a list has.",
        result: Some(Kind::Number),
        params: &[required("list", Slot::of(Kind::List), "the list")],
        build: |call| match call.value("list")? {
            Value::List(members) => Some(Value::Number(members.len() as f64)),
            _ => None,
        },
    },
];

/// What a function of one value takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Takes {
    /// A number, and yields one.
    Number,
    /// An angle, or a number of radians, and yields a number.
    Angle,
    /// A number, and yields an angle.
    ToAngle,
    /// Anything with a unit, and keeps it.
    Any,
}

fn one(call: &mut Call<'_, '_, '_>, function: Function, takes: Takes) -> Option<Value> {
    let operand = operand(call, "a")?;
    let unit = operand.unit();
    let fits = match takes {
        Takes::Number | Takes::ToAngle => unit == FieldUnit::Number,
        Takes::Angle => matches!(unit, FieldUnit::Number | FieldUnit::Angle),
        Takes::Any => unit != FieldUnit::Bool,
    };
    if !fits {
        return unfit(call, "a");
    }
    let result = match takes {
        Takes::Number | Takes::Angle => FieldUnit::Number,
        Takes::ToAngle => FieldUnit::Angle,
        Takes::Any => unit,
    };
    if let Some(value) = call.number("a") {
        let outside = match function {
            Function::Sqrt => value < 0.0,
            Function::Ln => value <= 0.0,
            Function::Asin | Function::Acos => value.abs() > 1.0,
            _ => false,
        };
        if outside {
            return call.refuse("a", format!("`{}` has no value at {value}", call.signature.name));
        }
    }
    let result = ops::map(operand, function, result).value();
    if result.number().is_some_and(|value| !value.is_finite()) {
        return call.refuse("a", format!("`{}` of this is not a finite number", call.signature.name));
    }
    Some(result)
}

fn two(call: &mut Call<'_, '_, '_>, operator: Operator) -> Option<Value> {
    let (a, b, unit) = pair(call, "a", "b")?;
    Some(ops::combine(a, b, operator, unit).value())
}

fn atan2(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let (y, x, _) = pair(call, "y", "x")?;
    Some(ops::combine(y, x, Operator::Atan2, FieldUnit::Angle).value())
}

fn clamp(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let (value, low, _) = pair(call, "value", "low")?;
    let (_, high, unit) = pair(call, "value", "high")?;
    if let (Some(low), Some(high)) = (call.number("low"), call.number("high"))
        && low > high
    {
        return call.refuse("low", "`low` must not be greater than `high`".to_owned());
    }
    let raised = ops::combine(value, low, Operator::Max, unit);
    Some(ops::combine(raised, high, Operator::Min, unit).value())
}

/// `a + (b - a) * share`.
fn mix(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let (a, b, unit) = pair(call, "a", "b")?;
    let share = operand(call, "share")?;
    if share.unit() != FieldUnit::Number {
        return unfit(call, "share");
    }
    let way = ops::combine(b, a.clone(), Operator::Subtract, unit);
    let part = ops::combine(way, share, Operator::Multiply, unit);
    Some(ops::combine(a, part, Operator::Add, unit).value())
}

/// `t * t * (3 - 2 * t)` with t the place of the value between low and high, clamped to [0, 1].
fn smoothstep(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let (low, high, unit) = pair(call, "low", "high")?;
    let (value, _, _) = pair(call, "value", "low")?;
    if let (Some(a), Some(b)) = (call.number("low"), call.number("high"))
        && a == b
    {
        return call.refuse("high", "`low` and `high` must differ".to_owned());
    }
    let number = |value| Operand::constant(FieldUnit::Number, value);
    let plain = FieldUnit::Number;
    let way = ops::combine(high, low.clone(), Operator::Subtract, unit);
    let share = ops::combine(ops::combine(value, low, Operator::Subtract, unit), way, Operator::Divide, plain);
    let share = ops::combine(ops::combine(share, number(0.0), Operator::Max, plain), number(1.0), Operator::Min, plain);
    let square = ops::combine(share.clone(), share.clone(), Operator::Multiply, plain);
    let twice = ops::combine(share, number(2.0), Operator::Multiply, plain);
    let rest = ops::combine(number(3.0), twice, Operator::Subtract, plain);
    Some(ops::combine(square, rest, Operator::Multiply, plain).value())
}

fn operand(call: &mut Call<'_, '_, '_>, name: &str) -> Option<Operand> {
    let operand = Operand::of(&call.value(name)?);
    if operand.is_none() {
        return unfit(call, name);
    }
    operand
}

/// Two arguments brought to one unit.
fn pair(call: &mut Call<'_, '_, '_>, a: &str, b: &str) -> Option<(Operand, Operand, FieldUnit)> {
    let (x, y) = (operand(call, a)?, operand(call, b)?);
    let settled = ops::agree(call.cx, x, y).filter(|(_, _, unit)| *unit != FieldUnit::Bool);
    if settled.is_none() {
        let (left, right) = (call.value(a)?.describe(), call.value(b)?.describe());
        let message = format!("`{}` cannot take {left} and {right} together", call.signature.name);
        let span = call.span_of(a).to(call.span_of(b));
        call.cx.report(Diagnostic::error(Code::Unit, span, message).hint("both need the same unit"));
    }
    settled
}

fn unfit<T>(call: &mut Call<'_, '_, '_>, name: &str) -> Option<T> {
    let found = call.value(name)?.describe();
    let message = format!("`{}` does not take {found}", call.signature.name);
    let span = call.span_of(name);
    call.cx.report(Diagnostic::error(Code::Type, span, message));
    None
}
