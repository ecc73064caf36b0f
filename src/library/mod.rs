//! Libraries of tones as they lie under version control: what says which one it is and what it depends on, what pins down
//! other libraries, and what pins down its pictures.
//!
//! In: the texts of `kake.toml`, `kake.lock` and `pins/*.toml`, and the bytes of files. Out: a [`Manifest`], a [`Lock`], a
//! [`Pin`], what is wrong with them, and the same as text again. Files are read and written by the command line alone.

pub mod junit;
pub mod lock;
pub mod manifest;
pub mod markdown;
pub mod page;
pub mod pin;
pub mod review;

pub use lock::Lock;
pub use manifest::{Dependency, Library, Manifest};
pub use pin::Pin;
pub use review::Review;

/// The name of a library's manifest, which also marks the root folder of what its scenes may read.
pub const MANIFEST: &str = "kake.toml";

/// The name of what pins down a library's dependencies.
pub const LOCK: &str = "kake.lock";
