//! `kake build`: a scene to pictures.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::back::metadata::Metadata;
use crate::back::plot::plot;
use crate::back::{json, pdf, png, svg};
use crate::diag::{Code, Diagnostic};
use crate::drawing::Drawing;
use crate::overlay::Overlay;
use crate::scene::Limits;
use crate::{Compiled, Config, compile};

use super::files::{Opened, Pending, open, plain, print, write_beside};
use super::picture::{Embed, Form, NO_OVERLAY, is_plot, metadata, overlays, set_plot, take_over};
use super::progress::Progress;
use super::{Ended, SceneArgs, report};

#[derive(Debug, Args)]
pub(super) struct BuildArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Where to: FILE.svg, FILE.png, FILE.pdf or FILE.json, or - for SVG on standard output; several times for several files.
    /// By default the scene's name with .svg, in this folder
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Replace the scene's seed
    #[arg(long, value_name = "N", conflicts_with = "seeds")]
    seed: Option<u64>,
    /// Build once for each seed from A to B; outputs hold {seed} in their names
    #[arg(long, value_name = "A..B", value_parser = parse_seeds)]
    seeds: Option<Seeds>,
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

/// The kinds of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Svg,
    Png,
    Pdf,
    Json,
}

pub(super) fn kind_of(output: &Path) -> Result<Kind, String> {
    if output == Path::new("-") {
        return Ok(Kind::Svg);
    }
    let extension = output.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("svg") => Ok(Kind::Svg),
        Some("png") => Ok(Kind::Png),
        Some("pdf") => Ok(Kind::Pdf),
        Some("json") => Ok(Kind::Json),
        _ => Err(format!("{}: outputs end in .svg, .png, .pdf or .json", output.display())),
    }
}

pub(super) fn run(arguments: &BuildArgs) -> Ended {
    let outputs = match outputs(arguments) {
        Ok(outputs) => outputs,
        Err(message) => {
            eprintln!("kake: {message}");
            return Ended::Usage;
        }
    };
    if let Some(threads) = arguments.threads {
        // Fails only where the pool is there already, which nothing before this makes.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
    }
    let opened = match open(&arguments.scene.scene, arguments.scene.root.as_deref()) {
        Ok(opened) => opened,
        Err(error) => return report::cannot_open(error),
    };
    report::locks(opened.loader.packages());
    let seeds: Vec<Option<u64>> = match arguments.seeds {
        Some(Seeds(from, to)) => (from..=to).map(Some).collect(),
        None => vec![arguments.seed],
    };
    let mut worst = Ended::Done;
    for seed in seeds {
        let ended = build(arguments, &opened, &outputs, seed);
        match ended {
            Ended::Done => {}
            // The same scene is at fault for every seed.
            Ended::Fault | Ended::Usage => return ended,
            Ended::Io => worst = ended,
        }
    }
    worst
}

fn outputs(arguments: &BuildArgs) -> Result<Vec<(PathBuf, Kind)>, String> {
    let scene = &arguments.scene.scene;
    let mut outputs = arguments.output.clone();
    if outputs.is_empty() {
        let standard = scene == Path::new("-");
        let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
        let seed = if arguments.seeds.is_some() { "-{seed}" } else { "" };
        let name = if standard { "-".to_owned() } else { format!("{stem}{seed}.svg") };
        outputs.push(PathBuf::from(name));
    }
    let several = arguments.seeds.is_some_and(|Seeds(from, to)| from < to);
    if arguments.form == Some(Form::Pattern) && outputs.iter().all(|output| kind_of(output) != Ok(Kind::Svg)) {
        return Err("`--as pattern` is about SVG: no output ends in .svg".to_owned());
    }
    for (i, output) in outputs.iter().enumerate() {
        if several && !output.to_string_lossy().contains("{seed}") {
            return Err(format!("{}: with several seeds an output needs {{seed}} in its name", output.display()));
        }
        if arguments.plot && kind_of(output) != Ok(Kind::Svg) {
            return Err(format!("{}: what is plotted is written as .svg", output.display()));
        }
        if outputs[..i].contains(output) {
            return Err(format!("{} is given twice", output.display()));
        }
        if same_file(output, scene) {
            return Err(format!("{} is the scene itself", output.display()));
        }
    }
    outputs.into_iter().map(|output| kind_of(&output).map(|kind| (output, kind))).collect()
}

fn same_file(output: &Path, scene: &Path) -> bool {
    match (output.canonicalize(), scene.canonicalize()) {
        // A picture may be built again over itself.
        (Ok(output), Ok(scene)) => output == scene && kind_of(&scene).is_err(),
        _ => false,
    }
}

