//! `kake man`: manual pages, made of the same definitions as the options.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;

use super::files::{Pending, print, write_beside};
use super::{Cli, Ended, build};

#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// Where to: a folder that gets a page for the program and one for each command. By default the program's page goes to
    /// standard output
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(super) fn run(arguments: &ManArgs) -> Ended {
    let mut command = Cli::command();
    // The page of `kake help` would say what every page says.
    command = command.disable_help_subcommand(true);
    command.build();
    match &arguments.output {
        None => match page(&command) {
            Ok((_, text)) => print(&text),
            Err(error) => build::cannot_write(Path::new("-"), &error),
        },
        Some(folder) => match write(&command, folder) {
            Ok(()) => Ended::Done,
            Err((target, error)) => build::cannot_write(&target, &error),
        },
    }
}

/// A command's page, with its file name.
fn page(command: &Command) -> io::Result<(String, Vec<u8>)> {
    let man = Man::new(command.clone()).manual("Kakeami");
    let title = command.get_display_name().unwrap_or(command.get_name()).to_uppercase();
    let man = man.title(title);
    let mut text = Vec::new();
    man.render(&mut text)?;
    Ok((man.get_filename(), text))
}

/// Writes the pages of a command and of those below it, all or none.
fn write(command: &Command, folder: &Path) -> Result<(), (PathBuf, io::Error)> {
    fs::create_dir_all(folder).map_err(|error| (folder.to_owned(), error))?;
    let mut pending = Vec::new();
    for command in std::iter::once(command).chain(command.get_subcommands().filter(|command| !command.is_hide_set())) {
        let written = page(command).and_then(|(name, text)| {
            let target = folder.join(name);
            write_beside(&target, |out| out.write_all(&text))
        });
        pending.push(written.map_err(|error| (folder.join(command.get_name()), error))?);
    }
    pending.into_iter().try_for_each(Pending::keep).map_err(|error| (folder.to_owned(), error))
}
