//! `kake explain`: what a code means.

use clap::Args;

use crate::diag::{Code, did_you_mean};

use super::Ended;
use super::files::print;

#[derive(Debug, Args)]
pub(super) struct ExplainArgs {
    /// The code, with or without `kake::`; all of them where it is left out
    code: Option<String>,
}

pub(super) fn run(arguments: &ExplainArgs) -> Ended {
    let Some(name) = &arguments.code else {
        let longest = Code::ALL.iter().map(|code| code.to_string().len()).max().unwrap_or(0);
        let lines: String =
            Code::ALL.iter().map(|code| format!("{:longest$}  {}\n", code.to_string(), code.title())).collect();
        return print(lines.as_bytes());
    };
    match Code::from_name(name) {
        Some(code) => print(format!("{code}: {}\n\n{}\n", code.title(), code.explanation()).as_bytes()),
        None => {
            let short = name.strip_prefix("kake::").unwrap_or(name);
            let near = did_you_mean(short, Code::ALL.iter().map(|code| code.name()));
            eprintln!("kake: there is no code `{name}`{}", near.map_or(String::new(), |near| format!("; {near}")));
            Ended::Usage
        }
    }
}
