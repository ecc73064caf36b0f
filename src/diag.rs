//! Diagnostics: the one type in which every part of the program says what is wrong, and the table of their codes.
//!
//! A diagnostic has a stable code, a plain sentence, the narrowest span that is at fault, a hint where a fix is known
//! and notes for further places. [`render`] draws them through miette, [`to_json`] gives the same as data.

mod codes;
mod excerpt;
mod place;
mod render;

pub use codes::Code;
pub use render::{RenderConfig, render, to_json};

use crate::span::Span;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Nothing can be built.
    Error,
    /// A picture comes out, but perhaps not the one that was meant.
    Warning,
}

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Which kind of mistake.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// A plain sentence without a full stop at its end.
    pub message: String,
    /// Where, unless the mistake stands in no text (a command-line argument, a picture's metadata).
    pub span: Option<Span>,
    /// A few words under the span.
    pub label: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// Further places that are involved.
    pub notes: Vec<(Span, String)>,
}

impl Diagnostic {
    /// An error at a span.
    #[must_use]
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message: message.into(),
            span: Some(span),
            label: String::new(),
            hint: None,
            notes: Vec::new(),
        }
    }

    /// A warning at a span.
    #[must_use]
    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, span, message) }
    }

    /// An error that stands in no text.
    #[must_use]
    pub fn without_span(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message: message.into(),
            span: None,
            label: String::new(),
            hint: None,
            notes: Vec::new(),
        }
    }

    /// With a few words under the span.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// With a hint.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// With a hint where there is one.
    #[must_use]
    pub fn maybe_hint(mut self, hint: Option<String>) -> Self {
        self.hint = hint.or(self.hint);
        self
    }

    /// With a further place.
    #[must_use]
    pub fn note(mut self, span: Span, note: impl Into<String>) -> Self {
        self.notes.push((span, note.into()));
        self
    }

    /// Whether it keeps a picture from being made.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Puts diagnostics in the order of their places (sources in the order they were read), those without one first, and
/// drops repeated ones.
pub fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by_key(|diagnostic| (diagnostic.span, diagnostic.severity, diagnostic.code));
    diagnostics.dedup();
}

/// "did you mean `x`?" for the known name that is nearest to `name`, if one is near.
#[must_use]
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let mut best: Option<(f64, &str)> = None;
    for candidate in known {
        let likeness = strsim::damerau_levenshtein(name, candidate);
        let longest = name.chars().count().max(candidate.chars().count());
        if likeness > 3 || likeness * 2 > longest {
            continue;
        }
        // Fewer edits first, and of those the name whose beginning agrees.
        let score = likeness as f64 - strsim::jaro_winkler(name, candidate);
        if best.is_none_or(|(least, _)| score < least) {
            best = Some((score, candidate));
        }
    }
    best.map(|(_, candidate)| format!("did you mean `{candidate}`?"))
}

/// A number with its thousands apart: `2,000,000`.
#[must_use]
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}
