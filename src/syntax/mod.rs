//! The two front ends: text to [`ast::Document`] and back.

pub mod ast;
pub mod format;
pub mod kake;
pub mod toml;
