//! How deep a TOML text is nested, before anything walks it.
//!
//! The tree that the `toml` crate builds is built, walked and freed by recursion. The crate's own bound of 80 levels is
//! less than the language allows, so it is switched off and this one takes its place: the same parser runs once with
//! its events thrown away and says where a text is nested too deeply.

use toml_parser::decoder::Encoding;
use toml_parser::parser::{EventReceiver, RecursionGuard, parse_document};
use toml_parser::{ErrorSink, Source, Span};

/// The greatest depth of arrays and tables within one value, of blocks, and of brackets in an expression.
pub(super) use crate::syntax::kake::NESTING;

/// The greatest number of names in a dotted key: two for every block around a drawing statement.
const KEY_PARTS: usize = 2 * NESTING + 8;

/// Where a text is nested too deeply, as a range of bytes.
pub(super) fn too_deep(text: &str) -> Option<std::ops::Range<usize>> {
    let tokens = Source::new(text).lex().into_vec();
    let mut keys = Keys { parts: 0, too_long: None };
    let mut too_deep: Option<Span> = None;
    let mut errors = |error: toml_parser::ParseError| {
        // The guard has no other way to say that it stopped.
        if error.description().contains("max recursion depth") {
            too_deep = too_deep.or(error.unexpected());
        }
    };
    let limit = u32::try_from(NESTING).unwrap_or(u32::MAX);
    parse_document(&tokens, &mut RecursionGuard::new(&mut keys, limit), &mut errors);
    too_deep.or(keys.too_long).map(|span| span.start()..span.end())
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
}
