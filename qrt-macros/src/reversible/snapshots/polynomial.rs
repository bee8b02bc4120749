// Generated; see `reversible/tests.rs`.

/// out += x^2 + 3 y
pub fn polynomial<M: ::qrt::circuit::Machine>(
    machine: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    y: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    out: &mut ::qrt::circuit::format::Reg<M::Register, UInt<10>>,
) {
    use ::qrt::circuit::format::Reg;
    use ::qrt::circuit::{Declaration, Type, When, Word, unconditional};
    let mut square: Reg<_, UInt<8>> = Reg::zero(machine, "square");
    unconditional(
        machine,
        |machine| {
            let t0 = machine
                .square(&Declaration::work("x * x", Type::UInt, 8), x.word(), 0);
            machine
                .add_into(
                    square.register_mut(),
                    Word::unsigned(&t0, 0, 8).into(),
                    false,
                    When::Always,
                );
            machine.undo([t0]);
        },
    );
    machine.add_into(out.register_mut(), square.word().into(), false, When::Always);
    let t1 = machine.scale(&Declaration::work("3 * y", Type::UInt, 6), y.word(), 3, 0);
    machine
        .add_into(
            out.register_mut(),
            Word::unsigned(&t1, 0, 6).into(),
            false,
            When::Always,
        );
    machine.undo([t1]);
    unconditional(
        machine,
        |machine| {
            let t2 = machine
                .square(&Declaration::work("x * x", Type::UInt, 8), x.word(), 0);
            machine
                .add_into(
                    square.register_mut(),
                    Word::unsigned(&t2, 0, 8).into(),
                    true,
                    When::Always,
                );
            machine.undo([t2]);
        },
    );
    square.free(machine);
}
/// The inverse of [`polynomial`]: undoes what it has done.
#[allow(dead_code, reason = "not every author needs it")]
pub fn polynomial_inverse<M: ::qrt::circuit::Machine>(
    machine: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    y: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    out: &mut ::qrt::circuit::format::Reg<M::Register, UInt<10>>,
) {
    use ::qrt::circuit::format::Reg;
    use ::qrt::circuit::{Declaration, Type, When, Word, unconditional};
    let mut square: Reg<_, UInt<8>> = Reg::zero(machine, "square");
    unconditional(
        machine,
        |machine| {
            let t0 = machine
                .square(&Declaration::work("x * x", Type::UInt, 8), x.word(), 0);
            machine
                .add_into(
                    square.register_mut(),
                    Word::unsigned(&t0, 0, 8).into(),
                    false,
                    When::Always,
                );
            machine.undo([t0]);
        },
    );
    let t1 = machine.scale(&Declaration::work("3 * y", Type::UInt, 6), y.word(), 3, 0);
    machine
        .add_into(
            out.register_mut(),
            Word::unsigned(&t1, 0, 6).into(),
            true,
            When::Always,
        );
    machine.undo([t1]);
    machine.add_into(out.register_mut(), square.word().into(), true, When::Always);
    unconditional(
        machine,
        |machine| {
            let t2 = machine
                .square(&Declaration::work("x * x", Type::UInt, 8), x.word(), 0);
            machine
                .add_into(
                    square.register_mut(),
                    Word::unsigned(&t2, 0, 8).into(),
                    true,
                    When::Always,
                );
            machine.undo([t2]);
        },
    );
    square.free(machine);
}
/// [`polynomial`] as a program, whose inputs are its registers in their order.
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
pub fn polynomial_program(style: ::qrt::circuit::Style) -> ::qrt::circuit::Program {
    use ::qrt::circuit::format::Reg;
    let mut recorder = ::qrt::circuit::Recorder::new(style);
    let x: Reg<_, UInt<4>> = Reg::input(&mut recorder, "x");
    let y: Reg<_, UInt<4>> = Reg::input(&mut recorder, "y");
    let mut out: Reg<_, UInt<10>> = Reg::input(&mut recorder, "out");
    polynomial(&mut recorder, &x, &y, &mut out);
    recorder.finish()
}
