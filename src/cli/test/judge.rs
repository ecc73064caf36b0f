//! One swatch against its pin.
//!
//! In: a scene and what was pinned of it. Out: how they compare, and what a new pin would be.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::back::png;
use crate::back::raster::{Pixels, render};
use crate::cli::files::{OpenError, Opened, open, plain, slashed};
use crate::cli::packages::read_below;
use crate::cli::{limits, report};
use crate::compare::{fingerprint, pictures};
use crate::diag::{Code, Diagnostic};
use crate::drawing::{Drawing, Layer, Page};
use crate::library::pin::{Figure, Pin};
use crate::library::review::{Outcome, Pictures, Reason, Swatch};
use crate::lower::{LowerConfig, Lowered};
use crate::metrics::{Measured, Measures};
use crate::scene::Depth;
use crate::span::{Sources, Syntax};
use crate::{Config, PaintStages, compile, paints, syntax};

use super::find::{File, Library};

/// The longer side of a pinned picture, in pixels.
const SIDE: u32 = 256;

/// More pixels than any pinned picture has.
const MOST_PIXELS: u64 = 1 << 20;

/// Distances of the correlogram beyond this say nothing new, and fill pages.
const NEAR: u32 = 3;

/// The folder of the pins.
pub(super) const PINS: &str = "pins";

/// A swatch with what its pin would be.
#[derive(Debug)]
pub(super) struct Judged {
    pub(super) swatch: Swatch,
    /// The text and the picture, where there is a drawing.
    pub(super) pin: Option<(String, Vec<u8>)>,
}

/// The paths of a pin's files from the library's root.
pub(super) fn files(name: &str) -> [String; 2] {
    [format!("{PINS}/{name}.toml"), format!("{PINS}/{name}.png")]
}

