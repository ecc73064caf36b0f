//! Drawings that the page may still ask for, the oldest given up first.

use std::collections::VecDeque;
use std::sync::{Arc, OnceLock};

use crate::back::raster::Index;
use crate::drawing::Drawing;
use crate::scene::Scene;

/// How many are kept.
const MOST: usize = 64;

/// How many bytes all kept ones take, about; the newest is kept whatever it takes.
const MEMORY: usize = 512 << 20;

/// A drawing that was made.
pub(super) struct Picture {
    /// What was drawn.
    pub(super) drawing: Drawing,
    /// What it was drawn from.
    pub(super) scene: Scene,
    /// Its SVG, where it is small enough to be shown so.
    pub(super) svg: OnceLock<Arc<[u8]>>,
    /// Where its marks lie, once tiles of it were asked for.
    pub(super) index: OnceLock<Index>,
    /// The paint that was drawn alone.
    pub(super) only: Option<String>,
    /// How many tiles it has.
    pub(super) tiles: u64,
}

impl Picture {
    /// Where its marks lie.
    pub(super) fn index(&self) -> &Index {
        self.index.get_or_init(|| Index::new(&self.drawing))
    }
}

/// Those that are kept.
#[derive(Default)]
pub(super) struct Pictures {
    list: VecDeque<(u64, usize, Arc<Picture>)>,
    last: u64,
}

impl Pictures {
    /// Keeps a drawing of about so many bytes; its number.
    pub(super) fn keep(&mut self, picture: Picture, bytes: usize) -> u64 {
        self.last += 1;
        self.list.push_back((self.last, bytes, Arc::new(picture)));
        while self.list.len() > 1 && (self.list.len() > MOST || self.bytes() > MEMORY) {
            self.list.pop_front();
        }
        self.last
    }

    fn bytes(&self) -> usize {
        self.list.iter().map(|(_, bytes, _)| bytes).sum()
    }

    /// The drawing of a number, if it is still kept.
    pub(super) fn get(&self, id: u64) -> Option<Arc<Picture>> {
        self.list.iter().find(|(known, ..)| *known == id).map(|(.., picture)| Arc::clone(picture))
    }
}

/// How many points a drawing has, about: what it takes in memory and as text follows from that.
pub(super) fn points(drawing: &Drawing) -> usize {
    let of = |layer: &crate::drawing::Layer| -> usize {
        let areas: usize = layer.areas.iter().flatten().map(Vec::len).sum();
        let strokes: usize = layer
            .strokes
            .iter()
            .map(|strokes| {
                let bent: usize = strokes.polylines.iter().map(Vec::len).sum();
                strokes.lines.len() * 2 + bent + strokes.curves.points()
            })
            .sum();
        let dots: usize = layer.dots.iter().map(|dots| dots.centres.len()).sum();
        areas + strokes + layer.tapers.spines.points() + dots
    };
    drawing.layers.iter().map(of).sum()
}
