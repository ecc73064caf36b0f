//! How a TOML text is nested, before anything walks it.
//!
//! The tree that the `toml` crate builds is built, walked and freed by recursion. The crate's own bound of 80 levels is
//! less than the language allows, so it is switched off and this one takes its place: the same parser runs once with
//! its events thrown away and says where a text is nested too deeply. It says too where a bracket is not closed, for
//! such a bracket swallows the rest of the file, and [`without_unclosed`] takes it out.

use std::ops::Range;

use toml_parser::decoder::Encoding;
use toml_parser::parser::{EventReceiver, RecursionGuard, parse_document};
use toml_parser::{ErrorSink, ParseError, Source, Span};

/// The greatest depth of arrays and tables within one value, of blocks, and of brackets in an expression.
pub(super) use crate::syntax::kake::NESTING;

/// The greatest number of names in a dotted key: two for every block around a drawing statement.
const KEY_PARTS: usize = 2 * NESTING + 8;

/// What is wrong with the nesting of a text.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Nesting {
    /// Where it is too deep.
    pub(super) too_deep: Option<Range<usize>>,
    /// The first bracket of a value that is not closed.
    pub(super) unclosed: Option<usize>,
}

/// Looks at the brackets and dotted keys of a text.
pub(super) fn measure(text: &str) -> Nesting {
    let tokens = Source::new(text).lex().into_vec();
    let mut keys = Keys { parts: 0, too_long: None };
    let mut too_deep: Option<Span> = None;
    let mut unclosed: Option<usize> = None;
    // The parser tells these errors from others by their words alone.
    let mut errors = |error: ParseError| match error.description() {
        "cannot recurse further; max recursion depth met" => too_deep = too_deep.or(error.unexpected()),
        "unclosed array" | "unclosed inline table" => {
            let open = error.context().map(|span| span.start());
            unclosed = unclosed.into_iter().chain(open).min();
        }
        _ => {}
    };
    let limit = u32::try_from(NESTING).unwrap_or(u32::MAX);
    parse_document(&tokens, &mut RecursionGuard::new(&mut keys, limit), &mut errors);
    Nesting { too_deep: too_deep.or(keys.too_long).map(|span| span.start()..span.end()), unclosed }
}

/// The text with `0` in place of the value that begins at `open` and is not closed; every other byte keeps its place.
/// The value is taken to end where a line begins a table, or, without indentation, an entry.
pub(super) fn without_unclosed(text: &str, open: usize) -> String {
    let (before, rest) = text.split_at(open);
    let mut length = 0;
    for (i, line) in rest.split_inclusive('\n').enumerate() {
        if i > 0 && begins_entry(line) {
            break;
        }
        length += line.len();
    }
    let (value, after) = rest.split_at(length);
    let blank = |byte: u8| if byte == b'\n' { '\n' } else { ' ' };
    let value: String = std::iter::once('0').chain(value.bytes().skip(1).map(blank)).collect();
    format!("{before}{value}{after}")
}

fn begins_entry(line: &str) -> bool {
    let heading = line.split('#').next().unwrap_or("").trim();
    let is_key = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-' | '.' | '"' | '\'' | ' ');
    let is_heading = heading.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).is_some_and(|rest| {
        let name = rest.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(rest);
        !name.is_empty() && name.chars().all(is_key)
    });
    let (key, value) = line.split_at(line.find('=').unwrap_or(0));
    is_heading || (!value.is_empty() && !key.is_empty() && !key.starts_with(' ') && key.chars().all(is_key))
}

/// Counts the parts of dotted keys.
struct Keys {
    parts: usize,
    too_long: Option<Span>,
}

impl EventReceiver for Keys {
    fn key_sep(&mut self, span: Span, _: &mut dyn ErrorSink) {
        self.parts += 1;
        if self.parts >= KEY_PARTS {
            self.too_long = self.too_long.or(Some(span));
        }
    }

    fn key_val_sep(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.parts = 0;
    }

    fn std_table_open(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.parts = 0;
    }

    fn array_table_open(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.parts = 0;
    }

    fn scalar(&mut self, _: Span, _: Option<Encoding>, _: &mut dyn ErrorSink) {
        self.parts = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn too_deep(text: &str) -> Option<Range<usize>> {
        measure(text).too_deep
    }

    #[test]
    fn depth_is_counted_in_brackets_and_dots() {
        let nested = |depth: usize| format!("a = {}{}", "[".repeat(depth), "]".repeat(depth));
        assert_eq!(too_deep(&nested(NESTING)), None);
        assert_eq!(too_deep(&nested(NESTING + 1)), Some(NESTING + 4..NESTING + 5));
        let dotted = |parts: usize| format!("{}b = 1\n", "a.".repeat(parts));
        assert_eq!(too_deep(&dotted(10).repeat(KEY_PARTS)), None);
        assert!(too_deep(&dotted(KEY_PARTS)).is_some());
        assert!(too_deep(&format!("[{}]", vec!["a"; 100_000].join("."))).is_some());
        assert!(too_deep(&"a = {a = [".repeat(50_000)).is_some());
    }

    #[test]
    fn an_unclosed_value_is_taken_out() {
        let text = "a = [1, é\n  b = 2\n [x]\nc = {\n[[y]]\n";
        assert_eq!(measure(text).unclosed, Some(4));
        let text = without_unclosed(text, 4);
        assert_eq!(text, "a = 0     \n       \n [x]\nc = {\n[[y]]\n");
        assert_eq!(measure(&text).unclosed, Some(28));
        assert_eq!(without_unclosed("a = [", 4), "a = 0");
        assert_eq!(measure("a = [[1], {}]").unclosed, None);
    }
}
