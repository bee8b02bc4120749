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
    // Neither in one column nor in one row.
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
