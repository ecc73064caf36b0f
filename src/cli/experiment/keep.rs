//! The file that finished runs are kept in until all are.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::cli::Ended;
use crate::cli::files::plain;
use crate::experiment::{Done, Journal, Recipe, Shard, entry, head};

/// What is added to the name of a journal that is put aside.
const ASIDE: &str = "old";

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
    /// over; a journal of another is put aside.
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
        let found = Journal::read(&bytes);
        if let Some(journal) = found.filter(|journal| journal.recipe == *recipe && journal.shard == shard) {
            if journal.damaged > 0 {
                eprintln!("kake: {} damaged in {}, and done again", lines(journal.damaged), path.display());
            }
            let length = journal.whole as u64;
            file.set_len(length).map_err(|error| failed(&path, &error))?;
            return Ok(Self { path, file, done: journal.done, length });
        }
        // A first line that was cut short is not worth keeping.
        if bytes.contains(&b'\n') {
            let aside = path.with_extension(format!("journal.{ASIDE}"));
            fs::rename(&path, &aside).map_err(|error| failed(&aside, &error))?;
            eprintln!("kake: the scene, its files or its parameters are not those of the runs in {}", folder.display());
            eprintln!("kake: all runs are done anew; the earlier ones are kept in {}", aside.display());
            file = open(&path).map_err(|error| failed(&path, &error))?;
            lock(&file, folder)?;
        }
        let first = head(recipe, shard).map_err(|error| failed(&path, &error.into()))?;
        let begun = file.set_len(0).and_then(|()| file.write_all(first.as_bytes()));
        begun.map_err(|error| failed(&path, &error))?;
        Ok(Self { path, file, done: BTreeMap::new(), length: first.len() as u64 })
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
