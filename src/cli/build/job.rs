//! One build: a configuration and the pictures that it makes.

use std::path::PathBuf;

use crate::back::plot::plot;
use crate::cli::files::Opened;
use crate::cli::picture::{Embed, Form, is_plot, metadata, overlays, set_plot, take_over};
use crate::cli::progress::Progress;
use crate::cli::{Ended, report};
use crate::diag::{Code, Diagnostic};
use crate::drawing::Drawing;
use crate::scene::Limits;
use crate::{Compiled, Config, compile};

use super::BuildArgs;
use super::output::{Kind, failure, write};

/// One build.
pub(super) struct Job<'a> {
    opened: &'a Opened,
    pub(super) config: Config,
    form: Form,
    embed: Embed,
    is_plotted: bool,
    /// The files with their kinds.
    pub(super) outputs: Vec<(PathBuf, Kind)>,
}

/// What came of a build.
pub(super) struct Done {
    /// What is to be told, in lines.
    pub(super) words: String,
    pub(super) ended: Ended,
    /// The picture, where there is one.
    pub(super) drawing: Option<Drawing>,
}

impl Done {
    fn fault(words: String) -> Self {
        Self { words, ended: Ended::Fault, drawing: None }
    }
}

impl<'a> Job<'a> {
    /// What the command line asks for, with a seed and further parameters.
    pub(super) fn new(
        arguments: &BuildArgs,
        opened: &'a Opened,
        (seed, sets): (Option<u64>, &[(String, String)]),
        outputs: Vec<(PathBuf, Kind)>,
    ) -> Self {
        let mut config = arguments.scene.config(seed);
        config.lower.dpi = arguments.dpi;
        config.lower.sets.extend(sets.iter().cloned());
        config.only.clone_from(&arguments.only);
        take_over(&mut config, opened);
        if !arguments.plot {
            config.overlays = overlays(&arguments.overlay, opened);
        }
        let form = arguments.form.or_else(|| Form::of(opened)).unwrap_or(Form::Page);
        // What is shown on top of a picture is no part of its plot.
        let is_plotted = arguments.plot || config.overlays.is_empty() && opened.picture.as_ref().is_some_and(is_plot);
        Self { opened, config, form, embed: arguments.embed, is_plotted, outputs }
    }

    fn has(&self, wanted: Kind) -> bool {
        self.outputs.iter().any(|(_, kind)| *kind == wanted)
    }

    /// Compiles the scene and writes the pictures: all of them or, should one fail, none.
    pub(super) fn run(&self, progress: &mut Progress) -> Done {
        let mut compiled = compile(&self.opened.path, &self.opened.loader, &self.config, progress);
        if self.has(Kind::Png) {
            check_pixels(&mut compiled, &self.config.lower.limits);
        }
        let diagnostics = &compiled.lowered.diagnostics;
        let mut words = report::words(diagnostics, &compiled.lowered.sources);
        let missing = |diagnostic: &Diagnostic| matches!(diagnostic.code, Code::File | Code::Import);
        if self.opened.picture.is_some() && diagnostics.iter().any(missing) {
            words += "kake: the picture holds its scene, but not every file that the scene reads\n\
                      kake: name the folder they lie in by `--root DIR`, or build pictures with `--embed all`\n";
        }
        let drawing = match compiled.drawing.take() {
            Some(drawing) if !diagnostics.iter().any(Diagnostic::is_error) => drawing,
            _ => return Done::fault(words),
        };
        let repeats = compiled.lowered.scene.as_ref().is_some_and(|scene| scene.canvas.period().is_some());
        if self.form == Form::Pattern && !repeats {
            return Done::fault(words + "kake: a pattern needs a canvas that repeats: `canvas { … repeat: true }`\n");
        }
        if let Some((target, _)) = self.outputs.iter().find(|(target, _)| self.opened.loader.has_read(target)) {
            words += &format!("kake: {} is read by the scene; name another output\n", target.display());
            return Done { words, ended: Ended::Usage, drawing: None };
        }
        let (ended, more) = self.write(&compiled, &drawing, progress);
        Done { words: words + &more, ended, drawing: Some(drawing) }
    }

    /// Writes the pictures; how it ended, and what is to be told.
    fn write(&self, compiled: &Compiled, drawing: &Drawing, progress: &mut Progress) -> (Ended, String) {
        let mut metadata = metadata(self.embed, &self.config, (self.opened, self.form), compiled);
        let plot = (self.is_plotted && self.has(Kind::Svg)).then(|| {
            progress.step("plot", "");
            plot(drawing)
        });
        if plot.is_some()
            && let Some(metadata) = &mut metadata
        {
            set_plot(metadata);
        }
        let failed = |target: &PathBuf, error: &std::io::Error| match failure(target, error) {
            Some(words) => (Ended::Io, words),
            None => (Ended::Done, String::new()),
        };
        // All are written beside their places first, so that a full disk leaves every old file as it was.
        let mut pending = Vec::new();
        for (target, kind) in &self.outputs {
            progress.step(kind.name(), "");
            let drawing = match (&plot, kind) {
                (Some(plot), Kind::Svg) => &plot.drawing,
                (_, Kind::Svg | Kind::Png | Kind::Pdf | Kind::Json) => drawing,
            };
            match write(drawing, metadata.as_ref(), (*kind, self.form), target) {
                Ok(file) => pending.extend(file.map(|file| (target, file))),
                Err(error) => return failed(target, &error),
            }
        }
        for (target, file) in pending {
            if let Err(error) = file.keep() {
                return failed(target, &error);
            }
        }
        (Ended::Done, plot.as_ref().map(report::plot).unwrap_or_default())
    }
}

/// A picture of more pixels than the limit is not drawn.
pub(in crate::cli) fn check_pixels(compiled: &mut Compiled, limits: &Limits) {
    let Some(drawing) = &compiled.drawing else { return };
    let [width, height] = drawing.page.pixels;
    let most = limits.megapixels.saturating_mul(1_000_000);
    let pixels = u64::from(width) * u64::from(height);
    if pixels <= most {
        return;
    }
    let message =
        format!("the PNG would have {width} x {height} pixels; the limit is {} megapixels", limits.megapixels);
    let diagnostic = match compiled.lowered.canvas_span {
        Some(span) => Diagnostic::error(Code::Limit, span, message),
        None => Diagnostic::without_span(Code::Limit, message),
    };
    let hint = format!("give a lower `dpi`, or lift it: `--limit megapixels={}`", pixels.div_ceil(1_000_000));
    compiled.lowered.diagnostics.push(diagnostic.hint(hint));
    compiled.drawing = None;
}
