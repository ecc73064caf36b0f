//! Small changes to a scene's text: a parameter's default, or the seed. All else, comments and layout included, stays as
//! it was written.
//!
//! In: a text of either front end and what is to be changed. Out: the text with the change. What holds: it reads as the
//! same document but for the change, or there is none.

use std::fmt;
use std::ops::Range;

use ::toml::Spanned;
use ::toml::de::{DeTable, DeValue};
use unicode_normalization::UnicodeNormalization;

use super::ast::{Document, Expr, ExprKind, Statement, StatementKind};
use super::format::{documented_expression, shape};
use super::{kake, toml};
use crate::diag::Diagnostic;
use crate::span::{Source, SourceId, Sources, Span, Syntax};

/// The greatest seed that a scene can hold: above it neighbouring whole numbers are no longer told apart.
const GREATEST_SEED: u64 = 1 << 53;

/// What is to be changed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Changes<'a> {
    /// Parameters with their new defaults, expressions of the language.
    pub params: &'a [(String, String)],
    /// The new seed.
    pub seed: Option<u64>,
}

/// Why a text cannot be changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum EditError {
    /// It has mistakes.
    Faulty,
    /// It declares no parameter of this name.
    NoParam(String),
    /// What this parameter should be is no expression.
    NoValue(String),
    /// Seeds are not that great.
    Seed,
    /// The change would change something else.
    Lost,
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Faulty => f.write_str("the scene has mistakes; mend them before anything is written into it"),
            Self::NoParam(name) => write!(f, "the scene's own text declares no parameter `{name}`"),
            Self::NoValue(name) => write!(f, "the value of `{name}` cannot be written down"),
            Self::Seed => f.write_str("a seed in a scene is a whole number from 0 to 2^53"),
            Self::Lost => f.write_str("the values cannot be written without changing something else"),
        }
    }
}

impl std::error::Error for EditError {}

/// The names of the parameters that a text declares itself.
#[must_use]
pub fn params(id: SourceId, source: &Source) -> Vec<String> {
    let (document, _) = read(id, &source.text, source.syntax);
    let names = document.statements.into_iter().filter_map(|statement| match statement.kind {
        StatementKind::Param { binding, .. } => Some(binding.name.name),
        _ => None,
    });
    names.collect()
}

fn read(id: SourceId, text: &str, syntax: Syntax) -> (Document, Vec<Diagnostic>) {
    match syntax {
        Syntax::Kake => kake::parse(id, text),
        Syntax::Toml => toml::read(id, text),
    }
}

/// Changes a text.
///
/// # Errors
/// Where the text is at fault, a parameter is not declared in it, or a value is none.
pub fn edit(text: &str, syntax: Syntax, changes: &Changes<'_>) -> Result<String, EditError> {
    let id = Sources::new().add("scene", text, syntax);
    let (mut document, diagnostics) = read(id, text, syntax);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(EditError::Faulty);
    }
    let mut edits = Vec::new();
    for (name, value) in changes.params {
        let (value, faults) = kake::parse_expression(id, value, &|offset| offset);
        if !faults.is_empty() {
            return Err(EditError::NoValue(name.clone()));
        }
        let default = default_mut(&mut document, name).ok_or_else(|| EditError::NoParam(name.clone()))?;
        let (place, written) = match syntax {
            Syntax::Kake => (range(default.span), documented_expression(&value)),
            Syntax::Toml => {
                let place = toml_place(text, &["param", name, "default"]).ok_or(EditError::Lost)?;
                (place, toml::value(&value))
            }
        };
        *default = value;
        edits.push((place, written));
    }
    if let Some(seed) = changes.seed {
        if seed > GREATEST_SEED {
            return Err(EditError::Seed);
        }
        edits.push(match syntax {
            Syntax::Kake => kake_seed(text, &document, seed),
            Syntax::Toml => toml_seed(text, seed),
        });
        set_seed(&mut document, seed);
    }
    let edited = replaced(text, edits).ok_or(EditError::Lost)?;
    let (found, diagnostics) = read(id, &edited, syntax);
    let is_right = !diagnostics.iter().any(Diagnostic::is_error) && shape(&found) == shape(&document);
    if is_right { Ok(edited) } else { Err(EditError::Lost) }
}

