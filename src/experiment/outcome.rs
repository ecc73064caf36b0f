//! What an experiment found.

use crate::stats::{Anova, Assumptions, Summary, TukeyRow};

use super::Plan;

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

/// A picture that stands for a condition.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Which condition of the plan.
    pub condition: usize,
    /// The seed of the run whose contrast is nearest to the condition's median.
    pub seed: u64,
    /// Which of the plan's pictures: with what parameters it is drawn besides the condition's.
    pub variant: usize,
    /// The file's name within the folder of images.
    pub file: String,
    /// The PNG.
    pub png: Vec<u8>,
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
    /// The statistics of every paint and measure: paint by paint, in the order of the measures.
    pub analyses: Vec<Analysis>,
    /// For each condition the seed of the run whose `e_contrast` is nearest to the median of its first paint's (the lowest
    /// on ties); none where no run was done.
    pub representatives: Vec<Option<u64>>,
}

/// The statistics of one measure of one paint.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Which paint.
    pub paint: usize,
    /// Which measure.
    pub measure: usize,
    /// For each condition; none where nothing was measured.
    pub summaries: Vec<Option<Summary>>,
    /// Analysis of variance over the design's conditions.
    pub anova: Anova,
    /// Whether its assumptions hold.
    pub assumptions: Assumptions,
    /// Cohen's d of every pair of the design's conditions.
    pub cohen_d: Vec<(usize, usize, Option<f64>)>,
    /// Tukey's test of every pair of the design's conditions.
    pub tukey: Vec<TukeyRow>,
}
