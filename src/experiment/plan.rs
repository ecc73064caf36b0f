//! Which runs an experiment has: every condition with every seed.
//!
//! In: an experiment as lowering checked it, and the parameters of its scene. Out: the conditions by name, with what each
//! sets its parameters to, as expressions that `--set` takes. The numbers of the runs follow from the plan alone, so that
//! a run means the same in every sitting and on every machine.

use std::collections::BTreeSet;

use crate::diag::{Code, Diagnostic};
use crate::scene::{Experiment, Limits, Param, ParamValue};

/// The runs of an experiment. They are numbered from 0, condition by condition and seed by seed.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The experiment's name.
    pub name: String,
    /// First and last seed.
    pub seeds: [u64; 2],
    /// What is varied: the parameters of the factorial design with their levels.
    pub factors: Vec<Factor>,
    /// The parameters that conditions differ by: the factors', then those that only references give. Tables have a column
    /// for each.
    pub params: Vec<ParamType>,
    /// The conditions: the product of the factors' levels, the last factor's changing fastest, then the references.
    pub conditions: Vec<Condition>,
    /// What the run that stands for a condition is drawn with, a picture for each; a single one that sets nothing where
    /// the experiment asks for none.
    pub pictures: Vec<Vec<Setting>>,
}

/// A parameter and its type's name in the language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParamType {
    /// Its name.
    pub name: String,
    /// `number`, `string`, `length`…
    pub ty: String,
}

/// A factor of the design.
#[derive(Debug, Clone)]
pub struct Factor {
    /// The parameter's name.
    pub param: String,
    /// Its levels as tables show them.
    pub levels: Vec<String>,
}

/// A parameter with a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The parameter's name.
    pub param: String,
    /// Its value as tables show it: strings without quotes.
    pub label: String,
    /// Its value as an expression that yields it to the last bit.
    pub expression: String,
}

/// What runs have in common that differ by their seeds alone.
#[derive(Debug, Clone)]
pub struct Condition {
    /// Its name, made of its levels: `poisson + bfs`. No two conditions share one.
    pub name: String,
    /// The level of each factor; none for a reference, which stands outside the design.
    pub levels: Option<Vec<usize>>,
    /// The parameters that are set.
    pub sets: Vec<Setting>,
    /// The value of each of the plan's parameters, set or not, as tables show it.
    pub labels: Vec<String>,
}

impl Plan {
    /// The plan of an experiment in a scene of these parameters.
    ///
    /// # Errors
    /// If it has more runs or pictures than the limit.
    pub fn new(experiment: &Experiment, params: &[Param], limits: &Limits) -> Result<Self, Diagnostic> {
        let [first, last] = experiment.seeds;
        let seeds = (last - first).saturating_add(1);
        let product = |factors: &[crate::scene::Factor]| {
            factors.iter().fold(1u64, |product, factor| product.saturating_mul(factor.levels.len() as u64))
        };
        let conditions = product(&experiment.factors).saturating_add(experiment.reference.len() as u64);
        let pictures = product(&experiment.images);
        within("runs", conditions.saturating_mul(seeds), experiment, limits)?;
        within("pictures", conditions.saturating_mul(pictures), experiment, limits)?;

        let ty = |name: &str| params.iter().find(|param| param.name == name).map_or("", |param| param.ty.as_str());
        let setting = |name: &str, value: &ParamValue| Setting {
            param: name.to_owned(),
            label: label(value),
            expression: expression(value, ty(name)),
        };
        let settings = |factors: &[crate::scene::Factor]| -> Vec<Vec<Setting>> {
            factors
                .iter()
                .map(|factor| factor.levels.iter().map(|value| setting(&factor.param, value)).collect())
                .collect()
        };
        let levels = settings(&experiment.factors);
        let mut names: Vec<&str> = experiment.factors.iter().map(|factor| factor.param.as_str()).collect();
        for (name, _) in experiment.reference.iter().flatten() {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let labels = |sets: &[Setting]| -> Vec<String> {
            let given = |name: &str| sets.iter().find(|set| set.param == name).map(|set| set.label.clone());
            let kept = |name: &str| params.iter().find(|param| param.name == name).map(|param| label(&param.value));
            names.iter().map(|name| given(name).or_else(|| kept(name)).unwrap_or_default()).collect()
        };
        let design = combinations(&levels).into_iter().map(|indices| {
            let sets: Vec<Setting> =
                levels.iter().zip(&indices).map(|(levels, &level)| levels[level].clone()).collect();
            Condition { name: String::new(), labels: labels(&sets), levels: Some(indices), sets }
        });
        let references = experiment.reference.iter().map(|reference| {
            let sets: Vec<Setting> = reference.iter().map(|(name, value)| setting(name, value)).collect();
            Condition { name: String::new(), labels: labels(&sets), levels: None, sets }
        });
        let mut conditions: Vec<Condition> = design.chain(references).collect();
        name(&mut conditions, &experiment.name);
        let pictures = settings(&experiment.images);
        let pictures = combinations(&pictures)
            .into_iter()
            .map(|indices| pictures.iter().zip(indices).map(|(levels, level)| levels[level].clone()).collect())
            .collect();
        Ok(Self {
            name: experiment.name.clone(),
            seeds: experiment.seeds,
            factors: experiment
                .factors
                .iter()
                .map(|factor| Factor { param: factor.param.clone(), levels: factor.levels.iter().map(label).collect() })
                .collect(),
            params: names.iter().map(|name| ParamType { name: (*name).to_owned(), ty: ty(name).to_owned() }).collect(),
            conditions,
            pictures,
        })
    }

    /// How many seeds each condition has.
    #[must_use]
    pub fn seed_count(&self) -> usize {
        (self.seeds[1] - self.seeds[0]) as usize + 1
    }

    /// How many runs there are.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.conditions.len() * self.seed_count()
    }

