//! What a document says, apart from where it says so: the ground on which two documents are called the same.
//!
//! In: a tree. Out: a text in which everything but spans and comments stands, so that two trees have one text if and
//! only if they say the same. `fmt` and `convert` are held to it.

use std::fmt::Write;

use crate::syntax::ast::{
    Argument, Binding, Doc, Document, Expr, ExprKind, Ident, Parameter, Pattern, Property, Statement, StatementKind,
    StringPart, ToneBody, UnaryOp,
};

/// What a document says. Comments other than doc comments are left out.
#[must_use]
pub fn shape(document: &Document) -> String {
    let mut out = String::new();
    for statement in &document.statements {
        put_statement(&mut out, statement);
        out.push('\n');
    }
    out
}

/// What an expression says.
#[must_use]
pub fn expression_shape(expr: &Expr) -> String {
    let mut out = String::new();
    put_expr(&mut out, expr);
    out
}

/// Writes to a string, which cannot fail.
macro_rules! put {
    ($out:expr, $($part:tt)*) => {{
        let _ = write!($out, $($part)*);
    }};
}

fn put_statement(out: &mut String, statement: &Statement) {
    put_doc(out, statement.doc.as_ref());
    match &statement.kind {
        StatementKind::Edition(value) => put_node(out, "edition", &[value]),
        StatementKind::Seed(value) => put_node(out, "seed", &[value]),
        StatementKind::Import { path, alias } => {
            put!(out, "(import {:?} ", path.value);
            put_name(out, alias.as_ref());
            out.push(')');
        }
        StatementKind::Canvas(properties) => put_properties(out, "canvas", properties),
        StatementKind::Let(binding) => put_binding(out, "let", binding),
        StatementKind::Field(binding) => put_binding(out, "field", binding),
        StatementKind::Region(binding) => put_binding(out, "region", binding),
        StatementKind::Param { binding, domain } => {
            put_binding(out, "param", binding);
            put_optional(out, "in", domain.as_ref());
        }
        StatementKind::Tone { name, params, body } => {
            put!(out, "(tone {:?}", name.name);
            params.iter().for_each(|parameter| put_parameter(out, parameter));
            match body {
                ToneBody::Properties(properties) => put_properties(out, "has", properties),
                ToneBody::Derived { base, with } => {
                    put_node(out, "from", &[base]);
                    put_properties(out, "with", with);
                }
            }
            out.push(')');
        }
        StatementKind::Fn { name, params, body } => {
            put!(out, "(fn {:?}", name.name);
            params.iter().for_each(|parameter| put_parameter(out, parameter));
            put_node(out, "=", &[body]);
            out.push(')');
        }
        StatementKind::Paint { region, tone, name, seed } => {
            put_node(out, "paint", &[region, tone]);
            put_optional(out, "as", name.as_ref());
            put_optional(out, "seed", seed.as_ref());
        }
        StatementKind::Outline { region, pen } => {
            put_node(out, "outline", &[region]);
            put_optional(out, "pen", pen.as_ref());
        }
        StatementKind::Ink { drawing } => put_node(out, "ink", &[drawing]),
        StatementKind::Layer { name, ink, body } => {
            put_node(out, "layer", &[name]);
            put_optional(out, "ink", ink.as_ref());
            put_body(out, body);
        }
        StatementKind::For { variable, iterable, body } => {
            put!(out, "for {:?} ", variable.name);
            put_expr(out, iterable);
            put_body(out, body);
        }
        StatementKind::If { branches, otherwise } => {
            for (condition, body) in branches {
                put_node(out, "if", &[condition]);
                put_body(out, body);
            }
            if let Some(body) = otherwise {
                out.push_str(" else ");
                put_body(out, body);
            }
        }
        StatementKind::Experiment { name, properties } => {
            put!(out, "(experiment {:?}", name.name);
            put_properties(out, "has", properties);
            out.push(')');
        }
    }
}

fn put_body(out: &mut String, body: &[Statement]) {
    out.push('{');
    for statement in body {
        put_statement(out, statement);
        out.push(';');
    }
    out.push('}');
}

fn put_doc(out: &mut String, doc: Option<&Doc>) {
    if let Some(doc) = doc {
        // White space at the ends of a comment's lines says nothing.
        let lines: Vec<&str> = doc.text.split('\n').map(str::trim_end).collect();
        put!(out, "doc {lines:?} ");
    }
}

fn put_name(out: &mut String, name: Option<&Ident>) {
    match name {
        Some(name) => put!(out, "{:?}", name.name),
        None => out.push('-'),
    }
}

