//! What a test writes: pins, the page to be looked at, and reports.

use std::fs;
use std::io;
use std::path::Path;

use crate::cli::Ended;
use crate::cli::files::{plain, write_beside};
use crate::cli::packages::below;
use crate::library::review::{Outcome, Review, picture_file};
use crate::library::{junit, markdown, page};

use super::find::Library;
use super::judge::{Judged, files};

/// The page that shows what changed, in a folder that git ignores.
pub(super) const PAGE: &str = ".kake/review.html";

/// Writes files below a folder, all of them beside their places before the first is put there. No link leads one of them
/// out of the folder.
fn put(folder: &Path, files: &[(String, &[u8])]) -> Result<(), (String, io::Error)> {
    let mut pending = Vec::new();
    for (name, bytes) in files {
        let failed = |error| (name.clone(), error);
        let target = below(folder, name).map_err(failed)?;
        pending.push((name, write_beside(&target, |out| out.write_all(bytes)).map_err(failed)?));
    }
    pending.into_iter().try_for_each(|(name, file)| file.keep().map_err(|error| (name.clone(), error)))
}

fn failed(folder: &Path, (name, error): (String, io::Error)) -> Ended {
    eprintln!("kake: cannot write {}: {}", folder.join(name).display(), plain(&error));
    Ended::Io
}

/// Pins what was found, and removes pins without a swatch. What is the same stays as it is, to the byte.
pub(super) fn accept(library: &Library, judged: &[Judged]) -> Ended {
    let mut written = Vec::new();
    for Judged { swatch, pin } in judged {
        if let (Outcome::Changed(_) | Outcome::New, Some((text, picture))) = (swatch.outcome, pin) {
            let [text_file, picture_file] = files(&swatch.name);
            written.push((text_file, text.as_bytes()));
            written.push((picture_file, picture.as_slice()));
        }
    }
    if let Err(error) = put(&library.root, &written) {
        return failed(&library.root, error);
    }
    for Judged { swatch, .. } in judged.iter().filter(|judged| judged.swatch.outcome == Outcome::Orphan) {
        for file in files(&swatch.name) {
            // A link is removed, not what it leads to.
            match fs::remove_file(library.root.join(&file)) {
                Ok(()) => {}
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => {
                    eprintln!("kake: cannot remove {file}: {}", plain(&error));
                    return Ended::Io;
                }
            }
        }
    }
    forget(library);
    Ended::Done
}

/// Writes the page where there is something to be looked at.
pub(super) fn page(library: &Library, review: &Review) -> Ended {
    if review.is_same() {
        forget(library);
        return Ended::Done;
    }
    match put(&library.root, &[(PAGE.to_owned(), page::write(std::slice::from_ref(review)).as_bytes())]) {
        Ok(()) => {
            eprintln!("look at {}", library.root.join(PAGE).display());
            if review.is_acceptable() {
                eprintln!("`kake test --accept` pins what is there now");
            }
            Ended::Done
        }
        Err(error) => failed(&library.root, error),
    }
}

/// Removes a page that shows what is no longer so.
fn forget(library: &Library) {
    let _ = fs::remove_file(library.root.join(PAGE));
}

/// Writes the report.
pub(super) fn report(folder: &Path, reviews: &mut [Review]) -> Ended {
    // Swatches of one name in two libraries have pictures of their own.
    if reviews.len() > 1 {
        for review in reviews.iter_mut() {
            let title = review.title.replace(' ', "-");
            for swatch in &mut review.swatches {
                swatch.name = format!("{title}/{}", swatch.name);
            }
        }
    }
    if let Err(error) = fs::create_dir_all(folder) {
        return failed(folder, (String::new(), error));
    }
    let junit = match junit::write(reviews) {
        Ok(text) => text,
        Err(words) => {
            eprintln!("kake: cannot write junit.xml: {words}");
            return Ended::Io;
        }
    };
    let (html, text) = (page::write(reviews), markdown::write(reviews));
    let mut written = vec![
        ("report.md".to_owned(), text.as_bytes()),
        ("review.html".to_owned(), html.as_bytes()),
        ("junit.xml".to_owned(), junit.as_bytes()),
    ];
    let shown = reviews.iter().flat_map(|review| &review.swatches).filter(|swatch| swatch.outcome != Outcome::Same);
    for swatch in shown {
        written.extend(swatch.pictures.named().map(|(kind, bytes)| (picture_file(&swatch.name, kind), bytes)));
    }
    let root = match folder.canonicalize() {
        Ok(root) => root,
        Err(error) => return failed(folder, (String::new(), error)),
    };
    match put(&root, &written) {
        Ok(()) => Ended::Done,
        Err(error) => failed(folder, error),
    }
}
