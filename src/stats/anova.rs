//! Analysis of variance: what each factor, and each set of factors together, explains of what was measured.

use serde::Serialize;

use super::describe::{Moments, is_rounding};
use super::factorial::{Cells, Factorial};
use super::project::{Projector, Share};
use super::tails::f_upper;

/// The table of an analysis of variance.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Anova {
    /// Main effects in the order of the factors, their interactions by twos, by threes and so on, and the residual.
    pub rows: Vec<AnovaRow>,
    /// The sum of squares about the mean of all values.
    pub total: f64,
    /// What could not be said, and why.
    pub note: Option<String>,
}

/// A source of variance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnovaRow {
    /// A factor's name, names of factors joined by colons, or `residual`.
    pub source: String,
    /// The sum of squares, of type II: what the source explains beyond all sources that do not hold it.
    pub ss: f64,
    /// Degrees of freedom.
    pub df: usize,
    /// The mean square over that of the residual; `None` for the residual, and when nothing is left for it.
    pub f: Option<f64>,
    /// The probability of so great an F were there no such effect, in [0, 1].
    pub p: Option<f64>,
    /// The share of the total sum of squares; `None` when that is 0.
    pub eta2: Option<f64>,
    /// The share with the residual's part taken out, at least 0; `None` for the residual and without residual.
    pub omega2: Option<f64>,
}

/// Analyses a design of any number of factors and levels with all interactions, by sums of squares of type II. Cells need
/// not hold equally many values, nor any.
///
/// Nothing is divided by what is 0: rows then lack their F, p and shares, and the note says why. The table is empty
/// without values, and for designs too large to analyse.
#[must_use]
pub fn anova(design: &Factorial) -> Anova {
    let table = Cells::of(design).map(|cells| of_cells(design, &cells));
    table.flatten().unwrap_or_else(|| Anova {
        note: Some("the design has too many cells for an analysis of variance: leave out factors or levels".to_owned()),
        ..Anova::default()
    })
}

/// Analyses what was gathered; `None` for what is too much.
fn of_cells(design: &Factorial, cells: &Cells) -> Option<Anova> {
    let all: Vec<f64> = cells.values.iter().flatten().copied().collect();
    let Some(moments) = Moments::of(&all) else {
        return Some(Anova { note: Some("nothing was measured".to_owned()), ..Anova::default() });
    };
    let projector = Projector::new(cells, moments.mean);
    if !projector.is_feasible() {
        return None;
    }
    let mut notes = notes_on_the_design(design, cells);

    let within = cells.residuals();
    let mut residual =
        Share { squares: within.iter().map(|value| value * value).sum(), df: cells.count() - cells.filled().count() };
    let mut total = moments.squares;
    if is_rounding(total, moments.n, moments.scale) {
        notes.push(format!("every run measures {}: there is no variance to explain", moments.mean));
        (total, residual.squares) = (0.0, 0.0);
    } else if residual.df == 0 {
        notes.push("no cell holds more than one run: there is no residual to test against".to_owned());
    } else if is_rounding(residual.squares, moments.n, moments.scale) {
        notes.push("the runs of a cell do not differ: there is no residual to test against".to_owned());
        residual.squares = 0.0;
    }
    let judge = Judge { total, residual };

    let mut rows = Vec::new();
    // Factors that do not vary stand in the table, and explain nothing.
    let mut places = 0..;
    let varying: Vec<Option<u64>> = (0..design.factors.len())
        .map(|factor| cells.factors.contains(&factor).then(|| places.next().map(|place| 1 << place)).flatten())
        .collect();
    for (factor, term) in design.factors.iter().zip(&varying) {
        let share = term.map_or(Share { squares: 0.0, df: 0 }, |term| projector.share(term));
        rows.push(judge.row(factor.name.clone(), share));
    }
    for term in projector.terms().into_iter().filter(|term| term.count_ones() > 1) {
        let names = (0..design.factors.len()).filter(|factor| varying[*factor].is_some_and(|bit| term & bit != 0));
        let names: Vec<&str> = names.map(|factor| design.factors[factor].name.as_str()).collect();
        rows.push(judge.row(names.join(":"), projector.share(term)));
    }
    let eta2 = judge.of_total(residual.squares);
    rows.push(AnovaRow {
        source: "residual".to_owned(),
        ss: residual.squares,
        df: residual.df,
        f: None,
        p: None,
        eta2,
        omega2: None,
    });
    Some(Anova { rows, total, note: (!notes.is_empty()).then(|| notes.join("; ")) })
}

