//! The lines of two texts that went and came, as git writes them: git shows no text of its own where a driver is set.

use similar::{ChangeTag, TextDiff};

use super::words::{Paintbox, printable};

/// Lines of both texts that are set side by side, at most: the time it takes grows with the square of their number.
const MOST_LINES: usize = 20_000;

/// Lines around a change that are shown with it.
const AROUND: usize = 3;

/// What differs between two texts, or nothing where they are the same.
pub(super) fn lines(names: [&str; 2], [old, new]: [&str; 2], paintbox: Paintbox) -> String {
    if old == new {
        return String::new();
    }
    if old.lines().count() + new.lines().count() > MOST_LINES {
        return "\nthe texts are too long to be set side by side: `git diff --no-ext-diff` does\n".to_owned();
    }
    let difference = TextDiff::from_lines(old, new);
    let [old_name, new_name] = names.map(printable);
    let mut out = String::from("\n");
    let mut put = |text: &str| {
        out.push_str(text);
        out.push('\n');
    };
    put(&paintbox.strong(&format!("--- {old_name}")));
    put(&paintbox.strong(&format!("+++ {new_name}")));
    for hunk in difference.unified_diff().context_radius(AROUND).iter_hunks() {
        put(&paintbox.place(&hunk.header().to_string()));
        for change in hunk.iter_changes() {
            let line = shown(change.value());
            put(&match change.tag() {
                ChangeTag::Delete => paintbox.old(&format!("-{line}")),
                ChangeTag::Insert => paintbox.added(&format!("+{line}")),
                ChangeTag::Equal => format!(" {line}"),
            });
            if change.missing_newline() {
                put("\\ No newline at end of file");
            }
        }
    }
    out
}

/// A line without its end and without what would steer a terminal; tabs stay.
fn shown(line: &str) -> String {
    let line = line.strip_suffix('\n').unwrap_or(line);
    line.split('\t').map(printable).collect::<Vec<_>>().join("\t")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_shown_as_git_does() {
        let (old, new) = ("a\nb\nc\nd\ne\n\tf\x1b[31m\n", "a\nb\nc\nd\nE\n\tf\x1b[31m");
        let said = lines(["x", "y"], [old, new], Paintbox::Plain);
        let wanted = "\n--- x\n+++ y\n@@ -2,5 +2,5 @@\n b\n c\n d\n-e\n-\tf\u{fffd}[31m\n+E\n+\tf\u{fffd}[31m\n\\ No newline at end of file\n";
        assert_eq!(said, wanted);
        assert_eq!(lines(["x", "y"], [old, old], Paintbox::Plain), "");
        let coloured = lines(["x", "y"], ["a\n", "b\n"], Paintbox::Colours);
        assert!(coloured.contains("\x1b[31m-a\x1b[0m\n\x1b[32m+b\x1b[0m"), "{coloured}");
    }

    #[test]
    fn texts_without_end_are_not_compared() {
        let (old, new) = ("a\n".repeat(MOST_LINES), "b\n".repeat(MOST_LINES));
        assert!(lines(["x", "y"], [&old, &new], Paintbox::Plain).contains("too long"));
    }
}
