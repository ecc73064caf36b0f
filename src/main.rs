//! The command line `kake`.

use std::process::ExitCode;

fn main() -> ExitCode {
    kakeami::cli::run(std::env::args_os())
}
