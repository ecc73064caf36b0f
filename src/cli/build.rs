//! `kake build`: a scene to pictures.

mod batch;
mod job;
mod output;
mod vary;
mod watching;

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::overlay::Overlay;

use super::files::{Opened, open};
use super::picture::{Embed, Form, NO_OVERLAY};
use super::progress::Progress;
use super::{Ended, SceneArgs, report};

use job::Job;
pub(super) use job::check_pixels;
pub(super) use output::{Kind, cannot_write, fill, kind_of, safe, write};
use output::{expanded, same_file};
pub(super) use vary::{Vary, parse as parse_vary};

#[derive(Debug, Args)]
pub(super) struct BuildArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Where to: FILE.svg, FILE.png, FILE.pdf or FILE.json, or - for SVG on standard output; several times for several files.
    /// By default the scene's name with .svg, in this folder, unless there is a sheet
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Replace the scene's seed
    #[arg(long, value_name = "N", conflicts_with = "seeds")]
    seed: Option<u64>,
    /// Build once for each seed from A to B, on all cores; outputs hold {seed} in their names
    #[arg(long, value_name = "A..B", value_parser = parse_seeds)]
    seeds: Option<Seeds>,
    /// Build once for each of these values of a parameter, with commas between them; several times for every combination.
    /// Outputs hold {NAME}, or {n} for the picture's number, in their names
    #[arg(long, value_name = "NAME=V1,V2,…", value_parser = parse_vary)]
    vary: Vec<Vary>,
    /// Put all pictures on one sheet with captions: FILE.svg, FILE.png or FILE.pdf
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
    /// Replace the canvas's resolution, in pixels per inch
    #[arg(long, value_name = "N", value_parser = parse_dpi)]
    dpi: Option<f64>,
    /// Draw this paint alone
    #[arg(long, value_name = "PAINT")]
    only: Option<String>,
    /// What an SVG is: a page, or a swatch with the page as a pattern, for a canvas that repeats
    #[arg(long = "as", value_enum, value_name = "FORM")]
    form: Option<Form>,
    /// For pen plotters: one layer for each ink and pen width, strokes only, joined and put in an order with short ways
    /// between them; says how far the pen goes. Outputs are .svg
    #[arg(long)]
    plot: bool,
    /// Show patterns on top of the picture: any of sites, graph, cells, angles, k and contrast, with commas between them.
    /// none takes away what a picture was made with
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = overlay_names(), conflicts_with = "plot")]
    overlay: Vec<String>,
    /// What the pictures carry so that they can be built again
    #[arg(long, value_enum, default_value_t = Embed::Text)]
    embed: Embed,
    /// How many threads work; by default one for each core. The pictures do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Say how long each step took
    #[arg(long)]
    timings: bool,
    /// Build again whenever the scene, an import or an image is saved, until Ctrl-C
    #[arg(long)]
    watch: bool,
}

/// First and last seed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seeds(pub(super) u64, pub(super) u64);

pub(super) fn parse_seeds(text: &str) -> Result<Seeds, String> {
    let (from, to) = text.split_once("..").ok_or("expected A..B, as in 0..15")?;
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| format!("`{text}` is not a whole number"));
    let (from, to) = (number(from)?, number(to)?);
    if from > to { Err(format!("{from} comes after {to}")) } else { Ok(Seeds(from, to)) }
}

pub(super) fn parse_dpi(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(dpi) if (1.0..=100_000.0).contains(&dpi) => Ok(dpi),
        _ => Err("a resolution is a number from 1 to 100,000".to_owned()),
    }
}

/// Every overlay by its name, and none.
fn overlay_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Overlay::ALL.map(Overlay::name).into_iter().chain([NO_OVERLAY]))
}

pub(super) fn run(arguments: &BuildArgs) -> Ended {
    if let Err(message) = check(arguments) {
        eprintln!("kake: {message}");
        return Ended::Usage;
    }
    if let Some(threads) = arguments.threads {
        // Fails only where the pool is there already, which nothing before this makes.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
    }
    if arguments.watch {
        return watching::run(arguments);
    }
    match open(&arguments.scene.scene, arguments.scene.root.as_deref()) {
        Ok(opened) => build(arguments, &opened),
        Err(error) => report::cannot_open(error),
    }
}

/// Builds once.
fn build(arguments: &BuildArgs, opened: &Opened) -> Ended {
    report::locks(opened.loader.packages());
    if arguments.seeds.is_some() || !arguments.vary.is_empty() || arguments.sheet.is_some() {
        return batch::run(arguments, opened);
    }
    let mut progress = Progress::new();
    let job = Job::new(arguments, opened, (arguments.seed, &[]), single(arguments));
    let done = job.run(&mut progress);
    let spent = progress.finish();
    eprint!("{}", done.words);
    if arguments.timings && done.ended == Ended::Done {
        report::timings(&spent);
    }
    done.ended
}

/// The outputs that are asked for, or the usual one; `{seed}` and the like are not looked at yet.
fn asked(arguments: &BuildArgs) -> Vec<PathBuf> {
    let scene = &arguments.scene.scene;
    if !arguments.output.is_empty() || arguments.sheet.is_some() {
        return arguments.output.clone();
    }
    let names = arguments.vary.iter().map(|vary| vary.name.as_str()).chain(arguments.seeds.map(|_| "seed"));
    let names: String = names.map(|name| format!("-{{{name}}}")).collect();
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let is_standard = scene == Path::new("-");
    vec![PathBuf::from(match (is_standard, names.is_empty()) {
        (true, true) => "-".to_owned(),
        (true, false) => format!("stdin{names}.svg"),
        (false, _) => format!("{stem}{names}.svg"),
    })]
}

/// The outputs of a single build.
fn single(arguments: &BuildArgs) -> Vec<(PathBuf, Kind)> {
    // In a single build what stands for nothing is a name like any other.
    let seed = |name: &str| match (name, arguments.seed) {
        ("seed", Some(seed)) => Some(seed.to_string()),
        _ => Some(format!("{{{name}}}")),
    };
    let file = |output: PathBuf| expanded(&output, &seed).unwrap_or(output);
    let kinds = asked(arguments).into_iter().map(|output| kind_of(&output).map(|kind| (file(output), kind)));
    kinds.filter_map(Result::ok).collect()
}

/// What a command line can be refused for before anything is read.
fn check(arguments: &BuildArgs) -> Result<(), String> {
    let scene = &arguments.scene.scene;
    let outputs = asked(arguments);
    if arguments.form == Some(Form::Pattern) && outputs.iter().all(|output| kind_of(output) != Ok(Kind::Svg)) {
        return Err("`--as pattern` is about SVG: no output ends in .svg".to_owned());
    }
    for (i, output) in outputs.iter().enumerate() {
        if same_file(output, scene) {
            return Err(format!("{} is the scene itself", output.display()));
        }
        let kind = kind_of(output)?;
        if arguments.plot && kind != Kind::Svg {
            return Err(format!("{}: what is plotted is written as .svg", output.display()));
        }
        if outputs[..i].contains(output) {
            return Err(format!("{} is given twice", output.display()));
        }
    }
    if arguments.watch && (scene == Path::new("-") || outputs.iter().any(|output| output == Path::new("-"))) {
        return Err("`--watch` follows a file and writes files; - is none".to_owned());
    }
    vary::check(arguments)
}
