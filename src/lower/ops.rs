//! Operators and functions on numbers, lengths, angles and fields of them, and on regions.

use crate::diag::{Code, Diagnostic};
use crate::field::{Field, Function, Node, Operator};
use crate::region::Operation;
use crate::span::Span;
use crate::syntax::ast::{BinaryOp, UnaryOp};

use super::cx::Cx;
use super::files::SIMPLIFY;
use super::value::{FieldUnit, Kind, TypedField, Value};

/// An operand that can be reckoned with.
#[derive(Debug, Clone)]
pub(super) struct Operand {
    unit: FieldUnit,
    amount: Amount,
}

#[derive(Debug, Clone)]
enum Amount {
    One(f64),
    Varying(Field),
    /// Only its kind is known.
    Unknown,
    /// A field of which not even the unit is known.
    UnknownField,
}

impl Operand {
    /// Of a value that is a number, length, angle, percentage, field, or unknown one of these.
    pub(super) fn of(value: &Value) -> Option<Self> {
        let (unit, amount) = match value {
            Value::Number(n) | Value::Percent(n) => (FieldUnit::Number, Amount::One(*n)),
            Value::Length(mm) => (FieldUnit::Length, Amount::One(*mm)),
            Value::Angle(radians) => (FieldUnit::Angle, Amount::One(*radians)),
            Value::Bool(truth) => (FieldUnit::Bool, Amount::One(f64::from(u8::from(*truth)))),
            Value::Field(TypedField { field, unit }) => (*unit, Amount::Varying(field.clone())),
            Value::Unknown(Some(kind)) => match kind {
                Kind::Number | Kind::Percentage => (FieldUnit::Number, Amount::Unknown),
                Kind::Length => (FieldUnit::Length, Amount::Unknown),
                Kind::Angle => (FieldUnit::Angle, Amount::Unknown),
                Kind::Bool => (FieldUnit::Bool, Amount::Unknown),
                Kind::Field => (FieldUnit::Number, Amount::UnknownField),
                _ => return None,
            },
            _ => return None,
        };
        Some(Self { unit, amount })
    }

    pub(super) fn unit(&self) -> FieldUnit {
        self.unit
    }

    fn with_unit(self, unit: FieldUnit) -> Self {
        Self { unit, ..self }
    }

    fn is_unknown_field(&self) -> bool {
        matches!(self.amount, Amount::UnknownField)
    }

    /// A plain number beside a length becomes a length in canvas units.
    fn scaled(self, unit: f64) -> Self {
        if unit == 1.0 {
            return self.with_unit(FieldUnit::Length);
        }
        let amount = match self.amount {
            Amount::One(n) => Amount::One(n * unit),
            Amount::Varying(field) => Amount::Varying(zip(field, Field::constant(unit), Operator::Multiply)),
            unknown => unknown,
        };
        Self { unit: FieldUnit::Length, amount }
    }

    pub(super) fn value(self) -> Value {
        match (self.amount, self.unit) {
            (Amount::One(n), FieldUnit::Number) => Value::Number(n),
            (Amount::One(n), FieldUnit::Length) => Value::Length(n),
            (Amount::One(n), FieldUnit::Angle) => Value::Angle(n),
            (Amount::One(n), FieldUnit::Bool) => Value::Bool(n != 0.0),
            (Amount::Varying(field), unit) => Value::Field(TypedField { field, unit }),
            (Amount::UnknownField, _) => Value::Unknown(Some(Kind::Field)),
            (Amount::Unknown, unit) => Value::Unknown(Some(match unit {
                FieldUnit::Number => Kind::Number,
                FieldUnit::Length => Kind::Length,
                FieldUnit::Angle => Kind::Angle,
                FieldUnit::Bool => Kind::Bool,
            })),
        }
    }

    fn field(self) -> Option<Field> {
        match self.amount {
            Amount::One(n) => Some(Field::constant(n)),
            Amount::Varying(field) => Some(field),
            Amount::Unknown | Amount::UnknownField => None,
        }
    }

    pub(super) fn constant(unit: FieldUnit, value: f64) -> Self {
        Self { unit, amount: Amount::One(value) }
    }
}

fn zip(a: Field, b: Field, operator: Operator) -> Field {
    Field::new(Node::Binary(operator, a, b))
}

/// A function of one operand that yields `unit`.
pub(super) fn map(operand: Operand, function: Function, unit: FieldUnit) -> Operand {
    let amount = match operand.amount {
        Amount::One(n) => Amount::One(function.apply(n)),
        Amount::Varying(field) => Amount::Varying(Field::new(Node::Unary(function, field))),
        unknown => unknown,
    };
    Operand { unit, amount }
}

