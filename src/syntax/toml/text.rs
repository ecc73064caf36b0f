//! From TOML keys and strings to names, types, docs and plain text.

use unicode_normalization::UnicodeNormalization;

use super::read::{Key, Reader, Value};
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{Doc, Expr, ExprKind, Ident, StringPart, Text};
use crate::syntax::kake::{RESERVED, is_identifier, parse_expression};

impl Reader<'_> {
    /// A key as the name of what it declares.
    pub(super) fn ident(&mut self, key: &Key) -> Option<Ident> {
        self.name(&key.name, key.span)
    }

    /// A key as the name of a property, where the reserved words of the language may stand too.
    pub(super) fn label(&mut self, key: &Key) -> Ident {
        if !is_word(&key.name) {
            self.no_name(&key.name, key.span);
        }
        Ident { name: key.name.nfc().collect(), span: key.span }
    }

    /// A string that is a name, as behind `as` and `for`.
    pub(super) fn ident_value(&mut self, key: &Key, value: Value<'_>) -> Option<Ident> {
        let (text, span) = self.inner(key, value)?;
        self.name(&text, span)
    }

    /// A string that is the name of a type.
    pub(super) fn type_value(&mut self, key: &Key, value: Value<'_>) -> Option<Ident> {
        let (text, span) = self.inner(key, value)?;
        if is_word(&text) {
            return Some(Ident { name: text.nfc().collect(), span });
        }
        self.no_name(&text, span);
        None
    }

    /// A string that is plain text.
    pub(super) fn plain(&mut self, key: &Key, value: Value<'_>) -> Option<Text> {
        let text = self.string(key, value)?;
        Some(Text { value: text, span: self.span(value.span()) })
    }

    /// A string that documents something.
    pub(super) fn doc(&mut self, key: &Key, value: Value<'_>) -> Option<Doc> {
        let text = self.string(key, value)?;
        let text = text.replace("\r\n", "\n");
        Some(Doc { text, span: self.span(value.span()) })
    }

    /// The name of a paint: plain text with `{expr}`, or `{ value = "expression" }`.
    pub(super) fn paint_name(&mut self, key: &Key, value: Value<'_>) -> Option<Expr> {
        if let Some(table) = value.get_ref().as_table() {
            let mut name = None;
            for (key, value) in self.entries(table) {
                match key.name.as_str() {
                    "value" => name = Some(self.value(value)),
                    _ => self.unknown(&key, "a computed name", &["value"]),
                }
            }
            if name.is_none() {
                self.missing(self.span(value.span()), "a computed name needs a `value`".into());
            }
            return name;
        }
        let text = self.string(key, value)?;
        let (_, places) = self.places(value);
        let mut parts = Vec::new();
        for piece in pieces(&text) {
            match piece {
                Piece::Text(text) => parts.push(StringPart::Text(text)),
                Piece::Expr { start, end } => {
                    let place = |offset: usize| places.place(start + offset);
                    let (expr, diagnostics) = parse_expression(self.source, text.get(start..end).unwrap_or(""), &place);
                    self.diagnostics.extend(diagnostics);
                    parts.push(StringPart::Expr(expr));
                }
                Piece::Open { start } => {
                    let span = self.span(places.place(start)..places.place(text.len()));
                    let diagnostic = Diagnostic::error(Code::Syntax, span, "`{` is not closed");
                    self.report(diagnostic.hint("write `\\{` for a brace that is text"));
                }
            }
        }
        Some(Expr { kind: ExprKind::String(parts), span: self.span(value.span()) })
    }

    /// The text of a string, and its place without the quotes.
    fn inner(&mut self, key: &Key, value: Value<'_>) -> Option<(String, Span)> {
        let text = self.string(key, value)?;
        let (_, places) = self.places(value);
        let span = self.span(places.place(0)..places.place(text.len()));
        Some((text, span))
    }

    /// The value of a string. The line end before the closing quotes of a multi-line one does not count.
    fn string(&mut self, key: &Key, value: Value<'_>) -> Option<String> {
        if self.is_lost(value) {
            return None;
        }
        let Some(text) = value.get_ref().as_str() else {
            self.wrong_type(self.span(value.span()), &key.name, "a string of plain text", value.get_ref());
            return None;
        };
        let (raw, _) = self.places(value);
        let is_multiline = raw.starts_with("'''") || raw.starts_with("\"\"\"");
        let text = text.strip_suffix('\n').filter(|_| is_multiline).unwrap_or(text);
        Some(text.strip_suffix('\r').filter(|_| is_multiline).unwrap_or(text).to_owned())
    }

    fn name(&mut self, text: &str, span: Span) -> Option<Ident> {
        let name: String = text.nfc().collect();
        if is_identifier(&name) {
            return Some(Ident { name, span });
        }
        self.no_name(text, span);
        None
    }

    fn no_name(&mut self, text: &str, span: Span) {
        let diagnostic = Diagnostic::error(Code::Syntax, span, format!("`{}` cannot be a name", text.escape_debug()));
        self.report(diagnostic.hint("names begin with a letter and go on with letters, digits and `_`"));
    }
}

