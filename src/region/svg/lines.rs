//! The lines of a file that a flood runs up against: the centres of its strokes, and what is filled darkly.

use std::collections::BTreeMap;

use super::{Ends, MarkKind, Rgba, Selection, SvgError, SvgFile};
use crate::geom::{Rect, bezier};
use crate::region::FLATTENING;
use crate::region::flood::{Centre, Lines};

/// Strokes whose luma, in shares of white's, is above this are no lines: white strokes part what they cross.
const WHITE: f64 = 0.9;

/// Fills whose luma is below this are ink: blackened hair, and lines of changing width that were saved as outlines.
const DARK: f64 = 0.5;

/// Marks with less alpha than this hold nothing back.
const SHEER: u8 = 128;

impl SvgFile {
    /// The lines of a part of the file, on the page. As for `fit`, see [`SvgFile::region`].
    ///
    /// # Errors
    /// Where there is no such part, it has neither strokes nor dark fills, or outlines cross too often.
    pub fn lines(&self, selection: Selection<'_>, fit: Option<Rect>) -> Result<Lines, SvgError> {
        let place = self.place(fit);
        let mut clips = BTreeMap::new();
        let mut centres = Vec::new();
        let mut dark = Vec::new();
        for mark in self.selected(selection)?.into_iter().filter_map(|i| self.marks.get(i)) {
            match mark.kind {
                MarkKind::Fill(_) => dark.extend(mark.colour.is_some_and(is_dark).then_some(mark)),
                MarkKind::Stroke { width, ends } if mark.colour.is_none_or(is_line) => {
                    let radius = width * place.scale / 2.0;
                    let beyond = if ends == Ends::Butt { 0.0 } else { radius };
                    for chain in self.chains(mark, &place, &mut clips)? {
                        centres.push(Centre { points: bezier::flatten(&chain, FLATTENING), radius, beyond });
                    }
                }
                MarkKind::Stroke { .. } => {}
            }
        }
        let dark = self.union(dark.into_iter(), &place)?;
        if centres.is_empty() && dark.is_empty() {
            return Err(SvgError::NoLines);
        }
        Ok(Lines { page: place.page, centres, dark })
    }
}

/// The share of white's luma (Rec. 709), of sRGB as it is written.
fn luma([r, g, b, _]: Rgba) -> f64 {
    (0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)) / 255.0
}

fn is_line(colour: Rgba) -> bool {
    luma(colour) <= WHITE && colour[3] >= SHEER
}

fn is_dark(colour: Rgba) -> bool {
    luma(colour) < DARK && colour[3] >= SHEER
}
