//! From TOML to a document: the file and its declarations.

use std::borrow::Cow;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::guard;
use super::place::Places;
use crate::diag::{Code, Diagnostic, did_you_mean, sort};
use crate::span::{SourceId, Span};
use crate::syntax::ast::{Binding, Doc, Document, Expr, ExprKind, Ident, Property, Statement, StatementKind, ToneBody};

/// Reads a scene in TOML. The document holds whatever could be read; the diagnostics say what could not.
#[must_use]
pub fn read(source: SourceId, text: &str) -> (Document, Vec<Diagnostic>) {
    let mut reader = Reader::new(source, text);
    let mut statements = Vec::new();
    if let Some(text) = reader.closed_text() {
        let (table, errors) = DeTable::parse_recoverable(&text);
        for error in errors {
            reader.syntax_error(&error, "expressions of the language stand in quotes");
        }
        reader.file(table.get_ref(), &mut statements);
    }
    sort(&mut reader.diagnostics);
    (Document { source, statements, comments: Vec::new() }, reader.diagnostics)
}

/// The keys of the file in the order in which their statements stand in the document: what draws comes late.
pub(super) const SECTIONS: [&str; 12] =
    ["edition", "import", "canvas", "seed", "param", "let", "field", "region", "fn", "tone", "draw", "experiment"];

/// After so many values that are not closed, the rest of the text is read as it is.
const MOST_UNCLOSED: usize = 16;

/// A key with its place.
#[derive(Debug, Clone)]
pub(super) struct Key {
    /// What it says.
    pub(super) name: String,
    /// Where it stands, with its quotes if it has any.
    pub(super) span: Span,
}

/// A value with its place.
pub(super) type Value<'t> = &'t Spanned<DeValue<'t>>;

/// Reads one file.
pub(super) struct Reader<'a> {
    pub(super) source: SourceId,
    pub(super) text: &'a str,
    pub(super) diagnostics: Vec<Diagnostic>,
    /// How many blocks, arrays and tables of the language are around.
    pub(super) depth: usize,
    /// Whether the text is TOML; if not, what is missing may only be unreadable.
    is_sound: bool,
    /// Where values begin that were taken out because they are not closed.
    unclosed: Vec<usize>,
}

impl<'a> Reader<'a> {
    /// At the beginning of a text.
    pub(super) fn new(source: SourceId, text: &'a str) -> Self {
        Self { source, text, diagnostics: Vec::new(), depth: 0, is_sound: true, unclosed: Vec::new() }
    }

    /// The span of a range of bytes. The parser of TOML counts a bad escape as two bytes, whatever the second begins.
    pub(super) fn span(&self, range: std::ops::Range<usize>) -> Span {
        let length = self.text.len();
        let is_between = |at: &usize| self.text.is_char_boundary(*at);
        let start = (0..=range.start.min(length)).rev().find(is_between).unwrap_or(0);
        let end = (range.end.min(length)..=length).find(is_between).unwrap_or(length);
        Span::new(self.source, start, end)
    }

