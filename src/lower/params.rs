//! Parameters: their values from the scene or the command line, their domains, and their JSON Schema.

use std::rc::Rc;

use serde_json::{Map, Value as Json, json};

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::scene::{Param, ParamDomain, ParamValue};
use crate::span::{Sources, Span, Syntax};
use crate::syntax::ast::{self, Expr, StatementKind};
use crate::syntax::kake;

use super::LowerConfig;
use super::convert::{Slot, coerce};
use super::cx::Cx;
use super::eval;
use super::scope::Scope;
use super::value::{Kind, Value};

/// A parameter that the command line sets.
#[derive(Debug)]
pub(super) struct Set {
    name: String,
    text: String,
    /// Its value as an expression; a string may be given without its quotes, so this may be nonsense.
    expr: Expr,
    faults: Vec<Diagnostic>,
    span: Span,
}

/// Reads the values that were set.
pub(super) fn parse_sets(config: &LowerConfig, sources: &mut Sources, diagnostics: &mut Vec<Diagnostic>) -> Vec<Set> {
    let mut sets: Vec<Set> = Vec::with_capacity(config.sets.len());
    for (name, text) in &config.sets {
        let source = sources.add(format!("--set {name}"), text.as_str(), Syntax::Kake);
        let span = Span::new(source, 0, text.len());
        if let Some(earlier) = sets.iter().find(|set| set.name == *name) {
            let message = format!("`{name}` is set twice");
            diagnostics.push(Diagnostic::error(Code::Param, span, message).note(earlier.span, "first set here"));
            continue;
        }
        let (expr, faults) = kake::parse_expression(source, text, &|offset| offset);
        sets.push(Set { name: name.clone(), text: text.clone(), expr, faults, span });
    }
    sets
}

/// The parameters that can be set: those of the scene and of what it imports, with the names they are set by.
fn settable(cx: &Cx<'_, '_>) -> Vec<(usize, String, String)> {
    let Some(main) = cx.modules.first() else { return Vec::new() };
    let opened = main.opened.iter().map(|&module| (module, String::new()));
    let named = main.aliases.iter().map(|(alias, &module)| (module, format!("{alias}.")));
    let mut list = Vec::new();
    for (module, prefix) in std::iter::once((0, String::new())).chain(opened).chain(named) {
        for statement in &cx.modules[module].document.statements {
            if let StatementKind::Param { binding, .. } = &statement.kind {
                let name = binding.name.name.clone();
                list.push((module, format!("{prefix}{name}"), name));
            }
        }
    }
    list
}

/// Gives the parameters the values that were set, before anything asks for them.
pub(super) fn apply<'a>(cx: &mut Cx<'a, '_>, sets: &'a [Set]) {
    let known = settable(cx);
    for set in sets {
        let Some((module, _, name)) = known.iter().find(|(_, full, _)| *full == set.name) else {
            let message = format!("the scene has no parameter `{}`", set.name);
            let hint =
                did_you_mean(&set.name, known.iter().map(|(_, full, _)| full.as_str())).unwrap_or_else(|| match known
                    .is_empty()
                {
                    true => "it declares none: `param name = value`".to_owned(),
                    false => {
                        let names: Vec<_> = known.iter().map(|(_, full, _)| format!("`{full}`")).collect();
                        format!("its parameters are {}", names.join(", "))
                    }
                });
            cx.report(Diagnostic::error(Code::Param, set.span, message).hint(hint));
            continue;
        };
        cx.set.insert((*module, name.clone()), set);
    }
}

/// The value of a parameter: what was set, else its default, both held to its kind and domain.
pub(super) fn settle<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    binding: &'a ast::Binding,
    domain: Option<&'a Expr>,
    default: Value,
) -> Value {
    let name = &binding.name.name;
    let kind = default.kind();
    let domain = domain.map(|expr| (self::domain(cx, scope, expr, kind), expr.span));
    let allowed = domain.as_ref().and_then(|(domain, span)| domain.as_ref().map(|domain| (domain, *span)));
    if let Some((Value::List(choices), _)) = allowed {
        cx.choices.insert((scope.module, name.clone()), choices.to_vec());
    }
    let default = within(cx, default, allowed, binding.value.span);
    let text = default_text(&default, &binding.value);
    let value = match cx.set.get(&(scope.module, name.clone())).copied() {
        None => default.clone(),
        Some(set) => {
            let value = set_value(cx, set, kind);
            within(cx, value, allowed, set.span)
        }
    };
    let domain = domain.and_then(|(domain, span)| Some((domain?, span)));
    let settled = Settled { kind, domain, default: text, value: value.clone() };
    cx.settled.insert((scope.module, name.clone()), settled);
    value
}

