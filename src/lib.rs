//! Kakeami: a compiler for manga's hand-hatched tone.

pub mod back;
pub mod diag;
pub mod drawing;
pub mod field;
pub mod geom;
pub mod loader;
pub mod pass;
pub mod random;
pub mod region;
pub mod scene;
pub mod span;
pub mod stage;
pub mod syntax;
