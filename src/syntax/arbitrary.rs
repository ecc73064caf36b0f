//! Random documents for the tests of the formatter and of the TOML front end. Their spans mean nothing.
#![allow(clippy::unwrap_used)]

use proptest::collection::vec;
use proptest::option::of;
use proptest::prelude::*;
use proptest::sample::select;

use crate::span::{SourceId, Sources, Span, Syntax};
use crate::syntax::ast::{
    Argument, Arm, BinaryOp, Binding, Doc, Document, Expr, ExprKind, Ident, Parameter, Pattern, Property, Statement,
    StatementKind, StringPart, Text, ToneBody, UnaryOp, Unit,
};

/// The source that every span names.
pub(super) fn source() -> SourceId {
    Sources::new().add("test", "", Syntax::Kake)
}

fn span() -> Span {
    Span::new(source(), 0, 0)
}

fn make(kind: ExprKind) -> Expr {
    Expr { kind, span: span() }
}

fn ident(name: impl Into<String>) -> Ident {
    Ident { name: name.into(), span: span() }
}

fn name() -> BoxedStrategy<String> {
    select(vec!["a", "b2", "k", "tile_size", "region", "影", "with", "in", "field", "_x", "pen"])
        .prop_map(str::to_owned)
        .boxed()
}

fn label() -> BoxedStrategy<String> {
    prop_oneof![4 => name(), 1 => select(vec!["if", "value", "doc", "params", "type", "seed"]).prop_map(str::to_owned)]
        .boxed()
}

fn plain_text() -> BoxedStrategy<String> {
    let pieces =
        select(vec!["a", " ", "\"", "'", "\\", "{", "}", "\n", "\t", "影", "//", "'''", "\"\"\"", "\u{1}", "é"]);
    vec(pieces, 0..6).prop_map(|pieces| pieces.concat()).boxed()
}

fn doc() -> BoxedStrategy<Option<Doc>> {
    let line = select(vec!["", "Words.", " indented", "with \"quotes\" and \\", "'''", "\"\"\"", "影 // x"]);
    let text = vec(line, 1..4).prop_map(|lines| lines.join("\n"));
    prop_oneof![4 => Just(None), 1 => text.prop_map(|text| Some(Doc { text, span: span() }))].boxed()
}

fn number() -> BoxedStrategy<Expr> {
    let texts = vec!["0", "1", "12", "0.5", "1e-3", "007", "2.50", "1E+3", "99999999999999999999", "0e0"];
    let unit = prop_oneof![2 => Just(None), 1 => select(Unit::ALL.to_vec()).prop_map(Some)];
    (select(texts), unit)
        .prop_map(|(text, unit)| make(ExprKind::Number { value: text.parse().unwrap(), text: text.into(), unit }))
        .boxed()
}

fn property(value: BoxedStrategy<Expr>) -> BoxedStrategy<Property> {
    (doc(), label(), value).prop_map(|(doc, name, value)| Property { doc, name: ident(name), value }).boxed()
}

/// A record or block; `doc` and `value` are more frequent than they would be.
fn properties(value: BoxedStrategy<Expr>) -> BoxedStrategy<Vec<Property>> {
    vec(property(value), 0..4).boxed()
}

fn chain(operand: BoxedStrategy<Expr>, operators: &[BinaryOp], most: usize) -> BoxedStrategy<Expr> {
    let rest = vec((select(operators.to_vec()), operand.clone()), 1..=most);
    prop_oneof![
        12 => operand.clone(),
        1 => (operand, rest).prop_map(|(first, rest)| make(ExprKind::Binary(Box::new(first), rest))),
    ]
    .boxed()
}

/// What may stand wherever a value may.
pub(super) fn expr() -> BoxedStrategy<Expr> {
    let leaf = prop_oneof![
        number(),
        select(vec!["#fff", "#0a0b0c", "#11223344"]).prop_map(|text| make(ExprKind::Colour(text.into()))),
        any::<bool>().prop_map(|value| make(ExprKind::Bool(value))),
        name().prop_map(|name| make(ExprKind::Name(name))),
        plain_text().prop_map(|text| make(ExprKind::String(vec![StringPart::Text(text)]))),
    ];
    leaf.prop_recursive(3, 10, 3, |inner| whole(primary(inner.boxed()))).boxed()
}

/// What a tone derives from: the first brace that belongs to no match opens its block, so that a record needs brackets.
fn base() -> BoxedStrategy<Expr> {
    let bracket = |expr: Expr| {
        if super::format::expression(&expr).contains('{') { make(ExprKind::Group(Box::new(expr))) } else { expr }
    };
    expr().prop_map(bracket).boxed()
}

