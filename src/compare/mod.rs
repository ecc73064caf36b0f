//! What changed between two drawings and the patterns behind them.
//!
//! In: finished drawings, pictures of them, tiles of paints. Out: a [`Fingerprint`], which is the same for drawings that look
//! the same; what went and what came as pixels ([`pictures`]) and stroke by stroke ([`marks`]); what became of tiles
//! ([`tiles`]). Nothing here reads a scene: comments, names of files and the program's version change nothing.

mod fingerprint;
mod marks;
mod overlap;
mod picture;
mod tiles;

pub use fingerprint::{Fingerprint, fingerprint, layers};
pub use marks::{CAME, STAYED, WENT, common, drawn, marks};
pub use picture::{Difference, pictures, pictures_on};
pub use tiles::{Pattern, Shift, tiles};
