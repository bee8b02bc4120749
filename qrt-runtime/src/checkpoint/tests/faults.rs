//! A render's file operations, with a fault at each operation in turn, or a power cut at any of
//! them.

use super::*;
use crate::replace_file::replace_file;

/// All tiles of a picture, row by row.
fn picture() -> Vec<Tile> {
    let places = (1..5).flat_map(|y| (2..7).map(move |x| (x, y)));
    places.map(|(x, y)| tile(x, y, 1, 1)).collect()
}

/// The bytes of the picture, independent of the order of `tiles`.
fn bytes(tiles: &[Tile]) -> Vec<u8> {
    let mut tiles = tiles.to_vec();
    tiles.sort_by_key(|tile| (tile.y, tile.x));
    tiles.iter().flat_map(Tile::encode).collect()
}

/// Renders the picture into `folder`, as the command does: takes the tiles of the checkpoint,
/// appends the others, each with a part before it, and removes the checkpoint when the picture is
/// safe. Syncs after every fourth tile.
fn job(folder: &Scratch, resume: bool) -> Result<(), CheckpointError> {
    let path = folder.path("p.png.qrt-partial");
    let there = resume && path.exists();
    let (mut checkpoint, mut tiles) = if there {
        Checkpoint::open(&path, &header())?
    } else {
        (Checkpoint::create(&path, &header())?, Vec::new())
    };
    let work = (|| {
        for (number, tile) in picture().into_iter().enumerate() {
            if !tiles.contains(&tile) {
                let part = PixelPart {
                    totals: vec![7; 60],
                    ..part([tile.x, tile.y], 0, 1)
                };
                checkpoint.append_parts(&[part])?;
                checkpoint.append(&tile)?;
                if number % 4 == 3 {
                    checkpoint.sync()?;
                }
                tiles.push(tile);
            }
        }
        let picture = folder.path("p.png");
        replace_file(&picture, |out| out.write_all(&bytes(&tiles))).map_err(|source| {
            CheckpointError::Io {
                path: picture,
                source,
            }
        })
    })();
    match work {
        Ok(()) => checkpoint.remove(),
        Err(error) => {
            let _ = checkpoint.close();
            Err(error)
        }
    }
}

/// Checks that the folder holds the old picture or the new one.
fn whole(folder: &Scratch, old: &[u8]) {
    let found = fs::read(folder.path("p.png")).unwrap();
    assert!(found == old || found == bytes(&picture()), "half a picture");
}

/// Checks that a later run with `--resume` makes the picture, and leaves no other file.
fn goes_on(folder: &Scratch) {
    job(folder, true).unwrap();
    assert_eq!(fs::read(folder.path("p.png")).unwrap(), bytes(&picture()));
    assert_eq!(folder.names(), ["p.png"]);
}

#[test]
fn whichever_operation_fails_it_is_told_and_the_render_goes_on_to_the_same_bytes() {
    let mut failed = std::collections::BTreeSet::new();
    // Once from the beginning, once from a torn checkpoint.
    for resume in [false, true] {
        for which in 0.. {
            let folder = Scratch::new();
            fs::write(folder.path("p.png"), "old").unwrap();
            if resume {
                let path = folder.path("p.png.qrt-partial");
                let mut checkpoint = Checkpoint::create(&path, &header()).unwrap();
                for tile in &picture()[3..9] {
                    checkpoint.append(tile).unwrap();
                }
                drop(checkpoint);
                let bytes = fs::read(&path).unwrap();
                fs::write(&path, &bytes[..bytes.len() - 9]).unwrap();
            }
            let watched = Watched::new(&folder.path(""), Plan::Fail(which));
            let result = job(&folder, resume);
            let done = watched.done();
            drop(watched);
            whole(&folder, b"old");
            let Some(operation) = done.get(which) else {
                result.unwrap();
                break;
            };
            failed.insert(*operation);
            // A new file is first looked for with `Open`, and a failure of that may do no harm.
            let harmless = *operation == Operation::Open && !resume;
            if !harmless || result.is_err() {
                let error = result.unwrap_err().to_string();
                assert!(error.contains("a fault of this test"), "{error}");
            }
            for name in folder.names() {
                assert!(["p.png", "p.png.qrt-partial"].contains(&&*name), "{name}");
            }
            goes_on(&folder);
        }
    }
    let all = [
        Operation::Create,
        Operation::Open,
        Operation::Write,
        Operation::SetLength,
        Operation::Sync,
        Operation::Lock,
        Operation::Rename,
        Operation::Remove,
        Operation::SyncFolder,
    ];
    assert_eq!(failed, all.into_iter().collect());
}

#[test]
fn whenever_the_power_is_cut_the_render_goes_on_to_the_same_bytes() {
    let operations = {
        let folder = Scratch::new();
        let watched = Watched::new(&folder.path(""), Plan::Nothing);
        job(&folder, false).unwrap();
        watched.done().len()
    };
    let mut draw = qrt_counting::random::Stream::new(0, 0, 0, 0);
    let mut resumed = 0;
    for _ in 0..100 {
        let folder = Scratch::new();
        fs::write(folder.path("p.png"), "old").unwrap();
        let strict = draw.below(2) == 0;
        // Cut and resume, up to three times.
        for cuts in 0..3 {
            let at = draw.below(operations as u64) as usize;
            let watched = Watched::new(&folder.path(""), Plan::Cut(at));
            let result = job(&folder, cuts > 0);
            watched.after_the_cut(|| !strict && draw.below(2) == 0);
            whole(&folder, b"old");
            let path = folder.path("p.png.qrt-partial");
            if let Ok((_, tiles)) = Checkpoint::open(&path, &header()) {
                resumed += tiles.len();
            }
            if result.is_ok() {
                let picture = fs::read(folder.path("p.png")).unwrap();
                assert!(picture != b"old");
                break;
            }
        }
        goes_on(&folder);
    }
    assert!(resumed > 100, "only {resumed} tiles survived");
}
