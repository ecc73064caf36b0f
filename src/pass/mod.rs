//! The passes: plain functions from one stage's type to the next.

pub mod cut;
pub mod draw;