/// An operator on two operands whose units were settled, yielding `unit`.
pub(super) fn combine(a: Operand, b: Operand, operator: Operator, unit: FieldUnit) -> Operand {
    let amount = match (a.amount, b.amount) {
        (Amount::One(a), Amount::One(b)) => Amount::One(operator.apply(a, b)),
        (Amount::UnknownField, _) | (_, Amount::UnknownField) => Amount::UnknownField,
        (Amount::Unknown, Amount::Varying(_)) | (Amount::Varying(_), Amount::Unknown) => Amount::UnknownField,
        (Amount::Unknown, _) | (_, Amount::Unknown) => Amount::Unknown,
        (Amount::One(a), Amount::Varying(b)) => Amount::Varying(zip(Field::constant(a), b, operator)),
        (Amount::Varying(a), Amount::One(b)) => Amount::Varying(zip(a, Field::constant(b), operator)),
        (Amount::Varying(a), Amount::Varying(b)) => Amount::Varying(zip(a, b, operator)),
    };
    Operand { unit, amount }
}

/// Brings two operands to one unit: a plain number beside a length is one in canvas units. `None` where they do not go
/// together.
pub(super) fn agree(cx: &Cx<'_, '_>, a: Operand, b: Operand) -> Option<(Operand, Operand, FieldUnit)> {
    let unit = cx.unit;
    Some(match (a.unit, b.unit) {
        (x, y) if x == y => (a, b, x),
        (_, y) if a.is_unknown_field() => (a, b, y),
        (x, _) if b.is_unknown_field() => (a, b, x),
        (FieldUnit::Number, FieldUnit::Length) => (a.scaled(unit), b, FieldUnit::Length),
        (FieldUnit::Length, FieldUnit::Number) => (a, b.scaled(unit), FieldUnit::Length),
        _ => return None,
    })
}

/// `a op b`.
pub(super) fn binary(
    cx: &mut Cx<'_, '_>,
    op: BinaryOp,
    (a, a_span): (Value, Span),
    (b, b_span): (Value, Span),
) -> Value {
    let span = a_span.to(b_span);
    match op {
        BinaryOp::And | BinaryOp::Or => logic(cx, op, (a, a_span), (b, b_span)),
        BinaryOp::Equal | BinaryOp::NotEqual => equality(cx, op, a, b, span),
        BinaryOp::Less | BinaryOp::LessEqual | BinaryOp::Greater | BinaryOp::GreaterEqual => order(cx, op, a, b, span),
        BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Intersect if is_region(&a) || is_region(&b) => {
            regions(cx, op, a, b, span)
        }
        BinaryOp::Intersect => {
            if !matches!((&a, &b), (Value::Unknown(None), _) | (_, Value::Unknown(None))) {
                let message = format!("`&` joins regions, not {} and {}", a.describe(), b.describe());
                cx.report(Diagnostic::error(Code::Type, span, message).hint("conditions are joined by `and`"));
            }
            Value::Unknown(Some(Kind::Region))
        }
        _ => arithmetic(cx, op, a, b, (b_span, span)),
    }
}

fn is_region(value: &Value) -> bool {
    matches!(value, Value::Region(_) | Value::Unknown(Some(Kind::Region)))
}

fn regions(cx: &mut Cx<'_, '_>, op: BinaryOp, a: Value, b: Value, span: Span) -> Value {
    let (Value::Region(left), Value::Region(right)) = (&a, &b) else {
        if !matches!((&a, &b), (Value::Unknown(_), _) | (_, Value::Unknown(_))) || (!is_region(&a) && !is_region(&b)) {
            let message = format!("`{}` cannot join {} and {}", op.symbol(), a.describe(), b.describe());
            cx.report(Diagnostic::error(Code::Type, span, message));
        }
        return Value::Unknown(Some(Kind::Region));
    };
    if cx.is_dead() {
        return Value::Unknown(Some(Kind::Region));
    }
    let operation = match op {
        BinaryOp::Add => Operation::Union,
        BinaryOp::Subtract => Operation::Difference,
        _ => Operation::Intersection,
    };
    match left.try_combined(right, operation) {
        Ok(region) => Value::Region(region),
        Err(tangled) => {
            cx.report_value(Diagnostic::error(Code::Limit, span, tangled.to_string()).hint(SIMPLIFY));
            Value::Unknown(Some(Kind::Region))
        }
    }
}

