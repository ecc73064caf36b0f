//! The evaluator: what an expression is worth in its scope and its place.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, grouped};
use crate::geom::Length;
use crate::scene::Colour;
use crate::span::Span;
use crate::syntax::ast::{self, Expr, ExprKind, StringPart, Unit};

use super::convert::{Slot, coerce};
use super::cx::Cx;
use super::scope::Scope;
use super::value::{FieldUnit, Kind, Member, TypedField, Value};
use super::{branch, function, names, ops};

/// What an expression is worth. `slot` says what its place takes, and so which bare names it knows; the value may still
/// be of another kind.
pub(super) fn eval<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr, slot: Slot) -> Value {
    let value = cx.deeper(expr.span, |cx| eval_kind(cx, scope, expr, slot)).unwrap_or(Value::UNKNOWN);
    if matches!(expr.kind, ExprKind::Tuple(_) | ExprKind::List(_) | ExprKind::Record(_)) && !value.has_at_most(PARTS) {
        let message = format!("the value has more than {} parts", grouped(PARTS));
        cx.report(Diagnostic::error(Code::Limit, expr.span, message));
        return Value::UNKNOWN;
    }
    if let Value::Field(TypedField { field, .. }) = &value
        && (field.depth() > FIELD_DEPTH || field.cost() > FIELD_COST)
    {
        let message = "the field is made of too many parts to be evaluated at every tile";
        cx.report(Diagnostic::error(Code::Limit, expr.span, message));
        return Value::Unknown(Some(Kind::Field));
    }
    value
}

/// How many members a value may have, those of its members counted too: lists of lists of lists grow fast.
const PARTS: u64 = 1_000_000;
/// How many bytes a string may have that is put together.
const LONGEST: usize = 1 << 20;
/// How deep a field's tree may be: it is walked at every site.
const FIELD_DEPTH: u32 = 1000;
/// How many parts a field may have, shared ones counted wherever they stand.
const FIELD_COST: u64 = 100_000;

/// What an expression is worth, brought into what its place takes.
pub(super) fn expect<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr, slot: Slot) -> Value {
    let value = eval(cx, scope, expr, slot);
    coerce(cx, value, slot, expr.span)
}

fn eval_kind<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr, slot: Slot) -> Value {
    match &expr.kind {
        ExprKind::Number { value, unit, .. } => number(cx, *value, *unit, expr.span),
        ExprKind::Colour(text) => {
            let value = colour(text);
            cx.note_colour(expr.span, &value);
            value
        }
        ExprKind::String(parts) => string(cx, scope, parts, expr.span),
        ExprKind::Bool(truth) => Value::Bool(*truth),
        ExprKind::Name(name) => names::name(cx, scope, name, expr.span, slot),
        ExprKind::Member(module, member) => names::member(cx, scope, module, member),
        ExprKind::Call(callee, arguments) => function::call(cx, scope, callee, arguments, expr.span, slot),
        ExprKind::Index(list, index) => self::index(cx, scope, list, index, slot),
        ExprKind::Group(inner) => eval(cx, scope, inner, slot),
        ExprKind::Tuple(members) => {
            // The members of points and boxes are lengths, and are held to that one by one.
            let lengths = matches!((slot.kind, members.len()), (Some(Kind::Point), 2) | (Some(Kind::Box), 4));
            let inner = if lengths { Slot::of(Kind::Length) } else { Slot::ANY };
            Value::Tuple(members.iter().map(|member| expect(cx, scope, member, inner)).collect())
        }
        ExprKind::List(members) => {
            let inner = if slot.kind == Some(Kind::List) { Slot::ANY } else { slot };
            Value::List(members.iter().map(|member| eval(cx, scope, member, inner)).collect())
        }
        ExprKind::Range(low, high) => range(cx, scope, low, high),
        ExprKind::Record(properties) => record(cx, scope, properties),
        ExprKind::Unary(operators, inner) => {
            let mut value = eval(cx, scope, inner, operand_slot(slot));
            for operator in operators.iter().rev() {
                value = ops::unary(cx, *operator, value, expr.span);
            }
            value
        }
        ExprKind::Binary(first, rest) => binary(cx, scope, first, rest, slot),
        ExprKind::If { branches, otherwise } => branch::choose(cx, scope, branches, otherwise, slot, expr.span),
        ExprKind::Match { subject, arms } => branch::matching(cx, scope, subject, arms, slot, expr.span),
        ExprKind::Error => Value::UNKNOWN,
    }
}

