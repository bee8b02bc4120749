use super::net::split_mix;
use super::*;
use crate::scene::{DepthSampling, Lights};
use proptest::prelude::*;

fn sampling(sequence: Sequence, path_bits: u32, bits: &[[u32; 2]]) -> Sampling {
    Sampling {
        sequence,
        path_bits,
        depths: bits
            .iter()
            .map(|&bits| DepthSampling::of_bits(bits))
            .collect(),
        ..Sampling::default()
    }
}

/// SciPy 1.17.1, `qmc.Sobol(128, scramble=False, bits=32)`, another implementation of the same
/// direction numbers: `n`, then `2^32 x` of point `n` in its first 0, 1, 2, 5, 17, 40, 63 and 127th
/// dimensions, then the sum over all dimensions `d` of `(d + 1) 2^32 x_d`. SciPy enumerates in Gray
/// code.
#[rustfmt::skip]
const SCIPY: [(u64, [u64; 8], u64); 11] = [
    (1, [2147483648, 2147483648, 2147483648, 2147483648, 2147483648, 2147483648, 2147483648, 2147483648], 17729624997888),
    (2, [3221225472, 1073741824, 1073741824, 3221225472, 1073741824, 1073741824, 3221225472, 1073741824], 17285095882752),
    (3, [1073741824, 3221225472, 3221225472, 1073741824, 3221225472, 3221225472, 1073741824, 3221225472], 18174154113024),
    (5, [3758096384, 3758096384, 536870912, 2684354560, 1610612736, 1610612736, 2684354560, 536870912], 16971563270144),
    (8, [805306368, 1342177280, 4026531840, 1342177280, 3489660928, 2415919104, 2952790016, 268435456], 17509507923968),
    (13, [3489660928, 2952790016, 3489660928, 4026531840, 2952790016, 4026531840, 268435456, 805306368], 16964047077376),
    (100, [1778384896, 1107296256, 3321888768, 3187671040, 3187671040, 3053453312, 2785017856, 1979711488], 17262480195584),
    (1000, [943718400, 415236096, 2227175424, 3896508416, 1480589312, 3921674240, 1916796928, 2336227328], 18626098757632),
    (65537, [2147581952, 4294934528, 4174741504, 1136361472, 264208384, 2840428544, 3205005312, 55869440], 16411636531200),
    (1048575, [4096, 4026593280, 3314585600, 3405787136, 2484047872, 1928704000, 2322862080, 587075584], 15169001824256),
    (123456789, [4191448864, 3403469216, 27513184, 3656567136, 4127893280, 218441632, 1087637792, 2879378656], 16073225796224),
];

fn of_ray(depth: usize, axis: usize) -> Coordinate {
    [Coordinate::u(depth), Coordinate::v(depth)][axis]
}

/// Checks the order film, ray, ray, lamp, lamp: rays have the same dimensions with and without
/// lamps.
#[test]
fn points_on_lamps_have_the_dimensions_after_all_rays() {
    let mut written = sampling(Sequence::DigitalNet, 8, &[[8, 8]; 3]);
    let order = |sampling: &Sampling| {
        let points = PathPoints::new(sampling).unwrap();
        let coordinates = points.coordinates();
        let mut all: Vec<_> = coordinates.map(|c| (points.dimension(c), c)).collect();
        all.sort_by_key(|(dimension, _)| *dimension);
        let numbers: Vec<usize> = all.iter().map(|(dimension, _)| *dimension).collect();
        assert_eq!(numbers, (0..all.len()).collect::<Vec<_>>());
        all.into_iter().map(|(_, c)| c).collect::<Vec<_>>()
    };
    let rays = [0, 1, 2].map(|k| [Coordinate::u(k), Coordinate::v(k)]);
    assert_eq!(order(&written), rays.concat());
    for depth in &mut written.depths[1..] {
        depth.light = [5, 6].into();
    }
    let lamps = [1, 2].map(|k| [Coordinate::light_u(k), Coordinate::light_v(k)]);
    assert_eq!(order(&written), [rays.concat(), lamps.concat()].concat());
    let points = PathPoints::new(&written).unwrap();
    assert_eq!(points.bits(Coordinate::light_v(2)), 6);
    written.lights = Lights::None;
    assert_eq!(order(&written), rays.concat());
}

