//! Swatches: a scene of its own that paints its canvas with a tone that another file declares.
//!
//! In: the path of a file that declares tones, and a call of one of them as it stands behind `with`. Out: the lowered scene
//! that imports the file and paints with the tone, on a canvas of any size. Wedges and galleries are made of them; their size
//! follows from the distance of the tone's tiles, which only the tone knows.

use std::sync::Arc;

use crate::diag;
use crate::geom::Length;
use crate::loader::{LoadError, Loader, UnknownDependency};
use crate::lower::{LowerConfig, Lowered, lower};
use crate::pass::place;
use crate::scene::{Canvas, Colour, Paint, Scene, Shape};
use crate::span::{Sources, Syntax};
use crate::syntax::ast::{Document, StatementKind};
use crate::syntax::{self, kake};
use crate::{Compiled, Config, compile};

/// The side of the canvas on which spacings are looked up.
const TRIAL: Length = Length::mm(100.0);

/// What the path of an import starts with that names no file below the root.
const STANDARD: &str = "std:";

/// A scene that paints its canvas with a tone of another file.
pub struct Swatch<'a> {
    /// What it is called, and its paint.
    pub name: &'a str,
    /// Where the other file lies.
    pub path: &'a str,
    /// What reads it.
    pub loader: &'a dyn Loader,
    /// Parameters and limits of the other file.
    pub config: &'a LowerConfig,
    /// The statements that import it; see [`imports`].
    pub imports: String,
    /// The canvas from which all but the size and the colours is taken.
    pub canvas: &'a Canvas,
    /// Its colours.
    pub colours: Colours,
}

/// The colours of a swatch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// Black on white.
    Plain,
    /// Those of the canvas.
    Own,
}

/// What the tiles of a tone are like.
#[derive(Debug, Clone)]
pub struct Tiling {
    /// How far apart they lie.
    pub spacing: Length,
    /// What they look like.
    pub shape: Shape,
    /// Whether the tone asks for as much everywhere.
    pub is_even: bool,
}

/// Files with one more, which exists nowhere else.
struct With<'a> {
    loader: &'a dyn Loader,
    path: String,
    text: Arc<[u8]>,
}

impl Loader for With<'_> {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if path == self.path { Ok(Arc::clone(&self.text)) } else { self.loader.load(path) }
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        self.loader.library(name)
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        self.loader.dependency(of, name)
    }
}

impl Swatch<'_> {
    /// Lowers it with a tone at a size.
    #[must_use]
    pub fn lower(&self, tone: &str, size: [Length; 2]) -> Lowered {
        let with = self.with(tone, size);
        lower(&with.path, &with, self.config)
    }

    /// Draws it with a tone at a size.
    #[must_use]
    pub fn compile(&self, tone: &str, size: [Length; 2]) -> Compiled {
        let with = self.with(tone, size);
        let config = Config { lower: self.config.clone(), ..Config::default() };
        compile(&with.path, &with, &config, &mut ())
    }

    /// The scene as a file among those of the other.
    fn with(&self, tone: &str, [width, height]: [Length; 2]) -> With<'_> {
        let path = if self.path.starts_with(STANDARD) { "" } else { self.path };
        let (folder, file) = path.rsplit_once('/').map_or(("", path), |(folder, file)| (folder, file));
        let Canvas { dpi, unit, gain, .. } = self.canvas;
        let (unit, gain) = (unit.to_mm(), gain.to_mm());
        let (width, height) = (width.to_mm(), height.to_mm());
        let colours = match self.colours {
            Colours::Plain => String::new(),
            Colours::Own => {
                let paper = self.canvas.paper.map_or_else(|| "none".to_owned(), written);
                format!(" paper: {paper} ink: {}", written(self.canvas.ink))
            }
        };
        let text = format!(
            "{}canvas {{ size: ({width:.6}mm, {height:.6}mm) dpi: {dpi} unit: {unit}mm gain: {gain}mm{colours} }}\n\
             paint canvas with {tone} as \"{}\"\n",
            self.imports, self.name,
        );
        // Should there be such a file, it is not the one that is imported.
        let name = format!("{} of {file}.kake", self.name);
        let path = if folder.is_empty() { name } else { format!("{folder}/{name}") };
        With { loader: self.loader, path, text: text.into_bytes().into() }
    }

    /// What the tiles of a tone are like.
    ///
    /// # Errors
    /// What was found where the tone cannot be placed; the diagnostics say why.
    pub fn tiles(&self, tone: &str) -> Result<Tiling, Box<Lowered>> {
        let mut trial = self.lower(tone, [TRIAL; 2]);
        let Some((paint, canvas)) = first_paint(trial.scene.as_ref()) else { return Err(Box::new(trial)) };
        match place::place(paint, canvas, &self.config.limits) {
            Ok(sites) => Ok(Tiling {
                spacing: Length::mm(sites.spacing),
                shape: paint.tone.shape.clone(),
                is_even: paint.tone.asked.field().as_constant().is_some(),
            }),
            Err(diagnostic) => {
                trial.diagnostics.push(diagnostic);
                diag::sort(&mut trial.diagnostics);
                Err(Box::new(trial))
            }
        }
    }
}

/// The one paint of a swatch, with its canvas.
#[must_use]
pub fn first_paint(scene: Option<&Scene>) -> Option<(&Paint, &Canvas)> {
    let scene = scene?;
    crate::paints(scene).next().map(|paint| (paint, &scene.canvas))
}

/// The document of a file that lowering has read.
#[must_use]
pub fn read(path: &str, sources: &Sources) -> Option<Document> {
    let (source, read) = sources.iter().find(|(_, source)| source.name == path)?;
    let (document, _) = match read.syntax {
        Syntax::Kake => kake::parse(source, &read.text),
        Syntax::Toml => syntax::toml::read(source, &read.text),
    };
    Some(document)
}

/// Every statement at the top level of a document.
pub fn statements(document: Option<&Document>) -> impl Iterator<Item = &StatementKind> {
    document.into_iter().flat_map(|document| &document.statements).map(|statement| &statement.kind)
}

/// Statements that import a file, and what it imports itself under the names that it uses.
#[must_use]
pub fn imports(path: &str, document: Option<&Document>) -> String {
    let file = match path.starts_with(STANDARD) {
        true => path,
        false => path.rsplit_once('/').map_or(path, |(_, file)| file),
    };
    let mut text = format!("import {}\n", quoted(file));
    for kind in statements(document) {
        if let StatementKind::Import { path, alias } = kind {
            text += &format!("import {}", quoted(&path.value));
            text += &alias.as_ref().map_or_else(String::new, |alias| format!(" as {}", alias.name));
            text.push('\n');
        }
    }
    text
}

/// A colour as it is written in a scene.
fn written(colour: Colour) -> String {
    if colour.a == 255 { colour.hex() } else { format!("{}{:02x}", colour.hex(), colour.a) }
}

/// A string of the language.
#[must_use]
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        if matches!(character, '\\' | '"' | '{' | '}') {
            quoted.push('\\');
        }
        quoted.push(character);
    }
    quoted.push('"');
    quoted
}
