//! The statistics of an experiment.
//!
//! What comes in are numbers, in groups or by the levels of factors; what goes out are plain tables. Nothing here knows of
//! scenes or tiles. All numbers are finite: who calls leaves out what could not be measured, and what is not finite is
//! passed over. What cannot be said (an F without a residual, a deviation of one value) is `None`, and where an analysis
//! as a whole falls short its `note` says so in words. `docs/statistics.md` has the formulae and their sources.

mod anova;
mod assumptions;
mod describe;
mod effect;
mod factorial;
mod holm;
mod levene;
mod paired;
mod project;
mod range;
mod shapiro;
mod tabled;
mod tails;
mod tukey;

pub use anova::{Anova, AnovaRow, anova};
pub use assumptions::{Assumptions, assumptions};
pub use describe::{Summary, percentile, summary};
pub use effect::cohen_d;
pub use factorial::{Factor, Factorial, Observation};
pub use holm::holm;
pub use levene::{Levene, levene};
pub use paired::{PairedT, SignedRank, paired_t, wilcoxon_signed_rank};
pub use range::{studentized_range_quantile, studentized_range_upper};
pub use shapiro::{ShapiroWilk, shapiro_wilk};
pub use tukey::{Tukey, TukeyRow, tukey};
