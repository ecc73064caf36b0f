//! `kake bundle`: a scene and all that it reads in one file, and back.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use crate::bundle::{Bundle, Sign, read, split, write};
use crate::loader;
use crate::lower::{LowerConfig, Lowered, lower};
use crate::scene::{Param, ParamDomain};
use crate::span::Syntax;

use super::files::{Opened, open, plain, print, replace};
use super::picture::sources;
use super::{Ended, limits, report};

#[derive(Debug, Args)]
pub(super) struct BundleArgs {
    /// The scene: a .kake or .toml file, a picture that holds one, or - for standard input
    scene: PathBuf,
    /// Where to: a file of the scene's kind, or - for standard output. By default the scene's name with .bundle before its
    /// ending, in this folder
    #[arg(short, long, value_name = "FILE", conflicts_with = "extract")]
    output: Option<PathBuf>,
    /// Take a bundle apart: its files go to this folder, which is new or empty
    #[arg(long, value_name = "DIR")]
    extract: Option<PathBuf>,
    /// The folder whose files the scene may read
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Lift a limit: tiles, strokes, iterations, megapixels, nesting or runs
    #[arg(long, value_name = "NAME=N", value_parser = limits::parse_limit)]
    limit: Vec<(limits::Limit, u64)>,
}

/// What the path of a standard library starts with.
const STANDARD: &str = "std:";

/// So often a scene is read with other parameters, to find the files that it reads then.
const MOST_TRIALS: usize = 200;

pub(super) fn run(arguments: &BundleArgs) -> Ended {
    match &arguments.extract {
        Some(folder) => extract(&arguments.scene, folder),
        None => pack(arguments),
    }
}

fn said(words: &str, ended: Ended) -> Ended {
    eprintln!("kake: {words}");
    ended
}

fn pack(arguments: &BundleArgs) -> Ended {
    let opened = match open(&arguments.scene, arguments.root.as_deref()) {
        Ok(opened) => opened,
        Err(error) => return report::cannot_open(error),
    };
    let config = LowerConfig { limits: limits::apply(&arguments.limit), ..LowerConfig::default() };
    let lowered = lower(&opened.path, &opened.loader, &config);
    let ended = report::diagnostics(&lowered.diagnostics, &lowered.sources);
    let Some((_, main)) = lowered.sources.iter().next().filter(|_| ended == Ended::Done) else { return ended };
    let (sign, kind) = match main.syntax {
        Syntax::Kake => (Sign::Slashes, "kake"),
        Syntax::Toml => (Sign::Hash, "toml"),
    };
    let output = match output(arguments, kind) {
        Ok(output) => output,
        Err(words) => return said(&words, Ended::Usage),
    };
    if let Some(picture) = opened.picture.as_ref().filter(|picture| !picture.params.is_empty()) {
        let sets: Vec<String> = picture.params.iter().map(|(name, value)| format!("--set {name}={value}")).collect();
        eprintln!("kake: the picture was made with {}; the bundle holds the scene as it is written", sets.join(" "));
    }
    let mut files = Files::default();
    files.add(&opened, &lowered);
    // A scene reads other files with other parameters.
    for sets in trials(&lowered.scene.as_ref().map(|scene| scene.params.clone()).unwrap_or_default()) {
        files.add(&opened, &lower(&opened.path, &opened.loader, &LowerConfig { sets, ..config.clone() }));
    }
    let used: BTreeSet<String> = files.paths().map(|path| loader::split(path).0.to_owned()).collect();
    let aliases = opened.loader.aliases().into_iter();
    let bundle = Bundle {
        scene: opened.path.clone(),
        files: files.list,
        dependencies: aliases.filter(|(_, short)| used.contains(short)).collect(),
    };
    let text = match write(&main.text, sign, &bundle) {
        Ok(text) => text,
        Err(error) => return said(&error.to_string(), Ended::Fault),
    };
    if output == Path::new("-") { print(text.as_bytes()) } else { replace(&output, &text) }
}

/// Where the bundle goes.
fn output(arguments: &BundleArgs, kind: &str) -> Result<PathBuf, String> {
    let stem = arguments.scene.file_stem().unwrap_or_default().to_string_lossy();
    let stem = if arguments.scene == Path::new("-") { "stdin" } else { &*stem };
    let Some(output) = &arguments.output else {
        let stem = stem.strip_suffix(".bundle").unwrap_or(stem);
        let usual = PathBuf::from(format!("{stem}.bundle.{kind}"));
        return not_the_scene(usual, &arguments.scene);
    };
    if output != Path::new("-") && !output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(kind)) {
        return Err(format!("{}: the scene is written in .{kind}, and its bundle too", output.display()));
    }
    not_the_scene(output.clone(), &arguments.scene)
}

fn not_the_scene(output: PathBuf, scene: &Path) -> Result<PathBuf, String> {
    match (output.canonicalize(), scene.canonicalize()) {
        (Ok(a), Ok(b)) if a == b => {
            Err(format!("{} is the scene itself: name the bundle by `-o FILE`", output.display()))
        }
        _ => Ok(output),
    }
}

/// Parameters with which a scene may read other files: one of them at a time at each of its choices, the ends of its range,
/// or the other way round.
fn trials(params: &[Param]) -> Vec<Vec<(String, String)>> {
    let of = |param: &Param| -> Vec<String> {
        match &param.domain {
            Some(ParamDomain::Choices(choices)) => choices.iter().map(|choice| choice.text.clone()).collect(),
            Some(ParamDomain::Range(low, high)) => vec![low.text.clone(), high.text.clone()],
            None if param.ty == "bool" => vec!["true".to_owned(), "false".to_owned()],
            None => Vec::new(),
        }
    };
    let all = params.iter().flat_map(|param| {
        let values = of(param).into_iter().filter(|value| *value != param.default.text);
        values.map(|value| vec![(param.name.clone(), value)]).collect::<Vec<_>>()
    });
    all.take(MOST_TRIALS).collect()
}

