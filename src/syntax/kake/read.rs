//! Reads a text statement by statement and property by property.
//!
//! In: a text. Out: what could be read of it, and a diagnostic for each statement, heading or property that could not.
//! Every one of those is a run of the grammar over its own stretch of text, so that a mistake is reported once, where
//! it stands, and the others are read whatever it is.

use super::grammar::{Grammar, Rule};
use super::scan::{Kind, Remarks, Scanner, Token, is_keyword};
use super::structure::{Role, Shape, structure};
use super::{KEYWORDS, MOST_ERRORS, NESTING, Places, expected, near_word};
use crate::diag::{self, Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{Comment, Doc, Expr, ExprKind, Parameter, Property, Statement, StatementKind, ToneBody};
use pest::Parser;
use pest::error::{Error, ErrorVariant, InputLocation};
use pest::iterators::Pairs;
use std::ops::Range;

/// What a text is.
#[derive(Clone, Copy)]
pub(super) enum Whole {
    /// Statements.
    File,
    /// An expression or a list of parameters.
    Value,
}

pub(super) struct Reader<'t> {
    pub(super) text: &'t str,
    pub(super) places: &'t Places<'t>,
    /// The words and signs of the text.
    pub(super) tokens: Vec<Token>,
    roles: Vec<Role>,
    too_deep: Vec<usize>,
    /// The tokens that are strings without an end.
    unclosed: Vec<usize>,
    /// Where the faults that are already reported begin.
    faults: Vec<usize>,
    remarks: Remarks,
    /// Where in the text the stretch begins that the grammar was run over.
    pub(super) base: usize,
    /// Whether that stretch has been found to be nested too deeply.
    pub(super) is_too_deep: bool,
    diagnostics: Vec<Diagnostic>,
}

