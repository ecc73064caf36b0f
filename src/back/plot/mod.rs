//! A drawing for a pen plotter: layers of marks go in, strokes come out that a machine with one pen at a time can draw.
//!
//! There is one layer for each ink and width of pen, called as plotters read it: `1 black 0.3mm`. Dots are points, strokes
//! that run out are plain strokes, filled areas are hatched. Within a layer strokes that touch are one, and their order and
//! sense leave little way between them. What comes out depends on the drawing alone.

mod hatch;
mod merge;
mod order;
mod path;

use std::collections::BTreeMap;

use rayon::prelude::*;

use self::path::Path;
use super::number;
use crate::drawing::{Drawing, Layer, Page, Strokes};
use crate::geom::{Length, Point};
use crate::scene::{Cap, Colour};

/// Widths of pens are told apart by so much.
const STEP: f64 = 0.01;
/// The pen for filled areas of an ink that draws nothing else.
const USUAL: u32 = 30;
/// Ends this near are joined whatever the pen.
const LEAST_REACH: Length = Length::mm(0.05);

/// What a plotter is to draw.
#[derive(Debug, Clone)]
pub struct Plot {
    /// Strokes alone, in the order in which they are drawn.
    pub drawing: Drawing,
    /// What the pen does, for each layer of the drawing.
    pub layers: Vec<Plotted>,
    /// What is not drawn as it is in other outputs, in words.
    pub warnings: Vec<String>,
}

/// A layer's name and what the pen does in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Plotted {
    /// Number, colour and width.
    pub name: String,
    /// With every mark by itself, in the order of the drawing.
    pub before: Travel,
    /// As it is plotted.
    pub after: Travel,
}

/// What a pen does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Travel {
    /// How often it is lifted.
    pub lifts: usize,
    /// How far it draws.
    pub down: Length,
    /// How far it goes between strokes.
    pub up: Length,
}

impl Travel {
    fn of(paths: &[Path]) -> Self {
        let down = paths.iter().fold(0.0, |down, path| down + path.length());
        let up = paths.windows(2).fold(0.0, |up, pair| up + pair[0].ends()[1].distance(pair[1].ends()[0]));
        Self { lifts: paths.len(), down: Length::mm(down), up: Length::mm(up) }
    }

    /// Of two layers together; the way from one to the other, where the pen is changed, does not count.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self { lifts: self.lifts + other.lifts, down: self.down + other.down, up: self.up + other.up }
    }
}

/// Turns a drawing into strokes, joins and orders them.
#[must_use]
pub fn plot(drawing: &Drawing) -> Plot {
    let mut sets = Sets::default();
    let pens = finest_pens(drawing);
    let mut counts = Counts::default();
    for layer in &drawing.layers {
        sets.gather(layer, &pens, &mut counts);
    }
    let done: Vec<(Layer, Plotted)> = sets.list.into_par_iter().enumerate().map(|(i, set)| set.finish(i + 1)).collect();
    let (layers, plotted) = done.into_iter().unzip();
    let drawing = Drawing { page: Page { paper: None, ..drawing.page.clone() }, layers };
    let warnings = counts.warnings(&drawing.page);
    Plot { drawing, layers: plotted, warnings }
}

/// A width as a whole number of steps, at least one.
fn steps(width: Length) -> u32 {
    // What is too large, or is no number, is cut off by the conversion.
    ((width.to_mm() / STEP).round() as u32).max(1)
}

/// The pen of an ink without its transparency, which pens do not have.
fn opaque(ink: Colour) -> Colour {
    Colour { a: 255, ..ink }
}

/// The finest pen that draws strokes or dots with each ink.
fn finest_pens(drawing: &Drawing) -> BTreeMap<Colour, u32> {
    let mut finest = BTreeMap::new();
    for layer in &drawing.layers {
        let strokes = layer.strokes.iter().map(|strokes| strokes.pen);
        let dots = layer.dots.iter().map(|dots| dots.radius * 2.0);
        for pen in strokes.chain(dots).map(steps).chain(pen_of_tapers(layer)) {
            finest.entry(opaque(layer.ink)).and_modify(|least: &mut u32| *least = pen.min(*least)).or_insert(pen);
        }
    }
    finest
}

