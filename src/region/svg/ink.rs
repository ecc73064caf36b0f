//! The marks of a file as they are drawn: strokes with their widths and ends, and fills, each in its colour, from the
//! bottom up.
//!
//! Widths are those the transforms leave; where a transform stretches one way more than the other, the geometric mean.
//! Joins are round whatever the file says. What else cannot be drawn is listed as [`Lack`]s.

use std::collections::{BTreeMap, BTreeSet};

use super::{Ends, Lack, Mark, MarkKind, Placement, Rgba, Selection, Step, SvgError, SvgFile, snapped};
use crate::geom::{Length, Point, Rect};
use crate::region::{Operation, Region, chain};

/// What a part of a file draws.
#[derive(Debug, Clone)]
pub struct Inked {
    /// Never empty; from the bottom up.
    pub marks: Vec<InkMark>,
    /// What is drawn otherwise than the file says.
    pub lacks: BTreeSet<Lack>,
}

/// A fill or a stroke.
#[derive(Debug, Clone)]
pub struct InkMark {
    /// Its alpha is not zero.
    pub colour: Rgba,
    /// What has the colour.
    pub shape: InkShape,
}

/// What a mark covers.
#[derive(Debug, Clone)]
pub enum InkShape {
    /// An area; never empty.
    Area(Region),
    /// Lines of one width.
    Lines {
        /// Greater than zero.
        width: Length,
        /// Whether they end in half a disc, or straight at their last point.
        is_round: bool,
        /// Chains of cubic Béziers, of 3n + 1 points each; one that ends at its first point is closed. Never empty.
        chains: Vec<Vec<Point>>,
    },
}

/// Widths are multiples of this many millimetres.
const WIDTHS: f64 = 1e-4;

impl SvgFile {
    /// What a part of the file draws on its page. As for `fit`, see [`SvgFile::region`].
    ///
    /// # Errors
    /// Where there is no such part, nothing of it is drawn, or outlines cross too often.
    pub fn ink(&self, selection: Selection<'_>, fit: Option<Rect>) -> Result<Inked, SvgError> {
        let place = self.place(fit);
        let page = Region::rect(place.page);
        let mut lacks = if selection == Selection::Whole { self.unread.clone() } else { BTreeSet::new() };
        let mut clips = BTreeMap::new();
        let mut marks = Vec::new();
        for mark in self.selected(selection)?.into_iter().filter_map(|i| self.marks.get(i)) {
            lacks.extend(&mark.lacks);
            let Some(colour) = mark.colour.filter(|colour| colour[3] > 0) else { continue };
            let shape = match mark.kind {
                MarkKind::Fill(_) => {
                    let area = self.union(std::iter::once(mark), &place)?;
                    let is_whole = [area.bounds().min, area.bounds().max].into_iter().all(|p| place.page.contains(p));
                    let area = if is_whole { area } else { area.try_combined(&page, Operation::Intersection)? };
                    (!area.is_empty()).then_some(InkShape::Area(area))
                }
                MarkKind::Stroke { width, ends } => {
                    let width = (width * place.scale / WIDTHS).round() * WIDTHS;
                    let mut chains = self.chains(mark, &place, &mut clips)?;
                    if ends == Ends::Square {
                        chains.iter_mut().for_each(|chain| chain::lengthen(chain, width / 2.0));
                    }
                    let chains: Vec<Vec<Point>> =
                        chains.iter().flat_map(|chain| chain::clipped(chain, &page)).collect();
                    let is_round = ends == Ends::Round;
                    let is_seen = width > 0.0 && !chains.is_empty();
                    is_seen.then_some(InkShape::Lines { width: Length::mm(width), is_round, chains })
                }
            };
            marks.extend(shape.map(|shape| InkMark { colour, shape }));
        }
        if marks.is_empty() { Err(SvgError::NotDrawn) } else { Ok(Inked { marks, lacks }) }
    }

    /// The path of a mark as chains of Béziers, as far as its clip path shows them. The clip paths found are kept.
    pub(super) fn chains(
        &self,
        mark: &Mark,
        place: &Placement,
        clips: &mut BTreeMap<usize, Region>,
    ) -> Result<Vec<Vec<Point>>, SvgError> {
        let chains = mark.chains(place);
        let Some(clip) = mark.clip else { return Ok(chains) };
        let area = self.clip(clip, place, clips)?;
        Ok(chains.iter().flat_map(|chain| chain::clipped(chain, &area)).collect())
    }
}

impl Mark {
    /// Its path on the page as chains of cubic Béziers.
    fn chains(&self, place: &Placement) -> Vec<Vec<Point>> {
        let at = |p: Point| snapped(place.point(p));
        let mut chains = Vec::new();
        let mut current: Vec<Point> = Vec::new();
        for step in &self.steps {
            let from = current.last().copied();
            match (*step, from) {
                (Step::Move(p), _) => {
                    chains.push(std::mem::replace(&mut current, vec![at(p)]));
                }
                (Step::Line(p), Some(a)) => chain::push_line(&mut current, a, at(p)),
                (Step::Quadratic(b, c), Some(a)) => {
                    let (b, c) = (at(b), at(c));
                    current.extend([a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c]);
                }
                (Step::Cubic(b, c, d), Some(_)) => current.extend([at(b), at(c), at(d)]),
                (Step::Close, Some(a)) => {
                    let first = current.first().copied().unwrap_or(a);
                    chain::push_line(&mut current, a, first);
                    chains.push(std::mem::replace(&mut current, vec![first]));
                }
                (_, None) => {}
            }
        }
        chains.push(current);
        chains.retain(|chain| chain.len() > 1);
        chains
    }
}