fn put_binding(out: &mut String, kind: &str, binding: &Binding) {
    put!(out, "({kind} {:?} ", binding.name.name);
    put_name(out, binding.ty.as_ref());
    out.push(' ');
    put_expr(out, &binding.value);
    out.push(')');
}

fn put_parameter(out: &mut String, parameter: &Parameter) {
    out.push('(');
    put_doc(out, parameter.doc.as_ref());
    put!(out, "{:?} ", parameter.name.name);
    put_name(out, parameter.ty.as_ref());
    put_optional(out, "=", parameter.default.as_ref());
    out.push(')');
}

fn put_properties(out: &mut String, kind: &str, properties: &[Property]) {
    put!(out, "({kind}");
    for property in properties {
        out.push_str(" (");
        put_doc(out, property.doc.as_ref());
        put!(out, "{:?} ", property.name.name);
        put_expr(out, &property.value);
        out.push(')');
    }
    out.push(')');
}

fn put_optional(out: &mut String, kind: &str, expr: Option<&Expr>) {
    if let Some(expr) = expr {
        put_node(out, kind, &[expr]);
    }
}

fn put_node(out: &mut String, kind: &str, members: &[&Expr]) {
    put!(out, "({kind}");
    for member in members {
        out.push(' ');
        put_expr(out, member);
    }
    out.push(')');
}

fn put_list(out: &mut String, kind: &str, members: &[Expr]) {
    put_node(out, kind, &members.iter().collect::<Vec<_>>());
}

fn put_expr(out: &mut String, expr: &Expr) {
    match &expr.kind {
        ExprKind::Number { value: _, text, unit } => put!(out, "{text}{}", unit.map_or("", |unit| unit.symbol())),
        ExprKind::Colour(text) => out.push_str(text),
        ExprKind::String(parts) => put_string(out, parts),
        ExprKind::Bool(value) => put!(out, "{value}!"),
        ExprKind::Name(name) => put!(out, "{name:?}"),
        ExprKind::Member(base, name) => {
            put_node(out, "member", &[base]);
            put_name(out, Some(name));
        }
        ExprKind::Call(callee, arguments) => {
            put_node(out, "call", &[callee]);
            out.push('(');
            for Argument { name, value } in arguments {
                put_name(out, name.as_ref());
                out.push(':');
                put_expr(out, value);
                out.push(' ');
            }
            out.push(')');
        }
        ExprKind::Index(base, index) => put_node(out, "index", &[base, index]),
        ExprKind::Group(inner) => put_node(out, "group", &[inner]),
        ExprKind::Tuple(members) => put_list(out, "tuple", members),
        ExprKind::List(members) => put_list(out, "list", members),
        ExprKind::Range(from, to) => put_node(out, "range", &[from, to]),
        ExprKind::Record(properties) => put_properties(out, "record", properties),
        ExprKind::Unary(operators, operand) => {
            for operator in operators {
                out.push_str(match operator {
                    UnaryOp::Minus => "minus ",
                    UnaryOp::Not => "not ",
                });
            }
            put_node(out, "of", &[operand]);
        }
        ExprKind::Binary(first, rest) => {
            put_node(out, "chain", &[first]);
            for (operator, operand) in rest {
                put_node(out, operator.symbol(), &[operand]);
            }
        }
        ExprKind::If { branches, otherwise } => {
            for (condition, value) in branches {
                put_node(out, "if", &[condition, value]);
            }
            put_node(out, "else", &[otherwise]);
        }
        ExprKind::Match { subject, arms } => {
            put_node(out, "match", &[subject]);
            out.push('{');
            for arm in arms {
                match &arm.pattern {
                    Pattern::String(text) => put!(out, "{text:?}"),
                    Pattern::Number(_, text) => out.push_str(text),
                    Pattern::Bool(value) => put!(out, "{value}!"),
                    Pattern::Any => out.push('_'),
                }
                put_node(out, "=>", &[&arm.value]);
            }
            out.push('}');
        }
        ExprKind::Error => out.push_str("error!"),
    }
}

/// Pieces of plain text that touch are one piece, and an empty one is none.
fn put_string(out: &mut String, parts: &[StringPart]) {
    out.push_str("(string");
    let mut text = String::new();
    for part in parts {
        match part {
            StringPart::Text(piece) => text.push_str(piece),
            StringPart::Expr(expr) => {
                put!(out, " {text:?} ");
                text.clear();
                put_expr(out, expr);
            }
        }
    }
    put!(out, " {text:?})");
}