    /// The condition and the seed of a run.
    #[must_use]
    pub fn run(&self, number: usize) -> (usize, u64) {
        let seeds = self.seed_count();
        (number / seeds, self.seeds[0] + (number % seeds) as u64)
    }

    /// The conditions of the factorial design, by number.
    pub fn design(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.conditions.len()).filter(|&condition| self.conditions[condition].levels.is_some())
    }
}

/// Says that there are too many of something, if so.
fn within(what: &str, count: u64, experiment: &Experiment, limits: &Limits) -> Result<(), Diagnostic> {
    if count <= limits.runs {
        return Ok(());
    }
    let count = if count == u64::MAX { "more than can be counted".to_owned() } else { count.to_string() };
    let message = format!("the experiment `{}` has {count} {what}; the limit is {}", experiment.name, limits.runs);
    let hint = "take fewer seeds or levels, or lift the limit: `--limit runs=N`";
    Err(Diagnostic::error(Code::Limit, experiment.span, message).hint(hint))
}

/// A value as tables show it.
fn label(value: &ParamValue) -> String {
    value.string.clone().unwrap_or_else(|| value.text.clone())
}

/// A value as an expression that yields it to the last bit: the text of a length or an angle is rounded for the eye.
fn expression(value: &ParamValue, ty: &str) -> String {
    match (ty, value.number) {
        ("length", Some(mm)) => format!("{mm}mm"),
        ("angle", Some(radians)) => format!("{radians}rad"),
        _ => value.text.clone(),
    }
}

/// Every choice of one level of each, the last changing fastest; a single empty one of nothing.
fn combinations(levels: &[Vec<Setting>]) -> Vec<Vec<usize>> {
    levels.iter().fold(vec![Vec::new()], |chosen, levels| {
        let grow = |chosen: Vec<usize>| (0..levels.len()).map(move |level| [chosen.as_slice(), &[level]].concat());
        chosen.into_iter().flat_map(grow).collect()
    })
}

/// Names conditions by the values of the plan's parameters: those that explain themselves stand alone.
fn name(conditions: &mut [Condition], experiment: &str) {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    for condition in conditions {
        let explains = |set: &Setting| set.expression.starts_with('"') && !set.label.is_empty();
        let word =
            |set: &Setting| if explains(set) { set.label.clone() } else { format!("{} {}", set.param, set.label) };
        let words: Vec<String> = condition.sets.iter().map(word).collect();
        let plain = if words.is_empty() { experiment.to_owned() } else { words.join(" + ") };
        let mut name = plain.clone();
        let mut number = 2;
        while !taken.insert(name.clone()) {
            name = format!("{plain} ({number})");
            number += 1;
        }
        condition.name = name;
    }
}
