//! Export of a scene to Mitsuba 3, so that an independent renderer can check qrt.
//!
//! The picture of qrt's scene is the expected value of Mitsuba's `path` integrator, if the
//! integrator stops at the same depth and never by chance. The export states explicitly what
//! Mitsuba does differently by default: faces are flat, or smooth by the normals that qrt uses;
//! surfaces other than dielectrics act on both sides; outside of glass there is vacuum, not air; a
//! pixel is the mean over its square; the field of view is vertical. A sun becomes a disc that is so far away that
//! directions to it differ by less than 1e-5. Its radiance includes that of the sky behind its centre: before a
//! gradient, that of a wide sun is wrong by what the sky differs over the disc. A smooth metal has the least
//! roughness of Mitsuba's `principled`, alpha = 0.001, and is as good as smooth at the size of a pixel.
//!
//! On smooth meshes the expected value differs at outlines, where the interpolated normal is behind
//! the viewer or a direction is on different sides of the face and of its normal. Mitsuba has no rule
//! for these. A smooth lamp that also reflects emits by its face's normal in qrt, by the interpolated
//! one in Mitsuba.
//!
//! <https://mitsuba.readthedocs.io/en/stable/src/generated/plugins_bsdfs.html> and the pages beside it.
//!
//! ```
//! use qrt_scene::front::parse;
//! use qrt_lab::mitsuba::{Exported, export};
//! let text = "
//! name: sky
//! camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
//! film: { width: 4, height: 2 }
//! materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
//! geometry:
//!   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
//! ";
//! let scene = parse(text, "sky.yaml", &[], "".as_ref())?;
//! let Exported { text, meshes } = export(&scene.valid, "sky")?;
//! assert!(text.contains(r#"<rgb name="radiance" value="0.25, 0.5, 1"/>"#));
//! // A lamp of four right angles needs no file.
//! assert!(meshes.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use glam::DVec3;
use qrt_drawing::escaped;
use qrt_scene::lights::Cone;
use qrt_scene::valid::{Polygon, Scatter, Surface, ValidScene};
use qrt_scene::{Camera, Checker, Film, Reflectance, Rgb, Sky};
use qrt_syntax::{Path, Problem, Renderer};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::fmt::{self, Write};

/// Default number of paths of a pixel; `-D spp=N` of the command `mitsuba` overrides it.
const SAMPLES: u32 = 256;
/// Depth from which Mitsuba may end a path by chance: greater than the depth of any path.
const NEVER: u32 = 1 << 20;
/// Distance of Mitsuba's near clipping plane, as a fraction of the distance to the farthest point.
const NEAR: f64 = 1e-6;

/// A scene in Mitsuba's format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The scene file: XML.
    pub text: String,
    /// The files that the scene file refers to, to be written into its folder.
    pub meshes: Vec<MeshFile>,
}

/// The polygons of a material, as a binary PLY file, or the sky as a Portable Float Map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshFile {
    /// Name of the file, without a folder.
    pub file: String,
    /// Contents of the file.
    pub bytes: Vec<u8>,
}

/// The kind of a material whose checker Mitsuba cannot draw on some face.
const CHECKER: &str = "checker";

/// A material that Mitsuba does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("Mitsuba has no counterpart of the {kind} material `{name}`")]
pub struct NoCounterpart {
    /// Name of the material in the scene.
    pub name: String,
    /// `phong` or `bsdf`; `checker` for one on a sphere, a disc or a slanted face.
    pub kind: &'static str,
}

impl NoCounterpart {
    fn new(surface: &Surface, kind: &'static str) -> Self {
        let name = surface.name.clone();
        Self { name, kind }
    }

    /// The problem at the material's place in the scene.
    pub fn problem(&self) -> Problem {
        let path = Path::root().key("materials").key(self.name.as_str());
        let what = Renderer::NoCounterpart {
            renderer: "Mitsuba",
            name: self.name.clone(),
            kind: self.kind,
        };
        let path = match self.kind {
            CHECKER => path,
            kind => path.key(kind),
        };
        Problem::new(path, what)
    }
}

