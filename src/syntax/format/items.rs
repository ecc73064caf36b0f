//! Lists of items between brackets: arguments, members, properties, arms, statements.

use super::Formatter;
use super::comments::Lead;
use super::layout::Layout;
use crate::syntax::ast::{Argument, Arm, Doc, Expr, Parameter, Property, Statement};

/// A member of a list in the tree, as far as its place goes.
pub(super) trait Item {
    /// Its first byte, without the doc comment.
    fn start(&self) -> usize;
    /// One past its last byte.
    fn end(&self) -> usize;
    /// The doc comment above it.
    fn doc(&self) -> Option<&Doc> {
        None
    }
}

impl Item for Expr {
    fn start(&self) -> usize {
        self.span.start as usize
    }
    fn end(&self) -> usize {
        self.span.end as usize
    }
}

impl Item for Argument {
    fn start(&self) -> usize {
        self.name.as_ref().map_or(self.value.span, |name| name.span).start as usize
    }
    fn end(&self) -> usize {
        self.value.span.end as usize
    }
}

impl Item for Arm {
    fn start(&self) -> usize {
        self.span.start as usize
    }
    fn end(&self) -> usize {
        self.value.span.end as usize
    }
}

impl Item for Property {
    fn start(&self) -> usize {
        self.name.span.start as usize
    }
    fn end(&self) -> usize {
        self.value.span.end as usize
    }
    fn doc(&self) -> Option<&Doc> {
        self.doc.as_ref()
    }
}

impl Item for Parameter {
    fn start(&self) -> usize {
        self.name.span.start as usize
    }
    fn end(&self) -> usize {
        let ty = self.ty.as_ref().map_or(self.name.span, |ty| ty.span);
        self.default.as_ref().map_or(ty, |default| default.span).end as usize
    }
    fn doc(&self) -> Option<&Doc> {
        self.doc.as_ref()
    }
}

impl Item for Statement {
    fn start(&self) -> usize {
        self.span.start as usize
    }
    fn end(&self) -> usize {
        self.span.end as usize
    }
    fn doc(&self) -> Option<&Doc> {
        self.doc.as_ref()
    }
}

/// An item that is laid out, with the comments around it.
pub(super) struct Entry {
    /// The comments and doc comments above it.
    pub(super) leads: Vec<Lead>,
    /// Whether an empty line stands between those and the item, or above the item if there are none.
    pub(super) blank: bool,
    /// The item.
    pub(super) body: Layout,
    /// The comments behind it.
    pub(super) trailing: String,
}

/// The items of a list with all that stands between its brackets.
pub(super) struct Items {
    /// The items in order.
    pub(super) entries: Vec<Entry>,
    /// Comments on lines of their own behind the last.
    pub(super) tail: Vec<Lead>,
    /// Short comments before the closing bracket.
    pub(super) inline: Vec<String>,
}

/// How the items of a list are told apart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    /// By commas, and a trailing one where the list is broken.
    Commas,
    /// By commas on one line, by line ends where the list is broken.
    Lines,
}

/// The brackets around a list.
#[derive(Clone, Copy)]
pub(super) struct Brackets {
    open: &'static str,
    close: &'static str,
    pad: &'static str,
    separator: Separator,
}

/// `(a, b)`
pub(super) const ROUND: Brackets = Brackets { open: "(", close: ")", pad: "", separator: Separator::Commas };
/// `[a, b]`
pub(super) const SQUARE: Brackets = Brackets { open: "[", close: "]", pad: "", separator: Separator::Commas };
/// `{ a, b }`, a value
pub(super) const CURLY: Brackets = Brackets { open: "{", close: "}", pad: " ", separator: Separator::Commas };
/// `{ a, b }`, a block, without commas where it is broken
pub(super) const BLOCK: Brackets = Brackets { open: "{", close: "}", pad: " ", separator: Separator::Lines };

