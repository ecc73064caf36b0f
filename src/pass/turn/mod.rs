//! Turning: the direction of every tile.
//!
//! In: a paint, its sites and their links. Out: [`Angles`], one direction in [0, pi) for every site. An angle rule is
//! one file here and one line in [`turn`]. Rules that choose among whole steps of half a turn say how many there are.

mod along;
mod bfs;
mod checkerboard;
mod coloured;
mod fixed;
mod random;
mod seen;
mod tuned;

use std::f64::consts::PI;

use crate::diag::{Code, Diagnostic};
use crate::geom::Angle;
use crate::pass::cut;
use crate::random::Key;
use crate::scene::{AngleRule, Paint, See, Start};
use crate::stage::{Angles, Graph, Sites, Tiles};
use crate::stop::Stop;

/// Turns the tiles of a paint by the rule of its tone. Where it is stopped, some are not turned as they should be.
#[must_use]
pub fn turn(paint: &Paint, sites: &Sites, graph: &Graph, stop: &Stop) -> Angles {
    let key = Key { seed: paint.seed, name: &paint.name, purpose: "angle" };
    Angles(match &paint.tone.angle {
        AngleRule::Bfs(rule) => {
            let steps = bfs::turn(graph, rule.candidates, &seen(rule.see, paint, sites, graph), &key);
            directions(steps, rule.candidates, first(rule.start, rule.candidates, &key))
        }
        AngleRule::Tuned(rule) => {
            let seen = seen(rule.see, paint, sites, graph);
            let steps = bfs::turn(graph, rule.candidates, &seen, &key);
            let tune_key = Key { purpose: "tune", ..key };
            let steps = tuned::tune(graph, &sites.points, &seen, rule, &steps, &tune_key, stop);
            directions(steps, rule.candidates, first(rule.start, rule.candidates, &key))
        }
        AngleRule::Coloured { colours } => directions(coloured::colours(graph, *colours, &key), *colours, 0),
        AngleRule::Random => random::turn(sites, &key),
        AngleRule::Checkerboard => checkerboard::turn(sites),
        AngleRule::Fixed(angle) => fixed::turn(sites, *angle),
        AngleRule::Along(field) => along::turn(sites, field),
    })
}

/// The warning that a colouring left neighbours alike, of which both lie in the region.
#[must_use]
pub fn alike(paint: &Paint, graph: &Graph, angles: &Angles, tiles: &Tiles) -> Option<Diagnostic> {
    let AngleRule::Coloured { colours } = paint.tone.angle else { return None };
    let inside = || graph.edges().filter(|edge| edge.iter().all(|&end| tiles.inside[end as usize]));
    let alike = inside().filter(|&[a, b]| angles.0[a as usize] == angles.0[b as usize]).count();
    if alike == 0 {
        return None;
    }
    let links = inside().count();
    let message =
        format!("{colours} directions leave {alike} of {links} pairs of neighbours in `{}` alike", paint.name);
    let hint = match colours {
        0..4 => {
            "four directions are enough, `coloured(4)`, but on a page that repeats, where up to seven may be needed"
        }
        _ => "a page that repeats may need up to seven directions: `coloured(7)`",
    };
    Some(Diagnostic::warning(Code::Alike, paint.tone.angle_span, message).hint(hint))
}

/// How many layers are seen of every tile, by what the rule looks at.
fn seen(see: See, paint: &Paint, sites: &Sites, graph: &Graph) -> Vec<u8> {
    match see {
        See::Primary => vec![1; graph.len()],
        See::Layers => cut::foreseen(paint, sites, graph),
    }
}

/// By how many steps all tiles are turned.
fn first(start: Start, candidates: u32, key: &Key<'_>) -> u32 {
    match start {
        Start::First => 0,
        Start::Random => key.stream().below(u64::from(candidates)) as u32,
    }
}

