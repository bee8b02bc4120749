//! A reversible function as a scene's BSDF: its mathematics, compiled into the scene.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use qrt::prelude::*;

/// 0.25 cos_i cos_o
#[reversible]
fn glow(cos_i: &UFixed<1, 14>, cos_o: &UFixed<1, 14>, out: &mut UFixed<2, 14>) {
    out += 0.25 * cos_i * cos_o;
}

mod optics {
    use super::*;
    #[reversible]
    pub fn tinted(
        cos_i: &UFixed<1, 14>,
        r: &mut UFixed<2, 14>,
        g: &mut UFixed<2, 14>,
        b: &mut UFixed<2, 14>,
    ) {
        r += cos_i >> 2;
        g += 0.125;
        if cos_i < 0.5 {
            b += 0.25;
        } else {
            b += 0.25 * cos_i;
        }
    }
}

qrt! {
    pub scene Terms {
        camera: perspective { eye: (0, 2, 4), target: (0, 0, 0), vfov: 40 },
        film: 4 x 4,
        material a: bsdf {
            map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
            jacobian: auto,
            value: fn glow,
        },
        material b: bsdf {
            map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
            jacobian: auto,
            value: fn optics::tinted,
        },
        quad: a { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
    }
}

#[test]
fn it_works() {
    println!("{:#?}", Terms::scene().scene().materials);
    #[reversible]
    fn inner(cos_i: &UFixed<1, 14>, cos_o: &UFixed<1, 14>, out: &mut UFixed<2, 14>) {
        out += 0.25 * cos_i * cos_o;
    }
    qrt! {
        pub scene Terms {
            camera: perspective { eye: (0, 2, 4), target: (0, 0, 0), vfov: 40 },
            film: 4 x 4,
            material a: bsdf {
                map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
                jacobian: auto,
                value: fn inner,
            },
            quad: a { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        }
    }
    Terms::scene();
}