/// What is known of a parameter once it has its value.
#[derive(Debug, Clone)]
pub(super) struct Settled {
    kind: Option<Kind>,
    /// The range or choices, with their place.
    domain: Option<(Value, Span)>,
    default: ParamValue,
    value: Value,
}

fn default_text(value: &Value, expr: &Expr) -> ParamValue {
    match value {
        Value::Unknown(_) => ParamValue { text: crate::syntax::format::expression(expr), number: None, string: None },
        value => param_value(value),
    }
}

pub(super) fn param_value(value: &Value) -> ParamValue {
    let string = match value {
        Value::String(text) => Some(text.value.to_string()),
        _ => None,
    };
    ParamValue { text: value.text(), number: value.number(), string }
}

fn set_value<'a>(cx: &mut Cx<'a, '_>, set: &'a Set, kind: Option<Kind>) -> Value {
    // `--set placement=uniform` means the string; the shell has eaten quotes that were there.
    if kind == Some(Kind::String) && !set.text.trim_start().starts_with('"') {
        return Value::string(&set.text, set.span.source);
    }
    if !set.faults.is_empty() {
        for fault in &set.faults {
            cx.report(fault.clone());
        }
        return Value::Unknown(kind);
    }
    let modules = cx.modules;
    let Some(main) = modules.first() else { return Value::Unknown(kind) };
    eval::expect(cx, &main.scope, &set.expr, kind.map_or(Slot::ANY, Slot::of))
}

/// The range or choices of a parameter, brought to its kind.
fn domain<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr, kind: Option<Kind>) -> Option<Value> {
    let slot = kind.map_or(Slot::ANY, Slot::of);
    match eval::eval(cx, scope, expr, slot) {
        Value::Range(ends) => {
            let low = coerce(cx, ends.0.clone(), slot, expr.span);
            let high = coerce(cx, ends.1.clone(), slot, expr.span);
            let (from, to) = (low.number()?, high.number()?);
            if from > to {
                let message = format!("the range runs backwards, from {} to {}", low.text(), high.text());
                cx.report(Diagnostic::error(Code::Range, expr.span, message));
                return None;
            }
            Some(Value::Range(Rc::new((low, high))))
        }
        Value::List(members) if members.is_empty() => {
            cx.report(Diagnostic::error(Code::Range, expr.span, "a parameter needs at least one choice"));
            None
        }
        Value::List(members) => {
            let members: Rc<[Value]> =
                members.iter().map(|member| coerce(cx, member.clone(), slot, expr.span)).collect();
            (!members.iter().any(Value::is_unknown)).then_some(Value::List(members))
        }
        Value::Unknown(_) => None,
        other => {
            let message = format!("a parameter lies in a range or a list of choices, not in {}", other.describe());
            cx.report(Diagnostic::error(Code::Type, expr.span, message).hint("`in 0 .. 1` or `in [\"a\", \"b\"]`"));
            None
        }
    }
}

/// Holds a value to a range or choices.
pub(super) fn within(cx: &mut Cx<'_, '_>, value: Value, domain: Option<(&Value, Span)>, span: Span) -> Value {
    let Some((domain, domain_span)) = domain else { return value };
    if value.is_unknown() {
        return value;
    }
    let (fits, code, message) = match domain {
        Value::Range(ends) => {
            let (low, high) = (ends.0.number(), ends.1.number());
            let fits = match (value.number(), low, high) {
                (Some(value), Some(low), Some(high)) => (low..=high).contains(&value),
                _ => false,
            };
            let message = format!("{} is not between {} and {}", value.text(), ends.0.text(), ends.1.text());
            (fits, Code::Range, message)
        }
        Value::List(choices) => {
            let texts: Vec<String> = choices.iter().map(Value::text).collect();
            let fits = texts.contains(&value.text());
            (fits, Code::Choice, format!("{} is not one of {}", value.text(), texts.join(", ")))
        }
        _ => return value,
    };
    if fits {
        return value;
    }
    let mut diagnostic = Diagnostic::error(code, span, message);
    if let (Value::List(choices), Value::String(text)) = (domain, &value) {
        let names: Vec<&str> = choices
            .iter()
            .filter_map(|choice| match choice {
                Value::String(text) => Some(&*text.value),
                _ => None,
            })
            .collect();
        diagnostic = diagnostic.maybe_hint(did_you_mean(&text.value, names));
    }
    cx.report(diagnostic.note(domain_span, "declared here"));
    Value::Unknown(value.kind())
}

