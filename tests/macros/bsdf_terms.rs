//! Tests of a reversible function as a scene's BSDF: the function computes the BSDF's mathematics to within
//! its rounding, on every machine.

#![allow(
    deprecated,
    reason = "that is how `qrt!` warns of values that are not reciprocal"
)]

use qrt::prelude::*;
use qrt::scene::Material;
use qrt::scene::expr::{Expr, Variable, Variables};
use std::path::Path;

/// A product.
#[reversible]
fn glow(cos_i: &UFixed<1, 14>, cos_o: &UFixed<1, 14>, out: &mut UFixed<2, 14>) {
    out += 0.25 * cos_i * cos_o;
}

/// Scratch registers.
#[reversible]
fn sheen(cos_i: &UFixed<1, 14>, out: &mut UFixed<2, 14>) {
    let mut dark: UFixed<1, 14> = 0;
    let mut square: UFixed<2, 14> = 0;
    within! {
        dark += 1 - cos_i;
        square += dark * dark;
    }
    apply! {
        out += 0.25 * square * square;
    }
}

/// A branch, in which a difference is never negative.
#[reversible]
fn lobe(cos_a: &Fixed<2, 14>, out: &mut UFixed<2, 14>) {
    if cos_a > 0.5 {
        out += wrapping(cos_a) - 0.5;
    }
}

/// A loop.
#[reversible]
fn halves(cos_o: &UFixed<1, 14>, out: &mut UFixed<1, 14>) {
    for i in 3..6 {
        out += cos_o >> i;
    }
}

pub(crate) mod optics {
    use qrt::prelude::*;

    /// Three outputs, and branches that exclude each other.
    #[reversible]
    pub fn tint(
        u: &UFixed<0, 10>,
        v: &UFixed<0, 10>,
        b: &mut UFixed<1, 14>,
        g: &mut UFixed<1, 14>,
        r: &mut Fixed<2, 14>,
    ) {
        r += 0.125 - (u >> 4);
        g += (u * v) >> 3;
        if u < v && v > 0.25 {
            b += 0.125;
        } else {
            b += v >> 3;
        }
    }
}

/// Scratch that is swapped and uncomputed by hand.
#[reversible]
fn by_hand(cos_i: &UFixed<1, 8>, cos_o: &UFixed<1, 8>, out: &mut UFixed<3, 16>) {
    let mut less: UFixed<1, 8> = 0;
    let mut more: UFixed<1, 8> = 0;
    less += cos_i;
    more += cos_o;
    if cos_i > cos_o {
        swap(less, more);
    }
    out += less * more >> 3;
    if cos_i > cos_o {
        swap(less, more);
    }
    more -= cos_o;
    less -= cos_i;
}

macro_rules! scene {
    ($name:ident { $($material:ident: { $($value:tt)* }),* $(,)? }) => {
        qrt! {
            scene $name {
                name: "terms",
                camera: perspective { eye: (0, 3, 5), target: (0, 0, 0), vfov: 60 },
                film: 6 x 4,
                $(
                    material $material: bsdf {
                        map: |u, v| (
                            sqrt(u) * cos(2 * pi * v),
                            sqrt(u) * sin(2 * pi * v),
                            sqrt(1 - u),
                        ),
                        jacobian: auto,
                        value: $($value)*,
                    },
                    triangle: $material { (-1, 0, 1), (1, 0, 1), (0, 0, -1) },
                )*
                material lamp: emitter { radiance: (4, 3, 2) },
                quad: lamp { (-1, 3, -1), (1, 3, -1), (1, 3, 1), (-1, 3, 1) },
                sampling { path_bits: 4 },
                depth { bits: (4, 4) },
                depth { bits: (4, 4) },
            }
        }
    };
}

scene!(Terms {
    glow: { fn glow },
    sheen: { fn self::sheen },
    lobe: { fn lobe },
    halves: { fn halves },
    tint: { fn optics::tint },
    by_hand: { fn crate::macros::bsdf_terms::by_hand },
});

