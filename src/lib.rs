//! Kakeami: a compiler for manga's hand-hatched tone.
//!
//! A scene, written in a small language or in TOML, describes regions, tile shapes, fills, fields and seeds; what comes
//! out is clean hatching as SVG or PNG. The same scene gives the same bytes on every run.
//!
//! ```
//! use kakeami::loader::MemoryLoader;
//!
//! let text = "canvas { size: (20mm, 20mm) }
//!             tone plain { place: poisson(radius: 4mm) fill: lines(pitch: 0.8mm) k: 2 }
//!             paint canvas with plain";
//! let mut loader = MemoryLoader::default();
//! loader.files.insert("sheet.kake".to_owned(), text.as_bytes().into());
//!
//! let compiled = kakeami::compile("sheet.kake", &loader, &kakeami::Config::default(), &mut ());
//! let drawing = compiled.drawing.expect("the scene is without fault");
//! let mut svg = Vec::new();
//! kakeami::back::svg::write(&drawing, None, &mut svg).expect("memory takes all that is written");
//! assert!(svg.starts_with(b"<svg"));
//! ```
//!
//! The pipeline: [`syntax`] reads a [`syntax::ast::Document`], [`lower`] makes a [`scene::Scene`] of it, the passes in
//! [`pass`] go through [`stage`]'s types to a [`drawing::Drawing`], and [`back`] writes that out. The library touches no
//! terminal, no clock and, but for a [`loader::Loader`], no file.

pub mod back;
pub mod chart;
#[doc(hidden)]
pub mod cli;
pub mod compare;
pub mod diag;
pub mod drawing;
pub mod experiment;
pub mod field;
pub mod geom;
pub mod illustrate;
pub mod library;
pub mod loader;
pub mod lower;
pub mod lsp;
pub mod metrics;
pub mod overlay;
pub mod pass;
pub mod random;
pub mod region;
pub mod scene;
pub mod span;
pub mod stage;
pub mod stats;
pub mod stop;
pub mod syntax;
pub mod wedge;

use diag::{Code, Diagnostic};
use drawing::Drawing;
use loader::Loader;
use lower::{LowerConfig, Lowered};
use overlay::{Overlay, Pattern};
use pass::draw::{Assembly, Item, Stages, items};
use pass::{cut, link, place, turn};
use scene::{Canvas, Depth, Limits, Paint, Scene};
use span::Span;
use stage::{Angles, Graph, Sites, Tiles};

/// What the caller decides about a compilation.
#[derive(Debug, Clone, Default)]
pub struct Config {
    /// Parameters, seed, resolution and limits.
    pub lower: LowerConfig,
    /// The paint that is drawn alone, where not all are.
    pub only: Option<String>,
    /// What is shown of the patterns on top of the picture. With any of them a raster has all levels, whatever the canvas
    /// says.
    pub overlays: Vec<Overlay>,
}

/// The steps of a compilation, for whoever watches it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// Reading and lowering the scene.
    Lower,
    /// Placing sites.
    Place,
    /// Linking neighbours.
    Link,
    /// Assigning angles.
    Turn,
    /// Cutting tiles.
    Cut,
    /// Drawing strokes.
    Draw,
}

impl Step {
    /// Every step in order.
    pub const ALL: [Self; 6] = [Self::Lower, Self::Place, Self::Link, Self::Turn, Self::Cut, Self::Draw];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Place => "place",
            Self::Link => "link",
            Self::Turn => "turn",
            Self::Cut => "cut",
            Self::Draw => "draw",
        }
    }
}

/// Is told of every step of a compilation before it is taken: for progress bars and timings.
pub trait Observer {
    /// A step begins, for the paint of this name (empty for the whole scene).
    fn begin(&mut self, step: Step, paint: &str);
}

/// Nobody watches.
impl Observer for () {
    fn begin(&mut self, _step: Step, _paint: &str) {}
}

/// What a compilation found.
#[derive(Debug)]
pub struct Compiled {
    /// The picture, unless there are errors.
    pub drawing: Option<Drawing>,
    /// The scene with every diagnostic, the passes' included, every text and every file that was read.
    pub lowered: Lowered,
}

/// Compiles the scene at `path`, a path from the loader's root, to a drawing.
///
/// Mistakes are in `lowered.diagnostics`; the drawing is there only if none of them is an error, and if `config`'s
/// [`stop::Stop`] was not asked meanwhile.
#[must_use]
pub fn compile(path: &str, loader: &dyn Loader, config: &Config, observer: &mut dyn Observer) -> Compiled {
    observer.begin(Step::Lower, "");
    let mut lowered = lower::lower(path, loader, &config.lower);
    let Some(scene) = &lowered.scene else { return Compiled { drawing: None, lowered } };
    let mut diagnostics = Vec::new();
    // What concerns the whole scene is said at its first character.
    let start = lowered.sources.iter().next().map(|(source, _)| Span::new(source, 0, 0));
    let drawing = draw(scene, start, config, observer, &mut diagnostics);
    lowered.diagnostics.extend(diagnostics);
    diag::sort(&mut lowered.diagnostics);
    Compiled { drawing, lowered }
}

