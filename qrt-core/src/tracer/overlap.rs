//! Convex polygons of one plane, of which some cover others.

use super::geometry::SAME_PLANE;
use glam::DVec3;

/// Polygons of one plane, in a tree of rectangles around them, so that those that a polygon overlaps are
/// found without asking all.
pub(super) struct Outlines<'a> {
    /// The axis that is left out of rectangles.
    axis: usize,
    polygons: Vec<&'a [DVec3]>,
    /// The root last.
    nodes: Vec<Node>,
}

struct Node {
    rectangle: Rectangle,
    /// The least and the greatest number of a polygon below.
    numbers: [usize; 2],
    /// Two nodes; none where there is one polygon.
    children: Option<[usize; 2]>,
}

/// Low and high corner.
#[derive(Clone, Copy)]
struct Rectangle([[f64; 2]; 2]);

impl Rectangle {
    fn of(axis: usize, outline: &[DVec3]) -> Self {
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
    /// At least one polygon on a plane whose main axis is `axis`.
    pub(super) fn new(axis: usize, polygons: Vec<&'a [DVec3]>) -> Self {
        let mut all = Self {
            axis,
            polygons,
            nodes: Vec::new(),
        };
        let around = |number: usize| (Rectangle::of(axis, all.polygons[number]), number);
        let mut leaves: Vec<(Rectangle, usize)> = (0..all.polygons.len()).map(around).collect();
        all.grow(&mut leaves);
        all
    }

    fn grow(&mut self, leaves: &mut [(Rectangle, usize)]) -> usize {
        if let [(rectangle, number)] = *leaves {
            self.nodes.push(Node {
                rectangle,
                numbers: [number; 2],
                children: None,
            });
            return self.nodes.len() - 1;
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
        let [a, b] = children.map(|child| &self.nodes[child]);
        self.nodes.push(Node {
            rectangle: a.rectangle.and(b.rectangle),
            numbers: [
                a.numbers[0].min(b.numbers[0]),
                a.numbers[1].max(b.numbers[1]),
            ],
            children: Some(children),
        });
        self.nodes.len() - 1
    }

    /// The first of the polygons from number `start` on with which `outline` has more than edges in common.
    pub(super) fn first_overlapped(&self, start: usize, outline: &[DVec3]) -> Option<usize> {
        let rectangle = Rectangle::of(self.axis, outline);
        let mut first = None;
        let mut pending = vec![self.nodes.len() - 1];
        while let Some(node) = pending.pop() {
            let node = &self.nodes[node];
            let [least, greatest] = node.numbers;
            let comes_later = first.is_some_and(|first| first <= least);
            if greatest < start || comes_later || !node.rectangle.meets(rectangle) {
                continue;
            }
            match node.children {
                None if overlap(outline, self.polygons[least]) => first = Some(least),
                None => {}
                Some([a, b]) => {
                    let a_first = self.nodes[a].numbers[0] <= self.nodes[b].numbers[0];
                    pending.extend(if a_first { [b, a] } else { [a, b] });
                }
            }
        }
        first
    }
}

/// Whether two convex polygons of one plane have more than edges in common.
fn overlap(a: &[DVec3], b: &[DVec3]) -> bool {
    let apart = |a: &[DVec3], b: &[DVec3]| {
        let normal = (a[1] - a[0]).cross(a[2] - a[0]).normalize();
        (0..a.len()).any(|k| {
            let (start, end) = (a[k], a[(k + 1) % a.len()]);
            let outward = (end - start).cross(normal).normalize();
            b.iter()
                .all(|corner| outward.dot(*corner - start) >= -SAME_PLANE)
        })
    };
    !apart(a, b) && !apart(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of some size at some place of the plane z = 1.
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

    #[test]
    fn the_tree_finds_what_asking_all_finds() {
        let mut state = 7;
        let all: Vec<Vec<DVec3>> = (0..300).map(|_| triangle(&mut state)).collect();
        let outlines = Outlines::new(2, all.iter().map(Vec::as_slice).collect());
        let mut found = 0;
        for start in 0..300 {
            for _ in 0..10 {
                let one = triangle(&mut state);
                let asked = (start..300).find(|&n| overlap(&one, &all[n]));
                assert_eq!(outlines.first_overlapped(start, &one), asked);
                found += usize::from(asked.is_some());
            }
        }
        assert!((1000..2990).contains(&found), "{found}");
    }
}
