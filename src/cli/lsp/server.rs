//! What is open, what is asked, and when scenes are looked at.
//!
//! Every open scene is looked at on its own, with its imports, a little after the last edit; a newer edit stops the look
//! that is under way. Questions about names wait for a look at the text as it is; completion makes do with the last one.
//! Diagnostics of all looks are put together file by file, and taken back when nothing says them any more.

mod telling;

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::{Diagnostic, DidChangeTextDocumentParams, DidOpenTextDocumentParams, Uri};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::cli::Ended;
use crate::diag;
use crate::library::MANIFEST;
use crate::lsp::{Encoding, Related, Snippets, Text};
use crate::stop::Stop;

use super::drafts::{self, Texts, is_scene, settled};
use super::worker::{About, Looked, Outcome, Worker};
use super::{address, answers, wire};

/// What happens.
#[derive(Debug)]
pub(super) enum Event {
    Message(Message),
    /// Something came in that is no message.
    Nonsense(String),
    /// No more will come in.
    End,
    Done(About, Outcome),
}

/// Why a request has no answer.
#[derive(Debug, Clone)]
pub(super) struct Refusal {
    pub(super) code: ErrorCode,
    pub(super) words: String,
}

impl Refusal {
    pub(super) fn new(code: ErrorCode, words: impl Into<String>) -> Self {
        Self { code, words: words.into() }
    }
}

/// An open text.
#[derive(Debug)]
pub(super) struct Buffer {
    pub(super) uri: Uri,
    pub(super) path: PathBuf,
    pub(super) text: Text,
    pub(super) kind: BufferKind,
    version: i32,
}

/// What an open text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BufferKind {
    Kake,
    /// A scene in TOML.
    Toml,
    /// A library's `kake.toml`.
    Manifest,
    /// Settings of some other program.
    Other,
}

/// What is known of an open scene.
#[derive(Debug, Default)]
struct Scene {
    looked: Option<Arc<Looked>>,
    /// The count of edits when something that it reads was changed last.
    changed: u64,
    /// When it is to be looked at.
    due: Option<Instant>,
}

/// A look at a scene or a task that is under way.
struct Running {
    about: String,
    stop: Stop,
}

/// A request that needs all scenes of a library.
pub(super) struct Task {
    pub(super) id: RequestId,
    pub(super) uri: String,
    pub(super) stop: Stop,
    pub(super) work: Box<dyn FnOnce() -> Outcome + Send>,
}

/// What the editor can do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Client {
    pub(super) encoding: Encoding,
    pub(super) snippets: Snippets,
    related: Related,
    /// Whether it can be asked to tell of changed files.
    watches: bool,
}

/// How far the session has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Waiting,
    Open,
    ShutDown,
}

/// Shortest time from an edit to a look.
const SOON: Duration = Duration::from_millis(60);
/// Longest time from an edit to a look, for scenes that take long.
const LATE: Duration = Duration::from_millis(600);

pub(super) struct Server {
    pub(super) client: Client,
    stage: Stage,
    buffers: BTreeMap<String, Buffer>,
    scenes: BTreeMap<String, Scene>,
    /// A count of edits.
    revision: u64,
    worker: Worker,
    running: Option<Running>,
    tasks: VecDeque<Task>,
    /// Requests that wait for a look at their scene.
    waiting: Vec<(Request, String)>,
    /// What each scene has wrong, by the address of the text.
    found: BTreeMap<String, BTreeMap<String, Vec<Diagnostic>>>,
    /// What was told last, by the address of the text.
    told: BTreeMap<String, Vec<Diagnostic>>,
    /// The texts of standard libraries as files, from when one is asked for.
    standard: Option<tempfile::TempDir>,
    ended: Option<Ended>,
}

impl Server {
    /// Starts the thread that looks at scenes, which reports to `events`.
    pub(super) fn new(events: Sender<Event>) -> io::Result<Self> {
        Ok(Self {
            client: Client {
                encoding: Encoding::Utf16,
                snippets: Snippets::Plain,
                related: Related::Unknown,
                watches: false,
            },
            stage: Stage::Waiting,
            buffers: BTreeMap::new(),
            scenes: BTreeMap::new(),
            revision: 0,
            worker: Worker::new(events)?,
            running: None,
            tasks: VecDeque::new(),
            waiting: Vec::new(),
            found: BTreeMap::new(),
            told: BTreeMap::new(),
            standard: None,
            ended: None,
        })
    }

