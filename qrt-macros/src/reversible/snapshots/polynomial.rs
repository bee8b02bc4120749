// Generated; see `reversible/tests.rs`.

/// out += x^2 + 3 y
pub fn polynomial<M: ::qrt::circuit::Host>(
    __host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    y: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    out: &mut ::qrt::circuit::format::Reg<M::Register, UInt<10>>,
) {
    use ::qrt::circuit as __qrt;
    let __machine = ::qrt::circuit::Host::machine(__host);
    if M::UNDONE {
        let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
            __machine,
            "square",
        );
        __qrt::unconditional(
            __machine,
            |__machine| {
                let __t0 = __qrt::Machine::square(
                    __machine,
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
                __qrt::Machine::add_into(
                    __machine,
                    square.register_mut(),
                    __qrt::Operand::Word(__qrt::Word::unsigned(&__t0, 0, 8)),
                    false,
                    __qrt::When::Always,
                );
                __qrt::Machine::undo(__machine, [__t0]);
            },
        );
        let __t1 = __qrt::Machine::scale(
            __machine,
            &__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6),
            y.word(),
            3,
            0,
        );
        __qrt::Machine::add_into(
            __machine,
            out.register_mut(),
            __qrt::Operand::Word(__qrt::Word::unsigned(&__t1, 0, 6)),
            true,
            __qrt::When::Always,
        );
        __qrt::Machine::undo(__machine, [__t1]);
        __qrt::Machine::add_into(
            __machine,
            out.register_mut(),
            __qrt::Operand::Word(square.word()),
            true,
            __qrt::When::Always,
        );
        __qrt::unconditional(
            __machine,
            |__machine| {
                let __t2 = __qrt::Machine::square(
                    __machine,
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
                __qrt::Machine::add_into(
                    __machine,
                    square.register_mut(),
                    __qrt::Operand::Word(__qrt::Word::unsigned(&__t2, 0, 8)),
                    true,
                    __qrt::When::Always,
                );
                __qrt::Machine::undo(__machine, [__t2]);
            },
        );
        square.free(__machine);
    } else {
        let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
            __machine,
            "square",
        );
        __qrt::unconditional(
            __machine,
            |__machine| {
                let __t0 = __qrt::Machine::square(
                    __machine,
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
                __qrt::Machine::add_into(
                    __machine,
                    square.register_mut(),
                    __qrt::Operand::Word(__qrt::Word::unsigned(&__t0, 0, 8)),
                    false,
                    __qrt::When::Always,
                );
                __qrt::Machine::undo(__machine, [__t0]);
            },
        );
        __qrt::Machine::add_into(
            __machine,
            out.register_mut(),
            __qrt::Operand::Word(square.word()),
            false,
            __qrt::When::Always,
        );
        let __t1 = __qrt::Machine::scale(
            __machine,
            &__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6),
            y.word(),
            3,
            0,
        );
        __qrt::Machine::add_into(
            __machine,
            out.register_mut(),
            __qrt::Operand::Word(__qrt::Word::unsigned(&__t1, 0, 6)),
            false,
            __qrt::When::Always,
        );
        __qrt::Machine::undo(__machine, [__t1]);
        __qrt::unconditional(
            __machine,
            |__machine| {
                let __t2 = __qrt::Machine::square(
                    __machine,
                    &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                    x.word(),
                    0,
                );
                __qrt::Machine::add_into(
                    __machine,
                    square.register_mut(),
                    __qrt::Operand::Word(__qrt::Word::unsigned(&__t2, 0, 8)),
                    true,
                    __qrt::When::Always,
                );
                __qrt::Machine::undo(__machine, [__t2]);
            },
        );
        square.free(__machine);
    }
}
/// The inverse of [`polynomial`]: undoes what it has done.
#[allow(dead_code, reason = "not every author needs it")]
pub fn polynomial_inverse<M: ::qrt::circuit::Host>(
    __host: &mut M,
    x: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    y: &::qrt::circuit::format::Reg<M::Register, UInt<4>>,
    out: &mut ::qrt::circuit::format::Reg<M::Register, UInt<10>>,
) {
    use ::qrt::circuit as __qrt;
    const {
        ::qrt::circuit::demand(
            !M::UNDONE,
            "QRT0812: `polynomial_inverse` has another name here, by which it cannot be undone",
        )
    };
    let __machine = ::qrt::circuit::Host::machine(__host);
    let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
        __machine,
        "square",
    );
    __qrt::unconditional(
        __machine,
        |__machine| {
            let __t0 = __qrt::Machine::square(
                __machine,
                &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                x.word(),
                0,
            );
            __qrt::Machine::add_into(
                __machine,
                square.register_mut(),
                __qrt::Operand::Word(__qrt::Word::unsigned(&__t0, 0, 8)),
                false,
                __qrt::When::Always,
            );
            __qrt::Machine::undo(__machine, [__t0]);
        },
    );
    let __t1 = __qrt::Machine::scale(
        __machine,
        &__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6),
        y.word(),
        3,
        0,
    );
    __qrt::Machine::add_into(
        __machine,
        out.register_mut(),
        __qrt::Operand::Word(__qrt::Word::unsigned(&__t1, 0, 6)),
        true,
        __qrt::When::Always,
    );
    __qrt::Machine::undo(__machine, [__t1]);
    __qrt::Machine::add_into(
        __machine,
        out.register_mut(),
        __qrt::Operand::Word(square.word()),
        true,
        __qrt::When::Always,
    );
    __qrt::unconditional(
        __machine,
        |__machine| {
            let __t2 = __qrt::Machine::square(
                __machine,
                &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                x.word(),
                0,
            );
            __qrt::Machine::add_into(
                __machine,
                square.register_mut(),
                __qrt::Operand::Word(__qrt::Word::unsigned(&__t2, 0, 8)),
                true,
                __qrt::When::Always,
            );
            __qrt::Machine::undo(__machine, [__t2]);
        },
    );
    square.free(__machine);
}
/// [`polynomial`] as a program, whose inputs are its registers in their order.
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
pub fn polynomial_program(__style: ::qrt::circuit::Style) -> ::qrt::circuit::Program {
    let mut __recorder = ::qrt::circuit::Recorder::new(__style);
    let x: &::qrt::circuit::format::Reg<_, UInt<4>> = &::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "x",
    );
    let y: &::qrt::circuit::format::Reg<_, UInt<4>> = &::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "y",
    );
    let out: &mut ::qrt::circuit::format::Reg<_, UInt<10>> = &mut ::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "out",
    );
    let __host = &mut __recorder;
    use ::qrt::circuit as __qrt;
    let __machine = __host;
    let mut square: __qrt::format::Reg<_, UInt<8>> = __qrt::format::Reg::zero(
        __machine,
        "square",
    );
    __qrt::unconditional(
        __machine,
        |__machine| {
            let __t0 = __qrt::Machine::square(
                __machine,
                &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                x.word(),
                0,
            );
            __qrt::Machine::add_into(
                __machine,
                square.register_mut(),
                __qrt::Operand::Word(__qrt::Word::unsigned(&__t0, 0, 8)),
                false,
                __qrt::When::Always,
            );
            __qrt::Machine::undo(__machine, [__t0]);
        },
    );
    __qrt::Machine::add_into(
        __machine,
        out.register_mut(),
        __qrt::Operand::Word(square.word()),
        false,
        __qrt::When::Always,
    );
    let __t1 = __qrt::Machine::scale(
        __machine,
        &__qrt::Declaration::work("3 * y", __qrt::Type::UInt, 6),
        y.word(),
        3,
        0,
    );
    __qrt::Machine::add_into(
        __machine,
        out.register_mut(),
        __qrt::Operand::Word(__qrt::Word::unsigned(&__t1, 0, 6)),
        false,
        __qrt::When::Always,
    );
    __qrt::Machine::undo(__machine, [__t1]);
    __qrt::unconditional(
        __machine,
        |__machine| {
            let __t2 = __qrt::Machine::square(
                __machine,
                &__qrt::Declaration::work("x * x", __qrt::Type::UInt, 8),
                x.word(),
                0,
            );
            __qrt::Machine::add_into(
                __machine,
                square.register_mut(),
                __qrt::Operand::Word(__qrt::Word::unsigned(&__t2, 0, 8)),
                true,
                __qrt::When::Always,
            );
            __qrt::Machine::undo(__machine, [__t2]);
        },
    );
    square.free(__machine);
    __recorder.finish()
}
