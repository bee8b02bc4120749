//! FLIP: the difference between two pictures that a viewer sees when flipping between them.
//!
//! P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM
//! on Computer Graphics and Interactive Techniques 3(2), 2020; for radiance, P. Andersson et al.,
//! "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics Short Papers, 2021. The
//! constants are from these papers.

use super::{Image, SizesDiffer, same_size};
use std::f64::consts::PI;

/// Pixels per degree of visual angle, for a display that is 3,840 pixels and 0.7 m wide, seen from
/// a distance of 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * PI / 180.0;

/// The error of every pixel, from 0 (no difference) to 1 (the largest difference).
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorMap {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The errors row by row from the top, each row from the left.
    pub values: Vec<f64>,
}

impl ErrorMap {
    /// The mean over pixels, usually called "the FLIP" of two pictures.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    /// Converts the map to a picture, as linear RGB, in FLIP's usual colours: from black through
    /// purple to yellow (magma).
    pub fn picture(&self) -> Image {
        Image {
            width: self.width,
            height: self.height,
            pixels: self.values.iter().map(|&value| magma(value)).collect(),
            window: None,
        }
    }
}

/// FLIP of display pictures. Values are linear RGB from 0 to 1 and are clamped to that range.
///
/// # Errors
/// If the sizes differ.
pub fn flip_of_display(
    reference: &Image,
    test: &Image,
    pixels_per_degree: f64,
) -> Result<ErrorMap, SizesDiffer> {
    same_size(reference, test)?;
    Ok(of_display(reference, test, pixels_per_degree, |value| {
        value
    }))
}

/// FLIP of pictures of radiance: the largest error of each pixel over several evenly spaced
/// exposures. They range from the exposure that shows the reference's brightest pixel to the one
/// that shows its median pixel. Each exposure is shown through the ACES curve.
///
/// # Errors
/// If the sizes differ.
pub fn flip_of_radiance(
    reference: &Image,
    test: &Image,
    pixels_per_degree: f64,
) -> Result<ErrorMap, SizesDiffer> {
    same_size(reference, test)?;
    let exposures = exposures(reference);
    let mut greatest = vec![0.0f64; reference.pixels.len()];
    for exposure in exposures {
        let scale = libm::exp2(exposure);
        let map = of_display(reference, test, pixels_per_degree, |value| {
            aces(value * scale)
        });
        for (greatest, value) in greatest.iter_mut().zip(map.values) {
            *greatest = greatest.max(value);
        }
    }
    Ok(ErrorMap {
        width: reference.width,
        height: reference.height,
        values: greatest,
    })
}

/// Numerator and denominator, by falling powers, of the ACES tone curve.
const ACES: [[f64; 3]; 2] = [
    [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.0],
    [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14],
];
/// The curve's value for the brightest pixel that is shown well.
const SHOWN: f64 = 0.85;

fn aces(value: f64) -> f64 {
    let [over, under] = ACES.map(|[a, b, c]| (a * value + b) * value + c);
    (over / under).clamp(0.0, 1.0)
}

