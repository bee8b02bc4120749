//! The name by which the author's crate knows `qrt`. It is another name if the crate's Cargo.toml
//! says `quantum = { package = "qrt" }`.

use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use std::path::Path;

/// Returns the expansion with the name by which the crate in `folder` knows `qrt`.
pub(crate) fn named(tokens: TokenStream, folder: &Path) -> TokenStream {
    match name(folder) {
        Some(name) if name != "qrt" => renamed(tokens, &name),
        _ => tokens,
    }
}

/// Replaces every `::qrt` by `::name`.
fn renamed(tokens: TokenStream, name: &str) -> TokenStream {
    let mut colons = 0;
    let tokens = tokens.into_iter().map(|token| {
        let before = colons;
        colons = 0;
        match token {
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), renamed(group.stream(), name));
                inner.set_span(group.span());
                inner.into()
            }
            // The colon of a type may precede the path's two colons.
            TokenTree::Ident(ident) if before >= 2 && ident == "qrt" => {
                Ident::new(name, ident.span()).into()
            }
            TokenTree::Punct(punct) if punct.as_char() == ':' => {
                colons = before + 1;
                punct.into()
            }
            other => other,
        }
    });
    tokens.collect()
}

fn name(folder: &Path) -> Option<String> {
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).ok()?;
    let workspace = || {
        let folders = folder.ancestors();
        let manifests = folders.filter_map(|f| std::fs::read_to_string(f.join("Cargo.toml")).ok());
        let mut roots = manifests.filter(|text| text.contains("[workspace"));
        roots.next().unwrap_or_default()
    };
    dependency(&manifest, workspace).map(|name| name.replace('-', "_"))
}

/// A dependency, as a manifest describes it.
struct Entry {
    name: String,
    /// True if its package is `qrt`, by this name or another.
    is_qrt: bool,
    /// True if the workspace's manifest states the package.
    inherited: bool,
}

fn dependency(manifest: &str, workspace: impl Fn() -> String) -> Option<String> {
    let entries = entries(manifest);
    if let Some(own) = entries.iter().find(|entry| entry.is_qrt) {
        return Some(own.name.clone());
    }
    let shared = workspace();
    let shared = self::entries(&shared);
    let of = |entry: &&Entry| {
        let same = |other: &Entry| other.is_qrt && other.name == entry.name;
        entry.inherited && shared.iter().any(same)
    };
    let inherited = entries.iter().find(of)?;
    Some(inherited.name.clone())
}

/// Returns the entries of all tables of dependencies, as far as they identify the package.
fn entries(manifest: &str) -> Vec<Entry> {
    let mut found = Vec::new();
    // The state at a line: within a table of dependencies, or of the named one of them.
    let (mut within, mut of): (bool, Option<String>) = (false, None);
    for line in manifest.lines() {
        let line: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        let line = line.replace('\'', "\"");
        if let Some(header) = line.strip_prefix('[') {
            let header = header.split(']').next().unwrap_or_default();
            within = header.ends_with("dependencies");
            of = header
                .rsplit_once("dependencies.")
                .map(|(_, name)| name.trim_matches('"').to_owned());
            continue;
        }
        let Some((key, value)) = line.split_once('=') else {
            continue;
        };
        let key = key.replace('"', "");
        let (name, said) = match (&of, key.split_once('.')) {
            (Some(name), _) => (name.clone(), line.clone()),
            (None, _) if !within => continue,
            (None, Some((name, rest))) => (name.to_owned(), format!("{rest}={value}")),
            (None, None) => (key, value.to_owned()),
        };
        found.push(Entry {
            is_qrt: said.contains("package=\"qrt\"") || name == "qrt",
            inherited: said.contains("workspace=true"),
            name,
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::quote;

    fn found(manifest: &str, workspace: &str) -> Option<String> {
        dependency(manifest, || workspace.to_owned())
    }

    #[test]
    fn a_dependency_is_found_however_it_is_written() {
        for renamed in [
            "[dependencies]\nquantum = { path = \"..\", package = \"qrt\" }",
            "[dev-dependencies]\nquantum = {package='qrt', version = \"1\"} # ours",
            "[dependencies.quantum]\nversion = \"1\"\npackage = \"qrt\"",
            "[dependencies]\nrand = \"1\"\nquantum.package = \"qrt\"",
            "[target.'cfg(unix)'.dependencies]\n\"quantum\" = { package = \"qrt\" }",
        ] {
            assert_eq!(found(renamed, "").as_deref(), Some("quantum"), "{renamed}");
        }
        let plain = "[package]\nname = \"mine\"\n[dependencies]\nqrt = \"1\"";
        assert_eq!(found(plain, "").as_deref(), Some("qrt"));
        assert_eq!(found("[package]\npackage = \"qrt\"", ""), None);
        let other = "[dependencies]\nother = { package = \"qrt-core\" }";
        assert_eq!(found(other, ""), None);
    }

    #[test]
    fn a_dependency_may_be_the_workspaces() {
        let shared = "[workspace.dependencies]\nquantum = { package = \"qrt\", version = \"1\" }";
        for inherited in [
            "[dependencies]\nquantum.workspace = true",
            "[dependencies]\nrand.workspace = true\nquantum = { workspace = true }",
            "[dependencies.quantum]\nworkspace = true",
        ] {
            assert_eq!(
                found(inherited, shared).as_deref(),
                Some("quantum"),
                "{inherited}"
            );
        }
        assert_eq!(found("[dependencies]\nrand.workspace = true", shared), None);
    }

    #[test]
    fn only_paths_from_the_crate_are_renamed() {
        let tokens = quote!(
            use ::qrt::circuit::Bit; let qrt: ::qrt::Qrt = { f::<::qrt::X>(qrt) };
        );
        let renamed = quote!(
            use ::quantum::circuit::Bit; let qrt: ::quantum::Qrt = { f::<::quantum::X>(qrt) };
        );
        assert_eq!(
            super::renamed(tokens, "quantum").to_string(),
            renamed.to_string()
        );
    }
}
