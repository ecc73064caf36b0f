//! Libraries as artists meet them: laid out, tested, changed, accepted, depended on, locked; and libraries that are broken or
//! hostile.

use std::fs;

use serde_json::Value;

use crate::cli::Desk;

/// What the program said, and how it ended.
struct Said {
    status: i32,
    stdout: String,
    stderr: String,
}

impl Said {
    fn lines(&self) -> Vec<&str> {
        self.stdout.lines().collect()
    }
}

fn kake(desk: &Desk, arguments: &[&str]) -> Said {
    let ran = desk.kake(arguments);
    let said = Said { status: ran.status(), stdout: ran.out(), stderr: ran.err() };
    assert!(!said.stderr.contains("panicked"), "{}", said.stderr);
    said
}

/// A folder with a new library `ink` in it.
fn desk() -> Desk {
    let desk = Desk::new();
    let made = kake(&desk, &["new", "ink"]);
    assert_eq!(made.status, 0, "{}", made.stderr);
    desk
}

/// Replaces a text in a file, where it stands.
fn edit(desk: &Desk, file: &str, old: &str, new: &str) {
    let text = String::from_utf8(desk.get(file)).expect("it is text");
    assert!(text.contains(old), "{file} has no `{old}`");
    desk.put(file, text.replace(old, new));
}

/// A manifest with these dependencies.
fn manifest(name: &str, dependencies: &[(&str, &str)]) -> String {
    let list: String = dependencies.iter().map(|(name, path)| format!("{name} = {{ path = \"{path}\" }}\n")).collect();
    format!("[library]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = 1\n\n[dependencies]\n{list}")
}

/// A scene that paints with the tone of an import.
fn scene(import: &str, tone: &str) -> String {
    format!(
        "import \"{import}\"\ncanvas {{ size: (20mm, 15mm), dpi: 150 }}\nseed 1\npaint canvas with {tone} as \"sheet\"\n"
    )
}

/// A small tone of a pen.
fn tone(name: &str, pen: &str) -> String {
    format!("tone {name} {{ place: grid(spacing: 5mm) fill: lines(pitch: 1mm, pen: {pen}) }}\n")
}

/// The pins of a library, text by text and picture by picture.
fn pins(desk: &Desk) -> Vec<(String, Vec<u8>)> {
    let mut pins: Vec<(String, Vec<u8>)> = fs::read_dir(desk.path("ink/pins"))
        .expect("the pins are there")
        .map(|entry| {
            let path = entry.expect("it can be read").path();
            (
                path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
                fs::read(&path).expect("it is a file"),
            )
        })
        .collect();
    pins.sort();
    pins
}

#[test]
fn a_newcomers_way() {
    let desk = desk();
    let first = kake(&desk, &["test", "ink"]);
    assert_eq!(
        (first.status, first.lines()),
        (0, vec!["same      mist", "same      ripple", "same      weave", "ink 0.1.0: 3 swatches: 3 same",])
    );
    let formed =
        kake(&desk, &["fmt", "--check", "ink/tones/weave.kake", "ink/tones/mist.kake", "ink/tones/ripple.kake"]);
    assert_eq!(formed.status, 0, "{}", formed.stdout);

    edit(&desk, "ink/tones/weave.kake", "pitch: length = 0.7mm", "pitch: length = 0.8mm");
    let before = pins(&desk);
    let second = kake(&desk, &["test", "ink", "--report", "report"]);
    assert_eq!(second.status, 1);
    assert!(
        second.stdout.contains("changed   weave   ") && second.stdout.contains(" pixels differ ("),
        "{}",
        second.stdout
    );
    assert!(second.stdout.contains("            marks "), "{}", second.stdout);
    assert!(second.stdout.contains("same      mist"));
    assert_eq!(pins(&desk), before, "a test changes no pin");
    let page = String::from_utf8(desk.get("ink/.kake/review.html")).expect("pages are UTF-8");
    assert_eq!(page.matches("<figure>").count(), 3, "old, new and difference");
    let text = String::from_utf8(desk.get("report/report.md")).expect("reports are UTF-8");
    for kind in ["old", "new", "difference"] {
        let file = format!("pictures/weave-{kind}.png");
        assert!(text.contains(&file) && desk.get(&format!("report/{file}")).starts_with(b"\x89PNG"), "{file}");
    }
    assert_eq!(desk.get("report/review.html"), page.into_bytes());
    let junit = String::from_utf8(desk.get("report/junit.xml")).expect("JUnit is UTF-8");
    assert!(junit.contains("tests=\"3\" skipped=\"0\" failures=\"1\" errors=\"0\""), "{junit}");

    assert_eq!(kake(&desk, &["test", "ink", "--accept"]).status, 0);
    assert!(!desk.path("ink/.kake/review.html").exists(), "there is nothing to be judged any more");
    assert_eq!(kake(&desk, &["test", "ink"]).status, 0);
    let changed: Vec<String> =
        pins(&desk).into_iter().filter(|pin| !before.contains(pin)).map(|(name, _)| name).collect();
    assert_eq!(changed, ["weave.png", "weave.toml"], "what is the same stays as it is");
}

