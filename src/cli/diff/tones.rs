//! What became of a file that draws nothing by itself: its tones, functions, parameters and all else that it declares.
//!
//! In: the texts of two compilations that are without fault. Out: what came, went and changed, by name. Comments of either
//! kind, empty lines and the order of declarations change nothing.

use std::collections::BTreeMap;

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::lower::Lowered;
use crate::span::{Source, SourceId, Syntax};
use crate::syntax::ast::{Binding, Document, Expr, Parameter, Property, Statement, StatementKind, ToneBody};
use crate::syntax::format::{expression, shape};
use crate::syntax::{kake, toml};

use super::findings::Fate;

/// Something that is declared and that is not what it was.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub(super) struct Declared {
    /// The word that it is declared with: `tone`, `fn`, `param`…
    pub(super) kind: &'static str,
    /// Its name; empty of what has none.
    pub(super) name: String,
    pub(super) change: Fate,
    /// Its doc comment, as it stands now or stood last.
    pub(super) doc: Option<String>,
    /// Its parameters and properties that differ; of what came all of its parameters.
    pub(super) parts: Vec<Part>,
}

/// A parameter or a property.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub(super) struct Part {
    pub(super) name: String,
    /// The value before: a default, or an expression.
    pub(super) old: Option<String>,
    pub(super) new: Option<String>,
    pub(super) doc: Option<String>,
}

/// A declaration by itself.
#[derive(Debug, Default)]
struct Entry {
    doc: Option<String>,
    params: Vec<Value>,
    properties: Vec<Value>,
    /// What is not told of but matters.
    rest: String,
}

#[derive(Debug)]
struct Value {
    name: String,
    value: String,
    doc: Option<String>,
}

