//! The `.kake` front end: text to [`Document`].
//!
//! In: a text and the name of its source. Out: the syntax tree of what could be read, and a diagnostic for everything
//! that could not. What holds: no text is met by a panic or an exhausted stack, the work is linear in the text's
//! length, and the tree is no deeper than its brackets and [`NESTING`] allow.
//!
//! `scan` finds words and signs, `structure` matches brackets, measures nesting and finds where statements and
//! properties begin, `read` runs the grammar (`grammar/kake.pest`) over one of those at a time, `build` and
//! `expression` make the tree from what it found, and `expected` says in words what it did not find.

mod build;
mod expected;
mod expression;
mod read;
mod scan;
mod structure;

#[cfg(test)]
mod tests;

use crate::diag::{self, Diagnostic};
use crate::span::{SourceId, Sources, Span, Syntax};
use crate::syntax::ast::{Document, Expr, Parameter};
use unicode_normalization::is_nfc;

pub use scan::{Kind as TokenKind, Token};

/// The words that begin a statement. Elsewhere they are words like any other.
pub const KEYWORDS: &[&str] = &[
    "edition",
    "import",
    "canvas",
    "seed",
    "let",
    "param",
    "field",
    "region",
    "tone",
    "fn",
    "paint",
    "outline",
    "ink",
    "layer",
    "for",
    "if",
    "experiment",
];

/// The words that mean something wherever a value may stand, and so can name nothing that is looked up. Arguments and
/// properties may still be called so.
pub const RESERVED: &[&str] = &["and", "or", "not", "if", "then", "else", "match", "true", "false"];

/// How deeply brackets, conditions, blocks and accesses may be nested.
pub const NESTING: usize = 128;

/// After so many errors the rest of a text is not read: whoever has written it mends the first ones first.
const MOST_ERRORS: usize = 100;

/// The generated parser. Its rules are those of `grammar/kake.pest`.
mod grammar {
    #![allow(missing_docs, unreachable_pub)]

    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/kake.pest"]
    pub struct Grammar;
}

/// Where the bytes of a text stand in its source.
struct Places<'a> {
    source: SourceId,
    place: &'a dyn Fn(usize) -> usize,
}

impl Places<'_> {
    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.source, (self.place)(start), (self.place)(end))
    }
}

/// Reads a file. What could not be read is reported and left out; where it is an expression inside something that
/// could be read, it is [`ExprKind::Error`](crate::syntax::ast::ExprKind::Error).
#[must_use]
pub fn parse(source: SourceId, text: &str) -> (Document, Vec<Diagnostic>) {
    let places = Places { source, place: &|offset| offset };
    let mut reader = read::Reader::new(text, &places, read::Whole::File);
    let statements = reader.file();
    let (comments, diagnostics) = reader.finish();
    (Document { source, statements, comments }, diagnostics)
}

/// Reads a text that is one expression. `place` gives for a byte of `text` its byte in the source, and every span goes
/// through it.
#[must_use]
pub fn parse_expression(source: SourceId, text: &str, place: &dyn Fn(usize) -> usize) -> (Expr, Vec<Diagnostic>) {
    let places = Places { source, place };
    let mut reader = read::Reader::new(text, &places, read::Whole::Value);
    let value = reader.value();
    let (_, diagnostics) = reader.finish();
    (value, diagnostics)
}

/// Reads a text that is the inside of a parameter list: `a: length = 1mm, b`. As for `place`, see
/// [`parse_expression`].
#[must_use]
pub fn parse_parameters(
    source: SourceId,
    text: &str,
    place: &dyn Fn(usize) -> usize,
) -> (Vec<Parameter>, Vec<Diagnostic>) {
    let places = Places { source, place };
    let mut reader = read::Reader::new(text, &places, read::Whole::Value);
    let parameters = reader.parameters();
    let (_, diagnostics) = reader.finish();
    (parameters, diagnostics)
}

/// The words and signs of a text as far as it makes sense, and where its comments stand: for what colours or completes
/// a text that is being written.
#[must_use]
pub fn tokens(text: &str) -> (Vec<Token>, Vec<std::ops::Range<usize>>) {
    let source = Sources::new().add("", "", Syntax::Kake);
    let places = Places { source, place: &|offset| offset };
    let scanned = scan::Scanner::scan(text, &places);
    (scanned.tokens, scanned.remarks.ranges())
}

/// Whether something can be declared under this name: an identifier in normal form C that is no reserved word.
#[must_use]
pub fn is_identifier(text: &str) -> bool {
    scan::is_word(text) && is_nfc(text) && !RESERVED.contains(&text)
}

/// The text in these bytes, without a byte order mark before it.
///
/// # Errors
/// The offset of the first byte that does not belong to UTF-8.
pub fn decode_utf8(bytes: &[u8]) -> Result<&str, usize> {
    let text = std::str::from_utf8(bytes).map_err(|error| error.valid_up_to())?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// "did you mean …?" for a word of ordinary length.
fn near_word(word: &str, known: &[&str]) -> Option<String> {
    const LONGEST: usize = 32;
    if word.len() <= LONGEST { diag::did_you_mean(word, known.iter().copied()) } else { None }
}
