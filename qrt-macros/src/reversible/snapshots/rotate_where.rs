// Generated; see `reversible/tests.rs`.

/// Rotates a by one, and adds it to b, where a is less and the flag is set.
#[inline]
fn rotate_where<const W: u32, M: ::qrt::circuit::Host>(
    host: &mut M,
    flag: &::qrt::circuit::format::Reg<M::Register, Bool>,
    a: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
    b: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::core::assert!(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::core::assert!(W <= 1000001, "QRT0811: a loop of more than 1,000,000 passes")
    };
    const { ::core::assert!(W <= 62, "QRT0829: a number of more than 63 bits") };
    const { ::core::assert!(3 <= W, "QRT0806: `5` has more bits than its target") };
    #[allow(dead_code, reason = "it is a type, and never a value")]
    struct __Frame<H>(::core::marker::PhantomData<H>);
    impl<H: __qrt::Host> __qrt::Frame for __Frame<H> {
        const RUNNING: &'static __qrt::Running = &__qrt::Running {
            function: ::core::concat!(::core::module_path!(), "::", "rotate_where"),
            place: [::core::line!(), ::core::column!()],
            from: H::RUNNING,
        };
    }
    const {
        let running = <__Frame<M> as __qrt::Frame>::RUNNING;
        ::core::assert!(
            ! running.repeats(),
            "QRT0812: `rotate_where` calls itself, by way of what it calls, and would never end: write `for` over constants"
        );
    }
    let machine = host.machine();
    if M::UNDONE {
        machine.swap(a.register_mut(), b.register_mut(), None);
        let t0 = machine
            .and(
                &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
                __qrt::Bit::at(flag.register(), 0),
                __qrt::Bit::at(b.register(), 0).inverted(),
            );
        __qrt::controlled(
            machine,
            __qrt::Bit::at(&t0, 0),
            |machine| {
                let t1 = machine
                    .less(
                        &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                        b.word().into(),
                        __qrt::Operand::Constant(12),
                    );
                __qrt::controlled(
                    machine,
                    __qrt::Bit::at(&t1, 0),
                    |machine| {
                        __qrt::Caller::<_, __Frame<M>, true>::new(machine)
                            .call(helpers::add::<W, _>, (&*flag, &mut *a));
                    },
                );
                __qrt::controlled(
                    machine,
                    __qrt::Bit::at(&t1, 0).inverted(),
                    |machine| {
                        machine
                            .add_into(
                                a.register_mut(),
                                __qrt::Operand::Constant(5),
                                false,
                                __qrt::When::Always,
                            );
                    },
                );
                machine.undo([t1]);
                for i in (1..W).rev() {
                    let t2 = machine
                        .copy(
                            &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                            __qrt::Word::unsigned(a.register(), i - 1, 1),
                        );
                    machine
                        .xor_into(
                            a.register_mut(),
                            __qrt::Word::unsigned(&t2, 0, 1).shifted(i).into(),
                            None,
                        );
                    machine.undo([t2]);
                }
            },
        );
        machine.undo([t0]);
    } else {
        let t0 = machine
            .and(
                &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
                __qrt::Bit::at(flag.register(), 0),
                __qrt::Bit::at(b.register(), 0).inverted(),
            );
        __qrt::controlled(
            machine,
            __qrt::Bit::at(&t0, 0),
            |machine| {
                for i in 1..W {
                    let t1 = machine
                        .copy(
                            &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                            __qrt::Word::unsigned(a.register(), i - 1, 1),
                        );
                    machine
                        .xor_into(
                            a.register_mut(),
                            __qrt::Word::unsigned(&t1, 0, 1).shifted(i).into(),
                            None,
                        );
                    machine.undo([t1]);
                }
                let t2 = machine
                    .less(
                        &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                        b.word().into(),
                        __qrt::Operand::Constant(12),
                    );
                __qrt::controlled(
                    machine,
                    __qrt::Bit::at(&t2, 0),
                    |machine| {
                        __qrt::Caller::<_, __Frame<M>, false>::new(machine)
                            .call(helpers::add::<W, _>, (&*flag, &mut *a));
                    },
                );
                __qrt::controlled(
                    machine,
                    __qrt::Bit::at(&t2, 0).inverted(),
                    |machine| {
                        machine
                            .add_into(
                                a.register_mut(),
                                __qrt::Operand::Constant(5),
                                true,
                                __qrt::When::Always,
                            );
                    },
                );
                machine.undo([t2]);
            },
        );
        machine.undo([t0]);
        machine.swap(a.register_mut(), b.register_mut(), None);
    }
}
/// The inverse of [`rotate_where`]: undoes what it has done.
#[inline]
#[allow(dead_code, reason = "not every author needs it")]
fn rotate_where_inverse<const W: u32, M: ::qrt::circuit::Host>(
    host: &mut M,
    flag: &::qrt::circuit::format::Reg<M::Register, Bool>,
    a: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
    b: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
) {
    use ::qrt::circuit as __qrt;
    const { ::core::assert!(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::core::assert!(W <= 1000001, "QRT0811: a loop of more than 1,000,000 passes")
    };
    const { ::core::assert!(W <= 62, "QRT0829: a number of more than 63 bits") };
    const { ::core::assert!(3 <= W, "QRT0806: `5` has more bits than its target") };
    #[allow(dead_code, reason = "it is a type, and never a value")]
    struct __Frame<H>(::core::marker::PhantomData<H>);
    impl<H: __qrt::Host> __qrt::Frame for __Frame<H> {
        const RUNNING: &'static __qrt::Running = &__qrt::Running {
            function: ::core::concat!(::core::module_path!(), "::", "rotate_where"),
            place: [::core::line!(), ::core::column!()],
            from: H::RUNNING,
        };
    }
    const {
        let running = <__Frame<M> as __qrt::Frame>::RUNNING;
        ::core::assert!(
            ! running.repeats(),
            "QRT0812: `rotate_where` calls itself, by way of what it calls, and would never end: write `for` over constants"
        );
    }
    const {
        ::core::assert!(
            ! M::UNDONE,
            "QRT0812: `rotate_where_inverse` has another name here, by which it cannot be undone"
        )
    };
    let machine = host.machine();
    machine.swap(a.register_mut(), b.register_mut(), None);
    let t0 = machine
        .and(
            &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
            __qrt::Bit::at(flag.register(), 0),
            __qrt::Bit::at(b.register(), 0).inverted(),
        );
    __qrt::controlled(
        machine,
        __qrt::Bit::at(&t0, 0),
        |machine| {
            let t1 = machine
                .less(
                    &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                    b.word().into(),
                    __qrt::Operand::Constant(12),
                );
            __qrt::controlled(
                machine,
                __qrt::Bit::at(&t1, 0),
                |machine| {
                    __qrt::Caller::<_, __Frame<M>, true>::new(machine)
                        .call(helpers::add::<W, _>, (&*flag, &mut *a));
                },
            );
            __qrt::controlled(
                machine,
                __qrt::Bit::at(&t1, 0).inverted(),
                |machine| {
                    machine
                        .add_into(
                            a.register_mut(),
                            __qrt::Operand::Constant(5),
                            false,
                            __qrt::When::Always,
                        );
                },
            );
            machine.undo([t1]);
            for i in (1..W).rev() {
                let t2 = machine
                    .copy(
                        &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                        __qrt::Word::unsigned(a.register(), i - 1, 1),
                    );
                machine
                    .xor_into(
                        a.register_mut(),
                        __qrt::Word::unsigned(&t2, 0, 1).shifted(i).into(),
                        None,
                    );
                machine.undo([t2]);
            }
        },
    );
    machine.undo([t0]);
}
/// [`rotate_where`] as a program, whose inputs are its registers in their order.
#[inline]
#[allow(dead_code, reason = "not every author needs it")]
#[must_use]
fn rotate_where_program<const W: u32>(
    style: ::qrt::circuit::Style,
) -> ::qrt::circuit::Program {
    let mut recorder = ::qrt::circuit::Recorder::new(style);
    let flag: &::qrt::circuit::format::Reg<_, Bool> = &::qrt::circuit::format::Reg::input(
        &mut recorder,
        "flag",
    );
    let a: &mut ::qrt::circuit::format::Reg<_, UInt<W>> = &mut ::qrt::circuit::format::Reg::input(
        &mut recorder,
        "a",
    );
    let b: &mut ::qrt::circuit::format::Reg<_, UInt<W>> = &mut ::qrt::circuit::format::Reg::input(
        &mut recorder,
        "b",
    );
    let host = &mut recorder;
    use ::qrt::circuit as __qrt;
    const { ::core::assert!(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::core::assert!(W <= 1000001, "QRT0811: a loop of more than 1,000,000 passes")
    };
    const { ::core::assert!(W <= 62, "QRT0829: a number of more than 63 bits") };
    const { ::core::assert!(3 <= W, "QRT0806: `5` has more bits than its target") };
    #[allow(dead_code, reason = "it is a type, and never a value")]
    struct __Frame<H>(::core::marker::PhantomData<H>);
    impl<H: __qrt::Host> __qrt::Frame for __Frame<H> {
        const RUNNING: &'static __qrt::Running = &__qrt::Running {
            function: ::core::concat!(::core::module_path!(), "::", "rotate_where"),
            place: [::core::line!(), ::core::column!()],
            from: H::RUNNING,
        };
    }
    const {
        let running = <__Frame<::qrt::circuit::Recorder> as __qrt::Frame>::RUNNING;
        ::core::assert!(
            ! running.repeats(),
            "QRT0812: `rotate_where` calls itself, by way of what it calls, and would never end: write `for` over constants"
        );
    }
    use ::qrt::circuit::Machine as _;
    let machine = host;
    let t0 = machine
        .and(
            &__qrt::Declaration::work("and", __qrt::Type::Bool, 1),
            __qrt::Bit::at(flag.register(), 0),
            __qrt::Bit::at(b.register(), 0).inverted(),
        );
    __qrt::controlled(
        machine,
        __qrt::Bit::at(&t0, 0),
        |machine| {
            for i in 1..W {
                let t1 = machine
                    .copy(
                        &__qrt::Declaration::work("a[i - 1]", __qrt::Type::UInt, 1),
                        __qrt::Word::unsigned(a.register(), i - 1, 1),
                    );
                machine
                    .xor_into(
                        a.register_mut(),
                        __qrt::Word::unsigned(&t1, 0, 1).shifted(i).into(),
                        None,
                    );
                machine.undo([t1]);
            }
            let t2 = machine
                .less(
                    &__qrt::Declaration::work("less", __qrt::Type::Bool, 1),
                    b.word().into(),
                    __qrt::Operand::Constant(12),
                );
            __qrt::controlled(
                machine,
                __qrt::Bit::at(&t2, 0),
                |machine| {
                    __qrt::Caller::<
                        _,
                        __Frame<::qrt::circuit::Recorder>,
                        false,
                    >::new(machine)
                        .call(helpers::add::<W, _>, (&*flag, &mut *a));
                },
            );
            __qrt::controlled(
                machine,
                __qrt::Bit::at(&t2, 0).inverted(),
                |machine| {
                    machine
                        .add_into(
                            a.register_mut(),
                            __qrt::Operand::Constant(5),
                            true,
                            __qrt::When::Always,
                        );
                },
            );
            machine.undo([t2]);
        },
    );
    machine.undo([t0]);
    machine.swap(a.register_mut(), b.register_mut(), None);
    recorder.finish()
}