#[test]
fn pins_hold_the_drawing_and_nothing_else() {
    let desk = desk();
    // Comments, form and files' names are no part of a drawing.
    edit(&desk, "ink/tones/mist.kake", "// Airy tones", "// Thin   tones");
    edit(&desk, "ink/swatches/mist.kake", "canvas {", "canvas   { /* as before */");
    fs::rename(desk.path("ink/tones/weave.kake"), desk.path("ink/tones/woven.kake")).expect("it can be renamed");
    edit(&desk, "ink/swatches/weave.kake", "../tones/weave.kake", "../tones/woven.kake");
    let same = kake(&desk, &["test", "ink"]);
    assert_eq!(same.status, 0, "{}", same.stdout);

    // A shift by a hundredth of a millimetre is one, though nobody sees it.
    let scene = |left: &str| {
        format!(
            "canvas {{ size: (600mm, 600mm) }}\nregion bar = rect(at: ({left}, 10mm), size: (1mm, 1mm))\noutline bar pen 0.2mm\n"
        )
    };
    desk.put("ink/swatches/bar.kake", scene("10mm"));
    assert_eq!(kake(&desk, &["test", "ink", "--accept"]).status, 0);
    desk.put("ink/swatches/bar.kake", scene("10.01mm"));
    let moved = kake(&desk, &["test", "ink", "--filter", "bar"]);
    assert_eq!(moved.status, 1);
    let words =
        "changed   bar  the drawing changed by so little that neither the small picture nor any figure shows it";
    assert_eq!(moved.lines().first(), Some(&words));
}

#[test]
fn broken_swatches_leave_the_others_alone() {
    let desk = desk();
    desk.put("ink/swatches/bad.kake", "canvas { size: (20mm, 20mm) }\npaint canvas with nothing_known\n");
    desk.put("ink/swatches/sub/new.kake", scene("../../tones/ripple.kake", "ripple"));
    fs::rename(desk.path("ink/pins/mist.toml"), desk.path("ink/pins/gone.toml")).expect("it can be renamed");
    fs::rename(desk.path("ink/pins/mist.png"), desk.path("ink/pins/gone.png")).expect("it can be renamed");
    desk.put("ink/pins/weave.toml", "<<<<<<< HEAD\n");
    desk.put("ink/pins/ripple.png", "no picture");
    let ran = kake(&desk, &["test", "ink"]);
    assert_eq!(ran.status, 1);
    assert_eq!(
        ran.lines(),
        [
            "broken    bad      it does not compile",
            "orphan    gone     there is a pin, but no swatch of this name",
            "new       mist     it has no pin yet",
            "changed   ripple   the drawing is the same, but the pinned picture is missing or damaged",
            "new       sub/new  it has no pin yet",
            "changed   weave    the pin cannot be read",
            "ink 0.1.0: 5 swatches: 2 changed, 2 new, 1 broken, 1 orphan",
        ]
    );
    assert!(ran.stderr.contains("kake::unknown-tone") && ran.stderr.contains("kake::pin"), "{}", ran.stderr);

    // What does not compile cannot be accepted, and keeps the test from passing.
    let accepted = kake(&desk, &["test", "ink", "--accept"]);
    assert_eq!(accepted.status, 1);
    assert!(accepted.stdout.contains("accepted  sub/new") && accepted.stdout.contains("removed   gone"));
    assert!(desk.path("ink/pins/sub/new.png").is_file() && !desk.path("ink/pins/gone.toml").exists());
    fs::remove_file(desk.path("ink/swatches/bad.kake")).expect("it can be removed");
    assert_eq!(kake(&desk, &["test", "ink"]).status, 0);
}

