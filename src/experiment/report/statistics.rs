//! The statistics of each measure, and what they could not say.

use std::collections::BTreeMap;

use maud::{Markup, html};

use super::figures::COMPARED;
use super::words::{Goal, description, digits, maybe, probability};
use super::{Measure, shown};
use crate::experiment::{ALPHA, Analysis, Outcome};

/// Pairs of conditions that a table shows; more are in the CSV files.
const MOST_PAIRS: usize = 200;

/// A measure with its charts and tables.
pub(super) fn measure(outcome: &Outcome, measure: &Measure<'_>, anchor: &str, is_open: bool) -> Markup {
    let analysis = measure.analysis;
    let goal = Goal::of(measure.name);
    html! {
        details id=(anchor) open[is_open] {
            summary {
                code { (measure.name) } " " (description(measure.name))
                @if let Some(goal) = goal { span.soft { " (" (goal.words()) ")" } }
            }
            (shown(measure.boxes.iter().chain(&measure.effects)))
            (anova(analysis))
            (assumptions(analysis))
            (pairs(analysis))
            @if let Some(figure) = &measure.cohen {
                (shown([figure]))
            }
            @if outcome.plan.design().count() > COMPARED && !analysis.cohen_d.is_empty() {
                p.soft { "Cohen's d of all pairs of conditions is in cohen_d.csv." }
            }
            @if outcome.plan.conditions.iter().any(|condition| condition.levels.is_none()) {
                p.soft { "References take no part in the analysis." }
            }
        }
    }
}

fn anova(analysis: &Analysis) -> Markup {
    html! {
        @if !analysis.anova.rows.is_empty() {
            div.scroll {
                table {
                    caption { "Analysis of variance (type II)" }
                    thead {
                        tr { th { "Source" } th { "SS" } th { "df" } th { "F" } th { "p" } th { "η²" } th { "ω²" } }
                    }
                    tbody {
                        @for row in &analysis.anova.rows {
                            tr {
                                th { (row.source.replace(':', " × ")) }
                                td { (digits(row.ss, 4)) }
                                td { (row.df) }
                                td { (maybe(row.f, |f| digits(f, 4))) }
                                td { (maybe(row.p, probability)) }
                                td { (maybe(row.eta2, |v| format!("{v:.4}"))) }
                                td { (maybe(row.omega2, |v| format!("{v:.4}"))) }
                            }
                        }
                    }
                }
            }
        }
        @if let Some(note) = &analysis.anova.note { p.note { (note) } }
    }
}

fn assumptions(analysis: &Analysis) -> Markup {
    let found = &analysis.assumptions;
    let holds = |p: Option<f64>| match p {
        Some(p) if p < ALPHA => "rejected",
        Some(_) => "not rejected",
        None => "–",
    };
    html! {
        @if found.shapiro_p.is_some() || found.levene_p.is_some() {
            div.scroll {
                table {
                    caption { "Assumptions, at " (ALPHA) }
                    thead { tr { th { "Test" } th { "Statistic" } th { "p" } th { "" } } }
                    tbody {
                        tr {
                            th { "Shapiro–Wilk: residuals are normal" }
                            td { (maybe(found.shapiro_w, |w| format!("W = {w:.4}"))) }
                            td { (maybe(found.shapiro_p, probability)) }
                            td.name { (holds(found.shapiro_p)) }
                        }
                        tr {
                            th { "Levene: spreads are equal" }
                            td { (maybe(found.levene_f, |f| format!("F = {}", digits(f, 4)))) }
                            td { (maybe(found.levene_p, probability)) }
                            td.name { (holds(found.levene_p)) }
                        }
                    }
                }
            }
        }
        @if let Some(note) = &found.note { p.note { (note) } }
    }
}

