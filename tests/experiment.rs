//! `kake experiment`: what it writes, that it goes on where it was ended, and that shards add up to the whole.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::cli::Desk;

/// Six conditions, one of them a reference, with four seeds each.
const SCENE: &str = "canvas { size: (12mm, 12mm), pixels: (40, 40) }
param place = \"poisson\" in [\"poisson\", \"uniform\", \"grid\"]
param angles = \"bfs\" in [\"bfs\", \"random\", \"checkerboard\"]
param layers: number = 1 in 1 .. 4
param gap = 1mm
tone plain {
  place: match place { \"poisson\" => poisson(radius: 2mm) \"uniform\" => uniform(count: 30) \"grid\" => grid(spacing: 2mm) }
  shape: rect(size: 3mm)
  angle: match angles { \"bfs\" => bfs() \"random\" => random() \"checkerboard\" => checkerboard() }
  fill: lines(pitch: gap)
  k: layers
}
paint canvas with plain
experiment trial {
  seeds: 3 .. 6
  factors: { place: [\"poisson\", \"uniform\"], angles: [\"bfs\", \"random\"] }
  reference: [{ place: \"grid\", angles: \"checkerboard\" }, { gap: 0.5mm }]
  images: { layers: [1, 2] }
}
";

/// Every file below a folder, by its path from there.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).expect("the folder is there") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("it lies there").to_string_lossy().into_owned();
                files.insert(name, fs::read(&path).expect("it can be read"));
            }
        }
    }
    files
}

/// Asserts that two folders hold the same files.
#[track_caller]
fn same(desk: &Desk, a: &str, b: &str) {
    let (a, b) = (files(&desk.path(a)), files(&desk.path(b)));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(bytes == &b[name], "{name} differs");
    }
}

fn desk() -> Desk {
    let desk = Desk::new();
    desk.put("trial.kake", SCENE);
    desk
}

fn rows(desk: &Desk, file: &str) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(std::io::Cursor::new(desk.get(file)));
    reader.deserialize().map(|row| row.expect("it is CSV")).collect()
}

#[test]
fn every_run_has_its_row_and_every_condition_its_pictures() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "trial", "-o", "out"]);
    let found = files(&desk.path("out"));
    let tables = ["anova", "assumptions", "cohen_d", "runs", "summary", "tukey"].map(|name| format!("{name}.csv"));
    let others = ["made.json", "report.html", "runs.journal", "runs.parquet"].map(str::to_owned);
    for name in tables.iter().chain(&others) {
        assert!(found.contains_key(name), "{name}");
    }
    let conditions =
        ["poisson-bfs", "poisson-random", "uniform-bfs", "uniform-random", "grid-checkerboard", "gap-0.5mm"];
    let mut pictures: Vec<String> =
        conditions.iter().flat_map(|name| [1, 2].map(|k| format!("images/{name}-layers={k}.png"))).collect();
    pictures.sort();
    let drawn: Vec<&String> = found.keys().filter(|name| name.starts_with("images/")).collect();
    assert_eq!(drawn, pictures.iter().collect::<Vec<_>>());

    let runs = String::from_utf8(desk.get("out/runs.csv")).expect("it is text");
    assert!(runs.starts_with("place,angles,gap,seed,tiles,edges,e_contrast,"), "{runs}");
    let runs = rows(&desk, "out/runs.csv");
    assert_eq!(runs.len(), 24);
    let names: Vec<[&str; 4]> =
        runs.iter().map(|row| ["place", "angles", "gap", "seed"].map(|name| &*row[name])).collect();
    assert_eq!(names[0], ["poisson", "bfs", "1mm", "3"]);
    assert_eq!(names[7], ["poisson", "random", "1mm", "6"]);
    assert_eq!(names[16], ["grid", "checkerboard", "1mm", "3"]);
    assert_eq!(names[20], ["poisson", "bfs", "0.5mm", "3"]);
    // What a run measures is what the scene measures with its parameters and seed.
    assert_eq!(runs[0]["e_contrast"], runs[20]["e_contrast"]);
    let summary = rows(&desk, "out/summary.csv");
    let contrast = summary.iter().find(|row| row["condition"] == "poisson + bfs" && row["measure"] == "e_contrast");
    let contrast = contrast.expect("it is measured");
    let mean = runs[..4].iter().map(|row| row["e_contrast"].parse::<f64>().expect("a number")).sum::<f64>() / 4.0;
    assert!((contrast["mean"].parse::<f64>().expect("a number") - mean).abs() < 1e-12 && contrast["n"] == "4");
    // References stand outside the design.
    let anova: Vec<String> = rows(&desk, "out/anova.csv")
        .into_iter()
        .filter(|row| row["measure"] == "e_contrast")
        .map(|row| format!("{} {}", row["source"], row["df"]))
        .collect();
    assert_eq!(anova, ["place 1", "angles 1", "place:angles 1", "residual 12"]);
    assert_eq!(rows(&desk, "out/tukey.csv").iter().filter(|row| row["measure"] == "e_contrast").count(), 6);
    // A picture makes itself again.
    desk.quietly(&["build", "out/images/uniform-random-layers=2.png", "-o", "again.png"]);
    assert_eq!(desk.get("again.png"), desk.get("out/images/uniform-random-layers=2.png"));
    // All is there: doing it again does nothing new.
    let before = files(&desk.path("out"));
    desk.quietly(&["experiment", "trial.kake", "-o", "out"]);
    assert!(before == files(&desk.path("out")));
}

