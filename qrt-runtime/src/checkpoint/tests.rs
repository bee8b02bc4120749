mod faults;

use super::*;
use crate::disk::Operation;
use crate::disk::faults::{Plan, Watched};
use crate::scratch::Scratch;
use proptest::prelude::*;
use std::fs;

fn header() -> Header {
    Header {
        scene_hash: "9f86d081".into(),
        seed: 7,
        options: [
            ("model".into(), "real".into()),
            ("estimator".into(), "sine".into()),
        ]
        .into(),
        width: 8,
        height: 6,
        crop: [2, 1, 5, 4],
    }
}

fn tile(x: u32, y: u32, width: u32, height: u32) -> Tile {
    let area = width * height;
    let pixels = (0..area)
        .map(|i| [f64::from(i) / 3.0, f64::from(x), -0.0])
        .collect();
    let queries = (0..area).map(|i| u64::MAX - u64::from(i)).collect();
    Tile {
        x,
        y,
        width,
        height,
        pixels,
        counted: CountedPixels {
            queries,
            good: (0..area).map(|i| [u64::from(i); 3]).collect(),
            widths: (0..area).map(|i| [f64::from(i) / 8.0; 3]).collect(),
            strata: (0..area).map(|i| [i as u8; 3]).collect(),
        },
    }
}

fn tiles() -> [Tile; 3] {
    [tile(4, 3, 3, 2), tile(2, 1, 2, 2), tile(4, 1, 1, 1)]
}

fn written(path: &Path) -> Vec<u8> {
    let mut checkpoint = Checkpoint::create(path, &header()).unwrap();
    for tile in &tiles() {
        checkpoint.append(tile).unwrap();
    }
    drop(checkpoint);
    fs::read(path).unwrap()
}

fn part(pixel: [u32; 2], number: u64, paths: u64) -> PixelPart {
    PixelPart {
        pixel,
        number,
        paths,
        totals: (0..paths % 5).map(|word| !word).collect(),
    }
}

/// Tiles, and parts of pixels inside and outside these tiles.
fn records() -> Vec<Record> {
    let [a, b, c] = tiles().map(Record::Tile);
    let parts = [
        part([6, 3], 0, 3),
        part([6, 3], 4095, 1 << 40),
        part([6, 4], 0, 0),
        part([2, 3], 1, 9),
        part([6, 3], 0, 4),
        part([4, 3], 7, 8),
    ];
    let [p, q, r, s, t, u] = parts.map(Record::Part);
    vec![p, q, b, r, s, t, a, u, c]
}

/// The tiles and parts that count after `records`; parts are in the order of pixel and number.
fn left(records: &[Record]) -> (Vec<Tile>, Vec<PixelPart>) {
    let (mut tiles, mut parts) = (Vec::new(), BTreeMap::new());
    for record in records {
        match record {
            Record::Tile(tile) => {
                parts.retain(|(pixel, _), _| !tile.has(*pixel));
                tiles.push(tile.clone());
            }
            Record::Part(part) => {
                parts.insert((part.pixel, part.number), part.clone());
            }
            // A checkpoint of a render has no ending.
            #[cfg(feature = "parts")]
            Record::Ending(_) => {}
        }
    }
    (tiles, parts.into_values().collect())
}

fn with_parts(path: &Path) -> Vec<u8> {
    let mut checkpoint = Checkpoint::create(path, &header()).unwrap();
    for record in &records() {
        match record {
            Record::Tile(tile) => checkpoint.append(tile).unwrap(),
            Record::Part(part) => checkpoint.append_parts(std::slice::from_ref(part)).unwrap(),
            #[cfg(feature = "parts")]
            Record::Ending(_) => {}
        }
    }
    drop(checkpoint);
    fs::read(path).unwrap()
}

fn opened(path: &Path) -> (Checkpoint, (Vec<Tile>, Vec<PixelPart>)) {
    let (mut checkpoint, tiles) = Checkpoint::open(path, &header()).unwrap();
    let parts = checkpoint.take_parts();
    assert!(checkpoint.take_parts().is_empty());
    (checkpoint, (tiles, parts))
}

