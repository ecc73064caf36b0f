//! Batches, contact sheets, galleries and bundles, as the program makes them.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use kakeami::back::metadata::extract;

use crate::cli::Desk;

/// The names of the files in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder can be read");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("it can be read").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn size(png: &[u8]) -> [u32; 2] {
    let image = image::load(Cursor::new(png), image::ImageFormat::Png).expect("it is a PNG");
    [image.width(), image.height()]
}

#[test]
fn a_matrix_makes_every_picture_as_it_is_made_alone() {
    let desk = Desk::new();
    let vary = ["--vary", "pen=0.1mm,0.4mm", "--vary", "kind=hex,grid"];
    let arguments = [&["build", "scene.kake"][..], &vary, &["--seeds", "5..6", "-o", "{n}-{pen}-{kind}-{seed}.svg"]];
    desk.quietly(&arguments.concat());
    let made: Vec<String> = names(&desk.path("")).into_iter().filter(|name| name != "scene.kake").collect();
    assert_eq!(made.len(), 8);
    assert_eq!((made[0].as_str(), made[7].as_str()), ("1-0.1mm-hex-5.svg", "8-0.4mm-grid-6.svg"));
    let alone = ["build", "scene.kake", "--set", "pen=0.4mm", "--set", "kind=hex", "--seed", "6", "-o", "alone.svg"];
    desk.quietly(&alone);
    assert!(desk.get("alone.svg") == desk.get("6-0.4mm-hex-6.svg"));
    // Neither do the threads matter, nor is a file left half.
    let again = [&["build", "scene.kake"][..], &vary, &["--threads", "1", "-o", "one-{pen}-{kind}.png"]].concat();
    desk.quietly(&again);
    let many = [&["build", "scene.kake"][..], &vary, &["--threads", "4", "-o", "many-{pen}-{kind}.png"]].concat();
    desk.quietly(&many);
    assert!(desk.get("one-0.1mm-grid.png") == desk.get("many-0.1mm-grid.png"));
    assert!(names(&desk.path("")).iter().all(|name| !name.ends_with(".part")));
}

#[test]
fn outputs_are_named_after_what_varies() {
    let desk = Desk::new();
    desk.quietly(&["build", "scene.kake", "--vary", "kind=\"hex\",grid", "--seeds", "1..1"]);
    assert_eq!(names(&desk.path("")), ["scene-grid-1.svg", "scene-hex-1.svg", "scene.kake"]);
    assert_eq!(extract(&desk.get("scene-grid-1.svg")).expect("it says how it was made").seed, 1);
}

#[test]
fn sheets_hold_all_pictures_with_their_captions() {
    let desk = Desk::new();
    let matrix = ["build", "scene.kake", "--vary", "kind=hex,grid", "--vary", "pen=0.1mm,0.3mm,0.6mm", "--sheet"];
    for (sheet, threads) in [("a.svg", "1"), ("b.svg", "3"), ("a.png", "1"), ("b.png", "3"), ("a.pdf", "2")] {
        desk.quietly(&[&matrix[..], &[sheet, "--threads", threads]].concat());
    }
    assert!(desk.get("a.svg") == desk.get("b.svg") && desk.get("a.png") == desk.get("b.png"));
    let text = String::from_utf8(desk.get("a.svg")).expect("SVG is UTF-8");
    for caption in ["kind = hex", "kind = grid", "pen = 0.1mm", "pen = 0.3mm", "pen = 0.6mm", "scene.kake"] {
        // Rows and columns say it once.
        assert_eq!(text.matches(&format!(">{caption}</text>")).count(), 1, "{caption}");
    }
    assert_eq!(text.matches("<svg ").count(), 7);
    let document = usvg::roxmltree::Document::parse(&text).expect("it is XML");
    let mut ids: Vec<&str> = document.descendants().filter_map(|node| node.attribute("id")).collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all, "ids are unique");
    let [width, height] = size(&desk.get("a.png"));
    assert!(width > height, "three across and two down: {width} x {height}");
    assert!(desk.get("a.pdf").starts_with(b"%PDF"));
    assert!(!names(&desk.path("")).iter().any(|name| name.starts_with("scene-")), "a sheet alone makes no other files");
    desk.quietly(&["build", "scene.kake", "--seeds", "0..8", "--sheet", "seeds.svg", "-o", "s-{seed}.svg"]);
    let text = String::from_utf8(desk.get("seeds.svg")).expect("SVG is UTF-8");
    assert!((0..=8).all(|seed| text.contains(&format!(">seed {seed}</text>"))));
    assert_eq!(names(&desk.path("")).iter().filter(|name| name.starts_with("s-")).count(), 9);
}

