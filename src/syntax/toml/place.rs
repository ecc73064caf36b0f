//! From places in a string's value to places in the TOML text.
//!
//! In: a string as it is written, with its quotes. Out: where each byte of its value came from, so that a mistake
//! within an expression is shown where it was made, behind escapes and trimmed line ends too. The rules are those of
//! TOML 1.1, "String".

/// Where the value of a string came from.
#[derive(Debug)]
pub(super) struct Places<'a> {
    /// The string as it is written.
    raw: &'a str,
    /// Where it begins in the text.
    start: usize,
    /// Runs of bytes that stand in the text as they stand in the value: where each begins in the value and in the
    /// text. In ascending order, never empty.
    runs: Vec<(usize, usize)>,
}

impl<'a> Places<'a> {
    /// The places of the string that is written as `raw` from the byte `start` on.
    pub(super) fn new(raw: &'a str, start: usize) -> Self {
        let (quote, multiline) = match raw.as_bytes() {
            [b'"', b'"', b'"', ..] => (b'"', true),
            [b'\'', b'\'', b'\'', ..] => (b'\'', true),
            [b'\'', ..] => (b'\'', false),
            _ => (b'"', false),
        };
        let width = if multiline { 3 } else { 1 };
        let mut at = width.min(raw.len());
        if multiline {
            // A line end directly behind the quotes is no part of the value.
            let rest = raw.get(at..).unwrap_or("");
            at += if rest.starts_with("\r\n") { 2 } else { usize::from(rest.starts_with('\n')) };
        }
        let end = raw.len().saturating_sub(width).max(at);
        let mut runs = vec![(0, start + at)];
        let mut value = 0;
        while quote == b'"' && at < end {
            let body = raw.get(at..end).unwrap_or("");
            let Some(plain) = body.find('\\') else { break };
            value += plain;
            at += plain;
            let (written, meant) = escape(&body[plain..]);
            runs.push((value, start + at));
            value += meant;
            at += written;
            runs.push((value, start + at));
        }
        Self { raw, start, runs }
    }

    /// Where the byte `offset` of the value stands in the text. Within an escape, where the escape begins; always where a
    /// character begins, for what the parser makes of an escape that is none is not known.
    pub(super) fn place(&self, offset: usize) -> usize {
        let next = self.runs.partition_point(|&(value, _)| value <= offset);
        let (value, text) = self.runs[next.saturating_sub(1)];
        let bound = self.runs.get(next).map_or(usize::MAX, |&(_, text)| text);
        let within = (text + (offset - value)).min(bound).saturating_sub(self.start).min(self.raw.len());
        self.start + (0..=within).rev().find(|&at| self.raw.is_char_boundary(at)).unwrap_or(0)
    }
}

/// How many bytes the escape at the start of `text` takes there and in the value.
fn escape(text: &str) -> (usize, usize) {
    let digits = |count: usize| {
        let code = text.get(2..2 + count).and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let letter = code.and_then(char::from_u32).unwrap_or(char::REPLACEMENT_CHARACTER);
        (2 + count, letter.len_utf8())
    };
    match text.as_bytes().get(1) {
        Some(b'x') => digits(2),
        Some(b'u') => digits(4),
        Some(b'U') => digits(8),
        // A backslash at the end of a line swallows the white space that follows.
        Some(b' ' | b'\t' | b'\r' | b'\n') => {
            let rest = &text[1..];
            (1 + rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n']).len(), 0)
        }
        // One letter is meant by another, or nothing is.
        Some(_) => (1 + text.chars().nth(1).map_or(0, char::len_utf8), 1),
        None => (1, 0),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn value(raw: &str) -> String {
        toml::de::DeValue::parse(raw).unwrap().into_inner().as_str().unwrap().to_owned()
    }

    #[test]
    fn every_kind_of_string_is_followed() {
        let cases = [
            (r#""a + b""#, "b"),
            (r#"'a + b'"#, "b"),
            (r#""\"x\" + \u3042 + \U0001F600 + \x41 + b""#, "b"),
            ("'''\n\"x\" +\n b'''", "b"),
            ("\"\"\"\r\n\"x\" + \\\r\n   \n b\"\"\"", "b"),
            (r#""""x \t "y" b""""#, "b"),
        ];
        for (raw, wanted) in cases {
            let found = Places::new(raw, 100).place(value(raw).find(wanted).unwrap());
            assert_eq!(found, 100 + raw.rfind(wanted).unwrap(), "{raw}");
        }
    }

    #[test]
    fn places_within_an_escape_are_where_it_begins() {
        let places = Places::new(r#""\u3042x""#, 0);
        assert_eq!((0..5).map(|offset| places.place(offset)).collect::<Vec<_>>(), [1, 2, 3, 7, 8]);
    }

    proptest! {
        #[test]
        fn plain_letters_keep_their_place(parts in proptest::collection::vec(0..8usize, 0..20), multiline: bool) {
            let pieces = ["q", r"\n", r#"\""#, r"\\", r"\u00e9", r"\U0001F600", "é", r"\x41"];
            let body: String = parts.iter().map(|&part| pieces[part]).collect();
            let quotes = if multiline { "\"\"\"" } else { "\"" };
            let raw = format!("{quotes}{body}{quotes}");
            let places = Places::new(&raw, 7);
            let value = value(&raw);
            let text: Vec<usize> = raw.match_indices('q').map(|(at, _)| at + 7).collect();
            let mapped: Vec<usize> = value.match_indices('q').map(|(at, _)| places.place(at)).collect();
            prop_assert_eq!(text, mapped);
            prop_assert_eq!(places.place(value.len()), 7 + raw.len() - quotes.len());
        }
    }
}