/// What there is to say of a design before anything is reckoned.
fn notes_on_the_design(design: &Factorial, cells: &Cells) -> Vec<String> {
    let mut notes = Vec::new();
    let constant: Vec<&str> = (0..design.factors.len())
        .filter(|factor| !cells.factors.contains(factor))
        .map(|factor| design.factors[factor].name.as_str())
        .collect();
    if design.factors.is_empty() {
        notes.push("there is no factor to compare".to_owned());
    } else if !constant.is_empty() {
        notes.push(format!("{} has one level only and explains nothing", constant.join(", ")));
    }
    let empty = cells.values.len() - cells.filled().count();
    if empty > 0 {
        let of = cells.values.len();
        notes
            .push(format!("{empty} of {of} cells hold no run: effects are told apart only as far as the others allow"));
    }
    notes
}

/// What sums of squares are held against.
struct Judge {
    /// The sum of squares of all.
    total: f64,
    /// The residual.
    residual: Share,
}

impl Judge {
    /// The row of a source.
    fn row(&self, source: String, share: Share) -> AnovaRow {
        let Share { squares, df } = if self.total > 0.0 { share } else { Share { squares: 0.0, ..share } };
        let noise = (self.residual.df > 0).then(|| self.residual.squares / self.residual.df as f64);
        let f = noise.filter(|noise| *noise > 0.0 && df > 0).map(|noise| squares / df as f64 / noise);
        let omega2 = noise
            .filter(|_| self.total > 0.0 && df > 0)
            .map(|noise| ((squares - df as f64 * noise) / (self.total + noise)).max(0.0));
        let p = f.and_then(|f| f_upper(f, df, self.residual.df));
        AnovaRow { source, ss: squares, df, f, p, eta2: self.of_total(squares), omega2 }
    }