scene!(Written {
    glow: { 0.25 * cos_i * cos_o },
    sheen: { 0.25 * (1 - cos_i) ^ 2 * (1 - cos_i) ^ 2 },
    lobe: { if_less(0.5, cos_a, cos_a - 0.5, 0) },
    halves: { 0.125 * cos_o + 0.0625 * cos_o + 0.03125 * cos_o },
    tint: {
        rgb(
            0.125 - 0.0625 * u,
            0.125 * (u * v),
            if_less(u, v, if_less(0.25, v, 0.125, 0.125 * v), 0.125 * v),
        )
    },
    by_hand: {
        0.125 * (if_less(cos_o, cos_i, cos_o, cos_i) * if_less(cos_o, cos_i, cos_i, cos_o))
    },
});

/// Returns the expressions of a scene's material.
fn expressions(material: &str) -> Vec<Expr> {
    let materials = &Terms::scene().scene().materials;
    let found = materials.iter().find(|(name, _)| name == material);
    let Some((_, Material::Bsdf(bsdf))) = found else {
        panic!("{material}");
    };
    let parse = |text: &String| Expr::parse(text, &Variable::ALL).unwrap();
    bsdf.value.iter().map(parse).collect()
}

/// Checks that a routine, on all machines, computes a material's expressions to within `error`: `inputs`
/// are the numbers of its registers, `outputs` their values afterwards, in the channels' order.
fn check<const N: usize>(
    material: &str,
    program: fn(Style) -> Program,
    grid: &[[f64; N]],
    state: impl Fn([f64; N]) -> Vec<u64>,
    variables: impl Fn([f64; N]) -> Variables,
    outputs: impl Fn(&[u64]) -> Vec<f64>,
    error: f64,
) {
    let expressions = expressions(material);
    let states: Vec<Vec<u64>> = grid.iter().map(|point| state(*point)).collect();
    for style in [Style::InPlace, Style::OutOfPlace] {
        let program = program(style);
        let ends = run::on_definition(&program, &states).unwrap();
        assert_eq!(run::on_fixed(&program, &states).unwrap(), ends);
        assert_eq!(run::on_gates(&program, &states).unwrap(), ends);
        for (point, end) in grid.iter().zip(&ends) {
            let outputs = outputs(end);
            assert_eq!(outputs.len(), expressions.len());
            for (output, expression) in outputs.iter().zip(&expressions) {
                let expected = expression.eval(&variables(*point));
                let far = (output - expected).abs();
                assert!(
                    far <= error,
                    "{material} at {point:?}: {output}, not {expected}"
                );
            }
        }
    }
}

/// Returns multiples of `1 / parts` from `first` to `last`.
fn steps(first: i32, last: i32, parts: i32) -> Vec<[f64; 1]> {
    let all = first * parts..=last * parts;
    all.map(|step| [f64::from(step) / f64::from(parts)])
        .collect()
}

fn pairs(singles: &[[f64; 1]]) -> Vec<[f64; 2]> {
    let pair = |[a]: [f64; 1]| singles.iter().map(move |[b]| [a, *b]);
    singles.iter().copied().flat_map(pair).collect()
}

const ULP: f64 = 1.0 / 16384.0;

type Cosine = UFixed<1, 14>;
type Value = UFixed<2, 14>;

fn bits<T: Format>(value: f64) -> u64 {
    T::bits(value).unwrap()
}

#[test]
fn a_product() {
    check(
        "glow",
        glow_program,
        &pairs(&steps(0, 1, 32)),
        |[i, o]| vec![bits::<Cosine>(i), bits::<Cosine>(o), 0],
        |[cos_i, cos_o]| Variables {
            cos_i,
            cos_o,
            ..Variables::default()
        },
        |end| vec![Value::value(end[2])],
        ULP,
    );
}

