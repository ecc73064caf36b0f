//! The report of an experiment: a page that needs nothing else to be read, and its charts.
//!
//! In: the outcome, how it was made and the pictures. Out: HTML with its style, charts and pictures in it, without scripts
//! and without a word that another run would not write; and every chart as an SVG of its own. Nothing here touches a file.

mod figures;
mod pictures;
mod sections;
mod statistics;
mod words;

#[cfg(test)]
mod tests;

use maud::{DOCTYPE, Markup, PreEscaped, html};

pub use figures::Figure;

use super::{Analysis, Outcome, Picture, Recipe};
use words::{Goal, distance};

/// The style of the page.
const STYLE: &str = include_str!("style.css");

/// Distances of the correlogram beyond this are looked up, and do not stand between the other measures.
const NEAR: u32 = 3;

/// A report.
#[derive(Debug, Clone)]
pub struct Report {
    /// The page.
    pub html: String,
    /// Its charts.
    pub figures: Vec<Figure>,
}

/// Writes the report of an experiment.
#[must_use]
pub fn report(recipe: &Recipe, outcome: &Outcome, pictures: &[Picture]) -> Report {
    let paints: Vec<Charts> = (0..outcome.paints.len()).map(|paint| Charts::new(outcome, paint)).collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content={ "kake " (recipe.version) };
                title { (outcome.plan.name) " – experiment with " (recipe.scene) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (contents(outcome, &paints))
                main {
                    (sections::head(recipe, outcome))
                    @for charts in &paints {
                        (paint(outcome, charts))
                    }
                    (pictures::section(outcome, pictures))
                    (statistics::notes(outcome))
                    (sections::made(recipe, outcome))
                }
            }
        }
    };
    let figures = paints.into_iter().flat_map(|charts| {
        let measures =
            charts.measures.into_iter().flat_map(|of| of.boxes.into_iter().chain(of.effects).chain(of.cohen));
        charts.correlograms.into_iter().chain(measures).collect::<Vec<_>>()
    });
    Report { html: page.into_string(), figures: figures.collect() }
}

/// The charts of a paint.
struct Charts<'a> {
    paint: usize,
    correlograms: Vec<Figure>,
    measures: Vec<Measure<'a>>,
}

/// The statistics of a measure with its charts.
struct Measure<'a> {
    name: &'a str,
    analysis: &'a Analysis,
    boxes: Option<Figure>,
    effects: Vec<Figure>,
    cohen: Option<Figure>,
}

impl<'a> Charts<'a> {
    fn new(outcome: &'a Outcome, paint: usize) -> Self {
        let of_paint = outcome.analyses.iter().filter(|analysis| analysis.paint == paint);
        let measures = of_paint.map(|analysis| Measure {
            name: &outcome.measures[analysis.measure],
            analysis,
            boxes: Some(figures::boxes(outcome, analysis)),
            effects: figures::effects(outcome, analysis),
            cohen: figures::cohen(outcome, analysis),
        });
        Self { paint, correlograms: figures::correlograms(outcome, paint), measures: measures.collect() }
    }

    /// The measures in the order of the page: those far out on the correlogram last, and apart.
    fn parts(&self) -> [Vec<&Measure<'a>>; 2] {
        let is_far = |measure: &&Measure<'a>| distance(measure.name).is_some_and(|k| k > NEAR);
        let (far, near) = self.measures.iter().partition(is_far);
        [near, far]
    }
}

/// The place of a section on the page; the paint's number stands in it where there are several.
fn anchor(outcome: &Outcome, paint: usize, name: &str) -> String {
    if outcome.paints.len() > 1 { format!("p{}-{name}", paint + 1) } else { name.to_owned() }
}

fn contents(outcome: &Outcome, paints: &[Charts<'_>]) -> Markup {
    let link = |paint: usize, name: &str, words: &str| {
        html! { li { a href={ "#" (anchor(outcome, paint, name)) } { (words) } } }
    };
    html! {
        nav aria-label="Contents" {
            ol {
                li { a href="#top" { "Overview" } }
                @for charts in paints {
                    @if outcome.paints.len() > 1 {
                        (link(charts.paint, "paint", &format!("Paint {}", outcome.paints[charts.paint])))
                    }
                    (link(charts.paint, "summary", "Summary"))
                    @if !charts.correlograms.is_empty() {
                        (link(charts.paint, "correlogram", "Correlogram"))
                    }
                    li {
                        a href={ "#" (anchor(outcome, charts.paint, "measures")) } { "Measures" }
                        ol {
                            @for measure in &charts.parts()[0] {
                                (link(charts.paint, &format!("m-{}", measure.name), measure.name))
                            }
                        }
                    }
                }
                li { a href="#pictures" { "Pictures" } }
                li { a href="#notes" { "Notes" } }
                li { a href="#made" { "How it was made" } }
            }
        }
    }
}

fn paint(outcome: &Outcome, charts: &Charts<'_>) -> Markup {
    let at = |name: &str| anchor(outcome, charts.paint, name);
    let [near, far] = charts.parts();
    // One is open, to show what the others hold.
    let open = near.iter().position(|measure| Goal::of(measure.name).is_some()).unwrap_or(0);
    html! {
        @if outcome.paints.len() > 1 {
            h2 id=(at("paint")) { "Paint " code { (outcome.paints[charts.paint]) } }
        }
        h2 id=(at("summary")) { "Summary" }
        p.soft {
            "Mean ± standard deviation over the seeds. "
            span.key.best { "Best" } " and " span.key.second { "second best" }
            " condition where a measure has a better and a worse. * stands outside the design."
        }
        (sections::summary(outcome, &near))
        @if !far.is_empty() {
            details { summary { "The correlogram beyond distance " (NEAR) } (sections::summary(outcome, &far)) }
        }
        @if !charts.correlograms.is_empty() {
            h2 id=(at("correlogram")) { "Correlogram" }
            (shown(&charts.correlograms))
        }
        h2 id=(at("measures")) { "Measures" }
        @for (i, measure) in near.iter().enumerate() {
            (statistics::measure(outcome, measure, &at(&format!("m-{}", measure.name)), i == open))
        }
        @if !far.is_empty() {
            details {
                summary { "The correlogram beyond distance " (NEAR) }
                @for measure in &far {
                    (statistics::measure(outcome, measure, &at(&format!("m-{}", measure.name)), false))
                }
            }
        }
    }
}

/// Charts side by side.
fn shown<'a>(figures: impl IntoIterator<Item = &'a Figure>) -> Markup {
    html! {
        div.charts {
            @for figure in figures {
                div.chart { (PreEscaped(&figure.svg)) }
            }
        }
    }
}
