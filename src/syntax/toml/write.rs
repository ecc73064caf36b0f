//! From a document to TOML: the file, its tables and its drawing statements.

use std::fmt::Write;

use super::encode::{
    are_distinct, bindable, key, name, paint_name, params, plain, property, property_value, string, value,
};
use super::read::SECTIONS;
use crate::syntax::ast::{Binding, Doc, Document, Expr, Property, Statement, StatementKind, ToneBody};
use crate::syntax::format::documented_record;

/// A document as TOML. What its statements say is kept; comments other than doc comments are not. Declarations are
/// grouped by kind and keep their order within one.
#[must_use]
pub fn write(document: &Document) -> String {
    let mut writer = Writer { out: String::new() };
    writer.file(&document.statements);
    writer.out
}

struct Writer {
    out: String,
}

impl Writer {
    fn file(&mut self, statements: &[Statement]) {
        // Plain keys of the file stand before its first table.
        let is_plain = |name: &&str| ["edition", "seed"].contains(name);
        let (plain, tables): (Vec<&str>, Vec<&str>) = SECTIONS.iter().partition(|name| is_plain(name));
        for name in plain.into_iter().chain(tables) {
            let mut is_first = true;
            for statement in statements.iter().filter(|statement| section(&statement.kind) == name) {
                let is_first = std::mem::take(&mut is_first);
                match &statement.kind {
                    StatementKind::Let(binding) | StatementKind::Field(binding) | StatementKind::Region(binding) => {
                        if is_first {
                            self.heading(&format!("[{name}]"));
                        }
                        let doc = statement.doc.as_ref();
                        self.entry(&key(&binding.name.name), |column| bindable(doc, binding, column));
                    }
                    _ if name == "draw" => self.draw(name, statement),
                    _ => self.declaration("", statement),
                }
            }
        }
    }

    /// A heading, with an empty line above it.
    fn heading(&mut self, heading: &str) {
        if !self.out.is_empty() {
            self.out.push('\n');
        }
        self.line(heading);
    }

    fn line(&mut self, line: &str) {
        self.out.push_str(line);
        self.out.push('\n');
    }

    /// `key = value`; the value is told in which column it begins.
    fn entry(&mut self, key: &str, value: impl FnOnce(usize) -> String) {
        let column = key.chars().count() + " = ".len();
        let value = value(column);
        // Writing to a string cannot fail.
        let _ = writeln!(self.out, "{key} = {value}");
    }

    fn scalar(&mut self, name: &str, statement: &Statement, expr: &Expr) {
        self.entry(name, |column| property_value(statement.doc.as_ref(), expr, column));
    }

    fn expr(&mut self, name: &str, expr: &Expr) {
        self.entry(name, |column| value(expr, column));
    }

    fn doc(&mut self, doc: Option<&Doc>) {
        if let Some(doc) = doc {
            self.entry("doc", |_| plain(&doc.text));
        }
    }

    /// A declaration in the tables whose names begin with `prefix`: nothing, or the path of an entry and a dot.
    fn declaration(&mut self, prefix: &str, statement: &Statement) {
        let doc = statement.doc.as_ref();
        match &statement.kind {
            StatementKind::Edition(expr) => self.scalar("edition", statement, expr),
            StatementKind::Seed(expr) => self.scalar("seed", statement, expr),
            StatementKind::Let(binding) => self.local("let", doc, binding),
            StatementKind::Field(binding) => self.local("field", doc, binding),
            StatementKind::Region(binding) => self.local("region", doc, binding),
            StatementKind::Import { path, alias } => {
                self.heading(&format!("[[{prefix}import]]"));
                self.entry("import", |_| plain(&path.value));
                if let Some(alias) = alias {
                    self.entry("as", |_| name(&alias.name));
                }
                self.doc(doc);
            }
            StatementKind::Canvas(properties) => {
                self.heading(&format!("[{prefix}canvas]"));
                self.doc(doc);
                self.properties(properties, &[]);
            }
            StatementKind::Param { binding, domain } => {
                self.heading(&format!("[{prefix}param.{}]", key(&binding.name.name)));
                if let Some(ty) = &binding.ty {
                    self.entry("type", |_| name(&ty.name));
                }
                self.expr("default", &binding.value);
                if let Some(domain) = domain {
                    self.expr("in", domain);
                }
                self.doc(doc);
            }
            StatementKind::Fn { name, params: list, body } => {
                self.heading(&format!("[{prefix}fn.{}]", key(&name.name)));
                self.doc(doc);
                if !list.is_empty() {
                    self.entry("params", |column| params(list, column));
                }
                self.expr("value", body);
            }
            StatementKind::Tone { name, params: list, body } => {
                self.heading(&format!("[{prefix}tone.{}]", key(&name.name)));
                self.doc(doc);
                if !list.is_empty() {
                    self.entry("params", |column| params(list, column));
                }
                let properties = match body {
                    ToneBody::Properties(properties) => properties,
                    ToneBody::Derived { base, with } => {
                        self.expr("from", base);
                        with
                    }
                };
                self.properties(properties, &["params", "from"]);
            }
            StatementKind::Experiment { name, properties } => {
                self.heading(&format!("[{prefix}experiment.{}]", key(&name.name)));
                self.doc(doc);
                self.properties(properties, &[]);
            }
            StatementKind::Paint { .. }
            | StatementKind::Outline { .. }
            | StatementKind::Ink { .. }
            | StatementKind::Layer { .. }
            | StatementKind::For { .. }
            | StatementKind::If { .. } => {}
        }
    }

