//! What could be written at a place.
//!
//! In: a text that is being written, a place, and its scene as it was looked at last. Out: words that fit, those that give
//! what the place takes first.

use std::ops::Range;

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionTextEdit, Documentation, InsertTextFormat, MarkupContent, MarkupKind,
    TextEdit,
};

use crate::lower::reference::{self, Block, Kind, Need, Signature, Slot};
use crate::syntax::ast::Unit;

use super::analysis::Seen;
use super::context::{CallAt, Context, Place, context};
use super::declared::{Declared, What, parameter};
use super::text::Text;

/// Whether the editor fills in forms with places to visit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Snippets {
    /// It does.
    Filled,
    /// It takes plain text only.
    Plain,
}

/// What lies in folders, for paths inside strings.
pub trait Folder {
    /// The entries of a folder, by its path from the folder of the text; folders end with `/`.
    fn list(&self, folder: &str) -> Vec<String>;
}

/// Endings of files that scenes read.
const IMAGES: [&str; 4] = ["png", "jpg", "jpeg", "svg"];
const SCENES: [&str; 2] = ["kake", "toml"];

/// What could be written at a byte of a text.
#[must_use]
pub fn complete(
    text: &Text,
    offset: usize,
    seen: Seen<'_>,
    snippets: Snippets,
    folder: &dyn Folder,
) -> Vec<CompletionItem> {
    let found = context(text.as_str(), offset, &seen);
    let mut list = List { text, word: found.context.word.clone(), snippets, items: Vec::new() };
    let (context, slot) = (&found.context, found.slot);
    let written = text.as_str().get(context.word.start..offset).unwrap_or_default();
    match context.place {
        Place::Nothing => {}
        Place::Statement { is_top, head } => {
            list.clauses(head);
            list.statements(is_top);
        }
        Place::Property(block) => list.properties(block, &context.given),
        Place::Argument | Place::Value { .. } if written.starts_with(|c: char| c.is_ascii_digit()) => {
            list.units(written, slot);
        }
        Place::Argument => {
            if let Some(call) = context.calls.last() {
                list.arguments(call, seen);
            }
            list.values(context, slot, seen);
        }
        Place::Value { .. } => list.values(context, slot, seen),
        Place::Text { owner } => list.strings(owner, slot, offset, folder),
        Place::Member(module) => {
            for declared in seen.analysis.members(seen.source, module) {
                list.declared(&declared, slot, seen);
            }
        }
        Place::Type => {
            for kind in Kind::NAMED {
                list.add(kind.name(), CompletionItemKind::TYPE_PARAMETER, "type", reference::kind(kind), 0);
            }
        }
        Place::Operator { head } => list.clauses(head),
    }
    list.items
}

struct List<'t> {
    text: &'t Text,
    word: Range<usize>,
    snippets: Snippets,
    items: Vec<CompletionItem>,
}

