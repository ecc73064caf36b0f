//! Diagnostics as text, through miette, and as JSON.

use super::Diagnostic;
use crate::span::Sources;

/// How diagnostics are drawn.
#[derive(Debug, Clone, Copy)]
pub struct RenderConfig {
    /// Columns.
    pub width: usize,
    /// With ANSI colours.
    pub colour: bool,
    /// With line-drawing characters rather than ASCII.
    pub unicode: bool,
}

/// Diagnostics as people read them.
#[must_use]
pub fn render(_diagnostics: &[Diagnostic], _sources: &Sources, _config: RenderConfig) -> String {
    String::new()
}

/// Diagnostics as data.
#[must_use]
pub fn to_json(_diagnostics: &[Diagnostic], _sources: &Sources) -> serde_json::Value {
    serde_json::Value::Null
}
