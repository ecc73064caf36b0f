//! A drawing for the page: what is wanted goes in, what came of it comes out as JSON. The picture itself is kept and
//! fetched by its name.

use std::sync::{Arc, Mutex, OnceLock};
use std::time::Instant;

use serde_json::{Value, json};

use crate::back::svg;
use crate::diag::{Code, Diagnostic};
use crate::drawing::Drawing;
use crate::lower::Lowered;
use crate::scene::{Param, ParamDomain, ParamValue, Scene};
use crate::span::Sources;
use crate::stop::Stop;
use crate::{Observer, Step, paints};

use super::command::command;
use super::diagnostics::listed;
use super::pictures::{Picture, points};
use super::session::{Made, Seed, Session, Unmade, Wanted, locked};
use super::write_back::is_locked;
use crate::syntax::edit;

/// SVG of so many bytes at most is shown as it is; what is larger is shown by tiles.
const LARGEST_SVG: usize = 1_500_000;

/// A point takes at least so many bytes of SVG: what would be too large anyhow need not be written.
const POINT: usize = 3;

/// What a drawing takes in memory for each of its points, its index included.
const POINT_MEMORY: usize = 24;

/// Where a drawing is, for whoever waits for it.
#[derive(Debug, Clone, Default)]
pub(super) struct Progress(Arc<Mutex<(&'static str, String)>>);

impl Progress {
    /// The step that is being taken, and the paint it is taken for.
    pub(super) fn step(&self) -> (&'static str, String) {
        locked(&self.0).clone()
    }
}

/// What each step took.
struct Steps {
    begun: Instant,
    spent: Vec<(&'static str, f64)>,
    current: Option<(&'static str, Instant)>,
    progress: Progress,
}

impl Steps {
    fn new(progress: Progress) -> Self {
        Self { begun: Instant::now(), spent: Vec::new(), current: None, progress }
    }

    fn begin_named(&mut self, name: &'static str, paint: &str) {
        self.end();
        self.current = Some((name, Instant::now()));
        *locked(&self.progress.0) = (name, paint.to_owned());
    }

    fn end(&mut self) {
        let Some((name, since)) = self.current.take() else { return };
        let spent = milliseconds(since);
        match self.spent.iter_mut().find(|(known, _)| *known == name) {
            Some((_, total)) => *total += spent,
            None => self.spent.push((name, spent)),
        }
    }

    fn to_json(&self) -> Value {
        self.spent.iter().map(|(name, spent)| json!([name, rounded(*spent)])).collect()
    }
}

impl Observer for Steps {
    fn begin(&mut self, step: Step, paint: &str) {
        self.begin_named(step.name(), paint);
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1000.0
}

fn rounded(milliseconds: f64) -> f64 {
    (milliseconds * 100.0).round() / 100.0
}

/// Draws, keeps the picture, and says what came of it.
///
/// # Errors
/// In words, where what is wanted makes no sense.
pub(super) fn draw(session: &Session, wanted: &Wanted, stop: &Stop, progress: Progress) -> Result<Value, String> {
    let mut steps = Steps::new(progress);
    let made = match session.make(wanted, stop, &mut steps) {
        Ok(made) => made,
        Err(Unmade::Nonsense(words)) => return Err(words),
        Err(Unmade::NoScene(words)) => {
            let diagnostic =
                Diagnostic::without_span(Code::File, words).hint("it is shown again as soon as it is back");
            return Ok(at_fault(session, &[diagnostic], &Sources::new(), &steps));
        }
        Err(Unmade::Manifest(faults)) => {
            return Ok(at_fault(session, &faults.diagnostics, &faults.sources, &steps));
        }
    };
    let Made { opened, config, compiled, revision } = made;
    let lowered = compiled.lowered;
    if !stop.is_asked()
        && let Some((_, source)) = lowered.sources.iter().next()
    {
        session.last().text = Some((revision, Arc::clone(&source.text)));
    }
    let (Some(drawing), Some(scene)) = (compiled.drawing, lowered.scene.as_ref()) else {
        let mut answer = at_fault(session, &lowered.diagnostics, &lowered.sources, &steps);
        answer["revision"] = json!(revision);
        answer["command"] = json!(command(session, &config));
        return Ok(answer);
    };
    let layers: Vec<Value> = drawing.layers.iter().map(layer).collect();
    let shown = json!({
        "seed": Seed(scene.seed).to_json(),
        "tiles": compiled.tiles,
        "marks": drawing.layers.iter().map(|layer| layer.marks()).sum::<u64>(),
        "page": page(&drawing),
        "layers": layers,
        "paints": paints(scene).map(|paint| paint.name.as_str()).collect::<Vec<_>>(),
        "params": params(scene, &lowered),
    });
    steps.begin_named("svg", "");
    let points = points(&drawing);
    let svg = (points * POINT <= LARGEST_SVG).then(|| written(&drawing)).flatten();
    steps.end();
    let bytes = svg.as_ref().map(|svg| svg.len());
    let is_small = bytes.is_some_and(|bytes| bytes <= LARGEST_SVG);
    let picture = Picture {
        drawing,
        scene: scene.clone(),
        svg: svg.filter(|_| is_small).map_or_else(OnceLock::new, |svg| OnceLock::from(Arc::from(svg))),
        index: OnceLock::new(),
        only: config.only.clone(),
        tiles: compiled.tiles,
    };
    let id = session.pictures().keep(picture, points * POINT_MEMORY + bytes.unwrap_or(0));
    session.last().good = Some(shown.clone());
    let mut answer = shown;
    let rest = json!({
        "id": format!("{}-{id}", session.name),
        "ok": true,
        "ms": rounded(milliseconds(steps.begun)),
        "steps": steps.to_json(),
        "revision": revision,
        "show": if is_small { "svg" } else { "tiles" },
        "bytes": bytes,
        "diagnostics": listed(&lowered.diagnostics, &lowered.sources),
        "sources": sources(&lowered.sources),
        "command": command(session, &config),
        "writable": opened.picture.is_none()
            && !opened.loader.place(&opened.path).is_some_and(|file| is_locked(&file)),
    });
    merge(&mut answer, rest);
    Ok(answer)
}

/// The answer where there is no drawing: what is wrong, beside what was shown last.
fn at_fault(session: &Session, diagnostics: &[Diagnostic], sources: &Sources, steps: &Steps) -> Value {
    let mut answer = json!({
        "seed": null, "tiles": 0, "marks": 0, "page": null, "layers": [], "paints": [], "params": [],
    });
    if let Some(good) = &session.last().good {
        merge(&mut answer, good.clone());
    }
    merge(
        &mut answer,
        json!({
            "id": null,
            "ok": false,
            "ms": rounded(milliseconds(steps.begun)),
            "steps": steps.to_json(),
            "revision": session.revision(),
            "show": null,
            "bytes": null,
            "diagnostics": listed(diagnostics, sources),
            "sources": self::sources(sources),
            "command": null,
            "writable": false,
        }),
    );
    answer
}

/// Takes over every entry of another object.
fn merge(into: &mut Value, from: Value) {
    if let (Value::Object(into), Value::Object(from)) = (into, from) {
        into.extend(from);
    }
}

/// A drawing as SVG without metadata.
pub(super) fn written(drawing: &Drawing) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    svg::write(drawing, None, &mut out).ok()?;
    Some(out)
}

fn page(drawing: &Drawing) -> Value {
    let page = &drawing.page;
    json!({
        "width": page.width.to_mm(),
        "height": page.height.to_mm(),
        "pixels": page.pixels,
        "paper": page.paper.map(|paper| paper.hex()),
    })
}

fn layer(layer: &crate::drawing::Layer) -> Value {
    json!({ "name": layer.name, "groups": layer.groups, "ink": layer.ink.hex(), "marks": layer.marks() })
}

/// The texts that the page shows: the scene and its imports.
fn sources(sources: &Sources) -> Value {
    let shown = sources.iter().filter(|(_, source)| !source.name.starts_with("--") && !source.name.starts_with("std:"));
    shown.map(|(_, source)| json!({ "name": source.name, "text": &*source.text })).collect()
}

fn params(scene: &Scene, lowered: &Lowered) -> Value {
    let own = lowered.sources.iter().next().map(|(id, source)| edit::params(id, source)).unwrap_or_default();
    scene.params.iter().map(|param| self::param(param, own.contains(&param.name))).collect()
}

fn param(param: &Param, here: bool) -> Value {
    let (kind, unit, factor) = match param.ty.as_str() {
        "number" => ("number", "", 1.0),
        "length" => ("length", "mm", 1.0),
        "angle" => ("angle", "deg", 180.0 / std::f64::consts::PI),
        "percentage" => ("percentage", "%", 100.0),
        "colour" => ("colour", "", 1.0),
        "string" => ("string", "", 1.0),
        "bool" => ("bool", "", 1.0),
        _ => ("other", "", 1.0),
    };
    // Rounding takes away the last bits that a conversion of units leaves.
    let number = |value: &ParamValue| value.number.map(|number| (number * factor * 1e9).round() / 1e9);
    let (range, choices) = match &param.domain {
        Some(ParamDomain::Range(from, to)) => {
            (json!({ "from": number(from), "to": number(to), "unit": unit }), Value::Null)
        }
        Some(ParamDomain::Choices(choices)) => (Value::Null, choices.iter().map(text).collect()),
        None => (Value::Null, Value::Null),
    };
    json!({
        "name": param.name,
        "kind": kind,
        "default": text(&param.default),
        "value": text(&param.value),
        "doc": param.doc,
        "range": range,
        "choices": choices,
        "here": here,
    })
}

/// A value as `--set` takes it: strings without quotes, unless they begin with one.
fn text(value: &ParamValue) -> &str {
    match &value.string {
        Some(string) if !string.trim_start().starts_with('"') => string,
        _ => &value.text,
    }
}
