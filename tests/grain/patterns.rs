//! Patterns that a measure of grain is tried on: placements and angle rules of the language, and others that only look
//! like hatching. `benches/grain.rs` prints their table, `tests/grain/mod.rs` holds the measure to it.

use kakeami::PaintStages;
use kakeami::geom::{Angle, Point};
use kakeami::loader::MemoryLoader;
use kakeami::lower::{LowerConfig, lower};
use kakeami::metrics::Measured;
use kakeami::random::{Key, Stream};
use kakeami::scene::{Limits, Placement};

/// What a pattern is drawn on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Page {
    /// Width and height in millimetres.
    pub(crate) size: [f64; 2],
    /// About how many tiles it holds.
    pub(crate) tiles: u32,
    /// What is painted.
    pub(crate) region: &'static str,
    /// How far tiles go on beyond it, in tiles.
    pub(crate) bleed: f64,
    /// Whether it repeats.
    pub(crate) repeat: bool,
}

impl Page {
    /// The report's page: a square without bleed.
    pub(crate) const fn square(tiles: u32) -> Self {
        Self { size: [60.0, 60.0], tiles, region: "canvas", bleed: 0.0, repeat: false }
    }

    /// The distance of sites in millimetres: the square root of a tile's share of the page.
    fn spacing(&self) -> f64 {
        (self.size[0] * self.size[1] / f64::from(self.tiles)).sqrt()
    }

