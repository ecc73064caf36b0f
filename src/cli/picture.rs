//! What a picture says of how it was made, and what a new picture says of it.

use std::collections::BTreeMap;

use clap::ValueEnum;

use crate::back::metadata::Metadata;
use crate::bundle;
use crate::lower::Lowered;
use crate::overlay::Overlay;
use crate::{Compiled, Config};

use super::files::Opened;

/// What goes into a picture besides the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Embed {
    /// The scene's text with its imports, the seed and the parameters
    Text,
    /// Every file that was read too
    All,
    /// Nothing
    None,
}

/// What an SVG is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Form {
    /// The page itself
    Page,
    /// A swatch: the page as a pattern, shown two by two times
    Pattern,
}

impl Form {
    /// The option that a picture was made with.
    const OPTION: &str = "as";

    fn name(self) -> &'static str {
        match self {
            Self::Page => "page",
            Self::Pattern => "pattern",
        }
    }

    /// What a picture was made as, if it says so.
    pub(super) fn of(opened: &Opened) -> Option<Self> {
        let said = opened.picture.as_ref()?.options.get(Self::OPTION)?;
        [Self::Page, Self::Pattern].into_iter().find(|form| form.name() == said)
    }
}

/// Sets what a picture was made with, unless the command line says otherwise.
pub(super) fn take_over(config: &mut Config, opened: &Opened) {
    let Some(picture) = &opened.picture else { return };
    for (name, value) in &picture.params {
        if !config.lower.sets.iter().any(|(set, _)| set == name) {
            config.lower.sets.push((name.clone(), value.clone()));
        }
    }
    config.lower.seed = config.lower.seed.or(Some(picture.seed));
    let dpi = picture.options.get("dpi").and_then(|dpi| dpi.parse().ok());
    config.lower.dpi = config.lower.dpi.or(dpi);
    config.only = config.only.take().or_else(|| picture.options.get("only").cloned());
}

/// The option that says what a picture shows on top.
const OVERLAY: &str = "overlay";

/// What stands for no overlay.
pub(super) const NO_OVERLAY: &str = "none";

/// The overlays of these names; where none is named, those that a picture was made with.
pub(super) fn overlays(names: &[String], opened: &Opened) -> Vec<Overlay> {
    let said = opened.picture.as_ref().and_then(|picture| picture.options.get(OVERLAY));
    let list = |names: &mut dyn Iterator<Item = &str>| names.filter_map(Overlay::from_name).collect();
    match said {
        Some(said) if names.is_empty() => list(&mut said.split(',')),
        _ => list(&mut names.iter().map(String::as_str)),
    }
}

/// The option that says that a picture is a plot.
const PLOT: &str = "plot";

/// Whether a picture was made for a plotter; what is built from it is too.
pub(super) fn is_plot(picture: &Metadata) -> bool {
    picture.options.contains_key(PLOT)
}

/// Says that a picture was made for a plotter.
pub(super) fn set_plot(picture: &mut Metadata) {
    picture.options.insert(PLOT.to_owned(), String::new());
}

/// How a picture was made, for the picture itself.
pub(super) fn metadata(
    embed: Embed,
    config: &Config,
    (opened, form): (&Opened, Form),
    compiled: &Compiled,
) -> Option<Metadata> {
    let scene = compiled.lowered.scene.as_ref()?;
    if embed == Embed::None {
        return None;
    }
    let mut options = BTreeMap::new();
    if let Some(dpi) = config.lower.dpi {
        options.insert("dpi".to_owned(), dpi.to_string());
    }
    if let Some(only) = &config.only {
        options.insert("only".to_owned(), only.clone());
    }
    if !config.overlays.is_empty() {
        let names: Vec<&str> = config.overlays.iter().map(|overlay| overlay.name()).collect();
        options.insert(OVERLAY.to_owned(), names.join(","));
    }
    if form != Form::Page {
        options.insert(Form::OPTION.to_owned(), form.name().to_owned());
    }
    Some(Metadata {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: scene.seed,
        scene: opened.path.clone(),
        params: config.lower.sets.iter().cloned().collect(),
        options,
        sources: sources(&compiled.lowered),
        dependencies: opened.loader.aliases(),
        files: match embed {
            Embed::All => compiled.lowered.files.iter().map(|(path, bytes)| (path.clone(), bytes.to_vec())).collect(),
            Embed::Text | Embed::None => Vec::new(),
        },
    })
}

/// The texts of files; values from the command line are kept as parameters.
pub(super) fn sources(lowered: &Lowered) -> Vec<(String, String)> {
    let files = lowered.sources.iter().filter(|(_, source)| !source.name.starts_with("--"));
    // What a bundle holds besides its scene are files of their own.
    files.map(|(_, source)| (source.name.clone(), bundle::split(&source.text).0.to_owned())).collect()
}