/// One pen for all strokes of a layer that change their width: the middle one of their greatest widths.
fn pen_of_tapers(layer: &Layer) -> Option<u32> {
    let greatest = |widths: &[f64]| widths.iter().fold(0.0, |widest: f64, &width| width.max(widest));
    let mut widths: Vec<f64> = layer.tapers.iter().map(|(_, widths)| greatest(widths)).collect();
    widths.sort_unstable_by(f64::total_cmp);
    widths.get(widths.len() / 2).map(|&width| steps(Length::mm(width)))
}

/// What is drawn otherwise than it looks.
#[derive(Default)]
struct Counts {
    areas: usize,
    tapers: usize,
    translucent: usize,
}

impl Counts {
    fn warnings(&self, page: &Page) -> Vec<String> {
        let several = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            count => Some(format!("{count} {many}")),
        };
        let areas = several(self.areas, "filled area is hatched", "filled areas are hatched");
        let tapers = "strokes that change their width are drawn with one width";
        let tapers = several(self.tapers, "stroke that changes its width is drawn with one width", tapers);
        let translucent = "layers of translucent ink are drawn opaque";
        let translucent = several(self.translucent, "layer of translucent ink is drawn opaque", translucent);
        let bleed = number::text(page.bleed.to_mm());
        let bleed = (page.bleed > Length::ZERO).then(|| format!("the bleed is drawn too, {bleed}mm beyond the page"));
        [areas, tapers, translucent, bleed].into_iter().flatten().collect()
    }
}

/// All strokes, those of one ink and pen together.
#[derive(Default)]
struct Sets {
    /// In the order in which they are first needed.
    list: Vec<Set>,
    index: BTreeMap<(Colour, u32), usize>,
}

struct Set {
    ink: Colour,
    pen: u32,
    paths: Vec<Path>,
}

impl Sets {
    fn of(&mut self, ink: Colour, pen: u32) -> &mut Vec<Path> {
        let place = *self.index.entry((ink, pen)).or_insert_with(|| {
            self.list.push(Set { ink, pen, paths: Vec::new() });
            self.list.len() - 1
        });
        &mut self.list[place].paths
    }

    /// Adds the marks of a layer in the order of painting.
    fn gather(&mut self, layer: &Layer, pens: &BTreeMap<Colour, u32>, counts: &mut Counts) {
        let ink = opaque(layer.ink);
        counts.translucent += usize::from(layer.ink.a < 255 && layer.marks() > 0);
        if !layer.areas.is_empty() {
            counts.areas += layer.areas.len();
            let pen = pens.get(&ink).copied().unwrap_or(USUAL);
            let width = Length::mm(f64::from(pen) * STEP);
            self.of(ink, pen).extend(layer.areas.iter().flat_map(|area| hatch::hatch(area, width)));
        }
        for strokes in &layer.strokes {
            let lines = strokes.lines.iter().map(|line| straight(line));
            let polylines = strokes.polylines.iter().map(|points| straight(points));
            let curves = strokes.curves.iter().map(|chain| Path::Curved(chain.to_vec()));
            let paths = lines.chain(polylines).chain(curves).filter(Path::is_sound);
            self.of(ink, steps(strokes.pen)).extend(paths);
        }
        if let Some(pen) = pen_of_tapers(layer) {
            counts.tapers += layer.tapers.spines.len();
            let spines = layer.tapers.spines.iter().map(|chain| Path::Curved(chain.to_vec()));
            self.of(ink, pen).extend(spines.filter(Path::is_sound));
        }
        for dots in &layer.dots {
            let centres = dots.centres.iter().map(|&centre| Path::Straight(vec![centre]));
            self.of(ink, steps(dots.radius * 2.0)).extend(centres.filter(Path::is_sound));
        }
    }
}

/// Points without those that follow themselves.
fn straight(points: &[Point]) -> Path {
    let mut points = points.to_vec();
    points.dedup();
    Path::Straight(points)
}

impl Set {
    /// Joins and orders the strokes.
    fn finish(self, number: usize) -> (Layer, Plotted) {
        let width = Length::mm(f64::from(self.pen) * STEP);
        let name = format!("{number} {} {}mm", colour_name(self.ink), number::text(width.to_mm()));
        let before = Travel::of(&self.paths);
        // Ends that lie half a pen apart are one spot of ink already.
        let paths = order::order(merge::merge(self.paths, (width * 0.5).max(LEAST_REACH)));
        let after = Travel::of(&paths);
        let mut layer = Layer::new(Vec::new(), name.clone(), self.ink);
        let is_curved = |path: &Path| matches!(path, Path::Curved(_));
        for run in paths.chunk_by(|a, b| is_curved(a) == is_curved(b)) {
            let mut strokes = Strokes::new(width, Cap::Round);
            for path in run {
                match path {
                    // A dot is a stroke of no length.
                    Path::Straight(points) if points.len() == 1 => strokes.polylines.push(vec![points[0]; 2]),
                    Path::Straight(points) => strokes.polylines.push(points.clone()),
                    Path::Curved(chain) => strokes.curves.push(chain),
                }
            }
            layer.strokes.push(strokes);
        }
        (layer, Plotted { name, before, after })
    }
}

