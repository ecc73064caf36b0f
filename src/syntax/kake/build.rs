//! Statements, from what the grammar found.
//!
//! In: pairs of `grammar/kake.pest`. Out: parts of the syntax tree. The grammar guarantees the order of the parts; a
//! part that is missing all the same leaves its statement out.

use super::grammar::Rule;
use super::read::Reader;
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{Binding, Expr, Ident, Parameter, Property, StatementKind, StringPart, Text, ToneBody};
use pest::iterators::Pair;
use unicode_normalization::{UnicodeNormalization, is_nfc};

/// The parts of a pair that carry meaning: not its keywords, brackets and commas.
pub(super) fn parts(pair: Pair<'_, Rule>) -> impl Iterator<Item = Pair<'_, Rule>> {
    pair.into_inner().filter(|part| {
        !matches!(
            part.as_rule(),
            Rule::word_edition
                | Rule::word_import
                | Rule::word_canvas
                | Rule::word_seed
                | Rule::word_let
                | Rule::word_param
                | Rule::word_field
                | Rule::word_region
                | Rule::word_tone
                | Rule::word_fn
                | Rule::word_paint
                | Rule::word_outline
                | Rule::word_layer
                | Rule::word_for
                | Rule::word_if
                | Rule::word_experiment
                | Rule::word_as
                | Rule::word_with
                | Rule::word_in
                | Rule::word_pen
                | Rule::word_ink
                | Rule::word_then
                | Rule::word_else
                | Rule::word_match
                | Rule::colon
                | Rule::comma
                | Rule::equals
                | Rule::arrow
                | Rule::open_paren
                | Rule::close_paren
                | Rule::close_bracket
                | Rule::open_brace
                | Rule::close_brace
        )
    })
}

impl Reader<'_> {
    /// Where a pair stands in the source.
    pub(super) fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        self.places.span(self.base + span.start(), self.base + span.end())
    }

    pub(super) fn ident(&self, pair: &Pair<'_, Rule>) -> Ident {
        let name = pair.as_str();
        let name = if is_nfc(name) { name.to_owned() } else { name.nfc().collect() };
        Ident { name, span: self.span(pair) }
    }

    /// `simple`
    pub(super) fn simple(&mut self, pair: Pair<'_, Rule>) -> Option<StatementKind> {
        let pair = pair.into_inner().next()?;
        let rule = pair.as_rule();
        let mut parts = parts(pair);
        let first = parts.next()?;
        Some(match rule {
            Rule::edition => StatementKind::Edition(self.expression(first)),
            Rule::seed => StatementKind::Seed(self.expression(first)),
            Rule::import => {
                let path = self.path(first)?;
                StatementKind::Import { path, alias: parts.next().map(|alias| self.ident(&alias)) }
            }
            Rule::let_ => StatementKind::Let(self.binding(first)?),
            Rule::field => StatementKind::Field(self.binding(first)?),
            Rule::region => StatementKind::Region(self.binding(first)?),
            Rule::param => {
                let binding = self.binding(first)?;
                StatementKind::Param { binding, domain: parts.next().map(|domain| self.expression(domain)) }
            }
            Rule::fn_ => {
                let name = self.ident(&first);
                let params = self.parameter_list(parts.next()?);
                StatementKind::Fn { name, params, body: self.expression(parts.next()?) }
            }
            Rule::outline => {
                let region = self.expression(first);
                StatementKind::Outline { region, pen: parts.next().map(|pen| self.expression(pen)) }
            }
            Rule::ink => StatementKind::Ink { drawing: self.expression(first) },
            Rule::paint => {
                let region = self.expression(first);
                let tone = self.expression(parts.next()?);
                let (name, seed) = self.paint_tail(parts);
                StatementKind::Paint { region, tone, name, seed }
            }
            _ => return None,
        })
    }

    /// `as "name" seed N`, in this order.
    fn paint_tail<'i>(&mut self, tail: impl Iterator<Item = Pair<'i, Rule>>) -> (Option<Expr>, Option<Expr>) {
        let (mut name, mut seed) = (None, None);
        for part in tail {
            let is_name = part.as_rule() == Rule::paint_name;
            let word = self.span(&part).at_start();
            let Some(value) = parts(part).next() else { continue };
            let value = self.expression(value);
            let span = word.to(value.span);
            let slot = if is_name { &mut name } else { &mut seed };
            let is_double = slot.replace(value).is_some();
            if is_double {
                let what = if is_name { "name" } else { "seed" };
                self.report(Diagnostic::error(Code::Syntax, span, format!("a paint has one {what}")));
            } else if is_name && seed.is_some() {
                let message = "the name stands before the seed";
                self.report(Diagnostic::error(Code::Syntax, span, message).hint("write `as \"…\" seed …`"));
            }
        }
        (name, seed)
    }

    /// `canvas_head`, `experiment_head`, `tone_head`; the properties are to be filled in.
    pub(super) fn properties_head(&mut self, pair: Pair<'_, Rule>) -> Option<StatementKind> {
        let rule = pair.as_rule();
        let mut parts = parts(pair).peekable();
        Some(match rule {
            Rule::canvas_head => StatementKind::Canvas(Vec::new()),
            Rule::experiment_head => {
                StatementKind::Experiment { name: self.ident(&parts.next()?), properties: Vec::new() }
            }
            Rule::tone_head => {
                let name = self.ident(&parts.next()?);
                let params = parts.next_if(|part| part.as_rule() == Rule::parameter_list);
                let params = params.map(|list| self.parameter_list(list)).unwrap_or_default();
                let body = match parts.next() {
                    Some(base) => ToneBody::Derived { base: self.expression(base), with: Vec::new() },
                    None => ToneBody::Properties(Vec::new()),
                };
                StatementKind::Tone { name, params, body }
            }
            _ => return None,
        })
    }

    /// `layer_head`, `for_head`; the statements are to be filled in.
    pub(super) fn statements_head(&mut self, pair: Pair<'_, Rule>) -> Option<StatementKind> {
        let rule = pair.as_rule();
        let mut parts = parts(pair);
        let first = parts.next()?;
        Some(match rule {
            Rule::layer_head => {
                let name = self.expression(first);
                let ink = parts.next().map(|ink| self.expression(ink));
                StatementKind::Layer { name, ink, body: Vec::new() }
            }
            Rule::for_head => {
                let variable = self.ident(&first);
                StatementKind::For { variable, iterable: self.expression(parts.next()?), body: Vec::new() }
            }
            _ => return None,
        })
    }

    /// The condition of `if_head` and `else_if_head`; none for `else_head`.
    pub(super) fn condition_head(&mut self, pair: Pair<'_, Rule>) -> Option<Expr> {
        let condition = parts(pair).next()?;
        Some(self.expression(condition))
    }

    fn path(&mut self, pair: Pair<'_, Rule>) -> Option<Text> {
        let span = self.span(&pair);
        let parts = self.string_parts(pair.into_inner().next()?).0;
        let mut value = String::new();
        for part in parts {
            match part {
                StringPart::Text(text) => value.push_str(&text),
                StringPart::Expr(inner) => {
                    let message = "the path of an import cannot be computed";
                    let hint = "for a brace in a file's name write `\\{`";
                    self.report(Diagnostic::error(Code::Syntax, inner.span, message).hint(hint));
                    return None;
                }
            }
        }
        Some(Text { value, span })
    }

    fn binding(&mut self, pair: Pair<'_, Rule>) -> Option<Binding> {
        let mut parts = parts(pair).peekable();
        let name = self.ident(&parts.next()?);
        let ty = parts.next_if(|part| part.as_rule() == Rule::type_name).map(|ty| self.ident(&ty));
        Some(Binding { name, ty, value: self.expression(parts.next()?) })
    }

    /// `parameter_list` or `parameters`
    pub(super) fn parameter_list(&mut self, pair: Pair<'_, Rule>) -> Vec<Parameter> {
        let list = match pair.as_rule() {
            Rule::parameters => Some(pair),
            _ => parts(pair).next(),
        };
        let Some(list) = list.filter(|list| list.as_rule() == Rule::parameters) else { return Vec::new() };
        let mut parameters = Vec::new();
        for pair in parts(list) {
            let doc = self.doc_above(self.base + pair.as_span().start());
            let mut parts = parts(pair).peekable();
            let Some(name) = parts.next() else { continue };
            let name = self.ident(&name);
            let ty = parts.next_if(|part| part.as_rule() == Rule::type_name).map(|ty| self.ident(&ty));
            let default = parts.next().map(|value| self.expression(value));
            parameters.push(Parameter { doc, name, ty, default });
        }
        parameters
    }

    /// `property`
    pub(super) fn property(&mut self, pair: Pair<'_, Rule>) -> Option<Property> {
        let doc = self.doc_above(self.base + pair.as_span().start());
        let mut parts = parts(pair);
        let name = self.ident(&parts.next()?);
        Some(Property { doc, name, value: self.expression(parts.next()?) })
    }
}
