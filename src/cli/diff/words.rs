//! What differs, in words for a terminal: short, and only what did.

use std::fmt::Write as _;
use std::io::{self, IsTerminal};

use crate::compare::Shift;
use crate::diag::grouped;
use crate::geom::Length;

use super::findings::{Change, Fate, Findings, Measure, PaintChange, Summary, digits, millimetres, significant};
use super::tones::Declared;

/// Columns of a line of measures.
const WIDTH: usize = 100;

/// Whether words are coloured: what went in red, what came in blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Paintbox {
    Colours,
    Plain,
}

impl Paintbox {
    /// Colours on a terminal, or where git shows what is printed on one page by page; never where `NO_COLOR` is set.
    pub(super) fn new() -> Self {
        let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let pages = std::env::var("GIT_PAGER_IN_USE").is_ok_and(|value| value == "true" || value == "1");
        let is_seen = io::stdout().is_terminal() || pages;
        let is_dumb = std::env::var("TERM").is_ok_and(|terminal| terminal == "dumb");
        if is_seen && !is_dumb && !is_set("NO_COLOR") { Self::Colours } else { Self::Plain }
    }

    /// A line that came, as git colours it.
    pub(super) fn added(self, text: &str) -> String {
        self.put("32", text)
    }

    /// Where lines stand, as git colours it.
    pub(super) fn place(self, text: &str) -> String {
        self.put("36", text)
    }

    fn put(self, code: &str, text: &str) -> String {
        match self {
            Self::Colours => format!("\x1b[{code}m{text}\x1b[0m"),
            Self::Plain => text.to_owned(),
        }
    }

    pub(super) fn old(self, text: &str) -> String {
        self.put("31", text)
    }

    fn new_one(self, text: &str) -> String {
        self.put("94", text)
    }

    pub(super) fn strong(self, text: &str) -> String {
        self.put("1", text)
    }

    fn faint(self, text: &str) -> String {
        self.put("2", text)
    }
}

/// All that differs.
pub(super) fn words(findings: &Findings, paintbox: Paintbox) -> String {
    let mut out = String::new();
    let none = |exists: bool, name: &str| {
        if exists { printable(name) } else { format!("{} (there is none)", printable(name)) }
    };
    let old = none(findings.old.exists, &findings.old.name);
    let new = none(findings.new.exists, &findings.new.name);
    line(&mut out, &paintbox.old(&format!("old  {old}")));
    line(&mut out, &paintbox.new_one(&format!("new  {new}")));
    line(&mut out, &paintbox.strong(&verdict(findings)));
    if findings.draws_nothing() {
        let hint =
            "draws nothing by itself: what becomes of pictures is seen where a scene that imports it is compared";
        line(&mut out, &paintbox.faint(hint));
    }
    for change in &findings.declared {
        declared(&mut out, change, paintbox);
    }
    table(&mut out, "parameters", &findings.params, paintbox);
    table(&mut out, "canvas", &findings.canvas, paintbox);
    if findings.order_changed {
        line(&mut out, "\npaints lie on each other in another order");
    }
    for change in findings.paints.iter().filter(|change| change.change != Fate::Same) {
        paint(&mut out, change, paintbox);
    }
    let same = findings.paints.iter().filter(|change| change.change == Fate::Same).count();
    if same > 0 && !findings.same && same < findings.paints.len() {
        let text =
            if same == 1 { "1 other is as it was".to_owned() } else { format!("{same} others are as they were") };
        line(&mut out, &format!("\n{}", paintbox.faint(&text)));
    }
    for note in &findings.notes {
        line(&mut out, &paintbox.faint(&format!("note: {}", printable(note))));
    }
    out
}

/// The whole in one sentence.
pub(super) fn verdict(findings: &Findings) -> String {
    let (old, new) = (&findings.old, &findings.new);
    let is_faulty = |side: &Summary| side.exists && side.fingerprint.is_none() && !side.draws_nothing;
    match (is_faulty(old), is_faulty(new)) {
        (true, true) => return "neither scene compiles".to_owned(),
        (true, false) => return format!("the old scene does not compile; the new one {}", has(new)),
        (false, true) => return format!("the new scene does not compile; the old one {}", has(old)),
        (false, false) => {}
    }
    if findings.draws_nothing() {
        return library(findings);
    }
    if old.draws_nothing || new.draws_nothing {
        return format!("the old scene {}; the new one {}", has(old), has(new));
    }
    match (old.exists, new.exists) {
        (false, true) => return format!("the scene is new: {}", sum(new)),
        (true, false) => return format!("the scene went: {}", sum(old)),
        (false, false) => return "there is neither scene".to_owned(),
        (true, true) => {}
    }
    if findings.same {
        return if findings.text_changed {
            "the pictures are the same: only the text changed"
        } else {
            "nothing changed"
        }
        .to_owned();
    }
    match &findings.pixels {
        Some(pixels) if pixels.changed == 0 => {
            format!("the drawings differ, but at {} dpi no pixel does that can be seen", significant(pixels.dpi, 4))
        }
        Some(pixels) => format!("the pictures differ: {} of the pixels", percent(pixels.share)),
        None => "the pictures differ".to_owned(),
    }
}

