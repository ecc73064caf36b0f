//! Laying text out on lines of limited width.
//!
//! In: a [`Layout`], a tree of texts, of places where a line may end and of groups that either stay on one line or
//! break at all of their own places. Out: the text. Outer groups break before inner ones (Oppen, "Prettyprinting",
//! TOPLAS 1980, in the form of Wadler's "A prettier printer", 2003). Nothing here knows the language.

/// The greatest number of characters on a line.
pub(super) const WIDTH: usize = 100;

/// Columns of one level.
const INDENT: usize = 2;

/// A text that has not been laid out.
#[derive(Debug, Clone)]
pub(super) enum Layout {
    /// As it stands.
    Text(String),
    /// Where a line may end; one space or nothing otherwise.
    Line {
        /// What stands there when the line goes on.
        flat: &'static str,
        /// Whether an empty line follows the line that ends.
        blank: bool,
    },
    /// One text or the other, depending on whether the group is broken.
    Choice {
        /// When the group stays on one line.
        flat: &'static str,
        /// When it does not.
        broken: &'static str,
    },
    /// A trailing comment: it may stand beyond the width.
    Suffix(String),
    /// One after the other.
    Concat(Vec<Layout>),
    /// Lines that end within stand one level deeper.
    Indent(Box<Layout>),
    /// Breaks as a whole or not at all.
    Group {
        /// What it holds.
        inner: Box<Layout>,
        /// Whether it is broken even where it would fit.
        broken: bool,
    },
}

impl Layout {
    /// A text.
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// One level deeper.
    pub(super) fn indent(parts: Vec<Self>) -> Self {
        Self::Indent(Box::new(Self::Concat(parts)))
    }

    /// A group that is broken where it must be: because `broken` says so or because a group within is.
    pub(super) fn group(parts: Vec<Self>, broken: bool) -> Self {
        let broken = broken || parts.iter().any(Self::is_broken);
        Self::Group { inner: Box::new(Self::Concat(parts)), broken }
    }

    /// Whether a group in it cannot stay on one line.
    pub(super) fn is_broken(&self) -> bool {
        match self {
            Self::Text(_) | Self::Line { .. } | Self::Choice { .. } | Self::Suffix(_) => false,
            Self::Concat(parts) => parts.iter().any(Self::is_broken),
            Self::Indent(inner) => inner.is_broken(),
            Self::Group { broken, .. } => *broken,
        }
    }

    /// Lays it out within `width` columns where that can be done. The outermost level is broken.
    pub(super) fn print(&self, width: usize) -> String {
        let mut printer = Printer { out: String::new(), column: 0, width };
        printer.print(self);
        printer.out
    }
}

/// Whether the places of the group around are line ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Flat,
    Broken,
}

/// What is still to be printed: how deep it stands, in which mode, and what it is.
type Task<'a> = (usize, Mode, &'a Layout);

struct Printer {
    out: String,
    column: usize,
    width: usize,
}

impl Printer {
    fn print(&mut self, layout: &Layout) {
        let mut tasks: Vec<Task<'_>> = vec![(0, Mode::Broken, layout)];
        while let Some((depth, mode, layout)) = tasks.pop() {
            match layout {
                Layout::Text(text) | Layout::Suffix(text) => self.write(text),
                Layout::Line { flat, blank } => match mode {
                    Mode::Flat => self.write(flat),
                    Mode::Broken => self.end_line(depth, *blank),
                },
                Layout::Choice { flat, broken } => self.write(if mode == Mode::Flat { flat } else { broken }),
                Layout::Concat(parts) => tasks.extend(parts.iter().rev().map(|part| (depth, mode, part))),
                Layout::Indent(inner) => tasks.push((depth + 1, mode, inner)),
                Layout::Group { inner, broken } => {
                    let room = self.width.saturating_sub(self.column);
                    let flat = !broken && fits(room, inner, &tasks);
                    tasks.push((depth, if flat { Mode::Flat } else { Mode::Broken }, inner));
                }
            }
        }
    }

    fn write(&mut self, text: &str) {
        self.out.push_str(text);
        match text.rfind('\n') {
            Some(at) => self.column = columns(&text[at + 1..]),
            None => self.column += columns(text),
        }
    }

    fn end_line(&mut self, depth: usize, blank: bool) {
        self.out.truncate(self.out.trim_end_matches(' ').len());
        self.out.push('\n');
        if blank {
            self.out.push('\n');
        }
        self.column = depth * INDENT;
        self.out.extend(std::iter::repeat_n(' ', self.column));
    }
}

/// Whether `inner` fits into `room` columns on one line, together with what follows it up to the next line end.
fn fits(room: usize, inner: &Layout, rest: &[Task<'_>]) -> bool {
    let mut left = room;
    let mut local = vec![(Mode::Flat, inner)];
    let mut rest = rest.iter().rev();
    loop {
        let (mode, layout) = match local.pop() {
            Some(task) => task,
            None => match rest.next() {
                Some(&(_, mode, layout)) => (mode, layout),
                None => return true,
            },
        };
        let text = match layout {
            Layout::Text(text) => text.as_str(),
            Layout::Line { flat, .. } => match mode {
                Mode::Flat => flat,
                Mode::Broken => return true,
            },
            Layout::Choice { flat, broken } => match mode {
                Mode::Flat => flat,
                Mode::Broken => broken,
            },
            Layout::Suffix(_) => "",
            Layout::Concat(parts) => {
                local.extend(parts.iter().rev().map(|part| (mode, part)));
                ""
            }
            Layout::Indent(inner) => {
                local.push((mode, inner));
                ""
            }
            Layout::Group { inner, broken } => {
                local.push((if *broken { Mode::Broken } else { mode }, inner));
                ""
            }
        };
        match left.checked_sub(columns(text)) {
            Some(remaining) => left = remaining,
            None => return false,
        }
    }
}

fn columns(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(items: &[&str]) -> Layout {
        let mut inner = Vec::new();
        for (i, item) in items.iter().enumerate() {
            inner.push(Layout::Line { flat: if i == 0 { "" } else { " " }, blank: false });
            inner.push(Layout::text(*item));
            inner.push(if i + 1 < items.len() { Layout::text(",") } else { Layout::Choice { flat: "", broken: "," } });
        }
        let parts =
            vec![Layout::text("["), Layout::indent(inner), Layout::Line { flat: "", blank: false }, Layout::text("]")];
        Layout::group(parts, false)
    }

    #[test]
    fn a_group_stays_on_its_line_while_it_fits() {
        assert_eq!(list(&["aa", "bb"]).print(8), "[aa, bb]");
        assert_eq!(list(&["aa", "bb"]).print(7), "[\n  aa,\n  bb,\n]");
    }

    #[test]
    fn what_follows_a_group_counts_and_trailing_comments_do_not() {
        let with = |tail: Layout| Layout::Concat(vec![list(&["aa", "bb"]), tail]).print(8);
        assert_eq!(with(Layout::text("+")), "[\n  aa,\n  bb,\n]+");
        assert_eq!(with(Layout::Suffix(" // long".into())), "[aa, bb] // long");
    }

    #[test]
    fn a_broken_group_breaks_those_around_it() {
        let inner = Layout::group(vec![Layout::text("a"), Layout::Line { flat: " ", blank: true }], true);
        assert!(Layout::group(vec![inner], false).is_broken());
    }
}
