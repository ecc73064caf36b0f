//! Galleries: what a file of tones or a scene holds, and what it looks like.
//!
//! In: the path of a file. Out: every tone that it declares with its doc comment, its parameters and how it is called, drawn
//! at several numbers of layers or values of a parameter; and, where the file draws something itself, that picture with its
//! parameters. What cannot be drawn says why. Swatches are as large as the tone's tiles ask for, so that one sees tiles.

mod contact;
mod fit;
mod page;

use fit::Call;

pub use contact::contact;
pub use page::{GENERATOR, Page, page};

use std::fmt::{self, Write as _};
use std::sync::Arc;

use rayon::prelude::*;

use crate::diag::{Diagnostic, RenderConfig, render};
use crate::drawing::Drawing;
use crate::geom::{Length, Point, Rect};
use crate::loader::{LoadError, Loader, UnknownDependency};
use crate::lower::{LowerConfig, Lowered, lower};
use crate::scene::{Canvas, Param, Shape};
use crate::span::Sources;
use crate::swatch::{Colours, Swatch, imports, read};
use crate::syntax::ast::{self, Document, ExprKind, Statement, StatementKind, Unit};
use crate::syntax::format;
use crate::{Config, compile};

/// A swatch is so many spacings of its tiles wide, and twice as many where the tone is darker in one place than in another.
const SPACINGS: f64 = 7.0;
const UNEVEN_SPACINGS: f64 = 14.0;
/// It shows about so much of the length of its longest stamps.
const OF_STAMPS: f64 = 0.95;
/// But its width is no less and no more than this, in millimetres.
const WIDTHS: [f64; 2] = [18.0, 140.0];
/// Its height as a part of its width.
const HEIGHT: f64 = 0.75;
/// Values that fit are found on a page as wide as this, before the true width is known.
const TRIAL: f64 = 60.0;

/// Columns of diagnostics.
const COLUMNS: usize = 100;

/// What the caller decides about a gallery.
#[derive(Debug, Clone)]
pub struct GalleryConfig {
    /// Limits, above all.
    pub lower: LowerConfig,
    /// What changes from one swatch of a tone to the next.
    pub over: Over,
}

/// What changes from one swatch of a tone to the next.
#[derive(Debug, Clone, PartialEq)]
pub enum Over {
    /// `k`, from the first to the last; of tones that ask for a share instead, as many even steps.
    Layers(u32, u32),
    /// A parameter with its values as they are written. Tones that do not have it are drawn as they stand.
    Param(String, Vec<String>),
}

/// A file.
#[derive(Debug)]
pub struct Module {
    /// Its path from the root.
    pub path: String,
    /// The comment that it begins with.
    pub intro: Option<String>,
    /// Its tones in the order they are declared.
    pub tones: Vec<Tone>,
    /// What it draws itself.
    pub scene: Option<Painted>,
    /// What is wrong with it, as it is shown to a person.
    pub faults: Option<String>,
}

/// A tone.
#[derive(Debug)]
pub struct Tone {
    /// Its name.
    pub name: String,
    /// Its doc comment.
    pub doc: Option<String>,
    /// Its parameters.
    pub params: Vec<Parameter>,
    /// How it is drawn.
    pub swatches: Vec<Shown>,
    /// Whether the swatches differ in something that was asked for, and not the tone as it stands alone.
    pub is_series: bool,
}

/// A parameter of a tone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// The type that it is declared with or that its default has.
    pub ty: Option<String>,
    /// The value it has where none is given.
    pub default: Option<String>,
    /// Its doc comment.
    pub doc: Option<String>,
}

/// A swatch.
#[derive(Debug)]
pub struct Shown {
    /// What is particular about it; nothing where the tone is drawn as it stands.
    pub label: String,
    /// The tone as it stands behind `with`.
    pub call: String,
    /// The picture, or why there is none.
    pub picture: Result<Drawing, Lacking>,
}

