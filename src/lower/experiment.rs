//! Experiments: checked here, run by others.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::scene::{Experiment, Factor, ParamValue};
use crate::span::Span;
use crate::syntax::ast::{Expr, ExprKind, Ident, Property, StatementKind};
use crate::syntax::format;

use super::convert::Slot;
use super::cx::Cx;
use super::eval;
use super::params;
use super::properties::EXPERIMENT as PROPERTIES;
use super::scope::Scope;
use super::value::{Kind, Member, Value};

/// The names of the properties.
fn names() -> impl Iterator<Item = &'static str> {
    PROPERTIES.iter().map(|known| known.name)
}

/// Every experiment of the first module.
pub(super) fn lower(cx: &mut Cx<'_, '_>) -> Vec<Experiment> {
    let modules = cx.modules;
    let Some(module) = modules.first() else { return Vec::new() };
    let mut experiments: Vec<Experiment> = Vec::new();
    for statement in &module.document.statements {
        let StatementKind::Experiment { name, properties } = &statement.kind else { continue };
        if let Some(earlier) = experiments.iter().find(|earlier| earlier.name == name.name) {
            let message = format!("two experiments are called `{}`", name.name);
            let note = earlier.span;
            cx.report(Diagnostic::error(Code::Duplicate, name.span, message).note(note, "the first one"));
        }
        if let Some(experiment) = one(cx, &module.scope, name, properties) {
            experiments.push(experiment);
        }
    }
    experiments
}

fn one<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &Ident, properties: &'a [Property]) -> Option<Experiment> {
    let mut experiment = Experiment {
        name: name.name.clone(),
        seeds: [0, 0],
        factors: Vec::new(),
        reference: Vec::new(),
        images: Vec::new(),
        span: name.span,
    };
    let mut seen: Vec<&Ident> = Vec::new();
    for property in properties {
        let key = &property.name;
        if let Some(earlier) = seen.iter().find(|earlier| earlier.name == key.name) {
            let message = format!("`{}` is given twice", key.name);
            let note = earlier.span;
            cx.report(Diagnostic::error(Code::Duplicate, key.span, message).note(note, "first given here"));
            continue;
        }
        seen.push(key);
        let span = property.value.span;
        match key.name.as_str() {
            "seeds" => {
                let value = eval::expect(cx, scope, &property.value, Slot::of(Kind::Range));
                if let Some(seeds) = seeds(cx, &value, span) {
                    experiment.seeds = seeds;
                }
            }
            "factors" => experiment.factors = factors(cx, scope, property),
            "images" => experiment.images = factors(cx, scope, property),
            "reference" => {
                if let Value::List(members) = eval::expect(cx, scope, &property.value, Slot::of(Kind::List)) {
                    let spans = eval::member_spans(&property.value, members.len());
                    for (i, (member, span)) in members.iter().zip(spans).enumerate() {
                        let record = match &property.value.kind {
                            ExprKind::List(written) if written.len() == members.len() => Some(&written[i]),
                            _ => None,
                        };
                        experiment.reference.push(reference(cx, member, span, record));
                    }
                }
            }
            other => {
                eval::eval(cx, scope, &property.value, Slot::ANY);
                let message = format!("experiments have no property `{other}`");
                let hint = did_you_mean(other, names())
                    .unwrap_or_else(|| format!("experiments have `{}`", names().collect::<Vec<_>>().join("`, `")));
                cx.report(Diagnostic::error(Code::UnknownProperty, key.span, message).hint(hint));
            }
        }
    }
    let is_unknown = |key: &&Ident| !names().any(|name| name == key.name);
    if !seen.iter().any(|key| key.name == "seeds") {
        // A property that is not known may have been meant for it.
        if seen.iter().any(is_unknown) {
            return None;
        }
        let message = format!("the experiment `{}` has no `seeds`", name.name);
        cx.report(Diagnostic::error(Code::Missing, name.span, message).hint("`seeds: 0 .. 99`"));
        return None;
    }
    Some(experiment)
}

