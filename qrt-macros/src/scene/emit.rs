//! The Rust of a scene: a type, and the checked scene as a function of it.

use super::{Header, Parsed, Source};
use proc_macro2::{Literal, TokenStream};
use qrt_scene::valid::ValidScene;
use quote::quote;
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
    let text = Literal::string(&valid.scene().to_yaml());
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
            quote!(#conditions const _: &[u8] = #bytes;)
        }
        _ => TokenStream::new(),
    };
    let about = Literal::string(&about(valid));
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
                static SCENE: ::std::sync::OnceLock<::qrt::scene::valid::ValidScene> =
                    ::std::sync::OnceLock::new();
                const TEXT: &str = #text;
                const FILES: &[(&str, &[u8])] = &[#(#files),*];
                SCENE.get_or_init(|| {
                    let files = ::qrt::scene::front::Files::held(FILES);
                    match ::qrt::scene::front::parse_with(TEXT, "the scene", &[], files) {
                        ::core::result::Result::Ok(loaded) => loaded.valid,
                        // The same text and the same files were checked when this was compiled.
                        ::core::result::Result::Err(report) => ::core::unreachable!("{report}"),
                    }
                })
            }
        }

        #watched
        #generated
    }
}

/// Returns the expansion of a scene with errors: enough for the rest of a program to be understood.
pub(crate) fn stub(header: &Header) -> TokenStream {
    let Header {
        attributes,
        visibility,
        name,
        ..
    } = header;
    let conditions = header.conditions();
    let figures = crate::generate::stub(
        &name.to_string(),
        &quote!(#visibility).to_string(),
        &conditions.to_string(),
    );
    quote! {
        #attributes
        #visibility struct #name;

        #figures

        #conditions
        impl #name {
            /// The scene, once its errors are corrected.
            #visibility fn scene() -> &'static ::qrt::scene::valid::ValidScene {
                ::core::unreachable!("this scene has errors")
            }
        }
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
    format!(
        "The scene `{}`: {} x {} pixels, {}, 2^{} paths of {} a pixel.",
        scene.name.replace('`', "'"),
        scene.film.width,
        scene.film.height,
        count(valid.polygons().len(), "polygon"),
        scene.sampling.path_bits,
        count(scene.sampling.depths.len(), "ray"),
    )
}
