//! The file that finished runs are kept in until all are.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::cli::Ended;
use crate::cli::files::plain;
use crate::experiment::{Done, Journal, Recipe, Shard, entry, head};

/// What is added to the name of a journal that is put aside; from the second on, a number follows.
const ASIDE: &str = ".old";

/// A journal that grows.
pub(super) struct Keep {
    path: PathBuf,
    file: File,
    done: BTreeMap<usize, Done>,
    /// The bytes of whole lines.
    length: u64,
}

/// The runs of a journal that is complete. The folder stays locked while this is held.
pub(super) struct Kept {
    pub(super) done: BTreeMap<usize, Done>,
    _lock: File,
}

/// The name of the journal of a share.
pub(super) fn name(shard: Shard) -> String {
    match shard.is_whole() {
        true => "runs.journal".to_owned(),
        false => format!("runs-{}-of-{}.journal", shard.index, shard.of),
    }
}

impl Keep {
    /// Opens the journal of a share in a folder, which is made where there is none. Runs of the same recipe are taken
    /// over; a journal of another is put aside, and one of the same that was put aside earlier is taken up again.
    pub(super) fn open(folder: &Path, recipe: &Recipe, shard: Shard) -> Result<Self, Ended> {
        let failed = |path: &Path, error: &io::Error| {
            eprintln!("kake: cannot write {}: {}", path.display(), plain(error));
            Ended::Io
        };
        fs::create_dir_all(folder).map_err(|error| failed(folder, &error))?;
        let path = folder.join(name(shard));
        let mut file = open(&path).map_err(|error| failed(&path, &error))?;
        lock(&file, folder)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(|error| failed(&path, &error))?;
        let is_own = |journal: &Journal| journal.recipe == *recipe && journal.shard == shard;
        let found = Journal::read(&bytes);
        let is_legible = found.is_some();
        if let Some(journal) = found.filter(is_own) {
            file.set_len(journal.whole as u64).map_err(|error| failed(&path, &error))?;
            return Ok(Self::of(path, file, journal));
        }
        let earlier = earlier(folder, &name(shard), is_own);
        // A first line that was cut short is not worth keeping.
        if bytes.contains(&b'\n') {
            let aside = free(folder, &name(shard));
            fs::rename(&path, &aside).map_err(|error| failed(&aside, &error))?;
            if is_legible {
                let folder = folder.display();
                eprintln!("kake: the scene, its files or its parameters are not those of the runs in {folder}");
            } else {
                eprintln!("kake: the first line of {}, which says what its runs are of, is damaged", path.display());
            }
            let now = if earlier.is_some() { "" } else { "all runs are done anew; " };
            eprintln!("kake: {now}the earlier journal is kept in {}", aside.display());
            file = open(&path).map_err(|error| failed(&path, &error))?;
            lock(&file, folder)?;
        }
        if let Some(Earlier { path: kept, bytes, journal }) = earlier {
            eprintln!("kake: the runs in {} are of the same scene and parameters, and taken up again", kept.display());
            // The journal is copied, not moved: another process may have begun one in its place, which is locked by now
            // and must not be replaced. Only when the copy is on the disk is the other one removed.
            let copied =
                file.set_len(0).and_then(|()| file.write_all(&bytes[..journal.whole])).and_then(|()| file.sync_all());
            if let Err(error) = copied {
                // Half a copy would be gone on with, and the whole one never looked at.
                let _ = file.set_len(0);
                return Err(failed(&path, &error));
            }
            let _ = fs::remove_file(kept);
            return Ok(Self::of(path, file, journal));
        }
        let first = head(recipe, shard).map_err(|error| failed(&path, &error.into()))?;
        let begun = file.set_len(0).and_then(|()| file.write_all(first.as_bytes()));
        begun.map_err(|error| failed(&path, &error))?;
        Ok(Self { path, file, done: BTreeMap::new(), length: first.len() as u64 })
    }

