//! Texts that are being written, in place of the files that they will be saved to.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lsp_types::Uri;

use crate::cli::files::{self, FsLoader};
use crate::cli::packages::Faults;
use crate::loader::{LoadError, Loader, UnknownDependency};
use crate::lsp::{Analysis, Folder};
use crate::stop::Stop;

/// Open texts by the paths of their files.
pub(super) type Texts = BTreeMap<PathBuf, Arc<str>>;

/// A loader that finds open texts first.
#[derive(Debug)]
pub(super) struct Drafts {
    files: FsLoader,
    texts: Arc<Texts>,
    /// What is wrong with the manifests of the libraries.
    pub(super) faults: Option<Faults>,
}

impl Drafts {
    /// The loader of a scene, saved or not, and the scene's name in it.
    pub(super) fn of(scene: &Path, texts: &Arc<Texts>) -> (Self, String) {
        let scene = settled(scene);
        let folder = scene.parent().unwrap_or(&scene);
        let (files, faults) = files::beside(folder);
        let inside = scene.strip_prefix(files.root()).map(files::slashed).unwrap_or_default();
        (Self { files, texts: Arc::clone(texts), faults }, inside)
    }

    /// The same with other texts.
    pub(super) fn with(self, texts: Arc<Texts>) -> Self {
        Self { texts, ..self }
    }

    /// Where the file of a name lies.
    pub(super) fn place(&self, name: &str) -> Option<PathBuf> {
        self.files.place(name)
    }

    /// The root folder of the scene's library.
    pub(super) fn root(&self) -> &Path {
        self.files.root()
    }

    /// Looks at a scene of this loader.
    pub(super) fn look(&self, name: &str, stop: Stop) -> Analysis {
        Analysis::new(name, self, stop)
    }
}

impl Loader for Drafts {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if let Some(text) = self.files.place(path).and_then(|place| self.texts.get(&place)) {
            return Ok(text.as_bytes().into());
        }
        self.files.load(path)
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        self.files.library(name)
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        self.files.dependency(of, name)
    }
}

/// A path with links followed as far as it is there.
pub(super) fn settled(path: &Path) -> PathBuf {
    if let Ok(full) = path.canonicalize() {
        return full;
    }
    match (path.parent().map(Path::canonicalize), path.file_name()) {
        (Some(Ok(folder)), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// Where a text would lie that has no file yet.
pub(super) fn unsaved(uri: &Uri, is_toml: bool) -> PathBuf {
    let name: String = uri.as_str().chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let folder = std::env::current_dir().unwrap_or_default();
    settled(&folder.join(format!("{name}.{}", if is_toml { "toml" } else { "kake" })))
}

/// The folder of a text, for paths inside strings.
pub(super) struct Beside {
    folder: PathBuf,
    root: PathBuf,
}

impl Beside {
    /// The folder of a text, and the root that no path leads out of.
    pub(super) fn new(scene: &Path, root: &Path) -> Self {
        Self { folder: settled(scene).parent().unwrap_or(scene).to_owned(), root: root.to_owned() }
    }
}

/// The most entries of a folder that are offered.
const MOST: usize = 500;

impl Folder for Beside {
    fn list(&self, folder: &str) -> Vec<String> {
        let Ok(folder) = self.folder.join(folder).canonicalize() else { return Vec::new() };
        if !folder.starts_with(&self.root) {
            return Vec::new();
        }
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let named = entries.filter_map(|entry| {
            let name = entry.file_name().to_str()?.to_owned();
            let is_folder = entry.path().is_dir();
            (!name.starts_with('.')).then(|| if is_folder { format!("{name}/") } else { name })
        });
        let mut names: Vec<String> = named.take(MOST).collect();
        names.sort();
        names
    }
}

/// Whether a text in TOML is a scene: any program's settings may be open as well.
pub(super) fn is_scene(text: &str) -> bool {
    const HEADS: [&str; 9] =
        ["[canvas", "[[draw", "[tone.", "[[import", "[param.", "[region", "[field", "[experiment.", "[fn."];
    let mut is_above = true;
    for line in text.lines().map(str::trim) {
        if HEADS.iter().any(|head| line.starts_with(head)) {
            return true;
        }
        is_above &= !line.starts_with('[');
        let key = line.split('=').next().unwrap_or_default().trim();
        if is_above && matches!(key, "edition" | "canvas" | "draw") && line.contains('=') {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_told_from_other_settings() {
        assert!(is_scene("edition = 1\n"));
        assert!(is_scene("# a library\n[tone.plain]\nplace = 'hex(spacing: 4mm)'\n"));
        assert!(is_scene("[canvas]\nsize = 'a4'\n"));
        assert!(!is_scene("[package]\nname = \"kakeami\"\nedition = \"2024\"\n[[bin]]\n"));
        assert!(!is_scene("[library]\nname = \"ink\"\n"));
        assert!(!is_scene(""));
    }
}
