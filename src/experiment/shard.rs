//! Shares of an experiment's runs, for several machines.

use serde::{Deserialize, Serialize};

/// Every `of`-th run, from the one at `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// From 1 to `of`.
    pub index: usize,
    /// How many shards there are, at least 1.
    pub of: usize,
}

impl Shard {
    /// All runs.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// Whether a run belongs to it.
    #[must_use]
    pub fn holds(self, run: usize) -> bool {
        run % self.of == self.index - 1
    }

    /// Whether it is all runs.
    #[must_use]
    pub fn is_whole(self) -> bool {
        self.of == 1
    }
}
