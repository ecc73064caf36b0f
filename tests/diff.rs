//! `kake diff`: two files, revisions that the real git holds, and git calling it as a driver and as a tool.

#![allow(clippy::print_stderr)]

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const TONES: &str =
    "tone plain(tile: length = 3mm) { place: grid(spacing: tile) fill: lines(pitch: 1mm, pen: 0.2mm) }\n";
const SCENE: &str = "edition 1
canvas { size: (12mm, 12mm), dpi: 150 }
seed 3
import \"tones.kake\"
/// The side of a tile.
param tile = 3mm in 1mm .. 6mm
paint canvas with plain(tile: tile) as \"ground\"
paint circle(center: (6mm, 6mm), radius: 4mm) with plain(tile: 2mm) as \"disc\"
";

/// The program, quoted for the shell that git runs commands in.
const KAKE: &str = concat!("\"", env!("CARGO_BIN_EXE_kake"), "\"");

struct Desk(TempDir);

struct Ran(Output);

impl Ran {
    #[track_caller]
    fn ends(&self, status: i32) -> String {
        assert_eq!(self.0.status.code(), Some(status), "{}\n{}", self.out(), self.err());
        assert!(!self.err().contains("panicked"), "{}", self.err());
        self.out()
    }

    fn out(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    fn err(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    /// What is said in JSON, of pictures that differ or not.
    #[track_caller]
    fn json(&self, status: i32) -> Value {
        serde_json::from_str(&self.ends(status)).expect("it prints JSON")
    }
}

impl Desk {
    /// A folder with a scene.
    fn new() -> Self {
        let desk = Self(TempDir::new().expect("there is room for temporary files"));
        desk.put("scene.kake", SCENE);
        desk.put("tones.kake", TONES);
        desk
    }

    /// The same under version control, with the driver set up; none where there is no git.
    fn with_git() -> Option<Self> {
        if Command::new("git").arg("--version").output().is_err() {
            eprintln!("there is no git program: what `kake diff` reads from git is not tested");
            return None;
        }
        let desk = Self::new();
        desk.put(".gitattributes", "*.kake diff=kake\n");
        desk.git(&["init", "-q", "."]).ends(0);
        desk.git(&["config", "diff.kake.command", &format!("{KAKE} diff")]).ends(0);
        desk.commit("first");
        Some(desk)
    }

    fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    fn put(&self, file: &str, text: &str) {
        let path = self.path(file);
        fs::create_dir_all(path.parent().expect("it lies in the folder")).expect("folders can be made");
        fs::write(path, text).expect("files can be written");
    }

    /// Replaces a part of a file.
    fn edit(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(file)).expect("it is there");
        assert!(text.contains(from), "{file} holds no {from}");
        self.put(file, &text.replace(from, to));
    }

    fn run(&self, program: &str, arguments: &[&str], set: &[(&str, &str)]) -> Ran {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(self.0.path());
        for (name, _) in std::env::vars_os() {
            // Nothing of whoever runs the tests, a hook of git perhaps, reaches the repository of a test.
            if name.to_string_lossy().starts_with("GIT_") {
                command.env_remove(name);
            }
        }
        for (name, value) in [
            ("HOME", self.0.path().to_str().expect("it is UTF-8")),
            ("GIT_CONFIG_NOSYSTEM", "1"),
            ("GIT_CONFIG_GLOBAL", "/dev/null"),
            ("GIT_AUTHOR_NAME", "a"),
            ("GIT_AUTHOR_EMAIL", "a@example.org"),
            ("GIT_COMMITTER_NAME", "a"),
            ("GIT_COMMITTER_EMAIL", "a@example.org"),
        ] {
            command.env(name, value);
        }
        Ran(command.envs(set.iter().copied()).output().expect("the program starts"))
    }

    fn kake(&self, arguments: &[&str]) -> Ran {
        self.run(env!("CARGO_BIN_EXE_kake"), &[&["diff"], arguments].concat(), &[])
    }

    fn git(&self, arguments: &[&str]) -> Ran {
        self.run("git", arguments, &[])
    }

    fn commit(&self, message: &str) {
        self.git(&["add", "-A"]).ends(0);
        self.git(&["commit", "-q", "-m", message]).ends(0);
    }
}

#[test]
fn the_same_picture_ends_with_0_and_another_with_1() {
    let desk = Desk::new();
    desk.put("other.kake", &format!("// Only words.\n{SCENE}"));
    assert!(desk.kake(&["scene.kake", "scene.kake"]).ends(0).contains("nothing changed"));
    assert!(desk.kake(&["scene.kake", "other.kake"]).ends(0).contains("only the text changed"));
    desk.edit("other.kake", "radius: 4mm", "radius: 5mm");
    desk.edit("other.kake", "size: (12mm, 12mm)", "size: (15mm, 12mm)");
    let said = desk.kake(&["scene.kake", "other.kake"]).ends(1);
    assert!(said.contains("the pictures differ") && said.contains("12mm x 12mm → 15mm x 12mm"), "{said}");
    assert!(!said.contains('\x1b'), "no colours but on a terminal: {said}");
}

#[test]
fn findings_as_data() {
    let desk = Desk::new();
    desk.put(
        "other.kake",
        &SCENE.replace("param tile = 3mm", "param tile = 4mm").replace("as \"disc\"", "as \"moon\""),
    );
    let found = desk.kake(&["scene.kake", "other.kake", "--format", "json"]).json(1);
    assert_eq!(found["same"], false);
    assert_eq!(found["params"], serde_json::json!([{ "name": "tile", "old": "3mm", "new": "4mm" }]));
    assert_eq!(found["canvas"], serde_json::json!([]));
    let [ground, moon] = [0, 1].map(|i| &found["paints"][i]);
    assert_eq!((&ground["change"], &moon["change"]), (&"changed".into(), &"renamed".into()));
    assert_eq!(moon["was"], "disc");
    assert_eq!(moon["tiles"]["moved"], 0);
    assert_eq!(
        (&ground["tiles"]["went"].as_u64().map(|went| went > 0), &ground["tiles"]["layers"]),
        (&Some(true), &0.into())
    );
    assert!(ground["metrics"].as_array().is_some_and(|metrics| metrics.iter().any(|metric| metric["name"] == "edges")));
    assert!(found["pixels"]["share"].as_f64().is_some_and(|share| share > 0.0 && share < 1.0));
    assert!(found["old"]["fingerprint"].as_str().is_some_and(|print| print.starts_with("sha256:")));
    // Set alike, both are the same but for the name.
    let found = desk.kake(&["scene.kake", "other.kake", "--set", "tile=2mm", "--format", "json"]).json(0);
    assert_eq!((&found["same"], &found["paints"][1]["change"]), (&true.into(), &"renamed".into()));
    // With another seed nothing here moves: lattices draw nothing at random but their directions.
    let found = desk.kake(&["scene.kake", "scene.kake", "--seed", "9", "--format", "json"]).json(0);
    assert_eq!(found["params"], serde_json::json!([]));
}

#[test]
fn a_parameter_that_one_side_lacks_is_set_on_the_other() {
    let desk = Desk::new();
    desk.put("older.kake", &SCENE.replace("param tile = 3mm in 1mm .. 6mm", "let tile = 3mm"));
    assert!(desk.kake(&["older.kake", "scene.kake", "--set", "tile=3mm"]).ends(0).contains("no parameter `tile`"));
    let neither = desk.kake(&["older.kake", "scene.kake", "--set", "til=3mm"]);
    neither.ends(1);
    assert!(neither.err().contains("neither scene has a parameter `til`"), "{}", neither.err());
}

#[test]
fn pictures_of_the_difference() {
    let desk = Desk::new();
    desk.put("other.kake", &SCENE.replace("center: (6mm, 6mm)", "center: (8mm, 5mm)"));
    let outputs = ["-o", "{name}.png", "-o", "d.svg", "-o", "d.html"];
    desk.kake(&[&["scene.kake", "other.kake"][..], &outputs].concat()).ends(1);
    let png = fs::read(desk.path("other.png")).expect("{name} is the new scene's");
    let pixels = kakeami::back::png::decode(&png, 1 << 20).expect("it is a PNG");
    assert_eq!((pixels.width, pixels.height), (71, 71));
    let colours: Vec<_> = (0..71 * 71).filter_map(|i| pixels.colour(i % 71, i / 71)).collect();
    assert!(
        colours.iter().any(|c| c.r > c.b.saturating_add(60)) && colours.iter().any(|c| c.b > c.r.saturating_add(60))
    );
    let svg = fs::read_to_string(desk.path("d.svg")).expect("it is text");
    for group in ["went", "came", "stayed"] {
        assert!(svg.contains(&format!("inkscape:label=\"{group}\"")), "{group}");
    }
    let html = fs::read_to_string(desk.path("d.html")).expect("it is text");
    assert!(!html.contains("http://") && !html.contains("https://"), "it works without a network");
    assert_eq!(html.matches("data:image/svg+xml;base64,").count(), 2);
    // The same pictures can be looked at too, and outputs never replace a scene.
    desk.kake(&["scene.kake", "scene.kake", "-o", "same.html"]).ends(0);
    assert!(desk.path("same.html").is_file());
    for wrong in [&["-o", "d.pdf"][..], &["-o", "scene.kake"], &["-o", "-"]] {
        desk.kake(&[&["scene.kake", "other.kake"][..], wrong].concat()).ends(2);
    }
    desk.kake(&["scene.kake", "other.kake", "-o", "no/such/folder.png"]).ends(3);
    // A picture that holds its scene is a side like any other.
    desk.run(env!("CARGO_BIN_EXE_kake"), &["build", "scene.kake", "--set", "tile=4mm"], &[]).ends(0);
    let found = desk.kake(&["scene.svg", "scene.kake", "--format", "json"]).json(1);
    assert_eq!(found["params"][0]["old"], "4mm");
}

#[test]
fn a_side_at_fault_leaves_the_other() {
    let desk = Desk::new();
    desk.put("broken.kake", &SCENE.replace("plain(tile: 2mm)", "plane(tile: 2mm)"));
    let ran = desk.kake(&["scene.kake", "broken.kake", "-o", "d.png"]);
    assert!(ran.ends(1).contains("the new scene does not compile; the old one has 2 paints"), "{}", ran.out());
    assert!(ran.err().contains("did you mean") && ran.err().contains("broken.kake"), "{}", ran.err());
    assert!(!desk.path("d.png").exists());
    let found = desk.kake(&["broken.kake", "scene.kake", "--format", "json"]).json(1);
    assert_eq!(
        (&found["old"]["fingerprint"], &found["old"]["diagnostics"][0]["severity"]),
        (&Value::Null, &"error".into())
    );
    desk.kake(&["scene.kake", "none.kake"]).ends(3);
    desk.kake(&["scene.kake", "."]).ends(2);
    desk.kake(&["scene.kake"]).ends(2);
    desk.kake(&["-", "-"]).ends(2);
}

const LIBRARY: &str = "edition 1
/// Rows of strokes.
tone wall(
  /// The side of a tile.
  tile: length = 3mm,
  pen: length = 0.2mm,
) { place: grid(spacing: tile) fill: lines(pitch: 1mm, pen: pen) }
tone old(tile: length = 2mm) { place: grid(spacing: tile) fill: lines(pitch: 1mm, pen: 0.2mm) }
";

#[test]
fn a_library_is_told_of_by_its_tones() {
    let desk = Desk::new();
    desk.put("old.kake", LIBRARY);
    desk.put("new.kake", LIBRARY);
    assert!(desk.kake(&["old.kake", "new.kake"]).ends(0).contains("nothing changed"));
    // Comments and empty lines make no picture.
    desk.edit("new.kake", "/// The side of a tile.", "// Why not.\n\n  /// How wide a tile is.");
    let said = desk.kake(&["old.kake", "new.kake"]).ends(0);
    assert!(said.contains("only the text changed") && said.contains("\n+  /// How wide a tile is.\n"), "{said}");
    desk.edit(
        "new.kake",
        "tile: length = 3mm",
        "tile: length = 4mm,\n  /// How far strokes shake.\n  shake: length = 0mm",
    );
    desk.edit("new.kake", "  pen: length = 0.2mm,\n", "");
    desk.edit("new.kake", "pen: pen)", "pen: 0.3mm)");
    desk.edit("new.kake", "tone old", "tone fresh");
    let ran = desk.kake(&["old.kake", "new.kake", "-o", "d.png"]);
    let said = ran.ends(1);
    for words in [
        "the tones differ: 1 changed, 1 came, 1 went",
        "draws nothing by itself",
        "tone `wall`: changed  Rows of strokes.",
        "  tile       length 3mm → length 4mm  How wide a tile is.",
        "  shake      length 0mm came  How far strokes shake.",
        "  pen        length 0.2mm went",
        "  fill       lines(pitch: 1mm, pen: pen) → lines(pitch: 1mm, pen: 0.3mm)",
        "tone `fresh` came\n  tile       length 2mm",
        "tone `old` went",
        "--- old.kake\n+++ new.kake\n@@ ",
        "\n-  pen: length = 0.2mm,\n",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(!ran.err().contains("kake::empty") && ran.err().contains("neither draws anything"), "{}", ran.err());
    let found = desk.kake(&["old.kake", "new.kake", "--format", "json"]).json(1);
    assert_eq!((&found["old"]["draws_nothing"], &found["new"]["diagnostics"]), (&true.into(), &serde_json::json!([])));
    assert_eq!((&found["declared"][0]["name"], &found["declared"][0]["change"]), (&"wall".into(), &"changed".into()));
    // Beside a scene that draws, and beside one that does not compile.
    let said = desk.kake(&["old.kake", "scene.kake"]).ends(1);
    assert!(said.contains("the old scene draws nothing by itself; the new one has 2 paints"), "{said}");
    desk.put("broken.kake", "edition 1\nlet a = b\n");
    let ran = desk.kake(&["old.kake", "broken.kake"]);
    assert!(ran.ends(1).contains("the new scene does not compile; the old one draws nothing"), "{}", ran.out());
    assert!(ran.err().contains("broken.kake") && !ran.err().contains("old.kake:"), "{}", ran.err());
}

#[test]
fn what_a_library_imports_may_change_pictures() {
    let desk = Desk::new();
    desk.put("a/lib.kake", "edition 1\nimport \"base.kake\"\n");
    desk.put("b/lib.kake", "edition 1\nimport \"base.kake\"\n");
    desk.put("a/base.kake", LIBRARY);
    desk.put("b/base.kake", &LIBRARY.replace("Rows", "Lines"));
    desk.kake(&["a/lib.kake", "b/lib.kake"]).ends(0);
    desk.edit("b/base.kake", "pitch: 1mm", "pitch: 2mm");
    let said = desk.kake(&["a/lib.kake", "b/lib.kake"]).ends(1);
    assert!(said.contains("what is imported from `base.kake`: changed"), "{said}");
}

#[test]
fn git_shows_the_lines_of_a_library() {
    let Some(desk) = Desk::with_git() else { return };
    desk.put("gone.kake", LIBRARY);
    desk.commit("a library");
    desk.edit("tones.kake", "pitch: 1mm", "pitch: 0.5mm");
    desk.put("fresh.kake", LIBRARY);
    desk.git(&["add", "-N", "."]).ends(0);
    // What is removed before is removed from the index too.
    fs::remove_file(desk.path("gone.kake")).expect("it is there");
    let ran = desk.git(&["diff", "--no-renames"]);
    let said = ran.ends(0);
    assert_eq!(ran.err(), "");
    for words in
        ["the file is new: 2 tones", "the file went: 2 tones", "\n-tone plain", "\n+tone plain", "\n-tone wall("]
    {
        assert!(said.contains(words), "{words}: {said}");
    }
    let coloured = desk.run("git", &["diff"], &[("GIT_PAGER_IN_USE", "1"), ("TERM", "xterm")]).ends(0);
    assert!(coloured.contains("\x1b[36m@@ ") && coloured.contains("\x1b[32m+tone plain"), "{coloured}");
}

#[test]
fn chief_measures_are_told_and_the_rest_counted() {
    let desk = Desk::new();
    desk.put("other.kake", &SCENE.replace("radius: 4mm", "radius: 5mm"));
    let said = desk.kake(&["scene.kake", "other.kake", "-o", "d.html"]).ends(1);
    assert!(said.contains("changed; `--format json` has them") && !said.contains("edges"), "{said}");
    let found = desk.kake(&["scene.kake", "other.kake", "--format", "json"]).json(1);
    let metrics = found["paints"][1]["metrics"].as_array().expect("it is a list");
    let chief = ["e_contrast", "e_share", "h_angle", "xi", "c_cov", "u_vor", "density_contrast", "grain"];
    let others = metrics.iter().filter(|metric| !chief.contains(&metric["name"].as_str().unwrap_or_default())).count();
    assert!(others > 0 && said.contains(&format!(" {others} more measures changed")), "{others}: {said}");
    let page = fs::read_to_string(desk.path("d.html")).expect("it is text");
    assert!(page.contains("<h1>The pictures differ") && page.contains(&format!("<summary>{others} more measures")));
    assert!(page.contains("tiles inside") && page.contains("tiles placed"));
    assert_eq!(page.matches("class=\"sheet").count(), 2, "both pictures have one width");
    let print = found["new"]["fingerprint"].as_str().expect("it is a text");
    assert!(page.contains(&format!("title=\"{print}\">{}<", &print[..19])), "{print}");
}

#[test]
fn a_revision_needs_a_path() {
    let Some(desk) = Desk::with_git() else { return };
    let ran = desk.kake(&["HEAD", "scene.kake"]);
    ran.ends(3);
    assert!(ran.err().contains("a revision needs a path: `HEAD:scene.kake`"), "{}", ran.err());
    let ran = desk.kake(&["HEADLESS", "scene.kake"]);
    ran.ends(3);
    assert!(!ran.err().contains("revision"), "{}", ran.err());
}

#[test]
fn revisions_are_read_with_their_imports() {
    let Some(desk) = Desk::with_git() else { return };
    desk.edit("tones.kake", "pitch: 1mm", "pitch: 0.5mm");
    let said = desk.kake(&["HEAD:scene.kake", "scene.kake"]).ends(1);
    assert!(said.contains("marks") && !said.contains("note:"), "{said}");
    desk.kake(&["HEAD:scene.kake", ":scene.kake"]).ends(0);
    desk.git(&["add", "-A"]).ends(0);
    desk.kake(&["HEAD:scene.kake", ":scene.kake"]).ends(1);
    desk.kake(&["scene.kake", ":scene.kake"]).ends(0);
    desk.commit("second");
    desk.kake(&["HEAD^{/first}:scene.kake", "HEAD~1:scene.kake"]).ends(0);
    desk.kake(&["HEAD~1:scene.kake", "HEAD:./scene.kake"]).ends(1);
    for (wrong, words) in [
        ("HEAD~9:scene.kake", "git knows no revision `HEAD~9`"),
        ("--output=x:scene.kake", "differences end in"),
        ("HEAD:sub/none.kake", "there is no file `sub/none.kake` there"),
        ("HEAD:../../scene.kake", "leads out of the repository"),
    ] {
        let ran = desk.kake(&[wrong, "scene.kake"]);
        assert!(ran.0.status.code().is_some_and(|status| status > 1), "{wrong}");
        assert!(ran.err().contains(words), "{wrong}: {}", ran.err());
    }
    let ran = desk.kake(&["--", "--output=x:scene.kake", "scene.kake"]);
    ran.ends(3);
    assert!(ran.err().contains("git knows no revision"), "{}", ran.err());
    assert!(!desk.path("x").exists() && !desk.path("x:scene.kake").exists());
    let ran = desk.run(env!("CARGO_BIN_EXE_kake"), &["diff", "HEAD:scene.kake", "scene.kake"], &[("PATH", "")]);
    ran.ends(3);
    assert!(ran.err().contains("git program"), "{}", ran.err());
}

#[cfg(unix)]
#[test]
fn links_in_a_revision_stay_in_it() {
    let Some(desk) = Desk::with_git() else { return };
    desk.put("shared/real.kake", TONES);
    fs::remove_file(desk.path("tones.kake")).expect("it is there");
    std::os::unix::fs::symlink("shared/real.kake", desk.path("tones.kake")).expect("links can be made");
    desk.commit("linked");
    desk.kake(&["HEAD:scene.kake", "HEAD~1:scene.kake"]).ends(0);
    fs::remove_file(desk.path("tones.kake")).expect("it is there");
    std::os::unix::fs::symlink("/etc/passwd", desk.path("tones.kake")).expect("links can be made");
    desk.commit("led astray");
    let ran = desk.kake(&["HEAD:scene.kake", "HEAD~1:scene.kake"]);
    ran.ends(1);
    assert!(ran.err().contains("leads out"), "{}", ran.err());
}

#[test]
fn a_driver_shows_what_changed_and_git_goes_on() {
    let Some(desk) = Desk::with_git() else { return };
    desk.edit("scene.kake", "radius: 4mm", "radius: 5mm");
    desk.edit("tones.kake", "pitch: 1mm", "pitch: 0.5mm");
    desk.put("a new one.kake", SCENE);
    desk.git(&["add", "-N", "."]).ends(0);
    let ran = desk.git(&["diff"]);
    let said = ran.ends(0);
    assert!(said.contains("imports and images of the old scene are those of HEAD"), "{said}");
    assert!(said.contains("the scene is new: 2 paints"), "{said}");
    // What draws nothing by itself is told of, and is no fault.
    assert!(said.contains("tone `plain`: changed") && said.contains("draws nothing by itself"), "{said}");
    assert_eq!(ran.err(), "");
    // Git shows no lines where a driver is set.
    assert!(said.contains("\n+paint circle(center: (6mm, 6mm), radius: 5mm)"), "{said}");
    // Without the change of the import the old side has the old import still.
    let marks = |said: &str| said.matches("→").count();
    assert!(marks(&said) > 2);
    desk.commit("second");
    desk.git(&["mv", "scene.kake", "renamed.kake"]).ends(0);
    desk.edit("renamed.kake", "seed 3", "seed 4");
    desk.git(&["rm", "-q", "a new one.kake"]).ends(0);
    desk.git(&["add", "-A"]).ends(0);
    let said = desk.git(&["diff", "-M", "--cached"]).ends(0);
    assert!(
        said.contains("the scene went: 2 paints")
            && said.contains("old  scene.kake")
            && said.contains("new  renamed.kake"),
        "{said}"
    );
    desk.commit("third");
    let said = desk.git(&["log", "-p", "--ext-diff", "-M", "--format=%s"]).ends(0);
    assert!(said.contains("third") && said.contains("first") && said.contains("seed       3 → 4"), "{said}");
    // A version that only history holds brings the imports of its time.
    let said = desk.git(&["diff", "HEAD~2", "HEAD~1", "--", "scene.kake"]).ends(0);
    assert!(said.contains("imports and images of the old scene are those of"), "{said}");
    assert!(!said.contains("old scene are those of the working tree"), "{said}");
}

#[test]
fn a_driver_says_by_its_status_what_it_is_trusted_to() {
    let Some(desk) = Desk::with_git() else { return };
    desk.edit("scene.kake", "seed 3", "seed 3 // the same");
    // git 2.46 and newer ask a driver that is trusted; older ones only know that it may not fail.
    desk.git(&["diff", "--exit-code"]).0.status.code().expect("it ends by itself");
    desk.edit("scene.kake", "radius: 4mm", "radius: 5mm");
    desk.git(&["diff"]).ends(0);
    let seven = |set: &[(&str, &str)]| {
        let hex = "0".repeat(40);
        let old = desk.path("old.kake");
        desk.put("old.kake", SCENE);
        let old = old.to_str().expect("it is UTF-8");
        let arguments = ["diff", "scene.kake", old, &hex, "100644", "scene.kake", &hex, "100644"];
        desk.run(env!("CARGO_BIN_EXE_kake"), &arguments, set)
    };
    seven(&[]).ends(0);
    desk.git(&["config", "diff.kake.trustExitCode", "true"]).ends(0);
    seven(&[]).ends(1);
    desk.git(&["config", "--unset", "diff.kake.trustExitCode"]).ends(0);
    desk.git(&["config", "--unset", "diff.kake.command"]).ends(0);
    let external = ("GIT_EXTERNAL_DIFF", "kake diff");
    seven(&[external]).ends(0);
    seven(&[external, ("GIT_EXTERNAL_DIFF_TRUST_EXIT_CODE", "true")]).ends(1);
    seven(&[external, ("GIT_EXTERNAL_DIFF_TRUST_EXIT_CODE", "0")]).ends(0);
}

#[test]
fn a_tool_is_given_copies() {
    let Some(desk) = Desk::with_git() else { return };
    // Where a driver is set up git calls that before any tool.
    desk.git(&["config", "--unset", "diff.kake.command"]).ends(0);
    desk.edit("scene.kake", "radius: 4mm", "radius: 5mm");
    let ran = desk.git(&["difftool", "--no-prompt", "-x", &format!("{KAKE} diff -o {{name}}.png"), "--", "scene.kake"]);
    let said = ran.ends(0);
    assert!(said.contains("the pictures differ") && said.contains("of HEAD"), "{said}\n{}", ran.err());
    assert!(desk.path("scene.png").is_file());
    let ran = desk.git(&["difftool", "--no-prompt", "--trust-exit-code", "-x", &format!("{KAKE} diff")]);
    assert_ne!(ran.0.status.code(), Some(0), "a tool that is trusted says that pictures differ");
}

#[cfg(unix)]
#[test]
fn no_path_becomes_an_option_or_a_command() {
    let Some(desk) = Desk::with_git() else { return };
    let names = ["-o.kake", "--only x.kake", "a 'b' \"c\" $(touch gone).kake", "süß/ünder `x`;&.kake", ":colon.kake"];
    for name in names {
        desk.put(name, &SCENE.replace("import \"tones.kake\"\n", TONES));
    }
    desk.commit("strange");
    for name in names {
        desk.edit(name, "radius: 4mm", "radius: 5mm");
    }
    let before = || {
        let mut files: Vec<_> = fs::read_dir(desk.0.path())
            .expect("it can be read")
            .map(|file| file.expect("it can be read").file_name())
            .collect();
        files.sort();
        files
    };
    let files = before();
    for command in [&["diff"][..], &["difftool", "--no-prompt", "-x", &format!("{KAKE} diff")]] {
        let ran = desk.git(command);
        let said = ran.ends(0);
        assert_eq!(said.matches("the pictures differ").count(), names.len(), "{said}\n{}", ran.err());
        for name in names {
            assert!(said.contains(name), "{name}: {said}");
        }
        // Where a driver is set up git calls that before any tool.
        desk.git(&["config", "--unset", "diff.kake.command"]);
    }
    assert_eq!(before(), files, "nothing was run and nothing written");
}

#[test]
fn a_scene_at_fault_does_not_stop_git() {
    let Some(desk) = Desk::with_git() else { return };
    desk.edit("scene.kake", "with plain(tile: tile)", "with plane(tile: tile)");
    let ran = desk.git(&["diff"]);
    assert!(ran.ends(0).contains("the new scene does not compile"), "{}", ran.out());
    assert!(ran.err().contains("plane"), "{}", ran.err());
}

#[test]
fn a_path_that_is_not_merged_is_said_to_be() {
    let Some(desk) = Desk::with_git() else { return };
    desk.git(&["checkout", "-q", "-b", "other"]).ends(0);
    desk.edit("scene.kake", "seed 3", "seed 4");
    desk.commit("other");
    desk.git(&["checkout", "-q", "-"]).ends(0);
    desk.edit("scene.kake", "seed 3", "seed 5");
    desk.commit("own");
    assert_ne!(desk.git(&["merge", "-q", "other"]).0.status.code(), Some(0));
    assert!(desk.git(&["diff", "--cached"]).ends(0).contains("is not merged"));
}

#[test]
fn a_library_in_a_folder_is_found_from_anywhere() {
    let Some(desk) = Desk::with_git() else { return };
    desk.put("book/kake.toml", "[library]\nname = \"book\"\nversion = \"1.0.0\"\nedition = 1\n");
    desk.put("book/tones/plain.kake", TONES);
    desk.put("book/pages/one.kake", &SCENE.replace("\"tones.kake\"", "\"../tones/plain.kake\""));
    desk.commit("a book");
    desk.edit("book/tones/plain.kake", "pitch: 1mm", "pitch: 0.5mm");
    desk.kake(&["HEAD:book/pages/one.kake", "book/pages/one.kake"]).ends(1);
    let inside = Command::new(env!("CARGO_BIN_EXE_kake"))
        .args(["diff", "HEAD:./one.kake", "one.kake"])
        .current_dir(desk.path("book/pages"))
        .output()
        .expect("the program starts");
    Ran(inside).ends(1);
    let wrong = Command::new(env!("CARGO_BIN_EXE_kake"))
        .args(["diff", "HEAD:one.kake", "one.kake"])
        .current_dir(desk.path("book/pages"))
        .output()
        .expect("the program starts");
    let wrong = Ran(wrong);
    wrong.ends(3);
    assert!(wrong.err().contains("did you mean `HEAD:book/pages/one.kake`"), "{}", wrong.err());
}