#[test]
fn the_net_is_scipys_in_every_dimension() {
    let net = DigitalNet::new(MAX_DIMENSIONS, 32).unwrap();
    for (n, points, sum) in SCIPY {
        let id = n ^ (n >> 1);
        let point = |d| net.index(d, id, 0, 32);
        assert_eq!([0, 1, 2, 5, 17, 40, 63, 127].map(point), points, "n = {n}");
        let ours: u64 = (0..MAX_DIMENSIONS).map(|d| (d as u64 + 1) * point(d)).sum();
        assert_eq!(ours, sum, "n = {n}, all dimensions");
    }
}

#[test]
fn direction_numbers_make_unit_triangular_matrices() {
    // Column b starts at bit 63 - b: every projection of the first 2^m points is a permutation.
    let net = DigitalNet::new(MAX_DIMENSIONS, MAX_PATH_BITS).unwrap();
    for d in 0..MAX_DIMENSIONS {
        for b in 0..MAX_PATH_BITS {
            assert_eq!(
                net.column(d, b).trailing_zeros(),
                63 - b,
                "dimension {d}, id bit {b}"
            );
        }
        assert_eq!(net.column(d, MAX_PATH_BITS), 0);
    }
}

#[test]
fn every_projection_is_a_permutation_whatever_the_shift() {
    for (m, shift) in [(1, 0), (7, 0), (7, !0), (10, 0x0123_4567_89ab_cdef)] {
        let net = DigitalNet::new(MAX_DIMENSIONS, m).unwrap();
        for d in 0..MAX_DIMENSIONS {
            let mut seen: Vec<u64> = (0..1 << m).map(|id| net.index(d, id, shift, m)).collect();
            seen.sort_unstable();
            assert!(seen.iter().copied().eq(0..1 << m), "dimension {d}, m = {m}");
        }
    }
}

#[test]
fn the_first_two_dimensions_hit_every_elementary_interval_once() {
    for m in 0..=12 {
        for shift in [[0, 0], [pixel_shift(7, 3, 4, 0), pixel_shift(7, 3, 4, 1)]] {
            let net = DigitalNet::new(2, m).unwrap();
            for columns in 0..=m {
                let mut hits = vec![0; 1 << m];
                for id in 0..1 << m {
                    let column = net.index(0, id, shift[0], columns);
                    let row = net.index(1, id, shift[1], m - columns);
                    hits[(row << columns | column) as usize] += 1;
                }
                assert!(
                    hits.iter().all(|&h| h == 1),
                    "2^{columns} by 2^{} boxes",
                    m - columns
                );
            }
        }
    }
}

#[test]
fn columns_say_what_each_id_bit_flips() {
    let net = sampling(Sequence::DigitalNet, 20, &[[8, 24], [0, 32], [5, 1]]);
    let lattice = sampling(Sequence::ProductLattice, 20, &[[3, 7], [0, 4], [5, 1]]);
    for points in [net, lattice].map(|s| PathPoints::new(&s).unwrap()) {
        for c in points.coordinates() {
            let shift = points.shift(5, 6, 7, c);
            let zero = points.index(c, 0, shift);
            for b in 0..20 {
                let flipped = zero ^ points.index(c, 1 << b, shift);
                assert_eq!(points.column(c, b), flipped);
            }
            let bits = points.bits(c);
            assert_eq!(u64::from(zero), shift.checked_shr(64 - bits).unwrap_or(0));
        }
    }
}

#[test]
fn the_lattice_visits_every_cell_once_and_depth_0_u_is_lowest() {
    let bits = [[2, 3], [1, 0], [4, 2]];
    let points = PathPoints::new(&sampling(Sequence::ProductLattice, 12, &bits)).unwrap();
    for id in 0..1u64 << 12 {
        // Mixed-radix digits, lowest first: u_0, v_0, u_1, v_1, ...
        let mut rest = id;
        for (depth, bits) in bits.iter().enumerate() {
            for (axis, &bits) in bits.iter().enumerate() {
                let digit = rest % (1 << bits);
                rest /= 1 << bits;
                assert_eq!(
                    u64::from(points.index(of_ray(depth, axis), id, 0)),
                    digit,
                    "id {id}"
                );
            }
        }
        assert_eq!(rest, 0);
    }
    assert_eq!(points.shift(1, 2, 3, Coordinate::u(2)), 0);
}

