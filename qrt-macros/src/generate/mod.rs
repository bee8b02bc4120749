//! From a checked scene to Rust: its circuit's figures, its layout of registers, and its compute and
//! uncompute as straight-line code.
//!
//! The code is written as text and read back as tokens. It is long, and an unoptimised macro takes
//! many times the time to make it token by token.

mod code;
mod data;
mod fields;
mod lines;
mod names;
mod paths;
mod repeats;
#[cfg(test)]
mod tests;

pub(crate) use paths::about;

use names::{Names, beside};
use proc_macro2::TokenStream;
use qrt_core::oracle::{CallCost, Oracle, OracleOptions, Oracles, check_budget};
use qrt_scene::Scene;
use qrt_scene::valid::ValidScene;
use qrt_syntax::Problem;
use std::fmt::Write as _;

/// The most operations of a circuit that becomes code. The code of more would take minutes to
/// compile.
const MOST: usize = 20_000;

/// Returns the code beside the struct of a scene and its function `scene()`. It takes the scene's
/// name, its visibility, the `cfg`s on it, and by primitive the label that its author gave it.
///
/// # Errors
/// A scene without a circuit, or with a circuit that exceeds its budget.
pub(crate) fn scene(
    name: &str,
    visibility: &str,
    conditions: &str,
    (labels, valid): (&[Option<String>], &ValidScene),
) -> Result<TokenStream, Vec<Problem>> {
    let text = text(name, visibility, conditions, (labels, valid))?;
    Ok(parsed_text(&text))
}

/// Returns the constant data of a scene: see [`qrt_scene::front::Item`].
pub(crate) fn items(scene: &Scene) -> TokenStream {
    // The items' debug form is Rust code.
    let text = format!(
        "{{ #[allow(unused_imports)]
            use ::qrt::scene::front::Item::{{Bool, List, Map, Number, Text}};
            &{:?} }}",
        scene.encode().items()
    );
    parsed_text(&text)
}

/// The tokens of text that this module wrote.
fn parsed_text(text: &str) -> TokenStream {
    // Tests read all kinds of this text; text that they miss must not vanish.
    let unread = || quote::quote!(::core::compile_error! { "the circuit's code cannot be read" });
    if proc_macro::is_available() {
        // The compiler's own parser is optimised, unlike the macro.
        let read = text.parse::<proc_macro::TokenStream>();
        return read.map_or_else(|_| unread(), TokenStream::from);
    }
    text.parse().unwrap_or_else(|_| unread())
}

