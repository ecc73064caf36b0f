//! Where comments go when a text is laid out anew.
//!
//! The walk over the tree runs in the order of the text and takes every comment as it passes it. A comment between
//! two items of a list, block or clause stays between them, behind the first where it stood on its line. A comment in
//! an odder place stays where it is if it is a short `/* */`, and otherwise moves above the item it stood in.

use super::layout::Layout;
use crate::span::Span;
use crate::syntax::ast::{Comment, Document};

/// A comment on a line of its own.
#[derive(Debug, Clone)]
pub(super) struct Lead {
    /// Its text.
    pub(super) text: String,
    /// Whether an empty line stands above it.
    pub(super) blank: bool,
}

/// The comments between two items.
#[derive(Debug, Default)]
pub(super) struct Gap {
    /// What stands on the line of the first item, with a space before each.
    pub(super) trailing: String,
    /// What stands on lines of its own.
    pub(super) own: Vec<Lead>,
}

/// The text a document was read from and those of its comments that have not been laid out yet.
pub(super) struct Comments<'a> {
    text: &'a str,
    list: Vec<&'a Comment>,
    next: usize,
    /// Comments of odd places, waiting for the item around them to end.
    hoisted: Vec<String>,
}

impl<'a> Comments<'a> {
    /// The comments of a document. `text` is empty where there is none: then nothing is known about its lines.
    pub(super) fn new(document: &'a Document, text: &'a str) -> Self {
        let mut list: Vec<&Comment> = document.comments.iter().collect();
        list.sort_by_key(|comment| comment.span.start);
        Self { text, list, next: 0, hoisted: Vec::new() }
    }

    /// No text and no comments.
    pub(super) fn none() -> Self {
        Self { text: "", list: Vec::new(), next: 0, hoisted: Vec::new() }
    }

    /// Whether there is a text to look at.
    pub(super) fn has_text(&self) -> bool {
        !self.text.is_empty()
    }

    /// Whether a line ends between two places.
    pub(super) fn is_broken_between(&self, start: usize, end: usize) -> bool {
        self.text.get(start..end).is_some_and(|text| text.contains('\n'))
    }

    /// Whether an empty line stands above a place.
    pub(super) fn is_blank_before(&self, start: usize) -> bool {
        let before = self.text.get(..start).unwrap_or("");
        let code = before.trim_end();
        !code.is_empty() && before[code.len()..].matches('\n').count() > 1
    }

    /// Whether a comment that has not been laid out stands between two places.
    pub(super) fn any_between(&self, start: usize, end: usize) -> bool {
        let waiting = &self.list[self.next..];
        let first = waiting.partition_point(|comment| (comment.span.start as usize) < start);
        waiting.get(first).is_some_and(|comment| (comment.span.start as usize) < end)
    }

    /// The first `wanted` outside of comments in a range.
    pub(super) fn find(&self, start: usize, end: usize, wanted: char) -> Option<usize> {
        let mut at = start;
        let first = self.list.partition_point(|comment| (comment.span.end as usize) <= start);
        let mut comments = self.list[first..].iter().peekable();
        while at < end {
            let stop = comments.peek().map_or(end, |comment| (comment.span.start as usize).min(end));
            if let Some(found) = self.text.get(at..stop).and_then(|code| code.find(wanted)) {
                return Some(at + found);
            }
            at = comments.next().map_or(end, |comment| (comment.span.end as usize).max(at));
        }
        None
    }

    /// Takes the comments before `limit` that stand between the item that ends at `previous` and whatever begins at
    /// `limit`. With `keep_inline`, short ones that lead up to it on its own line are left for it.
    pub(super) fn gap(&mut self, previous: Option<usize>, limit: usize, keep_inline: bool) -> Gap {
        let waiting = &self.list[self.next..];
        let waiting = &waiting[..waiting.partition_point(|comment| (comment.span.start as usize) < limit)];
        let taken = if keep_inline {
            let ends_line = |i: usize| {
                let after = waiting.get(i + 1).map_or(limit, |next| next.span.start as usize);
                !is_short(waiting[i]) || self.is_broken_between(waiting[i].span.end as usize, after)
            };
            (0..waiting.len()).rev().find(|&i| ends_line(i)).map_or(0, |i| i + 1)
        } else {
            waiting.len()
        };
        let mut gap = Gap::default();
        let mut line = previous;
        for comment in &waiting[..taken] {
            let start = comment.span.start as usize;
            let on_line = line.is_some_and(|end| !self.is_broken_between(end, start));
            if on_line && gap.own.is_empty() && !comment.text.contains('\n') {
                gap.trailing.push(' ');
                gap.trailing.push_str(&clean(comment));
                line = Some(comment.span.end as usize);
            } else {
                gap.own.push(Lead { text: clean(comment), blank: self.is_blank_before(start) });
            }
        }
        self.next += taken;
        gap
    }

    /// Takes the comments before `limit` that are left in the line: short ones as text, others hoisted.
    pub(super) fn inline(&mut self, limit: usize) -> Vec<String> {
        let mut short = Vec::new();
        while let Some(comment) = self.list.get(self.next).filter(|comment| (comment.span.start as usize) < limit) {
            if is_short(comment) {
                short.push(clean(comment));
            } else {
                self.hoisted.push(clean(comment));
            }
            self.next += 1;
        }
        short
    }

    /// A word of the text, behind the comments that lead up to it.
    pub(super) fn word(&mut self, span: Span, word: impl Into<String>) -> Layout {
        let mut text: String = self.inline(span.start as usize).into_iter().map(|comment| comment + " ").collect();
        text.push_str(&word.into());
        Layout::Text(text)
    }

    /// What stands before the bracket that ends at `end`.
    pub(super) fn before_close(&mut self, end: usize) -> Layout {
        Layout::Text(self.inline(end).into_iter().map(|comment| format!(" {comment}")).collect())
    }

    /// Where the hoisted comments of an item begin.
    pub(super) fn mark(&self) -> usize {
        self.hoisted.len()
    }

    /// Takes the comments that were hoisted since `mark`.
    pub(super) fn hoisted_since(&mut self, mark: usize) -> Vec<Lead> {
        self.hoisted.split_off(mark).into_iter().map(|text| Lead { text, blank: false }).collect()
    }
}

/// Whether a comment may stand in a line with code behind it.
fn is_short(comment: &Comment) -> bool {
    comment.text.starts_with("/*") && !comment.text.contains('\n')
}

/// A comment as it is written again: without white space at its lines' ends. A `///` that documents nothing loses a
/// slash, or it might come to document what it is moved to.
fn clean(comment: &Comment) -> String {
    let lines: Vec<&str> = comment.text.lines().map(str::trim_end).collect();
    let text = lines.join("\n");
    match text.strip_prefix("///") {
        Some(rest) if !rest.starts_with('/') => format!("//{rest}"),
        _ => text,
    }
}