/// Builds a swatch and compares it with its pin.
pub(super) fn judge(library: &Library, file: &File) -> Judged {
    let shown = slashed(file.path.strip_prefix(&library.root).unwrap_or(&file.path));
    let mut swatch = Swatch {
        name: file.name.clone(),
        file: shown,
        outcome: Outcome::Broken,
        changes: Vec::new(),
        pictures: Pictures::default(),
        said: String::new(),
    };
    let [text, picture] = files(&file.name);
    let old_picture = read_below(&library.root, &picture);
    swatch.pictures.old = old_picture.as_ref().ok().filter(|bytes| png::decode(bytes, MOST_PIXELS).is_ok()).cloned();
    let opened = match open(&file.path, Some(&library.root)) {
        Ok(opened) => opened,
        Err(error) => {
            swatch.said = words(error);
            return Judged { swatch, pin: None };
        }
    };
    let (now, new_picture) = match build(&opened, &mut swatch.said) {
        Some(built) => built,
        None => return Judged { swatch, pin: None },
    };
    let png = match png::encode(&new_picture) {
        Ok(bytes) => bytes,
        Err(error) => {
            swatch.said.push_str(&format!("kake: the picture of {} cannot be written: {error:?}\n", swatch.file));
            return Judged { swatch, pin: None };
        }
    };
    let difference = swatch
        .pictures
        .old
        .as_ref()
        .and_then(|old| png::decode(old, MOST_PIXELS).ok())
        .map(|old| pictures(&old, &new_picture));
    let seen = difference.as_ref().map(|difference| (difference.changed, pixels(&difference.picture)));
    let was = match read_below(&library.root, &text) {
        Ok(bytes) => Some(read_pin(&text, &bytes)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => Some(Err(format!("kake: cannot read {text}: {}\n", plain(&error)))),
    };
    swatch.outcome = match &was {
        None => Outcome::New,
        Some(Err(_)) => Outcome::Changed(Reason::PinLost),
        Some(Ok(was)) => {
            swatch.changes = was.changes(&now);
            compared(was.fingerprint == now.fingerprint, swatch.changes.is_empty(), seen)
        }
    };
    if let Some(Err(said)) = was {
        swatch.said.push_str(&said);
    }
    if swatch.outcome == Outcome::New {
        swatch.pictures.old = None;
    } else if swatch.outcome != Outcome::Same {
        swatch.pictures.difference = difference.and_then(|difference| png::encode(&difference.picture).ok());
    }
    swatch.pictures.new = Some(png.clone());
    Judged { swatch, pin: Some((now.to_string(), png)) }
}

/// How a swatch compares with its pin: by the drawing, by the figures, and by how many pixels of how many differ, where the
/// pinned picture is known.
fn compared(is_same_drawing: bool, are_same_figures: bool, seen: Option<(u64, u64)>) -> Outcome {
    Outcome::Changed(match (is_same_drawing, are_same_figures, seen) {
        // The drawing decides: pixels of what is finer than it is told apart by may lie either way.
        (true, true, Some(_)) => return Outcome::Same,
        (true, true, None) => Reason::PictureLost,
        (true, false, _) => Reason::Figures,
        (false, _, None) => Reason::Unseen,
        (false, true, Some((0, _))) => Reason::Hidden,
        (false, false, Some((0, _))) => Reason::Measured,
        (false, _, Some((pixels, of))) => Reason::Seen { pixels, of },
    })
}

fn pixels(picture: &Pixels) -> u64 {
    picture.width as u64 * picture.height as u64
}

/// A pin, or what is wrong with it in words.
fn read_pin(name: &str, bytes: &[u8]) -> Result<Pin, String> {
    let mut sources = Sources::new();
    let pin = syntax::decode(name, bytes, Syntax::Toml, &mut sources)
        .map_err(|diagnostic| vec![diagnostic])
        .and_then(|(source, text)| Pin::parse(source, &text));
    pin.map_err(|mut diagnostics| {
        let message = format!("the pin {name} cannot be read");
        let whole = Diagnostic::without_span(Code::Pin, message).hint("`kake test --accept` writes it anew");
        diagnostics.insert(0, whole);
        report::text(&diagnostics, &sources)
    })
}

/// Why a scene cannot be opened.
fn words(error: OpenError) -> String {
    match error {
        OpenError::Words(words, _) => format!("kake: {words}\n"),
        OpenError::NoScene(path) => format!("kake: {path} holds no scene\n"),
        OpenError::Manifest(faults) => report::text(&faults.diagnostics, &faults.sources),
    }
}

/// Builds a scene: its pin and its small picture. What is said of it goes to `said`.
fn build(opened: &Opened, said: &mut String) -> Option<(Pin, Pixels)> {
    let config =
        Config { lower: LowerConfig { limits: limits::apply(&[]), ..LowerConfig::default() }, ..Config::default() };
    let mut compiled = compile(&opened.path, &opened.loader, &config, &mut ());
    let measured = compiled.drawing.is_some().then(|| measured(&compiled.lowered, &config)).transpose();
    let paints = match measured {
        Ok(measured) => measured.unwrap_or_default(),
        Err(diagnostic) => {
            compiled.lowered.diagnostics.push(diagnostic);
            compiled.drawing = None;
            Vec::new()
        }
    };
    said.push_str(&report::text(&compiled.lowered.diagnostics, &compiled.lowered.sources));
    let drawing = compiled.drawing?;
    let mut warnings: BTreeMap<String, u64> = BTreeMap::new();
    for diagnostic in &compiled.lowered.diagnostics {
        *warnings.entry(diagnostic.code.name().to_owned()).or_default() += 1;
    }
    let pin = Pin {
        fingerprint: fingerprint(&drawing).to_string(),
        marks: drawing.layers.iter().map(Layer::marks).sum(),
        page: size(&drawing.page),
        tiles: paints.iter().map(|(_, measures)| measures.tiles as u64).sum(),
        paints: paints.iter().map(|(name, measures)| (name.clone(), figures(measures))).collect(),
        warnings,
    };
    Some((pin, small(drawing)))
}

/// What the paints of a scene measure.
fn measured(lowered: &Lowered, config: &Config) -> Result<Vec<(String, Measures)>, Diagnostic> {
    let Some(scene) = &lowered.scene else { return Ok(Vec::new()) };
    let measure = |paint| {
        // The drawing found the same warnings.
        let stages = PaintStages::new(paint, &scene.canvas, &config.lower.limits, &mut (), &mut Vec::new())?;
        Ok((paint.name.clone(), Measures::new(&Measured::new(paint, &stages.borrow()))))
    };
    paints(scene).map(measure).collect()
}

/// The figures that are pinned.
fn figures(measures: &Measures) -> BTreeMap<String, Figure> {
    let is_far = |name: &str| name.strip_prefix('r').and_then(|k| k.parse().ok()).is_some_and(|k: u32| k > NEAR);
    let all = measures.scalars().into_iter();
    all.filter(|(name, _)| !is_far(name))
        .filter_map(|(name, value)| Some((name.into_owned(), Figure::new(value?)?)))
        .collect()
}

/// The size of a page in words.
fn size(page: &Page) -> String {
    let mm = |length: crate::geom::Length| ((length.to_mm() * 1000.0).round() / 1000.0).to_string();
    let bleed = if page.bleed.to_mm() > 0.0 { format!(", bleed {} mm", mm(page.bleed)) } else { String::new() };
    format!("{} x {} mm{bleed}", mm(page.width), mm(page.height))
}

/// The picture that is pinned: the whole page, in all levels.
fn small(mut drawing: Drawing) -> Pixels {
    let [width, height] = drawing.page.pixels.map(u64::from);
    let longer = width.max(height).max(1);
    let side = |length: u64| {
        let scaled = (length * u64::from(SIDE) + longer / 2) / longer;
        u32::try_from(scaled).unwrap_or(SIDE).clamp(1, SIDE)
    };
    drawing.page.pixels = [side(width), side(height)];
    drawing.page.depth = Depth::Eight;
    render(&drawing)
}

/// Pins that have no swatch.
pub(super) fn orphans(library: &Library) -> Result<Vec<Judged>, String> {
    let known = |name: &str| library.swatches.iter().any(|file| file.name == name);
    let found = pins(&library.root).map_err(|error| format!("cannot read {PINS}/: {}", plain(&error)))?;
    let orphan = |name: String| {
        let [text, picture] = files(&name);
        let old = read_below(&library.root, &picture).ok().filter(|bytes| png::decode(bytes, MOST_PIXELS).is_ok());
        let pictures = Pictures { old, ..Pictures::default() };
        let (outcome, changes, said) = (Outcome::Orphan, Vec::new(), String::new());
        Judged { swatch: Swatch { name, file: text, outcome, changes, pictures, said }, pin: None }
    };
    Ok(found.into_iter().filter(|name| !known(name)).map(orphan).collect())
}

/// The names of all pins, in order. Links to folders are not followed.
fn pins(root: &Path) -> io::Result<Vec<String>> {
    let top: PathBuf = root.join(PINS);
    let mut names = Vec::new();
    let mut folders = vec![top.clone()];
    while let Some(next) = folders.pop() {
        let entries = match fs::read_dir(&next) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            Err(error) => return Err(error),
        };
        for entry in entries {
            let entry = entry?;
            let (path, kind) = (entry.path(), entry.file_type()?);
            if kind.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "toml" || extension == "png") {
                names.push(slashed(&path.strip_prefix(&top).unwrap_or(&path).with_extension("")));
            }
        }
    }
    names.sort();
    names.dedup();
    Ok(names)
}
