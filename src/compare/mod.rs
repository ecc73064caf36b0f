//! What changed between two drawings: whether they are the same, and a picture of what went and what came.
//!
//! In: finished drawings, or pictures of them. Out: a [`Fingerprint`], which is the same for drawings that look the same,
//! and a [`Difference`]. Nothing here reads a scene: comments, names of files and the program's version change nothing.

mod fingerprint;
mod picture;

pub use fingerprint::{Fingerprint, fingerprint};
pub use picture::{Difference, pictures, pictures_on};
