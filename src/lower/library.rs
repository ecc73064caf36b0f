//! The standard libraries: scenes that come with the program and are imported as `"std:name"`.
//!
//! They lie in the folder `std` of the repository and are part of the program, so that they can be read whatever the
//! root of a scene is.

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::span::Span;

/// What the path of an import starts with that means a standard library.
const PREFIX: &str = "std:";

/// The name of every library with its text.
const LIBRARIES: [(&str, &str); 1] = [("manga", include_str!("../../std/manga.kake"))];

/// Whether the path of an import means a standard library.
pub(super) fn is_library(path: &str) -> bool {
    path.starts_with(PREFIX)
}

/// The text of the library that a path means.
pub(super) fn text(path: &str) -> Option<&'static str> {
    let name = path.strip_prefix(PREFIX)?;
    LIBRARIES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The path of every library with its text.
pub(super) fn all() -> impl Iterator<Item = (String, &'static str)> {
    LIBRARIES.into_iter().map(|(name, text)| (format!("{PREFIX}{name}"), text))
}

/// Says that there is no library of a path.
pub(super) fn unknown(path: &str, span: Span) -> Diagnostic {
    let names = LIBRARIES.map(|(name, _)| format!("{PREFIX}{name}"));
    let known = || names.iter().map(String::as_str);
    let listed = || names.iter().map(|name| format!("`\"{name}\"`")).collect::<Vec<_>>().join(", ");
    let hint = did_you_mean(path, known()).unwrap_or_else(|| format!("this version brings {}", listed()));
    Diagnostic::error(Code::Import, span, format!("there is no standard library `{path}`")).hint(hint)
}
