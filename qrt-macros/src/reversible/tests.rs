//! The expansion as text, and what is found wrong, without a compiler around it.

use super::expanded;
use proc_macro2::TokenStream;
use quote::quote;
use std::path::Path;

/// Compares with the file of this name, or writes it where `QRT_BLESS` is set.
fn snapshot(name: &str, item: TokenStream) {
    let (tokens, problems) = expanded(&TokenStream::new(), item);
    assert_eq!(problems.messages(), [""; 0]);
    let file = syn::parse2(tokens).unwrap();
    let text = format!(
        "// Generated; see `reversible/tests.rs`.\n\n{}",
        prettyplease::unparse(&file)
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/reversible/snapshots");
    let path = folder.join(name);
    if std::env::var_os("QRT_BLESS").is_some() {
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(&path, &text).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(
        text,
        expected,
        "run with QRT_BLESS=1 and read {}",
        path.display()
    );
}

/// The codes of what is wrong.
fn codes(item: TokenStream) -> Vec<String> {
    let messages = expanded(&TokenStream::new(), item).1.messages();
    let code = |message: &String| {
        message
            .split(['[', ']'])
            .find(|p| p.starts_with("QRT"))
            .map(str::to_owned)
    };
    messages.iter().filter_map(code).collect()
}

#[test]
fn a_polynomial_is_generated_readably() {
    snapshot(
        "polynomial.rs",
        quote! {
            /// out += x^2 + 3 y
            pub fn polynomial(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<10>) {
                let mut square: UInt<8> = 0;
                within! { square += x * x; }
                apply! { out += square; out += 3 * y; }
            }
        },
    );
}

#[test]
fn conditions_and_loops_are_generated_readably() {
    snapshot(
        "rotate_where.rs",
        quote! {
            /// Rotates a by one, and adds it to b, where a is less and the flag is set.
            #[inline]
            fn rotate_where<const W: u32>(flag: &Bool, a: &mut UInt<W>, b: &mut UInt<W>) {
                if flag & !b[0] {
                    for i in 1..W {
                        a[i] ^= a[i - 1];
                    }
                    if b < 3 << 2 { helpers::add::<W>(&flag, &mut a); } else { a -= 5; }
                }
                swap(a, b);
            }
        },
    );
}

#[test]
fn fixed_point_is_generated_readably() {
    snapshot(
        "parabola.rs",
        quote! {
            /// y += x - x^2 / 4 + 0.25
            fn parabola<const F: u32>(x: &Fixed<2, F>, y: &mut Fixed<4, F>) {
                y += x - 0.25 * x * x + 0.25;
            }
        },
    );
}

#[test]
fn what_a_register_reads_of_itself_is_undone_in_order() {
    let order = |last: TokenStream| {
        codes(quote! {
            fn f(x: &UInt<4>) {
                let mut t: UInt<4> = 0;
                t[1] ^= t[0];
                t[0] ^= x[0];
                #last
            }
        })
    };
    assert_eq!(order(quote!(t[1] ^= t[0]; t[0] ^= x[0];)), ["QRT0804"]);
    assert_eq!(order(quote!(t[0] ^= x[0]; t[1] ^= t[0];)), [""; 0]);
}

/// `+=` and `-=` that follow each other may be taken back in any order, and so may `^=`; what
/// stands between the two kinds, and a branch or a loop, has its place in the order.
#[test]
fn neighbouring_additions_are_taken_back_in_any_order_and_nothing_else_is() {
    let undone = |done: TokenStream, last: TokenStream| {
        codes(quote! {
            fn f(x: &UInt<4>, y: &UInt<4>, z: &Bool, out: &mut UInt<4>) {
                let mut t: UInt<4> = 0;
                #done
                out += t;
                #last
            }
        })
    };
    let sums = quote!(t += x; t -= y; t += 3;);
    for last in [
        quote!(t -= x; t += y; t -= 3;),
        quote!(t -= x; t -= 3; t += y;),
        quote!(t += y; t -= x; t -= 3;),
        quote!(t += y; t -= 3; t -= x;),
        quote!(t -= 3; t -= x; t += y;),
        quote!(t -= 3; t += y; t -= x;),
    ] {
        assert_eq!(undone(sums.clone(), last.clone()), [""; 0], "{last}");
    }
    // Twice what was done once, and once what was done twice.
    assert_eq!(undone(sums.clone(), quote!(t -= x; t += y;)), ["QRT0804"]);
    assert_eq!(
        undone(quote!(t += x; t += x;), quote!(t -= x;)),
        ["QRT0804"]
    );
    assert_eq!(
        undone(quote!(t += x; t += x;), quote!(t -= x; t -= x;)),
        [""; 0]
    );
    assert_eq!(undone(sums, quote!(t -= x; t += y; t += 3;)), ["QRT0804"]);

    let ors = quote!(t ^= x; t[2] ^= z;);
    assert_eq!(undone(ors.clone(), quote!(t ^= x; t[2] ^= z;)), [""; 0]);
    assert_eq!(undone(ors, quote!(t[2] ^= z; t ^= x;)), [""; 0]);

    // (0 + x) ^ y is not (0 ^ y) + x.
    let mixed = quote!(t += x; t ^= y;);
    assert_eq!(undone(mixed.clone(), quote!(t -= x; t ^= y;)), ["QRT0804"]);
    assert_eq!(undone(mixed, quote!(t ^= y; t -= x;)), [""; 0]);
    let apart = quote!(t += x; t ^= y; t += x;);
    assert_eq!(undone(apart, quote!(t -= x; t -= x; t ^= y;)), ["QRT0804"]);

    // A branch and a loop stand where they stand, whatever is in them.
    for inner in [
        quote!(if z {
            t += y;
        }),
        quote!(for _ in 0..2 {
            t += y;
        }),
    ] {
        let undo = match inner.clone().into_iter().next() {
            Some(first) if first.to_string() == "if" => quote!(if z {
                t -= y;
            }),
            _ => quote!(for _ in (0..2).rev() {
                t -= y;
            }),
        };
        let done = quote!(t += x; #inner);
        assert_eq!(undone(done.clone(), quote!(#undo t -= x;)), [""; 0]);
        assert_eq!(undone(done, quote!(t -= x; #undo)), ["QRT0804"]);
    }
}

#[test]
fn what_was_read_must_be_there_again() {
    let between = |between: TokenStream| {
        codes(quote! {
            fn f(x: &mut UInt<4>, y: &mut UInt<4>) {
                let mut t: UInt<4> = 0;
                t += x;
                #between
                t -= x;
            }
        })
    };
    assert_eq!(between(quote!(y += t;)), [""; 0]);
    assert_eq!(between(quote!(x += 1;)), ["QRT0804"]);
    assert_eq!(between(quote!(x += 1; y += t; x -= 1;)), [""; 0]);
    assert_eq!(
        between(quote!(if y[0] {
            x += 1;
        })),
        ["QRT0804"]
    );
    assert_eq!(
        between(quote!(for _ in 0..2 {
            x += 1;
        })),
        ["QRT0804"]
    );
    assert_eq!(between(quote!(swap(x, y);)), ["QRT0804"]);
    assert_eq!(between(quote!(swap(x, y); swap(y, x);)), [""; 0]);
    assert_eq!(
        between(quote!(g(&t, &mut x); h(&x, &mut y); g_inverse(&t, &mut x);)),
        [""; 0]
    );
    assert_eq!(
        between(quote!(g(&y, &mut x); y += 1; g_inverse(&y, &mut x);)),
        ["QRT0804"]
    );
    assert_eq!(
        between(quote!(within! { x += 1; } apply! { y += t; })),
        [""; 0]
    );
    assert_eq!(
        between(quote!(within! { y += 1; } apply! { x += 1; })),
        ["QRT0804"]
    );
}

#[test]
fn a_condition_may_read_bits_beside_those_that_change() {
    let branch = |body: TokenStream| {
        codes(quote! {
            fn f(a: &mut UInt<8>) {
                for i in 0..4 { if a[i] { #body } }
            }
        })
    };
    assert_eq!(branch(quote!(a[i + 1] ^= true;)), [""; 0]);
    assert_eq!(branch(quote!(a[4..8] ^= 3;)), [""; 0]);
    assert_eq!(branch(quote!(a[3..8] ^= 3;)), ["QRT0809"]);
    assert_eq!(
        branch(quote!(for j in 1..3 {
            a[j] ^= true;
        })),
        ["QRT0809"]
    );
}

#[test]
fn what_constants_must_fulfil_is_asked_of_them() {
    for (condition, message, item) in [
        (
            "V <= W",
            "QRT0806: `a` has more bits than its target",
            quote!(
                fn f<const V: u32, const W: u32>(a: &UInt<V>, b: &mut UInt<W>) {
                    b += a;
                }
            ),
        ),
        (
            "21 <= F",
            "QRT0806: nothing is left of a number that is rounded down",
            quote!(
                fn f<const F: u32>(a: &UFixed<0, F>, b: &mut UFixed<0, F>) {
                    b += a >> 20;
                }
            ),
        ),
        (
            "4 <= W",
            "QRT0806: everything is shifted out",
            quote!(
                fn f<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
                    b += a >> 3;
                }
            ),
        ),
        (
            "V <= W",
            "QRT0807: registers of different formats are swapped",
            quote!(
                fn f<const V: u32, const W: u32>(a: &mut UInt<V>, b: &mut UInt<W>) {
                    swap(a, b);
                }
            ),
        ),
        (
            "W <= V",
            "QRT0807: registers of different formats are swapped",
            quote!(
                fn f<const V: u32, const W: u32>(a: &mut UInt<V>, b: &mut UInt<W>) {
                    swap(a, b);
                }
            ),
        ),
        (
            "2 <= F",
            "QRT0808: a constant has more fraction bits than its target",
            quote!(
                fn f<const F: u32>(a: &mut UFixed<1, F>) {
                    a += 0.25;
                }
            ),
        ),
        (
            "2 <= F",
            "QRT0808: a constant has more fraction bits than what it is added to",
            quote!(
                fn f<const F: u32>(a: &UFixed<1, F>, b: &mut Bool) {
                    b ^= a < 0.25;
                }
            ),
        ),
        (
            "8 <= W",
            "QRT0819: bits beyond the last of `a`",
            quote!(
                fn f<const W: u32>(a: &UInt<W>, b: &mut Bool) {
                    b ^= a[7];
                }
            ),
        ),
        (
            "V <= W",
            "QRT0819: bits beyond the last of `a`",
            quote!(
                fn f<const V: u32, const W: u32>(a: &UInt<W>, b: &mut Bool) {
                    b ^= a[W - V];
                }
            ),
        ),
        (
            "3 <= W",
            "QRT0819: an empty range of bits",
            quote!(
                fn f<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
                    b += a[2..W];
                }
            ),
        ),
        (
            "W <= 43",
            "QRT0829: a number of more than 63 bits",
            quote!(
                fn f<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
                    b += wrapping(a << 20);
                }
            ),
        ),
    ] {
        let (tokens, problems) = expanded(&TokenStream::new(), item);
        assert_eq!(problems.messages(), [""; 0]);
        let demand = format!("const {{ :: core :: assert ! ({condition} , {message:?}) }}");
        assert!(tokens.to_string().contains(&demand), "{demand}: {tokens}");
    }
}
