//! TOML files that are no scenes: manifests, locks and pins.
//!
//! In: a text. Out: its [`Entry`]s in the order of the text, every key and value with its span, and diagnostics. A file
//! that is nested more deeply than scenes may be has no entries.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::read::{Reader, kind};
use crate::diag::{Code, Diagnostic, did_you_mean, sort};
use crate::span::{SourceId, Span};

/// A key with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub span: Span,
    /// What stands behind it.
    pub value: Value,
}

impl Entry {
    /// Says that its key means nothing where it stands.
    #[must_use]
    pub fn unknown(&self, place: &str, known: &[&str]) -> Diagnostic {
        let message = format!("`{}` is not known in {place}", self.key);
        let near = did_you_mean(&self.key, known.iter().copied());
        let hint = near.unwrap_or_else(|| format!("known here: {}", known.join(", ")));
        Diagnostic::error(Code::UnknownProperty, self.span, message).hint(hint)
    }

    /// Says that its value is not of the kind that its key asks for.
    #[must_use]
    pub fn wrong_type(&self, wanted: &str) -> Diagnostic {
        let message = format!("`{}` is {wanted}, not {}", self.key, self.value.kind.name());
        Diagnostic::error(Code::Type, self.value.span, message)
    }
}

/// A value with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// What it is.
    pub kind: Kind,
    /// Where it stands.
    pub span: Span,
}

/// What a value is.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A string.
    Text(String),
    /// A number without a fraction, as far as 64 bits hold it.
    Integer(i64),
    /// A number.
    Float(f64),
    /// A table.
    Table(Vec<Entry>),
    /// A list.
    List(Vec<Value>),
    /// Anything else, by its name: a boolean, a date, or a number that is out of range.
    Other(&'static str),
    /// It could not be read, which was reported.
    Lost,
}

impl Kind {
    /// What messages call it.
    fn name(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a float",
            Self::Table(_) => "a table",
            Self::List(_) => "an array",
            Self::Other(name) => name,
            Self::Lost => "unreadable",
        }
    }
}

/// Reads a file. The entries hold whatever could be read; the diagnostics say what could not.
#[must_use]
pub fn data(source: SourceId, text: &str) -> (Vec<Entry>, Vec<Diagnostic>) {
    let mut reader = Reader::new(source, text);
    let mut entries = Vec::new();
    if let Some(text) = reader.closed_text() {
        let (table, errors) = DeTable::parse_recoverable(&text);
        for error in errors {
            reader.syntax_error(&error, "text stands in quotes");
        }
        entries = table_entries(&reader, table.get_ref());
    }
    sort(&mut reader.diagnostics);
    (entries, reader.diagnostics)
}

/// The entries of a table. How deep tables and lists lie in each other was measured before.
fn table_entries(reader: &Reader<'_>, table: &DeTable<'_>) -> Vec<Entry> {
    let entries = reader.entries(table).into_iter();
    entries.map(|(key, found)| Entry { key: key.name, span: key.span, value: value(reader, found) }).collect()
}

fn value(reader: &Reader<'_>, found: &Spanned<DeValue<'_>>) -> Value {
    let kind = match found.get_ref() {
        _ if reader.is_lost(found) => Kind::Lost,
        DeValue::String(text) => Kind::Text(text.to_string()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Kind::Integer(number),
            Err(_) => Kind::Other("an integer of more than 64 bits"),
        },
        DeValue::Float(number) => match number.as_str().parse() {
            Ok(number) => Kind::Float(number),
            Err(_) => Kind::Other("a float"),
        },
        DeValue::Table(table) => Kind::Table(table_entries(reader, table)),
        DeValue::Array(list) => Kind::List(list.iter().map(|member| value(reader, member)).collect()),
        other @ (DeValue::Boolean(_) | DeValue::Datetime(_)) => Kind::Other(kind(other)),
    };
    Value { kind, span: reader.span(found.span()) }
}
