//! Saving a picture: the same bytes as the command line makes, in a file that is new.

use std::io;
use std::path::{Path, PathBuf};

use crate::back::plot::plot;
use crate::cli::build::{Kind, check_pixels, fill};
use crate::cli::files::{plain, write_beside};
use crate::cli::picture::{Embed, Form, is_plot, metadata, set_plot};
use crate::diag::Diagnostic;
use crate::stop::Stop;

use super::session::{Made, Session, Wanted};

/// After so many files of one name nobody finds theirs again.
const MOST_FILES: u32 = 10_000;

/// Draws what is wanted and writes it into the session's folder; where to.
///
/// # Errors
/// In words.
pub(super) fn save(session: &Session, wanted: &Wanted, kind: Kind, stop: &Stop) -> Result<PathBuf, String> {
    let made = session.make(wanted, stop, &mut ()).map_err(|unmade| unmade.words())?;
    let Made { opened, config, mut compiled, .. } = made;
    if kind == Kind::Png {
        check_pixels(&mut compiled, &config.lower.limits);
    }
    let Some(drawing) = &compiled.drawing else {
        let first = compiled.lowered.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
        return Err(first.map_or_else(|| "the drawing was stopped".to_owned(), fault));
    };
    let form = Form::of(&opened).unwrap_or(Form::Page);
    let mut metadata = metadata(Embed::Text, &config, (&opened, form), &compiled);
    let is_plotted = kind == Kind::Svg && config.overlays.is_empty() && opened.picture.as_ref().is_some_and(is_plot);
    let plotted = is_plotted.then(|| plot(drawing).drawing);
    if is_plotted && let Some(metadata) = &mut metadata {
        set_plot(metadata);
    }
    let stem = session.stem();
    let mut bytes = Vec::new();
    let failed = |error: io::Error| format!("the picture cannot be written: {}", plain(&error));
    fill(plotted.as_ref().unwrap_or(drawing), metadata.as_ref(), (kind, form), &stem, &mut bytes).map_err(failed)?;
    if stop.is_asked() {
        return Err("the drawing was stopped".to_owned());
    }
    // An end waits until the file is there.
    let _writing = session.writing();
    let path = written(&session.settings.output, &stem, kind.name(), &bytes).map_err(failed)?;
    eprintln!("kake: wrote {}", path.display());
    Ok(path)
}

/// What is wrong with a scene, in a line.
pub(super) fn fault(diagnostic: &Diagnostic) -> String {
    match &diagnostic.hint {
        Some(hint) => format!("{}; {hint}", diagnostic.message),
        None => diagnostic.message.clone(),
    }
}

/// Writes a file whose name is not taken: `scene.svg`, then `scene-2.svg`.
fn written(folder: &Path, stem: &str, ending: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    for number in 1..=MOST_FILES {
        let name = if number == 1 { format!("{stem}.{ending}") } else { format!("{stem}-{number}.{ending}") };
        let path = folder.join(name);
        // A link that leads nowhere is somebody's too.
        if path.symlink_metadata().is_ok() {
            continue;
        }
        match write_beside(&path, |out| out.write_all(bytes))?.keep_new() {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            kept => return kept.map(|()| path),
        }
    }
    Err(io::Error::other(format!("there are {MOST_FILES} files of this name already")))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn no_file_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["a", "b", "c"].map(|bytes| {
            let path = written(folder.path(), "scene", "svg", bytes.as_bytes()).unwrap();
            assert_eq!(fs::read(&path).unwrap(), bytes.as_bytes());
            path.file_name().unwrap().to_string_lossy().into_owned()
        });
        assert_eq!(names, ["scene.svg", "scene-2.svg", "scene-3.svg"]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }
}
