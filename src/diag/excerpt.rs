//! What is shown of a source: the lines around some spans as text of their own, made safe to print.
//!
//! Spans go in as ranges of the source; what comes out answers miette's questions about ranges of the excerpt. Lines that
//! are too long are cut to the surroundings of the first span on them.

use std::ops::Range;

use miette::{LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::place::Text;

/// Columns that a tab takes at most.
const TAB: usize = 4;
/// A span of more lines is shown by its first.
pub(super) const MOST_LINES: usize = 12;

/// How much of a line is shown, and what stands for the rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    /// Columns.
    pub(super) columns: usize,
    /// What stands where a line is cut.
    pub(super) ellipsis: &'static str,
}

/// Some lines of a source that follow each other.
#[derive(Debug)]
pub(super) struct Excerpt {
    name: String,
    /// Which line of the source the first one is, from 0.
    first: usize,
    text: String,
    /// Where each line ends in `text`, its line end included.
    ends: Vec<usize>,
    labels: Vec<Label>,
}

#[derive(Debug)]
struct Label {
    range: Range<usize>,
    /// The column in the source where it starts, from 0.
    column: usize,
    text: String,
}

impl Excerpt {
    /// The lines that some ranges lie in, with one more above and below. The first range is the one that matters most.
    pub(super) fn new(source: &Text<'_>, ranges: &[(Range<usize>, &str)], window: Window) -> Self {
        let ranges: Vec<(Range<usize>, &str)> =
            ranges.iter().map(|(range, label)| (shorten(source, range.clone()), *label)).collect();
        let lines_of = |range: &Range<usize>| [source.line_of(range.start), source.line_of(range.end)];
        let touched = |line: usize| ranges.iter().find(|(range, _)| lines_of(range).contains(&line));
        let top = ranges.iter().map(|(range, _)| lines_of(range)[0]).min().unwrap_or(0);
        let bottom = ranges.iter().map(|(range, _)| lines_of(range)[1]).max().unwrap_or(0);
        let first = top.saturating_sub(1);
        let mut last = (bottom + 1).min(source.lines() - 1);
        // The nothing behind the last line end is shown only where it is meant.
        if last > bottom && last + 1 == source.lines() && source.line(last).is_empty() {
            last -= 1;
        }
        let mut excerpt =
            Self { name: printable(source.name), first, text: String::new(), ends: Vec::new(), labels: Vec::new() };
        let mut shown = Vec::new();
        for line in first..=last {
            let start = source.line_start(line);
            let anchor = touched(line).map_or(0, |(range, _)| range.start.saturating_sub(start));
            shown.push(excerpt.push(source.line(line), anchor, window));
        }
        let place = |offset: usize| {
            let line = source.line_of(offset);
            shown.get(line - first).map_or(0, |shown| shown.place(source.line(line), offset - source.line_start(line)))
        };
        excerpt.labels = ranges
            .iter()
            .map(|(range, label)| Label {
                range: place(range.start)..place(range.end).max(place(range.start)),
                column: source.column(range.start),
                text: printable(label),
            })
            .collect();
        excerpt
    }

    /// Adds a line, of which what lies around `anchor` is shown.
    fn push(&mut self, line: &str, anchor: usize, window: Window) -> Shown {
        let part = visible(line, anchor, window.columns);
        if part.start > 0 {
            self.text.push_str(window.ellipsis);
        }
        let at = self.text.len();
        self.text.push_str(&printable(line.get(part.clone()).unwrap_or_default()));
        if part.end < line.len() {
            self.text.push_str(window.ellipsis);
        }
        self.text.push('\n');
        self.ends.push(self.text.len());
        Shown { part, at }
    }

    /// The labels, the first as the primary one.
    pub(super) fn labels(&self) -> impl Iterator<Item = LabeledSpan> + '_ {
        self.labels.iter().enumerate().map(|(i, label)| {
            let text = Some(label.text.clone()).filter(|text| !text.is_empty());
            let span = SourceSpan::new(label.range.start.into(), label.range.len());
            if i == 0 { LabeledSpan::new_primary_with_span(text, span) } else { LabeledSpan::new_with_span(text, span) }
        })
    }
}

