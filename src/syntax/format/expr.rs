//! Expressions.

use super::Formatter;
use super::items::{BLOCK, Brackets, CURLY, Item, ROUND, SQUARE};
use super::layout::Layout;
use crate::syntax::ast::{Argument, Arm, BinaryOp, Expr, ExprKind, Ident, Pattern, Property, StringPart, UnaryOp};

impl Formatter<'_> {
    /// An expression.
    pub(super) fn expr(&mut self, expr: &Expr) -> Layout {
        match &expr.kind {
            ExprKind::Number { text, unit, .. } => {
                let unit = unit.map_or("", |unit| unit.symbol());
                self.comments.word(expr.span, format!("{text}{unit}"))
            }
            ExprKind::Colour(text) | ExprKind::Name(text) => self.comments.word(expr.span, text.as_str()),
            ExprKind::Bool(value) => self.comments.word(expr.span, value.to_string()),
            ExprKind::String(parts) => {
                let text = self.string(expr, parts);
                Layout::Concat(vec![text, self.comments.before_close(expr.end())])
            }
            ExprKind::Member(base, name) => {
                let base = self.expr(base);
                let name = self.name(name);
                Layout::Concat(vec![base, Layout::text("."), name])
            }
            ExprKind::Call(callee, arguments) => self.call(expr, callee, arguments),
            ExprKind::Index(base, index) => {
                let base = self.expr(base);
                let index = self.expr(index);
                let close = self.comments.before_close(expr.end());
                Layout::Concat(vec![base, Layout::text("["), index, close, Layout::text("]")])
            }
            ExprKind::Group(inner) => {
                let open = self.comments.word(expr.span, "(");
                let inner = self.expr(inner);
                let close = self.comments.before_close(expr.end());
                Layout::Concat(vec![open, inner, close, Layout::text(")")])
            }
            ExprKind::Tuple(members) => self.members(expr, members, ROUND),
            ExprKind::List(members) => self.members(expr, members, SQUARE),
            ExprKind::Range(from, to) => {
                let from = self.expr(from);
                let to = self.expr(to);
                Layout::Concat(vec![from, Layout::text(" .. "), to])
            }
            ExprKind::Record(properties) => {
                let lead = self.comments.word(expr.span, "");
                let broken = properties
                    .first()
                    .is_some_and(|first| self.comments.is_broken_between(expr.start(), first.start()));
                Layout::Concat(vec![lead, self.record(properties, expr.end(), broken)])
            }
            ExprKind::Unary(operators, operand) => {
                let text: String = operators
                    .iter()
                    .map(|operator| match operator {
                        UnaryOp::Minus => "-",
                        UnaryOp::Not => "not ",
                    })
                    .collect();
                let operators = self.comments.word(expr.span, text);
                Layout::Concat(vec![operators, self.expr(operand)])
            }
            ExprKind::Binary(first, rest) => self.binary(first, rest),
            ExprKind::If { branches, otherwise } => self.conditional(expr, branches, otherwise),
            ExprKind::Match { subject, arms } => {
                let lead = self.comments.word(expr.span, "match ");
                let head = self.expr(subject);
                let broken =
                    arms.first().is_some_and(|first| self.comments.is_broken_between(subject.end(), first.start()));
                let items = self.items(arms, expr.end(), true, Self::arm);
                Layout::Concat(vec![lead, head, Layout::text(" "), items.enclose(BLOCK, broken)])
            }
            // Documents with errors are not written; in a message the place of the error is left open.
            ExprKind::Error => self.comments.word(expr.span, "…"),
        }
    }

    /// A name that is declared or looked up.
    pub(super) fn name(&mut self, name: &Ident) -> Layout {
        self.comments.word(name.span, name.name.as_str())
    }

    /// `name: value`
    pub(super) fn property(&mut self, property: &Property) -> Layout {
        let name = self.name(&property.name);
        Layout::Concat(vec![name, Layout::text(": "), self.expr(&property.value)])
    }

    /// `{ name: value }`, which closes at `end`.
    pub(super) fn record(&mut self, properties: &[Property], end: usize, broken: bool) -> Layout {
        self.items(properties, end, true, Self::property).enclose(CURLY, broken)
    }

    /// A string with what it interpolates, which stands on one line.
    fn string(&mut self, expr: &Expr, parts: &[StringPart]) -> Layout {
        let mut text = String::from("\"");
        let lead = self.comments.word(expr.span, "");
        for part in parts {
            match part {
                StringPart::Text(plain) => escape(plain, &mut text),
                StringPart::Expr(inner) => {
                    let inner = self.expr(inner).print(usize::MAX);
                    text.extend(["{", &inner, "}"]);
                }
            }
        }
        text.push('"');
        Layout::Concat(vec![lead, Layout::Text(text)])
    }

    fn call(&mut self, call: &Expr, callee: &Expr, arguments: &[Argument]) -> Layout {
        let head = self.expr(callee);
        if let [only] = arguments
            && only.name.is_none()
            && matches!(only.value.kind, ExprKind::List(_) | ExprKind::Record(_))
            && !self.comments.any_between(callee.end(), only.start())
            && !self.comments.any_between(only.end(), call.end())
            && !self.stays_broken(callee.end(), Some(only.end()), call.end())
        {
            // A list that is all there is needs no second level.
            let list = self.expr(&only.value);
            return Layout::Concat(vec![head, Layout::text("("), list, Layout::text(")")]);
        }
        let broken = self.stays_broken(callee.end(), arguments.last().map(Item::end), call.end());
        let items = self.items(arguments, call.end(), true, Self::argument);
        Layout::Concat(vec![head, items.enclose(ROUND, broken)])
    }

    fn argument(&mut self, argument: &Argument) -> Layout {
        match &argument.name {
            Some(name) => {
                let name = self.name(name);
                Layout::Concat(vec![name, Layout::text(": "), self.expr(&argument.value)])
            }
            None => self.expr(&argument.value),
        }
    }

    fn members(&mut self, expr: &Expr, members: &[Expr], brackets: Brackets) -> Layout {
        let lead = self.comments.word(expr.span, "");
        let broken = self.stays_broken(expr.start(), members.last().map(Item::end), expr.end());
        let items = self.items(members, expr.end(), true, Self::expr);
        Layout::Concat(vec![lead, items.enclose(brackets, broken)])
    }

    /// Whether a list was written over several lines with a trailing comma.
    pub(super) fn stays_broken(&self, start: usize, last: Option<usize>, end: usize) -> bool {
        last.is_some_and(|last| {
            self.comments.is_broken_between(start, end) && self.comments.find(last, end, ',').is_some()
        })
    }

    fn binary(&mut self, first: &Expr, rest: &[(BinaryOp, Expr)]) -> Layout {
        // Brackets within break first; a chain without any breaks before its operators.
        let rigid = is_breakable(first) || rest.iter().any(|(_, operand)| is_breakable(operand));
        let first = self.expr(first);
        let mut tail = Vec::with_capacity(rest.len() * 3);
        for (operator, operand) in rest {
            tail.push(if rigid { Layout::text(" ") } else { Layout::Line { flat: " ", blank: false } });
            tail.push(Layout::text(format!("{} ", operator.symbol())));
            tail.push(self.expr(operand));
        }
        let tail = if rigid { Layout::Concat(tail) } else { Layout::indent(tail) };
        Layout::group(vec![first, tail], false)
    }

    fn conditional(&mut self, expr: &Expr, branches: &[(Expr, Expr)], otherwise: &Expr) -> Layout {
        let mut head = Vec::new();
        let mut tail = Vec::new();
        for (i, (condition, value)) in branches.iter().enumerate() {
            let parts = if i == 0 {
                head.push(self.comments.word(expr.span, "if "));
                &mut head
            } else {
                tail.push(Layout::Line { flat: " ", blank: false });
                tail.push(Layout::text("else if "));
                &mut tail
            };
            parts.push(self.expr(condition));
            parts.push(Layout::text(" then "));
            parts.push(self.expr(value));
        }
        tail.push(Layout::Line { flat: " ", blank: false });
        tail.push(Layout::text("else "));
        tail.push(self.expr(otherwise));
        head.push(Layout::indent(tail));
        Layout::group(head, false)
    }

    fn arm(&mut self, arm: &Arm) -> Layout {
        let pattern = match &arm.pattern {
            Pattern::String(text) => quote(text),
            Pattern::Number(_, text) => text.clone(),
            Pattern::Bool(value) => value.to_string(),
            Pattern::Any => "_".to_owned(),
        };
        let pattern = self.comments.word(arm.span, pattern);
        Layout::Concat(vec![pattern, Layout::text(" => "), self.expr(&arm.value)])
    }
}

