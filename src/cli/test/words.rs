//! What a test prints: a line a swatch, and the figures of those that changed.

use crate::library::review::{Outcome, Review, Swatch};

/// More changed figures of a swatch than anyone reads on a terminal.
const MOST: usize = 12;

/// The text of a review.
pub(super) fn text(review: &Review, is_accepted: bool) -> String {
    let width = review.swatches.iter().map(|swatch| swatch.name.chars().count()).max().unwrap_or(0);
    let mut text: String = review.swatches.iter().map(|swatch| line(swatch, width, is_accepted)).collect();
    for fault in &review.faults {
        text.push_str(&format!("fault     {fault}\n"));
    }
    text.push_str(&format!("{}: {}\n", review.title, review.summary()));
    text
}

fn line(swatch: &Swatch, width: usize, is_accepted: bool) -> String {
    let word = match (swatch.outcome, is_accepted) {
        (Outcome::Changed(_) | Outcome::New, true) => "accepted",
        (Outcome::Orphan, true) => "removed",
        (outcome, _) => outcome.word(),
    };
    let said = match (swatch.outcome, is_accepted) {
        (Outcome::New, true) => "it had no pin".to_owned(),
        (outcome, _) => outcome.to_string(),
    };
    let mut text = format!("{word:8}  {:width$}  {said}", swatch.name).trim_end().to_owned();
    text.push('\n');
    let shown = swatch.changes.get(..MOST).unwrap_or(&swatch.changes);
    let or_none = |value: &Option<String>| value.clone().unwrap_or_else(|| "–".to_owned());
    let columns = |of: fn(&crate::library::pin::Change) -> usize| shown.iter().map(of).max().unwrap_or(0);
    let what = columns(|change| change.what.chars().count());
    let old = columns(|change| change.old.as_ref().map_or(1, |old| old.chars().count()));
    for change in shown {
        let (was, is) = (or_none(&change.old), or_none(&change.new));
        text.push_str(&format!("            {:what$}  {was:>old$} → {is}\n", change.what));
    }
    if swatch.changes.len() > shown.len() {
        text.push_str(&format!("            and {} more\n", swatch.changes.len() - shown.len()));
    }
    text
}
