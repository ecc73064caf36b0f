//! What is read from git: folders, blobs and a few settings, through the git program and nothing else. No shell is run, no
//! argument that comes from outside can become an option, nothing is fetched and nothing written.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{Arc, OnceLock};

use crate::cli::files::{FsLoader, LARGEST, plain};
use crate::loader::{self, LoadError, Loader, UnknownDependency};

/// How many commits that changed a file are looked at for one of its versions.
const COMMITS: &str = "8";

/// The git program, with what keeps it from doing more than reading.
fn git() -> Command {
    let mut command = Command::new("git");
    command.args(["--no-pager", "--literal-pathspecs", "-c", "core.fsmonitor=false"]);
    command.env("GIT_OPTIONAL_LOCKS", "0").env("GIT_NO_LAZY_FETCH", "1");
    command.stdin(Stdio::null()).stderr(Stdio::piped());
    command
}

/// What a command prints, without its line end; none where it fails.
fn answer(arguments: &[&OsStr]) -> Option<String> {
    let output = git().args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim_end_matches(['\n', '\r']).to_owned())
}

fn words(arguments: &[&str]) -> Option<String> {
    answer(&arguments.iter().map(OsStr::new).collect::<Vec<_>>())
}

/// The repository that the program was called in.
#[derive(Debug, Clone)]
pub(super) struct Repository {
    /// Its working tree, unless it has none.
    pub(super) top: Option<PathBuf>,
    /// The folder that the program was called in, from the top: empty or with a slash at its end.
    prefix: String,
}

/// A state of a repository.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum State {
    /// A tree by its hexadecimal name.
    Tree(String),
    /// What is to be committed next.
    Index,
    /// The files as they lie in the working tree.
    Disk,
}

/// Which of two versions of a file is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    /// The one before.
    Old,
    /// The one after.
    New,
}

