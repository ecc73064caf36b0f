//! How far a build is, on a terminal, and how long its steps took.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::{Observer, Step};

/// Builds that end sooner show no progress.
const PATIENCE: Duration = Duration::from_millis(700);

/// Watches a build.
pub(super) struct Progress {
    begun: Instant,
    current: Option<(String, Instant)>,
    /// What was spent on each step, in the order of their first beginning.
    spent: Vec<(String, Duration)>,
    bar: ProgressBar,
}

impl Progress {
    /// From now on.
    pub(super) fn new() -> Self {
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
            bar.set_style(style);
        }
        Self { begun: Instant::now(), current: None, spent: Vec::new(), bar }
    }

    /// From now on, without a bar: one of several builds at a time.
    pub(super) fn unseen() -> Self {
        Self { begun: Instant::now(), current: None, spent: Vec::new(), bar: ProgressBar::hidden() }
    }

    /// A step begins, and the one before it ends.
    pub(super) fn step(&mut self, name: &str, detail: &str) {
        self.close();
        self.current = Some((name.to_owned(), Instant::now()));
        if self.begun.elapsed() > PATIENCE {
            // indicatif draws on terminals only.
            self.bar.set_message(if detail.is_empty() { name.to_owned() } else { format!("{name} {detail}") });
            self.bar.enable_steady_tick(Duration::from_millis(100));
        }
    }

    fn close(&mut self) {
        let Some((name, since)) = self.current.take() else { return };
        let spent = since.elapsed();
        match self.spent.iter_mut().find(|(known, _)| *known == name) {
            Some((_, total)) => *total += spent,
            None => self.spent.push((name, spent)),
        }
    }

    /// Ends the last step and takes the bar away; what each step took, then the whole.
    pub(super) fn finish(mut self) -> Vec<(String, Duration)> {
        self.close();
        self.bar.finish_and_clear();
        let mut spent = std::mem::take(&mut self.spent);
        spent.push(("total".to_owned(), self.begun.elapsed()));
        spent
    }
}

impl Observer for Progress {
    fn begin(&mut self, step: Step, paint: &str) {
        self.step(step.name(), paint);
    }
}

/// Counts how many of several things are done, with the time that is left.
pub(super) struct Bar(ProgressBar);

impl Bar {
    /// Of so many, of which some are done already.
    pub(super) fn new(what: &'static str, all: usize, done: usize) -> Self {
        // indicatif draws on terminals only.
        let bar = ProgressBar::new(all as u64);
        if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}, {eta} left") {
            bar.set_style(style);
        }
        bar.set_message(what);
        bar.set_position(done as u64);
        // What was done before says nothing about how fast the rest goes.
        bar.reset_eta();
        Self(bar)
    }

    /// One more is done.
    pub(super) fn advance(&self) {
        self.0.inc(1);
    }

    /// Takes the bar away.
    pub(super) fn finish(self) {
        self.0.finish_and_clear();
    }
}
