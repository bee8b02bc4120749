use super::*;
use crate::path_machines::Candidate;
use qrt_counting::random::Stream;

/// Runs a search among `ranks`, which count from the nearest. Returns the rank found, and the
/// queries.
fn find(rounds: &Rounds, ranks: &[usize], guess: Option<usize>, stream: Stream) -> (usize, u64) {
    let mut search = Search::new(stream);
    let distances: Vec<i64> = ranks.iter().map(|&rank| rank as i64).collect();
    let candidate = |place: usize| Candidate {
        distance: distances[place],
        primitive: place as u32,
    };
    if let Some(place) = guess {
        search.guess(true, candidate(place));
    }
    while !search.is_over() {
        let best = search.nearest();
        let mut marks = vec![false; rounds.states()];
        for (place, mark) in marks.iter_mut().enumerate().take(ranks.len()) {
            *mark = best.is_none_or(|best| candidate(place) < best);
        }
        search.run_rounds(rounds, &marks, &distances);
    }
    let found = search
        .nearest()
        .map_or(usize::MAX, |found| ranks[found.primitive as usize]);
    (found, search.queries())
}

/// `0..count`, shuffled.
fn shuffled(count: usize, dice: &mut Stream) -> Vec<usize> {
    let mut ranks: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        let other = (dice.uniform() * (last + 1) as f64) as usize;
        ranks.swap(last, other);
    }
    ranks
}

#[test]
fn a_rounds_success_is_the_mean_over_its_iterations() {
    for states in [2_usize, 8, 64, 1024] {
        for marked in (0..=states).step_by(states.div_ceil(37)) {
            for count in [1, 2, 5, 32] {
                let each = (0..count).map(|k| marked_probability(k, marked, states));
                let mean = each.sum::<f64>() / count as f64;
                let closed = success(count, marked, states);
                assert!(
                    (mean - closed).abs() < 1e-12,
                    "{states}, {marked}: {mean}, {closed}"
                );
            }
        }
    }
}

#[test]
fn there_are_as_many_rounds_as_the_failure_asks_for_and_no_more() {
    for (states, faces) in [(2, 1), (2, 2), (32, 17), (1024, 1024), (4096, 2500)] {
        for failure in [0.3, 1e-3, 1e-9] {
            let rounds = Rounds::new(states, faces, failure).unwrap();
            // The formula of the documentation, from its terms.
            let stated = |rounds: &Rounds| {
                let worst = (1..=faces).map(|marked| rounds.miss(marked));
                let later = (1..faces).map(|marked| rounds.miss(marked) / (marked + 1) as f64);
                worst.fold(0.0, f64::max) + later.sum::<f64>()
            };
            assert!((stated(&rounds) - rounds.failure()).abs() < 1e-12);
            assert!(rounds.failure() <= failure);
            let fewer = Rounds {
                counts: rounds.counts()[..rounds.counts().len() - 1].to_vec(),
                ..rounds.clone()
            };
            assert!(stated(&fewer) > failure, "{states}, {faces}, {failure}");
        }
    }
}

#[test]
fn no_probability_is_an_error() {
    for failure in [0.0, -0.1, 1.0, 2.0, 1e-16, f64::NAN, f64::INFINITY] {
        let error = Rounds::new(8, 5, failure).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("a search cannot fail with probability")
        );
    }
    assert!(Rounds::new(8, 5, LEAST_FAILURE).is_ok());
}

#[test]
fn a_search_misses_what_it_may_and_no_more_often() {
    const RUNS: u32 = 20_000;
    let mut dice = Stream::new(5, 0, 0, 0);
    let (states, faces, failure) = (64, 50, 0.1);
    let rounds = Rounds::new(states, faces, failure).unwrap();
    let missed = |guess: Option<usize>, dice: &mut Stream| {
        let runs = (0..RUNS).filter(|&run| {
            let ranks = shuffled(faces, dice);
            let guess = guess.map(|rank| ranks.iter().position(|&r| r == rank).unwrap());
            find(
                &rounds,
                &ranks,
                guess,
                Stream::of_path(6, 0, 0, 9, u64::from(run)),
            )
            .0 != 0
        });
        runs.count() as f64 / f64::from(RUNS)
    };
    let sigma = |p: f64| (p * (1.0 - p) / f64::from(RUNS)).sqrt();
    let random = missed(None, &mut dice);
    assert!(
        random <= rounds.failure() + 4.0 * sigma(failure),
        "{random}"
    );
    // The bound is not far above the measured probability.
    assert!(random > 0.2 * failure, "{random}");
    // From the second nearest face, one step is left.
    let second = missed(Some(1), &mut dice);
    let exact = rounds.miss(1);
    assert!(
        (second - exact).abs() < 4.0 * sigma(exact),
        "{second}, {exact}"
    );
    // A search that begins at the nearest face cannot miss it.
    assert_eq!(missed(Some(0), &mut dice), 0.0);
}

#[test]
fn queries_to_the_minimum_stay_below_the_published_bound() {
    // Durr & Hoyer: 22.5 sqrt(N) + 1.4 (log2 N)^2 queries suffice with probability 1/2.
    let mut dice = Stream::new(7, 0, 0, 0);
    for states in [16_usize, 128, 1024] {
        let rounds = Rounds::new(states, states, 0.5).unwrap();
        let runs = 400;
        let mut queries = 0;
        for run in 0..runs {
            let ranks = shuffled(states, &mut dice);
            queries += find(&rounds, &ranks, None, Stream::of_path(8, 0, 0, 9, run)).1;
        }
        let mean = queries as f64 / runs as f64;
        let log = (states as f64).log2();
        let bound = 22.5 * (states as f64).sqrt() + 1.4 * log * log;
        assert!(mean < bound, "{states}: {mean} of {bound}");
        assert!(
            mean < 0.5 * states as f64 || states < 1000,
            "{states}: {mean}"
        );
    }
}

#[test]
fn a_search_for_nothing_gives_up_after_the_queries_that_are_stated() {
    let rounds = Rounds::new(256, 200, 1e-3).unwrap();
    let runs = 4000;
    let mut sum = 0;
    for run in 0..runs {
        let mut search = Search::new(Stream::of_path(9, 0, 0, 9, run));
        search.run_rounds(&rounds, &[false; 256], &[0; 256]);
        assert!(search.is_over() && search.nearest().is_none());
        sum += search.queries();
    }
    let mean = sum as f64 / runs as f64;
    assert!(
        (mean / rounds.fruitless() - 1.0).abs() < 0.02,
        "{mean}, {}",
        rounds.fruitless()
    );
}
