//! One preview: the scene that is shown, what was drawn of it, and who listens.

use std::collections::BTreeMap;
use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use serde::Deserialize;
use serde_json::{Value, json};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use crate::library::MANIFEST;
use crate::lower::LowerConfig;
use crate::overlay::Overlay;
use crate::scene::Limits;
use crate::stop::Stop;
use crate::{Compiled, Config, Observer, compile};

use super::job::Queue;
use super::pictures::{Picture, Pictures};
use crate::cli::files::{OpenError, Opened, open};
use crate::cli::packages::Faults;
use crate::cli::picture::take_over;
use crate::cli::watch::{Stamp, Stamps, Watch};

/// What is drawn: values of parameters, a seed, what is shown on top, and one paint alone.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Wanted {
    pub(super) sets: BTreeMap<String, String>,
    pub(super) seed: Option<Seed>,
    pub(super) overlays: Vec<String>,
    pub(super) only: Option<String>,
}

/// A seed. Browsers know whole numbers up to 2^53 only; greater ones are text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Value")]
pub(super) struct Seed(pub(super) u64);

/// The greatest number up to which a browser tells all whole numbers apart.
const EXACT: u64 = 1 << 53;

impl TryFrom<Value> for Seed {
    type Error = String;

    fn try_from(value: Value) -> Result<Self, String> {
        let number = value.as_u64().or_else(|| value.as_str()?.trim().parse().ok());
        number.map(Self).ok_or_else(|| "a seed is a whole number from 0 to 18,446,744,073,709,551,615".to_owned())
    }
}

impl Seed {
    /// As the page reads it.
    pub(super) fn to_json(self) -> Value {
        if self.0 <= EXACT { json!(self.0) } else { json!(self.0.to_string()) }
    }
}

/// Something that the page is told.
#[derive(Debug, Clone)]
pub(super) struct Event {
    /// Its kind.
    pub(super) name: &'static str,
    /// What it says, as JSON.
    pub(super) data: String,
}

/// What the command line says of a preview.
pub(super) struct Settings {
    /// The scene's file, from the root of the file system.
    pub(super) scene: PathBuf,
    /// The same as the user gave it.
    pub(super) given: PathBuf,
    pub(super) root: Option<PathBuf>,
    pub(super) sets: Vec<(String, String)>,
    pub(super) seed: Option<u64>,
    pub(super) limits: Limits,
    /// The `--limit` and `--root` arguments as they were given, for the command that makes a picture again.
    pub(super) arguments: Vec<String>,
    /// The folder that pictures are saved in.
    pub(super) output: PathBuf,
}

/// What the page is shown where a scene is at fault.
#[derive(Default)]
pub(super) struct Last {
    /// The parameters, layers, paints and page of the last drawing without fault.
    pub(super) good: Option<Value>,
    /// The revision and the scene's text that were drawn last.
    pub(super) text: Option<(u64, Arc<str>)>,
}

/// One preview.
pub(super) struct Session {
    pub(super) settings: Settings,
    /// What shows that a request comes from our page.
    pub(super) token: String,
    /// Tells the pictures of this preview from those that a browser keeps of another.
    pub(super) name: String,
    /// Compilations.
    pub(super) queue: Queue,
    /// What is done with drawings that are there: tiles do not wait for compilations.
    pub(super) brushes: Queue,
    revision: AtomicU64,
    pictures: Mutex<Pictures>,
    last: Mutex<Last>,
    listeners: Mutex<Vec<UnboundedSender<Event>>>,
    watch: OnceLock<Watch>,
    /// Held while a file is written, so that an end waits for it.
    writing: Mutex<()>,
}

/// A compilation with what it was made from.
pub(super) struct Made {
    pub(super) opened: Opened,
    pub(super) config: Config,
    pub(super) compiled: Compiled,
    /// Which state of the files was read.
    pub(super) revision: u64,
}

/// Why there is no compilation.
pub(super) enum Unmade {
    /// What is wanted makes no sense.
    Nonsense(String),
    /// The scene cannot be opened.
    NoScene(String),
    /// The library that the scene lies in is at fault.
    Manifest(Faults),
}

impl Unmade {
    /// What is wrong, in a line.
    pub(super) fn words(&self) -> String {
        match self {
            Self::Nonsense(words) | Self::NoScene(words) => words.clone(),
            Self::Manifest(faults) => {
                let first = faults.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
                first.map_or_else(|| "the library is at fault".to_owned(), |first| first.message.clone())
            }
        }
    }
}

/// What a lock guards, even where a thread panicked while it held it: no change here is made by halves.
pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sixteen digits that nobody can guess: the keys of std's hasher come from the system's randomness.
fn unguessable(purpose: &str) -> String {
    format!("{:016x}", RandomState::new().hash_one(purpose))
}

