//! Gaps between lines: where lines end, and the shortest ways from there to other lines.
//!
//! A stroke ends at its two ends, a dark shape at the tips of what is thin in it. An end that runs into another line, or
//! a little past it, leaves no gap. All distances are measured from ink to ink.

use std::ops::Range;

use super::{Border, Lines};
use crate::geom::{Point, Polygon};
use crate::region::Region;
use crate::region::index::Segment;
use crate::region::nearest::Nearest;

/// How far along an outline its two sides are compared, in millimetres: where they come back to each other is a tip.
const TIP: f64 = 0.8;

/// The two sides lie no farther apart at a tip than this share of the way to it.
const THIN: f64 = 0.6;

/// A line is bridged to itself only where the way along it is so many times as long as the bridge.
const DETOUR: f64 = 3.0;

/// A straight piece of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) a: Point,
    pub(super) b: Point,
    /// The line it belongs to.
    line: usize,
    /// How far along the line it begins, in millimetres.
    pub(super) from: f64,
    /// Half the width of the ink.
    radius: f64,
}

/// A way over a gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bridge {
    pub(super) from: Point,
    pub(super) to: Point,
    /// From ink to ink in millimetres, not negative.
    pub(super) gap: f64,
}

struct Line {
    pieces: Range<usize>,
    length: f64,
    is_closed: bool,
}

impl Line {
    /// How far it is along the line from one place to another.
    fn way(&self, a: f64, b: f64) -> f64 {
        let way = (a - b).abs();
        if self.is_closed { way.min(self.length - way) } else { way }
    }
}

/// Where a line ends.
#[derive(Debug, Clone, Copy)]
struct End {
    at: Point,
    line: usize,
    /// How far along the line it lies.
    along: f64,
    /// How far the ink reaches beyond it.
    beyond: f64,
}

/// All lines of a drawing.
pub(super) struct Network {
    pub(super) pieces: Vec<Piece>,
    /// How many of the pieces are those of strokes; they come first.
    strokes: usize,
    lines: Vec<Line>,
    ends: Vec<End>,
    tree: Nearest,
    widest: f64,
}

impl Network {
    pub(super) fn new(lines: &Lines, border: Border) -> Self {
        let tree = Nearest::new(&[]);
        let mut network =
            Self { pieces: Vec::new(), strokes: 0, lines: Vec::new(), ends: Vec::new(), tree, widest: 0.0 };
        for centre in &lines.centres {
            let line = network.add(&centre.points, centre.radius);
            let (Some(added), Some(&first), Some(&last)) =
                (network.lines.get(line), centre.points.first(), centre.points.last())
            else {
                continue;
            };
            if !added.is_closed {
                let ends = [(first, 0.0), (last, added.length)];
                let ends = ends.map(|(at, along)| End { at, line, along, beyond: centre.beyond });
                network.ends.extend(ends.into_iter().filter(|end| lines.page.contains(end.at)));
            }
        }
        network.strokes = network.pieces.len();
        for ring in lines.dark.polygons().iter().flat_map(Polygon::rings) {
            let closed: Vec<Point> = ring.iter().chain(ring.first()).copied().collect();
            let line = network.add(&closed, 0.0);
            let tips = network.tips(line, &lines.dark);
            network.ends.extend(tips.into_iter().filter(|end| lines.page.contains(end.at)));
        }
        if border == Border::Wall {
            let corners = lines.page.corners();
            let closed: Vec<Point> = corners.iter().chain(corners.first()).copied().collect();
            network.add(&closed, 0.0);
        }
        let segments: Vec<Segment> = network.pieces.iter().map(|&Piece { a, b, .. }| Segment { a, b }).collect();
        network.tree = Nearest::new(&segments);
        network
    }

