//! Expressions, from what the grammar found.
//!
//! In: pairs of `grammar/kake.pest`, in which operators and what they join stand in a row. Out: trees of [`Expr`], in
//! which they are grouped by how strongly they bind. What holds: a tree is at most [`HIGHEST`] deep.

use super::build::parts;
use super::grammar::Rule;
use super::read::Reader;
use super::{NESTING, near_word};
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{Argument, Arm, BinaryOp, Expr, ExprKind, Pattern, StringPart, UnaryOp, Unit};
use pest::iterators::Pair;
use std::iter::Peekable;
use std::vec::IntoIter;

/// How deep a tree may be. A pair of brackets with operators of one kind inside makes two levels, the innermost
/// operators a few more.
const HIGHEST: usize = 2 * NESTING + 8;

/// How strongly a prefix operator binds.
const PREFIX: u8 = 6;

/// An expression and how deep it is.
struct Node {
    expr: Expr,
    height: usize,
}

/// What operators join.
struct Operand {
    prefixes: Vec<UnaryOp>,
    /// From its first prefix to its end.
    span: Span,
    node: Node,
    /// How many calls, indices and members stand behind it.
    postfixes: usize,
}

/// An operator that joins two operands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Infix {
    Range,
    Binary(BinaryOp),
}

impl Infix {
    fn read(text: &str) -> Option<Self> {
        const ALL: [BinaryOp; 15] = [
            BinaryOp::Or,
            BinaryOp::And,
            BinaryOp::Equal,
            BinaryOp::NotEqual,
            BinaryOp::Less,
            BinaryOp::LessEqual,
            BinaryOp::Greater,
            BinaryOp::GreaterEqual,
            BinaryOp::Add,
            BinaryOp::Subtract,
            BinaryOp::Multiply,
            BinaryOp::Divide,
            BinaryOp::Remainder,
            BinaryOp::Intersect,
            BinaryOp::Power,
        ];
        if text == ".." {
            return Some(Self::Range);
        }
        ALL.iter().copied().find(|op| op.symbol() == text).map(Self::Binary)
    }

    fn precedence(self) -> u8 {
        match self {
            Self::Range => 0,
            Self::Binary(op) => op.precedence(),
        }
    }
}

/// Operands and the operators between them, as they stand.
struct Row {
    operands: IntoIter<Operand>,
    operators: Peekable<IntoIter<(Infix, Span)>>,
}

impl Row {
    fn next_operator(&mut self, precedence: u8) -> Option<(Infix, Span)> {
        self.operators.next_if(|(operator, _)| operator.precedence() == precedence)
    }

    /// Takes the `not`s before the next operand, with where they begin: they are about the comparison behind them.
    fn next_negations(&mut self) -> Option<(Vec<UnaryOp>, Span)> {
        let operand = self.operands.as_mut_slice().first_mut()?;
        let count = operand.prefixes.iter().take_while(|prefix| **prefix == UnaryOp::Not).count();
        let place = operand.span;
        let negations: Vec<UnaryOp> = operand.prefixes.drain(..count).collect();
        if operand.prefixes.is_empty() && count > 0 {
            operand.span = operand.node.expr.span;
        }
        (count > 0).then_some((negations, place))
    }
}

