//! The file system: scenes with their roots, standard input, and outputs that replace the old file whole or not at all.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, BufWriter, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::back::metadata::{self, Metadata};
use crate::bundle;
use crate::library::{LOCK, MANIFEST};
use crate::loader::{self, LoadError, Loader, UnknownDependency};

use super::Ended;
use super::packages::{Faults, Packages, is_foreign};
use super::watch::{Stamp, Stamps};

/// The largest file that is read.
pub(super) const LARGEST: u64 = 1 << 30;

/// What a scene read from standard input is called.
const STDIN: &str = "stdin.kake";

/// Reads files below a root folder, and those of the libraries that the root's `kake.toml` depends on.
#[derive(Debug)]
pub(super) struct FsLoader {
    root: PathBuf,
    /// Files that stand in for those of the root: standard input, or what a picture holds.
    held: BTreeMap<String, Arc<[u8]>>,
    packages: Packages,
    /// Keys of dependencies that a picture or a bundle knows by shorter ones.
    aliases: BTreeMap<String, String>,
    /// The scene of a bundle, with the file that holds both.
    bundle: Option<(String, PathBuf)>,
    /// The files that were asked for, those that are missing too, as they stood just before.
    asked: Mutex<Stamps>,
}

impl FsLoader {
    /// Reads files below a root, and those of the libraries that it depends on.
    fn new(root: PathBuf, packages: Packages) -> Self {
        let (held, aliases) = (BTreeMap::new(), BTreeMap::new());
        Self { root, held, packages, aliases, bundle: None, asked: Mutex::default() }
    }

    /// Of a root folder, in which files that are held stand in for those on disk.
    pub(super) fn at(root: PathBuf, held: BTreeMap<String, Arc<[u8]>>) -> Result<Self, Faults> {
        let packages = Packages::find(&root)?;
        Ok(Self { held, ..Self::new(root, packages) })
    }

    /// Where the file of a name lies, as texts are called in `Sources`; none for what lies in no file: standard input,
    /// what a picture holds, standard libraries and values from the command line.
    pub(super) fn place(&self, path: &str) -> Option<PathBuf> {
        if let Some((scene, file)) = &self.bundle
            && scene == path
        {
            return Some(file.clone());
        }
        if self.held.contains_key(path) || path.starts_with("--") {
            return None;
        }
        match loader::split(path) {
            ("", path) => Some(self.root.join(path)),
            (key, inside) => self.packages.get(key).map(|package| package.folder.join(inside)),
        }
    }

    /// The root folder of what is read.
    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// The libraries that files are read from.
    pub(super) fn packages(&self) -> &Packages {
        &self.packages
    }

    /// The keys of dependencies that stand for shorter ones.
    pub(super) fn aliases(&self) -> BTreeMap<String, String> {
        let mut aliases = self.packages.aliases();
        aliases.extend(self.aliases.clone());
        aliases
    }

    /// Whether a file was read, or asked for, so far.
    pub(super) fn has_read(&self, file: &Path) -> bool {
        let Ok(file) = file.canonicalize() else { return false };
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        asked.keys().any(|read| read.canonicalize().is_ok_and(|read| read == file))
    }

    /// Every file that mattered so far, the libraries' manifests included: when one of them changes, so may the picture.
    pub(super) fn followed(&self) -> Stamps {
        let mut stamps = self.asked.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let folders = self.packages.dependencies().iter().map(|package| package.folder.as_path());
        for folder in folders.chain([self.root.as_path()]) {
            for name in [MANIFEST, LOCK] {
                let path = folder.join(name);
                let stamp = Stamp::of(&path);
                stamps.entry(path).or_insert(stamp);
            }
        }
        if let Some((_, bundle)) = &self.bundle {
            stamps.entry(bundle.clone()).or_insert_with(|| Stamp::of(bundle));
        }
        stamps
    }