#[test]
fn cells_stand_at_their_centres() {
    assert_eq!(cell_centre(0, 0), 0.5);
    assert_eq!(
        [0, 1, 2, 3].map(|k| cell_centre(k, 2)),
        [0.125, 0.375, 0.625, 0.875]
    );
    assert_eq!(cell_centre(u32::MAX, 32), 1.0 - 0.5f64.powi(33));
}

#[test]
fn shifts_are_split_mix_64() {
    // The published outputs of the reference implementation for seed 1234567.
    let reference = [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ];
    assert_eq!([0, 1, 2, 3, 4].map(|n| split_mix(1234567, n)), reference);
    let state = split_mix(split_mix(9, 0) ^ (5 << 32 | 4), 0);
    assert_eq!(pixel_shift(9, 4, 5, 3), split_mix(state, 3));
}

#[test]
fn shifts_of_neighbours_are_unrelated() {
    // Differing bits of 64, over neighbouring seeds, pixels and dimensions: binomial, mean 32,
    // standard deviation 4. The mean of 4 * 16,384 lies within 5 standard errors, 5 * 4 / 256.
    let mut differing = 0;
    for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
        for d in 0..4 {
            let shift = pixel_shift(1, x, y, d);
            for other in [
                pixel_shift(2, x, y, d),
                pixel_shift(1, x + 1, y, d),
                pixel_shift(1, x, y + 1, d),
                pixel_shift(1, x, y, d + 1),
            ] {
                differing += (shift ^ other).count_ones();
            }
        }
    }
    let mean = f64::from(differing) / f64::from(64 * 64 * 4 * 4);
    assert!((mean - 32.0).abs() < 5.0 * 4.0 / 256.0, "{mean}");
}

#[test]
fn a_product_is_integrated_within_the_koksma_hlawka_bound() {
    // A (0, m, 2)-net in base 2 has N D* <= m/2 + 3/2 (Niederreiter 1992, theorem 4.6 and after);
    // x y has variation 3 in the sense of Hardy and Krause; rounding to centres of 2^-32 adds 2^-32.
    for m in 0..=20 {
        let points = PathPoints::new(&sampling(Sequence::DigitalNet, m, &[[32, 32]])).unwrap();
        let n = 1usize << m;
        for x in 0..4 {
            let mut xy = [vec![0; n], vec![0; n]];
            for (axis, out) in xy.iter_mut().enumerate() {
                let c = of_ray(0, axis);
                points.indices(c, 0, points.shift(1, x, 0, c), out);
            }
            let product = |(&u, &v)| cell_centre(u, 32) * cell_centre(v, 32);
            let mean = xy[0].iter().zip(&xy[1]).map(product).sum::<f64>() / n as f64;
            let bound = 3.0 * f64::from(m + 3) / 2.0 / n as f64 + 0.5f64.powi(32);
            assert!((mean - 0.25).abs() <= bound, "m = {m}: {mean}");
        }
    }
}

