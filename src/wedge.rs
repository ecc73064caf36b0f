//! Calibration wedges: a tone at even steps of what it can be asked for, with the ink that each step prints.
//!
//! In: a scene that declares the tone. Out: patches side by side as a drawing, and for each what was asked for, what the
//! passes reckon that it prints and what a rendering of it holds. A wedge is a scene of its own, which imports the other
//! one; whatever the tone's parameters are called, its `k` or `darkness` is replaced by the steps.

use crate::PaintStages;
use crate::back::raster::{Pixels, render};
use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::drawing::{Drawing, Page};
use crate::field::Field;
use crate::geom::{Length, Point, Rect};
use crate::loader::Loader;
use crate::lower::{LowerConfig, Lowered, lower};
use crate::pass::cut;
use crate::pass::draw::{Assembly, Setting};
use crate::region::Region;
use crate::scene::{Asked, Blend, Canvas, Colour, Darkness, Depth, Paint, Range};
use crate::span::{Sources, Syntax};
use crate::swatch::{Colours, Swatch, first_paint, imports, read, statements};
use crate::syntax::ast::{Document, Expr, ExprKind, Parameter, StatementKind};
use crate::syntax::kake;

/// Sides of a patch, in spacings of the tone's tiles.
const TILES: f64 = 10.0;

/// What of a patch's edge is not measured, in spacings: tiles of the neighbouring step reach over it.
const MARGIN: f64 = 1.0;

/// Patches in a row.
const COLUMNS: u32 = 8;

/// The greatest k.
const MOST_LAYERS: f64 = 4.0;

/// What the caller decides about a wedge.
#[derive(Debug, Clone)]
pub struct WedgeConfig {
    /// Parameters, resolution and limits of the scene that declares the tone.
    pub lower: LowerConfig,
    /// How many patches there are, at least 2.
    pub steps: u32,
}

/// What a tone is asked by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asks {
    /// Layers, 0 to 4.
    K,
    /// A share of the paper, 0 to 1.
    Darkness,
}

impl Asks {
    /// The property's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::K => "k",
            Self::Darkness => "darkness",
        }
    }
}

/// A patch of a wedge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// What the tone was asked for.
    pub asked: f64,
    /// The share of the paper that is inked, as the passes reckon it, spread of the ink included.
    pub reckoned: f64,
    /// The share of the paper that is inked in the patch as it is drawn, without any spread.
    pub measured: f64,
}

/// The wedge of a tone.
#[derive(Debug, Clone)]
pub struct Wedge {
    /// The tone as it was named.
    pub tone: String,
    /// What it was asked by.
    pub asks: Asks,
    /// Every patch, from the lightest on.
    pub steps: Vec<Step>,
    /// The patches in rows; each is a group that is called after its values.
    pub drawing: Drawing,
}

/// A wedge, or what was at fault.
#[derive(Debug)]
pub struct Drawn {
    /// The wedge, unless there are errors.
    pub wedge: Option<Wedge>,
    /// What is to be told.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that it is about.
    pub sources: Sources,
}

impl Drawn {
    fn fault(lowered: Lowered) -> Self {
        Self { wedge: None, diagnostics: lowered.diagnostics, sources: lowered.sources }
    }

    fn refuse(diagnostic: Diagnostic, sources: Sources) -> Self {
        Self { wedge: None, diagnostics: vec![diagnostic], sources }
    }
}

/// Draws the wedge of a tone that the scene at `path` declares. The tone is named as behind `with`, by its name or with
/// arguments; parameters without a default that may be fields or numbers are 0 where they are not given. A scene that
/// declares one tone need not have it named.
#[must_use]
pub fn wedge(path: &str, loader: &dyn Loader, tone: Option<&str>, config: &WedgeConfig) -> Drawn {
    let lowered = lower(path, loader, &config.lower);
    let Some(scene) = &lowered.scene else { return Drawn::fault(lowered) };
    let canvas = scene.canvas.clone();
    let document = read(path, &lowered.sources);
    let tone = match named(document.as_ref(), tone) {
        Ok(tone) => tone,
        Err(diagnostic) => return Drawn::refuse(diagnostic, lowered.sources),
    };
    let completed = completed(document.as_ref(), &tone);
    let swatch = Swatch {
        name: "wedge",
        path,
        loader,
        config: &config.lower,
        imports: imports(path, document.as_ref()),
        canvas: &canvas,
        colours: Colours::Plain,
    };
    // The size of patches follows from the distance of tiles, which only the tone knows.
    let spacing = match swatch.tiles(&completed) {
        Ok(tiles) => tiles.spacing.to_mm(),
        Err(lowered) => return Drawn::fault(*lowered),
    };
    let side = TILES * spacing;
    let columns = config.steps.clamp(1, COLUMNS);
    let rows = config.steps.div_ceil(columns);
    let size = [f64::from(columns), f64::from(rows)].map(|count| Length::mm(count * side));
    let whole = swatch.lower(&completed, size);
    let Some((paint, page)) = first_paint(whole.scene.as_ref()) else { return Drawn::fault(whole) };
    if let Some(diagnostic) = too_large(page, config) {
        return Drawn::refuse(diagnostic, whole.sources);
    }
    let patches = Patches { side, columns, spacing };
    match patches.draw(paint, page, config) {
        Ok((asks, steps, drawing)) => {
            let wedge = Wedge { tone, asks, steps, drawing };
            Drawn { wedge: Some(wedge), diagnostics: Vec::new(), sources: whole.sources }
        }
        Err(diagnostic) => Drawn::refuse(diagnostic, whole.sources),
    }
}