impl Reader<'_> {
    /// `expression`
    pub(super) fn expression(&mut self, pair: Pair<'_, Rule>) -> Expr {
        self.node(pair).expr
    }

    fn error(span: Span) -> Node {
        Node { expr: Expr { kind: ExprKind::Error, span }, height: 1 }
    }

    /// A node over others, the deepest of which is `below` deep.
    fn over(&mut self, kind: ExprKind, span: Span, below: usize) -> Node {
        if below >= HIGHEST {
            self.nested_too_deeply(span.at_start());
            return Self::error(span);
        }
        Node { expr: Expr { kind, span }, height: below + 1 }
    }

    fn node(&mut self, pair: Pair<'_, Rule>) -> Node {
        let whole = self.span(&pair);
        let mut operands: Vec<Operand> = Vec::new();
        let mut operators = Vec::new();
        let mut prefixes = Vec::new();
        let mut start = None;
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::prefix => {
                    start = start.or(Some(span));
                    prefixes.push(if part.as_str() == "-" { UnaryOp::Minus } else { UnaryOp::Not });
                }
                Rule::infix => operators.extend(Infix::read(part.as_str()).map(|operator| (operator, span))),
                Rule::call | Rule::index | Rule::member => {
                    if let Some(operand) = operands.pop() {
                        operands.push(self.postfix(operand, part));
                    }
                }
                _ => {
                    let node = self.primary(part);
                    let span = start.take().unwrap_or(span).to(span);
                    operands.push(Operand { prefixes: std::mem::take(&mut prefixes), span, node, postfixes: 0 });
                }
            }
        }
        let mut row = Row { operands: operands.into_iter(), operators: operators.into_iter().peekable() };
        self.range(&mut row).unwrap_or_else(|| Self::error(whole))
    }

    // --------------------------------------------------------------------------------------- operators

    fn range(&mut self, row: &mut Row) -> Option<Node> {
        let from = self.binary(row, 1)?;
        if row.next_operator(0).is_none() {
            return Some(from);
        }
        let to = self.binary(row, 1)?;
        let mut span = from.expr.span.to(to.expr.span);
        let below = from.height.max(to.height);
        let mut is_chain = false;
        while let Some((_, second)) = row.next_operator(0) {
            span = span.to(self.binary(row, 1)?.expr.span);
            if !is_chain {
                let message = "a range has two ends";
                self.report(Diagnostic::error(Code::Syntax, second, message).label("this begins a second range"));
            }
            is_chain = true;
        }
        if is_chain {
            return Some(Self::error(span));
        }
        Some(self.over(ExprKind::Range(Box::new(from.expr), Box::new(to.expr)), span, below))
    }

    /// Operators of one precedence and what they join, which binds more strongly.
    fn binary(&mut self, row: &mut Row, precedence: u8) -> Option<Node> {
        if precedence == PREFIX {
            return self.powers(row);
        }
        if precedence == BinaryOp::Equal.precedence()
            && let Some((negations, place)) = row.next_negations()
        {
            let inner = self.binary(row, precedence)?;
            let span = place.to(inner.expr.span);
            return Some(self.over(ExprKind::Unary(negations, Box::new(inner.expr)), span, inner.height));
        }
        let first = self.binary(row, precedence + 1)?;
        let (mut span, mut below) = (first.expr.span, first.height);
        let mut others = Vec::new();
        let mut second = None;
        while let Some((operator, place)) = row.next_operator(precedence) {
            let node = self.binary(row, precedence + 1)?;
            span = span.to(node.expr.span);
            below = below.max(node.height);
            if let Infix::Binary(operator) = operator {
                if others.len() == 1 {
                    second = Some(place);
                }
                others.push((operator, node.expr));
            }
        }
        if others.is_empty() {
            return Some(first);
        }
        if let Some(place) = second.filter(|_| precedence == BinaryOp::Less.precedence()) {
            let hint = "join two comparisons with `and`: `a < b and b < c`";
            self.report(Diagnostic::error(Code::Syntax, place, "comparisons do not chain").hint(hint));
            return Some(Self::error(span));
        }
        Some(self.over(ExprKind::Binary(Box::new(first.expr), others), span, below))
    }

    /// A chain of `^` with its prefix operators. A prefix takes all of the chain behind it, so that the chain is built
    /// from its end.
    fn powers(&mut self, row: &mut Row) -> Option<Node> {
        let mut chain = vec![row.operands.next()?];
        while row.next_operator(BinaryOp::Power.precedence()).is_some() {
            chain.push(row.operands.next()?);
        }
        let mut behind: Vec<Node> = Vec::new();
        for operand in chain.into_iter().rev() {
            behind.push(operand.node);
            if !operand.prefixes.is_empty() {
                let inner = self.power(behind.drain(..).rev())?;
                let span = operand.span.to(inner.expr.span);
                let kind = ExprKind::Unary(operand.prefixes, Box::new(inner.expr));
                behind.push(self.over(kind, span, inner.height));
            }
        }
        self.power(behind.into_iter().rev())
    }

    fn power(&mut self, mut nodes: impl Iterator<Item = Node>) -> Option<Node> {
        let first = nodes.next()?;
        let (mut span, mut below) = (first.expr.span, first.height);
        let mut others = Vec::new();
        for node in nodes {
            span = span.to(node.expr.span);
            below = below.max(node.height);
            others.push((BinaryOp::Power, node.expr));
        }
        if others.is_empty() {
            return Some(first);
        }
        Some(self.over(ExprKind::Binary(Box::new(first.expr), others), span, below))
    }

    // ----------------------------------------------------------------------------------------- postfixes

    /// An operand with one more call, index or member behind it.
    fn postfix(&mut self, operand: Operand, pair: Pair<'_, Rule>) -> Operand {
        let own = self.span(&pair);
        let Operand { prefixes, span, node: Node { expr: inner, height }, postfixes } = operand;
        let whole = inner.span.to(own);
        let is_name = matches!(inner.kind, ExprKind::Name(_));
        let mut refused = None;
        let is_silent = matches!(inner.kind, ExprKind::Error);
        let (kind, below) = match pair.as_rule() {
            Rule::call => {
                if !is_name && !matches!(inner.kind, ExprKind::Member(..)) {
                    refused = Some("only a name can be called");
                }
                let (arguments, below) = self.arguments(pair);
                (ExprKind::Call(Box::new(inner), arguments), below.max(height))
            }
            Rule::index => match parts(pair).next().map(|index| self.node(index)) {
                Some(index) => (ExprKind::Index(Box::new(inner), Box::new(index.expr)), height.max(index.height)),
                None => (ExprKind::Error, 0),
            },
            _ => match pair.into_inner().next().map(|name| self.ident(&name)) {
                Some(name) => {
                    if !is_name {
                        refused = Some("a member is written `module.name`");
                    }
                    (ExprKind::Member(Box::new(inner), name), height)
                }
                None => (ExprKind::Error, 0),
            },
        };
        let node = if is_silent {
            Self::error(whole)
        } else if let Some(message) = refused {
            self.report(Diagnostic::error(Code::Syntax, own, message));
            Self::error(whole)
        } else if postfixes >= NESTING {
            self.nested_too_deeply(own);
            Self::error(whole)
        } else {
            self.over(kind, whole, below)
        };
        Operand { prefixes, span: span.to(own), node, postfixes: postfixes + 1 }
    }

    fn arguments(&mut self, pair: Pair<'_, Rule>) -> (Vec<Argument>, usize) {
        let mut arguments = Vec::new();
        let mut height = 0;
        for argument in parts(pair) {
            let mut name = None;
            for part in argument.into_inner() {
                if part.as_rule() == Rule::argument_label {
                    name = part.into_inner().next().map(|label| self.ident(&label));
                } else {
                    let value = self.node(part);
                    height = height.max(value.height);
                    arguments.push(Argument { name: name.take(), value: value.expr });
                }
            }
        }
        (arguments, height)
    }

    // ----------------------------------------------------------------------------------------- primaries

    fn primary(&mut self, pair: Pair<'_, Rule>) -> Node {
        let span = self.span(&pair);
        let leaf = |kind| Node { expr: Expr { kind, span }, height: 1 };
        match pair.as_rule() {
            Rule::number => leaf(self.number(pair)),
            Rule::colour => leaf(self.colour(&pair)),
            Rule::boolean => leaf(ExprKind::Bool(pair.as_str() == "true")),
            Rule::name => leaf(ExprKind::Name(self.ident(&pair).name)),
            Rule::string => {
                let (parts, height) = self.string_parts(pair);
                self.over(ExprKind::String(parts), span, height)
            }
            Rule::tuple => {
                let (mut members, height) = self.members(pair);
                let kind = match members.pop() {
                    Some(only) if members.is_empty() => ExprKind::Group(Box::new(only)),
                    last => {
                        members.extend(last);
                        ExprKind::Tuple(members)
                    }
                };
                self.over(kind, span, height)
            }
            Rule::list => {
                let (members, height) = self.members(pair);
                self.over(ExprKind::List(members), span, height)
            }
            Rule::record => self.record(pair),
            Rule::if_value => self.choice(pair),
            Rule::match_value => self.matching(pair),
            _ => Self::error(span),
        }
    }

    fn members(&mut self, pair: Pair<'_, Rule>) -> (Vec<Expr>, usize) {
        let mut members = Vec::new();
        let mut height = 0;
        for member in parts(pair) {
            let member = self.node(member);
            height = height.max(member.height);
            members.push(member.expr);
        }
        (members, height)
    }

    fn record(&mut self, pair: Pair<'_, Rule>) -> Node {
        let span = self.span(&pair);
        let mut properties = Vec::new();
        let mut height = 0;
        for entry in parts(pair) {
            let doc = self.doc_above(self.base + entry.as_span().start());
            let mut parts = parts(entry);
            let (Some(name), Some(value)) = (parts.next(), parts.next()) else { continue };
            let name = self.ident(&name);
            let value = self.node(value);
            height = height.max(value.height);
            properties.push(crate::syntax::ast::Property { doc, name, value: value.expr });
        }
        self.over(ExprKind::Record(properties), span, height)
    }

    fn choice(&mut self, pair: Pair<'_, Rule>) -> Node {
        let span = self.span(&pair);
        let (mut values, height) = self.members(pair);
        let Some(otherwise) = values.pop() else { return Self::error(span) };
        // The pair itself goes on to the next word.
        let span = Span { end: otherwise.span.end, ..span };
        let mut branches = Vec::new();
        let mut values = values.into_iter();
        while let (Some(condition), Some(value)) = (values.next(), values.next()) {
            branches.push((condition, value));
        }
        self.over(ExprKind::If { branches, otherwise: Box::new(otherwise) }, span, height)
    }

    fn matching(&mut self, pair: Pair<'_, Rule>) -> Node {
        let span = self.span(&pair);
        let mut inner = parts(pair);
        let Some(subject) = inner.next() else { return Self::error(span) };
        let subject = self.node(subject);
        let mut height = subject.height;
        let mut arms = Vec::new();
        for arm in inner {
            let mut parts = parts(arm);
            let (Some(pattern), Some(value)) = (parts.next(), parts.next()) else { continue };
            let pattern = self.pattern(pattern);
            let value = self.node(value);
            height = height.max(value.height);
            if let Some((pattern, span)) = pattern {
                arms.push(Arm { pattern, span, value: value.expr });
            }
        }
        self.over(ExprKind::Match { subject: Box::new(subject.expr), arms }, span, height)
    }

    /// A pattern; one that is none has been reported, and its match cannot be trusted to cover its cases.
    fn pattern(&mut self, pair: Pair<'_, Rule>) -> Option<(Pattern, Span)> {
        let inner = pair.into_inner().next()?;
        if inner.as_rule() == Rule::any {
            return Some((Pattern::Any, self.span(&inner)));
        }
        let Expr { kind, span } = self.expression(inner);
        let pattern = match kind {
            ExprKind::Bool(value) => Some(Pattern::Bool(value)),
            ExprKind::Number { value, text, unit: None } => Some(Pattern::Number(value, text)),
            ExprKind::String(parts) => {
                let mut value = String::new();
                let is_plain = parts.into_iter().all(|part| match part {
                    StringPart::Text(text) => {
                        value.push_str(&text);
                        true
                    }
                    StringPart::Expr(_) => false,
                });
                is_plain.then_some(Pattern::String(value))
            }
            ExprKind::Error => return None,
            _ => None,
        };
        if pattern.is_none() {
            let message = "a pattern is a string, a number without sign or unit, `true`, `false` or `_`";
            self.report(Diagnostic::error(Code::Syntax, span, message));
        }
        pattern.map(|pattern| (pattern, span))
    }

    // -------------------------------------------------------------------------------------------- leaves

    fn number(&mut self, pair: Pair<'_, Rule>) -> ExprKind {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let Some(decimal) = parts.next() else { return ExprKind::Error };
        let text = decimal.as_str().to_owned();
        let value = text.parse::<f64>().unwrap_or(f64::INFINITY);
        if !value.is_finite() {
            self.report(Diagnostic::error(Code::Range, span, "this number is too large"));
            return ExprKind::Error;
        }
        let unit = match parts.next() {
            None => None,
            Some(unit) => {
                let symbol = unit.as_str();
                let known = Unit::ALL.iter().copied().find(|unit| unit.symbol() == symbol);
                if known.is_none() {
                    let place = self.span(&unit);
                    self.unknown_unit(symbol, place);
                    return ExprKind::Error;
                }
                known
            }
        };
        ExprKind::Number { value, text, unit }
    }

    fn unknown_unit(&mut self, symbol: &str, span: Span) {
        let symbols = Unit::ALL.map(Unit::symbol);
        let lower = symbol.to_lowercase();
        let same = symbols.iter().find(|known| **known == lower);
        let hint = match same {
            Some(known) => format!("did you mean `{known}`?"),
            None => near_word(symbol, &symbols)
                .unwrap_or_else(|| "units are `mm cm in pt px`, `deg rad turn` and `%`".to_owned()),
        };
        let message = if symbol.len() <= 40 { format!("unknown unit `{symbol}`") } else { "unknown unit".to_owned() };
        self.report(Diagnostic::error(Code::UnknownUnit, span, message).hint(hint));
    }

    fn colour(&mut self, pair: &Pair<'_, Rule>) -> ExprKind {
        let text = pair.as_str();
        let digits = text.get(1..).unwrap_or_default();
        let is_whole = digits.bytes().all(|byte| byte.is_ascii_hexdigit()) && matches!(digits.len(), 3 | 4 | 6 | 8);
        if is_whole {
            return ExprKind::Colour(text.to_owned());
        }
        let message = "a colour has 3, 4, 6 or 8 hexadecimal digits";
        let hint = "write `#rgb`, `#rrggbb` or `#rrggbbaa`";
        self.report(Diagnostic::error(Code::Syntax, self.span(pair), message).hint(hint));
        ExprKind::Error
    }

    /// The pieces of a `string`, and how deep they are.
    pub(super) fn string_parts(&mut self, pair: Pair<'_, Rule>) -> (Vec<StringPart>, usize) {
        let mut pieces = Vec::new();
        let mut plain = String::new();
        let mut height = 0;
        for piece in pair.into_inner() {
            match piece.as_rule() {
                Rule::text => plain.push_str(piece.as_str()),
                Rule::escape => plain.extend(self.escape(&piece)),
                _ => {
                    if !plain.is_empty() {
                        pieces.push(StringPart::Text(std::mem::take(&mut plain)));
                    }
                    if let Some(inner) = piece.into_inner().next() {
                        let node = self.node(inner);
                        height = height.max(node.height);
                        pieces.push(StringPart::Expr(node.expr));
                    }
                }
            }
        }
        if !plain.is_empty() || pieces.is_empty() {
            pieces.push(StringPart::Text(plain));
        }
        (pieces, height)
    }

    fn escape(&mut self, pair: &Pair<'_, Rule>) -> Option<char> {
        let text = pair.as_str();
        let span = self.span(pair);
        match text {
            "\\\"" => Some('"'),
            "\\\\" => Some('\\'),
            "\\n" => Some('\n'),
            "\\t" => Some('\t'),
            "\\{" => Some('{'),
            "\\}" => Some('}'),
            _ => {
                let digits = text.strip_prefix("\\u{").and_then(|rest| rest.strip_suffix('}'));
                if let Some(digits) = digits {
                    let is_hex = digits.len() <= 6 && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
                    let letter = u32::from_str_radix(digits, 16).ok().filter(|_| is_hex).and_then(char::from_u32);
                    if letter.is_none() {
                        let message = format!("`{text}` is no character");
                        let hint = "between the braces stand one to six hexadecimal digits of a Unicode scalar value";
                        self.report(Diagnostic::error(Code::Syntax, span, message).hint(hint));
                    }
                    return letter;
                }
                let hint = "the escapes are `\\\"`, `\\\\`, `\\n`, `\\t`, `\\{`, `\\}` and `\\u{3042}`";
                let message = format!("unknown escape `{text}`");
                self.report(Diagnostic::error(Code::Syntax, span, message).hint(hint));
                None
            }
        }
    }
}
