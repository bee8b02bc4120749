// Generated; see `reversible/tests.rs`.

/// Rotates a by one, and adds it to b, where a is less and the flag is set.
#[inline]
fn rotate_where<const W: u32, M: ::qrt::circuit::Machine>(
    machine: &mut M,
    flag: &::qrt::circuit::format::Reg<M::Register, Bool>,
    a: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
    b: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
) {
    use ::qrt::circuit::{Bit, Declaration, Operand, Type, When, Word, controlled};
    const { ::core::assert!(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::core::assert!(W <= 1000001, "QRT0811: a loop of more than 1,000,000 passes")
    };
    const { ::core::assert!(W <= 62, "QRT0829: a number of more than 63 bits") };
    const { ::core::assert!(3 <= W, "QRT0806: `5` has more bits than its target") };
    let routine = ::qrt::circuit::Routine::enter(
        ::core::concat!(::core::module_path!(), "::", "rotate_where"),
        [::core::line!(), ::core::column!()],
        &[W],
    );
    let t0 = machine
        .and(
            &Declaration::work("and", Type::Bool, 1),
            Bit::at(flag.register(), 0),
            Bit::at(b.register(), 0).inverted(),
        );
    controlled(
        machine,
        Bit::at(&t0, 0),
        |machine| {
            for i in 1..W {
                let t1 = machine
                    .copy(
                        &Declaration::work("a[i - 1]", Type::UInt, 1),
                        Word::unsigned(a.register(), i - 1, 1),
                    );
                machine
                    .xor_into(
                        a.register_mut(),
                        Word::unsigned(&t1, 0, 1).shifted(i).into(),
                        None,
                    );
                machine.undo([t1]);
            }
            let t2 = machine
                .less(
                    &Declaration::work("less", Type::Bool, 1),
                    b.word().into(),
                    Operand::Constant(12),
                );
            controlled(
                machine,
                Bit::at(&t2, 0),
                |machine| {
                    helpers::add::<W, _>(machine, flag, a);
                },
            );
            controlled(
                machine,
                Bit::at(&t2, 0).inverted(),
                |machine| {
                    machine
                        .add_into(
                            a.register_mut(),
                            Operand::Constant(5),
                            true,
                            When::Always,
                        );
                },
            );
            machine.undo([t2]);
        },
    );
    machine.undo([t0]);
    machine.swap(a.register_mut(), b.register_mut(), None);
}
/// The inverse of [`rotate_where`]: undoes what it has done.
#[inline]
#[allow(dead_code, reason = "not every author needs it")]
fn rotate_where_inverse<const W: u32, M: ::qrt::circuit::Machine>(
    machine: &mut M,
    flag: &::qrt::circuit::format::Reg<M::Register, Bool>,
    a: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
    b: &mut ::qrt::circuit::format::Reg<M::Register, UInt<W>>,
) {
    use ::qrt::circuit::{Bit, Declaration, Operand, Type, When, Word, controlled};
    const { ::core::assert!(1 <= W, "QRT0819: bits beyond the last of `b`") };
    const {
        ::core::assert!(W <= 1000001, "QRT0811: a loop of more than 1,000,000 passes")
    };
    const { ::core::assert!(W <= 62, "QRT0829: a number of more than 63 bits") };
    const { ::core::assert!(3 <= W, "QRT0806: `5` has more bits than its target") };
    let routine = ::qrt::circuit::Routine::enter(
        ::core::concat!(::core::module_path!(), "::", "rotate_where_inverse"),
        [::core::line!(), ::core::column!()],
        &[W],
    );
    machine.swap(a.register_mut(), b.register_mut(), None);
    let t0 = machine
        .and(
            &Declaration::work("and", Type::Bool, 1),
            Bit::at(flag.register(), 0),
            Bit::at(b.register(), 0).inverted(),
        );
    controlled(
        machine,
        Bit::at(&t0, 0),
        |machine| {
            let t1 = machine
                .less(
                    &Declaration::work("less", Type::Bool, 1),
                    b.word().into(),
                    Operand::Constant(12),
                );
            controlled(
                machine,
                Bit::at(&t1, 0),
                |machine| {
                    helpers::add_inverse::<W, _>(machine, flag, a);
                },
            );
            controlled(
                machine,
                Bit::at(&t1, 0).inverted(),
                |machine| {
                    machine
                        .add_into(
                            a.register_mut(),
                            Operand::Constant(5),
                            false,
                            When::Always,
                        );
                },
            );
            machine.undo([t1]);
            for i in (1..W).rev() {
                let t2 = machine
                    .copy(
                        &Declaration::work("a[i - 1]", Type::UInt, 1),
                        Word::unsigned(a.register(), i - 1, 1),
                    );
                machine
                    .xor_into(
                        a.register_mut(),
                        Word::unsigned(&t2, 0, 1).shifted(i).into(),
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
    use ::qrt::circuit::format::Reg;
    let mut recorder = ::qrt::circuit::Recorder::new(style);
    let flag: Reg<_, Bool> = Reg::input(&mut recorder, "flag");
    let mut a: Reg<_, UInt<W>> = Reg::input(&mut recorder, "a");
    let mut b: Reg<_, UInt<W>> = Reg::input(&mut recorder, "b");
    rotate_where::<W, _>(&mut recorder, &flag, &mut a, &mut b);
    recorder.finish()
}
