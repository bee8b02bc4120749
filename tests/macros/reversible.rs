//! Tests that reversible routines compute the same as plain integers, on every machine, and can be uncomputed.

use qrt::prelude::*;

/// Runs a program on all machines, which must agree, and backwards, which must restore the states.
pub(super) fn run_all(program: &Program, states: &[Vec<u64>]) -> Vec<Vec<u64>> {
    let result = run::on_definition(program, states).unwrap();
    assert_eq!(run::on_gates(program, states).unwrap(), result);
    assert_eq!(run::on_fixed(program, states).unwrap(), result);
    let inverse = program.inverse();
    assert_eq!(run::on_definition(&inverse, &result).unwrap(), states);
    assert_eq!(run::on_gates(&inverse, &result).unwrap(), states);
    assert_eq!(run::on_fixed(&inverse, &result).unwrap(), states);
    result
}

/// Returns all contents of registers of these widths.
pub(super) fn all(widths: &[u32]) -> Vec<Vec<u64>> {
    let mut states = vec![Vec::new()];
    for width in widths {
        let longer = states.iter().flat_map(|state| {
            (0..1 << width).map(move |value| {
                let mut state = state.clone();
                state.push(value);
                state
            })
        });
        states = longer.collect();
    }
    states
}

/// Checks in both styles that the routine maps each state as `expected` does, that its inverse maps it
/// back, and that the two inverses agree.
pub(super) fn check(
    [forward, backward]: [fn(Style) -> Program; 2],
    states: &[Vec<u64>],
    expected: impl Fn(&[u64]) -> Vec<u64>,
) {
    for style in [Style::InPlace, Style::OutOfPlace] {
        let result = run_all(&forward(style), states);
        for (state, result) in states.iter().zip(&result) {
            assert_eq!(*result, expected(state), "from {state:?}");
        }
        assert_eq!(run_all(&backward(style), &result), states);
    }
}

/// out += x^2 + 3 y
#[reversible]
fn polynomial(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<10>) {
    let mut square: UInt<8> = 0;
    within! { square += x * x; }
    apply! { out += square; out += 3 * y; }
}

#[reversible]
fn undo_polynomial(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<10>) {
    polynomial_inverse(&x, &y, &mut out);
}

#[test]
fn a_polynomial() {
    let states: Vec<_> = all(&[4, 4])
        .into_iter()
        .map(|s| vec![s[0], s[1], 1000])
        .collect();
    check(
        [polynomial_program, undo_polynomial_program],
        &states,
        |s| vec![s[0], s[1], (s[2] + s[0] * s[0] + 3 * s[1]) % 1024],
    );
}

/// out += x - y + 3, by additions that are undone in another order than that of the additions.
#[reversible]
fn in_any_order(x: &UInt<3>, y: &UInt<3>, out: &mut UInt<4>) {
    let mut t: UInt<4> = 0;
    t += x;
    t -= y;
    t += 3;
    out += t;
    t -= x;
    t -= 3;
    t += y;
}

#[reversible]
fn back_in_any_order(x: &UInt<3>, y: &UInt<3>, out: &mut UInt<4>) {
    in_any_order_inverse(&x, &y, &mut out);
}

#[test]
fn additions_are_taken_back_in_any_order() {
    check(
        [in_any_order_program, back_in_any_order_program],
        &all(&[3, 3, 4]),
        |s| vec![s[0], s[1], (s[2] + s[0] + 19 - s[1]) % 16],
    );
}

#[reversible]
fn add<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
    b += a;
}

#[reversible]
fn subtract<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
    add_inverse::<W>(&a, &mut b);
}

#[test]
fn an_adder_and_its_inverse_of_any_width() {
    check(
        [add_program::<5>, subtract_program::<5>],
        &all(&[5, 5]),
        |s| vec![s[0], (s[0] + s[1]) % 32],
    );
    check(
        [subtract_program::<3>, add_program::<3>],
        &all(&[3, 3]),
        |s| vec![s[0], (s[1] + 8 - s[0]) % 8],
    );
}

#[reversible]
fn add_where(flag: &Bool, a: &UInt<4>, b: &mut UInt<4>) {
    if flag {
        add(&a, &mut b);
    } else {
        b ^= a;
    }
}

#[reversible]
fn add_where_backwards(flag: &Bool, a: &UInt<4>, b: &mut UInt<4>) {
    add_where_inverse(&flag, &a, &mut b);
}

#[test]
fn a_controlled_adder() {
    check(
        [add_where_program, add_where_backwards_program],
        &all(&[1, 4, 4]),
        |s| {
            let b = if s[0] == 1 {
                (s[1] + s[2]) % 16
            } else {
                s[1] ^ s[2]
            };
            vec![s[0], s[1], b]
        },
    );
}

