//! Overlaps of convex polygons of one plane.

use super::SAME_PLANE;
use glam::{DVec2, DVec3};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Average work per query of a tree: testing a rectangle costs 1, comparing a polygon
/// [`OF_POLYGON`]. Beyond it, polygons that may overlap are not compared.
const ASKED: u64 = 1024;
const OF_POLYGON: u64 = 8;

/// Polygons of one plane, in a tree of rectangles around them, which finds the polygons that
/// overlap another without comparing all.
pub struct Outlines<'a> {
    /// The axis that rectangles leave out.
    axis: usize,
    polygons: Vec<&'a [DVec3]>,
    /// The nodes; the root is the last.
    nodes: Vec<Node>,
    /// The leaf of each polygon.
    leaves: Vec<usize>,
    /// Polygons of this number and greater ones are active: queries compare them.
    start: usize,
    /// The work that is left.
    left: u64,
}

struct Node {
    rectangle: Rectangle,
    /// The least number of an active polygon below this node; the greatest `usize` if there is
    /// none.
    least: usize,
    /// The two children; `None` for a leaf, which has one polygon.
    children: Option<[usize; 2]>,
    /// The parent node; the root is its own parent.
    parent: usize,
}

/// A rectangle: its low and its high corner.
#[derive(Clone, Copy)]
struct Rectangle([[f64; 2]; 2]);

impl Rectangle {
    fn around(axis: usize, outline: &[DVec3]) -> Self {
        let bound = |from: f64, pick: fn(f64, f64) -> f64| {
            [1, 2].map(|k| {
                let along = outline.iter().map(|corner| corner[(axis + k) % 3]);
                along.fold(from, pick)
            })
        };
        Self([
            bound(f64::INFINITY, f64::min),
            bound(f64::NEG_INFINITY, f64::max),
        ])
    }

    fn and(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        let pick = |x: [f64; 2], y: [f64; 2], pick: fn(f64, f64) -> f64| {
            [pick(x[0], y[0]), pick(x[1], y[1])]
        };
        Self([pick(a, c, f64::min), pick(b, d, f64::max)])
    }

    fn meets(self, other: Self) -> bool {
        let ([a, b], [c, d]) = (self.0, other.0);
        (0..2).all(|k| a[k] <= d[k] && c[k] <= b[k])
    }

    fn centre(self, k: usize) -> f64 {
        self.0[0][k] + self.0[1][k]
    }
}

impl<'a> Outlines<'a> {
    /// Creates the tree of at least one polygon on a plane whose main axis is `axis`. No polygon is
    /// active yet.
    pub fn new(axis: usize, polygons: Vec<&'a [DVec3]>) -> Self {
        let mut all = Self {
            axis,
            nodes: Vec::with_capacity(2 * polygons.len()),
            leaves: vec![0; polygons.len()],
            start: polygons.len(),
            polygons,
            left: 0,
        };
        let around = |number: usize| (Rectangle::around(axis, all.polygons[number]), number);
        let mut leaves: Vec<(Rectangle, usize)> = (0..all.polygons.len()).map(around).collect();
        all.grow(&mut leaves);
        all
    }

    fn grow(&mut self, leaves: &mut [(Rectangle, usize)]) -> usize {
        let parent = self.nodes.len();
        if let [(rectangle, number)] = *leaves {
            self.leaves[number] = parent;
            self.nodes.push(Node {
                rectangle,
                least: usize::MAX,
                children: None,
                parent,
            });
            return parent;
        }
        let around = leaves.iter().map(|(rectangle, _)| *rectangle);
        let wide = around.reduce(Rectangle::and).map_or(0, |around| {
            let [low, high] = around.0;
            usize::from(high[1] - low[1] > high[0] - low[0])
        });
        let half = leaves.len() / 2;
        leaves.select_nth_unstable_by(half, |(a, _), (b, _)| {
            a.centre(wide).total_cmp(&b.centre(wide))
        });
        let (left, right) = leaves.split_at_mut(half);
        let children = [self.grow(left), self.grow(right)];
        let parent = self.nodes.len();
        let [a, b] = children.map(|child| {
            self.nodes[child].parent = parent;
            self.nodes[child].rectangle
        });
        self.nodes.push(Node {
            rectangle: a.and(b),
            least: usize::MAX,
            children: Some(children),
            parent,
        });
        parent
    }

    /// Activates the polygons of number `start` and greater ones. The start never increases.
    pub fn ask_from(&mut self, start: usize) {
        for number in (start..self.start).rev() {
            let mut node = self.leaves[number];
            loop {
                self.nodes[node].least = number;
                let parent = self.nodes[node].parent;
                if parent == node {
                    break;
                }
                node = parent;
            }
        }
        self.start = self.start.min(start);
    }

