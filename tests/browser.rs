//! A preview in a real browser, for tests and benches: the program serves a scene from a folder of its own, and headless
//! Chromium shows its page. Both end when they are dropped.
//!
//! The browser is what `KAKE_CHROMIUM` names, otherwise Chromium or Chrome on the path.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::sleep;
use std::time::{Duration, Instant};

use headless_chrome::protocol::cdp::types::Event;
use headless_chrome::protocol::cdp::{Log, Network};
use headless_chrome::{Browser, LaunchOptions, Tab};
use tempfile::TempDir;

/// How long anything is waited for. Machines under test are slow at times; what is right comes long before.
pub(crate) const DEADLINE: Duration = Duration::from_secs(90);

/// Where the browser is, if there is one.
fn browser_path() -> Option<PathBuf> {
    if let Some(path) = env::var_os("KAKE_CHROMIUM") {
        return Some(path.into());
    }
    let folders: Vec<PathBuf> = env::split_paths(&env::var_os("PATH")?).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

/// The program, serving a scene in a folder of its own until it is dropped.
pub(crate) struct Server {
    pub(crate) child: Child,
    pub(crate) folder: TempDir,
    pub(crate) address: String,
}

impl Server {
    pub(crate) fn start(scene: &str) -> Self {
        let folder = tempfile::tempdir().expect("there is room for a folder");
        fs::write(folder.path().join("scene.kake"), scene).expect("the folder can be written");
        let mut child = Command::new(env!("CARGO_BIN_EXE_kake"))
            .args(["preview", "scene.kake"])
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let mut address = String::new();
        let out = child.stdout.take().expect("the output is a pipe");
        BufReader::new(out).read_line(&mut address).expect("the program says where the page is");
        Self { child, folder, address: address.trim().to_owned() }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Whether it ended by itself makes no difference now.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The page in the browser, and what the browser says of it.
pub(crate) struct Page {
    pub(crate) tab: Arc<Tab>,
    /// Errors on the console, and exceptions.
    pub(crate) errors: Arc<Mutex<Vec<String>>>,
    /// The addresses of all requests.
    pub(crate) requests: Arc<Mutex<Vec<String>>>,
    _browser: Browser,
}

impl Page {
    /// Opens an address and waits for the picture; nothing where there is no browser. What the browser keeps goes into a
    /// folder that goes with the server's.
    pub(crate) fn open(address: &str, profile: PathBuf) -> Option<Self> {
        let path = browser_path()?;
        let options = LaunchOptions::default_builder()
            .path(Some(path))
            .user_data_dir(Some(profile))
            .sandbox(false)
            .window_size(Some((1280, 800)))
            .idle_browser_timeout(2 * DEADLINE)
            .build()
            .expect("the options are complete");
        let browser = Browser::new(options).expect("the browser starts");
        let tab = browser.new_tab().expect("the browser has a window");
        tab.set_default_timeout(DEADLINE);
        let (errors, requests) = (Arc::new(Mutex::new(Vec::new())), Arc::new(Mutex::new(Vec::new())));
        let (wrong, asked) = (Arc::clone(&errors), Arc::clone(&requests));
        let listener = move |event: &Event| match event {
            Event::NetworkRequestWillBeSent(sent) => asked.lock().unwrap().push(sent.params.request.url.clone()),
            Event::LogEntryAdded(added) if added.params.entry.level == Log::LogEntryLevel::Error => {
                wrong.lock().unwrap().push(format!("{:?} {:?}", added.params.entry.text, added.params.entry.url));
            }
            Event::RuntimeExceptionThrown(thrown) => {
                wrong.lock().unwrap().push(format!("{:?}", thrown.params.exception_details));
            }
            _ => {}
        };
        tab.add_event_listener(Arc::new(listener)).expect("the window can be listened to");
        tab.enable_log().and_then(|tab| tab.enable_runtime()).expect("the window says what is wrong");
        let network = Network::Enable {
            max_total_buffer_size: None,
            max_resource_buffer_size: None,
            max_post_data_size: None,
            report_direct_socket_traffic: None,
            enable_durable_messages: None,
        };
        tab.call_method(network).expect("the window says what is asked for");
        tab.navigate_to(address).expect("the page can be opened");
        let page = Self { tab, errors, requests, _browser: browser };
        page.until("the picture is there", "document.querySelector('#viewport')?.dataset.state === 'drawn'");
        Some(page)
    }

    /// What an expression of the page gives, as text.
    pub(crate) fn ask(&self, expression: &str) -> String {
        let text = format!("(async () => String({expression}))()");
        let object = self.tab.evaluate(&text, true).expect("the page answers");
        let value = object.value.as_ref().and_then(|value| value.as_str().map(str::to_owned));
        value.unwrap_or_else(|| panic!("`{expression}` gives {object:?}"))
    }

    /// Waits until an expression of the page holds.
    pub(crate) fn until(&self, what: &str, expression: &str) {
        let begun = Instant::now();
        while self.ask(expression) != "true" {
            if begun.elapsed() > DEADLINE {
                let shown = self.ask("document.body.innerText");
                panic!("never: {what}\nerrors: {:?}\nthe page says:\n{shown}", self.errors.lock().unwrap());
            }
            sleep(Duration::from_millis(20));
        }
    }
}
