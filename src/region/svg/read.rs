//! From the text of an SVG file to its filled shapes: usvg resolves styles, units, `use` and viewports, and what it makes
//! of them is walked through in the order of drawing.

use std::collections::BTreeMap;
use std::ops::Range;

use usvg::tiny_skia_path::{PathSegment, Point as SkPoint, Transform};
use usvg::{ClipPath, Group, ImageHrefResolver, Node, Options, Tree};

use super::document::{self, Elements, Names};
use super::{Clip, Shape, Step, SvgError, SvgFile};
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
}

/// What is still to be done, last first.
enum Visit<'a> {
    Enter(&'a Node, Map, Option<usize>),
    /// The shapes from here on stand under an element with this id.
    Leave(&'a str, usize),
}

#[derive(Default)]
struct Walk {
    shapes: Vec<Shape>,
    clips: Vec<Clip>,
    drawn: BTreeMap<String, Vec<Range<usize>>>,
}

impl Walk {
    fn through(&mut self, root: &Group) {
        let map = Map::IDENTITY.after(root.transform());
        let clip = self.clip_of(root, map, None);
        let mut visits: Vec<Visit<'_>> = entries(root, map, clip).collect();
        while let Some(visit) = visits.pop() {
            match visit {
                Visit::Leave(id, start) => self.name(id, start),
                Visit::Enter(Node::Group(group), map, clip) => {
                    let map = map.after(group.transform());
                    let clip = self.clip_of(group, map, clip);
                    visits.push(Visit::Leave(group.id(), self.shapes.len()));
                    visits.extend(entries(group, map, clip));
                }
                Visit::Enter(Node::Path(path), map, clip) => {
                    let start = self.shapes.len();
                    self.shapes.extend(filled(path, map, clip));
                    self.name(path.id(), start);
                }
                Visit::Enter(Node::Image(_) | Node::Text(_), ..) => {}
            }
        }
    }

    /// Notes that the shapes from `start` on stand under an id.
    fn name(&mut self, id: &str, start: usize) {
        if !id.is_empty() && start < self.shapes.len() {
            self.drawn.entry(id.to_owned()).or_default().push(start..self.shapes.len());
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
            drawn.insert(root.clone(), std::iter::once(0..self.shapes.len()).collect());
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
            shapes: self.shapes,
            clips: self.clips,
        }
    }
}

/// The content of a group, the first element last.
fn entries(group: &Group, map: Map, clip: Option<usize>) -> impl Iterator<Item = Visit<'_>> {
    group.children().iter().rev().map(move |node| Visit::Enter(node, map, clip))
}

/// The shapes of a clip path; those within it that are clipped themselves are taken whole.
fn shapes_of_clip(clip: &ClipPath, map: Map) -> Vec<Shape> {
    let map = map.after(clip.transform());
    let mut shapes = Vec::new();
    let mut visits: Vec<(&Node, Map)> = clip.root().children().iter().rev().map(|node| (node, map)).collect();
    while let Some((node, map)) = visits.pop() {
        match node {
            Node::Group(group) => {
                let map = map.after(group.transform());
                visits.extend(group.children().iter().rev().map(|node| (node, map)));
            }
            Node::Path(path) => shapes.extend(filled(path, map, None)),
            Node::Image(_) | Node::Text(_) => {}
        }
    }
    shapes
}

/// The outline of a path, if it is seen and filled.
fn filled(path: &usvg::Path, map: Map, clip: Option<usize>) -> Option<Shape> {
    let fill = path.fill().filter(|_| path.is_visible())?;
    let rule = match fill.rule() {
        usvg::FillRule::NonZero => FillRule::NonZero,
        usvg::FillRule::EvenOdd => FillRule::EvenOdd,
    };
    let at = |p: SkPoint| map.apply(p);
    let steps = path
        .data()
        .segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => Step::Move(at(p)),
            PathSegment::LineTo(p) => Step::Line(at(p)),
            PathSegment::QuadTo(b, c) => Step::Quadratic(at(b), at(c)),
            PathSegment::CubicTo(b, c, d) => Step::Cubic(at(b), at(c), at(d)),
            PathSegment::Close => Step::Close,
        })
        .collect();
    Some(Shape { steps, rule, clip })
}
