//! What a drawing may cost: marks that are drawn, and looks that are taken to find them.
//!
//! A look is about what it takes to meet one line with one tile: some nanoseconds. Counting goes on in all threads at once.
//! Whether a limit is passed does not depend on their order, only where.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::diag::{Code, Diagnostic, grouped};
use crate::scene::Limits;
use crate::span::Span;
use crate::stop::Stop;

/// Looks for each mark that may be drawn: most lines of densely stacked tiles lie hidden, but that some are seen should
/// not take forever.
const WORK_PER_MARK: u64 = 16;

/// Looks that are always allowed, however few marks are: a moment's work.
const LEAST_WORK: u64 = 20_000_000;

/// Looks that a thread takes before it tells the others.
const TALLY: u64 = 4096;

/// What a line costs in looks, besides the tiles that may hide it.
pub(super) const LINE: u64 = 4;

/// What the profile of a tile costs.
pub(super) const PROFILE: u64 = 4;

/// What a dot costs, besides the tiles that may hide it.
pub(super) const DOT: u64 = 4;

/// What it costs to make a curve, besides the tiles that may hide it.
pub(super) const CURVE: u64 = 32;

/// What it costs to unite an inked tile with another near it.
pub(super) const UNITED: u64 = 64;

/// What a curve costs that is drawn: in memory it is a mark.
pub(super) const DRAWN: u64 = WORK_PER_MARK;

/// What the value of a field costs.
pub(super) const SAMPLE: u64 = 4;

/// What it costs to cut a line to the region, or to hold a dot against it.
pub(super) const BANK: u64 = 16;

/// A limit was passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Exceeded {
    /// More marks than may be drawn.
    Marks,
    /// More looks than may be taken.
    Work,
    /// Nobody waits for the drawing any more.
    Stopped,
    /// The tiles lie on each other so deeply that most of the work would go into what is hidden.
    Overlap {
        /// The side of a tile in millimetres.
        side: f64,
        /// The distance of sites in millimetres.
        spacing: f64,
        /// Tiles over one place.
        depth: u64,
    },
    /// The tiles hold too many lines or dots.
    Places {
        /// What there are too many of.
        what: &'static str,
        /// How many there are, about.
        count: u64,
    },
}

impl Exceeded {
    /// What to tell.
    pub(super) fn diagnostic(self, limits: &Limits, span: Span) -> Diagnostic {
        let error = |message: String| Diagnostic::error(Code::Limit, span, message);
        let most = grouped(limits.strokes);
        match self {
            Self::Marks => error(format!("the drawing has more than {most} strokes"))
                .label("this is too dense, or too large")
                .hint("a wider pitch or larger tiles take fewer strokes; `--limit strokes=…` lifts the limit"),
            Self::Work => error(format!("this takes more work than {most} strokes should"))
                .label("most of it goes into what is hidden or left out")
                .hint("smaller tiles, sites farther apart or a wider pitch take less; `--limit strokes=…` lifts the limit"),
            Self::Stopped => error("the drawing was stopped".to_owned()),
            Self::Overlap { side, spacing, depth } => {
                let (side, spacing, depth) = (short(side), short(spacing), grouped(depth));
                error(format!("tiles of {side}mm at a distance of {spacing}mm overlap {depth} deep"))
                    .label("the tiles lie too close for their size")
                    .hint("smaller tiles or sites farther apart overlap less; `--limit strokes=…` lifts the limit")
            }
            Self::Places { what, count } => error(format!("the tiles hold about {} {what}", grouped(count)))
                .label("this is too dense, or too large")
                .hint("a wider pitch or smaller tiles take fewer; `--limit strokes=…` lifts the limit"),
        }
    }
}

/// A length for people, to three digits.
fn short(mm: f64) -> f64 {
    let scale = [1e4, 1e3, 1e2, 1e1].into_iter().find(|scale| mm * scale < 1e4).unwrap_or(1.0);
    (mm * scale).round() / scale
}

/// Counts what a paint costs.
pub(super) struct Budget {
    limit: u64,
    most_work: u64,
    marks: AtomicU64,
    work: AtomicU64,
    stop: Stop,
}

impl Budget {
    pub(super) fn new(limits: &Limits) -> Self {
        let most_work = limits.strokes.saturating_mul(WORK_PER_MARK).max(LEAST_WORK);
        Self {
            limit: limits.strokes,
            most_work,
            marks: AtomicU64::new(0),
            work: AtomicU64::new(0),
            stop: limits.stop.clone(),
        }
    }

    /// Notes marks that are drawn.
    pub(super) fn mark(&self, count: usize) -> Result<(), Exceeded> {
        if spend(&self.marks, count as u64, self.limit) { Ok(()) } else { Err(Exceeded::Marks) }
    }

    /// Notes looks that are about to be taken. `count` may be infinite.
    pub(super) fn work(&self, count: f64) -> Result<(), Exceeded> {
        if self.stop.is_asked() {
            return Err(Exceeded::Stopped);
        }
        // A cast of what is too great gives the greatest number.
        if spend(&self.work, count as u64, self.most_work) { Ok(()) } else { Err(Exceeded::Work) }
    }

    /// Adds looks to a thread's own tally, which is handed on from time to time.
    pub(super) fn look(&self, tally: &mut u64, count: u64) -> Result<(), Exceeded> {
        *tally = tally.saturating_add(count);
        if *tally < TALLY { Ok(()) } else { self.work(std::mem::take(tally) as f64) }
    }

    /// The most marks.
    pub(super) fn limit(&self) -> usize {
        usize::try_from(self.limit).unwrap_or(usize::MAX)
    }

    /// The most looks.
    pub(super) fn most_work(&self) -> u64 {
        self.most_work
    }
}

/// Whether a limit is kept.
fn spend(spent: &AtomicU64, count: u64, limit: u64) -> bool {
    // Each addition is checked first, so that sums cannot run over.
    count <= limit && spent.fetch_add(count, Ordering::Relaxed) <= limit - count
}
