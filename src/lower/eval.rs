//! The evaluator: what an expression is worth in its scope and its place.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, did_you_mean, grouped};
use crate::geom::Length;
use crate::scene::Colour;
use crate::span::Span;
use crate::syntax::ast::{self, Argument, Expr, ExprKind, Pattern, StringPart, Unit};

use super::convert::{self, Slot, coerce};
use super::cx::Cx;
use super::modules::Function;
use super::scope::{Binding, Declared, Scope};
use super::value::{FieldUnit, Kind, Member, TypedField, Value};
use super::{call, ops, params, tone, vocabulary};

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
        ExprKind::Colour(text) => colour(text),
        ExprKind::String(parts) => string(cx, scope, parts, expr.span),
        ExprKind::Bool(truth) => Value::Bool(*truth),
        ExprKind::Name(name) => self::name(cx, scope, name, expr.span, slot),
        ExprKind::Member(module, member) => self::member(cx, scope, module, member),
        ExprKind::Call(callee, arguments) => self::call(cx, scope, callee, arguments, expr.span, slot),
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
        ExprKind::If { branches, otherwise } => choose(cx, scope, branches, otherwise, slot, expr.span),
        ExprKind::Match { subject, arms } => self::matching(cx, scope, subject, arms, slot, expr.span),
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

/// What a bare name stands for: a local, else a word of its place.
fn name<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &str, span: Span, slot: Slot) -> Value {
    // Tones have a name space of their own, so that a value of another kind does not hide one.
    let tone = if slot.kind == Some(Kind::Tone) { tone::find(cx, scope.module, name) } else { None };
    match (lookup(cx, scope, name, span), tone) {
        (Some(value @ (Value::Tone(_) | Value::Unknown(_))), _) | (Some(value), None) => return value,
        (_, Some(tone)) => return tone::instantiate(cx, scope, tone, &[], span),
        (None, None) => {}
    }
    if let Some(word) = slot.words.iter().find(|word| **word == convert::spelling(name)) {
        return Value::Word(word);
    }
    if let Some(value) = vocabulary::name(cx, name, span, slot) {
        return value;
    }
    if vocabulary::is_later(name) {
        cx.report(call::not_yet(name, span));
        return Value::UNKNOWN;
    }
    if cx.modules[scope.module].broken.contains(name) {
        return Value::UNKNOWN;
    }
    let hint = name_hint(cx, scope, name, slot);
    // What an import would have brought that could not be read is not missed again.
    if hint.is_none() && cx.modules[scope.module].is_incomplete {
        return Value::UNKNOWN;
    }
    cx.report(Diagnostic::error(Code::UnknownName, span, format!("`{name}` is not known here")).maybe_hint(hint));
    Value::UNKNOWN
}

fn name_hint<'a>(cx: &Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &str, slot: Slot) -> Option<String> {
    if cx.is_swamped() {
        return None;
    }
    if matches!(name, "x" | "y") {
        return Some(format!("`{name}` is a point's place in fields: `field f = …`"));
    }
    if tone::find(cx, scope.module, name).is_some() {
        return Some(format!("`{name}` is a tone: `paint REGION with {name}`"));
    }
    let module = &cx.modules[scope.module];
    if module.aliases.contains_key(name) {
        return Some(format!("`{name}` is a module: `{name}.something`"));
    }
    if slot.kind == Some(Kind::String) {
        return Some(format!("a string is written in quotes: `\"{name}\"`"));
    }
    let mut known: Vec<&str> = slot.words.to_vec();
    known.extend(visible(cx, scope));
    known.extend(vocabulary::names(slot));
    if slot.kind == Some(Kind::Colour) {
        return did_you_mean(name, known)
            .or_else(|| Some("colours are `#rrggbb`, or CSS names such as `navy`".to_owned()));
    }
    did_you_mean(name, known).or_else(|| {
        let words = slot.words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>();
        (!words.is_empty()).then(|| format!("this takes {}", words.join(", ")))
    })
}