fn pairs(analysis: &Analysis) -> Markup {
    html! {
        @if !analysis.tukey.is_empty() {
            div.scroll {
                table {
                    caption { "Tukey's test of every pair, at " (ALPHA) " over all pairs; Δ is the second mean less the first" }
                    thead {
                        tr { th { "First" } th.name { "Second" } th { "Δ" } th { "from" } th { "to" } th { "p" } th { "" } }
                    }
                    tbody {
                        @for pair in analysis.tukey.iter().take(MOST_PAIRS) {
                            tr {
                                th { (pair.group1) }
                                td.name { (pair.group2) }
                                td { (digits(pair.meandiff, 4)) }
                                td { (maybe(pair.lower, |v| digits(v, 4))) }
                                td { (maybe(pair.upper, |v| digits(v, 4))) }
                                td { (maybe(pair.p_adj, probability)) }
                                td.name {
                                    @match pair.reject {
                                        Some(true) => b { "differ" },
                                        Some(false) => "may be equal",
                                        None => "–",
                                    }
                                }
                            }
                        }
                    }
                }
            }
            @if analysis.tukey.len() > MOST_PAIRS {
                p.note { "The first " (MOST_PAIRS) " of " (analysis.tukey.len()) " pairs; all are in tukey.csv." }
            }
        }
    }
}

/// What could not be said and why: runs that failed, values that are missing, tests that had nothing to test.
pub(super) fn notes(outcome: &Outcome) -> Markup {
    let plan = &outcome.plan;
    let mut failures: BTreeMap<(usize, &str), Vec<u64>> = BTreeMap::new();
    for failure in &outcome.failures {
        failures.entry((failure.condition, &failure.words)).or_default().push(failure.seed);
    }
    // What several measures have in common is said once.
    let mut said: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for analysis in &outcome.analyses {
        let notes: [Option<&str>; 2] = [analysis.anova.note.as_deref(), analysis.assumptions.note.as_deref()];
        for note in notes.into_iter().flatten() {
            let of = said.entry(note).or_default();
            let name = named(outcome, analysis);
            if !of.contains(&name) {
                of.push(name);
            }
        }
    }
    let missing = missing(outcome);
    html! {
        h2 id="notes" { "Notes" }
        @if failures.is_empty() && said.is_empty() && missing.is_empty() {
            p { "Every run was done, every measure could be said, and every test had data to work on." }
        }
        @for ((condition, words), seeds) in &failures {
            div.note {
                p { "The condition " b { (plan.conditions[*condition].name) } " lacks " (listed(seeds)) ":" }
                pre { (words) }
            }
        }
        @if !missing.is_empty() {
            h3 { "Values that cannot be said" }
            ul { @for words in &missing { li { (words) } } }
        }
        @if !said.is_empty() {
            h3 { "Statistics" }
            ul {
                @for (note, measures) in &said {
                    li { (note) ": " @for (i, name) in measures.iter().enumerate() { @if i > 0 { ", " } code { (name) } } }
                }
            }
        }
    }
}

/// A measure's name, with the paint's where there are several.
fn named(outcome: &Outcome, analysis: &Analysis) -> String {
    let measure = &outcome.measures[analysis.measure];
    let paint = &outcome.paints[analysis.paint];
    if outcome.paints.len() > 1 { format!("{measure} of {paint}") } else { measure.clone() }
}

/// Which measures lack values in which conditions.
fn missing(outcome: &Outcome) -> Vec<String> {
    let mut words = Vec::new();
    for analysis in &outcome.analyses {
        let lacks: Vec<String> = outcome
            .plan
            .conditions
            .iter()
            .enumerate()
            .filter_map(|(number, condition)| {
                let of = |run: &&crate::experiment::Run| run.condition == number && run.paint == analysis.paint;
                let runs = outcome.runs.iter().filter(of).count();
                let there = analysis.summaries[number].as_ref().map_or(0, |summary| summary.n);
                (there < runs).then(|| format!("{} of {runs} runs of {}", runs - there, condition.name))
            })
            .collect();
        if !lacks.is_empty() {
            words.push(format!("{} in {}", named(outcome, analysis), lacks.join(", ")));
        }
    }
    words
}

/// Seeds in words.
fn listed(seeds: &[u64]) -> String {
    match seeds {
        [seed] => format!("the run of seed {seed}"),
        [first, ..] => format!("{} runs, the first that of seed {first}", seeds.len()),
        [] => String::new(),
    }
}
