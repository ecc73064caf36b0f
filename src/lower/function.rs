//! Calls of names: functions of the scene, and the way to tones and to the vocabulary.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::span::Span;
use crate::syntax::ast::{self, Argument, Expr, ExprKind};

use super::convert::Slot;
use super::cx::Cx;
use super::eval::{eval, expect, operand_slot};
use super::modules::Function;
use super::names::{module_of, named_kind, visible};
use super::scope::{Binding, Scope};
use super::value::{Kind, Value};
use super::{call, tone, vocabulary};

pub(super) fn call<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    callee: &'a Expr,
    arguments: &'a [Argument],
    span: Span,
    slot: Slot,
) -> Value {
    match &callee.kind {
        ExprKind::Name(name) => {
            if let Some(function) = find_function(cx, scope.module, name) {
                cx.note_use(callee.span, function.name.span);
                return call_function(cx, scope, function, (arguments, span), slot);
            }
            if slot.kind == Some(Kind::Tone)
                && let Some(tone) = tone::find(cx, scope.module, name)
            {
                cx.note_use(callee.span, tone.name.span);
                return tone::instantiate(cx, scope, tone, arguments, span);
            }
            if let Some(signature) = vocabulary::find(name, slot, arguments) {
                // Where anything is taken, as in `sin(x)`, the names of the call's own place are known.
                let around = operand_slot(slot);
                return call::call(cx, signature, arguments, span, |cx, expr, slot| {
                    eval(cx, scope, expr, if slot.kind.is_none() { around } else { slot })
                });
            }
            unknown_call(cx, scope, name, callee.span, slot);
        }
        ExprKind::Member(base, member) => {
            let Some(module) = module_of(cx, scope, base) else {
                check_arguments(cx, scope, arguments);
                return Value::UNKNOWN;
            };
            let modules = cx.modules;
            if let Some(&function) = modules[module].functions.get(member.name.as_str()) {
                cx.note_use(member.span, function.name.span);
                return call_function(cx, scope, function, (arguments, span), slot);
            }
            if let Some(&tone) = modules[module].tones.get(member.name.as_str()) {
                cx.note_use(member.span, tone.name.span);
                return tone::instantiate(cx, scope, tone, arguments, span);
            }
            let message = format!("`{}` declares no `{}`", modules[module].path, member.name);
            let known = modules[module].functions.keys().chain(modules[module].tones.keys()).copied();
            let hint = did_you_mean(&member.name, known);
            let code = if slot.kind == Some(Kind::Tone) { Code::UnknownTone } else { Code::UnknownFunction };
            cx.report(Diagnostic::error(code, member.span, message).maybe_hint(hint));
        }
        ExprKind::Error => {}
        _ => {
            cx.report(Diagnostic::error(Code::Type, callee.span, "only names can be called"));
        }
    }
    check_arguments(cx, scope, arguments);
    Value::UNKNOWN
}

/// Evaluates arguments of a call that came to nothing, for their own mistakes.
fn check_arguments<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, arguments: &'a [Argument]) {
    for argument in arguments {
        // Without a place of their own bare words may mean anything, so only what is inside them is looked at.
        if !matches!(argument.value.kind, ExprKind::Name(_)) {
            eval(cx, scope, &argument.value, Slot::of(Kind::Field));
        }
    }
}

fn unknown_call<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &str, span: Span, slot: Slot) {
    if visible(cx, scope).contains(&name) {
        let message = format!("`{name}` is a value, and only functions are called");
        cx.report(Diagnostic::error(Code::Type, span, message));
        return;
    }
    let modules = cx.modules;
    let module = &modules[scope.module];
    if module.broken.contains(name) {
        return;
    }
    if cx.is_swamped() {
        let message = format!("there is nothing called `{name}`");
        cx.report(Diagnostic::error(Code::UnknownFunction, span, message));
        return;
    }
    let mut known: Vec<&str> = cx.seen_from(scope.module).flat_map(|module| module.functions.keys().copied()).collect();
    // What fits the place comes first: a misspelt shape is no square root.
    let fitting = vocabulary::fitting(slot);
    match fitting.is_empty() {
        true => vocabulary::callables().for_each(|callable| known.push(callable)),
        false => fitting.iter().for_each(|callable| known.push(callable)),
    }
    let hint = match tone::find(cx, scope.module, name) {
        Some(_) => Some(format!("`{name}` is a tone: `paint REGION with {name}(…)`")),
        None => did_you_mean(name, known).or_else(|| {
            let names: Vec<_> = fitting.iter().map(|name| format!("`{name}`")).collect();
            slot.kind
                // A long list is for the reference.
                .filter(|_| (1..=12).contains(&names.len()))
                .map(|kind| format!("{} is one of {}", kind.noun(), names.join(", ")))
        }),
    };
    // The hint may be no more than a list of what there is.
    if module.is_incomplete && !hint.as_ref().is_some_and(|hint| hint.starts_with("did you mean")) {
        return;
    }
    let message = format!("there is nothing called `{name}`");
    cx.report(Diagnostic::error(Code::UnknownFunction, span, message).maybe_hint(hint));
}