/// Why there is no picture, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Lacking {
    /// Nothing is at fault, but the tone needs a value that only a person can choose.
    Value(String),
    /// The tone or its file is at fault.
    Fault(String),
}

impl fmt::Display for Lacking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(words) | Self::Fault(words) => f.write_str(words),
        }
    }
}

/// A scene that draws.
#[derive(Debug)]
pub struct Painted {
    /// Its doc is the file's; these are its parameters.
    pub params: Vec<Param>,
    /// The picture, or why there is none.
    pub picture: Result<Drawing, Lacking>,
}

/// Looks a file up: its tones, and what it draws.
#[must_use]
pub fn survey(path: &str, loader: &dyn Loader, config: &GalleryConfig) -> Module {
    let library = path.starts_with(STANDARD);
    let lowered = match library {
        true => lower(ABOVE, &Above { loader, path }, &config.lower),
        false => lower(path, loader, &config.lower),
    };
    let document = read(path, &lowered.sources);
    let faults = faults(&lowered.diagnostics, &lowered.sources);
    let canvas = lowered.scene.as_ref().map(|scene| scene.canvas.clone());
    let draws = lowered.scene.as_ref().is_some_and(|scene| !scene.draws.is_empty());
    let scene = draws.then(|| painted(path, loader, config, &lowered));
    let declared: Vec<&Statement> = document.iter().flat_map(|document| &document.statements).collect();
    let tone = |statement: &&Statement| {
        let StatementKind::Tone { name, params, .. } = &statement.kind else { return None };
        let maker =
            Maker { path, loader, config, document: document.as_ref(), canvas: canvas.as_ref(), tone: &name.name };
        let (swatches, is_series) = maker.swatches(params);
        let (name, doc) = (name.name.clone(), statement.doc.as_ref().map(|doc| doc.text.clone()));
        Some(Tone { name, doc, params: params.iter().map(parameter).collect(), swatches, is_series })
    };
    let tones = declared.par_iter().filter_map(tone).collect();
    Module { path: path.to_owned(), intro: document.as_ref().and_then(intro), tones, scene, faults }
}

/// What the path of a standard library starts with.
const STANDARD: &str = "std:";

/// A file above a standard library, which is no file that lowering begins with.
struct Above<'a> {
    loader: &'a dyn Loader,
    path: &'a str,
}

/// What it is called.
const ABOVE: &str = "above.kake";

impl Loader for Above<'_> {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        match path == ABOVE {
            true => Ok(format!("import {}\n", crate::swatch::quoted(self.path)).into_bytes().into()),
            false => self.loader.load(path),
        }
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        self.loader.library(name)
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        self.loader.dependency(of, name)
    }
}

/// The comment that a file begins with, without its signs.
fn intro(document: &Document) -> Option<String> {
    let first = document
        .statements
        .first()
        .map_or(u32::MAX, |statement| statement.doc.as_ref().map_or(statement.span.start, |doc| doc.span.start));
    let mut text = String::new();
    for comment in document.comments.iter().take_while(|comment| comment.span.start < first) {
        let inside = comment.text.strip_prefix("/*").and_then(|inside| inside.strip_suffix("*/"));
        let inside = inside.unwrap_or_else(|| comment.text.trim_start_matches('/'));
        let _ = writeln!(text, "{}", inside.trim());
    }
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

/// The errors among diagnostics as they are shown to a person.
fn faults(diagnostics: &[Diagnostic], sources: &Sources) -> Option<String> {
    let errors: Vec<Diagnostic> = diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).cloned().collect();
    let shown = || render(&errors, sources, RenderConfig { width: COLUMNS, colour: false, unicode: true });
    (!errors.is_empty()).then(shown)
}

/// The first error in one sentence.
fn reason(diagnostics: &[Diagnostic]) -> Lacking {
    let first = diagnostics.iter().find(|diagnostic| diagnostic.is_error());
    Lacking::Fault(first.map_or_else(|| "it could not be drawn".to_owned(), |diagnostic| diagnostic.message.clone()))
}

