//! `kake params`: a scene's parameters as JSON Schema.

use clap::Args;

use crate::lower::{lower, schema};

use super::files::{open, print};
use super::{Ended, SceneArgs, report};

#[derive(Debug, Args)]
pub(super) struct ParamsArgs {
    #[command(flatten)]
    scene: SceneArgs,
}

pub(super) fn run(arguments: &ParamsArgs) -> Ended {
    let opened = match open(&arguments.scene.scene, arguments.scene.root.as_deref()) {
        Ok(opened) => opened,
        Err(error) => return report::cannot_open(error),
    };
    let mut config = arguments.scene.config(None);
    super::picture::take_over(&mut config, &opened);
    let lowered = lower(&opened.path, &opened.loader, &config.lower);
    let ended = report::diagnostics(&lowered.diagnostics, &lowered.sources);
    match &lowered.scene {
        Some(scene) => print(format!("{:#}\n", schema(&opened.path, &scene.params)).as_bytes()),
        None => ended,
    }
}