fn number(cx: &mut Cx<'_, '_>, value: f64, unit: Option<Unit>, span: Span) -> Value {
    if !value.is_finite() {
        cx.report(Diagnostic::error(Code::Range, span, "the number is too large"));
        return Value::UNKNOWN;
    }
    match unit {
        None => Value::Number(value),
        Some(Unit::Millimetre) => Value::Length(value),
        Some(Unit::Centimetre) => Value::Length(value * 10.0),
        Some(Unit::Inch) => Value::Length(value * Length::MM_PER_INCH),
        Some(Unit::Point) => Value::Length(value * Length::MM_PER_INCH / 72.0),
        Some(Unit::Pixel) => match cx.dpi {
            Some(dpi) => Value::Length(value * Length::MM_PER_INCH / dpi),
            None => {
                let message = "pixels are not known here: they follow from the canvas's size and `dpi`";
                cx.report(Diagnostic::error(Code::Unit, span, message).hint("use mm, cm, in or pt"));
                Value::Unknown(Some(Kind::Length))
            }
        },
        Some(Unit::Degree) => Value::Angle(value.to_radians()),
        Some(Unit::Radian) => Value::Angle(value),
        Some(Unit::Turn) => Value::Angle(value * std::f64::consts::TAU),
        Some(Unit::Percent) => Value::Percent(value / 100.0),
    }
}

fn colour(text: &str) -> Value {
    let digits: Vec<u8> = text.chars().filter_map(|c| c.to_digit(16)).map(|digit| digit as u8).collect();
    let wide: Vec<u8> = match digits.len() {
        3 | 4 => digits.iter().map(|digit| digit * 17).collect(),
        _ => digits.chunks(2).map(|pair| pair.iter().fold(0, |byte, digit| byte * 16 + digit)).collect(),
    };
    match wide[..] {
        [r, g, b] => Value::Colour(Colour { r, g, b, a: 255 }),
        [r, g, b, a] => Value::Colour(Colour { r, g, b, a }),
        _ => Value::Unknown(Some(Kind::Colour)),
    }
}

fn string<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, parts: &'a [StringPart], span: Span) -> Value {
    let mut text = String::new();
    let mut known = true;
    for part in parts {
        match part {
            StringPart::Text(part) => text.push_str(part),
            StringPart::Expr(inner) => match eval(cx, scope, inner, Slot::ANY) {
                Value::String(part) => text.push_str(&part.value),
                Value::Unknown(_) => known = false,
                value => text.push_str(&value.text()),
            },
        }
        if text.len() > LONGEST && parts.len() > 1 {
            cx.report(Diagnostic::error(Code::Limit, span, "the string is longer than a million characters"));
            return Value::Unknown(Some(Kind::String));
        }
    }
    if known { Value::string(&text, span.source) } else { Value::Unknown(Some(Kind::String)) }
}

fn index<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, list: &'a Expr, index: &'a Expr, slot: Slot) -> Value {
    let base = eval(cx, scope, list, slot);
    let place = expect(cx, scope, index, Slot::of(Kind::Number));
    let members = match &base {
        Value::List(members) | Value::Tuple(members) => members,
        Value::Unknown(None | Some(Kind::List | Kind::Point | Kind::Box)) => return Value::UNKNOWN,
        other => {
            let message = format!("only lists have members by number, not {}", other.describe());
            cx.report(Diagnostic::error(Code::Type, list.span, message));
            return Value::UNKNOWN;
        }
    };
    let Value::Number(number) = place else { return Value::UNKNOWN };
    if number.fract() == 0.0
        && number >= 0.0
        && let Some(member) = members.get(number as usize)
    {
        return member.clone();
    }
    let message = match members.len() {
        0 => "the list is empty".to_owned(),
        count => format!("the list has {count} members, numbered 0 to {}", count - 1),
    };
    cx.report_value(Diagnostic::error(Code::Range, index.span, message).label(format!("there is no member {number}")));
    Value::UNKNOWN
}

