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
use crate::geom::{Length, Point};
use crate::scene::{Asked, Canvas, Darkness, Paint, Range};
use crate::stage::{Angles, Graph, Layers, Sites, Standing, Tiles};

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

/// The tiles of a paint with what they came from. Their `k` is what is asked for where layers are still to be found.
#[derive(Clone, Copy)]
pub(super) struct Bed<'a> {
    pub(super) paint: &'a Paint,
    pub(super) canvas: &'a Canvas,
    pub(super) sites: &'a Sites,
    pub(super) graph: &'a Graph,
    pub(super) angles: &'a Angles,
    pub(super) tiles: &'a Tiles,
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

/// Layers for every tile, of which `k` says what they ask for. A warning comes with them where the region asks for more
/// than the tone prints.
pub(super) fn layers(bed: &Bed<'_>, darkness: &Darkness) -> (Vec<Layers>, Option<Diagnostic>) {
    let cover = Cover::new(bed);
    let mut reckoner = Reckoner::new(bed, &cover);
    let greatest = cover.on_paper(reckoner.greatest());
    let solid = darkness.solid.unwrap_or(f64::INFINITY);
    let fitted = fit(bed.tiles, darkness, greatest);
    let wanted: Vec<f64> = fitted.iter().map(|&wanted| cover.in_tiles(wanted.min(greatest))).collect();
    let mut passed = vec![0.0; wanted.len()];
    let layers = (0..wanted.len())
        .map(|i| {
            if fitted[i] >= solid {
                return Layers::SOLID;
            }
            let asked = wanted[i] + passed[i];
            let (layers, drawn) = reckoner.choose(i, asked);
            let later = later(bed.graph, i);
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
    (layers, too_dark(bed, &fitted, greatest, solid))
}

/// The share of the paper that tiles with layers cover: the mean over those whose sites lie in the region.
pub(super) fn reckon(bed: &Bed<'_>) -> f64 {
    let cover = Cover::new(bed);
    let mut reckoner = Reckoner::new(bed, &cover);
    let (mut ink, mut area) = (0.0, 0.0);
    for tile in (0..bed.tiles.len()).filter(|&tile| bed.tiles.inside[tile]) {
        ink += reckoner.ink(tile, bed.tiles.layers[tile]) * reckoner.area(tile);
        area += reckoner.area(tile);
    }
    if area > 0.0 { cover.on_paper(ink / area) } else { 0.0 }
}

/// The share of a large area that tiles with layers cover, as wide as pens are. `radius` is that of a disc as large as a tile.
pub(super) fn shares(paint: &Paint, layers: &[Layers], radius: Length) -> Vec<f64> {
    let fills = &paint.tone.fill;
    let levels = ink::levels(fills, Length::ZERO, &[1.0; LAYERS], radius);
    let kind = |number: u8| fills.get(usize::from(number.saturating_sub(1))).or(fills.last()).map(|fill| &fill.kind);
    let share = |&layers: &Layers| {
        ink::of_layers(&levels, layers, |number, density| match paint.tone.asked {
            // A share of the lines.
            Asked::K(_) => density,
            Asked::Darkness(_) => kind(number).map_or(0.0, |kind| ink::inked(kind, Length::ZERO, density)),
        })
    };
    layers.iter().map(share).collect()
}

/// The neighbours of a site that come after it.
fn later(graph: &Graph, site: usize) -> &[u32] {
    // Neighbours ascend.
    let neighbours = graph.neighbours(site);
    &neighbours[neighbours.partition_point(|&j| j as usize <= site)..]
}

/// What is asked for, brought into the tone's range if it is to be.
fn fit(tiles: &Tiles, darkness: &Darkness, greatest: f64) -> Vec<f64> {
    match darkness.range {
        Range::Clip => tiles.k.clone(),
        Range::Fit => {
            let inside = tiles.k.iter().zip(&tiles.inside).filter(|(_, inside)| **inside).map(|(&v, _)| v);
            let (low, high) = inside.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            // One tone alone has no range that could be stretched, and neither has what grows beyond all numbers.
            if !(NEAR..f64::INFINITY).contains(&(high - low)) {
                return tiles.k.iter().map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) }).collect();
            }
            // Tiles that are inked all over reach the whole way.
            let top = if darkness.solid.is_some() { 1.0 } else { greatest };
            tiles.k.iter().map(|v| ((v - low) / (high - low)).clamp(0.0, 1.0) * top).collect()
        }
    }
}