#[test]
fn what_is_tested_is_chosen() {
    let desk = desk();
    let count = |arguments: &[&str]| {
        let ran = kake(&desk, arguments);
        (ran.status, ran.stdout.lines().count().saturating_sub(1))
    };
    assert_eq!(count(&["test", "ink/swatches/weave.kake"]), (0, 1));
    assert_eq!(count(&["test", "ink/swatches/weave.kake", "ink/swatches", "--jobs", "1"]), (0, 3));
    assert_eq!(count(&["test", "ink", "--filter", "i"]), (0, 2));
    for (arguments, words) in [
        (&["test", "ink", "--filter", "fog"][..], "no swatch has `fog` in its name"),
        (&["test", "ink/tones/weave.kake"], "is no swatch"),
        (&["test", "ink/tones"], "holds no swatches"),
        (&["test", "scene.kake"], "lies in no library"),
    ] {
        let ran = kake(&desk, arguments);
        assert!(ran.status == 2 && ran.stderr.contains(words), "{arguments:?}: {}", ran.stderr);
    }
    assert_eq!(kake(&desk, &["test", "nowhere"]).status, 3);
    desk.put("ink/swatches/weave.toml", "seed = 1\n");
    assert!(kake(&desk, &["test", "ink"]).stderr.contains("have the same pin"));
}

#[test]
fn nothing_is_laid_out_over_what_is_there() {
    let desk = Desk::new();
    desk.put("full/notes.txt", "mine");
    for (arguments, words) in [
        (&["new", "full"][..], "is not empty"),
        (&["new", "std"], "come with the program"),
        (&["new", "my tones"], "`--name NAME`"),
        (&["new", "ink", "--name", "a/b"], "is no name"),
    ] {
        let ran = kake(&desk, arguments);
        assert!(ran.status == 2 && ran.stderr.contains(words), "{arguments:?}: {}", ran.stderr);
    }
    assert_eq!(kake(&desk, &["new", "scene.kake", "--name", "ink"]).status, 3);
    assert!(!desk.path("ink").exists() && desk.get("full/notes.txt") == b"mine");
    fs::create_dir(desk.path("my tones")).expect("folders can be made");
    let made = kake(&desk, &["new", "my tones", "--name", "ink"]);
    assert_eq!((made.status, made.stderr.lines().count()), (0, 3), "{}", made.stderr);
    assert!(String::from_utf8_lossy(&desk.get("my tones/kake.toml")).contains("name = \"ink\""));
    let left = fs::read_dir(desk.path("my tones")).expect("it is there").count();
    assert_eq!(left, 9, "nothing is left over from the making");
}

/// `app` depends on `ink` and on `base`, which `ink` depends on too.
fn diamond() -> Desk {
    let desk = Desk::new();
    desk.put("base/kake.toml", manifest("base", &[]));
    desk.put("base/tones/plain.kake", tone("plain", "0.2mm"));
    desk.put(
        "base/art/bar.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 20 15'><rect width='9' height='9'/></svg>",
    );
    desk.put("base/tones/shapes.kake", "region bar = svg(\"../art/bar.svg\", fit: (0mm, 0mm, 20mm, 15mm))\n");
    desk.put("ink/kake.toml", manifest("ink", &[("ground", "../base")]));
    desk.put("ink/tones/dark.kake", "import \"ground:tones/plain.kake\"\ntone dark = plain with { k: 2 }\n");
    desk.put("app/kake.toml", manifest("app", &[("ink", "../ink"), ("base", "../base")]));
    desk.put(
        "app/swatches/both.kake",
        "import \"ink:tones/dark.kake\"\nimport \"base:tones/plain.kake\"\nimport \"base:tones/shapes.kake\"\n\
         canvas { size: (20mm, 15mm), dpi: 150 }\nseed 1\nparam pen = 0.2mm\n\
         paint bar with dark as \"bar\"\npaint canvas with plain as \"ground\"\n\
         experiment few { seeds: 0 .. 1  factors: { pen: [0.1mm, 0.2mm] } }\n",
    );
    desk
}