fn arithmetic(cx: &mut Cx<'_, '_>, op: BinaryOp, a: Value, b: Value, (b_span, span): (Span, Span)) -> Value {
    if matches!(a, Value::Unknown(None)) || matches!(b, Value::Unknown(None)) {
        return Value::UNKNOWN;
    }
    let (Some(x), Some(y)) = (Operand::of(&a), Operand::of(&b)) else {
        return cannot(cx, op, &a, &b, span);
    };
    if x.unit == FieldUnit::Bool || y.unit == FieldUnit::Bool {
        return cannot(cx, op, &a, &b, span);
    }
    let zero_divisor = matches!(y.amount, Amount::One(0.0));
    let settled = match op {
        BinaryOp::Add => agree(cx, x, y).map(|(x, y, unit)| (x, y, Operator::Add, unit)),
        BinaryOp::Subtract => agree(cx, x, y).map(|(x, y, unit)| (x, y, Operator::Subtract, unit)),
        BinaryOp::Remainder => agree(cx, x, y).map(|(x, y, unit)| (x, y, Operator::Remainder, unit)),
        BinaryOp::Multiply => match (x.unit, y.unit) {
            (FieldUnit::Number, unit) | (unit, FieldUnit::Number) => Some((x, y, Operator::Multiply, unit)),
            _ => None,
        },
        BinaryOp::Divide => match (x.unit, y.unit) {
            (unit, FieldUnit::Number) => Some((x, y, Operator::Divide, unit)),
            (p, q) if p == q || x.is_unknown_field() => Some((x, y, Operator::Divide, FieldUnit::Number)),
            _ => None,
        },
        _ => match (x.unit, y.unit) {
            (FieldUnit::Number, FieldUnit::Number) => Some((x, y, Operator::Power, FieldUnit::Number)),
            _ => None,
        },
    };
    let Some((x, y, operator, unit)) = settled else {
        return disagree(cx, op, &a, &b, span);
    };
    if zero_divisor && matches!(operator, Operator::Divide | Operator::Remainder) {
        cx.report_value(Diagnostic::error(Code::Range, b_span, "division by zero").label("this is zero"));
        return Value::UNKNOWN;
    }
    let result = combine(x, y, operator, unit);
    if let Amount::One(value) = result.amount
        && !value.is_finite()
    {
        let message = format!("the result of `{}` is not a finite number", op.symbol());
        cx.report_value(Diagnostic::error(Code::Range, span, message));
        return Value::UNKNOWN;
    }
    result.value()
}

