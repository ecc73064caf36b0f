//! The passes: from a paint of the scene to what is drawn, one plain function a step.
//!
//! Each takes the types of the stages before it and returns its own, complete. What they are given is valid, so that
//! they can only run into a limit; none of them panics.

pub mod cut;
pub mod draw;
#[cfg(test)]
pub(crate) mod fixture;
pub mod link;
pub mod place;
mod thin;
pub mod turn;