    /// Reads a file below a folder.
    fn read(folder: &Path, path: &str) -> Result<Arc<[u8]>, LoadError> {
        let unreadable = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => LoadError::Missing,
            _ => LoadError::Unreadable(plain(&error)),
        };
        // Links are followed first, so that none leads out of the folder.
        let full = folder.join(path).canonicalize().map_err(unreadable)?;
        if !full.starts_with(folder) {
            return Err(LoadError::Outside);
        }
        let kind = fs::metadata(&full).map_err(unreadable)?;
        if !kind.is_file() {
            return Err(LoadError::Unreadable("it is not a file".to_owned()));
        }
        if kind.len() > LARGEST {
            return Err(LoadError::Unreadable("it is larger than 1 GiB".to_owned()));
        }
        Ok(fs::read(&full).map_err(unreadable)?.into())
    }
}

impl Loader for FsLoader {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if let Some(bytes) = self.held.get(path) {
            return Ok(Arc::clone(bytes));
        }
        if let Some(place) = self.place(path) {
            let stamp = Stamp::of(&place);
            self.asked.lock().unwrap_or_else(PoisonError::into_inner).entry(place).or_insert(stamp);
        }
        match loader::split(path) {
            ("", _) => Self::read(&self.root, path),
            (key, inside) => match self.packages.get(key) {
                // What other programs keep in a dependency's folder is no part of it, nor is it locked.
                Some(_) if is_foreign(inside) => Err(LoadError::Outside),
                Some(package) => Self::read(&package.folder, inside),
                None => Self::read(&self.root, path),
            },
        }
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        self.held.get(name).cloned()
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        let chain = loader::key(of, name);
        let key = self.aliases.get(&chain).cloned().unwrap_or(chain);
        // What a picture holds needs no library on disk.
        if self.held.keys().any(|held| loader::split(held).0 == key) {
            return Ok(key);
        }
        self.packages.dependency(of, name)
    }
}

/// A scene that a command was given.
#[derive(Debug)]
pub(super) struct Opened {
    pub(super) loader: FsLoader,
    /// The scene's path from the root.
    pub(super) path: String,
    /// What a picture holds besides, where the scene is one.
    pub(super) picture: Option<Metadata>,
}

/// Why a scene cannot be opened.
#[derive(Debug)]
pub(super) enum OpenError {
    /// In words, with how the command ends.
    Words(String, Ended),
    /// A picture that holds no scene.
    NoScene(String),
    /// A library whose `kake.toml`, or that of a dependency, is at fault.
    Manifest(Faults),
}

/// Finds a scene and the root of what it may read.
pub(super) fn open(scene: &Path, root: Option<&Path>) -> Result<Opened, OpenError> {
    let failed = |path: &Path, error: &io::Error| {
        OpenError::Words(format!("cannot read {}: {}", path.display(), plain(error)), Ended::Io)
    };
    if scene == Path::new("-") {
        let mut text = Vec::new();
        io::stdin().take(LARGEST).read_to_end(&mut text).map_err(|error| failed(scene, &error))?;
        let root = root.unwrap_or(Path::new("."));
        let root = root.canonicalize().map_err(|error| failed(root, &error))?;
        let held = BTreeMap::from([(STDIN.to_owned(), Arc::from(text))]);
        let packages = Packages::find(&root).map_err(OpenError::Manifest)?;
        let mut loader = FsLoader { held, ..FsLoader::new(root, packages) };
        let path = match unpack(&mut loader, scene, STDIN)? {
            Some(path) => path,
            None => STDIN.to_owned(),
        };
        return Ok(Opened { loader, path, picture: None });
    }
    let full = scene.canonicalize().map_err(|error| failed(scene, &error))?;
    let folder = full.parent().unwrap_or(&full).to_owned();
    let root = match root {
        Some(root) => root.canonicalize().map_err(|error| failed(root, &error))?,
        None => folder.ancestors().find(|dir| dir.join(MANIFEST).is_file()).unwrap_or(&folder).to_owned(),
    };
    if is_picture(&full) {
        let bytes = read_file(&full).map_err(|error| failed(scene, &error))?;
        return picture(&bytes, &root, scene.display().to_string());
    }
    let Ok(inside) = full.strip_prefix(&root) else {
        let message = format!("{} does not lie below the root {}", scene.display(), root.display());
        return Err(OpenError::Words(message, Ended::Usage));
    };
    let path = slashed(inside);
    let bytes = bundled(&full).map_err(|error| failed(scene, &error))?;
    let packages = match (&bytes, Packages::find(&root)) {
        (_, Ok(packages)) => packages,
        // What is wrong with a library that a bundle happens to lie in does not matter to what it holds.
        (Some(_), Err(_)) => Packages::alone(&root),
        (None, Err(faults)) => return Err(OpenError::Manifest(faults)),
    };
    let mut loader = FsLoader::new(root, packages);
    if let Some(bytes) = bytes {
        loader.held.insert(path.clone(), bytes);
        if let Some(held) = unpack(&mut loader, scene, &path)? {
            loader.bundle = Some((held.clone(), full));
            return Ok(Opened { loader, path: held, picture: None });
        }
        loader.held.clear();
    }
    Ok(Opened { loader, path, picture: None })
}

