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
mod native;
mod paths;
mod repeats;
mod stub;
#[cfg(test)]
mod tests;

pub(crate) use stub::stub;

use names::Names;
use proc_macro2::TokenStream;
use qrt_core::oracle::{CallCost, Oracle, OracleCost, check_budget, oracle_costs_knowing};
use qrt_scene::syntax::Problem;
use qrt_scene::valid::ValidScene;
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
    let recorded = Oracle::rgb_and_costs(valid);
    let (oracle, costs) = recorded.map_err(|error| vec![error.problem()])?;
    keep_budget(valid, &costs)?;
    let [red, green, blue] = costs;
    let most = red.dearer(green).dearer(blue);
    let mut out = format!("{conditions}\n");
    out.push_str(&figures(scene, public, valid, &oracle, most.call));
    paths::write(&mut out, scene, public, conditions, valid);
    paths::numbers(&mut out, scene, public, conditions, (labels, valid));
    if oracle.program.ops.len() <= MOST {
        let names = Names::new(&oracle);
        let layout = fields::write(&mut out, scene, public, conditions, &oracle);
        let _ = writeln!(
            out,
            "
            {conditions}
            #[allow(warnings, clippy::all, clippy::pedantic, reason = \"written by `qrt!`\")]
            const _: () = {{
            // A name that nothing of what is imported below has.
            type __Scene = {scene};
            const _: () = {{
            use ::qrt::core::compile::{{NamedPlace, PixelWord, Place}};
            use ::qrt::scene::sampling::{{Axis::{{U, V}}, Coordinate, Square::{{Light, Ray}}}};
            use ::qrt::circuit::{{
                Bit, BlockId, Declaration, Machine, Multiples, Operand, RegisterId, Style, Tag,
                Type, Word,
            }};
            use ::qrt::core::oracle::Channel;
            use ::qrt::core::oracle::compiled::{{
                BlockDeclaration, CompiledOracle, Computed, Field, Outline, Vector,
            }};
            use ::qrt::core::tracer::{{Named, Quantity}};
            use ::qrt::runtime::path_machines::native::{{
                Integers, NativeOracle, Truths, Vectors, block, word,
            }};"
        );
        let _ = writeln!(
            out,
            "impl __Scene {{
                /// Registers of the numbers of a path, ray by ray.
                {public} const LAYOUT: {scene}Layout = {layout};
            }}"
        );
        data::write(&mut out, &oracle);
        code::write(&mut out, &oracle, &names);
        native::write(&mut out, &oracle, &names);
        out.push_str("};\n};\n");
    }
    Ok(out)
}

/// Reports the oracles of the scene that exceed its budget. Oracles whose costs are not `known`, of
/// pixels of another class, are compiled for that.
fn keep_budget(valid: &ValidScene, known: &[OracleCost]) -> Result<(), Vec<Problem>> {
    if valid.scene().budget.is_none() {
        return Ok(());
    }
    let costs = oracle_costs_knowing(valid, known);
    check_budget(valid, &costs.map_err(|error| vec![error.problem()])?)
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
            {public} const QUBITS: u64 = {qubits};
            /// Toffoli gates of a call of the oracle of the channel that has the most.
            {public} const TOFFOLI: u64 = {toffoli};
            /// A pixel has `2^PATH_BITS` paths.
            {public} const PATH_BITS: u32 = {path_bits};
            /// Qubits of the comparator.
            {public} const COMPARATOR_BITS: u32 = {comparator_bits};
            /// Bits after the point of every number.
            {public} const FRACTION_BITS: u32 = {fraction};
            /// Rays on a path.
            {public} const DEPTH: usize = {depth};
            /// Columns and rows of the film.
            {public} const FILM: [u32; 2] = {film:?};
            /// By channel (red, green, blue): the proven bound on a path's colour, in radiance.
            {public} const SCALE: [f64; 3] = {scale:?};
            /// Operations from a path's id to its three colours.
            {public} const OPERATIONS: usize = {operations};
        }}
"
    )
}