    /// Returns the first active polygon that overlaps `outline` in more than edges. If the work is
    /// used up, returns the first active polygon, which may not overlap it: thousands of polygons
    /// may lie over each other without overlapping.
    pub fn first_overlapped(&mut self, outline: &[DVec3]) -> Option<usize> {
        let root = self.nodes.len() - 1;
        let rectangle = Rectangle::around(self.axis, outline);
        self.left += ASKED;
        let mut first = usize::MAX;
        let mut pending = vec![root];
        while let Some(number) = pending.pop() {
            let node = &self.nodes[number];
            self.left = self.left.saturating_sub(1);
            if node.least >= first || !node.rectangle.meets(rectangle) {
                continue;
            }
            match node.children {
                None => {
                    if self.left == 0 {
                        return Some(self.start);
                    }
                    self.left = self.left.saturating_sub(OF_POLYGON);
                    if overlap(outline, self.polygons[node.least], SAME_PLANE) {
                        first = node.least;
                    }
                }
                Some([a, b]) => {
                    let a_first = self.nodes[a].least <= self.nodes[b].least;
                    pending.extend(if a_first { [b, a] } else { [a, b] });
                }
            }
        }
        (first < usize::MAX).then_some(first)
    }
}

/// True if polygons of a plane whose main axis is `axis` lie side by side and fill a convex region,
/// as the triangles of a fan or of a grid do. Then no two have more than edges in common. False
/// proves nothing.
///
/// All must go around in one direction. The number of polygons that cover a point is then the
/// winding number about it of the edges that no two polygons share. If these edges are one convex
/// loop that goes around once, the number is 1 within the loop, and 0 outside.
pub fn fill_once<'a>(axis: usize, polygons: impl Iterator<Item = &'a [DVec3]>) -> bool {
    let flat = |corner: DVec3| DVec2::new(corner[(axis + 1) % 3], corner[(axis + 2) % 3]);
    let key = |corner: DVec2| (corner + DVec2::ZERO).to_array().map(f64::to_bits);
    let (mut edges, mut around) = (HashSet::new(), None);
    for polygon in polygons {
        let corners: Vec<DVec2> = polygon.iter().map(|&corner| flat(corner)).collect();
        let pairs = || corners.iter().zip(corners.iter().cycle().skip(1));
        let area: f64 = pairs().map(|(a, b)| a.perp_dot(*b)).sum();
        if *around.get_or_insert(area > 0.0) != (area > 0.0) {
            return false;
        }
        if !pairs().all(|(a, b)| edges.insert([key(*a), key(*b)])) {
            return false;
        }
    }
    let outer = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a]));
    let mut next = HashMap::new();
    if !outer
        .map(|[a, b]| next.insert(*a, *b))
        .all(|two| two.is_none())
    {
        return false;
    }
    let Some(&start) = next.keys().next() else {
        return false;
    };
    let mut outline = Vec::new();
    let mut at = start;
    while let Some(to) = next.remove(&at) {
        outline.push(DVec2::from_array(at.map(f64::from_bits)));
        at = to;
    }
    at == start && next.is_empty() && turns_once(&outline, around == Some(true))
}

/// True if a closed line turns only to one side, and goes around once: to the left if `left`.
fn turns_once(outline: &[DVec2], left: bool) -> bool {
    let corner = |k: usize| outline[k % outline.len()];
    let mut whole = 0.0;
    for k in 0..outline.len() {
        let [a, b] = [k, k + 1].map(|k| (corner(k + 1) - corner(k)).normalize());
        let turn = if left { a.perp_dot(b) } else { b.perp_dot(a) };
        if turn < -SAME_PLANE {
            return false;
        }
        whole += a.angle_to(b).abs();
    }
    (whole - TAU).abs() < 1.0
}