    /// `let.name = value`, in an entry of `draw`.
    fn local(&mut self, section: &str, doc: Option<&Doc>, binding: &Binding) {
        let path = format!("{section}.{}", key(&binding.name.name));
        self.entry(&path, |column| bindable(doc, binding, column));
    }

    /// The properties of a block, one a line; as one record where a table cannot have them: where one is called like
    /// a key that means something else there, or two are called the same.
    fn properties(&mut self, properties: &[Property], reserved: &[&str]) {
        let is_reserved = |name: &str| ["doc", "properties"].contains(&name) || reserved.contains(&name);
        let clashes = !are_distinct(properties) || properties.iter().any(|property| is_reserved(&property.name.name));
        if clashes {
            self.entry("properties", |_| string(&documented_record(properties)));
        } else {
            for member in properties {
                self.entry(&key(&member.name.name), |column| property(member, column));
            }
        }
    }

    /// A statement of a drawing array, as an entry at `path`.
    fn draw(&mut self, path: &str, statement: &Statement) {
        self.heading(&format!("[[{path}]]"));
        match &statement.kind {
            StatementKind::Paint { region, tone, name, seed } => {
                self.expr("paint", region);
                self.expr("with", tone);
                if let Some(name) = name {
                    self.entry("as", |column| paint_name(name, column));
                }
                if let Some(seed) = seed {
                    self.expr("seed", seed);
                }
                self.doc(statement.doc.as_ref());
            }
            StatementKind::Outline { region, pen } => {
                self.expr("outline", region);
                if let Some(pen) = pen {
                    self.expr("pen", pen);
                }
                self.doc(statement.doc.as_ref());
            }
            StatementKind::Ink { drawing } => {
                self.expr("ink", drawing);
                self.doc(statement.doc.as_ref());
            }
            StatementKind::Layer { name, ink, body } => {
                self.expr("layer", name);
                if let Some(ink) = ink {
                    self.expr("ink", ink);
                }
                self.doc(statement.doc.as_ref());
                self.blocks(path, &[("draw", body)]);
            }
            StatementKind::For { variable, iterable, body } => {
                self.entry("for", |_| name(&variable.name));
                self.expr("in", iterable);
                self.doc(statement.doc.as_ref());
                self.blocks(path, &[("draw", body)]);
            }
            StatementKind::If { branches, otherwise } => self.condition(path, statement, branches, otherwise.as_ref()),
            StatementKind::Edition(_)
            | StatementKind::Import { .. }
            | StatementKind::Canvas(_)
            | StatementKind::Seed(_)
            | StatementKind::Let(_)
            | StatementKind::Param { .. }
            | StatementKind::Field(_)
            | StatementKind::Region(_)
            | StatementKind::Tone { .. }
            | StatementKind::Fn { .. }
            | StatementKind::Experiment { .. } => self.declaration(&format!("{path}."), statement),
        }
    }

    fn condition(
        &mut self,
        path: &str,
        statement: &Statement,
        branches: &[(Expr, Vec<Statement>)],
        otherwise: Option<&Vec<Statement>>,
    ) {
        let Some(((condition, body), rest)) = branches.split_first() else { return };
        self.expr("if", condition);
        self.doc(statement.doc.as_ref());
        // Keys of an entry stand before the tables below it.
        let mut blocks = vec![("draw", body)];
        blocks.extend(otherwise.filter(|body| body.is_empty()).map(|body| ("else", body)));
        self.blocks(path, &blocks);
        for (condition, body) in rest {
            self.heading(&format!("[[{path}.else-if]]"));
            self.expr("if", condition);
            self.blocks(&format!("{path}.else-if"), &[("draw", body)]);
        }
        if let Some(body) = otherwise {
            body.iter().for_each(|statement| self.draw(&format!("{path}.else"), statement));
        }
    }

    /// Blocks of an entry at `path`. Empty ones are written as such.
    fn blocks(&mut self, path: &str, blocks: &[(&str, &Vec<Statement>)]) {
        for (name, _) in blocks.iter().filter(|(_, body)| body.is_empty()) {
            self.line(&format!("{name} = []"));
        }
        for (name, body) in blocks {
            body.iter().for_each(|statement| self.draw(&format!("{path}.{name}"), statement));
        }
    }
}

/// The key under which a statement stands in the file.
pub(super) fn section(kind: &StatementKind) -> &'static str {
    match kind {
        StatementKind::Edition(_) => "edition",
        StatementKind::Import { .. } => "import",
        StatementKind::Canvas(_) => "canvas",
        StatementKind::Seed(_) => "seed",
        StatementKind::Let(_) => "let",
        StatementKind::Param { .. } => "param",
        StatementKind::Field(_) => "field",
        StatementKind::Region(_) => "region",
        StatementKind::Tone { .. } => "tone",
        StatementKind::Fn { .. } => "fn",
        StatementKind::Paint { .. }
        | StatementKind::Outline { .. }
        | StatementKind::Ink { .. }
        | StatementKind::Layer { .. }
        | StatementKind::For { .. }
        | StatementKind::If { .. } => "draw",
        StatementKind::Experiment { .. } => "experiment",
    }
}