    /// Answers until the session ends.
    pub(super) fn run(mut self, inbox: &Receiver<Event>) -> Ended {
        loop {
            let due =
                if self.running.is_none() { self.scenes.values().filter_map(|scene| scene.due).min() } else { None };
            let event = match due.map(|due| due.saturating_duration_since(Instant::now())) {
                Some(wait) => inbox.recv_timeout(wait),
                None => inbox.recv().map_err(RecvTimeoutError::from),
            };
            match event {
                Ok(Event::Message(message)) => self.message(message),
                Ok(Event::Nonsense(words)) => {
                    if wire::refuse(&words).is_err() {
                        self.ended = Some(Ended::Io);
                    }
                }
                // An editor that is gone has not said good-bye.
                Ok(Event::End) | Err(RecvTimeoutError::Disconnected) => self.end(),
                Ok(Event::Done(about, outcome)) => self.done(about, outcome),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Some(ended) = self.ended {
                if let Some(running) = &self.running {
                    running.stop.ask();
                }
                return ended;
            }
            self.start_next();
        }
    }

    /// The session ends: as it should, if the editor has said so before.
    fn end(&mut self) {
        self.ended = Some(if self.stage == Stage::ShutDown { Ended::Done } else { Ended::Fault });
    }

    fn send(&mut self, message: impl Into<Message>) {
        if wire::write(message.into()).is_err() {
            self.ended = Some(Ended::Io);
        }
    }

    pub(super) fn notify(&mut self, method: &str, params: Value) {
        self.send(Notification { method: method.to_owned(), params });
    }

    pub(super) fn answer(&mut self, id: RequestId, answer: Result<Value, Refusal>) {
        let response = match answer {
            Ok(value) => Response { id, response_result: Ok(value) },
            Err(refusal) => Response::new_err(id, refusal.code as i32, refusal.words),
        };
        self.send(response);
    }

    fn message(&mut self, message: Message) {
        match message {
            Message::Request(request) => self.request(request),
            Message::Notification(notification) => self.notification(notification),
            // Nothing that is asked of the editor needs an answer.
            Message::Response(_) => {}
        }
    }

    fn request(&mut self, request: Request) {
        let refused = |code, words: &str| Err(Refusal::new(code, words));
        let id = request.id.clone();
        match (self.stage, request.method.as_str()) {
            (Stage::Waiting, "initialize") => {
                let answer = self.initialize(&request.params);
                self.answer(id, answer);
            }
            (Stage::Waiting, _) => {
                self.answer(id, refused(ErrorCode::ServerNotInitialized, "`initialize` comes first"));
            }
            (Stage::ShutDown, _) => self.answer(id, refused(ErrorCode::InvalidRequest, "the server is shut down")),
            (Stage::Open, "initialize") => {
                self.answer(id, refused(ErrorCode::InvalidRequest, "the server is initialized already"));
            }
            (Stage::Open, "shutdown") => {
                self.stage = Stage::ShutDown;
                self.answer(id, Ok(Value::Null));
            }
            (Stage::Open, _) => self.ask(request),
        }
    }

    fn initialize(&mut self, params: &Value) -> Result<Value, Refusal> {
        let at = |path: &str| params.pointer(path);
        let offered =
            at("/capabilities/general/positionEncodings").and_then(|kinds| Deserialize::deserialize(kinds).ok());
        self.client.encoding = Encoding::agreed(&offered.unwrap_or_else(Vec::new));
        let is_true = |path: &str| at(path) == Some(&Value::Bool(true));
        if is_true("/capabilities/textDocument/completion/completionItem/snippetSupport") {
            self.client.snippets = Snippets::Filled;
        }
        if is_true("/capabilities/textDocument/publishDiagnostics/relatedInformation") {
            self.client.related = Related::Shown;
        }
        self.client.watches = is_true("/capabilities/workspace/didChangeWatchedFiles/dynamicRegistration");
        self.stage = Stage::Open;
        let capabilities = answers::capabilities(self.client.encoding);
        Ok(json!({
            "capabilities": capabilities,
            "serverInfo": { "name": "kake", "version": env!("CARGO_PKG_VERSION") },
        }))
    }

    fn notification(&mut self, notification: Notification) {
        if notification.method == "exit" {
            self.end();
            return;
        }
        if self.stage != Stage::Open {
            return;
        }
        let params = notification.params;
        match notification.method.as_str() {
            "initialized" => self.watch(),
            "textDocument/didOpen" => {
                if let Ok(params) = serde_json::from_value::<DidOpenTextDocumentParams>(params) {
                    self.open(params);
                }
            }
            "textDocument/didChange" => {
                if let Ok(params) = serde_json::from_value::<DidChangeTextDocumentParams>(params) {
                    self.change(params);
                }
            }
            "textDocument/didClose" => {
                if let Some(uri) = params.pointer("/textDocument/uri").and_then(Value::as_str) {
                    self.close(&uri.to_owned());
                }
            }
            // What lies on disk has changed: every scene may read it.
            "textDocument/didSave" | "workspace/didChangeWatchedFiles" => {
                self.revision += 1;
                let all: Vec<String> = self.scenes.keys().cloned().collect();
                for uri in all {
                    self.changed(&uri, SOON);
                }
            }
            "$/cancelRequest" => self.cancel(&params),
            // The others are not for this server; those that are for none may be passed over.
            _ => {}
        }
    }

    /// Asks to be told of files that change under scenes.
    fn watch(&mut self) {
        if !self.client.watches {
            return;
        }
        let watchers = json!([{ "globPattern": "**/*.{kake,toml,png,jpg,jpeg,svg}" }]);
        let method = "workspace/didChangeWatchedFiles";
        let registration = json!({ "id": "files", "method": method, "registerOptions": { "watchers": watchers } });
        let params = json!({ "registrations": [registration] });
        let id = RequestId::from("files".to_owned());
        self.send(Request { id, method: "client/registerCapability".to_owned(), params });
    }

    fn cancel(&mut self, params: &Value) {
        let Some(id) = params.get("id").and_then(|id| serde_json::from_value::<RequestId>(id.clone()).ok()) else {
            return;
        };
        let cancelled = || Err(Refusal::new(ErrorCode::RequestCanceled, "cancelled"));
        if let Some(at) = self.waiting.iter().position(|(request, _)| request.id == id) {
            self.waiting.remove(at);
            self.answer(id, cancelled());
        } else if let Some(at) = self.tasks.iter().position(|task| task.id == id) {
            self.tasks.remove(at);
            self.answer(id, cancelled());
        } else if let Some(running) = self.running.as_ref().filter(|running| running.about == id.to_string()) {
            running.stop.ask();
        }
    }

    // ------------------------------------------------------------------------------------------- texts

    fn open(&mut self, params: DidOpenTextDocumentParams) {
        let document = params.text_document;
        let text = document.text.strip_prefix('\u{feff}').unwrap_or(&document.text);
        let text = Text::new(text.into(), self.client.encoding);
        let is_toml = document.language_id == "toml" || document.uri.as_str().ends_with(".toml");
        let path = match address::path(&document.uri) {
            Some(path) => settled(&path),
            None => drafts::unsaved(&document.uri, is_toml),
        };
        let kind = kind(&path, is_toml, text.as_str());
        let key = document.uri.as_str().to_owned();
        self.moved_on(&key);
        let buffer = Buffer { uri: document.uri, path, text, kind, version: document.version };
        self.buffers.insert(key.clone(), buffer);
        self.edited(&key, Duration::ZERO);
    }

    fn change(&mut self, params: DidChangeTextDocumentParams) {
        let key = params.text_document.uri.as_str().to_owned();
        // What was never opened cannot change.
        let Some(buffer) = self.buffers.get_mut(&key) else { return };
        for change in params.content_changes {
            buffer.text = buffer.text.edited(change.range, &change.text);
        }
        // Edits come in the order in which they were made; their numbers are told back and mean nothing else here.
        buffer.version = params.text_document.version;
        if matches!(buffer.kind, BufferKind::Toml | BufferKind::Other) {
            buffer.kind = kind(&buffer.path, true, buffer.text.as_str());
        }
        self.moved_on(&key);
        let took = self.scenes.get(&key).and_then(|scene| scene.looked.as_ref()).map_or(SOON, |looked| looked.took);
        self.edited(&key, took.clamp(SOON, LATE));
    }

    fn close(&mut self, key: &String) {
        let Some(buffer) = self.buffers.remove(key) else { return };
        self.moved_on(key);
        self.scenes.remove(key);
        if let Some(running) = self.running.as_ref().filter(|running| running.about == *key) {
            running.stop.ask();
        }
        self.found.remove(key);
        self.publish(None);
        self.revision += 1;
        self.changed_with(&buffer.path, SOON);
    }

    /// Answers requests about a text that is no longer what was asked about.
    fn moved_on(&mut self, key: &str) {
        let (gone, left) = std::mem::take(&mut self.waiting).into_iter().partition(|(_, uri)| uri == key);
        self.waiting = left;
        let gone: Vec<(Request, String)> = gone;
        let modified = || Err(Refusal::new(ErrorCode::ContentModified, "the text has changed"));
        for (request, _) in gone {
            self.answer(request.id, modified());
        }
        let (gone, left) = std::mem::take(&mut self.tasks).into_iter().partition(|task| task.uri == key);
        self.tasks = left;
        let gone: VecDeque<Task> = gone;
        for task in gone {
            self.answer(task.id, modified());
        }
    }

    /// The text of an address is new.
    fn edited(&mut self, key: &str, wait: Duration) {
        self.revision += 1;
        let Some(buffer) = self.buffers.get(key) else { return };
        let path = buffer.path.clone();
        match buffer.kind {
            BufferKind::Kake | BufferKind::Toml => {
                self.scenes.entry(key.to_owned()).or_default();
                self.changed(key, wait);
            }
            BufferKind::Manifest => {
                let problems = self.manifest(key);
                self.found.insert(key.to_owned(), BTreeMap::from([(key.to_owned(), problems)]));
                self.publish(Some(key));
            }
            BufferKind::Other => {
                self.scenes.remove(key);
                self.found.remove(key);
                self.publish(None);
            }
        }
        self.changed_with(&path, wait);
    }

    /// What scenes read has changed: they are to be looked at again. So are those with mistakes, for the file may be the
    /// one that they miss.
    fn changed_with(&mut self, path: &Path, wait: Duration) {
        let concerned = self.scenes.iter().filter(|(_, scene)| match &scene.looked {
            Some(looked) => looked.reads(path) || looked.analysis.diagnostics.iter().any(diag::Diagnostic::is_error),
            None => false,
        });
        let concerned: Vec<String> = concerned.map(|(key, _)| key.clone()).collect();
        for key in concerned {
            self.changed(&key, wait);
        }
    }

    fn changed(&mut self, key: &str, wait: Duration) {
        if let Some(running) = self.running.as_ref().filter(|running| running.about == key) {
            running.stop.ask();
        }
        if let Some(scene) = self.scenes.get_mut(key) {
            scene.changed = self.revision;
            scene.due = Some(Instant::now() + wait);
        }
    }

    pub(super) fn texts(&self) -> Arc<Texts> {
        let texts = self.buffers.values().map(|buffer| (buffer.path.clone(), Arc::clone(buffer.text.shared())));
        Arc::new(texts.collect())
    }

    /// The addresses of what is open.
    pub(super) fn addresses(&self) -> BTreeMap<PathBuf, Uri> {
        self.buffers.values().map(|buffer| (buffer.path.clone(), buffer.uri.clone())).collect()
    }

    // ------------------------------------------------------------------------------------------- looks

    /// Starts what is to be done next, if nothing is under way.
    fn start_next(&mut self) {
        if self.running.is_some() {
            return;
        }
        let now = Instant::now();
        let due = self.scenes.iter().filter(|(_, scene)| scene.due.is_some_and(|due| due <= now));
        if let Some(key) = due.min_by_key(|(_, scene)| scene.due).map(|(key, _)| key.clone()) {
            let texts = self.texts();
            let (Some(buffer), Some(scene)) = (self.buffers.get(&key), self.scenes.get_mut(&key)) else { return };
            scene.due = None;
            let (path, revision, stop) = (buffer.path.clone(), self.revision, Stop::new());
            self.running = Some(Running { about: key.clone(), stop: stop.clone() });
            let work = move || Outcome::Looked(Box::new(Looked::new(&path, &texts, revision, &stop)));
            self.worker.start(About::Scene(key), Box::new(work));
        } else if let Some(task) = self.tasks.pop_front() {
            self.running = Some(Running { about: task.id.to_string(), stop: task.stop });
            self.worker.start(About::Request(task.id), task.work);
        }
    }

    pub(super) fn later(&mut self, task: Task) {
        self.tasks.push_back(task);
    }

    fn done(&mut self, about: About, outcome: Outcome) {
        self.running = None;
        match (about, outcome) {
            (About::Scene(key), Outcome::Looked(looked)) => self.looked(&key, *looked),
            (About::Scene(key), _) => {
                // The fault would come again with the same text: the next edit has another try.
                let failed = || Err(Refusal::new(ErrorCode::InternalError, "the scene could not be looked at"));
                let waiting = std::mem::take(&mut self.waiting);
                for (request, uri) in waiting {
                    match uri == key {
                        true => self.answer(request.id, failed()),
                        false => self.waiting.push((request, uri)),
                    }
                }
            }
            (About::Request(id), Outcome::Answer(answer, words)) => {
                self.answer(id, answer);
                if let Some(words) = words {
                    self.notify("window/showMessage", json!({ "type": 2, "message": words }));
                }
            }
            (About::Request(id), _) => {
                self.answer(id, Err(Refusal::new(ErrorCode::InternalError, "the request failed")));
            }
        }
    }

    fn looked(&mut self, key: &str, looked: Looked) {
        // What was stopped, or closed meanwhile, is of no use.
        let Some(scene) = self.scenes.get_mut(key).filter(|scene| scene.changed <= looked.revision) else { return };
        let looked = Arc::new(looked);
        scene.looked = Some(Arc::clone(&looked));
        let problems = self.problems(key, &looked);
        self.found.insert(key.to_owned(), problems);
        self.publish(Some(key));
        let waiting = std::mem::take(&mut self.waiting);
        for (request, uri) in waiting {
            match uri == key {
                true => self.ask(request),
                false => self.waiting.push((request, uri)),
            }
        }
    }

    // ------------------------------------------------------------------------------------------- requests

    /// Answers a request, now or when its scene was looked at.
    fn ask(&mut self, request: Request) {
        let uri = request.params.pointer("/textDocument/uri").and_then(Value::as_str).map(ToOwned::to_owned);
        let needs = answers::needs(&request.method);
        if let (Some(uri), true) = (&uri, self.must_wait(uri.as_deref(), needs)) {
            let soon = Instant::now();
            if let Some(scene) = self.scenes.get_mut(uri)
                && scene.due.is_some()
            {
                scene.due = Some(soon);
            }
            self.waiting.push((request, uri.clone()));
            return;
        }
        let buffer = uri.as_ref().and_then(|uri| self.buffers.get(uri));
        let looked = uri.as_ref().and_then(|uri| self.scenes.get(uri)).and_then(|scene| scene.looked.clone());
        match answers::Asked::new(&request, buffer, looked, self).answer() {
            answers::Answer::Now(answer) => self.answer(request.id, answer),
            answers::Answer::Definition(place) => {
                let answer = match place {
                    Some((looked, span)) => self.location(&looked, span),
                    None => None,
                };
                self.answer(request.id, Ok(answer.map_or(Value::Null, |location| json!(location))));
            }
            answers::Answer::Told(words) => {
                self.notify("window/showMessage", json!({ "type": 3, "message": words }));
                self.answer(request.id, Ok(Value::String(words)));
            }
            answers::Answer::Later(task) => self.later(task),
        }
    }

    fn must_wait(&self, uri: Option<&str>, needs: answers::Needs) -> bool {
        let Some(scene) = uri.and_then(|uri| self.scenes.get(uri)) else { return false };
        match (needs, &scene.looked) {
            (answers::Needs::Text, _) => false,
            (answers::Needs::Look, looked) => looked.is_none() && self.will_look(uri, scene),
            (answers::Needs::Fresh, Some(looked)) => scene.changed > looked.revision && self.will_look(uri, scene),
            (answers::Needs::Fresh, None) => self.will_look(uri, scene),
        }
    }

    /// Whether a scene is being looked at or will be.
    fn will_look(&self, uri: Option<&str>, scene: &Scene) -> bool {
        scene.due.is_some() || self.running.as_ref().is_some_and(|running| Some(running.about.as_str()) == uri)
    }
}

/// What an open text is.
fn kind(path: &Path, is_toml: bool, text: &str) -> BufferKind {
    match (is_toml, path.file_name().is_some_and(|name| name == MANIFEST)) {
        (false, _) => BufferKind::Kake,
        (true, true) => BufferKind::Manifest,
        (true, false) if is_scene(text) => BufferKind::Toml,
        (true, false) => BufferKind::Other,
    }
}
