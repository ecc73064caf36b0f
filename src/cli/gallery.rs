//! `kake gallery`: a page and a contact sheet of tones and scenes.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::back::contact::Contact;
use crate::back::png::{self, PngError};
use crate::back::{pdf, svg};
use crate::drawing::Drawing;
use crate::gallery::{GalleryConfig, Lacking, Module, Over, Page, contact, page, survey};
use crate::loader::MemoryLoader;
use crate::lower::LowerConfig;
use crate::sheet::Sheet;

use super::build::{Kind, Vary, cannot_write, kind_of, parse_vary, safe};
use super::files::{Pending, open, plain, write_beside};
use super::progress::Bar;
use super::{Ended, limits, report};

mod find;

use find::{Found, find};

#[derive(Debug, Args)]
pub(super) struct GalleryArgs {
    /// Libraries (folders with a kake.toml or a folder `tones`), other folders, files, and std:manga
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// The folder that the page goes to; it is made where there is none
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// How many layers tones are drawn with; of those that ask for a share instead, as many even steps
    #[arg(long, value_name = "A..B", default_value = "1..4", value_parser = parse_layers)]
    k: (u32, u32),
    /// Draw tones over the values of one of their parameters instead
    #[arg(long, value_name = "PARAM=V1,V2,…", value_parser = parse_vary, conflicts_with = "k")]
    over: Option<Vary>,
    /// Where the contact sheet goes: FILE.png, FILE.svg or FILE.pdf; by default gallery.png in the folder
    #[arg(long, value_name = "FILE")]
    single: Option<PathBuf>,
    /// The folder whose files the scenes may read
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Lift a limit: tiles, strokes, iterations, megapixels, nesting or runs
    #[arg(long, value_name = "NAME=N", value_parser = limits::parse_limit)]
    limit: Vec<(limits::Limit, u64)>,
}

/// The most layers that a tone has.
const MOST_LAYERS: u32 = 4;

fn parse_layers(text: &str) -> Result<(u32, u32), String> {
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    let number = |text: &str| text.trim().parse::<u32>().map_err(|_| format!("`{text}` is not a whole number"));
    match (number(from)?, number(to)?) {
        (from, to) if from > to => Err(format!("{from} comes after {to}")),
        (_, to) if to > MOST_LAYERS => Err(format!("a tone has {MOST_LAYERS} layers at most")),
        range => Ok(range),
    }
}

/// What the page is called.
const PAGE: &str = "index.html";
/// What the contact sheet is called where nothing else is said.
const SHEET: &str = "gallery.png";
/// The folder of the pictures.
const PICTURES: &str = "pictures";

/// Pictures of more bytes are written as PNG, with so many pixels on their longer side.
const LONGEST_SVG: usize = 1 << 20;
const PIXELS: f64 = 1600.0;

pub(super) fn run(arguments: &GalleryArgs) -> Ended {
    let single = arguments.single.clone().unwrap_or_else(|| arguments.output.join(SHEET));
    if !matches!(kind_of(&single), Ok(Kind::Svg | Kind::Png | Kind::Pdf)) || single.as_os_str() == "-" {
        eprintln!("kake: {}: a contact sheet is a file that ends in .png, .svg or .pdf", single.display());
        return Ended::Usage;
    }
    let earlier = match earlier(&arguments.output) {
        Ok(earlier) => earlier,
        Err(words) => {
            eprintln!("kake: {words}");
            return Ended::Usage;
        }
    };
    let mut ended = Ended::Done;
    let found = match find(&arguments.paths) {
        Ok(found) => found,
        Err((words, ended)) => {
            eprintln!("kake: {words}");
            return ended;
        }
    };
    let modules = surveyed(arguments, &found, &mut ended);
    if modules.is_empty() {
        return ended;
    }
    if let Some(over) = &arguments.over
        && !modules.iter().flat_map(|module| &module.tones).any(|tone| tone.is_series)
    {
        eprintln!("kake: no tone has a parameter `{}`", over.name);
        return Ended::Fault;
    }
    match write(arguments, &found, &modules, (&single, &earlier)) {
        Ok(()) => ended,
        Err((path, error)) => cannot_write(&path, &error),
    }
}