/// Returns the result of [`scene`] as text.
fn text(
    scene: &str,
    public: &str,
    conditions: &str,
    (labels, valid): (&[Option<String>], &ValidScene),
) -> Result<String, Vec<Problem>> {
    let oracles = Oracles::new(valid);
    // The class that serves all pixels.
    let class = OracleOptions::default().class;
    let recorded = oracles.with_costs(class);
    let (oracle, [red, green, blue]) = recorded.map_err(|error| vec![error.problem()])?;
    keep_budget(&oracles)?;
    let most = red.dearer(green).dearer(blue);
    // The names of the types beside the scene's are no names of the author's module.
    let mut out = format!("{conditions}\nconst _: () = {{\n");
    out.push_str(&figures(scene, public, valid, &oracle, most.call));
    paths::write(&mut out, scene, public, valid);
    paths::numbers(&mut out, scene, public, (labels, valid));
    if oracle.program.ops.len() <= MOST {
        let names = Names::new(&oracle);
        let layout = fields::write(&mut out, scene, public, &oracle);
        let _ = writeln!(
            out,
            "
            #[allow(warnings, clippy::all, clippy::pedantic, reason = \"written by `qrt!`\")]
            const _: () = {{
            // A name that nothing of what is imported below has.
            type __Scene = {scene};
            const _: () = {{
            // The author's own items may have any of these names.
            use ::core::clone::Clone;
            use ::core::convert::{{From, Into}};
            use ::core::default::Default;
            use ::core::iter::{{IntoIterator, Iterator}};
            use ::core::marker::{{Copy, Send, Sized, Sync}};
            use ::core::ops::{{Drop, Fn, FnMut, FnOnce}};
            use ::core::option::Option::{{self, None, Some}};
            use ::core::primitive::{{
                bool, f32, f64, i8, i16, i32, i64, i128, str, u8, u16, u32, u64, u128, usize,
            }};
            use ::core::result::Result::{{self, Err, Ok}};
            use ::qrt::core::compile::{{NamedPlace, PixelWord, ValuePlace}};
            use ::qrt::scene::sampling::{{Axis::{{U, V}}, Coordinate, Square::{{Light, Ray}}}};
            use ::qrt::circuit::{{
                Bit, BlockId, Declaration, Machine, Multiples, Operand, RegisterId, Style, Tag,
                Type, When, Word,
            }};
            use ::qrt::core::oracle::Channel;
            use ::qrt::core::oracle::compiled::{{
                BlockDeclaration, CompiledOracle, Computed, Field, Outline, Vector,
            }};
            use ::qrt::tracer::{{Named, Quantity}};"
        );
        let ty = beside(scene, "LAYOUT");
        let _ = writeln!(
            out,
            "impl __Scene {{
                /// Registers of the numbers of a path, ray by ray.
                {public} const LAYOUT: {ty} = {layout};
            }}"
        );
        data::write(&mut out, &oracle);
        code::write(&mut out, &oracle, &names);
        out.push_str("};\n};\n");
    }
    out.push_str("};\n");
    Ok(out)
}

/// Reports the oracles of the scene that exceed its budget.
fn keep_budget(oracles: &Oracles<'_>) -> Result<(), Vec<Problem>> {
    if oracles.scene().scene().budget.is_none() {
        return Ok(());
    }
    let costs = oracles.costs().map_err(|error| vec![error.problem()])?;
    check_budget(oracles.scene(), &costs)
}

/// Returns the constants of the circuit's properties and costs.
fn figures(
    scene: &str,
    public: &str,
    valid: &ValidScene,
    oracle: &Oracle,
    cost: CallCost,
) -> String {
    let CallCost { qubits, toffoli } = cost;
    let film = oracle.film;
    let path_bits = oracle.points.path_bits();
    let comparator_bits = oracle.comparator_bits();
    let depth = valid.scene().sampling.depths.len();
    let operations = oracle.program.ops.len();
    let fraction = oracle.fraction;
    let mut scale = [0.0; 3];
    for channel in &oracle.channels {
        scale[channel.number] = channel.scale;
    }
    format!(
        "#[allow(dead_code, reason = \"an author asks for some of them only\")]
        impl {scene} {{
            /// The most qubits in use at any time during a call of the oracle of the channel that
            /// has the most Toffolis.
            {public} const QUBITS: ::core::primitive::u64 = {qubits};
            /// Toffoli gates of a call of the oracle of the channel that has the most.
            {public} const TOFFOLI: ::core::primitive::u64 = {toffoli};
            /// A pixel has `2^PATH_BITS` paths.
            {public} const PATH_BITS: ::core::primitive::u32 = {path_bits};
            /// Qubits of the comparator.
            {public} const COMPARATOR_BITS: ::core::primitive::u32 = {comparator_bits};
            /// Bits after the point of every number.
            {public} const FRACTION_BITS: ::core::primitive::u32 = {fraction};
            /// Rays on a path.
            {public} const DEPTH: ::core::primitive::usize = {depth};
            /// Columns and rows of the film.
            {public} const FILM: [::core::primitive::u32; 2] = {film:?};
            /// By channel (red, green, blue): the proven bound on a path's colour, in radiance.
            {public} const SCALE: [::core::primitive::f64; 3] = {scale:?};
            /// Operations from a path's id to its three colours.
            {public} const OPERATIONS: ::core::primitive::usize = {operations};
        }}
"
    )
}
