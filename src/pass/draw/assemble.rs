//! From drawn paints and outlines to the whole drawing, from the bottom up.

use crate::diag::{Code, Diagnostic, grouped};
use crate::drawing::{Drawing, Layer, Page, Strokes};
use crate::geom::Rect;
use crate::pass::cut;
use crate::region::{Operation, Region, chain};
use crate::scene::{Canvas, Cap, Colour, Draw, Ink, InkMark, InkShape, Limits, Outline, Over, Paint, Scene};
use crate::span::Span;

use super::budget::{Budget, Exceeded};
use super::knockout::Stencil;
use super::torus::{self, Unrolled};
use super::{Stages, draw};

/// Something that is drawn.
#[derive(Debug, Clone, Copy)]
pub enum Item<'a> {
    /// A region filled with a tone.
    Paint(&'a Paint),
    /// A region's outline.
    Outline(&'a Outline),
    /// Strokes and fills of a file.
    Ink(&'a Ink),
}

/// Where in the scene something is drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// The names of the layers around it, outermost first.
    pub groups: Vec<String>,
    /// The ink of the innermost layer that has one, else the canvas's.
    pub ink: Colour,
}

/// All that a scene draws, from the bottom up.
#[must_use]
pub fn items(scene: &Scene) -> Vec<(Setting, Item<'_>)> {
    let mut items = Vec::new();
    collect(&scene.draws, &Setting { groups: Vec::new(), ink: scene.canvas.ink }, &mut items);
    items
}

/// Layers are nested no deeper than the limit of nesting.
fn collect<'a>(draws: &'a [Draw], setting: &Setting, items: &mut Vec<(Setting, Item<'a>)>) {
    for draw in draws {
        match draw {
            Draw::Paint(paint) => items.push((setting.clone(), Item::Paint(paint))),
            Draw::Outline(outline) => items.push((setting.clone(), Item::Outline(outline))),
            Draw::Ink(ink) => items.push((setting.clone(), Item::Ink(ink))),
            Draw::Layer(group) => {
                let mut inner = setting.clone();
                inner.groups.push(group.name.clone());
                inner.ink = group.ink.unwrap_or(setting.ink);
                collect(&group.draws, &inner, items);
            }
        }
    }
}

/// The warning that none of a paint's tiles has a mark.
fn nothing_drawn(paint: &Paint, tiles: usize) -> Diagnostic {
    let tiles = if tiles == 1 { "1 tile".to_owned() } else { format!("{} tiles", grouped(tiles as u64)) };
    Diagnostic::warning(Code::NoTiles, paint.span, format!("`{}` has {tiles}, but draws nothing", paint.name))
        .hint("strokes below `shortest`, dots that do not fit and all that lies under later tiles is left out")
}

/// A drawing that is being put together.
pub struct Assembly<'a> {
    canvas: &'a Canvas,
    limits: &'a Limits,
    layers: Vec<Layer>,
    /// Marks in all layers.
    marks: u64,
}

impl<'a> Assembly<'a> {
    /// An empty sheet.
    #[must_use]
    pub fn new(canvas: &'a Canvas, limits: &'a Limits) -> Self {
        Self { canvas, limits, layers: Vec::new(), marks: 0 }
    }

    /// Draws a paint on top of what is there, and first removes what lies under its tiles if it knocks out.
    ///
    /// A warning comes back where the paint has tiles but draws nothing.
    ///
    /// # Errors
    /// If the drawing comes to have more marks than the limit allows.
    pub fn paint(
        &mut self,
        paint: &Paint,
        setting: &Setting,
        stages: &Stages<'_>,
    ) -> Result<Option<Diagnostic>, Diagnostic> {
        let layers = draw(paint, self.canvas, setting, stages, self.limits)?;
        match paint.tone.over {
            Over::Print => {}
            Over::Knockout => {
                let visible = cut::visible(paint, self.canvas);
                let reach = self.canvas.period().map(|period| torus::protrusion(&self.layers, period));
                let unrolled = reach.and_then(|reach| Unrolled::new(stages, reach));
                let Stages { sites, tiles, .. } = unrolled.as_ref().map_or(*stages, Unrolled::stages);
                let stencil = Stencil::new(paint, &visible, sites, tiles);
                Budget::new(self.limits)
                    .work(stencil.cost(&self.layers))
                    .map_err(|exceeded| exceeded.diagnostic(self.limits, paint.span))?;
                self.layers.iter_mut().for_each(|layer| stencil.cut(layer));
                self.layers.retain(|layer| layer.marks() > 0);
                self.marks = self.layers.iter().map(Layer::marks).sum();
            }
        }
        let tiles = (0..stages.tiles.len()).filter(|&tile| stages.tiles.is_drawn(tile)).count();
        let warning = (layers.is_empty() && tiles > 0).then(|| nothing_drawn(paint, tiles));
        self.add(layers, paint.span)?;
        Ok(warning)
    }

