//! A difference as a page that stands alone: the old and the new picture under a slider, what went and came beside them,
//! and the words.

use std::io;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::back::{png, svg};
use crate::compare::{Difference, common};
use crate::diag::grouped;
use crate::drawing::{Drawing, Layer, Page};
use crate::geom::Length;

use super::findings::{Change, Fate, Findings, PaintChange, Summary};
use super::output::Sheets;
use super::words::{Paintbox, called, metres, shifted, short, verdict};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Pictures of more marks are shown as pixels.
const MOST_MARKS: u64 = 40_000;

/// The page.
pub(super) fn page(findings: &Findings, sheets: &mut Sheets, difference: &Difference) -> io::Result<String> {
    let pictures = pictures(sheets)?;
    let seen = url("image/png", &png::encode(&difference.picture).map_err(io::Error::other)?);
    let sheet = common(&sheets.old.page, &sheets.new.page);
    let names = [&findings.old.name, &findings.new.name];
    let title = format!("{} → {}", names[0], names[1]);
    // Only what is in the page itself is loaded or run.
    let policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main {
                    header {
                        h1 { (capital(&verdict(findings))) }
                        p { span.old { (names[0]) } " → " span.new { (names[1]) } }
                    }
                    section aria-labelledby="both" {
                        h2 #both { "Old and new" }
                        (slider(&pictures, [&sheets.old, &sheets.new].map(|drawing| &drawing.page), &sheet))
                    }
                    section aria-labelledby="changes" {
                        h2 #changes { "What went and what came" }
                        p.key { span.went { "went" } " " span.came { "came" } " " span.stayed { "stayed" } }
                        figure.sheet style=(ratio(&sheet)) { img src=(seen) alt="What went in red, what came in blue, what stayed in grey"; }
                    }
                    section aria-labelledby="words" {
                        h2 #words { "In words" }
                        (table("Parameters", &findings.params))
                        (table("Canvas", &findings.canvas))
                        @if findings.order_changed { p { "Paints lie on each other in another order." } }
                        @for change in findings.paints.iter().filter(|change| change.change != Fate::Same) { (paint(change)) }
                        (sums(&findings.old, &findings.new))
                        @for note in &findings.notes { p.note { (note) } }
                    }
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    Ok(page.into_string())
}

/// The new picture over the old one, each shown on its side of the slider.
fn slider(pictures: &[String; 2], pages: [&Page; 2], sheet: &Page) -> Markup {
    let percent = |length: Length, of: Length| format!("{:.3}%", length.to_mm() / of.to_mm() * 100.0);
    let place = |page: &Page| {
        format!("width:{};height:{}", percent(page.width, sheet.width), percent(page.height, sheet.height))
    };
    html! {
        div.slider {
            figure.sheet.pair style=(ratio(sheet)) {
                div.side { img style=(place(pages[0])) src=(pictures[0]) alt="The old picture"; }
                div.side.over { img style=(place(pages[1])) src=(pictures[1]) alt="The new picture"; }
                div.edge {}
            }
            label.bar {
                span.old { "old" }
                input #slide type="range" min="0" max="100" value="50" step="0.5" aria-label="How much of the old picture is shown";
                span.new { "new" }
            }
            p.hint { "Drag on the picture, or use the arrow keys on the slider." }
        }
    }
}

/// How wide a sheet is for its height: both pictures of it have one size.
fn ratio(sheet: &Page) -> String {
    format!("--ratio:{}", sheet.width.to_mm() / sheet.height.to_mm())
}

/// A sentence as it begins a page.
fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map(|first| first.to_uppercase().chain(characters).collect()).unwrap_or_default()
}

/// Both pictures as URLs: vectors where they are small enough for a browser, pixels otherwise.
fn pictures(sheets: &mut Sheets) -> io::Result<[String; 2]> {
    let all = |drawing: &Drawing| drawing.layers.iter().map(Layer::marks).sum::<u64>();
    if all(&sheets.old).max(all(&sheets.new)) > MOST_MARKS {
        return Ok(sheets.previews()?.map(|bytes| url("image/png", &bytes)));
    }
    let vectors = |drawing: &Drawing| {
        let mut bytes = Vec::new();
        svg::write(drawing, None, &mut bytes).map(|()| url("image/svg+xml", &bytes))
    };
    Ok([vectors(&sheets.old)?, vectors(&sheets.new)?])
}

