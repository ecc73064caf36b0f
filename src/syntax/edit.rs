//! Small changes to a scene's text.

use crate::span::{Source, SourceId, Syntax};
use crate::syntax::ast::{Document, StatementKind};
use crate::syntax::{kake, toml};

/// The names of the parameters that a text declares itself.
#[must_use]
pub fn params(id: SourceId, source: &Source) -> Vec<String> {
    let document = read(id, source);
    let names = document.statements.into_iter().filter_map(|statement| match statement.kind {
        StatementKind::Param { binding, .. } => Some(binding.name.name),
        _ => None,
    });
    names.collect()
}

fn read(id: SourceId, source: &Source) -> Document {
    match source.syntax {
        Syntax::Kake => kake::parse(id, &source.text).0,
        Syntax::Toml => toml::read(id, &source.text).0,
    }
}