#[test]
fn the_files_do_not_depend_on_threads() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "-o", "one", "--jobs", "1"]);
    desk.quietly(&["experiment", "trial.kake", "-o", "two", "--jobs", "2"]);
    same(&desk, "one", "two");
}

#[test]
fn what_was_cut_short_goes_on() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "-o", "whole"]);
    let journal = desk.get("whole/runs.journal");
    // Killed in the midst of a line, with an earlier line damaged.
    let lines: Vec<&[u8]> = journal.split_inclusive(|&byte| byte == b'\n').collect();
    let mut cut: Vec<u8> = lines[..9].concat();
    let damaged = lines[0].len() + lines[1].len() + 40;
    cut[damaged] ^= 1;
    cut.extend(&lines[9][..lines[9].len() / 2]);
    desk.put("cut/runs.journal", &cut);
    let ran = desk.kake(&["experiment", "trial.kake", "-o", "cut"]);
    assert_eq!(ran.status(), 0, "{}", ran.err());
    assert!(ran.err().contains("7 of 24 runs are finished already"), "{}", ran.err());
    same(&desk, "whole", "cut");
    // A first line that was cut short is nothing yet.
    desk.put("begun/runs.journal", &journal[..30]);
    desk.quietly(&["experiment", "trial.kake", "-o", "begun"]);
    same(&desk, "whole", "begun");
}

#[test]
fn an_edited_scene_does_not_mix_with_earlier_runs() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "-o", "out"]);
    desk.put("trial.kake", SCENE.replace("radius: 2mm", "radius: 2.5mm").replace("layers: [1, 2]", "layers: [1]"));
    let ran = desk.kake(&["experiment", "trial.kake", "-o", "out"]);
    assert_eq!(ran.status(), 0, "{}", ran.err());
    assert!(ran.err().contains("all runs are done anew"), "{}", ran.err());
    assert!(desk.path("out/runs.journal.old").is_file());
    fs::remove_file(desk.path("out/runs.journal.old")).expect("it is there");
    desk.quietly(&["experiment", "trial.kake", "-o", "fresh"]);
    // Pictures that the edited scene has no more are gone.
    same(&desk, "out", "fresh");
}

#[test]
fn no_journal_that_was_put_aside_is_written_over() {
    let desk = desk();
    let run = |seeds: &str, words: &[&str]| {
        let ran = desk.kake(&["experiment", "trial.kake", "-o", "out", "--seeds", seeds]);
        assert_eq!(ran.status(), 0, "{}", ran.err());
        words.iter().for_each(|words| assert!(ran.err().contains(words), "{words}: {}", ran.err()));
        (desk.get("out/runs.journal"), ran.err())
    };
    let (first, _) = run("3..3", &[]);
    let (second, _) = run("4..4", &["all runs are done anew", "runs.journal.old\n"]);
    let (third, _) = run("5..5", &["all runs are done anew", "runs.journal.old-2\n"]);
    assert!(first != second && second != third && first != third);
    assert!(desk.get("out/runs.journal.old") == first && desk.get("out/runs.journal.old-2") == second);
    // What was put aside unfinished is gone on with.
    let lines: Vec<&[u8]> = first.split_inclusive(|&byte| byte == b'\n').collect();
    desk.put("out/runs.journal.old", lines[..3].concat());
    let (again, said) = run("3..3", &["runs.journal.old-3\n", "taken up again", "2 of 6 runs are finished already"]);
    assert!(again == first && !said.contains("done anew"), "{said}");
    assert!(!desk.path("out/runs.journal.old").exists());
    assert!(desk.get("out/runs.journal.old-2") == second && desk.get("out/runs.journal.old-3") == third);
    // Of a first line that is damaged it cannot be told whether the scene is another.
    let mut damaged = first.clone();
    damaged[40] ^= 1;
    desk.put("out/runs.journal", &damaged);
    let (anew, said) = run("3..3", &["is damaged", "all runs are done anew", "runs.journal.old\n"]);
    assert!(anew == first && !said.contains("the scene, its files"), "{said}");
    assert!(desk.get("out/runs.journal.old") == damaged);
    assert!(desk.get("out/runs.journal.old-2") == second && desk.get("out/runs.journal.old-3") == third);
}