/// sum += a b
#[reversible]
fn multiply_add(a: &UInt<3>, b: &Int<4>, sum: &mut Int<8>) {
    sum += a * b;
}

/// The same by shifted additions.
#[reversible]
fn shift_and_add(a: &UInt<3>, b: &Int<4>, sum: &mut Int<8>) {
    for i in 0..3 {
        if a[i] {
            sum += b << i;
        }
    }
}

#[reversible]
fn both_ways(a: &UInt<3>, b: &Int<4>, sum: &mut Int<8>) {
    multiply_add(&a, &b, &mut sum);
    shift_and_add_inverse(&a, &b, &mut sum);
}

#[reversible]
fn neither(a: &UInt<3>, b: &Int<4>, sum: &mut Int<8>) {
    both_ways_inverse(&a, &b, &mut sum);
}

#[test]
fn a_multiplier_and_the_same_by_hand() {
    let states: Vec<_> = all(&[3, 4])
        .into_iter()
        .map(|s| vec![s[0], s[1], 200])
        .collect();
    let signed = |bits: u64| (bits << 60).cast_signed() >> 60;
    for program in [multiply_add_program, shift_and_add_program] {
        for (s, result) in states
            .iter()
            .zip(run_all(&program(Style::InPlace), &states))
        {
            let sum = 200 + s[0].cast_signed() * signed(s[1]);
            assert_eq!(result[2], sum.cast_unsigned() & 255, "from {s:?}");
        }
    }
    check(
        [both_ways_program, neither_program],
        &states,
        <[u64]>::to_vec,
    );
}

#[reversible]
fn sort<const W: u32>(a: &mut UInt<W>, b: &mut UInt<W>, swapped: &mut Bool) {
    swapped ^= b < a;
    if swapped {
        swap(a, b);
    }
}

#[reversible]
fn unsort<const W: u32>(a: &mut UInt<W>, b: &mut UInt<W>, swapped: &mut Bool) {
    sort_inverse::<W>(&mut a, &mut b, &mut swapped);
}

#[test]
fn a_network_of_swaps() {
    check(
        [sort_program::<4>, unsort_program::<4>],
        &all_then(&[4, 4], &[0]),
        |s| vec![s[0].min(s[1]), s[0].max(s[1]), u64::from(s[1] < s[0])],
    );
}

fn all_then(widths: &[u32], rest: &[u64]) -> Vec<Vec<u64>> {
    let mut states = all(widths);
    for state in &mut states {
        state.extend(rest);
    }
    states
}

/// Computes every comparison, in a bit each.
#[reversible]
fn compare(a: &Int<4>, b: &UInt<3>, out: &mut UInt<8>) {
    out[0] ^= a < b;
    out[1] ^= a <= b;
    out[2] ^= a > b;
    out[3] ^= a >= b;
    out[4] ^= a == b;
    out[5] ^= a != b;
    out[6] ^= a < 3 && !(b == 2);
    out[7] ^= a[3] | b[0] ^ !b[1];
}

#[reversible]
fn uncompare(a: &Int<4>, b: &UInt<3>, out: &mut UInt<8>) {
    compare_inverse(&a, &b, &mut out);
}

#[test]
fn comparisons() {
    check(
        [compare_program, uncompare_program],
        &all_then(&[4, 3], &[0x5A]),
        |s| {
            let (a, b) = ((s[0] << 60).cast_signed() >> 60, s[1].cast_signed());
            let bits = [
                a < b,
                a <= b,
                a > b,
                a >= b,
                a == b,
                a != b,
                a < 3 && b != 2,
                a < 0 || ((b & 1 == 1) ^ (b & 2 == 0)),
            ];
            let flips = (0..8).fold(0, |all, i| all | u64::from(bits[i]) << i);
            vec![s[0], s[1], s[2] ^ flips]
        },
    );
}

/// Conditions in conditions, also in a called function, with scratch in all of them.
#[reversible]
fn nested(a: &UInt<2>, b: &mut UInt<4>, c: &mut UInt<3>) {
    if a[0] {
        if a[1] {
            inner(&a, &mut b);
        } else if b[3] {
            c += 3;
        }
        c ^= 1;
    } else {
        let mut t: UInt<5> = 0;
        within! {
            t += b + 1;
            if a[1] { t ^= 1; }
        }
        apply! {
            if t > 7 { c -= t[1..3]; }
        }
    }
}

