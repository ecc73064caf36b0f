//! The program itself: what its commands print, write and end with.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use kakeami::diag::Code;
use serde_json::Value;
use tempfile::TempDir;

use crate::support::here;

const SCENE: &str = "edition 1

canvas { size: (12mm, 12mm), dpi: 300 }
seed 3

/// The stroke's width.
param pen = 0.2mm in 0.1mm .. 0.6mm
/// Which lattice.
param kind = \"hex\" in [\"hex\", \"grid\"]
param turned = 0deg
param fine = false
param share = 50%

tone plain {
  place: match kind { \"hex\" => hex(spacing: 4mm), \"grid\" => grid(spacing: 4mm) }
  angle: fixed(turned)
  fill: lines(pitch: 1mm, pen: pen)
}
tone loose { place: poisson(radius: 3mm) fill: lines(pitch: 1.5mm) }

paint canvas with plain as \"lattice\"
layer \"upper\" {
  paint circle(center: (6mm, 6mm), radius: 4mm) with loose as \"disc\"
}
";

/// A folder of its own for one test.
pub(crate) struct Desk(TempDir);

impl Desk {
    pub(crate) fn new() -> Self {
        let desk = Self(TempDir::new().expect("there is room for temporary files"));
        desk.put("scene.kake", SCENE);
        desk
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub(crate) fn put(&self, file: &str, text: impl AsRef<[u8]>) {
        let path = self.path(file);
        fs::create_dir_all(path.parent().expect("it lies in the folder")).expect("folders can be made");
        fs::write(path, text).expect("files can be written");
    }

    pub(crate) fn get(&self, file: &str) -> Vec<u8> {
        fs::read(self.path(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    }

    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder can be read");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("it can be read").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the program in this folder.
    pub(crate) fn kake(&self, arguments: &[&str]) -> Ran {
        self.kake_with(arguments, b"")
    }

    fn kake_with(&self, arguments: &[&str], input: &[u8]) -> Ran {
        let mut child = Command::new(env!("CARGO_BIN_EXE_kake"))
            .args(arguments)
            .current_dir(self.0.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut stdin = child.stdin.take().expect("it has an input");
        // Who does not read its input closes it.
        let _ = stdin.write_all(input);
        drop(stdin);
        Ran(child.wait_with_output().expect("the program ends"))
    }

    /// Runs the program, which must succeed without a word.
    #[track_caller]
    pub(crate) fn quietly(&self, arguments: &[&str]) {
        let ran = self.kake(arguments);
        assert_eq!((ran.status(), ran.out().as_str(), ran.err().as_str()), (0, "", ""), "{arguments:?}");
    }
}

pub(crate) struct Ran(Output);

impl Ran {
    pub(crate) fn status(&self) -> i32 {
        self.0.status.code().expect("it ends by itself")
    }

    pub(crate) fn out(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).expect("it prints UTF-8")
    }

    pub(crate) fn err(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).expect("it prints UTF-8")
    }

    #[track_caller]
    fn json(&self) -> Value {
        assert_eq!(self.status(), 0, "{}", self.err());
        serde_json::from_slice(&self.0.stdout).expect("it prints JSON")
    }

    /// Asserts how it ended, with nothing printed and these words among what was said.
    #[track_caller]
    pub(crate) fn refused(&self, status: i32, words: &str) {
        assert_eq!(self.status(), status, "{}", self.err());
        assert_eq!(self.out(), "");
        assert!(self.err().contains(words), "{}", self.err());
        assert!(!self.err().contains("panicked"), "{}", self.err());
    }
}

#[test]
fn build_writes_every_output() {
    let desk = Desk::new();
    desk.quietly(&["build", "scene.kake", "-o", "a.svg", "-o", "b.png", "-o", "c.json"]);
    assert_eq!(desk.files(), ["a.svg", "b.png", "c.json", "scene.kake"]);
    assert!(desk.get("a.svg").starts_with(b"<svg"));
    assert!(desk.get("b.png").starts_with(b"\x89PNG"));
    let json: Value = serde_json::from_slice(&desk.get("c.json")).expect("it is JSON");
    assert_eq!(json["layers"].as_array().map(Vec::len), Some(2));
    // The same picture on standard output, and under the scene's name where no output is named.
    assert_eq!(desk.kake(&["build", "scene.kake", "-o", "-"]).0.stdout, desk.get("a.svg"));
    desk.quietly(&["build", "scene.kake"]);
    assert_eq!(desk.get("scene.svg"), desk.get("a.svg"));
}

#[test]
fn build_reads_standard_input() {
    let desk = Desk::new();
    let ran = desk.kake_with(&["build", "-", "-o", "-", "--embed", "none"], SCENE.as_bytes());
    assert_eq!(ran.status(), 0, "{}", ran.err());
    assert_eq!(ran.0.stdout, desk.kake(&["build", "scene.kake", "-o", "-", "--embed", "none"]).0.stdout);
    desk.kake_with(&["build", "-", "-o", "-"], b"paint canvas with plain").refused(1, "stdin.kake:1");
}

#[test]
fn build_draws_for_every_seed() {
    let desk = Desk::new();
    desk.quietly(&["build", "scene.kake", "--seeds", "2..4", "-o", "out-{seed}.svg", "-o", "{seed}.png"]);
    assert_eq!(desk.files(), ["2.png", "3.png", "4.png", "out-2.svg", "out-3.svg", "out-4.svg", "scene.kake"]);
    desk.quietly(&["build", "scene.kake", "--seed", "4", "-o", "four.svg"]);
    assert_eq!(desk.get("four.svg"), desk.get("out-4.svg"));
    assert_ne!(desk.get("out-3.svg"), desk.get("out-4.svg"));
    desk.kake(&["build", "scene.kake", "--seeds", "2..4", "-o", "one.svg"]).refused(2, "{seed}");
    desk.kake(&["build", "scene.kake", "--seeds", "4..2", "-o", "{seed}.svg"]).refused(2, "4 comes after 2");
    desk.kake(&["build", "scene.kake", "--seeds", "1..2", "--seed", "3"]).refused(2, "--seed");
}

#[test]
fn build_sets_parameters() {
    let desk = Desk::new();
    let svg = |sets: &[&str]| {
        let mut arguments = vec!["build", "scene.kake", "-o", "-", "--embed", "none"];
        for set in sets {
            arguments.extend(["--set", set]);
        }
        let ran = desk.kake(&arguments);
        assert_eq!(ran.status(), 0, "{}", ran.err());
        ran.out()
    };
    let plain = svg(&[]);
    assert_eq!(svg(&["pen=0.2mm"]), plain);
    assert_ne!(svg(&["pen=0.4mm"]), plain);
    assert_eq!(svg(&["kind=grid"]), svg(&["kind=\"grid\""]));
    assert_ne!(svg(&["kind=grid"]), plain);
    let refuse = |set: &str, code: &str| {
        desk.kake(&["build", "scene.kake", "-o", "x.svg", "--set", set]).refused(1, code);
        assert_eq!(desk.files(), ["scene.kake"]);
    };
    refuse("pne=0.2mm", "kake::param");
    refuse("pen=2mm", "kake::out-of-range");
    refuse("kind=square", "kake::choice");
    refuse("pen=\"a\"", "kake::type");
    refuse("pen=(", "kake::syntax");
    desk.kake(&["build", "scene.kake", "--set", "pen"]).refused(2, "NAME=VALUE");
}

#[test]
fn build_knows_its_other_options() {
    let desk = Desk::new();
    let png = |arguments: &[&str]| {
        let mut all = vec!["build", "scene.kake", "-o", "x.png"];
        all.extend(arguments);
        desk.quietly(&all);
        desk.get("x.png")
    };
    let width = |png: &[u8]| u32::from_be_bytes(png[16..20].try_into().expect("four bytes"));
    assert_eq!(width(&png(&[])), 142);
    assert_eq!(width(&png(&["--dpi", "150"])), 71);
    let only = desk.kake(&["build", "scene.kake", "-o", "-", "--only", "disc"]).out();
    assert!(only.contains("\"disc\"") && !only.contains("label=\"lattice\""));
    desk.kake(&["build", "scene.kake", "--only", "disk"]).refused(1, "did you mean `disc`?");
    desk.kake(&["build", "scene.kake", "--limit", "tiles=2"]).refused(1, "kake::limit");
    desk.kake(&["build", "scene.kake", "--limit", "strokes=2"]).refused(1, "kake::limit");
    desk.kake(&["build", "scene.kake", "--dpi", "60000", "-o", "x.png"]).refused(1, "--limit megapixels=");
    desk.kake(&["build", "scene.kake", "--limit", "tyles=2"]).refused(2, "there is no limit `tyles`");
    desk.kake(&["build", "scene.kake", "--limit", "tiles=many"]).refused(2, "not a whole number");
    desk.kake(&["build", "scene.kake", "--dpi", "0"]).refused(2, "resolution");
    desk.kake(&["build", "scene.kake", "--threads", "0"]).refused(2, "threads");
    let timed = desk.kake(&["build", "scene.kake", "--timings", "-o", "x.svg"]);
    assert_eq!((timed.status(), timed.out().as_str()), (0, ""));
    assert!(timed.err().contains("lower") && timed.err().contains("ms"));
}

#[test]
fn a_canvas_that_repeats_makes_swatches() {
    let desk = Desk::new();
    // Three cells of the grid go round the page, but no even number of a hexagonal lattice's rows.
    desk.put("rain.kake", SCENE.replace("dpi: 300", "repeat: true").replace("kind = \"hex\"", "kind = \"grid\""));
    desk.quietly(&["build", "rain.kake", "-o", "rain.svg", "-o", "rain.png", "--as", "pattern"]);
    let swatch = String::from_utf8(desk.get("rain.svg")).expect("SVG is UTF-8");
    assert!(swatch.contains(r#"<pattern height="12" id="rain" patternUnits="userSpaceOnUse" width="12">"#), "{swatch}");
    assert!(swatch.contains(r#"viewBox="0 0 24 24""#));
    // The swatch makes itself again, and a plain page when told to.
    desk.quietly(&["build", "rain.svg", "-o", "again.svg"]);
    assert_eq!(String::from_utf8(desk.get("again.svg")).expect("SVG is UTF-8").replace("again", "rain"), swatch);
    desk.quietly(&["build", "rain.svg", "-o", "page.svg", "--as", "page"]);
    assert!(!String::from_utf8(desk.get("page.svg")).expect("SVG is UTF-8").contains("<pattern"));
    desk.kake(&["build", "rain.kake", "-o", "rain.png", "--as", "pattern"]).refused(2, "no output ends in .svg");
    desk.kake(&["build", "scene.kake", "-o", "a.svg", "--as", "pattern"]).refused(1, "a canvas that repeats");
    assert!(!desk.files().contains(&"a.svg".to_owned()));
}

#[test]
fn threads_make_no_difference() {
    let desk = Desk::new();
    for threads in ["1", "4"] {
        let [svg, png] = ["svg", "png"].map(|kind| format!("{threads}.{kind}"));
        desk.quietly(&["build", "scene.kake", "--threads", threads, "-o", &svg, "-o", &png]);
    }
    assert_eq!(desk.get("1.svg"), desk.get("4.svg"));
    assert_eq!(desk.get("1.png"), desk.get("4.png"));
}

/// A scene with an import, a drawing and an image, in folders of their own.
fn with_files(desk: &Desk) {
    let data = |file: &str| fs::read(here("tests/cases/data").join(file)).expect("the data is there");
    desk.put(
        "art/library.kake",
        "param weight = 0.3mm\ntone loose { place: hex(spacing: 4mm) fill: lines(pitch: 1mm, pen: weight) }\n",
    );
    desk.put("art/data/shapes.svg", data("shapes.svg"));
    desk.put("art/data/tiny.png", data("tiny.png"));
    desk.put(
        "art/scene.kake",
        "import \"library.kake\" as library
canvas { size: (20mm, 20mm), dpi: 150 }
param seed_of_the_noise = 1
field light = image(\"data/tiny.png\", fit: canvas)
tone shaded = library.loose with { k: 3 * (1 - light) + noise(scale: 3mm, seed: seed_of_the_noise) }
paint svg(\"data/shapes.svg\", id: \"disc\") with shaded as \"disc\"
paint canvas with library.loose as \"all\"
",
    );
}

#[test]
fn a_picture_is_built_again_from_itself() {
    let desk = Desk::new();
    with_files(&desk);
    let options = ["--seed", "9", "--set", "library.weight=0.5mm", "--set", "seed_of_the_noise=4", "--dpi", "100"];
    let mut first = vec!["build", "art/scene.kake", "-o", "art/one.svg", "-o", "art/one.png"];
    first.extend(options);
    desk.quietly(&first);
    for picture in ["art/one.svg", "art/one.png"] {
        desk.quietly(&["build", picture, "-o", "art/again.svg", "-o", "art/again.png"]);
        assert!(desk.get("art/again.svg") == desk.get("art/one.svg"), "{picture}");
        assert!(desk.get("art/again.png") == desk.get("art/one.png"), "{picture}");
    }
    // The command line still has the last word.
    desk.quietly(&["build", "art/one.svg", "--seed", "10", "-o", "art/other.svg"]);
    assert_ne!(desk.get("art/other.svg"), desk.get("art/one.svg"));
    // Texts are in the picture, files are not.
    fs::remove_file(desk.path("art/library.kake")).expect("it is there");
    desk.quietly(&["build", "art/one.svg", "-o", "art/again.svg"]);
    fs::remove_file(desk.path("art/data/tiny.png")).expect("it is there");
    desk.kake(&["build", "art/one.svg", "-o", "art/again.svg"]).refused(1, "kake::file");
}

#[test]
fn a_picture_with_all_its_files_is_built_anywhere() {
    let desk = Desk::new();
    with_files(&desk);
    desk.quietly(&["build", "art/scene.kake", "--embed", "all", "-o", "one.svg", "-o", "one.png", "-o", "one.pdf"]);
    fs::remove_dir_all(desk.path("art")).expect("it is there");
    for picture in ["one.svg", "one.png", "one.pdf"] {
        desk.quietly(&["build", picture, "--embed", "all", "-o", "again.svg", "-o", "again.png"]);
        assert!(desk.get("again.svg") == desk.get("one.svg"), "{picture}");
        assert!(desk.get("again.png") == desk.get("one.png"), "{picture}");
    }
    desk.quietly(&["check", "one.svg"]);
}

/// A standard library is read whatever the root is, and a picture keeps the text of the one it was made with.
#[test]
fn a_picture_keeps_its_standard_library() {
    let desk = Desk::new();
    desk.put(
        "library.kake",
        "import \"std:manga\"\ncanvas { size: (20mm, 20mm) }\npaint canvas with kakeami(pitch: 1.5mm)\n",
    );
    // A file of the same name, where the system allows it, is no standard library.
    if cfg!(unix) {
        desk.put("std:manga", "no scene");
    }
    desk.quietly(&["build", "library.kake", "-o", "one.svg"]);
    desk.quietly(&["build", "one.svg", "-o", "again.svg"]);
    assert!(desk.get("again.svg") == desk.get("one.svg"));
    let text = String::from_utf8(desk.get("one.svg")).expect("SVG is UTF-8");
    assert!(text.contains("place: poisson(radius: tile / 1.6)"));
    desk.put("old.svg", text.replace("place: poisson(radius: tile / 1.6)", "place: poisson(radius: tile / 1.2)"));
    desk.quietly(&["build", "old.svg", "-o", "again.svg"]);
    let again = String::from_utf8(desk.get("again.svg")).expect("SVG is UTF-8");
    assert!(again.contains("tile / 1.2") && again.matches("<path").count() != text.matches("<path").count());
}

#[test]
fn a_plot_says_what_the_pen_does() {
    let desk = Desk::new();
    let ran = desk.kake(&["build", "scene.kake", "--set", "pen=0.3mm", "--plot", "-o", "plot.svg"]);
    assert_eq!((ran.status(), ran.out().as_str()), (0, ""));
    let said = ran.err();
    assert!(said.contains("1 black 0.3mm") && said.contains("2 black") && said.contains("all "), "{said}");
    assert!(said.contains("lifts") && said.contains("down") && said.contains("up"), "{said}");
    let plot = String::from_utf8(desk.get("plot.svg")).expect("it is text");
    assert!(plot.contains("inkscape:label=\"1 black 0.3mm\"") && !plot.contains("<rect"));
    // What is built from a plot is one.
    assert_eq!(desk.kake(&["build", "plot.svg", "-o", "again.svg"]).status(), 0);
    assert!(desk.get("again.svg") == desk.get("plot.svg"));
}

#[test]
fn a_picture_keeps_what_it_shows_on_top() {
    let desk = Desk::new();
    desk.quietly(&["build", "scene.kake", "--overlay", "contrast,angles", "-o", "o.svg", "-o", "o.png", "-o", "o.pdf"]);
    let text = String::from_utf8(desk.get("o.svg")).expect("SVG is UTF-8");
    let label = |name: &str| format!("inkscape:label=\"overlay {name}\"");
    assert_eq!(["angles", "contrast", "sites"].map(|name| text.matches(&label(name)).count()), [1, 1, 0]);
    // Built again from itself it is the same, with others it has those, and a plot has none.
    desk.quietly(&["build", "o.svg", "-o", "same.svg"]);
    assert_eq!(desk.get("o.svg"), desk.get("same.svg"));
    desk.quietly(&["build", "o.svg", "--overlay", "sites", "-o", "sites.svg"]);
    let text = String::from_utf8(desk.get("sites.svg")).expect("SVG is UTF-8");
    assert!(text.contains(&label("sites")) && !text.contains(&label("angles")));
    desk.quietly(&["build", "scene.kake", "-o", "plain.svg"]);
    desk.quietly(&["build", "o.svg", "--overlay", "none", "-o", "none.svg"]);
    assert_eq!(desk.get("plain.svg"), desk.get("none.svg"));
    assert_eq!(desk.kake(&["build", "o.svg", "--plot", "-o", "plot.svg"]).status(), 0);
    assert!(!String::from_utf8(desk.get("plot.svg")).expect("SVG is UTF-8").contains("overlay "));
}

#[test]
fn metrics_draw_charts() {
    let desk = Desk::new();
    let plain = desk.kake(&["metrics", "scene.kake", "--seeds", "0..2"]).out();
    let ran = desk.kake(&["metrics", "scene.kake", "--seeds", "0..2", "--charts", "made/charts"]);
    assert_eq!((ran.status(), ran.out()), (0, plain), "{}", ran.err());
    for paint in ["lattice", "disc"] {
        for kind in ["correlogram", "decay", "spectrum", "directions", "contrast", "cells"] {
            let text = String::from_utf8(desk.get(&format!("made/charts/{paint}-{kind}.svg"))).expect("SVG is UTF-8");
            assert!(text.starts_with("<svg") && text.contains(paint) && !text.contains("NaN"), "{paint} {kind}");
        }
    }
    desk.kake(&["metrics", "scene.kake", "--charts", "scene.kake"]).refused(3, "cannot write scene.kake");
}

#[test]
fn a_picture_without_a_scene_says_so() {
    let desk = Desk::new();
    desk.quietly(&["build", "scene.kake", "--embed", "none", "-o", "bare.svg", "-o", "bare.png", "-o", "bare.pdf"]);
    desk.put("other.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
    desk.put("broken.png", "no picture at all");
    for picture in ["bare.svg", "bare.png", "bare.pdf", "other.svg", "broken.png"] {
        desk.kake(&["build", picture, "-o", "x.svg"]).refused(1, "kake::metadata");
        desk.kake(&["check", picture]).refused(1, "kake::metadata");
    }
}

#[test]
fn faults_of_the_scene_write_nothing() {
    let desk = Desk::new();
    desk.put("x.svg", "the old picture");
    desk.put("faulty.kake", SCENE.replace("hex(spacing", "hexx(spacing"));
    desk.kake(&["build", "faulty.kake", "-o", "x.svg", "-o", "new.png"]).refused(1, "kake::unknown-function");
    desk.put("latin.kake", b"// caf\xe9\n");
    desk.kake(&["build", "latin.kake", "-o", "x.svg"]).refused(1, "kake::encoding");
    desk.put("empty.kake", "");
    desk.kake(&["build", "empty.kake", "-o", "x.svg"]).refused(1, "kake::empty");
    assert_eq!(desk.get("x.svg"), b"the old picture");
    assert_eq!(desk.files(), ["empty.kake", "faulty.kake", "latin.kake", "scene.kake", "x.svg"]);
}

#[test]
fn faults_of_the_command_line() {
    let desk = Desk::new();
    for (arguments, words) in [
        (&["build"][..], "SCENE"),
        (&["biuld", "scene.kake"], "biuld"),
        (&["build", "scene.kake", "--sede", "3"], "--sede"),
        (&["build", "scene.kake", "-o", "x.bmp"], ".svg, .png, .pdf or .json"),
        (&["build", "scene.kake", "--plot", "-o", "x.svg", "-o", "x.png"], "x.png: what is plotted is written as .svg"),
        (&["build", "scene.kake", "--overlay", "sites,grph"], "a similar value exists: 'graph'"),
        (&["build", "scene.kake", "--overlay", ""], "'--overlay <LIST>'"),
        (&["build", "scene.kake", "--overlay", "sites", "--plot"], "cannot be used with '--plot'"),
        (&["build", "scene.kake", "-o", "x.svg", "-o", "x.svg"], "given twice"),
        (&["build", "scene.kake", "-o", "scene.kake"], "the scene itself"),
        (&["build", "scene.kake", "--seed", "-1"], "-1"),
        (&["build", "scene.kake", "--embed", "some"], "some"),
        (&["ir", "scene.kake", "--stage", "lines"], "lines"),
        (&["convert", "scene.kake", "x.svg"], ".kake nor .toml"),
        (&["fmt"], "FILE"),
        (&["fmt", "scene.toml"], "TOML"),
        (&["explain", "kake::unknown-nam"], "did you mean `unknown-name`?"),
        (&["build", "scene.kake", "--root", "elsewhere/"], "elsewhere"),
    ] {
        let ran = desk.kake(arguments);
        let wanted = if words == "elsewhere" { 3 } else { 2 };
        ran.refused(wanted, words);
    }
    let ran = desk.kake(&[]);
    assert_eq!(ran.status(), 2);
    assert_eq!(desk.files(), ["scene.kake"]);
}

#[test]
fn what_cannot_be_read_ends_with_three() {
    let desk = Desk::new();
    fs::create_dir(desk.path("folder.kake")).expect("folders can be made");
    for file in ["missing.kake", "missing.svg", "missing/scene.kake"] {
        for command in ["build", "check", "ir", "params"] {
            desk.kake(&[command, file]).refused(3, "cannot read");
        }
    }
    desk.kake(&["fmt", "missing.kake"]).refused(3, "cannot read");
    desk.kake(&["fmt", "folder.kake"]).refused(3, "cannot read");
    desk.kake(&["convert", "missing.kake", "x.toml"]).refused(3, "cannot read");
}

#[test]
fn what_cannot_be_written_ends_with_three() {
    let desk = Desk::new();
    desk.put("old.svg", "the old picture");
    fs::create_dir(desk.path("folder.svg")).expect("folders can be made");
    // One output that fails keeps the others from being replaced.
    for output in ["scene.kake/x.svg", "missing/x.svg", "folder.svg", "/proc/x.svg"] {
        desk.kake(&["build", "scene.kake", "-o", "old.svg", "-o", output]).refused(3, "cannot write");
        assert_eq!(desk.get("old.svg"), b"the old picture", "{output}");
    }
    assert_eq!(desk.files(), ["folder.svg", "old.svg", "scene.kake"], "nothing half-written is left");
    desk.kake(&["convert", "scene.kake", "missing/x.toml"]).refused(3, "cannot write");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_with_three() {
    let desk = Desk::new();
    desk.put("old.svg", "the old picture");
    std::os::unix::fs::symlink("/dev/full", desk.path("full.svg")).expect("links can be made");
    desk.kake(&["build", "scene.kake", "-o", "old.svg", "-o", "full.svg"]).refused(3, "no space left");
    assert_eq!(desk.get("old.svg"), b"the old picture");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let status = Command::new(env!("CARGO_BIN_EXE_kake"))
        .args(["build", "scene.kake", "-o", "-"])
        .current_dir(desk.0.path())
        .stdout(full)
        .stderr(Stdio::null())
        .status();
    assert_eq!(status.expect("the program starts").code(), Some(3));
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_stays_what_it_was() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::new();
    desk.put("real.svg", "the old picture");
    fs::set_permissions(desk.path("real.svg"), fs::Permissions::from_mode(0o640)).expect("it is ours");
    std::os::unix::fs::symlink("real.svg", desk.path("link.svg")).expect("links can be made");
    desk.quietly(&["build", "scene.kake", "-o", "link.svg"]);
    assert!(desk.path("link.svg").is_symlink());
    assert!(desk.get("real.svg").starts_with(b"<svg"));
    let mode = fs::metadata(desk.path("real.svg")).expect("it is there").permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
}

#[cfg(unix)]
#[test]
fn links_lead_out_of_no_root() {
    let desk = Desk::new();
    desk.put("secret.png", "secret");
    fs::create_dir(desk.path("art")).expect("folders can be made");
    std::os::unix::fs::symlink("../secret.png", desk.path("art/link.png")).expect("links can be made");
    desk.put(
        "art/scene.kake",
        "canvas { size: (9mm, 9mm) }\nfield f = image(\"link.png\", fit: canvas)\noutline canvas pen 1mm\n",
    );
    desk.kake(&["check", "art/scene.kake"]).refused(1, "kake::outside-root");
    desk.kake(&["check", "art/scene.kake", "--root", "."]).refused(1, "kake::image");
    desk.put("kake.toml", "");
    desk.kake(&["check", "art/scene.kake"]).refused(1, "kake::image");
}

#[test]
fn check_says_what_is_wrong() {
    let desk = Desk::new();
    desk.quietly(&["check", "scene.kake"]);
    desk.put("faulty.kake", SCENE.replace("radius: 4mm", "raduis: 4mm"));
    desk.kake(&["check", "scene.kake", "faulty.kake"]).refused(1, "did you mean `radius`?");
    let ran = desk.kake(&["check", "faulty.kake", "scene.kake", "--format", "json"]);
    assert_eq!((ran.status(), ran.err().as_str()), (1, ""));
    let list: Value = serde_json::from_str(&ran.out()).expect("it prints JSON");
    let [found] = &list.as_array().expect("it prints a list")[..] else { panic!("{list}") };
    assert_eq!(found["code"], "kake::unknown-argument");
    assert_eq!(found["severity"], "error");
    assert_eq!(found["file"], "faulty.kake");
    assert_eq!(found["hint"], "did you mean `radius`?");
    assert_eq!((&found["start"]["line"], &found["start"]["column"]), (&Value::from(23), &Value::from(36)));
    assert!(found["message"].is_string() && found["notes"].is_array());
    // Warnings are said and are no fault.
    desk.put("unnamed.kake", SCENE.replace(" as \"lattice\"", "").replace("with loose as \"disc\"", "with plain"));
    let warned = desk.kake(&["check", "unnamed.kake"]);
    assert_eq!(warned.status(), 0);
    assert!(warned.err().contains("kake::unnamed-paint"));
    assert_eq!(desk.kake(&["check", "scene.kake", "--format", "json"]).out(), "[]\n");
    // A library draws nothing, and is fine.
    desk.put("library.kake", "tone t { place: hex(spacing: 4mm) fill: solid() }\n");
    desk.quietly(&["check", "library.kake"]);
    desk.kake(&["build", "library.kake"]).refused(1, "kake::empty");
}

#[test]
fn fmt_brings_scenes_into_form() {
    let desk = Desk::new();
    let ugly = "canvas{size:(12mm,12mm)}   // a page\noutline   canvas pen 1mm\n";
    desk.put("ugly.kake", ugly);
    let checked = desk.kake(&["fmt", "--check", "ugly.kake"]);
    assert_eq!((checked.status(), checked.out().as_str()), (1, "ugly.kake\n"));
    assert_eq!(desk.get("ugly.kake"), ugly.as_bytes());
    let printed = desk.kake_with(&["fmt", "-"], ugly.as_bytes());
    assert_eq!(printed.status(), 0);
    desk.quietly(&["fmt", "ugly.kake"]);
    assert_eq!(desk.get("ugly.kake"), printed.0.stdout);
    desk.quietly(&["fmt", "--check", "ugly.kake"]);
    desk.put("faulty.kake", "canvas { size: ( }\n");
    desk.kake(&["fmt", "faulty.kake"]).refused(1, "kake::syntax");
    assert_eq!(desk.get("faulty.kake"), b"canvas { size: ( }\n");
}

#[test]
fn convert_goes_both_ways() {
    let desk = Desk::new();
    desk.quietly(&["convert", "scene.kake", "scene.toml"]);
    desk.quietly(&["convert", "scene.toml", "back.kake"]);
    desk.quietly(&["fmt", "--check", "back.kake"]);
    let svg = |file: &str| desk.kake(&["build", file, "-o", "-", "--embed", "none"]).0.stdout;
    assert!(svg("scene.kake") == svg("scene.toml"));
    assert!(svg("scene.kake") == svg("back.kake"));
    assert_eq!(desk.kake(&["convert", "scene.kake", "-"]).0.stdout, desk.get("scene.toml"));
    assert_eq!(desk.kake(&["convert", "scene.toml", "-"]).0.stdout, desk.get("back.kake"));
    desk.put("noted.kake", format!("// Only a comment.\n{SCENE}"));
    let noted = desk.kake(&["convert", "noted.kake", "noted.toml"]);
    assert_eq!(noted.status(), 0);
    assert!(noted.err().contains("comments other than `///`"));
    desk.put("faulty.toml", "canvas = 3\n");
    desk.kake(&["convert", "faulty.toml", "x.kake"]).refused(1, "kake::toml");
}

/// Numbers in a JSON value, all of them finite.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(members) => members.iter().flat_map(numbers).collect(),
        Value::Number(number) => vec![number.as_f64().expect("numbers are finite")],
        _ => Vec::new(),
    }
}

#[test]
fn ir_prints_every_stage() {
    let desk = Desk::new();
    let stage = |stage: &str| desk.kake(&["ir", "scene.kake", "--stage", stage]).json();
    let scene = stage("scene");
    assert_eq!(scene["seed"], 3);
    assert_eq!(desk.kake(&["ir", "scene.kake"]).json(), scene);
    assert_eq!(scene["draws"].as_array().map(Vec::len), Some(2));
    let keys = |value: &Value| -> Vec<String> { value.as_object().expect("an object").keys().cloned().collect() };
    let stages: [(&str, &[&str]); 4] = [
        ("sites", &["paint", "tone", "bounds", "sites"]),
        ("graph", &["paint", "tone", "bounds", "sites", "edges", "triangles"]),
        ("angles", &["paint", "tone", "bounds", "sites", "edges", "triangles", "angles", "k"]),
        ("tiles", &["paint", "tone", "bounds", "sites", "edges", "triangles", "angles", "k", "tiles"]),
    ];
    for (name, expected) in stages {
        let printed = stage(name);
        let mut expected: Vec<&str> = expected.to_vec();
        expected.sort_unstable();
        let paints = printed["paints"].as_array().expect("a list of paints");
        assert_eq!(paints.len(), 2);
        for paint in paints {
            let mut keys = keys(paint);
            keys.sort_unstable();
            assert_eq!(keys, expected, "{name}");
        }
        assert_eq!((&paints[0]["paint"], &paints[0]["tone"]), (&"lattice".into(), &"plain".into()));
        assert_eq!(numbers(&paints[0]["bounds"]), [0.0, 0.0, 12.0, 12.0]);
        let count = paints[1]["sites"].as_array().expect("a list of sites").len();
        assert!(count > 3);
        for site in paints[1]["sites"].as_array().expect("a list of sites") {
            assert_eq!(numbers(site).len(), 2);
        }
        for of_sites in ["angles", "k", "tiles"].into_iter().filter(|key| expected.contains(key)) {
            assert_eq!(paints[1][of_sites].as_array().map(Vec::len), Some(count), "{of_sites}");
        }
        for (of_links, length) in [("edges", 2), ("triangles", 3)].into_iter().filter(|(key, _)| expected.contains(key))
        {
            let links = paints[1][of_links].as_array().expect("a list of links");
            assert!(!links.is_empty());
            for link in links.iter().map(numbers) {
                assert_eq!(link.len(), length);
                assert!(link.iter().all(|site| *site < count as f64 && site.fract() == 0.0));
            }
        }
    }
    let angles = numbers(&stage("angles")["paints"][1]["angles"]);
    assert!(angles.iter().all(|angle| (0.0..std::f64::consts::PI).contains(angle)));
    // Tiles are lists of rings of points.
    let tile = &stage("tiles")["paints"][1]["tiles"][0];
    assert_eq!(tile[0].as_array().map(Vec::len), Some(4));
    assert_eq!(numbers(&tile[0][0]).len(), 2);
    let drawing = stage("drawing");
    assert_eq!(drawing["layers"][0]["name"], "lattice");
    assert_eq!(drawing["layers"][0]["ink"], "#000000");
    let stroke = &drawing["layers"][0]["strokes"][0];
    assert_eq!(stroke["pen"].as_f64(), Some(0.2));
    assert_eq!(numbers(&stroke["points"]).len(), 4);
    // One paint, another seed.
    let only = desk.kake(&["ir", "scene.kake", "--stage", "sites", "--only", "disc", "--seed", "8"]).json();
    assert_eq!(only["paints"].as_array().map(Vec::len), Some(1));
    assert_ne!(only["paints"][0]["sites"], stage("sites")["paints"][1]["sites"]);
    desk.kake(&["ir", "scene.kake", "--stage", "sites", "--only", "disk"]).refused(1, "did you mean `disc`?");
}

#[test]
fn params_are_a_json_schema() {
    let desk = Desk::new();
    let schema = desk.kake(&["params", "scene.kake"]).json();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    assert_eq!(schema["type"], "object");
    assert_eq!(schema["additionalProperties"], false);
    let properties = &schema["properties"];
    assert_eq!(properties.as_object().map(serde_json::Map::len), Some(5));
    let pen = &properties["pen"];
    assert_eq!(pen["type"], "number");
    assert_eq!(pen["description"], "The stroke's width.");
    assert_eq!((pen["default"].as_f64(), pen["x-unit"].as_str()), (Some(0.2), Some("mm")));
    assert_eq!((pen["minimum"].as_f64(), pen["maximum"].as_f64()), (Some(0.1), Some(0.6)));
    assert_eq!(properties["kind"]["enum"], serde_json::json!(["hex", "grid"]));
    assert_eq!(properties["kind"]["default"], "hex");
    assert_eq!(properties["turned"]["x-unit"], "deg");
    assert_eq!(properties["fine"]["type"], "boolean");
    assert_eq!(
        (properties["share"]["default"].as_f64(), properties["share"]["x-unit"].as_str()),
        (Some(50.0), Some("%"))
    );
}

#[test]
fn wedges_are_drawn_and_printed() {
    let desk = Desk::new();
    desk.put(
        "tones.kake",
        "tone fine(d: field, tile: length = 1mm) {
           place: grid(spacing: tile) fill: lines(pitch: 0.25mm, pen: 0.1mm) darkness: d
         }
         tone coarse(k: field = 1) { place: grid(spacing: 1mm) fill: lines(pitch: 0.5mm, pen: 0.1mm) k: k }",
    );
    let wedge = desk.kake(&["wedge", "tones.kake", "fine(tile: 1.5mm)", "--steps", "5", "--format", "json"]).json();
    assert_eq!((&wedge["tone"], &wedge["asks"]), (&"fine(tile: 1.5mm)".into(), &"darkness".into()));
    let measured = |step: usize| wedge["steps"][step]["measured"].as_f64().expect("it is a number");
    assert!(measured(0) == 0.0 && (measured(1) - 0.25).abs() < 0.05 && measured(4) > 0.7, "{wedge}");

    let ran =
        desk.kake(&["wedge", "tones.kake", "coarse", "--steps", "3", "--dpi", "300", "-o", "w.svg", "-o", "w.png"]);
    assert_eq!((ran.status(), ran.err().as_str()), (0, ""));
    let lines: Vec<String> = ran.out().lines().map(|line| line.trim_start().to_owned()).collect();
    assert_eq!(lines.len(), 4, "{lines:?}");
    assert!(lines[0].starts_with("k ") && lines[1].starts_with("0.000") && lines[3].starts_with("4.000"), "{lines:?}");
    assert!(String::from_utf8_lossy(&desk.get("w.svg")).contains("k 2.000, prints 0."));
    assert!(desk.get("w.png").starts_with(b"\x89PNG"));
    assert!(desk.kake(&["wedge", "tones.kake", "coarse", "--steps", "2", "--format", "csv"]).out().starts_with("k,"));
    assert_eq!(desk.kake(&["wedge", "scene.kake", "plain", "--steps", "2", "--set", "pen=0.4mm"]).status(), 0);

    desk.put("page.kake", "import \"tones.kake\" as tones");
    assert_eq!(desk.kake(&["wedge", "page.kake", "tones.fine(d: 0)", "--steps", "2"]).status(), 0);
    desk.kake(&["wedge", "page.kake"]).refused(1, "declares no tone");

    desk.kake(&["wedge", "tones.kake"]).refused(1, "several tones");
    desk.kake(&["wedge", "tones.kake", "fone"]).refused(1, "did you mean `fine`?");
    desk.kake(&["wedge", "tones.kake", "fine(tile: 3deg)"]).refused(1, "kake::type");
    desk.kake(&["wedge", "tones.kake", "fine(tile: 100mm)"]).refused(1, "megapixels");
    desk.kake(&["wedge", "tones.kake", "fine", "--steps", "1"]).refused(2, "--steps");
    desk.kake(&["wedge", "tones.kake", "fine", "-o", "-"]).refused(2, "standard output");
    desk.kake(&["wedge", "tones.kake", "fine", "-o", "w.gif"]).refused(2, "outputs end in");
}

#[test]
fn every_code_is_explained() {
    let desk = Desk::new();
    let list = desk.kake(&["explain"]).out();
    assert_eq!(list.lines().count(), Code::ALL.len());
    for (code, line) in Code::ALL.iter().zip(list.lines()) {
        assert!(line.starts_with(&format!("{code} ")) && line.ends_with(code.title()), "{line}");
    }
    // One process each would be slow; a few stand for all, for they come from one table.
    for code in [Code::Syntax, Code::UnknownName, Code::Metadata] {
        let explained = desk.kake(&["explain", &code.to_string()]).out();
        assert!(explained.contains(code.title()) && explained.contains(code.explanation()));
        assert_eq!(desk.kake(&["explain", code.name()]).out(), explained);
    }
}

#[test]
fn completions_help_and_version_are_results() {
    let desk = Desk::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ran = desk.kake(&["completions", shell]);
        assert_eq!(ran.status(), 0);
        assert!(ran.out().contains("kake") && ran.err().is_empty(), "{shell}");
    }
    let help = desk.kake(&["--help"]);
    assert_eq!((help.status(), help.err().as_str()), (0, ""));
    for command in ["build", "check", "fmt", "convert", "ir", "params", "explain", "completions"] {
        assert!(help.out().contains(command), "{command}");
        assert_eq!(desk.kake(&[command, "--help"]).status(), 0);
    }
    assert_eq!(desk.kake(&["--version"]).out(), format!("kake {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn what_the_scene_reads_is_not_overwritten() {
    let desk = Desk::new();
    desk.quietly(&["build", "scene.kake", "-o", "light.png"]);
    let light = desk.get("light.png");
    desk.put(
        "traced.kake",
        "canvas { size: (12mm, 12mm) }
tone shade { place: grid(spacing: 3mm) fill: lines(pitch: 1mm) k: 4 * image(\"light.png\", fit: canvas) }
paint canvas with shade
",
    );
    desk.kake(&["build", "traced.kake", "-o", "light.png"]).refused(2, "light.png is read by the scene");
    assert_eq!(desk.get("light.png"), light);
    desk.kake(&["build", "light.png", "-o", "light.png", "--watch"]).refused(2, "built again for ever");
    assert_eq!(desk.get("light.png"), light);
    desk.quietly(&["build", "light.png", "-o", "light.png"]);
}

#[cfg(unix)]
#[test]
fn pipes_are_not_waited_for() {
    let desk = Desk::new();
    let made = Command::new("mkfifo").arg(desk.path("pipe.kake")).status().expect("there are pipes");
    assert!(made.success());
    for arguments in [&["check", "pipe.kake"][..], &["build", "pipe.kake", "--watch"], &["preview", "pipe.kake"]] {
        desk.kake(arguments).refused(3, "it is not a file");
    }
    desk.kake(&["check", "/dev/zero"]).refused(3, "it is not a file");
}

#[test]
fn every_command_has_a_manual_page() {
    let desk = Desk::new();
    let page = desk.kake(&["man"]).out();
    assert!(page.starts_with(".ie") || page.contains(".TH KAKE 1"), "{page}");
    assert!(page.contains("Exit status"), "{page}");
    assert_eq!(desk.kake(&["man", "-o", "share/man1"]).status(), 0);
    let text = |file: &str| String::from_utf8(desk.get(file)).expect("pages are UTF-8");
    assert_eq!(text("share/man1/kake.1"), page);
    let help = desk.kake(&["--help"]).out();
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let mut count = 0;
    for command in commands.filter(|line| line.starts_with("  ") && !line.starts_with("   ")) {
        let name = command.split_whitespace().next().expect("a command has a name");
        if name != "help" {
            assert!(text(&format!("share/man1/kake-{name}.1")).contains("SYNOPSIS"), "{name}");
            count += 1;
        }
    }
    assert!(count > 10);
    desk.put("file", "");
    assert_eq!(desk.kake(&["man", "-o", "file/below"]).status(), 3);
}

#[test]
fn pictures_do_not_depend_on_where_they_are_built() {
    let desk = Desk::new();
    desk.put("deep/er/scene.kake", SCENE);
    desk.quietly(&["build", "scene.kake", "-o", "a.svg"]);
    desk.quietly(&["build", "deep/er/scene.kake", "-o", "b.svg"]);
    desk.quietly(&["build", desk.path("scene.kake").to_str().expect("paths are UTF-8"), "-o", "c.svg"]);
    assert!(desk.get("a.svg") == desk.get("b.svg"));
    assert!(desk.get("a.svg") == desk.get("c.svg"));
}