/// The whole of files that draw nothing by themselves in one sentence.
fn library(findings: &Findings) -> String {
    let count = |fate: Fate| findings.declared.iter().filter(|change| change.change == fate).count();
    let tones = findings.declared.iter().filter(|change| change.kind == "tone").count();
    let tones_of = || if tones == 1 { "1 tone".to_owned() } else { format!("{tones} tones") };
    match (findings.old.exists, findings.new.exists) {
        (false, _) => return format!("the file is new: {}", tones_of()),
        (_, false) => return format!("the file went: {}", tones_of()),
        (true, true) => {}
    }
    if findings.same {
        let same = "what it declares is the same: only the text changed";
        return if findings.text_changed { same } else { "nothing changed" }.to_owned();
    }
    let counts = [(Fate::Changed, "changed"), (Fate::Came, "came"), (Fate::Went, "went")];
    let counts = counts.map(|(fate, word)| (count(fate), word));
    let counts: Vec<String> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}")).collect();
    let what = if tones == findings.declared.len() { "the tones differ" } else { "what it declares differs" };
    format!("{what}: {}", counts.join(", "))
}

/// What became of a declaration.
fn declared(out: &mut String, change: &Declared, paintbox: Paintbox) {
    let name =
        if change.name.is_empty() { change.kind.to_owned() } else { format!("{} `{}`", change.kind, change.name) };
    let name = printable(&name);
    let head = match change.change {
        Fate::Came => paintbox.new_one(&format!("{name} came")),
        Fate::Went => paintbox.old(&format!("{name} went")),
        Fate::Same | Fate::Changed | Fate::Renamed => format!("{}: changed", paintbox.strong(&name)),
    };
    line(out, &format!("\n{head}{}", documented(change.doc.as_deref(), paintbox)));
    let width = change.parts.iter().map(|part| part.name.chars().count()).max().unwrap_or(0).max(10);
    for part in &change.parts {
        let gap = " ".repeat(width - part.name.chars().count());
        let [old, new] = [&part.old, &part.new].map(|side| side.as_deref().map(printable));
        let text = match (old, new) {
            (Some(old), Some(new)) if old.chars().count() + new.chars().count() > WIDTH => "changed".to_owned(),
            (Some(old), Some(new)) => format!("{} → {}", paintbox.old(&old), paintbox.new_one(&new)),
            (Some(old), None) => paintbox.old(&format!("{} went", clipped(&old))),
            // All of what came did.
            (None, Some(new)) if change.change == Fate::Came => paintbox.new_one(&clipped(&new)),
            (None, Some(new)) => paintbox.new_one(&format!("{} came", clipped(&new))),
            (None, None) => String::new(),
        };
        let name = printable(&part.name);
        line(out, &format!("  {name}{gap} {text}{}", documented(part.doc.as_deref(), paintbox)));
    }
}

/// The first line of a doc comment, behind what it belongs to.
fn documented(doc: Option<&str>, paintbox: Paintbox) -> String {
    let first = doc.and_then(|doc| doc.lines().next()).map(str::trim).filter(|line| !line.is_empty());
    first.map(|line| paintbox.faint(&format!("  {}", clipped(&printable(line))))).unwrap_or_default()
}

/// A text that is not too long for a line.
fn clipped(text: &str) -> String {
    if text.chars().count() <= WIDTH { text.to_owned() } else { text.chars().take(WIDTH).chain(['…']).collect() }
}

fn has(side: &Summary) -> String {
    if side.draws_nothing { "draws nothing by itself".to_owned() } else { format!("has {}", sum(side)) }
}

fn sum(side: &Summary) -> String {
    let paints = if side.paints == 1 { "1 paint".to_owned() } else { format!("{} paints", side.paints) };
    let (tiles, marks) = (grouped(side.tiles as u64), grouped(side.marks));
    format!("{paints}, {tiles} tiles placed, {marks} marks, {} drawn", metres(side.drawn))
}

