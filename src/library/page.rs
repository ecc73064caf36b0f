//! Reviews as one HTML page that needs nothing else: pictures are within it, and there are no scripts.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::review::{Outcome, Review, Swatch};

/// The style of the page.
const STYLE: &str = include_str!("review.css");

/// The page. What is to be judged comes first.
#[must_use]
pub fn write(reviews: &[Review]) -> String {
    let titles: Vec<&str> = reviews.iter().map(|review| review.title.as_str()).collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content={ "kake " (env!("CARGO_PKG_VERSION")) };
                meta name="color-scheme" content="light dark";
                title { "Review – " (titles.join(", ")) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main {
                    @for review in reviews { (library(review)) }
                }
            }
        }
    };
    page.into_string()
}

fn library(review: &Review) -> Markup {
    let same: Vec<&Swatch> = review.swatches.iter().filter(|swatch| swatch.outcome == Outcome::Same).collect();
    html! {
        header {
            h1 { (review.title) }
            p { (review.summary()) "." }
            @if review.is_same() {
                p.hint { "Every swatch looks as it was pinned." }
            } @else if review.is_acceptable() {
                p.hint { code { "kake test --accept" } " pins what is there now." }
            }
        }
        @for fault in &review.faults {
            p.fault role="alert" { (fault) }
        }
        @for swatch in review.to_review() { (section(swatch)) }
        @if !same.is_empty() {
            section.same {
                h2 { "Same as pinned" }
                ul {
                    @for swatch in &same {
                        li {
                            @if let Some(picture) = &swatch.pictures.new { (image(picture, &swatch.name)) }
                            span { (swatch.name) }
                        }
                    }
                }
            }
        }
    }
}

fn section(swatch: &Swatch) -> Markup {
    let or_none = |value: &Option<String>| value.clone().unwrap_or_else(|| "–".to_owned());
    html! {
        section {
            h2 {
                span.outcome.(swatch.outcome.word()) { (swatch.outcome.word()) }
                " " (swatch.name)
            }
            p { (swatch.outcome.sentence()) " " span.file { (swatch.file) } }
            @if swatch.pictures.named().next().is_some() {
                div.pictures {
                    @for (kind, picture) in swatch.pictures.named() {
                        figure {
                            (image(picture, &format!("{}, {kind}", swatch.name)))
                            figcaption {
                                (kind)
                                @if kind == "difference" {
                                    span.key { " – " span.went { "went" } " " span.came { "came" } " " span.stayed { "stayed" } }
                                }
                            }
                        }
                    }
                }
            }
            @if !swatch.changes.is_empty() {
                div.figures tabindex="0" role="region" aria-label={ "Figures of " (swatch.name) } {
                    table {
                        thead { tr { th scope="col" { "figure" } th scope="col" { "old" } th scope="col" { "new" } } }
                        tbody {
                            @for change in &swatch.changes {
                                tr {
                                    th scope="row" { (change.what) }
                                    td { (or_none(&change.old)) }
                                    td { (or_none(&change.new)) }
                                }
                            }
                        }
                    }
                }
            }
            @if !swatch.said.is_empty() {
                pre tabindex="0" { (swatch.said.trim_end()) }
            }
        }
    }
}

fn image(png: &[u8], words: &str) -> Markup {
    html! { img src={ "data:image/png;base64," (BASE64.encode(png)) } alt=(words); }
}
