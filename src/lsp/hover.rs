//! What stands at a place, in words.

use crate::lower::reference::{self, Kind};
use crate::span::Span;
use crate::syntax::kake::KEYWORDS;

use super::analysis::{Analysis, Seen, Spot};
use super::context::{Found, Place, context};
use super::declared::{Declared, What};
use super::signature;

/// What stands at a place of a text, as Markdown, with the bytes that it is about. Names that are declared are told of in
/// any text; words of the language in `.kake` texts, for in TOML they lie in strings.
#[must_use]
pub fn hover(analysis: &Analysis, spot: Spot, is_toml: bool) -> Option<(Span, String)> {
    if let Some((span, name)) = analysis.name_at(spot)
        && let Some(declared) = analysis.declaration(name)
    {
        return Some((span, declaration(analysis, &declared)));
    }
    if let Some((span, source)) = analysis.import_at(spot) {
        return Some((span, module(analysis, &analysis.sources.get(source).name.clone())));
    }
    if is_toml {
        return None;
    }
    let text = &analysis.sources.get(spot.source).text;
    let seen = Seen { analysis, source: spot.source };
    let found = context(text, spot.offset, &seen);
    let word = found.context.word.clone();
    let about = vocabulary(text.get(word.clone())?, text.get(word.end..)?, &found, analysis, spot)?;
    Some((Span::new(spot.source, word.start, word.end), about))
}

fn declaration(analysis: &Analysis, declared: &Declared<'_>) -> String {
    let mut parts = vec![format!("```kake\n{}\n```", declared.heading())];
    if let What::Parameter(of, _) = declared.what {
        parts.push(format!("A parameter of `{}`.", of.name));
    }
    if let Some(doc) = declared.doc {
        parts.push(doc.to_owned());
    }
    if let Some(worth) = analysis.worth(declared.name.span) {
        // What a parameter is worth depends on the call.
        let is_parameter = matches!(declared.what, What::Parameter(..));
        match (worth.kind, worth.text.as_str()) {
            (Some(kind), "") => parts.push(format!("Takes {}.", kind.noun())),
            (Some(kind), _) if is_parameter => parts.push(format!("Takes {}.", kind.noun())),
            (_, "") => {}
            (_, text) => {
                let first = if worth.is_first { " at first" } else { "" };
                let is_written = !text.starts_with("a ") && !text.starts_with("an ") && !text.starts_with("the ");
                let shown = if is_written { format!("`{text}`") } else { text.to_owned() };
                parts.push(format!("Value{first}: {shown}"));
            }
        }
    }
    match declared.what {
        What::Module(_) => {
            let imports = analysis.imports(declared.name.span.source);
            let named = imports.into_iter().find(|(alias, _)| *alias == Some(declared.name.name.as_str()));
            if let Some((_, source)) = named {
                parts.push(members(analysis, source));
            }
        }
        _ if declared.name.span.source.ne(&first(analysis, declared)) => {
            parts.push(format!("From `{}`.", analysis.sources.get(declared.name.span.source).name));
        }
        _ => {}
    }
    parts.join("\n\n")
}

/// The scene's own text.
fn first(analysis: &Analysis, declared: &Declared<'_>) -> crate::span::SourceId {
    analysis.sources.iter().next().map_or(declared.name.span.source, |(id, _)| id)
}

fn module(analysis: &Analysis, name: &str) -> String {
    let members = analysis.source(name).map(|source| members(analysis, source)).unwrap_or_default();
    format!("`{name}`\n\n{members}")
}

/// The most names of a module that are listed.
const MOST_MEMBERS: usize = 40;

fn members(analysis: &Analysis, source: crate::span::SourceId) -> String {
    let Some(document) = analysis.document(source) else { return String::new() };
    let declared = super::declared::declared(document);
    let names: Vec<String> =
        declared.iter().filter(|d| d.is_top && d.noun() != "module").map(|d| format!("`{}`", d.name.name)).collect();
    match names.len() {
        0 => "It declares nothing.".to_owned(),
        count if count > MOST_MEMBERS => format!("Declares {}…", names[..MOST_MEMBERS].join(", ")),
        _ => format!("Declares {}.", names.join(", ")),
    }
}