#[test]
fn finished_tiles_come_back_and_the_render_goes_on() {
    let folder = Scratch::new();
    let path = folder.path("c");
    written(&path);
    let (mut checkpoint, finished) = Checkpoint::open(&path, &header()).unwrap();
    assert_eq!(finished, tiles());
    assert!(finished[0].pixels[0][2].is_sign_negative());
    checkpoint.append(&tile(6, 1, 1, 1)).unwrap();
    drop(checkpoint);
    let (_, finished) = Checkpoint::open(&path, &header()).unwrap();
    assert_eq!(finished[..3], tiles());
    assert_eq!(finished[3..], [tile(6, 1, 1, 1)]);
}

/// The offset at which each record ends.
fn ends() -> Vec<usize> {
    let start = header().encode().len();
    let records = records();
    let lengths = records.iter().map(|record| match record {
        Record::Tile(tile) => tile.encode().len(),
        Record::Part(part) => part.encode().len(),
        #[cfg(feature = "parts")]
        Record::Ending(ending) => ending.encode().len(),
    });
    lengths
        .scan(start, |end, length| {
            *end += length;
            Some(*end)
        })
        .collect()
}

#[test]
fn of_an_unfinished_pixel_the_last_of_each_part_comes_back() {
    let folder = Scratch::new();
    let path = folder.path("c");
    with_parts(&path);
    let (mut checkpoint, (tiles, parts)) = opened(&path);
    assert_eq!((tiles.clone(), parts.clone()), left(&records()));
    // The second tile dropped the earlier parts of its pixels; the part appended after it is left.
    let [a, b] = &parts[..] else {
        panic!("{parts:?}");
    };
    assert_eq!((a, b), (&part([2, 3], 1, 9), &part([4, 3], 7, 8)));
    let two = [part([2, 3], 1, 12), part([3, 3], 0, 1)];
    checkpoint.append_parts(&two).unwrap();
    checkpoint.append_parts(&[]).unwrap();
    drop(checkpoint);
    let (_, (_, parts)) = opened(&path);
    assert_eq!(parts, [two[0].clone(), two[1].clone(), part([4, 3], 7, 8)]);
}

#[test]
fn wherever_the_file_is_cut_whole_records_survive_and_a_new_one_can_follow() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let bytes = with_parts(&path);
    assert_eq!(ends().last(), Some(&bytes.len()));
    let new = tile(6, 4, 1, 1);
    for length in 0..=bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let (mut checkpoint, found) = opened(&path);
        let whole = ends().iter().filter(|&&end| end <= length).count();
        let mut records = records();
        records.truncate(whole);
        assert_eq!(found, left(&records), "cut at {length}");
        checkpoint.append(&new).unwrap();
        drop(checkpoint);
        records.push(Record::Tile(new.clone()));
        assert_eq!(opened(&path).1, left(&records), "cut at {length}");
    }
}

#[test]
fn a_changed_byte_anywhere_is_noticed() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let bytes = with_parts(&path);
    let start = header().encode().len();
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        fs::write(&path, &changed).unwrap();
        match Checkpoint::open(&path, &header()) {
            Ok((mut checkpoint, tiles)) => {
                let whole = ends().iter().filter(|&&end| end <= at).count();
                let found = (tiles, checkpoint.take_parts());
                assert!(at >= start, "byte {at}");
                assert_eq!(found, left(&records()[..whole]), "byte {at}");
            }
            Err(_) => assert!(at < start, "byte {at}"),
        }
    }
}