#[reversible]
fn inner(a: &UInt<2>, b: &mut UInt<4>) {
    if b[0] & a[1] {
        b[3] ^= !b[1];
        b[1..3] ^= a;
    }
    swap_ends(&mut b);
}

#[reversible]
fn swap_ends(b: &mut UInt<4>) {
    b[0] ^= b[3];
    b[3] ^= b[0];
    b[0] ^= b[3];
}

#[reversible]
fn unnested(a: &UInt<2>, b: &mut UInt<4>, c: &mut UInt<3>) {
    nested_inverse(&a, &mut b, &mut c);
}

#[test]
fn conditions_in_conditions() {
    check([nested_program, unnested_program], &all(&[2, 4, 3]), |s| {
        let (a, mut b, mut c) = (s[0], s[1], s[2]);
        if a & 1 == 1 {
            if a & 2 == 2 {
                if b & 1 == 1 {
                    b ^= (!b >> 1 & 1) << 3;
                    b ^= a << 1;
                }
                b = b & 6 | b >> 3 | (b & 1) << 3;
            } else if b & 8 == 8 {
                c += 3;
            }
            c = (c % 8) ^ 1;
        } else {
            let t = (b + 1) ^ (a >> 1);
            if t > 7 {
                c = c + 8 - (t >> 1 & 3);
            }
        }
        vec![a, b, c % 8]
    });
}

/// out += the number of ones; a rotated by one.
#[reversible]
fn count_and_rotate<const W: u32, const V: u32>(a: &mut UInt<W>, ones: &mut UInt<V>) {
    for i in 0..W {
        ones += a[i];
    }
    for i in (1..W).rev() {
        a[i] ^= a[i - 1];
        a[i - 1] ^= a[i];
        a[i] ^= a[i - 1];
    }
}

#[reversible]
fn rotate_back<const W: u32, const V: u32>(a: &mut UInt<W>, ones: &mut UInt<V>) {
    count_and_rotate_inverse::<W, V>(&mut a, &mut ones);
}

#[test]
fn loops_over_constants() {
    let programs = [
        count_and_rotate_program::<6, 3>,
        rotate_back_program::<6, 3>,
    ];
    check(programs, &all(&[6, 3]), |s| {
        let rotated = s[0] << 1 & 63 | s[0] >> 5;
        vec![rotated, (s[1] + u64::from(s[0].count_ones())) % 8]
    });
}

/// y += x - x^2 / 4 + 0.25, in fixed point.
#[reversible]
fn parabola(x: &Fixed<2, 6>, y: &mut Fixed<4, 6>) {
    y += x - 0.25 * x * x + 0.25;
}

/// The same by Horner's rule, rounding twice.
#[reversible]
fn horner(x: &Fixed<2, 6>, y: &mut Fixed<4, 6>) {
    let mut slope: Fixed<3, 6> = 0;
    within! {
        slope += 1 - floor(x >> 2);
    }
    apply! {
        y += wrapping(slope * x) + 0.25;
    }
}

#[reversible]
fn back(x: &Fixed<2, 6>, y: &mut Fixed<4, 6>) {
    parabola_inverse(&x, &mut y);
}

#[reversible]
fn horner_back(x: &Fixed<2, 6>, y: &mut Fixed<4, 6>) {
    horner_inverse(&x, &mut y);
}

#[test]
fn polynomials_in_fixed_point() {
    let states = all_then(&[8], &[0]);
    let x = |s: &[u64]| (s[0] << 56).cast_signed() >> 56;
    check([parabola_program, back_program], &states, |s| {
        let y = x(s) - ((x(s) * x(s)) >> 8) + 16;
        assert!((y as f64 / 64.0 - exact(x(s))).abs() <= 1.0 / 64.0);
        vec![s[0], y.cast_unsigned() & 1023]
    });
    check([horner_program, horner_back_program], &states, |s| {
        let y = (((64 - (x(s) >> 2)) * x(s)) >> 6) + 16;
        assert!((y as f64 / 64.0 - exact(x(s))).abs() <= 4.0 / 64.0);
        vec![s[0], y.cast_unsigned() & 1023]
    });
    assert_eq!(Fixed::<2, 6>::bits(-0.5), Some(0xE0));
}

fn exact(x: i64) -> f64 {
    let x = x as f64 / 64.0;
    x - x * x / 4.0 + 0.25
}

