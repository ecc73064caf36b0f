//! Drawing statements: paints, outlines and layers, with the loops and conditions around them.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::diag::{Code, Diagnostic};
use crate::geom::Length;
use crate::region::Region;
use crate::scene::{Colour, Draw, Ink, LayerGroup, Outline, Paint};
use crate::span::Span;
use crate::syntax::ast::{Expr, Ident, Statement, StatementKind};

use super::convert::Slot;
use super::cx::Cx;
use super::scope::{Binding, Scope};
use super::tone::{self, ToneValue};
use super::value::{Kind, Value};
use super::{branch, canvas, eval, modules, names, repeat, vocabulary};

/// What is drawn before paints have their names.
enum Drawn {
    Paint(Box<Painted>),
    Outline(Outline),
    Ink(Ink),
    Layer { name: String, ink: Option<Colour>, draws: Vec<Self> },
}

struct Painted {
    region: Region,
    tone: Rc<ToneValue>,
    name: Option<(String, Span)>,
    seed: Option<u64>,
    span: Span,
    /// Where the tone is named.
    tone_span: Span,
}

/// Whether a statement draws, or may.
pub(super) fn is_drawing(kind: &StatementKind) -> bool {
    match kind {
        StatementKind::Paint { .. }
        | StatementKind::Outline { .. }
        | StatementKind::Ink { .. }
        | StatementKind::Layer { .. }
        | StatementKind::For { .. }
        | StatementKind::If { .. } => true,
        StatementKind::Edition(_)
        | StatementKind::Import { .. }
        | StatementKind::Canvas(_)
        | StatementKind::Seed(_)
        | StatementKind::Let(_)
        | StatementKind::Param { .. }
        | StatementKind::Field(_)
        | StatementKind::Region(_)
        | StatementKind::Tone { .. }
        | StatementKind::Fn { .. }
        | StatementKind::Experiment { .. } => false,
    }
}

/// Reports statements that stand where they may not.
pub(super) fn check_order<'a>(cx: &mut Cx<'a, '_>, statements: &'a [Statement], main: bool) {
    let mut first_drawing: Option<Span> = None;
    let mut seen: BTreeMap<&'static str, Span> = BTreeMap::new();
    for statement in statements {
        let word = match &statement.kind {
            StatementKind::Edition(edition) => {
                canvas::check_edition(cx, edition);
                "edition"
            }
            StatementKind::Canvas(_) => "canvas",
            StatementKind::Seed(_) => "seed",
            kind => {
                if is_drawing(kind) && first_drawing.is_none() {
                    first_drawing = Some(statement.span);
                }
                check_nested(cx, kind);
                continue;
            }
        };
        if let Some(earlier) = seen.insert(word, statement.span) {
            let message = format!("`{word}` is given twice");
            cx.report(Diagnostic::error(Code::Order, statement.span, message).note(earlier, "first given here"));
        } else if let Some(drawing) = first_drawing
            && main
        {
            let message = format!("`{word}` stands after something that draws");
            let diagnostic = Diagnostic::error(Code::Order, statement.span, message);
            cx.report(diagnostic.note(drawing, "this draws").hint(format!("move `{word}` to the top of the file")));
        }
    }
}

/// Statements inside blocks that may only stand at the top level.
fn check_nested(cx: &mut Cx<'_, '_>, kind: &StatementKind) {
    let bodies: Vec<&Vec<Statement>> = match kind {
        StatementKind::Layer { body, .. } | StatementKind::For { body, .. } => vec![body],
        StatementKind::If { branches, otherwise } => {
            branches.iter().map(|(_, body)| body).chain(otherwise.iter()).collect()
        }
        _ => return,
    };
    for statement in bodies.into_iter().flatten() {
        let word = match &statement.kind {
            StatementKind::Edition(_) => "edition",
            StatementKind::Import { .. } => "import",
            StatementKind::Canvas(_) => "canvas",
            StatementKind::Seed(_) => "seed",
            StatementKind::Param { .. } => "param",
            StatementKind::Tone { .. } => "tone",
            StatementKind::Fn { .. } => "fn",
            StatementKind::Experiment { .. } => "experiment",
            nested => {
                check_nested(cx, nested);
                continue;
            }
        };
        let message = format!("`{word}` stands only at the top level of a file");
        cx.report(Diagnostic::error(Code::Order, statement.span, message));
    }
}

