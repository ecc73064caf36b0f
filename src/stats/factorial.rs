//! Observations by the levels of factors, and the cells they fall into.

use super::describe::Moments;

/// Something that was varied on purpose.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// What it is called in tables.
    pub name: String,
    /// The names of its levels.
    pub levels: Vec<String>,
}

/// A value that was measured at one level of each factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The index of the level of each factor, in the order of the factors.
    pub levels: Vec<usize>,
    /// What was measured: finite.
    pub value: f64,
}

/// What was measured where. What does not fit (a level that is not there, a value that is not finite) is passed over.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Factorial {
    /// What was varied.
    pub factors: Vec<Factor>,
    /// What was measured; missing ones are just not there.
    pub observations: Vec<Observation>,
}

/// The most cells that a design may have.
const MOST_CELLS: usize = 1 << 18;

/// Observations gathered by cell. Levels that nobody observed are left out, and with them factors that do not vary.
#[derive(Debug)]
pub(super) struct Cells {
    /// The indices of the factors that vary.
    pub(super) factors: Vec<usize>,
    /// How many levels each of them has among the observations: at least 2.
    pub(super) shape: Vec<usize>,
    /// The values of each cell, by the mixed radix number of its levels, the last factor fastest.
    pub(super) values: Vec<Vec<f64>>,
}

impl Cells {
    /// Gathers the observations; `None` when there are more cells than can be analysed.
    pub(super) fn of(design: &Factorial) -> Option<Self> {
        let fits = |observation: &&Observation| {
            observation.value.is_finite()
                && observation.levels.len() == design.factors.len()
                && observation.levels.iter().zip(&design.factors).all(|(level, factor)| *level < factor.levels.len())
        };
        let observations: Vec<&Observation> = design.observations.iter().filter(fits).collect();

        // The new number of each level, counted over those that occur.
        let numbers: Vec<Vec<Option<usize>>> = design
            .factors
            .iter()
            .enumerate()
            .map(|(factor, described)| {
                let mut seen = vec![false; described.levels.len()];
                observations.iter().for_each(|observation| seen[observation.levels[factor]] = true);
                let mut next = 0..;
                seen.into_iter().map(|seen| seen.then(|| next.next()).flatten()).collect()
            })
            .collect();
        let counts: Vec<usize> = numbers.iter().map(|numbers| numbers.iter().flatten().count()).collect();
        let factors: Vec<usize> = (0..counts.len()).filter(|factor| counts[*factor] > 1).collect();
        let shape: Vec<usize> = factors.iter().map(|factor| counts[*factor]).collect();

        let cells = shape.iter().try_fold(1_usize, |cells, levels| cells.checked_mul(*levels))?;
        if cells > MOST_CELLS {
            return None;
        }
        let mut values = vec![Vec::new(); cells];
        for observation in observations {
            let cell = factors.iter().zip(&shape).fold(0, |cell, (factor, levels)| {
                cell * levels + numbers[*factor][observation.levels[*factor]].unwrap_or_default()
            });
            values[cell].push(observation.value);
        }
        Some(Self { factors, shape, values })
    }

    /// How many values there are.
    pub(super) fn count(&self) -> usize {
        self.values.iter().map(Vec::len).sum()
    }

    /// The greatest absolute value.
    pub(super) fn scale(&self) -> f64 {
        self.values.iter().flatten().fold(0.0, |most, value| most.max(value.abs()))
    }

    /// The cells that hold values.
    pub(super) fn filled(&self) -> impl Iterator<Item = &[f64]> {
        self.values.iter().map(Vec::as_slice).filter(|values| !values.is_empty())
    }

    /// What each value has beyond the mean of its cell.
    pub(super) fn residuals(&self) -> Vec<f64> {
        self.filled()
            .flat_map(|values| {
                let mean = Moments::of(values).map_or(0.0, |moments| moments.mean);
                values.iter().map(move |value| value - mean)
            })
            .collect()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A design with the given numbers of levels and values with their levels.
    pub(in crate::stats) fn design(shape: &[usize], values: &[(&[usize], f64)]) -> Factorial {
        let name = |factor: usize| char::from(b'a' + u8::try_from(factor).unwrap()).to_string();
        Factorial {
            factors: (0..shape.len())
                .map(|i| Factor { name: name(i), levels: (0..shape[i]).map(|level| level.to_string()).collect() })
                .collect(),
            observations: values
                .iter()
                .map(|(levels, value)| Observation { levels: levels.to_vec(), value: *value })
                .collect(),
        }
    }

    #[test]
    fn levels_that_nobody_observed_and_factors_that_do_not_vary_are_left_out() {
        let found = design(&[3, 2, 2], &[(&[0, 1, 0], 1.0), (&[2, 1, 1], 2.0), (&[2, 1, 1], 4.0)]);
        let cells = Cells::of(&found).unwrap();
        assert_eq!((cells.factors.as_slice(), cells.shape.as_slice()), (&[0, 2][..], &[2, 2][..]));
        assert_eq!(cells.values, [vec![1.0], vec![], vec![], vec![2.0, 4.0]]);
        assert_eq!(cells.residuals(), [0.0, -1.0, 1.0]);
    }

    #[test]
    fn what_does_not_fit_is_passed_over() {
        let found = design(&[2], &[(&[0], f64::NAN), (&[2], 1.0), (&[0, 0], 1.0), (&[1], 3.0)]);
        assert_eq!(Cells::of(&found).unwrap().count(), 1);
    }

    #[test]
    fn too_many_cells_are_refused() {
        let many: Vec<usize> = (0..30).map(|_| 2).collect();
        let (low, high) = (vec![0; 30], vec![1; 30]);
        assert!(Cells::of(&design(&many, &[(&low, 0.0), (&high, 1.0)])).is_none());
    }
}
