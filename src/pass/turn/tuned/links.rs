//! Links of sites in the order of their patches: neighbours, and what lies two and three links away.

use rayon::prelude::*;

use crate::stage::Graph;

use super::super::seen::Offsets;
use super::patches::Patches;

/// The most sites that are kept two links away from a site, and three. Triangulations of evenly spread sites have about
/// 12 and 18 on average; only about hubs are there many more, and of those the first must do.
const MOST_AWAY: [usize; 2] = [32, 48];

/// Lists of sites, one list a site.
#[derive(Default)]
pub(super) struct Lists {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Lists {
    /// The list of a site.
    pub(super) fn of(&self, site: usize) -> &[u32] {
        &self.items[self.starts[site] as usize..self.starts[site + 1] as usize]
    }

    /// Where the list of a site lies among the items.
    pub(super) fn range(&self, site: usize) -> std::ops::Range<usize> {
        self.starts[site] as usize..self.starts[site + 1] as usize
    }

    fn gathered(lists: impl Iterator<Item = (Vec<u32>, Vec<u32>)>) -> Self {
        let mut all = Self { starts: vec![0], items: Vec::new() };
        for (lengths, items) in lists {
            let mut end = all.items.len() as u32;
            for length in lengths {
                end += length;
                all.starts.push(end);
            }
            all.items.extend(items);
        }
        all
    }
}

/// The links, all sites named by their places in the order of patches.
pub(super) struct Links {
    /// The neighbours of every site.
    pub(super) near: Lists,
    /// What layers of either site lie between neighbours, one for each item of `near`.
    pub(super) offsets: Vec<Offsets>,
    /// The sites exactly two links away.
    pub(super) second: Lists,
    /// The sites exactly three links away.
    pub(super) third: Lists,
}

impl Links {
    /// The links of a graph; `seen` says how many layers are seen of every site.
    pub(super) fn new(graph: &Graph, patches: &Patches, seen: &[u8]) -> Self {
        let mut places = vec![0u32; graph.len()];
        for (place, &site) in (0u32..).zip(&patches.order) {
            places[site as usize] = place;
        }
        let near = Lists::gathered(patches.order.iter().map(|&site| {
            let mut list: Vec<u32> = graph.neighbours(site as usize).iter().map(|&j| places[j as usize]).collect();
            list.sort_unstable();
            (vec![list.len() as u32], list)
        }));
        let layers = |place: usize| seen[patches.order[place] as usize];
        let offsets = (0..graph.len())
            .flat_map(|site| near.of(site).iter().map(move |&other| (site, other)))
            .map(|(site, other)| Offsets::between(layers(site), layers(other as usize)))
            .collect();
        // Patch by patch, in parallel; the lists are put together in order.
        let away: Vec<[(Vec<u32>, Vec<u32>); 2]> = patches
            .starts
            .par_windows(2)
            .map(|bounds| {
                let mut lists: [(Vec<u32>, Vec<u32>); 2] = Default::default();
                let mut walk = Walk::default();
                for site in bounds[0]..bounds[1] {
                    walk.from(&near, site);
                    for (list, found) in lists.iter_mut().zip([&walk.second, &walk.third]) {
                        list.0.push(found.len() as u32);
                        list.1.extend_from_slice(found);
                    }
                }
                lists
            })
            .collect();
        let (second, third): (Vec<_>, Vec<_>) = away.into_iter().map(|[second, third]| (second, third)).unzip();
        Self { near, offsets, second: Lists::gathered(second.into_iter()), third: Lists::gathered(third.into_iter()) }
    }

    /// Which patches hold sites within three links of each patch's own, in order.
    pub(super) fn around(&self, patches: &Patches) -> Vec<Vec<u32>> {
        let mut patch_of = vec![0u32; patches.order.len()];
        for (patch, bounds) in (0u32..).zip(patches.starts.windows(2)) {
            patch_of[bounds[0] as usize..bounds[1] as usize].fill(patch);
        }
        let mut around: Vec<Vec<u32>> = patches
            .starts
            .par_windows(2)
            .map(|bounds| {
                let mut found: Vec<u32> = (bounds[0] as usize..bounds[1] as usize)
                    .flat_map(|site| [&self.near, &self.second, &self.third].into_iter().flat_map(move |l| l.of(site)))
                    .map(|&other| patch_of[other as usize])
                    .collect();
                found.sort_unstable();
                found.dedup();
                found
            })
            .collect();
        // Where a list was cut short only one of two may know of the other.
        for patch in 0..around.len() {
            for other in around[patch].clone() {
                let theirs = &mut around[other as usize];
                if let Err(place) = theirs.binary_search(&(patch as u32)) {
                    theirs.insert(place, patch as u32);
                }
            }
        }
        around
    }
}

/// A walk outwards from a site.
#[derive(Default)]
struct Walk {
    first: Vec<u32>,
    second: Vec<u32>,
    third: Vec<u32>,
}

impl Walk {
    /// Finds the sites exactly two and three links away, as many of them as are kept.
    fn from(&mut self, near: &Lists, site: u32) {
        self.second.clear();
        self.third.clear();
        self.first.clear();
        self.first.extend_from_slice(near.of(site as usize));
        'second: for i in 0..self.first.len() {
            for &other in near.of(self.first[i] as usize) {
                if other != site && self.first.binary_search(&other).is_err() && !self.second.contains(&other) {
                    if self.second.len() >= MOST_AWAY[0] {
                        break 'second;
                    }
                    self.second.push(other);
                }
            }
        }
        'third: for i in 0..self.second.len() {
            for &other in near.of(self.second[i] as usize) {
                if self.first.binary_search(&other).is_err()
                    && !self.second.contains(&other)
                    && !self.third.contains(&other)
                {
                    if self.third.len() >= MOST_AWAY[1] {
                        break 'third;
                    }
                    self.third.push(other);
                }
            }
        }
        self.second.sort_unstable();
        self.third.sort_unstable();
    }
}
