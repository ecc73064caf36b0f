//! Which runs an experiment has: every condition with every seed.

use crate::scene::{Experiment, Param, ParamValue, Scene};

/// The runs of an experiment. They are numbered from 0, condition by condition and seed by seed.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The experiment's name.
    pub name: String,
    /// First and last seed.
    pub seeds: [u64; 2],
    /// What is varied: the parameters of the factorial design with their levels.
    pub factors: Vec<Levels>,
    /// The parameters that conditions differ by: the factors', then those that only references give. Tables have a column
    /// for each.
    pub params: Vec<ParamType>,
    /// The conditions: the product of the factors' levels, the last factor's changing fastest, then the references.
    pub conditions: Vec<Condition>,
    /// What each condition is drawn with, one picture for each; a single one without parameters where the scene asks for
    /// none.
    pub pictures: Vec<Vec<Level>>,
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
pub struct Levels {
    /// The parameter's name.
    pub param: String,
    /// Its levels as tables show them.
    pub labels: Vec<String>,
}

/// A parameter with a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
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
    /// The level of each factor; `None` for a reference, which stands outside the design.
    pub levels: Option<Vec<usize>>,
    /// The parameters that are set.
    pub sets: Vec<Level>,
    /// The value of each of the plan's parameters, set or not, as tables show it.
    pub labels: Vec<String>,
}
