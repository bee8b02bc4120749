#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::channels;
use crate::reversible::problem::Problems;

/// Returns the expressions of a function, or its problems.
fn read(function: &str) -> Result<Vec<String>, Vec<String>> {
    let mut problems = Problems::default();
    let channels = channels(function.parse().unwrap(), &mut problems);
    channels.ok_or_else(|| problems.messages())
}

/// Returns the expression of a function of `cos_i` and `cos_o` with these statements.
fn body(statements: &str) -> String {
    let cosines = "cos_i: &UFixed<1, 14>, cos_o: &UFixed<1, 14>";
    let function = format!("fn f({cosines}, out: &mut Fixed<6, 14>) {{ {statements} }}");
    read(&function).map_or_else(|messages| messages.join("\n"), |texts| texts.join(" "))
}

#[test]
fn updates_are_sums() {
    assert_eq!(body("out += cos_i;"), "cos_i");
    assert_eq!(body("out -= cos_i;"), "-cos_i");
    assert_eq!(
        body("out += 1 - cos_i; out -= 0.5 * cos_o;"),
        "1-cos_i-0.5*cos_o"
    );
    assert_eq!(body("out += cos_i; out -= cos_i;"), "0");
    assert_eq!(body("out -= cos_i; out += cos_o;"), "cos_o-cos_i");
    assert_eq!(
        body("out += cos_i << 2; out += cos_o >> 3;"),
        "4*cos_i+0.125*cos_o"
    );
    assert_eq!(body("out += (1 - cos_i) * (1 - cos_i);"), "(1-cos_i)^2");
    assert_eq!(
        body("out += 1.5 * cos_i * (cos_o - 0.25);"),
        "1.5*cos_i*(cos_o-0.25)"
    );
    assert_eq!(body("out -= -3 * cos_i;"), "3*cos_i");
}

#[test]
fn scratch_is_what_was_computed() {
    let text =
        body("let mut t: UFixed<1, 14> = 0; within! { t += cos_i; } apply! { out += t * cos_o; }");
    assert_eq!(text, "cos_i*cos_o");
    let text = body(
        "let mut t: UFixed<2, 14> = 0;
         within! { if cos_i < cos_o { t += cos_i; } }
         apply! { out += t; t += cos_o; out += t; t -= cos_o; }",
    );
    let branch = "if_less(cos_i,cos_o,cos_i,0)";
    assert_eq!(text, format!("{branch}+({branch}+cos_o)"));
}

#[test]
fn branches_are_choices() {
    assert_eq!(
        body("if cos_i < 0.5 { out += cos_i; } else { out += cos_o; }"),
        "if_less(cos_i,0.5,cos_i,cos_o)"
    );
    assert_eq!(
        body("if cos_i >= 0.5 && cos_o < 0.5 { out += 1; }"),
        "if_less(cos_i,0.5,0,if_less(cos_o,0.5,1,0))"
    );
    assert_eq!(
        body("if cos_i < 0.5 || cos_o < 0.5 { out += 1; } else { out += cos_i; }"),
        "if_less(cos_i,0.5,1,if_less(cos_o,0.5,1,cos_i))"
    );
    // Branches that other branches, or numbers, rule out are not written.
    assert_eq!(
        body("if cos_i < 0.5 { if cos_i < 0.5 { out += 1; } else { out += 2; } }"),
        "if_less(cos_i,0.5,1,0)"
    );
}

#[test]
fn loops_are_written_out() {
    assert_eq!(
        body("for i in 1..3 { out += cos_i >> i; }"),
        "0.5*cos_i+0.25*cos_i"
    );
    assert_eq!(
        body("for i in (1..3).rev() { out += cos_i << i; }"),
        "4*cos_i+2*cos_i"
    );
}

/// Returns the code of the problem of these statements.
fn code(statements: &str) -> String {
    let message = body(statements);
    let code = message.find("[QRT").map_or(0, |at| at + 1);
    message[code..].chars().take(7).collect()
}