/// A level of a factor: a value that a parameter may be given. `None` where it may not, which was reported.
///
/// A run sets the parameter by an expression. Where the value itself is none that can be written down, a placement say, it
/// is `written`: the expression that the scene has for it.
pub(super) fn level<'a>(
    cx: &mut Cx<'a, '_>,
    name: &str,
    value: Value,
    (span, written): (Span, Option<String>),
) -> Option<ParamValue> {
    let (module, _, short) = settable(cx).into_iter().find(|(_, full, _)| full == name)?;
    let settled = cx.settled.get(&(module, short)).cloned()?;
    let value = coerce(cx, value, settled.kind.map_or(Slot::ANY, Slot::of), span);
    let value = within(cx, value, settled.domain.as_ref().map(|(domain, place)| (domain, *place)), span);
    if value.is_unknown() {
        return None;
    }
    let plain = param_value(&value);
    match written {
        _ if value.is_literal() => Some(plain),
        Some(text) => Some(ParamValue { text, ..plain }),
        None => {
            let message = format!("{} as a level is written out in the experiment", value.describe());
            cx.report(Diagnostic::error(Code::Type, span, message).hint(format!("`{{ {name}: [a, b] }}`")));
            None
        }
    }
}

/// Tells that a parameter is named.
pub(super) fn note_use(cx: &mut Cx<'_, '_>, name: &str, span: Span) {
    if cx.survey.is_none() {
        return;
    }
    if let Some((module, _, short)) = settable(cx).into_iter().find(|(_, full, _)| full == name)
        && let Some(entry) = cx.modules[module].scope.own(&short)
    {
        cx.note_use(span, entry.span);
    }
}

/// The names of the parameters that can be set.
pub(super) fn names(cx: &Cx<'_, '_>) -> Vec<String> {
    settable(cx).into_iter().map(|(_, full, _)| full).collect()
}

/// Every parameter that can be set, with what it is and may be.
pub(super) fn list(cx: &Cx<'_, '_>) -> Vec<Param> {
    let mut list = Vec::new();
    for (module, full, name) in settable(cx) {
        let Some(settled) = cx.settled.get(&(module, name.clone())) else { continue };
        let doc = cx.modules[module].document.statements.iter().find_map(|statement| match &statement.kind {
            StatementKind::Param { binding, .. } if binding.name.name == name => statement.doc.as_ref(),
            _ => None,
        });
        list.push(Param {
            name: full,
            doc: doc.map(|doc| doc.text.clone()),
            ty: settled.kind.map_or("value", Kind::name).to_owned(),
            domain: settled.domain.as_ref().and_then(|(domain, _)| match domain {
                Value::Range(ends) => Some(ParamDomain::Range(param_value(&ends.0), param_value(&ends.1))),
                Value::List(choices) => Some(ParamDomain::Choices(choices.iter().map(param_value).collect())),
                _ => None,
            }),
            default: settled.default.clone(),
            value: param_value(&settled.value),
        });
    }
    list
}

/// The parameters as JSON Schema (draft 2020-12).
///
/// Numbers are in the unit that `x-unit` names (`mm`, `deg`, `%`); other values are expressions of the language, as
/// `--set` takes them. `x-type` is the type's name in the language.
#[must_use]
pub fn schema(title: &str, params: &[Param]) -> Json {
    let mut properties = Map::new();
    for param in params {
        let mut property = Map::new();
        let (kind, unit) = match param.ty.as_str() {
            "number" => ("number", None),
            "length" => ("number", Some("mm")),
            "angle" => ("number", Some("deg")),
            "percentage" => ("number", Some("%")),
            "bool" => ("boolean", None),
            _ => ("string", None),
        };
        let plain = |value: &ParamValue| plain(value, &param.ty);
        property.insert("type".to_owned(), json!(kind));
        if let Some(doc) = &param.doc {
            property.insert("description".to_owned(), json!(doc));
        }
        property.insert("default".to_owned(), plain(&param.default));
        match &param.domain {
            Some(ParamDomain::Range(low, high)) => {
                property.insert("minimum".to_owned(), plain(low));
                property.insert("maximum".to_owned(), plain(high));
            }
            Some(ParamDomain::Choices(choices)) => {
                property.insert("enum".to_owned(), choices.iter().map(plain).collect());
            }
            None => {}
        }
        property.insert("x-type".to_owned(), json!(param.ty));
        if let Some(unit) = unit {
            property.insert("x-unit".to_owned(), json!(unit));
        }
        properties.insert(param.name.clone(), Json::Object(property));
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    })
}

fn plain(value: &ParamValue, ty: &str) -> Json {
    match (value.number, ty) {
        (Some(radians), "angle") => json!((radians.to_degrees() * 1e9).round() / 1e9),
        (Some(share), "percentage") => json!((share * 100.0 * 1e9).round() / 1e9),
        (Some(number), _) => json!(number),
        (None, "bool") => json!(value.text == "true"),
        (None, "string") => match serde_json::from_str::<String>(&value.text) {
            Ok(text) => json!(text),
            Err(_) => json!(value.text),
        },
        (None, _) => json!(value.text),
    }
}