/// Every tone of a document with its parameters.
fn tones(document: Option<&Document>) -> impl Iterator<Item = (&str, &[Parameter])> {
    statements(document).filter_map(|kind| match kind {
        StatementKind::Tone { name, params, .. } => Some((name.name.as_str(), &params[..])),
        _ => None,
    })
}

/// The tone that is meant.
fn named(document: Option<&Document>, tone: Option<&str>) -> Result<String, Diagnostic> {
    let names: Vec<&str> = tones(document).map(|(name, _)| name).collect();
    let list = || names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (tone, &names[..]) {
        (Some(tone), _) => {
            let name = tone.split('(').next().unwrap_or_default().trim();
            // What imports bring is known to lowering alone.
            let has_imports = statements(document).any(|kind| matches!(kind, StatementKind::Import { .. }));
            if names.contains(&name) || has_imports || !kake::is_identifier(name) {
                return Ok(tone.to_owned());
            }
            let message = format!("the scene declares no tone `{name}`");
            let hint = did_you_mean(name, names.iter().copied());
            let hint = hint.or_else(|| (!names.is_empty()).then(|| format!("it declares {}", list())));
            Err(Diagnostic::without_span(Code::UnknownTone, message).maybe_hint(hint))
        }
        (None, [tone]) => Ok((*tone).to_owned()),
        (None, []) => Err(Diagnostic::without_span(Code::UnknownTone, "the scene declares no tone")
            .hint("a wedge is drawn of a tone that the file declares or imports; one that it imports has to be named")),
        (None, _) => Err(Diagnostic::without_span(Code::Missing, "the scene declares several tones")
            .hint(format!("name one of them: {}", list()))),
    }
}

/// The tone with 0 for what it cannot do without.
fn completed(document: Option<&Document>, tone: &str) -> String {
    let mut sources = Sources::new();
    let source = sources.add("tone", tone, Syntax::Kake);
    let (expr, diagnostics) = kake::parse_expression(source, tone, &|offset| offset);
    let (callee, arguments) = match &expr.kind {
        ExprKind::Call(callee, arguments) => (&**callee, &arguments[..]),
        _ => (&expr, &[][..]),
    };
    let Expr { kind: ExprKind::Name(name), .. } = callee else { return tone.to_owned() };
    let Some((_, params)) = tones(document).find(|(known, _)| known == name) else { return tone.to_owned() };
    if !diagnostics.is_empty() {
        return tone.to_owned();
    }
    let by_place = arguments.iter().filter(|argument| argument.name.is_none()).count();
    let is_given = |param: &Parameter| {
        arguments.iter().filter_map(|argument| argument.name.as_ref()).any(|given| given.name == param.name.name)
    };
    let may_be_0 =
        |param: &Parameter| param.ty.as_ref().is_none_or(|ty| matches!(ty.name.as_str(), "field" | "number"));
    let lacking = params
        .iter()
        .skip(by_place)
        .filter(|param| param.default.is_none() && !is_given(param) && may_be_0(param))
        .map(|param| format!("{}: 0", param.name.name));
    let lacking: Vec<String> = lacking.collect();
    match tone.rsplit_once(')') {
        _ if lacking.is_empty() => tone.to_owned(),
        Some((before, _)) => {
            let comma = if arguments.is_empty() || before.trim_end().ends_with(',') { "" } else { ", " };
            format!("{before}{comma}{})", lacking.join(", "))
        }
        None => format!("{tone}({})", lacking.join(", ")),
    }
}

