//! Places in a text: byte offsets go in, lines and columns come out.

use std::ops::Range;

use crate::span::{Source, Span};

/// A source and where its lines start.
pub(super) struct Text<'a> {
    /// What messages call it.
    pub(super) name: &'a str,
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Text<'a> {
    /// Finds the lines of a source. There is always one, and the text behind the last line end is one too.
    pub(super) fn new(source: &'a Source) -> Self {
        let text: &str = &source.text;
        let ends = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at + 1);
        Self { name: &source.name, text, starts: std::iter::once(0).chain(ends).collect() }
    }

    /// A span's range, moved to where there is text and out of the middle of characters.
    pub(super) fn clamp(&self, span: Span) -> Range<usize> {
        let start = self.floor(span.start as usize);
        start..self.floor(span.end as usize).max(start)
    }

    fn floor(&self, offset: usize) -> usize {
        let offset = offset.min(self.text.len());
        (0..=offset).rev().find(|&at| self.text.is_char_boundary(at)).unwrap_or(0)
    }

    /// How many lines there are.
    pub(super) fn lines(&self) -> usize {
        self.starts.len()
    }

    /// The line that an offset lies in, from 0.
    pub(super) fn line_of(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    /// Where a line starts.
    pub(super) fn line_start(&self, line: usize) -> usize {
        self.starts.get(line).copied().unwrap_or(self.text.len())
    }

    /// A line without its end.
    pub(super) fn line(&self, line: usize) -> &'a str {
        let end = self.starts.get(line + 1).copied().unwrap_or(self.text.len());
        let text = self.text.get(self.line_start(line)..end).unwrap_or_default();
        let text = text.strip_suffix('\n').unwrap_or(text);
        text.strip_suffix('\r').unwrap_or(text)
    }

    /// The column of an offset that [`Text::clamp`] gave, in characters from 0.
    pub(super) fn column(&self, offset: usize) -> usize {
        let start = self.line_start(self.line_of(offset));
        self.text.get(start..offset).map_or(0, |before| before.chars().count())
    }
}
