//! Names: what a bare name or a module's member stands for, found when it is first asked for.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::span::Span;
use crate::syntax::ast::{self, Expr, ExprKind};

use super::convert::{self, Slot};
use super::cx::Cx;
use super::eval::expect;
use super::scope::{Binding, Declared, Scope};
use super::value::{Kind, Value};
use super::{params, tone, vocabulary};

/// What a bare name stands for: a local, else a word of its place.
pub(super) fn name<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, name: &str, span: Span, slot: Slot) -> Value {
    // Tones have a name space of their own, so that a value of another kind does not hide one.
    let tone = if slot.kind == Some(Kind::Tone) { tone::find(cx, scope.module, name) } else { None };
    match (lookup(cx, scope, name, span), tone) {
        (Some(value @ (Value::Tone(_) | Value::Unknown(_))), _) | (Some(value), None) => return value,
        (_, Some(tone)) => {
            cx.note_use(span, tone.name.span);
            return tone::instantiate(cx, scope, tone, &[], span);
        }
        (None, None) => {}
    }
    if let Some(word) = slot.words.iter().find(|word| **word == convert::spelling(name)) {
        return Value::Word(word);
    }
    if let Some(value) = vocabulary::name(cx, name, span, slot) {
        cx.note_colour(span, &value);
        return value;
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
pub(super) fn visible<'a>(cx: &Cx<'a, '_>, scope: &Rc<Scope<'a>>) -> Vec<&'a str> {
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
        if let Some(entry) = scope.own(name) {
            cx.note_use(span, entry.span);
            return Some(force(cx, scope, name, span));
        }
        next = scope.parent();
    }
    let modules = cx.modules;
    let mut opened = modules[scope.module].opened.iter();
    let (module, entry) = opened.find_map(|&opened| Some((opened, modules[opened].scope.own(name)?)))?;
    cx.note_use(span, entry.span);
    Some(force(cx, &modules[module].scope, name, span))
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
            cx.note_value(entry.span, &value);
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
pub(super) fn member<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, base: &'a Expr, member: &ast::Ident) -> Value {
    let Some(module) = module_of(cx, scope, base) else { return Value::UNKNOWN };
    let modules = cx.modules;
    let inner = &modules[module].scope;
    if let Some(entry) = inner.own(&member.name) {
        cx.note_use(member.span, entry.span);
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
    if found.is_some() {
        cx.note_module(base.span, module, name);
    }
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