/// What a word of the language means at its place. `after` is the text behind it.
fn vocabulary(word: &str, after: &str, found: &Found<'_>, analysis: &Analysis, spot: Spot) -> Option<String> {
    if word.is_empty() {
        return None;
    }
    let after = after.trim_start();
    let slot = found.slot;
    let owned = |owner: Option<&str>, word: &str| {
        let owner = owner?;
        reference::word(owner, word).map(|about| format!("`{owner}: {word}`: {about}."))
    };
    match found.context.place {
        Place::Property(block) if after.starts_with(':') => {
            let property = reference::properties(block).iter().find(|property| property.name == word)?;
            let default = match property.default {
                "" => "Must be given.".to_owned(),
                default => format!("Default: {default}."),
            };
            return Some(format!("**{word}**: {}\n\n{}\n\n{default}", property.slot.expectation(), property.about));
        }
        Place::Type => return Kind::from_name(word).map(|kind| format!("**{word}**: {}", reference::kind(kind))),
        Place::Text { owner } => return owned(owner, word.trim_matches('"')),
        Place::Nothing | Place::Member(_) => return None,
        _ => {}
    }
    if after.starts_with(':')
        && let Some(call) = found.context.calls.last()
    {
        let seen = Seen { analysis, source: spot.source };
        if seen.analysis.called(seen.source, &call.called, call.slot).is_none() {
            let signature = signature::vocabulary(call)?;
            let param = signature.params().iter().find(|param| param.name() == word)?;
            return Some(format!("**{word}** of `{}`: {}", signature.name(), signature::explained(param)));
        }
    }
    let owner = match found.context.place {
        Place::Value { owner } => owner,
        // The first word of an argument may name it or be its value.
        Place::Argument => found.context.calls.last().and_then(|call| {
            let signature = signature::vocabulary(call)?;
            match call.argument {
                super::frame::Argument::Place(place) => signature.params().get(place).map(|param| param.name()),
                super::frame::Argument::Named(_) => None,
            }
        }),
        _ => None,
    };
    let is_value = matches!(found.context.place, Place::Value { .. } | Place::Argument);
    if is_value {
        if let Some(about) = owned(owner, word).filter(|_| slot.words.contains(&word)) {
            return Some(about);
        }
        if let Some((_, about)) = reference::constants(slot).into_iter().find(|(name, _)| *name == word) {
            return Some(format!("**{word}**: {about}"));
        }
        let labels: &[&str] = if called_with_at(after) { &["at"] } else { &[] };
        let is_called = after.starts_with('(');
        if let Some(signature) = reference::callable(word, slot, labels)
            && (is_called || signature.result() == slot.kind)
        {
            let params: Vec<String> = signature
                .params()
                .iter()
                .map(|param| format!("- `{}` {}", param.name(), signature::explained(param)))
                .collect();
            return Some(format!(
                "```kake\n{}\n```\n\n{}\n\n{}",
                signature::label(signature),
                signature.about(),
                params.join("\n")
            ));
        }
        if slot.kind == Some(Kind::Colour) {
            let named = reference::colours().find(|(name, _)| *name == word);
            return named.map(|(_, colour)| format!("`{}`", colour.hex()));
        }
    }
    if let Some(about) = reference::word("clause", word).filter(|_| !is_value) {
        return Some(format!("**{word}**: {about}."));
    }
    let is_statement = matches!(found.context.place, Place::Statement { .. }) && KEYWORDS.contains(&word);
    let (about, _) = reference::statement(word).filter(|_| is_statement)?;
    Some(format!("**{word}**: {about}"))
}

/// Whether the arguments that follow name one `at`: what tells the region `rect` from the stamp.
fn called_with_at(after: &str) -> bool {
    let inside = after.split(')').next().unwrap_or_default();
    inside.split([',', '(']).any(|argument| argument.trim_start().starts_with("at:"))
}