impl List<'_> {
    /// Adds a word that stands for itself. Of two with one rank the alphabet decides.
    fn add(&mut self, label: &str, kind: CompletionItemKind, detail: &str, about: &str, rank: u8) {
        self.insert(label, label, kind, (detail, about), rank, InsertTextFormat::PLAIN_TEXT);
    }

    /// Adds a form with places to fill in; where the editor cannot, the word alone.
    fn form(&mut self, label: &str, form: &str, kind: CompletionItemKind, words: (&str, &str), rank: u8) {
        match self.snippets {
            Snippets::Filled => self.insert(label, form, kind, words, rank, InsertTextFormat::SNIPPET),
            Snippets::Plain => self.add(label, kind, words.0, words.1, rank),
        }
    }

    fn insert(
        &mut self,
        label: &str,
        text: &str,
        kind: CompletionItemKind,
        (detail, about): (&str, &str),
        rank: u8,
        format: InsertTextFormat,
    ) {
        if self.items.iter().any(|item| item.label == label) {
            return;
        }
        let edit = TextEdit { range: self.text.range(self.word.clone()), new_text: text.to_owned() };
        self.items.push(CompletionItem {
            label: label.to_owned(),
            kind: Some(kind),
            detail: (!detail.is_empty()).then(|| detail.to_owned()),
            documentation: (!about.is_empty()).then(|| markdown(about)),
            sort_text: Some(format!("{rank}{label}")),
            filter_text: Some(label.to_owned()),
            insert_text_format: Some(format),
            text_edit: Some(CompletionTextEdit::Edit(edit)),
            ..CompletionItem::default()
        });
    }

    fn statements(&mut self, is_top: bool) {
        const NESTED: [&str; 9] = ["let", "field", "region", "paint", "outline", "ink", "layer", "for", "if"];
        for (keyword, about, form) in reference::STATEMENTS {
            if is_top || NESTED.contains(&keyword) {
                self.form(keyword, form, CompletionItemKind::KEYWORD, ("statement", about), 2);
            }
        }
    }

    /// Words by which a statement goes on.
    fn clauses(&mut self, head: Option<&str>) {
        let words: &[&str] = match head {
            Some("paint") => &["with", "as", "seed"],
            Some("tone") => &["with"],
            Some("import") => &["as"],
            Some("outline") => &["pen"],
            Some("layer") => &["ink"],
            Some("param" | "for") => &["in"],
            _ => &[],
        };
        for word in words {
            let about = reference::word("clause", word).unwrap_or_default();
            self.add(word, CompletionItemKind::KEYWORD, "", about, 0);
        }
        if head == Some("if") {
            self.add("else", CompletionItemKind::KEYWORD, "", "what is carried out otherwise", 0);
        }
    }

    fn properties(&mut self, block: Block, given: &[&str]) {
        for property in reference::properties(block) {
            if given.contains(&property.name) {
                continue;
            }
            let default = match property.default {
                "" => "required".to_owned(),
                default => format!("default: {default}"),
            };
            let detail = format!("{}; {default}", property.slot.expectation());
            let form = format!("{}: $0", property.name);
            let about = property.about;
            self.form(property.name, &form, CompletionItemKind::PROPERTY, (&detail, about), 0);
        }
    }

    fn arguments(&mut self, call: &CallAt<'_>, seen: Seen<'_>) {
        let place = |i: usize| matches!(call.argument, super::frame::Argument::Place(place) if i < place);
        if let Some(declared) = seen.analysis.called(seen.source, &call.called, call.slot) {
            for (i, param) in declared.parameters().unwrap_or_default().iter().enumerate() {
                let name = &param.name.name;
                if !call.labels.contains(&name.as_str()) && !place(i) {
                    let doc = param.doc.as_ref().map_or("", |doc| doc.text.as_str());
                    let form = format!("{name}: $0");
                    self.form(name, &form, CompletionItemKind::FIELD, (&parameter(param), doc), 1);
                }
            }
            return;
        }
        let Some(signature) = super::signature::vocabulary(call) else { return };
        for (i, param) in signature.params().iter().enumerate() {
            if call.labels.contains(&param.name()) || place(i) {
                continue;
            }
            let default = match param.need() {
                Need::Required => "required".to_owned(),
                Need::Optional(default) => format!("default: {default}"),
            };
            let detail = format!("{}; {default}", param.slot().expectation());
            let form = format!("{}: $0", param.name());
            self.form(param.name(), &form, CompletionItemKind::FIELD, (&detail, param.about()), 1);
        }
    }

    fn values(&mut self, context: &Context<'_>, slot: Slot, seen: Seen<'_>) {
        let owner = match context.place {
            Place::Value { owner } | Place::Text { owner } => owner,
            _ => None,
        };
        for word in slot.words {
            let about = owner.and_then(|owner| reference::word(owner, word)).unwrap_or_default();
            self.add(word, CompletionItemKind::ENUM_MEMBER, owner.unwrap_or_default(), about, 0);
        }
        if slot.kind == Some(Kind::Word) {
            return;
        }
        for (name, _) in &context.locals {
            self.add(name, CompletionItemKind::VARIABLE, "local", "", 1);
        }
        for declared in seen.analysis.visible(seen.source) {
            self.declared(&declared, slot, seen);
        }
        for (alias, _) in seen.analysis.imports(seen.source) {
            if let Some(alias) = alias {
                self.add(alias, CompletionItemKind::MODULE, "module", "", 3);
            }
        }
        for (name, about) in reference::constants(slot) {
            self.add(name, CompletionItemKind::CONSTANT, "", about, 2);
        }
        if slot.kind != Some(Kind::Tone) {
            for signature in reference::callables(slot) {
                self.callable(signature, slot);
            }
        }
        if matches!(slot.kind, None | Some(Kind::Bool)) {
            self.add("true", CompletionItemKind::CONSTANT, "bool", "", 4);
            self.add("false", CompletionItemKind::CONSTANT, "bool", "", 4);
        }
        if slot.kind == Some(Kind::Colour) {
            for (name, colour) in reference::colours() {
                self.add(name, CompletionItemKind::COLOR, &colour.hex(), &colour.hex(), 3);
            }
        }
    }

    fn callable(&mut self, signature: &Signature, slot: Slot) {
        let required: Vec<&str> =
            signature.params().iter().filter(|p| p.need() == Need::Required).map(|param| param.name()).collect();
        let places: Vec<String> =
            required.iter().enumerate().map(|(i, name)| format!("{name}: ${{{}}}", i + 1)).collect();
        let form = match signature.params().is_empty() {
            true => format!("{}()", signature.name()),
            false if places.is_empty() => format!("{}($0)", signature.name()),
            false => format!("{}({})", signature.name(), places.join(", ")),
        };
        let detail = super::signature::label(signature);
        let rank = if slot.kind.is_some() && signature.result() == slot.kind { 2 } else { 5 };
        let kind = CompletionItemKind::FUNCTION;
        self.form(signature.name(), &form, kind, (&detail, signature.about()), rank);
    }

    fn declared(&mut self, declared: &Declared<'_>, slot: Slot, seen: Seen<'_>) {
        let kind = seen.analysis.kind(declared);
        let (icon, fits) = match declared.what {
            What::Let(_) | What::Param(..) | What::Field(_) | What::Region(_) | What::Variable(_) => {
                (CompletionItemKind::VARIABLE, slot.kind != Some(Kind::Tone) || kind == Some(Kind::Tone))
            }
            What::Tone(..) => (CompletionItemKind::CLASS, slot.kind == Some(Kind::Tone)),
            What::Fn(..) => (CompletionItemKind::FUNCTION, slot.kind != Some(Kind::Tone)),
            What::Parameter(..) | What::Module(_) | What::Experiment => return,
        };
        if !fits {
            return;
        }
        let worth = seen.analysis.worth(declared.name.span).map_or("", |worth| worth.text.as_str());
        let detail = declared.heading();
        let doc = match (declared.doc, worth) {
            (Some(doc), _) => doc.to_owned(),
            (None, "") => String::new(),
            (None, worth) => format!("`{worth}`"),
        };
        let rank = if slot.kind.is_none() || kind == slot.kind || slot.kind == Some(Kind::Tone) { 1 } else { 3 };
        let name = &declared.name.name;
        match declared.parameters() {
            Some([_, ..]) => self.form(name, &format!("{name}($0)"), icon, (&detail, &doc), rank),
            _ => self.add(name, icon, &detail, &doc, rank),
        }
    }

    /// The units that a number may carry.
    fn units(&mut self, written: &str, slot: Slot) {
        let digits = written.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(written.len());
        let number = written.get(..digits).unwrap_or_default().trim_end_matches('.');
        let all = || Unit::ALL.to_vec();
        let units = match reference::units(slot) {
            units if units.is_empty() => all(),
            units => units,
        };
        for (i, unit) in units.into_iter().enumerate() {
            let label = format!("{number}{}", unit.symbol());
            self.add(&label, CompletionItemKind::UNIT, reference::unit(unit), "", 0);
            if let Some(item) = self.items.last_mut() {
                item.sort_text = Some(format!("{i}"));
            }
        }
    }

    fn strings(&mut self, owner: Option<&str>, slot: Slot, offset: usize, folder: &dyn Folder) {
        let literal = self.text.as_str().get(self.word.clone()).unwrap_or_default();
        let closed = literal.len() > 1 && literal.ends_with('"');
        // The quotes stay.
        self.word = self.word.start + 1..self.word.end - usize::from(closed);
        for word in slot.words {
            let about = owner.and_then(|owner| reference::word(owner, word)).unwrap_or_default();
            self.add(word, CompletionItemKind::ENUM_MEMBER, owner.unwrap_or_default(), about, 0);
        }
        let endings: &[&str] = match owner {
            Some("import") => &SCENES,
            Some("file") => &IMAGES,
            _ => return,
        };
        let written = self.text.as_str().get(self.word.start..offset).unwrap_or_default().to_owned();
        let written = written.as_str();
        if owner == Some("import") && !written.contains('/') {
            for (library, _) in reference::libraries() {
                self.add(&library, CompletionItemKind::MODULE, "comes with the program", "", 0);
            }
        }
        let (inside, _) = written.rsplit_once('/').map_or(("", written), |(folder, name)| (folder, name));
        let prefix = if inside.is_empty() { String::new() } else { format!("{inside}/") };
        for name in folder.list(inside) {
            let path = format!("{prefix}{name}");
            if name.ends_with('/') {
                self.add(&path, CompletionItemKind::FOLDER, "", "", 2);
            } else {
                let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
                if endings.iter().any(|known| known.eq_ignore_ascii_case(ending)) && name != "kake.toml" {
                    self.add(&path, CompletionItemKind::FILE, "", "", 1);
                }
            }
        }
    }
}

fn markdown(text: &str) -> Documentation {
    Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value: text.to_owned() })
}
