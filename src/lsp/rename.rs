//! All places of a name over several files, and whether a new name means the same.
//!
//! A name is looked up in many ways: around it, among imports, in the vocabulary of its place. So nothing is guessed about
//! clashes: the scenes are looked at once more with the new name in place, and every name must still mean what it meant.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::kake::{self, KEYWORDS};

use super::analysis::{Analysis, Spot};

/// A place where a name stands, whatever scene it was found from.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Named {
    /// The text, as messages call it.
    pub file: String,
    /// Its first byte.
    pub start: usize,
    /// One past its last byte.
    pub end: usize,
}

impl Named {
    fn new(analysis: &Analysis, span: Span) -> Self {
        let file = analysis.sources.get(span.source).name.clone();
        Self { file, start: span.start as usize, end: span.end as usize }
    }

    /// Its bytes.
    #[must_use]
    pub fn bytes(&self) -> Range<usize> {
        self.start..self.end
    }
}

/// The name at a place and where it is declared, where it may be given another.
///
/// # Errors
/// Says why it may not.
pub fn renameable(analysis: &Analysis, spot: Spot) -> Result<(Span, Named), String> {
    let Some((span, name)) = analysis.name_at(spot) else {
        return Err("only names that a scene declares can be changed".to_owned());
    };
    let source = analysis.sources.get(name.source);
    if let Some((library, _)) = source.name.split_once(':') {
        let words = match library {
            "std" => format!("`{}` comes with the program: its names stay", source.name),
            library => format!("the name is declared in the library `{library}`: change it there"),
        };
        return Err(words);
    }
    Ok((span, Named::new(analysis, name)))
}

/// Every place in any of the scenes that names what is declared at a place, in order.
#[must_use]
pub fn places(scenes: &[&Analysis], declared: &Named) -> Vec<Named> {
    let mut found = BTreeSet::new();
    for analysis in scenes {
        let Some(source) = analysis.source(&declared.file) else { continue };
        let name = Span::new(source, declared.start, declared.end);
        // A scene that does not read the declaration as this one does has no say.
        if analysis.name_at(Spot { source, offset: declared.start }).is_none_or(|(_, found)| found != name) {
            continue;
        }
        found.extend(analysis.places_of(name).into_iter().map(|span| Named::new(analysis, span)));
    }
    found.into_iter().collect()
}

/// Whether a name may be written at these places.
///
/// # Errors
/// Says why not.
pub fn check_name(new: &str, places: &[Named], text: &dyn Fn(&str) -> Option<String>) -> Result<(), String> {
    if !kake::is_identifier(new) {
        let why = if kake::RESERVED.contains(&new) { "is a word of the language" } else { "is no name" };
        return Err(format!("`{new}` {why}"));
    }
    if KEYWORDS.contains(&new) {
        return Err(format!("`{new}` begins a statement"));
    }
    for place in places {
        let text = text(&place.file).unwrap_or_default();
        let written = text.get(place.bytes()).unwrap_or_default();
        if !kake::is_identifier(written) && !kake::KEYWORDS.contains(&written) {
            return Err(format!("in `{}` the name is written `{written}`: change it by hand", place.file));
        }
    }
    Ok(())
}

/// Whether every name means in `after`, where these places have a new name of `length` bytes, what it meant in `before`.
///
/// # Errors
/// Says what would mean something else.
pub fn same_meanings(before: &Analysis, after: &Analysis, places: &[Named], length: usize) -> Result<(), String> {
    let mut edits: BTreeMap<&str, Vec<&Named>> = BTreeMap::new();
    for place in places {
        edits.entry(&place.file).or_default().push(place);
    }
    let moved = |named: Named| {
        let earlier = edits.get(named.file.as_str()).into_iter().flatten().filter(|edit| edit.end <= named.start);
        let (mut lost, mut gained) = (0, 0);
        for edit in earlier {
            lost += edit.end - edit.start;
            gained += length;
        }
        (named.file, named.start + gained - lost)
    };
    let old: BTreeMap<_, _> = before
        .survey
        .uses
        .iter()
        .map(|(used, name)| (moved(Named::new(before, *used)), moved(Named::new(before, *name))))
        .collect();
    let place = |span: Span| {
        let named = Named::new(after, span);
        (named.file, named.start)
    };
    let new: BTreeMap<_, _> = after.survey.uses.iter().map(|(used, name)| (place(*used), place(*name))).collect();
    let faults = |analysis: &Analysis, code: Option<Code>| {
        analysis.diagnostics.iter().filter(|d| d.is_error() && code.is_none_or(|code| d.code == code)).count()
    };
    if let Some(twice) = after
        .diagnostics
        .iter()
        .find(|d| d.code == Code::Duplicate)
        .filter(|_| faults(after, Some(Code::Duplicate)) > faults(before, Some(Code::Duplicate)))
    {
        return Err(format!("{}{}", twice.message, line_of(after, twice)));
    }
    let keys: BTreeSet<_> = old.keys().chain(new.keys()).collect();
    for key in keys {
        if old.get(key) != new.get(key) {
            let text =
                after.source(&key.0).map(|source| after.sources.get(source).text.to_string()).unwrap_or_default();
            let line = text.get(..key.1).map_or(0, |before| before.matches('\n').count()) + 1;
            return Err(format!("a name in line {line} of `{}` would then mean something else", key.0));
        }
    }
    if faults(after, None) > faults(before, None) {
        let known: Vec<&str> = before.diagnostics.iter().map(|d| d.message.as_str()).collect();
        let fault = after.diagnostics.iter().find(|d| d.is_error() && !known.contains(&d.message.as_str()));
        let words = fault.map_or("there would be a new mistake".to_owned(), |fault| fault.message.clone());
        return Err(words);
    }
    Ok(())
}

fn line_of(analysis: &Analysis, diagnostic: &Diagnostic) -> String {
    let Some(span) = diagnostic.span else { return String::new() };
    let source = analysis.sources.get(span.source);
    let line = source.text.get(..span.start as usize).map_or(0, |before| before.matches('\n').count()) + 1;
    format!(" (line {line} of `{}`)", source.name)
}
