// Generated; see `reversible/tests.rs`.

/// y += x - x^2 / 4 + 0.25
fn parabola<const F: u32, M: ::qrt::circuit::Machine>(
    machine: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, Fixed<2, F>>,
    y: &mut ::qrt::circuit::format::Reg<M::Register, Fixed<4, F>>,
) {
    use ::qrt::circuit::{Declaration, Operand, Type, When, Word};
    const { ::core::assert!(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::core::assert!(
            2 <= F, "QRT0808: a constant has more fraction bits than its target"
        )
    };
    machine.add_into(y.register_mut(), x.word().into(), false, When::Always);
    let t0 = machine
        .multiply(
            &Declaration::work("0.25 * x * x", Type::Fixed { fraction: F }, F + 2),
            x.word(),
            x.word(),
            F + 2,
        );
    machine
        .add_into(
            y.register_mut(),
            Word::signed(&t0, 0, F + 2).into(),
            true,
            When::Always,
        );
    machine.undo([t0]);
    machine
        .add_into(
            y.register_mut(),
            Operand::Constant(1 << (F - 2)),
            false,
            When::Always,
        );
}
/// The inverse of [`parabola`]: undoes what it has done.
#[allow(dead_code, reason = "not every author needs it")]
fn parabola_inverse<const F: u32, M: ::qrt::circuit::Machine>(
    machine: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, Fixed<2, F>>,
    y: &mut ::qrt::circuit::format::Reg<M::Register, Fixed<4, F>>,
) {
    use ::qrt::circuit::{Declaration, Operand, Type, When, Word};
    const { ::core::assert!(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::core::assert!(
            2 <= F, "QRT0808: a constant has more fraction bits than its target"
        )
    };
    machine
        .add_into(y.register_mut(), Operand::Constant(1 << (F - 2)), true, When::Always);
    let t0 = machine
        .multiply(
            &Declaration::work("0.25 * x * x", Type::Fixed { fraction: F }, F + 2),
            x.word(),
            x.word(),
            F + 2,
        );
    machine
        .add_into(
            y.register_mut(),
            Word::signed(&t0, 0, F + 2).into(),
            false,
            When::Always,
        );
    machine.undo([t0]);
    machine.add_into(y.register_mut(), x.word().into(), true, When::Always);
}
/// [`parabola`] as a program, whose inputs are its registers in their order.
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
fn parabola_program<const F: u32>(
    style: ::qrt::circuit::Style,
) -> ::qrt::circuit::Program {
    use ::qrt::circuit::format::Reg;
    let mut recorder = ::qrt::circuit::Recorder::new(style);
    let x: Reg<_, Fixed<2, F>> = Reg::input(&mut recorder, "x");
    let mut y: Reg<_, Fixed<4, F>> = Reg::input(&mut recorder, "y");
    parabola::<F, _>(&mut recorder, &x, &mut y);
    recorder.finish()
}