/// The files that a scene reads, each once, in the order in which it reads them.
#[derive(Default)]
struct Files {
    known: BTreeSet<String>,
    list: Vec<(String, Vec<u8>)>,
}

impl Files {
    fn add(&mut self, opened: &Opened, lowered: &Lowered) {
        let texts = sources(lowered).into_iter().map(|(path, text)| (path, Arc::from(text.into_bytes())));
        let files = lowered.files.iter().map(|(path, bytes)| (path.clone(), Arc::clone(bytes)));
        for (path, bytes) in texts.chain(files) {
            let bytes: Arc<[u8]> = bytes;
            if path != opened.path && self.known.insert(path.clone()) {
                self.list.push((path, bytes.to_vec()));
            }
        }
    }

    fn paths(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|(path, _)| path.as_str())
    }
}

fn extract(scene: &Path, folder: &Path) -> Ended {
    let cannot = |verb: &str, path: &Path, error: &io::Error| {
        said(&format!("cannot {verb} {}: {}", path.display(), plain(error)), Ended::Io)
    };
    let text = match fs::read(scene).map(String::from_utf8) {
        Ok(Ok(text)) => text,
        Ok(Err(_)) => return said(&format!("{} is no bundle", scene.display()), Ended::Fault),
        Err(error) => return cannot("read", scene, &error),
    };
    let bundle = match read(&text) {
        Ok(Some(bundle)) => bundle,
        Ok(None) => return said(&format!("{} is no bundle: `kake bundle` makes one", scene.display()), Ended::Fault),
        Err(error) => return said(&format!("{}: {error}", scene.display()), Ended::Fault),
    };
    let is_empty = match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_none(),
        Err(error) => error.kind() == io::ErrorKind::NotFound,
    };
    if !is_empty {
        let words = format!("{} is no empty folder, and nothing in it is replaced: name a new one", folder.display());
        return said(&words, Ended::Usage);
    }
    for (path, bytes) in extracted(&text, bundle) {
        let target = folder.join(&path);
        if let Err(error) = put(&target, &bytes) {
            return cannot("write", &target, &error);
        }
    }
    Ended::Done
}

/// The files that a bundle becomes. Dependencies become folders beside the scene's, which their manifests name.
fn extracted(text: &str, bundle: Bundle) -> Vec<(String, Vec<u8>)> {
    let scene = format!("{}\n", split(text).0.trim_end_matches('\n'));
    // Standard libraries come with the program.
    let own = |path: &&str| !path.starts_with(STANDARD);
    let keys =
        bundle.files.iter().map(|(path, _)| path.as_str()).filter(own).map(|path| loader::split(path).0.to_owned());
    let libraries: BTreeSet<String> = keys.filter(|key| !key.is_empty()).collect();
    // With dependencies the scene has a folder of its own, so that theirs lie beside it and not within.
    let home = if libraries.is_empty() { String::new() } else { format!("{HOME}/") };
    let mut files = vec![(format!("{home}{}", bundle.scene), scene.into_bytes())];
    for (path, bytes) in bundle.files {
        if !own(&path.as_str()) {
            continue;
        }
        let place = match loader::split(&path) {
            ("", path) => format!("{home}{path}"),
            (key, path) => format!("{}/{path}", folder(key)),
        };
        files.push((place, bytes));
    }
    let is_there = |files: &[(String, Vec<u8>)], path: &str| files.iter().any(|(known, _)| known == path);
    for key in libraries.iter().map(String::as_str).chain((!libraries.is_empty()).then_some("")) {
        let place = if key.is_empty() { format!("{HOME}/kake.toml") } else { format!("{}/kake.toml", folder(key)) };
        if !is_there(&files, &place) {
            files.push((place, manifest(key, &libraries, &bundle.dependencies).into_bytes()));
        }
    }
    files
}

/// The folder of the scene's own files beside those of libraries.
const HOME: &str = "scene";

/// The folder of a library.
fn folder(key: &str) -> String {
    format!("libraries/{}", key.replace('/', "-"))
}

/// What a library says of itself and of those that it depends on.
fn manifest(of: &str, libraries: &BTreeSet<String>, aliases: &BTreeMap<String, String>) -> String {
    let mut text = String::new();
    if !of.is_empty() {
        let name = of.rsplit('/').next().unwrap_or(of);
        text += &format!("[library]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = 1\n");
    }
    let known = libraries.iter().map(|key| (key.as_str(), key.as_str()));
    let other = aliases.iter().map(|(long, short)| (long.as_str(), short.as_str()));
    let mut dependencies = String::new();
    for (long, short) in known.chain(other) {
        let (owner, name) = long.rsplit_once('/').unwrap_or(("", long));
        if owner == of && libraries.contains(short) {
            let up =
                if of.is_empty() { format!("../{}", folder(short)) } else { format!("../{}", short.replace('/', "-")) };
            dependencies += &format!("{name} = {{ path = \"{up}\" }}\n");
        }
    }
    if !dependencies.is_empty() {
        text += &format!("\n[dependencies]\n{dependencies}");
    }
    text.trim_start().to_owned()
}

/// Writes a new file; one that is there already is left as it is, and an error.
fn put(target: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = target.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::OpenOptions::new().write(true).create_new(true).open(target)?.write_all(bytes)
}