#[test]
fn libraries_build_on_libraries() {
    let desk = diamond();
    let built = kake(&desk, &["build", "app/swatches/both.kake", "-o", "a.svg", "-o", "all.png", "--embed", "all"]);
    assert_eq!((built.status, built.stderr.as_str()), (0, ""));
    for arguments in [
        &["check", "app/swatches/both.kake"][..],
        &["ir", "app/swatches/both.kake", "--stage", "tiles"],
        &["metrics", "app/swatches/both.kake"],
        &["params", "app/swatches/both.kake"],
        &["wedge", "app/swatches/both.kake", "dark", "-o", "wedge.svg"],
        &["experiment", "app/swatches/both.kake", "-o", "few"],
    ] {
        let ran = kake(&desk, arguments);
        assert_eq!(ran.status, 0, "{arguments:?}: {}", ran.stderr);
    }
    // Pictures that hold such scenes are built again where no library is.
    desk.put("far/all.png", desk.get("all.png"));
    for folder in ["app", "base", "ink"] {
        fs::remove_dir_all(desk.path(folder)).expect("it can be removed");
    }
    let again = kake(&desk, &["build", "far/all.png", "-o", "b.svg", "--embed", "all"]);
    assert_eq!((again.status, again.stderr.as_str()), (0, ""));
    assert_eq!(desk.get("a.svg"), desk.get("b.svg"));
}

#[test]
fn dependencies_are_locked() {
    let desk = diamond();
    let is_locked = || kake(&desk, &["lock", "app", "--check"]).status;
    assert_eq!(is_locked(), 1, "there is no lock file yet");
    let unlocked = kake(&desk, &["test", "app", "--accept"]);
    assert!(unlocked.status == 1 && unlocked.stdout.contains("fault     the dependencies are not locked"));
    let locked = kake(&desk, &["lock", "app"]);
    assert_eq!((locked.status, is_locked()), (0, 0), "{}", locked.stderr);
    let lock = String::from_utf8(desk.get("app/kake.lock")).expect("locks are UTF-8");
    assert_eq!(lock.matches("[[dependency]]").count(), 2, "each library once: {lock}");
    assert!(lock.contains("name = \"base\"\npath = \"../base\"\nversion = \"0.1.0\"\nsha256 = \""), "{lock}");
    let passed = kake(&desk, &["test", "app"]);
    assert_eq!(passed.status, 0, "{}", passed.stdout);

    // What other programs keep there is no part of a library; everything else is, to the line ends.
    desk.put("base/.git/index", "x");
    assert_eq!(is_locked(), 0);
    edit(&desk, "base/tones/plain.kake", "\n", "\r\n");
    let words = "the files of the dependency `base` are not those that were locked";
    let built = kake(&desk, &["build", "app/swatches/both.kake", "-o", "a.svg"]);
    assert!(
        built.status == 0 && built.stderr.contains(words) && built.stderr.contains("kake::lock"),
        "{}",
        built.stderr
    );
    let checked = kake(&desk, &["check", "app/swatches/both.kake", "--format", "json"]);
    let said: Value = serde_json::from_str(&checked.stdout).expect("it is JSON");
    assert_eq!((checked.status, said[0]["code"].as_str()), (0, Some("kake::lock")), "{said}");
    let tested = kake(&desk, &["test", "app"]);
    assert!(tested.status == 1 && tested.stdout.contains(&format!("fault     {words}")), "{}", tested.stdout);
    assert_eq!((kake(&desk, &["lock", "app"]).status, kake(&desk, &["test", "app"]).status), (0, 0));

    desk.put("app/kake.lock", "version = 9\n");
    assert!(kake(&desk, &["lock", "app", "--check"]).stderr.contains("a form that this program does not know"));
    assert_eq!(kake(&desk, &["lock", "ink/tones"]).status, 2, "it is no library");
}

