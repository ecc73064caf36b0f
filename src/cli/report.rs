//! Diagnostics on standard error.

use std::io::{self, IsTerminal};

use crate::diag::{Code, Diagnostic, RenderConfig, render};
use crate::span::Sources;

use super::Ended;
use super::files::OpenError;

/// Columns where standard error is no terminal.
const WIDTH: usize = 100;

/// Prints diagnostics; a fault if any is an error.
pub(super) fn diagnostics(diagnostics: &[Diagnostic], sources: &Sources) -> Ended {
    if !diagnostics.is_empty() {
        let terminal = io::stderr().is_terminal();
        let colour = terminal && std::env::var_os("NO_COLOR").is_none();
        eprint!("{}", render(diagnostics, sources, RenderConfig { width: WIDTH, colour, unicode: true }));
    }
    if diagnostics.iter().any(Diagnostic::is_error) { Ended::Fault } else { Ended::Done }
}

/// Says why a scene cannot be opened.
pub(super) fn cannot_open(error: OpenError) -> Ended {
    match error {
        OpenError::Words(words, ended) => {
            eprintln!("kake: {words}");
            ended
        }
        OpenError::NoScene(path) => {
            let message = format!("{path} holds no scene");
            let hint = "pictures can be built again unless they were written with `--embed none`";
            let diagnostic = Diagnostic::without_span(Code::Metadata, message).hint(hint);
            diagnostics(&[diagnostic], &Sources::new())
        }
    }
}
