//! Places in a text as editors count them: lines from 0 and columns in UTF-8, UTF-16 or UTF-32 units.
//!
//! Every place that comes in is brought to the nearest place that there is: no column lies beyond its line, no line beyond
//! the text, no byte within a character. Lines end with `\n`, `\r\n` or `\r`.

use std::ops::Range as Bytes;
use std::sync::Arc;

use lsp_types::{Position, PositionEncodingKind, Range};

/// What a column counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// What the protocol counts unless something else is agreed on.
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// The cheapest of those that a client offers.
    #[must_use]
    pub fn agreed(offered: &[PositionEncodingKind]) -> Self {
        let offers = |kind: &PositionEncodingKind| offered.contains(kind);
        if offers(&PositionEncodingKind::UTF8) {
            Self::Utf8
        } else if offers(&PositionEncodingKind::UTF32) && !offers(&PositionEncodingKind::UTF16) {
            Self::Utf32
        } else {
            Self::Utf16
        }
    }

    /// Its name in the protocol.
    #[must_use]
    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    fn width(self, character: char) -> usize {
        match self {
            Self::Utf8 => character.len_utf8(),
            Self::Utf16 => character.len_utf16(),
            Self::Utf32 => 1,
        }
    }
}

/// A text with its lines.
#[derive(Debug, Clone)]
pub struct Text {
    text: Arc<str>,
    encoding: Encoding,
    /// Where lines start.
    starts: Vec<usize>,
}

impl Text {
    /// Finds the lines of a text.
    #[must_use]
    pub fn new(text: Arc<str>, encoding: Encoding) -> Self {
        let bytes = text.as_bytes();
        let ends = bytes.iter().enumerate().filter(|&(at, &byte)| match byte {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        });
        let starts = std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect();
        Self { text, encoding, starts }
    }

    /// The text itself.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// The text itself, shared.
    #[must_use]
    pub fn shared(&self) -> &Arc<str> {
        &self.text
    }

    /// The line that a byte lies in, from 0.
    #[must_use]
    pub fn line_of(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// A line without its end, as a range of bytes; empty beyond the last.
    #[must_use]
    pub fn line(&self, line: usize) -> Bytes<usize> {
        let start = self.starts.get(line).copied().unwrap_or(self.text.len());
        let end = self.starts.get(line + 1).copied().unwrap_or(self.text.len());
        let inside = self.text.get(start..end).unwrap_or_default();
        start..start + inside.trim_end_matches(['\n', '\r']).len()
    }

    /// The byte of a place.
    #[must_use]
    pub fn offset(&self, position: Position) -> usize {
        let Ok(line) = usize::try_from(position.line) else { return self.text.len() };
        if line >= self.starts.len() {
            return self.text.len();
        }
        let range = self.line(line);
        let mut left = position.character as usize;
        let inside = self.text.get(range.clone()).unwrap_or_default();
        for (at, character) in inside.char_indices() {
            let width = self.encoding.width(character);
            // A column in the middle of a character is its start.
            if left < width {
                return range.start + at;
            }
            left -= width;
        }
        range.end
    }

    /// The place of a byte.
    #[must_use]
    pub fn position(&self, offset: usize) -> Position {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line_of(offset);
        let before = self.text.get(self.starts.get(line).copied().unwrap_or(0)..offset).unwrap_or_default();
        let column: usize = match self.encoding {
            Encoding::Utf8 => before.len(),
            Encoding::Utf16 | Encoding::Utf32 => before.chars().map(|c| self.encoding.width(c)).sum(),
        };
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        Position { line: count(line), character: count(column) }
    }

    /// The places of a range of bytes.
    #[must_use]
    pub fn range(&self, bytes: Bytes<usize>) -> Range {
        Range { start: self.position(bytes.start), end: self.position(bytes.end) }
    }

    /// The bytes of a range of places; empty at its start where it runs backwards.
    #[must_use]
    pub fn bytes(&self, range: Range) -> Bytes<usize> {
        let start = self.offset(range.start);
        start..self.offset(range.end).max(start)
    }

    /// The text with a range of it replaced, or all of it.
    #[must_use]
    pub fn edited(&self, range: Option<Range>, new: &str) -> Self {
        let Some(range) = range else { return Self::new(new.into(), self.encoding) };
        let bytes = self.bytes(range);
        let mut text = String::with_capacity(self.text.len() + new.len());
        text.push_str(self.text.get(..bytes.start).unwrap_or_default());
        text.push_str(new);
        text.push_str(self.text.get(bytes.end..).unwrap_or_default());
        Self::new(text.into(), self.encoding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(line: u32, character: u32) -> Position {
        Position { line, character }
    }

    #[test]
    fn columns_count_what_was_agreed_on() {
        // A kana is 3 bytes and 1 unit of UTF-16, the brush 4 bytes and 2 units.
        let text = "かけ🖌x\r\ny\rz";
        let places = |encoding| {
            let text = Text::new(text.into(), encoding);
            (text.position(10), text.offset(at(0, 4)), text.position(13), text.position(15))
        };
        assert_eq!(places(Encoding::Utf8), (at(0, 10), 3, at(1, 0), at(2, 0)));
        assert_eq!(places(Encoding::Utf16), (at(0, 4), 10, at(1, 0), at(2, 0)));
        assert_eq!(places(Encoding::Utf32), (at(0, 3), 11, at(1, 0), at(2, 0)));
    }

    #[test]
    fn places_that_are_not_there_are_brought_to_the_nearest() {
        let text = Text::new("ab\r\ncd".into(), Encoding::Utf16);
        assert_eq!(text.offset(at(0, 99)), 2);
        assert_eq!(text.offset(at(9, 0)), 6);
        assert_eq!(text.position(1000), at(1, 2));
        assert_eq!(text.edited(Some(Range { start: at(1, 1), end: at(0, 1) }), "x").as_str(), "ab\r\ncxd");
        assert_eq!(text.edited(Some(Range { start: at(0, 1), end: at(1, 1) }), "").as_str(), "ad");
    }

    proptest! {
        #[test]
        fn places_of_bytes_lead_back_to_them(text in "[a\u{e9}\u{304b}\u{1f58c}\r\n]{0,40}", utf8: bool) {
            let encoding = if utf8 { Encoding::Utf8 } else { Encoding::Utf16 };
            let lines = Text::new(text.as_str().into(), encoding);
            for (offset, _) in text.char_indices() {
                let back = lines.offset(lines.position(offset));
                // Between `\r` and `\n` there is no place of its own.
                let inside_end = text[..offset].ends_with('\r') && text[offset..].starts_with('\n');
                prop_assert!(back == offset || (inside_end && back + 1 == offset), "{offset} {back}");
            }
        }
    }
}
