//! A layer in portions: what back ends that write text write without a break.
//!
//! A layer's marks go in, grouped by how they are painted; pieces of them come out, each a path or a part of one. Text of
//! several portions is made by several threads; what they make does not depend on how many there are.

use std::io;

use rayon::prelude::*;

use crate::drawing::{Curves, Drawing, Layer, Tapers};
use crate::geom::{Length, Point};
use crate::scene::Cap;

/// Up to this number of tiles, longer strokes and areas each has a path of its own.
pub(super) const MANY: usize = 20_000;
/// How many share a path where there are more.
pub(super) const TOGETHER: usize = 64;
/// Strokes of a path that one thread writes at a time.
pub(super) const PIECE: usize = 8_192;
/// Points that one thread writes at a time, unless a single piece has more.
const PORTION: usize = 16_384;
/// Portions that are held as text at a time.
const AT_ONCE: usize = 32;

/// How many tiles, longer strokes and areas share a path.
pub(super) fn together(drawing: &Drawing) -> usize {
    if count_paths(drawing) > MANY { TOGETHER } else { 1 }
}

/// How many paths there are with one for each tile, longer stroke and area.
fn count_paths(drawing: &Drawing) -> usize {
    let count = |layer: &Layer| {
        let strokes = layer
            .strokes
            .iter()
            .map(|strokes| strokes.bundle_ends.len() + strokes.polylines.len() + bundle_ends(&strokes.curves).len());
        let dots: usize = layer.dots.iter().map(|d| d.bundle_ends.len()).sum();
        layer.areas.len() + strokes.sum::<usize>() + bundle_ends(&layer.tapers.spines).len() + dots
    };
    drawing.layers.iter().map(count).sum()
}

/// Where each tile's chains end; a chain of no tile is by itself.
fn bundle_ends(curves: &Curves) -> Vec<usize> {
    let mut ends = curves.bundle_ends().to_vec();
    ends.extend(ends.last().copied().unwrap_or(0) + 1..=curves.len());
    ends
}

/// How the marks of a group are painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Style {
    /// Filled: by the even-odd rule, but [`Marks::Rings`] by the non-zero one.
    Areas,
    /// Filled by the non-zero rule.
    Tapers,
    /// Stroked with a pen, with round joins.
    Stroke(Length, Cap),
}

/// Marks that are painted alike.
pub(super) struct Group<'a> {
    pub(super) style: Style,
    pub(super) pieces: Vec<Piece<'a>>,
}

/// What one thread writes without a break: a path or a part of one.
pub(super) struct Piece<'a> {
    pub(super) marks: Marks<'a>,
    /// Whether the path starts with it.
    pub(super) starts: bool,
    /// Whether the path ends with it.
    pub(super) ends: bool,
}

