//! Tones: recipes with parameters, properties and inheritance, up to the tone that a paint uses.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::field::{Field, Node};
use crate::geom::{Angle, Length};
use crate::scene::{
    AngleRule, Asked, Bfs, Blend, Darkness, Domain, Edge, Fill, FillKind, Ground, Hand, Link, Over, Placement, Range,
    Shape, Stack, Tone as SceneTone,
};
use crate::span::Span;
use crate::syntax::ast::{Argument, Expr, ExprKind, Property, ToneBody};

use super::convert::{Slot, coerce};
use super::cx::Cx;
use super::modules::Tone;
use super::properties::{Property as Known, TONE as PROPERTIES};
use super::scope::Scope;
use super::value::{FieldUnit, Kind, TypedField, Value};
use super::{eval, function, ground, names};

/// A tone with its properties as far as they are given.
#[derive(Debug, Clone)]
pub(super) struct ToneValue {
    /// What it is called; paints without a name are called after it.
    pub(super) name: String,
    /// Where it is declared.
    declared: Span,
    properties: Vec<Given>,
    /// Whether a property could not be read, which was reported.
    broken: bool,
}

/// A property that is given.
#[derive(Debug, Clone)]
struct Given {
    name: &'static str,
    value: Value,
    span: Span,
}

/// Properties without which nothing can be painted.
const REQUIRED: [&str; 2] = ["place", "fill"];

/// Pairs of properties of which a tone has one at most, with what the first is about.
const RIVALS: [(&str, &str, &str); 4] = [
    (
        "darkness",
        "k",
        "`k` is a number of layers, `darkness` a share of the paper from which layers follow: give one of them",
    ),
    ("darkness", "blend", "`blend` is about fractions of `k`; with `darkness` the spacing of lines takes care of them"),
    ("range", "k", "`range` is about `darkness`, which has bounds that depend on the fill"),
    ("solid", "k", "`solid` is about `darkness`; layers of `k` are inked all over by `fill: solid`"),
];

/// The direction of a ground's lines, which no tile turns: the diagonal that the hand takes.
const GROUND_DEGREES: f64 = 45.0;

/// The tone of a name that can be seen from a module.
pub(super) fn find<'a>(cx: &Cx<'a, '_>, module: usize, name: &str) -> Option<Tone<'a>> {
    cx.seen_from(module).find_map(|module| module.tones.get(name)).copied()
}

/// A tone with arguments, which are evaluated in the caller's scope.
pub(super) fn instantiate<'a>(
    cx: &mut Cx<'a, '_>,
    caller: &Rc<Scope<'a>>,
    tone: Tone<'a>,
    arguments: &'a [Argument],
    span: Span,
) -> Value {
    let what = format!("`{}`", tone.name.name);
    let scope = function::bind_arguments(cx, (caller, Slot::ANY), &what, (tone.module, tone.params), arguments, span);
    let Some(scope) = scope else { return Value::Unknown(Some(Kind::Tone)) };
    if !cx.count_iteration(span) {
        return Value::Unknown(Some(Kind::Tone));
    }
    let name = tone.name.span;
    if cx.is_runaway(name) {
        return Value::Unknown(Some(Kind::Tone));
    }
    // Without parameters nothing can end the round.
    if tone.params.is_empty() && cx.is_under_way(name) {
        let message = format!("the tone {what} is derived from itself");
        cx.report(Diagnostic::error(Code::Cycle, span, message).note(name, "declared here"));
        cx.give_up();
        return Value::Unknown(Some(Kind::Tone));
    }
    let value = cx.called(name, span, |cx| properties(cx, &scope, tone)).flatten();
    value.map_or(Value::Unknown(Some(Kind::Tone)), |tone| Value::Tone(Rc::new(tone)))
}

/// Evaluates a tone that nothing may paint with, with unknown arguments.
pub(super) fn check<'a>(cx: &mut Cx<'a, '_>, tone: Tone<'a>) {
    let scope = function::unknown_arguments(cx, tone.module, tone.params);
    let name = tone.name.span;
    let checked = cx.called(name, name, |cx| properties(cx, &scope, tone));
    if let (Some(Some(value)), ToneBody::Properties(_)) = (checked, tone.body)
        && !value.broken
    {
        value.check_pairs(cx);
        value.check_whole(cx, tone);
    }
}

