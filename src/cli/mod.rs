//! The command line: arguments in, files and words out. Everything that touches a terminal, a clock or a file is here.
//!
//! Results go to standard output, words about them to standard error. Exit status: 0 done; 1 the scene is at fault; 2 the
//! command line is; 3 reading or writing failed.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod build;
mod check;
mod convert;
mod experiment;
mod explain;
mod files;
mod fmt;
mod ir;
mod limits;
mod lock;
mod lsp;
mod man;
mod metrics;
mod new;
mod packages;
mod params;
mod picture;
mod progress;
mod report;
mod test;
mod wedge;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, CommandFactory, Parser, Subcommand};

use crate::Config;
use crate::lower::LowerConfig;
use crate::scene::Limits;

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ended {
    /// All is done.
    Done,
    /// The scene, or a check of it, is at fault.
    Fault,
    /// The command line is at fault.
    Usage,
    /// Reading or writing failed.
    Io,
}

impl From<Ended> for ExitCode {
    fn from(ended: Ended) -> Self {
        Self::from(match ended {
            Ended::Done => 0,
            Ended::Fault => 1,
            Ended::Usage => 2,
            Ended::Io => 3,
        })
    }
}

/// What ends the help and the manual page of the program.
const EXIT_STATUS: &str = "\
Exit status: 0 done; 1 the scene is at fault, or a test, check or comparison of it failed; 2 the command line is at fault; \
3 reading or writing failed.

Results go to standard output, words about them to standard error. `-` is standard input or output.";

/// A compiler for kakeami, manga's hand-hatched tone
///
/// Kakeami is manga's hatching: small tiles of parallel strokes, each turned against its neighbours. A scene, in a small
/// language or in TOML, describes regions, tile shapes, fills, fields and seeds; what comes out is SVG, PNG or PDF.
#[derive(Debug, Parser)]
#[command(name = "kake", version, max_term_width = 100, arg_required_else_help = true, after_long_help = EXIT_STATUS)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compile a scene to a picture
    Build(build::BuildArgs),
    /// Say what is wrong with scenes, without drawing them
    Check(check::CheckArgs),
    /// Bring scenes into their canonical form
    Fmt(fmt::FmtArgs),
    /// Convert a scene between .kake and .toml
    Convert(convert::ConvertArgs),
    /// Print a stage of a scene's compilation as JSON
    Ir(ir::IrArgs),
    /// Print a scene's parameters as JSON Schema
    Params(params::ParamsArgs),
    /// Print what a scene's patterns measure. The scene may also be a .json file as `kake ir --stage tiles` prints it
    Metrics(metrics::MetricsArgs),
    /// Draw the calibration wedge of a tone, and print what its steps measure
    Wedge(wedge::WedgeArgs),
    /// Run a scene's experiment: every condition with every seed, measured, analysed and pictured
    Experiment(Box<experiment::ExperimentArgs>),
    /// Make a library of tones in a new folder: kake.toml, tones, swatches, pins, and files for git and a build server
    New(new::NewArgs),
    /// Say which swatches of a library do not look as they were pinned
    Test(test::TestArgs),
    /// Lock what a library depends on: writes the hashes of its dependencies into kake.lock
    Lock(lock::LockArgs),
    /// Explain a diagnostic's code, or list them all
    Explain(explain::ExplainArgs),
    /// Serve editors: the Language Server Protocol on standard input and output
    Lsp(lsp::LspArgs),
    /// Print a completion script for a shell
    Completions(CompletionsArgs),
    /// Print the manual page, or write one for each command
    Man(man::ManArgs),
}

#[derive(Debug, Args)]
struct CompletionsArgs {
    /// The shell
    shell: clap_complete::Shell,
}

/// What every command that reads a scene knows.
#[derive(Debug, Args)]
struct SceneArgs {
    /// The scene: a .kake or .toml file, a picture that holds one, or - for standard input
    scene: PathBuf,
    /// Set a parameter: NAME=VALUE
    #[arg(long, value_name = "NAME=VALUE", value_parser = limits::parse_set)]
    set: Vec<(String, String)>,
    /// The folder whose files the scene may read
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Lift a limit: tiles, strokes, iterations, megapixels, nesting or runs
    #[arg(long, value_name = "NAME=N", value_parser = limits::parse_limit)]
    limit: Vec<(limits::Limit, u64)>,
}

impl SceneArgs {
    fn limits(&self) -> Limits {
        limits::apply(&self.limit)
    }

    /// The configuration that the arguments ask for.
    fn config(&self, seed: Option<u64>) -> Config {
        let lower = LowerConfig { sets: self.set.clone(), seed, dpi: None, limits: self.limits() };
        Config { lower, only: None, overlays: Vec::new() }
    }
}

/// Runs the command line and says how it ended.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are results; whatever else clap says is about the command line.
            let ended = if error.use_stderr() { Ended::Usage } else { Ended::Done };
            return if error.print().is_ok() { ended.into() } else { Ended::Io.into() };
        }
    };
    let ended = match cli.command {
        Command::Build(arguments) => build::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Fmt(arguments) => fmt::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Ir(arguments) => ir::run(&arguments),
        Command::Params(arguments) => params::run(&arguments),
        Command::Metrics(arguments) => metrics::run(&arguments),
        Command::Wedge(arguments) => wedge::run(&arguments),
        Command::Experiment(arguments) => experiment::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Test(arguments) => test::run(&arguments),
        Command::Lock(arguments) => lock::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Lsp(arguments) => lsp::run(&arguments),
        Command::Completions(arguments) => {
            let mut script = Vec::new();
            clap_complete::generate(arguments.shell, &mut Cli::command(), "kake", &mut script);
            files::print(&script)
        }
        Command::Man(arguments) => man::run(&arguments),
    };
    ended.into()
}
