//! Lowering: from documents to a scene.
//!
//! In: the path of a scene, a loader, the parameters that were set. Out: a [`Scene`] in which every name, unit, type and
//! parameter is resolved, or every independent mistake that was found on the way.
//!
//! One evaluator serves for both. Code that cannot run (a branch not taken, a function's body, a tone that nothing paints
//! with) is evaluated with unknown values: names, arguments and kinds are checked, ranges are not.

mod branch;
mod call;
mod canvas;
mod convert;
mod cx;
mod draw;
mod eval;
mod experiment;
mod files;
mod function;
mod ground;
mod library;
mod modules;
mod names;
mod ops;
mod params;
mod properties;
pub mod reference;
mod repeat;
mod scope;
mod survey;
mod tone;
mod value;
mod vocabulary;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::diag::{self, Code, Diagnostic};
use crate::loader::Loader;
use crate::scene::{Limits, Scene};
use crate::span::{Sources, Span};
use crate::syntax::ast::StatementKind;

pub use params::schema;
pub use survey::{Survey, Worth};

use cx::Cx;

/// What the caller decides about a scene.
#[derive(Debug, Clone, Default)]
pub struct LowerConfig {
    /// Parameters with the values they are given, as expressions of the language; bare words will do for strings.
    pub sets: Vec<(String, String)>,
    /// Replaces the scene's seed.
    pub seed: Option<u64>,
    /// Replaces the canvas's resolution.
    pub dpi: Option<f64>,
    /// What the scene may use.
    pub limits: Limits,
}

/// What lowering found.
#[derive(Debug)]
pub struct Lowered {
    /// The scene, unless there are errors.
    pub scene: Option<Scene>,
    /// Errors and warnings in the order of the sources.
    pub diagnostics: Vec<Diagnostic>,
    /// Every text that was read, the scene's own first.
    pub sources: Sources,
    /// Every other file that was read, by its path from the root.
    pub files: BTreeMap<String, Arc<[u8]>>,
    /// Where the canvas is declared, for limits that are met later.
    pub canvas_span: Option<Span>,
}

/// Reads and lowers the scene at `path`, a path from the loader's root.
///
/// Every independent mistake is reported; the scene is there only if none of them is an error.
#[must_use]
pub fn lower(path: &str, loader: &dyn Loader, config: &LowerConfig) -> Lowered {
    on_a_deep_stack(|| lower_here(path, loader, config, None).0)
}

/// Lowers the scene at `path` and says what its names mean, as far as that could be found out.
#[must_use]
pub fn survey(path: &str, loader: &dyn Loader, config: &LowerConfig) -> (Lowered, Survey) {
    on_a_deep_stack(|| lower_here(path, loader, config, Some(Box::default())))
}

/// Runs what evaluates with room for values that lead into each other.
fn on_a_deep_stack<T: Send>(run: impl Fn() -> T + Sync) -> T {
    // Values lead into each other as deep as the limits allow, which the stack of a small thread has no room for.
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK);
        match thread.spawn_scoped(scope, &run) {
            Ok(running) => match running.join() {
                Ok(result) => result,
                Err(panic) => std::panic::resume_unwind(panic),
            },
            // Where no thread can be had, the stack at hand has to do.
            Err(_) => run(),
        }
    })
}

/// Bytes of stack for lowering; only what is used is taken from the machine.
const STACK: usize = 256 << 20;

fn lower_here(
    path: &str,
    loader: &dyn Loader,
    config: &LowerConfig,
    surveyed: Option<Box<Survey>>,
) -> (Lowered, Survey) {
    let mut sources = Sources::new();
    let mut diagnostics = Vec::new();
    let files = modules::read(path, loader, &mut sources, &mut diagnostics);
    let sets: Vec<_> = params::parse_sets(config, &mut sources, &mut diagnostics);
    let modules = modules::declare(&files, &mut diagnostics);
    let (mut lowered, surveyed) = match modules.is_empty() {
        true => (Lowered { scene: None, diagnostics, sources, files: BTreeMap::new(), canvas_span: None }, None),
        false => {
            let mut cx = Cx::new(&modules, loader, config, diagnostics);
            cx.survey = surveyed;
            let scene = scene(&mut cx, &sets);
            let surveyed = cx.survey.take();
            let (diagnostics, files) = cx.finish();
            let canvas_span = files_canvas(&modules);
            (Lowered { scene, diagnostics, sources, files, canvas_span }, surveyed)
        }
    };
    if config.limits.stop.is_asked() {
        lowered.diagnostics.push(Diagnostic::without_span(Code::Limit, "the reading of the scene was stopped"));
    }
    diag::sort(&mut lowered.diagnostics);
    if lowered.diagnostics.iter().any(Diagnostic::is_error) {
        lowered.scene = None;
    }
    let survey = surveyed.map(|survey| modules::surveyed(files, *survey)).unwrap_or_default();
    (lowered, survey)
}

/// Where the first module declares its canvas.
fn files_canvas(modules: &[modules::Module<'_>]) -> Option<Span> {
    modules.first()?.document.statements.iter().find_map(|statement| match statement.kind {
        StatementKind::Canvas(_) => Some(statement.span),
        _ => None,
    })
}

/// Lowers the first module with all it imports.
fn scene<'a>(cx: &mut Cx<'a, '_>, sets: &'a [params::Set]) -> Option<Scene> {
    let canvas = canvas::lower(cx);
    params::apply(cx, sets);
    let seed = canvas::seed(cx);
    cx.seed = cx.config.seed.or(seed).unwrap_or(0);
    modules::check_declarations(cx);
    let draws = draw::lower(cx);
    let params = params::list(cx);
    let experiments = experiment::lower(cx);
    let canvas = match canvas {
        Some(canvas) => canvas,
        None if draws.is_empty() => canvas::default(),
        None => {
            cx.missing_canvas();
            return None;
        }
    };
    Some(Scene { canvas, seed: cx.seed, params, draws, experiments })
}

impl Cx<'_, '_> {
    /// Says that a scene that draws has no canvas, unless a canvas was written and is at fault itself.
    fn missing_canvas(&mut self) {
        let Some(module) = self.modules.first() else { return };
        if files_canvas(self.modules).is_some() {
            return;
        }
        let first = module.document.statements.iter().find(|s| draw::is_drawing(&s.kind));
        if let Some(statement) = first {
            let diagnostic = Diagnostic::error(Code::Missing, statement.span, "a scene that draws needs a canvas")
                .label("drawn on what?")
                .hint("put `canvas { size: a4 }` or `canvas { size: (60mm, 60mm) }` at the top");
            self.report(diagnostic);
        }
    }
}
