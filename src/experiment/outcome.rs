//! What an experiment found: every run's figures in one table, and their statistics.
//!
//! In: a plan and its runs, in any order. Out: an [`Outcome`], which depends on nothing else.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::stats::{self, Anova, Assumptions, Factorial, Observation, Summary, Tukey, TukeyRow};

use super::{Done, Plan};

/// The level of significance of Tukey's test.
pub const ALPHA: f64 = 0.05;

/// Pairs of conditions that are compared at most, those of 100 conditions: pairs grow with the square, and the tables of
/// 500 conditions would hold hundreds of megabytes.
const MOST_PAIRS: usize = 5000;

/// What conditions are represented by.
pub const CONTRAST: &str = "e_contrast";

/// Distances to the median that differ by less are equal: two runs beside the median lie equally far from it, but for
/// the last bits.
const TIE: f64 = 1e-12;

/// One paint of one run, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Which condition of the plan.
    pub condition: usize,
    /// The scene's seed.
    pub seed: u64,
    /// Which paint of the outcome's.
    pub paint: usize,
    /// A value for each of the outcome's measures; none where the measure cannot be said.
    pub values: Vec<Option<f64>>,
}

/// A run that could not be done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Which condition of the plan.
    pub condition: usize,
    /// The scene's seed.
    pub seed: u64,
    /// The diagnostics, rendered.
    pub words: String,
}

/// All that an experiment found.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What was asked for.
    pub plan: Plan,
    /// The names of the paints that were measured, in the order of their first appearance.
    pub paints: Vec<String>,
    /// The names of the measures (`tiles`, `edges`, `e_contrast` … `r1` `r2` … `xi` …), in the order of tables.
    pub measures: Vec<String>,
    /// Every run that was done, in the order of the plan, the paints of one run after each other.
    pub runs: Vec<Run>,
    /// The runs that could not be done, in the order of the plan.
    pub failures: Vec<Failure>,
    /// The statistics of every paint and every measure that has a value: paint by paint, in the order of the measures.
    pub analyses: Vec<Analysis>,
    /// For each condition the seed of the run whose `e_contrast` is nearest to the median, the lowest on ties, in the
    /// first paint that is measured there; none where no run was done.
    pub representatives: Vec<Option<u64>>,
}

/// The statistics of one measure of one paint.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Which paint of the outcome's.
    pub paint: usize,
    /// Which measure of the outcome's.
    pub measure: usize,
    /// For each condition; none where nothing was measured.
    pub summaries: Vec<Option<Summary>>,
    /// Analysis of variance over the design's conditions.
    pub anova: Anova,
    /// Whether its assumptions hold.
    pub assumptions: Assumptions,
    /// Cohen's d of every pair of the design's conditions, by their numbers; empty where there are more than 5,000, as
    /// the note of the assumptions then says.
    pub cohen_d: Vec<(usize, usize, Option<f64>)>,
    /// Tukey's test of every pair of the design's conditions; empty likewise.
    pub tukey: Vec<TukeyRow>,
}

impl Outcome {
    /// Puts the runs of a plan together, with their statistics. A run that is there twice counts once.
    #[must_use]
    pub fn new(plan: Plan, done: impl IntoIterator<Item = Done>) -> Self {
        let mut outcome = Self::of_runs(plan, done);
        outcome.representatives = (0..outcome.plan.conditions.len()).map(|c| outcome.representative(c)).collect();
        outcome.analyses = outcome.analyse();
        outcome
    }

    /// Puts runs together, some of a plan's perhaps, without statistics.
    #[must_use]
    pub fn of_runs(plan: Plan, done: impl IntoIterator<Item = Done>) -> Self {
        let done: BTreeMap<usize, Done> = done.into_iter().map(|done| (done.run, done)).collect();
        let found = || done.values().filter_map(|done| done.found.as_ref().ok()).flatten();
        let mut paints: Vec<String> = Vec::new();
        let mut measures = Names::default();
        for figures in found() {
            if !paints.contains(&figures.paint) {
                paints.push(figures.paint.clone());
            }
            measures.add(figures.figures.iter().map(|(name, _)| name));
        }
        let measures = measures.0;
        let places: BTreeMap<&str, usize> = measures.iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
        let mut runs = Vec::new();
        let mut failures = Vec::new();
        for (&number, done) in &done {
            let (condition, seed) = plan.run(number);
            match &done.found {
                Err(words) => failures.push(Failure { condition, seed, words: words.clone() }),
                Ok(figures) => runs.extend(figures.iter().map(|figures| {
                    let mut values = vec![None; measures.len()];
                    for (name, value) in &figures.figures {
                        // Infinities and NaN are no figures.
                        values[places[name.as_str()]] = value.filter(|value| value.is_finite());
                    }
                    let paint = paints.iter().position(|paint| *paint == figures.paint).unwrap_or(0);
                    Run { condition, seed, paint, values }
                })),
            }
        }
        Self { plan, paints, measures, runs, failures, analyses: Vec::new(), representatives: Vec::new() }
    }

