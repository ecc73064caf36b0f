//! What the call takes that a place lies in.

use lsp_types::{
    Documentation, MarkupContent, MarkupKind, ParameterInformation, ParameterLabel, SignatureHelp, SignatureInformation,
};

use crate::lower::reference::{self, Need, Param, Signature};

use super::analysis::Seen;
use super::context::{CallAt, context};
use super::declared::parameter;
use super::frame::Argument;
use super::text::Text;

/// The innermost call around a byte of a text, with the parameter that is being written.
#[must_use]
pub fn help(text: &Text, offset: usize, seen: Seen<'_>) -> Option<SignatureHelp> {
    let found = context(text.as_str(), offset, &seen);
    found.context.calls.iter().rev().find_map(|call| described(call, seen))
}

fn described(call: &CallAt<'_>, seen: Seen<'_>) -> Option<SignatureHelp> {
    let (name, about, params) = match seen.analysis.called(seen.source, &call.called, call.slot) {
        Some(declared) => {
            let params = declared.parameters().unwrap_or_default().iter().map(|param| {
                let doc = param.doc.as_ref().map(|doc| doc.text.clone()).unwrap_or_default();
                (param.name.name.clone(), parameter(param), doc)
            });
            let params: Vec<_> = params.collect();
            (declared.name.name.clone(), declared.doc.unwrap_or_default().to_owned(), params)
        }
        None => {
            let signature = vocabulary(call)?;
            let params =
                signature.params().iter().map(|param| (param.name().to_owned(), argument(param), explained(param)));
            (signature.name().to_owned(), signature.about().to_owned(), params.collect())
        }
    };
    let active = match call.argument {
        Argument::Named(label) => params.iter().position(|(name, ..)| name == label),
        Argument::Place(place) => (place < params.len()).then_some(place),
    };
    let list = params.iter().map(|(_, shown, _)| shown.as_str()).collect::<Vec<_>>().join(", ");
    let parameters = params.into_iter().map(|(_, shown, about)| ParameterInformation {
        label: ParameterLabel::Simple(shown),
        documentation: (!about.is_empty()).then(|| markdown(about)),
    });
    let information = SignatureInformation {
        label: format!("{name}({list})"),
        documentation: (!about.is_empty()).then(|| markdown(about)),
        parameters: Some(parameters.collect()),
        active_parameter: None,
    };
    Some(SignatureHelp {
        signatures: vec![information],
        active_signature: Some(0),
        // Beyond the last none is active.
        active_parameter: Some(active.map_or(u32::MAX, |place| u32::try_from(place).unwrap_or(u32::MAX))),
    })
}

/// The signature of the vocabulary behind a call.
pub(super) fn vocabulary(call: &CallAt<'_>) -> Option<&'static Signature> {
    let mut labels = call.labels.clone();
    if let Argument::Named(label) = call.argument {
        labels.push(label);
    }
    match call.called.module {
        None => reference::callable(call.called.name, call.slot, &labels),
        Some(_) => None,
    }
}

/// A signature as it is declared, in the words of the language.
pub(super) fn label(signature: &Signature) -> String {
    let params: Vec<String> = signature.params().iter().map(argument).collect();
    let result = signature.result().map(|kind| format!(" → {}", kind.name())).unwrap_or_default();
    format!("{}({}){result}", signature.name(), params.join(", "))
}

fn argument(param: &Param) -> String {
    let mark = if param.need() == Need::Required { "" } else { "?" };
    match param.slot().kind {
        Some(kind) if param.slot().words.is_empty() => format!("{}{mark}: {}", param.name(), kind.name()),
        Some(_) => format!("{}{mark}: {}", param.name(), param.slot().words.join(" | ")),
        None => format!("{}{mark}", param.name()),
    }
}

/// What a parameter takes, is and is by default.
pub(super) fn explained(param: &Param) -> String {
    let default = match param.need() {
        Need::Required => String::new(),
        Need::Optional(default) => format!(" Default: {default}."),
    };
    format!("{}: {}.{default}", param.slot().expectation(), param.about())
}

fn markdown(text: String) -> Documentation {
    Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value: text })
}