/// Declarations by what they are and what they are called, in the order in which they stand.
type Entries = Vec<((&'static str, String), Entry)>;

/// All that differs between two sides; a side that is not there declares nothing. What a scene imports counts as well, and
/// so do the files that it reads.
pub(super) fn declared(made: [Option<&Lowered>; 2]) -> Vec<Declared> {
    let [old, new] = made.map(|made| made.map(entries).unwrap_or_default());
    let places: BTreeMap<_, _> = old.iter().enumerate().map(|(place, (key, _))| (key, place)).collect();
    let mut stayed = vec![false; old.len()];
    let mut found = Vec::new();
    for (key, after) in &new {
        let before = places.get(key).copied();
        if let Some(place) = before {
            stayed[place] = true;
        }
        found.extend(compared(key, before.and_then(|place| old.get(place)).map(|(_, entry)| entry), Some(after)));
    }
    let went = old.iter().zip(stayed).filter(|(_, stayed)| !stayed);
    found.extend(went.filter_map(|((key, before), _)| compared(key, Some(before), None)));
    if made.iter().any(Option::is_none) {
        // That a file came or went says so of its edition.
        found.retain(|change| change.kind != "edition");
    }
    found
}

fn compared((kind, name): &(&'static str, String), before: Option<&Entry>, after: Option<&Entry>) -> Option<Declared> {
    let none = Entry::default();
    let (old, new) = (before.unwrap_or(&none), after.unwrap_or(&none));
    let change = match (before, after) {
        (None, _) => Fate::Came,
        (_, None) => Fate::Went,
        (Some(_), Some(_)) => Fate::Changed,
    };
    let mut parts = differing(&old.params, &new.params);
    if change == Fate::Changed {
        parts.extend(differing(&old.properties, &new.properties));
        if parts.is_empty() && old.rest == new.rest {
            return None;
        }
    }
    if change == Fate::Went {
        parts.clear();
    }
    let doc = new.doc.clone().or_else(|| old.doc.clone());
    Some(Declared { kind, name: name.clone(), change, doc, parts })
}

/// Values that differ, in the order of the new ones, what went at the end.
fn differing(old: &[Value], new: &[Value]) -> Vec<Part> {
    let find =
        |list: &[Value], name: &str| list.iter().find(|value| value.name == name).map(|value| value.value.clone());
    let went = old.iter().filter(|value| find(new, &value.name).is_none());
    let all = new.iter().chain(went).map(|value| Part {
        name: value.name.clone(),
        old: find(old, &value.name),
        new: find(new, &value.name),
        doc: value.doc.clone(),
    });
    all.filter(|part| part.old != part.new).collect()
}

/// All that a compilation read, the scene's own declarations one by one.
fn entries(lowered: &Lowered) -> Entries {
    let mut texts = lowered.sources.iter().filter(|(_, source)| !source.name.starts_with("--"));
    let mut entries = Entries::new();
    for statement in texts.next().map(|(id, source)| read(id, source).statements).unwrap_or_default() {
        let (key, entry) = entry(statement);
        match entries.iter_mut().find(|(known, _)| *known == key) {
            // What has no name of its own is one with others of its kind.
            Some((_, known)) => {
                known.properties.extend(entry.properties);
                known.rest.push('\n');
                known.rest.push_str(&entry.rest);
            }
            None => entries.push((key, entry)),
        }
    }
    for (id, source) in texts {
        let rest = read(id, source).statements.into_iter().map(said).collect();
        entries.push((("what is imported from", source.name.clone()), Entry { rest, ..Entry::default() }));
    }
    for (name, bytes) in &lowered.files {
        let rest = format!("{:?}", Sha256::digest(bytes));
        entries.push((("file", name.clone()), Entry { rest, ..Entry::default() }));
    }
    entries
}

fn read(id: SourceId, source: &Source) -> Document {
    match source.syntax {
        Syntax::Kake => kake::parse(id, &source.text).0,
        Syntax::Toml => toml::read(id, &source.text).0,
    }
}

/// What a statement says apart from its doc comments.
fn said(statement: Statement) -> String {
    let (key, entry) = entry(statement);
    let values = |list: Vec<Value>| list.into_iter().map(|value| (value.name, value.value)).collect::<Vec<_>>();
    format!("{key:?} {:?} {:?} {}\n", values(entry.params), values(entry.properties), entry.rest)
}

fn entry(statement: Statement) -> ((&'static str, String), Entry) {
    let Statement { doc, kind, span } = statement;
    let doc = doc.map(|doc| doc.text);
    let one = |name: &str, value: &Expr| Value { name: name.to_owned(), value: expression(value), doc: None };
    let plain = |properties: Vec<Value>| Entry { properties, ..Entry::default() };
    let bound = |binding: &Binding| {
        let ty = binding.ty.iter().map(|ty| Value { name: "type".to_owned(), value: ty.name.clone(), doc: None });
        ty.chain([one("value", &binding.value)]).collect::<Vec<_>>()
    };
    let (kind, name, entry) = match kind {
        StatementKind::Edition(value) => ("edition", String::new(), plain(vec![one("value", &value)])),
        StatementKind::Seed(value) => ("seed", String::new(), plain(vec![one("value", &value)])),
        StatementKind::Import { path, alias } => {
            let alias = alias.map(|alias| format!(" as {}", alias.name)).unwrap_or_default();
            ("import", format!("{}{alias}", path.value), Entry::default())
        }
        StatementKind::Canvas(properties) => ("canvas", String::new(), plain(listed(&properties))),
        StatementKind::Experiment { name, properties } => ("experiment", name.name, plain(listed(&properties))),
        StatementKind::Let(binding) => ("let", binding.name.name.clone(), plain(bound(&binding))),
        StatementKind::Field(binding) => ("field", binding.name.name.clone(), plain(bound(&binding))),
        StatementKind::Region(binding) => ("region", binding.name.name.clone(), plain(bound(&binding))),
        StatementKind::Param { binding, domain } => {
            let mut values = bound(&binding);
            values.extend(domain.as_ref().map(|domain| one("in", domain)));
            ("param", binding.name.name, plain(values))
        }
        StatementKind::Tone { name, params, body } => {
            let properties = match body {
                ToneBody::Properties(properties) => listed(&properties),
                ToneBody::Derived { base, with } => {
                    let mut values = vec![one("base", &base)];
                    values.extend(listed(&with));
                    values
                }
            };
            ("tone", name.name, with_parameters(&params, properties))
        }
        StatementKind::Fn { name, params, body } => {
            ("fn", name.name, with_parameters(&params, vec![one("value", &body)]))
        }
        kind @ (StatementKind::Paint { .. }
        | StatementKind::Outline { .. }
        | StatementKind::Ink { .. }
        | StatementKind::Layer { .. }
        | StatementKind::For { .. }
        | StatementKind::If { .. }) => {
            let statements = vec![Statement { doc: None, kind, span }];
            let rest = shape(&Document { source: span.source, statements, comments: Vec::new() });
            ("what is drawn", String::new(), Entry { rest, ..Entry::default() })
        }
    };
    ((kind, name), Entry { doc, ..entry })
}

fn listed(properties: &[Property]) -> Vec<Value> {
    let doc = |property: &Property| property.doc.as_ref().map(|doc| doc.text.clone());
    let value = |property: &Property| Value {
        name: property.name.name.clone(),
        value: expression(&property.value),
        doc: doc(property),
    };
    properties.iter().map(value).collect()
}

fn with_parameters(params: &[Parameter], properties: Vec<Value>) -> Entry {
    let value = |parameter: &Parameter| {
        let ty = parameter.ty.as_ref().map(|ty| format!("{} ", ty.name)).unwrap_or_default();
        let default = parameter.default.as_ref().map_or_else(|| "without a default".to_owned(), expression);
        let doc = parameter.doc.as_ref().map(|doc| doc.text.clone());
        Value { name: parameter.name.name.clone(), value: format!("{ty}{default}"), doc }
    };
    // Values may be given in the order of the parameters.
    let rest = params.iter().map(|parameter| parameter.name.name.as_str()).collect::<Vec<_>>().join(" ");
    Entry { doc: None, params: params.iter().map(value).collect(), properties, rest }
}