fn properties<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, tone: Tone<'a>) -> Option<ToneValue> {
    let (mut value, given) = match tone.body {
        ToneBody::Properties(given) => {
            let empty =
                ToneValue { name: String::new(), declared: tone.name.span, properties: Vec::new(), broken: false };
            (empty, given)
        }
        ToneBody::Derived { base, with } => {
            let base = match expect_tone(cx, scope, base) {
                Value::Tone(base) => (*base).clone(),
                // The base is unknown or broken, but what differs can be looked at all the same.
                _ => ToneValue { name: String::new(), declared: tone.name.span, properties: Vec::new(), broken: true },
            };
            (base, with)
        }
    };
    // What a damaged file's tone lacks may have stood in what could not be read.
    value.broken |= cx.modules[tone.module].is_damaged;
    value.name.clone_from(&tone.name.name);
    value.declared = tone.name.span;
    let mut seen: Vec<(&str, Span)> = Vec::new();
    for property in given {
        let name = property.name.name.as_str();
        if let Some((_, earlier)) = seen.iter().find(|(seen, _)| *seen == name) {
            let message = format!("the property `{name}` is given twice");
            let diagnostic = Diagnostic::error(Code::Duplicate, property.name.span, message);
            cx.report(diagnostic.note(*earlier, "first given here"));
            continue;
        }
        seen.push((name, property.name.span));
        value.give(cx, scope, property);
    }
    Some(value)
}

/// The value of an expression that names a tone.
pub(super) fn expect_tone<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr) -> Value {
    let slot = Slot::of(Kind::Tone);
    // Behind `with` a name that is nothing else is a misspelt tone.
    let unknown = match &expr.kind {
        ExprKind::Name(name) => Some((name, &[][..], expr.span)),
        ExprKind::Call(callee, arguments) => match &callee.kind {
            ExprKind::Name(name) => Some((name, &arguments[..], callee.span)),
            _ => None,
        },
        ExprKind::Member(base, member) => return member_tone(cx, scope, base, member, expr.span),
        _ => None,
    };
    if let Some((name, arguments, span)) = unknown
        && find(cx, scope.module, name).is_none()
        && (matches!(expr.kind, ExprKind::Call(..)) || names::lookup(cx, scope, name, span).is_none())
    {
        for argument in arguments {
            eval::eval(cx, scope, &argument.value, Slot::of(Kind::Field));
        }
        let modules = cx.modules;
        let module = &modules[scope.module];
        let known: Vec<&str> = cx.seen_from(scope.module).flat_map(|module| module.tones.keys().copied()).collect();
        let hint = did_you_mean(name, known.iter().copied()).or_else(|| {
            let alias = module.aliases.iter().find(|(_, index)| modules[**index].tones.contains_key(name.as_str()));
            alias.map(|(alias, _)| format!("`{alias}.{name}` is a tone"))
        });
        if (hint.is_some() || !module.is_incomplete) && !module.broken.contains(name.as_str()) {
            let message = format!("there is no tone `{name}`");
            cx.report(Diagnostic::error(Code::UnknownTone, span, message).maybe_hint(hint));
        }
        return Value::Unknown(Some(Kind::Tone));
    }
    eval::expect(cx, scope, expr, slot)
}

/// `module.tone` without arguments, or a value of that name.
fn member_tone<'a>(
    cx: &mut Cx<'a, '_>,
    scope: &Rc<Scope<'a>>,
    base: &'a Expr,
    member: &'a crate::syntax::ast::Ident,
    span: Span,
) -> Value {
    let Some(module) = names::module_of(cx, scope, base) else { return Value::Unknown(Some(Kind::Tone)) };
    let modules = cx.modules;
    if let Some(&tone) = modules[module].tones.get(member.name.as_str()) {
        cx.note_use(member.span, tone.name.span);
        return instantiate(cx, scope, tone, &[], span);
    }
    let inner = &modules[module].scope;
    if let Some(entry) = inner.own(&member.name) {
        cx.note_use(member.span, entry.span);
        let value = names::force(cx, inner, &member.name, member.span);
        return coerce(cx, value, Slot::of(Kind::Tone), span);
    }
    let message = format!("`{}` declares no tone `{}`", modules[module].path, member.name);
    let hint = did_you_mean(&member.name, modules[module].tones.keys().copied());
    cx.report(Diagnostic::error(Code::UnknownTone, member.span, message).maybe_hint(hint));
    Value::Unknown(Some(Kind::Tone))
}

