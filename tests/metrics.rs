//! `kake metrics`: what it prints of scenes and of patterns from elsewhere, and what it refuses.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = "edition 1

canvas { size: (8mm, 8mm), pixels: (64, 64), paper: white }

tone lined { place: grid(columns: 2, rows: 2) shape: rect(size: 2.9mm) angle: checkerboard() fill: lines(pitch: 1mm, pen: 0.2mm) k: 1 }
tone strewn { place: poisson(radius: 1mm) shape: voronoi(inset: 0.1mm) angle: bfs() fill: lines(pitch: 0.5mm, pen: 0.1mm)
  k: linear(from: (0, 0), to: (8, 0), start: 0, end: 3) blend: dither }

paint canvas with lined
paint rect(at: (1, 1), size: (6, 5)) with strewn
";

struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(TempDir::new().expect("there is room for temporary files"));
        desk.put("scene.kake", SCENE);
        desk
    }

    fn put(&self, file: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.0.path().join(file), bytes).expect("files can be written");
    }

    fn kake(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kake"));
        command.args(arguments).current_dir(self.0.path()).output().expect("the program starts")
    }

    /// What the program prints when all goes well.
    #[track_caller]
    fn printed(&self, arguments: &[&str]) -> String {
        let output = self.kake(arguments);
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), &*words), (Some(0), ""), "{arguments:?}");
        String::from_utf8(output.stdout).expect("it prints UTF-8")
    }

    #[track_caller]
    fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.printed(arguments)).expect("it prints JSON")
    }

    #[track_caller]
    fn refused(&self, arguments: &[&str], status: i32, words: &str) {
        let output = self.kake(arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(status), 0), "{said}");
        assert!(said.contains(words) && !said.contains("panicked"), "{said}");
    }
}

#[test]
fn a_table_is_for_people() {
    let desk = Desk::new();
    insta::assert_snapshot!("metrics_table", desk.printed(&["metrics", "scene.kake", "--only", "lined"]));
    let seeds = desk.printed(&["metrics", "scene.kake", "--seeds", "3..5"]);
    assert!(seeds.contains("lined: 3 seeds") && seeds.contains("strewn: 3 seeds"));
    assert!(seeds.lines().all(|line| line.chars().count() <= 100), "{seeds}");
    assert!(seeds.contains("  mean") && seeds.contains("    sd"));
}

#[test]
fn json_and_csv_hold_the_same_figures_to_the_last_digit() {
    let desk = Desk::new();
    let json = desk.json(&["metrics", "scene.kake", "--seeds", "3..5", "--format", "json"]);
    let csv = desk.printed(&["metrics", "scene.kake", "--seeds", "3..5", "--format", "csv"]);
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let paints = json["paints"].as_array().expect("a list of paints");
    assert_eq!((paints.len(), rows.len()), (6, 7));
    let ids: Vec<(&str, u64)> = paints
        .iter()
        .map(|paint| (paint["paint"].as_str().unwrap_or(""), paint["seed"].as_u64().unwrap_or(9)))
        .collect();
    assert_eq!(ids, [("lined", 3), ("lined", 4), ("lined", 5), ("strewn", 3), ("strewn", 4), ("strewn", 5)]);
    for (paint, row) in paints.iter().zip(&rows[1..]) {
        let mut compared = 0;
        for (name, cell) in rows[0].iter().zip(row) {
            match &paint[*name] {
                Value::Number(number) => {
                    assert_eq!(cell.parse::<f64>().ok(), number.as_f64(), "{name}");
                    compared += 1;
                }
                Value::Null if !name.starts_with('r') => {
                    assert!(cell.is_empty() || name.starts_with("decay"), "{name}")
                }
                _ => {}
            }
        }
        assert!(compared > 20);
        let r = paint["r"].as_array().expect("a list of correlations");
        let first = rows[0].iter().position(|name| *name == "r1").expect("a column of its own");
        assert_eq!(row[first].parse::<f64>().ok(), r[0].as_f64());
    }
    // Nothing depends on what else is measured, or on how many threads do it.
    let one = desk.json(&["metrics", "scene.kake", "--seed", "4", "--only", "strewn", "--format", "json"]);
    assert_eq!(one["paints"][0], paints[4]);
}