#[test]
fn libraries_read_what_they_may() {
    let desk = diamond();
    desk.put("secret.kake", tone("secret", "0.2mm"));
    desk.put("base/.git/config.kake", tone("secret", "0.2mm"));
    #[cfg(unix)]
    std::os::unix::fs::symlink(desk.path("secret.kake"), desk.path("base/link.kake")).expect("links can be made");
    #[cfg(not(unix))]
    desk.put("base/link.kake", "import \"../secret.kake\"\n");
    for (import, code) in [
        ("base:link.kake", "kake::outside-root"),
        ("base:../secret.kake", "kake::outside-root"),
        ("base:/etc/passwd.kake", "kake::outside-root"),
        ("base:.git/config.kake", "kake::outside-root"),
        ("base:nothing.kake", "kake::import"),
        ("ground:tones/plain.kake", "kake::dependency"),
        ("bace:tones/plain.kake", "kake::dependency"),
    ] {
        desk.put("app/swatches/one.kake", scene(import, "secret"));
        let ran = kake(&desk, &["check", "app/swatches/one.kake"]);
        assert!(ran.status == 1 && ran.stderr.contains(code), "{import}: {}", ran.stderr);
    }
    // A dependency does not reach into what depends on it.
    desk.put("base/tones/plain.kake", "import \"../../app/swatches/both.kake\"\n");
    let ran = kake(&desk, &["check", "app/swatches/both.kake"]);
    assert!(ran.status == 1 && ran.stderr.contains("base:tones/plain.kake:1:8"), "{}", ran.stderr);
}

#[test]
fn bad_manifests_are_diagnosed() {
    let desk = diamond();
    desk.put("bare/kake.toml", "");
    let bad = [
        ("../../../../../../../../etc", "kake::dependency"),
        ("/etc", "kake::manifest"),
        ("..", "kake::manifest"),
        ("../app", "kake::manifest"),
        ("../bare", "kake::dependency"),
        ("swatches/both.kake", "kake::dependency"),
    ];
    for (path, code) in bad {
        desk.put("app/kake.toml", manifest("app", &[("ink", path)]));
        for command in ["check", "build", "metrics", "params"] {
            let ran = kake(&desk, &[command, "app/swatches/both.kake"]);
            assert!(ran.status == 1 && ran.stderr.contains("kake.toml:7:"), "{command} {path}: {}", ran.stderr);
        }
        let ran = kake(&desk, &["check", "app/swatches/both.kake", "--format", "json"]);
        let said: Value = serde_json::from_str(&ran.stdout).expect("it is JSON");
        assert_eq!(said[0]["code"].as_str(), Some(code), "{path}: {said}");
        assert_eq!(kake(&desk, &["test", "app"]).status, 1);
    }
    desk.put("app/kake.toml", manifest("app", &[("ink", "../ink")]));
    desk.put("base/kake.toml", manifest("base", &[("app", "../app")]));
    let round = kake(&desk, &["lock", "app"]);
    assert!(
        round.status == 1 && round.stderr.contains("`app` depends on itself by way of `ink` and `base`"),
        "{}",
        round.stderr
    );
    desk.put("app/kake.toml", b"name = \xff\n");
    let ran = kake(&desk, &["check", "app/swatches/both.kake"]);
    assert!(ran.status == 1 && ran.stderr.contains("kake::encoding"), "{}", ran.stderr);
}

/// Links in a library lead nothing out of it.
#[cfg(unix)]
#[test]
fn nothing_is_written_outside_a_library() {
    use std::os::unix::fs::symlink;
    let desk = desk();
    desk.put("outside/kept.txt", "mine");
    edit(&desk, "ink/tones/mist.kake", "pen: length = 0.16mm", "pen: length = 0.3mm");
    symlink(desk.path("outside"), desk.path("ink/.kake")).expect("links can be made");
    assert_eq!(kake(&desk, &["test", "ink"]).status, 3);
    fs::remove_file(desk.path("ink/pins/mist.toml")).expect("it can be removed");
    symlink(desk.path("outside/kept.txt"), desk.path("ink/pins/mist.toml")).expect("links can be made");
    let before = desk.get("ink/pins/mist.png");
    assert_eq!(kake(&desk, &["test", "ink", "--accept"]).status, 3);
    assert_eq!(desk.get("ink/pins/mist.png"), before, "a pin is written whole or not at all");
    fs::remove_file(desk.path("ink/kake.lock")).expect("it can be removed");
    symlink(desk.path("outside/kept.txt"), desk.path("ink/kake.lock")).expect("links can be made");
    assert_eq!(kake(&desk, &["lock", "ink"]).status, 3);
    assert_eq!(desk.get("outside/kept.txt"), b"mine");
    assert_eq!(fs::read_dir(desk.path("outside")).expect("it is there").count(), 1);
}
