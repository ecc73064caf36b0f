//! Least squares over the cells of a design: what a term explains beyond the terms that it is no part of.
//!
//! All values of a cell share one row of the design matrix, so that least squares over the values is least squares over
//! the means of the cells, weighted by their counts. Terms are sets of factors, as bits; the space of a term is what its
//! factors can explain, and it holds the spaces of all its subsets. Type II (Langsrud 2003, section 3) asks what a term
//! adds to all terms that it is no part of.

use super::factorial::Cells;

/// A set of factors, by their places among those that vary.
pub(super) type Term = u64;

/// What a term explains beyond the terms that do not hold it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Share {
    /// The sum of squares.
    pub(super) squares: f64,
    /// The dimensions that the term adds.
    pub(super) df: usize,
}

/// A column that keeps less of its length than this beside others is a sum of them.
const DEPENDENT: f64 = 1e-9;

/// The operations beyond which a design is not analysed: some ten seconds'.
const MOST_WORK: f64 = 1e11;

/// The means of the cells, ready for projections.
#[derive(Debug)]
pub(super) struct Projector {
    shape: Vec<usize>,
    /// Cells that hold values, by their levels.
    cells: Vec<Vec<usize>>,
    /// The square roots of the counts.
    weights: Vec<f64>,
    /// The means about the mean of all values, times the weights.
    means: Vec<f64>,
    /// Whether every cell holds as many values as any other.
    balanced: bool,
}

impl Projector {
    /// Takes the means of the cells about `mean`.
    pub(super) fn new(cells: &Cells, mean: f64) -> Self {
        let levels = |mut number: usize| {
            let mut levels = vec![0; cells.shape.len()];
            for (level, count) in levels.iter_mut().zip(&cells.shape).rev() {
                (*level, number) = (number % count, number / count);
            }
            levels
        };
        let filled: Vec<usize> = (0..cells.values.len()).filter(|cell| !cells.values[*cell].is_empty()).collect();
        let count = |cell: &usize| cells.values[*cell].len();
        Self {
            cells: filled.iter().map(|cell| levels(*cell)).collect(),
            weights: filled.iter().map(|cell| (count(cell) as f64).sqrt()).collect(),
            means: filled
                .iter()
                .map(|cell| {
                    let about: f64 = cells.values[*cell].iter().map(|value| value - mean).sum();
                    about / (count(cell) as f64).sqrt()
                })
                .collect(),
            balanced: filled.len() == cells.values.len() && filled.iter().all(|cell| count(cell) == count(&filled[0])),
            shape: cells.shape.clone(),
        }
    }

    /// Every term, those of fewer factors first, within these the first factors first.
    pub(super) fn terms(&self) -> Vec<Term> {
        let members = |term: Term| (0..self.shape.len()).filter(move |factor| term >> factor & 1 == 1);
        let mut terms: Vec<Term> = (1..1 << self.shape.len()).collect();
        terms.sort_by_cached_key(|term| (term.count_ones(), members(*term).collect::<Vec<_>>()));
        terms
    }

    /// Whether the design can be analysed in a time that somebody waits for.
    pub(super) fn is_feasible(&self) -> bool {
        let columns = |term: Term| -> f64 {
            let first = self.closed(term);
            let others = self.terms().into_iter().filter(|u| u & term != term && u >> first & 1 == 1);
            let own = if term == self.all() { 0.0 } else { self.columns(term) as f64 };
            own + others.map(|term| self.columns(term) as f64).sum::<f64>()
        };
        let terms = self.terms();
        if self.balanced {
            return terms.len() as f64 * self.cells.len() as f64 * self.shape.len() as f64 <= MOST_WORK;
        }
        // The terms are gone through once a term, so that their own number is bounded first.
        terms.len() <= 1 << 10
            && terms.iter().map(|term| 4.0 * self.cells.len() as f64 * columns(*term) * columns(*term)).sum::<f64>()
                <= MOST_WORK
    }

    /// What a term explains beyond the terms that do not hold it.
    pub(super) fn share(&self, term: Term) -> Share {
        if self.balanced { self.balanced_share(term) } else { self.unbalanced_share(term) }
    }

    /// The term of all factors.
    fn all(&self) -> Term {
        (1 << self.shape.len()) - 1
    }

    /// How many columns a term has of its own.
    fn columns(&self, term: Term) -> usize {
        (0..self.shape.len()).filter(|factor| term >> factor & 1 == 1).map(|factor| self.shape[factor] - 1).product()
    }

    /// In a balanced design the spaces are orthogonal: the means are averaged over each factor that the term has not, and
    /// what they are beyond the average is taken along each that it has.
    fn balanced_share(&self, term: Term) -> Share {
        let mut effect = self.means.clone();
        let mut stride = effect.len();
        for (factor, levels) in self.shape.iter().enumerate() {
            stride /= levels;
            for start in (0..effect.len()).filter(|cell| (cell / stride).is_multiple_of(*levels)) {
                let along = || (0..*levels).map(|level| start + level * stride);
                let average = along().map(|cell| effect[cell]).sum::<f64>() / *levels as f64;
                for cell in along() {
                    effect[cell] = if term >> factor & 1 == 1 { effect[cell] - average } else { average };
                }
            }
        }
        Share { squares: dot(&effect, &effect), df: self.columns(term) }
    }