#[test]
fn six_dimensions_beat_monte_carlo_and_the_lattice() {
    // prod_d pi/2 sin(pi x_d) has integral 1 and variance (pi^2/8)^6 - 1. RMSE over pixels.
    let f = |x: f64| std::f64::consts::FRAC_PI_2 * (std::f64::consts::PI * x).sin();
    let monte_carlo = |m: u32| {
        let variance = (std::f64::consts::PI.powi(2) / 8.0).powi(6) - 1.0;
        (variance / f64::from(1 << m)).sqrt()
    };
    let rmse = |sequence, m: u32, bits| {
        let points = PathPoints::new(&sampling(sequence, m, &[[bits; 2]; 3])).unwrap();
        let mut squares = 0.0;
        for x in 0..16 {
            let mut product = vec![1.0; 1 << m];
            for c in points.coordinates() {
                let mut index = vec![0; 1 << m];
                let shift = points.shift(11, x, 0, c);
                points.indices(c, 0, shift, &mut index);
                for (p, k) in product.iter_mut().zip(index) {
                    *p *= f(cell_centre(k, bits));
                }
            }
            squares += (product.iter().sum::<f64>() / product.len() as f64 - 1.0).powi(2);
        }
        (squares / 16.0).sqrt()
    };
    for m in [8, 12, 16] {
        let net = rmse(Sequence::DigitalNet, m, 24);
        assert!(
            net < monte_carlo(m) / 2.0,
            "m = {m}: {net} against {}",
            monte_carlo(m)
        );
    }
    // 2^12 paths give the lattice 2 bits a coordinate: the midpoint rule's error is exactly this.
    let midpoint = (0..4).map(|k| f(cell_centre(k, 2))).sum::<f64>() / 4.0;
    let lattice = rmse(Sequence::ProductLattice, 12, 2);
    assert!((lattice - (midpoint.powi(6) - 1.0)).abs() < 1e-12);
    assert!(lattice > 5.0 * rmse(Sequence::DigitalNet, 12, 24));
}

proptest! {
    #[test]
    fn a_run_of_indices_is_each_index(
        lattice: bool,
        path_bits in 0u32..=52,
        bits in 0u32..=32,
        first: u64,
        shift: u64,
        len in 0usize..700,
    ) {
        let points = if lattice {
            let bits = [[path_bits / 2, 0], [path_bits / 4, path_bits / 4]];
            let sum = bits.iter().flatten().sum();
            PathPoints::new(&sampling(Sequence::ProductLattice, sum, &bits)).unwrap()
        } else {
            let bits = [[bits, 32 - bits], [7, bits]];
            PathPoints::new(&sampling(Sequence::DigitalNet, path_bits, &bits)).unwrap()
        };
        for c in points.coordinates() {
            let mut run = vec![0; len];
            points.indices(c, first, shift, &mut run);
            for (i, index) in run.into_iter().enumerate() {
                let id = first.wrapping_add(i as u64);
                prop_assert_eq!(index, points.index(c, id, shift));
                prop_assert!(u64::from(index) < 1 << points.bits(c));
            }
        }
    }

    #[test]
    fn the_net_of_a_path_is_the_net(id: u64, shift: u64, bits in 0u32..=32, m in 0u32..=52) {
        let points = PathPoints::new(&sampling(Sequence::DigitalNet, m, &[[bits; 2]; 5])).unwrap();
        let net = DigitalNet::new(10, m).unwrap();
        for d in 0..10 {
            let index = u64::from(points.index(of_ray(d / 2, d % 2), id, shift));
            prop_assert_eq!(index, net.index(d, id, shift, bits));
        }
    }
}

#[test]
fn sizes_beyond_the_limits_are_refused() {
    let error = |sequence, path_bits, bits: &[[u32; 2]]| {
        PathPoints::new(&sampling(sequence, path_bits, bits)).unwrap_err()
    };
    let net = Sequence::DigitalNet;
    let lattice = Sequence::ProductLattice;
    assert_eq!(
        error(net, 12, &[[8; 2]; 65]),
        SamplingError::Dimensions { dimensions: 130 }
    );
    assert_eq!(
        error(net, 53, &[[8; 2]]),
        SamplingError::PathBits { path_bits: 53 }
    );
    assert_eq!(
        error(net, 12, &[[8, 8], [8, 33]]),
        SamplingError::CoordinateBits {
            coordinate: Coordinate::v(1),
            bits: 33
        }
    );
    assert_eq!(
        error(lattice, 64, &[[32; 2]]),
        SamplingError::PathBits { path_bits: 64 }
    );
    assert_eq!(
        error(lattice, 12, &[[8; 2]]).to_string(),
        "12 path bits, but the product lattice's coordinates have 16 in all"
    );
    assert!(ProductLattice::new(&[[u32::MAX; 2]; 2]).is_err());
    assert!(PathPoints::new(&sampling(net, 52, &[[8; 2]; 64])).is_ok());
}
