//! Tests of the bytes of a picture's properties.

use super::*;
use crate::plan::ErrorParts;
use crate::render::{Searched, Visibility};
use crate::search::Guess;
use proptest::prelude::*;
use qrt_core::oracle::CallCost;
use qrt_scene::{Accuracy, Sequence};
use qrt_tracer::{ByClass, PixelClass};

fn scales(bounds: Vec<(PixelClass, [f64; 3])>) -> Scales {
    let outlines = Some(vec![vec![[1.0, 2.0], [3.0, -0.0]], vec![]]);
    Scales(ByClass::of_parts(outlines, bounds).unwrap())
}

/// Returns properties in which every field has a value of its own.
fn full() -> Properties {
    Properties {
        scene_hash: "9f86d081".into(),
        scene: "name: none\n".into(),
        model: Model::Gates,
        colour: Colour::OneRun,
        estimator: Estimator::Chebyshev,
        noise: Noise {
            depolarising: 0.125,
            readout: 0.25,
        },
        primary_hits: PrimaryHitsFound {
            method: Visibility::Grover {
                failure: 1e-3,
                guess: Guess::Random,
            },
            searched: Some(Searched {
                faces: 5,
                states: 8,
                failure: 1e-3,
                qubits: 300,
                toffoli: 7_000,
            }),
        },
        plan: Some(PlanFigures {
            accuracy: Accuracy {
                error: 0.01,
                confidence: 0.95,
            },
            mean: 0.5,
            pixels: [64, 4096],
            sequence: Sequence::ProductLattice,
            path_bits: 14,
            extrapolated: true,
            fraction: Some(16),
            comparator_bits: 12,
            estimator: Estimator::Sine,
            phase_bits: 9,
            repetitions: 3,
            error: None,
            within: 0.96,
            parts: ErrorParts {
                paths: 0.1,
                comparators: 0.2,
                width: 0.3,
                counting: 0.4,
                total: 0.6,
            },
            queries: 1.5,
            channel_queries: [0.25, 0.5, 0.75],
            cost: Some(CallCost {
                qubits: 39_010,
                toffoli: 69_124,
            }),
        }),
        scales: scales(vec![
            (PixelClass::MayMeetLamp, [17.0, 12.0, f64::MIN_POSITIVE]),
            (PixelClass::MeetsNoLamp, [1.0; 3]),
        ]),
        ids: u64::MAX,
        paths: 1 << 40,
        resumed_paths: 7,
        seconds: 0.1,
        threads: 64,
    }
}

#[test]
fn all_fields_come_back() {
    assert_eq!(Properties::decode(&full().encode()), Some(full()));
    for name in Estimator::ALL {
        let estimator = *name;
        let properties = Properties {
            estimator,
            ..full()
        };
        assert_eq!(Properties::decode(&properties.encode()), Some(properties));
    }
}

#[test]
fn a_part_or_a_continuation_of_the_bytes_is_refused() {
    let bytes = full().encode();
    for length in 0..bytes.len() {
        assert_eq!(Properties::decode(&bytes[..length]), None, "{length}");
    }
    assert_eq!(Properties::decode(&[&bytes[..], &[0]].concat()), None);
}

#[test]
fn an_unknown_estimator_is_refused() {
    let mut bytes = full().encode();
    let name = Estimator::Chebyshev.name().as_bytes();
    let place = bytes.windows(name.len()).position(|found| found == name);
    bytes[place.unwrap()] = b'C';
    assert_eq!(Properties::decode(&bytes), None);
}

#[test]
fn a_length_beyond_the_end_is_refused() {
    let one = Properties {
        scales: scales(vec![(
            PixelClass::MayMeetLamp,
            [17.0, 12.0, f64::MIN_POSITIVE],
        )]),
        ..full()
    };
    let (one, with) = (one.encode(), full().encode());
    let place = (0..one.len()).find(|&place| one[place] != with[place]);
    let place = place.unwrap();
    assert_eq!([one[place], with[place]], [1, 2]);
    // A bound has 25 bytes: these are terabytes of them.
    let length = [0xff, 0xff, 0xff, 0xff, 0xff, 0x0f];
    let bytes = [&with[..place], &length, &with[place + 1..]].concat();
    assert_eq!(Properties::decode(&bytes), None);
}

proptest! {
    #[test]
    fn any_changed_bytes_are_read_or_refused(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = full().encode();
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if let Some(properties) = Properties::decode(&bytes) {
            // Compared as text, for a changed float may be NaN.
            let again = Properties::decode(&properties.encode());
            prop_assert_eq!(format!("{again:?}"), format!("{:?}", Some(properties)));
        }
    }
}
