//! The charts of a report, each under the name of its file.

use super::words::{description, distance};
use crate::chart::{self, Effect, Estimate, Group, Look, Series, Spot, Titles};
use crate::experiment::picture::plain;
use crate::experiment::{Analysis, Outcome};

/// Conditions that a correlogram shows at a time.
const TOGETHER: usize = 6;

/// Factors whose pairs have plots: with more the page would be nothing else.
const PAIRED: usize = 4;

/// Conditions that are compared with each other in a matrix; more are in the CSV file.
pub(super) const COMPARED: usize = 16;

/// A chart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// The name of its file: `KIND-MEASURE….svg`.
    pub file: String,
    /// The text of the SVG.
    pub svg: String,
}

impl Figure {
    /// What is called after these parts; the paint's name stands first where there are several.
    fn new(outcome: &Outcome, paint: usize, parts: &[&str], svg: String) -> Self {
        let paint = (outcome.paints.len() > 1).then(|| outcome.paints[paint].as_str());
        let parts: Vec<String> = paint.into_iter().chain(parts.iter().copied()).map(plain).collect();
        Self { file: format!("{}.svg", parts.join("-")), svg }
    }
}

/// How a measure spreads in each condition.
pub(super) fn boxes(outcome: &Outcome, analysis: &Analysis) -> Figure {
    let measure = &outcome.measures[analysis.measure];
    let values: Vec<Vec<f64>> = (0..outcome.plan.conditions.len())
        .map(|condition| outcome.values(analysis.paint, condition, analysis.measure))
        .collect();
    let names = outcome.plan.conditions.iter().map(|condition| condition.name.as_str());
    let groups: Vec<Group<'_>> = names.zip(&values).map(|(name, values)| Group { name, values }).collect();
    let title = match description(measure) {
        "" => measure.clone(),
        words => format!("{measure}: {words}"),
    };
    let titles = Titles { title: &title, x: measure, y: "" };
    Figure::new(outcome, analysis.paint, &["boxes", measure], chart::boxes(&titles, &groups))
}

/// The means of a measure over the levels of each factor, a line for each level of each other one.
pub(super) fn effects(outcome: &Outcome, analysis: &Analysis) -> Vec<Figure> {
    let factors = outcome.plan.factors.len();
    let mut figures = Vec::new();
    if factors == 1 {
        figures.push(effect(outcome, analysis, 0, None));
    } else if factors <= PAIRED {
        for first in 0..factors {
            figures.extend((first + 1..factors).map(|second| effect(outcome, analysis, first, Some(second))));
        }
    } else {
        figures.extend((0..factors).map(|first| effect(outcome, analysis, first, None)));
    }
    figures
}

fn effect(outcome: &Outcome, analysis: &Analysis, first: usize, second: Option<usize>) -> Figure {
    let plan = &outcome.plan;
    let measure = &outcome.measures[analysis.measure];
    let values: Vec<(&Vec<usize>, Vec<f64>)> = plan
        .conditions
        .iter()
        .enumerate()
        .filter_map(|(number, condition)| {
            let levels = condition.levels.as_ref()?;
            Some((levels, outcome.values(analysis.paint, number, analysis.measure)))
        })
        .collect();
    let mean = |level: usize, other: Option<usize>| {
        let is_meant = |levels: &Vec<usize>| levels[first] == level && second.map(|second| levels[second]) == other;
        let found = values.iter().filter(|(levels, _)| is_meant(levels)).flat_map(|(_, values)| values);
        estimate(&found.copied().collect::<Vec<f64>>())
    };
    let levels: Vec<&str> = plan.factors[first].levels.iter().map(String::as_str).collect();
    let means = |other: Option<usize>| (0..levels.len()).map(|level| mean(level, other)).collect();
    let names: Vec<String> = second.map_or_else(Vec::new, |second| {
        let factor = &plan.factors[second];
        factor.levels.iter().map(|level| format!("{} = {level}", factor.param)).collect()
    });
    let lines: Vec<Effect<'_>> = if second.is_none() {
        vec![Effect { name: "", means: means(None) }]
    } else {
        names.iter().enumerate().map(|(other, name)| Effect { name, means: means(Some(other)) }).collect()
    };
    let [a, b] = [Some(first), second].map(|factor| factor.map(|factor| plan.factors[factor].param.as_str()));
    let a = a.unwrap_or_default();
    let title = b.map_or_else(|| format!("{measure} by {a}"), |b| format!("{measure} by {a} and {b}"));
    let titles = Titles { title: &title, x: a, y: "mean ± 2 standard errors" };
    let svg = chart::effects(&titles, &levels, &lines);
    let parts: Vec<&str> = ["effect", measure, a].into_iter().chain(b).collect();
    Figure::new(outcome, analysis.paint, &parts, svg)
}