/// A wedge of too many pixels to be rendered.
fn too_large(canvas: &Canvas, config: &WedgeConfig) -> Option<Diagnostic> {
    let most = config.lower.limits.megapixels;
    let [width, height] = canvas.pixels;
    if u64::from(width) * u64::from(height) <= most.saturating_mul(1_000_000) {
        return None;
    }
    let message = format!("the wedge would have {width} x {height} pixels; the limit is {most} megapixels");
    let hint =
        "fewer `--steps`, a lower `--dpi` or smaller tiles make it smaller; `--limit megapixels=N` lifts the limit";
    Some(Diagnostic::without_span(Code::Limit, message).hint(hint))
}

/// How patches lie on the sheet.
struct Patches {
    /// In millimetres.
    side: f64,
    columns: u32,
    /// Of the tone's tiles, in millimetres.
    spacing: f64,
}

impl Patches {
    fn place(&self, step: u32) -> Rect {
        let corner = |column: u32, row: u32| Point::new(f64::from(column) * self.side, f64::from(row) * self.side);
        let (column, row) = (step % self.columns, step / self.columns);
        Rect::new(corner(column, row), corner(column + 1, row + 1))
    }

    /// Draws every step and measures it.
    fn draw(
        &self,
        paint: &Paint,
        canvas: &Canvas,
        config: &WedgeConfig,
    ) -> Result<(Asks, Vec<Step>, Drawing), Diagnostic> {
        let limits = &config.lower.limits;
        let (asks, greatest) = match paint.tone.asked {
            Asked::K(_) => (Asks::K, MOST_LAYERS),
            Asked::Darkness(_) => (Asks::Darkness, 1.0),
        };
        let mut assembly = Assembly::new(canvas, limits);
        let mut steps = Vec::new();
        for i in 0..config.steps {
            let asked = greatest * f64::from(i) / f64::from(config.steps.saturating_sub(1).max(1));
            let mut patch = paint.clone();
            patch.region = Region::rect(self.place(i));
            patch.tone.asked = match &paint.tone.asked {
                Asked::K(_) => Asked::K(Field::constant(asked)),
                // A single tone has no range to fit.
                Asked::Darkness(Darkness { solid, .. }) => {
                    Asked::Darkness(Darkness { field: Field::constant(asked), range: Range::Clip, solid: *solid })
                }
            };
            // Of one k all over the patch nothing ends along the field.
            if patch.tone.blend == Blend::Contour {
                patch.tone.blend = Blend::Step;
            }
            // What is said of single steps says nothing of the tone.
            let stages = PaintStages::new(&patch, canvas, limits, &mut (), &mut Vec::new())?;
            let PaintStages { sites, graph, angles, tiles } = &stages;
            let reckoned = cut::reckon(&patch, canvas, sites, graph, angles, tiles);
            let setting = Setting { groups: vec![i.to_string()], ink: canvas.ink };
            assembly.paint(&patch, &setting, &stages.borrow())?;
            steps.push(Step { asked, reckoned, measured: 0.0 });
        }
        let mut drawing = assembly.finish();
        let pixels = render(&black(&drawing));
        let scale = pixels.width as f64 / canvas.width.to_mm();
        for (i, step) in steps.iter_mut().enumerate() {
            let inner = self.place(i as u32).grown(-MARGIN * self.spacing);
            step.measured = mean_ink(&pixels, &inner, scale);
        }
        for group in drawing.layers.iter_mut().filter_map(|layer| layer.groups.first_mut()) {
            if let Some(step) = group.parse().ok().and_then(|i: usize| steps.get(i)) {
                *group = format!("{} {:.3}, prints {:.3}", asks.name(), step.asked, step.measured);
            }
        }
        Ok((asks, steps, drawing))
    }
}

/// The same marks in black on white.
fn black(drawing: &Drawing) -> Drawing {
    let page = Page { paper: Some(Colour::WHITE), depth: Depth::Eight, ..drawing.page.clone() };
    let mut black = Drawing { page, layers: drawing.layers.clone() };
    black.layers.iter_mut().for_each(|layer| layer.ink = Colour::BLACK);
    black
}

/// The share of ink in a box in millimetres of a grey picture with so many pixels a millimetre.
fn mean_ink(pixels: &Pixels, area: &Rect, scale: f64) -> f64 {
    let within = |mm: f64, end: usize| ((mm * scale).round().max(0.0) as usize).min(end);
    let columns = within(area.min.x, pixels.width)..within(area.max.x, pixels.width);
    let rows = within(area.min.y, pixels.height)..within(area.max.y, pixels.height);
    let (mut sum, mut count) = (0u64, 0u64);
    for row in rows {
        let start = row * pixels.width;
        let row = pixels.data.get(start + columns.start..start + columns.end).unwrap_or_default();
        sum += row.iter().map(|&value| u64::from(255 - value)).sum::<u64>();
        count += row.len() as u64;
    }
    if count > 0 { sum as f64 / 255.0 / count as f64 } else { 0.0 }
}
