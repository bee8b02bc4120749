// Generated; see `reversible/tests.rs`.

/// y += x - x^2 / 4 + 0.25
fn parabola<const F: u32, M: ::qrt::circuit::Host>(
    host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, Fixed<2, F>>,
    y: &mut ::qrt::circuit::format::Reg<M::Register, Fixed<4, F>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::core::assert!(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::core::assert!(
            2 <= F, "QRT0808: a constant has more fraction bits than its target"
        )
    };
    let machine = host.machine();
    if M::UNDONE {
        machine
            .add_into(
                y.register_mut(),
                __qrt::Operand::Constant(1 << (F - 2)),
                true,
                __qrt::When::Always,
            );
        let t0 = machine
            .multiply(
                &__qrt::Declaration::work(
                    "0.25 * x * x",
                    __qrt::Type::Fixed { fraction: F },
                    F + 2,
                ),
                x.word(),
                x.word(),
                F + 2,
            );
        machine
            .add_into(
                y.register_mut(),
                __qrt::Word::signed(&t0, 0, F + 2).into(),
                false,
                __qrt::When::Always,
            );
        machine.undo([t0]);
        machine.add_into(y.register_mut(), x.word().into(), true, __qrt::When::Always);
    } else {
        machine.add_into(y.register_mut(), x.word().into(), false, __qrt::When::Always);
        let t0 = machine
            .multiply(
                &__qrt::Declaration::work(
                    "0.25 * x * x",
                    __qrt::Type::Fixed { fraction: F },
                    F + 2,
                ),
                x.word(),
                x.word(),
                F + 2,
            );
        machine
            .add_into(
                y.register_mut(),
                __qrt::Word::signed(&t0, 0, F + 2).into(),
                true,
                __qrt::When::Always,
            );
        machine.undo([t0]);
        machine
            .add_into(
                y.register_mut(),
                __qrt::Operand::Constant(1 << (F - 2)),
                false,
                __qrt::When::Always,
            );
    }
}
/// The inverse of [`parabola`]: undoes what it has done.
#[allow(dead_code, reason = "not every author needs it")]
fn parabola_inverse<const F: u32, M: ::qrt::circuit::Host>(
    host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, Fixed<2, F>>,
    y: &mut ::qrt::circuit::format::Reg<M::Register, Fixed<4, F>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::core::assert!(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::core::assert!(
            2 <= F, "QRT0808: a constant has more fraction bits than its target"
        )
    };
    const {
        ::core::assert!(
            ! M::UNDONE,
            "QRT0812: `parabola_inverse` has another name here, by which it cannot be undone"
        )
    };
    let machine = host.machine();
    machine
        .add_into(
            y.register_mut(),
            __qrt::Operand::Constant(1 << (F - 2)),
            true,
            __qrt::When::Always,
        );
    let t0 = machine
        .multiply(
            &__qrt::Declaration::work(
                "0.25 * x * x",
                __qrt::Type::Fixed { fraction: F },
                F + 2,
            ),
            x.word(),
            x.word(),
            F + 2,
        );
    machine
        .add_into(
            y.register_mut(),
            __qrt::Word::signed(&t0, 0, F + 2).into(),
            false,
            __qrt::When::Always,
        );
    machine.undo([t0]);
    machine.add_into(y.register_mut(), x.word().into(), true, __qrt::When::Always);
}
/// [`parabola`] as a program, whose inputs are its registers in their order.
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
fn parabola_program<const F: u32>(
    style: ::qrt::circuit::Style,
) -> ::qrt::circuit::Program {
    let mut recorder = ::qrt::circuit::Recorder::new(style);
    let x: &::qrt::circuit::format::Reg<_, Fixed<2, F>> = &::qrt::circuit::format::Reg::input(
        &mut recorder,
        "x",
    );
    let y: &mut ::qrt::circuit::format::Reg<_, Fixed<4, F>> = &mut ::qrt::circuit::format::Reg::input(
        &mut recorder,
        "y",
    );
    let host = &mut recorder;
    use ::qrt::circuit as __qrt;
    const { ::core::assert!(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::core::assert!(
            2 <= F, "QRT0808: a constant has more fraction bits than its target"
        )
    };
    use ::qrt::circuit::Machine as _;
    let machine = host;
    machine.add_into(y.register_mut(), x.word().into(), false, __qrt::When::Always);
    let t0 = machine
        .multiply(
            &__qrt::Declaration::work(
                "0.25 * x * x",
                __qrt::Type::Fixed { fraction: F },
                F + 2,
            ),
            x.word(),
            x.word(),
            F + 2,
        );
    machine
        .add_into(
            y.register_mut(),
            __qrt::Word::signed(&t0, 0, F + 2).into(),
            true,
            __qrt::When::Always,
        );
    machine.undo([t0]);
    machine
        .add_into(
            y.register_mut(),
            __qrt::Operand::Constant(1 << (F - 2)),
            false,
            __qrt::When::Always,
        );
    recorder.finish()
}
