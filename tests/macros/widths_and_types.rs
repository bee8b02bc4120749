//! Tests of reversible routines whose widths are computed from constants, and of routines of types: methods of
//! formats, functions of user-defined types.

use super::reversible::{all, check, run_all};
use qrt::circuit::{Declaration, Type};
use qrt::prelude::*;

/// out += a^2, by widths that are computed.
#[reversible]
fn square<const W: u32>(a: &UInt<W>, out: &mut UInt<{ 2 * W }>) {
    out += a * a;
}

/// out += (a + b)^2
#[reversible]
fn square_of_sum<const W: u32>(a: &UInt<W>, b: &UInt<W>, out: &mut UInt<{ 2 * W + 2 }>) {
    let mut sum: UInt<{ W + 1 }> = 0;
    within! {
        sum += a;
        sum += b;
    }
    apply! { out += sum * sum; }
}

/// The same as a^2 + 2 a b + b^2, the squares by calls from registers of computed widths.
#[reversible]
fn by_parts<const W: u32>(a: &UInt<W>, b: &UInt<W>, out: &mut UInt<{ 2 * W + 2 }>) {
    let mut squares: [UInt<{ 2 * W }>; 2] = [0; 2];
    within! {
        square(&a, &mut squares[0]);
        square::<W>(&b, &mut squares[1]);
    }
    apply! {
        out += squares[0];
        out += squares[1];
        out += 2 * a * b;
    }
}

#[reversible]
fn difference_of_the_two<const W: u32>(a: &UInt<W>, b: &UInt<W>, out: &mut UInt<{ 2 + 2 * W }>) {
    square_of_sum(&a, &b, &mut out);
    by_parts_inverse(&a, &b, &mut out);
}

#[reversible]
fn neither_way<const W: u32>(a: &UInt<W>, b: &UInt<W>, out: &mut UInt<{ 2 * (W + 1) }>) {
    difference_of_the_two_inverse(&a, &b, &mut out);
}

/// Calls it from a function of known widths.
#[reversible]
fn square_of_five_bits(a: &UInt<5>, out: &mut UInt<10>) {
    square(&a, &mut out);
}

#[reversible]
fn undo_square(a: &UInt<5>, out: &mut UInt<10>) {
    square_inverse::<5>(&a, &mut out);
}

#[test]
fn widths_are_computed_from_constants() {
    let states: Vec<_> = all(&[5]).iter().map(|s| vec![s[0], 1000]).collect();
    check(
        [square_of_five_bits_program, undo_square_program],
        &states,
        |s| vec![s[0], (s[1] + s[0] * s[0]) % 1024],
    );
    assert_eq!(
        square_of_five_bits_program(Style::InPlace),
        square_program::<5>(Style::InPlace)
    );
    let states: Vec<_> = all(&[3, 3]).iter().map(|s| vec![s[0], s[1], 200]).collect();
    for program in [square_of_sum_program::<3>, by_parts_program::<3>] {
        for style in [Style::InPlace, Style::OutOfPlace] {
            for (s, end) in states.iter().zip(run_all(&program(style), &states)) {
                assert_eq!(
                    end,
                    [s[0], s[1], (200 + (s[0] + s[1]).pow(2)) % 256],
                    "from {s:?}"
                );
            }
        }
    }
    let programs = [difference_of_the_two_program::<3>, neither_way_program::<3>];
    check(programs, &states, <[u64]>::to_vec);
}

/// Fixed-point numbers whose integer bits are a constant of the function, too.
#[reversible]
fn double<const I: i32, const F: u32>(x: &Fixed<I, F>, y: &mut Fixed<{ I + 1 }, F>) {
    y += x << 1;
}

#[reversible]
fn double_a_number(x: &Fixed<3, 2>, y: &mut Fixed<4, 2>) {
    double(&x, &mut y);
}

/// A constant that is a width, too.
#[reversible]
fn add_whole<const W: u32>(n: &UInt<W>, y: &mut UFixed<W, 2>) {
    y += n;
}

#[reversible]
fn add_three_bits(n: &UInt<3>, y: &mut UFixed<3, 2>) {
    add_whole(&n, &mut y);
}

#[reversible]
fn add_three_bits_back(n: &UInt<3>, y: &mut UFixed<3, 2>) {
    add_whole_inverse(&n, &mut y);
}

#[reversible]
fn add_numbers<const I: i32, const F: u32>(x: &Fixed<I, F>, y: &mut Fixed<I, F>) {
    let mut twice: Fixed<{ I + 1 }, F> = 0;
    within! { twice += x << 1; }
    apply! { y += x; y -= wrapping(twice); }
}

#[reversible]
fn without_constants(x: &Fixed<3, 2>, y: &mut Fixed<3, 2>) {
    add_numbers(&x, &mut y);
}

