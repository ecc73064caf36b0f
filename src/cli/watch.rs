//! Files that change: which files matter and how they stood when they were read goes in; those that were saved, deleted
//! or came back come out.
//!
//! Folders are watched rather than files, for editors save by renaming, and files that are missing may yet come. What the
//! system reports only says when to look: what changed is seen from the files themselves. They are looked at once a
//! second besides, for there are drives of which no system reports anything.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use notify::{RecommendedWatcher, RecursiveMode, Watcher};

/// How long nothing happens before files are looked at: saving takes several steps.
const QUIET: Duration = Duration::from_millis(25);

/// How long that is waited for at most.
const PATIENCE: Duration = Duration::from_millis(250);

/// How often files are looked at where nothing is reported.
const ROUND: Duration = Duration::from_secs(1);

/// How files stood, by their places on disk.
pub(super) type Stamps = BTreeMap<PathBuf, Stamp>;

/// How a file stands: what differs after it was saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Stamp(Option<(u64, Option<SystemTime>, u64)>);

impl Stamp {
    /// Looks at a file; one that cannot be seen is missing.
    pub(super) fn of(path: &Path) -> Self {
        Self(fs::metadata(path).ok().map(|file| (file.len(), file.modified().ok(), number(&file))))
    }
}

/// What tells a file from another that was put in its place.
#[cfg(unix)]
fn number(file: &fs::Metadata) -> u64 {
    use std::os::unix::fs::MetadataExt;
    file.ino()
}

#[cfg(not(unix))]
fn number(_file: &fs::Metadata) -> u64 {
    0
}

/// Follows files until it is dropped.
pub(super) struct Watch {
    followed: Arc<Mutex<Followed>>,
    wake: mpsc::Sender<()>,
}

struct Followed {
    stamps: Stamps,
    folders: BTreeSet<PathBuf>,
    /// None where the system has none to give.
    watcher: Option<RecommendedWatcher>,
}

impl Watch {
    /// Follows nothing as yet. `report` is told of files that changed, several at a time, on a thread of its own.
    ///
    /// # Errors
    /// If no thread can be had.
    pub(super) fn start(report: impl Fn(Vec<PathBuf>) + Send + 'static) -> io::Result<Self> {
        let (wake, woken) = mpsc::channel();
        let notice = wake.clone();
        let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            // Reading is no change, and this program reads.
            if event.is_ok_and(|event| !event.kind.is_access()) {
                // Fails only where nobody watches any more.
                let _ = notice.send(());
            }
        });
        let followed = Followed { stamps: Stamps::new(), folders: BTreeSet::new(), watcher: watcher.ok() };
        let followed = Arc::new(Mutex::new(followed));
        let seen = Arc::downgrade(&followed);
        thread::Builder::new().name("watch".to_owned()).spawn(move || {
            loop {
                match woken.recv_timeout(ROUND) {
                    Ok(()) => settle(&woken),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
                let Some(followed) = seen.upgrade() else { return };
                let changed = followed.lock().unwrap_or_else(PoisonError::into_inner).look();
                drop(followed);
                if !changed.is_empty() {
                    report(changed);
                }
            }
        })?;
        Ok(Self { followed, wake })
    }

    /// Follows these files too. Those that stand otherwise by now are reported.
    pub(super) fn follow(&self, stamps: Stamps) {
        let mut followed = self.followed.lock().unwrap_or_else(PoisonError::into_inner);
        for (path, stamp) in stamps {
            if !followed.stamps.contains_key(&path) {
                followed.watch(&path);
                followed.stamps.insert(path, stamp);
            }
        }
        drop(followed);
        // Fails only where the thread ended, which it does not before this is dropped.
        let _ = self.wake.send(());
    }
}

/// Waits until nothing more is reported, or long enough.
fn settle(woken: &mpsc::Receiver<()>) {
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE && woken.recv_timeout(QUIET).is_ok() {}
}

impl Followed {
    /// Watches the folder that a file lies in, or the nearest one that is there.
    fn watch(&mut self, path: &Path) {
        let Some(folder) = path.ancestors().skip(1).find(|folder| folder.is_dir()) else { return };
        if self.folders.contains(folder) {
            return;
        }
        // Where that fails, files are looked at by the second.
        if let Some(watcher) = &mut self.watcher
            && watcher.watch(folder, RecursiveMode::NonRecursive).is_ok()
        {
            self.folders.insert(folder.to_owned());
        }
    }

    /// Which files stand otherwise than when they were looked at last.
    fn look(&mut self) -> Vec<PathBuf> {
        let mut changed = Vec::new();
        for (path, known) in &mut self.stamps {
            let stamp = Stamp::of(path);
            if stamp != *known {
                *known = stamp;
                changed.push(path.clone());
            }
        }
        // A folder that was taken away and made again is another folder.
        self.folders.retain(|folder| folder.is_dir());
        for path in &changed {
            self.watch(path);
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a watch reports of a file in a folder.
    fn changes(path: &Path) -> (Watch, mpsc::Receiver<Vec<PathBuf>>) {
        let (sender, receiver) = mpsc::channel();
        let watch = Watch::start(move |changed| sender.send(changed).unwrap_or_default()).unwrap();
        watch.follow(Stamps::from([(path.to_owned(), Stamp::of(path))]));
        (watch, receiver)
    }

    #[test]
    fn files_that_are_saved_deleted_and_come_back_are_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.kake");
        fs::write(&path, "a").unwrap();
        let (watch, changes) = changes(&path);
        let wait = || assert_eq!(changes.recv_timeout(Duration::from_secs(20)).unwrap(), std::slice::from_ref(&path));
        fs::write(&path, "ab").unwrap();
        wait();
        let beside = folder.path().join("scene.kake~");
        fs::write(&beside, "abc").unwrap();
        fs::rename(&beside, &path).unwrap();
        wait();
        fs::remove_file(&path).unwrap();
        wait();
        fs::write(&path, "ab").unwrap();
        wait();
        drop(watch);
    }

    #[test]
    fn files_in_folders_that_are_missing_may_come() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tones/deep/plain.kake");
        let (_watch, changes) = changes(&path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, "a").unwrap();
        assert_eq!(changes.recv_timeout(Duration::from_secs(20)).unwrap(), [path]);
    }

    #[test]
    fn what_changed_before_it_is_followed_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.kake");
        let before = Stamp::of(&path);
        fs::write(&path, "a").unwrap();
        let (sender, changes) = mpsc::channel();
        let watch = Watch::start(move |changed| sender.send(changed).unwrap_or_default()).unwrap();
        watch.follow(Stamps::from([(path.clone(), before)]));
        assert_eq!(changes.recv_timeout(Duration::from_secs(20)).unwrap(), [path]);
    }
}