#[test]
fn records_that_no_longer_count_do_not_fill_the_disk() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let mut checkpoint = Checkpoint::create(&path, &header()).unwrap();
    let mut records = Vec::new();
    let mut most = 0;
    for paths in 1..2000 {
        if paths % 400 == 0 {
            let tile = &tiles()[paths as usize / 400 % 3];
            checkpoint.append(tile).unwrap();
            records.push(Record::Tile(tile.clone()));
        }
        let parts = [part([3, 3], paths % 3, paths), part([6, 3], 0, paths)];
        checkpoint.append_parts(&parts).unwrap();
        records.extend(parts.map(Record::Part));
        most = most.max(fs::metadata(&path).unwrap().len());
        if paths % 97 == 0 {
            // The compacted file has taken the old name, and is locked too.
            let second = Checkpoint::open(&path, &header());
            assert!(matches!(second, Err(CheckpointError::InUse { .. })));
            assert_eq!(folder.names(), ["c"]);
        }
    }
    assert!(most < 4 * MOST_DEAD, "{most} bytes");
    assert!(checkpoint.close().unwrap());
    assert_eq!(opened(&path).1, left(&records));
}

#[test]
fn a_part_of_a_pixel_outside_is_refused() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let mut checkpoint = Checkpoint::create(&path, &header()).unwrap();
    for pixel in [[1, 1], [2, 0], [7, 1], [2, 5]] {
        let refused = checkpoint.append_parts(&[part([2, 1], 0, 1), part(pixel, 0, 1)]);
        assert!(matches!(refused, Err(CheckpointError::Tile { .. })));
    }
    drop(checkpoint);
    assert_eq!(opened(&path).1, left(&[]));
}

#[test]
fn another_render_is_told_in_what_it_differs() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let bytes = written(&path);
    let mut asked = header();
    asked.scene_hash = "60303ae2".into();
    asked.seed = 8;
    asked.crop = [0, 0, 8, 6];
    asked.options = [
        ("model".into(), "fixed".into()),
        ("phase_bits".into(), "9".into()),
    ]
    .into();
    let message = Checkpoint::open(&path, &asked).unwrap_err().to_string();
    let lines: Vec<&str> = message.lines().skip(1).collect();
    assert_eq!(
        lines,
        [
            "  scene: there 9f86d081, here 60303ae2",
            "  seed: there 7, here 8",
            "  crop: there 2,1,5,4, here 0,0,8,6",
            "  estimator: there sine, here not set",
            "  model: there real, here fixed",
            "  phase_bits: there not set, here 9",
        ]
    );
    assert_eq!(
        fs::read(&path).unwrap(),
        bytes,
        "a refused file is left as it was"
    );
    asked = Header {
        width: 9,
        ..header()
    };
    let message = Checkpoint::open(&path, &asked).unwrap_err().to_string();
    assert!(message.ends_with("\n  film: there 8 x 6, here 9 x 6"));
}

#[test]
fn what_is_no_checkpoint_of_ours_is_left_alone() {
    let folder = Scratch::new();
    let path = folder.path("c");
    assert!(matches!(
        Checkpoint::open(&path, &header()),
        Err(CheckpointError::Io { .. })
    ));
    assert!(folder.names().is_empty());
    fs::write(&path, "a thesis").unwrap();
    for result in [
        Checkpoint::create(&path, &header()).err(),
        Checkpoint::open(&path, &header()).err(),
    ] {
        assert!(matches!(result, Some(CheckpointError::Foreign { .. })));
    }
    assert_eq!(fs::read(&path).unwrap(), b"a thesis");
    for version in [5, 7] {
        let mut other = header().encode();
        other[8] = version;
        fs::write(&path, other).unwrap();
        let message = Checkpoint::open(&path, &header()).unwrap_err().to_string();
        let expected = format!("is a checkpoint of format {version}; this qrt reads 6");
        assert!(message.ends_with(&expected), "{message}");
    }
}

#[test]
fn creating_forgets_what_was_there_once_there_is_a_tile() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let before = written(&path);
    let other = Header {
        seed: 8,
        ..header()
    };
    // These two renders append no tile.
    assert!(!Checkpoint::create(&path, &other).unwrap().close().unwrap());
    drop(Checkpoint::create(&path, &other).unwrap());
    assert_eq!(fs::read(&path).unwrap(), before);
    let mut checkpoint = Checkpoint::create(&path, &other).unwrap();
    checkpoint.append(&tile(6, 1, 1, 1)).unwrap();
    assert!(checkpoint.close().unwrap());
    assert_eq!(
        Checkpoint::open(&path, &other).unwrap().1,
        [tile(6, 1, 1, 1)]
    );
}

