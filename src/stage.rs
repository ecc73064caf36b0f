//! The types between the passes. Each is complete when it is made and never changed after.

use crate::geom::{Angle, Figure, Period, Pieces, Point, Rect, Vec2};

/// Where the tiles of a paint lie.
#[derive(Debug, Clone)]
pub struct Sites {
    /// The sites, in millimetres; their order is that of discovery, or row by row.
    pub points: Vec<Point>,
    /// The area that sites were asked for.
    pub domain: Rect,
    /// The domain grown by the bleed: every site but those of `points([…])` lies in it, or the site's cell in a tiling
    /// touches it.
    pub extent: Rect,
    /// The distance of neighbouring sites that shapes are sized by, in millimetres; greater than zero.
    pub spacing: f64,
    /// Column and row of every site of a grid.
    pub cells: Option<Vec<[i32; 2]>>,
    /// The cells of a tiling, one for every site, where something asks for them. They cover the extent.
    pub tiling: Option<Tiling>,
    /// On a page that repeats: the period, and what is known of images.
    pub torus: Option<Torus>,
}

/// A page that repeats.
#[derive(Debug, Clone)]
pub struct Torus {
    /// After which it does.
    pub period: Period,
    /// The site that each of the last sites is an image of, a whole number of periods away. Only the drawing pass adds
    /// images, so that what lies beyond a border is found like any other tile; all other sites lie in the first period.
    pub images: Vec<u32>,
}

/// Cells that lie side by side without gap or overlap.
#[derive(Debug, Clone, Default)]
pub struct Tiling {
    /// Corners of all cells, one after the other, each convex and clockwise on the page.
    corners: Vec<Point>,
    /// Where each cell ends in `corners`.
    ends: Vec<u32>,
    /// The pairs of cells that share an edge or a part of one, each once in any order.
    pub edges: Vec<[u32; 2]>,
}

impl Tiling {
    /// Adds a cell by its corners, clockwise on the page.
    pub fn push(&mut self, ring: &[Point]) {
        self.corners.extend_from_slice(ring);
        self.ends.push(self.corners.len() as u32);
    }

    /// How many cells there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of a cell.
    #[must_use]
    pub fn cell(&self, number: usize) -> &[Point] {
        let start = if number == 0 { 0 } else { self.ends[number - 1] as usize };
        &self.corners[start..self.ends[number] as usize]
    }
}

impl Sites {
    /// How many sites are no images of others. They come first.
    #[must_use]
    pub fn own(&self) -> usize {
        self.points.len() - self.torus.as_ref().map_or(0, |torus| torus.images.len())
    }

    /// The site that a site is an image of, or itself: what random draws for a tile are keyed by, and its place in the
    /// order of the pile.
    #[must_use]
    pub fn original(&self, site: usize) -> usize {
        let image = self.torus.as_ref().zip(site.checked_sub(self.own()));
        image.and_then(|(torus, image)| torus.images.get(image)).map_or(site, |&site| site as usize)
    }

    /// The sites that are no images.
    #[must_use]
    pub fn without_images(&self) -> Self {
        let torus = self.torus.as_ref().map(|torus| Torus { images: Vec::new(), ..torus.clone() });
        Self { points: self.points[..self.own()].to_vec(), torus, ..self.clone() }
    }

    /// The period of a page that repeats.
    #[must_use]
    pub fn period(&self) -> Option<Period> {
        self.torus.as_ref().map(|torus| torus.period)
    }
}

/// Which tiles are neighbours.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    /// Where the neighbours of site i start in `neighbours`; one more than there are sites.
    offsets: Vec<u32>,
    /// The neighbours of every site, in the order of their indices.
    neighbours: Vec<u32>,
    /// The triangles behind the links, each with its least index first and then clockwise on the page, in order; empty
    /// where links are not Delaunay's.
    pub triangles: Vec<[u32; 3]>,
    /// On a page that repeats: where the neighbours lie.
    around: Option<Around>,
}

/// Where the neighbours of every site lie, seen from it: in the page or beyond its borders. A site may have several
/// images of one neighbour around it, or its own.
#[derive(Debug, Clone)]
struct Around {
    /// Where the places round site i start; one more than there are sites.
    offsets: Vec<u32>,
    places: Vec<Point>,
}

