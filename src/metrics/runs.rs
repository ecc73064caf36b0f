//! Which way strokes run where they come to the border of their tile.

use std::f64::consts::PI;

use crate::geom::{Angle, Point, Vec2, ring_bounds};
use crate::pass::draw::{Stages, tangents};
use crate::region::Region;
use crate::scene::{FillKind, Paint, Swing};

/// A neighbour counts as lying beside a strand where it is ahead or behind by less than this sine of an angle.
const BESIDE: f64 = 1e-9;

/// How the strokes of a tile run. The unevenness of a hand is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Run {
    /// Along the tile's angle, everywhere.
    Straight,
    /// As a sine about lines along the tile's angle, which rises through the site.
    Wave(Swing),
    /// On circles about a place.
    Round(Point),
    /// As a strand, which leaves the tile in these directions backwards and forwards along its angle.
    Strand([Angle; 2]),
}

impl Run {
    /// Of the first layer of some of a paint's tiles.
    pub(super) fn of(paint: &Paint, stages: &Stages<'_>, tiles: &[usize]) -> Vec<Self> {
        let Some(fill) = paint.tone.fill.first() else { return vec![Self::Straight; tiles.len()] };
        match &fill.kind {
            FillKind::Lines(_)
            | FillKind::Dashes { .. }
            | FillKind::Dots { .. }
            | FillKind::Crosses { .. }
            | FillKind::Scribble { .. }
            | FillKind::Motif { .. }
            | FillKind::Solid => vec![Self::Straight; tiles.len()],
            FillKind::Waves { swing, .. } => vec![Self::Wave(*swing); tiles.len()],
            FillKind::Arcs(_) => tiles.iter().map(|&tile| Self::Round(foot(stages, tile))).collect(),
            FillKind::Nawaami { .. } => {
                let tangents = tangents(paint, stages);
                tiles.iter().map(|&tile| Self::Strand(tangents[tile])).collect()
            }
        }
    }

    /// The directions of strokes at the border of a tile towards a neighbour: halfway, where their cells meet. Two where a
    /// strand passes a neighbour that lies beside it, and both of its ends are as near.
    pub(super) fn towards(self, site: Point, angle: Angle, way: Vec2) -> [Angle; 2] {
        let along = angle.unit();
        match self {
            Self::Straight => [angle; 2],
            Self::Wave(swing) => {
                let turns = along.dot(way) / 2.0 / swing.wavelength.to_mm() * (2.0 * PI);
                let steepest = 2.0 * PI * (swing.amplitude / swing.wavelength);
                let slope = steepest * Angle::radians(turns).sin_cos().1;
                [(angle + Angle::of(Vec2::new(1.0, slope))).direction(); 2]
            }
            Self::Round(centre) => {
                let radius = site + way * 0.5 - centre;
                [Angle::of(if radius == Vec2::default() { along } else { radius.turned() }).direction(); 2]
            }
            Self::Strand([back, forth]) => {
                let (ahead, least) = (along.dot(way), BESIDE * way.length());
                if ahead > least {
                    [forth; 2]
                } else if ahead < -least {
                    [back; 2]
                } else {
                    [back, forth]
                }
            }
        }
    }
}

/// The place about which a tile's arcs run: where its outline is left in the direction of its angle; the site itself where
/// the tile has no outline.
fn foot(stages: &Stages<'_>, tile: usize) -> Point {
    let (site, along) = (stages.sites.points[tile], stages.angles.0[tile].unit());
    let outline = stages.tiles.outline(tile);
    let bounds = ring_bounds(outline);
    if outline.is_empty() {
        return site;
    }
    let reach = bounds.width() + bounds.height();
    let mut inside = Vec::new();
    Region::from_rings(vec![outline.to_vec()], crate::region::FillRule::NonZero).clip_line(
        site + along * -reach,
        site + along * reach,
        &mut inside,
    );
    let share = inside.last().map_or(0.5, |range| range.1);
    site + along * (reach * (share * 2.0 - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Length;
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::{cut, link, place, turn};
    use crate::scene::{AngleRule, GridSize, Limits, Placement};
    use crate::stop::Stop;

    fn near(found: [Angle; 2], degrees: f64) {
        let off = found.map(|angle| angle.rp1_distance(Angle::degrees(degrees)).to_radians());
        assert!(off.iter().all(|off| off.abs() < 1e-9), "{found:?} instead of {degrees} degrees");
    }

    #[test]
    fn waves_rise_and_fall() {
        let swing = Swing { wavelength: Length::mm(4.0), amplitude: Length::mm(2.0 / PI) };
        let towards = |x, y| Run::Wave(swing).towards(Point::new(5.0, 5.0), Angle::ZERO, Vec2::new(x, y));
        // Through the site at 45 degrees, level at a quarter of the wave, down at half of it.
        near(towards(0.0, 3.0), 45.0);
        near(towards(2.0, 0.0), 0.0);
        near(towards(-4.0, 1.0), -45.0);
    }

    #[test]
    fn arcs_run_round_their_foot() {
        let run = Run::Round(Point::new(1.0, 0.0));
        near(run.towards(Point::default(), Angle::ZERO, Vec2::new(-2.0, 0.0)), 90.0);
        near(run.towards(Point::default(), Angle::ZERO, Vec2::new(0.0, 2.0)), 45.0);
        near(run.towards(Point::default(), Angle::ZERO, Vec2::new(2.0, 0.0)), 0.0);
    }

    #[test]
    fn the_foot_is_where_the_angle_leaves_the_tile() {
        let canvas = canvas(4.0, 2.0);
        let grid = Placement::Grid(GridSize::Cells { columns: 2, rows: 1 });
        let mut paint = paint(&canvas, grid, AngleRule::Fixed(Angle::degrees(90.0)));
        let hatch = paint.tone.fill[0].kind.hatch().copied();
        paint.tone.fill[0].kind = hatch.map_or(FillKind::Solid, FillKind::Arcs);
        let sites = place::place(&paint, &canvas, &Limits::default()).unwrap();
        let graph = link::link(&sites, paint.tone.link);
        let angles = turn::turn(&paint, &sites, &graph, &Stop::default());
        let tiles = cut::cut(&paint, &canvas, &sites, &graph, &angles, &mut Vec::new());
        let stages = Stages { sites: &sites, graph: &graph, angles: &angles, tiles: &tiles };
        let found = Run::of(&paint, &stages, &[1]);
        let Run::Round(foot) = found[0] else { panic!("{found:?}") };
        assert!(foot.distance(Point::new(3.0, 2.0)) < 1e-6, "{foot:?}");
    }
}