/// Whether a text is a word of the language, reserved or not.
fn is_word(text: &str) -> bool {
    RESERVED.contains(&text) || is_identifier(&text.nfc().collect::<String>())
}

/// A piece of a text with interpolation.
#[derive(Debug, PartialEq)]
enum Piece {
    /// Plain text, its escapes resolved.
    Text(String),
    /// An expression between braces, as a range of the text.
    Expr {
        /// Behind the `{`.
        start: usize,
        /// Before the `}`.
        end: usize,
    },
    /// A brace that is not closed.
    Open {
        /// Where it stands.
        start: usize,
    },
}

/// Takes a text apart at its interpolations. `\{`, `\}` and `\\` are a brace or a backslash; any other backslash is
/// itself.
fn pieces(text: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut plain = String::new();
    let mut letters = text.char_indices().peekable();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '\\' => plain.push(letters.next_if(|(_, next)| matches!(next, '{' | '}' | '\\')).map_or('\\', |(_, c)| c)),
            '{' => {
                if !plain.is_empty() {
                    pieces.push(Piece::Text(std::mem::take(&mut plain)));
                }
                let start = at + 1;
                let Some(length) = closing_brace(&text[start..]) else {
                    pieces.push(Piece::Open { start: at });
                    return pieces;
                };
                pieces.push(Piece::Expr { start, end: start + length });
                while letters.next_if(|&(at, _)| at <= start + length).is_some() {}
            }
            other => plain.push(other),
        }
    }
    if !plain.is_empty() {
        pieces.push(Piece::Text(plain));
    }
    pieces
}

/// Where the brace that was opened before `text` is closed. Braces in strings and comments do not count.
fn closing_brace(text: &str) -> Option<usize> {
    // What is open: braces of code, and strings, whose interpolations are code again.
    let mut open = vec!['{'];
    let mut letters = text.char_indices().peekable();
    while let Some((at, letter)) = letters.next() {
        let is_text = open.last() == Some(&'"');
        match letter {
            '\\' if is_text => {
                letters.next();
            }
            '"' if is_text => {
                open.pop();
            }
            '"' | '{' => open.push(letter),
            '}' if !is_text => {
                open.pop();
                if open.is_empty() {
                    return Some(at);
                }
            }
            '/' if !is_text => {
                let rest = &text[at..];
                let length = if rest.starts_with("//") {
                    rest.find('\n').unwrap_or(rest.len())
                } else if rest.starts_with("/*") {
                    rest.find("*/").map_or(rest.len(), |end| end + 2)
                } else {
                    1
                };
                while letters.next_if(|&(next, _)| next < at + length).is_some() {}
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_paints_are_taken_apart() {
        let text = |text: &str| Piece::Text(text.into());
        assert_eq!(pieces(r"a \{b\} \\ \c"), [text(r"a {b} \ \c")]);
        assert_eq!(
            pieces("a {b}-{c}"),
            [text("a "), Piece::Expr { start: 3, end: 4 }, text("-"), Piece::Expr { start: 7, end: 8 }]
        );
        assert_eq!(pieces(r#"{f("}\"{x}", /* } */ { a: 1 })}"#), [Piece::Expr { start: 1, end: 30 }]);
        assert_eq!(pieces("a {b"), [text("a "), Piece::Open { start: 2 }]);
        assert_eq!(pieces(""), []);
    }
}