#[test]
fn a_render_without_a_tile_leaves_no_checkpoint() {
    let folder = Scratch::new();
    let path = folder.path("c");
    assert!(
        !Checkpoint::create(&path, &header())
            .unwrap()
            .close()
            .unwrap()
    );
    assert!(folder.names().is_empty());
    drop(Checkpoint::create(&path, &header()).unwrap());
    let (opened, _) = Checkpoint::open(&path, &header()).unwrap();
    assert!(!opened.close().unwrap());
    assert!(folder.names().is_empty());
}

#[cfg(unix)]
#[test]
fn a_link_is_never_followed() {
    let folder = Scratch::new();
    let path = folder.path("c");
    for target in ["thesis", "missing", "tiles", "."] {
        std::os::unix::fs::symlink(target, &path).unwrap();
        fs::write(folder.path("thesis"), "").unwrap();
        let bytes = written(&folder.path("tiles"));
        for result in [
            Checkpoint::create(&path, &header()).err(),
            Checkpoint::open(&path, &header()).err(),
        ] {
            assert!(matches!(result, Some(CheckpointError::Irregular { .. })));
        }
        fs::remove_file(&path).unwrap();
        assert_eq!(fs::read(folder.path("thesis")).unwrap(), b"");
        assert_eq!(fs::read(folder.path("tiles")).unwrap(), bytes);
        assert_eq!(folder.names(), ["thesis", "tiles"]);
    }
    let device = Checkpoint::create(Path::new("/dev/null"), &header());
    assert!(matches!(
        device.err(),
        Some(CheckpointError::Irregular { .. })
    ));
}

#[cfg(unix)]
#[test]
fn what_was_removed_is_made_again() {
    let folder = Scratch::new();
    let path = folder.path("own/c");
    fs::create_dir(folder.path("own")).unwrap();
    let mut checkpoint = Checkpoint::create(&path, &header()).unwrap();
    checkpoint.append(&tile(6, 1, 1, 1)).unwrap();
    fs::remove_dir_all(folder.path("own")).unwrap();
    checkpoint.append(&tile(4, 1, 1, 1)).unwrap();
    assert!(checkpoint.close().unwrap());
    let (_, tiles) = Checkpoint::open(&path, &header()).unwrap();
    assert_eq!(tiles, [tile(6, 1, 1, 1), tile(4, 1, 1, 1)]);
}

#[cfg(unix)]
#[test]
fn what_another_has_put_in_its_place_is_not_removed() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let mut first = Checkpoint::create(&path, &header()).unwrap();
    first.append(&tile(6, 1, 1, 1)).unwrap();
    fs::remove_file(&path).unwrap();
    let second = written(&path);
    assert!(matches!(first.close(), Err(CheckpointError::Lost { .. })));
    assert_eq!(fs::read(&path).unwrap(), second);
    let (first, _) = Checkpoint::open(&path, &header()).unwrap();
    fs::remove_file(&path).unwrap();
    written(&path);
    first.remove().unwrap();
    assert_eq!(fs::read(&path).unwrap(), second);
}

