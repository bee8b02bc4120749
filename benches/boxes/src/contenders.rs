//! The crates to compare with, each used as its documentation shows.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use nalgebra::{Point3, Vector3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use qrt::tracer::{NO_FACE, StageGeometry};
use qrt::runtime::path_machines::SingleRay;
use std::time::Duration;

/// A triangle of the scene; a quad's two halves share its label.
#[derive(Clone)]
pub struct Triangle {
    corners: [Vector3<f64>; 3],
    label: u32,
    /// The triangle's plane: a ray that starts on it cannot meet it.
    plane: u32,
    node: usize,
}

impl Triangle {
    /// Returns all triangles of `geometry`.
    pub fn all(geometry: &StageGeometry) -> Vec<Self> {
        let mut triangles = Vec::new();
        for (label, corners) in geometry.corners.iter().enumerate() {
            let at = |i: usize| Vector3::from(corners[i].to_array());
            for last in 2..corners.len() {
                triangles.push(Self {
                    corners: [at(0), at(last - 1), at(last)],
                    label: label as u32,
                    plane: geometry.plane_of[label],
                    node: 0,
                });
            }
        }
        triangles
    }

    /// Returns the distance at which a ray meets it from either side: Möller and Trumbore's test.
    fn distance(&self, ray: &bvh::ray::Ray<f64, 3>) -> f64 {
        let [a, b, c] = &self.corners;
        let (ab, ac) = (b - a, c - a);
        let across = ray.direction.cross(&ac);
        let inverse = 1.0 / ab.dot(&across);
        let from = ray.origin.coords - a;
        let u = from.dot(&across) * inverse;
        let turned = from.cross(&ab);
        let v = ray.direction.dot(&turned) * inverse;
        let distance = ac.dot(&turned) * inverse;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 {
            distance
        } else {
            f64::INFINITY
        }
    }

    fn singles(triangles: &[Self]) -> Vec<obvhs::triangle::Triangle> {
        let single = |v: Vector3<f64>| [v.x as f32, v.y as f32, v.z as f32].into();
        let corners = triangles.iter().map(|t| t.corners.map(single));
        corners
            .map(|[v0, v1, v2]| obvhs::triangle::Triangle { v0, v1, v2 })
            .collect()
    }
}

/// Triangles in the order in which a tree of `obvhs` names them.
struct Ordered {
    triangles: Vec<RtTriangle>,
    labels: Vec<u32>,
    planes: Vec<u32>,
}

impl Ordered {
    fn new(triangles: &[Triangle], singles: &[obvhs::triangle::Triangle], order: &[u32]) -> Self {
        let places = || order.iter().map(|&place| place as usize);
        Self {
            triangles: places().map(|p| (&singles[p]).into()).collect(),
            labels: places().map(|p| triangles[p].label).collect(),
            planes: places().map(|p| triangles[p].plane).collect(),
        }
    }

    #[inline(always)]
    fn distance(&self, ray: &Ray, id: usize, from: u32) -> f32 {
        if self.planes[id] == from {
            return f32::INFINITY;
        }
        self.triangles[id].intersect(ray)
    }

    #[inline(always)]
    fn label(&self, met: bool, hit: &RayHit) -> u32 {
        if met {
            self.labels[hit.primitive_id as usize]
        } else {
            NO_FACE
        }
    }
}

fn single_precision(ray: &SingleRay) -> Ray {
    let single = |v: [f64; 3]| v.map(|c| c as f32).into();
    Ray::new_inf(single(ray.origin), single(ray.direction))
}

/// Hierarchy of `obvhs` with eight children a node.
pub struct Cwbvh {
    tree: CwBvh,
    faces: Ordered,
}

impl Cwbvh {
    /// Builds a hierarchy over `triangles` with the slowest, most careful settings.
    pub fn new(triangles: &[Triangle]) -> Self {
        let singles = Triangle::singles(triangles);
        let care = BvhBuildParams::very_slow_build();
        let tree = build_cwbvh_from_tris(&singles, care, &mut Duration::default());
        let faces = Ordered::new(triangles, &singles, &tree.primitive_indices);
        Self { tree, faces }
    }