/// Whether an expression holds brackets at which a line may end.
fn is_breakable(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number { .. }
        | ExprKind::Colour(_)
        | ExprKind::String(_)
        | ExprKind::Bool(_)
        | ExprKind::Name(_)
        | ExprKind::Error => false,
        ExprKind::Call(callee, arguments) => !arguments.is_empty() || is_breakable(callee),
        ExprKind::Tuple(members) | ExprKind::List(members) => !members.is_empty(),
        ExprKind::Record(properties) => !properties.is_empty(),
        ExprKind::Match { .. } | ExprKind::If { .. } => true,
        ExprKind::Member(base, _) => is_breakable(base),
        ExprKind::Index(base, index) => is_breakable(base) || is_breakable(index),
        ExprKind::Group(inner) | ExprKind::Unary(_, inner) => is_breakable(inner),
        ExprKind::Range(from, to) => is_breakable(from) || is_breakable(to),
        ExprKind::Binary(first, rest) => is_breakable(first) || rest.iter().any(|(_, operand)| is_breakable(operand)),
    }
}

/// A string without interpolation, as it is written.
pub(super) fn quote(text: &str) -> String {
    let mut out = String::from("\"");
    escape(text, &mut out);
    out.push('"');
    out
}

/// Writes a string's text with the escapes it needs.
fn escape(text: &str, out: &mut String) {
    for letter in text.chars() {
        match letter {
            '"' | '\\' | '{' | '}' => out.extend(['\\', letter]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            control if control.is_control() => out.push_str(&format!("\\u{{{:x}}}", u32::from(control))),
            other => out.push(other),
        }
    }
}