#[test]
fn a_pattern_from_elsewhere_measures_like_its_scene() {
    let desk = Desk::new();
    desk.put("tiles.json", desk.printed(&["ir", "scene.kake", "--stage", "tiles"]));
    let scene = desk.json(&["metrics", "scene.kake", "--format", "json"]);
    let pattern = desk.json(&["metrics", "tiles.json", "--format", "json"]);
    for i in 0..2 {
        let (scene, pattern) = (&scene["paints"][i], &pattern["paints"][i]);
        for name in
            ["tiles", "edges", "e_contrast", "e_bound", "p5_contrast_layers", "e_contrast_k", "h_angle_mean", "r"]
        {
            assert_eq!(scene[name], pattern[name], "{name}");
        }
        for name in ["c_cov", "u_vor", "xi"] {
            let [scene, pattern] = [scene, pattern].map(|figures| figures[name].as_f64());
            let is_near = |(a, b): (f64, f64)| (a - b).abs() < 1e-12;
            assert!(scene.zip(pattern).is_none_or(is_near) && scene.is_some() == pattern.is_some(), "{name}");
        }
        // What is drawn is not in the file.
        assert_eq!((&pattern["density_contrast"], &pattern["tile_isotropy"]), (&Value::Null, &Value::Null));
        assert!(scene["density_contrast"].is_number());
    }
    desk.put("least.json", r#"{"paints":[{"sites":[],"edges":[],"angles":[]}]}"#);
    let nothing = &desk.json(&["metrics", "least.json", "--format", "json"])["paints"][0];
    assert_eq!((&nothing["e_contrast"], &nothing["h_angle"]), (&0.0.into(), &0.0.into()));
    assert!(
        ["c_cov", "u_vor", "p5_contrast", "e_bound", "e_contrast_k", "xi"].iter().all(|name| nothing[name].is_null())
    );
}

#[test]
fn a_page_that_repeats_measures_the_same_from_its_file() {
    let desk = Desk::new();
    let scene =
        SCENE.replace("paper: white", "paper: white, repeat: true").replace("rect(at: (1, 1), size: (6, 5))", "canvas");
    desk.put("torus.kake", scene.replace("linear(from: (0, 0), to: (8, 0), start: 0, end: 3)", "1.5"));
    desk.put("torus.json", desk.printed(&["ir", "torus.kake", "--stage", "tiles"]));
    let figures = |file| desk.json(&["metrics", file, "--only", "strewn", "--format", "json"])["paints"][0].clone();
    let (scene, pattern) = (figures("torus.kake"), figures("torus.json"));
    assert!(scene["e_bound"].is_null() && pattern["e_bound"].is_null());
    for name in ["c_cov", "u_vor", "e_contrast"] {
        let [scene, pattern] = [&scene, &pattern].map(|figures| figures[name].as_f64().expect("a number"));
        assert!((scene - pattern).abs() < 1e-9, "{name}: {scene} and {pattern}");
    }
}

#[test]
fn pictures_are_compared() {
    let desk = Desk::new();
    desk.printed(&["build", "scene.kake", "-o", "same.png"]);
    desk.printed(&["build", "scene.kake", "-o", "large.png", "--dpi", "600"]);
    desk.printed(&["build", "scene.kake", "-o", "other.png", "--seed", "9"]);
    let ssim = |file| {
        let found = desk.json(&["metrics", "scene.kake", "--against", file, "--format", "json"]);
        assert_eq!(found["paints"][0]["ssim"], found["paints"][1]["ssim"]);
        found["paints"][0]["ssim"].as_f64().expect("a number")
    };
    assert_eq!((ssim("same.png"), ssim("large.png")), (1.0, 1.0));
    assert!((0.0..0.9).contains(&ssim("other.png")));
    let csv = desk.printed(&["metrics", "scene.kake", "--against", "same.png", "--format", "csv"]);
    assert!(csv.lines().next().is_some_and(|header| header.ends_with(",ssim")));
    assert!(csv.lines().skip(1).all(|row| row.ends_with(",1")));

    let picture = |file: &str, width, height| {
        let place = desk.0.path().join(file);
        image::GrayImage::new(width, height).save(Path::new(&place)).expect("pictures can be written");
    };
    picture("wide.png", 64, 48);
    picture("tiny.png", 8, 8);
    desk.put("text.png", "no picture");
    let against = |file| ["metrics", "scene.kake", "--against", file];
    desk.refused(&against("wide.png"), 1, "64 x 48 pixels, and no resolution makes that of a page of 8 x 8 mm");
    desk.refused(&against("tiny.png"), 1, "windows of 11 x 11");
    desk.refused(&against("text.png"), 3, "neither a PNG nor a JPEG");
    desk.refused(&against("none.png"), 3, "cannot read none.png");
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let desk = Desk::new();
    desk.refused(&["metrics", "none.kake"], 3, "cannot read none.kake");
    desk.refused(&["metrics", "none.json"], 3, "cannot read none.json");
    desk.refused(&["metrics", "scene.kake", "--only", "line"], 1, "did you mean `lined`?");
    desk.refused(&["metrics", "scene.kake", "--seeds", "5..3"], 2, "5 comes after 3");
    desk.refused(&["metrics", "scene.kake", "--seeds", "0..18446744073709551615"], 2, "more than 1000000 seeds");
    desk.refused(&["metrics", "scene.kake", "--seed", "1", "--seeds", "1..2"], 2, "--seed");
    desk.refused(&["metrics", "scene.kake", "--limit", "tiles=3"], 1, "tiles");
    desk.put("bad.json", "{\"paints\":[");
    desk.refused(&["metrics", "bad.json"], 1, "bad.json: this is no JSON");
    desk.put("other.json", "{\"layers\":[]}");
    desk.refused(&["metrics", "other.json"], 1, "`kake ir --stage tiles`");
    desk.put("wrong.json", r#"{"paints":[{"paint":"a","sites":[[0,0]],"edges":[[0,1]],"angles":[0]}]}"#);
    desk.refused(&["metrics", "wrong.json"], 1, "`a`: `edges` names site 1");
    desk.refused(&["metrics", "wrong.json", "--seed", "1"], 2, "--seed is for scenes");
    let many = r#"{"paints":[{"sites":[[0,0],[1,0]],"edges":[],"angles":[0,0]}]}"#;
    desk.put("many.json", many);
    desk.refused(&["metrics", "many.json", "--limit", "tiles=1"], 1, "--limit tiles=2");
    desk.refused(&["metrics", "many.json", "--only", "x"], 1, "no paint `x`");
}

#[test]
fn a_scene_without_paints_has_no_measures() {
    let desk = Desk::new();
    desk.put("bare.kake", "canvas { size: (4mm, 4mm) }\noutline canvas pen 0.2mm\n");
    let output = desk.kake(&["metrics", "bare.kake", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(output.stdout, b"{\"paints\":[]}\n");
    assert!(String::from_utf8_lossy(&output.stderr).contains("no paint to be measured"));
}
