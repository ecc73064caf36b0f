//! Nearest points among many, some of which are taken away one by one: a k-d tree (Bentley, "K-d trees for semidynamic
//! point sets", 1990). Of points equally near the one with the lower number counts as nearer.

use super::{Point, Rect};

/// Points of a leaf.
const LEAF: usize = 8;

/// Points that are told by their number.
#[derive(Debug)]
pub struct Tree<'a> {
    points: &'a [Point],
    nodes: Vec<Node>,
    /// The numbers of the points, those of a node in a row.
    order: Vec<u32>,
    /// The leaf of each point.
    leaf_of: Vec<u32>,
    /// Which points are still there.
    alive: Vec<bool>,
}

#[derive(Debug)]
struct Node {
    bounds: Rect,
    /// Its points in `order`.
    range: [u32; 2],
    /// The second of its two children, the first being the next node; a leaf has none.
    second: Option<u32>,
    parent: Option<u32>,
    /// How many of its points are still there.
    alive: u32,
}

/// A point and the square of its distance.
pub type Found = (f64, u32);

impl<'a> Tree<'a> {
    /// Of all points.
    #[must_use]
    pub fn new(points: &'a [Point]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut leaf_of = vec![0; points.len()];
        let mut nodes: Vec<Node> = Vec::new();
        // What is still to be split: a range, its parent, and whether it is the second child.
        let mut rest = vec![(0, points.len(), None, false)];
        while let Some((start, end, parent, is_second)) = rest.pop() {
            let number = nodes.len() as u32;
            if let Some(parent) = parent.filter(|_| is_second) {
                let parent: u32 = parent;
                nodes[parent as usize].second = Some(number);
            }
            let ids = &mut order[start..end];
            let bounds = ids.iter().fold(Rect::EMPTY, |bounds, &id| bounds.including(points[id as usize]));
            let alive = ids.len() as u32;
            nodes.push(Node { bounds, range: [start as u32, end as u32], second: None, parent, alive });
            if ids.len() <= LEAF {
                for &id in ids.iter() {
                    leaf_of[id as usize] = number;
                }
                continue;
            }
            let wide = bounds.width() >= bounds.height();
            let key = |id: u32| if wide { points[id as usize].x } else { points[id as usize].y };
            let middle = ids.len() / 2;
            ids.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            rest.push((start + middle, end, Some(number), true));
            rest.push((start, start + middle, Some(number), false));
        }
        Self { points, nodes, order, leaf_of, alive: vec![true; points.len()] }
    }

    /// Whether a point has not been taken away.
    #[must_use]
    pub fn is_there(&self, id: u32) -> bool {
        self.alive[id as usize]
    }

    /// Takes a point away.
    pub fn remove(&mut self, id: u32) {
        if !std::mem::replace(&mut self.alive[id as usize], false) {
            return;
        }
        let mut node = Some(self.leaf_of[id as usize]);
        while let Some(number) = node {
            let at = &mut self.nodes[number as usize];
            at.alive -= 1;
            node = at.parent;
        }
    }

    /// The nearest point that is still there.
    #[must_use]
    pub fn nearest(&self, p: Point) -> Option<u32> {
        let mut found = Vec::with_capacity(2);
        self.nearest_few(p, 1, f64::INFINITY, |_| true, &mut found);
        found.first().map(|&(_, id)| id)
    }

    /// The nearest points that are still there, up to `count` of them and none farther than the square root of `reach`,
    /// nearest first.
    pub fn nearest_few(
        &self,
        p: Point,
        count: usize,
        reach: f64,
        accept: impl Fn(u32) -> bool,
        found: &mut Vec<Found>,
    ) {
        found.clear();
        let off = |node: u32| {
            let node = &self.nodes[node as usize];
            if node.alive == 0 {
                return f64::INFINITY;
            }
            let near = Point::new(
                p.x.clamp(node.bounds.min.x, node.bounds.max.x),
                p.y.clamp(node.bounds.min.y, node.bounds.max.y),
            );
            p.distance_squared(near)
        };
        let is_worse = |off: f64, found: &[Found]| {
            off > reach
                || off == f64::INFINITY
                || (found.len() == count && found.last().is_some_and(|last| off > last.0))
        };
        let mut rest = Vec::with_capacity(32);
        if !self.points.is_empty() {
            rest.push((off(0), 0));
        }
        while let Some((distance, number)) = rest.pop() {
            if is_worse(distance, found) {
                continue;
            }
            let node = &self.nodes[number as usize];
            if let Some(second) = node.second {
                let mut children = [(off(number + 1), number + 1), (off(second), second)];
                if children[0].0 < children[1].0 {
                    children.swap(0, 1);
                }
                rest.extend(children);
                continue;
            }
            for &id in &self.order[node.range[0] as usize..node.range[1] as usize] {
                let candidate = (p.distance_squared(self.points[id as usize]), id);
                if !self.alive[id as usize] || is_worse(candidate.0, found) || !accept(id) {
                    continue;
                }
                let place =
                    found.partition_point(|other| other.0.total_cmp(&candidate.0).then(other.1.cmp(&id)).is_lt());
                found.insert(place, candidate);
                found.truncate(count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn finds_what_looking_at_all_finds(
            // Few places, so that many points are equally far or the same.
            places in vec((0..12i32, 0..12i32), 1..120),
            gone in vec(any::<prop::sample::Index>(), 0..60),
            from in (-3..15i32, -3..15i32),
            count in 1..6usize,
            reach in 1..200i32,
        ) {
            let point = |(x, y): (i32, i32)| Point::new(f64::from(x), f64::from(y));
            let points: Vec<Point> = places.into_iter().map(point).collect();
            let mut tree = Tree::new(&points);
            let mut left: Vec<u32> = (0..points.len() as u32).collect();
            for index in gone {
                let id = index.index(points.len()) as u32;
                tree.remove(id);
                left.retain(|&other| other != id);
            }
            let (p, reach) = (point(from), f64::from(reach));
            let mut wanted: Vec<Found> = left.iter().map(|&id| (p.distance_squared(points[id as usize]), id)).collect();
            wanted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            prop_assert_eq!(tree.nearest(p), wanted.first().map(|found| found.1));
            wanted.retain(|found| found.0 <= reach && found.1 % 3 != 0);
            wanted.truncate(count);
            let mut found = Vec::new();
            tree.nearest_few(p, count, reach, |id| id % 3 != 0, &mut found);
            prop_assert_eq!(found, wanted);
        }
    }
}
