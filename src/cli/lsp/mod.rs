//! `kake lsp`: the Language Server Protocol on standard input and output.
//!
//! One thread reads messages, one looks at scenes, and this one answers: [`wire`] frames messages, [`server`] keeps what is
//! open and what is asked, [`drafts`] lets texts that are being written stand in for files, [`answers`] asks
//! [`crate::lsp`], [`renaming`] looks at all scenes of a library.

mod address;
mod answers;
mod drafts;
mod renaming;
mod server;
mod wire;
mod worker;

use std::sync::mpsc;
use std::thread;

use clap::Args;

use super::Ended;
use server::{Event, Server};

#[derive(Debug, Args)]
pub(super) struct LspArgs {
    /// Speak over standard input and output, as is always done: editors say so
    #[arg(long)]
    stdio: bool,
}

pub(super) fn run(arguments: &LspArgs) -> Ended {
    // There is no other way to speak; the switch is there for editors that pass it.
    let LspArgs { stdio: _ } = arguments;
    let (events, inbox) = mpsc::channel();
    let incoming = events.clone();
    // The thread that reads ends with the process: nothing can wake it while the editor says nothing.
    let reading = thread::Builder::new().spawn(move || {
        let mut input = std::io::stdin().lock();
        loop {
            let event = match wire::read(&mut input) {
                wire::Incoming::Message(message) => Event::Message(message),
                wire::Incoming::Nonsense(words) => Event::Nonsense(words),
                wire::Incoming::End => Event::End,
            };
            let is_end = matches!(event, Event::End);
            if incoming.send(event).is_err() || is_end {
                return;
            }
        }
    });
    if let Err(error) = reading {
        eprintln!("kake: cannot start a thread: {}", super::files::plain(&error));
        return Ended::Io;
    }
    match Server::new(events) {
        Ok(server) => server.run(&inbox),
        Err(error) => {
            eprintln!("kake: cannot start a thread: {}", super::files::plain(&error));
            Ended::Io
        }
    }
}