/// The picture of a scene as it stands.
fn painted(path: &str, loader: &dyn Loader, config: &GalleryConfig, lowered: &Lowered) -> Painted {
    let params = lowered.scene.as_ref().map(|scene| scene.params.clone()).unwrap_or_default();
    let config = Config { lower: config.lower.clone(), ..Config::default() };
    let compiled = compile(path, loader, &config, &mut ());
    let picture = compiled.drawing.ok_or_else(|| reason(&compiled.lowered.diagnostics));
    Painted { params, picture }
}

fn parameter(param: &ast::Parameter) -> Parameter {
    Parameter {
        name: param.name.name.clone(),
        ty: param.ty.as_ref().map(|ty| ty.name.clone()).or_else(|| param.default.as_ref().and_then(type_of)),
        default: param.default.as_ref().map(format::expression),
        doc: param.doc.as_ref().map(|doc| doc.text.clone()),
    }
}

/// The type of a value that is written out.
fn type_of(expr: &ast::Expr) -> Option<String> {
    let name = match &expr.kind {
        ExprKind::Number { unit, .. } => match unit {
            None => "number",
            Some(Unit::Millimetre | Unit::Centimetre | Unit::Inch | Unit::Point | Unit::Pixel) => "length",
            Some(Unit::Degree | Unit::Radian | Unit::Turn) => "angle",
            Some(Unit::Percent) => "percentage",
        },
        ExprKind::Colour(_) => "colour",
        ExprKind::String(_) => "string",
        ExprKind::Bool(_) => "bool",
        ExprKind::List(_) => "list",
        _ => return None,
    };
    Some(name.to_owned())
}

/// A parameter with the value that a swatch is drawn with.
type Given = Option<(String, String)>;

impl Call {
    /// Why a tone that is called so is not drawn: where a value was only thought to fit, nobody is at fault.
    fn reason(&self, diagnostics: &[Diagnostic]) -> Lacking {
        match (reason(diagnostics), self.is_guessed) {
            (Lacking::Fault(words), true) => Lacking::Value(format!("not with values that seemed to fit: {words}")),
            (lacking, _) => lacking,
        }
    }
}

/// Draws the swatches of one tone.
struct Maker<'a> {
    path: &'a str,
    loader: &'a dyn Loader,
    config: &'a GalleryConfig,
    document: Option<&'a Document>,
    /// None where the file is at fault.
    canvas: Option<&'a Canvas>,
    tone: &'a str,
}

