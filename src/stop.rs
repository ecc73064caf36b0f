//! Asking a compilation to stop: whoever has a newer one to run need not wait for the older.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether a compilation goes on. All copies of one are asked together; the default is never asked.
#[derive(Debug, Clone, Default)]
pub struct Stop(Option<Arc<AtomicBool>>);

impl Stop {
    /// One that can be asked.
    #[must_use]
    pub fn new() -> Self {
        Self(Some(Arc::default()))
    }

    /// Asks for an end. What runs ends soon, without a result; nothing tells when.
    pub fn ask(&self) {
        if let Some(asked) = &self.0 {
            asked.store(true, Ordering::Relaxed);
        }
    }

    /// Whether an end was asked for.
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.as_ref().is_some_and(|asked| asked.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_asked_together_and_the_default_never() {
        let stop = Stop::new();
        let copy = stop.clone();
        assert!(!copy.is_asked());
        stop.ask();
        assert!(copy.is_asked());
        let never = Stop::default();
        never.ask();
        assert!(!never.is_asked());
    }
}