/// True if two convex polygons of one plane have a region in common that is wider than `width` across each
/// of their edges.
pub(crate) fn overlap(a: &[DVec3], b: &[DVec3], width: f64) -> bool {
    let apart = |a: &[DVec3], b: &[DVec3]| {
        let normal = (a[1] - a[0]).cross(a[2] - a[0]).normalize();
        (0..a.len()).any(|k| {
            let (start, end) = (a[k], a[(k + 1) % a.len()]);
            let outward = (end - start).cross(normal).normalize();
            b.iter()
                .all(|corner| outward.dot(*corner - start) >= -width)
        })
    };
    !apart(a, b) && !apart(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a pseudorandom triangle of the plane z = 1.
    fn triangle(state: &mut u64) -> Vec<DVec3> {
        let mut next = || {
            *state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (*state >> 33) as f64 / (1_u64 << 31) as f64
        };
        let (x, y, size) = (next(), next(), 0.02 + 0.2 * next() * next());
        let corner = |x: f64, y: f64| DVec3::new(x, y, 1.0);
        vec![corner(x, y), corner(x + size, y), corner(x, y + size)]
    }

    /// Returns `corners` corners on a circle of the plane z = 1.
    fn around(corners: usize) -> Vec<DVec3> {
        let corner = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / corners as f64).sin_cos();
            DVec3::new(cos, sin, 1.0)
        };
        (0..corners).map(corner).collect()
    }

    fn fill(polygons: &[Vec<DVec3>]) -> bool {
        fill_once(2, polygons.iter().map(Vec::as_slice))
    }

    #[test]
    fn polygons_side_by_side_are_seen_to_fill_a_region() {
        let circle = around(50);
        let fan: Vec<Vec<DVec3>> = (1..49)
            .map(|k| vec![circle[0], circle[k], circle[k + 1]])
            .collect();
        let turned = |fan: &[Vec<DVec3>]| -> Vec<Vec<DVec3>> {
            let turned = fan.iter().map(|one| one.iter().rev().copied().collect());
            turned.collect()
        };
        let corner = |i: usize, j: usize| DVec3::new(i as f64 / 7.0, j as f64 / 7.0, 1.0);
        let cell = |n: usize| {
            let (i, j) = (n % 7, n / 7);
            vec![
                corner(i, j),
                corner(i + 1, j),
                corner(i + 1, j + 1),
                corner(i, j + 1),
            ]
        };
        let grid: Vec<Vec<DVec3>> = (0..49).map(cell).collect();
        for tiles in [&fan, &turned(&fan), &grid, &turned(&grid)] {
            assert!(fill(tiles));
            let pairs = (0..tiles.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
            assert!(
                pairs
                    .into_iter()
                    .all(|(a, b)| !overlap(&tiles[a], &tiles[b], SAME_PLANE))
            );
        }
        // A hole, an outline that is not convex, two regions, one that is turned over or there twice,
        // a fan around its hub twice, and one that only comes from elsewhere.
        let without = |n: usize| [&grid[..n], &grid[n + 1..]].concat();
        assert!(!fill(&without(24)) && !fill(&without(0)) && !fill(&without(3)));
        let far: Vec<DVec3> = fan[0].iter().map(|c| *c + DVec3::X * 9.0).collect();
        assert!(!fill(&[&fan[..], &[far][..]].concat()));
        assert!(!fill(&[&fan[1..], &turned(&fan[..1])].concat()));
        assert!(!fill(&[&fan[..], &fan[4..5]].concat()));
        let hub = DVec3::new(0.0, 0.0, 1.0);
        let twice = |k: usize| vec![hub, circle[2 * k % 50], circle[(2 * k + 2) % 50]];
        let twice = (0..25).map(twice).chain((0..24).map(|k| {
            let k = 2 * k + 1;
            vec![hub, circle[k], circle[k + 2]]
        }));
        assert!(!fill(&twice.collect::<Vec<_>>()));
        assert!(!fill(&[]));
    }

    #[test]
    fn the_tree_finds_what_asking_all_finds() {
        let mut state = 7;
        let all: Vec<Vec<DVec3>> = (0..300).map(|_| triangle(&mut state)).collect();
        let mut outlines = Outlines::new(2, all.iter().map(Vec::as_slice).collect());
        let mut found = 0;
        for start in (0..300).rev() {
            outlines.ask_from(start);
            for _ in 0..10 {
                let one = triangle(&mut state);
                let asked = (start..300).find(|&n| overlap(&one, &all[n], SAME_PLANE));
                assert_eq!(outlines.first_overlapped(&one), asked);
                found += usize::from(asked.is_some());
            }
        }
        assert!((1000..2990).contains(&found), "{found}");
    }

    /// Triangles in a heap, and thin strips side by side whose rectangles meet.
    #[test]
    fn however_polygons_lie_few_are_asked() {
        const COUNT: usize = 20_000;
        let mut state = 3;
        let heap: Vec<Vec<DVec3>> = (0..COUNT).map(|_| triangle(&mut state)).collect();
        let strip = |n: usize| {
            let x = n as f64;
            let corner = |x: f64, y: f64| DVec3::new(x, y, 1.0);
            let far = 10.0 * COUNT as f64;
            vec![
                corner(x, -x),
                corner(x + 0.5, -x - 0.5),
                corner(x + far + 0.5, far - x - 0.5),
                corner(x + far, far - x),
            ]
        };
        let strips: Vec<Vec<DVec3>> = (0..COUNT).map(strip).collect();
        for (all, exact) in [(&heap, true), (&strips, false)] {
            let mut outlines = Outlines::new(2, all.iter().map(Vec::as_slice).collect());
            let mut asked = 0;
            for number in (0..COUNT).rev() {
                outlines.ask_from(number + 1);
                let left = outlines.left + ASKED;
                let found = outlines.first_overlapped(&all[number]);
                asked += left - outlines.left;
                if exact && number % 100 == 0 {
                    let first =
                        (number + 1..COUNT).find(|&n| overlap(&all[number], &all[n], SAME_PLANE));
                    assert_eq!(found, first);
                }
            }
            let each = asked / COUNT as u64;
            println!("{each} asked for each");
            assert!(
                each <= if exact { 300 } else { ASKED },
                "{each} asked for each"
            );
        }
    }
}
