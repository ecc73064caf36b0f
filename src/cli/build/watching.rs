//! `kake build --watch`: built again whenever a file that matters is saved, for those who keep their own viewer.
//!
//! Outputs replace the old ones when they are whole, so that the last good picture stays while a scene is at fault or
//! away.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::Instant;

use crate::cli::files::{open, plain};
use crate::cli::watch::{Stamp, Stamps, Watch};
use crate::cli::{Ended, report};

use super::{BuildArgs, asked, build};

/// Builds until the program is ended.
pub(super) fn run(arguments: &BuildArgs) -> Ended {
    let scene = &arguments.scene.scene;
    let (sender, changes) = mpsc::channel();
    // A receiver that is gone has ended with the program.
    let watch = match Watch::start(move |changed| sender.send(changed).unwrap_or_default()) {
        Ok(watch) => watch,
        Err(error) => {
            eprintln!("kake: cannot watch files: {}", plain(&error));
            return Ended::Io;
        }
    };
    let place = match std::path::absolute(scene) {
        Ok(place) => place,
        Err(error) => {
            eprintln!("kake: cannot read {}: {}", scene.display(), plain(&error));
            return Ended::Io;
        }
    };
    // A scene that was never there is a slip of the command line rather than one that went.
    if !scene.is_file() {
        return open(scene, arguments.scene.root.as_deref()).map_or_else(report::cannot_open, |_| Ended::Io);
    }
    let itself = asked(arguments).into_iter().find(|output| match (output.canonicalize(), scene.canonicalize()) {
        (Ok(output), Ok(scene)) => output == scene,
        _ => false,
    });
    if let Some(output) = itself {
        eprintln!("kake: {} would be built again for ever; name another output", output.display());
        return Ended::Usage;
    }
    let mut why = String::new();
    loop {
        let mut stamps = Stamps::from([(place.clone(), Stamp::of(&place))]);
        let begun = Instant::now();
        // What the program itself does wrong is printed where it happens; the next save may go better.
        let ended = catch_unwind(AssertUnwindSafe(|| match open(scene, arguments.scene.root.as_deref()) {
            Ok(opened) => {
                let ended = build(arguments, &opened);
                stamps.extend(opened.loader.followed());
                ended
            }
            Err(error) => report::cannot_open(error),
        }));
        let milliseconds = begun.elapsed().as_secs_f64() * 1000.0;
        match ended {
            Ok(Ended::Done) => eprintln!("kake: {why}wrote {} in {milliseconds:.0} ms", outputs(arguments)),
            Ok(Ended::Fault | Ended::Usage | Ended::Io) | Err(_) => {
                eprintln!("kake: {why}what was written last stays as it is until that is mended");
            }
        }
        watch.follow(stamps);
        let Ok(changed) = changes.recv() else { return Ended::Io };
        why = words(&place, &changed);
    }
}

/// The outputs as they are asked for, in a line.
fn outputs(arguments: &BuildArgs) -> String {
    let files = asked(arguments).into_iter().chain(arguments.sheet.clone());
    files.map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// What happened, before what came of it: `scene.kake was saved: `.
fn words(scene: &std::path::Path, changed: &[PathBuf]) -> String {
    let folder = scene.parent().and_then(|folder| folder.canonicalize().ok());
    let names: Vec<String> = changed
        .iter()
        .map(|path| {
            let inside = folder.as_ref().and_then(|folder| path.strip_prefix(folder).ok()).unwrap_or(path);
            let inside = inside.strip_prefix(scene.parent().unwrap_or(scene)).unwrap_or(inside);
            inside.display().to_string()
        })
        .collect();
    let gone = changed.iter().all(|path| !path.exists());
    let happened = match (gone, names.len()) {
        (true, 1) => "is gone",
        (true, _) => "are gone",
        (false, 1) => "was saved",
        (false, _) => "were saved",
    };
    format!("{} {happened}: ", names.join(", "))
}
