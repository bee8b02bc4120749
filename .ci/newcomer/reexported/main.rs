//! Both macros, by the path of a library that re-exports qrt.

library::adder!(sum);

library::qrt::qrt! {
    crate = library::qrt;

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

#[library::qrt::reversible(crate = library::qrt)]
fn widen<const W: ::core::primitive::u32>(
    a: &library::qrt::circuit::format::UInt<W>,
    b: &mut library::qrt::circuit::format::UInt<{ W + 1 }>,
) {
    b += a;
    b += W;
}

fn main() {
    ::core::assert_eq!(Room::scene().scene().film.width, 2);
    ::core::assert!(Room::TOFFOLI > 0);
    let widen = widen_program::<4>(library::qrt::circuit::Style::InPlace);
    let states = library::qrt::machines::run::on_gates(&widen, &[[3, 20]]);
    assert_eq!(states.unwrap(), [[3, 27]]);
    let sum = sum_program(library::qrt::circuit::Style::InPlace);
    let states = library::qrt::machines::run::on_gates(&sum, &[[3, 4]]);
    assert_eq!(states.unwrap(), [[3, 7]]);
    println!("reexported: both macros through another crate");
}