/// Carries out the drawing statements of the first module.
pub(super) fn lower(cx: &mut Cx<'_, '_>) -> Vec<Draw> {
    let modules = cx.modules;
    let Some(module) = modules.first() else { return Vec::new() };
    let mut drawn = Vec::new();
    run(cx, &module.scope, &module.document.statements, &mut drawn);
    let names = name_paints(cx, &drawn);
    let mut names = names.into_iter();
    finish(cx, drawn, &mut names)
}

/// Carries out the statements of a block in their own scope.
fn block<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, body: &'a [Statement], out: &mut Vec<Drawn>) {
    for statement in body {
        if let Some((name, earlier)) = modules::declare_binding(&statement.kind, scope) {
            cx.report(modules::declared_twice(name, earlier));
        }
    }
    for statement in body {
        match &statement.kind {
            StatementKind::Let(binding) | StatementKind::Field(binding) | StatementKind::Region(binding) => {
                names::force(cx, scope, &binding.name.name, binding.name.span);
            }
            _ => {}
        }
    }
    run(cx, scope, body, out);
}

fn run<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, body: &'a [Statement], out: &mut Vec<Drawn>) {
    for statement in body {
        match &statement.kind {
            StatementKind::Paint { region, tone, name, seed } => {
                let painted = paint(cx, scope, (region, tone), (name.as_ref(), seed.as_ref()), statement.span);
                out.extend(painted.map(|painted| Drawn::Paint(Box::new(painted))));
            }
            StatementKind::Outline { region, pen } => {
                out.extend(outline(cx, scope, region, pen.as_ref(), statement.span).map(Drawn::Outline));
            }
            StatementKind::Ink { drawing } => {
                let drawing = eval::expect(cx, scope, drawing, Slot::of(Kind::Drawing));
                if let (Value::Drawing(marks), false) = (drawing, cx.is_dead()) {
                    out.push(Drawn::Ink(Ink { marks: marks.to_vec(), span: statement.span }));
                }
            }
            StatementKind::Layer { name, ink, body } => {
                let name = eval::expect(cx, scope, name, Slot::of(Kind::String));
                let ink = match ink.as_ref().map(|ink| eval::expect(cx, scope, ink, Slot::of(Kind::Colour))) {
                    Some(Value::Colour(ink)) => Some(ink),
                    _ => None,
                };
                let name = match name {
                    Value::String(text) => text.value.to_string(),
                    _ => String::new(),
                };
                let mut draws = Vec::new();
                deeper(cx, statement.span, |cx| block(cx, &Scope::inside(scope), body, &mut draws));
                out.push(Drawn::Layer { name, ink, draws });
            }
            StatementKind::For { variable, iterable, body } => {
                deeper(cx, statement.span, |cx| repeat(cx, scope, (variable, iterable), body, out));
            }
            StatementKind::If { branches, otherwise } => {
                deeper(cx, statement.span, |cx| choose(cx, scope, branches, otherwise.as_deref(), out));
            }
            _ => {}
        }
    }
}

fn deeper<'a, 'c>(cx: &mut Cx<'a, 'c>, span: Span, inner: impl FnOnce(&mut Cx<'a, 'c>)) {
    // What is too deep was reported, and nothing more of it is drawn.
    let _: Option<()> = cx.deeper(span, inner);
}

