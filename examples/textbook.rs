//! Eight routines of the textbooks, and their costs: `cargo run --example textbook`.

use qrt::circuit::lower;
use qrt::prelude::*;

/// b += a, in place.
#[reversible]
pub(crate) fn add<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
    b += a;
}

/// Exchanges a and b if the bit `when` is set: W Fredkin gates.
#[reversible]
pub(crate) fn swap_if<const W: u32>(when: &Bool, a: &mut UInt<W>, b: &mut UInt<W>) {
    if when {
        swap(a, b);
    }
}

/// x = (x + 1) % 11 for x < 11: adds 1, then exchanges 11 and 0.
#[reversible]
pub(crate) fn increment_modulo(x: &mut UInt<4>) {
    x += 1;
    // In 0 and in 0b1011 the bits 0, 1 and 3 are equal and bit 2 is 0; no other x shares that.
    x[1] ^= x[0];
    x[3] ^= x[0];
    x[0] ^= !x[1] & !x[2] & !x[3];
    x[3] ^= x[0];
    x[1] ^= x[0];
}

/// root += the square root of x, rounded down, and x loses its square: digit by digit, as on paper.
/// `root` must be 0; x is not negative, and has two bits for each digit, and its sign.
#[reversible]
pub(crate) fn square_root<const N: u32, const W: u32>(x: &mut Int<W>, root: &mut UInt<N>) {
    for i in (0..N).rev() {
        // (root + 2^i)^2 - root^2 = 2^(i + 1) root + 4^i
        let mut step: Int<W> = 0;
        step[2 * i] ^= true;
        for j in i + 1..N {
            step[i + j + 1] ^= root[j];
        }
        x -= step;
        root[i] ^= !x[W - 1];
        if !root[i] {
            x += step;
        }
        for j in i + 1..N {
            step[i + j + 1] ^= root[j];
        }
        step[2 * i] ^= true;
    }
}

/// ones ^= the number of ones in x, by adders of three bits, each of which takes one AND.
#[reversible]
pub(crate) fn popcount(x: &UInt<8>, ones: &mut UInt<4>) {
    let mut sums: UInt<3> = 0;
    let mut twos: UInt<4> = 0;
    let mut fours: UInt<2> = 0;
    let mut two: Bool = false;
    within! {
        sums[0] ^= x[0] ^ x[1] ^ x[2];
        sums[1] ^= x[3] ^ x[4] ^ x[5];
        sums[2] ^= x[6] ^ sums[0] ^ sums[1];
        twos[0] ^= (x[0] ^ x[1]) & (x[0] ^ x[2]) ^ x[0];
        twos[1] ^= (x[3] ^ x[4]) & (x[3] ^ x[5]) ^ x[3];
        twos[2] ^= (x[6] ^ sums[0]) & (x[6] ^ sums[1]) ^ x[6];
        twos[3] ^= x[7] & sums[2];
        two ^= twos[0] ^ twos[1] ^ twos[2];
        fours[0] ^= (twos[0] ^ twos[1]) & (twos[0] ^ twos[2]) ^ twos[0];
        fours[1] ^= two & twos[3];
    }
    apply! {
        ones[0] ^= sums[2] ^ x[7];
        ones[1] ^= two ^ twos[3];
        ones[2] ^= fours[0] ^ fours[1];
        ones[3] ^= fours[0] & fours[1];
    }
}

/// Sorts two numbers; `swapped` is flipped if they were in the wrong order.
#[reversible]
pub(crate) fn sort_two<const W: u32>(a: &mut UInt<W>, b: &mut UInt<W>, swapped: &mut Bool) {
    swapped ^= b < a;
    swap_if(&swapped, &mut a, &mut b);
}

/// Sorts four numbers by Batcher's network, and keeps the permutation.
#[reversible]
pub(crate) fn sort_four<const W: u32>(
    a: &mut UInt<W>,
    b: &mut UInt<W>,
    c: &mut UInt<W>,
    d: &mut UInt<W>,
    first: &mut Bool,
    second: &mut Bool,
    third: &mut Bool,
    fourth: &mut Bool,
    fifth: &mut Bool,
) {
    sort_two(&mut a, &mut b, &mut first);
    sort_two(&mut c, &mut d, &mut second);
    sort_two(&mut a, &mut c, &mut third);
    sort_two(&mut b, &mut d, &mut fourth);
    sort_two(&mut b, &mut c, &mut fifth);
}

/// sum += a b, rounded down to the last bit of the sum.
#[reversible]
pub(crate) fn multiply_add<const F: u32>(a: &Fixed<2, F>, b: &Fixed<2, F>, sum: &mut Fixed<4, F>) {
    sum += a * b;
}

/// less ^= a < b.
#[reversible]
pub(crate) fn compare<const W: u32>(a: &UInt<W>, b: &UInt<W>, less: &mut Bool) {
    less ^= a < b;
}

/// A routine, its program, and the best published count of Toffolis with its source.
pub(crate) type Row = (&'static str, Program, u64, &'static str);

/// Returns the routines at sizes for which counts are published.
pub(crate) fn rows() -> Vec<Row> {
    let style = Style::InPlace;
    vec![
        (
            "add in place, 16 bits",
            add_program::<16>(style),
            30,
            "2n - 2: Takahashi, Tani, Kunihiro 2010 (Cuccaro et al. 2004: 2n)",
        ),
        (
            "conditional swap, 16 bits",
            swap_if_program::<16>(style),
            16,
            "n: Fredkin and Toffoli 1982",
        ),
        (
            "increment modulo 11",
            increment_modulo_program(style),
            32,
            "8n: four adders, Vedral, Barenco, Ekert 1996, for any sum",
        ),
        (
            "square root by digits, 16 bits",
            square_root_program::<8, 17>(style),
            212,
            "n^2/2 + 5n + 4: Qrisp, not restoring",
        ),
        (
            "popcount, 8 bits",
            popcount_program(style),
            13,
            "7 ANDs: Boyar and Peralta 2008; 6 of them undone",
        ),
        (
            "sorting network of four, 16 bits",
            sort_four_program::<16>(style),
            240,
            "5 (2n + n): Batcher 1968, with comparators of Cuccaro et al. and Fredkin gates",
        ),
        (
            "multiply-accumulate, 2 + 14 bits",
            multiply_add_program::<14>(style),
            1994,
            "1,964 + 30: Q#, fixed-point product and adder",
        ),
        (
            "comparator, 16 bits",
            compare_program::<16>(style),
            32,
            "2n: Cuccaro et al. 2004",
        ),
    ]
}

fn main() {
    println!("routine                           qubits  Toffolis  measured  published  source");
    for (name, program, published, source) in rows() {
        let qubits = lower::circuit(&program).qubits;
        let cost: lower::Cost = lower::tally(&program).into_iter().sum();
        let more = if cost.toffoli > published {
            "(more)"
        } else {
            ""
        };
        println!(
            "{name:33} {qubits:6} {:9} {:9} {published:10}  {more:6} {source}",
            cost.toffoli, cost.and_measured
        );
    }
}
