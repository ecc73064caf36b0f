//! Names over all scenes of a library: where each stands, and giving it another.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lsp_types::{Location, TextEdit, Uri};

use crate::loader::{self, Loader};
use crate::lsp::{self, Analysis, Encoding, Named, Spot, Text};
use crate::span::{Sources, Syntax};
use crate::stop::Stop;
use crate::syntax::ast::StatementKind;
use crate::syntax::{kake, toml};

use super::address;
use super::drafts::{Drafts, Texts, is_scene, settled};

/// A place in a scene, and how it is told to the editor.
pub(super) struct Asked {
    /// The scene.
    pub(super) scene: PathBuf,
    /// A byte of its text.
    pub(super) offset: usize,
    pub(super) texts: Arc<Texts>,
    pub(super) encoding: Encoding,
    /// The addresses under which the editor knows files that are open.
    pub(super) addresses: BTreeMap<PathBuf, Uri>,
    pub(super) stop: Stop,
}

/// A name that was given.
pub(super) struct Renamed {
    /// The edits, file by file.
    pub(super) files: Vec<(Uri, Vec<TextEdit>)>,
    /// What the person should know about it.
    pub(super) remark: Option<String>,
}

/// The scenes that may name what a name means, the one at hand first.
struct Group {
    drafts: Drafts,
    names: Vec<String>,
    scenes: Vec<Analysis>,
}

/// The most files of a library that are looked through.
const MOST_FILES: usize = 5000;
/// How many folders deep they are looked for.
const DEEPEST: usize = 16;

impl Asked {
    /// Every place that names what is named here.
    pub(super) fn places(&self) -> Result<Vec<Location>, String> {
        let (group, declared, _) = self.group()?;
        let scenes: Vec<&Analysis> = group.scenes.iter().collect();
        let mut texts = BTreeMap::new();
        let places = lsp::places(&scenes, &declared).into_iter().filter_map(|place| {
            let text = texts.entry(place.file.clone()).or_insert_with(|| self.text(&group, &place.file));
            Some(Location { uri: self.address(&group, &place.file)?, range: text.as_ref()?.range(place.bytes()) })
        });
        Ok(places.collect())
    }

    /// The edits that give what is named here another name.
    pub(super) fn rename(&self, new: &str) -> Result<Renamed, String> {
        let (group, declared, written) = self.group()?;
        let scenes: Vec<&Analysis> = group.scenes.iter().collect();
        let places = lsp::places(&scenes, &declared);
        if written == new {
            return Ok(Renamed { files: Vec::new(), remark: None });
        }
        let text_of = |file: &str| self.text(&group, file).map(|text| text.as_str().to_owned());
        lsp::check_name(new, &places, &text_of)?;
        let mut edits: BTreeMap<&str, Vec<&Named>> = BTreeMap::new();
        for place in &places {
            edits.entry(&place.file).or_default().push(place);
        }
        let (mut changed, mut files) = ((*self.texts).clone(), Vec::new());
        for (file, places) in edits {
            let unknown = || format!("`{file}` lies in no file");
            let text = self.text(&group, file).ok_or_else(unknown)?;
            let uri = self.address(&group, file).ok_or_else(unknown)?;
            let edit = |place: &&Named| TextEdit { range: text.range(place.bytes()), new_text: new.to_owned() };
            files.push((uri, places.iter().map(edit).collect()));
            let mut whole = text.as_str().to_owned();
            for place in places.iter().rev() {
                if whole.get(place.bytes()).is_some() {
                    whole.replace_range(place.bytes(), new);
                }
            }
            changed.insert(group.drafts.place(file).ok_or_else(unknown)?, whole.into());
        }
        let remark = remark(&group, &declared, &written);
        // Every name must mean with the new text what it means with the old one.
        let Group { drafts, names, scenes } = group;
        let drafts = drafts.with(Arc::new(changed));
        for (name, before) in names.iter().zip(&scenes) {
            let after = drafts.look(name, self.stop.clone());
            lsp::same_meanings(before, &after, &places, new.len())
                .map_err(|why| format!("`{new}` will not do: {why}"))?;
        }
        Ok(Renamed { files, remark })
    }

    /// All scenes that may name what is named here, where that is declared, and its name.
    fn group(&self) -> Result<(Group, Named, String), String> {
        let (drafts, name) = Drafts::of(&self.scene, &self.texts);
        let here = drafts.look(&name, self.stop.clone());
        let source = here.source(&name).ok_or("the scene cannot be read")?;
        let (span, declared) = lsp::renameable(&here, Spot { source, offset: self.offset })?;
        let written = here.sources.text(span).to_owned();
        let mut names = vec![name];
        for file in importers(&drafts, &declared.file, &self.texts) {
            if !names.contains(&file) {
                names.push(file);
            }
        }
        let further = names.iter().skip(1).map(|name| drafts.look(name, self.stop.clone()));
        let scenes = std::iter::once(here).chain(further).collect();
        if self.stop.is_asked() {
            return Err("the request was cancelled".to_owned());
        }
        Ok((Group { drafts, names, scenes }, declared, written))
    }

