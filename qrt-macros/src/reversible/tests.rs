//! Tests of the expansion as text, and of problems, without a compiler around it.

use super::expanded;
use proc_macro2::TokenStream;
use quote::quote;
use std::path::Path;

/// Compares with the file of this name, or writes it if `QRT_BLESS` is set.
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

/// Returns the codes of the problems.
fn codes(item: TokenStream) -> Vec<&'static str> {
    let (_, problems) = expanded(&TokenStream::new(), item);
    problems
        .found()
        .iter()
        .map(|problem| problem.code)
        .collect()
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

/// `+=` and `-=` that follow each other may be undone in any order, and so may `^=`. A statement
/// between the two kinds, a branch and a loop keep their places in the order.
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
    // An inverse is missing, a change is made twice, and an inverse has the wrong sign.
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

    // Changes in a branch or a loop are additions, too.
    let inner = quote!(if z { t += y; } for _ in 0..2 { t += x; });
    let last = quote!(t -= x; for _ in 0..2 { t -= x; } if z { t -= y; });
    assert_eq!(undone(quote!(t += x; #inner), last.clone()), [""; 0]);
    assert_eq!(undone(inner, last), ["QRT0804"]);
}

/// Bits are undone one by one, in parts and by other statements, wherever they were computed.
#[test]
fn bits_are_taken_back_in_any_legal_order() {
    let undone = |done: TokenStream, last: TokenStream| {
        codes(quote! {
            fn f(x: &UInt<4>, y: &UInt<4>, z: &Bool, out: &mut UInt<4>) {
                let mut t: UInt<4> = 0;
                let mut c: Bool = false;
                #done
                if t[3] & c { out += t; }
                #last
            }
        })
    };
    let both = |done: TokenStream, undo: TokenStream, less: TokenStream| {
        assert_eq!(undone(done.clone(), undo.clone()), [""; 0], "{undo}");
        let wrong = undone(done, less.clone());
        assert!(
            !wrong.is_empty() && wrong.iter().all(|code| *code == "QRT0804"),
            "{less}"
        );
    };
    // A word, bit by bit, and bits as a word.
    both(
        quote!(t ^= x; c ^= z;),
        quote!(c ^= z; for i in 0..4 { t[i] ^= x[i]; }),
        quote!(c ^= z; for i in 0..3 { t[i] ^= x[i]; }),
    );
    both(
        quote!(for i in (0..4).rev() { t[i] ^= x[i] & y[3 - i]; } c ^= t[0];),
        quote!(c ^= t[0]; for i in 0..2 { t[i] ^= x[i] & y[3 - i]; }
            t[3] ^= y[0] & x[3]; t[2] ^= x[2] && y[1];),
        quote!(for i in 0..4 { t[i] ^= x[i] & y[3 - i]; } c ^= t[0];),
    );
    // A sum is the total of its additions, regardless of changes of its bits in between.
    both(
        quote!(t += x; t[1] ^= z; c ^= t[2]; t[1] ^= z; t += y;),
        quote!(t -= x; t -= y; t += x; c ^= t[2]; t -= x;),
        quote!(t -= x; t -= y; c ^= t[2];),
    );
    // A branch in pieces, on one side and the other.
    both(
        quote!(if z {
            t ^= x;
            c ^= y[0];
        } else {
            t ^= y;
        }),
        quote!(t ^= y; c ^= z & y[0]; if z { t ^= y; t ^= x; }),
        quote!(t ^= y; c ^= z & y[0]; if z { t ^= x; }),
    );
    // The register that was read has changed in between, in other bits.
    both(
        quote!(t[0] ^= x[0]; c ^= t[0]; t[1] ^= x[1];),
        quote!(c ^= t[0]; t[1] ^= x[1]; t[0] ^= x[0];),
        quote!(t[0] ^= x[0]; c ^= t[0]; t[1] ^= x[1];),
    );
    // A swap of scratch registers swaps their contents.
    both(
        quote!(let mut s: UInt<4> = 0; s += x; t += y; swap(s, t);),
        quote!(t -= x; swap(s, t); t -= y; c ^= z; c ^= z;),
        quote!(t -= y; swap(s, t); t -= x; c ^= z; c ^= z;),
    );
}

/// Ripple-carry addition in place, by majorities (Cuccaro et al. 2004): the carry is borrowed.
#[test]
fn an_ancilla_of_an_adder_by_hand_is_returned() {
    let adder = |last: TokenStream| {
        codes(quote! {
            fn add(a: &mut UInt<8>, b: &mut UInt<8>) {
                let mut carry: Bool = false;
                b[0] ^= a[0]; carry ^= a[0]; a[0] ^= carry & b[0];
                for i in 1..8 { b[i] ^= a[i]; a[i - 1] ^= a[i]; a[i] ^= a[i - 1] & b[i]; }
                for i in (1..8).rev() { a[i] ^= a[i - 1] & b[i]; a[i - 1] ^= a[i]; b[i] ^= a[i - 1]; }
                #last
            }
        })
    };
    assert_eq!(
        adder(quote!(a[0] ^= carry & b[0]; carry ^= a[0]; b[0] ^= carry;)),
        [""; 0]
    );
    assert_eq!(
        adder(quote!(carry ^= a[0]; a[0] ^= carry & b[0]; b[0] ^= carry;)),
        ["QRT0804"]
    );
}

/// Over constants, too: parts of a register, and loops that add, in any legal order.
#[test]
fn parts_are_taken_back_over_constants() {
    let root = |undo: TokenStream| {
        codes(quote! {
            fn root<const N: u32, const W: u32>(x: &mut UInt<W>, root: &mut UInt<N>) {
                for i in 0..N {
                    let mut step: UInt<W> = 0;
                    step[2 * i] ^= true;
                    for j in i + 1..N { step[i + j + 1] ^= root[j]; }
                    root[i] ^= x >= step;
                    if root[i] { x -= step; }
                    #undo
                }
            }
        })
    };
    let rest = quote!(step[2 * i] ^= true;);
    let all = quote!(for j in (i + 1..N).rev() {
        step[i + j + 1] ^= root[j];
    });
    assert_eq!(root(quote!(#all #rest)), [""; 0]);
    assert_eq!(root(quote!(#rest #all)), [""; 0]);
    assert_eq!(
        root(quote!(#rest for j in i + 1..N { step[i + j + 1] ^= root[j]; })),
        [""; 0]
    );
    assert_eq!(root(quote!(#rest)), ["QRT0804"]);
    assert_eq!(root(quote!(#rest root[N - 1] ^= true; #all)), ["QRT0804"]);
    assert_eq!(
        root(quote!(#rest for j in i + 2..N { step[i + j + 1] ^= root[j]; })),
        ["QRT0804"]
    );
    // Intermediate results keep their order.
    let way = |undo: TokenStream| {
        codes(quote! {
            fn f<const W: u32>(x: &UInt<W>, y: &UInt<W>, z: &mut UInt<W>) {
                let mut t: UInt<W> = 0;
                for i in 0..4 { z += x; t ^= z; z -= x; t ^= y; }
                #undo
            }
        })
    };
    assert_eq!(
        way(quote!(for i in (0..4).rev() {
            t ^= y;
            z += x;
            t ^= z;
            z -= x;
        })),
        [""; 0]
    );
    assert_eq!(
        way(quote!(for i in 0..4 {
            t ^= y;
            z -= x;
            t ^= z;
            z += x;
        })),
        ["QRT0804"]
    );
    let chain = |undo: TokenStream| {
        codes(quote! {
            fn f<const W: u32>(x: &UInt<W>) {
                let mut t: UInt<W> = 0;
                t ^= x;
                for i in 1..W { t[i] ^= t[i - 1]; }
                #undo
                t ^= x;
            }
        })
    };
    assert_eq!(
        chain(quote!(for i in (1..W).rev() {
            t[i] ^= t[i - 1];
        })),
        [""; 0]
    );
    assert_eq!(
        chain(quote!(for i in 1..W {
            t[i] ^= t[i - 1];
        })),
        ["QRT0804"]
    );
}

/// Sums of many branches, and bits of many products.
#[test]
fn many_branches_are_followed_bit_by_bit() {
    let found = codes(quote! {
        fn f(x: &UInt<32>, y: &UInt<32>, out: &mut UInt<32>) {
            let mut t: UInt<32> = 0;
            let mut s: UInt<32> = 0;
            for _ in 0..2 {
                for i in 0..32 { if x[i] { t ^= y; s += y; } }
                for i in 0..32 { t[i] ^= x[i] & y[31 - i]; }
            }
            out += s;
            for _ in 0..2 {
                for i in 0..32 { t[i] ^= x[i] & y[31 - i]; }
                for i in 0..32 { if x[i] { t ^= y; s -= y; } }
            }
        }
    });
    assert_eq!(found, [""; 0]);
}

/// Loops that are too long to be followed bit by bit are followed as wholes.
#[test]
fn long_loops_are_followed_as_wholes() {
    let long = |undo: TokenStream| {
        codes(quote! {
            fn f(x: &UInt<32>, out: &mut UInt<32>) {
                let mut t: UInt<32> = 0;
                for i in 0..1000 { t += x; }
                out += t;
                #undo
            }
        })
    };
    assert_eq!(
        long(quote!(for i in (0..1000).rev() {
            t -= x;
        })),
        [""; 0]
    );
    assert_eq!(
        long(quote!(for i in (0..999).rev() {
            t -= x;
        })),
        ["QRT0804"]
    );
}

/// Constants of the module, aliases of formats and loops' variables are numbers like others.
#[test]
fn names_of_the_module_are_left_to_the_compiler() {
    let (tokens, problems) = expanded(
        &TokenStream::new(),
        quote! {
            fn f(x: &Word, y: &UInt<{ 2 * W - 1 }>, out: &mut UInt<W>) {
                out += wrapping(x) + OFFSET;
                for i in 1..4 { out[..2] ^= i; out += wrapping(i * y); }
            }
        },
    );
    assert_eq!(problems.messages(), [""; 0]);
    let tokens = tokens.to_string();
    for part in [
        ":: core :: matches ! (< Word as :: qrt :: circuit :: format :: Format > :: TYPE",
        "(OFFSET as :: core :: primitive :: u32) as :: core :: primitive :: u64 >> (W as",
        ":: core :: convert :: From < _ >> :: from (i)) , :: core :: option :: Option :: None)",
        "2 * (W as :: core :: primitive :: u32) <= 64",
    ] {
        assert!(tokens.contains(part), "{part}: {tokens}");
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
            "W <= 1000000",
            "QRT0811: a loop of more than 1,000,000 passes",
            quote!(
                fn f<const W: u32>(a: &UInt<4>, b: &mut UInt<4>) {
                    for _ in 0..W {
                        b += a;
                    }
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
        let demand = format!("const {{ :: qrt :: circuit :: demand ({condition} , {message:?}) }}");
        assert!(tokens.to_string().contains(&demand), "{demand}: {tokens}");
    }
}

/// The passes of nested loops count together. Those of a triangle count as those of its square.
#[test]
fn the_passes_of_all_loops_around_are_bounded() {
    for item in [
        quote!(
            fn f<const W: u32>(a: &UInt<4>, b: &mut UInt<4>) {
                for _ in 0..W {
                    for _ in 0..W {
                        b += a;
                    }
                }
            }
        ),
        quote!(
            fn f(a: &UInt<4>, b: &mut UInt<4>) {
                for i in 0..PASSES {
                    for _ in 0..1000 {
                        for _ in 0..i {
                            b += a;
                        }
                    }
                }
            }
        ),
    ] {
        let (tokens, problems) = expanded(&TokenStream::new(), item);
        assert_eq!(problems.messages(), [""; 0]);
        let tokens = tokens.to_string();
        let message = "QRT0811: loops within loops of more than 1,000,000 passes in all";
        assert!(
            tokens.contains("__all = __all . saturating_mul"),
            "{tokens}"
        );
        assert!(tokens.contains(&format!("{message:?}")), "{tokens}");
    }
}