/// Scratch that is uncomputed by hand, in an order that the author chose.
#[reversible]
fn by_hand(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<6>) {
    let mut sum: UInt<5> = 0;
    let mut odd: Bool = false;
    sum += x + y;
    odd ^= sum[0] ^ x[3];
    if odd {
        out += sum;
    }
    odd ^= sum[0] ^ x[3];
    sum -= y + x;
    {
        let mut t: UInt<6> = 0;
        add_up(&x, &mut t);
        out ^= t;
        add_up_inverse(&x, &mut t);
    }
    for i in 0..3 {
        let mut bit: Bool = false;
        bit ^= x[i] & y[i];
        out[i + 2] ^= bit;
        bit ^= x[i] & y[i];
    }
}

#[reversible]
fn add_up(x: &UInt<4>, t: &mut UInt<6>) {
    t += (x + 1) * 2;
}

#[reversible]
fn by_hand_back(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<6>) {
    by_hand_inverse(&x, &y, &mut out);
}

#[test]
fn scratch_uncomputed_by_hand() {
    check(
        [by_hand_program, by_hand_back_program],
        &all_then(&[4, 4], &[41]),
        |s| {
            let (x, y) = (s[0], s[1]);
            let sum = x + y;
            let mut out = s[2];
            if (sum & 1) ^ (x >> 3) == 1 {
                out = (out + sum) % 64;
            }
            out ^= 2 * (x + 1);
            out ^= (x & y & 7) << 2;
            vec![x, y, out]
        },
    );
}

/// Registers of 20 bits and more, tested on random numbers.
#[reversible]
fn wide(a: &Int<20>, b: &UInt<21>, c: &Int<30>, out: &mut Int<54>) {
    out += (a + b) * c - 12345 * a;
    out -= wrapping(c * c);
    out ^= wrapping((a - b) << 3);
    if a * 5 < c >> 4 {
        out += b[3..17] * c[20..30];
    }
}

#[reversible]
fn wide_back(a: &Int<20>, b: &UInt<21>, c: &Int<30>, out: &mut Int<54>) {
    wide_inverse(&a, &b, &c, &mut out);
}

#[test]
fn wide_registers() {
    let mut state = 1_u64;
    let mut random = |bits: u32| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        state >> (64 - bits)
    };
    let states: Vec<Vec<u64>> = (0..500)
        .map(|_| [20, 21, 30, 54].map(&mut random).into())
        .collect();
    let signed =
        |bits: u64, width: u32| i128::from((bits << (64 - width)).cast_signed() >> (64 - width));
    check([wide_program, wide_back_program], &states, |s| {
        let (a, b, c) = (signed(s[0], 20), i128::from(s[1]), signed(s[2], 30));
        let mut out = i128::from(s[3]) + (a + b) * c - 12345 * a - c * c;
        out ^= (a - b) << 3;
        if a * 5 < c >> 4 {
            out += i128::from(s[1] >> 3 & 0x3FFF) * i128::from(s[2] >> 20);
        }
        vec![s[0], s[1], s[2], out as u64 & ((1 << 54) - 1)]
    });
}

#[reversible]
fn beyond_the_half(a: &mut UInt<63>) {
    a += 4_611_686_018_427_387_904;
    a ^= 9_223_372_036_854_775_807;
}

#[test]
fn the_longest_register_takes_the_longest_constants() {
    let program = beyond_the_half_program(Style::InPlace);
    let states = [0, 7, 1 << 62, (1 << 63) - 1].map(|before: u64| vec![before]);
    for (before, after) in states.iter().zip(run_all(&program, &states)) {
        let sum = (before[0] + (1 << 62)) % (1 << 63);
        assert_eq!(after, [sum ^ ((1 << 63) - 1)]);
    }
}

type Word = UInt<4>;

const OFFSET: u32 = 5;

mod sizes {
    pub(super) const W: u32 = 4;
    pub(super) const HALF: usize = 2;
}

/// Widths, bounds and numbers that are constants of modules, an alias, and a loop's variable.
#[reversible]
fn named(x: &Word, out: &mut UInt<{ 2 * sizes::W }>) {
    out += x;
    out -= OFFSET + 1;
    for i in 1..sizes::W {
        out += 7 - i;
        if x[i] {
            out += wrapping(i * x);
        }
    }
    out[sizes::HALF..6] ^= OFFSET;
    if x > sizes::W {
        out ^= sizes::HALF;
    }
}

#[reversible]
fn unnamed(x: &Word, out: &mut UInt<{ 2 * sizes::W }>) {
    named_inverse(&x, &mut out);
}

#[test]
fn constants_and_aliases_of_modules() {
    check([named_program, unnamed_program], &all(&[4, 8]), |s| {
        let mut out = s[1] + s[0] + 256 - 6;
        for i in 1..4 {
            out += 7 - i + (s[0] >> i & 1) * i * s[0];
        }
        out ^= 5 << 2;
        if s[0] > 4 {
            out ^= 2;
        }
        vec![s[0], out % 256]
    });
}