    fn add(&mut self, points: &[Point], radius: f64) -> usize {
        let (start, line) = (self.pieces.len(), self.lines.len());
        let mut length = 0.0;
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            self.pieces.push(Piece { a, b, line, from: length, radius });
            length += a.distance(b);
        }
        let is_closed = points.first() == points.last();
        self.lines.push(Line { pieces: start..self.pieces.len(), length, is_closed });
        self.widest = self.widest.max(radius);
        line
    }

    /// The pieces of all strokes.
    pub(super) fn strokes(&self) -> &[Piece] {
        self.pieces.get(..self.strokes).unwrap_or_default()
    }

    /// The pieces of a line.
    fn pieces_of(&self, line: usize) -> &[Piece] {
        self.lines.get(line).and_then(|line| self.pieces.get(line.pieces.clone())).unwrap_or_default()
    }

    /// The place so far along a line, which for a closed one may be beyond its ends.
    fn place(&self, line: usize, along: f64) -> Option<Point> {
        let length = self.lines.get(line)?.length;
        let along = along - (along / length).floor() * length;
        let pieces = self.pieces_of(line);
        let piece = pieces.get(pieces.partition_point(|piece| piece.from <= along).checked_sub(1)?)?;
        let own = piece.a.distance(piece.b);
        Some(if own > 0.0 { piece.a.lerp(piece.b, ((along - piece.from) / own).min(1.0)) } else { piece.a })
    }

    /// The tips of the thin parts of a dark shape on one of its outlines.
    fn tips(&self, line: usize, dark: &Region) -> Vec<End> {
        let Some(outline) = self.lines.get(line) else { return Vec::new() };
        let span = TIP.min(outline.length / 4.0);
        let mut found: Vec<(f64, End)> = Vec::new();
        for piece in self.pieces_of(line) {
            let sides = (self.place(line, piece.from - span), self.place(line, piece.from + span));
            let (Some(a), Some(b)) = sides else { continue };
            let apart = a.distance(b);
            if apart <= THIN * span && dark.contains(a.lerp(b, 0.5)) {
                found.push((apart, End { at: piece.a, line, along: piece.from, beyond: 0.0 }));
            }
        }
        // Of those around one tip, the one whose sides are nearest to each other.
        let mut order: Vec<usize> = (0..found.len()).collect();
        order.sort_by(|&i, &j| found[i].0.total_cmp(&found[j].0).then(i.cmp(&j)));
        let mut is_taken = vec![false; found.len()];
        let mut tips = Vec::new();
        for i in order {
            if is_taken[i] {
                continue;
            }
            let near = |j: &usize| outline.way(found[i].1.along, found[*j].1.along) <= span;
            // Around the ring both ways, as far as the tip's surroundings go.
            let after = (1..found.len()).map(|k| (i + k) % found.len()).take_while(near);
            let before = (1..found.len()).map(|k| (i + found.len() - k) % found.len()).take_while(near);
            let around: Vec<usize> = after.chain(before).collect();
            is_taken[i] = true;
            around.into_iter().for_each(|j| is_taken[j] = true);
            tips.push(found[i].1);
        }
        tips
    }

    /// Whether a point lies on the ink of a stroke.
    pub(super) fn is_on_line(&self, p: Point) -> bool {
        let mut is_on = false;
        self.tree.search(self.pieces.len(), p, self.widest, |i| {
            if let Some(piece) = self.pieces.get(i) {
                is_on |= piece.nearest(p).0.distance(p) <= piece.radius;
            }
            self.widest
        });
        is_on
    }

    /// The bridges from all ends over gaps of at most `most` millimetres, the shortest first. Ends that run past another
    /// line by up to `past` have none.
    pub(super) fn bridges(&self, dark: &Region, past: f64, most: f64) -> Vec<Bridge> {
        let open: Vec<End> =
            self.ends.iter().copied().filter(|end| !dark.contains(end.at) && !self.is_met(end, past)).collect();
        let dots: Vec<Segment> = open.iter().map(|end| Segment { a: end.at, b: end.at }).collect();
        let tree = Nearest::new(&dots);
        let mut bridges: Vec<Bridge> = Vec::new();
        for (i, end) in open.iter().enumerate() {
            bridges.extend(self.to_line(end, most));
            bridges.extend(self.to_end(i, &open, &tree, most));
        }
        bridges.sort_by(|a, b| a.gap.total_cmp(&b.gap));
        bridges
    }

    /// The shortest bridge from an end to a line.
    fn to_line(&self, end: &End, most: f64) -> Option<Bridge> {
        let mut best: Option<(f64, f64, usize, Point)> = None;
        let reach = |gap: f64| gap + end.beyond + self.widest;
        self.tree.search(self.pieces.len(), end.at, reach(most), |i| {
            let limit = best.map_or(most, |best| best.0);
            let Some(piece) = self.pieces.get(i) else { return reach(limit) };
            let (to, along) = piece.nearest(end.at);
            let distance = to.distance(end.at);
            let gap = (distance - end.beyond - piece.radius).max(0.0);
            let is_nearer = best.is_none_or(|best| (gap, distance, i) < (best.0, best.1, best.2));
            if gap > most || !is_nearer || !self.is_apart(end, piece.line, along, distance) {
                return reach(limit);
            }
            best = Some((gap, distance, i, to));
            reach(gap)
        });
        best.map(|(gap, _, _, to)| Bridge { from: end.at, to, gap })
    }

    /// The shortest bridge from an end to another one.
    fn to_end(&self, i: usize, open: &[End], tree: &Nearest, most: f64) -> Option<Bridge> {
        let end = open.get(i)?;
        let mut best: Option<(f64, usize, Point)> = None;
        let reach = |gap: f64| gap + end.beyond + self.widest;
        tree.search(open.len(), end.at, reach(most), |j| {
            let limit = best.map_or(most, |best| best.0);
            let Some(other) = open.get(j).filter(|_| j != i) else { return reach(limit) };
            let distance = other.at.distance(end.at);
            let gap = (distance - end.beyond - other.beyond).max(0.0);
            let is_nearer = best.is_none_or(|best| (gap, j) < (best.0, best.1));
            if gap > most || !is_nearer || !self.is_apart(end, other.line, other.along, distance) {
                return reach(limit);
            }
            best = Some((gap, j, other.at));
            reach(gap)
        });
        best.map(|(gap, _, to)| Bridge { from: end.at, to, gap })
    }

    /// Whether a place on a line is another one than the end's own surroundings.
    fn is_apart(&self, end: &End, line: usize, along: f64, distance: f64) -> bool {
        line != end.line || self.lines.get(line).is_some_and(|line| line.way(end.along, along) > DETOUR * distance)
    }

    /// Whether a line meets another one within `past` of its end.
    fn is_met(&self, end: &End, past: f64) -> bool {
        let Some(own) = self.lines.get(end.line) else { return false };
        let mut is_met = false;
        // The pieces on both sides of the end, as far as they go.
        let pieces = self.pieces_of(end.line);
        let count = pieces.len();
        let start = pieces.partition_point(|piece| piece.from < end.along);
        let onwards =
            (0..count).map(|k| start + k).take_while(|&i| own.is_closed || i < count).map(|i| i % count.max(1));
        let back = (1..=count).map(|k| start + count - k);
        let back = back.take_while(|&i| own.is_closed || i >= count).map(|i| i % count.max(1));
        let is_near = |i: &usize| {
            pieces.get(*i).is_some_and(|piece| {
                let to = piece.from + piece.a.distance(piece.b);
                own.way(piece.from, end.along).min(own.way(to, end.along)) < past
            })
        };
        let near: Vec<usize> = onwards.take_while(is_near).chain(back.take_while(is_near)).collect();
        for piece in near.into_iter().filter_map(|i| pieces.get(i)) {
            let length = piece.a.distance(piece.b);
            let middle = piece.a.lerp(piece.b, 0.5);
            self.tree.search(self.pieces.len(), middle, length / 2.0, |i| {
                if let Some(other) = self.pieces.get(i)
                    && let Some(share) = crossing(piece, other)
                {
                    let along = piece.from + share * length;
                    let place = other.nearest(piece.a.lerp(piece.b, share)).1;
                    let is_other = other.line != piece.line || own.way(along, place) > past.max(length);
                    is_met |= is_other && own.way(along, end.along) <= past;
                }
                length / 2.0
            });
        }
        is_met
    }
}

/// Where along a piece another one meets it, as a share; nothing for those that run along each other.
fn crossing(piece: &Piece, other: &Piece) -> Option<f64> {
    let (way, across) = (piece.b - piece.a, other.b - other.a);
    let area = way.cross(across);
    if area == 0.0 {
        return None;
    }
    let between = other.a - piece.a;
    let (s, t) = (between.cross(across) / area, between.cross(way) / area);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then_some(s)
}
