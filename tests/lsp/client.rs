//! A small client of the Language Server Protocol, for tests: one process of `kake lsp`, ended with it.

use std::collections::VecDeque;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

/// Longer than any answer takes: what does not come by then never will.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder of files that the editor has open or not, and the server.
pub(crate) struct Client {
    pub(crate) folder: tempfile::TempDir,
    child: Child,
    input: Option<ChildStdin>,
    output: Receiver<Value>,
    told: VecDeque<Value>,
    next: i64,
}

/// Bytes and the place in each line of a text in UTF-16, as the protocol counts.
pub(crate) fn position(text: &str, offset: usize) -> Value {
    let before = &text[..offset];
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().unwrap_or_default().encode_utf16().count();
    json!({ "line": line, "character": column })
}

/// A text without its mark, and the mark's place.
pub(crate) fn marked(text: &str) -> (String, usize) {
    let at = text.find('‸').expect("the text has a mark");
    (text.replacen('‸', "", 1), at)
}

/// The place of the `nth` piece of a text.
pub(crate) fn find(text: &str, piece: &str, nth: usize) -> Value {
    let at = text.match_indices(piece).nth(nth).unwrap_or_else(|| panic!("`{piece}` stands there")).0;
    position(text, at)
}

impl Client {
    /// A server that knows nothing yet, in a folder with these files.
    pub(crate) fn start(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        for (path, text) in files {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("folders can be made");
            fs::write(path, text).expect("files can be written");
        }
        let mut child = Command::new(env!("CARGO_BIN_EXE_kake"))
            .arg("lsp")
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("kake runs");
        let (sender, output) = channel();
        let mut reader = BufReader::new(child.stdout.take().expect("its output is a pipe"));
        thread::spawn(move || {
            loop {
                let mut length = 0;
                loop {
                    let mut line = String::new();
                    if reader.read_line(&mut line).unwrap_or(0) == 0 {
                        return;
                    }
                    match line.trim().strip_prefix("Content-Length: ") {
                        Some(number) => length = number.parse().expect("a length is a number"),
                        None if line.trim().is_empty() => break,
                        None => {}
                    }
                }
                let mut body = vec![0; length];
                reader.read_exact(&mut body).expect("a message is as long as it says");
                if sender.send(serde_json::from_slice(&body).expect("a message is JSON")).is_err() {
                    return;
                }
            }
        });
        let input = child.stdin.take();
        Self { folder, child, input, output, told: VecDeque::new(), next: 0 }
    }

    /// A server that was greeted, with what this client can do.
    pub(crate) fn greeted(files: &[(&str, &str)], capabilities: Value) -> Self {
        let mut client = Self::start(files);
        client.ask("initialize", json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        client.tell("initialized", json!({}));
        client
    }

    /// The address of a file of the folder.
    pub(crate) fn uri(&self, path: &str) -> String {
        let folder: PathBuf = self.folder.path().canonicalize().expect("the folder is there");
        format!("file://{}", folder.join(path).to_str().expect("names are UTF-8"))
    }

    pub(crate) fn raw(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().expect("the input is open");
        // A server that has ended reads no more.
        let _ = input.write_all(bytes).and_then(|()| input.flush());
    }

    pub(crate) fn send(&mut self, message: &Value) {
        let body = message.to_string();
        self.raw(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
    }

    pub(crate) fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Asks without waiting; the number of the request.
    pub(crate) fn post(&mut self, method: &str, params: Value) -> i64 {
        self.next += 1;
        let id = self.next;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        id
    }

    /// The next message of any kind.
    pub(crate) fn next(&mut self) -> Value {
        self.output.recv_timeout(PATIENCE).expect("the server says something")
    }

    /// The response to a request.
    pub(crate) fn response(&mut self, id: i64) -> Value {
        loop {
            let message = self.next();
            if message.get("method").is_some() {
                self.told.push_back(message);
            } else if message["id"] == json!(id) {
                return message;
            }
        }
    }

    /// Asks and waits for the result.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.post(method, params);
        let response = self.response(id);
        assert!(response.get("error").is_none(), "{method}: {response}");
        response["result"].clone()
    }

    /// Asks what is refused, and why.
    pub(crate) fn refused(&mut self, method: &str, params: Value) -> (i64, String) {
        let id = self.post(method, params);
        let response = self.response(id);
        let error = &response["error"];
        let code = error["code"].as_i64().unwrap_or_else(|| panic!("{method} is refused, not {response}"));
        (code, error["message"].as_str().unwrap_or_default().to_owned())
    }

    /// The next notification of a method.
    pub(crate) fn told(&mut self, method: &str) -> Value {
        if let Some(at) = self.told.iter().position(|message| message["method"] == method) {
            return self.told.remove(at).expect("it is there")["params"].clone();
        }
        loop {
            let message = self.next();
            if message["method"] == method {
                return message["params"].clone();
            }
            if message.get("method").is_some() {
                self.told.push_back(message);
            }
        }
    }

    /// What is said to be wrong with a file, when something is said next.
    pub(crate) fn problems(&mut self, path: &str) -> Vec<Value> {
        let uri = self.uri(path);
        loop {
            let params = self.told("textDocument/publishDiagnostics");
            if params["uri"] == json!(uri) {
                return params["diagnostics"].as_array().expect("diagnostics are a list").clone();
            }
        }
    }

    /// Waits until something wrong with a file is said that holds these words.
    pub(crate) fn problem(&mut self, path: &str, words: &str) -> Value {
        loop {
            let problems = self.problems(path);
            let has = |problem: &&Value| problem["message"].as_str().unwrap_or_default().contains(words);
            if let Some(found) = problems.iter().find(has) {
                return found.clone();
            }
        }
    }

    /// Waits until a file is said to be without fault.
    pub(crate) fn faultless(&mut self, path: &str) {
        while !self.problems(path).is_empty() {}
    }

    pub(crate) fn open(&mut self, path: &str, text: &str) {
        let language = if path.ends_with(".toml") { "toml" } else { "kake" };
        let document = json!({ "uri": self.uri(path), "languageId": language, "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Replaces the whole text.
    pub(crate) fn change(&mut self, path: &str, version: i64, text: &str) {
        let document = json!({ "uri": self.uri(path), "version": version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [{ "text": text }] }));
    }

    pub(crate) fn close(&mut self, path: &str) {
        let uri = self.uri(path);
        self.tell("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    }

    /// Parameters that mean a place in a file.
    pub(crate) fn at(&self, path: &str, position: &Value) -> Value {
        json!({ "textDocument": { "uri": self.uri(path) }, "position": position })
    }

    /// No more will be said; how the server ends.
    pub(crate) fn hang_up(&mut self) -> Option<i32> {
        self.input = None;
        self.ended()
    }

    /// How the server ends.
    pub(crate) fn ended(&mut self) -> Option<i32> {
        self.child.wait().expect("the server ends").code()
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.input = None;
        // Without input it ends by itself, unless a test has failed on the way.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