#[test]
fn shards_add_up_to_the_whole() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "-o", "whole"]);
    desk.quietly(&["experiment", "trial.kake", "-o", "a", "--shard", "1/3"]);
    desk.quietly(&["experiment", "trial.kake", "-o", "b", "--shard", "2/3"]);
    let refused = |arguments: &[&str], words: &str| {
        desk.kake(&[&["experiment", "merge", "-o", "merged"], arguments].concat()).refused(2, words);
    };
    refused(&["a", "b"], "the shard 3/3 is missing");
    refused(&["a"], "the shards 2/3, 3/3 are missing");
    refused(&["a", "b", "a"], "the shard 1/3 is given twice");
    refused(&["a", "whole"], "is one of 3 shards, whole/runs.journal one of 1");
    fs::create_dir(desk.path("empty")).expect("the desk can be written");
    refused(&["empty"], "empty holds no shard");
    desk.quietly(&["experiment", "merge", "whole", "-o", "one"]);
    same(&desk, "whole", "one");
    desk.quietly(&["experiment", "trial.kake", "-o", "a", "--shard", "3/3"]);
    assert_eq!(rows(&desk, "a/runs-3-of-3.csv").len(), 8);
    // The scene itself is not needed any more.
    fs::rename(desk.path("trial.kake"), desk.path("gone.kake")).expect("it is there");
    desk.quietly(&["experiment", "merge", "b", "a", "-o", "merged"]);
    same(&desk, "whole", "merged");

    desk.put("trial.kake", SCENE.replace("3mm", "4mm"));
    desk.quietly(&["experiment", "trial.kake", "-o", "other", "--shard", "3/3"]);
    refused(&["b", "other"], "trial.kake is not the same");
    desk.put("trial.kake", SCENE);
    desk.quietly(&["experiment", "trial.kake", "-o", "half", "--shard", "1/2"]);
    refused(&["b", "half"], "is one of");
    let journal = desk.get("b/runs-2-of-3.journal");
    desk.put("b/runs-2-of-3.journal", &journal[..journal.len() - 5]);
    refused(&["a", "b"], "the shard 2/3 is not finished: 7 of 8 runs are");
    desk.kake(&["experiment", "merge", "nowhere", "-o", "merged"]).refused(3, "cannot read nowhere");
}

#[test]
fn one_seed_and_measures_without_variance_are_said_to_have_none() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "-o", "out", "--seeds", "5..5"]);
    assert_eq!(rows(&desk, "out/runs.csv").len(), 6);
    let fixed = SCENE.replace("\"random\" => random()", "\"random\" => fixed(30deg)").replace("bfs()", "fixed(0deg)");
    desk.put("fixed.kake", fixed);
    desk.quietly(&["experiment", "fixed.kake", "-o", "fixed"]);
    for folder in ["out", "fixed"] {
        for (name, bytes) in files(&desk.path(folder)).iter().filter(|(name, _)| name.ends_with(".csv")) {
            let text = String::from_utf8_lossy(bytes).to_lowercase();
            assert!(!text.contains("nan") && !text.contains("inf,") && !text.contains("inf\n"), "{name}: {text}");
        }
        let noted = rows(&desk, &format!("{folder}/anova.csv"));
        assert!(noted.iter().any(|row| row["measure"] == "e_contrast" && !row["note"].is_empty()), "{noted:?}");
    }
}

#[test]
fn a_condition_at_fault_leaves_the_others() {
    let desk = desk();
    let scene = SCENE.replace("angles: [\"bfs\", \"random\"]", "angles: [\"bfs\", \"checkerboard\"]");
    desk.put("trial.kake", scene);
    let ran = desk.kake(&["experiment", "trial.kake", "-o", "out"]);
    assert_eq!(ran.status(), 1);
    assert!(ran.err().contains("the condition `poisson + checkerboard` is at fault: all its runs are left out"));
    assert!(ran.err().contains("kake::checkerboard"), "{}", ran.err());
    assert_eq!(rows(&desk, "out/runs.csv").len(), 16);
    assert!(desk.path("out/images/uniform-bfs-layers=2.png").is_file());
    // What has failed stays so, and is told again.
    let again = desk.kake(&["experiment", "trial.kake", "-o", "out"]);
    assert_eq!((again.status(), again.err()), (1, ran.err()));
    // A limit that one seed meets is its run's alone: here all meet it.
    let ran = desk.kake(&["experiment", "trial.kake", "-o", "few", "--limit", "tiles=3"]);
    ran.refused(1, "no run could be measured");
    assert!(!desk.path("few/runs.csv").exists());
}

