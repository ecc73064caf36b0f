//! `kake new`: a library of tones, laid out and pinned.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::library::{LOCK, Lock, MANIFEST};
use crate::loader::is_name;

use super::Ended;
use super::files::plain;
use super::test::pin_all;

/// The files of a new library with their texts. `{{name}}` is the library's name and `{{version}}` the program's version.
const FILES: [(&str, &str); 11] = [
    (MANIFEST, include_str!("new/kake.toml")),
    ("README.md", include_str!("new/README.md")),
    (".gitattributes", include_str!("new/gitattributes")),
    (".gitignore", include_str!("new/gitignore")),
    (".github/workflows/kake.yml", include_str!("new/kake.yml")),
    ("tones/mist.kake", include_str!("new/tones/mist.kake")),
    ("tones/ripple.kake", include_str!("new/tones/ripple.kake")),
    ("tones/weave.kake", include_str!("new/tones/weave.kake")),
    ("swatches/mist.kake", include_str!("new/swatches/mist.kake")),
    ("swatches/ripple.kake", include_str!("new/swatches/ripple.kake")),
    ("swatches/weave.kake", include_str!("new/swatches/weave.kake")),
];

/// What the name of a draft begins and ends with.
const DRAFT: [&str; 2] = [".kake-", ".part"];

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// The folder to be made; it may be there already, if it is empty
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The library's name, where it is not the folder's
    #[arg(long)]
    name: Option<String>,
}

pub(super) fn run(arguments: &NewArgs) -> Ended {
    let folder = &arguments.folder;
    let name = match name(arguments) {
        Ok(name) => name,
        Err(words) => {
            eprintln!("kake: {words}");
            return Ended::Usage;
        }
    };
    let is_there = match fs::read_dir(folder) {
        // A draft that was broken off is nobody's work.
        Ok(mut entries) => match entries.find(|entry| !entry.as_ref().is_ok_and(is_draft)) {
            None => true,
            Some(_) => {
                eprintln!("kake: {} is not empty; nothing was written", folder.display());
                return Ended::Usage;
            }
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => false,
        Err(error) => {
            eprintln!("kake: cannot make a library in {}: {}", folder.display(), plain(&error));
            return Ended::Io;
        }
    };
    if let Err(words) = make(folder, &name) {
        eprintln!("kake: cannot make a library in {}: {words}", folder.display());
        if !is_there {
            // A folder that is not empty is not removed.
            let _ = fs::remove_dir(folder);
        }
        return Ended::Io;
    }
    let shown = folder.display();
    eprintln!("{name} is ready in {shown}: three tones with their swatches, pinned. Next:");
    let quote = if shown.to_string().contains(' ') { "\"" } else { "" };
    let go = if folder == Path::new(".") { String::new() } else { format!("cd {quote}{shown}{quote} && ") };
    eprintln!("  {go}git init && git config diff.kake.command \"kake diff\"");
    eprintln!("  change a tone, look with `kake preview swatches/weave.kake --open`, then run `kake test`");
    Ended::Done
}

/// Whether something was left behind by a `kake new` that was broken off.
fn is_draft(entry: &fs::DirEntry) -> bool {
    let name = entry.file_name().to_string_lossy().into_owned();
    name.starts_with(DRAFT[0]) && name.ends_with(DRAFT[1])
}

/// What the library is called.
fn name(arguments: &NewArgs) -> Result<String, String> {
    const RULE: &str = "names have 2 to 64 plain letters, digits, `-` and `_`, and begin with a letter";
    let good = |name: &str| match name.to_ascii_lowercase().as_str() {
        "std" => Err("`std:` names the libraries that come with the program".to_owned()),
        _ if is_name(name) => Ok(name.to_owned()),
        _ => Err(format!("`{name}` is no name of a library: {RULE}")),
    };
    if let Some(name) = &arguments.name {
        return good(name);
    }
    // `.` and `..` have the names of the folders they mean.
    let folder = arguments.folder.canonicalize().unwrap_or_else(|_| arguments.folder.clone());
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    good(&name).map_err(|words| format!("{words}; `--name NAME` gives it another name than its folder's"))
}

/// Makes the library beside its place, within the folder, and moves it there when it is whole.
fn make(folder: &Path, name: &str) -> Result<(), String> {
    let failed = |error: io::Error| plain(&error);
    fs::create_dir_all(folder).map_err(failed)?;
    let mut builder = tempfile::Builder::new();
    for left in fs::read_dir(folder).map_err(failed)?.flatten().filter(is_draft) {
        fs::remove_dir_all(left.path()).map_err(failed)?;
    }
    builder.prefix(DRAFT[0]).suffix(DRAFT[1]);
    permissions(&mut builder);
    let draft = builder.tempdir_in(folder).map_err(failed)?;
    for (file, text) in FILES {
        let target = draft.path().join(file);
        fs::create_dir_all(target.parent().unwrap_or(folder)).map_err(failed)?;
        let text = text.replace("{{name}}", name).replace("{{version}}", env!("CARGO_PKG_VERSION"));
        fs::write(target, text).map_err(failed)?;
    }
    fs::write(draft.path().join(LOCK), Lock::default().to_string()).map_err(failed)?;
    pin_all(draft.path())?;
    // The folder may have been filled meanwhile; nothing in it is replaced.
    let entries: Vec<_> = fs::read_dir(draft.path()).and_then(Iterator::collect).map_err(failed)?;
    let taken = entries.iter().find(|entry: &&fs::DirEntry| folder.join(entry.file_name()).symlink_metadata().is_ok());
    if let Some(taken) = taken {
        return Err(format!("{} is there already", taken.file_name().to_string_lossy()));
    }
    entries.iter().try_for_each(|entry| fs::rename(entry.path(), folder.join(entry.file_name()))).map_err(failed)
}

/// The folders of a draft are as open as any other that is made.
#[cfg(unix)]
fn permissions(builder: &mut tempfile::Builder<'_, '_>) {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(fs::Permissions::from_mode(0o777));
}

#[cfg(not(unix))]
fn permissions(_builder: &mut tempfile::Builder<'_, '_>) {}
