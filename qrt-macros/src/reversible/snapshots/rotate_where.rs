// Generated; see `reversible/tests.rs`.

/// Rotates a by one, and adds it to b, where a is less and the flag is set.
#[inline]
fn rotate_where<const W: ::core::primitive::u32, M: ::qrt::circuit::Host>(
    __host: &mut M,
    flag: &::qrt::circuit::format::Reg<M::Register, Bool>,
    a: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
    b: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::qrt::circuit::demand(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::qrt::circuit::demand(
            W <= 1000001,
            "QRT0811: a loop of more than 1,000,000 passes",
        )
    };
    const { ::qrt::circuit::demand(W <= 62, "QRT0829: a number of more than 63 bits") };
    const {
        ::qrt::circuit::demand(3 <= W, "QRT0806: `5` has more bits than its target")
    };
    #[allow(dead_code, reason = "it is a type, and never a value")]
    struct __Frame<H>(::core::marker::PhantomData<H>);
    impl<H: __qrt::Host> __qrt::CallFrame for __Frame<H> {
        const RUNNING: &'static __qrt::Running = &__qrt::Running {
            function: ::core::concat!(::core::module_path!(), "::", "rotate_where"),
            place: [::core::line!(), ::core::column!()],
            from: H::RUNNING,
        };
        const UNDONE: ::core::primitive::bool = H::UNDONE;
    }
    const {
        let __running = <__Frame<M> as __qrt::CallFrame>::RUNNING;
        __qrt::demand(
            !__running.repeats(),
            "QRT0812: `rotate_where` calls itself, by way of what it calls, and would never end: write `for` over constants",
        );
    }
    let __machine = ::qrt::circuit::Host::machine(__host);
    if M::UNDONE {
        __qrt::Machine::swap(
            __machine,
            a.register_mut(),
            b.register_mut(),
            ::core::option::Option::None,
        );
        let __t0 = __qrt::Machine::and(
            __machine,
            &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
            __qrt::Bit::at(flag.register(), 0),
            __qrt::Bit::at(b.register(), 0).inverted(),
        );
        __qrt::controlled(
            __machine,
            __qrt::Bit::at(&__t0, 0),
            |__machine| {
                let __t1 = __qrt::Machine::less(
                    __machine,
                    &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                    __qrt::Operand::Word(b.word()),
                    __qrt::Operand::Constant(12),
                );
                __qrt::controlled(
                    __machine,
                    __qrt::Bit::at(&__t1, 0),
                    |__machine| {
                        <__qrt::Itself<
                            __qrt::Recorder,
                        > as __qrt::Reversible<
                            _,
                            _,
                            _,
                        >>::run(
                            helpers::add::<W, _>,
                            <__qrt::Itself<
                                __qrt::Recorder,
                            > as __qrt::Is<
                                _,
                                _,
                            >>::is(
                                &mut __qrt::Caller::<_, __Frame<M>, false>::new(__machine),
                            ),
                            <__qrt::Itself<
                                __qrt::Recorder,
                            > as __qrt::Handed<
                                _,
                                _,
                                _,
                            >>::handed::<
                                <M as __qrt::Host>::Register,
                                _,
                                _,
                            >((&*flag, &mut *a)),
                        );
                    },
                );
                __qrt::controlled(
                    __machine,
                    __qrt::Bit::at(&__t1, 0).inverted(),
                    |__machine| {
                        __qrt::Machine::add_into(
                            __machine,
                            a.register_mut(),
                            __qrt::Operand::Constant(5),
                            false,
                            __qrt::When::Always,
                        );
                    },
                );
                __qrt::Machine::undo(__machine, [__t1]);
                for i in ::core::iter::Iterator::rev(1..W) {
                    let __t2 = __qrt::Machine::copy(
                        __machine,
                        &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                        __qrt::Word::unsigned(a.register(), i - 1, 1),
                    );
                    __qrt::Machine::xor_into(
                        __machine,
                        a.register_mut(),
                        __qrt::Operand::Word(
                            __qrt::Word::unsigned(&__t2, 0, 1).shifted(i),
                        ),
                        ::core::option::Option::None,
                    );
                    __qrt::Machine::undo(__machine, [__t2]);
                }
            },
        );
        __qrt::Machine::undo(__machine, [__t0]);
    } else {
        let __t0 = __qrt::Machine::and(
            __machine,
            &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
            __qrt::Bit::at(flag.register(), 0),
            __qrt::Bit::at(b.register(), 0).inverted(),
        );
        __qrt::controlled(
            __machine,
            __qrt::Bit::at(&__t0, 0),
            |__machine| {
                for i in 1..W {
                    let __t1 = __qrt::Machine::copy(
                        __machine,
                        &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                        __qrt::Word::unsigned(a.register(), i - 1, 1),
                    );
                    __qrt::Machine::xor_into(
                        __machine,
                        a.register_mut(),
                        __qrt::Operand::Word(
                            __qrt::Word::unsigned(&__t1, 0, 1).shifted(i),
                        ),
                        ::core::option::Option::None,
                    );
                    __qrt::Machine::undo(__machine, [__t1]);
                }
                let __t2 = __qrt::Machine::less(
                    __machine,
                    &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                    __qrt::Operand::Word(b.word()),
                    __qrt::Operand::Constant(12),
                );
                __qrt::controlled(
                    __machine,
                    __qrt::Bit::at(&__t2, 0),
                    |__machine| {
                        <__qrt::Itself<
                            __qrt::Recorder,
                        > as __qrt::Reversible<
                            _,
                            _,
                            _,
                        >>::run(
                            helpers::add::<W, _>,
                            <__qrt::Itself<
                                __qrt::Recorder,
                            > as __qrt::Is<
                                _,
                                _,
                            >>::is(
                                &mut __qrt::Caller::<_, __Frame<M>, false>::new(__machine),
                            ),
                            <__qrt::Itself<
                                __qrt::Recorder,
                            > as __qrt::Handed<
                                _,
                                _,
                                _,
                            >>::handed::<
                                <M as __qrt::Host>::Register,
                                _,
                                _,
                            >((&*flag, &mut *a)),
                        );
                    },
                );
                __qrt::controlled(
                    __machine,
                    __qrt::Bit::at(&__t2, 0).inverted(),
                    |__machine| {
                        __qrt::Machine::add_into(
                            __machine,
                            a.register_mut(),
                            __qrt::Operand::Constant(5),
                            true,
                            __qrt::When::Always,
                        );
                    },
                );
                __qrt::Machine::undo(__machine, [__t2]);
            },
        );
        __qrt::Machine::undo(__machine, [__t0]);
        __qrt::Machine::swap(
            __machine,
            a.register_mut(),
            b.register_mut(),
            ::core::option::Option::None,
        );
    }
}
/// The inverse of [`rotate_where`]: undoes what it has done.
#[inline]
#[allow(dead_code, reason = "not every author needs it")]
fn rotate_where_inverse<const W: ::core::primitive::u32, M: ::qrt::circuit::Host>(
    __host: &mut M,
    flag: &::qrt::circuit::format::Reg<M::Register, Bool>,
    a: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
    b: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::qrt::circuit::demand(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::qrt::circuit::demand(
            W <= 1000001,
            "QRT0811: a loop of more than 1,000,000 passes",
        )
    };
    const { ::qrt::circuit::demand(W <= 62, "QRT0829: a number of more than 63 bits") };
    const {
        ::qrt::circuit::demand(3 <= W, "QRT0806: `5` has more bits than its target")
    };
    #[allow(dead_code, reason = "it is a type, and never a value")]
    struct __Frame<H>(::core::marker::PhantomData<H>);
    impl<H: __qrt::Host> __qrt::CallFrame for __Frame<H> {
        const RUNNING: &'static __qrt::Running = &__qrt::Running {
            function: ::core::concat!(::core::module_path!(), "::", "rotate_where"),
            place: [::core::line!(), ::core::column!()],
            from: H::RUNNING,
        };
        const UNDONE: ::core::primitive::bool = H::UNDONE;
    }
    const {
        let __running = <__Frame<M> as __qrt::CallFrame>::RUNNING;
        __qrt::demand(
            !__running.repeats(),
            "QRT0812: `rotate_where` calls itself, by way of what it calls, and would never end: write `for` over constants",
        );
    }
    const {
        ::qrt::circuit::demand(
            !M::UNDONE,
            "QRT0812: `rotate_where_inverse` has another name here, by which it cannot be undone",
        )
    };
    let __machine = ::qrt::circuit::Host::machine(__host);
    __qrt::Machine::swap(
        __machine,
        a.register_mut(),
        b.register_mut(),
        ::core::option::Option::None,
    );
    let __t0 = __qrt::Machine::and(
        __machine,
        &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
        __qrt::Bit::at(flag.register(), 0),
        __qrt::Bit::at(b.register(), 0).inverted(),
    );
    __qrt::controlled(
        __machine,
        __qrt::Bit::at(&__t0, 0),
        |__machine| {
            let __t1 = __qrt::Machine::less(
                __machine,
                &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                __qrt::Operand::Word(b.word()),
                __qrt::Operand::Constant(12),
            );
            __qrt::controlled(
                __machine,
                __qrt::Bit::at(&__t1, 0),
                |__machine| {
                    <__qrt::Itself<
                        __qrt::Recorder,
                    > as __qrt::Reversible<
                        _,
                        _,
                        _,
                    >>::run(
                        helpers::add::<W, _>,
                        <__qrt::Itself<
                            __qrt::Recorder,
                        > as __qrt::Is<
                            _,
                            _,
                        >>::is(
                            &mut __qrt::Caller::<_, __Frame<M>, true>::new(__machine),
                        ),
                        <__qrt::Itself<
                            __qrt::Recorder,
                        > as __qrt::Handed<
                            _,
                            _,
                            _,
                        >>::handed::<
                            <M as __qrt::Host>::Register,
                            _,
                            _,
                        >((&*flag, &mut *a)),
                    );
                },
            );
            __qrt::controlled(
                __machine,
                __qrt::Bit::at(&__t1, 0).inverted(),
                |__machine| {
                    __qrt::Machine::add_into(
                        __machine,
                        a.register_mut(),
                        __qrt::Operand::Constant(5),
                        false,
                        __qrt::When::Always,
                    );
                },
            );
            __qrt::Machine::undo(__machine, [__t1]);
            for i in ::core::iter::Iterator::rev(1..W) {
                let __t2 = __qrt::Machine::copy(
                    __machine,
                    &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                    __qrt::Word::unsigned(a.register(), i - 1, 1),
                );
                __qrt::Machine::xor_into(
                    __machine,
                    a.register_mut(),
                    __qrt::Operand::Word(__qrt::Word::unsigned(&__t2, 0, 1).shifted(i)),
                    ::core::option::Option::None,
                );
                __qrt::Machine::undo(__machine, [__t2]);
            }
        },
    );
    __qrt::Machine::undo(__machine, [__t0]);
}
/// [`rotate_where`] as a program, whose inputs are its registers in their order.
#[inline]
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
fn rotate_where_program<const W: ::core::primitive::u32>(
    __style: ::qrt::circuit::Style,
) -> ::qrt::circuit::Program {
    let mut __recorder = ::qrt::circuit::Recorder::new(__style);
    let flag: &::qrt::circuit::format::Reg<_, Bool> = &::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "flag",
    );
    let a: &mut ::qrt::circuit::format::Reg<_, UInt<W>> = &mut ::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "a",
    );
    let b: &mut ::qrt::circuit::format::Reg<_, UInt<W>> = &mut ::qrt::circuit::format::Reg::input(
        &mut __recorder,
        "b",
    );
    let __host = &mut __recorder;
    use ::qrt::circuit as __qrt;
    const { ::qrt::circuit::demand(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::qrt::circuit::demand(
            W <= 1000001,
            "QRT0811: a loop of more than 1,000,000 passes",
        )
    };
    const { ::qrt::circuit::demand(W <= 62, "QRT0829: a number of more than 63 bits") };
    const {
        ::qrt::circuit::demand(3 <= W, "QRT0806: `5` has more bits than its target")
    };
    #[allow(dead_code, reason = "it is a type, and never a value")]
    struct __Frame<H>(::core::marker::PhantomData<H>);
    impl<H: __qrt::Host> __qrt::CallFrame for __Frame<H> {
        const RUNNING: &'static __qrt::Running = &__qrt::Running {
            function: ::core::concat!(::core::module_path!(), "::", "rotate_where"),
            place: [::core::line!(), ::core::column!()],
            from: H::RUNNING,
        };
        const UNDONE: ::core::primitive::bool = H::UNDONE;
    }
    const {
        let __running = <__Frame<::qrt::circuit::Recorder> as __qrt::CallFrame>::RUNNING;
        __qrt::demand(
            !__running.repeats(),
            "QRT0812: `rotate_where` calls itself, by way of what it calls, and would never end: write `for` over constants",
        );
    }
    let __machine = __host;
    let __t0 = __qrt::Machine::and(
        __machine,
        &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
        __qrt::Bit::at(flag.register(), 0),
        __qrt::Bit::at(b.register(), 0).inverted(),
    );
    __qrt::controlled(
        __machine,
        __qrt::Bit::at(&__t0, 0),
        |__machine| {
            for i in 1..W {
                let __t1 = __qrt::Machine::copy(
                    __machine,
                    &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                    __qrt::Word::unsigned(a.register(), i - 1, 1),
                );
                __qrt::Machine::xor_into(
                    __machine,
                    a.register_mut(),
                    __qrt::Operand::Word(__qrt::Word::unsigned(&__t1, 0, 1).shifted(i)),
                    ::core::option::Option::None,
                );
                __qrt::Machine::undo(__machine, [__t1]);
            }
            let __t2 = __qrt::Machine::less(
                __machine,
                &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                __qrt::Operand::Word(b.word()),
                __qrt::Operand::Constant(12),
            );
            __qrt::controlled(
                __machine,
                __qrt::Bit::at(&__t2, 0),
                |__machine| {
                    <__qrt::Itself<
                        __qrt::Recorder,
                    > as __qrt::Reversible<
                        _,
                        _,
                        _,
                    >>::run(
                        helpers::add::<W, _>,
                        <__qrt::Itself<
                            __qrt::Recorder,
                        > as __qrt::Is<
                            _,
                            _,
                        >>::is(
                            &mut __qrt::Caller::<
                                _,
                                __Frame<::qrt::circuit::Recorder>,
                                false,
                            >::new(__machine),
                        ),
                        <__qrt::Itself<
                            __qrt::Recorder,
                        > as __qrt::Handed<
                            _,
                            _,
                            _,
                        >>::handed::<
                            <::qrt::circuit::Recorder as __qrt::Host>::Register,
                            _,
                            _,
                        >((&*flag, &mut *a)),
                    );
                },
            );
            __qrt::controlled(
                __machine,
                __qrt::Bit::at(&__t2, 0).inverted(),
                |__machine| {
                    __qrt::Machine::add_into(
                        __machine,
                        a.register_mut(),
                        __qrt::Operand::Constant(5),
                        true,
                        __qrt::When::Always,
                    );
                },
            );
            __qrt::Machine::undo(__machine, [__t2]);
        },
    );
    __qrt::Machine::undo(__machine, [__t0]);
    __qrt::Machine::swap(
        __machine,
        a.register_mut(),
        b.register_mut(),
        ::core::option::Option::None,
    );
    __recorder.finish()
}