#[test]
fn one_faulty_picture_does_not_stop_the_others() {
    let desk = Desk::new();
    let scene = "canvas { size: (12mm, 12mm) dpi: 100 }\nparam r = 3mm\n\
                 tone plain { place: poisson(radius: r) fill: lines(pitch: 1mm) }\npaint canvas with plain\n";
    desk.put("r.kake", scene);
    let ran = desk.kake(&["build", "r.kake", "--vary", "r=2mm,0mm,4mm", "-o", "{r}.svg", "--sheet", "all.svg"]);
    let said = ran.err();
    assert_eq!(ran.status(), 1, "{said}");
    assert!(said.contains("1 of 3 pictures could not be made: r = 0mm"), "{said}");
    assert_eq!(names(&desk.path("")), ["2mm.svg", "4mm.svg", "all.svg", "r.kake", "scene.kake"]);
    let sheet = String::from_utf8(desk.get("all.svg")).expect("SVG is UTF-8");
    assert!(sheet.contains("no picture"));
    // What is wrong with all of them is said once.
    desk.put("r.kake", scene.replace("poisson", "poison"));
    let said = desk.kake(&["build", "r.kake", "--vary", "r=2mm,3mm,4mm"]).err();
    assert_eq!(said.matches("poison").count(), 1 + said.matches("did you mean").count(), "{said}");
}

#[test]
fn values_are_refused_once_before_anything_is_drawn() {
    let desk = Desk::new();
    let arguments = ["build", "scene.kake", "--vary", "pen=0.2mm,9mm", "--vary", "pan=1,2,3", "--seeds", "0..3"];
    let ran = desk.kake(&arguments);
    let said = ran.err();
    assert_eq!(ran.status(), 1, "{said}");
    assert_eq!(said.matches("9mm is not between").count(), 1, "{said}");
    assert_eq!(said.matches("no parameter `pan`").count(), 1, "{said}");
    assert_eq!(names(&desk.path("")), ["scene.kake"]);
}