#[reversible]
fn without_constants_back(x: &Fixed<3, 2>, y: &mut Fixed<3, 2>) {
    add_numbers_inverse(&x, &mut y);
}

#[test]
fn bits_on_both_sides_of_the_point_are_inferred() {
    let programs = [without_constants_program, without_constants_back_program];
    check(programs, &all(&[5, 5]), |s| {
        vec![s[0], (s[1] + 32 - s[0]) % 32]
    });
    assert_eq!(
        without_constants_program(Style::InPlace),
        add_numbers_program::<3, 2>(Style::InPlace)
    );
}

#[test]
fn bits_before_the_point_may_be_those_of_an_integer() {
    let programs = [add_three_bits_program, add_three_bits_back_program];
    check(programs, &all(&[3, 5]), |s| {
        vec![s[0], (s[1] + 4 * s[0]) % 32]
    });
}

#[test]
fn bits_before_the_point_are_computed() {
    let program = double_a_number_program(Style::InPlace);
    assert_eq!(program, double_program::<3, 2>(Style::InPlace));
    let widths: Vec<u32> = program
        .registers
        .iter()
        .map(|register| register.width)
        .collect();
    assert_eq!(widths[..2], [5, 6]);
    for x in 0..32 {
        let end = run_all(&program, &[vec![x, 0]]);
        assert_eq!(
            Fixed::<4, 2>::value(end[0][1]),
            2.0 * Fixed::<3, 2>::value(x)
        );
    }
}

/// Operations on a number of any width, in place.
#[reversible]
trait InPlace {
    /// Adds one.
    fn increment(&mut self);
    /// Adds it to another number.
    fn add_to(&self, other: &mut Self);
    /// Adds it to another number, and one more.
    fn add_one_more_to(&self, other: &mut Self);
}

#[reversible]
impl<const W: u32> InPlace for UInt<W> {
    fn increment(&mut self) {
        self += 1;
    }

    fn add_to(&self, other: &mut Self) {
        other += self;
    }

    fn add_one_more_to(&self, other: &mut Self) {
        self.add_to(&mut other);
        other.increment();
    }
}

/// Adds a + 1 to b if the flag is set, and a - b otherwise.
#[reversible]
fn by_methods(flag: &Bool, a: &UInt<4>, b: &mut UInt<4>) {
    if flag {
        a.add_one_more_to(&mut b);
    } else {
        a.add_to_inverse(&mut b);
    }
}

#[reversible]
fn undo_methods(flag: &Bool, a: &UInt<4>, b: &mut UInt<4>) {
    if flag {
        b.increment_inverse();
        UInt::<4>::add_to_inverse(&a, &mut b);
    } else {
        let mut copies: [UInt<4>; 1] = [0; 1];
        within! { a.add_to(&mut copies[0]); }
        apply! { (&copies[0]).add_to(&mut b); }
    }
}

#[test]
fn methods_of_formats() {
    check(
        [by_methods_program, undo_methods_program],
        &all(&[1, 4, 4]),
        |s| {
            let added = if s[0] == 1 { s[1] + 1 } else { 16 - s[1] };
            vec![s[0], s[1], (s[2] + added) % 16]
        },
    );
    let program = UInt::<3>::add_one_more_to_program(Style::InPlace);
    assert_eq!(program.registers[0].name, "self");
    assert_eq!(run_all(&program, &[vec![3, 6]]), [[3, 2]]);
    // The test also calls it on a machine by hand.
    let mut state = State::new();
    let x = state.input(&Declaration::work("x", Type::UInt, 3), 6);
    let mut x: Reg<_, UInt<3>> = Reg::from_recorded(x);
    UInt::<3>::increment(&mut state, &mut x);
    UInt::<3>::increment(&mut state, &mut x);
    assert_eq!(state.bits(x.register()), 0);
    UInt::<3>::increment_inverse(&mut state, &mut x);
    assert_eq!(state.bits(x.register()), 7);
}

struct Steps;

/// Functions of a user-defined type, all of them reversible.
#[reversible]
impl Steps {
    const LENGTH: u64 = 3;

    fn forth(a: &mut UInt<4>) {
        a += 3;
    }

    fn back(a: &mut UInt<4>) {
        Self::forth_inverse(&mut a);
    }
}

#[test]
fn an_impl_of_functions() {
    check(
        [Steps::forth_program, Steps::back_program],
        &all(&[4]),
        |s| vec![(s[0] + Steps::LENGTH) % 16],
    );
}

/// Registers may have the names of variables in a BSDF's expression.
mod called_like_variables {
    use qrt::prelude::*;

    /// v += u / 2
    #[reversible]
    pub(super) fn half(u: &Fixed<2, 6>, v: &mut Fixed<2, 6>) {
        v += u >> 1;
    }

    /// Functions with the same name, one of them with another's parameters.
    pub(super) mod inner {
        use qrt::prelude::*;