/// The exposures at which the pictures are compared, in stops.
fn exposures(reference: &Image) -> Vec<f64> {
    let luminance = |&[r, g, b]: &[f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let mut luminances: Vec<f64> = reference.pixels.iter().map(luminance).collect();
    luminances.sort_by(f64::total_cmp);
    let at = |place: usize| luminances.get(place).copied().unwrap_or(0.0);
    // For an even number of pixels, the authors' program takes the upper of the two middle ones.
    let median = at(luminances.len() / 2);
    let brightest = at(luminances.len().saturating_sub(1));
    // The curve has the value `SHOWN` at the roots of a quadratic; the greater root is the one
    // needed.
    let [a, b, c] = std::array::from_fn(|k| ACES[0][k] - SHOWN * ACES[1][k]);
    let root = libm::sqrt(b * b - 4.0 * a * c);
    let shown = ((-b - root) / (2.0 * a)).max((-b + root) / (2.0 * a));
    let least = f64::EPSILON;
    let first = libm::log2(shown / brightest.max(least));
    let last = libm::log2(shown / median.max(least));
    let steps = libm::ceil(last - first).max(1.0);
    let count = (steps as usize).max(2);
    let step = (last - first) / (count - 1) as f64;
    (0..count).map(|n| first + n as f64 * step).collect()
}

/// One value for every pixel.
type Plane = Vec<f64>;

fn of_display(
    reference: &Image,
    test: &Image,
    pixels_per_degree: f64,
    shown: impl Fn(f64) -> f64,
) -> ErrorMap {
    let [width, height] = [reference.width as usize, reference.height as usize];
    let seen = [reference, test].map(|image| {
        let mut planes: [Plane; 3] =
            std::array::from_fn(|_| Vec::with_capacity(image.pixels.len()));
        for pixel in &image.pixels {
            let opponent =
                opponent_of_xyz(xyz_of_rgb(pixel.map(|value| shown(value).clamp(0.0, 1.0))));
            for (plane, value) in planes.iter_mut().zip(opponent) {
                plane.push(value);
            }
        }
        Seen::new(&planes, [width, height], pixels_per_degree)
    });
    let [reference_seen, test_seen] = &seen;
    let values = (0..width * height).map(|place| {
        let colour = colour_error(reference_seen.lab[place], test_seen.lab[place]);
        let edge = (reference_seen.edges[place] - test_seen.edges[place]).abs();
        let point = (reference_seen.points[place] - test_seen.points[place]).abs();
        let feature = libm::sqrt(edge.max(point) / std::f64::consts::SQRT_2);
        libm::pow(colour, 1.0 - feature)
    });
    ErrorMap {
        width: reference.width,
        height: reference.height,
        values: values.collect(),
    }
}

/// A picture as the eye perceives it.
struct Seen {
    /// L*, a* and b* after the contrast filter for this distance; a* and b* weighted by L*, after
    /// Hunt.
    lab: Vec<[f64; 3]>,
    /// The strength of the edge at each pixel.
    edges: Plane,
    /// The strength of the point at each pixel.
    points: Plane,
}

/// The contrast sensitivity of lightness, red-green and blue-yellow: sums of `a sqrt(pi / b)
/// exp(-pi^2 x^2 / b)` over (a, b), x in degrees.
const SENSITIVITY: [&[[f64; 2]]; 3] = [
    &[[1.0, 0.0047]],
    &[[1.0, 0.0053]],
    &[[34.1, 0.04], [13.5, 0.025]],
];
/// The width of the edge that the eye notices best, in degrees.
const FEATURE: f64 = 0.082;

impl Seen {
    /// Filters `planes`, which hold Y, Cx and Cz.
    fn new(planes: &[Plane; 3], size: [usize; 2], pixels_per_degree: f64) -> Self {
        let widest = libm::sqrt(0.04 / (2.0 * PI * PI));
        let radius = libm::ceil(3.0 * widest * pixels_per_degree) as isize;
        let filtered: [Plane; 3] = std::array::from_fn(|plane| {
            let kernels = SENSITIVITY[plane].iter().map(|&[a, b]| {
                let weight = libm::sqrt(a * libm::sqrt(PI / b));
                kernel(radius, |x| {
                    let x = x / pixels_per_degree;
                    weight * libm::exp(-PI * PI * x * x / b)
                })
            });
            let kernels: Vec<Vec<f64>> = kernels.collect();
            // The sum of the weights over both directions.
            let total = kernels.iter().map(|kernel| {
                let sum: f64 = kernel.iter().sum();
                sum * sum
            });
            let total: f64 = total.sum();
            let mut sum = vec![0.0; planes[plane].len()];
            for kernel in &kernels {
                let part = separable(&planes[plane], size, kernel, kernel);
                for (sum, part) in sum.iter_mut().zip(part) {
                    *sum += part / total;
                }
            }
            sum
        });
        let lab = (0..filtered[0].len()).map(|place| {
            let opponent = std::array::from_fn(|plane| filtered[plane][place]);
            let rgb = rgb_of_xyz(xyz_of_opponent(opponent));
            hunt(lab_of_xyz(xyz_of_rgb(
                rgb.map(|value| value.clamp(0.0, 1.0)),
            )))
        });
        let lab = lab.collect();

        let deviation = 0.5 * FEATURE * pixels_per_degree;
        let radius = libm::ceil(3.0 * deviation) as isize;
        let gaussian = |x: f64| libm::exp(-x * x / (2.0 * deviation * deviation));
        let smooth = halves(kernel(radius, gaussian));
        let slope = halves(kernel(radius, |x| -x * gaussian(x)));
        let bend = halves(kernel(radius, |x| {
            (x * x / (deviation * deviation) - 1.0) * gaussian(x)
        }));
        let lightness: Plane = planes[0].iter().map(|y| (y + 16.0) / 116.0).collect();
        let length = |[across, down]: [&[f64]; 2]| -> Plane {
            let x = separable(&lightness, size, across, down);
            let y = separable(&lightness, size, down, across);
            x.iter().zip(y).map(|(x, y)| libm::hypot(*x, y)).collect()
        };
        Self {
            lab,
            edges: length([&slope, &smooth]),
            points: length([&bend, &smooth]),
        }
    }
}

fn kernel(radius: isize, value: impl Fn(f64) -> f64) -> Vec<f64> {
    (-radius..=radius).map(|x| value(x as f64)).collect()
}

/// Scales the positive weights of a kernel to a sum of 1, and the negative ones to a sum of -1.
fn halves(kernel: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| -> f64 {
        let part = kernel.iter().map(|weight| (sign * weight).max(0.0));
        part.sum()
    };
    let (up, down) = (sum(1.0), sum(-1.0));
    let scaled = kernel.into_iter().map(|weight| match weight {
        weight if weight > 0.0 => weight / up,
        weight if weight < 0.0 => weight / down,
        weight => weight,
    });
    scaled.collect()
}

/// Filters rows by `across` and columns by `down`. The border pixels are repeated beyond the
/// border.
fn separable(plane: &[f64], [width, height]: [usize; 2], across: &[f64], down: &[f64]) -> Plane {
    let at = |place: usize, tap: usize, radius: usize, length: usize| {
        (place + tap).saturating_sub(radius).min(length - 1)
    };
    let radius = across.len() / 2;
    let mut rows = Vec::with_capacity(plane.len());
    for row in plane.chunks_exact(width.max(1)) {
        rows.extend((0..width).map(|x| {
            let taps = across.iter().enumerate();
            taps.map(|(tap, weight)| weight * row[at(x, tap, radius, width)])
                .sum::<f64>()
        }));
    }
    let radius = down.len() / 2;
    let mut out = vec![0.0; plane.len()];
    for (y, out) in out.chunks_exact_mut(width.max(1)).enumerate() {
        for (tap, weight) in down.iter().enumerate() {
            let row = &rows[at(y, tap, radius, height) * width..][..width];
            for (sum, value) in out.iter_mut().zip(row) {
                *sum += weight * value;
            }
        }
    }
    out
}

/// The distance of two colours, from 0 to 1: HyAB to the power of 0.7. Errors up to 0.4 of the
/// largest one are mapped to the range from 0 to 0.95, larger errors to the rest.
fn colour_error(reference: [f64; 3], test: [f64; 3]) -> f64 {
    let corner = |rgb: [f64; 3]| hunt(lab_of_xyz(xyz_of_rgb(rgb)));
    let most = hyab(corner([0.0, 1.0, 0.0]), corner([0.0, 0.0, 1.0]));
    let (most, bend, share) = (libm::pow(most, 0.7), 0.4, 0.95);
    let error = libm::pow(hyab(reference, test), 0.7);
    if error < bend * most {
        error * share / (bend * most)
    } else {
        share + (error - bend * most) / (most - bend * most) * (1.0 - share)
    }
}

fn hyab([l, a, b]: [f64; 3], [m, c, d]: [f64; 3]) -> f64 {
    (l - m).abs() + libm::hypot(a - c, b - d)
}

fn hunt([l, a, b]: [f64; 3]) -> [f64; 3] {
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// Converts linear sRGB to X, Y, Z as fractions of those of white.
fn xyz_of_rgb(rgb: [f64; 3]) -> [f64; 3] {
    let xyz = times(&XYZ_OF_RGB, rgb);
    std::array::from_fn(|k| xyz[k] / WHITE[k])
}

fn rgb_of_xyz(fractions: [f64; 3]) -> [f64; 3] {
    times(
        &RGB_OF_XYZ,
        std::array::from_fn(|k| fractions[k] * WHITE[k]),
    )
}

fn times(matrix: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

/// Linear sRGB to X, Y, Z, from the primaries and the white of sRGB.
const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [
        10_135_552.0 / 24_577_794.0,
        8_788_810.0 / 24_577_794.0,
        4_435_075.0 / 24_577_794.0,
    ],
    [
        2_613_072.0 / 12_288_897.0,
        8_788_810.0 / 12_288_897.0,
        887_015.0 / 12_288_897.0,
    ],
    [
        1_425_312.0 / 73_733_382.0,
        8_788_810.0 / 73_733_382.0,
        70_074_185.0 / 73_733_382.0,
    ],
];
/// The inverse of [`XYZ_OF_RGB`].
const RGB_OF_XYZ: [[f64; 3]; 3] = inverse(XYZ_OF_RGB);
/// X, Y and Z of white.
const WHITE: [f64; 3] = [
    XYZ_OF_RGB[0][0] + XYZ_OF_RGB[0][1] + XYZ_OF_RGB[0][2],
    XYZ_OF_RGB[1][0] + XYZ_OF_RGB[1][1] + XYZ_OF_RGB[1][2],
    XYZ_OF_RGB[2][0] + XYZ_OF_RGB[2][1] + XYZ_OF_RGB[2][2],
];

const fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut cofactors = [[0.0; 3]; 3];
    let mut row = 0;
    while row < 3 {
        let mut column = 0;
        while column < 3 {
            let (a, b) = ((row + 1) % 3, (row + 2) % 3);
            let (c, d) = ((column + 1) % 3, (column + 2) % 3);
            cofactors[column][row] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
            column += 1;
        }
        row += 1;
    }
    let determinant =
        m[0][0] * cofactors[0][0] + m[0][1] * cofactors[1][0] + m[0][2] * cofactors[2][0];
    let mut row = 0;
    while row < 3 {
        let mut column = 0;
        while column < 3 {
            cofactors[row][column] /= determinant;
            column += 1;
        }
        row += 1;
    }
    cofactors
}

/// Y, Cx and Cz: lightness, red-green and yellow-blue, linear in X, Y and Z.
fn opponent_of_xyz([x, y, z]: [f64; 3]) -> [f64; 3] {
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn xyz_of_opponent([lightness, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (lightness + 16.0) / 116.0;
    [y + cx / 500.0, y, y - cz / 200.0]
}

fn lab_of_xyz(xyz: [f64; 3]) -> [f64; 3] {
    let knee = 6.0 / 29.0;
    let [x, y, z] = xyz.map(|value: f64| {
        if value > knee * knee * knee {
            libm::cbrt(value)
        } else {
            value / (3.0 * knee * knee) + 4.0 / 29.0
        }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The colour map magma of N. J. Smith and S. van der Walt, as a polynomial of degree 6 by M. Zucker
/// (both in the public domain), in linear RGB.
fn magma(value: f64) -> [f64; 3] {
    /// Coefficients of red, green and blue, by falling powers.
    const POWERS: [[f64; 3]; 7] = [
        [
            18.655_705_065_918_83,
            -11.489_773_519_977_11,
            -5.601_961_508_734_096,
        ],
        [
            -50.768_525_364_735_88,
            29.046_582_821_272_91,
            4.234_152_993_845_98,
        ],
        [
            52.176_139_812_340_68,
            -27.943_606_071_683_51,
            12.944_169_442_383_94,
        ],
        [
            -27.668_733_085_768_66,
            14.264_730_780_965_33,
            -13.649_213_188_139_22,
        ],
        [
            8.353_717_279_216_625,
            -3.577_719_514_958_484,
            0.314_467_903_013_257_3,
        ],
        [
            0.251_660_540_737_164_2,
            0.677_523_243_683_766_8,
            2.494_026_599_312_351,
        ],
        [
            -0.002_136_485_053_939_582,
            -0.000_749_655_052_795_221,
            -0.005_386_127_855_323_933,
        ],
    ];
    let value = value.clamp(0.0, 1.0);
    let sum = |channel: usize| {
        let powers = POWERS.iter().map(|power| power[channel]);
        powers.fold(0.0, |sum, power| sum * value + power)
    };
    std::array::from_fn(|channel| qrt_runtime::image::linear_of_srgb(sum(channel).clamp(0.0, 1.0)))
}