/// The warning that part of the region asks for more than the tone prints, but less than is inked all over.
fn too_dark(bed: &Bed<'_>, fitted: &[f64], greatest: f64, solid: f64) -> Option<Diagnostic> {
    let (mut count, mut beyond) = (0usize, 0usize);
    for (&wanted, &standing) in fitted.iter().zip(&bed.tiles.standing) {
        if standing != Standing::Absent {
            count += 1;
            beyond += usize::from(wanted > greatest + SLIGHT && wanted < solid);
        }
    }
    if beyond == 0 {
        return None;
    }
    let share = match (beyond as f64 / count as f64 * 100.0).round() {
        percent if percent < 1.0 => "less than 1 %".to_owned(),
        percent => format!("{percent} %"),
    };
    let (name, span) = (&bed.paint.name, bed.paint.tone.asked_span);
    let message = format!("{share} of `{name}` asks for more than the tone prints");
    let hint = if solid.is_finite() {
        "a lower `solid` inks more tiles all over; a tighter pitch, a wider pen or more fills print darker"
    } else {
        "a tighter pitch, a wider pen or more fills print darker; `solid: 0.9` inks the darkest tiles all over; \
         `range: fit` presses the picture into the tone's range"
    };
    Some(
        Diagnostic::warning(Code::TooDark, span, message)
            .label(format!("prints up to {}", (greatest * 100.0).round() / 100.0))
            .hint(hint)
            .note(bed.paint.span, "painted here"),
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::field::Function;
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::{cut, link, place, turn};
    use crate::region::Region;
    use crate::scene::{AngleRule, Bfs, Limits, Placement, Shape};
    use crate::stop::Stop;

    fn cells(field: Field, range: Range, solid: Option<f64>) -> (Canvas, Paint) {
        let canvas = canvas(4.0, 4.0);
        let place = Placement::Poisson { radius: Length::mm(0.3), tries: 30, density: None };
        let mut paint = paint(&canvas, place, AngleRule::Bfs(Bfs::default()));
        paint.tone.shape = Shape::Voronoi { inset: Length::ZERO, round: Length::ZERO };
        paint.tone.bleed = None;
        paint.tone.asked = Asked::Darkness(Darkness { field, range, solid });
        (canvas, paint)
    }

    fn tiles(paint: &Paint, canvas: &Canvas) -> (Tiles, f64, Vec<Diagnostic>) {
        let sites = place::place(paint, canvas, &Limits::default()).unwrap();
        let graph = link::link(&sites, paint.tone.link);
        let angles = turn::turn(paint, &sites, &graph, &Stop::default());
        let mut warnings = Vec::new();
        let tiles = cut::cut(paint, canvas, &sites, &graph, &angles, &mut warnings);
        let ink = cut::reckon(paint, canvas, &sites, &graph, &angles, &tiles);
        (tiles, ink, warnings)
    }

    fn across(start: f64, end: f64) -> Field {
        Field::new(Node::Linear { from: Point::default(), to: Point::new(4.0, 0.0), start, end })
    }

    #[test]
    fn tiles_together_have_the_ink_that_is_asked_for() {
        // Lines of 0.005 mm at 0.08 mm cover a sixteenth of the paper.
        for asked in [0.01, 0.05, 0.13, 0.2] {
            let (canvas, paint) = cells(Field::constant(asked), Range::Clip, None);
            let (_, ink, warnings) = tiles(&paint, &canvas);
            assert!((ink - asked).abs() < 0.004, "{asked}: {ink}");
            assert!(warnings.is_empty());
        }
    }

    #[test]
    fn a_moved_outline_changes_no_tile() {
        let (canvas, mut paint) = cells(across(0.0, 0.2), Range::Clip, None);
        let (whole, ..) = tiles(&paint, &canvas);
        paint.region = Region::circle(Point::new(2.0, 2.0), Length::mm(0.9));
        let (part, ..) = tiles(&paint, &canvas);
        assert_eq!(whole.layers, part.layers);
    }

    #[test]
    fn what_is_too_dark_is_told_and_inked_all_over_or_fitted() {
        let (canvas, paint) = cells(across(0.0, 1.0), Range::Clip, None);
        let (clipped, _, warnings) = tiles(&paint, &canvas);
        assert_eq!(warnings.len(), 1);
        assert_eq!(warnings[0].code, Code::TooDark);
        // The tone prints up to 0.23; tiles count as wholes.
        let share: f64 = warnings[0].message.split(' ').next().unwrap().parse().unwrap();
        assert!((share - 77.0).abs() < 4.0, "{warnings:?}");
        assert!(clipped.layers.iter().all(|layers| !layers.is_solid));

        let (canvas, paint) = cells(across(0.0, 1.0), Range::Clip, Some(0.5));
        let (solid, ..) = tiles(&paint, &canvas);
        let black = solid.layers.iter().filter(|layers| layers.is_solid).count() as f64 / solid.len() as f64;
        assert!((black - 0.5).abs() < 0.05, "{black}");

        let (canvas, paint) = cells(across(0.4, 0.9), Range::Fit, None);
        let (fitted, _, warnings) = tiles(&paint, &canvas);
        assert!(warnings.is_empty());
        assert!(fitted.k.iter().any(|&k| k > 3.9) && fitted.k.contains(&0.0));
        assert!(fitted.layers.iter().filter(|layers| layers.full == 4).count() < fitted.len() / 8);
    }

    #[test]
    fn a_field_is_looked_at_all_over_a_tile() {
        let ring = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
        let hill = Field::new(Node::Unary(Function::Abs, across(-1.0, 1.0)));
        // The site lies where the field is 0.5, its corners reach from 1 to 0.
        let found = mean(&hill, Point::new(1.0, 1.0), &ring);
        assert!((found - 0.5).abs() < 1e-9, "{found}");
        assert!(mean(&hill, Point::new(2.0, 1.0), &ring) > 0.0);
    }
}
