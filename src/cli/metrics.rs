//! `kake metrics`: what the patterns of a scene measure.

mod charts;
mod picture;
mod table;

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rayon::prelude::*;
use serde::Serialize;

use crate::diag::{self, Diagnostic};
use crate::illustrate::Sketch;
use crate::lower::lower;
use crate::metrics::read::read;
use crate::metrics::ssim::Grey;
use crate::metrics::{Measured, Measures, Scalars};
use crate::span::Sources;
use crate::{Config, PaintStages, compile, no_such_paint, paints};

use super::build::{Seeds, parse_seeds};
use super::files::{Opened, open, plain, print};
use super::{Ended, SceneArgs, report};

/// More seeds than anyone waits for.
const MOST_SEEDS: u64 = 1_000_000;

#[derive(Debug, Args)]
pub(super) struct MetricsArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Replace the scene's seed
    #[arg(long, value_name = "N", conflicts_with = "seeds")]
    seed: Option<u64>,
    /// Measure once for each seed from A to B
    #[arg(long, value_name = "A..B", value_parser = parse_seeds)]
    seeds: Option<Seeds>,
    /// How the figures are printed
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    /// Measure this paint alone
    #[arg(long, value_name = "PAINT")]
    only: Option<String>,
    /// Compare the picture with this one, a PNG or JPEG file of the page's shape: adds the structural similarity `ssim`
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Draw charts into this folder, for every paint PAINT-correlogram.svg, -decay, -spectrum, -directions, -contrast and
    /// -cells; of several seeds the means with their standard deviations
    #[arg(long, value_name = "DIR")]
    charts: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Names and values for people
    Table,
    /// An object with a list of paints
    Json,
    /// Comma-separated values, a row for every paint and seed
    Csv,
}

/// What one paint measures with one seed.
#[derive(Debug, Serialize)]
struct Entry {
    paint: String,
    /// None where the pattern was read from a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    #[serde(flatten)]
    measures: Measures,
    /// How alike the picture and the reference are.
    #[serde(skip_serializing_if = "Option::is_none")]
    ssim: Option<f64>,
    /// What its charts need, where they are asked for.
    #[serde(skip)]
    sketch: Option<Sketch>,
}

impl Entry {
    /// Every single figure by its name.
    fn scalars(&self) -> Scalars {
        let mut scalars = self.measures.scalars();
        if self.ssim.is_some() {
            scalars.push(("ssim".into(), self.ssim));
        }
        scalars
    }
}

/// What came of one seed.
struct Run {
    entries: Vec<Entry>,
    diagnostics: Vec<Diagnostic>,
    sources: Sources,
    /// What is wrong with the comparison.
    misfit: Option<String>,
}

pub(super) fn run(arguments: &MetricsArgs) -> Ended {
    let found = if is_pattern(&arguments.scene.scene) { patterns(arguments) } else { scene(arguments) };
    let entries = match found {
        Ok(entries) => entries,
        Err(ended) => return ended,
    };
    if entries.is_empty() {
        eprintln!("kake: there is no paint to be measured");
    }
    if let Some(folder) = &arguments.charts
        && !entries.is_empty()
    {
        match charts::write(folder, &entries) {
            Ended::Done => {}
            ended => return ended,
        }
    }
    let printed = match arguments.format {
        Format::Table => Ok(table::text(&entries).into_bytes()),
        Format::Json => json(&entries),
        Format::Csv => csv(&entries),
    };
    match printed {
        Ok(bytes) => print(&bytes),
        Err(words) => {
            eprintln!("kake: {words}");
            Ended::Io
        }
    }
}