#[test]
fn scratch_registers() {
    check(
        "sheen",
        sheen_program,
        &steps(0, 1, 512),
        |[i]| vec![bits::<Cosine>(i), 0],
        |[cos_i]| Variables {
            cos_i,
            ..Variables::default()
        },
        |end| vec![Value::value(end[1])],
        2.0 * ULP,
    );
}

#[test]
fn a_branch() {
    check(
        "lobe",
        lobe_program,
        &steps(-1, 1, 512),
        |[a]| vec![bits::<Fixed<2, 14>>(a), 0],
        |[cos_a]| Variables {
            cos_a,
            ..Variables::default()
        },
        |end| vec![Value::value(end[1])],
        0.0,
    );
}

#[test]
fn a_loop() {
    check(
        "halves",
        halves_program,
        &steps(0, 1, 512),
        |[o]| vec![bits::<Cosine>(o), 0],
        |[cos_o]| Variables {
            cos_o,
            ..Variables::default()
        },
        |end| vec![Cosine::value(end[1])],
        3.0 * ULP,
    );
}

#[test]
fn three_outputs() {
    let below_1 = &steps(0, 1, 32)[..32];
    check(
        "tint",
        optics::tint_program,
        &pairs(below_1),
        |[u, v]| vec![bits::<UFixed<0, 10>>(u), bits::<UFixed<0, 10>>(v), 0, 0, 0],
        |[u, v]| Variables {
            u,
            v,
            ..Variables::default()
        },
        |end| {
            vec![
                Fixed::<2, 14>::value(end[4]),
                Cosine::value(end[3]),
                Cosine::value(end[2]),
            ]
        },
        ULP,
    );
}

#[test]
fn by_hand_and_swapped() {
    check(
        "by_hand",
        by_hand_program,
        &pairs(&steps(0, 1, 32)),
        |[i, o]| vec![bits::<UFixed<1, 8>>(i), bits::<UFixed<1, 8>>(o), 0],
        |[cos_i, cos_o]| Variables {
            cos_i,
            cos_o,
            ..Variables::default()
        },
        |end| vec![UFixed::<3, 16>::value(end[2])],
        1.0 / 65536.0,
    );
}

fn picture(scene: &ValidScene, name: &str) -> Vec<u8> {
    let exact = Options {
        estimator: Some(Estimator::Exact),
        ..Options::default()
    };
    let rendered = render(scene, &exact).unwrap();
    assert!(rendered.image.pixels.iter().flatten().any(|c| *c > 0.0));
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let metadata = rendered.metadata().unwrap();
    let encoding = Encoding::for_path(&path, None).unwrap();
    save(&path, &rendered.image, &metadata, encoding).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn a_term_is_the_expression_written_out() {
    assert_eq!(Terms::scene().scene(), Written::scene().scene());
    assert_eq!(Terms::scene().fingerprint(), Written::scene().fingerprint());
    assert_eq!(Terms::scene().polygons(), Written::scene().polygons());
    let [terms, written] = [
        (Terms::scene(), "terms.exr"),
        (Written::scene(), "written.exr"),
    ]
    .map(|(scene, name)| picture(scene, name));
    assert_eq!(terms, written);
}

/// Functions are terms even where they are not visible outside.
#[test]
fn a_function_within_a_function() {
    #[reversible]
    fn shine(cos_i: &UFixed<1, 14>, out: &mut UFixed<2, 14>) {
        out += 0.25 * cos_i;
    }
    scene!(Local { own: { fn shine } });
    let Material::Bsdf(bsdf) = &Local::scene().scene().materials[0].1 else {
        panic!("not a BSDF");
    };
    assert_eq!(bsdf.value, ["0.25*cos_i"]);
}

/// A term's name may come from another macro, with its path.
#[test]
fn a_term_as_a_macros_variable() {
    macro_rules! of {
        ($term:path) => {
            scene!(Passed { own: { fn $term } });
        };
    }
    of!(optics::tint);
    let Material::Bsdf(bsdf) = &Passed::scene().scene().materials[0].1 else {
        panic!("not a BSDF");
    };
    assert_eq!(bsdf.value.len(), 3);
}
