//! From the text of an SVG file to its marks, what is filled and stroked: usvg resolves styles, units, `use` and viewports, and what it makes
//! of them is walked through in the order of drawing.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

use usvg::tiny_skia_path::{Path, PathSegment, Point as SkPoint, StrokeDash, Transform};
use usvg::{
    BlendMode, ClipPath, Group, ImageHrefResolver, LineCap, Node, Opacity, Options, Paint, PaintOrder, Stop, Stroke,
    Tree,
};

use super::document::{self, Elements, Names};
use super::{Clip, Ends, Lack, Mark, MarkKind, Rgba, Step, SvgError, SvgFile};
use crate::geom::{Point, Vec2};
use crate::region::FillRule;

/// Reads a file.
pub(super) fn read(text: &str) -> Result<SvgFile, SvgError> {
    let document = document::parse(text)?;
    let elements = document::elements(&document, text)?;
    let tree = match elements.completed(text) {
        Some(text) => draw(&document::parse(&text)?)?,
        None => draw(&document)?,
    };
    let mut walk = Walk::default();
    walk.through(tree.root());
    Ok(walk.finish(&tree, &elements))
}

fn draw(document: &usvg::roxmltree::Document<'_>) -> Result<Tree, SvgError> {
    // Pictures are neither loaded nor decoded, whether they are files or stand in the text.
    let options = Options {
        image_href_resolver: ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..Options::default()
    };
    Tree::from_xmltree(document, &options).map_err(|error| match error {
        usvg::Error::InvalidSize => SvgError::NoSize,
        usvg::Error::ElementsLimitReached => SvgError::TooLarge,
        usvg::Error::ParsingFailed(error) => document::explain(error),
        other => SvgError::Unreadable(other.to_string()),
    })
}

/// An affine map, with which a point (x, y) becomes (a x + c y + e, b x + d y + f).
#[derive(Debug, Clone, Copy)]
struct Map([f64; 6]);

