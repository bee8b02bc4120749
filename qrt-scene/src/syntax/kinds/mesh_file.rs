//! Problems with a mesh's file, and with the material libraries that it names.

use super::shorten;
use crate::syntax::codes;
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
        Lines = OBJ_NO_POLYGON "lines have no area, so no light meets them"
            help "leave out the `l` statements";
        Points = OBJ_NO_POLYGON "points have no area, so no light meets them"
            help "leave out the `p` statements";
        FreeForm { keyword: String } = OBJ_NO_POLYGON "`{keyword}`: free-form shapes are not read"
            help "export the mesh as polygons";
        NotANumber { word: String, is_library: bool } = { statement(*is_library, codes::OBJ_NUMBER) }
            "`{word}` is not a number";
        NotFinite { word: String, is_library: bool }
            = { statement(*is_library, codes::OBJ_NOT_FINITE) } "`{word}` is not a finite number";
        Count { keyword: String, least: usize, most: usize, given: usize } = OBJ_NUMBER
            { let count = if least == most { least.to_string() } else { format!("{least} to {most}") };
              format!("`{keyword}` takes {count} numbers, not {given}") };
        FiveNumbers = OBJ_NUMBER
            "`v` takes 3 numbers, or 4 with a weight, or 6 with a colour, not 5";
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
        Overlarge = OBJ_NOT_FINITE "this face is too large: its area is not a finite number"
            help "scale the mesh in the file, and back in the scene";
        ManyCorners { most: usize } = OBJ_OUTLINE
            "this face is not convex and has more than {most} corners"
            help "export the mesh as triangles";
        Crossing = OBJ_OUTLINE "this face cannot be cut into triangles: its outline crosses itself"
            help "export the mesh as triangles";

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
        Texture { keyword: String } = MTL_TEXTURE "`{keyword}`: there are no textures"
            help "give the mesh a `material` in the scene, or a plain colour here";
        NotRgb { keyword: String, space: String } = MTL_STATEMENT
            "`{keyword} {space}` is not read: colours are linear RGB";
        Colour { keyword: String, given: usize } = MTL_STATEMENT
            "`{keyword}` takes 3 numbers, or 1, not {given}";
        NegativeRadiance { value: f64 } = MTL_RADIANCE "the radiance `Ke` is {value}, which is negative";
        NotAlbedo { value: f64 } = MTL_ALBEDO "the albedo `Kd` is {value}, which is not in [0, 1]";
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