/// Writes a scene for Mitsuba 3, version 3.0 or later, for a variant in linear RGB, for example
/// `scalar_rgb` or `llvm_ad_rgb`. The mesh files are called `STEM.N.MATERIAL.ply`.
///
/// # Errors
/// If a face has a material that Mitsuba lacks: a `phong` with a specular part, a
/// user-defined `bsdf`, or a checker on a sphere, on a disc, or where the face is not parallel to two of the
/// scene's axes.
pub fn export(scene: &ValidScene, stem: &str) -> Result<Exported, NoCounterpart> {
    let depth = scene.scene().sampling.depths.len();
    let mut text = format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<!-- Written by qrt {version}; rendered by: mitsuba -m scalar_rgb FILE -D spp=N -->
<scene version="3.0.0">
    <default name="spp" value="{SAMPLES}"/>
    <default name="sampler" value="independent"/>
    <default name="max_depth" value="{depth}"/>
    <integrator type="path">
        <integer name="max_depth" value="$max_depth"/>
        <integer name="rr_depth" value="{NEVER}"/>
    </integrator>
{sensor}"#,
        version = env!("CARGO_PKG_VERSION"),
        sensor = sensor(scene),
    );
    let mut meshes = Vec::new();
    if let Some(sky) = scene.scene().sky.filter(Sky::shines) {
        text.push_str(&emitter(&sky, stem, &mut meshes));
    }
    if let Some(sun) = scene.sun() {
        text.push_str(&sun_disc(scene, sun));
    }
    let mut faces_of: Vec<Vec<Face<'_>>> = vec![Vec::new(); scene.surfaces().len()];
    let mut smooth = scene.smooth_faces().iter().peekable();
    let mut coloured = scene.coloured_faces().iter().peekable();
    for (number, polygon) in scene.polygons().iter().enumerate() {
        let smooth = smooth.next_if(|face| face.polygon == number);
        let coloured = coloured.next_if(|face| face.polygon == number);
        if let Some(faces) = faces_of.get_mut(polygon.surface as usize) {
            let normals = smooth.map(|face| face.normals);
            let colours = coloured.map(|face| face.colours);
            faces.push(Face {
                polygon,
                normals,
                colours,
            });
        }
    }
    let used = scene.surfaces().iter().zip(&faces_of).enumerate();
    for (index, (surface, faces)) in used.filter(|(_, (_, faces))| !faces.is_empty()) {
        // Mitsuba samples the points of a rectangle as evenly as its sampler's numbers are
        // distributed.
        let checker = surface.checker();
        let is_lamp = |face: &&Face<'_>| {
            surface.emits() && checker.is_none() && is_parallelogram(face.polygon)
        };
        let is_alone = |face: &&Face<'_>| face.polygon.disc || is_lamp(face);
        let (alone, faces): (Vec<&Face<'_>>, Vec<&Face<'_>>) = faces.iter().partition(is_alone);
        // The texture coordinates of Mitsuba's discs are polar.
        if checker.is_some() && alone.iter().any(|face| face.polygon.disc) {
            return Err(NoCounterpart::new(surface, CHECKER));
        }
        let is_coloured = faces.iter().any(|face| face.colours.is_some());
        let plain_material = material(surface, false)?;
        for face in alone {
            let kind = if face.polygon.disc {
                "disk"
            } else {
                "rectangle"
            };
            let shape = format!(
                "    <shape type=\"{kind}\">\n        <transform name=\"to_world\"><matrix value=\"{}\"/></transform>\n",
                square_to(face.polygon)
            );
            text.push_str(&(shape + &plain_material));
        }
        if faces.is_empty() {
            continue;
        }
        let file = format!("{stem}.{}.{}.ply", index + 1, plain(&surface.name));
        let is_smooth = faces.iter().any(|face| face.normals.is_some());
        let shape = format!(
            "    <shape type=\"ply\">\n        <string name=\"filename\" value=\"{}\"/>\n        \
             <boolean name=\"face_normals\" value=\"{}\"/>\n",
            escaped(&file),
            !is_smooth
        );
        text.push_str(&(shape + &material(surface, is_coloured)?));
        meshes.push(MeshFile {
            file,
            bytes: {
                let cells = faces.iter().map(|face| match checker {
                    None => Some(None),
                    Some(checker) => cells(checker, face.polygon).map(Some),
                });
                let Some(cells) = cells.collect::<Option<Vec<_>>>() else {
                    return Err(NoCounterpart::new(surface, CHECKER));
                };
                let tint = surface.tint().filter(|_| is_coloured);
                ply(&faces, &cells, is_smooth, tint.map(one_colour))
            },
        });
    }
    for ball in scene.balls() {
        let shape = format!(
            "    <shape type=\"sphere\">\n        <point name=\"center\" value=\"{}\"/>\n        \
             <float name=\"radius\" value=\"{}\"/>\n",
            triple(ball.centre.to_array()),
            Number(ball.radius)
        );
        let surface = &scene.surfaces()[ball.surface as usize];
        if surface.checker().is_some() {
            return Err(NoCounterpart::new(surface, CHECKER));
        }
        text.push_str(&(shape + &material(surface, false)?));
    }
    text.push_str("</scene>\n");
    Ok(Exported { text, meshes })
}