impl Map {
    const IDENTITY: Self = Self([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);

    /// This map after another one.
    fn after(self, first: Transform) -> Self {
        let Self([a, b, c, d, e, f]) = self;
        let along = |x: f64, y: f64| (a * x + c * y, b * x + d * y);
        let (xx, xy) = along(f64::from(first.sx), f64::from(first.ky));
        let (yx, yy) = along(f64::from(first.kx), f64::from(first.sy));
        let (tx, ty) = along(f64::from(first.tx), f64::from(first.ty));
        Self([xx, xy, yx, yy, tx + e, ty + f])
    }

    fn apply(self, p: SkPoint) -> Point {
        let Self([a, b, c, d, e, f]) = self;
        let (x, y) = (f64::from(p.x), f64::from(p.y));
        Point::new(e, f) + Vec2::new(a * x + c * y, b * x + d * y)
    }

    /// How much longer it makes lines; where that depends on their direction, the geometric mean.
    fn scale(self) -> f64 {
        let Self([a, b, c, d, ..]) = self;
        (a * d - b * c).abs().sqrt()
    }
}

/// What is handed down from a group to all that it holds.
#[derive(Clone)]
struct Around {
    map: Map,
    clip: Option<usize>,
    opacity: f32,
    lacks: BTreeSet<Lack>,
}

/// What is still to be done, last first.
enum Visit<'a> {
    Enter(&'a Node, Rc<Around>),
    /// The marks from here on stand under an element with this id.
    Leave(&'a str, usize),
}

#[derive(Default)]
struct Walk {
    marks: Vec<Mark>,
    clips: Vec<Clip>,
    drawn: BTreeMap<String, Vec<Range<usize>>>,
}

impl Walk {
    fn through(&mut self, root: &Group) {
        let outermost = Around { map: Map::IDENTITY, clip: None, opacity: 1.0, lacks: BTreeSet::new() };
        let around = self.inside(root, &outermost);
        let mut visits: Vec<Visit<'_>> = entries(root, around).collect();
        while let Some(visit) = visits.pop() {
            match visit {
                Visit::Leave(id, start) => self.name(id, start),
                Visit::Enter(Node::Group(group), around) => {
                    let around = self.inside(group, &around);
                    visits.push(Visit::Leave(group.id(), self.marks.len()));
                    visits.extend(entries(group, around));
                }
                Visit::Enter(Node::Path(path), around) => {
                    let start = self.marks.len();
                    let marks = [filled(path, &around), stroked(path, &around)];
                    match path.paint_order() {
                        PaintOrder::FillAndStroke => self.marks.extend(marks.into_iter().flatten()),
                        PaintOrder::StrokeAndFill => self.marks.extend(marks.into_iter().rev().flatten()),
                    }
                    self.name(path.id(), start);
                }
                Visit::Enter(Node::Image(_) | Node::Text(_), ..) => {}
            }
        }
    }

    /// What the content of a group inherits.
    fn inside(&mut self, group: &Group, around: &Around) -> Rc<Around> {
        let map = around.map.after(group.transform());
        let mut lacks = around.lacks.clone();
        lacks.extend(group.mask().map(|_| Lack::Mask));
        lacks.extend((!group.filters().is_empty()).then_some(Lack::Filter));
        lacks.extend((group.blend_mode() != BlendMode::Normal).then_some(Lack::Blend));
        let clip = self.clip_of(group, map, around.clip);
        Rc::new(Around { map, clip, opacity: around.opacity * group.opacity().get(), lacks })
    }

    /// Notes that the marks from `start` on stand under an id.
    fn name(&mut self, id: &str, start: usize) {
        if !id.is_empty() && start < self.marks.len() {
            self.drawn.entry(id.to_owned()).or_default().push(start..self.marks.len());
        }
    }

    /// The clip path that the content of a group is seen through.
    fn clip_of(&mut self, group: &Group, map: Map, outer: Option<usize>) -> Option<usize> {
        let mut outer = outer;
        let mut next = group.clip_path();
        // Clip paths that are clipped themselves: as good as one within the other.
        while let Some(clip) = next {
            let shapes = shapes_of_clip(clip, map);
            self.clips.push(Clip { shapes, outer });
            outer = Some(self.clips.len() - 1);
            next = clip.clip_path();
        }
        outer
    }

    fn finish(self, tree: &Tree, elements: &Elements) -> SvgFile {
        let size = [f64::from(tree.size().width()), f64::from(tree.size().height())];
        let mut drawn = self.drawn;
        if let Some(root) = &elements.root {
            drawn.insert(root.clone(), std::iter::once(0..self.marks.len()).collect());
        }
        let runs = |id: &String| drawn.get(id).cloned().unwrap_or_default();
        let named = |names: &Names| {
            names.iter().map(|(name, ids)| (name.clone(), ids.iter().flat_map(runs).collect())).collect()
        };
        SvgFile {
            size,
            ids: elements.ids.iter().map(|id| (id.clone(), runs(id))).collect(),
            layers: named(&elements.layers),
            classes: named(&elements.classes),
            unread: elements.unread.clone(),
            marks: self.marks,
            clips: self.clips,
        }
    }
}

/// The content of a group, the first element last.
fn entries(group: &Group, around: Rc<Around>) -> impl Iterator<Item = Visit<'_>> {
    group.children().iter().rev().map(move |node| Visit::Enter(node, Rc::clone(&around)))
}

/// The shapes of a clip path; those within it that are clipped themselves are taken whole.
fn shapes_of_clip(clip: &ClipPath, map: Map) -> Vec<Mark> {
    let map = map.after(clip.transform());
    let mut shapes = Vec::new();
    let mut visits: Vec<(&Node, Map)> = clip.root().children().iter().rev().map(|node| (node, map)).collect();
    while let Some((node, map)) = visits.pop() {
        match node {
            Node::Group(group) => {
                let map = map.after(group.transform());
                visits.extend(group.children().iter().rev().map(|node| (node, map)));
            }
            Node::Path(path) => {
                let around = Around { map, clip: None, opacity: 1.0, lacks: BTreeSet::new() };
                shapes.extend(filled(path, &around));
            }
            Node::Image(_) | Node::Text(_) => {}
        }
    }
    shapes
}

/// The inside of a path, if it is seen and filled.
fn filled(path: &usvg::Path, around: &Around) -> Option<Mark> {
    let fill = path.fill().filter(|_| path.is_visible())?;
    let rule = match fill.rule() {
        usvg::FillRule::NonZero => FillRule::NonZero,
        usvg::FillRule::EvenOdd => FillRule::EvenOdd,
    };
    Some(mark(path.data(), MarkKind::Fill(rule), (fill.paint(), fill.opacity()), around))
}

/// The line of a path, if it is seen and stroked; in pieces if it is dashed.
fn stroked(path: &usvg::Path, around: &Around) -> Option<Mark> {
    let stroke = path.stroke().filter(|_| path.is_visible())?;
    let ends = match stroke.linecap() {
        LineCap::Butt => Ends::Butt,
        LineCap::Round => Ends::Round,
        LineCap::Square => Ends::Square,
    };
    let scale = around.map.scale();
    let kind = MarkKind::Stroke { width: f64::from(stroke.width().get()) * scale, ends };
    let paint = (stroke.paint(), stroke.opacity());
    Some(match dashed(path.data(), stroke, scale) {
        Some(dashes) => mark(&dashes, kind, paint, around),
        None => mark(path.data(), kind, paint, around),
    })
}

fn dashed(path: &Path, stroke: &Stroke, scale: f64) -> Option<Path> {
    let dash = StrokeDash::new(stroke.dasharray()?.to_vec(), stroke.dashoffset())?;
    path.dash(&dash, scale as f32)
}

fn mark(path: &Path, kind: MarkKind, (paint, opacity): (&Paint, Opacity), around: &Around) -> Mark {
    let at = |p: SkPoint| around.map.apply(p);
    let steps = path
        .segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => Step::Move(at(p)),
            PathSegment::LineTo(p) => Step::Line(at(p)),
            PathSegment::QuadTo(b, c) => Step::Quadratic(at(b), at(c)),
            PathSegment::CubicTo(b, c, d) => Step::Cubic(at(b), at(c), at(d)),
            PathSegment::Close => Step::Close,
        })
        .collect();
    let mut lacks = around.lacks.clone();
    let colour = match paint {
        Paint::Color(colour) => Some([colour.red, colour.green, colour.blue, 255]),
        Paint::LinearGradient(gradient) => mean(gradient.stops()),
        Paint::RadialGradient(gradient) => mean(gradient.stops()),
        Paint::Pattern(_) => None,
    };
    match paint {
        Paint::Color(_) => {}
        Paint::LinearGradient(_) | Paint::RadialGradient(_) => drop(lacks.insert(Lack::Gradient)),
        Paint::Pattern(_) => drop(lacks.insert(Lack::Pattern)),
    }
    let opacity = opacity.get() * around.opacity;
    let colour = colour.map(|[r, g, b, a]| [r, g, b, (f32::from(a) * opacity).round() as u8]);
    Mark { steps, kind, colour, clip: around.clip, lacks }
}

/// The mean colour of a gradient that runs through its stops once.
fn mean(stops: &[Stop]) -> Option<Rgba> {
    let (first, last) = (stops.first()?, stops.last()?);
    let parts = |stop: &Stop| {
        let colour = stop.color();
        [colour.red, colour.green, colour.blue].map(f64::from)
    };
    let offset = |stop: &Stop| f64::from(stop.offset().get());
    // Each stretch between two stops has their mean; before the first and behind the last their own colour lasts.
    let ends = [(offset(first), first, first), (1.0 - offset(last), last, last)];
    let between = stops.windows(2).map(|pair| (offset(&pair[1]) - offset(&pair[0]), &pair[0], &pair[1]));
    let (mut sum, mut alpha) = ([0.0; 3], 0.0);
    for (share, from, to) in between.chain(ends) {
        for (sum, (a, b)) in sum.iter_mut().zip(parts(from).into_iter().zip(parts(to))) {
            *sum += share * (a + b) / 2.0;
        }
        alpha += share * f64::from(from.opacity().get() + to.opacity().get()) / 2.0 * 255.0;
    }
    let [r, g, b] = sum.map(|v| v.round() as u8);
    Some([r, g, b, alpha.round() as u8])
}
