//! Names that other renderers use, with what the scene language says instead.

use super::name::nearest;

/// The answer to a word: what a scene has in its place.
#[derive(Clone, Copy, Debug)]
enum Here {
    /// The word that stands in the same place.
    Name(&'static str),
    /// A sentence.
    Words(&'static str),
}

use Here::{Name, Words};

/// Parts of a scene, words of other renderers for one of their keys or kinds, and the answer. Words are in small
/// letters, without `_` and `-`.
#[rustfmt::skip]
const ROWS: &[(&str, &[&str], Here)] = &[
    ("the scene", &["sensor", "view", "cameras"], Name("camera")),
    ("the scene", &["image", "resolution", "width", "height", "imagewidth", "imageheight", "screen"],
        Words("write `film: { width: 640, height: 480 }`")),
    ("the scene", &["environment", "background", "envmap", "env", "skylight", "hdri"], Name("sky")),
    ("the scene", &["bsdfs", "brdfs", "shaders", "surfaces"], Name("materials")),
    ("the scene", &["objects", "shapes", "primitives", "meshes", "entities", "models", "spheres"], Name("geometry")),
    ("the scene", &["sampler", "render", "settings"], Name("sampling")),
    ("the scene", &["light", "lights", "lamps", "emitters"],
        Words("a lamp is a primitive whose material is an `emitter`")),
    ("the scene", &["sunlight", "sunsky", "sunlamp"], Name("sun")),
    ("the scene", &["directional", "directionallight", "distant", "distantlight"],
        Words("write `sun`, whose `direction` points towards it")),
    ("the scene", &["spp", "samples", "samplesperpixel", "paths"],
        Words("write `path_bits` in `sampling`: a pixel has 2^path_bits paths")),
    ("the scene", &["maxdepth", "depth", "bounces", "maxbounces", "depths", "integrator"],
        Words("write `depths` in `sampling`: the number of rays of a path, or an entry for each")),
    ("the scene", &["textures", "texture"], Words("a colour is one, or a `checker`: pictures on surfaces are not drawn")),
    ("a camera", &["pinhole", "persp", "projective", "thinlens"], Name("perspective")),
    ("a camera", &["ortho", "parallel"], Name("orthographic")),
    ("a camera", &["fov", "vfov", "eye", "position", "origin", "from", "lookfrom", "lookat", "target", "lens"],
        Words("it goes into the map of the kind: `perspective: { eye: [..], target: [..], vfov: 40 }`")),
    ("a perspective camera", &["fov", "fovy", "yfov", "fieldofview", "verticalfov"], Name("vfov")),
    ("a perspective camera", &["xfov", "hfov", "fovx", "horizontalfov", "focallength"],
        Words("`vfov` is the angle from the bottom of the film to its top, in degrees")),
    ("a perspective camera",
        &["position", "pos", "origin", "from", "lookfrom", "location", "center", "centre"], Name("eye")),
    ("a perspective camera", &["lookat", "at", "to", "look", "interest"], Name("target")),
    ("a perspective camera", &["vup", "upvector"], Name("up")),
    ("a perspective camera",
        &["aperture", "apertureradius", "focus", "focusdist", "focusdistance", "focaldistance", "defocusangle", "dof"],
        Words("write `lens: { aperture: 0.1, focus: 10 }`")),
    ("a perspective camera", &["aspect", "aspectratio"], Words("pixels are squares: `film` gives the aspect")),
    ("an orthographic camera", &["position", "pos", "origin", "from", "lookfrom", "location"], Name("eye")),
    ("an orthographic camera", &["lookat", "at", "to", "look"], Name("target")),
    ("an orthographic camera", &["scale", "size", "ymag", "orthoscale"], Name("height")),
    ("a lens", &["radius", "apertureradius", "lensradius"],
        Words("`aperture` is the diameter of the lens, twice its radius")),
    ("a lens", &["fstop", "fnumber"], Words("`aperture` is the diameter of the lens, in scene units")),
    ("a lens", &["diameter"], Name("aperture")),
    ("a lens", &["distance", "focusdistance", "focusdist", "focaldistance", "dist"], Name("focus")),
    ("the film", &["w", "xresolution", "xres", "imagewidth", "columns"], Name("width")),
    ("the film", &["h", "yresolution", "yres", "imageheight", "rows"], Name("height")),
    ("the film", &["resolution", "size"], Words("write `width` and `height`, in pixels")),
    ("the sky", &["color", "colour", "intensity", "emission", "strength", "value"], Name("radiance")),
    ("the sky", &["top", "high"], Name("zenith")),
    ("the sky", &["bottom", "low"], Name("horizon")),
    ("the sky", &["file", "filename", "map", "hdri", "texture"],
        Words("qrt reads no pictures: write `radiance`, or `horizon` and `zenith`")),
    ("the sun", &["color", "colour", "intensity", "emission", "strength", "value"], Name("radiance")),
    ("the sun", &["irradiance"], Words("write `radiance`: irradiance over pi sin(angle / 2)^2")),
    ("the sun", &["size", "diameter", "angulardiameter", "aperture"], Name("angle")),
    ("the sun", &["radius", "angularradius", "halfangle", "sunradius"],
        Words("`angle` is the angular diameter of the sun in degrees, twice its radius")),
    ("the sun", &["dir", "towards", "position", "sundirection"], Name("direction")),
    ("the sun", &["from", "to", "target", "lookat"],
        Words("write `direction`: from the scene towards the sun")),
    ("a material", &["diffuse", "matte", "lambert", "lambertianreflection", "orennayar"], Name("lambertian")),
    ("a material", &["plastic", "roughplastic", "glossy", "blinnphong"], Name("phong")),
    ("a material", &["specular", "reflective"], Name("mirror")),
    ("a material", &["conductor", "roughconductor", "coatedconductor", "roughmetal", "chrome"], Name("metal")),
    ("a material", &["microfacet", "trowbridgereitz"], Name("ggx")),
    ("a material", &["principled", "principledbsdf", "disney", "pbr", "uber", "standard", "standardsurface", "coateddiffuse"],
        Words("take `metal`, `phong` for a highlight on a matte surface, or write a `bsdf`")),
    ("a material", &["glass", "dielectrics", "refractive", "thindielectric", "water", "transparent"],
        Name("dielectric")),
    ("a material", &["roughdielectric", "frosted"], Words("take `dielectric` for smooth glass, or write a `bsdf`")),
    ("a material", &["light", "lamp", "area", "arealight", "emissive", "emission", "emit", "diffuselight"],
        Name("emitter")),
    ("a material", &["custom", "brdf", "user"], Name("bsdf")),
    ("a lambertian material", &["color", "colour", "reflectance", "diffuse", "kd", "basecolor", "rgb"], Name("albedo")),
    ("a lambertian material", &["texture", "map"], Words("an `albedo` is one colour, or a `checker`")),
    ("a lambertian material", &["checker", "checkerboard"],
        Words("write `albedo: { checker: { of: [0.9, 0.1], scale: 1 } }`")),
    ("a pattern", &["checkerboard", "checkered", "chequer", "chess"], Name("checker")),
    ("a checker", &["colors", "colours", "even", "odd", "color0", "color1", "tex1", "tex2"],
        Words("write `of`, a list of both colours")),
    ("a checker", &["size", "width", "cell", "edge", "period"], Name("scale")),
    ("an emitter", &["color", "colour", "emission", "emit", "le", "l", "ke", "intensity", "power", "strength", "emittance"],
        Name("radiance")),
    ("an emitter", &["reflectance", "diffuse", "kd"], Name("albedo")),
    ("a mirror", &["color", "colour", "albedo", "specular", "ks", "specularreflectance", "tint"], Name("reflectance")),
    ("a metal", &["color", "colour", "albedo", "specular", "f0", "basecolor", "specularreflectance", "tint"],
        Name("reflectance")),
    ("a metal", &["roughness", "fuzz"],
        Words("write `alpha`: the square of the roughness that modelling programs show")),
    ("a metal", &["eta", "k", "ior"], Words("write `reflectance`, the colour along the normal, in place of `eta` and `k`")),
    ("a mirror", &["roughness", "alpha", "fuzz"], Words("a rough mirror is a `ggx`, with an `alpha`")),
    ("a dielectric", &["eta", "index", "intior", "refractiveindex", "indexofrefraction", "n", "ni", "refidx"], Name("ior")),
    ("a dielectric", &["extior"], Words("`ior` is the index within, relative to that outside")),
    ("a dielectric", &["color", "colour", "tint", "transmission", "speculartransmittance", "albedo", "tf"],
        Name("transmittance")),
    ("a dielectric", &["roughness", "alpha"], Words("glass is smooth here")),
    ("a ggx material", &["roughness", "fuzz", "alphax", "uroughness"],
        Words("write `alpha`: the square of the roughness that modelling programs show")),
    ("a ggx material", &["color", "colour", "albedo", "specular", "ks", "specularreflectance", "basecolor"],
        Name("reflectance")),
    ("a phong material", &["kd", "albedo", "color", "colour", "diffusereflectance"], Name("diffuse")),
    ("a phong material", &["ks", "specularreflectance", "highlight"], Name("specular")),
    ("a phong material", &["shininess", "ns", "n", "power", "glossiness"], Name("exponent")),
    ("a primitive", &["rectangle", "rect", "plane", "parallelogram", "square", "xyrect", "xzrect", "yzrect"],
        Name("quad")),
    ("a primitive", &["tri", "trianglemesh"], Name("triangle")),
    ("a primitive", &["ball", "orb"], Name("sphere")),
    ("a primitive", &["cube", "cuboid", "aabb", "block"], Name("box")),
    ("a primitive", &["obj", "ply", "gltf", "glb", "file", "model", "trimesh", "shape"], Name("mesh")),
    ("a primitive", &["disk", "circle"], Name("disc")),
    ("a primitive", &["cylinder", "cone", "torus", "polygon", "curve", "ellipsoid"],
        Words("qrt has quads, triangles, boxes, spheres, discs and meshes: export this one as a mesh")),
    ("a quad", &["points", "corners", "positions", "verts", "p"], Name("vertices")),
    ("a triangle", &["points", "corners", "positions", "verts", "p"], Name("vertices")),
    ("a sphere", &["centre", "position", "pos", "origin", "location", "c"], Name("center")),
    ("a sphere", &["r"], Name("radius")),
    ("a sphere", &["diameter", "size"], Words("`radius` is half the diameter")),
    ("a disc", &["centre", "position", "pos", "origin", "location", "c"], Name("center")),
    ("a disc", &["n", "direction", "axis", "facing"], Name("normal")),
    ("a disc", &["r"], Name("radius")),
    ("a disc", &["diameter", "size"], Words("`radius` is half the diameter")),
    ("a box", &["low", "lower", "from", "a", "pmin", "p0"], Name("min")),
    ("a box", &["high", "upper", "to", "b", "pmax", "p1"], Name("max")),
    ("a box", &["center", "centre", "size"], Words("write two opposite corners, `min` and `max`")),
    ("a quad", &["rotation", "orientation"], Name("rotate")),
    ("a quad", &["position", "offset", "translation", "location"], Name("translate")),
    ("a quad", &["size"], Name("scale")),
    ("a triangle", &["rotation", "orientation"], Name("rotate")),
    ("a triangle", &["position", "offset", "translation", "location"], Name("translate")),
    ("a triangle", &["size"], Name("scale")),
    ("a sphere", &["rotation", "orientation"], Name("rotate")),
    ("a sphere", &["offset", "translation"], Name("translate")),
    ("a disc", &["rotation", "orientation"], Name("rotate")),
    ("a disc", &["offset", "translation"], Name("translate")),
    ("a box", &["rotation", "orientation"], Name("rotate")),
    ("a box", &["offset", "position", "translation", "location"], Name("translate")),
    ("a mesh", &["file", "filename", "path", "source"], Words("write `obj: FILE`, `ply: FILE` or `gltf: FILE`")),
    ("a mesh", &["position", "offset", "translation", "location"], Name("translate")),
    ("a mesh", &["rotation", "orientation"], Name("rotate")),
    ("a mesh", &["size"], Name("scale")),
    ("a mesh", &["smoothing", "smoothshading", "shadesmooth", "autosmooth", "smoothangle"], Name("smooth")),
    ("a mesh", &["colours", "color", "colour", "vertexcolors", "vertexcolours", "vertexcolor", "vertexcolour"],
        Name("colors")),
    ("a mesh", &["facenormals", "flat", "shadeflat"], Words("write `smooth: 0` for flat faces")),
    ("sampling", &["spp", "samples", "samplesperpixel", "paths", "rays"],
        Words("write `path_bits`: a pixel has 2^path_bits paths")),
    ("sampling", &["maxdepth", "depth"], Name("depths")),
    ("sampling", &["bounces", "maxbounces"], Words("write `depths`, the number of rays: one more than bounces")),
    ("sampling", &["sampler", "pattern"], Name("sequence")),
    ("sampling", &["nee", "nextevent", "lightsampling", "directlight", "mis"], Name("lights")),
    ("a sequence", &["sobol", "net"], Name("digital-net")),
    ("a sequence", &["halton", "hammersley", "qmc", "lowdiscrepancy"],
        Words("the sequence of low discrepancy is the `digital-net`, of Sobol' points")),
    ("a sequence", &["lattice", "grid", "stratified", "paper"], Name("product-lattice")),
    ("a sequence", &["independent", "random", "uniform"],
        Words("a circuit knows its paths: the `digital-net` is shifted at random from pixel to pixel")),
    ("a use of colours", &["vertex", "true", "on", "auto", "color0"], Name("vertices")),
    ("a use of colours", &["off", "false"], Name("none")),
    ("a way to sample lights", &["nee", "direct", "area"], Name("next-event")),
    ("a way to sample lights", &["off", "false", "bsdf"], Name("none")),
    ("a way to sample lights", &["on", "true", "default"], Name("auto")),
];

fn find(noun: &str, word: &str) -> Option<Here> {
    let letters = word.chars().filter(|c| !matches!(c, '_' | '-' | ' '));
    let plain: String = letters.flat_map(char::to_lowercase).collect();
    let row = ROWS
        .iter()
        .find(|(of, words, _)| *of == noun && words.contains(&plain.as_str()))?;
    Some(row.2)
}

/// Returns the name that `word` stands for in other renderers, or misspells, among `names` of a part of the scene.
pub fn meant_by<'a>(
    noun: &str,
    word: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let mut names: Vec<&str> = names.into_iter().collect();
    if let Some(Name(name)) = find(noun, word) {
        names.retain(|other| *other == name);
        return names.pop();
    }
    nearest(word, names)
}

/// Returns help for `word`, which other renderers use for one of `names`, the keys or kinds of the part `noun` of a
/// scene.
pub fn called(noun: &str, word: &str, names: &[&str]) -> Option<String> {
    match find(noun, word)? {
        Name(name) if !names.contains(&name) => None,
        Name(name) => Some(format!("`{word}` is called `{name}` here")),
        Words(words) => Some(words.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn words_of_other_renderers_name_ours() {
        let scene = ["sky", "film"];
        for (noun, word, names, help) in [
            (
                "a material",
                "diffuse",
                &["lambertian"][..],
                "`diffuse` is called `lambertian` here",
            ),
            (
                "the scene",
                "background",
                &scene,
                "`background` is called `sky` here",
            ),
            (
                "the scene",
                "samplesPerPixel",
                &scene,
                "write `path_bits` in `sampling`: a pixel has 2^path_bits paths",
            ),
            (
                "sampling",
                "max-depth",
                &["depths"],
                "`max-depth` is called `depths` here",
            ),
            (
                "a perspective camera",
                "FOV",
                &["vfov"],
                "`FOV` is called `vfov` here",
            ),
        ] {
            assert_eq!(called(noun, word, names).as_deref(), Some(help));
        }
        assert_eq!(called("a mesh", "diffuse", &["lambertian"]), None);
        // A macro has no entry `geometry`.
        assert_eq!(called("the scene", "objects", &scene), None);
        let sphere = ["center", "radius"];
        assert_eq!(meant_by("a sphere", "r", sphere), Some("radius"));
        assert_eq!(meant_by("a sphere", "radus", sphere), Some("radius"));
    }

    #[test]
    fn each_name_is_in_the_schema() {
        let schema = include_str!("../../scenes-yaml/scene.schema.json");
        for (_, _, here) in ROWS {
            if let Name(name) = here {
                assert!(schema.contains(&format!("\"{name}\"")), "{name}");
            }
        }
    }

    #[test]
    fn no_word_stands_twice_or_needs_normalising() {
        let mut known = HashSet::new();
        for (noun, words, _) in ROWS {
            for word in *words {
                assert!(known.insert((noun, word)), "{noun}: {word}");
                assert!(
                    word.chars()
                        .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()),
                    "{word}"
                );
            }
        }
    }
}
