//! Writing a document in its canonical form, as `kake fmt` does.
//!
//! In: a [`Document`] without syntax errors and the text it was read from. Out: the same document as text: two spaces
//! a level, one statement a line, one property a line in blocks, lines of at most 100 columns where brackets allow it.
//! Lists and calls that were written over several lines with a trailing comma stay broken; empty lines are kept, at
//! most one at a time. What holds: the text reads as the same document ([`shape`] tells), every comment is in it, and
//! writing it again changes nothing.

mod comments;
mod expr;
mod items;
mod layout;
mod shape;
mod statement;
#[cfg(test)]
mod tests;

pub use shape::{expression_shape, shape};

use self::comments::Comments;
use self::layout::{Layout, WIDTH};
use crate::syntax::ast::{Document, Expr, Parameter, Property};

/// The canonical text of a document. `text` is what it was read from as `.kake`; for a document that was read from
/// TOML it is empty, and lines and empty lines are chosen anew. The document has no syntax errors.
#[must_use]
pub fn format(document: &Document, text: &str) -> String {
    let mut formatter = Formatter { comments: Comments::new(document, text), docs: true };
    let mut out = formatter.document(document).print(WIDTH);
    out.truncate(out.trim_end().len());
    if !out.is_empty() {
        out.push('\n');
    }
    out
}

/// An expression on one line, without doc comments.
#[must_use]
pub fn expression(expr: &Expr) -> String {
    let mut formatter = Formatter { comments: Comments::none(), docs: false };
    formatter.expr(expr).print(usize::MAX)
}

/// An expression with its doc comments, over as many lines as they ask for: one if there are none.
pub(in crate::syntax) fn documented_expression(expr: &Expr) -> String {
    let mut formatter = Formatter { comments: Comments::none(), docs: true };
    formatter.expr(expr).print(usize::MAX)
}

/// Properties as a record, with their doc comments.
pub(in crate::syntax) fn documented_record(properties: &[Property]) -> String {
    let mut formatter = Formatter { comments: Comments::none(), docs: true };
    formatter.record(properties, 0, false).print(usize::MAX)
}

/// A parameter list without its brackets, on one line and without doc comments.
pub(in crate::syntax) fn parameters(list: &[Parameter]) -> String {
    let mut formatter = Formatter { comments: Comments::none(), docs: false };
    let mut parts = Vec::new();
    for (i, parameter) in list.iter().enumerate() {
        parts.push(Layout::text(if i == 0 { "" } else { ", " }));
        parts.push(formatter.parameter(parameter));
    }
    Layout::Concat(parts).print(usize::MAX)
}

/// Lays out parts of a document, taking its comments on the way.
struct Formatter<'a> {
    /// The text and the comments.
    comments: Comments<'a>,
    /// Whether doc comments are written.
    docs: bool,
}