/// A `{ … }` that belongs to a statement.
struct Block {
    /// What it holds.
    shape: Shape,
    /// The token of its brace.
    brace: usize,
    /// Its tokens.
    inside: Range<usize>,
    /// The token behind it.
    next: usize,
}

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str, places: &'t Places<'t>, whole: Whole) -> Self {
        let Scanner { tokens, remarks, faults, .. } = Scanner::scan(text, places);
        let shape = match whole {
            Whole::File => Shape::Statements,
            Whole::Value => Shape::Values,
        };
        let structure = structure(text, &tokens, shape, places);
        let mut starts = Vec::new();
        let mut diagnostics = Vec::new();
        for fault in faults.into_iter().chain(structure.faults) {
            starts.push(fault.at);
            diagnostics.push(fault.diagnostic);
        }
        starts.sort_unstable();
        let unclosed = tokens.iter().enumerate().filter(|(_, token)| token.kind == Kind::BadText);
        let unclosed = unclosed.map(|(index, _)| index).collect();
        Self {
            text,
            places,
            tokens,
            roles: structure.roles,
            too_deep: structure.too_deep,
            unclosed,
            faults: starts,
            remarks,
            base: 0,
            is_too_deep: false,
            diagnostics,
        }
    }

    /// The comments that document nothing, and all that is wrong, in order.
    pub(super) fn finish(mut self) -> (Vec<Comment>, Vec<Diagnostic>) {
        diag::sort(&mut self.diagnostics);
        (self.remarks.rest(self.text, self.places), self.diagnostics)
    }

    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// The doc comment above what begins at a place of the stretch that was parsed.
    pub(super) fn doc_above(&mut self, offset: usize) -> Option<Doc> {
        self.remarks.take_doc(self.text, self.places, offset)
    }

    pub(super) fn text_of(&self, index: usize) -> &'t str {
        self.tokens.get(index).and_then(|token| self.text.get(token.start..token.end)).unwrap_or_default()
    }

    fn kind_of(&self, index: usize) -> Option<Kind> {
        self.tokens.get(index).map(|token| token.kind)
    }

    /// From the first byte of one token to the last of another.
    fn span_of(&self, first: usize, last: usize) -> Span {
        let start = self.tokens.get(first).map_or(self.text.len(), |token| token.start);
        let end = self.tokens.get(last).map_or(self.text.len(), |token| token.end);
        self.places.span(start, end.max(start))
    }

    /// The token behind this one, or behind the bracket that this one opens.
    fn after(&self, index: usize) -> usize {
        match (self.kind_of(index), self.roles.get(index)) {
            (Some(Kind::Open | Kind::TextOpen), Some(role)) => role.mate + usize::from(role.is_matched),
            _ => index + 1,
        }
    }

    /// Where the statement or property that begins at `start` ends: at the next one.
    fn stop(&self, start: usize, end: usize) -> usize {
        let mut at = self.after(start);
        while at < end && !self.roles.get(at).is_some_and(|role| role.begins) {
            at = self.after(at);
        }
        at.min(end)
    }

    /// The first block in a range of tokens.
    fn block(&self, range: Range<usize>) -> Option<Block> {
        let mut at = range.start;
        while at < range.end {
            let role = self.roles.get(at)?;
            if let Some(shape) = role.block {
                let inside = at + 1..role.mate.max(at + 1);
                return Some(Block { shape, brace: at, inside, next: self.after(at) });
            }
            at = self.after(at);
        }
        None
    }

    // ------------------------------------------------------------------------------------------- wholes

    /// All statements of a file.
    pub(super) fn file(&mut self) -> Vec<Statement> {
        self.statements(0..self.tokens.len())
    }

    /// The text as one expression.
    pub(super) fn value(&mut self) -> Expr {
        let all = 0..self.tokens.len();
        let value = self.run(Rule::one_expression, &all).and_then(|mut pairs| pairs.next());
        let value = value.map(|pair| self.expression(pair));
        value.unwrap_or_else(|| Expr { kind: ExprKind::Error, span: self.places.span(0, self.text.len()) })
    }

    /// The text as the inside of a parameter list.
    pub(super) fn parameters(&mut self) -> Vec<Parameter> {
        let all = 0..self.tokens.len();
        let list = self.run(Rule::all_parameters, &all).and_then(|mut pairs| pairs.next());
        list.map(|pair| self.parameter_list(pair)).unwrap_or_default()
    }

    fn statements(&mut self, range: Range<usize>) -> Vec<Statement> {
        let mut statements = Vec::new();
        let mut at = range.start;
        while at < range.end && !self.is_full(at) {
            let stop = self.stop(at, range.end);
            statements.extend(self.statement(at, stop));
            at = stop;
        }
        statements
    }

    /// Whether so much is wrong that reading on would help nobody.
    fn is_full(&mut self, at: usize) -> bool {
        if self.diagnostics.len() < MOST_ERRORS {
            return false;
        }
        if self.diagnostics.len() == MOST_ERRORS {
            let message = format!("there are {MOST_ERRORS} mistakes or more: from here on the text was not read");
            self.report(Diagnostic::error(Code::Syntax, self.span_of(at, at), message));
        }
        true
    }

    /// The statement in a range of tokens.
    fn statement(&mut self, first: usize, stop: usize) -> Option<Statement> {
        let word = self.text_of(first);
        if self.kind_of(first) != Some(Kind::Word) || !is_keyword(word) {
            return self.no_statement(first, stop);
        }
        let start = self.tokens.get(first)?.start;
        let doc = self.doc_above(start);
        let (kind, last) = match word {
            "canvas" | "experiment" | "tone" => self.with_properties(first, stop)?,
            "layer" | "for" => self.with_statements(first, stop)?,
            "if" => self.condition(first, stop)?,
            _ => {
                let pair = self.run(Rule::one_simple, &(first..stop))?.next()?;
                (self.simple(pair)?, stop - 1)
            }
        };
        Some(Statement { doc, kind, span: self.span_of(first, last) })
    }

    /// Reports what stands where a statement should, and reads the block behind it if it has one.
    fn no_statement(&mut self, first: usize, stop: usize) -> Option<Statement> {
        let word = self.text_of(first);
        let is_reported = self.tokens.get(first).is_none_or(|token| {
            self.faults.binary_search(&token.start).is_ok()
                || (token.kind == Kind::Close && !self.roles.get(first).is_some_and(|role| role.is_matched))
        });
        if !is_reported {
            let found = expected::describe(self.kind_of(first), word);
            let message = format!("expected a statement, found {found}");
            let hint = match word {
                "else" => Some("`else` follows the `}` of an `if { … }`".to_owned()),
                ";" => Some("statements end by themselves: leave the `;` out".to_owned()),
                _ if self.text_of(first + 1) == "=" => Some("a name is declared with `let name = …`".to_owned()),
                _ if self.kind_of(first) == Some(Kind::Word) => near_word(word, KEYWORDS),
                _ => None,
            };
            self.report(Diagnostic::error(Code::Syntax, self.span_of(first, first), message).maybe_hint(hint));
        }
        let block = self.block(first..stop)?;
        if self.too_deep_in(&(first..block.brace + 1)).is_none() {
            self.inside(&block);
        }
        None
    }

    /// Reads a block for what is wrong in it.
    fn inside(&mut self, block: &Block) {
        match block.shape {
            Shape::Statements => drop(self.statements(block.inside.clone())),
            Shape::Properties => drop(self.properties(block.inside.clone())),
            Shape::Values | Shape::Text => {}
        }
    }

    /// Runs the grammar over a heading up to its brace, and finds the block. The heading may be wrong and the block
    /// still be there; one that is nested too deeply is not entered.
    fn head(&mut self, first: usize, stop: usize) -> (Option<Pairs<'t, Rule>>, Option<Block>) {
        let block = self.block(first..stop);
        let heading = first..block.as_ref().map_or(stop, |block| block.brace + 1);
        let is_too_deep = self.too_deep_in(&heading).is_some();
        (self.run(Rule::one_head, &heading), block.filter(|_| !is_too_deep))
    }

    fn with_properties(&mut self, first: usize, stop: usize) -> Option<(StatementKind, usize)> {
        let (head, block) = self.head(first, stop);
        let head = head.and_then(|mut head| self.properties_head(head.next()?));
        let block = block?;
        let properties = self.properties(block.inside.clone());
        let kind = match head? {
            StatementKind::Canvas(_) => StatementKind::Canvas(properties),
            StatementKind::Experiment { name, .. } => StatementKind::Experiment { name, properties },
            StatementKind::Tone { name, params, body } => {
                let body = match body {
                    ToneBody::Properties(_) => ToneBody::Properties(properties),
                    ToneBody::Derived { base, .. } => ToneBody::Derived { base, with: properties },
                };
                StatementKind::Tone { name, params, body }
            }
            _ => return None,
        };
        Some((kind, block.next - 1))
    }

    fn with_statements(&mut self, first: usize, stop: usize) -> Option<(StatementKind, usize)> {
        let (head, block) = self.head(first, stop);
        let head = head.and_then(|mut head| self.statements_head(head.next()?));
        let block = block?;
        let statements = self.statements(block.inside.clone());
        let kind = match head? {
            StatementKind::Layer { name, ink, .. } => StatementKind::Layer { name, ink, body: statements },
            StatementKind::For { variable, iterable, .. } => {
                StatementKind::For { variable, iterable, body: statements }
            }
            _ => return None,
        };
        Some((kind, block.next - 1))
    }

    fn condition(&mut self, first: usize, stop: usize) -> Option<(StatementKind, usize)> {
        let mut branches = Vec::new();
        let mut otherwise = None;
        let mut is_whole = true;
        let mut at = first;
        let mut last = first;
        while at < stop {
            if otherwise.is_some() {
                let message = "nothing can follow the last `else`".to_owned();
                self.report(Diagnostic::error(Code::Syntax, self.span_of(at, at), message));
                return None;
            }
            let has_condition = at == first || self.text_of(at + 1) == "if";
            let (head, block) = self.head(at, stop);
            let condition = match head {
                Some(mut head) => head.next().and_then(|pair| self.condition_head(pair)),
                None => {
                    is_whole = false;
                    None
                }
            };
            let block = block?;
            let statements = self.statements(block.inside.clone());
            match condition {
                Some(condition) => branches.push((condition, statements)),
                None if !has_condition => otherwise = Some(statements),
                None => {}
            }
            at = block.next;
            last = at - 1;
        }
        (is_whole && !branches.is_empty()).then_some((StatementKind::If { branches, otherwise }, last))
    }

    fn properties(&mut self, range: Range<usize>) -> Vec<Property> {
        let mut properties = Vec::new();
        let mut at = range.start;
        while at < range.end && !self.is_full(at) {
            let stop = self.stop(at, range.end);
            if let Some(pair) = self.run(Rule::one_property, &(at..stop)).and_then(|mut pairs| pairs.next()) {
                properties.extend(self.property(pair));
            }
            at = stop;
        }
        properties
    }

    // ----------------------------------------------------------------------------------- runs of the grammar

    /// Runs a rule over the tokens of a range, and reports where it does not fit.
    fn run(&mut self, rule: Rule, range: &Range<usize>) -> Option<Pairs<'t, Rule>> {
        self.is_too_deep = false;
        if let Some(token) = self.too_deep_in(range) {
            self.nested_too_deeply(self.span_of(token, token));
            return None;
        }
        let start = self.tokens.get(range.start).map_or(self.text.len(), |token| token.start);
        // The rest of a line behind a quote that is not closed is not text that the structure knows.
        let unclosed = self.unclosed.partition_point(|&token| token < range.start);
        let end = match self.unclosed.get(unclosed).filter(|&&token| token < range.end) {
            Some(&token) => self.tokens.get(token).map_or(start, |token| token.start),
            None => {
                let last = range.end.checked_sub(1).and_then(|last| self.tokens.get(last));
                last.map_or(start, |token| token.end)
            }
        };
        self.base = start;
        match Grammar::parse(rule, self.text.get(start..end.max(start)).unwrap_or_default()) {
            Ok(pairs) => Some(pairs),
            Err(error) => {
                self.misfit(rule, &error, range);
                None
            }
        }
    }

    /// The first token of a range at which nesting passes the limit.
    fn too_deep_in(&self, range: &Range<usize>) -> Option<usize> {
        let first = self.too_deep.partition_point(|&token| token < range.start);
        self.too_deep.get(first).copied().filter(|&token| token < range.end)
    }

    /// Reports nesting beyond the limit, once for a stretch.
    pub(super) fn nested_too_deeply(&mut self, span: Span) {
        if !std::mem::replace(&mut self.is_too_deep, true) {
            let message = format!("this is nested too deeply: the limit is {NESTING}");
            let hint = "give inner parts names with `let`";
            self.report(Diagnostic::error(Code::Nesting, span, message).hint(hint));
        }
    }

    fn misfit(&mut self, rule: Rule, error: &Error<Rule>, range: &Range<usize>) {
        let offset = match error.location {
            InputLocation::Pos(offset) | InputLocation::Span((offset, _)) => self.base + offset,
        };
        let ErrorVariant::ParsingError { positives, .. } = &error.variant else {
            // The grammar ran out of stack: a host gave it less than a thread usually has.
            self.nested_too_deeply(self.span_of(range.start, range.start));
            return;
        };
        let found = self.tokens.partition_point(|token| token.end <= offset);
        let mut found = (found < range.end).then_some(found);
        let until = found.and_then(|found| self.tokens.get(found)).map_or(offset, |token| token.start.max(offset));
        // What is wrong with a bracket or string has been said already.
        let known = self.faults.partition_point(|&fault| fault < self.base);
        if self.faults.get(known).is_some_and(|&fault| fault <= until) {
            return;
        }
        let last = range.end.checked_sub(1).filter(|&last| last >= range.start);
        // Where a heading lacks a value, the grammar takes the block's brace for that of a record.
        let mut tried = positives.as_slice();
        if let (Rule::one_head, None, Some(brace)) = (rule, found, last)
            && self.text_of(brace) == "{"
        {
            (found, tried) = (last, &[Rule::expression]);
        }
        let place = expected::Place {
            found: found.map(|index| (self.kind_of(index), self.text_of(index))),
            before: found
                .unwrap_or(range.end)
                .checked_sub(1)
                .filter(|&index| index >= range.start)
                .map(|index| (self.kind_of(index), self.text_of(index))),
            first: self.text_of(range.start),
            next: match rule {
                Rule::one_simple | Rule::one_head => "the next statement",
                Rule::one_property => "the next property",
                _ => "the end",
            },
        };
        let span = match (found, last) {
            (Some(found), _) => self.span_of(found, found),
            (None, Some(last)) => self.span_of(last, last),
            (None, None) => self.places.span(self.text.len(), self.text.len()),
        };
        let diagnostic = expected::message(tried, &place, span);
        self.report(diagnostic);
    }
}
