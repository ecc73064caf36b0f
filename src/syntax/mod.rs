//! The two front ends: text to [`ast::Document`] and back.

pub mod ast;
pub mod format;
