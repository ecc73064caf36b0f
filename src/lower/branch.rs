//! `if` and `match`: the branch that is taken is evaluated, the others are checked.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{self, Expr, ExprKind, Pattern};

use super::convert::Slot;
use super::cx::Cx;
use super::eval::{eval, operand_slot};
use super::ops;
use super::scope::Scope;
use super::value::{FieldUnit, Kind, TypedField, Value};

pub(super) fn choose<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    branches: &'a [(Expr, Expr)],
    otherwise: &'a Expr,
    slot: Slot,
    span: Span,
) -> Value {
    let Some(((condition, then), rest)) = branches.split_first() else {
        return eval(cx, scope, otherwise, slot);
    };
    let last = |cx: &mut Cx<'a, '_>| {
        if rest.is_empty() {
            eval(cx, scope, otherwise, slot)
        } else {
            cx.deeper(span, |cx| choose(cx, scope, rest, otherwise, slot, span)).unwrap_or(Value::UNKNOWN)
        }
    };
    match self::condition(cx, scope, condition, slot) {
        Value::Bool(true) => {
            cx.dead_once(then.span.at_start().to(otherwise.span), last);
            eval(cx, scope, then, slot)
        }
        Value::Bool(false) => {
            cx.dead_once(then.span, |cx| eval(cx, scope, then, slot));
            last(cx)
        }
        Value::Field(TypedField { field, .. }) => {
            let a = eval(cx, scope, then, slot);
            let b = last(cx);
            ops::select(cx, field, &a, &b, span)
        }
        _ => {
            let a = cx.dead(|cx| eval(cx, scope, then, slot));
            let b = cx.dead(last);
            common([a, b])
        }
    }
}

/// A value of which only the kind is known, where all of these are of one kind.
fn common(values: impl IntoIterator<Item = Value>) -> Value {
    let mut kinds = values.into_iter().map(|value| value.kind());
    let first = kinds.next().flatten();
    if kinds.all(|kind| kind == first) { Value::Unknown(first) } else { Value::UNKNOWN }
}

/// A condition: a bool, a field of them, or unknown.
pub(super) fn condition<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr, slot: Slot) -> Value {
    let value = eval(cx, scope, expr, operand_slot(slot));
    match value {
        Value::Bool(_) | Value::Unknown(None | Some(Kind::Bool | Kind::Field)) => value,
        Value::Field(TypedField { unit: FieldUnit::Bool, .. }) => value,
        other => {
            let message = format!("a condition is true or false, not {}", other.describe());
            cx.report(Diagnostic::error(Code::Type, expr.span, message));
            Value::UNKNOWN
        }
    }
}

pub(super) fn matching<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    subject: &'a Expr,
    arms: &'a [ast::Arm],
    slot: Slot,
    span: Span,
) -> Value {
    let value = eval(cx, scope, subject, Slot::ANY);
    let covered = check_patterns(cx, scope, (subject, &value), arms, span);
    if value.is_unknown() {
        let values: Vec<Value> = arms.iter().map(|arm| cx.dead(|cx| eval(cx, scope, &arm.value, slot))).collect();
        return common(values);
    }
    let taken = arms.iter().position(|arm| holds(&arm.pattern, &value));
    for (i, arm) in arms.iter().enumerate() {
        if Some(i) != taken {
            cx.dead_once(arm.value.span, |cx| eval(cx, scope, &arm.value, slot));
        }
    }
    match taken {
        Some(taken) => eval(cx, scope, &arms[taken].value, slot),
        None if !covered => Value::UNKNOWN,
        None => {
            let message = format!("no arm covers {}", value.text());
            let diagnostic = Diagnostic::error(Code::Match, subject.span, message);
            cx.report_value(diagnostic.hint("a last arm `_ => …` covers the rest"));
            Value::UNKNOWN
        }
    }
}

fn holds(pattern: &Pattern, value: &Value) -> bool {
    match (pattern, value) {
        (Pattern::Any, _) => true,
        (Pattern::String(text), Value::String(value)) => **text == *value.value,
        (Pattern::String(text), Value::Word(word)) => text == word,
        (Pattern::Number(number, _), Value::Number(value)) => number == value,
        (Pattern::Bool(truth), Value::Bool(value)) => truth == value,
        _ => false,
    }
}

/// Patterns that can never match, match twice, or leave something uncovered whatever the value is; whether they cover all.
fn check_patterns(
    cx: &mut Cx<'_, '_>,
    scope: &Rc<Scope<'_>>,
    (subject, value): (&Expr, &Value),
    arms: &[ast::Arm],
    span: Span,
) -> bool {
    for (i, arm) in arms.iter().enumerate() {
        let expected = match arm.pattern {
            Pattern::Any => None,
            Pattern::String(_) => Some(Kind::String),
            Pattern::Number(..) => Some(Kind::Number),
            Pattern::Bool(_) => Some(Kind::Bool),
        };
        if let (Some(expected), Some(found)) = (expected, value.kind())
            && expected != found
            && !(expected == Kind::String && found == Kind::Word)
        {
            let message = format!("this matches {}, but the value is {}", expected.noun(), value.describe());
            cx.report(Diagnostic::error(Code::Type, arm.span, message));
        }
        if let Some(earlier) =
            arms[..i].iter().find(|earlier| earlier.pattern == arm.pattern || earlier.pattern == Pattern::Any)
        {
            let message = "an earlier arm takes everything that this one would";
            cx.report(Diagnostic::error(Code::Match, arm.span, message).note(earlier.span, "this one"));
        }
    }
    if arms.iter().any(|arm| arm.pattern == Pattern::Any) {
        return true;
    }
    let choices = match (&subject.kind, value.kind()) {
        (_, Some(Kind::Bool)) => vec![Value::Bool(true), Value::Bool(false)],
        (ExprKind::Name(name), _) => cx.choices.get(&(scope.module, name.clone())).cloned().unwrap_or_default(),
        _ => Vec::new(),
    };
    let missed: Vec<String> =
        choices.iter().filter(|choice| !arms.iter().any(|arm| holds(&arm.pattern, choice))).map(Value::text).collect();
    if !choices.is_empty() && missed.is_empty() {
        return true;
    }
    let message = match missed.is_empty() {
        true => "the match does not cover every value".to_owned(),
        false => format!("the match does not cover {}", missed.join(", ")),
    };
    cx.report(Diagnostic::error(Code::Match, span, message).hint("a last arm `_ => …` covers the rest"));
    false
}
