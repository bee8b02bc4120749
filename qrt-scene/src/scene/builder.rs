//! Scenes written in Rust, part by part.

use super::{
    Accuracy, Budget, Camera, Circuit, Comparator, Counting, Cuboid, DepthSampling, Disc, Film,
    Geometry, Map, Material, Mesh, Orthographic, Perspective, Precision, Quad, Sampling, Scene,
    Sky, Sphere, Sun, Triangle,
};
use glam::DVec3;

impl Default for Perspective {
    /// Looks from (0, 0, 5) to the origin, with up along y and a vertical field of view of 45
    /// degrees.
    fn default() -> Self {
        Self {
            eye: DVec3::new(0.0, 0.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            vfov: 45.0,
            lens: None,
        }
    }
}

impl Default for Orthographic {
    /// Looks from (0, 0, 5) to the origin, with up along y and a film 4 scene units high.
    fn default() -> Self {
        Self {
            eye: DVec3::new(0.0, 0.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            height: 4.0,
        }
    }
}

impl Default for Camera {
    /// Returns [`Perspective::default`].
    fn default() -> Self {
        Self::Perspective(Perspective::default())
    }
}

impl Default for Film {
    /// 64 x 64 pixels.
    fn default() -> Self {
        Self {
            width: 64,
            height: 64,
        }
    }
}

impl Default for DepthSampling {
    /// Returns [`DepthSampling::of_bits`] with 8 bits each, the default of a scene.
    fn default() -> Self {
        Self::of_bits([8, 8])
    }
}

impl Default for Mesh {
    /// Creates a mesh without a transform, with the materials of its file, which must be set.
    fn default() -> Self {
        Self {
            obj: None,
            ply: None,
            gltf: None,
            material: None,
            smooth: None,
            colors: None,
            scale: 1.0,
            rotate: DVec3::ZERO,
            translate: DVec3::ZERO,
        }
    }
}

impl Default for Scene {
    /// Creates an empty scene with the default camera and film, to start a scene in Rust from.
    fn default() -> Self {
        Self {
            name: "scene".to_owned(),
            camera: Camera::default(),
            film: Film::default(),
            sky: None,
            sun: None,
            materials: Vec::new(),
            geometry: Vec::new(),
            sampling: Sampling::default(),
            precision: Precision::default(),
            comparator: Comparator::default(),
            counting: Counting::default(),
            circuit: Circuit::default(),
            accuracy: None,
            budget: None,
        }
    }
}

/// A scene under construction: see [`Scene::builder`].
#[derive(Clone, Debug, PartialEq)]
#[must_use = "a builder makes a scene by `build`"]
pub struct SceneBuilder(Scene);

impl Scene {
    /// Begins a scene called `name`, in which everything that is not set has its default.
    ///
    /// A [`Scene`] is plain data: its fields can be changed after building, and a builder can start
    /// from a scene ([`SceneBuilder::from`]). Nothing is checked before [`Scene::validate`].
    ///
    /// ```
    /// use qrt_scene::{DepthSampling, Emitter, Lambertian, Perspective, Sampling, Scene};
    ///
    /// let scene = Scene::builder("lit floor")
    ///     .camera(Perspective { eye: [0.0, 1.0, 2.0].into(), ..Perspective::default() })
    ///     .film(8, 6)
    ///     .material("floor", Lambertian { albedo: [0.8, 0.5, 0.2].into() })
    ///     .material("sky", Emitter { radiance: [1.0; 3], albedo: [0.0; 3].into() })
    ///     .quad("floor", [[-9., 0., 9.], [9., 0., 9.], [9., 0., -9.], [-9., 0., -9.]])
    ///     .quad("sky", [[-9., 5., -9.], [9., 5., -9.], [9., 5., 9.], [-9., 5., 9.]])
    ///     .sampling(Sampling {
    ///         path_bits: 8,
    ///         depths: vec![DepthSampling::of_bits([8, 8]); 2],
    ///         ..Sampling::default()
    ///     })
    ///     .build();
    /// let mut larger = scene.clone();
    /// larger.film.width = 80;
    ///
    /// // Checked, it can be compiled and rendered.
    /// let valid = scene.clone().validate("".as_ref())?;
    /// assert_eq!(valid.polygons().len(), 2);
    /// // Written, it is a scene file.
    /// assert_eq!(Scene::from_yaml(&scene.to_string(), "floor.yaml")?, scene);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn builder(name: impl Into<String>) -> SceneBuilder {
        SceneBuilder(Self {
            name: name.into(),
            ..Self::default()
        })
    }
}

impl std::fmt::Display for Scene {
    /// Writes the scene as YAML: [`Scene::to_yaml`].
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.to_yaml())
    }
}

impl From<Scene> for SceneBuilder {
    /// Continues building from `scene`.
    fn from(scene: Scene) -> Self {
        Self(scene)
    }
}