    /// Otherwise the columns of the terms that do not hold this one are made orthogonal one after another, then its own:
    /// what these find in the means is what it explains. Columns of terms without one chosen factor of this one need not be
    /// written out, since that all together they span is averages over that factor.
    fn unbalanced_share(&self, term: Term) -> Share {
        let factor = self.closed(term);
        let groups = self.groups(factor);
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for other in self.terms().into_iter().filter(|other| other & term != term && other >> factor & 1 == 1) {
            self.extend(&mut basis, other, &groups);
        }
        let mut rest = self.means.clone();
        self.subtract_averages(&mut rest, &groups);
        orthogonalise(&mut rest, &basis);
        if term == self.all() {
            // All factors together explain each cell, and so all that is left.
            let known = groups.iter().max().map_or(0, |group| group + 1) + basis.len();
            return Share { squares: dot(&rest, &rest), df: self.cells.len().saturating_sub(known) };
        }
        let before = basis.len();
        self.extend(&mut basis, term, &groups);
        let squares = basis[before..].iter().map(|column| dot(column, &rest)).map(|found| found * found).sum();
        Share { squares, df: basis.len() - before }
    }

    /// The factor of a term with the fewest levels: its averages span the most.
    fn closed(&self, term: Term) -> usize {
        let members = (0..self.shape.len()).filter(|factor| term >> factor & 1 == 1);
        members.min_by_key(|factor| (self.shape[*factor], *factor)).unwrap_or_default()
    }

    /// Numbers the cells such that those that differ in one factor only share a number.
    fn groups(&self, factor: usize) -> Vec<usize> {
        let mut numbers = std::collections::BTreeMap::new();
        self.cells
            .iter()
            .map(|cell| {
                let others: Vec<usize> = (0..cell.len()).filter(|i| *i != factor).map(|i| cell[i]).collect();
                let next = numbers.len();
                *numbers.entry(others).or_insert(next)
            })
            .collect()
    }

    /// Takes from each cell the weighted average of its group.
    fn subtract_averages(&self, column: &mut [f64], groups: &[usize]) {
        let mut sums = vec![(0.0, 0.0); groups.iter().max().map_or(0, |group| group + 1)];
        for ((value, weight), group) in column.iter().zip(&self.weights).zip(groups) {
            let (sum, squares) = &mut sums[*group];
            *sum += value * weight;
            *squares += weight * weight;
        }
        for ((value, weight), group) in column.iter_mut().zip(&self.weights).zip(groups) {
            *value -= weight * sums[*group].0 / sums[*group].1;
        }
    }

    /// Adds to a basis what the columns of a term have beyond it.
    fn extend(&self, basis: &mut Vec<Vec<f64>>, term: Term, groups: &[usize]) {
        let factors: Vec<usize> = (0..self.shape.len()).filter(|factor| term >> factor & 1 == 1).collect();
        for number in 0..self.columns(term) {
            let mut column = self.weights.clone();
            let mut number = number;
            for factor in factors.iter().rev() {
                let contrast = number % (self.shape[*factor] - 1);
                number /= self.shape[*factor] - 1;
                column.iter_mut().zip(&self.cells).for_each(|(value, cell)| *value *= helmert(contrast, cell[*factor]));
            }
            let length = dot(&column, &column).sqrt();
            self.subtract_averages(&mut column, groups);
            orthogonalise(&mut column, basis);
            let left = dot(&column, &column).sqrt();
            if left > DEPENDENT * length {
                column.iter_mut().for_each(|value| *value /= left);
                basis.push(column);
            }
        }
    }
}

/// Helmert's contrasts, of length 1: what a level has beyond the mean of those before it.
fn helmert(contrast: usize, level: usize) -> f64 {
    let before = (contrast + 1) as f64;
    let length = (before * (before + 1.0)).sqrt();
    match level.cmp(&(contrast + 1)) {
        std::cmp::Ordering::Less => -1.0 / length,
        std::cmp::Ordering::Equal => before / length,
        std::cmp::Ordering::Greater => 0.0,
    }
}

/// Takes from a column what a basis has of it; a second time when that was most of it, which is enough (Giraud, Langou and
/// Rozložník 2005).
fn orthogonalise(column: &mut [f64], basis: &[Vec<f64>]) {
    let mut before = dot(column, column);
    for _ in 0..2 {
        for unit in basis {
            let along = dot(column, unit);
            column.iter_mut().zip(unit).for_each(|(value, unit)| *value -= along * unit);
        }
        let after = dot(column, column);
        if after > 0.5 * before {
            break;
        }
        before = after;
    }
}

/// The inner product, in eight sums side by side: a single one would wait for itself.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; 8];
    for (a, b) in a.zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += a * b;
        }
    }
    rest + sums.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::super::factorial::tests::design;
    use super::*;

    #[test]
    fn balance_is_a_shortcut_and_no_other_answer() {
        let value = |a: usize, b: usize, c: usize| libm::sin((7 * a + 3 * b * b + 11 * c * a + b * c) as f64);
        let levels: Vec<[usize; 3]> =
            (0..24).map(|i| [i / 12, i / 4 % 3, i % 4]).flat_map(|levels| [levels, levels]).collect();
        let values: Vec<(&[usize], f64)> =
            levels.iter().enumerate().map(|(i, l)| (&l[..], value(l[0], l[1], l[2]) + 0.1 * (i % 2) as f64)).collect();
        let cells = Cells::of(&design(&[2, 3, 4], &values)).unwrap();
        let projector = Projector::new(&cells, 0.2);
        assert!(projector.balanced);
        assert_eq!(projector.terms(), [1, 2, 4, 3, 5, 6, 7]);
        for term in projector.terms() {
            let (short, long) = (projector.balanced_share(term), projector.unbalanced_share(term));
            assert!((short.squares - long.squares).abs() < 1e-12, "{short:?} {long:?}");
            assert_eq!(short.df, long.df);
        }
    }
}