fn find_function<'a>(cx: &Cx<'a, '_>, module: usize, name: &str) -> Option<Function<'a>> {
    cx.seen_from(module).find_map(|module| module.functions.get(name)).copied()
}

fn call_function<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    function: Function<'a>,
    (arguments, span): (&'a [Argument], Span),
    slot: Slot,
) -> Value {
    let what = format!("`{}`", function.name.name);
    let inner =
        bind_arguments(cx, (scope, operand_slot(slot)), &what, (function.module, function.params), arguments, span);
    let Some(inner) = inner else { return Value::UNKNOWN };
    if cx.is_dead() || cx.is_runaway(function.name.span) || !cx.count_iteration(span) {
        return Value::UNKNOWN;
    }
    let name = function.name.span;
    cx.called(name, span, |cx| eval(cx, &inner, function.body, Slot::ANY)).unwrap_or(Value::UNKNOWN)
}

/// Evaluates a function's body once with unknown arguments.
pub(super) fn check_function<'a>(cx: &mut Cx<'a, '_>, function: Function<'a>) {
    let scope = unknown_arguments(cx, function.module, function.params);
    eval(cx, &scope, function.body, Slot::of(Kind::Field));
}

/// A scope in which the parameters have their defaults, or are unknown.
pub(super) fn unknown_arguments<'a>(cx: &mut Cx<'a, '_>, module: usize, params: &'a [ast::Parameter]) -> Rc<Scope<'a>> {
    let scope = Scope::inside(&cx.modules[module].scope);
    for param in params {
        let kind = param.ty.as_ref().and_then(|ty| named_kind(cx, ty));
        if let Some(default) = &param.default {
            let value = expect(cx, &scope, default, kind.map_or(Slot::ANY, Slot::of));
            declare_param(cx, &scope, param, Value::Unknown(kind.or(value.kind())));
        } else {
            declare_param(cx, &scope, param, Value::Unknown(kind));
        }
    }
    scope
}

fn declare_param<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, param: &'a ast::Parameter, value: Value) {
    cx.note_value(param.name.span, &value);
    if let Some(earlier) = scope.declare(&param.name.name, Binding::Value(value), param.name.span) {
        cx.report(super::modules::declared_twice(&param.name, earlier));
    }
}

/// A scope with the parameters of a function or tone bound to arguments that are evaluated in the caller's scope; where
/// a parameter takes anything, the names of the caller's place are known, as in `f(x)` in a field. `None` where one is
/// missing, which was reported.
pub(super) fn bind_arguments<'a>(
    cx: &mut Cx<'a, '_>,
    (caller, around): (&Rc<Scope<'a>>, Slot),
    what: &str,
    (module, params): (usize, &'a [ast::Parameter]),
    arguments: &'a [Argument],
    span: Span,
) -> Option<Rc<Scope<'a>>> {
    let names: Vec<&str> = params.iter().map(|param| param.name.name.as_str()).collect();
    let places = call::assign(cx, what, &names, arguments);
    let scope = Scope::inside(&cx.modules[module].scope);
    let mut whole = true;
    for argument in arguments.iter().zip(&places).filter(|(_, place)| place.is_none()).map(|(argument, _)| argument) {
        eval(cx, caller, &argument.value, Slot::of(Kind::Field));
    }
    for (argument, place) in arguments.iter().zip(&places) {
        if let (Some(label), Some(place)) = (&argument.name, place) {
            cx.note_use(label.span, params[*place].name.span);
        }
    }
    for (i, param) in params.iter().enumerate() {
        let given = places.iter().position(|place| *place == Some(i)).map(|given| &arguments[given].value);
        let pinned = param.ty.as_ref().and_then(|ty| named_kind(cx, ty));
        let value = match (given, &param.default) {
            (Some(given), default) => {
                let kind = match (pinned, default) {
                    (None, Some(default)) => eval(cx, &scope, default, Slot::ANY).kind(),
                    (pinned, _) => pinned,
                };
                match kind {
                    Some(kind) => expect(cx, caller, given, Slot::of(kind)),
                    None => eval(cx, caller, given, around),
                }
            }
            (None, Some(default)) => expect(cx, &scope, default, pinned.map_or(Slot::ANY, Slot::of)),
            (None, None) => {
                // An argument that none of the parameters took may have been meant for this one.
                if !places.contains(&None) {
                    let message = format!("{what} needs `{}`", param.name.name);
                    let diagnostic = Diagnostic::error(Code::Missing, span, message);
                    cx.report(diagnostic.note(param.name.span, "declared here"));
                }
                whole = false;
                Value::Unknown(pinned)
            }
        };
        declare_param(cx, &scope, param, value);
    }
    whole.then_some(scope)
}
