//! What can be wrong, concept by concept: each problem with its code, its arguments and the words that
//! the author of a scene's text reads. The macro words some of them otherwise, by their variants.

#![allow(
    missing_docs,
    reason = "a variant is documented by its words, an argument by its name"
)]

use super::name::{listed, nearest};
use super::number::{grouped, number, rounded};
use super::tree::{Found, Kind, Scalar, shorten};
use std::fmt;

/// A problem in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    /// The stable code of the problem: `QRT0101`.
    pub code: &'static str,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// What stands beside the caret; may be empty.
    pub label: String,
    /// The right thing to write; none if nothing can be advised.
    pub help: Option<String>,
    /// What the other place is that matters: "first written here"; may be empty.
    pub also: &'static str,
}

/// `"a {text}"` with the arguments put in, or `{ an expression }`.
macro_rules! text {
    () => { String::new() };
    ($text:literal) => { format!($text) };
    ({ $($text:tt)* }) => { { $($text)* } };
}

/// A help, or the expression of an optional one.
macro_rules! help {
    () => { None };
    ($text:literal) => { Some(format!($text)) };
    ({ $($text:tt)* }) => { { $($text)* } };
}

macro_rules! problems {
    ($(
        $(#[$doc:meta])*
        $concept:ident {
            $(
                $problem:ident $({ $($argument:ident: $type:ty),* $(,)? })? = $code:ident $message:tt
                $(label $label:tt)? $(help $help:tt)? $(also $also:literal)?;
            )*
        }
    )*) => {
        /// What is wrong, by concept and with its arguments.
        #[derive(Clone, Debug, PartialEq)]
        pub enum What {
            $( $(#[$doc])* $concept($concept), )*
            /// What another reader has put into words.
            Told(Box<Words>),
            /// A problem where `auto` would do.
            OrAuto(Box<What>),
        }

        impl What {
            /// How a scene's text is told of it.
            pub fn words(&self) -> Words {
                match self {
                    $( Self::$concept(what) => what.words(), )*
                    Self::Told(words) => Words::clone(words),
                    Self::OrAuto(what) => {
                        let mut words = what.words();
                        words.help.get_or_insert_with(|| "or write `auto`".to_owned());
                        words
                    }
                }
            }
        }

        $(
            $(#[$doc])*
            #[derive(Clone, Debug, PartialEq)]
            pub enum $concept {
                $( $problem $({ $($argument: $type),* })?, )*
            }

            impl $concept {
                #[allow(unused_variables, clippy::useless_format)]
                fn words(&self) -> Words {
                    match self {
                        $( Self::$problem $({ $($argument),* })? => Words {
                            code: super::codes::$code,
                            message: text!($message),
                            label: text!($($label)?),
                            help: help!($($help)?),
                            also: concat!($($also)?),
                        }, )*
                    }
                }
            }

            impl From<$concept> for What {
                fn from(what: $concept) -> Self {
                    Self::$concept(what)
                }
            }
        )*
    };
}

problems! {
    /// Of a scene's file.
    File {
        Folder = UNREADABLE "this is a folder" help "name a scene file";
        Irregular = UNREADABLE "this is not a regular file" help "name a scene file";
        Missing = UNREADABLE "there is no such file"
            help "check the path, or start a scene with `qrt new NAME`";
        Outside = OUTSIDE "the file is outside the crate's folder"
            help "`qrt!` reads files of the crate alone";
        Denied = UNREADABLE "you may not read this file";
        Failed { why: String } = UNREADABLE "the file cannot be read: {why}";
        TooLarge { most: u64 } = TOO_LARGE { format!("the file is larger than {} MiB", most >> 20) }
            help "put large geometry into OBJ meshes";
        NotUtf8 { byte: usize, line: usize } = NOT_UTF8
            "the file is not UTF-8 text: byte {byte}, on line {line}" help "save it as UTF-8";
    }

    /// Of a text as YAML.
    Yaml {
        Syntax { why: String, has_tab: bool, is_invisible: bool } = SYNTAX "not YAML: {why}"
            help { match (has_tab, is_invisible) {
                (true, _) => Some("indent with spaces: YAML has no tabs in its indentation".into()),
                (_, true) => Some("remove the invisible character".into()),
                _ => None,
            } };
        Empty = EMPTY "the scene is empty" help "`qrt new NAME` writes a scene to start from";
        DuplicateKey { key: String } = DUPLICATE_KEY
            { format!("the key `{}` is written twice", shorten(key)) }
            label "again here" help "keep one of the two" also "first written here";
        SecondDocument = SECOND_DOCUMENT "a second YAML document starts here"
            help "a file holds one scene";
        Tag { tag: String } = TAG { format!("the YAML tag `{}` has no meaning here", shorten(tag)) }
            help "remove it: a value's type follows from its place in the scene";
        MergeKey = MERGE_KEY "merge keys are not part of YAML 1.2"
            help "write the entries out; whole values can be shared by `*alias`";
        ComplexKey = COMPLEX_KEY "a key must be a word or a text"
            help "a list, a map, an alias or nothing cannot be a key";
        UnknownAlias = ALIAS "this alias has no anchor before it"
            help "write `&name` before the value it stands for";
        RecursiveAlias = ALIAS "this alias stands within its own anchor"
            help "a value cannot contain itself";
        AliasBudget { most: usize } = ALIAS_BUDGET
            "aliases expand to more than {most} values by here"
            help "put large geometry into OBJ meshes";
        AliasBytes { most: usize } = ALIAS_BUDGET
            { format!("aliases expand to more than {} MiB of text by here", most >> 20) }
            help "use shorter names and expressions, or fewer aliases";
        TooMany { most: usize } = TOO_LARGE "the scene holds more than {most} values by here"
            help "put large geometry into OBJ meshes";
        TooDeep { most: usize } = TOO_DEEP "more than {most} levels of nesting"
            help "a scene needs fewer than ten";
    }

    /// Of an override of the command line.
    Override {
        NotAPair = SET_SYNTAX "an override is written key=value"
            help "write it as `--set sampling.path_bits=14`";
        NotAnIndex = SET_SYNTAX "an index is a whole number from 0"
            help "write it as `--set sampling.path_bits=14`";
        NoKey = SET_SYNTAX "a key is missing here" help "write it as `--set sampling.path_bits=14`";
        NoFirstKey = SET_SYNTAX "an override begins with a key"
            help "write it as `--set sampling.path_bits=14`";
        NoValue = SET_SYNTAX "the value is missing here"
            help "write it as `--set sampling.path_bits=14`";
        NoElement { index: usize, count: usize } = SET_PLACE
            "there is no element {index}: the list has {count}";
        NotAList { index: usize, found: Found } = SET_PLACE
            "there is no element {index} in {found}";
        NotAMap { key: String, found: Found } = SET_PLACE "there is no key `{key}` in {found}";
    }

    /// Of a scene's structure: keys, and the kinds of their values.
    Structure {
        WrongType { expected: Expected, found: Found } = WRONG_TYPE
            "expected {expected}, found {found}"
            label { format!("not {}", expected.kind()) } help { expected.help(found) };
        WrongLength { expected: usize, found: Found } = WRONG_LENGTH
            "expected a list of {expected}, found {found}" label "must have {expected} elements";
        WrongChannels { found: Found } = WRONG_LENGTH "expected one expression or three, found {found}"
            help "one expression means grey; three are red, green and blue";
        UnknownKey { key: String, noun: &'static str, keys: Vec<&'static str> } = UNKNOWN_KEY
            { format!("unknown key `{}` in {noun}", shorten(key)) }
            help { meant(key, keys).or_else(|| {
                Some(format!("the keys of {noun} are {}", listed(keys, "and")))
            }) };
        MissingKeys { noun: &'static str, keys: Vec<&'static str> } = MISSING_KEY
            { format!("{noun} lacks {}", listed(keys, "and")) }
            label { format!("{} missing here", listed(keys, "and")) };
        NotOneKind { noun: &'static str, count: usize, known: Option<String>, kinds: Names }
            = ONE_VARIANT "{noun} is of exactly one kind, found {count} keys"
            help { Some(match known {
                Some(known) => format!("keep one key; what describes the `{known}` goes inside its map"),
                None => format!("write one of the keys {}", listed(kinds, "or")),
            }) };
        UnknownKind { name: String, noun: &'static str, kinds: Names } = UNKNOWN_VARIANT
            { format!("no kind of {} is called `{}`", without_article(noun), shorten(name)) }
            help { meant(name, kinds).or_else(|| Some(format!("there are {}", listed(kinds, "and")))) };
        UnknownWord { word: String, noun: &'static str, words: Names } = UNKNOWN_WORD
            { format!("no {} is called `{}`", without_article(noun), shorten(word)) }
            help { meant(word, words).or_else(|| Some(format!("write {}", listed(words, "or")))) };
    }

    /// Of a single value.
    Datum {
        Unrepresentable { text: String, is_small: bool } = UNREPRESENTABLE
            { format!("{text} is too {} for 64 bits", if *is_small { "small" } else { "large" }) };
        NotFinite { value: f64 } = NOT_FINITE { format!("{} is not a finite number", number(*value)) };
        OutOfRange { value: f64, range: Range } = OUT_OF_RANGE
            { format!("{} is out of range", number(*value)) } label "must be {range}";
        NotAlbedo { value: f64, range: Range } = ALBEDO
            { format!("{} is not an albedo or reflectance", number(*value)) } label "must be {range}";
        NotRadiance { value: f64, range: Range } = RADIANCE
            { format!("{} is not a radiance", number(*value)) } label "must be {range}";
        WholeOutOfRange { value: f64, low: u64, high: u64 } = OUT_OF_RANGE
            { format!("{} is out of range", number(*value)) }
            label "must be a whole number from {low} to {high}";
        EmptyText = EMPTY_NAME "this text is empty";
        EmptyName = EMPTY_NAME "this name is empty";
        NoRay = NO_DEPTH "a path has at least one ray";
    }

    /// Of materials' names, and of what they reflect.
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
    }

    /// Of a scene as another renderer reads it.
    Renderer {
        NoCounterpart { renderer: &'static str, name: String, kind: &'static str } = NO_COUNTERPART
            { format!("{renderer} has no counterpart of the `{kind}` of `{}`", shorten(name)) }
            help { Some(match *kind {
                "phong" => "a `phong` without `specular` is matte, and is exported".to_owned(),
                _ => "a map and a value of one's own are qrt's alone: use another material".to_owned(),
            }) };
    }

    /// Of the camera.
    Camera {
        NoView = CAMERA_TARGET "the camera looks at the point it stands on"
            label "same as `eye`" also "the camera stands here";
        NoUp = CAMERA_UP "`up` is zero: it has no direction";
        UpAlongView = CAMERA_UP "`up` points along the view"
            help "choose an `up` across the view, such as [0, 0, 1]";
    }

    /// Of a primitive's shape.
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
    }

    /// Of a mesh as it is placed.
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
        TooBright { material: String, radiance: f64, most: f64 } = RADIANCE
            { format!("the radiance {} of `{material}` is too large", number(*radiance)) }
            label "must be at most {most:e}";
    }

    /// Of an expression's text.
    Expression {
        TooLong { bytes: usize, most: usize } = EXPR_SIZE
            "expression of {bytes} bytes; the limit is {most}";
        TooDeep { most: usize } = EXPR_SIZE "expression nested deeper than {most}";
        Empty = EXPR_EMPTY "the expression is empty";
        Unexpected { found: String } = EXPR_SYNTAX "unexpected `{found}`"
            help { Some(match found.as_str() {
                ")" => "there is no `(` for this `)`",
                "," => "a comma stands only between a function's operands",
                "=" => "write the value alone, without an equation",
                "**" => "a power is written with `^`",
                _ => "a product is written with `*`",
            }.to_owned()) };
        NoValue { found: Option<String> } = EXPR_SYNTAX
            { match found {
                Some(found) => format!("expected a value, found `{found}`"),
                None => "expected a value, found the end".to_owned(),
            } };
        NeverClosed = EXPR_SYNTAX "this `(` is never closed";
        NotClosed { found: String } = EXPR_SYNTAX "expected `)`, found `{found}`"
            help "a product is written with `*`";
        NoValueHere { name: String, allowed: Vec<&'static str> } = EXPR_VARIABLE
            "`{name}` has no value here"
            help { (!allowed.is_empty()).then(|| format!("this may depend on {}", allowed.join(", "))) };
        UnknownName { name: String, near: Option<&'static str>, allowed: Vec<&'static str> } = EXPR_NAME
            "unknown name `{name}`"
            help { Some(match (name.as_str(), near) {
                ("e", _) => "Euler's number is `exp(1)`".to_owned(),
                (_, Some(near)) => format!("did you mean `{near}`?"),
                (_, None) => format!("this may depend on {}, pi", allowed.join(", ")),
            }) };
        UnknownFunction { name: String, functions: Vec<&'static str> } = EXPR_NAME
            "unknown function `{name}`"
            help { match name.as_str() {
                "ln" => Some("the natural logarithm is `log`".to_owned()),
                _ => meant(name, functions)
                    .or_else(|| Some(format!("there are {}", functions.join(", ")))),
            } };
        NotAFunction { name: String } = EXPR_OPERANDS "`{name}` is not a function"
            help "a product is written with `*`";
        NoOperands { name: String, wanted: usize } = EXPR_OPERANDS
            "the function `{name}` has no operands"
            help { Some(match wanted {
                2 => format!("write `{name}(u, v)`"),
                4 => format!("write `{name}(a, b, x, y)`: x where a < b, y elsewhere"),
                _ => format!("write `{name}(u)`"),
            }) };
        Operands { name: String, wanted: usize, given: usize } = EXPR_OPERANDS
            { let s = if *wanted == 1 { "" } else { "s" };
              format!("`{name}` takes {wanted} operand{s}, not {given}") };
        TooLarge { text: String } = EXPR_NUMBER "`{text}` is too large";
        NotANumber { text: String } = EXPR_NUMBER "`{text}` is not a number";
    }

    /// Of what a BSDF's expressions mean; points are those of the unit square.
    Bsdf {
        Channels { count: usize } = BSDF_CHANNELS
            "a BSDF has one value (grey) or three (RGB), not {count}";
        OffSphere { off: f64, at: [f64; 2] } = MAP_OFF_SPHERE
            { let length = match off {
                off if off.abs() < 1e-4 => format!("1 + {off:e}"),
                off => rounded(1.0 + off),
              };
              format!("the map leaves the unit sphere: its length is {length} at {}", point(*at)) }
            help "a direction has length 1: x^2 + y^2 + z^2 must be 1 for every u and v";
        NoDirection { at: [f64; 2] } = MAP_UNDEFINED
            { format!("this component of the map has no value at {}", point(*at)) }
            help "it must be finite for every u and v between 0 and 1";
        NoSlope { at: [f64; 2] } = MAP_UNDEFINED
            { format!("this component of the map has no finite slope at {}", point(*at)) }
            help "the Jacobian needs its derivatives between 0 and 1";
        Flat { around: [f64; 2] } = MAP_FLAT
            { format!("the map takes a whole area of the square to a line or a point, as around {}",
                point(*around)) }
            help "the direction must change with u and with v, along different ways";
        CoversTwice { around: [f64; 3], times: f64, whole: f64 } = MAP_COVERS_TWICE
            { covered(*around, *times, *whole) }
            help { Some(once()) };
        LeavesOut { around: [f64; 3], times: f64, whole: f64 } = MAP_LEAVES_OUT
            { covered(*around, *times, *whole) }
            help { Some(once()) };
        OnlyBelow = MAP_LEAVES_OUT
            "the map reaches directions below the surface alone: its third component is negative"
            help "the third component is the cosine to the normal: write `sqrt(1-u)` for `-sqrt(1-u)`";
        WrongJacobian { stated: f64, right: f64, at: [f64; 2], mistake: Mistake } = JACOBIAN_MISMATCH
            { format!("the stated Jacobian is {} at {}, but |dphi/du x dphi/dv| = {}",
                rounded(*stated), point(*at), rounded(*right)) } help "{mistake}";
        Negative { value: f64, at: Variables } = BSDF_NEGATIVE
            { format!("the value is negative: {} at {}", rounded(*value), situation(at)) }
            help "`max(0, ...)` cuts the negative part off";
        Undefined { is_infinite: bool, at: Variables } = BSDF_UNDEFINED
            { let what = if *is_infinite { "is infinite" } else { "has no value" };
              format!("the BSDF {what} at {}", situation(at)) }
            help "it must be finite for every pair of directions above the surface";
        GainsEnergy { albedo: f64, seen: Option<f64> } = BSDF_ENERGY
            { let seen = seen.map_or_else(String::new, |cos_o| {
                format!(", seen at cos_o = {}", rounded(cos_o))
              });
              format!("the BSDF gains energy: {} of the light that arrives leaves{seen}",
                rounded(*albedo)) }
            help { Some(format!(
                "the integral of value * |cos_i| over all directions must not pass 1: scale the value \
                 by {} or less", rounded(rounded_down(albedo.recip())))) };
        WrongPdf { stated: f64, right: f64, at: [f64; 2], mistake: Mistake } = PDF_MISMATCH
            { format!("the stated density is {} at {}, but 1 / |dphi/du x dphi/dv| = {}",
                rounded(*stated), point(*at), rounded(*right)) } help "{mistake}";
        PdfOfTheSquare = PDF_MISMATCH
            "a density is a function of directions: the value must not depend on u or v beside it"
            help "write the value in cos_i, cos_o, cos_a; or leave `pdf` out";
        PdfBeyondMap { whole: f64 } = PDF_MISMATCH
            { format!("the density integrates to {} over the hemisphere: the map leaves directions \
                out", rounded(*whole)) }
            help "let the map reach every direction, or leave `pdf` out";
        PdfBelow = PDF_MISMATCH "the map goes below the surface, where no lamp is sampled"
            help "leave `pdf` out";
        NotReciprocal { there: f64, back: f64, at: [f64; 2] } = NOT_RECIPROCAL
            { let [i, o] = at.map(rounded);
              format!("the value is {} at cos_i = {i}, cos_o = {o}, but {} with the two exchanged: \
                  light does not go this way as it goes the other", rounded(*there), rounded(*back)) }
            help "let cos_o enter as cos_i does, as in (1 + cos_i)*(1 + cos_o)";
        Unbounded = BSDF_UNBOUNDED "no bound of the weight value * |phi_z| * J can be shown"
            help "choose a map that sends more points where the value is large; a denominator that \
                  vanishes at grazing angles needs a small number more, as in 1/(cos_i + cos_o + 1e-3)";
    }

    /// Of paths, comparators and accuracy.
    Sampling {
        PrimaryMap = PRIMARY_MAP "the primary ray has no map: it samples the pixel square"
            help "remove it; the maps of reflected rays start with the second entry";
        PrimaryLight = PRIMARY_LIGHT "the primary ray leaves no surface that a lamp could light"
            help "remove it; the second entry's ray leaves the first surface";
        TooManyDepths { dimensions: usize, most: usize } = TOO_MANY_DIMENSIONS
            "the depths need {dimensions} dimensions: the net has {most}"
            help "use fewer depths, or `product-lattice`";
        FewLightBits { lamps: usize, bits: u32, needed: u32 } = FEW_LIGHT_BITS
            { format!("{lamps} polygons emit, and {bits} bits choose among {}", 1_u64 << bits) }
            help "write {needed} bits or more here";
        LightUnbounded { surface: String } = LIGHT_UNBOUNDED
            "no bound of next-event estimation can be shown: a lamp may touch a surface of `{surface}`"
            help "write `mis`, whose weights never pass 1, or `auto`";
        NoLamp = LIGHT_UNUSED "nothing emits: there is no lamp to sample" help "remove it";
        NoReceiver = LIGHT_UNUSED
            "no surface reflects to more than single directions and tells how densely: none can \
             sample a lamp" help "remove it";
        TooManyIds { path: u32, comparator: u32, most: u32 } = TOO_MANY_IDS
            { format!("{path} path bits and {comparator} comparator bits make 2^{} indices: at most \
                2^{most} fit", path.saturating_add(*comparator)) }
            help "use fewer of either" also "with these";
        TooManyPaths { sum: u32, most: u32 } = TOO_MANY_IDS
            "the bits add up to {sum}: a lattice of at most 2^{most} paths"
            help "use fewer bits; a bit more in each of six coordinates is 64 times the paths";
        NotTheSum { path: u32, sum: u32 } = PATH_BITS_SUM
            "path_bits is {path}, but the bits add up to {sum}"
            help "under `product-lattice` leave `path_bits` out, or change the bits"
            also "these bits";
        BesideAccuracy { key: &'static str } = ACCURACY_CONFLICT
            "`accuracy` chooses `{key}`, so that both cannot be given"
            help "keep one of the two" also "the accuracy asked for";
        NoStrata { strata: u32, estimator: &'static str, counting: &'static str } = STRATA
            "{strata} strata, and the estimator `{estimator}` counts the whole comparator at once"
            help "use `strata: auto` or 1, or `estimator: {counting}`" also "this estimator";
        TooManyStrata { strata: u32, bits: u32, most: u32 } = STRATA
            "{strata} strata, and a comparator of {bits} bits has at most {most}"
            help "use fewer, or more `comparator.bits`" also "these bits";
        NeverStops { estimator: &'static str, stopping: &'static str } = NEVER_STOPS
            "an error to stop at, and the estimator `{estimator}` does not stop by itself"
            help "leave `error` out, or use `estimator: {stopping}`" also "this estimator";
        Impossible { why: String } = TOO_MANY_IDS "{why}";
    }

    /// Of the circuit that a scene compiles to.
    Circuit {
        Qubits { used: u64, most: u64, auto: bool } = BUDGET_QUBITS
            { over(*used, *most, "qubits") } label { format!("at most {}", grouped(*most)) }
            help { Some(if *auto {
                "no way to lay it out needs fewer; use fewer bits of `precision.fraction`, or a shorter \
                 list of `sampling.depths`; or raise `budget.qubits`"
            } else {
                "`circuit.uncompute: auto` finds the cheapest circuit that fits; or use fewer bits of \
                 `precision.fraction`, or raise `budget.qubits`"
            }.to_owned()) };
        Toffolis { used: u64, most: u64, scoped: bool, running: bool } = BUDGET_TOFFOLI
            { over(*used, *most, "Toffoli gates") } label { format!("at most {}", grouped(*most)) }
            help { let cheaper = match (scoped, running) {
                (true, _) => "`circuit.uncompute: keep` needs fewer gates, for more qubits",
                (_, false) => "`circuit.nearest: running` needs fewer gates",
                _ => "each entry of `sampling.depths` traces the scene once more",
              };
              Some(format!(
                "{cheaper}; or use fewer bits of `precision.fraction`, or raise `budget.toffoli`")) };
        UnboundedQuotient = QUOTIENT_UNBOUNDED
            "an expression of the scene divides by what may be zero, so that no register is wide enough \
             for the quotient" help "keep the divisor away from 0, as in `a / (b + 0.01)`";
        TooWide { what: &'static str, bits: u32, most: u32, whole: u32,
                  value: Option<(&'static str, String)> } = NUMBER_TOO_WIDE
            { match value {
                Some((key, material)) => format!(
                    "a number that `{key}` of the material `{material}` takes on the way needs {bits} \
                     bits and a register has at most {most}"),
                None => format!("{what} needs {bits} bits and a register has at most {most}"),
            } }
            help { Some(match value {
                Some(("exponent", _)) => format!(
                    "lower the exponent, or keep `map: auto`, which samples the lobe and takes no power \
                     of a cosine; numbers may go up to 2^{whole}"),
                Some(_) => format!(
                    "keep every part of it below 2^{whole}, as in `min(1 / x, 100)`; each bit less of \
                     `precision.fraction` doubles that"),
                None => "choose a smaller `precision.fraction`, or bring the camera nearer to the geometry"
                    .to_owned(),
            }) };
        TooManyFaces { faces: usize, most: usize } = TOO_MANY_FACES
            "the scene has {faces} faces, and tables of faces hold at most {most}"
            help "use a coarser mesh";
    }
}

/// What is wrong, and what to do, in one line.
impl fmt::Display for What {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Words { message, help, .. } = self.words();
        f.write_str(&message)?;
        help.map_or(Ok(()), |help| write!(f, "; {help}"))
    }
}

/// Names of a scene's language, in their order.
type Names = &'static [&'static str];
/// Variables of expressions with their values.
type Variables = Vec<(&'static str, f64)>;

/// What stands where a value of another kind is expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expected {
    Number,
    Whole,
    Text,
    Expression,
    Elements(usize),
    List {
        may_be_empty: bool,
    },
    Named,
    Record {
        noun: &'static str,
        keys: Vec<&'static str>,
    },
    Variant {
        noun: &'static str,
        kinds: Names,
    },
    Word {
        noun: &'static str,
        words: Names,
    },
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Record { noun, .. } | Self::Variant { noun, .. } => write!(f, "{noun} (a map)"),
            Self::Word { noun, .. } => write!(f, "{noun} (a word)"),
            _ => f.write_str(&self.kind()),
        }
    }
}

impl Expected {
    /// The kind of value that it is.
    fn kind(&self) -> String {
        match self {
            Self::Number => "a number",
            Self::Whole => "a whole number",
            Self::Text => "a text",
            Self::Expression => "an expression",
            Self::Elements(count) => return format!("a list of {count}"),
            Self::List { .. } => "a list",
            Self::Named => "a map from names",
            Self::Record { .. } | Self::Variant { .. } => "a map",
            Self::Word { .. } => "a word",
        }
        .to_owned()
    }

    fn help(&self, found: &Found) -> Option<String> {
        let bare = |scalar: &Scalar| Scalar {
            quoted: false,
            ..scalar.clone()
        };
        match (self, found) {
            (Self::Number | Self::Whole, Found::Scalar(scalar))
                if scalar.quoted && matches!(bare(scalar).kind(), Kind::Number(_)) =>
            {
                Some("remove the quotes".to_owned())
            }
            (Self::Text, Found::Scalar(scalar)) => {
                Some(format!("put it in quotes: \"{}\"", scalar.text))
            }
            (Self::List { may_be_empty: true }, Found::Nothing) => {
                Some("write `[]` for an empty list".to_owned())
            }
            (Self::Named, Found::Nothing) => Some("write `{}` for none".to_owned()),
            (Self::Record { keys, .. }, _) => {
                Some(format!("write a map with {}", listed(keys, "and")))
            }
            (Self::Variant { kinds, .. }, found) => Some(match found {
                Found::Scalar(scalar)
                    if let Some(kind) = nearest(&scalar.text, kinds.iter().copied()) =>
                {
                    format!("write a map: `{{ {kind}: {{ ... }} }}`")
                }
                _ => format!("write a map with one of the keys {}", listed(kinds, "or")),
            }),
            (Self::Word { words, .. }, _) => Some(format!("write {}", listed(words, "or"))),
            _ => None,
        }
    }
}

/// The numbers from a least to a greatest, which may themselves be left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub low_open: bool,
    pub high: f64,
    pub high_open: bool,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (number(self.low), number(self.high));
        match (self.low_open, self.high_open) {
            (false, false) => write!(f, "from {low} to {high}"),
            (true, false) => write!(f, "above {low} and at most {high}"),
            (false, true) => write!(f, "at least {low} and below {high}"),
            (true, true) => write!(f, "above {low} and below {high}"),
        }
    }
}

/// Some of a mesh's triangles, from the first of them, counted from 0.
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

/// What was stated in place of a map's Jacobian.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    Inverse,
    WithCosine,
    InverseWithCosine,
    Negative,
    Factor(f64),
    Other { right: String },
    Unlike,
    NotInverse,
    Density,
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inverse => {
                "this is 1/J: a change of variables multiplies by J, it does not divide"
            }
            Self::WithCosine => {
                "this is J |z|: the cosine is multiplied in already, J stands without it"
            }
            Self::InverseWithCosine => {
                "this is 1/(J |z|): write J, the solid angle per unit of the square"
            }
            Self::Negative => "this is -J: the Jacobian is a length, not a signed area",
            Self::Factor(factor) => return write!(f, "multiply it by {}", rounded(*factor)),
            Self::Other { right } => return write!(f, "write `{right}`, or `auto`"),
            Self::Unlike => "`jacobian: auto` works it out",
            Self::NotInverse => "this is the Jacobian: the density is 1 over it",
            Self::Density => {
                "write the density of directions per steradian, 1/J, in cos_i, cos_o and cos_a"
            }
        })
    }
}

