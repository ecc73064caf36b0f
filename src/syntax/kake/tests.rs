//! Tests of the `.kake` front end, and what they share.
#![allow(clippy::unwrap_used, clippy::panic)]

mod laws;
mod mistakes;
mod nesting;
mod reading;

use super::*;
use crate::span::{Sources, Syntax};
use crate::syntax::ast::{Argument, ExprKind, Pattern, StatementKind, StringPart, UnaryOp};

/// A scene with every statement, value and operator of the language.
const SCENE: &str = r##"// A scene that uses all of the language.
edition 1

import "tones/manga.kake"
import "hand.kake" as hand

canvas { size: (90mm, 2.5cm), dpi: 600, paper: #fffef8, repeat: false }
seed 7

/// Width of every stroke
/// in this scene
param pen: length = 0.18mm in 0.1mm .. 0.6mm
param mode = "grid" in ["grid", "disk"]

let count = 1e3 % 7 + -2 ^ 2 * (3 - 1) / 4
let names = ["a {count} b", "brace \{ \u{3042}\n",]
let inks = { dark: #123, light: #12345678 other: red }
region body = svg("pear.svg", id: "path50", fit: (8mm, 8mm, 74mm, 74mm)) - circle(center: (1, 2), radius: 3) & canvas
field shade: field = linear(from: (20mm, 30mm), to: (75mm, 70mm), start: 50%, end: 4 * pen)

fn shrink(r, by: length = 1mm) = inset(r, if by > 0mm and not (by >= 9mm) then by else if by == 0mm then 0 else -by)

/// A tone.
tone plain(
  /// How dark.
  k: field = 1,
  seed,
) {
  place: match mode { "grid" => grid(columns: 8, rows: 8), "disk" => poisson(radius: 6mm) _ => hex(spacing: 3pt) }
  domain: region
  /// Turned step by step.
  angle: bfs(candidates: 360) /* the default */
  k: k
}

tone thin(k: field = 1) = hand.plain(k: k) with { fill: lines(pitch: 0.5mm, pen: 0.1mm) }

layer "ground" ink #333333 {
  for i in 0 .. 2 {
    paint shrink(body, by: 1mm) with thin(k: 2) as "ground {i}" seed i + 1
  }
  for r in [body, canvas] { outline r pen 0.3mm }
}

if mode == "grid" {
  paint body with plain
} else if count != 3 or false {
  paint body with hand.sketchy
} else {
  outline body pen pen
  outline canvas
  ink svg("figure.svg", layer: "hair")
}

experiment factorial {
  seeds: 0 .. 99
  factors: { mode: ["grid", "disk"], inner: { a: [1, 2], b: true } }
}
"##;

/// The source that tests read from.
fn source() -> SourceId {
    Sources::new().add("scene.kake", "", Syntax::Kake)
}

/// Reads a text that is free of mistakes.
fn read(text: &str) -> Document {
    let (document, diagnostics) = parse(source(), text);
    assert_eq!(diagnostics, [], "in {text}");
    document
}

/// What is wrong with a text: the text under each span, the message and the hint.
fn mistakes(text: &str) -> Vec<String> {
    let (_, diagnostics) = parse(source(), text);
    diagnostics.iter().map(|diagnostic| line(text, diagnostic)).collect()
}

fn line(text: &str, diagnostic: &Diagnostic) -> String {
    let span = diagnostic.span.unwrap();
    let place = &text[span.start as usize..span.end as usize];
    let hint = diagnostic.hint.as_deref().map(|hint| format!(" ({hint})")).unwrap_or_default();
    format!("{place}: {}{hint}", diagnostic.message)
}

/// The value of `let v = …`.
fn value(text: &str) -> Expr {
    let document = read(&format!("let v = {text}"));
    let [statement] = document.statements.as_slice() else { panic!("one statement in {text}") };
    let StatementKind::Let(binding) = &statement.kind else { panic!("a let in {text}") };
    binding.value.clone()
}

/// An expression with all its structure visible.
fn show(expr: &Expr) -> String {
    let list = |members: &[Expr]| members.iter().map(show).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        ExprKind::Number { text, unit, .. } => format!("{text}{}", unit.map_or("", |unit| unit.symbol())),
        ExprKind::Colour(text) | ExprKind::Name(text) => text.clone(),
        ExprKind::String(parts) => {
            let parts = parts.iter().map(|part| match part {
                StringPart::Text(text) => text.clone(),
                StringPart::Expr(inner) => format!("{{{}}}", show(inner)),
            });
            format!("'{}'", parts.collect::<String>())
        }
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Member(module, name) => format!("{}.{}", show(module), name.name),
        ExprKind::Call(callee, arguments) => {
            let argument = |argument: &Argument| match &argument.name {
                Some(name) => format!("{}: {}", name.name, show(&argument.value)),
                None => show(&argument.value),
            };
            format!("{}({})", show(callee), arguments.iter().map(argument).collect::<Vec<_>>().join(", "))
        }
        ExprKind::Index(of, at) => format!("{}[{}]", show(of), show(at)),
        ExprKind::Group(inner) => format!("group({})", show(inner)),
        ExprKind::Tuple(members) => format!("tuple({})", list(members)),
        ExprKind::List(members) => format!("[{}]", list(members)),
        ExprKind::Range(from, to) => format!("<{} .. {}>", show(from), show(to)),
        ExprKind::Record(entries) => {
            let entries = entries.iter().map(|entry| format!("{}: {}", entry.name.name, show(&entry.value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        ExprKind::Unary(operators, inner) => {
            let operator = |operator: &UnaryOp| match operator {
                UnaryOp::Minus => "-",
                UnaryOp::Not => "not ",
            };
            format!("<{}{}>", operators.iter().map(operator).collect::<String>(), show(inner))
        }
        ExprKind::Binary(first, others) => {
            let others = others.iter().map(|(operator, other)| format!(" {} {}", operator.symbol(), show(other)));
            format!("<{}{}>", show(first), others.collect::<String>())
        }
        ExprKind::If { branches, otherwise } => {
            let branch =
                |(condition, value): &(Expr, Expr)| format!("if {} then {} else ", show(condition), show(value));
            format!("<{}{}>", branches.iter().map(branch).collect::<String>(), show(otherwise))
        }
        ExprKind::Match { subject, arms } => {
            let arms = arms.iter().map(|arm| {
                let pattern = match &arm.pattern {
                    Pattern::String(text) => format!("'{text}'"),
                    Pattern::Number(_, text) => text.clone(),
                    Pattern::Bool(value) => value.to_string(),
                    Pattern::Any => "_".to_owned(),
                };
                format!("{pattern} => {}", show(&arm.value))
            });
            format!("match {} {{{}}}", show(subject), arms.collect::<Vec<_>>().join(", "))
        }
        ExprKind::Error => "error".to_owned(),
    }
}