/// The colour's name in CSS, or its digits.
fn colour_name(ink: Colour) -> String {
    let named = csscolorparser::Color::from_rgba8(ink.r, ink.g, ink.b, 255);
    named.name().map_or_else(|| ink.hex(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::super::samples::{layer, lines, on_threads, page, ring, scattered};
    use super::super::svg;
    use super::*;
    use crate::drawing::Dots;

    const RED: Colour = Colour { r: 255, g: 0, b: 0, a: 255 };

    fn svg_of(plot: &Plot) -> Vec<u8> {
        let mut text = Vec::new();
        assert!(svg::write(&plot.drawing, None, &mut text).is_ok());
        text
    }

    #[test]
    fn a_layer_for_each_ink_and_pen() {
        let mut first = layer("first", Colour::BLACK);
        first.strokes.push(lines(0.3, Cap::Butt, &[&[[(1.0, 1.0), (4.0, 1.0)], [(4.0, 1.0), (4.0, 3.0)]]]));
        first.strokes.push(lines(0.1, Cap::Butt, &[&[[(1.0, 6.0), (4.0, 6.0)]]]));
        let mut second = layer("second", RED);
        second.dots.push(Dots { radius: Length::mm(0.2), centres: ring(&[(8.0, 8.0)]), bundle_ends: vec![1] });
        let mut third = layer("third", Colour { r: 1, g: 2, b: 3, a: 100 });
        third.areas.push(vec![ring(&[(5.0, 5.0), (6.0, 5.0), (6.0, 6.0)])]);
        let mut fourth = layer("fourth", Colour::BLACK);
        fourth.tapers.push(&ring(&[(1.0, 2.0), (2.0, 2.0), (3.0, 2.0), (4.0, 3.0)]), &[0.1, 0.3]);
        let plot = plot(&Drawing { page: page(10.0, 10.0), layers: vec![first, second, third, fourth] });
        let names: Vec<&str> = plot.layers.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(names, ["1 black 0.3mm", "2 black 0.1mm", "3 red 0.4mm", "4 #010203 0.3mm"]);
        // Two lines and the spine that starts where they end are one stroke.
        assert_eq!((plot.layers[0].before.lifts, plot.layers[0].after.lifts), (3, 1));
        assert_eq!(
            plot.warnings,
            [
                "1 filled area is hatched",
                "1 stroke that changes its width is drawn with one width",
                "1 layer of translucent ink is drawn opaque"
            ]
        );
        assert!(plot.drawing.page.paper.is_none());
        let text = String::from_utf8_lossy(&svg_of(&plot)).into_owned();
        assert!(text.contains("M8 8h0"), "{text}");
        assert!(plot.drawing.layers.iter().all(|layer| layer.areas.is_empty() && layer.dots.is_empty()));
    }

    #[test]
    fn plotting_saves_way_and_loses_no_stroke() {
        let mut drawing = scattered(60.0, 60.0, 210);
        // Only strokes, each by itself.
        drawing.layers.truncate(1);
        let plot = plot(&drawing);
        for layer in &plot.layers {
            assert!(layer.after.lifts <= layer.before.lifts);
            assert!(layer.after.up.to_mm() < 0.5 * layer.before.up.to_mm(), "{layer:?}");
            let added = layer.after.down.to_mm() - layer.before.down.to_mm();
            let joined = layer.before.lifts - layer.after.lifts;
            assert!((-1e-6..=0.2 * joined as f64 + 1e-6).contains(&added), "{layer:?}");
        }
        // What is written is what was counted.
        for (layer, plotted) in plot.drawing.layers.iter().zip(&plot.layers) {
            assert_eq!(layer.marks(), plotted.after.lifts as u64);
        }
    }

    #[test]
    fn threads_do_not_matter() {
        let drawing = scattered(100.0, 100.0, 2_000);
        let [one, four] = on_threads(|| svg_of(&plot(&drawing)));
        assert!(one == four);
    }
}