/// A list of fills, one for each layer.
fn fills(cx: &mut Cx<'_, '_>, members: &Rc<[Value]>, expr: &Expr) -> Value {
    if members.is_empty() {
        cx.report_value(Diagnostic::error(Code::Range, expr.span, "the list of fills is empty"));
        return Value::Unknown(Some(Kind::Fill));
    }
    let spans = eval::member_spans(expr, members.len());
    let mut fills = Vec::with_capacity(members.len());
    for (member, span) in members.iter().zip(spans) {
        match coerce(cx, member.clone(), Slot::of(Kind::Fill), span) {
            Value::List(inner) => fills.extend(inner.iter().cloned()),
            fill => fills.push(fill),
        }
    }
    Value::List(fills.into())
}

impl ToneValue {
    fn give<'a>(&mut self, cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, property: &'a Property) {
        let name = &property.name;
        let Some(Known { name: known, slot, .. }) = PROPERTIES.iter().find(|known| known.name == name.name) else {
            self.broken = true;
            eval::eval(cx, scope, &property.value, Slot::of(Kind::Field));
            let names = PROPERTIES.iter().map(|known| known.name);
            let hint = did_you_mean(&name.name, names.clone()).unwrap_or_else(|| {
                format!("tones have {}", names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))
            });
            let message = format!("tones have no property `{}`", name.name);
            cx.report(Diagnostic::error(Code::UnknownProperty, name.span, message).hint(hint));
            return;
        };
        let value = eval::eval(cx, scope, &property.value, *slot);
        let value = match (*known, value) {
            ("fill", Value::List(members)) => fills(cx, &members, &property.value),
            (_, value) => coerce(cx, value, *slot, property.value.span),
        };
        let value = self.held_to_range(cx, known, value, property.value.span);
        self.broken |= value.is_unknown();
        self.properties.retain(|given| given.name != *known);
        self.properties.push(Given { name: known, value, span: property.value.span });
    }

    fn held_to_range(&self, cx: &mut Cx<'_, '_>, name: &str, value: Value, span: Span) -> Value {
        let message = match (name, &value) {
            ("bleed", Value::Length(mm)) if *mm < 0.0 => "`bleed` must not be negative".to_owned(),
            ("solid", Value::Number(share)) if !(*share > 0.0 && *share <= 1.0) => {
                "`solid` must lie between 0 and 1, and above 0".to_owned()
            }
            ("darkness", Value::Field(TypedField { field, unit: FieldUnit::Number })) if matches!(field.node(), Node::Constant(share) if !(0.0..=1.0).contains(share)) => {
                "`darkness` must lie between 0 (paper) and 1 (ink)".to_owned()
            }
            ("k" | "darkness", Value::Field(TypedField { unit, .. })) if *unit != FieldUnit::Number => {
                let found = match unit {
                    FieldUnit::Number => "numbers",
                    FieldUnit::Length => "lengths",
                    FieldUnit::Angle => "angles",
                    FieldUnit::Bool => "conditions",
                };
                let message = format!("`{name}` takes numbers, not {found}");
                cx.report(Diagnostic::error(Code::Type, span, message));
                return Value::Unknown(Some(Kind::Field));
            }
            _ => return value,
        };
        cx.report_value(Diagnostic::error(Code::Range, span, message));
        Value::Unknown(value.kind())
    }

    fn get(&self, name: &str) -> Option<&Given> {
        self.properties.iter().find(|given| given.name == name)
    }

    /// Where a property is given, if it is.
    pub(super) fn span_of(&self, name: &str) -> Option<Span> {
        self.get(name).map(|given| given.span)
    }

    fn word(&self, name: &str) -> Option<&'static str> {
        match self.get(name)?.value {
            Value::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Notes a tone that nothing can be painted with, unless others derive from it: they may give what it lacks.
    fn check_whole(&self, cx: &mut Cx<'_, '_>, tone: Tone<'_>) {
        let missing: Vec<String> =
            REQUIRED.iter().filter(|name| self.get(name).is_none()).map(|name| format!("`{name}`")).collect();
        if missing.is_empty() || cx.modules.iter().any(|module| module.bases.contains(tone.name.name.as_str())) {
            return;
        }
        let message = format!("the tone `{}` has no {}", tone.name.name, missing.join(" and no "));
        cx.lacking.push(
            Diagnostic::warning(Code::Missing, tone.name.span, message)
                .label("nothing can be painted with it")
                .hint("a tone that others derive from may leave these to them"),
        );
    }

    /// Properties that do not go together.
    fn check_pairs(&self, cx: &mut Cx<'_, '_>) -> bool {
        let mut whole = true;
        for (name, other, reason) in RIVALS {
            if let (Some(given), Some(rival)) = (self.get(name), self.get(other)) {
                // The one that stands later came to the other: in a derived tone that is not always the first.
                let message = format!("`{name}` and `{other}` do not go together");
                cx.report(
                    Diagnostic::error(Code::Conflict, given.span, message)
                        .note(rival.span, format!("`{other}` is given here"))
                        .hint(reason),
                );
                whole = false;
            }
        }
        let Some(place) = self.get("place") else { return whole };
        // All are looked at, so that each one's mistake is told.
        let has_cells = self.check_cells(cx, place);
        self.check_rows(cx, place) && has_cells && whole
    }

    /// Cells and the edges they share need a placement that has some.
    fn check_cells(&self, cx: &mut Cx<'_, '_>, place: &Given) -> bool {
        let Value::Placement(placement) = &place.value else { return true };
        if placement.is_tiling() {
            return true;
        }
        let tilings = "`grid`, `hex`, `triangles`, `penrose` and `pinwheel` are tilings";
        if let Some(Given { value: Value::Shape(shape), span, .. }) = self.get("shape")
            && matches!(**shape, Shape::Cell { .. })
        {
            let diagnostic = Diagnostic::error(Code::Tiling, *span, "`cell` needs a placement that is a tiling");
            let hint = format!("{tilings}; elsewhere `voronoi()` gives every site a cell");
            cx.report_value(diagnostic.note(place.span, "this placement has no cells").hint(hint));
            return false;
        }
        if let (Some("edges"), Some(link)) = (self.word("link"), self.get("link")) {
            let diagnostic = Diagnostic::error(Code::Tiling, link.span, "`edges` needs a placement that is a tiling");
            let hint = format!("{tilings}; Voronoi cells share edges just where `delaunay` links them");
            cx.report_value(diagnostic.note(place.span, "this placement has no cells").hint(hint));
            return false;
        }
        true
    }

    /// A checkerboard needs a grid.
    fn check_rows(&self, cx: &mut Cx<'_, '_>, place: &Given) -> bool {
        let Some(angle) = self.get("angle") else { return true };
        if let (Value::Placement(placement), Value::Angles(rule)) = (&place.value, &angle.value)
            && matches!(**rule, AngleRule::Checkerboard)
            && !matches!(**placement, Placement::Grid(_))
        {
            let message = "a checkerboard of angles needs the rows and columns of a grid";
            cx.report_value(
                Diagnostic::error(Code::Checkerboard, angle.span, message)
                    .note(place.span, "this placement has none")
                    .hint("`place: grid(spacing: …)`, or another rule such as `bfs()`"),
            );
            return false;
        }
        true
    }

    /// The tone that a paint uses, every property decided; `None` where something is missing, which was reported.
    pub(super) fn settle(&self, cx: &mut Cx<'_, '_>, span: Span) -> Option<SceneTone> {
        if self.broken {
            return None;
        }
        let mut whole = self.check_pairs(cx);
        for name in REQUIRED {
            if self.get(name).is_none() {
                let message = format!("the tone `{}` has no `{name}`", self.name);
                let diagnostic = Diagnostic::error(Code::Missing, span, message);
                cx.report(diagnostic.note(self.declared, format!("give `{name}` here")));
                cx.lacking.retain(|lacking| lacking.span != Some(self.declared));
                whole = false;
            }
        }
        if !whole || !self.check_darkness(cx) {
            return None;
        }
        let place = self.get("place")?;
        let Value::Placement(placement) = &place.value else { return None };
        let shape = match self.get("shape").map(|given| &given.value) {
            Some(Value::Shape(shape)) => (**shape).clone(),
            _ => Shape::Rect { width: None, height: None, overlap: None, upright: false },
        };
        let (angle, angle_span) = match self.get("angle") {
            Some(Given { value: Value::Angles(rule), span, .. }) => ((**rule).clone(), *span),
            _ => (AngleRule::Bfs(Bfs::default()), span),
        };
        let (asked, asked_span) = self.asked().unwrap_or_else(|| (Asked::K(Field::constant(1.0)), span));
        let (hand, hand_span) = match self.get("hand") {
            Some(Given { value: Value::Hand(hand), span, .. }) => (*hand, *span),
            _ => (Hand::RULED, span),
        };
        let mut tone = SceneTone {
            place: (**placement).clone(),
            place_span: place.span,
            domain: match self.word("domain") {
                Some("region") => Domain::Region,
                _ => Domain::Canvas,
            },
            bleed: match self.get("bleed").map(|given| &given.value) {
                Some(Value::Length(mm)) => Some(Length::mm(*mm)),
                _ => None,
            },
            stack: match self.word("stack") {
                Some("through") => Stack::Through,
                Some("cover") => Stack::Cover,
                _ if shape.is_cell() => Stack::Through,
                _ => Stack::Cover,
            },
            link: match self.word("link") {
                Some("edges") => Link::Edges,
                Some("delaunay") => Link::Delaunay,
                _ => match shape {
                    Shape::Cell { .. } => Link::Edges,
                    Shape::Rect { .. }
                    | Shape::Hexagon { .. }
                    | Shape::Triangle { .. }
                    | Shape::Trapezoid { .. }
                    | Shape::Stamp { .. }
                    | Shape::Voronoi { .. } => Link::Delaunay,
                },
            },
            shape,
            angle,
            angle_span,
            fill: self.fill_list()?,
            asked,
            asked_span,
            blend: match self.word("blend") {
                Some("partial") => Blend::Partial,
                Some("dither") => Blend::Dither,
                Some("contour") => Blend::Contour,
                _ => Blend::Step,
            },
            over: match self.word("over") {
                Some("knockout") => Over::Knockout,
                _ => Over::Print,
            },
            ground: self.ground(),
            edge: match self.word("edge") {
                Some("whole") => Edge::Whole,
                Some("centre") => Edge::Centre,
                _ => Edge::Clip,
            },
            hand,
            hand_span,
        };
        if self.get("ground").is_none() {
            tone.ground = ground::default(&tone);
        }
        Some(tone)
    }

    /// What is asked for, and where.
    fn asked(&self) -> Option<(Asked, Span)> {
        if let Some(Given { value: Value::Field(TypedField { field, .. }), span, .. }) = self.get("darkness") {
            let range = match self.word("range") {
                Some("fit") => Range::Fit,
                _ => Range::Clip,
            };
            let solid = self.get("solid").and_then(|given| given.value.number());
            return Some((Asked::Darkness(Darkness { field: field.clone(), range, solid }), *span));
        }
        match self.get("k")? {
            Given { value: Value::Field(TypedField { field, .. }), span, .. } => Some((Asked::K(field.clone()), *span)),
            Given { .. } => None,
        }
    }

    /// What belongs to a darkness stands with one, and its ink spreads by less than the width of its strokes.
    fn check_darkness(&self, cx: &mut Cx<'_, '_>) -> bool {
        let mut whole = true;
        if self.get("darkness").is_none() {
            for name in ["range", "solid"] {
                if let Some(given) = self.get(name) {
                    let message = format!("`{name}` needs a `darkness`, which the tone `{}` has not", self.name);
                    cx.report_value(Diagnostic::error(Code::Missing, given.span, message));
                    whole = false;
                }
            }
            return whole;
        }
        let (Some((gain, span)), Some(fills)) = (cx.gain, self.fill_list()) else { return whole };
        let widths = fills.iter().filter_map(|fill| match &fill.kind {
            FillKind::Dots { radius, .. } => Some(*radius * 2.0),
            FillKind::Lines(_)
            | FillKind::Dashes { .. }
            | FillKind::Crosses { .. }
            | FillKind::Arcs(_)
            | FillKind::Waves { .. }
            | FillKind::Scribble { .. }
            | FillKind::Nawaami { .. }
            | FillKind::Motif { .. }
            | FillKind::Solid => fill.kind.hatch().map(|hatch| hatch.pen),
        });
        let Some(pen) = widths.reduce(Length::min).filter(|&pen| gain > pen) else { return whole };
        let message =
            format!("ink that spreads by {}mm is wider than this tone's marks of {}mm", gain.to_mm(), pen.to_mm());
        let given = self.get("fill").map_or(span, |given| given.span);
        cx.report_value(
            Diagnostic::error(Code::Range, span, message)
                .note(given, "drawn here")
                .hint("`gain` is how far ink spreads beyond each edge of a mark: about 0.02mm on smooth paper"),
        );
        false
    }

    fn fill_list(&self) -> Option<Vec<Fill>> {
        match &self.get("fill")?.value {
            Value::Fill(fill) => Some(vec![(**fill).clone()]),
            Value::List(members) => members
                .iter()
                .map(|member| match member {
                    Value::Fill(fill) => Some((**fill).clone()),
                    _ => None,
                })
                .collect(),
            _ => None,
        }
    }

    fn ground(&self) -> Option<Ground> {
        match &self.get("ground")?.value {
            Value::Fill(fill) => Some(Ground::Fill { fill: (**fill).clone(), angle: Angle::degrees(GROUND_DEGREES) }),
            Value::Word("nearest") => Some(Ground::Nearest),
            _ => None,
        }
    }
}