    /// The share of the total.
    fn of_total(&self, squares: f64) -> Option<f64> {
        (self.total > 0.0).then(|| squares / self.total)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::factorial::tests::design;
    use super::*;

    /// Two factors of two levels, with the same values in each cell moved by what the cell adds.
    fn two_by_two(values: &[f64], added: [f64; 4]) -> Factorial {
        let levels: [&[usize]; 4] = [&[0, 0], &[0, 1], &[1, 0], &[1, 1]];
        let rows: Vec<(&[usize], f64)> =
            levels.iter().zip(added).flat_map(|(l, added)| values.iter().map(move |v| (*l, v + added))).collect();
        design(&[2, 2], &rows)
    }

    fn note(design: &Factorial) -> String {
        anova(design).note.unwrap_or_default()
    }

    #[test]
    fn one_run_a_cell_has_shares_but_no_test() {
        let found = anova(&two_by_two(&[0.0], [0.0, 1.0, 2.0, 5.0]));
        let shares: Vec<f64> = found.rows.iter().map(|row| row.eta2.unwrap()).collect();
        assert_eq!(shares, [9.0 / 14.0, 4.0 / 14.0, 1.0 / 14.0, 0.0]);
        assert!(found.rows.iter().all(|row| row.f.is_none() && row.p.is_none() && row.omega2.is_none()));
        assert_eq!(
            found.note.as_deref(),
            Some("no cell holds more than one run: there is no residual to test against")
        );
    }

    #[test]
    fn a_constant_measure_has_nothing_to_explain() {
        let found = anova(&two_by_two(&[0.1, 0.1], [0.0; 4]));
        assert!(found.rows.iter().all(|row| row.ss == 0.0 && row.eta2.is_none() && row.f.is_none()));
        assert_eq!(found.rows.iter().map(|row| row.df).collect::<Vec<_>>(), [1, 1, 1, 4]);
        assert_eq!(found.note.as_deref(), Some("every run measures 0.1: there is no variance to explain"));
    }

    #[test]
    fn cells_without_spread_are_not_tested_against() {
        let found = anova(&two_by_two(&[0.7, 0.7 + f64::EPSILON], [0.0, 1.0, 0.0, 1.0]));
        assert!((found.rows[1].eta2.unwrap() - 1.0).abs() < 1e-12);
        assert!(found.rows.iter().all(|row| row.f.is_none()));
        assert_eq!(
            found.note.as_deref(),
            Some("the runs of a cell do not differ: there is no residual to test against")
        );
    }

    #[test]
    fn factors_that_do_not_vary_are_named() {
        let found = anova(&design(&[1, 2], &[(&[0, 0], 1.0), (&[0, 0], 2.0), (&[0, 1], 4.0), (&[0, 1], 6.0)]));
        let rows: Vec<(&str, usize)> = found.rows.iter().map(|row| (&*row.source, row.df)).collect();
        assert_eq!(rows, [("a", 0), ("b", 1), ("residual", 2)]);
        assert_eq!((found.rows[0].f, found.rows[0].eta2), (None, Some(0.0)));
        assert_eq!(found.note.as_deref(), Some("a has one level only and explains nothing"));
        assert_eq!(note(&design(&[], &[(&[], 1.0), (&[], 2.0)])), "there is no factor to compare");
        assert_eq!(note(&design(&[2], &[])), "nothing was measured");
    }

    #[test]
    fn a_design_that_takes_too_long_is_refused() {
        let levels: Vec<[usize; 2]> = (0..200_000).map(|i| [i % 447, i / 447]).collect();
        let rows: Vec<(&[usize], f64)> = levels.iter().map(|levels| (&levels[..], levels[0] as f64)).collect();
        assert!(note(&design(&[447, 448], &rows)).contains("too many cells"));
    }

    /// Balanced designs of two or three factors.
    fn balanced() -> impl Strategy<Value = Factorial> {
        (prop::collection::vec(2..4_usize, 2..4), 2..4_usize).prop_flat_map(|(shape, count)| {
            let cells: usize = shape.iter().product();
            prop::collection::vec(-1.0..1.0_f64, cells * count).prop_map(move |values| {
                let levels: Vec<Vec<usize>> = (0..values.len())
                    .map(|i| {
                        let mut cell = i / count;
                        let level = |levels: &usize| {
                            let level = cell % levels;
                            cell /= levels;
                            level
                        };
                        shape.iter().map(level).collect()
                    })
                    .collect();
                let rows: Vec<(&[usize], f64)> = levels.iter().map(Vec::as_slice).zip(values).collect();
                design(&shape, &rows)
            })
        })
    }

    proptest! {
        #[test]
        fn in_a_balanced_design_the_sums_add_up(design in balanced()) {
            let found = anova(&design);
            prop_assert!((found.rows.iter().map(|row| row.ss).sum::<f64>() - found.total).abs() < 1e-10);
            let df: usize = found.rows.iter().map(|row| row.df).sum();
            prop_assert_eq!(df, design.observations.len() - 1);
        }

        #[test]
        fn neither_place_nor_scale_changes_f(
            design in balanced(), scale in 0.1..10.0_f64, offset in -10.0..10.0_f64, lost in 0..7_usize
        ) {
            // One value less makes the design unbalanced.
            let mut plain = design;
            plain.observations.remove(lost);
            let mut moved = plain.clone();
            moved.observations.iter_mut().for_each(|one| one.value = one.value * scale + offset);
            for (a, b) in anova(&plain).rows.iter().zip(&anova(&moved).rows) {
                prop_assert!((a.ss * scale * scale - b.ss).abs() < 1e-9);
                if let (Some(a), Some(b)) = (a.f, b.f) {
                    prop_assert!((a - b).abs() <= 1e-8 * (1.0 + a));
                }
            }
        }
    }
}
