//! What a drawing may cost: marks that are drawn, and the lines that are looked at to find them.
//!
//! Counting goes on in all threads at once. Whether a limit is passed does not depend on their order, only where.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::diag::{Code, Diagnostic, grouped};
use crate::scene::Limits;
use crate::span::Span;

/// Places that may be looked at for each mark that may be drawn: most lines of densely stacked tiles lie hidden, but
/// that some are seen should not take forever.
const WORK_PER_MARK: u64 = 16;

/// A limit was passed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Exceeded;

impl Exceeded {
    /// What to tell.
    pub(super) fn diagnostic(self, limits: &Limits, span: Span) -> Diagnostic {
        let limit = limits.strokes;
        Diagnostic::error(Code::Limit, span, format!("the drawing has more than {} strokes", grouped(limit)))
            .label("this is too dense, or too large")
            .hint("a wider pitch or larger tiles take fewer strokes; `--limit strokes=…` lifts the limit")
    }
}

/// Counts what a paint costs.
pub(super) struct Budget {
    limit: u64,
    marks: AtomicU64,
    work: AtomicU64,
}

impl Budget {
    pub(super) fn new(limits: &Limits) -> Self {
        Self { limit: limits.strokes, marks: AtomicU64::new(0), work: AtomicU64::new(0) }
    }

    /// Notes marks that are drawn.
    pub(super) fn mark(&self, count: usize) -> Result<(), Exceeded> {
        spend(&self.marks, count as u64, self.limit)
    }

    /// Notes lines, dots or samples that are about to be looked at. `count` may be infinite.
    pub(super) fn work(&self, count: f64) -> Result<(), Exceeded> {
        // A cast of what is too great gives the greatest number.
        spend(&self.work, count as u64, self.limit.saturating_mul(WORK_PER_MARK))
    }

    /// The most marks.
    pub(super) fn limit(&self) -> usize {
        usize::try_from(self.limit).unwrap_or(usize::MAX)
    }
}

fn spend(spent: &AtomicU64, count: u64, limit: u64) -> Result<(), Exceeded> {
    // Each addition is checked first, so that sums cannot run over.
    if count > limit || spent.fetch_add(count, Ordering::Relaxed) > limit - count { Err(Exceeded) } else { Ok(()) }
}