/// Rows of the picture of a sky: enough for bilinear interpolation to be off by less than 1e-6 of the
/// greatest radiance.
const SKY_ROWS: usize = 1024;

/// Returns the XML of a sky. Mitsuba reads a gradient from a picture, which is added to `files`.
fn emitter(sky: &Sky, stem: &str, files: &mut Vec<MeshFile>) -> String {
    let [horizon, zenith] = sky.gradient();
    if horizon == zenith {
        return format!(
            "    <emitter type=\"constant\"><rgb name=\"radiance\" value=\"{}\"/></emitter>\n",
            triple(horizon)
        );
    }
    // A Portable Float Map: rows from the bottom to the top.
    let mut bytes = format!("PF\n4 {SKY_ROWS}\n-1.0\n").into_bytes();
    for row in (0..SKY_ROWS).rev() {
        // Mitsuba's first and last rows are the poles.
        let height = (PI * row as f64 / (SKY_ROWS - 1) as f64).cos().max(0.0);
        for _ in 0..4 {
            for (horizon, zenith) in horizon.into_iter().zip(zenith) {
                let value = horizon + height * (zenith - horizon);
                bytes.extend((value as f32).to_le_bytes());
            }
        }
    }
    let file = format!("{stem}.sky.pfm");
    // The picture's up is y.
    let up = sky.upwards();
    let side = if up.x.abs() < 0.5 { DVec3::X } else { DVec3::Z };
    let x = (side - up * side.dot(up)).normalize();
    let columns = [x, up, x.cross(up)];
    let rows = (0..3).map(|row| {
        let row = columns.map(|column| Number(column[row]).to_string());
        row.join(" ") + " 0"
    });
    let rows: Vec<String> = rows.collect();
    let text = format!(
        "    <emitter type=\"envmap\">\n        <string name=\"filename\" value=\"{}\"/>\n        \
         <transform name=\"to_world\"><matrix value=\"{} 0 0 0 1\"/></transform>\n    </emitter>\n",
        escaped(&file),
        rows.join(" ")
    );
    files.push(MeshFile { file, bytes });
    text
}

/// Distance of a sun's disc in Mitsuba, in distances from the eye to the scene's farthest corner: seen from any
/// point of the scene, the disc is in the same directions up to 1e-5.
const SUN_DISTANCE: f64 = 1e5;

/// Returns the XML of a sun: Mitsuba has no cone of directions, so a far disc shines. It hides the sky behind it, and
/// so has its radiance, too: that at the centre.
fn sun_disc(scene: &ValidScene, (cone, radiance): (Cone, Rgb)) -> String {
    let distance = SUN_DISTANCE * farthest(scene);
    let radius = distance * cone.sin / (1.0 - cone.cap);
    let [x, y] = cone.across.map(|across| across * radius);
    let centre = eye(scene) + cone.axis * distance;
    let mut radiance = radiance;
    if let Some(sky) = scene.scene().sky {
        let [horizon, zenith] = sky.gradient();
        let height = sky.upwards().dot(cone.axis).max(0.0);
        for (channel, radiance) in radiance.iter_mut().enumerate() {
            *radiance += horizon[channel] + height * (zenith[channel] - horizon[channel]);
        }
    }
    format!(
        "    <shape type=\"disk\">\n        <transform name=\"to_world\"><matrix value=\"{}\"/></transform>\n        \
         <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0, 0, 0\"/></bsdf>\n        \
         <emitter type=\"area\"><rgb name=\"radiance\" value=\"{}\"/></emitter>\n    </shape>\n",
        matrix([x, -y, -cone.axis, centre]),
        triple(radiance)
    )
}