    /// The entries of a table in the order of the text.
    pub(super) fn entries<'t>(&self, table: &'t DeTable<'t>) -> Vec<(Key, Value<'t>)> {
        let mut entries: Vec<(Key, Value<'t>)> = table
            .iter()
            .map(|(key, value)| {
                let name = key.get_ref().to_string();
                (Key { name, span: self.span(key.span()) }, value)
            })
            .collect();
        entries.sort_by_key(|(key, _)| key.span);
        entries
    }

    /// The written form of a string and the places of its value.
    pub(super) fn places(&self, value: Value<'_>) -> (&'a str, Places<'a>) {
        let range = value.span();
        let raw = self.text.get(range.clone()).unwrap_or("");
        (raw, Places::new(raw, range.start))
    }

    /// Whether a value could not be read, which has been reported: the TOML parser makes one up, or takes what has no
    /// quotes for a string.
    pub(super) fn is_lost(&self, value: Value<'_>) -> bool {
        let range = value.span();
        match value.get_ref() {
            DeValue::Integer(_) => range.is_empty() || self.unclosed.contains(&range.start),
            DeValue::String(_) => !self.text.get(range).is_some_and(|raw| raw.starts_with(['"', '\''])),
            _ => false,
        }
    }

    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    pub(super) fn too_deep(&mut self, span: Span) {
        let message = format!("nested more than {} levels deep", guard::NESTING);
        self.report(Diagnostic::error(Code::Nesting, span, message).hint("give the inner parts names with `let`"));
    }

    /// The text without the values that are not closed; none if it is nested too deeply.
    pub(super) fn closed_text(&mut self) -> Option<Cow<'a, str>> {
        let mut text = Cow::Borrowed(self.text);
        loop {
            let nesting = guard::measure(&text);
            if let Some(range) = nesting.too_deep {
                self.too_deep(self.span(range));
                return None;
            }
            match nesting.unclosed {
                Some(open) if self.unclosed.len() < MOST_UNCLOSED => {
                    self.is_sound = false;
                    self.unclosed.push(open);
                    let bracket = text.get(open..open + 1).unwrap_or("");
                    let message = format!("`{bracket}` is not closed");
                    self.report(Diagnostic::error(Code::Syntax, self.span(open..open + 1), message));
                    text = Cow::Owned(guard::without_unclosed(&text, open));
                }
                _ => return Some(text),
            }
        }
    }

    /// Reports an error of the TOML parser; `quotes` says what stands in quotes.
    pub(super) fn syntax_error(&mut self, error: &toml::de::Error, quotes: &str) {
        self.is_sound = false;
        let span = self.span(error.span().unwrap_or(0..0));
        let message = error.message();
        let under = self.text.get(span.start as usize..span.end as usize).unwrap_or("").trim();
        self.report(match message {
            "duplicate key" => Diagnostic::error(Code::Duplicate, span, format!("`{under}` is given twice")),
            _ if message.starts_with("string values must be quoted") && under.is_empty() => {
                Diagnostic::error(Code::Syntax, span, "expected a value")
            }
            _ if message.starts_with("string values must be quoted") => {
                Diagnostic::error(Code::Syntax, span, format!("`{under}` is no value of TOML")).hint(quotes)
            }
            _ => Diagnostic::error(Code::Syntax, span, message),
        });
    }

    /// A value that is not what its key asks for.
    pub(super) fn wrong_type(&mut self, span: Span, key: &str, wanted: &str, value: &DeValue<'_>) {
        let message = format!("`{key}` is {wanted}, not {}", kind(value));
        self.report(Diagnostic::error(Code::Type, span, message));
    }

    /// A key that does not have the form a scene needs.
    pub(super) fn wrong_form(&mut self, span: Span, message: String, hint: String) {
        self.report(Diagnostic::error(Code::Toml, span, message).hint(hint));
    }

    /// Reports what must be given and is not.
    pub(super) fn missing(&mut self, span: Span, message: String) {
        if self.is_sound {
            self.report(Diagnostic::error(Code::Missing, span, message));
        }
    }

    /// A key that means nothing where it stands.
    pub(super) fn unknown(&mut self, key: &Key, place: &str, known: &[&str]) {
        let message = format!("`{}` is not known in {place}", key.name);
        let near = did_you_mean(&key.name, known.iter().copied());
        let hint = near.unwrap_or_else(|| format!("known here: {}", known.join(", ")));
        self.report(Diagnostic::error(Code::UnknownProperty, key.span, message).hint(hint));
    }

    /// A table, if the value is one.
    pub(super) fn table<'t>(&mut self, key: &Key, value: Value<'t>, example: &str) -> Option<&'t DeTable<'t>> {
        let table = value.get_ref().as_table();
        if table.is_none() && !self.is_lost(value) {
            let message = format!("`{}` is a table, not {}", key.name, kind(value.get_ref()));
            self.wrong_form(key.span, message, format!("write `{example}`"));
        }
        table
    }

    /// The tables of an array of tables, with their places.
    pub(super) fn tables<'t>(&mut self, key: &Key, value: Value<'t>, example: &str) -> Vec<(Span, &'t DeTable<'t>)> {
        let Some(array) = value.get_ref().as_array() else {
            if !self.is_lost(value) {
                let message = format!("`{}` is an array of tables, not {}", key.name, kind(value.get_ref()));
                self.wrong_form(key.span, message, format!("write `{example}`"));
            }
            return Vec::new();
        };
        self.members(key, array)
    }

    fn members<'t>(&mut self, key: &Key, array: &'t DeArray<'t>) -> Vec<(Span, &'t DeTable<'t>)> {
        let mut tables = Vec::new();
        for member in array.iter() {
            let span = self.span(member.span());
            match member.get_ref().as_table() {
                Some(table) => tables.push((span, table)),
                None if self.is_lost(member) => {}
                None => {
                    let message = format!("`{}` holds tables, not {}", key.name, kind(member.get_ref()));
                    self.wrong_form(span, message, "every entry is a table with the keys of a statement".into());
                }
            }
        }
        tables
    }

    fn file(&mut self, table: &DeTable<'_>, out: &mut Vec<Statement>) {
        let mut entries = self.entries(table);
        for (key, _) in entries.iter().filter(|(key, _)| !SECTIONS.contains(&key.name.as_str())) {
            self.unknown(key, "a scene", &SECTIONS);
        }
        entries.sort_by_key(|(key, _)| SECTIONS.iter().position(|section| *section == key.name));
        for (key, value) in &entries {
            if key.name == "draw" {
                for (span, table) in self.tables(key, value, "[[draw]]") {
                    self.draw(span, table, out);
                }
            } else {
                self.declare(key, value, out);
            }
        }
    }

    /// Whether a key declares something, in the file or in a block.
    pub(super) fn declares(name: &str) -> bool {
        name != "draw" && SECTIONS.contains(&name)
    }

    /// Reads the declarations of one key.
    pub(super) fn declare(&mut self, key: &Key, value: Value<'_>, out: &mut Vec<Statement>) {
        match key.name.as_str() {
            "edition" => self.scalar(key, value, out, StatementKind::Edition),
            "seed" => self.scalar(key, value, out, StatementKind::Seed),
            "import" => {
                for (span, table) in self.tables(key, value, "[[import]]") {
                    self.import(span, table, out);
                }
            }
            "canvas" => {
                if let Some(table) = self.table(key, value, "[canvas]") {
                    let mut block = Block::default();
                    for (key, value) in self.entries(table) {
                        self.block_entry(&mut block, key, value);
                    }
                    let kind = StatementKind::Canvas(block.properties);
                    out.push(Statement { doc: block.doc, kind, span: self.covering(key, value) });
                }
            }
            "let" => self.bindings(key, value, out, StatementKind::Let),
            "field" => self.bindings(key, value, out, StatementKind::Field),
            "region" => self.bindings(key, value, out, StatementKind::Region),
            "param" => self.named(key, value, out, "a parameter", Self::param),
            "fn" => self.named(key, value, out, "a function", Self::function),
            "tone" => self.named(key, value, out, "a tone", Self::tone),
            "experiment" => self.named(key, value, out, "an experiment", Self::experiment),
            _ => {}
        }
    }

    /// `edition` and `seed`.
    fn scalar(&mut self, key: &Key, value: Value<'_>, out: &mut Vec<Statement>, make: fn(Expr) -> StatementKind) {
        let property = self.property(key, value);
        out.push(Statement { doc: property.doc, kind: make(property.value), span: self.covering(key, value) });
    }

    fn import(&mut self, span: Span, table: &DeTable<'_>, out: &mut Vec<Statement>) {
        let mut doc = None;
        let mut path = None;
        let mut alias = None;
        let mut place = span;
        for (key, value) in self.entries(table) {
            match key.name.as_str() {
                "doc" => doc = self.doc(&key, value),
                "import" => {
                    place = self.covering(&key, value);
                    path = self.plain(&key, value);
                }
                "as" => alias = self.ident_value(&key, value),
                _ => self.unknown(&key, "an import", &["import", "as", "doc"]),
            }
        }
        match path {
            Some(path) => out.push(Statement { doc, kind: StatementKind::Import { path, alias }, span: place }),
            None if table.get("import").is_some() => {}
            None => self.missing(span, "an import needs `import`, the file's path".into()),
        }
    }

    /// `[let]`, `[field]`, `[region]`
    fn bindings(&mut self, key: &Key, value: Value<'_>, out: &mut Vec<Statement>, make: fn(Binding) -> StatementKind) {
        let Some(table) = self.table(key, value, &format!("[{}]", key.name)) else { return };
        for (key, value) in self.entries(table) {
            let Some(name) = self.ident(&key) else { continue };
            let span = self.covering(&key, value);
            let mut binding = Binding { name, ty: None, value: lost(span) };
            let mut doc = None;
            match value.get_ref().as_table().filter(|table| is_documented(table, &["value", "type", "doc"])) {
                Some(table) => {
                    for (key, value) in self.entries(table) {
                        match key.name.as_str() {
                            "type" => binding.ty = self.type_value(&key, value),
                            "doc" => doc = self.doc(&key, value),
                            _ => binding.value = self.value(value),
                        }
                    }
                }
                None => binding.value = self.value(value),
            }
            out.push(Statement { doc, kind: make(binding), span });
        }
    }

    /// `[param.NAME]`, `[fn.NAME]`, `[tone.NAME]`, `[experiment.NAME]`
    fn named(
        &mut self,
        key: &Key,
        value: Value<'_>,
        out: &mut Vec<Statement>,
        what: &str,
        read: fn(&mut Self, Ident, Span, &DeTable<'_>) -> Statement,
    ) {
        let Some(table) = self.table(key, value, &format!("[{}.name]", key.name)) else { return };
        let section = &key.name;
        for (key, value) in self.entries(table) {
            let Some(table) = value.get_ref().as_table() else {
                if !self.is_lost(value) {
                    let message = format!("{what} is a table, not {}", kind(value.get_ref()));
                    self.wrong_form(key.span, message, format!("write `[{section}.{}]`", key.name));
                }
                continue;
            };
            if let Some(name) = self.ident(&key) {
                let span = self.covering(&key, value);
                out.push(read(self, name, span, table));
            }
        }
    }

    fn param(&mut self, name: Ident, span: Span, table: &DeTable<'_>) -> Statement {
        let mut binding = Binding { name, ty: None, value: lost(span) };
        let mut domain = None;
        let mut doc = None;
        for (key, value) in self.entries(table) {
            match key.name.as_str() {
                "type" => binding.ty = self.type_value(&key, value),
                "default" => binding.value = self.value(value),
                "in" => domain = Some(self.value(value)),
                "doc" => doc = self.doc(&key, value),
                _ => self.unknown(&key, "a parameter", &["type", "default", "in", "doc"]),
            }
        }
        if !table.contains_key("default") {
            self.missing(span, format!("the parameter `{}` needs a `default`", binding.name.name));
        }
        Statement { doc, kind: StatementKind::Param { binding, domain }, span }
    }

    fn function(&mut self, name: Ident, span: Span, table: &DeTable<'_>) -> Statement {
        let mut params = Vec::new();
        let mut body = lost(span);
        let mut doc = None;
        for (key, value) in self.entries(table) {
            match key.name.as_str() {
                "params" => params = self.parameters(&key, value),
                "value" => body = self.value(value),
                "doc" => doc = self.doc(&key, value),
                _ => self.unknown(&key, "a function", &["params", "value", "doc"]),
            }
        }
        if !table.contains_key("value") {
            self.missing(span, format!("the function `{}` needs a `value`", name.name));
        }
        Statement { doc, kind: StatementKind::Fn { name, params, body }, span }
    }

    fn tone(&mut self, name: Ident, span: Span, table: &DeTable<'_>) -> Statement {
        let mut params = Vec::new();
        let mut base = None;
        let mut block = Block::default();
        for (key, value) in self.entries(table) {
            match key.name.as_str() {
                "params" => params = self.parameters(&key, value),
                "from" => base = Some(self.value(value)),
                _ => self.block_entry(&mut block, key, value),
            }
        }
        let body = match base {
            Some(base) => ToneBody::Derived { base, with: block.properties },
            None => ToneBody::Properties(block.properties),
        };
        Statement { doc: block.doc, kind: StatementKind::Tone { name, params, body }, span }
    }

    fn experiment(&mut self, name: Ident, span: Span, table: &DeTable<'_>) -> Statement {
        let mut block = Block::default();
        for (key, value) in self.entries(table) {
            self.block_entry(&mut block, key, value);
        }
        let kind = StatementKind::Experiment { name, properties: block.properties };
        Statement { doc: block.doc, kind, span }
    }

    /// A key of a block: its doc comment, one of its properties or a record of them.
    fn block_entry(&mut self, block: &mut Block, key: Key, value: Value<'_>) {
        match key.name.as_str() {
            "doc" => block.doc = self.doc(&key, value),
            "properties" => {
                let record = self.value(value);
                match record.kind {
                    ExprKind::Record(properties) => block.properties.extend(properties),
                    ExprKind::Error => {}
                    _ => self.wrong_type(record.span, &key.name, "a record of properties", value.get_ref()),
                }
            }
            _ => block.properties.push(self.property(&key, value)),
        }
    }

    /// From a key to the end of its value, if the value stands behind it; of a table with a heading, the heading.
    pub(super) fn covering(&self, key: &Key, value: Value<'_>) -> Span {
        if self.is_lost(value) { key.span } else { key.span.to(self.span(value.span())) }
    }
}

/// What a block holds.
#[derive(Default)]
struct Block {
    doc: Option<Doc>,
    properties: Vec<Property>,
}

/// Whether a table is a value with what belongs to it: it has `value` and nothing beyond `allowed`.
pub(super) fn is_documented(table: &DeTable<'_>, allowed: &[&str]) -> bool {
    table.contains_key("value") && table.keys().all(|key| allowed.contains(&key.get_ref().as_ref()))
}

/// What stands for a value that is not there.
pub(super) fn lost(span: Span) -> Expr {
    Expr { kind: ExprKind::Error, span }
}

/// What a value is, in TOML's words.
pub(super) fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a float",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date or time",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}