    /// Returns the label of the nearest face of each ray.
    pub fn find(&self, rays: &[SingleRay]) -> Vec<u32> {
        let nearest = |ray: &SingleRay| {
            let mut hit = RayHit::none();
            let from = ray.from;
            let met = self
                .tree
                .ray_traverse(single_precision(ray), &mut hit, |ray, id| {
                    self.faces.distance(ray, id, from)
                });
            self.faces.label(met, &hit)
        };
        rays.iter().map(nearest).collect()
    }
}

/// Hierarchy of `obvhs` with two children a node.
pub struct Halves {
    tree: Bvh2,
    faces: Ordered,
}

impl Halves {
    /// Builds a hierarchy over `triangles` with the slowest, most careful settings.
    pub fn new(triangles: &[Triangle]) -> Self {
        let singles = Triangle::singles(triangles);
        let care = BvhBuildParams::very_slow_build();
        let tree = build_bvh2_from_tris(&singles, care, &mut Duration::default());
        let faces = Ordered::new(triangles, &singles, &tree.primitive_indices);
        Self { tree, faces }
    }

    /// Returns the label of the nearest face of each ray.
    pub fn find(&self, rays: &[SingleRay]) -> Vec<u32> {
        let nearest = |ray: &SingleRay| {
            let mut hit = RayHit::none();
            let from = ray.from;
            let met = self
                .tree
                .ray_traverse(single_precision(ray), &mut hit, |ray, id| {
                    self.faces.distance(ray, id, from)
                });
            self.faces.label(met, &hit)
        };
        rays.iter().map(nearest).collect()
    }
}

impl Bounded<f64, 3> for Triangle {
    fn aabb(&self) -> Aabb<f64, 3> {
        let [a, b, c] = self.corners.map(Point3::from);
        Aabb::empty().grow(&a).grow(&b).grow(&c)
    }
}

impl BHShape<f64, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }
    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// Hierarchy of `bvh` in double precision.
pub struct Doubles {
    tree: bvh::bvh::Bvh<f64, 3>,
    triangles: Vec<Triangle>,
}

impl Doubles {
    /// Builds a hierarchy over `triangles`.
    pub fn new(triangles: &[Triangle]) -> Self {
        let mut triangles = triangles.to_vec();
        let tree = bvh::bvh::Bvh::build(&mut triangles);
        Self { tree, triangles }
    }

    /// Returns the label of the nearest face of each ray. Visits boxes from the nearest on, until they begin
    /// beyond the nearest hit.
    pub fn find_in_order(&self, rays: &[SingleRay]) -> Vec<u32> {
        let nearest = |single: &SingleRay| {
            let ray = double_precision(single);
            let mut best = (f64::INFINITY, NO_FACE);
            for triangle in self.tree.nearest_traverse_iterator(&ray, &self.triangles) {
                let enters = ray.intersection_slice_for_aabb(&triangle.aabb());
                if enters.is_some_and(|(near, _)| near > best.0) {
                    break;
                }
                keep(&mut best, triangle, &ray, single.from);
            }
            best.1
        };
        rays.iter().map(nearest).collect()
    }

    /// Returns the label of the nearest face of each ray. Visits all boxes that the ray meets.
    pub fn find_in_all(&self, rays: &[SingleRay]) -> Vec<u32> {
        let nearest = |single: &SingleRay| {
            let ray = double_precision(single);
            let mut best = (f64::INFINITY, NO_FACE);
            for triangle in self.tree.traverse_iterator(&ray, &self.triangles) {
                keep(&mut best, triangle, &ray, single.from);
            }
            best.1
        };
        rays.iter().map(nearest).collect()
    }
}

fn keep(best: &mut (f64, u32), triangle: &Triangle, ray: &bvh::ray::Ray<f64, 3>, from: u32) {
    let distance = triangle.distance(ray);
    if distance < best.0 && triangle.plane != from {
        *best = (distance, triangle.label);
    }
}

fn double_precision(ray: &SingleRay) -> bvh::ray::Ray<f64, 3> {
    bvh::ray::Ray::new(Point3::from(ray.origin), Vector3::from(ray.direction))
}
