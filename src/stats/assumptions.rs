//! Whether an analysis of variance may be believed: normal residuals, equal spreads.

use serde::Serialize;

use super::describe::is_rounding;
use super::factorial::{Cells, Factorial};
use super::levene::levene;
use super::shapiro::{MOST_FITTED, shapiro_wilk};

/// The tests of the assumptions.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Assumptions {
    /// Shapiro and Wilk's statistic of the residuals, in (0, 1].
    pub shapiro_w: Option<f64>,
    /// Its probability were the residuals normal.
    pub shapiro_p: Option<f64>,
    /// Levene's statistic about the medians of the cells.
    pub levene_f: Option<f64>,
    /// Its probability were the spreads of the cells equal.
    pub levene_p: Option<f64>,
    /// What could not be said, and why.
    pub note: Option<String>,
}

/// Tests the residuals, what each value has beyond the mean of its cell, for normality, and the cells for equal spread.
#[must_use]
pub fn assumptions(design: &Factorial) -> Assumptions {
    let Some(cells) = Cells::of(design) else {
        let note = Some("the design has too many cells to test".to_owned());
        return Assumptions { note, ..Assumptions::default() };
    };
    let mut notes = Vec::new();
    let residuals = cells.residuals();
    let squares = residuals.iter().map(|value| value * value).sum();
    let constant = is_rounding(squares, residuals.len(), cells.scale());

    let shapiro = if constant { None } else { shapiro_wilk(&residuals) };
    if residuals.is_empty() {
        notes.push("nothing was measured".to_owned());
    } else if constant {
        notes.push("the runs of a cell do not differ: there are no residuals to test".to_owned());
    } else if shapiro.is_none() {
        notes.push("Shapiro and Wilk's test needs three runs".to_owned());
    } else if residuals.len() > MOST_FITTED {
        notes.push(format!("Shapiro and Wilk's p is an extrapolation beyond {MOST_FITTED} runs"));
    }
    let levene = if constant { None } else { levene(cells.filled()) };
    if levene.is_none() && !constant {
        let few = cells.filled().count() < 2;
        let why = if few { "Levene's test needs two cells" } else { "the distances from the medians do not differ" };
        notes.push(why.to_owned());
    }
    Assumptions {
        shapiro_w: shapiro.map(|test| test.w),
        shapiro_p: shapiro.map(|test| test.p),
        levene_f: levene.map(|test| test.f),
        levene_p: levene.map(|test| test.p),
        note: (!notes.is_empty()).then(|| notes.join("; ")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::factorial::tests::design;
    use super::*;

    #[test]
    fn one_run_a_cell_leaves_nothing_to_test() {
        let found = assumptions(&design(&[2, 2], &[(&[0, 0], 1.0), (&[0, 1], 2.0), (&[1, 0], 4.0), (&[1, 1], 3.0)]));
        let note = Some("the runs of a cell do not differ: there are no residuals to test".to_owned());
        assert_eq!(found, Assumptions { note, ..Assumptions::default() });
        assert_eq!(assumptions(&design(&[2], &[])).note.as_deref(), Some("nothing was measured"));
    }

    #[test]
    fn one_cell_has_no_spread_to_compare() {
        let found = assumptions(&design(&[], &[(&[], 1.0), (&[], 2.0), (&[], 4.0)]));
        assert!(found.shapiro_w.is_some() && found.levene_f.is_none());
        assert_eq!(found.note.as_deref(), Some("Levene's test needs two cells"));
    }
}