    fn text(&self, group: &Group, file: &str) -> Option<Text> {
        let found = group.scenes.iter().find_map(|scene| {
            let source = scene.source(file)?;
            Some(Arc::clone(&scene.sources.get(source).text))
        });
        found.map(|text| Text::new(text, self.encoding))
    }

    fn address(&self, group: &Group, file: &str) -> Option<Uri> {
        let path = group.drafts.place(file)?;
        self.addresses.get(&path).cloned().or_else(|| address::uri(&path))
    }
}

/// What a new name changes in the picture: random numbers follow the names of paints and noises.
fn remark(group: &Group, declared: &Named, written: &str) -> Option<String> {
    let scene = group.scenes.first()?;
    let source = scene.source(&declared.file)?;
    let name = crate::span::Span::new(source, declared.start, declared.end);
    let declared = scene.declaration(name)?;
    let text = scene.sources.text(declared.span);
    match declared.what {
        lsp::What::Tone(..) => {
            let mut statements = group
                .scenes
                .iter()
                .flat_map(|scene| scene.survey.documents.iter().flat_map(|d| &d.statements).map(move |s| (scene, s)));
            let is_unnamed = statements.any(|(scene, statement)| {
                matches!(&statement.kind, StatementKind::Paint { name: None, .. })
                    && scene.sources.text(statement.span).contains(written)
            });
            is_unnamed.then(|| {
                let words =
                    "the picture changes: random numbers follow the names of paints, and a paint without a name is";
                format!("{words} called after its tone. `as \"{written}\"` behind it keeps what it was.")
            })
        }
        lsp::What::Let(_) | lsp::What::Field(_) | lsp::What::Region(_) | lsp::What::Param(..) => {
            let words = "the picture changes: the random numbers of a noise follow the name it is declared under.";
            text.contains("noise").then(|| words.to_owned())
        }
        _ => None,
    }
}

/// The scenes below the root that import a file, and the file itself.
fn importers(drafts: &Drafts, file: &str, texts: &Texts) -> Vec<String> {
    let mut found = vec![file.to_owned()];
    let stem = file.rsplit('/').next().unwrap_or(file);
    for path in scenes_below(drafts.root(), texts) {
        let Ok(inside) = path.strip_prefix(drafts.root()) else { continue };
        let name = crate::cli::files::slashed(inside);
        let Ok(bytes) = drafts.load(&name) else { continue };
        let Ok(text) = std::str::from_utf8(&bytes) else { continue };
        if text.contains(stem) && imports(&name, text).contains(&file.to_owned()) {
            found.push(name);
        }
    }
    found
}

/// The files of its own library that a scene imports.
fn imports(name: &str, text: &str) -> Vec<String> {
    let is_toml = name.ends_with(".toml");
    if is_toml && !is_scene(text) {
        return Vec::new();
    }
    let source = Sources::new().add(name, text, if is_toml { Syntax::Toml } else { Syntax::Kake });
    let (document, _) = if is_toml { toml::read(source, text) } else { kake::parse(source, text) };
    let paths = document.statements.iter().filter_map(|statement| match &statement.kind {
        StatementKind::Import { path, .. } => Some(path.value.as_str()),
        _ => None,
    });
    paths.filter(|path| !path.contains(':')).filter_map(|path| loader::resolve(name, path)).collect()
}

/// Every scene below a folder, saved or not, in order.
fn scenes_below(root: &Path, texts: &Texts) -> Vec<PathBuf> {
    let is_source = |path: &Path| {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        ["kake", "toml"].iter().any(|known| known.eq_ignore_ascii_case(ending))
    };
    let mut found: Vec<PathBuf> =
        texts.keys().filter(|path| path.starts_with(root) && is_source(path)).cloned().collect();
    let mut open = vec![(settled(root), 0)];
    while let Some((folder, depth)) = open.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let (path, name) = (entry.path(), entry.file_name());
            let skipped = name.to_str().is_none_or(|name| name.starts_with('.') || name == "target");
            let Ok(kind) = entry.file_type() else { continue };
            if kind.is_dir() && !skipped && depth < DEEPEST {
                open.push((path, depth + 1));
            } else if kind.is_file() && is_source(&path) && found.len() < MOST_FILES {
                found.push(path);
            }
        }
    }
    found.sort();
    found.dedup();
    found
}