fn meant(name: &str, names: &[&'static str]) -> Option<String> {
    let near = nearest(name, names.iter().copied())?;
    Some(format!("did you mean `{near}`?"))
}

fn without_article(noun: &str) -> &str {
    let bare = noun.strip_prefix("a ").or_else(|| noun.strip_prefix("an "));
    bare.unwrap_or(noun)
}

fn point([u, v]: [f64; 2]) -> String {
    format!("u = {}, v = {}", rounded(u), rounded(v))
}

/// The number, down to four digits.
fn rounded_down(number: f64) -> f64 {
    let unit = 10_f64.powf(number.log10().floor() - 3.0);
    (number / unit).floor() * unit
}

/// How often a map covers directions.
fn covered(around: [f64; 3], times: f64, whole: f64) -> String {
    let [x, y, z] = around.map(|c| rounded((c * 100.0).round() / 100.0));
    let times = rounded((times * 10.0).round() / 10.0);
    let whole = rounded((whole * 100.0).round() / 100.0);
    format!(
        "the map covers the directions around [{x}, {y}, {z}] {times} times, and counts the \
         reflected light {whole} times on the whole"
    )
}

/// What a map must do.
fn once() -> String {
    "let each direction that the value reflects to come from one point of the square, as with \
     sqrt(u)*cos(2*pi*v), sqrt(u)*sin(2*pi*v), sqrt(1-u)"
        .to_owned()
}

fn situation(variables: &Variables) -> String {
    let shown = variables.iter();
    let shown = shown.map(|(name, value)| format!("{name} = {}", rounded(*value)));
    shown.collect::<Vec<_>>().join(", ")
}

fn over(used: u64, most: u64, what: &str) -> String {
    let (more, used) = (grouped(used - most), grouped(used));
    format!("the circuit has {used} {what}, {more} more than the budget allows")
}