/// Brackets and names, with any values within.
fn primary(inner: BoxedStrategy<Expr>) -> BoxedStrategy<Expr> {
    let argument =
        (of(label()), inner.clone()).prop_map(|(name, value)| Argument { name: name.map(ident), value }).boxed();
    let callee = prop_oneof![
        3 => name().prop_map(|name| make(ExprKind::Name(name))),
        1 => (name(), name())
            .prop_map(|(a, b)| make(ExprKind::Member(Box::new(make(ExprKind::Name(a))), ident(b)))),
    ];
    let call = (callee, vec(argument, 0..4))
        .prop_map(|(callee, arguments)| make(ExprKind::Call(Box::new(callee), arguments)))
        .boxed();
    let list = vec(inner.clone(), 0..4).prop_map(|members| make(ExprKind::List(members))).boxed();
    let parts = vec(
        prop_oneof![plain_text().prop_map(StringPart::Text), undocumented(inner.clone()).prop_map(StringPart::Expr)],
        0..4,
    );
    let pattern = prop_oneof![
        plain_text().prop_map(Pattern::String),
        Just(Pattern::Number(0.5, "0.5".into())),
        any::<bool>().prop_map(Pattern::Bool),
        Just(Pattern::Any),
    ];
    let arm = (pattern, inner.clone()).prop_map(|(pattern, value)| Arm { pattern, span: span(), value });
    prop_oneof![
        2 => number(),
        2 => name().prop_map(|name| make(ExprKind::Name(name))),
        3 => call.clone(),
        2 => list.clone(),
        1 => (prop_oneof![call, list], inner.clone())
            .prop_map(|(base, index)| make(ExprKind::Index(Box::new(base), Box::new(index)))),
        1 => inner.clone().prop_map(|inner| make(ExprKind::Group(Box::new(inner)))),
        1 => vec(inner.clone(), 2..4).prop_map(|members| make(ExprKind::Tuple(members))),
        2 => properties(inner.clone()).prop_map(|properties| make(ExprKind::Record(properties))),
        1 => parts.prop_map(|parts| make(ExprKind::String(parts))),
        1 => (inner, vec(arm, 1..3))
            .prop_map(|(subject, arms)| make(ExprKind::Match { subject: Box::new(subject), arms })),
    ]
    .boxed()
}

/// Doc comments end a line, and a string may not hold one.
fn undocumented(expr: BoxedStrategy<Expr>) -> BoxedStrategy<Expr> {
    expr.prop_filter("no doc comments in a string", |expr| {
        let plain = super::format::expression(expr);
        plain == super::format::documented_expression(expr)
    })
    .boxed()
}

/// Operators around primaries, each kind only where it needs no brackets.
fn whole(primary: BoxedStrategy<Expr>) -> BoxedStrategy<Expr> {
    let power = chain(primary, &[BinaryOp::Power], 2);
    let prefixed = |operator: UnaryOp, operand: BoxedStrategy<Expr>| {
        prop_oneof![
            4 => operand.clone(),
            1 => (1..3usize, operand)
                .prop_map(move |(count, operand)| make(ExprKind::Unary(vec![operator; count], Box::new(operand)))),
        ]
        .boxed()
    };
    let unary = prefixed(UnaryOp::Minus, power);
    let products = [BinaryOp::Multiply, BinaryOp::Divide, BinaryOp::Remainder, BinaryOp::Intersect];
    let sum = chain(chain(unary, &products, 2), &[BinaryOp::Add, BinaryOp::Subtract], 3);
    let comparison = chain(sum, &[BinaryOp::Equal, BinaryOp::Less, BinaryOp::GreaterEqual], 1);
    let comparison = prefixed(UnaryOp::Not, comparison);
    let or = chain(chain(comparison, &[BinaryOp::And], 2), &[BinaryOp::Or], 2);
    let branches = vec((or.clone(), or.clone()), 1..3);
    prop_oneof![
        6 => or.clone(),
        1 => (or.clone(), or.clone())
            .prop_map(|(from, to)| make(ExprKind::Range(Box::new(from), Box::new(to)))),
        1 => (branches, or)
            .prop_map(|(branches, otherwise)| make(ExprKind::If { branches, otherwise: Box::new(otherwise) })),
    ]
    .boxed()
}

fn binding() -> BoxedStrategy<Binding> {
    (name(), of(select(vec!["length", "field", "if"])), expr())
        .prop_map(|(name, ty, value)| Binding { name: ident(name), ty: ty.map(ident), value })
        .boxed()
}