/// Whether a file holds patterns rather than a scene.
fn is_pattern(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// Measures patterns that a file holds.
fn patterns(arguments: &MetricsArgs) -> Result<Vec<Entry>, Ended> {
    let path = &arguments.scene.scene;
    let given = [
        ("--seed", arguments.seed.is_some()),
        ("--seeds", arguments.seeds.is_some()),
        ("--set", !arguments.scene.set.is_empty()),
        ("--against", arguments.against.is_some()),
    ];
    if let Some((name, _)) = given.iter().find(|(_, is_given)| *is_given) {
        eprintln!("kake: {name} is for scenes, and {} holds patterns as they are", path.display());
        return Err(Ended::Usage);
    }
    let text = fs::read(path).map_err(|error| {
        eprintln!("kake: cannot read {}: {}", path.display(), plain(&error));
        Ended::Io
    })?;
    let mut patterns = read(&text, arguments.scene.limits().tiles).map_err(|bad| {
        eprintln!("kake: {}: {bad}", path.display());
        Ended::Fault
    })?;
    if let Some(only) = &arguments.only {
        let names: Vec<String> = patterns.iter().map(|pattern| pattern.name.clone()).collect();
        patterns.retain(|pattern| pattern.name == *only);
        if patterns.is_empty() {
            return Err(report::diagnostics(&[no_such_paint(only, &names)], &Sources::new()));
        }
    }
    let entry = |pattern: &Measured| entry(pattern, None, arguments);
    Ok(patterns.par_iter().map(entry).collect())
}

/// Measures a scene for every seed that is asked for, paint by paint.
fn scene(arguments: &MetricsArgs) -> Result<Vec<Entry>, Ended> {
    let seeds: Vec<Option<u64>> = match arguments.seeds {
        Some(Seeds(from, to)) if to - from >= MOST_SEEDS => {
            eprintln!("kake: these are more than {MOST_SEEDS} seeds");
            return Err(Ended::Usage);
        }
        Some(Seeds(from, to)) => (from..=to).map(Some).collect(),
        None => vec![arguments.seed],
    };
    let opened = open(&arguments.scene.scene, arguments.scene.root.as_deref()).map_err(report::cannot_open)?;
    let megapixels = arguments.scene.limits().megapixels;
    let reference = arguments.against.as_deref().map(|path| picture::reference(path, megapixels)).transpose()?;
    let config = |seed| {
        let mut config = arguments.scene.config(seed);
        config.only.clone_from(&arguments.only);
        super::picture::take_over(&mut config, &opened);
        config
    };
    let runs: Vec<Run> =
        seeds.into_par_iter().map(|seed| measure(&opened, &config(seed), reference.as_ref(), arguments)).collect();
    // What is wrong with a scene is mostly wrong with every seed; once is enough.
    let worst = runs.iter().find(|run| run.diagnostics.iter().any(Diagnostic::is_error)).or(runs.first());
    if let Some(run) = worst
        && report::diagnostics(&run.diagnostics, &run.sources) != Ended::Done
    {
        return Err(Ended::Fault);
    }
    if let Some(words) = runs.iter().find_map(|run| run.misfit.as_ref()) {
        eprintln!("kake: {words}");
        return Err(Ended::Fault);
    }
    let mut entries: Vec<(usize, Entry)> =
        runs.into_iter().flat_map(|run| run.entries.into_iter().enumerate()).collect();
    // Paint by paint, in each by seed: the sort is stable.
    entries.sort_by_key(|(paint, _)| *paint);
    Ok(entries.into_iter().map(|(_, entry)| entry).collect())
}

/// Measures a pattern.
fn entry(measured: &Measured, seed: Option<u64>, arguments: &MetricsArgs) -> Entry {
    let measures = Measures::new(measured);
    let sketch = arguments.charts.is_some().then(|| Sketch::new(measured, &measures));
    Entry { paint: measured.name.clone(), seed, measures, ssim: None, sketch }
}

/// Measures every paint of a scene with one seed.
fn measure(opened: &Opened, config: &Config, reference: Option<&Grey>, arguments: &MetricsArgs) -> Run {
    let mut lowered = lower(&opened.path, &opened.loader, &config.lower);
    let mut found = Vec::new();
    let mut entries = Vec::new();
    if let Some(scene) = &lowered.scene {
        let names: Vec<String> = paints(scene).map(|paint| paint.name.clone()).collect();
        if let Some(only) = config.only.as_ref().filter(|only| !names.contains(only)) {
            found.push(no_such_paint(only, &names));
        }
        for paint in paints(scene).filter(|paint| config.only.as_ref().is_none_or(|only| paint.name == *only)) {
            match PaintStages::new(paint, &scene.canvas, &config.lower.limits, &mut (), &mut found) {
                Ok(stages) => {
                    let measured = Measured::new(paint, &stages.borrow());
                    entries.push(entry(&measured, Some(scene.seed), arguments));
                }
                Err(diagnostic) => found.push(diagnostic),
            }
        }
    }
    lowered.diagnostics.append(&mut found);
    let mut misfit = None;
    if let Some(reference) = reference
        && !lowered.diagnostics.iter().any(Diagnostic::is_error)
    {
        // The passes' warnings are there already; drawing may find more.
        let compiled = compile(&opened.path, &opened.loader, config, &mut ());
        lowered.diagnostics = compiled.lowered.diagnostics;
        match compiled.drawing.map(|drawing| picture::similarity(drawing, reference)) {
            Some(Ok(ssim)) => entries.iter_mut().for_each(|entry| entry.ssim = Some(ssim)),
            Some(Err(words)) => misfit = Some(words),
            // Why there is no picture stands among the diagnostics.
            None => {}
        }
    }
    diag::sort(&mut lowered.diagnostics);
    Run { entries, diagnostics: lowered.diagnostics, sources: lowered.sources, misfit }
}

fn json(entries: &[Entry]) -> Result<Vec<u8>, String> {
    #[derive(Serialize)]
    struct All<'a> {
        paints: &'a [Entry],
    }
    let mut bytes = serde_json::to_vec(&All { paints: entries }).map_err(|error| error.to_string())?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// A row for every paint and seed; what cannot be said is left empty. Numbers have all the digits they need to be read back
/// as they are.
fn csv(entries: &[Entry]) -> Result<Vec<u8>, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let scalars: Vec<Scalars> = entries.iter().map(Entry::scalars).collect();
    let names = scalars.first().into_iter().flatten().map(|(name, _)| name.as_ref());
    let header: Vec<&str> = ["paint", "seed"].into_iter().chain(names).collect();
    writer.write_record(&header).map_err(|error| error.to_string())?;
    for (entry, scalars) in entries.iter().zip(&scalars) {
        let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        let seed = entry.seed.map(|seed| seed.to_string()).unwrap_or_default();
        let values = scalars.iter().map(|(_, value)| number(*value));
        let row = [entry.paint.clone(), seed].into_iter().chain(values);
        writer.write_record(row).map_err(|error| error.to_string())?;
    }
    writer.into_inner().map_err(|error| error.to_string())
}
