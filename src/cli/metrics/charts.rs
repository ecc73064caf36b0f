//! The charts of `kake metrics`: files beside each other in a folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::cli::Ended;
use crate::cli::build::cannot_write;
use crate::cli::files::{Pending, write_beside};
use crate::experiment::file_name;
use crate::illustrate::{Sketch, illustrate};

use super::Entry;

/// Writes the charts of every paint, `PAINT-KIND.svg`, over all its seeds. The folder is made where it is not there; no
/// file is replaced unless all can be written.
pub(super) fn write(folder: &Path, entries: &[Entry]) -> Ended {
    if let Err(error) = fs::create_dir_all(folder) {
        return cannot_write(folder, &error);
    }
    let mut taken = BTreeSet::new();
    let mut pending: Vec<(std::path::PathBuf, Pending)> = Vec::new();
    // Patterns of a file are each their own, though their names be the same.
    for paint in entries.chunk_by(|a, b| a.paint == b.paint && a.seed.is_some() && a.seed != b.seed) {
        let name = &paint[0].paint;
        let sketches: Vec<Sketch> = paint.iter().filter_map(|entry| entry.sketch.clone()).collect();
        let stem = stem(name, &mut taken);
        for chart in illustrate(name, &sketches) {
            let target = folder.join(format!("{stem}-{}.svg", chart.kind));
            match write_beside(&target, |out| out.write_all(chart.svg.as_bytes())) {
                Ok(file) => pending.push((target, file)),
                Err(error) => return cannot_write(&target, &error),
            }
        }
    }
    for (target, file) in pending {
        if let Err(error) = file.keep() {
            return cannot_write(&target, &error);
        }
    }
    Ended::Done
}

/// A paint's name as part of a file's, which no other paint has.
fn stem(paint: &str, taken: &mut BTreeSet<String>) -> String {
    let plain = match file_name(paint) {
        plain if plain.is_empty() => "paint".to_owned(),
        plain => plain,
    };
    let mut name = plain.clone();
    let mut number = 2;
    // File systems that do not tell capitals apart would mix charts up.
    while !taken.insert(name.to_lowercase()) {
        name = format!("{plain}-{number}");
        number += 1;
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_paints_share_files() {
        let mut taken = BTreeSet::new();
        let names = ["sky", "Sky", "a/b", "a b", "…"].map(|name| stem(name, &mut taken));
        assert_eq!(names, ["sky", "Sky-2", "a-b", "a-b-2", "paint"]);
    }
}