    /// Draws an outline on top of what is there: every ring as one closed stroke.
    ///
    /// # Errors
    /// If the drawing comes to have more marks than the limit allows.
    pub fn outline(&mut self, outline: &Outline, setting: &Setting) -> Result<(), Diagnostic> {
        let rings = outline.region.polygons().iter().flat_map(|polygon| polygon.rings());
        let polylines = rings.map(|ring| ring.iter().chain(ring.first()).copied().collect()).collect();
        let mut layer = Layer::new(setting.groups.clone(), "outline".to_owned(), setting.ink);
        layer.strokes.push(Strokes { polylines, ..Strokes::new(outline.pen, Cap::Butt) });
        if let Some(period) = self.canvas.period() {
            layer = torus::wrap(layer, period, self.limits.strokes)
                .map_err(|exceeded| exceeded.diagnostic(self.limits, outline.span))?;
        }
        self.add(vec![layer], outline.span)
    }

    /// Draws the strokes and fills of a file on top of what is there, as far as they lie on the canvas. A run of marks of
    /// one colour is one layer; what is not opaque is one by itself, so that it shows what lies under it. On a canvas that
    /// repeats what lies beyond its borders comes in at the opposite ones.
    ///
    /// # Errors
    /// If the drawing comes to have more marks than the limit allows.
    pub fn ink(&mut self, ink: &Ink, setting: &Setting) -> Result<(), Diagnostic> {
        let mut layers: Vec<Layer> = Vec::new();
        let period = self.canvas.period();
        let sheet = if period.is_some() { torus::EVERYWHERE } else { self.canvas.bounds() };
        for mark in &ink.marks {
            let mut layer = Layer::new(setting.groups.clone(), "ink".to_owned(), mark.colour);
            put(mark, sheet, &mut layer);
            match layers.last_mut() {
                Some(last) if mark.colour.a == 255 && last.ink == mark.colour => join(last, layer),
                _ if layer.marks() > 0 => layers.push(layer),
                _ => {}
            }
        }
        if let Some(period) = period {
            let wrapped = layers.into_iter().map(|layer| torus::wrap(layer, period, self.limits.strokes));
            layers = wrapped
                .collect::<Result<_, _>>()
                .map_err(|exceeded: Exceeded| exceeded.diagnostic(self.limits, ink.span))?;
            layers.retain(|layer| layer.marks() > 0);
        }
        self.add(layers, ink.span)
    }

    /// Lays layers on top of all that is there. On a canvas that repeats what lies beyond its borders comes in at the
    /// opposite ones.
    ///
    /// # Errors
    /// If the drawing comes to have more marks than the limit allows; `span` is where that is said.
    pub fn on_top(&mut self, layers: Vec<Layer>, span: Span) -> Result<(), Diagnostic> {
        let wrapped = |layer| match self.canvas.period() {
            None => Ok(layer),
            Some(period) => torus::wrap(layer, period, self.limits.strokes),
        };
        let layers: Result<Vec<Layer>, Exceeded> = layers.into_iter().map(wrapped).collect();
        self.add(layers.map_err(|exceeded| exceeded.diagnostic(self.limits, span))?, span)
    }

    fn add(&mut self, layers: Vec<Layer>, span: Span) -> Result<(), Diagnostic> {
        self.marks += layers.iter().map(Layer::marks).sum::<u64>();
        self.layers.extend(layers);
        if self.marks > self.limits.strokes {
            return Err(Exceeded::Marks.diagnostic(self.limits, span));
        }
        Ok(())
    }

    /// The drawing.
    #[must_use]
    pub fn finish(self) -> Drawing {
        let canvas = self.canvas;
        let page = Page {
            width: canvas.width,
            height: canvas.height,
            bleed: canvas.bleed,
            pixels: canvas.pixels,
            dpi: canvas.dpi,
            paper: canvas.paper,
            depth: canvas.depth,
        };
        Drawing { page, layers: self.layers }
    }
}

/// Draws what of a mark lies on the sheet.
fn put(mark: &InkMark, sheet: Rect, layer: &mut Layer) {
    match &mark.shape {
        InkShape::Area(area) => {
            let is_whole = sheet.contains(area.bounds().min) && sheet.contains(area.bounds().max);
            // An area that crosses the border too often to be cut lies beyond it as it is.
            let cut =
                if is_whole { None } else { area.try_combined(&Region::rect(sheet), Operation::Intersection).ok() };
            let polygons = cut.as_ref().unwrap_or(area).polygons();
            layer.areas = polygons.iter().map(|polygon| polygon.rings().cloned().collect()).collect();
        }
        InkShape::Strokes { pen, cap, chains } => {
            // Cut beyond the border, where no end of a stroke is seen.
            let seen = Region::rect(sheet.grown(pen.to_mm()));
            let mut strokes = Strokes::new(*pen, *cap);
            for piece in chains.iter().flat_map(|chain| chain::clipped(chain, &seen)) {
                match chain::straight(&piece) {
                    Some(corners) => strokes.polylines.push(corners),
                    None => strokes.curves.push(&piece),
                }
            }
            if !strokes.polylines.is_empty() || !strokes.curves.is_empty() {
                layer.strokes.push(strokes);
            }
        }
    }
}

/// Adds the marks of one layer to another of the same colour.
fn join(layer: &mut Layer, other: Layer) {
    layer.areas.extend(other.areas);
    for strokes in other.strokes {
        match layer.strokes.iter_mut().find(|known| (known.pen, known.cap) == (strokes.pen, strokes.cap)) {
            Some(known) => {
                known.polylines.extend(strokes.polylines);
                known.curves.append(&strokes.curves);
            }
            None => layer.strokes.push(strokes),
        }
    }
}