fn parameters() -> BoxedStrategy<Vec<Parameter>> {
    let parameter = (doc(), name(), of(Just("length")), of(expr())).prop_map(|(doc, name, ty, default)| Parameter {
        doc,
        name: ident(name),
        ty: ty.map(ident),
        default,
    });
    vec(parameter, 0..4).boxed()
}

fn with_doc(kind: BoxedStrategy<StatementKind>) -> BoxedStrategy<Statement> {
    (doc(), kind).prop_map(|(doc, kind)| Statement { doc, kind, span: span() }).boxed()
}

fn declaration() -> BoxedStrategy<StatementKind> {
    let body = prop_oneof![
        properties(expr()).prop_map(ToneBody::Properties),
        (base(), properties(expr())).prop_map(|(base, with)| ToneBody::Derived { base, with }),
    ];
    let path = "[a-z\"\\\\{é ]{0,6}".prop_map(|value| Text { value, span: span() });
    prop_oneof![
        (path, of(name())).prop_map(|(path, alias)| StatementKind::Import { path, alias: alias.map(ident) }),
        binding().prop_map(StatementKind::Let),
        binding().prop_map(StatementKind::Field),
        binding().prop_map(StatementKind::Region),
        (binding(), of(expr())).prop_map(|(binding, domain)| StatementKind::Param { binding, domain }),
        (name(), parameters(), body).prop_map(|(name, params, body)| StatementKind::Tone {
            name: ident(name),
            params,
            body
        }),
        (name(), parameters(), expr()).prop_map(|(name, params, body)| StatementKind::Fn {
            name: ident(name),
            params,
            body
        }),
        (name(), properties(expr()))
            .prop_map(|(name, properties)| StatementKind::Experiment { name: ident(name), properties }),
    ]
    .boxed()
}

fn drawing() -> BoxedStrategy<StatementKind> {
    let leaf = prop_oneof![
        (expr(), expr(), of(expr()), of(expr())).prop_map(|(region, tone, name, seed)| StatementKind::Paint {
            region,
            tone,
            name,
            seed
        }),
        (expr(), of(expr())).prop_map(|(region, pen)| StatementKind::Outline { region, pen }),
        expr().prop_map(|drawing| StatementKind::Ink { drawing }),
    ];
    leaf.prop_recursive(3, 8, 2, |inner| {
        let inner = inner.boxed();
        let local = binding().prop_map(StatementKind::Let).boxed();
        let statement = with_doc(prop_oneof![4 => inner, 1 => local, 1 => declaration()].boxed());
        let body = vec(statement, 0..3).boxed();
        prop_oneof![
            (expr(), of(expr()), body.clone()).prop_map(|(name, ink, body)| StatementKind::Layer { name, ink, body }),
            (name(), expr(), body.clone()).prop_map(|(name, iterable, body)| StatementKind::For {
                variable: ident(name),
                iterable,
                body
            }),
            (vec((expr(), body.clone()), 1..3), of(body))
                .prop_map(|(branches, otherwise)| StatementKind::If { branches, otherwise }),
        ]
    })
    .boxed()
}

/// A random document, which a failing test shows as text.
#[derive(Clone)]
pub(super) struct Sample(pub(super) Document);

impl std::fmt::Debug for Sample {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&super::format::format(&self.0, ""))
    }
}

/// A document. Every name is declared once, or TOML could not hold it.
pub(super) fn document() -> BoxedStrategy<Sample> {
    let head = (of(expr()), of(properties(expr())), of(expr())).prop_map(|(edition, canvas, seed)| {
        let kinds =
            [edition.map(StatementKind::Edition), canvas.map(StatementKind::Canvas), seed.map(StatementKind::Seed)];
        kinds.into_iter().flatten().map(|kind| Statement { doc: None, kind, span: span() }).collect::<Vec<_>>()
    });
    let body = vec(with_doc(prop_oneof![declaration(), drawing()].boxed()), 0..4);
    (head, body)
        .prop_map(|(head, body)| {
            let mut statements = head;
            statements.extend(body);
            for (i, statement) in statements.iter_mut().enumerate() {
                let name = match &mut statement.kind {
                    StatementKind::Let(binding)
                    | StatementKind::Field(binding)
                    | StatementKind::Region(binding)
                    | StatementKind::Param { binding, .. } => &mut binding.name.name,
                    StatementKind::Tone { name, .. }
                    | StatementKind::Fn { name, .. }
                    | StatementKind::Experiment { name, .. } => &mut name.name,
                    _ => continue,
                };
                name.push_str(&format!("_{i}"));
            }
            Sample(Document { source: source(), statements, comments: Vec::new() })
        })
        .boxed()
}