    /// The journal that a file holds.
    fn of(path: PathBuf, file: File, journal: Journal) -> Self {
        if journal.damaged > 0 {
            eprintln!("kake: {} damaged in {}, and done again", lines(journal.damaged), path.display());
        }
        Self { path, file, done: journal.done, length: journal.whole as u64 }
    }

    /// Whether a run is finished.
    pub(super) fn has(&self, run: usize) -> bool {
        self.done.contains_key(&run)
    }

    /// How many runs are.
    pub(super) fn len(&self) -> usize {
        self.done.len()
    }

    /// Adds a run. Where that fails, the journal stays as it was.
    pub(super) fn add(&mut self, done: Done) -> Result<(), String> {
        let words = |error: &io::Error| format!("cannot write {}: {}", self.path.display(), plain(error));
        let line = entry(&done).map_err(|error| words(&error.into()))?;
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // Half a line is left out when the journal is read; without it there is nothing to leave out.
            let _ = self.file.set_len(self.length).and_then(|()| self.file.seek(SeekFrom::End(0)).map(|_| ()));
            return Err(words(&error));
        }
        self.length += line.len() as u64;
        self.done.insert(done.run, done);
        Ok(())
    }

    /// The runs.
    pub(super) fn close(self) -> Kept {
        Kept { done: self.done, _lock: self.file }
    }
}

/// A journal that was put aside.
struct Earlier {
    path: PathBuf,
    bytes: Vec<u8>,
    journal: Journal,
}

/// The journal to take up again among those that were put aside: the one with the most runs. What cannot be read is left
/// where it is.
fn earlier(folder: &Path, name: &str, is_own: impl Fn(&Journal) -> bool) -> Option<Earlier> {
    let entries = fs::read_dir(folder).ok()?.filter_map(Result::ok);
    let aside = entries.filter(|entry| entry.file_name().to_str().is_some_and(|file| is_aside(file, name)));
    let read = aside.filter_map(|entry| {
        let path = entry.path();
        let bytes = fs::read(&path).ok()?;
        let journal = Journal::read(&bytes).filter(&is_own)?;
        Some(Earlier { path, bytes, journal })
    });
    read.max_by_key(|earlier| earlier.journal.done.len())
}

/// Whether a file is called as a journal of this name is that was put aside.
fn is_aside(file: &str, name: &str) -> bool {
    let rest = file.strip_prefix(name).and_then(|rest| rest.strip_prefix(ASIDE));
    let is_number = |text: &str| text.strip_prefix('-').is_some_and(|text| text.parse::<u64>().is_ok());
    rest.is_some_and(|rest| rest.is_empty() || is_number(rest))
}

/// The first name to put a journal aside by that no file has: finished runs are never written over.
fn free(folder: &Path, name: &str) -> PathBuf {
    let mut path = folder.join(format!("{name}{ASIDE}"));
    let mut number = 1_u64;
    // A link that leads nowhere has the name all the same.
    while path.symlink_metadata().is_ok() {
        number += 1;
        path = folder.join(format!("{name}{ASIDE}-{number}"));
    }
    path
}

fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).append(true).create(true).open(path)
}

/// Keeps others from the same journal; a file system that knows no locks has none.
fn lock(file: &File, folder: &Path) -> Result<(), Ended> {
    match file.try_lock() {
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            eprintln!("kake: another `kake experiment` is at work in {}", folder.display());
            Err(Ended::Io)
        }
    }
}

fn lines(count: usize) -> String {
    match count {
        1 => "one run is".to_owned(),
        count => format!("{count} runs are"),
    }
}

/// A journal that is complete, its runs in the order of the plan.
pub(super) fn complete(recipe: &Recipe, shard: Shard, done: &BTreeMap<usize, Done>) -> io::Result<Vec<u8>> {
    let mut text = head(recipe, shard)?;
    for done in done.values() {
        text.push_str(&entry(done)?);
    }
    Ok(text.into_bytes())
}