/// A text with other stretches in some places; none where these overlap.
fn replaced(text: &str, mut edits: Vec<(Range<usize>, String)>) -> Option<String> {
    edits.sort_by_key(|(place, _)| (place.start, place.end));
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for (place, written) in edits {
        out += text.get(at..place.start)?;
        out += &written;
        at = place.end;
    }
    out += text.get(at..)?;
    Some(out)
}

fn range(span: Span) -> Range<usize> {
    span.start as usize..span.end as usize
}

/// The default of a parameter.
fn default_mut<'d>(document: &'d mut Document, wanted: &str) -> Option<&'d mut Expr> {
    document.statements.iter_mut().find_map(|statement| match &mut statement.kind {
        StatementKind::Param { binding, .. } if binding.name.name == wanted => Some(&mut binding.value),
        _ => None,
    })
}

/// Sets a document's seed, or gives it one where both front ends read it.
fn set_seed(document: &mut Document, seed: u64) {
    let span = Span::new(document.source, 0, 0);
    let number = ExprKind::Number { value: seed as f64, text: seed.to_string(), unit: None };
    let value = Expr { kind: number, span };
    let known = document.statements.iter_mut().find_map(|statement| match &mut statement.kind {
        StatementKind::Seed(known) => Some(known),
        _ => None,
    });
    match known {
        Some(known) => *known = value,
        None => {
            let at = behind(document).map_or(0, |i| i + 1);
            document.statements.insert(at, Statement { doc: None, kind: StatementKind::Seed(value), span });
        }
    }
}

/// The statement that a seed follows: the canvas, or else the last of those that come before it.
fn behind(document: &Document) -> Option<usize> {
    let is_canvas = |statement: &Statement| matches!(statement.kind, StatementKind::Canvas(_));
    let is_before =
        |statement: &Statement| matches!(statement.kind, StatementKind::Edition(_) | StatementKind::Import { .. });
    let statements = &document.statements;
    statements.iter().position(is_canvas).or_else(|| statements.iter().rposition(is_before))
}

/// The line end that a text uses.
fn line_end(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
}

/// Where the line that holds a place ends, its line end not counted.
fn end_of_line(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    let line = rest.split('\n').next().unwrap_or_default();
    at + line.strip_suffix('\r').unwrap_or(line).len()
}

/// The change that sets the seed of a `.kake` text.
fn kake_seed(text: &str, document: &Document, seed: u64) -> (Range<usize>, String) {
    let known = document.statements.iter().find_map(|statement| match &statement.kind {
        StatementKind::Seed(value) => Some(value.span),
        _ => None,
    });
    if let Some(span) = known {
        return (range(span), seed.to_string());
    }
    let line_end = line_end(text);
    let Some(statement) = behind(document).and_then(|i| document.statements.get(i)) else {
        return (0..0, format!("seed {seed}{line_end}"));
    };
    let end = statement.span.end as usize;
    let stop = end_of_line(text, end);
    let rest = text.get(end..stop).unwrap_or_default().trim_start();
    if rest.is_empty() || rest.starts_with("//") && !rest.starts_with("///") {
        (stop..stop, format!("{line_end}seed {seed}"))
    } else {
        (end..end, format!(" seed {seed}"))
    }
}

/// The change that sets the seed of a TOML text.
fn toml_seed(text: &str, seed: u64) -> (Range<usize>, String) {
    let documented = toml_place(text, &["seed", "value"]);
    if let Some(place) = documented.or_else(|| toml_place(text, &["seed"])) {
        return (place, seed.to_string());
    }
    let line_end = line_end(text);
    // A value of the file itself stands before its first table.
    match toml_place(text, &["edition"])
        .filter(|place| text.get(place.clone()).is_some_and(|edition| !edition.is_empty()))
    {
        Some(edition) if !is_inside(text, &edition) => {
            let stop = end_of_line(text, edition.end);
            (stop..stop, format!("{line_end}seed = {seed}"))
        }
        _ => (0..0, format!("seed = {seed}{line_end}")),
    }
}

/// Whether a value stands in a table with a heading, where further keys would be the table's.
fn is_inside(text: &str, place: &Range<usize>) -> bool {
    text.get(..place.start).unwrap_or_default().lines().any(|line| line.trim_start().starts_with('['))
}