fn seeds(cx: &mut Cx<'_, '_>, value: &Value, span: Span) -> Option<[u64; 2]> {
    let Value::Range(ends) = value else { return None };
    let whole = |value: &Value| match value {
        Value::Number(n) if n.fract() == 0.0 && (0.0..9e15).contains(n) => Some(*n as u64),
        _ => None,
    };
    match (whole(&ends.0), whole(&ends.1)) {
        (Some(low), Some(high)) if low <= high => Some([low, high]),
        _ => {
            let message = "seeds run from one whole number up to another";
            cx.report(Diagnostic::error(Code::Range, span, message).hint("`seeds: 0 .. 99`"));
            None
        }
    }
}

/// The parameter that a member of a record names.
fn known_param(cx: &mut Cx<'_, '_>, member: &Member) -> bool {
    let names = params::names(cx);
    if names.contains(&member.name) {
        params::note_use(cx, &member.name, member.name_span);
        return true;
    }
    let message = format!("the scene has no parameter `{}`", member.name);
    let hint = did_you_mean(&member.name, names.iter().map(String::as_str));
    cx.report(Diagnostic::error(Code::Param, member.name_span, message).maybe_hint(hint));
    false
}

fn factors<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, property: &'a Property) -> Vec<Factor> {
    let Value::Record(members) = eval::expect(cx, scope, &property.value, Slot::of(Kind::Record)) else {
        return Vec::new();
    };
    let mut factors = Vec::new();
    for member in members.iter() {
        if !known_param(cx, member) {
            continue;
        }
        let expr = written(&property.value, &member.name);
        let levels: Vec<Value> = match &member.value {
            Value::List(levels) => levels.to_vec(),
            Value::Unknown(_) => continue,
            one => vec![one.clone()],
        };
        if levels.is_empty() {
            let message = format!("`{}` has no levels", member.name);
            cx.report(Diagnostic::error(Code::Range, member.span, message).label("an empty list"));
            continue;
        }
        let spans = match expr {
            Some(expr) => eval::member_spans(expr, levels.len()),
            None => vec![member.span; levels.len()],
        };
        let mut known: Vec<(ParamValue, Span)> = Vec::with_capacity(levels.len());
        for (i, (level, span)) in levels.into_iter().zip(spans).enumerate() {
            let text = expr.map(|expr| spelled(expr, &member.value, i));
            let Some(level) = params::level(cx, &member.name, level, (span, text)) else { continue };
            match known.iter().find(|(earlier, _)| *earlier == level) {
                Some(&(_, earlier)) => {
                    let message = format!("`{}` has the level {} twice", member.name, level.text);
                    cx.report(Diagnostic::error(Code::Duplicate, span, message).note(earlier, "first given here"));
                }
                None => known.push((level, span)),
            }
        }
        let levels = known.into_iter().map(|(level, _)| level).collect();
        factors.push(Factor { param: member.name.clone(), levels });
    }
    factors
}

/// The expression of one of several levels, which are written as a list or as something that gives one.
fn spelled(expr: &Expr, value: &Value, level: usize) -> String {
    match (&expr.kind, value) {
        (ExprKind::List(written), Value::List(levels)) if written.len() == levels.len() => {
            format::expression(&written[level])
        }
        (_, Value::List(_)) => format!("({})[{level}]", format::expression(expr)),
        _ => format::expression(expr),
    }
}

/// How a member of a record is written, where the record is.
fn written<'e>(record: &'e Expr, name: &str) -> Option<&'e Expr> {
    let ExprKind::Record(members) = &record.kind else { return None };
    members.iter().find(|member| member.name.name == name).map(|member| &member.value)
}

fn reference(cx: &mut Cx<'_, '_>, value: &Value, span: Span, record: Option<&Expr>) -> Vec<(String, ParamValue)> {
    let Value::Record(members) = value else {
        if !value.is_unknown() {
            let message = format!("a reference gives parameters their values, not {}", value.describe());
            let hint = "`reference: [{ placement: \"grid\" }]`";
            cx.report(Diagnostic::error(Code::Type, span, message).hint(hint));
        }
        return Vec::new();
    };
    let mut condition = Vec::new();
    for member in members.iter() {
        let text = record.and_then(|record| written(record, &member.name)).map(format::expression);
        if known_param(cx, member)
            && let Some(value) = params::level(cx, &member.name, member.value.clone(), (member.span, text))
        {
            condition.push((member.name.clone(), value));
        }
    }
    condition
}