    /// The radius at which Poisson-disk sampling finds that many sites: 0.627 in a square of it, and half a radius of
    /// the page's outside serves as well.
    fn radius(&self) -> f64 {
        let [width, height] = self.size;
        let sites = |radius: f64| 0.627 * (width / radius + 0.5) * (height / radius + 0.5);
        let (mut low, mut high) = (self.spacing() / 10.0, self.spacing() * 10.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            *(if sites(middle) > f64::from(self.tiles) { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

/// How sites lie.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sites {
    /// A placement of the language; `{r}` is the Poisson-disk radius and `{a}` the distance of sites.
    Place(&'static str),
    /// A lattice by its steps along a row and to the next, each site moved at random by up to so much of the spacing both
    /// ways; turned by the seed or not.
    Lattice { steps: [[f64; 2]; 2], jitter: f64, is_turned: bool },
    /// A sunflower's seeds: golden angles on a spiral of equal areas.
    Sunflower,
    /// The sequence of Halton in bases 2 and 3, moved round by the seed.
    Halton,
    /// Multiples of the plastic number's powers (M. Roberts' R2), moved round by the seed.
    R2,
    /// Clumps of five about centres that lie at random.
    Clumps,
    /// One Poisson-disk patch of so many by so many, over and over.
    Copies(u32),
}

/// How tiles are turned.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Turn {
    /// A rule of the language.
    Rule(&'static str),
    /// A rule of the language, all turned on by half a turn in even steps from left to right.
    Turning(&'static str),
    /// Two directions, most neighbours unlike.
    TwoColours,
    /// Stripes of two tiles' width, each of one direction.
    Stripes,
    /// Rings a tile wide, by turns along and across.
    Rings,
    /// A direction that goes round steadily from left to right, a quarter turn a tile.
    Ramp,
    /// A direction that flows smoothly.
    Flow,
    /// Breadth-first turning on the left half, random on the right.
    Half,
    /// Single moves that raise the mean contrast, from random directions, and nothing against two neighbours that fuse.
    Unguarded,
    /// A lattice's columns and rows by turns along and across, whatever the sites.
    Chequers,
    /// By turns 0, 60 and 120 degrees along a lattice's rows, so that no neighbours on a hexagonal lattice are alike.
    Thirds,
}

/// A pattern: a name, its sites and its angles.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pattern {
    pub(crate) name: &'static str,
    pub(crate) sites: Sites,
    pub(crate) turn: Turn,
}

const DISK: Sites = Sites::Place("poisson(radius: {r}mm)");
const BFS: Turn = Turn::Rule("bfs(candidates: 360)");
const RANDOM: Turn = Turn::Rule("random()");
const TUNED: Turn = Turn::Rule("tuned()");

const fn lattice(steps: [[f64; 2]; 2], jitter: f64) -> Sites {
    Sites::Lattice { steps, jitter, is_turned: false }
}

const fn turned(steps: [[f64; 2]; 2]) -> Sites {
    Sites::Lattice { steps, jitter: 0.0, is_turned: true }
}

const fn pattern(name: &'static str, sites: Sites, turn: Turn) -> Pattern {
    Pattern { name, sites, turn }
}

/// Lattices of unit cells.
const SQUARE: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];
const HEX: [[f64; 2]; 2] = [[1.074_569_931_823_542, 0.0], [0.537_284_965_911_771, 0.930_604_859_102_1]];
/// Bricks three times as long as high, each row moved by half a brick.
const BRICK: [[f64; 2]; 2] = [[1.732_050_807_568_877_2, 0.0], [0.866_025_403_784_438_6, 0.577_350_269_189_625_8]];
const OBLIQUE: [[f64; 2]; 2] = [[1.0, 0.0], [0.3, 1.0]];

/// Poisson-disk sites with breadth-first angles: what comes first.
pub(crate) const PROPOSED: Pattern = pattern("poisson + bfs", DISK, BFS);

/// What must not come after it: sites that lie more evenly, without rows, and angles that part more.
pub(crate) const BETTER: [Pattern; 9] = [
    pattern("relaxed 1 + bfs", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 1)"), BFS),
    pattern("relaxed 3 + bfs", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 3)"), BFS),
    pattern("relaxed 5 + bfs", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 5)"), BFS),
    pattern("relaxed 10 + bfs", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 10)"), BFS),
    pattern("relaxed 30 + bfs", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 30)"), BFS),
    pattern("relaxed 100 + bfs", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 100)"), BFS),
    pattern("poisson + tuned", DISK, TUNED),
    pattern("poisson + tuned, grain 6", DISK, Turn::Rule("tuned(grain: 6)")),
    pattern("relaxed 5 + tuned", Sites::Place("relaxed(poisson(radius: {r}mm), rounds: 5)"), TUNED),
];

/// What it does not tell from it, or not on every page: a dozen directions are many.
pub(crate) const UNTOLD: [Pattern; 3] = [
    pattern("poisson + turning colours", DISK, Turn::Turning("coloured(4)")),
    pattern("poisson + bfs of 12", DISK, Turn::Rule("bfs(candidates: 12)")),
    pattern("poisson + bfs of 24", DISK, Turn::Rule("bfs(candidates: 24)")),
];

/// What must come after it.
pub(crate) const WORSE: [Pattern; 46] = [
    pattern("poisson + random", DISK, RANDOM),
    pattern("uniform + bfs", Sites::Place("uniform(count: poisson(radius: {r}mm))"), BFS),
    pattern("uniform + random", Sites::Place("uniform(count: poisson(radius: {r}mm))"), RANDOM),
    pattern("grid + checkerboard", Sites::Place("grid(spacing: {a}mm)"), Turn::Rule("checkerboard()")),
    pattern("grid + bfs", Sites::Place("grid(spacing: {a}mm)"), BFS),
    pattern("hex + bfs", Sites::Place("hex(spacing: {h}mm)"), BFS),
    pattern("triangles + bfs", Sites::Place("triangles(edge: {t}mm)"), BFS),
    pattern("grid + random", Sites::Place("grid(spacing: {a}mm)"), RANDOM),
    pattern("hex + random", Sites::Place("hex(spacing: {h}mm)"), RANDOM),
    pattern("hex + three directions", lattice(HEX, 0.0), Turn::Thirds),
    pattern("turned square lattice + bfs", turned(SQUARE), BFS),
    pattern("turned hex lattice + bfs", turned(HEX), BFS),
    pattern("oblique lattice + bfs", turned(OBLIQUE), BFS),
    pattern("bricks + bfs", lattice(BRICK, 0.0), BFS),
    pattern("square, jitter 0.01 + bfs", lattice(SQUARE, 0.01), BFS),
    pattern("square, jitter 0.1 + bfs", lattice(SQUARE, 0.1), BFS),
    pattern("square, jitter 0.2 + bfs", lattice(SQUARE, 0.2), BFS),
    pattern("square, jitter 0.3 + bfs", lattice(SQUARE, 0.3), BFS),
    pattern("hex, jitter 0.1 + bfs", lattice(HEX, 0.1), BFS),
    pattern("hex, jitter 0.2 + bfs", lattice(HEX, 0.2), BFS),
    pattern("hex, jitter 0.3 + bfs", lattice(HEX, 0.3), BFS),
    pattern("penrose + bfs", Sites::Place("penrose(edge: {p}mm)"), BFS),
    pattern("pinwheel + bfs", Sites::Place("pinwheel(edge: {a}mm)"), BFS),
    pattern("sunflower + bfs", Sites::Sunflower, BFS),
    pattern("halton + bfs", Sites::Halton, BFS),
    pattern("r2 + bfs", Sites::R2, BFS),
    pattern("clumps + bfs", Sites::Clumps, BFS),
    pattern("copies of a patch + bfs", Sites::Copies(4), BFS),
    pattern("poisson + four colours", DISK, Turn::Rule("coloured(4)")),
    pattern("grid + tuned", Sites::Place("grid(spacing: {a}mm)"), TUNED),
    pattern("hex + tuned", Sites::Place("hex(spacing: {h}mm)"), TUNED),
    pattern("uniform + tuned", Sites::Place("uniform(count: poisson(radius: {r}mm))"), TUNED),
    pattern("poisson + two colours", DISK, Turn::TwoColours),
    pattern("poisson + bfs of 2", DISK, Turn::Rule("bfs(candidates: 2)")),
    pattern("poisson + bfs of 3", DISK, Turn::Rule("bfs(candidates: 3)")),
    pattern("poisson + bfs of 4", DISK, Turn::Rule("bfs(candidates: 4)")),
    pattern("poisson + bfs of 6", DISK, Turn::Rule("bfs(candidates: 6)")),
    pattern("poisson + bfs of 8", DISK, Turn::Rule("bfs(candidates: 8)")),
    pattern("poisson + stripes", DISK, Turn::Stripes),
    pattern("poisson + rings", DISK, Turn::Rings),
    pattern("poisson + ramp", DISK, Turn::Ramp),
    pattern("poisson + flow", DISK, Turn::Flow),
    pattern("poisson + one direction", DISK, Turn::Rule("fixed(0deg)")),
    pattern("poisson + half bfs, half random", DISK, Turn::Half),
    pattern("poisson + mean contrast alone", DISK, Turn::Unguarded),
    pattern("poisson + chequers", DISK, Turn::Chequers),
];

impl Pattern {
    /// The pattern of one seed.
    pub(crate) fn measured(&self, page: Page, seed: u64) -> Measured {
        let a = page.spacing();
        let place = match self.sites {
            Sites::Place(text) => text,
            Sites::Lattice { .. } | Sites::Sunflower | Sites::Halton | Sites::R2 | Sites::Clumps | Sites::Copies(_) => {
                "uniform(count: 100)"
            }
        };
        let place = place
            .replace("{r}", &page.radius().to_string())
            .replace("{a}", &a.to_string())
            .replace("{h}", &(a * HEX[0][0]).to_string())
            // A triangle's area is a share of its side's square, as a rhomb's mean is.
            .replace("{t}", &(a / 0.658_037).to_string())
            .replace("{p}", &(a / 0.9).to_string());
        let rule = if let Turn::Rule(text) | Turn::Turning(text) = self.turn { text } else { "bfs()" };
        let ([width, height], region, repeat) = (page.size, page.region, page.repeat);
        let text = format!(
            "canvas {{ size: ({width}mm, {height}mm), repeat: {repeat} }}
             seed {seed}
             tone plate {{
               place: {place}
               shape: rect(size: {a}mm)
               angle: {rule}
               bleed: {}mm
               fill: lines(pitch: 1mm)
               k: 1
             }}
             paint {region} with plate",
            page.bleed * a,
        );
        let mut loader = MemoryLoader::default();
        loader.files.insert("pattern.kake".to_owned(), text.into_bytes().into());
        let lowered = lower("pattern.kake", &loader, &LowerConfig::default());
        let scene = lowered.scene.unwrap_or_else(|| panic!("{:?}", lowered.diagnostics));
        let mut paint = kakeami::paints(&scene).next().cloned().expect("the scene paints");
        if !matches!(self.sites, Sites::Place(_)) {
            paint.tone.place = Placement::Points(self.sites.points(&page, seed));
        }
        let stages = PaintStages::new(&paint, &scene.canvas, &Limits::default(), &mut (), &mut Vec::new());
        let stages = stages.unwrap_or_else(|diagnostic| panic!("{}", diagnostic.message));
        let mut measured = Measured::new(&paint, &stages.borrow());
        measured.angles = self.turn.angles(&measured, a, seed);
        measured
    }
}

fn stream(seed: u64, purpose: &str) -> Stream {
    Key { seed, name: "pattern", purpose }.stream()
}

/// The fractional part of a number that is not below zero.
fn part(x: f64) -> f64 {
    x - x.floor()
}

impl Sites {
    /// Sites on a page; none beyond its bleed.
    fn points(self, page: &Page, seed: u64) -> Vec<Point> {
        let [width, height] = page.size;
        let (a, bleed) = (page.spacing(), page.bleed * page.spacing());
        let mut random = stream(seed, "sites");
        let mut points = Vec::new();
        match self {
            Self::Place(_) => {}
            Self::Lattice { steps: [row, next], jitter, is_turned } => {
                let turn = if is_turned { random.unit() * 360.0 } else { 0.0 };
                let (sin, cos) = Angle::degrees(turn).sin_cos();
                let reach = ((width + height + 4.0 * bleed) / a) as i32 * 2;
                for i in -reach..=reach {
                    for j in -reach..=reach {
                        let (i, j) = (f64::from(i) + 0.5, f64::from(j) + 0.5);
                        let (x, y) = ((i * row[0] + j * next[0]) * a, (i * row[1] + j * next[1]) * a);
                        let (x, y) = (x * cos - y * sin + a / 3.0, x * sin + y * cos + a / 3.0);
                        let mut moved = |x: f64| x + jitter * a * (random.unit() * 2.0 - 1.0);
                        points.push(Point::new(moved(x), moved(y)));
                    }
                }
            }
            Self::Sunflower => {
                let start = random.unit() * 360.0;
                for i in 0..page.tiles * 4 {
                    let (i, turn) = (f64::from(i), 137.507_764_050_037_85);
                    let (sin, cos) = Angle::degrees(part((start + i * turn) / 360.0) * 360.0).sin_cos();
                    let radius = ((i + 0.5) / std::f64::consts::PI).sqrt() * a;
                    points.push(Point::new(width / 2.0 + radius * cos, height / 2.0 + radius * sin));
                }
            }
            Self::Halton | Self::R2 => {
                let start = [random.unit(), random.unit()];
                for i in 0..page.tiles {
                    let at = match self {
                        Self::Halton => [radical_inverse(i, 2), radical_inverse(i, 3)],
                        _ => [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|step| part(f64::from(i) * step)),
                    };
                    points.push(Point::new(part(at[0] + start[0]) * width, part(at[1] + start[1]) * height));
                }
            }
            Self::Clumps => {
                for _ in 0..page.tiles / 5 {
                    let centre = [random.unit() * width, random.unit() * height];
                    for _ in 0..5 {
                        let [x, y] = centre.map(|x| x + (random.unit() + random.unit() - 1.0) * a);
                        points.push(Point::new(x, y));
                    }
                }
            }
            Self::Copies(side) => {
                let disk = Pattern { name: "", sites: DISK, turn: BFS };
                let size = [f64::from(side) * a; 2];
                let patch = disk.measured(Page { size, tiles: side * side, ..Page::square(1) }, seed);
                for i in 0..(width / size[0]).ceil() as i32 {
                    for j in 0..(height / size[1]).ceil() as i32 {
                        let (x, y) = (f64::from(i) * size[0], f64::from(j) * size[1]);
                        points.extend(patch.sites.iter().map(|p| Point::new(p.x + x, p.y + y)));
                    }
                }
            }
        }
        points.retain(|p| {
            let is_in = |x: f64, size: f64| -bleed <= x && x < size + bleed;
            is_in(p.x, width) && is_in(p.y, height)
        });
        points
    }
}

/// The digits of a number in a base, mirrored at the point.
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0);
    while number > 0 {
        place /= f64::from(base);
        value += place * f64::from(number % base);
        number /= base;
    }
    value
}

impl Turn {
    /// A direction for every tile.
    fn angles(self, measured: &Measured, a: f64, seed: u64) -> Vec<Angle> {
        let sites = &measured.sites;
        let by_place = |turn: &dyn Fn(f64, f64) -> f64| -> Vec<Angle> {
            sites.iter().map(|p| Angle::degrees(turn(p.x / a, p.y / a)).direction()).collect()
        };
        let widest = sites.iter().fold(0.0f64, |x, p| x.max(p.x / a));
        let middle = sites.iter().fold([0.0; 2], |[x, y], p| [x + p.x / a, y + p.y / a]);
        let middle = middle.map(|sum| sum / sites.len() as f64);
        let mut random = stream(seed, "angles");
        match self {
            Self::Rule(_) => measured.angles.clone(),
            Self::Turning(_) => {
                let round = by_place(&|x, _| x / widest * 180.0);
                measured.angles.iter().zip(round).map(|(&angle, turn)| (angle + turn).direction()).collect()
            }
            Self::TwoColours => two_colours(measured),
            Self::Stripes => by_place(&|x, _| (x / 2.0).floor() * 137.5),
            Self::Rings => by_place(&|x, y| 90.0 * (libm::hypot(x - middle[0], y - middle[1]).floor() % 2.0)),
            Self::Ramp => by_place(&|x, _| x * 90.0),
            Self::Flow => by_place(&|x, y| 60.0 * libm::sin(x / 3.0) + 60.0 * libm::cos(y / 2.0 + x / 5.0)),
            Self::Half => {
                let random: Vec<f64> = sites.iter().map(|_| random.unit() * 180.0).collect();
                let is_left = |p: &Point| p.x / a < middle[0];
                let angles = measured.angles.iter().zip(sites).zip(random);
                angles.map(|((&angle, p), other)| if is_left(p) { angle } else { Angle::degrees(other) }).collect()
            }
            Self::Unguarded => unguarded(measured, &mut random),
            Self::Chequers => by_place(&|x, y| 90.0 * (x.floor() + y.floor()).rem_euclid(2.0)),
            Self::Thirds => by_place(&|x, y| {
                let row = ((y - 1.0 / 3.0) / HEX[1][1] - 0.5).round();
                let column = ((x - 1.0 / 3.0 - (row + 0.5) * HEX[1][0]) / HEX[0][0] - 0.5).round();
                60.0 * (column - row).rem_euclid(3.0)
            }),
        }
    }
}

/// Two colours that differ over as many links as moving single tiles finds.
fn two_colours(measured: &Measured) -> Vec<Angle> {
    let mut colours: Vec<u8> = measured.angles.iter().map(|angle| u8::from(angle.to_radians() > 0.8)).collect();
    for _ in 0..100 {
        let mut is_settled = true;
        for tile in 0..colours.len() {
            let around = measured.graph.neighbours(tile);
            let alike = around.iter().filter(|&&other| colours[other as usize] == colours[tile]).count();
            if 2 * alike > around.len() {
                colours[tile] = 1 - colours[tile];
                is_settled = false;
            }
        }
        if is_settled {
            break;
        }
    }
    colours.into_iter().map(|colour| Angle::degrees(f64::from(colour) * 90.0)).collect()
}

/// Sweeps that each give every tile the direction of the greatest sum of contrasts to its neighbours.
fn unguarded(measured: &Measured, random: &mut Stream) -> Vec<Angle> {
    let mut angles: Vec<Angle> = measured.sites.iter().map(|_| Angle::degrees(random.unit() * 180.0)).collect();
    for _ in 0..50 {
        for tile in 0..angles.len() {
            let sum = |angle: Angle, angles: &[Angle]| -> f64 {
                let around = measured.graph.neighbours(tile).iter();
                around.map(|&other| angle.rp1_distance(angles[other as usize]).to_radians()).sum()
            };
            let tried = Angle::degrees(random.unit() * 180.0);
            if sum(tried, &angles) > sum(angles[tile], &angles) {
                angles[tile] = tried;
            }
        }
    }
    angles
}