#[test]
fn what_numbers_have_no_meaning_for_is_refused() {
    for statements in [
        "out ^= 1;",
        "out ^= cos_i;",
        "out[3] ^= cos_i[2];",
        "out += cos_i[2..5];",
        "let mut t: UInt<4> = 0; within! { t += 5; } apply! { out += t >> 1; }",
        "if cos_i[2] { out += 1; }",
        "if cos_i == cos_o { out += 1; }",
        "let mut b: Bool = false; within! { b ^= cos_i < cos_o; } apply! { if b { out += 1; } }",
        "let mut t: UInt<4> = 0; within! { t += floor(cos_i); } apply! { out += t; }",
        "other(&cos_i, &mut out);",
    ] {
        assert_eq!(code(statements), "QRT0727", "{statements}");
    }
}

#[test]
fn what_may_overflow_is_refused() {
    let kept = "let mut t: UFixed<1, 14> = 0;";
    for (statements, fits) in [
        ("within! { t += cos_i; } apply! {  out += t; }", true),
        (
            "within! { t += cos_i; t += cos_o; } apply! { out += t; }",
            false,
        ),
        ("within! { t += 1; t -= cos_i; } apply! { out += t; }", true),
        ("within! { t += cos_i - 0.5; } apply! { out += t; }", false),
        (
            "if cos_i > 0.5 { within! { t += cos_i - 0.5; } apply! { out += t; } }",
            true,
        ),
        // The product is rounded down, by less than a unit.
        (
            "within! { t += cos_i; t -= wrapping(cos_i * cos_o); } apply! { out += t; }",
            false,
        ),
        (
            "within! { t += 1.5; t -= wrapping(cos_i * cos_o); } apply! { out += t; }",
            true,
        ),
        // Only a proof on parts of the square shows it.
        (
            "within! { t += cos_i + 0.75; t -= wrapping(cos_i * cos_i); } apply! { out += t; }",
            true,
        ),
    ] {
        let found = code(&format!("{kept} {statements}"));
        assert_eq!(found != "QRT0728", fits, "{statements}: {found}");
    }
}

#[test]
fn outputs_are_one_or_three() {
    let three =
        "fn f(u: &UFixed<0, 8>, g: &mut UFixed<1, 8>, b: &mut UFixed<1, 8>, r: &mut UFixed<1, 8>)
        { r += u; b += 1; }";
    let texts = ["u", "0", "1"].map(str::to_owned);
    assert_eq!(read(three), Ok(texts.into()));
    for signature in [
        "(cos_i: &UFixed<1, 8>)",
        "(cos_i: &UFixed<1, 8>, a: &mut UFixed<1, 8>, b: &mut UFixed<1, 8>)",
        "(cos_i: &UFixed<1, 8>, out: &mut UInt<8>)",
        "(cos_i: &UFixed<0, 8>, out: &mut UFixed<1, 8>)",
        "(cos_a: &UFixed<1, 8>, out: &mut UFixed<1, 8>)",
        "(cos_i: &UInt<8>, out: &mut UFixed<1, 8>)",
        "(cos_x: &UFixed<1, 8>, out: &mut UFixed<1, 8>)",
        "(cos_i: &mut UFixed<1, 8>, out: &mut UFixed<1, 8>)",
        "<const W: u32>(cos_i: &UFixed<1, W>, out: &mut UFixed<1, W>)",
    ] {
        let messages = read(&format!("fn f{signature} {{}}")).unwrap_err();
        assert!(
            messages[0].contains("[QRT0726]"),
            "{signature}: {messages:?}"
        );
    }
}

#[test]
fn what_is_too_long_is_said_soon() {
    for statements in [
        "for _ in 0..1000000 { out += cos_i >> 10; }",
        "for _ in 0..1000000 {}",
        "let mut t: UFixed<1, 14> = 0; for _ in 0..1000 { t += cos_i; t -= cos_i; }",
    ] {
        let found = code(statements);
        assert!(
            found == "QRT0729" || found.starts_with('0'),
            "{statements}: {found}"
        );
    }
}
