//! `kake wedge`: the calibration wedge of a tone.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::json;

use crate::wedge::{Wedge, WedgeConfig, wedge};

use super::build::{Kind, cannot_write, kind_of, parse_dpi, write};
use super::files::{open, print};
use super::picture::Form;
use super::{Ended, SceneArgs, report};

/// Steps where `--steps` does not say otherwise.
const STEPS: u16 = 32;

#[derive(Debug, Args)]
pub(super) struct WedgeArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// The tone, by its name or with arguments: 'etched(tile: 3mm)'. It may be left out where the scene declares just
    /// one. Its `darkness` is asked for from 0 to 1, or its `k` from 0 to 4, whatever its parameters say
    tone: Option<String>,
    /// Where the patches are drawn to: FILE.svg, FILE.png…; several times for several files. Without it the values are
    /// printed alone
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// How many patches
    #[arg(long, value_name = "N", default_value_t = STEPS, value_parser = clap::value_parser!(u16).range(2..=256))]
    steps: u16,
    /// Replace the canvas's resolution, in pixels per inch
    #[arg(long, value_name = "N", value_parser = parse_dpi)]
    dpi: Option<f64>,
    /// How the values are printed
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Columns for people
    Table,
    /// An object with a list of steps
    Json,
    /// Comma-separated values
    Csv,
}

pub(super) fn run(arguments: &WedgeArgs) -> Ended {
    let mut outputs: Vec<(&Path, Kind)> = Vec::new();
    for output in &arguments.output {
        match kind_of(output) {
            // Standard output is for the values.
            Ok(_) if output == Path::new("-") => {
                eprintln!("kake: the values go to standard output, so that the picture needs a file");
                return Ended::Usage;
            }
            Ok(kind) => outputs.push((output, kind)),
            Err(message) => {
                eprintln!("kake: {message}");
                return Ended::Usage;
            }
        }
    }
    let opened = match open(&arguments.scene.scene, arguments.scene.root.as_deref()) {
        Ok(opened) => opened,
        Err(error) => return report::cannot_open(error),
    };
    let mut config = arguments.scene.config(None);
    config.lower.dpi = arguments.dpi;
    super::picture::take_over(&mut config, &opened);
    let config = WedgeConfig { lower: config.lower, steps: u32::from(arguments.steps) };
    let drawn = wedge(&opened.path, &opened.loader, arguments.tone.as_deref(), &config);
    let ended = report::diagnostics(&drawn.diagnostics, &drawn.sources);
    let Some(wedge) = &drawn.wedge else { return ended };
    let mut pending = Vec::new();
    for (target, kind) in outputs {
        match write(&wedge.drawing, None, (kind, Form::Page), target) {
            Ok(file) => pending.extend(file.map(|file| (target, file))),
            Err(error) => return cannot_write(target, &error),
        }
    }
    for (target, file) in pending {
        if let Err(error) = file.keep() {
            return cannot_write(target, &error);
        }
    }
    print(text(wedge, arguments.format).as_bytes())
}

/// The values as they are printed.
fn text(wedge: &Wedge, format: Format) -> String {
    let asks = wedge.asks.name();
    match format {
        Format::Table => {
            let mut text = format!("{asks:>8}  reckoned  measured\n");
            for step in &wedge.steps {
                text += &format!("{:>8.3}  {:>8.3}  {:>8.3}\n", step.asked, step.reckoned, step.measured);
            }
            text
        }
        Format::Csv => {
            let mut text = format!("{asks},reckoned,measured\n");
            for step in &wedge.steps {
                text += &format!("{},{},{}\n", step.asked, step.reckoned, step.measured);
            }
            text
        }
        Format::Json => {
            let step = |step: &crate::wedge::Step| json!({ "asked": step.asked, "reckoned": step.reckoned, "measured": step.measured });
            let steps: Vec<_> = wedge.steps.iter().map(step).collect();
            format!("{:#}\n", json!({ "tone": wedge.tone, "asks": asks, "steps": steps }))
        }
    }
}