/// Returns a name that is valid as a file name on every system.
fn plain(name: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || c == '-' {
            c
        } else {
            '_'
        }
    };
    name.chars().take(40).map(plain).collect()
}

/// Returns the place of the camera.
fn eye(scene: &ValidScene) -> DVec3 {
    match &scene.scene().camera {
        Camera::Perspective(camera) => camera.eye,
        Camera::Orthographic(camera) => camera.eye,
    }
}

/// Returns the distance from the camera to the farthest corner of the scene, or 1 if that is more.
fn farthest(scene: &ValidScene) -> f64 {
    let eye = eye(scene);
    let distances = scene.extent().map(|corner| (corner - eye).length());
    distances.fold(1.0, f64::max)
}

fn sensor(scene: &ValidScene) -> String {
    let Film { width, height } = scene.scene().film;
    let camera = &scene.scene().camera;
    let eye = eye(scene);
    let (target, up) = match camera {
        Camera::Perspective(c) => (c.target, c.up),
        Camera::Orthographic(c) => (c.target, c.up),
    };
    let farthest = farthest(scene);
    // A sun's disc is farther away, and its edge farther than its centre.
    let beyond = match scene.sun() {
        Some((cone, _)) => SUN_DISTANCE / (1.0 - cone.cap),
        None => 1.0,
    };
    let (kind, view, scale) = match camera {
        Camera::Perspective(camera) => {
            let view = format!(
                "        <string name=\"fov_axis\" value=\"y\"/>\n        \
                 <float name=\"fov\" value=\"{}\"/>\n",
                Number(camera.vfov)
            );
            match camera.lens {
                None => ("perspective", view, String::new()),
                Some(lens) => {
                    let lens = format!(
                        "{view}        <float name=\"aperture_radius\" value=\"{}\"/>\n        \
                         <float name=\"focus_distance\" value=\"{}\"/>\n",
                        Number(0.5 * lens.aperture),
                        Number(lens.focus)
                    );
                    ("thinlens", lens, String::new())
                }
            }
        }
        Camera::Orthographic(camera) => {
            // Mitsuba's film spans -1 to 1 in width.
            let half = 0.5 * camera.height * f64::from(width) / f64::from(height);
            let scale = format!("            <scale x=\"{0}\" y=\"{0}\"/>\n", Number(half));
            ("orthographic", String::new(), scale)
        }
    };
    format!(
        r#"    <sensor type="{kind}">
{view}        <float name="near_clip" value="{near}"/>
        <float name="far_clip" value="{far}"/>
        <transform name="to_world">
{scale}            <lookat origin="{eye}" target="{target}" up="{up}"/>
        </transform>
        <sampler type="$sampler">
            <integer name="sample_count" value="$spp"/>
        </sampler>
        <film type="hdrfilm">
            <integer name="width" value="{width}"/>
            <integer name="height" value="{height}"/>
            <string name="pixel_format" value="rgb"/>
            <string name="component_format" value="float32"/>
            <rfilter type="box"/>
        </film>
    </sensor>
"#,
        near = Number(NEAR * farthest),
        far = Number(2.0 * farthest * beyond),
        eye = triple(eye.to_array()),
        target = triple(target.to_array()),
        up = triple(up.to_array()),
    )
}

/// A texture coordinate: half of a corner's coordinate in cells, with a constant added.
#[derive(Clone, Copy)]
struct Cell {
    axis: usize,
    density: f64,
    shift: f64,
}

impl Cell {
    fn at(self, corner: DVec3) -> f64 {
        corner[self.axis] * self.density + self.shift
    }
}

/// The texture coordinates of a face in one layer of cells: Mitsuba's checkerboard has two cells per
/// unit. `None` if the face crosses layers along all axes, or along one alone.
fn cells(checker: &Checker, face: &Polygon) -> Option<[Cell; 2]> {
    let layers = checker.layers(face.outline());
    let axes: Vec<usize> = (0..3).filter(|&axis| layers[axis].is_none()).collect();
    let odd = layers
        .iter()
        .flatten()
        .filter(|&&layer| Checker::is_odd(layer));
    let [first, second] = axes[..] else {
        return None;
    };
    let cell = |axis, shift| Cell {
        axis,
        density: 0.5 / checker.scale,
        shift,
    };
    let shift = if odd.count() % 2 == 1 { 0.5 } else { 0.0 };
    Some([cell(first, shift), cell(second, 0.0)])
}