/// The directions of steps below `candidates`, all turned by some.
fn directions(steps: Vec<u32>, candidates: u32, turned: u32) -> Vec<Angle> {
    let unit = PI / f64::from(candidates);
    let step = |step: u32| (u64::from(step) + u64::from(turned)) % u64::from(candidates);
    steps.into_iter().map(|s| Angle::radians(step(s) as f64 * unit).direction()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::field::{Field, Node};
    use crate::geom::{Angle, Length, Point};
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::link::link;
    use crate::pass::place::place;
    use crate::scene::{Amount, Bfs, Canvas, GridSize, Limits, Link, Placement, Tuned};

    /// Places, links and turns.
    fn turned(paint: &Paint, canvas: &Canvas) -> (Sites, Graph, Vec<f64>) {
        let sites = place(paint, canvas, &Limits::default()).unwrap();
        let graph = link(&sites, Link::Delaunay);
        let Angles(angles) = turn(paint, &sites, &graph, &Stop::default());
        assert_eq!(angles.len(), sites.points.len());
        (sites, graph, angles.into_iter().map(Angle::to_radians).collect())
    }

    fn grid() -> Placement {
        Placement::Grid(GridSize::Cells { columns: 5, rows: 4 })
    }

    #[test]
    fn a_checkerboard_goes_on_into_the_bleed() {
        let canvas = canvas(50.0, 40.0);
        let mut paint = paint(&canvas, grid(), AngleRule::Checkerboard);
        paint.tone.bleed = Some(Length::mm(10.0));
        let (sites, _, angles) = turned(&paint, &canvas);
        for (p, angle) in sites.points.iter().zip(angles) {
            let is_even = ((p.x + p.y) / 10.0 - 1.0).rem_euclid(2.0) == 0.0;
            assert_eq!(angle, if is_even { 0.0 } else { Angle::RIGHT.to_radians() });
        }
    }

    #[test]
    fn random_angles_are_the_tile_s_own() {
        let canvas = canvas(50.0, 40.0);
        let count = |count| Placement::Uniform { amount: Amount::Count { count, density: None } };
        let (_, _, few) = turned(&paint(&canvas, count(20), AngleRule::Random), &canvas);
        let (_, _, many) = turned(&paint(&canvas, count(1000), AngleRule::Random), &canvas);
        assert_eq!(few, many[..20]);
        for part in 0..10 {
            let bin = f64::from(part) * Angle::degrees(18.0).to_radians();
            let there = many.iter().filter(|&&a| bin <= a && a < bin + Angle::degrees(18.0).to_radians()).count();
            assert!((60..140).contains(&there), "{there}");
        }
    }

    #[test]
    fn nothing_is_tuned_where_nothing_has_a_weight() {
        let canvas = canvas(50.0, 40.0);
        let disks = || Placement::Poisson { radius: Length::mm(4.0), tries: 30, density: None };
        let rule = Tuned { contrast: 0.0, diversity: 0.0, grain: 0.0, ..Tuned::default() };
        let (_, _, tuned) = turned(&paint(&canvas, disks(), AngleRule::Tuned(rule)), &canvas);
        let (_, _, first) = turned(&paint(&canvas, disks(), AngleRule::Bfs(Bfs::default())), &canvas);
        assert_eq!(tuned, first);
    }

    #[test]
    fn fixed_angles_and_fields_become_directions() {
        let canvas = canvas(50.0, 40.0);
        let (_, _, angles) = turned(&paint(&canvas, grid(), AngleRule::Fixed(Angle::degrees(-45.0))), &canvas);
        assert!(angles.iter().all(|a| (a - Angle::degrees(135.0).to_radians()).abs() < 1e-12));
        let along = AngleRule::Along(Field::new(Node::X(Length::mm(1.0))));
        let (sites, _, angles) = turned(&paint(&canvas, grid(), along), &canvas);
        for (p, angle) in sites.points.iter().zip(angles) {
            assert_eq!(angle, p.x % std::f64::consts::PI);
        }
    }

    #[test]
    fn nothing_is_turned_where_nothing_is() {
        let canvas = canvas(50.0, 40.0);
        let rules = [
            AngleRule::Bfs(Bfs::default()),
            AngleRule::Tuned(Tuned::default()),
            AngleRule::Coloured { colours: 4 },
            AngleRule::Random,
            AngleRule::Checkerboard,
            AngleRule::Fixed(Angle::ZERO),
            AngleRule::Along(Field::constant(1.0)),
        ];
        for rule in rules {
            assert!(turned(&paint(&canvas, Placement::Points(Vec::new()), rule), &canvas).2.is_empty());
        }
        let one = Placement::Points(vec![Point::new(1.0, 1.0)]);
        assert_eq!(
            turned(&paint(&canvas, one, AngleRule::Bfs(Bfs { candidates: 2, ..Bfs::default() })), &canvas).2.len(),
            1
        );
    }

    /// The report's setup over its seeds: what it measured comes out of these passes too, within what the order of
    /// neighbours and another stream of random numbers change.
    #[test]
    fn the_report_s_means_come_out() {
        let canvas = canvas(6.0, 6.0);
        let place = Placement::Poisson { radius: Length::mm(0.6), tries: 30, density: None };
        let mut paint = paint(&canvas, place, AngleRule::Bfs(Bfs::default()));
        let (mut tiles, mut edges, mut contrast, mut entropy, mut correlation) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for seed in 0..100 {
            paint.seed = seed;
            let (sites, graph, angles) = turned(&paint, &canvas);
            let (n, e) = (sites.points.len() as f64, graph.edges().count() as f64);
            let angle = |site: u32| Angle::radians(angles[site as usize]);
            let distance = |[a, b]: [u32; 2]| angle(a).rp1_distance(angle(b)).to_radians();
            let cosine = |[a, b]: [u32; 2]| ((angle(a) - angle(b)) * 2.0).unit().x;
            let mut bins = [0.0; 12];
            for a in &angles {
                bins[(a / std::f64::consts::PI * 12.0) as usize] += 1.0 / n;
            }
            tiles += n / 100.0;
            edges += e / 100.0;
            contrast += graph.edges().map(distance).sum::<f64>() / e * std::f64::consts::FRAC_2_PI / 100.0;
            correlation += graph.edges().map(cosine).sum::<f64>() / e / 100.0;
            let information = bins.iter().filter(|&&p| p > 0.0).map(|&p| -p * libm::log(p)).sum::<f64>();
            entropy += information / libm::log(12.0) / 100.0;
        }
        assert!((tiles - 68.8).abs() < 0.5, "{tiles} tiles");
        assert!((edges - 191.6).abs() < 1.5, "{edges} edges");
        assert!((0.638..0.645).contains(&contrast), "contrast {contrast}");
        assert!((0.945..0.97).contains(&entropy), "entropy {entropy}");
        assert!((-0.365..-0.345).contains(&correlation), "R1 {correlation}");
    }
}