impl Graph {
    /// From edges between `sites` sites, each named once in any order.
    #[must_use]
    pub fn new(sites: usize, edges: &[[u32; 2]], triangles: Vec<[u32; 3]>) -> Self {
        let mut offsets = vec![0u32; sites + 1];
        for edge in edges {
            for &end in edge {
                offsets[end as usize + 1] += 1;
            }
        }
        for i in 0..sites {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut neighbours = vec![0u32; edges.len() * 2];
        for &[a, b] in edges {
            for (from, to) in [(a, b), (b, a)] {
                neighbours[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        for i in 0..sites {
            neighbours[offsets[i] as usize..offsets[i + 1] as usize].sort_unstable();
        }
        Self { offsets, neighbours, triangles, around: None }
    }

    /// From what lies around every site of a page that repeats: each neighbour's index, and where it lies. The list is
    /// the same from both sides.
    #[must_use]
    pub fn around(stars: &[Vec<(u32, Point)>], triangles: Vec<[u32; 3]>) -> Self {
        let mut edges: Vec<[u32; 2]> = (0u32..)
            .zip(stars)
            .flat_map(|(site, star)| star.iter().map(move |&(other, _)| [site.min(other), site.max(other)]))
            .filter(|[a, b]| a != b)
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut around = Around { offsets: vec![0], places: Vec::new() };
        for star in stars {
            around.places.extend(star.iter().map(|&(_, place)| place));
            around.offsets.push(around.places.len() as u32);
        }
        Self { around: Some(around), ..Self::new(stars.len(), &edges, triangles) }
    }

    /// Where the neighbours of a site lie, of which `points` are all.
    pub fn places<'a>(&'a self, site: usize, points: &'a [Point]) -> impl Iterator<Item = Point> + 'a {
        let (links, places) = match &self.around {
            None => (self.neighbours(site), [].as_slice()),
            Some(around) => {
                let range = around.offsets[site] as usize..around.offsets[site + 1] as usize;
                ([].as_slice(), &around.places[range])
            }
        };
        links.iter().map(|&other| points[other as usize]).chain(places.iter().copied())
    }

    /// How many sites there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of a site, in the order of their indices.
    #[must_use]
    pub fn neighbours(&self, site: usize) -> &[u32] {
        &self.neighbours[self.offsets[site] as usize..self.offsets[site + 1] as usize]
    }

    /// Every edge once, its lesser end first, in order.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        (0..self.len()).flat_map(move |i| {
            let site = i as u32;
            self.neighbours(i).iter().filter(move |&&j| j > site).map(move |&j| [site, j])
        })
    }
}

/// How every tile is turned: directions in [0, pi).
#[derive(Debug, Clone)]
pub struct Angles(pub Vec<Angle>);

/// Where a tile lies relative to the painted region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Not drawn: outside, or left out by the edge rule.
    Absent,
    /// Drawn, and no outline comes near it.
    Whole,
    /// Drawn, and its strokes end at the region's outline.
    Clipped,
}

/// How many layers a tile has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layers {
    /// Layers that are drawn in full, 0 to 4.
    pub full: u8,
    /// What there is of the next layer, in [0, 1): the share of its lines that is drawn, or, where a darkness is asked
    /// for, how densely they stand, as a share of the fill's own density.
    pub part: f64,
    /// How densely the last full layer stands, as a share of the fill's own density, in (0, 1]: 1 unless it makes room for
    /// a thin layer after it.
    pub last: f64,
    /// Whether the tile is inked all over, whatever its layers are.
    pub is_solid: bool,
}

impl Layers {
    /// Inked all over.
    pub const SOLID: Self = Self { full: 4, part: 0.0, last: 1.0, is_solid: true };

    /// Full layers and a part of the next.
    #[must_use]
    pub const fn new(full: u8, part: f64) -> Self {
        Self { full, part, last: 1.0, is_solid: false }
    }

    /// How many layers of strokes are seen, a thin last one included; none where all is ink.
    #[must_use]
    pub fn seen(self) -> u8 {
        if self.is_solid { 0 } else { self.full + u8::from(self.part > 0.0) }
    }

    /// Whether nothing is drawn and nothing hidden.
    #[must_use]
    pub fn is_blank(self) -> bool {
        self.full == 0 && self.part <= 0.0 && !self.is_solid
    }
}