impl SceneBuilder {
    /// Sets the camera: a [`Perspective`] or an [`Orthographic`].
    pub fn camera(mut self, camera: impl Into<Camera>) -> Self {
        self.0.camera = camera.into();
        self
    }

    /// Sets the size of the picture in pixels.
    pub fn film(mut self, width: u32, height: u32) -> Self {
        self.0.film = Film { width, height };
        self
    }

    /// Adds a material called `name`, or replaces the one of that name.
    pub fn material(mut self, name: &str, material: impl Into<Material>) -> Self {
        let material = material.into();
        let materials = &mut self.0.materials;
        match materials.iter_mut().find(|(known, _)| known == name) {
            Some((_, known)) => *known = material,
            None => materials.push((name.to_owned(), material)),
        }
        self
    }

    /// Adds a primitive or a mesh.
    pub fn geometry(mut self, geometry: impl Into<Geometry>) -> Self {
        self.0.geometry.push(geometry.into());
        self
    }

    /// Adds a convex quadrilateral of a material, by four points around its outline.
    pub fn quad<V: Into<DVec3>>(self, material: &str, vertices: [V; 4]) -> Self {
        self.geometry(Quad::new(vertices.map(Into::into), material))
    }

    /// Adds a triangle of a material, by three points.
    pub fn triangle<V: Into<DVec3>>(self, material: &str, vertices: [V; 3]) -> Self {
        self.geometry(Triangle::new(vertices.map(Into::into), material))
    }

    /// Adds a sphere of a material.
    pub fn sphere(self, material: &str, center: impl Into<DVec3>, radius: f64) -> Self {
        self.geometry(Sphere::new(center.into(), radius, material))
    }

    /// Adds a disc of a material, whose front faces along `normal`.
    pub fn disc(
        self,
        material: &str,
        center: impl Into<DVec3>,
        normal: impl Into<DVec3>,
        radius: f64,
    ) -> Self {
        self.geometry(Disc::new(center.into(), normal.into(), radius, material))
    }

    /// Adds a box of a material along the axes, by its corners with the least and the greatest
    /// coordinates. Pass a [`Cuboid`] to [`SceneBuilder::geometry`] for a box that is moved.
    pub fn cuboid(self, material: &str, min: impl Into<DVec3>, max: impl Into<DVec3>) -> Self {
        self.geometry(Cuboid {
            min: min.into(),
            max: max.into(),
            scale: 1.0,
            rotate: DVec3::ZERO,
            translate: DVec3::ZERO,
            material: material.to_owned(),
        })
    }

    /// Sets the light of directions in which nothing stands.
    pub fn sky(mut self, sky: Sky) -> Self {
        self.0.sky = Some(sky);
        self
    }

    /// Sets the lamp that is infinitely far away.
    pub fn sun(mut self, sun: Sun) -> Self {
        self.0.sun = Some(sun);
        self
    }

    /// Sets the paths of a pixel.
    pub fn sampling(mut self, sampling: Sampling) -> Self {
        self.0.sampling = sampling;
        self
    }

    /// Sets the number of rays on each path, each with 8 bits per coordinate and each material's
    /// own map.
    pub fn depth(mut self, rays: usize) -> Self {
        self.0.sampling.depths = vec![DepthSampling::default(); rays];
        self
    }

    /// Sets the number of paths of a pixel to R = 2^`path_bits`.
    pub fn path_bits(mut self, path_bits: u32) -> Self {
        self.0.sampling.path_bits = path_bits;
        self
    }

    /// Sets the map of all rays but the primary one.
    pub fn map(mut self, map: Map) -> Self {
        for depth in self.0.sampling.depths.iter_mut().skip(1) {
            depth.map = map;
        }
        self
    }

    /// Sets the number of fraction bits of the circuit's numbers.
    pub fn fraction(mut self, bits: u32) -> Self {
        self.0.precision.fraction = Some(bits);
        self
    }

    /// Sets the comparator register.
    pub fn comparator(mut self, comparator: Comparator) -> Self {
        self.0.comparator = comparator;
        self
    }

    /// Sets the method of counting the good path indices.
    pub fn counting(mut self, counting: Counting) -> Self {
        self.0.counting = counting;
        self
    }

    /// Sets the layout of the circuit.
    pub fn circuit(mut self, circuit: Circuit) -> Self {
        self.0.circuit = circuit;
        self
    }

    /// Sets the required accuracy, which replaces path bits, precision, comparator and counting.
    pub fn accuracy(mut self, accuracy: Accuracy) -> Self {
        self.0.accuracy = Some(accuracy);
        self
    }

    /// Sets limits on the circuit's cost.
    pub fn budget(mut self, budget: Budget) -> Self {
        self.0.budget = Some(budget);
        self
    }

    /// Returns the scene, not yet checked: see [`Scene::validate`].
    pub fn build(self) -> Scene {
        self.0
    }
}