impl Session {
    /// Starts to watch the scene.
    pub(super) fn start(settings: Settings) -> Result<Arc<Self>, String> {
        let session = Arc::new(Self {
            settings,
            token: unguessable("token") + &unguessable("further digits of the token"),
            name: unguessable("name").split_off(10),
            queue: Queue::default(),
            brushes: Queue::default(),
            revision: AtomicU64::new(1),
            pictures: Mutex::default(),
            last: Mutex::default(),
            listeners: Mutex::default(),
            watch: OnceLock::new(),
            writing: Mutex::default(),
        });
        let told = Arc::downgrade(&session);
        let watch = Watch::start(move |changed| {
            if let Some(session) = told.upgrade() {
                session.changed(&changed);
            }
        });
        let watch = watch.map_err(|error| format!("cannot watch files: {}", crate::cli::files::plain(&error)))?;
        // Nothing was there before.
        let _ = session.watch.set(watch);
        session.follow_scene();
        Ok(session)
    }

    /// Follows files from now on.
    fn follow(&self, stamps: Stamps) {
        if let Some(watch) = self.watch.get() {
            watch.follow(stamps);
        }
    }

    /// Follows the scene's own file, and what would be the manifest of its library.
    fn follow_scene(&self) {
        let scene = &self.settings.scene;
        let manifests = scene.ancestors().skip(1).map(|folder| folder.join(MANIFEST)).filter(|path| path.is_file());
        let files = manifests.chain([scene.clone()]);
        self.follow(files.map(|path| (path.clone(), Stamp::of(&path))).collect());
    }

    /// Files changed: tells the page.
    fn changed(&self, files: &[PathBuf]) {
        let revision = self.revision.fetch_add(1, Ordering::SeqCst) + 1;
        let mut names: Vec<String> = files.iter().map(|file| self.shown(file)).collect();
        // A file may be known by two names that links give it.
        names.dedup();
        self.tell("changed", &json!({ "revision": revision, "files": names }));
    }

    /// A file as the page calls it: by its path from the scene's folder, where it lies there.
    fn shown(&self, file: &Path) -> String {
        let folder = self.settings.scene.parent().unwrap_or(Path::new(""));
        let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let inside = file.strip_prefix(folder).or_else(|_| file.strip_prefix(&real)).unwrap_or(file);
        inside.to_string_lossy().replace('\\', "/")
    }

    /// Tells everyone who listens.
    pub(super) fn tell(&self, name: &'static str, data: &Value) {
        let event = Event { name, data: data.to_string() };
        locked(&self.listeners).retain(|listener| listener.send(event.clone()).is_ok());
    }

    /// Listens from now on.
    pub(super) fn listen(&self) -> UnboundedReceiver<Event> {
        let (sender, receiver) = unbounded_channel();
        locked(&self.listeners).push(sender);
        receiver
    }

    /// How often files have changed, counted from 1.
    pub(super) fn revision(&self) -> u64 {
        self.revision.load(Ordering::SeqCst)
    }

    pub(super) fn pictures(&self) -> MutexGuard<'_, Pictures> {
        locked(&self.pictures)
    }

    pub(super) fn last(&self) -> MutexGuard<'_, Last> {
        locked(&self.last)
    }

    /// What pictures of the scene are called: its file's name without the ending.
    pub(super) fn stem(&self) -> String {
        self.settings.scene.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned())
    }

    pub(super) fn writing(&self) -> MutexGuard<'_, ()> {
        locked(&self.writing)
    }

    /// A picture by the name that the page knows it by.
    pub(super) fn picture(&self, id: &str) -> Option<Arc<Picture>> {
        let number = id.strip_prefix(&*self.name)?.strip_prefix('-')?.parse().ok()?;
        self.pictures().get(number)
    }

    /// Opens the scene as it is now.
    pub(super) fn open(&self) -> Result<Opened, Unmade> {
        open(&self.settings.scene, self.settings.root.as_deref()).map_err(|error| {
            self.follow_scene();
            match error {
                OpenError::Words(words, _) => Unmade::NoScene(words),
                OpenError::NoScene(path) => Unmade::NoScene(format!("{path} holds no scene")),
                OpenError::Manifest(faults) => Unmade::Manifest(faults),
            }
        })
    }

    /// Compiles the scene as it is wanted. What it reads is followed from then on.
    pub(super) fn make(&self, wanted: &Wanted, stop: &Stop, observer: &mut dyn Observer) -> Result<Made, Unmade> {
        let overlay = |name: &String| Overlay::from_name(name).ok_or_else(|| format!("there is no overlay `{name}`"));
        let overlays = wanted.overlays.iter().map(overlay).collect::<Result<Vec<_>, _>>().map_err(Unmade::Nonsense)?;
        let revision = self.revision();
        let opened = self.open()?;
        let given = self.settings.sets.iter().filter(|(name, _)| !wanted.sets.contains_key(name)).cloned();
        let sets = given.chain(wanted.sets.iter().map(|(name, value)| (name.clone(), value.clone()))).collect();
        let seed = wanted.seed.map(|seed| seed.0).or(self.settings.seed);
        let limits = Limits { stop: stop.clone(), ..self.settings.limits.clone() };
        let lower = LowerConfig { sets, seed, dpi: None, limits };
        let mut config = Config { lower, only: wanted.only.clone(), overlays };
        take_over(&mut config, &opened);
        let compiled = compile(&opened.path, &opened.loader, &config, observer);
        self.follow(opened.loader.followed());
        Ok(Made { opened, config, compiled, revision })
    }
}