#[test]
fn command_lines_that_cannot_be_meant_are_refused() {
    let desk = Desk::new();
    let two = "--vary=pen=0.2mm,0.3mm";
    for (arguments, words) in [
        (&[two, "-o", "one.svg"][..], "{pen}"),
        (&[two, "-o", "{pan}.svg"], "called `pan`; there are {pen}, {n}"),
        (&[two, "-o", "-"], "standard output"),
        (&[two, "-o", "no/{pen}.svg"], "no folder no"),
        (&[two, "--set", "pen=0.1mm"], "set and varied"),
        (&[two, two], "varied twice"),
        (&["--vary", "pen=0.2mm,0.2mm"], "twice"),
        (&["--vary", "pen=1,,2"], "missing"),
        (&["--vary", "pen=(1,2"], "`)` is missing"),
        (&["--vary", "kind=a/b,a:b", "-o", "{kind}.svg"], "would be one file"),
        (&[two, "--sheet", "x.json"], ".svg, .png or .pdf"),
        (&[two, "-o", "{pen}.svg", "--sheet", "0.2mm.svg"], "a picture and the sheet"),
        (&["--seeds", "0..18446744073709551615"], "--limit runs=N"),
        (&[two, "--seeds", "0..9", "--limit", "runs=19"], "20 pictures"),
    ] {
        let ran = desk.kake(&[&["build", "scene.kake"], arguments].concat());
        let said = ran.err();
        assert_eq!(ran.status(), 2, "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    assert_eq!(names(&desk.path("")), ["scene.kake"]);
}

/// A library with two files of tones, one of them broken, and a swatch.
fn library(desk: &Desk) {
    let manifest = "[library]\nname = \"ink\"\nversion = \"0.1.0\"\nedition = 1\ndescription = \"Tones & more\"\n";
    desk.put("lib/kake.toml", manifest);
    let tone = "/// A <wash> of `lines`.\ntone wash(k: field = 1, pitch: length = 1mm) {\n  place: hex(spacing: 4mm)\n  \
                fill: lines(pitch: pitch)\n  k: k\n}\n";
    desk.put("lib/tones/wash.kake", tone);
    desk.put("lib/tones/broken.kake", "tone bad(k: field = 1) { place: hexx(spacing: 4mm) k: k }\n");
    let swatch = "import \"../tones/wash.kake\"\ncanvas { size: (20mm, 10mm) }\n/// How dark\nparam k = 2 in 0 .. 4\n\
                  paint canvas with wash(k: k)\n";
    desk.put("lib/swatches/first.kake", swatch);
}

#[test]
fn a_gallery_shows_a_library_whatever_is_broken_in_it() {
    let desk = Desk::new();
    library(&desk);
    let ran = desk.kake(&["gallery", "lib", "-o", "out"]);
    let said = ran.err();
    assert_eq!(ran.status(), 1, "{said}");
    assert!(said.contains("hexx"), "{said}");
    assert_eq!(names(&desk.path("out")), ["gallery.png", "index.html", "pictures"]);
    let pictures = names(&desk.path("out/pictures"));
    assert_eq!(pictures, ["02-wash-1.svg", "02-wash-2.svg", "02-wash-3.svg", "02-wash-4.svg", "03-first.svg"]);
    let page = String::from_utf8(desk.get("out/index.html")).expect("it is UTF-8");
    for words in [
        "<title>ink</title>",
        "Tones &amp; more",
        "import &quot;ink:tones/wash.kake&quot;",
        "A &lt;wash&gt; of <code>lines</code>.",
        "k = 4",
        "at fault",
        "How dark",
        "src=\"pictures/03-first.svg\"",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!page.contains("http") && !page.contains("<script"), "it needs no network and no script");
    assert!(pictures.iter().all(|picture| page.contains(&format!("pictures/{picture}"))));
    // Drawn over a parameter, the other pictures go.
    desk.put("lib/tones/broken.kake", "tone good { place: hex(spacing: 4mm) fill: dots(pitch: 1mm) }\n");
    desk.quietly(&["gallery", "lib", "-o", "out", "--over", "pitch=0.6mm,2mm", "--single", "sheet.svg"]);
    assert_eq!(names(&desk.path("out/pictures")), ["01-good-1.svg", "02-wash-1.svg", "02-wash-2.svg", "03-first.svg"]);
    let sheet = String::from_utf8(desk.get("sheet.svg")).expect("it is UTF-8");
    assert!(sheet.contains(">pitch = 2mm</text>") && sheet.contains(">wash</text>"));
}

#[test]
fn galleries_are_the_same_every_time_and_replace_nothing_else() {
    let desk = Desk::new();
    library(&desk);
    desk.quietly(&["gallery", "lib/tones/wash.kake", "-o", "a", "--k", "1..2"]);
    desk.quietly(&["gallery", "lib/tones/wash.kake", "-o", "b", "--k", "1..2"]);
    for file in ["index.html", "gallery.png", "pictures/01-wash-2.svg"] {
        assert!(desk.get(&format!("a/{file}")) == desk.get(&format!("b/{file}")), "{file}");
    }
    desk.put("mine/index.html", "<title>My site</title>");
    for (arguments, words) in [
        (&["lib", "-o", "mine"][..], "is no page of `kake gallery`"),
        (&["lib", "-o", "x", "--k", "1..5"], "4 layers at most"),
        (&["lib", "-o", "x", "--k", "3..1"], "3 comes after 1"),
        (&["lib", "-o", "x", "--single", "y.txt"], "ends in"),
        (&["a", "-o", "x"], "holds no .kake file"),
    ] {
        let ran = desk.kake(&[&["gallery"], arguments].concat());
        let said = ran.err();
        assert_eq!(ran.status(), 2, "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    assert_eq!(desk.kake(&["gallery", "nowhere", "-o", "x"]).status(), 3);
    assert_eq!(desk.kake(&["gallery", "lib", "-o", "x", "--over", "nothing=1,2"]).status(), 1);
    assert_eq!(desk.get("mine/index.html"), b"<title>My site</title>");
}

/// A scene below a root that imports, reads pictures and uses what comes with the program.
fn scene_with_files(desk: &Desk) {
    desk.put("work/kake.toml", "[dependencies]\nink = { path = \"../lib\" }\n");
    desk.put("work/data/light.png", png(|x, y| x * 16 + y));
    desk.put("work/data/dark.png", png(|x, y| 200 - x * y / 2));
    desk.put("work/tones/base.kake", "// The base.\n\nlet pitch = 0.7mm\ntone base(k: field) {\n  place: grid(spacing: 3mm)\n  fill: lines(pitch: pitch)\n  k: k\n}\n");
    desk.put(
        "work/scenes/night.kake",
        "import \"../tones/base.kake\" as own\nimport \"ink:tones/wash.kake\"\nimport \"std:manga\"\n\n\
         canvas { size: (30mm, 12mm) }\nseed 3\n\n/// Which picture\nparam file = \"light\" in [\"light\", \"dark\"]\n\n\
         field light = image(\"../data/{file}.png\", fit: (0mm, 0mm, 12mm, 12mm))\n\n\
         paint rect(at: (0mm, 0mm), size: (9mm, 12mm)) with own.base(k: 4 * light)\n\
         paint rect(at: (10mm, 0mm), size: (9mm, 12mm)) with wash(k: 2)\n\
         paint rect(at: (20mm, 0mm), size: (9mm, 12mm)) with kake2(tile: 3mm)\n",
    );
}

/// A small picture.
fn png(grey: fn(u32, u32) -> u32) -> Vec<u8> {
    let image = image::GrayImage::from_fn(16, 16, |x, y| image::Luma([grey(x, y) as u8]));
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("memory takes it");
    bytes.into_inner()
}

/// A picture without what it says of how it was made.
fn bare(desk: &Desk, scene: &str, more: &[&str]) -> Vec<u8> {
    desk.quietly(&[&["build", scene, "--embed", "none", "-o", "bare.svg"], more].concat());
    desk.get("bare.svg")
}

#[test]
fn a_bundle_makes_the_same_picture_anywhere_and_comes_apart_again() {
    let desk = Desk::new();
    library(&desk);
    scene_with_files(&desk);
    desk.quietly(&["bundle", "work/scenes/night.kake", "-o", "mail.kake"]);
    let text = String::from_utf8(desk.get("mail.kake")).expect("a bundle is text");
    let scene = String::from_utf8(desk.get("work/scenes/night.kake")).expect("it is text");
    assert!(text.starts_with(&scene), "a bundle begins with its scene");
    for line in ["// file \"tones/base.kake\", text", "//| // The base.", "// file \"ink:tones/wash.kake\", text"] {
        assert!(text.lines().any(|known| known == line), "{line}");
    }
    // Elsewhere there is nothing else.
    let (here, away) = (&desk, Desk::new());
    away.put("letter.kake", &text);
    for more in [&[][..], &["--set", "file=dark"]] {
        assert!(bare(&away, "letter.kake", more) == bare(here, "work/scenes/night.kake", more), "{more:?}");
    }
    // Every command knows it.
    away.quietly(&["check", "letter.kake"]);
    away.put("letter.kake", text.replace("seed 3\n", "seed    3\n"));
    away.quietly(&["fmt", "letter.kake"]);
    assert_eq!(String::from_utf8(away.get("letter.kake")).expect("it is text"), text, "formatting keeps the files");
    away.put("letter.kake", text.replace("wash(k: 2)", "wish(k: 2)"));
    let said = away.kake(&["check", "letter.kake"]).err();
    assert!(said.contains("letter.kake:14:"), "lines are those of the bundle: {said}");
    // A picture made of it holds the scene and not the files twice.
    away.put("letter.kake", &text);
    away.quietly(&["build", "letter.kake", "--embed", "all", "-o", "p.svg"]);
    let picture = extract(&away.get("p.svg")).expect("it holds its scene");
    assert!(picture.sources.iter().all(|(_, text)| !text.contains("kake bundle")));
    assert!(bare(&away, "p.svg", &[]) == bare(here, "work/scenes/night.kake", &[]));
    // A bundle of a bundle is the same one.
    away.quietly(&["bundle", "letter.kake", "-o", "again.kake"]);
    assert_eq!(String::from_utf8(away.get("again.kake")).expect("it is text").lines().count(), text.lines().count());
    // Taken apart it is files that stand on their own.
    away.quietly(&["bundle", "letter.kake", "--extract", "apart"]);
    assert_eq!(names(&away.path("apart/scene")), ["data", "kake.toml", "scenes", "tones"]);
    assert_eq!(away.get("apart/scene/tones/base.kake"), here.get("work/tones/base.kake"));
    assert_eq!(away.get("apart/scene/data/dark.png"), here.get("work/data/dark.png"));
    let apart = ["build", "apart/scene/scenes/night.kake", "--embed", "none", "-o", "bare.svg"];
    let ran = away.kake(&apart);
    assert_eq!(ran.status(), 0, "{}", ran.err());
    assert!(away.get("bare.svg") == bare(here, "work/scenes/night.kake", &[]));
}

#[test]
fn a_scene_in_toml_is_bundled_in_toml() {
    let desk = Desk::new();
    desk.put("base.kake", "tone base { place: grid(spacing: 3mm) fill: lines(pitch: 1mm) }\n");
    desk.put("s.kake", "import \"base.kake\"\ncanvas { size: (12mm, 12mm) }\nseed 1\npaint canvas with base\n");
    desk.quietly(&["convert", "s.kake", "s.toml"]);
    desk.quietly(&["bundle", "s.toml"]);
    let away = Desk::new();
    away.put("s.bundle.toml", desk.get("s.bundle.toml"));
    assert!(bare(&away, "s.bundle.toml", &[]) == bare(&desk, "s.kake", &[]));
}

#[test]
fn bundles_that_mean_harm_are_refused_in_words() {
    let desk = Desk::new();
    let bundle = |lines: &str| format!("canvas {{ size: a4 }}\n\n// kake bundle 1 \"a.kake\"\n{lines}\n");
    for (lines, words) in [
        ("// file \"../../.profile\", text\n//| evil", "line 4: `../../.profile` leads out of the bundle"),
        ("// file \"/etc/passwd\", text", "leads out"),
        ("// file \"x\", text\n// file \"x\", text", "`x` is there twice"),
        ("// file \"x.png\", base64, 99 bytes\n//: AAAA", "lines are missing"),
        ("paint canvas with nothing", "nothing may stand but its files"),
    ] {
        desk.put("bad.kake", bundle(lines));
        for arguments in [&["build", "bad.kake"][..], &["check", "bad.kake"], &["bundle", "bad.kake", "--extract", "x"]]
        {
            let ran = desk.kake(arguments);
            let said = ran.err();
            assert_eq!(ran.status(), 1, "{arguments:?} {lines}: {said}");
            assert!(said.contains(words), "{lines}: {said}");
        }
    }
    assert_eq!(names(&desk.path("")), ["bad.kake", "scene.kake"]);
    desk.put("full/file", "mine");
    desk.quietly(&["bundle", "scene.kake"]);
    for (arguments, status, words) in [
        (&["bundle", "scene.bundle.kake", "--extract", "full"][..], 2, "no empty folder"),
        (&["bundle", "scene.kake", "--extract", "y"], 1, "is no bundle"),
        (&["bundle", "scene.kake", "-o", "scene.kake"], 2, "the scene itself"),
        (&["bundle", "scene.kake", "-o", "x.toml"], 2, "written in .kake"),
        (&["convert", "scene.bundle.kake", "x.toml"], 2, "would be lost"),
        (&["bundle", "none.kake"], 3, "cannot read"),
    ] {
        let ran = desk.kake(arguments);
        let said = ran.err();
        assert_eq!(ran.status(), status, "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    desk.put("broken.kake", "canvas { size: a4 }\npaint canvas with nothing\n");
    assert_eq!(desk.kake(&["bundle", "broken.kake"]).status(), 1);
    assert!(!desk.path("broken.bundle.kake").exists(), "a scene at fault is not sent to anybody");
}
