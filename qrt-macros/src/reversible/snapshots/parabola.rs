// Generated; see `reversible/tests.rs`.

/// y += x - x^2 / 4 + 0.25
fn parabola<const F: ::core::primitive::u32, M: ::qrt::circuit::Host>(
    __host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, Fixed<2, F>>,
    y: &mut ::qrt::circuit::format::Reg<M::Register, Fixed<4, F>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::qrt::circuit::demand(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::qrt::circuit::demand(
            2 <= F,
            "QRT0808: a constant has more fraction bits than its target",
        )
    };
    let __machine = ::qrt::circuit::Host::machine(__host);
    if M::UNDONE {
        __qrt::Machine::add_into(
            __machine,
            y.register_mut(),
            __qrt::Operand::Constant(1 << (F - 2)),
            true,
            __qrt::When::Always,
        );
        let __t0 = __qrt::Machine::multiply(
            __machine,
            &__qrt::Declaration::work(
                "0.25 * x * x",
                __qrt::Type::Fixed { fraction: F },
                F + 2,
            ),
            x.word(),
            x.word(),
            F + 2,
        );
        __qrt::Machine::add_into(
            __machine,
            y.register_mut(),
            __qrt::Operand::Word(__qrt::Word::signed(&__t0, 0, F + 2)),
            false,
            __qrt::When::Always,
        );
        __qrt::Machine::undo(__machine, [__t0]);
        __qrt::Machine::add_into(
            __machine,
            y.register_mut(),
            __qrt::Operand::Word(x.word()),
            true,
            __qrt::When::Always,
        );
    } else {
        __qrt::Machine::add_into(
            __machine,
            y.register_mut(),
            __qrt::Operand::Word(x.word()),
            false,
            __qrt::When::Always,
        );
        let __t0 = __qrt::Machine::multiply(
            __machine,
            &__qrt::Declaration::work(
                "0.25 * x * x",
                __qrt::Type::Fixed { fraction: F },
                F + 2,
            ),
            x.word(),
            x.word(),
            F + 2,
        );
        __qrt::Machine::add_into(
            __machine,
            y.register_mut(),
            __qrt::Operand::Word(__qrt::Word::signed(&__t0, 0, F + 2)),
            true,
            __qrt::When::Always,
        );
        __qrt::Machine::undo(__machine, [__t0]);
        __qrt::Machine::add_into(
            __machine,
            y.register_mut(),
            __qrt::Operand::Constant(1 << (F - 2)),
            false,
            __qrt::When::Always,
        );
    }
}
/// The inverse of [`parabola`]: undoes what it has done.
#[allow(dead_code, reason = "not every author needs it")]
fn parabola_inverse<const F: ::core::primitive::u32, M: ::qrt::circuit::Host>(
    __host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, Fixed<2, F>>,
    y: &mut ::qrt::circuit::format::Reg<M::Register, Fixed<4, F>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::qrt::circuit::demand(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::qrt::circuit::demand(
            2 <= F,
            "QRT0808: a constant has more fraction bits than its target",
        )
    };
    const {
        ::qrt::circuit::demand(
            !M::UNDONE,
            "QRT0812: `parabola_inverse` has another name here, by which it cannot be undone",
        )
    };
    let __machine = ::qrt::circuit::Host::machine(__host);
    __qrt::Machine::add_into(
        __machine,
        y.register_mut(),
        __qrt::Operand::Constant(1 << (F - 2)),
        true,
        __qrt::When::Always,
    );
    let __t0 = __qrt::Machine::multiply(
        __machine,
        &__qrt::Declaration::work(
            "0.25 * x * x",
            __qrt::Type::Fixed { fraction: F },
            F + 2,
        ),
        x.word(),
        x.word(),
        F + 2,
    );
    __qrt::Machine::add_into(
        __machine,
        y.register_mut(),
        __qrt::Operand::Word(__qrt::Word::signed(&__t0, 0, F + 2)),
        false,
        __qrt::When::Always,
    );
    __qrt::Machine::undo(__machine, [__t0]);
    __qrt::Machine::add_into(
        __machine,
        y.register_mut(),
        __qrt::Operand::Word(x.word()),
        true,
        __qrt::When::Always,
    );
}
/// [`parabola`] as a program, whose inputs are its registers in their order.
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
fn parabola_program<const F: ::core::primitive::u32>(
    __style: ::qrt::circuit::Style,
) -> ::qrt::circuit::Program {
    let mut __recorder = ::qrt::circuit::Recorder::new(__style);
    let x: &::qrt::circuit::format::Reg<_, Fixed<2, F>> = &::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "x",
    );
    let y: &mut ::qrt::circuit::format::Reg<_, Fixed<4, F>> = &mut ::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "y",
    );
    let __host = &mut __recorder;
    use ::qrt::circuit as __qrt;
    const { ::qrt::circuit::demand(F <= 61, "QRT0829: a number of more than 63 bits") };
    const {
        ::qrt::circuit::demand(
            2 <= F,
            "QRT0808: a constant has more fraction bits than its target",
        )
    };
    let __machine = __host;
    __qrt::Machine::add_into(
        __machine,
        y.register_mut(),
        __qrt::Operand::Word(x.word()),
        false,
        __qrt::When::Always,
    );
    let __t0 = __qrt::Machine::multiply(
        __machine,
        &__qrt::Declaration::work(
            "0.25 * x * x",
            __qrt::Type::Fixed { fraction: F },
            F + 2,
        ),
        x.word(),
        x.word(),
        F + 2,
    );
    __qrt::Machine::add_into(
        __machine,
        y.register_mut(),
        __qrt::Operand::Word(__qrt::Word::signed(&__t0, 0, F + 2)),
        true,
        __qrt::When::Always,
    );
    __qrt::Machine::undo(__machine, [__t0]);
    __qrt::Machine::add_into(
        __machine,
        y.register_mut(),
        __qrt::Operand::Constant(1 << (F - 2)),
        false,
        __qrt::When::Always,
    );
    __recorder.finish()
}