#[derive(Clone, Copy)]
pub(super) enum Marks<'a> {
    Lines(&'a [[Point; 2]]),
    Polylines(&'a [Vec<Point>]),
    /// The chains between two numbers.
    Curves(&'a Curves, usize, usize),
    /// The strokes between two numbers.
    Tapers(&'a Tapers, usize, usize),
    Dots(&'a [Point]),
    /// One area of any number of rings.
    Area(&'a [Vec<Point>]),
    /// Areas of one ring each.
    Rings(&'a [Vec<Vec<Point>>]),
}

impl<'a> Piece<'a> {
    fn whole(marks: Marks<'a>) -> Self {
        Self { marks, starts: true, ends: true }
    }

    /// How many points it has.
    pub(super) fn points(&self) -> usize {
        match self.marks {
            Marks::Lines(lines) => lines.len() * 2,
            Marks::Polylines(lines) => lines.iter().map(Vec::len).sum(),
            Marks::Curves(curves, from, to) => (from..to).map(|i| curves.chain(i).len()).sum(),
            // Both sides.
            Marks::Tapers(tapers, from, to) => (from..to).map(|i| 2 * tapers.spines.chain(i).len()).sum(),
            Marks::Dots(centres) => centres.len(),
            Marks::Area(rings) => rings.iter().map(Vec::len).sum(),
            Marks::Rings(areas) => areas.iter().flatten().map(Vec::len).sum(),
        }
    }
}

/// All marks of a layer in the order in which they are painted. No group is empty.
pub(super) fn groups(layer: &Layer, together: usize) -> Vec<Group<'_>> {
    let mut groups = vec![Group { style: Style::Areas, pieces: area_pieces(&layer.areas, together) }];
    for strokes in &layer.strokes {
        let lines = |from, to| Marks::Lines(strokes.lines.get(from..to).unwrap_or_default());
        let mut pieces = bundle_pieces(&strokes.bundle_ends, together, lines);
        pieces.extend(strokes.polylines.chunks(together).map(|lines| Piece::whole(Marks::Polylines(lines))));
        let curves = |from, to| Marks::Curves(&strokes.curves, from, to);
        pieces.extend(bundle_pieces(&bundle_ends(&strokes.curves), together, curves));
        groups.push(Group { style: Style::Stroke(strokes.pen, strokes.cap), pieces });
    }
    let tapers = |from, to| Marks::Tapers(&layer.tapers, from, to);
    let pieces = bundle_pieces(&bundle_ends(&layer.tapers.spines), together, tapers);
    groups.push(Group { style: Style::Tapers, pieces });
    for dots in &layer.dots {
        // A stroke of no length with round ends is a dot to every reader, and to a plotter a touch of the pen.
        let centres = |from, to| Marks::Dots(dots.centres.get(from..to).unwrap_or_default());
        let pieces = bundle_pieces(&dots.bundle_ends, together, centres);
        groups.push(Group { style: Style::Stroke(dots.radius * 2.0, Cap::Round), pieces });
    }
    groups.retain(|group| !group.pieces.is_empty());
    groups
}

/// Paths of `together` bundles each; `ends` says where each bundle ends.
fn bundle_pieces<'a>(ends: &[usize], together: usize, marks: impl Fn(usize, usize) -> Marks<'a>) -> Vec<Piece<'a>> {
    let mut pieces = Vec::with_capacity(ends.len().div_ceil(together));
    let mut start = 0;
    for &end in ends.chunks(together).filter_map(|bundles| bundles.last()) {
        for from in (start..end).step_by(PIECE) {
            let to = end.min(from + PIECE);
            pieces.push(Piece { marks: marks(from, to), starts: from == start, ends: to == end });
        }
        start = end;
    }
    pieces
}

/// A path for each area; where there are many, simple ones that follow each other share one.
pub(super) fn area_pieces(areas: &[Vec<Vec<Point>>], together: usize) -> Vec<Piece<'_>> {
    let is_simple = |area: &Vec<Vec<Point>>| together > 1 && area.len() == 1;
    areas
        .chunk_by(|a, b| is_simple(a) && is_simple(b))
        .flat_map(|run| run.chunks(together))
        .map(|run| match run {
            [area] => Piece::whole(Marks::Area(area)),
            areas => Piece::whole(Marks::Rings(areas)),
        })
        .collect()
}

/// Makes something of pieces, several portions at a time, and hands it on in order.
pub(super) fn for_each_portion<T: Send>(
    pieces: &[Piece<'_>],
    make: impl Fn(&[Piece<'_>]) -> T + Sync,
    mut take: impl FnMut(T) -> io::Result<()>,
) -> io::Result<()> {
    let mut portions = Vec::new();
    let (mut start, mut points) = (0, 0);
    for (i, piece) in pieces.iter().enumerate() {
        points += piece.points();
        if points >= PORTION {
            portions.push(&pieces[start..=i]);
            (start, points) = (i + 1, 0);
        }
    }
    portions.push(&pieces[start..]);
    for several in portions.chunks(AT_ONCE) {
        let made: Vec<T> = several.par_iter().map(|pieces| make(pieces)).collect();
        made.into_iter().try_for_each(&mut take)?;
    }
    Ok(())
}