/// The tiles of a paint as cut: outline, layers and standing of every site.
#[derive(Debug, Clone)]
pub struct Tiles {
    /// Corners of all outlines, one after the other, each clockwise on the page.
    corners: Vec<Point>,
    /// Where the outline of tile i ends in `corners`.
    ends: Vec<u32>,
    /// How outlines that are not convex fall into convex pieces.
    pieces: Pieces,
    /// Corners of all pieces of all tiles, as many for each.
    piece_corners: Vec<Point>,
    /// The field's value at the site, clamped to 0..=4; where a darkness is asked for, the layers that came of it.
    pub k: Vec<f64>,
    /// What of it is drawn.
    pub layers: Vec<Layers>,
    /// Where the tile lies relative to the region.
    pub standing: Vec<Standing>,
    /// Whether the site lies in the region: such tiles are measured.
    pub inside: Vec<bool>,
}

impl Tiles {
    /// From one convex ring of corners a tile; the lists have one entry a tile.
    #[must_use]
    pub fn new(
        rings: impl IntoIterator<Item = impl AsRef<[Point]>>,
        k: Vec<f64>,
        layers: Vec<Layers>,
        standing: Vec<Standing>,
        inside: Vec<bool>,
    ) -> Self {
        let mut corners = Vec::with_capacity(k.len() * 5);
        let mut ends = Vec::with_capacity(k.len());
        for ring in rings {
            corners.extend_from_slice(ring.as_ref());
            ends.push(corners.len() as u32);
        }
        Self { corners, ends, pieces: Pieces::default(), piece_corners: Vec::new(), k, layers, standing, inside }
    }

    /// The same tiles with outlines that are not convex, but all fall into pieces in one way. None of them is empty.
    #[must_use]
    pub fn in_pieces(mut self, pieces: &Pieces) -> Self {
        let mut corners = Vec::with_capacity(self.len() * pieces.len());
        if !pieces.is_empty() {
            (0..self.len()).for_each(|tile| corners.extend(pieces.corners(self.outline(tile))));
        }
        self.pieces = pieces.clone();
        self.piece_corners = corners;
        self
    }

    /// The same tiles and, after them, images of some, each moved.
    #[must_use]
    pub fn with_images(&self, images: &[(u32, Vec2)]) -> Self {
        let moved = |&(tile, way): &(u32, Vec2)| self.outline(tile as usize).iter().map(|&p| p + way).collect();
        let rings: Vec<Vec<Point>> = images.iter().map(moved).collect();
        let own = (0..self.len()).map(|tile| self.outline(tile));
        let tiles = || (0..self.len()).chain(images.iter().map(|&(tile, _)| tile as usize));
        Self::new(
            own.chain(rings.iter().map(Vec::as_slice)),
            tiles().map(|tile| self.k[tile]).collect(),
            tiles().map(|tile| self.layers[tile]).collect(),
            tiles().map(|tile| self.standing[tile]).collect(),
            // An image is measured where its original is.
            self.inside.iter().copied().chain(images.iter().map(|_| false)).collect(),
        )
        .in_pieces(&self.pieces)
    }

    /// The same tiles with other layers.
    #[must_use]
    pub fn with_layers(self, k: Vec<f64>, layers: Vec<Layers>) -> Self {
        Self { k, layers, ..self }
    }

    /// How many tiles there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The outline of a tile; empty where an inset left nothing of it.
    #[must_use]
    pub fn outline(&self, tile: usize) -> &[Point] {
        let start = if tile == 0 { 0 } else { self.ends[tile - 1] as usize };
        &self.corners[start..self.ends[tile] as usize]
    }

    /// A tile's outline with the convex pieces it is made of.
    #[must_use]
    pub fn figure(&self, tile: usize) -> Figure<'_> {
        let each = self.pieces.len();
        Figure::new(self.outline(tile), &self.pieces, &self.piece_corners[tile * each..(tile + 1) * each])
    }

    /// Whether a tile is drawn and hides what lies under it.
    #[must_use]
    pub fn is_drawn(&self, tile: usize) -> bool {
        self.standing[tile] != Standing::Absent && !self.layers[tile].is_blank()
    }
}
