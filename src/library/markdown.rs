//! Reviews as Markdown, for a comment in a review system. Pictures lie beside it, named by [`picture_file`].

use super::review::{Review, Swatch, picture_file};

/// The text.
#[must_use]
pub fn write(reviews: &[Review]) -> String {
    let mut text = String::new();
    for review in reviews {
        text.push_str(&format!("# {}\n\n{}.\n", escaped(&review.title), review.summary()));
        for fault in &review.faults {
            text.push_str(&format!("\n- **fault**: {}\n", escaped(fault)));
        }
        for swatch in review.to_review() {
            text.push_str(&section(swatch));
        }
        if review.is_same() {
            text.push_str("\nEvery swatch looks as it was pinned.\n");
        } else if review.is_acceptable() {
            text.push_str("\n`kake test --accept` pins what is there now.\n");
        }
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

fn section(swatch: &Swatch) -> String {
    let mut text = format!(
        "\n## {}: {}\n\n{} `{}`\n",
        escaped(&swatch.name),
        swatch.outcome.word(),
        swatch.outcome.sentence(),
        swatch.file.replace('`', "'")
    );
    let pictures: Vec<(&str, String)> =
        swatch.pictures.named().map(|(kind, _)| (kind, picture_file(&swatch.name, kind))).collect();
    if !pictures.is_empty() {
        let row = |cells: Vec<String>| format!("|{}|\n", cells.join("|"));
        text.push('\n');
        text.push_str(&row(pictures.iter().map(|(kind, _)| format!(" {kind} ")).collect()));
        text.push_str(&row(pictures.iter().map(|_| "---".to_owned()).collect()));
        text.push_str(&row(pictures.iter().map(|(kind, file)| format!(" ![{kind}](<{file}>) ")).collect()));
    }
    if !swatch.changes.is_empty() {
        text.push_str("\n| figure | old | new |\n|---|---|---|\n");
        let or_none = |value: &Option<String>| value.clone().unwrap_or_else(|| "–".to_owned());
        for change in &swatch.changes {
            let (old, new) = (or_none(&change.old), or_none(&change.new));
            text.push_str(&format!("| {} | {} | {} |\n", escaped(&change.what), escaped(&old), escaped(&new)));
        }
    }
    if !swatch.said.is_empty() {
        // A fence longer than any run of backticks within.
        let longest = swatch.said.split(|c| c != '`').map(str::len).max().unwrap_or(0);
        let fence = "`".repeat((longest + 1).max(3));
        text.push_str(&format!("\n{fence}text\n{}\n{fence}\n", swatch.said.trim_end()));
    }
    text
}

/// A text of which no character means anything to Markdown, on one line.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '\n' | '\r' => out.push(' '),
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '#' | '|' | '&' | '!' => out.extend(['\\', character]),
            other => out.push(other),
        }
    }
    out
}
