//! `kake preview` and `kake build --watch` from outside: requests over HTTP, files that change, and how they end.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::cli::Desk;

/// How long anything may take: far longer than it does, for the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(120);

/// A preview that runs, and ends with its test.
struct Preview {
    child: Child,
    port: u16,
    token: String,
}

impl Drop for Preview {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An answer: its status, its head and its body.
struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Answer {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    #[track_caller]
    fn json(&self) -> Value {
        assert_eq!(self.status, 200, "{}", self.text());
        serde_json::from_slice(&self.body).expect("the answer is JSON")
    }

    /// The words of a refusal.
    #[track_caller]
    fn refused(&self, status: u16) -> String {
        assert_eq!(self.status, status, "{}", self.text());
        let said: Value = serde_json::from_slice(&self.body).expect("refusals are JSON");
        said["error"].as_str().expect("refusals have words").to_owned()
    }
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_kake"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

impl Preview {
    fn of(desk: &Desk, arguments: &[&str]) -> Self {
        let arguments: Vec<&str> = ["preview", "scene.kake"].iter().chain(arguments).copied().collect();
        let mut child = start(&desk.path(""), &arguments);
        let mut line = String::new();
        let out = child.stdout.take().expect("it has an output");
        BufReader::new(out).read_line(&mut line).expect("it says where it is");
        let port = line.trim().trim_end_matches('/').rsplit(':').next().and_then(|port| port.parse().ok());
        let mut preview = Self { child, port: port.expect("it says its port"), token: String::new() };
        let page = preview.get("/").text();
        let token = page.split("name=\"kake-token\" content=\"").nth(1).and_then(|rest| rest.split('"').next());
        preview.token = token.expect("the page has a token").to_owned();
        assert!(page.contains("name=\"kake-scene\" content=\"scene.kake\""));
        preview
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("sockets know time");
        stream
    }

    /// A request as it goes over the wire.
    fn send(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &str) -> TcpStream {
        let mut stream = self.connect();
        let host = format!("127.0.0.1:{}", self.port);
        let host = if headers.iter().any(|(name, _)| *name == "Host") { None } else { Some(("Host", &*host)) };
        let mut request =
            format!("{method} {path} HTTP/1.1\r\nConnection: close\r\nContent-Length: {}\r\n", body.len());
        for (name, value) in host.iter().chain(headers) {
            request += &format!("{name}: {value}\r\n");
        }
        request += &format!("\r\n{body}");
        stream.write_all(request.as_bytes()).expect("it reads requests");
        stream
    }

    fn ask(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &str) -> Answer {
        let mut bytes = Vec::new();
        self.send(method, path, headers, body).read_to_end(&mut bytes).expect("it answers");
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").expect("answers have a head");
        let head = String::from_utf8_lossy(&bytes[..end]).to_lowercase();
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("answers have a status");
        Answer { status, head, body: bytes.split_off(end + 4) }
    }

    fn get(&self, path: &str) -> Answer {
        self.ask("GET", path, &[], "")
    }

    fn post(&self, path: &str, body: &Value) -> Answer {
        self.ask("POST", path, &[("X-Kake-Token", &self.token)], &body.to_string())
    }

    #[track_caller]
    fn draw(&self, body: &Value) -> Value {
        self.post("/api/draw", body).json()
    }

    fn events(&self) -> Events {
        let mut reader = BufReader::new(self.send("GET", "/api/events", &[], ""));
        // Behind the head whoever asked is listened for.
        let mut line = String::new();
        while line != "\r\n" {
            line.clear();
            reader.read_line(&mut line).expect("events have a head");
        }
        Events(reader)
    }
}

/// What a preview tells.
struct Events(BufReader<TcpStream>);

impl Events {
    /// The next event of a name.
    fn next(&mut self, name: &str) -> Value {
        let mut found = String::new();
        loop {
            let mut line = String::new();
            assert!(self.0.read_line(&mut line).expect("events go on") > 0, "the stream has ended");
            if let Some(event) = line.strip_prefix("event: ") {
                found = event.trim().to_owned();
            }
            if let Some(data) = line.strip_prefix("data: ")
                && found == name
            {
                return serde_json::from_str(data).expect("events are JSON");
            }
        }
    }
}

/// Two million sites of Poisson: far longer than any test waits.
const ENDLESS: &str = "canvas { size: (1000mm, 1000mm) }\nparam n = 1\ntone t { place: poisson(radius: 0.5mm) \
                       fill: lines(pitch: 0.2mm) }\npaint canvas with t\n";

#[test]
fn a_page_is_served_with_pictures_tiles_and_figures() {
    let desk = Desk::new();
    let preview = Preview::of(&desk, &[]);
    let page = preview.get("/");
    assert!(page.head.contains("content-security-policy: default-src 'self'"), "{}", page.head);
    assert!(preview.get("/page/page.css").head.contains("content-type: text/css"));
    assert_eq!(preview.get("/page/../Cargo.toml").status, 404);
    let drawn = preview.draw(&json!({ "sets": { "kind": "grid" }, "seed": 7 }));
    assert_eq!((&drawn["ok"], &drawn["seed"], &drawn["show"]), (&json!(true), &json!(7), &json!("svg")));
    assert_eq!(drawn["command"], "kake build scene.kake --set kind=grid --seed 7 -o scene.svg");
    assert_eq!(drawn["paints"], json!(["lattice", "disc"]));
    assert_eq!(drawn["layers"][1]["groups"], json!(["upper"]));
    let params = drawn["params"].as_array().expect("there are parameters");
    assert_eq!(
        params[0],
        json!({ "name": "pen", "kind": "length", "default": "0.2mm", "value": "0.2mm", "doc": "The stroke's width.",
                "range": { "from": 0.1, "to": 0.6, "unit": "mm" }, "choices": null, "here": true })
    );
    assert_eq!((&params[1]["value"], &params[1]["choices"]), (&json!("grid"), &json!(["hex", "grid"])));
    let id = drawn["id"].as_str().expect("it has a name");
    let all = preview.get(&format!("/api/picture/{id}.svg")).text();
    let part = preview.get(&format!("/api/picture/{id}.svg?hide=0")).text();
    assert!(all.starts_with("<svg") && part.starts_with("<svg") && part.len() < all.len());
    assert!(preview.get(&format!("/api/picture/{id}.svg?hide=x")).refused(400).contains("hide"));
    for path in ["tile/4/0/0.png", "tile/-2/0/0.png?hide=1", "thumb.png?size=64", "thumb.png"] {
        let png = preview.get(&format!("/api/picture/{id}/{path}"));
        assert!(png.status == 200 && png.body.starts_with(b"\x89PNG"), "{path}: {}", png.text());
    }
    for path in ["tile/4/1/0.png", "tile/11/0/0.png", "tile/4/0/-1.png", "tile/4/4294967295/0.png"] {
        preview.get(&format!("/api/picture/{id}/{path}")).refused(404);
    }
    let figures = preview.get(&format!("/api/picture/{id}/metrics")).json();
    assert_eq!(figures["paints"][0]["paint"], "lattice");
    assert!(figures["charts"]["disc"]["correlogram"].as_str().is_some_and(|svg| svg.starts_with("<svg")));
    preview.get("/api/picture/none-1.svg").refused(404);
    preview.get("/nothing").refused(404);
    preview.get("/api/draw").refused(405);
}

#[test]
fn only_our_own_page_is_answered() {
    let desk = Desk::new();
    let preview = Preview::of(&desk, &[]);
    let (port, token) = (preview.port, &*preview.token);
    let get = |headers: &[(&str, &str)]| preview.ask("GET", "/", headers, "").status;
    let local = [format!("localhost:{port}"), format!("http://127.0.0.1:{port}")];
    assert_eq!(get(&[("Host", &local[0])]), 200);
    assert_eq!(get(&[("Origin", &local[1]), ("Sec-Fetch-Site", "same-origin")]), 200);
    assert_eq!(get(&[("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "navigate")]), 200);
    for headers in [
        [("Host", "evil.example")].as_slice(),
        &[("Host", "127.0.0.1:1")],
        &[("Host", "127.0.0.1.evil.example")],
        &[("Origin", "http://evil.example")],
        &[("Origin", "null")],
        &[("Sec-Fetch-Site", "cross-site")],
        &[("Sec-Fetch-Site", "same-site")],
        &[("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "navigate"), ("Sec-Fetch-Dest", "iframe")],
    ] {
        assert_eq!(get(headers), 403, "{headers:?}");
    }
    let navigated = [("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "navigate")];
    assert_eq!(preview.ask("GET", "/api/events", &navigated, "").status, 403);
    for path in ["/api/save", "/api/params", "/api/draw"] {
        for headers in [
            [].as_slice(),
            &[("X-Kake-Token", "wrong")],
            &[("X-Kake-Token", token), ("Origin", "https://evil.example")],
            &[("X-Kake-Token", token), ("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "navigate")],
        ] {
            let said = preview.ask("POST", path, headers, r#"{"kind":"svg"}"#).refused(403);
            assert!(said.contains("page"), "{said}");
        }
    }
    assert_eq!(desk.files(), ["scene.kake"]);
}

#[test]
fn what_is_saved_is_drawn_again() {
    let desk = Desk::new();
    let scene = String::from_utf8(desk.get("scene.kake")).expect("scenes are text");
    desk.put("tones.kake", "tone fine { place: grid(spacing: 2mm) fill: lines(pitch: 0.5mm) }\n");
    desk.put("scene.kake", scene.replace("edition 1\n", "edition 1\nimport \"tones.kake\"\nimport \"late.kake\"\n"));
    let preview = Preview::of(&desk, &[]);
    let mut events = preview.events();
    // An import that is missing is a fault, and may come.
    let faulty = preview.draw(&json!({}));
    assert_eq!((&faulty["ok"], &faulty["id"], &faulty["page"]), (&json!(false), &Value::Null, &Value::Null));
    let said = &faulty["diagnostics"][0];
    assert_eq!(
        (&said["code"], &said["file"], &said["line"]),
        (&json!("kake::import"), &json!("scene.kake"), &json!(3))
    );
    desk.put("late.kake", "let late = 1\n");
    let changed = events.next("changed");
    assert_eq!((&changed["revision"], &changed["files"]), (&json!(2), &json!(["late.kake"])));
    let first = preview.draw(&json!({}));
    assert_eq!((&first["ok"], &first["revision"]), (&json!(true), &json!(2)));
    let names: Vec<&Value> = first["sources"].as_array().expect("it has sources").iter().map(|s| &s["name"]).collect();
    assert_eq!(names, ["scene.kake", "tones.kake", "late.kake"]);
    // An import is saved by renaming.
    desk.put("tones.new", "tone fine { place: grid(spacing: 3mm) fill: lines(pitch: 0.5mm) }\n");
    std::fs::rename(desk.path("tones.new"), desk.path("tones.kake")).expect("files can be renamed");
    assert_eq!(events.next("changed")["files"], json!(["tones.kake"]));
    // The scene is broken, and what was shown stays known.
    let good = String::from_utf8(desk.get("scene.kake")).expect("scenes are text");
    desk.put("scene.kake", good.replace("param pen = 0.2mm", "param pen = 0.2mn"));
    events.next("changed");
    let broken = preview.draw(&json!({}));
    assert_eq!((&broken["ok"], &broken["id"]), (&json!(false), &Value::Null));
    assert_eq!((&broken["page"], &broken["layers"]), (&first["page"], &first["layers"]));
    assert!(broken["diagnostics"][0]["line"].is_u64());
    // It is deleted.
    std::fs::remove_file(desk.path("scene.kake")).expect("files can be deleted");
    events.next("changed");
    let gone = preview.draw(&json!({}));
    assert_eq!(gone["ok"], json!(false));
    assert!(gone["diagnostics"][0]["message"].as_str().is_some_and(|said| said.contains("cannot read")), "{gone}");
    // It is back, and mended.
    desk.put("scene.kake", good.replace("spacing: 4mm", "spacing: 2mm"));
    let revision = events.next("changed")["revision"].clone();
    let mended = preview.draw(&json!({}));
    assert_eq!((&mended["ok"], &mended["revision"]), (&json!(true), &revision));
    assert!(mended["tiles"].as_u64() > first["tiles"].as_u64());
    assert!(preview.get(&format!("/api/picture/{}.svg", first["id"].as_str().unwrap_or_default())).status == 200);
}

#[test]
fn a_drawing_that_nobody_waits_for_is_stopped() {
    let desk = Desk::new();
    desk.put("scene.kake", ENDLESS);
    let preview = Preview::of(&desk, &["--limit", "tiles=100000000", "--limit", "strokes=1000000000"]);
    let mut events = preview.events();
    // Both places are taken by drawings that would go on for minutes.
    let token = [("X-Kake-Token", &*preview.token)];
    let waiting: Vec<TcpStream> =
        (0..4).map(|job| preview.send("POST", "/api/draw", &token, &json!({ "job": job }).to_string())).collect();
    let told = events.next("step");
    assert!(told["ms"].is_u64(), "{told}");
    loop {
        if events.next("step")["step"] == "place" {
            break;
        }
    }
    drop(waiting);
    desk.put("scene.kake", ENDLESS.replace("0.5mm", "100mm"));
    let drawn = preview.draw(&json!({}));
    assert_eq!(drawn["ok"], json!(true), "{drawn}");
}

#[test]
fn pictures_are_saved_as_the_command_line_makes_them() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path("out")).expect("folders can be made");
    let preview = Preview::of(&desk, &["--output", "out"]);
    let wanted = json!({ "sets": { "kind": "grid", "turned": "30deg" }, "seed": 5, "overlays": ["angles"] });
    let command = preview.draw(&wanted)["command"].as_str().expect("there is a command").to_owned();
    for (kind, name) in [("svg", "scene.svg"), ("png", "scene.png"), ("pdf", "scene.pdf"), ("svg", "scene-2.svg")] {
        let mut body = wanted.clone();
        body["kind"] = json!(kind);
        let path = preview.post("/api/save", &body).json()["path"].as_str().expect("it says where").to_owned();
        assert!(Path::new(&path).ends_with(Path::new("out").join(name)), "{path}");
        let file = format!("made.{kind}");
        let mut arguments: Vec<&str> = command.split(' ').skip(1).collect();
        arguments.pop();
        arguments.push(&file);
        desk.quietly(&arguments);
        assert!(desk.get(&format!("out/{name}")) == desk.get(&file), "{name}");
    }
    assert!(preview.post("/api/save", &json!({ "kind": "exe" })).refused(400).contains("svg"));
    let broken = json!({ "kind": "svg", "sets": { "pen": "9mm" } });
    assert!(preview.post("/api/save", &broken).refused(422).contains("0.6mm"));
    assert_eq!(std::fs::read_dir(desk.path("out")).expect("it is a folder").count(), 4);
}

#[test]
fn values_are_written_back_unless_the_scene_has_changed() {
    let desk = Desk::new();
    let before = String::from_utf8(desk.get("scene.kake")).expect("scenes are text");
    let preview = Preview::of(&desk, &[]);
    let mut events = preview.events();
    let sets = json!({ "pen": "0.3mm", "kind": "grid", "share": "50%" });
    let drawn = preview.draw(&json!({ "sets": sets, "seed": 11 }));
    let body = json!({ "sets": sets, "seed": 11, "revision": drawn["revision"] });
    let written = preview.post("/api/params", &body).json();
    assert_eq!(written["written"], json!(["pen", "kind", "seed"]));
    let wanted = before
        .replace("pen = 0.2mm in", "pen = 0.3mm in")
        .replace("kind = \"hex\" in", "kind = \"grid\" in")
        .replace("seed 3", "seed 11");
    assert_eq!(String::from_utf8_lossy(&desk.get("scene.kake")), wanted);
    events.next("changed");
    let after = preview.draw(&json!({}));
    assert_eq!((&after["seed"], &after["tiles"]), (&json!(11), &drawn["tiles"]));
    // The page has not seen what is in the file.
    assert!(preview.post("/api/params", &body).refused(409).contains("saved"));
    let mut late = body.clone();
    late["revision"] = after["revision"].clone();
    desk.put("scene.kake", wanted.replace("0.3mm", "0.4mm"));
    preview.post("/api/params", &late).refused(409);
    assert!(String::from_utf8_lossy(&desk.get("scene.kake")).contains("0.4mm"));
    events.next("changed");
    late["revision"] = preview.draw(&json!({}))["revision"].clone();
    late["sets"] = json!({ "pen": "9mm" });
    assert!(preview.post("/api/params", &late).refused(422).contains("9mm"));
}

#[test]
fn requests_that_make_no_sense_are_refused_in_words() {
    let desk = Desk::new();
    let preview = Preview::of(&desk, &[]);
    let token = [("X-Kake-Token", &*preview.token)];
    for body in
        ["", "{", "[]", "7", r#"{"sets":{"a":1}}"#, r#"{"seed":-1}"#, r#"{"seed":"x"}"#, r#"{"overlays":["x"]}"#]
    {
        let said = preview.ask("POST", "/api/draw", &token, body).refused(400);
        assert!(!said.is_empty(), "{body}");
    }
    let unknown = preview.draw(&json!({ "sets": { "no": "1" }, "only": null }));
    assert_eq!(unknown["diagnostics"][0]["code"], "kake::param");
    assert_eq!(preview.draw(&json!({ "only": "nobody" }))["ok"], json!(false));
    let seed = preview.draw(&json!({ "seed": "18446744073709551615" }));
    assert_eq!(seed["seed"], "18446744073709551615");
    assert_eq!(preview.draw(&json!({}))["ok"], json!(true));
}

#[test]
fn a_port_that_is_taken_is_said() {
    let desk = Desk::new();
    let taken = TcpListener::bind("127.0.0.1:0").expect("there are ports");
    let port = taken.local_addr().expect("it has a port").port().to_string();
    desk.kake(&["preview", "scene.kake", "--port", &port]).refused(3, &format!("port {port} is in use"));
    let (one, other) = (Preview::of(&desk, &[]), Preview::of(&desk, &[]));
    assert_ne!((one.port, &one.token), (other.port, &other.token));
    assert_eq!((one.draw(&json!({}))["ok"].clone(), other.draw(&json!({}))["ok"].clone()), (json!(true), json!(true)));
    assert_eq!(other.ask("POST", "/api/draw", &[("X-Kake-Token", &one.token)], "{}").status, 403);
}

#[test]
fn what_cannot_be_previewed_is_said() {
    let desk = Desk::new();
    desk.kake(&["preview", "none.kake"]).refused(3, "cannot read none.kake");
    desk.kake(&["preview", "-"]).refused(2, "follows a file");
    desk.kake(&["preview", "scene.kake", "--output", "none"]).refused(3, "cannot be saved in none");
    desk.kake(&["preview", "scene.kake", "--port", "65536"]).refused(2, "65536");
    desk.kake(&["build", "scene.kake", "--watch", "-o", "-"]).refused(2, "--watch");
}

/// Asks a program to end as a terminal or the system does, and waits for it.
#[cfg(unix)]
fn end(child: &mut Child, signal: &str) -> std::process::ExitStatus {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("there is a kill");
    assert!(sent.success());
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("it can be waited for") {
            return status;
        }
        assert!(begun.elapsed() < PATIENCE, "it does not end");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
#[cfg(unix)]
fn a_preview_ends_at_once_and_leaves_nothing() {
    for signal in ["-INT", "-TERM"] {
        let desk = Desk::new();
        desk.put("scene.kake", ENDLESS);
        let mut preview = Preview::of(&desk, &["--limit", "tiles=100000000", "--limit", "strokes=1000000000"]);
        let mut events = preview.events();
        let token = [("X-Kake-Token", &*preview.token)];
        let _waiting = preview.send("POST", "/api/draw", &token, "{}");
        events.next("step");
        let status = end(&mut preview.child, signal);
        assert_eq!(status.code(), Some(0));
        assert_eq!(desk.files(), ["scene.kake"]);
        assert!(TcpStream::connect(("127.0.0.1", preview.port)).is_err());
    }
}

/// `kake build --watch`, line by line.
struct Building {
    child: Child,
    said: BufReader<std::process::ChildStderr>,
}

impl Drop for Building {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Building {
    /// The next line of the program's own.
    fn next(&mut self) -> String {
        loop {
            let mut line = String::new();
            assert!(self.said.read_line(&mut line).expect("it speaks UTF-8") > 0, "it has ended");
            if let Some(words) = line.strip_prefix("kake: ") {
                return words.trim().to_owned();
            }
        }
    }
}

#[test]
fn a_build_follows_its_scene() {
    let desk = Desk::new();
    let scene = String::from_utf8(desk.get("scene.kake")).expect("scenes are text");
    let mut child = start(&desk.path(""), &["build", "scene.kake", "--watch", "-o", "a.svg", "-o", "b.png"]);
    let said = BufReader::new(child.stderr.take().expect("it speaks"));
    let mut building = Building { child, said };
    assert!(building.next().starts_with("wrote a.svg, b.png in "));
    let first = desk.get("a.svg");
    desk.put("scene.kake", scene.replace("spacing: 4mm", "spacing: 3mm"));
    assert!(building.next().starts_with("scene.kake was saved: wrote a.svg, b.png in "));
    let second = desk.get("a.svg");
    assert!(first != second);
    desk.put("scene.kake", scene.replace("seed 3", "seed three"));
    assert!(building.next().contains("stays as it is"));
    std::fs::remove_file(desk.path("scene.kake")).expect("files can be deleted");
    assert!(building.next().starts_with("cannot read scene.kake"));
    assert!(building.next().starts_with("scene.kake is gone: what was written last stays"));
    assert!(desk.get("a.svg") == second);
    desk.put("scene.kake", &scene);
    assert!(building.next().starts_with("scene.kake was saved: wrote a.svg, b.png in "));
    assert!(desk.get("a.svg") == first);
    #[cfg(unix)]
    assert!(!end(&mut building.child, "-INT").success());
    assert_eq!(desk.files(), ["a.svg", "b.png", "scene.kake"]);
}
