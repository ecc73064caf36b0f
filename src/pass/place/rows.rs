//! Cells of a lattice by row and column: which site is which, for the search of neighbours.

/// Rows of sites whose columns follow each other at equal steps.
pub(super) struct Rows {
    /// The number of the first row.
    top: i64,
    /// From column to column of a row.
    step: i64,
    /// The first column of every row, and the index of its site.
    starts: Vec<(i64, u32)>,
    /// How many sites there are.
    count: u32,
}

impl Rows {
    /// None as yet, from row `top` on.
    pub(super) fn new(top: i64, step: i64) -> Self {
        Self { top, step, starts: Vec::new(), count: 0 }
    }

    /// Adds the next row.
    pub(super) fn push(&mut self, first: i64, sites: usize) {
        self.starts.push((first, self.count));
        self.count += sites as u32;
    }

    /// The site in a row and a column, if there is one.
    fn site(&self, row: i64, column: i64) -> Option<u32> {
        let row = usize::try_from(row - self.top).ok()?;
        let &(first, start) = self.starts.get(row)?;
        let end = self.starts.get(row + 1).map_or(self.count, |next| next.1);
        let ahead = column - first;
        let at = u32::try_from(ahead / self.step).ok().filter(|_| ahead >= 0 && ahead % self.step == 0)?;
        (at < end - start).then_some(start + at)
    }

    /// Pairs of every site and those of its neighbours that are there. `neighbours` gives the rows and columns of some of
    /// them, so that every pair is named once.
    pub(super) fn pairs<const N: usize>(
        &self,
        neighbours: impl Fn(i64, i64) -> [Option<(i64, i64)>; N],
    ) -> Vec<[u32; 2]> {
        let mut pairs = Vec::with_capacity(self.count as usize * N);
        for (number, &(first, start)) in self.starts.iter().enumerate() {
            let end = self.starts.get(number + 1).map_or(self.count, |next| next.1);
            let row = self.top + number as i64;
            for site in start..end {
                let column = first + i64::from(site - start) * self.step;
                let there = neighbours(row, column).into_iter().flatten();
                pairs.extend(there.filter_map(|(row, column)| self.site(row, column)).map(|other| [site, other]));
            }
        }
        pairs
    }
}
