//! The two front ends: text to [`ast::Document`] and back.

#[cfg(test)]
mod arbitrary;
pub mod ast;
pub mod edit;
pub mod format;
pub mod kake;
pub mod toml;

use std::sync::Arc;

use crate::diag::{Code, Diagnostic};
use crate::span::{SourceId, Sources, Span, Syntax};

/// Adds a file's bytes to the sources as text.
///
/// # Errors
/// Where the bytes are not UTF-8, at the first that does not fit.
pub fn decode(
    name: &str,
    bytes: &[u8],
    syntax: Syntax,
    sources: &mut Sources,
) -> Result<(SourceId, Arc<str>), Diagnostic> {
    match kake::decode_utf8(bytes) {
        Ok(text) => {
            let source = sources.add(name, text, syntax);
            Ok((source, Arc::clone(&sources.get(source).text)))
        }
        Err(offset) => {
            // Up to there the text is as it stands, so that the place can be shown.
            let source = sources.add(name, String::from_utf8_lossy(bytes), syntax);
            let span = Span::new(source, offset, offset + char::REPLACEMENT_CHARACTER.len_utf8());
            let message = format!("`{name}` is not UTF-8: byte {} does not fit", offset + 1);
            let diagnostic = Diagnostic::error(Code::Encoding, span, message).label("not a character");
            Err(diagnostic.hint("save the file as UTF-8"))
        }
    }
}