/// Every local and imported name that can be seen from a scope.
fn visible<'a>(cx: &Cx<'a, '_>, scope: &Rc<Scope<'a>>) -> Vec<&'a str> {
    let mut names = Vec::new();
    let mut next = Some(scope);
    while let Some(scope) = next {
        names.extend(scope.own_names());
        next = scope.parent();
    }
    for &opened in &cx.modules[scope.module].opened {
        names.extend(cx.modules[opened].scope.own_names());
    }
    names
}

/// The value of a local or imported name.
pub(super) fn lookup<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &str, span: Span) -> Option<Value> {
    let mut next = Some(scope);
    while let Some(scope) = next {
        if scope.own(name).is_some() {
            return Some(force(cx, scope, name, span));
        }
        next = scope.parent();
    }
    let modules = cx.modules;
    let opened = modules[scope.module].opened.iter().find(|&&opened| modules[opened].scope.own(name).is_some());
    opened.map(|&opened| force(cx, &modules[opened].scope, name, span))
}

/// The value of a name that a scope declares, found now if it was not asked for before. `span` is where it is asked for.
pub(super) fn force<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &str, span: Span) -> Value {
    let Some(entry) = scope.own(name) else { return Value::UNKNOWN };
    match entry.binding {
        Binding::Value(value) => value,
        Binding::Busy => {
            let from = cx.naming.iter().rposition(|(busy, _)| busy == name).map_or(cx.naming.len(), |at| at + 1);
            let way: Vec<String> = cx.naming[from..].iter().map(|(busy, _)| format!("`{busy}`")).collect();
            let message = match way.is_empty() {
                true => format!("`{name}` needs itself"),
                false => format!("`{name}` needs itself by way of {}", way.join(" and ")),
            };
            let diagnostic = Diagnostic::error(Code::Cycle, span, message).note(entry.span, "declared here");
            cx.report(diagnostic);
            Value::UNKNOWN
        }
        Binding::Lazy(binding, declared) => {
            scope.set(name, Binding::Busy);
            let value = cx
                .declared(span, scope.parent().is_none(), |cx| bind(cx, scope, binding, declared))
                .unwrap_or(Value::UNKNOWN);
            scope.set(name, Binding::Value(value.clone()));
            value
        }
    }
}

fn bind<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, binding: &'a ast::Binding, declared: Declared<'a>) -> Value {
    let pinned = binding.ty.as_ref().and_then(|ty| named_kind(cx, ty));
    let slot = match (pinned, declared) {
        (Some(kind), _) => Slot::of(kind),
        (None, Declared::Field) => Slot::of(Kind::Field),
        (None, Declared::Region) => Slot::of(Kind::Region),
        (None, Declared::Let | Declared::Param(_)) => Slot::ANY,
    };
    cx.naming.push((binding.name.name.clone(), 0));
    let value = expect(cx, scope, &binding.value, slot);
    cx.naming.pop();
    match declared {
        Declared::Param(domain) => params::settle(cx, scope, binding, domain, value),
        Declared::Region | Declared::Let => {
            if let Value::Region(region) = &value
                && region.is_empty()
            {
                let message = format!("the region `{}` holds nothing", binding.name.name);
                cx.report_value(Diagnostic::error(Code::EmptyRegion, binding.value.span, message));
                return Value::Unknown(Some(Kind::Region));
            }
            value
        }
        Declared::Field => value,
    }
}

/// The kind that a type name names.
pub(super) fn named_kind(cx: &mut Cx<'_, '_>, ty: &ast::Ident) -> Option<Kind> {
    let kind = Kind::from_name(&ty.name);
    if kind.is_none() {
        let names = Kind::NAMED.map(Kind::name);
        let hint = did_you_mean(&ty.name, names).unwrap_or_else(|| format!("types are {}", names.join(", ")));
        let message = format!("there is no type `{}`", ty.name);
        cx.report(Diagnostic::error(Code::UnknownType, ty.span, message).hint(hint));
    }
    kind
}

