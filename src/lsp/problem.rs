//! Diagnostics in the protocol's form.

use lsp_types::{DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Range, Uri};

use crate::diag::{Diagnostic, Severity};
use crate::span::Span;

/// How bad it is, in the protocol's numbers.
#[must_use]
pub fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::ERROR,
        Severity::Warning => DiagnosticSeverity::WARNING,
    }
}

/// How an editor shows what belongs to a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Related {
    /// Below it, with places of their own.
    Shown,
    /// Not at all.
    Unknown,
}

/// A diagnostic at `range` of the text at `uri`. The hint and further places become related information; `place` gives
/// the place of a span, where an editor can open its text.
#[must_use]
pub fn problem(
    diagnostic: &Diagnostic,
    (uri, range): (&Uri, Range),
    related: Related,
    place: &dyn Fn(Span) -> Option<Location>,
) -> lsp_types::Diagnostic {
    let hint = diagnostic.hint.as_ref().map(|hint| DiagnosticRelatedInformation {
        location: Location { uri: uri.clone(), range },
        message: hint.clone(),
    });
    let notes = diagnostic.notes.iter().filter_map(|(span, note)| {
        Some(DiagnosticRelatedInformation { location: place(*span)?, message: note.clone() })
    });
    let further: Vec<_> = match related {
        Related::Shown => hint.into_iter().chain(notes).collect(),
        Related::Unknown => Vec::new(),
    };
    let message = match (&diagnostic.hint, related) {
        (Some(hint), Related::Unknown) => format!("{}\n{hint}", diagnostic.message),
        _ => diagnostic.message.clone(),
    };
    lsp_types::Diagnostic {
        range,
        severity: Some(severity(diagnostic.severity)),
        code: Some(NumberOrString::String(diagnostic.code.to_string())),
        source: Some("kake".to_owned()),
        message,
        related_information: (!further.is_empty()).then_some(further),
        ..lsp_types::Diagnostic::default()
    }
}