#[test]
fn what_cannot_be_run_is_said() {
    let desk = desk();
    let refused = |arguments: &[&str], status: i32, words: &str| {
        desk.kake(&[&["experiment", "-o", "out"], arguments].concat()).refused(status, words);
    };
    refused(&["trial.kake", "trail"], 1, "did you mean `trial`?");
    refused(&["scene.kake"], 1, "the scene declares no experiment");
    refused(&["trial.kake", "--set", "angles=random"], 2, "`angles` is a factor of the experiment `trial`");
    refused(&["trial.kake", "--limit", "runs=10"], 1, "has 24 runs; the limit is 10");
    refused(&["trial.kake", "--only", "plane"], 1, "did you mean `plain`?");
    refused(&["trial.kake", "--shard", "0/4"], 2, "shards are counted from 1/4 to 4/4");
    refused(&["missing.kake"], 3, "cannot read missing.kake");
    desk.put("two.kake", format!("{SCENE}experiment more {{ seeds: 0 .. 1 }}\n"));
    refused(&["two.kake"], 1, "name one of `trial`, `more`");
    refused(&["two.kake", "more", "--limit", "runs=1"], 1, "has 2 runs");
    desk.put("empty.kake", SCENE.replace("[\"bfs\", \"random\"]", "[]"));
    refused(&["empty.kake"], 1, "`angles` has no levels");
    desk.put("twice.kake", SCENE.replace("[\"bfs\", \"random\"]", "[\"bfs\", \"bfs\"]"));
    refused(&["twice.kake"], 1, "`angles` has the level \"bfs\" twice");
    desk.put("unknown.kake", SCENE.replace("factors: { place:", "factors: { plaice:"));
    refused(&["unknown.kake"], 1, "did you mean `place`?");
    desk.kake(&["experiment", "-o", "out"]).refused(2, "<SCENE>");
    desk.kake(&["experiment", "trial.kake"]).refused(2, "--output <DIR>");
    desk.put("file", "in the way");
    desk.kake(&["experiment", "trial.kake", "-o", "file"]).refused(3, "cannot write file");
    assert!(!desk.path("out").exists());
}

#[test]
#[cfg(unix)]
fn a_full_disk_loses_no_run() {
    let desk = desk();
    desk.quietly(&["experiment", "trial.kake", "-o", "whole"]);
    // No file may grow beyond 8 kB (16 in some shells), which some runs fit into.
    let script = "trap '' XFSZ; ulimit -f 16; exec \"$0\" experiment trial.kake -o out --jobs 1";
    let ran = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_kake")])
        .current_dir(desk.path(""))
        .output()
        .expect("there is a shell");
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert_eq!(ran.status.code(), Some(3), "{said}");
    assert!(said.contains("cannot write out/runs.journal: ") && said.contains(" of 24 runs are finished and kept"));
    let kept: usize =
        said.split("kake: ").last().and_then(|words| words.split(' ').next()?.parse().ok()).expect("a count");
    assert!(kept > 0, "{said}");
    let ran = desk.kake(&["experiment", "trial.kake", "-o", "out"]);
    assert!(ran.err().contains(&format!("{kept} of 24 runs are finished already")), "{}", ran.err());
    same(&desk, "whole", "out");
}

#[test]
fn several_paints_have_rows_of_their_own() {
    let desk = desk();
    let layered = SCENE.replace(
        "paint canvas with plain\n",
        "paint canvas with plain as \"below\"\npaint circle(center: (6mm, 6mm), radius: 5mm) with plain as \"above\"\n",
    );
    desk.put("trial.kake", layered);
    desk.quietly(&["experiment", "trial.kake", "-o", "out"]);
    let runs = rows(&desk, "out/runs.csv");
    assert_eq!(runs.len(), 48);
    assert_eq!([&*runs[0]["paint"], &*runs[1]["paint"]], ["below", "above"]);
    let below = rows(&desk, "out/anova.csv").into_iter().filter(|row| row["paint"] == "below").count();
    assert!(below > 0);
    desk.quietly(&["experiment", "trial.kake", "-o", "alone", "--only", "above"]);
    let alone = rows(&desk, "alone/runs.csv");
    assert_eq!(alone.len(), 24);
    assert_eq!(alone[0]["e_contrast"], runs[1]["e_contrast"]);
}
