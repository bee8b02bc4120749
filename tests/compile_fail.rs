//! What would be a wrong circuit does not compile: one short program a rule in `tests/ui`, each
//! with the compiler's words beside it. After a deliberate change of the words,
//! `TRYBUILD=overwrite cargo test --test compile_fail` writes them anew.

#[test]
fn wrong_programs_do_not_compile() {
    trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
}