fn repeat<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    (variable, iterable): (&'a Ident, &'a Expr),
    body: &'a [Statement],
    out: &mut Vec<Drawn>,
) {
    let over = eval::eval(cx, scope, iterable, Slot::ANY);
    let mut ran = false;
    let mut round = |cx: &mut Cx<'a, '_>, value: Value| {
        if !cx.count_iteration(iterable.span) {
            return false;
        }
        ran = true;
        let inner = Scope::inside(scope);
        cx.note_value(variable.span, &value);
        inner.declare(&variable.name, Binding::Value(value), variable.span);
        block(cx, &inner, body, out);
        true
    };
    match &over {
        Value::List(members) => {
            for member in members.iter() {
                if !round(cx, member.clone()) {
                    return;
                }
            }
        }
        Value::Range(ends) => {
            let (Value::Number(low), Value::Number(high)) = &**ends else {
                let message =
                    format!("a loop counts in whole numbers, not from {} to {}", ends.0.text(), ends.1.text());
                cx.report_value(Diagnostic::error(Code::Type, iterable.span, message));
                return;
            };
            if low.fract() != 0.0 || high.fract() != 0.0 {
                let message = format!("a loop counts in whole numbers, not from {low} to {high}");
                cx.report_value(Diagnostic::error(Code::Range, iterable.span, message));
                return;
            }
            let mut next = *low;
            while next <= *high {
                if !round(cx, Value::Number(next)) {
                    return;
                }
                next += 1.0;
            }
        }
        Value::Unknown(None | Some(Kind::List | Kind::Range)) => {}
        other => {
            let message = format!("a loop goes over a range or a list, not {}", other.describe());
            cx.report(Diagnostic::error(Code::Type, iterable.span, message));
        }
    }
    if !ran {
        let kind = matches!(over, Value::Range(_)).then_some(Kind::Number);
        cx.dead(|cx| {
            let inner = Scope::inside(scope);
            inner.declare(&variable.name, Binding::Value(Value::Unknown(kind)), variable.span);
            block(cx, &inner, body, &mut Vec::new());
        });
    }
}

fn choose<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    branches: &'a [(Expr, Vec<Statement>)],
    otherwise: Option<&'a [Statement]>,
    out: &mut Vec<Drawn>,
) {
    let mut taken = false;
    for (condition, body) in branches {
        let holds = branch::condition(cx, scope, condition, Slot::ANY);
        if let Value::Field(_) = holds {
            let message = "this condition varies over the page, but a statement is carried out or not";
            cx.report(Diagnostic::error(Code::Type, condition.span, message));
        }
        if !taken && matches!(holds, Value::Bool(true)) {
            taken = true;
            block(cx, &Scope::inside(scope), body, out);
        } else {
            // Where the condition is not known, what follows must not run either.
            taken |= !matches!(holds, Value::Bool(_));
            check_only(cx, scope, condition.span, body);
        }
    }
    if let Some(body) = otherwise {
        if taken {
            let span = body.first().map_or(branches.last().map(|(last, _)| last.span), |first| Some(first.span));
            if let Some(span) = span {
                check_only(cx, scope, span, body);
            }
        } else {
            block(cx, &Scope::inside(scope), body, out);
        }
    }
}

fn check_only<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, span: Span, body: &'a [Statement]) {
    cx.dead_once(span, |cx| block(cx, &Scope::inside(scope), body, &mut Vec::new()));
}

fn paint<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    (region, tone): (&'a Expr, &'a Expr),
    (name, seed): (Option<&'a Expr>, Option<&'a Expr>),
    span: Span,
) -> Option<Painted> {
    let area = eval::expect(cx, scope, region, Slot::of(Kind::Region));
    let value = tone::expect_tone(cx, scope, tone);
    let name = name.map(|name| (eval::expect(cx, scope, name, Slot::of(Kind::String)), name.span));
    let seed = seed.and_then(|seed| canvas::seed_value(cx, scope, seed));
    if cx.is_dead() {
        return None;
    }
    let name = match name {
        Some((Value::String(text), span)) if text.value.trim().is_empty() => {
            cx.report_value(Diagnostic::error(Code::Range, span, "a paint's name must not be empty"));
            None
        }
        Some((Value::String(text), span)) => Some((text.value.to_string(), span)),
        _ => None,
    };
    let (Value::Region(area), Value::Tone(value)) = (area, value) else { return None };
    let area = match cx.period {
        Some(period) => repeat::folded(cx, period, area, region.span)?,
        None => area,
    };
    check_region(cx, &area, region.span)?;
    Some(Painted { region: area, tone: value, name, seed, span, tone_span: tone.span })
}

fn outline<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    region: &'a Expr,
    pen: Option<&'a Expr>,
    span: Span,
) -> Option<Outline> {
    let area = eval::expect(cx, scope, region, Slot::of(Kind::Region));
    let width = match pen {
        Some(pen) => eval::expect(cx, scope, pen, Slot::of(Kind::Length)),
        None => Value::Length(vocabulary::DEFAULT_PEN.to_mm()),
    };
    if cx.is_dead() {
        return None;
    }
    let (Value::Region(area), Value::Length(width)) = (area, width) else { return None };
    if width <= 0.0 {
        let place = pen.map_or(span, |pen| pen.span);
        cx.report_value(Diagnostic::error(Code::Range, place, "`pen` must be greater than zero"));
        return None;
    }
    if cx.period.is_none() || area.is_empty() {
        check_region(cx, &area, region.span)?;
    }
    Some(Outline { region: area, pen: Length::mm(width), span })
}

