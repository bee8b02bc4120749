//! The Rust of a scene: a type, and the checked scene as a function of it.

use super::{Header, Parsed, Source};
use proc_macro2::{Literal, TokenStream};
use qrt_scene::valid::ValidScene;
use quote::{format_ident, quote};
use std::path::{Path, PathBuf};

/// Returns the expansion of a scene without errors, with the code that was `generated` for it.
pub(crate) fn expansion(
    parsed: &Parsed,
    valid: &ValidScene,
    root: &Path,
    generated: &TokenStream,
) -> TokenStream {
    let Header {
        attributes,
        visibility,
        name,
        ..
    } = &parsed.header;
    let conditions = parsed.header.conditions();
    let items = crate::generate::items(valid.scene());
    let folder = match &parsed.source {
        Source::File(loaded) => Path::new(&loaded.source.name).parent(),
        _ => None,
    };
    let files = valid.files().iter().map(|file| {
        // The file's name in the scene, and its bytes.
        let own = folder.and_then(|folder| file.strip_prefix(folder).ok());
        let name = Literal::string(&own.unwrap_or(file).to_string_lossy());
        let bytes = bytes(file, root);
        quote!((#name, #bytes))
    });
    // Cargo builds again when an included file changes.
    let watched = match &parsed.source {
        Source::File(loaded) => {
            let bytes = bytes(Path::new(&loaded.source.name), root);
            quote!(#conditions const _: &[::core::primitive::u8] = #bytes;)
        }
        _ => TokenStream::new(),
    };
    let about = [about(valid), crate::generate::about(valid)].join("\n\n");
    let about = Literal::string(about.trim_end());
    let separator = (!attributes.is_empty()).then(|| quote!(#[doc = ""]));
    quote! {
        #attributes
        #separator
        #[doc = #about]
        #visibility struct #name;

        #conditions
        impl #name {
            /// The scene, checked.
            #visibility fn scene() -> &'static ::qrt::scene::valid::ValidScene {
                static SCENE: ::qrt::__std::sync::OnceLock<::qrt::scene::valid::ValidScene> =
                    ::qrt::__std::sync::OnceLock::new();
                static ITEMS: &[::qrt::scene::front::Item<'static>] = #items;
                const FILES: &[(&::core::primitive::str, &[::core::primitive::u8])] = &[#(#files),*];
                SCENE.get_or_init(|| {
                    let __files = ::qrt::scene::front::Files::held(FILES);
                    match ::qrt::scene::front::from_items(ITEMS, __files) {
                        ::core::result::Result::Ok(__valid) => __valid,
                        // The same data and the same files were checked when this was compiled.
                        ::core::result::Result::Err(__invalid) => ::core::unreachable!("{__invalid}"),
                    }
                })
            }
        }

        #watched
        #generated
    }
}

/// Returns the expansion of a scene with errors, of which `error` is one: a type that has the same
/// error in a constant.
///
/// The compiler shows equal errors once. It reports nothing about a type with an error, whatever
/// the rest of the program asks of it: items, traits, fields, formats.
pub(crate) fn stub(header: &Header, error: &TokenStream) -> TokenStream {
    let Header {
        visibility, name, ..
    } = header;
    let conditions = header.conditions();
    let hidden = format_ident!("{name}WithErrors");
    quote! {
        #conditions
        #[doc(hidden)]
        #visibility struct #hidden<const ERROR: ::core::primitive::bool>;

        #conditions
        #[allow(dead_code, missing_docs, reason = "the scene has errors")]
        #visibility type #name = #hidden<{ #error }>;

        #conditions
        #[allow(dead_code, missing_docs, non_upper_case_globals, reason = "the scene has errors")]
        #visibility const #name: #name = #error;
    }
}

/// Returns an expression for the bytes of `file`, which is relative to `root`.
fn bytes(file: &Path, root: &Path) -> TokenStream {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    if file.is_relative() && manifest.as_deref() == Some(root) {
        let file = Literal::string(&file.to_string_lossy());
        return quote!(::core::include_bytes!(::core::concat!(
            ::core::env!("CARGO_MANIFEST_DIR"), "/", #file
        )));
    }
    let file = Literal::string(&root.join(file).to_string_lossy());
    quote!(::core::include_bytes!(#file))
}

/// Describes the scene's size, in a sentence.
fn about(valid: &ValidScene) -> String {
    let scene = valid.scene();
    let count = |count: usize, noun: &str| {
        let plural = if count == 1 { "" } else { "s" };
        format!("{count} {noun}{plural}")
    };
    let polygons = count(valid.polygons().len(), "polygon");
    let faces = match valid.balls().len() {
        0 => polygons,
        spheres => format!("{polygons} and {}", count(spheres, "sphere")),
    };
    format!(
        "The scene `{}`: {} x {} pixels, {}, 2^{} paths of {} a pixel.",
        scene.name.replace('`', "'"),
        scene.film.width,
        scene.film.height,
        faces,
        scene.sampling.path_bits,
        count(scene.sampling.depths.len(), "ray"),
    )
}