/// Where the members of a list stand; the whole list where it was not written as one.
pub(super) fn member_spans(expr: &Expr, count: usize) -> Vec<Span> {
    match &expr.kind {
        ExprKind::List(members) if members.len() == count => members.iter().map(|member| member.span).collect(),
        _ => vec![expr.span; count],
    }
}

fn range<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, low: &'a Expr, high: &'a Expr) -> Value {
    let ends = (eval(cx, scope, low, Slot::ANY), eval(cx, scope, high, Slot::ANY));
    if ends.0.is_unknown() || ends.1.is_unknown() {
        return Value::Unknown(Some(Kind::Range));
    }
    let settled = match (ops::Operand::of(&ends.0), ops::Operand::of(&ends.1)) {
        (Some(a), Some(b)) => ops::agree(cx, a, b).filter(|(_, _, unit)| *unit != FieldUnit::Bool),
        _ => None,
    };
    let percent = matches!(ends, (Value::Percent(_), Value::Percent(_)));
    match settled.map(|(a, b, _)| (a.value(), b.value())) {
        Some(_) if percent => Value::Range(Rc::new(ends)),
        Some((a, b)) if a.number().is_some() && b.number().is_some() => Value::Range(Rc::new((a, b))),
        _ => {
            let message =
                format!("a range goes from number to number, not {} to {}", ends.0.describe(), ends.1.describe());
            cx.report(Diagnostic::error(Code::Type, low.span.to(high.span), message));
            Value::Unknown(Some(Kind::Range))
        }
    }
}

fn record<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, properties: &'a [ast::Property]) -> Value {
    let mut members: Vec<Member> = Vec::with_capacity(properties.len());
    for property in properties {
        let value = eval(cx, scope, &property.value, Slot::ANY);
        let name = &property.name;
        if let Some(earlier) = members.iter().find(|member| member.name == name.name) {
            let note = earlier.name_span;
            let message = format!("`{}` is given twice", name.name);
            cx.report(Diagnostic::error(Code::Duplicate, name.span, message).note(note, "first given here"));
            continue;
        }
        members.push(Member { name: name.name.clone(), name_span: name.span, value, span: property.value.span });
    }
    Value::Record(members.into())
}

/// Operands know the names of their place only where operators keep its kind.
pub(super) fn operand_slot(slot: Slot) -> Slot {
    match slot.kind {
        Some(Kind::Region) => Slot::of(Kind::Region),
        Some(Kind::Field) => Slot::of(Kind::Field),
        _ => Slot::ANY,
    }
}

fn binary<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    first: &'a Expr,
    rest: &'a [(ast::BinaryOp, Expr)],
    slot: Slot,
) -> Value {
    let mut slot = operand_slot(slot);
    if let [(ast::BinaryOp::Power, _), ..] = rest {
        return power(cx, scope, first, rest, slot);
    }
    let mut value = eval(cx, scope, first, slot);
    let mut span = first.span;
    for (operator, operand) in rest {
        if matches!(value, Value::Region(_)) {
            slot = Slot::of(Kind::Region);
        }
        let right = eval(cx, scope, operand, slot);
        value = ops::binary(cx, *operator, (value, span), (right, operand.span));
        span = span.to(operand.span);
    }
    value
}

/// Powers are read from the right.
fn power<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    first: &'a Expr,
    rest: &'a [(ast::BinaryOp, Expr)],
    slot: Slot,
) -> Value {
    let operands: Vec<&Expr> = std::iter::once(first).chain(rest.iter().map(|(_, operand)| operand)).collect();
    let mut values: Vec<(Value, Span)> =
        operands.into_iter().map(|operand| (eval(cx, scope, operand, slot), operand.span)).collect();
    let Some(mut right) = values.pop() else { return Value::UNKNOWN };
    while let Some(left) = values.pop() {
        let span = left.1.to(right.1);
        right = (ops::binary(cx, ast::BinaryOp::Power, left, right), span);
    }
    right.0
}
