//! Diagnostics, and what a plot costs, on standard error.

use std::io::{self, IsTerminal};

use crate::back::plot::{Plot, Travel};
use crate::diag::{Code, Diagnostic, RenderConfig, render};
use crate::geom::Length;
use crate::span::Sources;

use super::Ended;
use super::files::OpenError;
use super::packages::Packages;

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

/// Diagnostics as text without colours, for files and for later.
pub(super) fn text(diagnostics: &[Diagnostic], sources: &Sources) -> String {
    match diagnostics {
        [] => String::new(),
        found => render(found, sources, RenderConfig { width: WIDTH, colour: false, unicode: true }),
    }
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
        OpenError::Manifest(faults) => diagnostics(&faults.diagnostics, &faults.sources),
    }
}

/// Warns of dependencies that are not what was locked.
pub(super) fn locks(packages: &Packages) {
    let (found, sources) = packages.unlocked();
    diagnostics(&found, &sources);
}

/// Says how far a pen goes in each layer of a plot and in all of them, and what is not drawn as it looks.
pub(super) fn plot(plot: &Plot) {
    for warning in &plot.warnings {
        eprintln!("kake: {warning}");
    }
    let all = plot.layers.iter().fold((Travel::default(), Travel::default()), |(before, after), layer| {
        (before.and(layer.before), after.and(layer.after))
    });
    let layers = plot.layers.iter().map(|layer| (layer.name.as_str(), layer.before, layer.after));
    let sum = (plot.layers.len() != 1).then_some(("all", all.0, all.1));
    let rows: Vec<_> = layers.chain(sum).collect();
    let width = rows.iter().map(|(name, ..)| name.chars().count()).max().unwrap_or(0);
    for (name, before, after) in rows {
        eprintln!(
            "{name:width$}  {:>8} lifts  {:>9} down  {:>9} up   (as drawn: {} lifts, {} up)",
            after.lifts,
            metres(after.down),
            metres(after.up),
            before.lifts,
            metres(before.up)
        );
    }
}

/// A length that may be long.
fn metres(length: Length) -> String {
    let mm = length.to_mm();
    if mm < 1000.0 { format!("{mm:.1} mm") } else { format!("{:.2} m", mm / 1000.0) }
}
