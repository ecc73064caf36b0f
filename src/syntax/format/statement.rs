//! Statements and blocks.

use super::Formatter;
use super::comments::Lead;
use super::expr::quote;
use super::items::{BLOCK, Item, Items, ROUND, Separator};
use super::layout::Layout;
use crate::syntax::ast::{Binding, Document, Expr, Ident, Parameter, Property, Statement, StatementKind, ToneBody};

impl Formatter<'_> {
    /// The whole document, each statement behind the end of a line.
    pub(super) fn document(&mut self, document: &Document) -> Layout {
        let lines = self.statements(&document.statements, usize::MAX).lines(Separator::Lines, "", false);
        // The first line needs no line end before it.
        Layout::Concat(lines.into_iter().skip(1).collect())
    }

    fn statements(&mut self, list: &[Statement], end: usize) -> Items {
        let mut items = self.items(list, end, false, Self::statement);
        if !self.comments.has_text() {
            for (i, pair) in list.windows(2).enumerate() {
                if let (true, Some(entry)) = (stand_apart(&pair[0], &pair[1]), items.entries.get_mut(i + 1)) {
                    match entry.leads.first_mut() {
                        Some(lead) => lead.blank = true,
                        None => entry.blank = true,
                    }
                }
            }
        }
        items
    }

    fn statement(&mut self, statement: &Statement) -> Layout {
        let end = statement.end();
        match &statement.kind {
            StatementKind::Edition(value) => Layout::Concat(vec![Layout::text("edition "), self.expr(value)]),
            StatementKind::Seed(value) => Layout::Concat(vec![Layout::text("seed "), self.expr(value)]),
            StatementKind::Import { path, alias } => {
                let mut parts = vec![Layout::text("import "), self.comments.word(path.span, quote(&path.value))];
                if let Some(alias) = alias {
                    parts.extend([Layout::text(" as "), self.name(alias)]);
                }
                Layout::Concat(parts)
            }
            StatementKind::Canvas(properties) => {
                let broken = self.comments.is_broken_between(statement.start(), end);
                let block = self.block(properties, end, broken);
                Layout::Concat(vec![Layout::text("canvas "), block])
            }
            StatementKind::Let(binding) => self.binding("let ", binding),
            StatementKind::Field(binding) => self.binding("field ", binding),
            StatementKind::Region(binding) => self.binding("region ", binding),
            StatementKind::Param { binding, domain } => {
                let binding = self.binding("param ", binding);
                match domain {
                    Some(domain) => Layout::Concat(vec![binding, Layout::text(" in "), self.expr(domain)]),
                    None => binding,
                }
            }
            StatementKind::Tone { name, params, body } => self.tone(statement, name, params, body),
            StatementKind::Fn { name, params, body } => {
                let lead = Layout::text("fn ");
                let name = self.name(name);
                let params = self.parameters(params, body.start());
                Layout::Concat(vec![lead, name, params, Layout::text(" = "), self.expr(body)])
            }
            StatementKind::Paint { region, tone, name, seed } => {
                let clauses = [("with ", Some(tone)), ("as ", name.as_ref()), ("seed ", seed.as_ref())];
                self.clauses("paint ", region, &clauses)
            }
            StatementKind::Outline { region, pen } => self.clauses("outline ", region, &[("pen ", pen.as_ref())]),
            StatementKind::Ink { drawing } => Layout::Concat(vec![Layout::text("ink "), self.expr(drawing)]),
            StatementKind::Layer { name, ink, body } => {
                let mut parts = vec![Layout::text("layer "), self.expr(name)];
                if let Some(ink) = ink {
                    parts.extend([Layout::text(" ink "), self.expr(ink)]);
                }
                parts.extend([Layout::text(" "), self.body(body, end)]);
                Layout::Concat(parts)
            }
            StatementKind::For { variable, iterable, body } => {
                let variable = self.name(variable);
                let iterable = self.expr(iterable);
                let body = self.body(body, end);
                Layout::Concat(vec![
                    Layout::text("for "),
                    variable,
                    Layout::text(" in "),
                    iterable,
                    Layout::text(" "),
                    body,
                ])
            }
            StatementKind::If { branches, otherwise } => self.condition(branches, otherwise.as_deref(), end),
            StatementKind::Experiment { name, properties } => {
                let name = self.name(name);
                let block = self.block(properties, end, true);
                Layout::Concat(vec![Layout::text("experiment "), name, Layout::text(" "), block])
            }
        }
    }

    /// `{ name: value … }`
    fn block(&mut self, properties: &[Property], end: usize, broken: bool) -> Layout {
        self.items(properties, end, true, Self::property).enclose(BLOCK, broken)
    }

    /// `{ statements }`
    fn body(&mut self, list: &[Statement], end: usize) -> Layout {
        self.statements(list, end).enclose(BLOCK, true)
    }

    fn binding(&mut self, keyword: &'static str, binding: &Binding) -> Layout {
        let mut parts = vec![Layout::text(keyword), self.name(&binding.name)];
        if let Some(ty) = &binding.ty {
            parts.extend([Layout::text(": "), self.name(ty)]);
        }
        parts.extend([Layout::text(" = "), self.expr(&binding.value)]);
        Layout::Concat(parts)
    }

    /// `name: type = default`
    pub(super) fn parameter(&mut self, parameter: &Parameter) -> Layout {
        let mut parts = vec![self.name(&parameter.name)];
        if let Some(ty) = &parameter.ty {
            parts.extend([Layout::text(": "), self.name(ty)]);
        }
        if let Some(default) = &parameter.default {
            parts.extend([Layout::text(" = "), self.expr(default)]);
        }
        Layout::Concat(parts)
    }

    /// `(name: type = default, …)`, which closes before `limit`.
    fn parameters(&mut self, list: &[Parameter], limit: usize) -> Layout {
        let (Some(first), Some(last)) = (list.first(), list.last()) else { return Layout::text("()") };
        let close = self.comments.find(last.end(), limit, ')').map_or(last.end(), |at| at + 1);
        let start = first.doc().filter(|_| self.docs).map_or(first.start(), |doc| doc.span.start as usize);
        let broken =
            self.comments.is_broken_between(start, close) && self.comments.find(last.end(), close, ',').is_some();
        self.items(list, close, true, Self::parameter).enclose(ROUND, broken)
    }

    fn tone(&mut self, statement: &Statement, name: &Ident, params: &[Parameter], body: &ToneBody) -> Layout {
        let end = statement.end();
        let mut parts = vec![Layout::text("tone "), self.name(name)];
        let limit = match body {
            ToneBody::Properties(properties) => properties.first().map_or(end, Item::start),
            ToneBody::Derived { base, .. } => base.start(),
        };
        if !params.is_empty() {
            parts.push(self.parameters(params, limit));
        }
        match body {
            ToneBody::Properties(properties) => {
                parts.extend([Layout::text(" "), self.block(properties, end, true)]);
            }
            ToneBody::Derived { base, with } => {
                parts.extend([Layout::text(" = "), self.expr(base)]);
                parts.extend([Layout::text(" with "), self.block(with, end, true)]);
            }
        }
        Layout::Concat(parts)
    }

    /// A statement of several clauses, on one line or on one each.
    fn clauses(&mut self, keyword: &'static str, first: &Expr, rest: &[(&'static str, Option<&Expr>)]) -> Layout {
        let head = vec![Layout::text(keyword), self.expr(first)];
        let mut previous = first.end();
        let mut tail = Vec::new();
        let mut broken = false;
        for (keyword, expr) in rest {
            let Some(expr) = expr else { continue };
            let gap = self.comments.gap(Some(previous), expr.start(), true);
            let mark = self.comments.mark();
            let body = self.expr(expr);
            let mut leads: Vec<Lead> = gap.own;
            leads.extend(self.comments.hoisted_since(mark));
            broken |= !leads.is_empty() || !gap.trailing.is_empty();
            tail.push(Layout::Suffix(gap.trailing));
            for lead in leads {
                tail.extend([Layout::Line { flat: " ", blank: false }, Layout::Text(lead.text)]);
            }
            tail.extend([Layout::Line { flat: " ", blank: false }, Layout::text(*keyword), body]);
            previous = expr.end();
        }
        let mut parts = head;
        parts.push(Layout::indent(tail));
        Layout::group(parts, broken)
    }

    fn condition(
        &mut self,
        branches: &[(Expr, Vec<Statement>)],
        otherwise: Option<&[Statement]>,
        end: usize,
    ) -> Layout {
        let mut parts = Vec::new();
        for (i, (condition, body)) in branches.iter().enumerate() {
            parts.push(Layout::text(if i == 0 { "if " } else { " else if " }));
            parts.push(self.expr(condition));
            parts.push(Layout::text(" "));
            let next = branches.get(i + 1).map(|(condition, _)| condition.start());
            let close = match next.or(otherwise.map(|list| list.first().map_or(end, Item::start))) {
                Some(limit) => self.closing_brace(condition.end(), body, limit),
                None => end,
            };
            parts.push(self.body(body, close));
        }
        if let Some(body) = otherwise {
            parts.extend([Layout::text(" else "), self.body(body, end)]);
        }
        Layout::Concat(parts)
    }

    /// Where the block behind a condition that ends at `start` closes, which is before `limit`.
    fn closing_brace(&self, start: usize, body: &[Statement], limit: usize) -> usize {
        let last = match body.last() {
            Some(last) => Some(last.end()),
            None => self.comments.find(start, limit, '{'),
        };
        let brace = last.and_then(|last| self.comments.find(last, limit, '}'));
        brace.map_or(limit, |at| at + 1)
    }
}

/// Whether an empty line between two statements reads better where no text says so.
fn stand_apart(above: &Statement, below: &Statement) -> bool {
    let tall = |statement: &Statement| {
        matches!(
            statement.kind,
            StatementKind::Tone { .. }
                | StatementKind::Layer { .. }
                | StatementKind::For { .. }
                | StatementKind::If { .. }
                | StatementKind::Experiment { .. }
        )
    };
    let group = |statement: &Statement| match &statement.kind {
        StatementKind::Edition(_) => 0,
        StatementKind::Import { .. } => 1,
        StatementKind::Canvas(_) | StatementKind::Seed(_) => 2,
        StatementKind::Param { .. } => 3,
        StatementKind::Let(_) | StatementKind::Field(_) | StatementKind::Region(_) => 4,
        StatementKind::Fn { .. } => 5,
        StatementKind::Tone { .. } => 6,
        StatementKind::Paint { .. }
        | StatementKind::Outline { .. }
        | StatementKind::Ink { .. }
        | StatementKind::Layer { .. }
        | StatementKind::For { .. }
        | StatementKind::If { .. } => 7,
        StatementKind::Experiment { .. } => 8,
    };
    tall(above) || tall(below) || group(above) != group(below)
}