impl Repository {
    /// Finds it, or says why not.
    pub(super) fn find() -> Result<Self, String> {
        let failed = |output: &Output| {
            let said = String::from_utf8_lossy(&output.stderr);
            let said = said.lines().next().unwrap_or_default();
            said.strip_prefix("fatal: ").unwrap_or(said).to_owned()
        };
        let output = git().args(["rev-parse", "--show-prefix"]).output().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => "it needs the git program, and there is none to be found".to_owned(),
            _ => format!("the git program cannot be run: {}", plain(&error)),
        })?;
        if !output.status.success() {
            return Err(format!("git says: {}", failed(&output)));
        }
        let prefix = String::from_utf8_lossy(&output.stdout).trim_end_matches(['\n', '\r']).to_owned();
        let top = words(&["rev-parse", "--show-toplevel"]).filter(|top| !top.is_empty());
        Ok(Self { top: top.and_then(|top| PathBuf::from(top).canonicalize().ok()), prefix })
    }

    /// The state that a revision names; an empty one is the index.
    pub(super) fn state(&self, revision: &str) -> Result<State, String> {
        if revision.is_empty() {
            return Ok(State::Index);
        }
        let unknown = || format!("git knows no revision `{revision}`");
        if revision.starts_with('-') {
            return Err(unknown());
        }
        let tree = words(&["rev-parse", "--verify", "--quiet", &format!("{revision}^{{tree}}")]);
        tree.filter(|tree| is_name(tree)).map(State::Tree).ok_or_else(unknown)
    }

    /// A path as git takes it, from the top: paths that start with a dot start at the folder the program was called in.
    pub(super) fn path(&self, path: &str) -> Option<String> {
        let from = if path.starts_with("./") || path.starts_with("../") { self.prefix.as_str() } else { "" };
        loader::resolve(from, path).filter(|path| !path.is_empty())
    }

    /// The same path as if it started at the folder the program was called in, where that makes a difference.
    pub(super) fn beside(&self, path: &str) -> Option<String> {
        (!self.prefix.is_empty()).then(|| format!("{}{path}", self.prefix))
    }

    /// Reads a file in a state other than the disk's.
    pub(super) fn read(&self, state: &State, path: &str) -> Result<Arc<[u8]>, LoadError> {
        let bytes = match state {
            // Links are followed inside the tree alone; the program reads names line by line.
            State::Tree(tree) if !path.contains('\n') => batch(&format!("{tree}:{path}"))?,
            State::Tree(tree) => blob(&format!("{tree}:{path}"))?,
            State::Index => blob(&format!(":0:{path}"))?,
            State::Disk => return Err(LoadError::Missing),
        };
        if bytes.starts_with(b"version https://git-lfs.github.com/spec/") {
            let why = "it is kept by Git LFS, and only a pointer to it lies in the repository";
            return Err(LoadError::Unreadable(why.to_owned()));
        }
        Ok(bytes.into())
    }

    /// Where a version of a file stands with all that lies around it, and what that is called. The same blob may stand in
    /// many states: HEAD and the index are asked first, then the commits that last brought it in or took it away.
    fn holder(&self, path: &str, hex: &str, which: Which) -> (State, String) {
        let holds = |state: &str| {
            words(&["rev-parse", "--verify", "--quiet", &format!("{state}:{path}")]).as_deref() == Some(hex)
        };
        let tree = |commit: &str| self.state(commit).ok();
        let disk = || (State::Disk, "the working tree".to_owned());
        if !is_name(hex) || hex.bytes().all(|digit| digit == b'0') {
            // It is no version but the file itself, and goes without saying.
            return (State::Disk, String::new());
        }
        if holds("HEAD")
            && let Some(state) = tree("HEAD")
        {
            return (state, "HEAD".to_owned());
        }
        if holds(":0") {
            return (State::Index, "the index".to_owned());
        }
        let find = format!("--find-object={hex}");
        let history = [
            "log",
            "--all",
            "--no-ext-diff",
            "--no-textconv",
            "--no-show-signature",
            "--format=%H",
            "-n",
            COMMITS,
            &find,
            "--",
            path,
        ];
        for commit in words(&history).unwrap_or_default().lines().filter(|commit| is_name(commit)) {
            let (after, before) = (commit.to_owned(), format!("{commit}^"));
            let sides = match which {
                Which::Old => [before, after],
                Which::New => [after, before],
            };
            if let Some(found) = sides.iter().find(|side| holds(side))
                && let Some(state) = tree(found)
            {
                let name = words(&["rev-parse", "--short", &format!("{found}^0")]);
                return (state, name.unwrap_or_else(|| found.clone()));
            }
        }
        disk()
    }

    /// The name that git gives the content of a file.
    pub(super) fn hash(file: &Path) -> Option<String> {
        let arguments = [OsStr::new("hash-object"), OsStr::new("--no-filters"), OsStr::new("--"), file.as_os_str()];
        answer(&arguments).filter(|hex| is_name(hex))
    }
}

/// Whether the driver that git called for a path may say by its exit status that pictures differ. Git asks for that through
/// the environment or its settings, depending on where the driver's command stands; everything but 0 is a failure otherwise.
pub(super) fn trusts(path: &Path) -> bool {
    let is_yes = |setting: &str| words(&["config", "--type=bool", "--get", setting]).as_deref() == Some("true");
    let is_set = |setting: &str| words(&["config", "--get", setting]).is_some();
    let attribute =
        answer(&[OsStr::new("check-attr"), OsStr::new("-z"), OsStr::new("diff"), OsStr::new("--"), path.as_os_str()]);
    let name = attribute.as_deref().and_then(|text| text.split('\0').nth(2)).unwrap_or_default();
    if is_set(&format!("diff.{name}.command")) {
        return is_yes(&format!("diff.{name}.trustExitCode"));
    }
    if std::env::var_os("GIT_EXTERNAL_DIFF").is_some_and(|command| !command.is_empty()) {
        let said = std::env::var("GIT_EXTERNAL_DIFF_TRUST_EXIT_CODE").unwrap_or_default();
        return is_true(&said);
    }
    is_set("diff.external") && is_yes("diff.trustExitCode")
}

/// Whether a variable says yes, in the words that git knows.
fn is_true(text: &str) -> bool {
    let text = text.trim().to_ascii_lowercase();
    matches!(text.as_str(), "true" | "yes" | "on") || text.parse::<i64>().is_ok_and(|number| number != 0)
}

