//! Brackets without a partner.
//!
//! In: the state of [`structure`](super::structure) where a bracket closes, or where something begins that cannot stand
//! inside the brackets that are open. Out: the brackets that were forgotten are closed there, and each such place is
//! one fault.

use super::{Builder, Frame, Layout, Shape};
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::kake::scan::{Fault, Kind, is_keyword};
use crate::syntax::kake::{MOST_ERRORS, NESTING, RESERVED};

/// Round, square, curly.
pub(super) fn bracket_kind(bracket: &str) -> Option<usize> {
    match bracket {
        "(" | ")" => Some(0),
        "[" | "]" => Some(1),
        "{" | "}" => Some(2),
        _ => None,
    }
}

/// The bracket that closes `open`.
fn closing(open: &str) -> &'static str {
    match open {
        "(" => ")",
        "[" => "]",
        "{" => "}",
        _ => "\"",
    }
}

impl Builder<'_> {
    /// Whether what follows a keyword makes it the beginning of a statement and nothing else.
    pub(super) fn is_followed_as_statement(&self, index: usize, keyword: &str) -> bool {
        let next = self.text_of(index + 1);
        let after = self.text_of(index + 2);
        let kind = self.kind_of(index + 1);
        let joins = RESERVED.contains(&next) || matches!(next, "with" | "as" | "in" | "pen" | "ink" | "_");
        let is_name = kind == Some(Kind::Word) && !joins;
        match keyword {
            "let" | "param" | "field" | "region" => is_name && matches!(after, "=" | ":"),
            "tone" | "fn" => is_name && matches!(after, "(" | "{" | "="),
            "experiment" => is_name && after == "{",
            "for" => is_name && after == "in",
            "paint" | "outline" | "ink" => {
                is_name && after != ":" && !(is_keyword(next) && self.is_followed_plainly(index + 1, next))
            }
            "layer" | "import" => matches!(kind, Some(Kind::Text | Kind::TextOpen | Kind::BadText)),
            "edition" | "seed" | "canvas" => self.is_followed_plainly(index, keyword),
            _ => false,
        }
    }

    /// The same for the keyword behind `paint`, which is more likely a value.
    fn is_followed_plainly(&self, index: usize, keyword: &str) -> bool {
        match keyword {
            "edition" | "seed" => self.kind_of(index + 1) == Some(Kind::Number),
            "canvas" => self.text_of(index + 1) == "{",
            "paint" | "outline" | "ink" => false,
            _ => self.is_followed_as_statement(index, keyword),
        }
    }

    /// Closes the brackets in which no statement may stand when one begins, and with [`Layout::Heeded`] the blocks that
    /// are indented no less than it.
    pub(super) fn close_forgotten(&mut self, index: usize, keyword: &str) {
        let Some(top) = self.frames.last() else { return };
        // As a property's value, `region` may well stand before `angle: …`.
        let is_value = top.shape == Shape::Properties && self.text_of(index + 2) == ":";
        if top.wants_value && (is_value || matches!(keyword, "edition" | "seed" | "canvas")) {
            return;
        }
        if self.frames.first().is_none_or(|whole| whole.shape != Shape::Statements) {
            return;
        }
        let Some(statements) = self.frames.iter().rposition(|frame| frame.shape == Shape::Statements) else { return };
        let mut keep = statements + 1;
        if self.layout == Layout::Heeded {
            let column = self.column(index);
            while keep > 1
                && let Some(around) = self.frames.get(keep - 2)
                && around.shape == Shape::Statements
                && around.indent >= column
            {
                keep -= 1;
            }
        }
        self.unclosed(keep, index);
    }

    /// With [`Layout::Heeded`], closes the brackets of values when what may be a property begins where an operator or
    /// comma is due.
    pub(super) fn close_before_property(&mut self, index: usize) {
        if self.layout == Layout::Ignored {
            return;
        }
        if !self.frames.last().is_some_and(|top| top.shape == Shape::Values && !top.wants_value) {
            return;
        }
        // Brackets nested beyond the limit are not searched, so that the work stays linear.
        let mut searched = self.frames.iter().enumerate().rev().take(NESTING);
        let around = searched.find(|(_, frame)| frame.shape != Shape::Values);
        if let Some((properties, frame)) = around
            && frame.shape == Shape::Properties
        {
            self.unclosed(properties + 1, index);
        }
    }

    /// Closes the brackets that this one ends.
    pub(super) fn close(&mut self, index: usize) {
        let bracket = self.text_of(index);
        let kind = bracket_kind(bracket);
        let opener = |frame: &Frame| frame.open.map(|open| self.text_of(open));
        let is_partner = |frame: &Frame| match (kind, frame.open) {
            (Some(kind), Some(_)) => opener(frame).and_then(bracket_kind) == Some(kind),
            (None, Some(_)) => frame.shape == Shape::Text,
            (_, None) => false,
        };
        let is_open = kind.is_none_or(|kind| self.counts.get(kind).is_some_and(|&count| count > 0));
        if is_open {
            let Some(partner) = self.frames.iter().rposition(is_partner) else { return };
            self.unclosed(partner + 1, index);
            self.pop(index, true);
            return;
        }
        let inner = self.frames.last().and_then(opener).unwrap_or_default();
        self.found.lost += 1;
        let span = self.span_of(index);
        let fault = if matches!(inner, "(" | "[") && self.text_of(index + 1) != closing(inner) {
            let open = self.frames.last().and_then(|frame| frame.open).unwrap_or_default();
            let message = format!("expected `{}`, found `{bracket}`", closing(inner));
            let note = self.span_of(open);
            self.pop(index, true);
            Diagnostic::error(Code::Syntax, span, message).note(note, "opened here")
        } else {
            // Several in a row are one mistake.
            let repeats = index > 0
                && self.kind_of(index - 1) == Some(Kind::Close)
                && self.found.roles.get(index - 1).is_some_and(|role| !role.is_matched);
            if repeats {
                return;
            }
            Diagnostic::error(Code::Syntax, span, format!("`{bracket}` closes nothing")).hint("leave it out")
        };
        self.fault(self.tokens.get(index).map_or(0, |token| token.start), fault);
    }

    /// Closes all but `keep` frames before token `end`, where their brackets should have been closed, and reports
    /// them as one mistake.
    pub(super) fn unclosed(&mut self, keep: usize, end: usize) {
        let mut forgotten = Vec::new();
        // Where nesting passes the limit, that is reported and enough.
        let mut is_known = self.is_too_deep;
        while self.frames.len() > keep.max(1) {
            if let Some(frame) = self.frames.last() {
                is_known |= frame.has_bad_text;
                if forgotten.len() < 4 {
                    forgotten.extend(frame.open);
                }
            }
            self.pop(end, false);
            self.found.lost += 1;
        }
        let Some((&inner, outer)) = forgotten.split_first() else { return };
        if is_known {
            return;
        }
        let bracket = self.text_of(inner);
        let span = match self.tokens.get(end) {
            Some(_) => self.span_of(end),
            None => self.tokens.last().map_or(self.places.span(0, 0), |last| self.places.span(last.end, last.end)),
        };
        let place = if end < self.tokens.len() { "before this" } else { "before the end" };
        let mut fault = Diagnostic::error(Code::Syntax, span, format!("unclosed `{bracket}`"))
            .label(format!("expected `{}` {place}", closing(bracket)))
            .note(self.span_of(inner), "opened here");
        for &open in outer {
            fault = fault.note(self.span_of(open), "this is not closed either");
        }
        self.fault(self.tokens.get(inner).map_or(0, |token| token.start), fault);
    }

    fn span_of(&self, index: usize) -> Span {
        let (start, end) = self.tokens.get(index).map_or((0, 0), |token| (token.start, token.end));
        self.places.span(start, end)
    }

    fn fault(&mut self, at: usize, diagnostic: Diagnostic) {
        if self.found.faults.len() < MOST_ERRORS {
            self.found.faults.push(Fault { at, diagnostic });
        }
    }
}