fn build(arguments: &BuildArgs, opened: &Opened, outputs: &[(PathBuf, Kind)], seed: Option<u64>) -> Ended {
    let mut progress = Progress::new();
    let mut config: Config = arguments.scene.config(seed);
    config.lower.dpi = arguments.dpi;
    config.only.clone_from(&arguments.only);
    take_over(&mut config, opened);
    if !arguments.plot {
        config.overlays = overlays(&arguments.overlay, opened);
    }
    let form = arguments.form.or_else(|| Form::of(opened)).unwrap_or(Form::Page);
    let mut compiled = compile(&opened.path, &opened.loader, &config, &mut progress);
    if outputs.iter().any(|(_, kind)| *kind == Kind::Png) {
        check_pixels(&mut compiled, &config.lower.limits);
    }
    let ended = report::diagnostics(&compiled.lowered.diagnostics, &compiled.lowered.sources);
    let missing = |diagnostic: &Diagnostic| matches!(diagnostic.code, Code::File | Code::Import);
    if opened.picture.is_some() && compiled.lowered.diagnostics.iter().any(missing) {
        eprintln!("kake: the picture holds its scene, but not every file that the scene reads");
        eprintln!("kake: name the folder they lie in by `--root DIR`, or build pictures with `--embed all`");
    }
    let Some(drawing) = &compiled.drawing else { return ended };
    if ended != Ended::Done {
        return ended;
    }
    let repeats = compiled.lowered.scene.as_ref().is_some_and(|scene| scene.canvas.period().is_some());
    if form == Form::Pattern && !repeats {
        eprintln!("kake: a pattern needs a canvas that repeats: `canvas {{ … repeat: true }}`");
        return Ended::Fault;
    }
    // What is shown on top of a picture is no part of its plot.
    let is_plotted = arguments.plot || config.overlays.is_empty() && opened.picture.as_ref().is_some_and(is_plot);
    let mut metadata = metadata(arguments.embed, &config, (opened, form), &compiled);
    let plot = (is_plotted && outputs.iter().any(|(_, kind)| *kind == Kind::Svg)).then(|| {
        progress.step("plot", "");
        plot(drawing)
    });
    if plot.is_some()
        && let Some(metadata) = &mut metadata
    {
        set_plot(metadata);
    }
    // All are written beside their places first, so that a full disk leaves every old file as it was.
    let mut pending = Vec::new();
    for (output, kind) in outputs {
        progress.step(kind.name(), "");
        let target = target(output, seed);
        let drawing = match (&plot, kind) {
            (Some(plot), Kind::Svg) => &plot.drawing,
            (_, Kind::Svg | Kind::Png | Kind::Pdf | Kind::Json) => drawing,
        };
        match write(drawing, metadata.as_ref(), (*kind, form), &target) {
            Ok(file) => pending.extend(file.map(|file| (target, file))),
            Err(error) => return cannot_write(&target, &error),
        }
    }
    for (target, file) in pending {
        if let Err(error) = file.keep() {
            return cannot_write(&target, &error);
        }
    }
    let spent = progress.finish();
    if let Some(plot) = &plot {
        report::plot(plot);
    }
    if arguments.timings {
        for (name, spent) in spent {
            eprintln!("{name:>8} {:>10.1} ms", spent.as_secs_f64() * 1000.0);
        }
    }
    Ended::Done
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
            Self::Json => "json",
        }
    }
}

fn target(output: &Path, seed: Option<u64>) -> PathBuf {
    match seed {
        Some(seed) => PathBuf::from(output.to_string_lossy().replace("{seed}", &seed.to_string())),
        None => output.to_owned(),
    }
}

pub(super) fn cannot_write(target: &Path, error: &io::Error) -> Ended {
    if error.kind() == io::ErrorKind::BrokenPipe {
        return Ended::Done;
    }
    eprintln!("kake: cannot write {}: {}", target.display(), plain(error));
    Ended::Io
}

/// A picture of more pixels than the limit is not drawn.
fn check_pixels(compiled: &mut Compiled, limits: &Limits) {
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

/// Writes one output beside its place; standard output is written at once.
pub(super) fn write(
    drawing: &Drawing,
    metadata: Option<&Metadata>,
    (kind, form): (Kind, Form),
    target: &Path,
) -> io::Result<Option<Pending>> {
    let fill = |out: &mut dyn Write| match kind {
        Kind::Svg => match form {
            Form::Page => svg::write(drawing, metadata, out),
            Form::Pattern => {
                let stem = target.file_stem().unwrap_or_default().to_string_lossy();
                svg::write_pattern(drawing, &stem, metadata, out)
            }
        },
        Kind::Pdf => pdf::write(drawing, metadata, out),
        Kind::Json => json::write(drawing, out),
        Kind::Png => png::write(drawing, metadata, out).map_err(|error| match error {
            png::PngError::Io(error) => error,
            png::PngError::Format(message) => io::Error::other(message),
        }),
    };
    if target == Path::new("-") {
        let mut bytes = Vec::new();
        fill(&mut bytes)?;
        return match print(&bytes) {
            Ended::Done => Ok(None),
            // What went wrong was said already.
            _ => Err(io::Error::other("standard output failed")),
        };
    }
    write_beside(target, fill).map(Some)
}