/// Adds in place by a ripple of majorities that borrow one bit (Cuccaro et al. 2004), by hand.
#[reversible]
fn ripple(a: &mut UInt<4>, b: &mut UInt<4>) {
    let mut carry: Bool = false;
    b[0] ^= a[0];
    carry ^= a[0];
    a[0] ^= carry & b[0];
    for i in 1..4 {
        b[i] ^= a[i];
        a[i - 1] ^= a[i];
        a[i] ^= a[i - 1] & b[i];
    }
    for i in (1..4).rev() {
        a[i] ^= a[i - 1] & b[i];
        a[i - 1] ^= a[i];
        b[i] ^= a[i - 1];
    }
    a[0] ^= carry & b[0];
    carry ^= a[0];
    b[0] ^= carry;
}

#[reversible]
fn unripple(a: &mut UInt<4>, b: &mut UInt<4>) {
    ripple_inverse(&mut a, &mut b);
}

/// Scratch whose bits are allocated and freed independently, across a swap under a comparison.
#[reversible]
fn in_parts(x: &UInt<3>, y: &UInt<3>, out: &mut UInt<4>) {
    let mut low: UInt<3> = 0;
    let mut high: UInt<3> = 0;
    let mut less: Bool = false;
    low ^= x;
    for i in 0..3 {
        high[i] ^= y[i];
    }
    less ^= y < x;
    if less {
        swap(low, high);
    }
    out += high;
    for i in (0..3).rev() {
        if less {
            low[i] ^= high[i];
            high[i] ^= low[i];
            low[i] ^= high[i];
        }
        low[i] ^= x[i];
    }
    less ^= y < x;
    high ^= y;
}

#[reversible]
fn in_parts_back(x: &UInt<3>, y: &UInt<3>, out: &mut UInt<4>) {
    in_parts_inverse(&x, &y, &mut out);
}

#[test]
fn scratch_is_uncomputed_bit_by_bit() {
    check([ripple_program, unripple_program], &all(&[4, 4]), |s| {
        vec![s[0], (s[0] + s[1]) % 16]
    });
    let programs = [in_parts_program, in_parts_back_program];
    check(programs, &all(&[3, 3, 4]), |s| {
        vec![s[0], s[1], (s[2] + s[0].max(s[1])) % 16]
    });
}

const FOUR: usize = 4;

/// Sorts neighbours in an array of registers, and keeps which of them were swapped.
#[reversible]
fn bubble(all: &mut [UInt<2>; FOUR], swapped: &mut [Bool; 3]) {
    for i in 0..3 {
        swapped[i] ^= all[i + 1] < all[i];
        if swapped[i] {
            swap(all[i], all[i + 1]);
        }
    }
}

/// Passes arrays, whole and one by one, and uses an array of scratch.
#[reversible]
fn pass_on(all: &mut [UInt<2>; FOUR], sum: &mut UInt<4>) {
    let mut swapped: [Bool; 3] = [false; 3];
    within! { bubble(&mut all, &mut swapped); }
    apply! { sum += all[3]; }
    let mut sums: [UInt<3>; 2] = [0; 2];
    within! {
        for i in 0..2 { sums[i] += all[2 * i] + all[2 * i + 1]; }
    }
    apply! {
        sum -= sums[0];
        sum[1..4] ^= sums[1];
    }
    for i in 1..4 {
        three(&all[0], &all[0], &mut all[i]);
    }
    all[0] += all[3];
    all[1][0] ^= all[2][1] & all[0][1];
}

#[reversible]
fn three(a: &UInt<2>, b: &UInt<2>, c: &mut UInt<2>) {
    c += a;
    c ^= b;
}

#[reversible]
fn take_back(all: &mut [UInt<2>; FOUR], sum: &mut UInt<4>) {
    pass_on_inverse(&mut all, &mut sum);
}

#[test]
fn arrays_of_registers() {
    check(
        [pass_on_program, take_back_program],
        &all(&[2, 2, 2, 2, 4]),
        |s| {
            let mut all = s[..4].to_vec();
            let mut sum = s[4] + all.iter().max().unwrap();
            sum = ((sum + 16 - (all[0] + all[1])) % 16) ^ ((all[2] + all[3]) << 1);
            for i in 1..4 {
                all[i] = ((all[i] + all[0]) % 4) ^ all[0];
            }
            all[0] = (all[0] + all[3]) % 4;
            all[1] ^= (all[2] >> 1) & (all[0] >> 1);
            all.push(sum % 16);
            all
        },
    );
}
