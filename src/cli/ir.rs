//! `kake ir`: the stages of a compilation as JSON.

use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::back::json;
use crate::diag::{self, Diagnostic};
use crate::geom::{Angle, Point, Rect};
use crate::lower::lower;
use crate::scene::{Paint, Scene};
use crate::{Config, PaintStages, compile, no_such_paint, paints};

use super::files::{Opened, open, print};
use super::{Ended, SceneArgs, report};

#[derive(Debug, Args)]
pub(super) struct IrArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Which stage
    #[arg(long, value_enum, default_value_t = Stage::Scene)]
    stage: Stage,
    /// Replace the scene's seed
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Print this paint alone
    #[arg(long, value_name = "PAINT")]
    only: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
enum Stage {
    /// The scene as it was lowered
    Scene,
    /// Where tiles lie
    Sites,
    /// Which are neighbours
    Graph,
    /// How they are turned, and their layers
    Angles,
    /// Their outlines
    Tiles,
    /// Everything that is drawn
    Drawing,
}

pub(super) fn run(arguments: &IrArgs) -> Ended {
    let opened = match open(&arguments.scene.scene, arguments.scene.root.as_deref()) {
        Ok(opened) => opened,
        Err(error) => return report::cannot_open(error),
    };
    let mut config = arguments.scene.config(arguments.seed);
    config.only.clone_from(&arguments.only);
    super::picture::take_over(&mut config, &opened);
    match arguments.stage {
        Stage::Drawing => drawing(&opened, &config),
        stage => passes(&opened, &config, stage),
    }
}

fn drawing(opened: &Opened, config: &Config) -> Ended {
    let compiled = compile(&opened.path, &opened.loader, config, &mut ());
    let ended = report::diagnostics(&compiled.lowered.diagnostics, &compiled.lowered.sources);
    let Some(drawing) = &compiled.drawing else { return ended };
    let mut out = Vec::new();
    match json::write(drawing, &mut out) {
        Ok(()) => print(&out),
        Err(error) => {
            eprintln!("kake: {error}");
            Ended::Io
        }
    }
}

fn passes(opened: &Opened, config: &Config, stage: Stage) -> Ended {
    let mut lowered = lower(&opened.path, &opened.loader, &config.lower);
    let mut found = Vec::new();
    let printed = match &lowered.scene {
        None => None,
        Some(scene) if stage == Stage::Scene => serde_json::to_vec(scene).ok(),
        Some(scene) => list(scene, config, stage, &mut found).and_then(|list| serde_json::to_vec(&list).ok()),
    };
    lowered.diagnostics.extend(found);
    diag::sort(&mut lowered.diagnostics);
    let ended = report::diagnostics(&lowered.diagnostics, &lowered.sources);
    match printed {
        Some(mut bytes) if ended == Ended::Done => {
            bytes.push(b'\n');
            print(&bytes)
        }
        _ => ended,
    }
}

#[derive(Serialize)]
struct Paints {
    paints: Vec<PaintIr>,
}

/// One paint as far as a stage knows it: the tiles whose sites lie in its region, numbered anew, and the links among
/// them, in millimetres and radians.
#[derive(Serialize)]
struct PaintIr {
    paint: String,
    tone: String,
    bounds: Rect,
    sites: Vec<Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    edges: Option<Vec<[usize; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    triangles: Option<Vec<[usize; 3]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    angles: Option<Vec<Angle>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    k: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tiles: Option<Vec<Vec<Vec<Point>>>>,
    /// The layers that are seen, where they are not just the nearest to k.
    #[serde(skip_serializing_if = "Option::is_none")]
    layers: Option<Vec<u8>>,
    /// Width and height of a page that repeats.
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<[f64; 2]>,
}

fn list(scene: &Scene, config: &Config, stage: Stage, found: &mut Vec<Diagnostic>) -> Option<Paints> {
    let names: Vec<String> = paints(scene).map(|paint| paint.name.clone()).collect();
    if let Some(only) = config.only.as_ref().filter(|only| !names.contains(only)) {
        found.push(no_such_paint(only, &names));
        return None;
    }
    let mut list = Vec::new();
    for paint in paints(scene).filter(|paint| config.only.as_ref().is_none_or(|only| paint.name == *only)) {
        match PaintStages::new(paint, &scene.canvas, &config.lower.limits, &mut (), found) {
            Ok(stages) => list.push(paint_ir(paint, &stages, stage)),
            Err(diagnostic) => {
                found.push(diagnostic);
                return None;
            }
        }
    }
    Some(Paints { paints: list })
}

fn paint_ir(paint: &Paint, stages: &PaintStages, stage: Stage) -> PaintIr {
    let inside = &stages.tiles.inside;
    let measured: Vec<usize> = (0..inside.len()).filter(|&site| inside[site]).collect();
    let mut numbers = vec![None; inside.len()];
    for (number, &site) in measured.iter().enumerate() {
        numbers[site] = Some(number);
    }
    let number = |site: u32| numbers[site as usize];
    let edges = || stages.graph.edges().filter_map(|[a, b]| Some([number(a)?, number(b)?])).collect();
    let triangles =
        || stages.graph.triangles.iter().filter_map(|&[a, b, c]| Some([number(a)?, number(b)?, number(c)?])).collect();
    let from = |least: Stage| stage >= least;
    let layers: Vec<u8> = measured.iter().map(|&site| stages.tiles.layers[site].seen()).collect();
    let nearest = measured.iter().map(|&site| (stages.tiles.k[site] + 0.5).floor());
    let is_nearest = layers.iter().zip(nearest).all(|(&layers, nearest)| f64::from(layers) == nearest);
    let period = stages.sites.period().map(|period| [period.width.to_mm(), period.height.to_mm()]);
    PaintIr {
        paint: paint.name.clone(),
        tone: paint.tone_name.clone(),
        bounds: paint.region.bounds(),
        sites: measured.iter().map(|&site| stages.sites.points[site]).collect(),
        edges: from(Stage::Graph).then(edges),
        triangles: from(Stage::Graph).then(triangles),
        angles: from(Stage::Angles).then(|| measured.iter().map(|&site| stages.angles.0[site]).collect()),
        k: from(Stage::Angles).then(|| measured.iter().map(|&site| stages.tiles.k[site]).collect()),
        tiles: from(Stage::Tiles)
            .then(|| measured.iter().map(|&site| vec![stages.tiles.outline(site).to_vec()]).collect()),
        layers: (from(Stage::Tiles) && !is_nearest).then_some(layers),
        period: period.filter(|_| from(Stage::Tiles)),
    }
}
