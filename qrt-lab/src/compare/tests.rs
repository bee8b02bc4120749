use super::*;
use qrt_runtime::image::linear_of_srgb;

const SIZE: [usize; 2] = [48, 32];

/// Discs on a gradient, from 0 to 1. The test picture is shifted right by one column, and one of
/// its corners is noisy.
fn shown() -> [Vec<[f64; 3]>; 2] {
    let picture = |x: i64, y: i64| {
        let disc = (x - 20).pow(2) + (y - 15).pow(2) < 81;
        let of = |inside, outside: i64| {
            if disc {
                inside
            } else {
                outside.rem_euclid(256)
            }
        };
        let even = (x.div_euclid(6) + y.div_euclid(6)) % 2 == 0;
        [of(220, 4 * x), of(40, 6 * y), if even { 200 } else { 30 }]
    };
    let all = || (0..SIZE[1] as i64).flat_map(|y| (0..SIZE[0] as i64).map(move |x| (x, y)));
    let unit = |levels: [i64; 3]| levels.map(|level| level as f64 / 255.0);
    let test = |(x, y): (i64, i64)| {
        let noise = (x * 7919 + y * 104_729) % 97;
        let levels = picture(x - 1, y);
        if x > 36 && y > 22 {
            levels.map(|level| (level + noise) % 256)
        } else {
            levels
        }
    };
    [
        all().map(|(x, y)| unit(picture(x, y))).collect(),
        all().map(|at| unit(test(at))).collect(),
    ]
}

fn image(pixels: Vec<[f64; 3]>) -> Image {
    Image {
        width: SIZE[0] as u32,
        height: SIZE[1] as u32,
        pixels,
        window: None,
    }
}

/// Checks the mean and the pixels (0, 0), (11, 15), (30, 8) and (40, 27) against the program of
/// FLIP's authors: benches/peers/flip.py.
fn check(map: &ErrorMap, mean: f64, pixels: [f64; 4]) {
    let close = |found: f64, asked: f64, what: &str| {
        assert!((found - asked).abs() < 2e-5, "{what}: {found} for {asked}");
    };
    for ([x, y], asked) in [[0, 0], [11, 15], [30, 8], [40, 27]]
        .into_iter()
        .zip(pixels)
    {
        close(map.values[y * SIZE[0] + x], asked, &format!("({x}, {y})"));
    }
    close(map.mean(), mean, "mean");
}

#[test]
fn flip_of_display_is_that_of_its_authors() {
    let [reference, test] =
        shown().map(|all| image(all.into_iter().map(|rgb| rgb.map(linear_of_srgb)).collect()));
    let map = flip_of_display(&reference, &test, PIXELS_PER_DEGREE).unwrap();
    check(
        &map,
        0.235_807_9,
        [0.880_941_4, 0.534_015_8, 0.304_049_1, 0.840_135_1],
    );
    let map = flip_of_display(&reference, &test, 20.0).unwrap();
    check(
        &map,
        0.293_402_7,
        [0.968_976_5, 0.445_338_9, 0.604_240_8, 0.973_701_8],
    );
}

#[test]
fn flip_of_radiance_is_that_of_its_authors() {
    let [reference, test] = shown().map(|all| {
        let pixels = all.into_iter().enumerate().map(|(place, rgb)| {
            let lamp = place % SIZE[0] < 8 && place / SIZE[0] < 5;
            rgb.map(|value| value * value * if lamp { 1000.0 } else { 0.5 })
        });
        image(pixels.collect())
    });
    let map = flip_of_radiance(&reference, &test, PIXELS_PER_DEGREE).unwrap();
    check(
        &map,
        0.265_811_3,
        [0.795_904_6, 0.623_448_4, 0.322_858_1, 0.687_723_0],
    );
    let map = flip_of_radiance(&reference, &test, 20.0).unwrap();
    check(
        &map,
        0.368_179_0,
        [0.966_781_5, 0.637_052_0, 0.701_274_2, 0.951_864_8],
    );
}

#[test]
fn a_picture_is_no_different_from_itself_and_black_from_white_is() {
    let [reference, _] = shown();
    let reference = image(reference);
    let same = flip_of_display(&reference, &reference, PIXELS_PER_DEGREE).unwrap();
    assert!(same.values.iter().all(|&value| value == 0.0));
    let same = flip_of_radiance(&reference, &reference, PIXELS_PER_DEGREE).unwrap();
    assert!(same.values.iter().all(|&value| value == 0.0));
    // For an all-black reference, no exposure shows anything; the result must still be a number.
    let [black, white] = [0.0, 1.0].map(|value| image(vec![[value; 3]; SIZE[0] * SIZE[1]]));
    let flip = flip_of_display(&black, &white, PIXELS_PER_DEGREE)
        .unwrap()
        .mean();
    assert!((0.9..1.0).contains(&flip), "{flip}");
    for [a, b] in [[&black, &white], [&white, &black], [&black, &black]] {
        let flip = flip_of_radiance(a, b, PIXELS_PER_DEGREE).unwrap().mean();
        assert!((0.0..=1.0).contains(&flip), "{flip}");
    }
}

#[test]
fn the_colours_of_errors_go_from_black_to_yellow() {
    let map = ErrorMap {
        width: 3,
        height: 1,
        values: vec![0.0, 0.5, 1.0],
    };
    let pixels = map.picture().pixels;
    // The map's own table has 0 0 4, 183 55 121, 252 253 191.
    let table = [[0, 0, 4], [183, 55, 121], [252, 253, 191]];
    for (found, asked) in pixels.iter().flatten().zip(table.as_flattened()) {
        let linear = |level: f64| linear_of_srgb(level / 255.0);
        let levels = f64::from(*asked) - 8.5..f64::from(*asked) + 8.5;
        assert!(
            (linear(levels.start)..linear(levels.end)).contains(found),
            "{pixels:?}"
        );
    }
}

#[test]
fn errors_are_those_of_closed_forms_and_sizes_must_agree() {
    let reference = image(vec![[0.2, 0.4, 2.0]; SIZE[0] * SIZE[1]]);
    let mut test = reference.clone();
    for (place, pixel) in test.pixels.iter_mut().enumerate() {
        pixel[0] += if place % 2 == 0 { 0.1 } else { -0.1 };
        pixel[2] += 0.3;
    }
    let found = difference(&reference, &test).unwrap();
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    assert!(
        near(found.rmse_rgb[0], 0.1) && found.rmse_rgb[1] == 0.0 && near(found.rmse_rgb[2], 0.3)
    );
    assert!(near(found.rmse, (0.1f64 / 3.0).sqrt()));
    assert!(near(found.bias_rgb[0], 0.0) && near(found.bias_rgb[2], 0.3));
    assert!(near(found.relative_mse, (0.01 / 0.05 + 0.09 / 4.01) / 3.0));
    assert!(near(found.greatest, 0.3) && near(found.reference_mean[2], 2.0));
    let mut narrow = image(Vec::new());
    narrow.width = 0;
    assert_eq!(
        difference(&reference, &narrow).unwrap_err().sizes,
        [[48, 32], [0, 32]]
    );
}
