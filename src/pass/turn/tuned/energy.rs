//! What a pattern costs: the energy that tuning brings down.
//!
//! It is a sum over patches, and every part of it is measured per tile, so that a pattern of any size is judged as the
//! small ones are, and so that a move can be judged where it is made:
//!
//! - contrast: over the links, the distance of the two tiles as a share of the greatest that their layers can have counts
//!   against the cost, and what it falls short of the least contrast counts several times for it;
//! - diversity: chi squared of the counts in twelve equal bins, averaged over all places where bins can start. It is kept
//!   as a sum over pairs of tiles of a triangle as wide as a bin, which is the same thing;
//! - grain: the squares of R2 and R3, the mean cosines of twice the angles between tiles two and three links apart.

use std::f64::consts::PI;

use crate::geom::Angle;
use crate::scene::Tuned;

use super::super::seen::Offsets;

/// Bins of a histogram, so fine that where they start does not matter.
pub(super) const FINE: usize = 72;

/// Fine bins in each of the twelve that diversity is measured in.
const WIDTH: usize = FINE / 12;

/// What a link costs for each unit of contrast that it lacks, against what a unit gains, at the start and at the end:
/// while it is hot, tiles pass through each other's neighbourhoods, and when it is cold none is left in them.
const FUSION: [f64; 2] = [2.0, 5.0];

/// By how much more a unit costs the more of it is lacking.
const DEPTH: f64 = 2.0;

/// What chi squared counts for each tile at weight 1.
const DIVERSITY: f64 = 0.12;

/// What the squares of R2 and R3 count for each tile at weight 1.
const GRAIN: f64 = 2.0;

/// Tables of what everything costs by whole steps.
pub(super) struct Costs {
    /// Steps in half a turn.
    pub(super) candidates: u32,
    /// For each set of offsets that occurs, the contrast of a link, 0 to 1, by the step of one end, less that of the other, plus
    /// `candidates`; below twice `candidates`.
    contrasts: Vec<Vec<f64>>,
    contrast: f64,
    least: f64,
    /// The unit vector of twice the angle of every step.
    pub(super) units: Vec<[f32; 2]>,
    /// The fine bin of every step.
    pub(super) bins: Vec<u8>,
    /// What chi squared counts for each tile.
    pub(super) diversity: f64,
    /// What the squares of R2 and R3 count for each tile.
    pub(super) grain: f64,
}

impl Costs {
    /// The tables of a rule for the sets of offsets that occur.
    pub(super) fn new(rule: &Tuned, occurring: &[Offsets]) -> Self {
        let candidates = rule.candidates;
        let angle = |step: u32| Angle::radians(PI * f64::from(step) / f64::from(candidates));
        let mut contrasts = vec![Vec::new(); Offsets::COUNT];
        for &offsets in occurring {
            let table = &mut contrasts[offsets.number()];
            if table.is_empty() {
                let greatest = offsets.greatest().to_radians();
                table.extend((0..2 * candidates).map(|step| offsets.distance(angle(step)).to_radians() / greatest));
            }
        }
        let unit = |step: u32| {
            let unit = (angle(step) * 2.0).unit();
            [unit.x as f32, unit.y as f32]
        };
        let bin = |step: u32| (u64::from(step) * FINE as u64 / u64::from(candidates)) as u8;
        Self {
            candidates,
            contrasts,
            contrast: rule.contrast,
            least: rule.least,
            units: (0..candidates).map(unit).collect(),
            bins: (0..candidates).map(bin).collect(),
            diversity: rule.diversity * DIVERSITY,
            grain: rule.grain * GRAIN,
        }
    }

    /// How the unit vector changes from one step to another.
    pub(super) fn turn(&self, from: usize, to: usize) -> [f32; 2] {
        let ([u, v], [x, y]) = (self.units[from], self.units[to]);
        [x - u, y - v]
    }

    /// What links cost after such a part of all rounds.
    pub(super) fn links(&self, part: f64) -> LinkCosts {
        let [from, to] = FUSION;
        let fusion = from * libm::pow(to / from, part);
        let cost = |&contrast: &f64| {
            let lacking = (self.least - contrast).max(0.0);
            (self.contrast * (fusion * lacking * (1.0 + DEPTH * lacking) - contrast)) as f32
        };
        LinkCosts(self.contrasts.iter().map(|table| table.iter().map(cost).collect()).collect())
    }
}

/// For each set of offsets that occurs, what a link costs by the step of one end, less that of the other, plus the number
/// of candidates.
pub(super) struct LinkCosts(Vec<Vec<f32>>);

impl LinkCosts {
    /// What links between layers with such offsets cost.
    pub(super) fn of(&self, offsets: Offsets) -> &[f32] {
        &self.0[offsets.number()]
    }
}

/// A triangle as wide as a bin of twelve and 1 high about fine bin [`FINE`], and its images a half-turn away.
static TRIANGLE: [f32; 2 * FINE] = {
    let mut heights = [0.0; 2 * FINE];
    let mut place = 0;
    while place < WIDTH {
        let height = (WIDTH - place) as f32 / WIDTH as f32;
        heights[place] = height;
        heights[FINE - place] = height;
        heights[FINE + place] = height;
        heights[2 * FINE - 1 - place] = if place + 1 < WIDTH { (WIDTH - place - 1) as f32 / WIDTH as f32 } else { 0.0 };
        place += 1;
    }
    heights
};

/// The height of the triangle about a bin at each of the bins.
fn triangle(bin: u8) -> &'static [f32] {
    let start = FINE - usize::from(bin);
    &TRIANGLE[start..start + FINE]
}

/// How many of a patch's tiles lie near every direction: for each fine bin, the sum of a triangle as wide as a bin of
/// twelve over the tiles.
pub(super) struct Crowd {
    near: [f32; FINE],
}

impl Crowd {
    /// Of no tiles.
    pub(super) const NONE: Self = Self { near: [0.0; FINE] };

    /// Adds a tile.
    pub(super) fn add(&mut self, bin: u8) {
        for (near, height) in self.near.iter_mut().zip(triangle(bin)) {
            *near += height;
        }
    }

    /// How many tiles lie near a bin, the nearer the more they count.
    pub(super) fn near(&self, bin: u8) -> f32 {
        self.near[usize::from(bin)]
    }

    /// Takes a tile from one bin to another.
    pub(super) fn turn(&mut self, from: u8, to: u8) {
        for ((near, less), more) in self.near.iter_mut().zip(triangle(from)).zip(triangle(to)) {
            *near += more - less;
        }
    }

    /// By how much the sum over all ordered pairs of tiles grows when a tile goes from one bin to another.
    pub(super) fn grows(&self, from: u8, to: u8) -> f32 {
        2.0 * (self.near[usize::from(to)] - self.near[usize::from(from)] + 1.0 - triangle(from)[usize::from(to)])
    }
}
