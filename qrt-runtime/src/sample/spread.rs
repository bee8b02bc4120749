//! Chooses pixels that represent a film.

/// Returns `count` different pixels of a film, in its row-by-row order; all of them if it has no
/// more. They are multiples of a step that is about the golden section of the film, so that they
/// cover rows and columns evenly for any `count`.
pub fn spread(film: [u32; 2], count: u64) -> Vec<[u32; 2]> {
    let width = u64::from(film[0]);
    let area = width * u64::from(film[1]);
    // A step without a common divisor visits every place once before any place comes again.
    let mut step = ((area as f64 * 0.618_033_988_75) as u64).max(1);
    while common_divisor(step, area) > 1 {
        step += 1;
    }
    let place = |k: u64| ((u128::from(k) * u128::from(step)) % u128::from(area)) as u64;
    let first = area / 3;
    let count = count.min(area);
    let mut places: Vec<u64> = (0..count).map(|k| (first + place(k)) % area).collect();
    places.sort_unstable();
    let pixels = places.into_iter();
    pixels
        .map(|place| [(place % width) as u32, (place / width) as u32])
        .collect()
}

fn common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn pixels_are_spread_over_the_film_and_differ() {
        for film in [[1, 1], [7, 5], [64, 64], [1, 1000], [65_535, 65_535]] {
            let area = u64::from(film[0]) * u64::from(film[1]);
            for count in [1, 2, 3, 16, 35].map(|n: u64| n.min(area)) {
                let pixels = spread(film, count);
                assert_eq!(pixels.len() as u64, count);
                let places = pixels.iter().map(|[x, y]| {
                    assert!(*x < film[0] && *y < film[1]);
                    u64::from(*y) * u64::from(film[0]) + u64::from(*x)
                });
                let places: Vec<u64> = places.collect();
                assert!(places.windows(2).all(|pair| pair[0] < pair[1]));
            }
        }
        // The pixels are in several rows and several columns.
        let pixels = spread([64, 64], 16);
        for axis in [0, 1] {
            let mut met: Vec<u32> = pixels.iter().map(|pixel| pixel[axis] / 8).collect();
            met.sort_unstable();
            met.dedup();
            assert!(met.len() >= 6, "{pixels:?}");
        }
        assert_eq!(
            spread([2, 2], 4),
            [[0, 0], [1, 0], [0, 1], [1, 1]],
            "a film that is asked for whole is taken whole"
        );
    }
}