/// Where the value of a key stands in a TOML text.
fn toml_place(text: &str, path: &[&str]) -> Option<Range<usize>> {
    let table = DeTable::parse(text).ok()?;
    let (last, tables) = path.split_last()?;
    let mut inner = table.get_ref();
    for name in tables {
        inner = entry(inner, name)?.get_ref().as_table()?;
    }
    Some(entry(inner, last)?.span())
}

/// The value of a key, whatever form of Unicode the key is written in.
fn entry<'t>(table: &'t DeTable<'t>, name: &str) -> Option<&'t Spanned<DeValue<'t>>> {
    let found = table.iter().find(|(key, _)| key.get_ref().nfc().eq(name.chars()));
    found.map(|(_, value)| value)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::super::arbitrary::{self, Sample};
    use super::super::format::{expression, expression_shape, format};
    use super::*;

    fn changed(text: &str, syntax: Syntax, params: &[(&str, &str)], seed: Option<u64>) -> Result<String, EditError> {
        let params: Vec<(String, String)> =
            params.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        edit(text, syntax, &Changes { params: &params, seed })
    }

    #[test]
    fn a_kake_text_keeps_its_layout_and_comments() {
        let text = "// Head\nedition 1\ncanvas { size: a5 } // the page\n\n/// The tile\nparam   tile = 6mm   \
                    in 2mm .. 8mm // doc\nparam kind = \"hex\" /* why */ in [\"hex\", \"grid\"]\n";
        let wanted = "// Head\nedition 1\ncanvas { size: a5 } // the page\nseed 7\n\n/// The tile\nparam   tile = 4.5mm   \
                      in 2mm .. 8mm // doc\nparam kind = \"grid\" /* why */ in [\"hex\", \"grid\"]\n";
        let found = changed(text, Syntax::Kake, &[("kind", "\"grid\""), ("tile", "4.5mm // x")], Some(7)).unwrap();
        assert_eq!(found, wanted);
        assert_eq!(changed(&found, Syntax::Kake, &[], Some(8)).unwrap(), wanted.replace("seed 7", "seed 8"));
    }

    #[test]
    fn a_seed_finds_its_place() {
        for (text, wanted) in [
            ("canvas { size: a5 }", "canvas { size: a5 }\nseed 3"),
            ("canvas { size: a5 } let a = 1", "canvas { size: a5 } seed 3 let a = 1"),
            ("canvas { size: a5 } /* a\nb */ let a = 1", "canvas { size: a5 } seed 3 /* a\nb */ let a = 1"),
            (
                "edition 1\r\nimport \"a.kake\"\r\nlet a = 1\r\n",
                "edition 1\r\nimport \"a.kake\"\r\nseed 3\r\nlet a = 1\r\n",
            ),
            ("/// A\nlet a = 1\n", "seed 3\n/// A\nlet a = 1\n"),
            ("canvas { size: a5 }\nseed 1 + 1 // two\n", "canvas { size: a5 }\nseed 3 // two\n"),
            ("", "seed 3\n"),
        ] {
            assert_eq!(changed(text, Syntax::Kake, &[], Some(3)).unwrap(), wanted);
        }
        for (text, wanted) in [
            ("edition = 1 # one\n[canvas]\nsize = \"a5\"\n", "edition = 1 # one\nseed = 3\n[canvas]\nsize = \"a5\"\n"),
            ("# Head\n[canvas]\nsize = \"a5\"\n", "seed = 3\n# Head\n[canvas]\nsize = \"a5\"\n"),
            ("seed = 0x10 # old\n", "seed = 3 # old\n"),
            ("seed = { doc = \"Why\", value = \"2 + 2\" }\n", "seed = { doc = \"Why\", value = 3 }\n"),
        ] {
            assert_eq!(changed(text, Syntax::Toml, &[], Some(3)).unwrap(), wanted);
        }
    }

    #[test]
    fn a_toml_text_keeps_its_layout_and_comments() {
        let text = "# Head\n[param.tile] # the tile\n default = '6mm' # mm\nin = \"2mm .. 8mm\"\n\n[param.kind]\n\
                    default = '\"hex\"'\n[param]\nn.default = 4 # four\nn.doc = \"N\"\n";
        let params = [("tile", "4.5mm"), ("kind", "\"it's\""), ("n", "5")];
        let wanted = "# Head\n[param.tile] # the tile\n default = \"4.5mm\" # mm\nin = \"2mm .. 8mm\"\n\n[param.kind]\n\
                      default = \"\\\"it's\\\"\"\n[param]\nn.default = 5 # four\nn.doc = \"N\"\n";
        assert_eq!(changed(text, Syntax::Toml, &params, None).unwrap(), wanted);
        let inline = "param = { a = { default = 1 }, \"b\" = { default = true } }";
        let found = changed(inline, Syntax::Toml, &[("a", "2"), ("b", "false")], None).unwrap();
        assert_eq!(found, "param = { a = { default = 2 }, \"b\" = { default = false } }");
    }

    #[test]
    fn what_cannot_be_changed_is_refused() {
        let text = "param a = 1\n";
        let refused = |params: &[(&str, &str)], seed| changed(text, Syntax::Kake, params, seed).unwrap_err();
        assert_eq!(refused(&[("b", "1")], None), EditError::NoParam("b".into()));
        assert_eq!(refused(&[("a", "1 } param c = 2")], None), EditError::NoValue("a".into()));
        assert_eq!(refused(&[("a", "")], None), EditError::NoValue("a".into()));
        assert_eq!(refused(&[], Some(u64::MAX)), EditError::Seed);
        assert_eq!(refused(&[("a", "1"), ("a", "2")], None), EditError::Lost);
        assert_eq!(changed("param a = ", Syntax::Kake, &[("a", "1")], None).unwrap_err(), EditError::Faulty);
        assert_eq!(changed("[param.a]\ndefault = ", Syntax::Toml, &[], None).unwrap_err(), EditError::Faulty);
    }

    /// The names of a document's parameters, the values of those, and all of its comments.
    fn parts(document: &Document) -> (Vec<String>, Vec<String>) {
        let names = document.statements.iter().filter_map(|statement| match &statement.kind {
            StatementKind::Param { binding, .. } => Some(binding.name.name.clone()),
            _ => None,
        });
        (names.collect(), document.comments.iter().map(|comment| comment.text.clone()).collect())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn only_what_is_changed_changes(
            Sample(document) in arbitrary::document(),
            value in arbitrary::expr(),
            seed in proptest::option::of(0..1u64 << 53),
            comment in proptest::sample::select(vec!["", "// here\n", "/* here */ ", "/* a\nb */\n"]),
        ) {
            let value = expression(&value);
            for (syntax, text) in
                [(Syntax::Kake, format!("{comment}{}", format(&document, ""))), (Syntax::Toml, toml::write(&document))]
            {
                let (before, _) = read(arbitrary::source(), &text, syntax);
                let (names, comments) = parts(&before);
                let params: Vec<(String, String)> = names.first().map(|name| (name.clone(), value.clone())).into_iter().collect();
                let edited = edit(&text, syntax, &Changes { params: &params, seed });
                let edited = edited.map_err(|error| TestCaseError::fail(format!("{error:?} in:\n{text}")))?;
                let (after, diagnostics) = read(arbitrary::source(), &edited, syntax);
                prop_assert!(diagnostics.is_empty());
                prop_assert_eq!(parts(&after), (names, comments));
                for (name, _) in &params {
                    let mut after = after.clone();
                    let found = expression_shape(default_mut(&mut after, name).unwrap());
                    let wanted = kake::parse_expression(arbitrary::source(), &value, &|at| at).0;
                    prop_assert_eq!(found, expression_shape(&wanted));
                }
                // What is changed back says what it said.
                if let (Some((name, _)), Syntax::Kake, None) = (params.first(), syntax, seed) {
                    let old = text[range(default_mut(&mut before.clone(), name).unwrap().span)].to_owned();
                    let back = edit(&edited, syntax, &Changes { params: &[(name.clone(), old)], seed: None });
                    let (back, _) = read(arbitrary::source(), &back.unwrap(), syntax);
                    prop_assert_eq!(shape(&back), shape(&before));
                }
            }
        }
    }
}