        #[reversible]
        pub fn half(cos_i: &UFixed<1, 6>, cos_o: &UFixed<1, 6>, sum: &mut UFixed<2, 6>) {
            sum += cos_i;
            sum += cos_o;
        }
    }

    pub(super) struct Lobe;

    #[reversible]
    impl Lobe {
        pub(super) fn product(cos_i: &UFixed<1, 6>, u: &UFixed<0, 6>, out: &mut UFixed<1, 6>) {
            out += cos_i * u;
        }
    }

    pub(super) struct Map;

    impl Map {
        #[reversible]
        fn twice(v: &UFixed<0, 6>, out: &mut UFixed<2, 6>) {
            out += v << 1;
        }

        #[reversible]
        pub(super) fn four_times(v: &UFixed<0, 6>, out: &mut UFixed<2, 6>) {
            Self::twice(&v, &mut out);
            Self::twice(&v, &mut out);
        }
    }
}

#[test]
fn registers_may_be_called_like_variables_of_a_bsdf() {
    use called_like_variables::{Lobe, Map, half_program, inner};

    #[reversible]
    fn local(u: &UFixed<0, 4>, out: &mut UFixed<0, 4>) {
        out += u;
    }

    let end = |program: &Program, state: &[u64]| run_all(program, &[state.to_vec()]).concat();
    assert_eq!(end(&half_program(Style::InPlace), &[40, 5]), [40, 25]);
    let sum = inner::half_program(Style::InPlace);
    assert_eq!(end(&sum, &[64, 65, 1]), [64, 65, 130]);
    let product = Lobe::product_program(Style::InPlace);
    assert_eq!(end(&product, &[96, 32, 1]), [96, 32, 49]);
    let four_times = Map::four_times_program(Style::InPlace);
    assert_eq!(end(&four_times, &[17, 3]), [17, 71]);
    assert_eq!(end(&local_program(Style::InPlace), &[7, 5]), [7, 12]);
}

/// Functions of a type, and of a type that is generic itself.
struct Adder<const W: u32>;

impl<const W: u32> Adder<W> {
    const STEP: u32 = 3;

    /// b += a + 3
    #[reversible]
    pub fn add(a: &UInt<W>, b: &mut UInt<W>) {
        b += a;
        Self::step(&mut b);
    }

    #[reversible]
    fn step(b: &mut UInt<W>) {
        b += Self::STEP;
    }

    #[reversible]
    fn subtract(a: &UInt<W>, b: &mut UInt<W>) {
        Self::add_inverse(&a, &mut b);
    }
}

#[reversible]
fn add_twice(a: &UInt<3>, b: &mut UInt<3>, flag: &Bool) {
    Adder::<3>::add(&a, &mut b);
    if flag {
        Adder::add(&a, &mut b);
    }
}

#[reversible]
fn subtract_twice(a: &UInt<3>, b: &mut UInt<3>, flag: &Bool) {
    add_twice_inverse(&a, &mut b, &flag);
}

#[test]
fn functions_of_types() {
    let programs = [Adder::<4>::add_program, Adder::<4>::subtract_program];
    check(programs, &all(&[4, 4]), |s| {
        vec![s[0], (s[0] + s[1] + 3) % 16]
    });
    let programs = [add_twice_program, subtract_twice_program];
    check(programs, &all(&[3, 3, 1]), |s| {
        vec![s[0], (s[1] + (s[0] + 3) * (1 + s[2])) % 8, s[2]]
    });
}

/// A type that is not generic, whose constants are widths.
struct Lookup;

#[reversible]
impl Lookup {
    const BELOW: u32 = 3;
    const SQUARES: [u32; 4] = [0, 1, 4, 9];

    /// out += k^2, by a table.
    fn square<const W: u32>(k: &UInt<{ Self::BELOW + 1 }>, out: &mut UInt<W>) {
        out += SQUARES[k[{ 0 }..2]];
    }
}

const SQUARES: [u32; 4] = Lookup::SQUARES;

/// The bits before a point are the width of a local register, too.
#[reversible]
fn parity_of_two<const I: u32>(x: &Fixed<I, 1>, y: &mut Bool) {
    let mut t: UInt<I> = 0;
    within! {
        t ^= 1;
    }
    apply! {
        y ^= t[0] & x[0];
    }
}

#[test]
fn constants_of_plain_types_are_widths() {
    let states = all(&[4, 5]);
    let ends = run_all(&Lookup::square_program::<5>(Style::InPlace), &states);
    for (s, end) in states.iter().zip(ends) {
        let low = s[0] % 4;
        assert_eq!(end, [s[0], (s[1] + low * low) % 32]);
    }
    let states = all(&[3, 1]);
    let ends = run_all(&parity_of_two_program::<2>(Style::InPlace), &states);
    for (s, end) in states.iter().zip(ends) {
        assert_eq!(end, [s[0], s[1] ^ s[0] & 1]);
    }
}
