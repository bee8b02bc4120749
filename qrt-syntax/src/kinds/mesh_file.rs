//! Problems with a mesh's file, and with the material libraries that it names.

use super::{listed, shorten};
use crate::codes;
use std::path::PathBuf;

problems! {
    /// Problems with a mesh's file or of its libraries.
    MeshFile {
        NotRead { name: String } = OBJ_UNREADABLE "`{name}` is not among the meshes that were read";
        Irregular { file: PathBuf, is_library: bool } = { unreadable(*is_library) }
            { format!("`{}` is not a regular file", file.display()) };
        Missing { file: PathBuf, is_library: bool } = { unreadable(*is_library) }
            { format!("cannot read `{}`: there is no such file", file.display()) }
            help "relative names are looked up beside the file that names them";
        Failed { file: PathBuf, is_library: bool, why: String } = { unreadable(*is_library) }
            { format!("cannot read `{}`: {why}", file.display()) }
            help "relative names are looked up beside the file that names them";
        OutsideCrate { file: PathBuf } = OUTSIDE
            { format!("`{}` is outside the crate's folder", file.display()) }
            help "`qrt!` reads files of the crate alone";
        OutsideScene { file: PathBuf } = OUTSIDE
            { format!("`{}` is outside the scene's folder", file.display()) }
            help "put it there, or allow its folder: `--allow-files DIR`";
        ManyBytes { most: u64 } = OBJ_TOO_LARGE
            { format!("the file is larger than {} MiB", most >> 20) } help "use a coarser mesh";
        ManyBytesInAll { most: u64 } = OBJ_TOO_LARGE
            { format!("with this file the scene's meshes exceed {} MiB", most >> 20) }
            help "use a coarser mesh";
        ManyVertices { most: usize } = OBJ_TOO_LARGE "more than {most} vertices"
            help "use a coarser mesh";
        ManyTriangles { most: usize } = OBJ_TOO_LARGE
            "the scene's meshes have more than {most} triangles" help "use a coarser mesh";
        Refused { why: String } = OBJ_REFUSED "the file cannot be read as an OBJ mesh: {why}";
        NotText = OBJ_NOT_TEXT "this is not a text file";
        NameNotText { keyword: String } = OBJ_NOT_TEXT "the name after `{keyword}` is not UTF-8 text";
        Continued = OBJ_CONTINUATION "the file ends within a continued line"
            help "is the file whole?";

        UnknownStatement { keyword: String, near: Option<&'static str> } = OBJ_STATEMENT
            { format!("`{}` is no OBJ statement", shorten(keyword)) }
            help { near.map(|near| format!("did you mean `{near}`?")) };
        Shapeless { keyword: String } = OBJ_NO_POLYGON
            "`{keyword}` is left out: lines, points and free-form shapes are not read"
            help "export the mesh as polygons";
        NotANumber { word: String, is_library: bool } = { statement(*is_library, codes::OBJ_NUMBER) }
            "`{word}` is not a number";
        NotFinite { word: String, is_library: bool }
            = { statement(*is_library, codes::OBJ_NOT_FINITE) } "`{word}` is not a finite number";
        VertexCount { given: usize } = OBJ_NUMBER
            "`v` takes 3 numbers, or 4 with a weight, or 6 or 7 with a colour, not {given}";
        Weight { weight: f64 } = OBJ_NOT_FINITE "the weight {weight} takes the vertex to infinity";

        NoFaces = OBJ_NO_FACES "the mesh has no faces";
        FewCorners { count: usize } = OBJ_CORNERS
            { let s = if *count == 1 { "" } else { "s" }; format!("a face of {count} corner{s}") }
            help "a face has three or more";
        NotACorner { corner: String } = OBJ_CORNER
            { format!("`{}` is not a corner of a face", shorten(corner)) }
            help "a corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`, with whole numbers";
        NoZeroth { kind: &'static str } = OBJ_CORNER "there is no {kind} 0" help "indices start at 1";
        NotBefore { kind: &'static str, index: i64, before: i64 } = OBJ_INDEX
            "there is no {kind} {index}: {before} stand before it";
        Beyond { kind: &'static str, index: i64, count: i64 } = OBJ_INDEX
            "there is no {kind} {index}: the file has {count}" help "is the file whole?";
        NoArea = OBJ_ZERO_AREA "this face has no area" help "remove it: its corners lie on a line";
        FlatLeftOut { count: usize } = OBJ_ZERO_AREA
            { format!("{} without area, and left out", triangles(*count)) }
            help "remove them with the tool that made the mesh";
        CopiesLeftOut { count: usize } = OBJ_COPY
            { format!("{} in the mesh twice, and left out once", triangles(*count)) }
            help "remove the copies with the tool that made the mesh";
        ManyAround { count: usize } = MESH_TOO_MANY
            "up to {count} triangles meet at a corner: means of their normals take too many comparisons"
            help "export the mesh with normals, or write `smooth: 0`";
        Overlarge = OBJ_NOT_FINITE "this face is too large: its area is not a finite number"
            help "scale the mesh in the file, and back in the scene";
        ManyCorners { most: usize } = OBJ_OUTLINE
            "this face is not convex and has more than {most} corners"
            help "export the mesh as triangles";
        Crossing = OBJ_OUTLINE "this face cannot be cut into triangles: its outline crosses itself"
            help "export the mesh as triangles";

        NotPly = PLY_HEADER "this is not a PLY file: its first line is not `ply`";
        PlyHeader { line: String } = PLY_HEADER
            { format!("`{}` cannot be read in a PLY header", shorten(line)) }
            help "a header has `format`, `element NAME COUNT`, `property TYPE NAME`, \
                  `property list TYPE TYPE NAME`, `comment` and `end_header`";
        PlyNoFormat = PLY_HEADER "the PLY header has no `format`" help "write `format ascii 1.0`";
        PlyNoEnd = PLY_HEADER "the PLY header has no `end_header`" help "is the file whole?";
        PlyMany { most: usize } = PLY_HEADER
            "the PLY header declares more than {most} elements and properties";
        PlyType { word: String } = PLY_HEADER { format!("`{}` is no type of PLY", shorten(word)) }
            help "there are char, uchar, short, ushort, int, uint, float and double";
        PlyNoCoordinate { property: &'static str } = PLY_HEADER
            "the element `vertex` has no property `{property}`"
            help "a vertex has `property float x`, `y` and `z`";
        PlyNoIndices = PLY_HEADER "the element `face` has no list `vertex_indices`"
            help "write `property list uchar int vertex_indices`";
        PlyStrips = OBJ_NO_POLYGON "triangle strips are not read"
            help "export the mesh as polygons";
        PlyEnds = PLY_ENDS "the file ends before its last element" help "is the file whole?";
        PlyWhole { value: f64 } = OBJ_NUMBER "{value} is not a whole number from 0 to 2^32 - 1";
        PlyIndex { index: u32, count: usize } = OBJ_INDEX
            "there is no vertex {index}: the file has {count}, counted from 0"
            help "is the file whole?";
        NoMaterials = OBJ_NO_MATERIAL "a PLY file has no materials"
            help "give the mesh a `material` in the scene";

        NoGltf = GLTF_FEATURE "this build of qrt cannot read glTF files"
            help "write `qrt = {{ git = \"https://github.com/qrt-rs/qrt\", default-features = false, \
                  features = [\"gltf\"] }}` in Cargo.toml";
        GltfText { why: String } = GLTF_TEXT "the file cannot be read as glTF 2: {why}";
        GltfNoText = GLTF_TEXT "the file has no JSON text" help "is the file whole?";
        GltfVersion { version: u32 } = GLTF_TEXT "this is version {version} of glTF"
            help "export the mesh as glTF 2";
        GltfLarge { bytes: usize, objects: usize, lists: usize, commas: usize } = OBJ_TOO_LARGE
            { format!(
                "the JSON text has more than {} MiB, {objects} objects, {lists} lists or {commas} \
                 commas",
                bytes >> 20
            ) }
            help "use a coarser mesh, or a binary file: `.glb`";
        GltfPlaced { most: usize } = OBJ_TOO_LARGE "the nodes place more than {most} primitives"
            help "join primitives, or meshes, into one";
        GltfExtension { name: String } = GLTF_TEXT
            { format!("the file needs the extension `{}`, which is not read", shorten(name)) }
            help "export the mesh without compression";
        GltfTree = GLTF_TEXT "the node is reached twice: a node has one parent, and never itself";
        GltfNoPositions = GLTF_DATA "the primitive has no attribute `POSITION`";
        GltfType { attribute: &'static str } = GLTF_DATA
            "the type of `{attribute}` is not that of glTF 2"
            help { Some(match *attribute {
                "COLOR_0" => "`COLOR_0` has 3 or 4 floats, or normalized unsigned bytes or shorts",
                _ => "`POSITION` has vectors of 3 floats, `indices` unsigned whole numbers",
            }.to_owned()) };
        GltfSparse = GLTF_DATA "sparse accessors are not read" help "export the mesh without them";
        GltfNoData = GLTF_DATA "the accessor has no `bufferView`";
        GltfShort = GLTF_DATA "the data end early" help "is the file whole?";
        GltfNoBinary = GLTF_DATA "the buffer has no `uri`, and the file no binary data for it"
            help "is the file whole?";
        GltfDataUri = GLTF_DATA "the `uri` is not `data:MEDIA;base64,...`";
        GltfNoMaterial = OBJ_NO_MATERIAL "the primitive has no material"
            help "give the mesh a `material` in the scene, or the primitive one in the file";
        GltfNormals = GLTF_POSE "`NORMAL` is left out: these normals are not plain vectors of 3 floats"
            help "export the mesh with such normals, or write an angle: `smooth: 30`";
        GltfSkin = GLTF_POSE "`skin` is left out: the mesh has the pose that it was made in"
            help "export the mesh with the pose applied";
        GltfMorph = GLTF_POSE "`targets` are left out: the mesh has its basic shape"
            help "export the mesh with the shape applied";

        ColoursUnused = COLOURS_UNUSED "the vertices have colours, which are not used"
            help "write `colors: vertices` in the mesh to use them, or `colors: none`";
        NoColour = MESH_COLOURS "this vertex has no colour"
            help "a vertex with a colour is `v x y z r g b`, with numbers from 0 to 1; or write `colors: none`";
        PlyNoColour { property: &'static str } = MESH_COLOURS "the element `vertex` has no property `{property}`"
            help "a vertex with a colour has `property uchar red`, `green` and `blue`; or write `colors: none`";
        GltfNoColours = MESH_COLOURS "the primitive has no attribute `COLOR_0`"
            help "export the mesh with colours of its vertices, or write `colors: none`";
        PlyColourType { property: &'static str, word: &'static str } = MESH_COLOURS
            "the property `{property}` is of type {word}"
            help "colours are of type uchar, ushort, float or double";
        ColourRange { value: f64 } = MTL_ALBEDO "a vertex has the colour {value}, which is not in [0, 1]"
            help "colours are linear: divide numbers up to 255 by 255";

        ManyLibraries { most: usize } = OBJ_TOO_LARGE
            "the mesh names material libraries in more than {most} statements";
        NamelessLibrary = OBJ_NO_LIBRARY "`mtllib` without a name";
        NamelessUse = OBJ_MATERIAL "`usemtl` without a name";
        NamelessMaterial = MTL_STATEMENT "`newmtl` without a name";
        NoUse = OBJ_NO_MATERIAL "this face has no material: no `usemtl` stands before it"
            help "give the mesh a `material` in the scene, or the face one in the file";
        NoLibrary { name: String } = OBJ_NO_LIBRARY { format!("no material `{}`", shorten(name)) }
            help "the file names no material library: a `mtllib` statement is missing";
        UnknownMaterial { name: String, near: Option<String> } = OBJ_MATERIAL
            { format!("no material `{}`", shorten(name)) }
            help { Some(match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`newmtl` in a material library names it".to_owned(),
            }) };
        SecondMaterial { name: String, file: String, line: usize } = MTL_DUPLICATE
            { format!("a second material `{}`", shorten(name)) }
            help "the first is in {file}, line {line}";
        EmptyMaterial { name: String } = MTL_EMPTY
            { format!("material `{}` has neither `Kd` nor `Ke`", shorten(name)) }
            help "`Kd r g b` is its albedo, `Ke r g b` its radiance";
        BeforeMaterials { keyword: String } = MTL_STATEMENT "`{keyword}` stands before any `newmtl`";
        Texture { keyword: String, name: String } = MTL_TEXTURE "`{keyword}`: there are no textures"
            help { Some(format!(
                "name a material of the scene `{}`, which replaces this one; or write a colour",
                shorten(name)
            )) };
        LeftOut { keywords: Vec<String>, name: String, others: usize } = MTL_LEFT_OUT
            { let others = and_others(*others);
              let verb = if keywords.len() == 1 { "has" } else { "have" };
              let (keywords, name) = (listed(keywords, "and"), shorten(name));
              format!("{keywords} of `{name}`{others} {verb} no counterpart") }
            help { Some(format!(
                "name a material of the scene `{}`: it replaces that of the file", shorten(name)
            )) };
        NotRgb { keyword: String, space: String } = MTL_STATEMENT
            "`{keyword} {space}` is not read: colours are linear RGB";
        Colour { keyword: String, given: usize } = MTL_STATEMENT
            "`{keyword}` takes 3 numbers, or 1, not {given}";
        NegativeRadiance { keyword: String, value: f64 } = MTL_RADIANCE
            "the radiance `{keyword}` is {value}, which is not a finite number from 0 on";
        NotAlbedo { keyword: String, value: f64 } = MTL_ALBEDO
            "the reflectance `{keyword}` is {value}, which is not in [0, 1]";
        StatementRange { keyword: String, value: f64, most: f64 } = MTL_STATEMENT
            { if *most == f64::MAX {
                  format!("`{keyword}` is {value}, which is negative")
              } else {
                  format!("`{keyword}` is {value}, which is not in [0, {most}]")
              } };
        StatementCount { keyword: String, given: usize } = MTL_STATEMENT
            "`{keyword}` takes 1 number, not {given}";
        Illumination { model: f64 } = MTL_STATEMENT "there is no illumination model {model}"
            help "`illum` is a whole number from 0 to 10";
        Ior { ior: f64 } = MTL_STATEMENT
            "the index of refraction is {ior}, which is not in [0.001, 1000]";
    }
}

/// The code of a file that cannot be read.
fn unreadable(is_library: bool) -> &'static str {
    if is_library {
        codes::MTL_UNREADABLE
    } else {
        codes::OBJ_UNREADABLE
    }
}

/// Returns the code of an invalid number. A library has one code for all its statements.
fn statement(is_library: bool, of_mesh: &'static str) -> &'static str {
    if is_library {
        codes::MTL_STATEMENT
    } else {
        of_mesh
    }
}

/// Returns a number of triangles as the subject of a sentence.
fn triangles(count: usize) -> String {
    if count == 1 {
        "1 triangle is".to_owned()
    } else {
        format!("{count} triangles are")
    }
}

/// Returns the end of a list of things of which one is named.
fn and_others(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => " and 1 other".to_owned(),
        others => format!(" and {others} others"),
    }
}