/// Returns whether a face is a parallelogram, up to rounding.
fn is_parallelogram(face: &Polygon) -> bool {
    let [v0, v1, v2, v3] = face.vertices;
    face.corners == 4 && (v0 + v2 - v1 - v3).length() <= 1e-9 * (v2 - v0).length()
}

/// Returns the matrix, by rows, that maps the square from -1 to 1, whose normal is z, to a
/// parallelogram, and the unit disc to the disc in it.
fn square_to(face: &Polygon) -> String {
    let [v0, v1, _, v3] = face.vertices;
    let (x, y) = (0.5 * (v1 - v0), 0.5 * (v3 - v0));
    matrix([x, y, x.cross(y).normalize(), v0 + x + y])
}

/// Returns a matrix with these columns, by rows.
fn matrix(columns: [DVec3; 4]) -> String {
    let rows = (0..3).map(|row| {
        let row = columns.map(|column| Number(column[row]).to_string());
        row.join(" ")
    });
    let rows: Vec<String> = rows.collect();
    format!("{} 0 0 0 1", rows.join(" "))
}

/// The albedo or reflectance of a surface without a checker.
fn one_colour(tint: &Reflectance) -> Rgb {
    tint.colours().first().copied().unwrap_or_default()
}

/// Returns the XML of a surface's material and emitter, and the end tag of the shape. If `is_coloured`, the albedo or
/// reflectance is that of the shape's vertices.
fn material(surface: &Surface, is_coloured: bool) -> Result<String, NoCounterpart> {
    let colour =
        |name: &str, value: Rgb| format!(r#"<rgb name="{name}" value="{}"/>"#, triple(value));
    let reflected = |name: &str, value: Reflectance| match value.checker() {
        None if is_coloured => format!(
            r#"<texture type="mesh_attribute" name="{name}"><string name="name" value="vertex_color"/></texture>"#
        ),
        None => colour(name, one_colour(&value)),
        Some(&Checker {
            of: [first, second],
            ..
        }) => format!(
            r#"<texture type="checkerboard" name="{name}">{}{}</texture>"#,
            colour("color0", first),
            colour("color1", second)
        ),
    };
    let diffuse = |albedo: Reflectance| {
        format!(
            r#"<bsdf type="diffuse">{}</bsdf>"#,
            reflected("reflectance", albedo)
        )
    };
    let conductor = |kind: &str, more: &str, reflectance: Reflectance| {
        format!(
            r#"<bsdf type="{kind}"><string name="material" value="none"/>{more}{}</bsdf>"#,
            reflected("specular_reflectance", reflectance)
        )
    };
    let none = |kind| NoCounterpart::new(surface, kind);
    let two_sided = |bsdf: String| format!(r#"<bsdf type="twosided">{bsdf}</bsdf>"#);
    let bsdf = match &surface.scatter {
        Scatter::Black => two_sided(diffuse([0.0; 3].into())),
        Scatter::Lambertian(matte) => two_sided(diffuse(matte.albedo)),
        Scatter::Phong(phong) if phong.specular == [0.0; 3] => {
            two_sided(diffuse(phong.diffuse.into()))
        }
        Scatter::Mirror(mirror) => two_sided(conductor("conductor", "", mirror.reflectance)),
        Scatter::Ggx(ggx) => {
            let more = format!(
                r#"<string name="distribution" value="ggx"/><float name="alpha" value="{}"/>"#,
                Number(ggx.alpha)
            );
            two_sided(conductor("roughconductor", &more, ggx.reflectance))
        }
        Scatter::Dielectric(glass) => {
            let through = match glass.transmittance {
                [1.0, 1.0, 1.0] => String::new(),
                through => colour("specular_transmittance", through),
            };
            format!(
                r#"<bsdf type="dielectric"><float name="int_ior" value="{}"/><float name="ext_ior" value="1"/>{through}</bsdf>"#,
                Number(glass.ior)
            )
        }
        // Mitsuba's conductors have the exact Fresnel formula; its `principled` metal has Schlick's. The
        // alpha of `principled` is the square of its roughness.
        Scatter::Metal(metal) => two_sided(format!(
            r#"<bsdf type="principled">{}<float name="metallic" value="1"/><float name="roughness" value="{}"/></bsdf>"#,
            reflected("base_color", metal.reflectance),
            Number(metal.alpha.sqrt())
        )),
        Scatter::Phong(_) => return Err(none("phong")),
        Scatter::Custom(_) => return Err(none("bsdf")),
    };
    let mut text = format!("        {bsdf}\n");
    if surface.emits() {
        let radiance = colour("radiance", surface.radiance);
        let _ = writeln!(text, r#"        <emitter type="area">{radiance}</emitter>"#);
    }
    text.push_str("    </shape>\n");
    Ok(text)
}

fn triple(value: [f64; 3]) -> String {
    let [x, y, z] = value.map(Number);
    format!("{x}, {y}, {z}")
}

/// A number with all its digits: in scientific notation where many zeros would be needed otherwise.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 0.0 || (1e-5..1e16).contains(&self.0.abs()) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

/// A polygon, with the normals of its corners if it is smooth, and with their colours if it has any.
#[derive(Clone, Copy)]
struct Face<'a> {
    polygon: &'a Polygon,
    normals: Option<[DVec3; 3]>,
    colours: Option<[Rgb; 3]>,
}

impl Face<'_> {
    /// The normal of each corner: of a flat face its own.
    fn normals(&self) -> [DVec3; 4] {
        let [a, b, c, _] = self.polygon.vertices;
        match self.normals {
            Some([a, b, c]) => [a, b, c, c],
            None => [(b - a).cross(c - a).normalize(); 4],
        }
    }

    /// The `tint` of each corner: times its colour, if it has one.
    fn tints(&self, tint: Rgb) -> [Rgb; 4] {
        let [a, b, c] = self.colours.unwrap_or([[1.0; 3]; 3]);
        [a, b, c, c].map(|colour| std::array::from_fn(|k| tint[k] * colour[k]))
    }
}

/// Writes a binary PLY file of triangles: their corners, with normals if `has_normals`, with texture
/// coordinates by the `cells` of the faces, and with the colours of corners times `tint` if there is one. Equal
/// vertices are shared. A quad is split along v0 - v2.
fn ply(
    faces: &[&Face<'_>],
    cells: &[Option<[Cell; 2]>],
    has_normals: bool,
    tint: Option<Rgb>,
) -> Vec<u8> {
    let mut vertices: Vec<Vec<f64>> = Vec::new();
    let mut numbers = HashMap::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for (face, cells) in faces.iter().zip(cells) {
        let tints = face.tints(tint.unwrap_or([1.0; 3]));
        let corners = face.polygon.outline().iter().zip(face.normals());
        let corners = corners.zip(tints).map(|((&corner, normal), colour)| {
            let normal = has_normals.then(|| normal.to_array());
            let uv = cells.map(|cells| cells.map(|cell| cell.at(corner)));
            let mut vertex = corner.to_array().to_vec();
            vertex.extend(normal.into_iter().flatten());
            vertex.extend(uv.into_iter().flatten());
            vertex.extend(tint.map(|_| colour).into_iter().flatten());
            let key: Vec<u64> = vertex.iter().map(|x| x.to_bits()).collect();
            *numbers.entry(key).or_insert_with(|| {
                vertices.push(vertex);
                (vertices.len() - 1) as u32
            })
        });
        let corners: Vec<u32> = corners.collect();
        if let Some((&first, rest)) = corners.split_first() {
            triangles.extend(rest.windows(2).map(|pair| [first, pair[0], pair[1]]));
        }
    }
    let has_uv = cells.iter().any(Option::is_some);
    let names = [
        ("x y z", true),
        ("nx ny nz", has_normals),
        ("u v", has_uv),
        ("r g b", tint.is_some()),
    ];
    let names = names.into_iter().filter(|(_, is_there)| *is_there);
    let names = names.flat_map(|(names, _)| names.split(' '));
    let properties: Vec<String> = names
        .map(|name| format!("property double {name}\n"))
        .collect();
    let properties = properties.concat();
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}element face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    for value in vertices.into_iter().flatten() {
        bytes.extend(value.to_le_bytes());
    }
    for triangle in &triangles {
        bytes.push(3);
        for corner in triangle {
            bytes.extend(corner.to_le_bytes());
        }
    }
    bytes
}