fn cannot(cx: &mut Cx<'_, '_>, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Value {
    let message = format!("`{}` cannot join {} and {}", op.symbol(), a.describe(), b.describe());
    let hint = match (a, b) {
        (Value::String(_), _) | (_, Value::String(_)) => {
            Some("strings are put together as \"text {value}\"".to_owned())
        }
        _ => None,
    };
    cx.report(Diagnostic::error(Code::Type, span, message).maybe_hint(hint));
    Value::UNKNOWN
}

fn disagree(cx: &mut Cx<'_, '_>, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Value {
    let message = format!("`{}` cannot join {} and {}", op.symbol(), a.describe(), b.describe());
    let hint = match op {
        BinaryOp::Multiply => "one side of a product is a plain number",
        BinaryOp::Divide => "divide by a plain number, or by a value of the same kind",
        BinaryOp::Power => "powers are of plain numbers",
        _ => "both sides need the same unit",
    };
    cx.report(Diagnostic::error(Code::Unit, span, message).hint(hint));
    Value::UNKNOWN
}

fn incomparable(cx: &mut Cx<'_, '_>, op: BinaryOp, a: &Value, b: &Value, span: Span) -> Value {
    let message = format!("`{}` cannot compare {} and {}", op.symbol(), a.describe(), b.describe());
    let measured = |value| Operand::of(value).is_some_and(|operand| operand.unit != FieldUnit::Bool);
    let code = if measured(a) && measured(b) { Code::Unit } else { Code::Type };
    cx.report(Diagnostic::error(code, span, message));
    Value::Unknown(Some(Kind::Bool))
}

fn order(cx: &mut Cx<'_, '_>, op: BinaryOp, a: Value, b: Value, span: Span) -> Value {
    if matches!(a, Value::Unknown(None)) || matches!(b, Value::Unknown(None)) {
        return Value::Unknown(Some(Kind::Bool));
    }
    let settled = match (Operand::of(&a), Operand::of(&b)) {
        (Some(x), Some(y)) => agree(cx, x, y).filter(|(_, _, unit)| *unit != FieldUnit::Bool),
        _ => None,
    };
    let Some((x, y, _)) = settled else {
        return incomparable(cx, op, &a, &b, span);
    };
    let (x, y, operator) = match op {
        BinaryOp::Less => (x, y, Operator::Less),
        BinaryOp::LessEqual => (x, y, Operator::LessEqual),
        BinaryOp::Greater => (y, x, Operator::Less),
        _ => (y, x, Operator::LessEqual),
    };
    combine(x, y, operator, FieldUnit::Bool).value()
}

fn equality(cx: &mut Cx<'_, '_>, op: BinaryOp, a: Value, b: Value, span: Span) -> Value {
    let negate = op == BinaryOp::NotEqual;
    let known = match (&a, &b) {
        (Value::Unknown(_), _) | (_, Value::Unknown(_)) => return Value::Unknown(Some(Kind::Bool)),
        (Value::String(a), Value::String(b)) => Some(a.value == b.value),
        (Value::Colour(a), Value::Colour(b)) => Some(a == b),
        (Value::Word(a), Value::Word(b)) => Some(a == b),
        _ => None,
    };
    if let Some(equal) = known {
        return Value::Bool(equal != negate);
    }
    let settled = match (Operand::of(&a), Operand::of(&b)) {
        (Some(x), Some(y)) => agree(cx, x, y),
        _ => None,
    };
    let Some((x, y, _)) = settled else {
        return incomparable(cx, op, &a, &b, span);
    };
    let equal = combine(x, y, Operator::Equal, FieldUnit::Bool);
    if negate { map(equal, Function::Not, FieldUnit::Bool).value() } else { equal.value() }
}

fn logic(cx: &mut Cx<'_, '_>, op: BinaryOp, (a, a_span): (Value, Span), (b, b_span): (Value, Span)) -> Value {
    let mut sides = Vec::with_capacity(2);
    for (value, span) in [(&a, a_span), (&b, b_span)] {
        match Operand::of(value) {
            Some(operand) if operand.unit == FieldUnit::Bool || operand.is_unknown_field() => sides.push(operand),
            _ if matches!(value, Value::Unknown(None)) => {}
            _ => {
                let message = format!("`{}` joins conditions, not {}", op.symbol(), value.describe());
                cx.report(Diagnostic::error(Code::Type, span, message));
            }
        }
    }
    let mut sides = sides.into_iter();
    let (Some(x), Some(y)) = (sides.next(), sides.next()) else { return Value::Unknown(Some(Kind::Bool)) };
    let operator = if op == BinaryOp::And { Operator::And } else { Operator::Or };
    combine(x, y, operator, FieldUnit::Bool).value()
}

/// A prefix operator.
pub(super) fn unary(cx: &mut Cx<'_, '_>, op: UnaryOp, value: Value, span: Span) -> Value {
    if matches!(value, Value::Unknown(None)) {
        return value;
    }
    let operand = Operand::of(&value);
    match (op, operand) {
        (UnaryOp::Minus, Some(operand)) if operand.unit != FieldUnit::Bool => {
            let unit = operand.unit;
            map(operand, Function::Negate, unit).value()
        }
        (UnaryOp::Not, Some(operand)) if operand.unit == FieldUnit::Bool || operand.is_unknown_field() => {
            map(operand, Function::Not, FieldUnit::Bool).value()
        }
        (UnaryOp::Minus, _) => {
            let message = format!("`-` cannot stand before {}", value.describe());
            cx.report(Diagnostic::error(Code::Type, span, message));
            Value::UNKNOWN
        }
        (UnaryOp::Not, _) => {
            let message = format!("`not` takes a condition, not {}", value.describe());
            cx.report(Diagnostic::error(Code::Type, span, message));
            Value::Unknown(Some(Kind::Bool))
        }
    }
}

/// `if condition then a else b` where the condition varies over the page.
pub(super) fn select(cx: &mut Cx<'_, '_>, condition: Field, a: &Value, b: &Value, span: Span) -> Value {
    let settled = match (Operand::of(a), Operand::of(b)) {
        (Some(x), Some(y)) => agree(cx, x, y),
        _ => None,
    };
    let Some((x, y, unit)) = settled else {
        if !a.is_unknown() && !b.is_unknown() {
            let message = format!(
                "a condition that varies over the page chooses between fields, not {} and {}",
                a.describe(),
                b.describe()
            );
            cx.report(Diagnostic::error(Code::Type, span, message));
        }
        return Value::Unknown(Some(Kind::Field));
    };
    match (x.field(), y.field()) {
        (Some(x), Some(y)) => Value::Field(TypedField { field: Field::new(Node::Select(condition, x, y)), unit }),
        _ => Value::Unknown(Some(Kind::Field)),
    }
}