/// The bytes of a file. Pipes would be waited for, and devices have no end.
pub(super) fn read_file(full: &Path) -> io::Result<Vec<u8>> {
    let kind = fs::metadata(full)?;
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !kind.is_file() {
        return Err(io::Error::other("it is not a file"));
    }
    if kind.len() > LARGEST {
        return Err(io::Error::other("it is larger than 1 GiB"));
    }
    fs::read(full)
}

/// The bytes of a file that may be a bundle: no other is read before it is asked for.
fn bundled(full: &Path) -> io::Result<Option<Arc<[u8]>>> {
    let bytes = read_file(full)?;
    let is_bundle = std::str::from_utf8(&bytes).is_ok_and(|text| !bundle::split(text).1.is_empty());
    Ok(is_bundle.then(|| bytes.into()))
}

/// Where the file that is held under a path is a bundle, holds what is in it too; the path of its scene.
fn unpack(loader: &mut FsLoader, scene: &Path, path: &str) -> Result<Option<String>, OpenError> {
    let Some(bytes) = loader.held.get(path).cloned() else { return Ok(None) };
    let Ok(text) = std::str::from_utf8(&bytes) else { return Ok(None) };
    let refused = |error| OpenError::Words(format!("{}: {error}", scene.display()), Ended::Fault);
    let Some(bundle) = bundle::read(text).map_err(refused)? else { return Ok(None) };
    // The scene is called after the bundle, but lies where it lay among its files.
    let file = path.rsplit('/').next().unwrap_or(path);
    let beside =
        bundle.scene.rsplit_once('/').map_or_else(|| file.to_owned(), |(folder, _)| format!("{folder}/{file}"));
    let is_taken = bundle.files.iter().any(|(path, _)| *path == beside);
    let main = if is_taken { bundle.scene } else { beside };
    loader.held.remove(path);
    loader.held.extend(bundle.files.into_iter().map(|(path, bytes)| (path, bytes.into())));
    loader.held.insert(main.clone(), bytes);
    loader.aliases = bundle.dependencies;
    Ok(Some(main))
}

/// Whether a file is a picture, which may hold a scene.
pub(super) fn is_picture(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    extension == "svg" || extension == "png" || extension == "pdf"
}

/// The scene that the bytes of a picture hold, with this root for what they do not; messages call the picture `name`.
pub(super) fn picture(bytes: &[u8], root: &Path, name: String) -> Result<Opened, OpenError> {
    let Some(picture) = metadata::extract(bytes) else { return Err(OpenError::NoScene(name)) };
    let texts = picture.sources.iter().map(|(path, text)| (path.clone(), Arc::from(text.as_bytes())));
    let files = picture.files.iter().map(|(path, bytes)| (path.clone(), Arc::from(&bytes[..])));
    let held = texts.chain(files).collect();
    let path = picture.scene.clone();
    // What is wrong with a library that the picture happens to lie in does not matter to what it holds.
    let packages = Packages::find(root).unwrap_or_else(|_| Packages::alone(root));
    let loader = FsLoader { held, aliases: picture.dependencies.clone(), ..FsLoader::new(root.to_owned(), packages) };
    Ok(Opened { loader, path, picture: Some(picture) })
}