/// Surveys every file; what is at fault is said, and does not stop the others.
fn surveyed(arguments: &GalleryArgs, found: &Found, ended: &mut Ended) -> Vec<Module> {
    let over = match &arguments.over {
        Some(Vary { name, values }) => Over::Param(name.clone(), values.clone()),
        None => Over::Layers(arguments.k.0, arguments.k.1),
    };
    let lower = LowerConfig { limits: limits::apply(&arguments.limit), ..LowerConfig::default() };
    let config = GalleryConfig { lower, over };
    let bar = Bar::new("files", found.files.len(), 0);
    let mut modules = Vec::new();
    for file in &found.files {
        let module = match file.to_str().filter(|file| file.starts_with("std:")) {
            Some(file) => Some(survey(file, &MemoryLoader::default(), &config)),
            None => match open(file, arguments.root.as_deref()) {
                Ok(opened) => Some(survey(&opened.path, &opened.loader, &config)),
                Err(error) => {
                    *ended = report::cannot_open(error);
                    None
                }
            },
        };
        bar.advance();
        let Some(module) = module else { continue };
        if say(&module) && *ended == Ended::Done {
            *ended = Ended::Fault;
        }
        modules.push(module);
    }
    bar.finish();
    modules
}

/// Says what is at fault in a file; whether anything is.
fn say(module: &Module) -> bool {
    if let Some(faults) = &module.faults {
        eprint!("{faults}");
        return true;
    }
    let mut is_faulty = false;
    let swatches = module.tones.iter().flat_map(|tone| tone.swatches.iter().map(move |shown| (tone, shown)));
    for (tone, shown) in swatches {
        if let Err(Lacking::Fault(why)) = &shown.picture {
            let what = if shown.label.is_empty() { String::new() } else { format!(", {}", shown.label) };
            eprintln!("kake: {}: `{}`{what}: {why}", module.path, tone.name);
            is_faulty = true;
        }
    }
    if let Some(Err(why)) = module.scene.as_ref().map(|scene| &scene.picture) {
        eprintln!("kake: {}: {why}", module.path);
        is_faulty = true;
    }
    is_faulty
}

/// The pictures of an earlier page in a folder; words where the folder holds a page that is not of this program.
fn earlier(folder: &Path) -> Result<BTreeSet<String>, String> {
    let path = folder.join(PAGE);
    let Ok(bytes) = fs::read(&path) else { return Ok(BTreeSet::new()) };
    let text = String::from_utf8_lossy(&bytes);
    if !text.contains(&format!("content=\"{}\"", crate::gallery::GENERATOR)) {
        return Err(format!(
            "{} is no page of `kake gallery`, and is not replaced: name another folder",
            path.display()
        ));
    }
    let start = format!("src=\"{PICTURES}/");
    let names = text.split(&start).skip(1).filter_map(|rest| rest.split_once('"').map(|(name, _)| name.to_owned()));
    Ok(names.filter(|name| !name.contains(['/', '\\'])).collect())
}

type Failed = (PathBuf, io::Error);

