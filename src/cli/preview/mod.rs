//! `kake preview`: a scene in a browser, drawn again whenever it is saved.
//!
//! A server on the loopback address answers one page, which lies inside the program. [`server`] says who may ask what,
//! [`session`] holds the scene and what was drawn of it, [`job`] runs what takes long.

mod assets;
mod command;
mod diagnostics;
mod draw;
mod job;
mod measure;
mod pictures;
mod save;
mod server;
mod session;
mod tiles;
mod write_back;

use std::io::{self, ErrorKind, Write};
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};

use clap::Args;
use tokio::runtime::Runtime;

use self::server::{Served, router};
use self::session::{Session, Settings};
use super::files::{open, plain};
use super::{Ended, SceneArgs, limits, report};

#[derive(Debug, Args)]
pub(super) struct PreviewArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Begin with this seed instead of the scene's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// The port to serve on; by default one that is free
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_port)]
    port: u16,
    /// Open the page in the browser
    #[arg(long)]
    open: bool,
    /// The folder that pictures are saved in; by default this one
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

pub(super) fn run(arguments: &PreviewArgs) -> Ended {
    let scene = &arguments.scene.scene;
    // What cannot be opened at all is said before a browser shows it.
    if scene != Path::new("-")
        && let Err(error) = open(scene, arguments.scene.root.as_deref())
    {
        return report::cannot_open(error);
    }
    match serve(arguments) {
        Ok(()) => Ended::Done,
        Err((words, ended)) => {
            eprintln!("kake: {words}");
            ended
        }
    }
}

/// Serves until it is ended.
fn serve(arguments: &PreviewArgs) -> Result<(), (String, Ended)> {
    let io = |words: String| (words, Ended::Io);
    let settings = settings(arguments)?;
    let listener = listen(arguments.port).map_err(io)?;
    let port = listener.local_addr().map_err(|error| io(plain(&error)))?.port();
    let session = Session::start(settings).map_err(io)?;
    let url = format!("http://127.0.0.1:{port}/");
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
    let runtime = runtime.map_err(|error| io(format!("cannot start the server: {}", plain(&error))))?;
    let ended = runtime.block_on(async {
        let ending = ending().map_err(|error| io(format!("cannot wait for Ctrl-C: {}", plain(&error))))?;
        let listener = tokio::net::TcpListener::from_std(listener).map_err(|error| io(plain(&error)))?;
        let served = Served { session: session.clone(), port };
        let serving = axum::serve(listener, router(served));
        // A reader that has gone away is no failure.
        let mut out = io::stdout().lock();
        let _ = writeln!(out, "{url}").and_then(|()| out.flush());
        drop(out);
        eprintln!("kake: {} is shown there; Ctrl-C ends it", session.settings.given.display());
        if arguments.open
            && let Err(error) = open::that_detached(&url)
        {
            eprintln!("kake: cannot open a browser: {}", plain(&error));
        }
        tokio::select! {
            served = async { serving.await } => served.map_err(|error| io(plain(&error))),
            () = ending => Ok(()),
        }
    });
    end(runtime, &session);
    ended
}

/// Ends at once, but for a file that is being written.
fn end(runtime: Runtime, session: &Session) {
    let _writing = session.writing();
    runtime.shutdown_background();
}

/// Waits until the user, or the system, asks for an end.
#[cfg(unix)]
fn ending() -> io::Result<impl Future<Output = ()>> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut interrupt = signal(SignalKind::interrupt())?;
    let mut terminate = signal(SignalKind::terminate())?;
    let mut hang_up = signal(SignalKind::hangup())?;
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hang_up.recv() => {}
        }
    })
}

#[cfg(not(unix))]
fn ending() -> io::Result<impl Future<Output = ()>> {
    let mut interrupt = tokio::signal::windows::ctrl_c()?;
    Ok(async move {
        interrupt.recv().await;
    })
}

/// Checks what the command line says.
fn settings(arguments: &PreviewArgs) -> Result<Settings, (String, Ended)> {
    let given = arguments.scene.scene.clone();
    if given == Path::new("-") {
        return Err(("a preview follows a file; save the scene to one".to_owned(), Ended::Usage));
    }
    let scene = std::path::absolute(&given).map_err(|error| (plain(&error), Ended::Io))?;
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from("."));
    let output = folder
        .canonicalize()
        .map_err(|error| (format!("pictures cannot be saved in {}: {}", folder.display(), plain(&error)), Ended::Io))?;
    if !output.is_dir() {
        return Err((format!("pictures cannot be saved in {}: it is no folder", folder.display()), Ended::Io));
    }
    Ok(Settings {
        scene,
        given,
        root: arguments.scene.root.clone(),
        sets: arguments.scene.set.clone(),
        seed: arguments.seed,
        limits: arguments.scene.limits(),
        arguments: limits::written(&arguments.scene),
        output,
    })
}

fn parse_port(text: &str) -> Result<u16, String> {
    text.parse().map_err(|_| "a port is a whole number from 0 to 65535, 0 for one that is free".to_owned())
}

/// Takes a port of the loopback address.
fn listen(port: u16) -> Result<TcpListener, String> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| match error.kind() {
        ErrorKind::AddrInUse => {
            format!("port {port} is in use, perhaps by another preview; without `--port` a free one is taken")
        }
        ErrorKind::PermissionDenied => {
            format!("port {port} is the system's own; without `--port` a free one is taken")
        }
        _ => format!("cannot listen on port {port}: {}", plain(&error)),
    })?;
    listener.set_nonblocking(true).map_err(|error| plain(&error))?;
    Ok(listener)
}