/// The loader of scenes that lie in a folder, saved or not, and what is wrong with the manifests of their libraries.
pub(super) fn beside(folder: &Path) -> (FsLoader, Option<Faults>) {
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let root = folder.ancestors().find(|dir| dir.join(MANIFEST).is_file()).unwrap_or(&folder).to_owned();
    let (packages, faults) = match Packages::find(&root) {
        Ok(packages) => (packages, None),
        Err(faults) => (Packages::alone(&root), Some(faults)),
    };
    (FsLoader::new(root, packages), faults)
}

/// A relative path with forward slashes.
pub(super) fn slashed(path: &Path) -> String {
    let parts = path.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_string_lossy()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

/// An error of the system without its number.
pub(super) fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    text.split_once(" (os error").map_or(text.clone(), |(words, _)| words.to_lowercase())
}

/// Prints bytes to standard output. A reader that has gone away is no failure.
pub(super) fn print(bytes: &[u8]) -> Ended {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ended::Done,
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ended::Done,
        Err(error) => {
            eprintln!("kake: cannot write to standard output: {}", plain(&error));
            Ended::Io
        }
    }
}

/// A file that is written beside its place and moved there when it is whole.
pub(super) struct Pending {
    target: PathBuf,
    file: Written,
}

enum Written {
    /// Beside its place, to be moved there.
    Beside(tempfile::TempPath),
    /// Straight to a device or pipe, which cannot be replaced.
    Straight,
}

/// Writes a file beside its place; `write` fills it.
pub(super) fn write_beside(target: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<Pending> {
    // What a link points to is replaced, not the link.
    let target = target.canonicalize().unwrap_or_else(|_| target.to_owned());
    if fs::metadata(&target).is_ok_and(|kind| !kind.is_file() && !kind.is_dir()) {
        let mut file = BufWriter::with_capacity(BUFFER, fs::OpenOptions::new().write(true).open(&target)?);
        write(&mut file)?;
        file.flush()?;
        return Ok(Pending { target, file: Written::Straight });
    }
    if target.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".kake-").suffix(".part");
    permissions(&mut builder, &target);
    let mut file = builder.tempfile_in(folder)?;
    let mut buffered = BufWriter::with_capacity(BUFFER, file.as_file_mut());
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    // The file is closed: many may be pending at a time.
    Ok(Pending { target, file: Written::Beside(file.into_temp_path()) })
}

const BUFFER: usize = 1 << 20;

/// A new file is as readable as any other; one that replaces an old file keeps its permissions.
#[cfg(unix)]
fn permissions(builder: &mut tempfile::Builder<'_, '_>, target: &Path) {
    use std::os::unix::fs::PermissionsExt;
    let kept = fs::metadata(target).map(|kind| kind.permissions());
    builder.permissions(kept.unwrap_or_else(|_| fs::Permissions::from_mode(0o666)));
}

#[cfg(not(unix))]
fn permissions(_builder: &mut tempfile::Builder<'_, '_>, _target: &Path) {}

/// Replaces a file by a text, whole or not at all.
pub(super) fn replace(target: &Path, text: &str) -> Ended {
    match write_beside(target, |out| out.write_all(text.as_bytes())).and_then(Pending::keep) {
        Ok(()) => Ended::Done,
        Err(error) => {
            eprintln!("kake: cannot write {}: {}", target.display(), plain(&error));
            Ended::Io
        }
    }
}

impl Pending {
    /// Moves the file to its place, if no other has come there meanwhile.
    pub(super) fn keep_new(self) -> io::Result<()> {
        match self.file {
            Written::Beside(file) => file.persist_noclobber(&self.target).map_err(|error| error.error),
            Written::Straight => Ok(()),
        }
    }

    /// Moves the file to its place.
    pub(super) fn keep(self) -> io::Result<()> {
        match self.file {
            Written::Beside(file) => file.persist(&self.target).map_err(|error| error.error),
            Written::Straight => Ok(()),
        }
    }
}
