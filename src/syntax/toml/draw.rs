//! From TOML to drawing statements.

use toml::de::DeTable;

use super::read::{Key, Reader, Value, lost};
use crate::span::Span;
use crate::syntax::ast::{Doc, Expr, Ident, Statement, StatementKind};

/// The keys that say which statement an entry is.
const STATEMENTS: [&str; 6] = ["paint", "outline", "layer", "ink", "for", "if"];

/// What a drawing statement may have, whichever it is.
#[derive(Default)]
struct Parts {
    doc: Option<Doc>,
    head: Option<Expr>,
    variable: Option<Ident>,
    with: Option<Expr>,
    name: Option<Expr>,
    seed: Option<Expr>,
    pen: Option<Expr>,
    ink: Option<Expr>,
    iterable: Option<Expr>,
    body: Vec<Statement>,
    branches: Vec<(Expr, Vec<Statement>)>,
    otherwise: Option<Vec<Statement>>,
}

impl Reader<'_> {
    /// An entry of `[[draw]]`: a drawing statement, or declarations.
    pub(super) fn draw(&mut self, span: Span, table: &DeTable<'_>, out: &mut Vec<Statement>) {
        let Some(kind) = STATEMENTS.into_iter().find(|kind| table.contains_key(*kind)) else {
            return self.declarations(span, table, out);
        };
        let (known, required): (&[&str], &[&str]) = match kind {
            "paint" => (&["paint", "with", "as", "seed", "doc"], &["with"]),
            "outline" => (&["outline", "pen", "doc"], &[]),
            "ink" => (&["ink", "doc"], &[]),
            "layer" => (&["layer", "ink", "draw", "doc"], &["draw"]),
            "for" => (&["for", "in", "draw", "doc"], &["in", "draw"]),
            _ => (&["if", "draw", "else-if", "else", "doc"], &["draw"]),
        };
        let mut parts = Parts::default();
        let mut place = span;
        let what = format!("a statement with `{kind}`");
        for (key, value) in self.entries(table) {
            if !known.contains(&key.name.as_str()) {
                self.unknown(&key, &what, known);
                continue;
            }
            if key.name == kind {
                place = self.covering(&key, value);
            }
            self.part(&mut parts, kind, &key, value);
        }
        for key in required {
            if !table.contains_key(*key) {
                self.missing(place, format!("{what} needs `{key}`"));
            }
        }
        if let Some(statement) = finish(kind, parts, place) {
            out.push(statement);
        }
    }

    fn part(&mut self, parts: &mut Parts, kind: &str, key: &Key, value: Value<'_>) {
        match key.name.as_str() {
            "doc" => parts.doc = self.doc(key, value),
            "for" => parts.variable = self.ident_value(key, value),
            "with" => parts.with = Some(self.value(value)),
            "as" => parts.name = self.paint_name(key, value),
            "seed" => parts.seed = Some(self.value(value)),
            "pen" => parts.pen = Some(self.value(value)),
            "ink" if kind == "layer" => parts.ink = Some(self.value(value)),
            "in" => parts.iterable = Some(self.value(value)),
            "draw" => parts.body = self.body(key, value),
            "else" => parts.otherwise = Some(self.body(key, value)),
            "else-if" => parts.branches = self.branches(key, value),
            name if name == kind => parts.head = Some(self.value(value)),
            _ => {}
        }
    }

    /// The statements of a block.
    fn body(&mut self, key: &Key, value: Value<'_>) -> Vec<Statement> {
        self.deeper(key.span, |reader| {
            let mut statements = Vec::new();
            for (span, table) in reader.tables(key, value, &format!("{} = [{{ paint = … }}]", key.name)) {
                reader.draw(span, table, &mut statements);
            }
            statements
        })
        .unwrap_or_default()
    }

    /// `else-if`: conditions with what they guard.
    fn branches(&mut self, key: &Key, value: Value<'_>) -> Vec<(Expr, Vec<Statement>)> {
        let mut branches = Vec::new();
        for (span, table) in self.tables(key, value, "else-if = [{ if = …, draw = […] }]") {
            let mut condition = None;
            let mut body = Vec::new();
            for (key, value) in self.entries(table) {
                match key.name.as_str() {
                    "if" => condition = Some(self.value(value)),
                    "draw" => body = self.body(&key, value),
                    _ => self.unknown(&key, "a branch", &["if", "draw"]),
                }
            }
            for key in ["if", "draw"] {
                if !table.contains_key(key) {
                    self.missing(span, format!("a branch needs `{key}`"));
                }
            }
            branches.push((condition.unwrap_or_else(|| lost(span)), body));
        }
        branches
    }

    /// An entry without a drawing statement.
    fn declarations(&mut self, span: Span, table: &DeTable<'_>, out: &mut Vec<Statement>) {
        for (key, value) in self.entries(table) {
            if Self::declares(&key.name) {
                self.declare(&key, value, out);
            } else {
                self.unknown(&key, "an entry of `draw`", &STATEMENTS);
            }
        }
        if table.is_empty() {
            self.missing(span, "an entry of `draw` needs `paint`, `outline`, `ink`, `layer`, `for` or `if`".into());
        }
    }
}

/// The statement that its parts make; none if the name of its variable is missing.
fn finish(kind: &str, parts: Parts, span: Span) -> Option<Statement> {
    let or_lost = |part: Option<Expr>| part.unwrap_or_else(|| lost(span));
    let head = or_lost(parts.head);
    let kind = match kind {
        "paint" => StatementKind::Paint { region: head, tone: or_lost(parts.with), name: parts.name, seed: parts.seed },
        "outline" => StatementKind::Outline { region: head, pen: parts.pen },
        "ink" => StatementKind::Ink { drawing: head },
        "layer" => StatementKind::Layer { name: head, ink: parts.ink, body: parts.body },
        "for" => StatementKind::For { variable: parts.variable?, iterable: or_lost(parts.iterable), body: parts.body },
        _ => {
            let mut branches = vec![(head, parts.body)];
            branches.extend(parts.branches);
            StatementKind::If { branches, otherwise: parts.otherwise }
        }
    };
    Some(Statement { doc: parts.doc, kind, span })
}