fn write(
    arguments: &GalleryArgs,
    found: &Found,
    modules: &[Module],
    (single, earlier): (&Path, &BTreeSet<String>),
) -> Result<(), Failed> {
    let folder = &arguments.output;
    let within = folder.join(PICTURES);
    fs::create_dir_all(&within).map_err(|error| (within.clone(), error))?;
    let mut written = BTreeSet::new();
    let mut pictures = Vec::new();
    for (i, module) in modules.iter().enumerate() {
        let mut names = Vec::new();
        let mut add = |name: String, picture: Option<&Drawing>| -> Result<(), Failed> {
            let file = picture.map(|picture| file(&within, &name, picture)).transpose()?;
            written.extend(file.clone());
            names.push(file.map(|file| format!("{PICTURES}/{file}")));
            Ok(())
        };
        for tone in &module.tones {
            for (j, shown) in tone.swatches.iter().enumerate() {
                let name = format!("{:02}-{}-{}", i + 1, safe(&tone.name), j + 1);
                add(name, shown.picture.as_ref().ok())?;
            }
        }
        if let Some(scene) = &module.scene {
            let stem = Path::new(&module.path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
            add(format!("{:02}-{}", i + 1, safe(&stem)), scene.picture.as_ref().ok())?;
        }
        pictures.push(names);
    }
    let (sheet, drawings) = contact(&found.title, modules);
    put(single, |out| write_sheet(single, &sheet, drawings, out))?;
    let beside = single.parent().map(Path::canonicalize).and_then(Result::ok) == folder.canonicalize().ok();
    let name = single.file_name().unwrap_or_default().to_string_lossy();
    let text = page(&Page {
        title: &found.title,
        about: found.about.as_deref(),
        library: found.library.as_deref(),
        sheet: beside.then_some(&*name),
        modules,
        pictures: &pictures,
    });
    put(&folder.join(PAGE), |out| out.write_all(text.as_bytes()))?;
    // Pictures that only the earlier page showed are of no use to anybody.
    for name in earlier.difference(&written) {
        let _ = fs::remove_file(within.join(name));
    }
    Ok(())
}

fn put(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failed> {
    write_beside(path, fill).and_then(Pending::keep).map_err(|error| (path.to_owned(), error))
}

/// Writes a picture; the name of its file.
fn file(folder: &Path, name: &str, picture: &Drawing) -> Result<String, Failed> {
    let mut bytes = Vec::new();
    svg::write(picture, None, &mut bytes).map_err(|error| (folder.to_owned(), error))?;
    let extension = if bytes.len() > LONGEST_SVG { "png" } else { "svg" };
    let file = format!("{name}.{extension}");
    let path = folder.join(&file);
    if extension == "png" {
        let mut picture = picture.clone();
        let [width, height] = [picture.page.width, picture.page.height].map(crate::geom::Length::to_mm);
        let scale = PIXELS / width.max(height);
        picture.page.pixels = [width, height].map(|side| (side * scale).round().max(1.0) as u32);
        picture.page.dpi = scale * crate::geom::Length::MM_PER_INCH;
        picture.page.depth = crate::scene::Depth::Eight;
        put(&path, |out| png::write(&picture, None, out).map_err(of_png))?;
    } else {
        put(&path, |out| out.write_all(&bytes))?;
    }
    Ok(file)
}

fn of_png(error: PngError) -> io::Error {
    match error {
        PngError::Io(error) => error,
        PngError::Format(words) => io::Error::other(words),
    }
}

fn write_sheet(file: &Path, sheet: &Sheet, drawings: Vec<&Drawing>, out: &mut dyn Write) -> io::Result<()> {
    let all = || -> Vec<Option<Drawing>> { drawings.iter().map(|drawing| Some((*drawing).clone())).collect() };
    match kind_of(file) {
        Ok(Kind::Svg) => svg::write_sheet(sheet, &all(), out),
        Ok(Kind::Pdf) => pdf::write_sheet(sheet, &all(), out),
        Ok(Kind::Png | Kind::Json) | Err(_) => {
            let mut contact = Contact::new(sheet);
            for (place, drawing) in sheet.places.iter().zip(drawings) {
                contact.put(place, &Contact::draw(sheet, place, drawing.clone()));
            }
            contact.write(out).map_err(of_png)
        }
    }
}

/// What the system says of a file.
fn cannot_read(path: &Path, error: &io::Error) -> (String, Ended) {
    (format!("cannot read {}: {}", path.display(), plain(error)), Ended::Io)
}