impl Maker<'_> {
    /// The swatches, and whether they are a series.
    fn swatches(&self, params: &[ast::Parameter]) -> (Vec<Shown>, bool) {
        let series = self.series(params);
        let is_series = series.is_some();
        let series = series.unwrap_or_else(|| vec![(String::new(), None)]);
        // All of a series show as much of the page, so that one sees what changes.
        let mut widths = Vec::new();
        let mut shown = Vec::new();
        for (label, given) in series {
            let call = |width: f64| self.call(params, given.as_ref(), width);
            match call(TRIAL).and_then(|call| self.width(&call)) {
                Ok(width) => {
                    widths.push(width);
                    shown.push((label, Ok(given)));
                }
                Err(why) => shown.push((label, Err(why))),
            }
        }
        // Where nothing is known to fit, once is enough to say so.
        if shown.iter().all(|(_, given)| matches!(given, Err(Lacking::Value(_)))) {
            shown.truncate(1);
            shown.iter_mut().for_each(|(label, _)| label.clear());
            return (shown.into_iter().map(|given| self.lacking(given)).collect(), false);
        }
        let width = widths.into_iter().fold(WIDTHS[0], f64::max);
        let draw = |(label, given): (String, Result<Given, Lacking>)| {
            let called = given.and_then(|given| self.call(params, given.as_ref(), width));
            let picture = called.clone().and_then(|call| self.draw(&call, width));
            let call = called.map_or_else(|_| format!("{}(…)", self.tone), |call| call.text);
            Shown { label, call, picture }
        };
        (shown.into_iter().map(draw).collect(), is_series)
    }

    /// A swatch that nothing was given for.
    fn lacking(&self, (label, given): (String, Result<Given, Lacking>)) -> Shown {
        let why = given.err().unwrap_or_else(|| Lacking::Value(String::new()));
        Shown { label, call: format!("{}(…)", self.tone), picture: Err(why) }
    }

    fn call(&self, params: &[ast::Parameter], given: Option<&(String, String)>, width: f64) -> Result<Call, Lacking> {
        fit::call(self.tone, params, given, [width, width * HEIGHT]).map_err(Lacking::Value)
    }

    /// What the swatches of a tone differ in, each with its label.
    fn series(&self, params: &[ast::Parameter]) -> Option<Vec<(String, Given)>> {
        let has = |name: &str| params.iter().find(|param| param.name.name == name);
        if let Over::Param(name, values) = &self.config.over {
            has(name)?;
            let one = |value: &String| (format!("{name} = {value}"), Some((name.clone(), value.clone())));
            return Some(values.iter().map(one).collect());
        }
        let (from, to) = match self.config.over {
            Over::Layers(from, to) => (from, to),
            Over::Param(..) => return None,
        };
        if has("k").is_some() {
            let one = |k: u32| (format!("k = {k}"), Some(("k".to_owned(), k.to_string())));
            return Some((from..=to).map(one).collect());
        }
        let share = fit::SHARES.into_iter().find_map(has)?;
        let name = &share.name.name;
        let steps = to - from + 1;
        let one = |i: u32| {
            let percent = f64::from(i) * 100.0 / f64::from(steps);
            let value = format!("{}", (percent * 10.0).round() / 1000.0);
            (format!("{name} = {value}"), Some((name.clone(), value)))
        };
        Some((1..=steps).map(one).collect())
    }

    fn swatch(&self) -> Result<Swatch<'_>, Lacking> {
        let canvas = self.canvas.ok_or_else(|| Lacking::Fault("its file is at fault".to_owned()))?;
        Ok(Swatch {
            name: "swatch",
            path: self.path,
            loader: self.loader,
            config: &self.config.lower,
            imports: imports(self.path, self.document),
            canvas,
            colours: Colours::Own,
        })
    }

    /// How wide a swatch has to be for its tiles to be seen, in millimetres.
    fn width(&self, call: &Call) -> Result<f64, Lacking> {
        let tiles = self.swatch()?.tiles(&call.text).map_err(|lowered| call.reason(&lowered.diagnostics))?;
        let longest = match &tiles.shape {
            Shape::Stamp { outline, size: None, .. } => longest(outline),
            _ => 0.0,
        };
        let spacings = if tiles.is_even { SPACINGS } else { UNEVEN_SPACINGS };
        Ok((spacings * tiles.spacing.to_mm()).max(OF_STAMPS * longest).clamp(WIDTHS[0], WIDTHS[1]))
    }

    fn draw(&self, call: &Call, width: f64) -> Result<Drawing, Lacking> {
        let compiled = self.swatch()?.compile(&call.text, [width, width * HEIGHT].map(Length::mm));
        compiled.drawing.ok_or_else(|| call.reason(&compiled.lowered.diagnostics))
    }
}

/// The longer side of the box round an outline.
fn longest(outline: &[Point]) -> f64 {
    let Some(first) = outline.first() else { return 0.0 };
    let bounds = outline.iter().fold(Rect::new(*first, *first), |bounds, point| bounds.including(*point));
    bounds.width().max(bounds.height())
}

/// How a file is imported, from a folder or as part of a library of this name.
#[must_use]
pub fn import(path: &str, library: Option<&str>) -> String {
    let target = match library {
        Some(name) if !path.starts_with(STANDARD) => format!("{name}:{path}"),
        _ => path.to_owned(),
    };
    format!("import {}", crate::swatch::quoted(&target))
}

#[cfg(test)]
mod tests;