/// `module.name`.
fn member<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, base: &'a Expr, member: &ast::Ident) -> Value {
    let Some(module) = module_of(cx, scope, base) else { return Value::UNKNOWN };
    let modules = cx.modules;
    let inner = &modules[module].scope;
    if inner.own(&member.name).is_some() {
        return force(cx, inner, &member.name, member.span);
    }
    let message = format!("`{}` declares no `{}`", modules[module].path, member.name);
    let hint = if modules[module].tones.contains_key(member.name.as_str()) {
        Some(format!("`{}` is a tone: it stands behind `with`", member.name))
    } else {
        did_you_mean(&member.name, inner.own_names())
    };
    cx.report(Diagnostic::error(Code::UnknownName, member.span, message).maybe_hint(hint));
    Value::UNKNOWN
}

/// The module that an expression before a point names.
pub(super) fn module_of<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, base: &'a Expr) -> Option<usize> {
    let ExprKind::Name(name) = &base.kind else {
        if !matches!(base.kind, ExprKind::Error) {
            let message = "only modules have members: `import \"file\" as name`, then `name.something`";
            cx.report(Diagnostic::error(Code::Type, base.span, message));
        }
        return None;
    };
    let module = &cx.modules[scope.module];
    let found = module.aliases.get(name.as_str()).copied();
    if found.is_none() && visible(cx, scope).contains(&name.as_str()) {
        let message = format!("`{name}` is a value, and only modules have members");
        cx.report(Diagnostic::error(Code::Type, base.span, message));
    } else if found.is_none() && !module.lost.contains(&name.as_str()) {
        let mut hint = did_you_mean(name, module.aliases.keys().copied());
        if module.aliases.is_empty() {
            hint = Some(format!("`import \"…\" as {name}` gives a file this name"));
        }
        let message = format!("there is no module `{name}`");
        cx.report(Diagnostic::error(Code::UnknownName, base.span, message).maybe_hint(hint));
    }
    found
}

fn call<'a>(
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
                return call_function(cx, scope, function, (arguments, span), slot);
            }
            if slot.kind == Some(Kind::Tone)
                && let Some(tone) = tone::find(cx, scope.module, name)
            {
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
                return call_function(cx, scope, function, (arguments, span), slot);
            }
            if let Some(&tone) = modules[module].tones.get(member.name.as_str()) {
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
    if vocabulary::is_later(name) {
        cx.report(call::not_yet(name, span));
        return;
    }
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
    let mut known: Vec<&str> = module.functions.keys().copied().collect();
    known.extend(module.opened.iter().flat_map(|&opened| modules[opened].functions.keys().copied()));
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
    let module = &cx.modules[module];
    let opened = module.opened.iter().map(|&opened| &cx.modules[opened]);
    std::iter::once(module).chain(opened).find_map(|module| module.functions.get(name)).copied()
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
    if let Some(earlier) = scope.declare(&param.name.name, Binding::Value(value), param.name.span) {
        cx.report(super::modules::declared_twice(&param.name, earlier));
    }
}

/// A scope with the parameters of a function or tone bound to arguments that are evaluated in the caller's scope; where
/// a parameter takes anything, the names of the caller's place are known, as in `f(x)` in a field. `None` where one is missing, which was reported.
pub(super) fn bind_arguments<'a>(
    cx: &mut Cx<'a, '_>,
    (caller, around): (&Rc<Scope<'a>>, Slot),
    what: &str,
    (module, params): (usize, &'a [ast::Parameter]),
    arguments: &'a [Argument],
    span: Span,
) -> Option<Rc<Scope<'a>>> {
    let names: Vec<&str> = params.iter().map(|param| param.name.name.as_str()).collect();
    let places = call::assign(cx, what, (&names, &[]), arguments);
    let scope = Scope::inside(&cx.modules[module].scope);
    let mut whole = true;
    for argument in arguments.iter().zip(&places).filter(|(_, place)| place.is_none()).map(|(argument, _)| argument) {
        eval(cx, caller, &argument.value, Slot::of(Kind::Field));
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
fn operand_slot(slot: Slot) -> Slot {
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

fn choose<'a>(
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

fn matching<'a>(
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