/// Whether a text is the full name of an object.
fn is_name(text: &str) -> bool {
    matches!(text.len(), 40 | 64) && text.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// A blob by its name alone.
fn blob(name: &str) -> Result<Vec<u8>, LoadError> {
    let output = git().args(["cat-file", "blob", name]).output();
    let output = output.map_err(|error| LoadError::Unreadable(plain(&error)))?;
    if output.status.success() { Ok(output.stdout) } else { Err(LoadError::Missing) }
}

/// A blob in a tree, links followed as far as they stay in it.
fn batch(name: &str) -> Result<Vec<u8>, LoadError> {
    let failed = |error: io::Error| LoadError::Unreadable(plain(&error));
    let mut command = git();
    command.args(["cat-file", "--batch", "--follow-symlinks"]);
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().map_err(failed)?;
    if let Some(mut input) = child.stdin.take() {
        // What the program does not take it does not answer to either.
        let _ = writeln!(input, "{name}");
    }
    let mut found = Err(LoadError::Missing);
    if let Some(output) = child.stdout.take() {
        let mut output = BufReader::new(output);
        let mut head = String::new();
        output.read_line(&mut head).map_err(failed)?;
        let mut parts = head.trim_end().rsplit(' ');
        let (size, kind) = (parts.next().and_then(|size| size.parse::<u64>().ok()), parts.next());
        found = match (size, kind) {
            _ if head.starts_with("symlink ") => Err(LoadError::Outside),
            (Some(size), Some("blob")) if size > LARGEST => {
                Err(LoadError::Unreadable("it is larger than 1 GiB".to_owned()))
            }
            (Some(size), Some("blob")) => {
                let mut bytes = Vec::new();
                output.take(size).read_to_end(&mut bytes).map_err(failed).map(|_| bytes)
            }
            (_, Some("tree" | "commit" | "tag")) => Err(LoadError::Unreadable("it is not a file".to_owned())),
            _ => Err(LoadError::Missing),
        };
    }
    let _ = child.kill();
    let _ = child.wait();
    found
}

/// Reads what a scene names in the state of the repository that it stands in; dependencies as they lie on disk.
#[derive(Debug)]
pub(super) struct GitLoader {
    repository: Repository,
    /// The folder of what the scene may read, from the top of the repository; empty for the top.
    root: String,
    /// The scene itself.
    held: BTreeMap<String, Arc<[u8]>>,
    disk: FsLoader,
    /// What state that is, where it has to be found out: the scene's path from the top, its blob, and which version it is.
    sought: (String, String, Which),
    state: OnceLock<(State, String)>,
}

impl GitLoader {
    /// Of a scene in a state that is known.
    pub(super) fn known(repository: Repository, state: State, root: String, disk: FsLoader) -> Self {
        let state = OnceLock::from((state, String::new()));
        let sought = (String::new(), String::new(), Which::New);
        Self { repository, root, held: BTreeMap::new(), disk, sought, state }
    }

    /// Of a version of a scene, told by its path from the top and its blob; where it stands is found out when the scene
    /// asks for another file.
    pub(super) fn sought(
        repository: Repository,
        sought: (String, String, Which),
        root: String,
        held: (String, Arc<[u8]>),
        disk: FsLoader,
    ) -> Self {
        Self { repository, root, held: BTreeMap::from([held]), disk, sought, state: OnceLock::new() }
    }

    /// Where files were read that stand around the scene, if that had to be found out.
    pub(super) fn found(&self) -> Option<&str> {
        self.state.get().map(|(_, name)| name.as_str()).filter(|name| !name.is_empty())
    }
}

impl Loader for GitLoader {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if let Some(bytes) = self.held.get(path) {
            return Ok(Arc::clone(bytes));
        }
        if !loader::split(path).0.is_empty() {
            return self.disk.load(path);
        }
        let (state, _) = self.state.get_or_init(|| {
            let (path, hex, which) = &self.sought;
            self.repository.holder(path, hex, *which)
        });
        match state {
            State::Disk => self.disk.load(path),
            State::Tree(_) | State::Index => self.repository.read(state, &below(&self.root, path)),
        }
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        self.disk.dependency(of, name)
    }
}

/// A path below a folder that may be the top.
pub(super) fn below(folder: &str, path: &str) -> String {
    if folder.is_empty() { path.to_owned() } else { format!("{folder}/{path}") }
}
