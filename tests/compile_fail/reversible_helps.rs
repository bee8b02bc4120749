//! Programs with `#[reversible]`, and the texts that their helps replace.

use super::Applied;

pub(super) const APPLIED: &[Applied] = &[
    ("add_to_bits", &[("a[0..4] += b", "a[0..4] ^= b")]),
    (
        "and_assign",
        &[
            ("b: &Bool", "b: &Bool, out: &mut Bool"),
            ("a &= b", "out ^= a & b"),
        ],
    ),
    (
        "and_of_a_sum",
        &[(
            "    c ^= a & (b + 1);",
            "    let mut t: UInt<4> = 0;\n    within! { t += wrapping(b + 1); } apply! { c ^= a & t; }",
        )],
    ),
    (
        "and_of_numbers",
        &[(
            "    b += a & 3;",
            "    let mut t: UInt<4> = 0;\n    within! { t ^= a & 3; } apply! { b += t; }",
        )],
    ),
    (
        "and_of_other_widths",
        &[("c ^= a & b", "c[0..2] ^= a[0..2] & b")],
    ),
    (
        "and_with_a_constant_of_any_width",
        &[("c ^= a & 1", "c[0] ^= a[0]")],
    ),
    ("and_with_a_long_constant", &[("16", "15")]),
    (
        "and_with_its_target",
        &[
            ("b: &UInt<4>", "b: &UInt<4>, out: &mut UInt<4>"),
            ("a ^= a & b;", "out ^= a; out ^= a & b;"),
        ],
    ),
    ("apply_alone", &[("apply! {", "within! {} apply! {")]),
    ("argument_by_value", &[("add(a,", "add(&a,")]),
    (
        "argument_in_an_authors_macro",
        &[("wrong(a: &UInt<8>", "wrong(a: &UInt<4>")],
    ),
    (
        "argument_is_a_number",
        &[(
            "    add(1, &mut b);",
            "    let mut t: UInt<4> = 0;\n    within! { t += 1; } apply! { add(&t, &mut b); }",
        )],
    ),
    (
        "argument_is_an_expression",
        &[(
            "    add(&(a + 1), &mut b);",
            "    let mut t: UInt<4> = 0;\n    within! { t += a; t += 1; } apply! { add(&t, &mut b); }",
        )],
    ),
    (
        "argument_is_read_only",
        &[("back(a: &UInt<4>", "back(a: &mut UInt<4>")],
    ),
    (
        "argument_of_another_format",
        &[("wrong(a: &UInt<4>", "wrong(a: &UInt<8>")],
    ),
    ("arguments", &[("#[reversible(fast)]", "#[reversible]")]),
    ("array_as_a_number", &[("out += all", "out += all[0]")]),
    (
        "array_of_unknown_length",
        &[(
            "[UInt<4>; length], out: &mut UInt<4>",
            "[UInt<8>; 4], out: &mut UInt<8>",
        )],
    ),
    ("assignment", &[("b = a", "b += a")]),
    ("assignment_through_a_star", &[("*out = *a", "out += a")]),
    (
        "associated_function",
        &[(
            "    fn add(a: u32, b: &mut u32) {\n        *b += a;",
            "    #[reversible]\n    fn add(a: &UInt<4>, b: &mut UInt<4>) {\n        b += a;",
        )],
    ),
    ("async_function", &[("async fn", "fn")]),
    (
        "attribute_of_a_method",
        &[
            (
                "fn count(#[cfg(debug_assertions)] &mut self);",
                "#[cfg(debug_assertions)]\n    fn count(&mut self);",
            ),
            (
                "fn count(#[cfg(debug_assertions)] &mut self) {",
                "#[cfg(debug_assertions)]\n    fn count(&mut self) {",
            ),
        ],
    ),
    (
        "attribute_of_a_parameter",
        &[(
            "#[reversible]\nfn add(a: &UInt<4>, #[cfg(debug_assertions)] b: &UInt<4>, c: &mut UInt<4>) {",
            "#[reversible]\n#[cfg(debug_assertions)]\nfn add(a: &UInt<4>, b: &UInt<4>, c: &mut UInt<4>) {",
        )],
    ),
    (
        "attribute_of_a_scratch",
        &[
            ("#[reversible]\nfn", "#[reversible]\n#[allow(unused)]\nfn"),
            ("    #[allow(unused)]\n    let", "    let"),
        ],
    ),
    (
        "attribute_of_a_statement",
        &[
            (
                "#[reversible]\nfn",
                "#[reversible]\n#[cfg(debug_assertions)]\nfn",
            ),
            ("    #[cfg(debug_assertions)]\n    swap", "    swap"),
        ],
    ),
    (
        "attributes",
        &[(
            "#[reversible]\nfn add<#[allow(unused)] const W: u32>(\n    /// A number.\n    a: &UInt<W>,\n    #[allow(unused)] b: &mut UInt<W>,\n) {\n    #![allow(unused)]\n    #[allow(unused)]\n    within! {}\n    #[allow(unused)]\n    apply! {\n        b += #[allow(unused)] a;",
            "#[reversible]\n#[allow(unused)]\nfn add<const W: u32>(\n    // A number.\n    a: &UInt<W>,\n    b: &mut UInt<W>,\n) {\n    within! {}\n    apply! {\n        b += a;",
        )],
    ),
    ("bits_of_bits", &[("a[0..4][1]", "a[1]")]),
    (
        "bits_before_the_point",
        &[("<const I: u32", "<const I: i32")],
    ),
    (
        "break",
        &[(
            "if a[i] {\n            break;\n        }\n        b += 1;",
            "if !a[i] {\n            b += 1;\n        }",
        )],
    ),
    (
        "call_in_an_expression",
        &[
            (
                "#[reversible]\nfn root",
                "#[reversible]\nfn sqrt(a: &UInt<8>, root: &mut UInt<8>) {\n    root += a >> 4;\n}\n\n#[reversible]\nfn root",
            ),
            ("b += sqrt(a)", "sqrt(&a, &mut b)"),
        ],
    ),
    ("callee_in_parentheses", &[("(add)(", "add(")]),
    ("cast", &[("a as UInt<8>", "a")]),
    (
        "changed_after_a_claim",
        &[(
            "    less ^= c < 3;\n",
            "    within! { less ^= c < 3; } apply! {}\n",
        )],
    ),
    ("closure", &[("|| a += 1", "a += 1")]),
    ("closure_in_an_expression", &[("|| a", "a")]),
    (
        "condition_changes",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, flag: &mut Bool"),
            ("if a[0] {", "flag ^= a[0];\n    if flag {"),
        ],
    ),
    ("condition_is_a_number", &[("if a {", "if a != 0 {")]),
    ("condition_is_a_sum", &[("if a + 1 {", "if a[0] {")]),
    (
        "condition_is_constant",
        &[("    if true {\n        a += 2;\n    }", "    a += 2;")],
    ),
    (
        "condition_on_its_target",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, flag: &mut Bool"),
            ("if a > 3 {", "flag ^= a > 3; if flag {"),
        ],
    ),
    ("const_function", &[("const fn", "fn")]),
    ("constant_is_a_text", &[("\"3\"", "3")]),
    ("constant_is_no_register", &[("W += out", "out += 1")]),
    (
        "constant_of_a_call_is_computed",
        &[("add::<{ W + 1 }>", "add"), ("add::<{ i }>", "add")],
    ),
    (
        "constant_of_another_type",
        &[("const W: usize", "const W: u32")],
    ),
    (
        "constant_product_too_large",
        &[("4_000_000_000 * 4_000_000_000", "4_000 * 4_000")],
    ),
    ("constant_too_large", &[("out += 16", "out += 15")]),
    ("constant_with_a_suffix", &[("3u32", "3")]),
    (
        "constant_with_more_fraction_bits",
        &[("0.0078125", "0.015625")],
    ),
    ("constant_without_last_bit", &[("0.1", "0.09375")]),
    (
        "dirty_array",
        &[(
            "        bits[i] ^= a[i] & a[0];\n    }\n    out ^= bits[3];\n    for i in 0..3 {\n        bits[i] ^= a[i] & a[0];\n",
            "        within! { bits[i] ^= a[i] & a[0]; } apply! { out ^= bits[i]; }\n",
        )],
    ),
    (
        "dirty_exclusive_or",
        &[(
            "t ^= a;\n    out += t;",
            "within! { t ^= a; } apply! { out += t; }",
        )],
    ),
    (
        "dirty_scratch",
        &[(
            "square += x * x;\n    out += square;",
            "within! { square += x * x; } apply! { out += square; }",
        )],
    ),
    (
        "divide_assign",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, out: &mut UInt<4>"),
            ("a /= 2", "out += a >> 1"),
        ],
    ),
    ("division", &[("a / 3", "a >> 2")]),
    (
        "does_not_parse",
        &[("match a {\n        0\n    }", "a += 1;")],
    ),
    ("empty_range_of_bits", &[("a[2..2]", "a[0..3]")]),
    ("everything_shifted_out", &[("a >> 4", "a >> 3")]),
    ("extern_function", &[("extern \"C\" fn", "fn")]),
    (
        "fraction_bits_of_two_constants",
        &[
            ("const F: u32, const G: u32", "const F: u32"),
            ("UFixed<1, G>", "UFixed<1, F>"),
        ],
    ),
    (
        "function_on_a_machine",
        &[(
            "fn by_hand<M: Machine>(machine: &mut M, a: &mut Reg<M::Register, UInt<4>>) {\n    machine.xor_into(a.register_mut(), Operand::Constant(1), None);",
            "#[reversible]\nfn by_hand(a: &mut UInt<4>) {\n    a ^= 1;",
        )],
    ),
    (
        "impl_for_all_types",
        &[(
            "impl<F: Format> Count for F",
            "impl<const W: u32> Count for UInt<W>",
        )],
    ),
    ("index_beyond_a_constant_width", &[("a[W]", "a[W - 1]")]),
    ("index_is_a_register", &[("a[i]", "a[3]")]),
    ("index_out_of_range", &[("a[4]", "a[3]")]),
    (
        "indices_may_be_equal",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, out: &mut UInt<4>"),
            ("a[i] ^= a[j];", "out[i] ^= a[i]; out[i] ^= a[j];"),
        ],
    ),
    (
        "irreversible_function",
        &[(
            "fn plain(_: &mut u32) {}",
            "#[reversible]\nfn plain(a: &mut UInt<4>) {\n    a += 1;\n}",
        )],
    ),
    (
        "item_inside",
        &[
            (
                "#[reversible]",
                "#[allow(dead_code)]\nconst ONE: u32 = 1;\n\n#[reversible]",
            ),
            ("    const ONE: u32 = 1;\n", ""),
        ],
    ),
    ("lifetime", &[("&'static mut", "&mut")]),
    ("loop", &[("loop {", "for i in 0..8 {")]),
    (
        "loop_of_too_many_passes",
        &[("0..20_000", "0..2"), ("0..5_000", "0..5")],
    ),
    ("loop_out_of_range", &[("b[i + 1]", "b[7]")]),
    (
        "loop_over_a_register",
        &[("for _ in 0..a", "for i in 0..8")],
    ),
    (
        "loop_over_an_iterator",
        &[("for i in [1, 3]", "for i in 0..4")],
    ),
    (
        "loop_over_pairs",
        &[("for (i, j) in 0..4", "for i in 0..4")],
    ),
    ("loop_variable_is_taken", &[("for a in", "for i in")]),
    (
        "macro_call",
        &[("println!(\"{a}\");", "within! {} apply! { a += 1; }")],
    ),
    (
        "match",
        &[(
            "match a {\n        _ => b += 1,\n    }",
            "if a != 0 {\n        b += 1;\n    }",
        )],
    ),
    (
        "method",
        &[
            ("trait Count", "#[reversible]\ntrait Count"),
            ("impl Count", "#[reversible]\nimpl Count"),
            (
                "    #[reversible]\n    fn count(&mut self) {",
                "    fn count(&mut self) {",
            ),
        ],
    ),
    (
        "method_of_bits",
        &[(
            "#[reversible]\nfn count<const W: u32>(a: &mut UInt<4>, b: &mut UInt<{ W + 1 }>) {\n    a[0..2].increment();\n    (&mut b).increment();",
            "#[reversible]\nfn add<const V: u32>(x: &UInt<{ V + 1 }>, y: &mut UInt<{ V + 1 }>) {\n    y += x;\n}\n\n#[reversible]\nfn count<const W: u32>(a: &UInt<{ W + 1 }>, b: &mut UInt<{ W + 1 }>) {\n    add::<W>(&a, &mut b);",
        )],
    ),
    (
        "method_reads_only",
        &[
            (
                "fn add_to(&self, other: &mut Self);",
                "fn add_to(&mut self, other: &mut Self);",
            ),
            (
                "fn add_to(&self, other: &mut Self) {",
                "fn add_to(&mut self, other: &mut Self) {",
            ),
        ],
    ),
    ("more_fraction_bits", &[("out += a", "out += floor(a)")]),
    (
        "multiply_assign",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, out: &mut UInt<6>"),
            ("a *= 3", "out += a * 3"),
        ],
    ),
    ("name_alone", &[("    a;\n", "")]),
    (
        "name_without_a_register",
        &[("a: &mut UInt<4>", "a: &mut UInt<4>, velocity: &UInt<4>")],
    ),
    (
        "negated_assignment",
        &[
            ("b: &UInt<4>)", "b: &UInt<4>, out: &mut UInt<4>)"),
            ("o = !o", "o ^= true"),
            ("a = !a", "out ^= !a"),
            ("a = a + b", "a += b"),
            ("a = b - a", "out += b - a"),
        ],
    ),
    ("negative_constant", &[("a += 2 * -3", "a -= 2 * 3")]),
    (
        "not_of_a_number",
        &[(
            "    c += !a;",
            "    let mut t: UInt<4> = 0;\n    within! { t ^= !a; } apply! { c += t; }",
        )],
    ),
    (
        "nothing_left_of_a_fraction",
        &[("b: &mut UFixed<0, 14>", "b: &mut UFixed<0, 34>")],
    ),
    ("number_for_a_bit", &[("b ^= a", "b ^= a[0]")]),
    (
        "on_a_struct",
        &[(
            "struct Registers {\n    a: UInt<4>,\n}",
            "fn count(a: &mut UInt<4>) {\n    a += 1;\n}",
        )],
    ),
    (
        "operand_of_within_changes",
        &[(
            "        out += square;\n        x += 1;\n    }\n",
            "        out += square;\n    }\n    x += 1;\n",
        )],
    ),
    (
        "or_assign",
        &[
            ("o: &mut UInt<4>", "o: &mut UInt<4>, out: &mut UInt<4>"),
            ("o |= 3", "out ^= o | 3"),
        ],
    ),
    ("parameter_by_value", &[("a: UInt<4>", "a: &UInt<4>")]),
    (
        "parameter_called_like_a_constant",
        &[
            ("(W: &mut UInt<4>", "(a: &mut UInt<W>"),
            ("W += 1", "a += 1"),
        ],
    ),
    (
        "parameter_is_a_number",
        &[("n: u32", "n: &UInt<8>"), ("out += 1", "out += n[0]")],
    ),
    (
        "parameter_is_a_tuple",
        &[("&(UInt<4>, UInt<4>)", "&UInt<4>")],
    ),
    ("parameter_is_an_integer", &[("n: &u32", "n: &UInt<4>")]),
    (
        "parameter_with_mut",
        &[("mut a: &mut UInt<4>", "a: &mut UInt<4>")],
    ),
    (
        "parameter_without_a_name",
        &[("_: &UInt<4>", "x: &UInt<8>")],
    ),
    ("product_with_zero", &[("    b += 0 * a;\n", "")]),
    ("question_mark", &[("value()?", "1")]),
    ("read_only", &[("a: &UInt<4>", "a: &mut UInt<4>")]),
    (
        "reads_its_target",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, out: &mut UInt<4>"),
            ("a += a;", "out += a; out += a;"),
        ],
    ),
    (
        "recursion",
        &[(
            "a += 1;\n    again(&mut a);",
            "for _ in 0..3 {\n        a += 1;\n    }",
        )],
    ),
    ("reference", &[("b += &a", "b += a")]),
    ("reference_alone", &[("    &a;\n", "")]),
    ("register_at_a_register", &[("all[place]", "all[3]")]),
    ("register_beyond_an_array", &[("0..4", "0..3")]),
    ("remainder", &[("a % 4", "a[0..2]")]),
    (
        "result_is_self",
        &[
            (
                "fn count(&mut self);",
                "fn count(&mut self, out: &mut Self);",
            ),
            (
                "fn count(&mut self) -> Self {\n        self += 1;",
                "fn count(&mut self, out: &mut Self) {\n        self += 1;\n        out += self;",
            ),
        ],
    ),
    (
        "return",
        &[(
            "if flag {\n        return;\n    }\n    a += 1;",
            "if !flag {\n        a += 1;\n    }",
        )],
    ),
    (
        "return_type",
        &[(
            "b: &UInt<4>) -> UInt<5> {\n    a + b",
            "b: &UInt<4>, out: &mut UInt<5>) {\n    out += a + b;",
        )],
    ),
    (
        "same_register_twice",
        &[(
            "    add(&a, &mut a);",
            "    let mut t: UInt<4> = 0;\n    let mut out: UInt<4> = 0;\n    within! { t ^= a; out ^= a; add(&t, &mut out); } apply! {}",
        )],
    ),
    (
        "scratch_changed_twice",
        &[(
            "t += a;\n    t += 1;\n    b += t;",
            "within! { t += a; t += 1; } apply! { b += t; }",
        )],
    ),
    (
        "scratch_not_zero",
        &[(
            "let mut t: UInt<4> = 1;\n    b += t;",
            "let mut t: UInt<8> = 0;\n    within! { t += 1; } apply! { b += t[0..4]; }",
        )],
    ),
    (
        "scratch_without_a_name",
        &[(
            "    let _: UInt<4> = 0;\n    a += 1;",
            "    let mut t: UInt<8> = 0;\n    within! { t += 1; } apply! { a += t[0..4]; }",
        )],
    ),
    (
        "scratch_without_a_value",
        &[(
            "    let mut t: UInt<4>;\n    a += 1;",
            "    let mut t: UInt<8> = 0;\n    within! { t += 1; } apply! { a += t[0..4]; }",
        )],
    ),
    (
        "scratch_without_format",
        &[(
            "    let mut t = 0;\n    b += 1;",
            "    let mut t: UInt<8> = 0;\n    within! { t += 1; } apply! { b += t[0..4]; }",
        )],
    ),
    (
        "scratch_without_mut",
        &[(
            "    let t: UInt<4> = 0;\n    a += 1;",
            "    let mut t: UInt<8> = 0;\n    within! { t += 1; } apply! { a += t[0..4]; }",
        )],
    ),
    (
        "self_by_value",
        &[("fn count(self)", "fn count(&mut self)")],
    ),
    ("self_is_no_register", &[("&mut self, a:", "a:")]),
    (
        "several_at_once",
        &[
            (
                "fn wrong(a: &UInt<4>, b: &mut UInt<4>) {\n    b = a;\n    b *= 2;\n    a += 1;",
                "fn wrong(a: &mut UInt<4>, b: &mut UInt<4>, out: &mut UInt<6>) {\n    b += a;\n    out += b * 2;\n    a += 1;",
            ),
            (
                "fn caller(a: &UInt<4>, b: &mut UInt<4>) {\n    wrong(&a, &mut b);",
                "fn caller(a: &mut UInt<4>, b: &mut UInt<4>, out: &mut UInt<6>) {\n    wrong(&mut a, &mut b, &mut out);",
            ),
        ],
    ),
    (
        "shadowing",
        &[(
            "let mut a: UInt<4> = 0;\n    within! { a += 1; }\n    apply! { b += a; }",
            "let mut t: UInt<4> = 0;\n    within! { t += 1; }\n    apply! { b += t; }",
        )],
    ),
    (
        "shift_by_a_register",
        &[("a << n", "a << 2"), ("a >> n", "a >> 2")],
    ),
    (
        "shift_left_assign",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, out: &mut UInt<5>"),
            ("a <<= 1", "out += a << 1"),
        ],
    ),
    (
        "signed_into_unsigned",
        &[("out += a", "out += wrapping(a)")],
    ),
    (
        "slice_to_a_register",
        &[("a[n..4]", "a[2..4]"), ("a[0..n]", "a[0..2]")],
    ),
    ("sum_alone", &[("a + b;", "b += a;")]),
    (
        "swap_in_an_array",
        &[(
            "    for i in 0..3 {\n        swap(all[i], all[2 - i]);\n    }",
            "    swap(all[0], all[2]);",
        )],
    ),
    ("swap_of_a_read_only", &[("a: &UInt<4>", "a: &mut UInt<4>")]),
    (
        "swap_of_bits",
        &[(
            "swap(a[0], b[0]);",
            "a[0] ^= b[0]; b[0] ^= a[0]; a[0] ^= b[0];",
        )],
    ),
    ("swap_of_formats", &[("b: &mut Int<4>", "b: &mut UInt<4>")]),
    (
        "swap_of_one",
        &[
            ("a: &mut UInt<4>", "a: &mut UInt<4>, b: &mut UInt<4>"),
            ("swap(a)", "swap(a, b)"),
        ],
    ),
    ("swap_with_itself", &[("    swap(a, a);\n", "")]),
    (
        "table_of_a_type",
        &[
            ("out += Self::TABLE[k]", "out += TABLE[k]"),
            ("out += Squares::<W>::TABLE[k]", "out += TABLE[k]"),
            (
                "fn main() {}",
                "const TABLE: [u32; 4] = [0, 1, 4, 9];\n\nfn main() {}",
            ),
        ],
    ),
    (
        "table_of_another_index",
        &[(
            "    c += SQUARES[-1];\n    c += SQUARES[i];\n    c += SQUARES[w];\n    c += SQUARES[k];",
            "    c += SQUARES[0];\n    c += SQUARES[i[0..2]];\n    c += SQUARES[w[0..2]];\n    c += SQUARES[k[0..2]];",
        )],
    ),
    (
        "table_of_other_entries",
        &[
            ("longer(k: &UInt<3>", "longer(k: &UInt<2>"),
            ("shorter(k: &Bool", "shorter(k: &UInt<2>"),
            ("SQUARES[4]", "SQUARES[3]"),
            ("[1, -1, 1, -1]", "[1, 0, 1, 0]"),
        ],
    ),
    ("target_is_a_sum", &[("a + b += 1", "a[0..4] ^= 1")]),
    (
        "too_few_arguments",
        &[
            (
                "wrong(b: &mut UInt<4>)",
                "wrong(a: &UInt<4>, b: &mut UInt<4>)",
            ),
            ("    add(&mut b)", "    add(&a, &mut b)"),
        ],
    ),
    ("too_many_bits", &[("x * x", "wrapping(x * x)")]),
    ("too_many_bits_shifted", &[("a << 60", "a[0..3] << 60")]),
    (
        "too_wide_a_factor",
        &[
            ("(a << 60) * b", "(a[0..3] << 60) * b"),
            ("a * (b << 60)", "a * (b[0..3] << 60)"),
        ],
    ),
    (
        "too_wide_a_number",
        &[("a * a < 7", "a[0..31] * a[0..31] < 7")],
    ),
    ("too_wide_a_register", &[("UInt<64>", "UInt<63>")]),
    (
        "trait_with_a_body",
        &[(
            "    fn count(&mut self) {\n        self += 1;\n    }\n}",
            "    fn count(&mut self);\n}\n\n#[reversible]\nimpl Count for UInt<4> {\n    fn count(&mut self) {\n        self += 1;\n    }\n}",
        )],
    ),
    ("tuple", &[("(a, a)", "a << 4")]),
    (
        "type_parameter",
        &[("<T>(a: &T,", "<const W: u32>(a: &UInt<W>,")],
    ),
    (
        "uncomputed_too_late",
        &[(
            "    x += 1;\n    square -= x * x;",
            "    square -= x * x;\n    x += 1;",
        )],
    ),
    ("unknown_name", &[("angel", "angle")]),
    ("unsafe_function", &[("unsafe fn", "fn")]),
    ("unused_scratch", &[("    let mut t: UInt<4> = 0;\n", "")]),
    (
        "update_through_a_star",
        &[("*out ^= a", "out ^= a"), ("^= *a", "^= a")],
    ),
    ("variadic_function", &[(", _: ...", "")]),
    ("where_clause", &[("\nwhere\n    u32: Copy,\n{", " {")]),
    ("while", &[("while b < a {", "for i in 0..8 {")]),
    (
        "width_is_a_product",
        &[
            ("UInt<{ W * V }>", "UInt<{ 2 * W + 1 }>"),
            ("const W: u32, const V: u32", "const W: u32"),
        ],
    ),
    ("width_is_no_constant", &[("UInt<width>", "UInt<8>")]),
    (
        "width_of_self",
        &[("UInt<{ Self::SUM + 1 }>", "UInt<{ W + 2 }>")],
    ),
    (
        "within_alone",
        &[(
            "within! { b += a; }\n    b += 1;",
            "let mut t: UInt<4> = 0;\n    within! { t += a; } apply! { b += t; b += 1; }",
        )],
    ),
    ("within_does_not_parse", &[("a += 1 2;", "a += 1;")]),
    (
        "zero_of_a_parameter",
        &[(
            "    assert_zero!(a);\n    assert_zero!();\n    if a[0] {\n        assert_zero!(t);\n    }",
            "    within! { t ^= a[0]; } apply! { a[1] ^= t; }\n    assert_zero!(t);",
        )],
    ),
];

/// Programs whose help names no text to write, each with the reason.
pub(super) const NOT_APPLIED: [(&str, &str); 1] = [(
    "computed_width_for_a_constant",
    "the callee takes a width as its own constant: which function to write depends on the author",
)];
