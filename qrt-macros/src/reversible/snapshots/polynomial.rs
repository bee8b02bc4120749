// Generated; see `reversible/tests.rs`.

/// out += x^2 + 3 y
pub fn polynomial<M: ::qrt::circuit::Host>(
    host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    y: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    out: &mut ::qrt::circuit::format::Reg<M::Register, UInt<10>>,
) {
    use ::qrt::circuit as __qrt;
    let machine = host.machine();
    if M::UNDONE {
        let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
            machine,
            "square",
        );
        __qrt::unconditional(
            machine,
            |machine| {
                let t0 = machine
                    .square(
                        &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                        x.word(),
                        0,
                    );
                machine
                    .add_into(
                        square.register_mut(),
                        __qrt::Word::unsigned(&t0, 0, 8).into(),
                        false,
                        __qrt::When::Always,
                    );
                machine.undo([t0]);
            },
        );
        let t1 = machine
            .scale(
                &__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6),
                y.word(),
                3,
                0,
            );
        machine
            .add_into(
                out.register_mut(),
                __qrt::Word::unsigned(&t1, 0, 6).into(),
                true,
                __qrt::When::Always,
            );
        machine.undo([t1]);
        machine
            .add_into(
                out.register_mut(),
                square.word().into(),
                true,
                __qrt::When::Always,
            );
        __qrt::unconditional(
            machine,
            |machine| {
                let t2 = machine
                    .square(
                        &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                        x.word(),
                        0,
                    );
                machine
                    .add_into(
                        square.register_mut(),
                        __qrt::Word::unsigned(&t2, 0, 8).into(),
                        true,
                        __qrt::When::Always,
                    );
                machine.undo([t2]);
            },
        );
        square.free(machine);
    } else {
        let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
            machine,
            "square",
        );
        __qrt::unconditional(
            machine,
            |machine| {
                let t0 = machine
                    .square(
                        &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                        x.word(),
                        0,
                    );
                machine
                    .add_into(
                        square.register_mut(),
                        __qrt::Word::unsigned(&t0, 0, 8).into(),
                        false,
                        __qrt::When::Always,
                    );
                machine.undo([t0]);
            },
        );
        machine
            .add_into(
                out.register_mut(),
                square.word().into(),
                false,
                __qrt::When::Always,
            );
        let t1 = machine
            .scale(
                &__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6),
                y.word(),
                3,
                0,
            );
        machine
            .add_into(
                out.register_mut(),
                __qrt::Word::unsigned(&t1, 0, 6).into(),
                false,
                __qrt::When::Always,
            );
        machine.undo([t1]);
        __qrt::unconditional(
            machine,
            |machine| {
                let t2 = machine
                    .square(
                        &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                        x.word(),
                        0,
                    );
                machine
                    .add_into(
                        square.register_mut(),
                        __qrt::Word::unsigned(&t2, 0, 8).into(),
                        true,
                        __qrt::When::Always,
                    );
                machine.undo([t2]);
            },
        );
        square.free(machine);
    }
}
/// The inverse of [`polynomial`]: undoes what it has done.
#[allow(dead_code, reason = "not every author needs it")]
pub fn polynomial_inverse<M: ::qrt::circuit::Host>(
    host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    y: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    out: &mut ::qrt::circuit::format::Reg<M::Register, UInt<10>>,
) {
    use ::qrt::circuit as __qrt;
    const {
        ::core::assert!(
            ! M::UNDONE,
            "QRT0812: `polynomial_inverse` has another name here, by which it cannot be undone"
        )
    };
    let machine = host.machine();
    let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
        machine,
        "square",
    );
    __qrt::unconditional(
        machine,
        |machine| {
            let t0 = machine
                .square(
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
            machine
                .add_into(
                    square.register_mut(),
                    __qrt::Word::unsigned(&t0, 0, 8).into(),
                    false,
                    __qrt::When::Always,
                );
            machine.undo([t0]);
        },
    );
    let t1 = machine
        .scale(&__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6), y.word(), 3, 0);
    machine
        .add_into(
            out.register_mut(),
            __qrt::Word::unsigned(&t1, 0, 6).into(),
            true,
            __qrt::When::Always,
        );
    machine.undo([t1]);
    machine
        .add_into(out.register_mut(), square.word().into(), true, __qrt::When::Always);
    __qrt::unconditional(
        machine,
        |machine| {
            let t2 = machine
                .square(
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
            machine
                .add_into(
                    square.register_mut(),
                    __qrt::Word::unsigned(&t2, 0, 8).into(),
                    true,
                    __qrt::When::Always,
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
    let mut recorder = ::qrt::circuit::Recorder::new(style);
    let x: &::qrt::circuit::format::Reg<_, UInt<4>> = &::qrt::circuit::format::Reg::input(
        &mut recorder,
        "x",
    );
    let y: &::qrt::circuit::format::Reg<_, UInt<4>> = &::qrt::circuit::format::Reg::input(
        &mut recorder,
        "y",
    );
    let out: &mut ::qrt::circuit::format::Reg<_, UInt<10>> = &mut ::qrt::circuit::format::Reg::input(
        &mut recorder,
        "out",
    );
    let host = &mut recorder;
    use ::qrt::circuit as __qrt;
    use ::qrt::circuit::Machine as _;
    let machine = host;
    let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
        machine,
        "square",
    );
    __qrt::unconditional(
        machine,
        |machine| {
            let t0 = machine
                .square(
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
            machine
                .add_into(
                    square.register_mut(),
                    __qrt::Word::unsigned(&t0, 0, 8).into(),
                    false,
                    __qrt::When::Always,
                );
            machine.undo([t0]);
        },
    );
    machine
        .add_into(out.register_mut(), square.word().into(), false, __qrt::When::Always);
    let t1 = machine
        .scale(&__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6), y.word(), 3, 0);
    machine
        .add_into(
            out.register_mut(),
            __qrt::Word::unsigned(&t1, 0, 6).into(),
            false,
            __qrt::When::Always,
        );
    machine.undo([t1]);
    __qrt::unconditional(
        machine,
        |machine| {
            let t2 = machine
                .square(
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
            machine
                .add_into(
                    square.register_mut(),
                    __qrt::Word::unsigned(&t2, 0, 8).into(),
                    true,
                    __qrt::When::Always,
                );
            machine.undo([t2]);
        },
    );
    square.free(machine);
    recorder.finish()
}
