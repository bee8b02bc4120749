//! Problems with materials, the camera and the geometry.

use super::{grouped, listed, number, shorten};

problems! {
    /// Problems with the materials' names and reflectances.
    Material {
        GivenTwice { name: String } = DUPLICATE_NAME "the name `{name}` is given twice";
        Unknown { name: String, near: Option<String>, defined: Vec<String>, more: bool }
            = UNKNOWN_MATERIAL { format!("no material is called `{}`", shorten(name)) }
            help { Some(match near {
                Some(near) => format!("did you mean `{near}`?"),
                None if defined.is_empty() => "define it under `materials`".into(),
                None => {
                    let more = if *more { " and more" } else { "" };
                    format!("defined are {}{more}", listed(defined, "and"))
                }
            }) };
        GainsEnergy { sum: f64, channel: &'static str } = PHONG_ENERGY
            "diffuse + specular is {sum} in {channel}: more than arrives"
            help "keep the sum at 1 or below in every channel" also "the diffuse part";
        Unused { name: String, more: usize } = UNUSED_MATERIAL
            { match more {
                0 => format!("nothing is made of the material `{}`", shorten(name)),
                more => format!(
                    "nothing is made of the material `{}`, nor of {more} others", shorten(name)
                ),
            } }
            help "remove it, or give it to a primitive";
    }

    /// Problems with lamps that light nothing.
    Unlit {
        NoLamp = BLACK "nothing emits: every picture of this scene is black"
            help "give a primitive an `emitter` material, or the scene a `sky` or a `sun`";
        LampsAway { is_disc: bool } = BLACK
            "every lamp shines away from all that the camera sees: the picture is black"
            label "this lamp emits on its other side"
            help { Some(if *is_disc {
                "a disc emits on its front, to which its `normal` points: write the opposite `normal`"
            } else {
                "a lamp emits on its front, where its vertices run counterclockwise: list them in the other order"
            }.to_owned()) };
        OppositeLamp = OPPOSITE_LAMP
            "this lamp lies on one that faces the other way: its light is lost where they overlap"
            label "of faces in one place, the first is seen"
            help "move the two apart, each towards the side that it lights"
            also "this lamp is seen from both sides";
    }

    /// Problems with a scene that another renderer is to read.
    Renderer {
        NoCounterpart { renderer: &'static str, name: String, kind: &'static str } = NO_COUNTERPART
            { format!("{renderer} has no counterpart of the `{kind}` of `{}`", shorten(name)) }
            help { Some(match *kind {
                "checker" => "on faces that are parallel to two axes it is exported: draw a slanted face, a \
                    sphere or a disc in one colour".to_owned(),
                "phong" => "a `phong` without `specular` is matte, and is exported".to_owned(),
                _ => "a map and a value of one's own are qrt's alone: use another material".to_owned(),
            }) };
    }

    /// Problems with the camera.
    Camera {
        NoView = CAMERA_TARGET "the camera looks at the point it stands on"
            label "same as `eye`" also "the camera stands here";
        NoUp = CAMERA_UP "`up` is zero: it has no direction";
        UpAlongView = CAMERA_UP "`up` points along the view"
            help "choose an `up` across the view, such as [0, 0, 1]";
        OnSphere = CAMERA_ON_SPHERE "the camera stands on the surface of a sphere"
            label "neither inside the sphere nor outside: rounding would decide it"
            help "move `eye` by a thousandth of the radius, inside or outside" also "the sphere";
    }

    /// Problems with the sky and the sun.
    Sky {
        TwoSkies { key: &'static str } = SKY "`{key}` stands beside `radiance`, which is that of all directions"
            help "keep either `radiance`, or both `horizon` and `zenith`" also "the radiance of all directions";
        NoEnd { key: &'static str } = SKY "the sky's gradient has no `{key}`"
            help "write both `horizon` and `zenith`, or one `radiance`";
        NoSky = SKY "the sky has no radiance"
            help "write `radiance: [1, 1, 1]`, or both `horizon` and `zenith`";
        NoUp = SKY "the sky's `up` is zero: it has no direction"
            help "leave it out for [0, 1, 0]";
        FaintSunlight { lit: f64, levels: u64, larger: Option<[f64; 2]> } = FAINT_SUNLIGHT
            { format!(
                "circuits tell {} {} of colours apart, and what this sun lights has {} of them",
                grouped(*levels), if *levels == 1 { "level" } else { "levels" }, number(*lit)
            ) }
            label "a mirror, glass or a glossy surface may show the sun itself, the brightest level"
            help { Some(match larger {
                Some([angle, fraction]) => format!(
                    "a larger sun with less radiance gives the same light: write `angle: {}`, and the radiance \
                     times {}; or more `comparator.bits` and `precision.fraction`",
                    number(*angle), number(*fraction)
                ),
                None => "use more `comparator.bits` and `precision.fraction`".to_owned(),
            }) };
        NoSunDirection = SUN "the sun's `direction` is zero: it has no direction"
            help "write the direction from the scene towards the sun, such as [1, 2, 1]";
    }

    /// Problems with a primitive's shape.
    Shape {
        Coincident { first: usize, second: usize } = COINCIDENT
            "vertices {first} and {second} are one point"
            label "same as vertex {first}" also "the other";
        Flat = ZERO_AREA "this primitive has no area" label "the vertices lie on a line";
        Straight { at: usize } = ZERO_AREA "the quad has no corner at vertex {at}"
            label "on a line with its neighbours" help "write a triangle, or move this vertex";
        Reflex { at: usize } = NOT_CONVEX
            "the quad is not convex: its corner at vertex {at} is dented"
            help "split it into two triangles";
        Crossing = CROSSING "the quad's edges cross"
            help "list the vertices in order around the outline";
        Thin = ZERO_AREA "the box is too thin: rounding decides where its faces look"
            help "use a larger extent or a smaller translation, or write a quad";
        Small = ZERO_AREA "the shape is too small: rounding decides its outline"
            help "use a larger radius, or a centre nearer to the origin";
        NoNormal = DISC_NORMAL "`normal` is zero: it has no direction"
            help "write the direction that the front faces, such as [0, 1, 0]";
        Far = MESH_RANGE "the shape reaches out of range: no coordinate may exceed 1e30"
            help "use a smaller shape, or a smaller transform";
        Merged = MESH_RANGE "rounding makes one point of two vertices once the shape is moved"
            label "too small for so large a translation"
            help "use a smaller translation, or a greater shape";
        NoVolume { axes: Vec<&'static str> } = ZERO_AREA
            { format!("`max` does not exceed `min` along {}", listed(axes, "and")) }
            label "must exceed `min` in each coordinate"
            help "exchange these coordinates; what has no extent is a quad"
            also "the corner with the least coordinates";
    }

    /// Problems with pieces of glass.
    Glass {
        Touches = GLASS_TOUCHES
            "faces of glass lie on each other: a ray crosses the two as one, and is refracted once"
            label "covers one listed before"
            help "leave a gap between the pieces, or let one reach into the other" also "the other";
    }

    /// Problems with a mesh after its transform.
    Mesh {
        NoMaterial { triangles: Triangles } = OBJ_NO_MATERIAL { triangles.that("have no material") }
            help "give the mesh a `material`";
        Flat { triangles: Triangles } = MESH_ZERO_AREA
            { triangles.that("have no area once scaled and moved") }
            help "rounding takes it: use a larger scale or a smaller translation";
        Far { triangles: Triangles } = MESH_RANGE
            { triangles.that("are out of range once scaled and moved") }
            help "use a smaller transform";
        TooMany { triangles: usize, most: usize } = MESH_TOO_MANY
            { format!("with this mesh the scene has {triangles} faces; the limit is {most}") }
            help "use a coarser mesh, or fewer copies of it";
        ManyAround { count: usize } = MESH_TOO_MANY
            "up to {count} triangles meet at a corner: means of their normals take too many comparisons"
            help "export the mesh with normals and write `smooth: auto`, or `smooth: 0`";
        Uncoloured { name: String, kind: &'static str } = MESH_UNCOLOURED
            { format!("the `{kind}` of `{}` cannot be coloured by vertices", shorten(name)) }
            help "use a `lambertian`, `emitter`, `mirror`, `ggx` or `metal` of one colour, or write `colors: none`";
        TooBright { material: String, radiance: f64, most: f64 } = RADIANCE
            { format!("the radiance {} of `{material}` is too large", number(*radiance)) }
            label "must be at most {most:e}";
    }
}

/// The number of faulty triangles, `some` of a mesh's `all`, and the index of the `first` of them,
/// from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangles {
    pub some: usize,
    pub all: usize,
    pub first: usize,
}

impl Triangles {
    fn that(self, fault: &str) -> String {
        let Self { some, all, first } = self;
        let number = first + 1;
        format!("{some} of {all} triangles {fault}; the first is number {number}")
    }
}
