//! Experiments: a scene compiled and measured under many conditions and seeds.
//!
//! In: a scene with an `experiment` block. Out: an [`Outcome`], which holds every run's measures, their statistics and
//! the pictures that stand for each condition. [`Plan`] says which runs there are, [`runner`] does them on all cores, and
//! what follows from the runs alone ([`Outcome::new`], the tables in [`tables`]) is the same whichever threads, sittings
//! or machines did them. Nothing here touches a clock or a file: whoever drives it keeps what is finished.

mod outcome;
mod plan;

pub use outcome::{Analysis, Failure, Outcome, Picture, Run};
pub use plan::{Condition, Level, Plan};
