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
            let part = area as f64 / count as f64;
            for (k, place) in places.enumerate() {
                assert!((place as f64 - (k as f64 + 0.5) * part).abs() <= 1.0);
            }
        }
    }
    assert_eq!(
        spread([2, 2], 4),
        [[0, 0], [1, 0], [0, 1], [1, 1]],
        "a film that is asked for whole is taken whole"
    );
}