/// The mean of values, and two standard errors of it to either side.
fn estimate(values: &[f64]) -> Option<Estimate> {
    let summary = crate::stats::summary(values)?;
    let error = summary.sd.map(|sd| 2.0 * sd / (summary.n as f64).sqrt());
    Some(Estimate { mean: summary.mean, interval: error.map(|error| [summary.mean - error, summary.mean + error]) })
}

/// Every pair of conditions by Cohen's d.
pub(super) fn cohen(outcome: &Outcome, analysis: &Analysis) -> Option<Figure> {
    let measure = &outcome.measures[analysis.measure];
    let conditions: Vec<usize> =
        outcome.plan.design().filter(|&condition| analysis.summaries[condition].is_some()).collect();
    let is_empty = analysis.cohen_d.iter().all(|(_, _, d)| d.is_none());
    if is_empty || conditions.len() > COMPARED {
        return None;
    }
    let names: Vec<String> = conditions
        .iter()
        .enumerate()
        .map(|(i, &condition)| format!("{}. {}", i + 1, outcome.plan.conditions[condition].name))
        .collect();
    let numbers: Vec<String> = (1..=conditions.len()).map(|number| number.to_string()).collect();
    let d = |row: usize, column: usize| {
        analysis.cohen_d.iter().find_map(|&(a, b, d)| match (a, b) {
            pair if pair == (row, column) => d,
            // Minus zero is zero.
            pair if pair == (column, row) => d.map(|d| 0.0 - d),
            _ => None,
        })
    };
    let values: Vec<Vec<Option<f64>>> =
        conditions.iter().map(|&row| conditions.iter().map(|&column| d(row, column)).collect()).collect();
    let title = format!("Cohen's d of {measure}: row less column");
    let [rows, columns] = [&names, &numbers].map(|texts| texts.iter().map(String::as_str).collect::<Vec<_>>());
    let svg = chart::matrix(&Titles { title: &title, x: "", y: "" }, &rows, &columns, &values);
    Some(Figure::new(outcome, analysis.paint, &["cohen_d", measure], svg))
}

/// The correlogram of each condition with the spread over its seeds, some conditions at a time, over one range.
pub(super) fn correlograms(outcome: &Outcome, paint: usize) -> Vec<Figure> {
    let analyses: Vec<(u32, &Analysis)> = outcome
        .analyses
        .iter()
        .filter(|analysis| analysis.paint == paint)
        .filter_map(|analysis| Some((distance(&outcome.measures[analysis.measure])?, analysis)))
        .collect();
    let runs =
        |condition: usize| outcome.runs.iter().filter(|run| run.paint == paint && run.condition == condition).count();
    let spots = |condition: usize| -> Vec<Spot> {
        let of = |&(k, analysis): &(u32, &Analysis)| {
            let summary = analysis.summaries[condition].as_ref()?;
            // What only few patterns are wide enough for would stand for those alone.
            if 2 * summary.n < runs(condition) {
                return None;
            }
            let band = summary.sd.map(|sd| [summary.mean - sd, summary.mean + sd]);
            Some(Spot { x: f64::from(k), y: summary.mean, band })
        };
        analyses.iter().filter_map(of).collect()
    };
    let series: Vec<Series<'_>> = outcome
        .plan
        .conditions
        .iter()
        .enumerate()
        .map(|(number, condition)| Series { name: &condition.name, look: Look::Joined, spots: spots(number) })
        .filter(|series| !series.spots.is_empty())
        .collect();
    let all = || series.iter().flat_map(|series| &series.spots);
    let edges = all().flat_map(|spot| [spot.y].into_iter().chain(spot.band.into_iter().flatten()));
    let [low, high] = edges.fold([0.0f64, 0.0f64], |[low, high], value| [low.min(value), high.max(value)]);
    let titles = Titles {
        title: "Correlogram: mean ± SD over the seeds, as far as half of the runs reach",
        x: "distance along the links, k",
        y: "R_k",
    };
    let parts = series.chunks(TOGETHER).enumerate().map(|(number, series)| {
        let svg = chart::lines(&titles, series, Some([low, high]));
        let number = (number + 1).to_string();
        let parts = ["correlogram", number.as_str()];
        let parts = if outcome.plan.conditions.len() > TOGETHER { &parts[..] } else { &parts[..1] };
        Figure::new(outcome, paint, parts, svg)
    });
    parts.collect()
}
