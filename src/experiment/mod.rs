//! Experiments: a scene compiled and measured under many conditions and seeds.
//!
//! In: a scene with an `experiment` block, as a [`Recipe`]. Out: an [`Outcome`], which holds every run's measures and their
//! statistics, as [`tables`] in CSV and [`parquet`], and a [`Picture`] for each condition. [`Plan`] says which runs there
//! are and [`run`] does them on all cores. What follows from the runs is the same whichever threads, sittings or machines
//! did them. Nothing here touches a clock or a file: whoever drives it keeps what is finished, in a [`Journal`] say.

mod journal;
mod made;
mod outcome;
pub mod parquet;
mod picture;
mod plan;
mod prepare;
mod recipe;
mod report;
mod runner;
mod shard;
pub mod tables;

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests;

pub use journal::{Journal, entry, head};
pub use made::{command, made};
pub use outcome::{ALPHA, Analysis, CONTRAST, Failure, Outcome, Run};
pub(crate) use picture::plain as file_name;
pub use picture::{Picture, count as picture_count, pictures};
pub use plan::{Condition, Factor, ParamType, Plan, Setting};
pub use prepare::{Prepared, Request, prepare};
pub use recipe::{Bytes, Recipe, Recorder};
pub use report::{Figure, Report, report};
pub use runner::{Done, PaintFigures, one, run};
pub use shard::Shard;