impl Formatter<'_> {
    /// Lays out the items of `list`, whose closing bracket ends at `end`. With `keep_inline`, short comments may stay
    /// in front of the item they lead up to.
    pub(super) fn items<T: Item>(
        &mut self,
        list: &[T],
        end: usize,
        keep_inline: bool,
        build: impl Fn(&mut Self, &T) -> Layout,
    ) -> Items {
        let mut entries: Vec<Entry> = Vec::with_capacity(list.len());
        let mut previous = None;
        for item in list {
            let doc = item.doc().filter(|_| self.docs);
            let start = doc.map_or(item.start(), |doc| doc.span.start as usize);
            // A comment between a doc comment and its item would part them.
            let gap = self.comments.gap(previous, start, keep_inline && doc.is_none());
            if let Some(last) = entries.last_mut() {
                last.trailing = gap.trailing;
            }
            let mut leads = gap.own;
            let blank = self.comments.is_blank_before(start);
            let mark = self.comments.mark();
            let body = build(self, item);
            let mut above = self.comments.hoisted_since(mark);
            above.extend(doc.into_iter().flat_map(doc_lines));
            // The empty line stands above all that belongs to the item.
            let blank = match above.first_mut() {
                Some(first) => {
                    first.blank = blank;
                    false
                }
                None => blank,
            };
            leads.extend(above);
            entries.push(Entry { leads, blank, body, trailing: String::new() });
            previous = Some(item.end());
        }
        let gap = self.comments.gap(previous, end, keep_inline);
        if let Some(last) = entries.last_mut() {
            last.trailing = gap.trailing;
        }
        let mut tail = gap.own;
        let mark = self.comments.mark();
        let inline = self.comments.inline(end);
        tail.extend(self.comments.hoisted_since(mark));
        Items { entries, tail, inline }
    }
}

/// The lines of a doc comment.
fn doc_lines(doc: &Doc) -> Vec<Lead> {
    let line = |text: &str| Lead { text: format!("/// {text}").trim_end().to_owned(), blank: false };
    doc.text.split('\n').map(line).collect()
}

impl Items {
    /// Whether comments keep the list from standing on one line.
    pub(super) fn is_broken(&self) -> bool {
        !self.tail.is_empty() || self.entries.iter().any(|entry| !entry.leads.is_empty() || !entry.trailing.is_empty())
    }

    /// The items with line ends between and before them, and what separates them.
    pub(super) fn lines(self, separator: Separator, pad: &'static str, closed: bool) -> Vec<Layout> {
        let mut out = Vec::new();
        let count = self.entries.len();
        let inline: String = self.inline.iter().map(|comment| format!(" {comment}")).collect();
        for (i, entry) in self.entries.into_iter().enumerate() {
            let flat = if i == 0 { pad } else { " " };
            let mut first = i == 0;
            for lead in entry.leads {
                out.push(Layout::Line { flat, blank: lead.blank && !first });
                out.push(Layout::Text(lead.text));
                first = false;
            }
            out.push(Layout::Line { flat, blank: entry.blank && !first });
            out.push(entry.body);
            let last = i + 1 == count;
            match separator {
                Separator::Commas if last => out.push(Layout::Choice { flat: "", broken: "," }),
                Separator::Commas => out.push(Layout::text(",")),
                Separator::Lines if !last => out.push(Layout::Choice { flat: ",", broken: "" }),
                Separator::Lines => {}
            }
            if last && closed {
                out.push(Layout::text(inline.as_str()));
            }
            out.push(Layout::Suffix(entry.trailing));
        }
        for (i, lead) in self.tail.into_iter().enumerate() {
            out.push(Layout::Line { flat: pad, blank: lead.blank && (count > 0 || i > 0) });
            out.push(Layout::Text(lead.text));
        }
        out
    }

    /// The items between brackets; broken where `broken` says so or comments ask for it.
    pub(super) fn enclose(self, brackets: Brackets, broken: bool) -> Layout {
        let Brackets { open, close, pad, separator } = brackets;
        if self.entries.is_empty() && self.tail.is_empty() {
            let inside = if self.inline.is_empty() { String::new() } else { format!(" {} ", self.inline.join(" ")) };
            return Layout::text(format!("{open}{inside}{close}"));
        }
        let broken = broken || self.is_broken();
        let parts = vec![
            Layout::text(open),
            Layout::indent(self.lines(separator, pad, true)),
            Layout::Line { flat: pad, blank: false },
            Layout::text(close),
        ];
        Layout::group(parts, broken)
    }
}