/// Draws a scene. Limits that are met and warnings go to `diagnostics`.
fn draw(
    scene: &Scene,
    start: Option<Span>,
    config: &Config,
    observer: &mut dyn Observer,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Drawing> {
    let (canvas, limits) = (&scene.canvas, &config.lower.limits);
    let mut items = items(scene);
    if let Some(only) = &config.only {
        let names: Vec<String> = paints(scene).map(|paint| paint.name.clone()).collect();
        items.retain(|(_, item)| matches!(item, Item::Paint(paint) if paint.name == *only));
        if items.is_empty() {
            diagnostics.push(no_such_paint(only, &names));
            return None;
        }
    }
    if items.is_empty() {
        let message = "the scene draws nothing";
        let hint = "`paint REGION with TONE` does; a library of tones is imported by a scene that paints";
        let diagnostic = Diagnostic { span: start, ..Diagnostic::without_span(Code::Empty, message) };
        diagnostics.push(diagnostic.hint(hint));
        return None;
    }
    let mut assembly = Assembly::new(canvas, limits);
    let mut whole = true;
    let mut patterns = Vec::new();
    let mut last = None;
    for (setting, item) in &items {
        if limits.stop.is_asked() {
            return None;
        }
        let drawn = match item {
            Item::Outline(outline) => assembly.outline(outline, setting).map(|()| None),
            Item::Ink(ink) => assembly.ink(ink, setting).map(|()| None),
            Item::Paint(paint) => PaintStages::new(paint, canvas, limits, observer, diagnostics).and_then(|stages| {
                observer.begin(Step::Draw, &paint.name);
                if !config.overlays.is_empty() {
                    patterns.push(Pattern::new(paint, canvas, &stages.borrow()));
                    last = Some(paint.span);
                }
                assembly.paint(paint, setting, &stages.borrow())
            }),
        };
        match drawn {
            Ok(warning) => diagnostics.extend(warning),
            Err(diagnostic) => {
                diagnostics.push(diagnostic);
                whole = false;
            }
        }
    }
    if let Some(span) = last
        && let Err(diagnostic) = assembly.on_top(overlay::layers(&config.overlays, &patterns, canvas), span)
    {
        diagnostics.push(diagnostic);
        whole = false;
    }
    whole.then(|| {
        let mut drawing = assembly.finish();
        if !config.overlays.is_empty() {
            drawing.page.depth = Depth::Eight;
        }
        drawing
    })
}

/// Every paint of a scene, from the bottom up.
pub fn paints(scene: &Scene) -> impl Iterator<Item = &Paint> {
    items(scene).into_iter().filter_map(|(_, item)| match item {
        Item::Paint(paint) => Some(paint),
        Item::Outline(_) | Item::Ink(_) => None,
    })
}

/// Says that a scene has no paint of a name.
#[must_use]
pub fn no_such_paint(name: &str, names: &[String]) -> Diagnostic {
    let hint = diag::did_you_mean(name, names.iter().map(String::as_str)).or_else(|| {
        let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
        (!names.is_empty()).then(|| format!("its paints are {}", names.join(", ")))
    });
    Diagnostic::without_span(Code::UnknownName, format!("the scene has no paint `{name}`")).maybe_hint(hint)
}

/// Says that nobody waits for a paint any more.
fn stopped(span: Span) -> Diagnostic {
    Diagnostic::error(Code::Limit, span, "the drawing was stopped")
}

/// What the passes find for one paint.
#[derive(Debug)]
pub struct PaintStages {
    /// Where its tiles lie.
    pub sites: Sites,
    /// Which are neighbours.
    pub graph: Graph,
    /// How they are turned.
    pub angles: Angles,
    /// The tiles themselves.
    pub tiles: Tiles,
}

impl PaintStages {
    /// Runs the passes of one paint up to its tiles.
    ///
    /// # Errors
    /// If the limit of tiles is met, or an end was asked for.
    pub fn new(
        paint: &Paint,
        canvas: &Canvas,
        limits: &Limits,
        observer: &mut dyn Observer,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self, Diagnostic> {
        let mut begin = |step: Step| {
            observer.begin(step, &paint.name);
            if limits.stop.is_asked() { Err(stopped(paint.span)) } else { Ok(()) }
        };
        begin(Step::Place)?;
        let sites = place::place(paint, canvas, limits)?;
        begin(Step::Link)?;
        let graph = link::link(&sites, paint.tone.link);
        begin(Step::Turn)?;
        let angles = turn::turn(paint, &sites, &graph, &limits.stop);
        begin(Step::Cut)?;
        let tiles = cut::cut(paint, canvas, &sites, &graph, &angles, warnings);
        warnings.extend(turn::alike(paint, &graph, &angles, &tiles));
        Ok(Self { sites, graph, angles, tiles })
    }

    /// As the drawing pass takes them.
    #[must_use]
    pub fn borrow(&self) -> Stages<'_> {
        Stages { sites: &self.sites, graph: &self.graph, angles: &self.angles, tiles: &self.tiles }
    }
}
