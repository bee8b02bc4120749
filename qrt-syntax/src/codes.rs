//! The table of error codes: the meaning of each code, and advice.
//!
//! Codes are stable: a number, once given, keeps its meaning. `QRT01..` is about the text and its
//! structure, `QRT02..` about values and names, `QRT03..` about geometry and meshes, `QRT04..`
//! about expressions and BSDFs, `QRT05..` about sampling and limits, `QRT06..` about the circuit,
//! `QRT07..` about the form of the macro `qrt!`, `QRT08..` about reversible routines, `QRT09..`
//! about the use of the command line.

/// A row of the table of error codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    /// `QRT0101`
    pub code: &'static str,
    /// The problem, in a few words.
    pub title: &'static str,
    /// Advice: how to fix the problem.
    pub advice: &'static str,
}

macro_rules! codes {
    ($($name:ident = $code:literal, $title:literal, $advice:literal;)*) => {
        $(#[doc = concat!($code, ": ", $title, ". ", $advice, ".")] pub const $name: &str = $code;)*

        /// All codes, in order.
        pub const TABLE: &[Code] =
            &[$(Code { code: $code, title: $title, advice: $advice }),*];
    };
}

codes! {
    UNREADABLE = "QRT0101", "the scene file cannot be read",
        "Check the path; it must be a file that you may read";
    NOT_UTF8 = "QRT0102", "the scene file is not UTF-8 text",
        "Save it as UTF-8";
    SYNTAX = "QRT0103", "the text is not YAML",
        "Look at the marked place and just before it: indentation, a missing colon, bracket or quote";
    EMPTY = "QRT0104", "the scene is empty",
        "Start from `qrt new NAME`";
    DUPLICATE_KEY = "QRT0105", "a key is written twice in one map",
        "Keep one of the two";
    SECOND_DOCUMENT = "QRT0106", "the file holds more than one YAML document",
        "Keep one scene per file";
    TAG = "QRT0107", "a YAML tag",
        "Remove it: a value's type follows from its place in the scene";
    MERGE_KEY = "QRT0108", "a YAML merge key",
        "Write the entries out, or alias whole values";
    COMPLEX_KEY = "QRT0109", "a key that is not a plain name",
        "Use a word or a text as the key";
    ALIAS = "QRT0110", "an alias to nothing or to itself",
        "Define the anchor, complete, before the alias";
    ALIAS_BUDGET = "QRT0111", "aliases expand to too much",
        "Write the scene with fewer or smaller aliases";
    TOO_DEEP = "QRT0112", "the text nests too deeply",
        "A scene needs fewer than ten levels";
    TOO_LARGE = "QRT0113", "the scene is too large",
        "Put large geometry into mesh files (OBJ, PLY, glTF)";
    UNKNOWN_KEY = "QRT0120", "an unknown key",
        "Compare with the nearest name, or remove the key";
    MISSING_KEY = "QRT0121", "a required key is missing",
        "Add it";
    WRONG_TYPE = "QRT0122", "a value of the wrong type",
        "Write what is expected there";
    WRONG_LENGTH = "QRT0123", "a list of the wrong length",
        "Write as many elements as are expected";
    ONE_VARIANT = "QRT0124", "not exactly one kind where one is to be chosen",
        "Write a map with a single key, such as `{ lambertian: { ... } }`";
    UNKNOWN_VARIANT = "QRT0125", "an unknown kind",
        "Choose one of the listed kinds";
    UNKNOWN_WORD = "QRT0126", "an unknown word",
        "Choose one of the listed words";
    UNREPRESENTABLE = "QRT0127", "a number beyond 64-bit floating point",
        "Write a number between 1e-307 and 1e308 in size, or 0";
    OUT_OF_RANGE = "QRT0201", "a number out of its range",
        "Choose one within the range";
    NOT_FINITE = "QRT0202", "NaN or infinity",
        "Write a finite number";
    ALBEDO = "QRT0203", "an albedo or reflectance outside [0, 1]",
        "A surface cannot reflect less than nothing or more than it receives";
    RADIANCE = "QRT0204", "a negative or overlarge radiance",
        "Write 0 or more";
    DUPLICATE_NAME = "QRT0205", "two materials of one name",
        "Rename one of them";
    UNKNOWN_MATERIAL = "QRT0206", "a material that is not defined",
        "Define it under `materials`, or correct the name";
    EMPTY_NAME = "QRT0207", "an empty name or text",
        "Give it at least one character";
    PHONG_ENERGY = "QRT0208", "a Phong surface that reflects more than it receives",
        "Keep diffuse + specular at 1 or below in every channel";
    CAMERA_TARGET = "QRT0209", "a camera that looks at the point it stands on",
        "Move `eye` or `target`";
    CAMERA_UP = "QRT0210", "a camera whose `up` does not say which way is up",
        "Choose an `up` that is neither zero nor along the view";
    SKY = "QRT0211", "a sky without a radiance, with a part of a gradient, or without a zenith",
        "Write one `radiance`, or both `horizon` and `zenith`";
    CAMERA_ON_SPHERE = "QRT0212", "a camera that stands on the surface of a sphere",
        "Move `eye` inside the sphere or outside";
    SUN = "QRT0213", "a sun whose `direction` is zero",
        "Write the direction from the scene towards the sun, of any length above 0";
    UNUSED_MATERIAL = "QRT0220", "a material that nothing is made of",
        "Remove it, or give it to a primitive; it is only a warning";
    BLACK = "QRT0221", "a scene whose pictures are black",
        "Let a lamp's front look at what the camera sees; it is only a warning";
    OPPOSITE_LAMP = "QRT0222", "a lamp hidden by another in the same place that faces the other way",
        "Move the two apart, each towards the side that it lights; it is only a warning";
    COINCIDENT = "QRT0301", "two vertices at one point",
        "Move one of them, or use a triangle";
    ZERO_AREA = "QRT0302", "a primitive without area",
        "Move a vertex off the line through the others";
    NOT_CONVEX = "QRT0303", "a quad that is not convex",
        "Split it into triangles";
    CROSSING = "QRT0304", "a quad whose edges cross",
        "List the vertices in order around the outline";
    MESH_ZERO_AREA = "QRT0305", "a mesh whose faces lose their area when it is placed",
        "Use a larger scale or a smaller translation";
    MESH_RANGE = "QRT0307", "a shape that its transform takes out of range",
        "Use a smaller scale or translation";
    MESH_TOO_MANY = "QRT0308", "more faces than a scene may have",
        "Use a coarser mesh, or fewer copies of it";
    GLASS_TOUCHES = "QRT0309", "faces of glass that lie on each other",
        "Leave a gap between the pieces, or let one reach into the other";
    DISC_NORMAL = "QRT0310", "a disc whose `normal` has no direction",
        "Write the direction that the front faces, of any length above 0";
    MESH_UNCOLOURED = "QRT0311", "a material that colours of vertices cannot colour",
        "Give the mesh a `lambertian`, `emitter`, `mirror`, `ggx` or `metal` of one colour";
    OUTSIDE = "QRT0319", "a file outside the scene's folder",
        "Put it beside the scene, or allow its folder with `--allow-files DIR`";
    OBJ_UNREADABLE = "QRT0320", "a mesh file that cannot be read",
        "Check the path, which is relative to the scene's folder";
    OBJ_TOO_LARGE = "QRT0321", "a mesh file that is too large",
        "Use a coarser mesh";
    OBJ_NOT_TEXT = "QRT0322", "a mesh file that is not text",
        "Export the mesh as Wavefront OBJ";
    OBJ_STATEMENT = "QRT0323", "an unknown statement in a mesh file",
        "Correct or remove it";
    OBJ_NO_POLYGON = "QRT0324", "points, lines or free-form shapes in a mesh file",
        "Export the mesh as polygons; it is only a warning, what has faces is read";
    OBJ_NUMBER = "QRT0325", "too few, too many or no numbers in a mesh file",
        "Write as many numbers as the statement takes";
    OBJ_NOT_FINITE = "QRT0326", "NaN, infinity or an overlarge number in a mesh file",
        "Write finite numbers, and scale the mesh in the scene";
    OBJ_CORNERS = "QRT0327", "a face with fewer than three corners",
        "Give it three or more, or remove it";
    OBJ_CORNER = "QRT0328", "a corner of a face that cannot be read",
        "Write it as v, v/vt, v//vn or v/vt/vn, with whole numbers from 1";
    OBJ_INDEX = "QRT0329", "a face that refers to what the file does not have",
        "Check that the file is whole";
    OBJ_OUTLINE = "QRT0330", "a face that cannot be cut into triangles",
        "Export the mesh as triangles";
    OBJ_NO_FACES = "QRT0331", "a mesh without faces",
        "Check that the file is whole";
    OBJ_CONTINUATION = "QRT0332", "a mesh file that ends within a line",
        "Check that the file is whole";
    OBJ_NO_LIBRARY = "QRT0333", "a mesh that names no material library",
        "Give the mesh a `material` in the scene, or the file a `mtllib` statement";
    MTL_UNREADABLE = "QRT0334", "a file that a mesh file names and that cannot be read",
        "Check its name, which is relative to the folder of the mesh file";
    OBJ_MATERIAL = "QRT0335", "a material that no library has",
        "Correct the name after `usemtl`, or add the material to the MTL file";
    OBJ_NO_MATERIAL = "QRT0336", "a face without a material",
        "Give the mesh a `material` in the scene, or the face one in the file";
    MTL_STATEMENT = "QRT0337", "a statement of a material library that cannot be read",
        "Write it as the page on meshes shows";
    MTL_ALBEDO = "QRT0338", "a reflectance outside [0, 1] in a mesh file",
        "A surface cannot reflect less than nothing or more than it receives";
    MTL_RADIANCE = "QRT0339", "a negative radiance in a mesh file",
        "Write 0 or more";
    MTL_DUPLICATE = "QRT0340", "two materials of one name in the libraries of a mesh",
        "Rename one of them";
    MTL_EMPTY = "QRT0341", "a material without `Kd` and `Ke`",
        "Give it an albedo, a radiance or both";
    MTL_TEXTURE = "QRT0342", "a texture in a mesh file",
        "Name a material of the scene like that of the file, or write a plain colour";
    OBJ_ZERO_AREA = "QRT0343", "a face without area",
        "Remove it with the tool that made the mesh; beside other faces it is only a warning";
    OBJ_REFUSED = "QRT0344", "a mesh file that the OBJ library refuses",
        "Export the mesh anew";
    OBJ_COPY = "QRT0345", "a face that a mesh has twice",
        "Remove the second with the tool that made the mesh; it is only a warning";
    MTL_LEFT_OUT = "QRT0346", "statements of a material that have no counterpart",
        "Let a material of the scene with its name replace it; it is only a warning";
    PLY_HEADER = "QRT0347", "a PLY header that cannot be read",
        "Compare it with the page on meshes, or export the mesh anew";
    PLY_ENDS = "QRT0348", "PLY data that end early",
        "Check that the file is whole, and that the counts in its header are right";
    GLTF_FEATURE = "QRT0349", "a glTF file, and a build that cannot read one",
        "Build qrt with the feature `gltf`";
    GLTF_TEXT = "QRT0350", "a glTF file whose JSON text cannot be read",
        "Check the file with the glTF validator of Khronos, or export it anew";
    GLTF_DATA = "QRT0351", "a glTF file whose binary data cannot be read",
        "Check that the file is whole, or export it anew";
    GLTF_POSE = "QRT0352", "a pose or shape of a glTF file that is left out",
        "Export the mesh with it applied; it is only a warning";
    MESH_COLOURS = "QRT0353", "a mesh without a colour at each vertex, although `colors: vertices` asks for them",
        "Export the mesh with colours of its vertices, or remove `colors`";
    COLOURS_UNUSED = "QRT0354", "colours of vertices that are not used",
        "Write `colors: vertices` in the mesh, or `colors: none`; it is only a warning";
    EXPR_SYNTAX = "QRT0400", "an expression that cannot be read",
        "Look at the marked place: an operator or parenthesis is missing or too many";
    EXPR_NAME = "QRT0401", "an unknown name in an expression",
        "Compare with the nearest name";
    EXPR_VARIABLE = "QRT0402", "a variable that has no value here",
        "Maps and Jacobians depend on u and v alone";
    EXPR_OPERANDS = "QRT0403", "a function with the wrong number of operands",
        "Give it as many as it takes";
    EXPR_NUMBER = "QRT0404", "a number that cannot be read in an expression",
        "Write it like 2, 0.5 or 1e-3";
    EXPR_SIZE = "QRT0405", "an expression that is too long or too deep",
        "Simplify it";
    EXPR_EMPTY = "QRT0406", "an empty expression",
        "Write one";
    BSDF_CHANNELS = "QRT0410", "values for another number of channels than one or three",
        "Give one expression (grey) or three (red, green, blue)";
    MAP_OFF_SPHERE = "QRT0411", "a map that leaves the unit sphere",
        "Make x^2 + y^2 + z^2 = 1 for all u and v";
    MAP_UNDEFINED = "QRT0412", "a map without a value or slope somewhere",
        "Make it finite and smooth within the unit square";
    MAP_FLAT = "QRT0413", "a map onto a point or a line",
        "Let it depend on both u and v";
    JACOBIAN_MISMATCH = "QRT0414", "a Jacobian that is not that of its map",
        "Write `auto`, or |dphi/du x dphi/dv|";
    BSDF_NEGATIVE = "QRT0415", "a BSDF with a negative value",
        "Cut the negative part off with `max(0, ...)`";
    BSDF_UNDEFINED = "QRT0416", "a BSDF without a finite value somewhere",
        "Make it finite for every pair of directions above the surface";
    BSDF_ENERGY = "QRT0417", "a BSDF that reflects more than it receives",
        "Scale it down";
    BSDF_UNBOUNDED = "QRT0418", "a BSDF whose weight has no bound under its map",
        "Choose a map that sends more points where the value is large";
    MAP_COVERS_TWICE = "QRT0419", "a map that reaches directions more than once",
        "Let every direction come from one point of the unit square";
    PDF_MISMATCH = "QRT0420", "a density that is not that of its map",
        "Write 1 over the map's Jacobian, as a function of the angles; or leave it out";
    MAP_LEAVES_OUT = "QRT0421", "a map that leaves out directions that the value reflects to",
        "Let it reach all of them, once; or make the value zero where it does not go";
    NOT_RECIPROCAL = "QRT0422", "a BSDF that is not the same in both directions",
        "Write a value that stays the same when cos_i and cos_o are exchanged; it is only a warning";
    NO_DEPTH = "QRT0501", "a path without rays",
        "Give `depths` at least one entry";
    PATH_BITS_SUM = "QRT0502", "path_bits that is not the sum of the lattice's bits",
        "Leave `path_bits` out under `product-lattice`, or change the bits";
    TOO_MANY_IDS = "QRT0503", "more path indices than fit into a word",
        "Use fewer path bits or comparator bits";
    TOO_MANY_DIMENSIONS = "QRT0504", "more dimensions than a path may have",
        "Use fewer depths, or `product-lattice`";
    PRIMARY_MAP = "QRT0505", "a map of directions for the primary ray",
        "Remove it: the primary ray samples the pixel square";
    ACCURACY_CONFLICT = "QRT0506", "an accuracy beside a parameter that it replaces",
        "Keep one of the two";
    STRATA = "QRT0507", "strata of the comparator that cannot be counted",
        "Leave `counting.strata` at `auto`, use fewer, or an estimator that counts them";
    PRIMARY_LIGHT = "QRT0508", "the sampling of lamps for the primary ray",
        "Remove it: the primary ray leaves no surface";
    FEW_LIGHT_BITS = "QRT0509", "more lamps than the point on a lamp has columns",
        "Give the first coordinate of `light` more bits";
    LIGHT_UNBOUNDED = "QRT0510", "next-event estimation where a lamp may touch a surface",
        "Write `mis`, or `auto`";
    LIGHT_UNUSED = "QRT0511", "the sampling of lamps where no surface samples one",
        "Remove it: it is a warning, and costs nothing";
    NEVER_STOPS = "QRT0512", "an error to stop at, and an estimator that does not stop",
        "Leave `counting.error` out, or use an estimator that decides itself what it measures";
    NO_LENS = "QRT0513", "a point on a lens where there is none",
        "Give the camera a `lens`, and sample it in the first entry of `depths`";
    LEVEL_BITS = "QRT0514", "a comparator with more bits than the estimator looks up",
        "Use at most 12 `comparator.bits`, or the estimator `auto`";
    FAINT_SUNLIGHT = "QRT0515", "a sun whose light has few levels beside its radiance",
        "Use a larger sun with less radiance, or more comparator and fraction bits; it is a warning";
    BUDGET_QUBITS = "QRT0601", "a circuit with more qubits than the budget allows",
        "Uncompute earlier, or use fewer path bits, depths or fraction bits; or raise the limit";
    BUDGET_TOFFOLI = "QRT0602", "a circuit with more Toffoli gates than the budget allows",
        "Use fewer depths, primitives or fraction bits; or raise the limit";
    QUOTIENT_UNBOUNDED = "QRT0610", "a quotient or a function that no register can hold",
        "Keep the divisor away from 0, and operands from where the function is infinite";
    NUMBER_TOO_WIDE = "QRT0611", "a number that no register can hold",
        "Use fewer fraction bits, or a smaller scene";
    TOO_MANY_FACES = "QRT0612", "more faces than a table holds",
        "Use a coarser mesh, or find primary hits classically";
    SPHERE_IN_TABLE = "QRT0613", "a sphere in a table of faces",
        "Search with `--visibility classical`, or draw the sphere as a mesh";
    SMALL_PART = "QRT0614", "a sphere, a smooth or coloured face or a checker, too small for the circuit's numbers",
        "Use more fraction bits, larger cells, or a quad in place of a large sphere";
    MACRO_SCENE = "QRT0701", "what stands in `qrt!` is not a scene",
        "Write `pub scene Name { ... }` or `pub scene Name from \"scene.yaml\"`";
    MACRO_FORMAT = "QRT0702", "a number format that is not `<Fixed<2, F>>`",
        "Write `<Fixed<2, 14>>` for 14 fraction bits, or leave it out";
    MACRO_FILE = "QRT0703", "a scene from something that is not a path in quotes",
        "Write `from \"scene.yaml\"`, relative to the folder of Cargo.toml";
    MACRO_ENTRY = "QRT0704", "an unknown entry of a scene",
        "Compare with the nearest name";
    MACRO_FORM = "QRT0705", "an entry that is not in its form",
        "Write it as the example shows";
    MACRO_COMMA = "QRT0706", "a missing comma",
        "Put a comma between entries, keys and elements";
    MACRO_KEY = "QRT0707", "something that is not `key: value`",
        "Write `key: value`, with `_` within keys";
    MACRO_VALUE = "QRT0708", "a value that is missing or cannot be one",
        "Write a number, a point, a colour, a word or a text";
    MACRO_SUFFIX = "QRT0709", "a number with a suffix",
        "Write the number alone: all numbers of a scene are 64-bit floats";
    MACRO_TEXT = "QRT0710", "a text without quotes",
        "Put it in quotes";
    MACRO_WORD = "QRT0711", "a word with a hyphen",
        "Write `_` for `-`";
    MACRO_NUMBER_NAME = "QRT0712", "an unknown name in a number",
        "Define it: `const NAME: f64 = 1.0;`";
    MACRO_CONSTANT = "QRT0713", "a constant that is not in its form",
        "Write `const NAME: f64 = 1.0;`";
    MACRO_NAME_TAKEN = "QRT0714", "a constant or loop variable whose name is taken",
        "Choose another name";
    MACRO_LABEL = "QRT0715", "two labels of one name",
        "Rename one of them, or leave it out";
    MACRO_LOOP = "QRT0716", "a loop that is not in its form",
        "Write `for i in 0..4 { ... }` or `for i in [1, 2, 5] { ... }`";
    MACRO_LOOP_ENDS = "QRT0717", "a loop that does not run from one whole number to another",
        "Write whole numbers on both sides of `..`";
    MACRO_LOOP_SIZE = "QRT0718", "loops that take too many passes",
        "Put large geometry into mesh files (OBJ, PLY, glTF)";
    MACRO_LOOP_ENTRY = "QRT0719", "an entry that cannot be repeated",
        "Put it outside the loop";
    MACRO_MAP = "QRT0720", "a map that is not `|u, v| (x, y, z)`",
        "Write `|u, v| (x, y, z)`, with three expressions in u and v";
    MACRO_MATERIAL = "QRT0721", "a material within the braces of what is made of it",
        "Write it before the braces: `mesh: white { ... }`";
    MACRO_DEPTHS = "QRT0722", "depths both within and beside `sampling`",
        "Keep one of the two";
    MACRO_PRECISION = "QRT0723", "a precision beside the number format",
        "Keep one of the two";
    MACRO_ATTRIBUTE = "QRT0724", "an attribute within a scene",
        "Put attributes before the scene; within it there are doc comments only";
    MACRO_SCENE_TWICE = "QRT0730", "two scenes of one name in one `qrt!`",
        "Rename one of the two";
    REV_ASSIGNMENT = "QRT0801", "an assignment, which forgets what was there",
        "Write `+=`, `-=` or `^=`, which can be undone";
    REV_ALIAS = "QRT0802", "a statement that reads what it changes",
        "Copy what is read into a scratch register first";
    REV_EARLY_EXIT = "QRT0803", "a way out that would skip an uncompute",
        "Let every statement run; write `if` for what depends on a bit";
    REV_DIRTY = "QRT0804", "a scratch register that is computed and never uncomputed",
        "Compute it in `within!` and use it in `apply!`";
    REV_WITHIN = "QRT0805", "an `apply!` that changes what its `within!` computed from",
        "Change it before or after the two";
    REV_WIDTH = "QRT0806", "a number with more bits than its target",
        "Use a wider target, or `wrapping(..)` for its lowest bits";
    REV_FORMAT = "QRT0807", "a number of another format than its target",
        "Use a target that can be negative or has the fraction bits, or `wrapping(..)` or `floor(..)`";
    REV_CONSTANT = "QRT0808", "a constant that its format does not have",
        "Write a multiple of the format's lowest bit";
    REV_CONDITION = "QRT0809", "a condition that is changed in its own branch",
        "Change it after the `if`, or copy the bit into a scratch register first";
    REV_NOT_A_BIT = "QRT0810", "a number where a bit is needed",
        "Write a bit such as `a[0]`, a `Bool` or a comparison";
    REV_LOOP = "QRT0811", "a loop that is not over constants",
        "Write `for i in 0..8`, with constant bounds";
    REV_CALL = "QRT0812", "a call of something that is not reversible",
        "Call functions marked `#[reversible]` by name";
    REV_ARGUMENT = "QRT0813", "an argument that is not a register",
        "Write `&x` to let it be read and `&mut x` to let it be changed";
    REV_STATEMENT = "QRT0814", "a statement that has no inverse",
        "Write updates, `swap`, `if`, `for`, calls, scratch registers, `within!` and `apply!`";
    REV_OPERATOR = "QRT0815", "an operator that has no inverse, or none here",
        "Write `+=`, `-=` or `^=`";
    REV_NAME = "QRT0816", "an unknown name",
        "Compare with the nearest name";
    REV_TAKEN = "QRT0817", "a name that is taken",
        "Choose another name";
    REV_READ_ONLY = "QRT0818", "a change of what can only be read",
        "Take the register by `&mut`";
    REV_INDEX = "QRT0819", "a bit beyond a register's last",
        "Count bits from 0";
    REV_PARAMETER = "QRT0820", "a parameter that is not a register",
        "Write `x: &UInt<8>`, or `&mut` if it is changed";
    REV_RESULT = "QRT0821", "a result",
        "Add it to a `&mut` parameter";
    REV_SIGNATURE = "QRT0822", "a function that cannot be reversible",
        "Write a plain `fn`";
    REV_GENERIC = "QRT0823", "a generic parameter that is not a constant",
        "Write `const W: u32`";
    REV_UNUSED = "QRT0824", "a scratch register that nothing is computed into",
        "Remove it";
    REV_SCRATCH = "QRT0825", "a declaration that is not a scratch register's",
        "Write `let mut t: UInt<8> = 0;`";
    REV_PAIR = "QRT0826", "one of `within!` and `apply!` without the other",
        "Write `within! { .. } apply! { .. }`";
    REV_FORMAT_NAME = "QRT0827", "a type that is not a register's format",
        "Choose `UInt<W>`, `Int<W>`, `Fixed<I, F>`, `UFixed<I, F>` or `Bool`";
    REV_EXPRESSION = "QRT0828", "an expression that is not computed reversibly",
        "Write registers, constants, `+ - * << >>`, slices, comparisons, `! & | ^` of bits";
    REV_TOO_WIDE = "QRT0829", "a register or a number of more than 63 bits",
        "Use fewer bits";
    REV_ITEM = "QRT0830", "`#[reversible]` on something that is not a function",
        "Put it on a function, without arguments";
    REV_CHANGE_TWICE = "QRT0831", "a register handed over twice that is changed",
        "Hand over different registers";
    REV_ZERO = "QRT0832", "a claim of zero that is not of a scratch register",
        "Write `assert_zero!(t);` in the block of `let mut t: UInt<8> = 0;`";
    SET_SYNTAX = "QRT0901", "an override that is not key=value",
        "Write `--set sampling.path_bits=14` or `--set 'film={ width: 8, height: 8 }'`";
    SET_PLACE = "QRT0902", "an override of something that is not there",
        "Name a key of the scene format, and list elements that exist";
    NO_COUNTERPART = "QRT0903", "a material that another renderer does not have",
        "Give these faces another material for the comparison";
}

/// Returns the table row of `code`; `None` if there is no such code.
pub fn lookup(code: &str) -> Option<&'static Code> {
    TABLE.iter().find(|row| row.code == code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_distinct_and_in_order() {
        assert!(TABLE.windows(2).all(|pair| pair[0].code < pair[1].code));
        assert_eq!(lookup("QRT0302").map(|row| row.code), Some(ZERO_AREA));
        assert_eq!(lookup("QRT0000"), None);
    }
}