/// A part of a line of the source, and where it stands in the excerpt.
struct Shown {
    part: Range<usize>,
    at: usize,
}

impl Shown {
    /// Where a place in the line lies in the excerpt; the nearest end for places that are not shown.
    fn place(&self, line: &str, offset: usize) -> usize {
        let offset = offset.clamp(self.part.start, self.part.end);
        self.at + line.get(self.part.start..offset).map_or(0, |before| printable(before).len())
    }
}

/// A range that ends where its last line does rather than at the start of the next, and on its first line if it is long.
fn shorten(source: &Text<'_>, range: Range<usize>) -> Range<usize> {
    let end_of = |line: usize| source.line_start(line) + source.line(line).len();
    let (first, last) = (source.line_of(range.start), source.line_of(range.end));
    if last - first >= MOST_LINES {
        range.start..end_of(first).max(range.start)
    } else if last > first && range.end == source.line_start(last) {
        range.start..end_of(last - 1).max(range.start)
    } else {
        range
    }
}

/// The part of a line that fits into some columns: all of it, or what lies around `anchor`, a third of it before.
fn visible(line: &str, anchor: usize, columns: usize) -> Range<usize> {
    // Every character is a column or more, so no more than this many need be looked at.
    if line.chars().take(columns + 1).map(columns_of).sum::<usize>() <= columns {
        return 0..line.len();
    }
    let (before, after) = line.split_at_checked(anchor).unwrap_or((line, ""));
    let forward = |budget: usize| fitting(after.chars(), budget);
    let backward = |budget: usize| fitting(before.chars().rev(), budget);
    let (_, wide) = backward(columns / 3);
    let (ahead, used) = forward(columns - wide);
    // What the end of the line leaves free shows more of the beginning.
    let (behind, _) = backward(columns - used);
    before.len() - behind..before.len() + ahead
}

/// How many bytes of the first characters fit into some columns, and how many columns they take.
fn fitting(chars: impl Iterator<Item = char>, budget: usize) -> (usize, usize) {
    let (mut bytes, mut columns) = (0, 0);
    for c in chars {
        if columns + columns_of(c) > budget {
            break;
        }
        columns += columns_of(c);
        bytes += c.len_utf8();
    }
    (bytes, columns)
}

/// How many columns a character takes, rather too many than too few.
fn columns_of(c: char) -> usize {
    match c {
        '\t' => TAB,
        '\0'..='\u{10ff}' => 1,
        _ => 2,
    }
}

/// Text without what a terminal would obey rather than show.
pub(super) fn printable(text: &str) -> String {
    let show = |c: char| match c {
        '\t' => c,
        '\n' | '\r' | '\u{2028}' | '\u{2029}' => ' ',
        '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => char::REPLACEMENT_CHARACTER,
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    text.chars().map(show).collect()
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let line_of = |offset: usize| self.ends.partition_point(|&end| end <= offset).min(self.ends.len() - 1);
        let start_of = |line: usize| if line == 0 { 0 } else { self.ends[line - 1] };
        let (top, bottom) = (line_of(span.offset()), line_of(span.offset() + span.len()));
        let from = top.saturating_sub(before);
        let to = (bottom + after).min(self.ends.len() - 1);
        // Asked for no lines around, miette wants to know where exactly the span starts.
        let column = match before {
            0 => self.labels.iter().find(|label| label.range.start == span.offset()).map_or(0, |label| label.column),
            _ => 0,
        };
        let range = start_of(from)..self.ends[to];
        let data = self.text.as_bytes().get(range.clone()).ok_or(MietteError::OutOfBounds)?;
        let span = SourceSpan::new(range.start.into(), range.len());
        let contents =
            MietteSpanContents::new_named(self.name.clone(), data, span, self.first + from, column, to + 1 - from);
        Ok(Box::new(contents))
    }
}
