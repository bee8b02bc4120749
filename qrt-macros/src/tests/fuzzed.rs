//! Tests of the fuzzer's target of the macros, on its seeds and on reproducible changes of them.

use numbers::Numbers;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::path::Path;

#[path = "../../../fuzz/macro_targets.rs"]
mod targets;

#[path = "../../../fuzz/numbers.rs"]
mod numbers;

fn seeds() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/seeds/macros");
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
        .iter()
        .map(|path| std::fs::read_to_string(path).unwrap())
        .collect()
}

/// Returns the tokens with some left out, written twice, or replaced by others.
fn changed(tokens: TokenStream, others: &[TokenTree], numbers: &mut Numbers) -> TokenStream {
    let mut changed = TokenStream::new();
    for token in tokens {
        let token = match token {
            TokenTree::Group(group) => {
                let inner = changed_group(&group, others, numbers);
                TokenTree::Group(inner)
            }
            token => token,
        };
        match numbers.below(60) {
            0 => {}
            1 => changed.extend([token.clone(), token]),
            2 => changed.extend([others[numbers.below(others.len())].clone()]),
            3 => changed.extend([others[numbers.below(others.len())].clone(), token]),
            _ => changed.extend([token]),
        }
    }
    changed
}

fn changed_group(group: &Group, others: &[TokenTree], numbers: &mut Numbers) -> Group {
    let delimiters = [
        Delimiter::Brace,
        Delimiter::Bracket,
        Delimiter::Parenthesis,
        Delimiter::None,
    ];
    let delimiter = match numbers.below(40) {
        0 => delimiters[numbers.below(4)],
        _ => group.delimiter(),
    };
    Group::new(delimiter, changed(group.stream(), others, numbers))
}

fn all(tokens: TokenStream) -> Vec<TokenTree> {
    let mut found = Vec::new();
    for token in tokens {
        if let TokenTree::Group(group) = &token {
            found.extend(all(group.stream()));
        }
        found.push(token);
    }
    found
}

#[test]
fn any_tokens_expand_to_items() {
    let seeds = seeds();
    let mut numbers = Numbers(1);
    let streams: Vec<TokenStream> = seeds.iter().map(|seed| seed.parse().unwrap()).collect();
    let mut others: Vec<TokenTree> = streams.iter().cloned().flat_map(all).collect();
    others
        .retain(|token| !matches!(token, TokenTree::Group(group) if all(group.stream()).len() > 9));
    for seed in &seeds {
        targets::tokens(seed.as_bytes());
    }
    for _ in 0..400 {
        let seed = streams[numbers.below(streams.len())].clone();
        let text = changed(seed, &others, &mut numbers).to_string();
        targets::tokens(text.as_bytes());
    }
}