fn url(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
}

fn table(title: &str, changes: &[Change]) -> Markup {
    let value = |value: &Option<String>| value.clone().unwrap_or_else(|| "–".to_owned());
    html! {
        @if !changes.is_empty() {
            h3 { (title) }
            div.wide {
                table {
                    thead { tr { th scope="col" { "name" } th scope="col" { "old" } th scope="col" { "new" } } }
                    tbody {
                        @for change in changes {
                            tr { th scope="row" { (change.name) } td.old { (value(&change.old)) } td.new { (value(&change.new)) } }
                        }
                    }
                }
            }
        }
    }
}

fn paint(change: &PaintChange) -> Markup {
    let head = match (change.change, &change.was) {
        (Fate::Came, _) => format!("{} came", change.paint),
        (Fate::Went, _) => format!("{} went", change.paint),
        (_, Some(was)) => format!("{} (was {was})", change.paint),
        (Fate::Same | Fate::Changed | Fate::Renamed, None) => change.paint.clone(),
    };
    let mut rows: Vec<[String; 3]> = Vec::new();
    let mut row = |name: &str, [old, new]: [String; 2]| rows.extend((old != new).then(|| [name.to_owned(), old, new]));
    row("marks", change.marks.map(grouped));
    row("drawn", change.drawn.map(metres));
    for look in &change.look {
        row(&look.name, [&look.old, &look.new].map(|value| value.clone().unwrap_or_else(|| "none".to_owned())));
    }
    let (chief, others) = change.measures();
    for measure in chief {
        row(called(&measure.name), short(measure));
    }
    let others: Vec<[String; 3]> = others
        .into_iter()
        .map(|measure| {
            let [old, new] = short(measure);
            [called(&measure.name).to_owned(), old, new]
        })
        .collect();
    html! {
        h3 { (head) }
        @if let Some(shift) = &change.tiles { p { "Tiles: " (shifted(shift, Paintbox::Plain)) "." } }
        @if !rows.is_empty() { (values(&rows)) }
        @if !others.is_empty() {
            details {
                summary { (others.len()) (if rows.is_empty() { " " } else { " more " }) (if others.len() == 1 { "measure" } else { "measures" }) " changed" }
                (values(&others))
            }
        }
    }
}

/// Names with an old and a new value.
fn values(rows: &[[String; 3]]) -> Markup {
    html! {
        div.wide {
            table {
                thead { tr { th scope="col" { "" } th scope="col" { "old" } th scope="col" { "new" } } }
                tbody { @for [name, old, new] in rows { tr { th scope="row" { (name) } td.old { (old) } td.new { (new) } } } }
            }
        }
    }
}

/// Both sides as a whole.
fn sums(old: &Summary, new: &Summary) -> Markup {
    // Twelve digits tell any two pictures apart; the whole is shown under the pointer.
    let print = |side: &Summary| side.fingerprint.clone().unwrap_or_else(|| "–".to_owned());
    let beginning = |print: &str| print.chars().take("sha256:".len() + 12).collect::<String>();
    let prints = [old, new].map(print);
    let rows = [
        ("paints", [old, new].map(|side| side.paints.to_string())),
        ("tiles placed", [old, new].map(|side| grouped(side.tiles as u64))),
        ("marks", [old, new].map(|side| grouped(side.marks))),
        ("drawn", [old, new].map(|side| metres(side.drawn))),
    ];
    html! {
        h3 { "The whole" }
        div.wide {
            table {
                thead { tr { th scope="col" { "" } th scope="col" { "old" } th scope="col" { "new" } } }
                tbody {
                    @for (name, [old, new]) in rows { tr { th scope="row" { (name) } td.old { (old) } td.new { (new) } } }
                    tr {
                        th scope="row" { "fingerprint" }
                        td.old title=(prints[0]) { (beginning(&prints[0])) }
                        td.new title=(prints[1]) { (beginning(&prints[1])) }
                    }
                }
            }
        }
    }
}