    /// Where a measure stands among the measures.
    #[must_use]
    pub fn measure(&self, name: &str) -> Option<usize> {
        self.measures.iter().position(|measure| measure == name)
    }

    /// The values of a measure over the seeds of a condition, in the order of the seeds, those that cannot be said left
    /// out.
    #[must_use]
    pub fn values(&self, paint: usize, condition: usize, measure: usize) -> Vec<f64> {
        let runs = self.runs.iter().filter(|run| run.paint == paint && run.condition == condition);
        runs.filter_map(|run| run.values[measure]).collect()
    }

    fn representative(&self, condition: usize) -> Option<u64> {
        let mut runs = self.runs.iter().filter(|run| run.condition == condition).peekable();
        let paint = runs.peek()?.paint;
        let contrast = self.measure(CONTRAST)?;
        let runs: Vec<(u64, f64)> =
            runs.filter(|run| run.paint == paint).filter_map(|run| Some((run.seed, run.values[contrast]?))).collect();
        let median = stats::summary(&runs.iter().map(|&(_, value)| value).collect::<Vec<_>>())?.median;
        let mut best: Option<(u64, f64)> = None;
        for (seed, value) in runs {
            let distance = (value - median).abs();
            if best.is_none_or(|(_, least)| distance < least - TIE) {
                best = Some((seed, distance));
            }
        }
        best.map(|(seed, _)| seed)
    }

    fn analyse(&self) -> Vec<Analysis> {
        let conditions = self.plan.conditions.len();
        // Values by paint, measure and condition, in the order of the seeds.
        let mut values = vec![vec![vec![Vec::new(); conditions]; self.measures.len()]; self.paints.len()];
        for run in &self.runs {
            for (measure, value) in run.values.iter().enumerate() {
                values[run.paint][measure][run.condition].extend(value);
            }
        }
        let all: Vec<(usize, usize, &Vec<Vec<f64>>)> = values
            .iter()
            .enumerate()
            .flat_map(|(paint, measures)| measures.iter().enumerate().map(move |(measure, of)| (paint, measure, of)))
            .filter(|(_, _, of)| of.iter().any(|values| !values.is_empty()))
            .collect();
        let tukey = Tukey::new(ALPHA);
        all.into_par_iter().map(|(paint, measure, values)| self.analysis(paint, measure, values, &tukey)).collect()
    }

    /// The statistics of a measure from its values by condition.
    fn analysis(&self, paint: usize, measure: usize, values: &[Vec<f64>], tukey: &Tukey) -> Analysis {
        let plan = &self.plan;
        let design: Vec<usize> = plan.design().filter(|&condition| !values[condition].is_empty()).collect();
        let observation = |condition: usize, value: f64| Observation {
            levels: plan.conditions[condition].levels.clone().unwrap_or_default(),
            value,
        };
        let factorial = Factorial {
            factors: plan
                .factors
                .iter()
                .map(|factor| stats::Factor { name: factor.param.clone(), levels: factor.levels.clone() })
                .collect(),
            observations: design
                .iter()
                .flat_map(|&condition| values[condition].iter().map(move |&value| observation(condition, value)))
                .collect(),
        };
        let mut assumptions = stats::assumptions(&factorial);
        let pairs = design.len() * design.len().saturating_sub(1) / 2;
        let (cohen_d, tukey) = if pairs > MOST_PAIRS {
            let count = design.len();
            let note = format!("{count} conditions make {pairs} pairs; pairs are compared up to {MOST_PAIRS}");
            let notes: Vec<String> = assumptions.note.take().into_iter().chain([note]).collect();
            assumptions.note = Some(notes.join("; "));
            (Vec::new(), Vec::new())
        } else {
            let pairs = design.iter().enumerate().flat_map(|(i, &a)| design[i + 1..].iter().map(move |&b| (a, b)));
            let groups: Vec<(String, Vec<f64>)> = design
                .iter()
                .map(|&condition| (plan.conditions[condition].name.clone(), values[condition].clone()))
                .collect();
            (pairs.map(|(a, b)| (a, b, stats::cohen_d(&values[a], &values[b]))).collect(), tukey.rows(&groups))
        };
        Analysis {
            paint,
            measure,
            summaries: values.iter().map(|values| stats::summary(values)).collect(),
            anova: stats::anova(&factorial),
            assumptions,
            cohen_d,
            tukey,
        }
    }
}

/// Names in an order that agrees with every list that was added.
#[derive(Debug, Default)]
struct Names(Vec<String>);

impl Names {
    /// Adds a list: a name that is new comes after the one before it.
    fn add<'a>(&mut self, names: impl Iterator<Item = &'a String>) {
        let mut at = 0;
        for name in names {
            // Most lists are the same, so that the next name is mostly the one looked for.
            if self.0.get(at) == Some(name) {
                at += 1;
            } else if let Some(known) = self.0.iter().position(|known| known == name) {
                at = known + 1;
            } else {
                self.0.insert(at, name.clone());
                at += 1;
            }
        }
    }
}
