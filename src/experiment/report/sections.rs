//! What an experiment was, and its summary.

use maud::{Markup, html};

use super::Measure;
use super::words::{Goal, description, fixed, places};
use crate::experiment::{Outcome, Recipe, command};

/// Bytes of a file that are shown; what is longer is no scene that anybody wrote.
const LONGEST: usize = 200_000;

/// The title, and how large the experiment is.
pub(super) fn head(recipe: &Recipe, outcome: &Outcome) -> Markup {
    let plan = &outcome.plan;
    let design = plan.design().count();
    let references = plan.conditions.len() - design;
    let [first, last] = plan.seeds;
    html! {
        h1 id="top" { (plan.name) }
        p.soft {
            "An experiment with " code { (recipe.scene) } ": "
            (counted(design, "condition")) " of the design"
            @if references > 0 { " and " (counted(references, "reference")) }
            ", each with " (counted(plan.seed_count(), "seed")) " (" (first) " to " (last) "), so "
            (counted(plan.runs(), "run")) "."
        }
        @if !outcome.failures.is_empty() {
            p.note {
                (counted(outcome.failures.len(), "run")) " of " (plan.runs()) " could not be done; "
                a href="#notes" { "the notes" } " say why."
            }
        }
        div.scroll {
            table {
                thead { tr { th { "Factor" } th.name { "Levels" } } }
                tbody {
                    @for factor in &plan.factors {
                        tr { th { code { (factor.param) } } td.name { (factor.levels.join(", ")) } }
                    }
                }
            }
        }
    }
}

/// A number with its noun.
pub(super) fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Mean and standard deviation of each measure in each condition.
pub(super) fn summary(outcome: &Outcome, measures: &[&Measure<'_>]) -> Markup {
    let plan = &outcome.plan;
    html! {
        div.scroll.sticky {
            table {
                thead {
                    tr {
                        th { "Measure" }
                        @for condition in &plan.conditions {
                            th { (condition.name) @if condition.levels.is_none() { " *" } }
                        }
                    }
                }
                tbody {
                    @for measure in measures {
                        (row(measure))
                    }
                }
            }
        }
    }
}

fn row(measure: &Measure<'_>) -> Markup {
    let summaries = &measure.analysis.summaries;
    let means: Vec<f64> = summaries.iter().flatten().map(|summary| summary.mean).collect();
    let sds: Vec<f64> = summaries.iter().flatten().filter_map(|summary| summary.sd).collect();
    let places = places(&means, &sds);
    let goal = Goal::of(measure.name);
    let mut losses: Vec<f64> = goal.iter().flat_map(|goal| means.iter().map(|&mean| goal.loss(mean))).collect();
    losses.sort_by(f64::total_cmp);
    losses.dedup();
    let class = |mean: f64| {
        let loss = goal.map(|goal| goal.loss(mean));
        // Where all are alike none is better.
        match loss.and_then(|loss| losses.iter().position(|&other| other == loss)) {
            Some(0) if losses.len() > 1 => Some("best"),
            Some(1) if losses.len() > 2 => Some("second"),
            _ => None,
        }
    };
    let title = [description(measure.name), goal.map_or("", Goal::words)];
    let title: Vec<&str> = title.into_iter().filter(|words| !words.is_empty()).collect();
    html! {
        tr {
            th title=(title.join("; ")) { code { (measure.name) } }
            @for summary in summaries {
                @match summary {
                    Some(summary) => {
                        td class=[class(summary.mean)] {
                            (fixed(summary.mean, places))
                            @if let Some(sd) = summary.sd { " ± " (fixed(sd, places)) }
                        }
                    }
                    None => td { "–" },
                }
            }
        }
    }
}

/// How all of it can be made again.
pub(super) fn made(recipe: &Recipe, outcome: &Outcome) -> Markup {
    let text = |path: &str| {
        let bytes = &recipe.files.get(path)?.0;
        std::str::from_utf8(bytes).ok().filter(|text| text.len() <= LONGEST)
    };
    let others = || recipe.files.iter().filter(|(path, _)| **path != recipe.scene);
    let set = || recipe.sets.iter().map(|(name, value)| format!("{name} = {value}"));
    html! {
        h2 id="made" { "How it was made" }
        p { "By kake " (recipe.version) ", in a folder that holds the scene:" }
        pre.command { (command(recipe)) }
        p {
            "The tables behind this page lie beside it: " code { "runs.csv" } " and " code { "runs.parquet" }
            " with a row for each run, " code { "summary.csv" } ", " code { "anova.csv" } ", "
            code { "assumptions.csv" } ", " code { "cohen_d.csv" } " and " code { "tukey.csv" }
            "; the charts are in " code { "figures" } ", the pictures in " code { "images" }
            ". Every random draw follows from the seeds: the same command gives the same files."
        }
        @if set().next().is_some() {
            p { "Every run sets " code { (set().collect::<Vec<_>>().join(", ")) } "." }
        }
        div.scroll {
            table {
                thead { tr { th { "Condition" } th.name { "Sets" } th { "Runs" } th { "Shown by seed" } } }
                tbody {
                    @for (number, condition) in outcome.plan.conditions.iter().enumerate() {
                        tr {
                            th { (condition.name) @if condition.levels.is_none() { " *" } }
                            td.name {
                                @for (i, set) in condition.sets.iter().enumerate() {
                                    @if i > 0 { ", " }
                                    code { (set.param) " = " (set.expression) }
                                }
                            }
                            td { (done(outcome, number)) }
                            td {
                                @match outcome.representatives.get(number).copied().flatten() {
                                    Some(seed) => (seed),
                                    None => "–",
                                }
                            }
                        }
                    }
                }
            }
        }
        h3 { "The scene" }
        @if let Some(text) = text(&recipe.scene) {
            pre { (text) }
        }
        @for (path, bytes) in others() {
            @match text(path) {
                Some(text) => details { summary { code { (path) } } pre { (text) } },
                None => p { code { (path) } ", " (counted(bytes.0.len(), "byte")) },
            }
        }
    }
}

/// How many runs of a condition were done.
fn done(outcome: &Outcome, condition: usize) -> usize {
    let failed = outcome.failures.iter().filter(|failure| failure.condition == condition).count();
    let seen = outcome.runs.iter().any(|run| run.condition == condition);
    if seen { outcome.plan.seed_count() - failed } else { 0 }
}