fn paint(out: &mut String, change: &PaintChange, paintbox: Paintbox) {
    let name = printable(&change.paint);
    let head = match (change.change, &change.was) {
        (Fate::Came, _) => paintbox.new_one(&format!("{name} came")),
        (Fate::Went, _) => paintbox.old(&format!("{name} went")),
        (_, Some(was)) => format!("{} (was {})", paintbox.strong(&name), paintbox.old(&printable(was))),
        (Fate::Same | Fate::Changed | Fate::Renamed, None) => paintbox.strong(&name),
    };
    line(out, &format!("\n{head}"));
    if let Some(shift) = &change.tiles {
        line(out, &format!("  {:<11}{}", "tiles", shifted(shift, paintbox)));
    }
    let [old, new] = change.marks;
    if old != new {
        row(out, "marks", &grouped(old), &grouped(new), paintbox);
    }
    let [old, new] = change.drawn.map(metres);
    if old != new {
        row(out, "drawn", &old, &new, paintbox);
    }
    for look in &change.look {
        row(out, &look.name, value(look.old.as_deref()), value(look.new.as_deref()), paintbox);
    }
    let (chief, others) = change.measures();
    measures(out, &chief, paintbox);
    let many = |count: usize| if count == 1 { "measure" } else { "measures" };
    match (chief.len(), others.len()) {
        (_, 0) => {}
        (0, count) => {
            line(out, &paintbox.faint(&format!("  {count} {} changed; `--format json` has them", many(count))))
        }
        (_, count) => {
            line(
                out,
                &paintbox.faint(&format!("  … and {count} more {} changed; `--format json` has them", many(count))),
            );
        }
    }
}

fn row(out: &mut String, name: &str, old: &str, new: &str, paintbox: Paintbox) {
    line(out, &format!("  {name:<10} {} → {}", paintbox.old(old), paintbox.new_one(new)));
}

/// What became of tiles, in the order in which one asks.
pub(super) fn shifted(shift: &Shift, paintbox: Paintbox) -> String {
    let mut parts = Vec::new();
    let mut part = |count: usize, text: String| parts.extend((count > 0).then_some(text));
    let count = |count: usize| grouped(count as u64);
    if shift.is_anew() {
        let [old, new] = [shift.went, shift.came].map(|only| count(shift.moved + only));
        return format!("placed anew: {} → {}", paintbox.old(&old), paintbox.new_one(&new));
    }
    if shift.moved + shift.went + shift.came == 0 {
        part(shift.stayed, format!("all {} stayed", count(shift.stayed)));
    } else {
        part(shift.stayed, format!("{} stayed", count(shift.stayed)));
    }
    let [median, most] = [shift.median, shift.most].map(hundredths);
    part(
        shift.moved,
        match shift.moved {
            1 => format!("1 moved by {most}"),
            moved => format!("{} moved by {median} (median), {most} at most", count(moved)),
        },
    );
    part(shift.went, paintbox.old(&format!("{} went", count(shift.went))));
    part(shift.came, paintbox.new_one(&format!("{} came", count(shift.came))));
    part(shift.turned, format!("{} turned", count(shift.turned)));
    part(shift.layers, format!("{} changed layers", count(shift.layers)));
    if parts.is_empty() { "none".to_owned() } else { parts.join(" · ") }
}

/// The measures, as many on a line as there is room for.
fn measures(out: &mut String, metrics: &[&Measure], paintbox: Paintbox) {
    let cells: Vec<[String; 3]> = metrics
        .iter()
        .map(|measure| {
            let [old, new] = short(measure);
            [called(&measure.name).to_owned(), old, new]
        })
        .collect();
    let widths = [0, 1, 2].map(|i| cells.iter().map(|cell| cell[i].chars().count()).max().unwrap_or(0));
    let each = widths[0].max(10) + widths[1] + widths[2] + 7;
    for cells in cells.chunks((WIDTH / each.max(1)).max(1)) {
        let cells = cells.iter().map(|[name, old, new]| {
            let gap = |text: &str, width: usize| " ".repeat(width.saturating_sub(text.chars().count()));
            let name_gap = gap(name, widths[0].max(10));
            format!(
                "  {name}{name_gap} {}{} → {}{}",
                gap(old, widths[1]),
                paintbox.old(old),
                paintbox.new_one(new),
                gap(new, widths[2])
            )
        });
        line(out, cells.collect::<Vec<_>>().join(" ").trim_end());
    }
}

/// What words call a measure: the tiles that are measured are fewer than those that are placed.
pub(super) fn called(measure: &str) -> &str {
    if measure == "tiles" { "tiles inside" } else { measure }
}

