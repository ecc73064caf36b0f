//! Darkness: from the share of the paper that is to be inked to layers and their spacing.
//!
//! Full layers stand at the fill's own pitch, and one further layer stands wider, so that the texture changes evenly
//! with the tone. What a tile asks for is the mean of the field over it. Where a tile holds few lines its ink is reckoned
//! from them, and what it has too much or too little is passed on to neighbours that come later (Ostromoukhov and Hersch
//! diffuse over such graphs; the weights here are equal). That goes over all tiles, drawn or not, so that moving a
//! region's outline changes none.

mod cover;
mod ink;
mod tile;

use crate::diag::{Code, Diagnostic};
use crate::field::{Field, Node};
use crate::geom::Point;
use crate::scene::{Canvas, Darkness, Paint, Range};
use crate::stage::{Angles, Graph, Layers, Sites, Standing};

use super::layers::MOST;
use cover::Cover;
use tile::Reckoner;

/// The greatest number of layers.
const LAYERS: usize = MOST as usize;

/// The most that is passed on from one tile: what is beyond a tone's reach shall not be made up for elsewhere.
const MOST_PASSED: f64 = 0.25;

/// Shares of ink that differ by less are alike.
const NEAR: f64 = 1e-9;

/// How far from the site towards a tile's corners the field is looked at, as a share of the way.
const INWARDS: f64 = 0.6;

/// What of the region may be a little too dark before it is worth a warning.
const SLIGHT: f64 = 0.005;

/// What a paint asks for.
pub(super) struct Asking<'a> {
    pub(super) paint: &'a Paint,
    pub(super) canvas: &'a Canvas,
    pub(super) darkness: &'a Darkness,
    pub(super) sites: &'a Sites,
    pub(super) graph: &'a Graph,
    pub(super) angles: &'a Angles,
    /// The outline of every tile.
    pub(super) rings: &'a [&'a [Point]],
    /// The mean of the field over every tile, clamped to [0, 1].
    pub(super) wanted: &'a [f64],
    pub(super) standing: &'a [Standing],
    /// Whether sites lie in the region.
    pub(super) inside: &'a [bool],
}

/// The mean of a field over a tile.
pub(super) fn mean(field: &Field, site: Point, ring: &[Point]) -> f64 {
    let middle = field.at(site);
    if matches!(field.node(), Node::Constant(_)) || ring.is_empty() {
        return middle;
    }
    let sum: f64 = ring.iter().map(|&corner| field.at(site.lerp(corner, INWARDS))).sum();
    (middle + sum) / (ring.len() + 1) as f64
}

/// Layers for every tile. A warning comes with them where the region asks for more than the tone prints.
pub(super) fn layers(asking: &Asking<'_>) -> (Vec<Layers>, Option<Diagnostic>) {
    let cover = Cover::new(asking.paint, asking.sites, asking.graph, asking.rings, asking.canvas.gain);
    let mut reckoner = Reckoner::new(asking, &cover);
    let greatest = cover.on_paper(reckoner.greatest());
    let fitted = fit(asking, greatest);
    let solid = asking.darkness.solid.unwrap_or(f64::INFINITY);
    let wanted: Vec<f64> = fitted.iter().map(|&wanted| cover.in_tiles(wanted.min(greatest))).collect();
    let mut passed = vec![0.0; wanted.len()];
    let layers = (0..wanted.len())
        .map(|i| {
            if fitted[i] >= solid {
                return Layers::SOLID;
            }
            let asked = wanted[i] + passed[i];
            let (layers, drawn) = reckoner.choose(i, asked);
            let later = later(asking.graph, i);
            let error = (asked - drawn).clamp(-MOST_PASSED, MOST_PASSED) * reckoner.area(i) / later.len().max(1) as f64;
            for &j in later {
                let area = reckoner.area(j as usize);
                if area > 0.0 {
                    passed[j as usize] += error / area;
                }
            }
            layers
        })
        .collect();
    (layers, too_dark(asking, &fitted, greatest))
}

/// The neighbours of a site that come after it.
fn later(graph: &Graph, site: usize) -> &[u32] {
    // Neighbours ascend.
    let neighbours = graph.neighbours(site);
    &neighbours[neighbours.partition_point(|&j| j as usize <= site)..]
}

/// What is asked for, brought into the tone's range if it is to be.
fn fit(asking: &Asking<'_>, greatest: f64) -> Vec<f64> {
    match asking.darkness.range {
        Range::Clip => asking.wanted.to_vec(),
        Range::Fit => {
            let inside = || asking.wanted.iter().zip(asking.inside).filter(|(_, inside)| **inside).map(|(&v, _)| v);
            let (low, high) = inside().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            if high - low <= NEAR {
                return asking.wanted.to_vec();
            }
            // Tiles that are inked all over reach the whole way.
            let top = if asking.darkness.solid.is_some() { 1.0 } else { greatest };
            asking.wanted.iter().map(|v| ((v - low) / (high - low)).clamp(0.0, 1.0) * top).collect()
        }
    }
}

/// The warning that part of the region asks for more than the tone prints.
fn too_dark(asking: &Asking<'_>, fitted: &[f64], greatest: f64) -> Option<Diagnostic> {
    let solid = asking.darkness.solid.unwrap_or(f64::INFINITY);
    let (mut count, mut beyond) = (0usize, 0usize);
    for (&wanted, &standing) in fitted.iter().zip(asking.standing) {
        if standing != Standing::Absent {
            count += 1;
            beyond += usize::from(wanted > greatest + SLIGHT && wanted < solid);
        }
    }
    if beyond == 0 {
        return None;
    }
    let percent = |share: f64| match share * 100.0 {
        percent if percent < 1.0 => "less than 1 %".to_owned(),
        percent => format!("{} %", percent.round()),
    };
    let message = format!(
        "{} of `{}` asks for more than the tone prints, which is {}",
        percent(beyond as f64 / count as f64),
        asking.paint.name,
        percent(greatest),
    );
    let hint = match asking.darkness.solid {
        None => {
            "a tighter pitch, a wider pen or more fills print darker; `solid: 0.9` inks the darkest tiles all over, \
                 `range: fit` presses the picture into the tone's range"
        }
        Some(_) => "a lower `solid` inks more tiles all over; a tighter pitch, a wider pen or more fills print darker",
    };
    Some(
        Diagnostic::warning(Code::TooDark, asking.paint.tone.asked_span, message)
            .hint(hint)
            .note(asking.paint.span, "painted here"),
    )
}