/// A region that nothing can be painted on is an error; one that nobody will see a warning.
fn check_region(cx: &mut Cx<'_, '_>, region: &Region, span: Span) -> Option<()> {
    if region.is_empty() {
        let message = "the region holds nothing";
        cx.report_value(Diagnostic::error(Code::EmptyRegion, span, message).label("nothing is left of this"));
        return None;
    }
    if let Some(page) = &cx.page
        && region.bounds().intersection(&page.bounds()).is_empty()
    {
        let message = "the region lies outside the canvas";
        cx.report_value(Diagnostic::warning(Code::Offside, span, message));
    }
    Some(())
}

/// Names every paint, in the order of drawing: those without a name after their tone, further ones of a tone numbered.
fn name_paints(cx: &mut Cx<'_, '_>, drawn: &[Drawn]) -> Vec<String> {
    let mut paints = Vec::new();
    collect(drawn, &mut paints);
    let mut explicit: BTreeMap<&str, Span> = BTreeMap::new();
    for paint in &paints {
        if let Some((name, span)) = &paint.name
            && let Some(earlier) = explicit.insert(name, *span)
        {
            let message = format!("two paints are called `{name}`");
            let diagnostic = Diagnostic::error(Code::Duplicate, *span, message);
            let diagnostic = if earlier == *span {
                diagnostic.hint("a loop needs a name that differs each round: `as \"swatch {i}\"`")
            } else {
                diagnostic.note(earlier, "the first one")
            };
            cx.report(diagnostic);
        }
    }
    let mut counts: BTreeMap<&str, u32> = BTreeMap::new();
    let mut names = Vec::with_capacity(paints.len());
    for paint in &paints {
        if let Some((name, _)) = &paint.name {
            names.push(name.clone());
            continue;
        }
        let tone = paint.tone.name.as_str();
        let count = counts.entry(tone).or_insert(0);
        let name = loop {
            *count += 1;
            let name = if *count == 1 { tone.to_owned() } else { format!("{tone} {count}") };
            if !explicit.contains_key(name.as_str()) {
                break name;
            }
        };
        if *count > 1 {
            let message = format!("this paint has no name of its own and is called `{name}`");
            cx.report(
                Diagnostic::warning(Code::Unnamed, paint.span, message)
                    .label("its tiles move when a paint is added before it")
                    .hint("give it a name: `as \"…\"`"),
            );
        }
        names.push(name);
    }
    names
}

fn collect<'d>(drawn: &'d [Drawn], out: &mut Vec<&'d Painted>) {
    for drawn in drawn {
        match drawn {
            Drawn::Paint(paint) => out.push(paint),
            Drawn::Outline(_) | Drawn::Ink(_) => {}
            Drawn::Layer { draws, .. } => collect(draws, out),
        }
    }
}

fn finish(cx: &mut Cx<'_, '_>, drawn: Vec<Drawn>, names: &mut impl Iterator<Item = String>) -> Vec<Draw> {
    let mut draws = Vec::with_capacity(drawn.len());
    for drawn in drawn {
        match drawn {
            Drawn::Outline(outline) => draws.push(Draw::Outline(outline)),
            Drawn::Ink(ink) => draws.push(Draw::Ink(ink)),
            Drawn::Layer { name, ink, draws: inner } => {
                let inner = finish(cx, inner, names);
                draws.push(Draw::Layer(LayerGroup { name, ink, draws: inner }));
            }
            Drawn::Paint(painted) => {
                let name = names.next().unwrap_or_default();
                let Some(tone) = painted.tone.settle(cx, painted.tone_span) else { continue };
                if let Some(period) = cx.period {
                    repeat::check(cx, period, &painted.region, (&tone, &painted.tone), painted.span);
                }
                draws.push(Draw::Paint(Box::new(Paint {
                    name,
                    tone_name: painted.tone.name.clone(),
                    seed: painted.seed.unwrap_or(cx.seed),
                    region: painted.region,
                    tone,
                    span: painted.span,
                })));
            }
        }
    }
    draws
}
