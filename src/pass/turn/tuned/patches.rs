//! Patches: the sites of a graph in compact groups of about a hundred, numbered group by group.

use crate::geom::{Point, Rect};

/// The most sites in a patch. What the eye takes in at a glance is about so much, and the graphs that angles were
/// studied on are smaller, so that each of those is a single patch.
const MOST: usize = 128;

/// Sites in the order of their patches.
pub(super) struct Patches {
    /// The site at each place of the order.
    pub(super) order: Vec<u32>,
    /// Where patches begin in the order; one more than there are patches.
    pub(super) starts: Vec<u32>,
}

impl Patches {
    /// Halves the points across the longer side of their box, again and again, until all groups are small enough.
    pub(super) fn new(points: &[Point]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut starts = vec![0];
        // Ranges that are still to be looked at, the first on top.
        let mut left: Vec<_> = std::iter::once(0..order.len()).collect();
        while let Some(range) = left.pop() {
            if range.len() <= MOST {
                order[range.clone()].sort_unstable();
                starts.push(range.end as u32);
                continue;
            }
            let sites = &mut order[range.clone()];
            let bounds = sites.iter().fold(Rect::EMPTY, |bounds, &site| bounds.including(points[site as usize]));
            let is_wide = bounds.width() >= bounds.height();
            let along = |site: u32| {
                let p = points[site as usize];
                if is_wide { p.x } else { p.y }
            };
            // As many patches on either side as can be, all about as full.
            let patches = sites.len().div_ceil(MOST);
            let middle = sites.len() * (patches / 2) / patches;
            // Of sites in one place the index decides.
            sites.select_nth_unstable_by(middle, |&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
            left.push(range.start + middle..range.end);
            left.push(range.start..range.start + middle);
        }
        if order.is_empty() {
            starts.truncate(1);
        }
        Self { order, starts }
    }
}
