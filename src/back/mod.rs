//! Back ends: a finished [`Drawing`](crate::drawing::Drawing) goes in, the bytes of a picture come out.
//!
//! They decide nothing about the picture: marks are already cut, placed and inked. The same drawing gives the same
//! bytes whatever the number of threads, the locale and the time; SVG text is the same on every machine.

pub mod json;
pub mod metadata;
mod number;
mod outline;
pub mod png;
pub mod raster;
pub mod svg;
