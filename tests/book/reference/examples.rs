//! An example of each block of a scene.

/// Blocks and examples of them; `book_listings` checks that each is a part of a scene.
pub(crate) const EXAMPLES: [(&str, &str); 14] = [
    ("name", "name: first-scene\n"),
    (
        "camera",
        "\
camera:
  perspective: { eye: [0, 1, 4], target: [0, 1, 0], vfov: 40, lens: { aperture: 0.1, focus: 4 } }
",
    ),
    ("film", "film: { width: 64, height: 48 }\n"),
    (
        "sky",
        "sky: { horizon: [1, 1, 1], zenith: [0.5, 0.7, 1] }\n",
    ),
    (
        "sun",
        "sun: { direction: [-1, 2, 1], angle: 0.53, radiance: [60000, 55000, 50000] }\n",
    ),
    (
        "materials",
        "\
materials:
  white: { lambertian: { albedo: [0.7, 0.7, 0.7] } }
  lamp: { emitter: { radiance: [16, 14, 11] } }
  silver: { mirror: { reflectance: [0.95, 0.93, 0.88] } }
  glass: { dielectric: { ior: 1.5, transmittance: [0.9, 1, 0.9] } }
  satin: { ggx: { alpha: 0.2, reflectance: [0.9, 0.7, 0.5] } }
  gold: { metal: { reflectance: [1, 0.8, 0.3], alpha: 0.1 } }
  vinyl: { phong: { diffuse: [0.4, 0.1, 0.1], specular: [0.5, 0.5, 0.5], exponent: 20 } }
  velvet:
    bsdf:
      map: [\"sqrt(1 - u^2) * cos(2*pi*v)\", \"sqrt(1 - u^2) * sin(2*pi*v)\", \"u\"]
      value: \"0.1/pi + 2 * (1 - cos_i)^3 * (1 - cos_o)^3\"
",
    ),
    (
        "geometry",
        "\
geometry:
  - quad:
      vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]]
      material: white
  - triangle: { vertices: [[0, 1, 0], [1, 1, 0], [0, 2, 0]], material: lamp }
  - sphere: { center: [0, 1, 0], radius: 1, material: white }
  - disc: { center: [0, 3, 0], normal: [0, -1, 0], radius: 0.5, material: lamp }
  - box: { min: [-1, 0, -1], max: [1, 2, 1], material: white, rotate: [0, 30, 0] }
  - mesh: { obj: meshes/knot.obj, material: white, scale: 0.5, translate: [0, 1, 0] }
",
    ),
    (
        "sampling",
        "\
sampling:
  path_bits: 14
  lights: none
  depths:
    - { bits: [8, 8] }
    - { bits: [8, 8], map: cosine-hemisphere }
",
    ),
    ("precision", "precision: { fraction: 18 }\n"),
    ("comparator", "comparator: { bits: 12, at: edges }\n"),
    (
        "counting",
        "counting: { phase_bits: 10, repetitions: 3, estimator: paper }\n",
    ),
    ("circuit", "circuit: { uncompute: scoped }\n"),
    ("accuracy", "accuracy: { error: 0.05, confidence: 0.95 }\n"),
    ("budget", "budget: { qubits: 2000, toffoli: 1000000 }\n"),
];

/// Chapters that explain a block further.
pub(crate) const CHAPTERS: [(&str, &str, &str); 11] = [
    ("camera", "Rays in superposition", "superposition.md"),
    ("sky", "Spheres, a sky and a lens", "spheres.md"),
    ("sun", "Light sampling", "lights.md"),
    ("materials", "Shading and materials", "shading.md"),
    ("geometry", "Find intersection", "intersection.md"),
    ("sampling", "Dense sampling", "sampling.md"),
    ("comparator", "The comparator", "comparator.md"),
    ("counting", "Estimators", "estimators.md"),
    ("circuit", "Phase oracle and uncomputation", "oracle.md"),
    ("accuracy", "Speed against accuracy", "accuracy.md"),
    ("budget", "Cost: space, time, Toffolis", "cost.md"),
];
