// Both macros, by full paths alone: crates of several kinds include this text.

::qrt::qrt! {
    scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 2 x 2,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(3, 2, 1) },
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 4, lights: none },
        depth primary { bits: (2, 2) },
        depth secondary { bits: (2, 2) },
    }
}

/// An entry for each number of two bits.
const SQUARES: [::core::primitive::u32; 4] = [0, 1, 4, 9];

#[::qrt::reversible]
fn add<const W: ::core::primitive::u32>(
    a: &::qrt::circuit::format::UInt<W>,
    b: &mut ::qrt::circuit::format::UInt<W>,
) {
    b += a;
}

#[::qrt::reversible]
fn widen<const W: ::core::primitive::u32>(
    a: &::qrt::circuit::format::UInt<W>,
    b: &mut ::qrt::circuit::format::UInt<{ W + 1 }>,
) {
    b += a;
    b += W;
}

/// Every kind of statement.
#[::qrt::reversible]
fn all(
    flag: &::qrt::circuit::format::Bool,
    k: &::qrt::circuit::format::UInt<2>,
    a: &mut [::qrt::circuit::format::UInt<4>; 2],
    b: &mut ::qrt::circuit::format::UInt<4>,
    c: &mut ::qrt::circuit::format::UInt<5>,
) {
    let mut t: ::qrt::circuit::format::UInt<8> = 0;
    let mut pair: [::qrt::circuit::format::Bool; 2] = [false; 2];
    within! {
        t += b * b;
        pair[0] ^= flag && b == 3;
    }
    apply! {
        c ^= t[0..5];
        if pair[0] {
            a[0] += 3;
        } else {
            add(&b, &mut a[1]);
        }
    }
    for i in (0..2).rev() {
        a[i][0] ^= flag;
        b += SQUARES[i];
    }
    for i in 0..4 {
        c += i;
    }
    b += SQUARES[k];
    b ^= a[0] & a[1] | 3;
    swap(a[0], a[1]);
    widen(&b, &mut c);
    if b > 3 {
        c -= 1;
    }
    let mut less: ::qrt::circuit::format::Bool = false;
    less ^= b < 3;
    less ^= b < 3;
    assert_zero!(less);
}

/// Runs the function forwards and backwards, and looks at the scene.
fn check() {
    let program = all_program(::qrt::circuit::Style::InPlace);
    let states = [[1, 2, 3, 4, 5, 6], [0, 3, 15, 9, 3, 31]];
    let forward = ::qrt::machines::run::on_gates(&program, &states).unwrap();
    let back = ::qrt::machines::run::on_gates(&program.inverse(), &forward).unwrap();
    ::core::assert!(forward != states);
    ::core::assert_eq!(back, states);
    ::core::assert_eq!(Room::scene().scene().film.width, 2);
    ::core::assert!(Room::TOFFOLI > 0);
}
