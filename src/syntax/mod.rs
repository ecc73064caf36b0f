//! The two front ends: text to [`ast::Document`] and back.

#[cfg(test)]
mod arbitrary;
pub mod ast;
pub mod format;
pub mod kake;
pub mod toml;
