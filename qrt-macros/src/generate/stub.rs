//! The code beside a scene with errors. With it, the compiler understands the rest of a program,
//! and reports little but the scene's errors.

use proc_macro2::TokenStream;

/// Number of rays in the code of a scene with errors.
const RAYS: usize = 16;

/// The fields that the layout of a scene can have.
const VECTORS: [&str; 2] = ["origin", "direction"];
const NUMBERS: [&str; 14] = [
    "distance",
    "found",
    "face",
    "sample_u",
    "sample_v",
    "throughput_r",
    "throughput_g",
    "throughput_b",
    "origin_x",
    "origin_y",
    "origin_z",
    "direction_x",
    "direction_y",
    "direction_z",
];

/// Returns the code: its figures are 1, its functions never return, and its layout has every field
/// that a layout can have.
pub(crate) fn stub(name: &str, visibility: &str, conditions: &str) -> TokenStream {
    let never = "::core::unreachable!(\"this scene has errors\")";
    let field =
        format!("::qrt::core::oracle::compiled::Field<{name}, ::qrt::circuit::format::Bool>");
    let bool = "::qrt::circuit::format::Bool";
    let vector = format!("::qrt::core::oracle::compiled::Vector<{name}, {bool}, {bool}, {bool}>");
    let place = "::qrt::core::oracle::compiled::Field::new(0, \
                 ::qrt::circuit::Word::unsigned(::qrt::circuit::RegisterId(0), 0, 1))";
    let each = |vectors: &dyn Fn(&str) -> String, numbers: &dyn Fn(&str) -> String| {
        let vectors = VECTORS.iter().map(|name| vectors(name));
        let numbers = NUMBERS.iter().map(|name| numbers(name));
        vectors.chain(numbers).collect::<Vec<_>>().join(", ")
    };
    let fields = each(&|name| format!("pub {name}: {vector}"), &|name| {
        format!("pub {name}: {field}")
    });
    let places = each(
        &|name| {
            format!(
                "{name}: ::qrt::core::oracle::compiled::Vector {{ \
                 x: {place}, y: {place}, z: {place} }}"
            )
        },
        &|name| format!("{name}: {place}"),
    );
    let rays = |text: &str| {
        let rays = (0..RAYS).map(|ray| {
            format!(
                "{}ray{ray}: {text}",
                if text == "RAY" { "" } else { "pub " }
            )
        });
        rays.collect::<Vec<_>>().join(", ")
    };
    let path = (0..RAYS).map(|ray| {
        let ty = "::qrt::core::oracle::paths::RayRegisters";
        format!("pub ray{ray}: {ty}<{bool}, {bool}, {bool}, {bool}, {bool}>")
    });
    let path = path.collect::<Vec<_>>().join(", ");
    let (all, each_is) = (rays(&format!("{name}Ray")), rays("RAY"));
    let text = format!(
        "{conditions}
        #[allow(missing_docs, dead_code)]
        #[derive(Clone, Copy, Debug)]
        {visibility} struct {name}Ray {{ {fields} }}
        {conditions}
        #[allow(missing_docs, dead_code)]
        #[derive(Clone, Copy, Debug)]
        {visibility} struct {name}Layout {{ {all} }}
        {conditions}
        #[allow(missing_docs, dead_code)]
        impl {name} {{
            pub const QUBITS: u64 = 1;
            pub const TOFFOLI: u64 = 1;
            pub const PATH_BITS: u32 = 1;
            pub const COMPARATOR_BITS: u32 = 1;
            pub const FRACTION_BITS: u32 = 1;
            pub const DEPTH: usize = 1;
            pub const FILM: [u32; 2] = [1; 2];
            pub const SCALE: [f64; 3] = [1.0; 3];
            pub const OPERATIONS: usize = 1;
            {visibility} const LAYOUT: {name}Layout = {{
                const RAY: {name}Ray = {name}Ray {{ {places} }};
                {name}Layout {{ {each_is} }}
            }};
        }}
        {conditions}
        #[allow(missing_docs, dead_code)]
        #[derive(Debug)]
        {visibility} struct {name}Path {{ {path},
            pub colour: ::qrt::core::oracle::paths::ColourRegisters<{bool}>,
        }}
        {conditions}
        impl ::qrt::core::oracle::paths::PathScene for {name} {{
            type Path = {name}Path;
            fn scene() -> &'static ::qrt::scene::valid::ValidScene {{ {never} }}
            fn path(_: &mut ::qrt::core::oracle::paths::PathInputs<'_>) -> {name}Path {{ {never} }}
        }}
        {conditions}
        impl ::qrt::core::oracle::compiled::CompiledOracle for {name} {{
            const OUTLINE: &'static ::qrt::core::oracle::compiled::Outline =
                &::qrt::core::oracle::compiled::Outline::NONE;
            fn scene() -> &'static ::qrt::scene::valid::ValidScene {{ {never} }}
            fn within<M: ::qrt::circuit::Machine, T>(
                _: &mut M,
                _: &M::Register,
                _: impl ::core::ops::FnOnce(
                    &mut M,
                    ::qrt::core::oracle::compiled::Computed<'_, Self, M::Register>,
                ) -> T,
            ) -> T {{ {never} }}
        }}
        {conditions}
        impl ::qrt::runtime::path_machines::NativeOracle for {name} {{
            fn native<V: ::qrt::runtime::path_machines::native::Vectors>(
                _: V,
                _: &[u64],
                _: V::Longs,
            ) -> [[V::Longs; 3]; 2] {{ {never} }}
        }}"
    );
    super::parsed_text(&text)
}