/// Both values of a measure, with as many digits as it takes to see that they differ.
pub(super) fn short(measure: &Measure) -> [String; 2] {
    let [old, new] = [measure.old, measure.new];
    let show =
        |count: usize| [old, new].map(|value| value.map_or_else(|| "–".to_owned(), |value| significant(value, count)));
    let four = show(4);
    if four[0] == four[1] { [old, new].map(|value| value.map_or_else(|| "–".to_owned(), digits)) } else { four }
}

fn table(out: &mut String, title: &str, changes: &[Change], paintbox: Paintbox) {
    if changes.is_empty() {
        return;
    }
    line(out, &format!("\n{}", paintbox.strong(title)));
    let width = changes.iter().map(|change| change.name.chars().count()).max().unwrap_or(0).max(10);
    for change in changes {
        let gap = " ".repeat(width - change.name.chars().count());
        let name = printable(&change.name);
        let [old, new] = [&change.old, &change.new].map(|side| side.as_deref().map(printable));
        let text = match (old, new) {
            (Some(old), Some(new)) => format!("{} → {}", paintbox.old(&old), paintbox.new_one(&new)),
            (Some(old), None) => paintbox.old(&format!("{old} went")),
            (None, Some(new)) => paintbox.new_one(&format!("{new} came")),
            (None, None) => String::new(),
        };
        line(out, &format!("  {name}{gap} {text}"));
    }
}

fn value(text: Option<&str>) -> &str {
    text.unwrap_or("none")
}

fn line(out: &mut String, text: &str) {
    // Memory takes all that is written.
    let _ = writeln!(out, "{text}");
}

/// A text on one line and without what would steer a terminal.
pub(super) fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// A share as a percentage, never rounded to none or all.
pub(super) fn percent(share: f64) -> String {
    let text = significant(share * 100.0, 2);
    match share {
        share if share > 0.0 && share < 1e-5 => "less than 0.001 %".to_owned(),
        share if share < 1.0 && text == "100" => "more than 99.5 %".to_owned(),
        _ => format!("{text} %"),
    }
}

/// A length that may be long.
pub(super) fn metres(length: Length) -> String {
    let mm = length.to_mm();
    if mm < 1000.0 { format!("{mm:.1} mm") } else { format!("{:.2} m", mm / 1000.0) }
}

/// A short way, to a hundredth of a millimetre, or to a thousandth where it is less.
fn hundredths(length: Length) -> String {
    let mm = length.to_mm();
    if mm < 0.005 { millimetres(length) } else { format!("{mm:.2}mm") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_say_no_more_than_is_so() {
        for (share, text) in [
            (0.0, "0 %"),
            (0.034, "3.4 %"),
            (1e-9, "less than 0.001 %"),
            (0.99999, "more than 99.5 %"),
            (1.0, "100 %"),
            (0.5, "50 %"),
        ] {
            assert_eq!(percent(share), text);
        }
    }

    #[test]
    fn measures_have_the_digits_they_need() {
        let measure = |old, new| short(&Measure { name: String::new(), old, new });
        assert_eq!(measure(Some(0.123_45), Some(0.2)), ["0.1235", "0.2"]);
        assert_eq!(measure(Some(0.123_451), Some(0.123_458)), ["0.123451", "0.123458"]);
        assert_eq!(measure(None, Some(2.0)), ["–", "2"]);
    }

    #[test]
    fn tiles_are_told_of_in_one_line() {
        let shift = Shift { stayed: 1200, turned: 3, ..Shift::default() };
        assert_eq!(shifted(&shift, Paintbox::Plain), "all 1,200 stayed · 3 turned");
        let (median, most) = (Length::mm(0.25), Length::mm(1.5));
        let shift = Shift { stayed: 7, moved: 2, median, most, went: 1, came: 4, layers: 0, turned: 0 };
        assert_eq!(
            shifted(&shift, Paintbox::Plain),
            "7 stayed · 2 moved by 0.25mm (median), 1.50mm at most · 1 went · 4 came"
        );
        assert_eq!(shifted(&Shift::default(), Paintbox::Plain), "none");
        let shift = Shift { moved: 37, went: 94, came: 55, turned: 35, ..Shift::default() };
        assert_eq!(shifted(&shift, Paintbox::Plain), "placed anew: 131 → 92");
    }

    #[test]
    fn nothing_steers_the_terminal() {
        assert_eq!(printable("a\x1b[31m\nb"), "a\u{fffd}[31m\u{fffd}b");
    }
}