#[test]
fn of_many_renders_at_a_time_one_has_the_checkpoint() {
    use std::sync::atomic::{AtomicU32, Ordering};
    let folder = Scratch::new();
    let path = folder.path("c");
    let (holders, finished) = (AtomicU32::new(0), AtomicU32::new(0));
    let render = |number: u32| {
        let opened = if number.is_multiple_of(2) {
            Checkpoint::create(&path, &header())
        } else {
            Checkpoint::open(&path, &header()).map(|(checkpoint, _)| checkpoint)
        };
        let mut checkpoint = match opened {
            Ok(checkpoint) => checkpoint,
            Err(CheckpointError::InUse { .. }) => return,
            Err(CheckpointError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
                assert!(!number.is_multiple_of(2), "a folder is there");
                return;
            }
            Err(error) => panic!("{error}"),
        };
        assert_eq!(holders.fetch_add(1, Ordering::SeqCst), 0);
        checkpoint.append(&tile(6, 1, 1, 1)).unwrap();
        let bytes = fs::read(&path).unwrap();
        assert!(bytes.ends_with(&tile(6, 1, 1, 1).encode()));
        finished.fetch_add(1, Ordering::SeqCst);
        holders.fetch_sub(1, Ordering::SeqCst);
        if number.is_multiple_of(3) {
            assert!(checkpoint.close().unwrap());
        } else {
            checkpoint.remove().unwrap();
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let mut number = 0;
                while finished.load(Ordering::SeqCst) < 100 {
                    render(number);
                    number += 1;
                }
            });
        }
    });
}

#[test]
fn what_is_appended_is_durable_a_second_later() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let watched = Watched::new(&folder.path(""), Plan::Nothing);
    let mut checkpoint = Checkpoint::create(&path, &header()).unwrap();
    // The first sync is that of the file, the second that of its name.
    let begun = [Operation::Sync, Operation::SyncFolder];
    assert!(watched.done().ends_with(&begun));
    checkpoint.append(&tiles()[0]).unwrap();
    assert_eq!(watched.done().last(), Some(&Operation::Write));
    std::thread::sleep(AT_STAKE);
    checkpoint.append(&tiles()[1]).unwrap();
    assert_eq!(watched.done().last(), Some(&Operation::Sync));
    checkpoint.append(&tiles()[2]).unwrap();
    assert_eq!(watched.done().last(), Some(&Operation::Write));
    drop(checkpoint);
    watched.after_the_cut(|| false);
    let (_, finished) = Checkpoint::open(&path, &header()).unwrap();
    assert_eq!(finished, tiles()[..2]);
}

#[test]
fn two_renders_cannot_write_one_checkpoint() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let first = Checkpoint::create(&path, &header()).unwrap();
    for second in [
        Checkpoint::create(&path, &header()).err(),
        Checkpoint::open(&path, &header()).err(),
    ] {
        assert!(matches!(second, Some(CheckpointError::InUse { .. })));
    }
    drop(first);
    assert!(Checkpoint::open(&path, &header()).is_ok());
}

#[test]
fn a_tile_that_does_not_fit_is_refused() {
    let folder = Scratch::new();
    let path = folder.path("c");
    let mut checkpoint = Checkpoint::create(&path, &header()).unwrap();
    let mut short = tile(2, 1, 2, 2);
    short.counted.queries.pop();
    let huge = Tile {
        width: u32::MAX,
        height: u32::MAX,
        ..tile(2, 1, 1, 1)
    };
    for bad in [
        tile(1, 1, 1, 1),
        tile(2, 0, 1, 1),
        tile(6, 1, 2, 1),
        tile(2, 4, 1, 2),
        short,
        huge,
    ] {
        assert!(matches!(
            checkpoint.append(&bad),
            Err(CheckpointError::Tile { .. })
        ));
    }
    drop(checkpoint);
    assert_eq!(Checkpoint::open(&path, &header()).unwrap().1, []);
}

proptest! {
    #[test]
    fn no_file_makes_it_panic_or_promise_tiles_that_are_not_there(
        tail in proptest::collection::vec(any::<u8>(), 0..200),
        keep in 0usize..=200,
    ) {
        let folder = Scratch::new();
        let path = folder.path("c");
        let mut bytes = header().encode();
        bytes.truncate(keep);
        bytes.extend(tail);
        fs::write(&path, &bytes).unwrap();
        if let Ok((_, tiles)) = Checkpoint::open(&path, &header()) {
            prop_assert_eq!(tiles, []);
        }
    }
}
