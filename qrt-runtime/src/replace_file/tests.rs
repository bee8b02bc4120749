use super::*;
use crate::disk::Operation;
use crate::disk::faults::{Plan, Watched};
use crate::scratch::Scratch;
use std::sync::atomic::{AtomicBool, Ordering};

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = Scratch::new();
    let path = folder.path("result");
    replace_file(&path, |out| out.write_all(b"old")).unwrap();
    let failed = replace_file(&path, |out| {
        out.write_all(&vec![b'x'; 100_000])?;
        Err(io::Error::other("the pen broke"))
    });
    assert_eq!(failed.unwrap_err().to_string(), "the pen broke");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(folder.names(), ["result"]);
    replace_file(&path, |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"new");
    assert_eq!(folder.names(), ["result"]);
}

#[test]
fn the_name_appears_only_when_all_is_written() {
    let folder = Scratch::new();
    let path = folder.path("result");
    replace_file(&path, |out| {
        out.write_all(b"half")?;
        out.flush()?;
        assert!(!path.exists());
        out.write_all(b" and half")
    })
    .unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"half and half");
}

#[test]
fn folders_and_missing_folders_are_errors() {
    let folder = Scratch::new();
    let nothing = |_: &mut BufWriter<DiskFile>| Ok::<(), io::Error>(());
    assert!(replace_file(&folder.path(""), nothing).is_err());
    assert!(replace_file(&folder.path("none/result"), nothing).is_err());
    assert!(replace_file(Path::new(""), nothing).is_err());
    assert!(replace_file(Path::new(".."), nothing).is_err());
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_are_written_to() {
    let folder = Scratch::new();
    let (real, link) = (folder.path("real"), folder.path("link"));
    fs::write(&real, "old").unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    replace_file(&link, |out| out.write_all(b"new")).unwrap();
    assert_eq!(fs::read(&real).unwrap(), b"new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    replace_file(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    replace_file(path, |out| out.write_all(bytes))
}

#[cfg(unix)]
#[test]
fn a_link_to_what_is_not_there_yet_is_followed() {
    let folder = Scratch::new();
    fs::create_dir(folder.path("below")).unwrap();
    let link = folder.path("link");
    std::os::unix::fs::symlink("below/real", &link).unwrap();
    write(&link, b"new").unwrap();
    assert_eq!(fs::read(folder.path("below/real")).unwrap(), b"new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(folder.names(), ["below", "link"]);
}

#[cfg(unix)]
#[test]
fn no_file_is_made_through_a_link_that_lies_in_wait() {
    let folder = Scratch::new();
    let (link, target) = (folder.path("link"), folder.path("target"));
    std::os::unix::fs::symlink(&target, &link).unwrap();
    let error = disk::create_new(&link).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::AlreadyExists);
    fs::write(&target, "thesis").unwrap();
    assert!(disk::create_new(&link).is_err());
    let error = disk::open(&link, true).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert_eq!(fs::read(&target).unwrap(), b"thesis");
}

#[test]
fn no_two_partial_files_have_one_name() {
    let names: std::collections::BTreeSet<_> =
        (0..1000).map(|_| partial_name("a.png".as_ref())).collect();
    assert_eq!(names.len(), 1000);
    for name in names {
        assert!(is_partial_name(&name, "a.png".as_ref()));
        assert!(!is_partial_name(&name, "a.pn".as_ref()));
        assert!(name.to_str().unwrap().ends_with(".qrt-partial"));
    }
    for other in [
        "a.png.qrt-partial",
        "a.png.123.qrt-partial",
        "a.png.0123456789abcdeF.qrt-partial",
    ] {
        assert!(
            !is_partial_name(other.as_ref(), "a.png".as_ref()),
            "{other}"
        );
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_its_permissions() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Scratch::new();
    let path = folder.path("result");
    let mode = || fs::metadata(&path).unwrap().permissions().mode() & 0o7777;
    write(&path, b"new").unwrap();
    let usual = mode();
    fs::write(folder.path("usual"), "").unwrap();
    let umask = fs::metadata(folder.path("usual")).unwrap();
    assert_eq!(usual, umask.permissions().mode() & 0o7777);
    for kept in [0o600, 0o640, 0o755, 0o400, 0o666] {
        fs::set_permissions(&path, fs::Permissions::from_mode(kept)).unwrap();
        replace_file(&path, |out| {
            // The partial file has the same permissions while it is written.
            let partial = folder
                .names()
                .into_iter()
                .find(|name| name.ends_with(PARTIAL));
            let partial = fs::metadata(folder.path(partial.unwrap())).unwrap();
            assert_eq!(partial.permissions().mode() & 0o7777, kept);
            out.write_all(b"newer")
        })
        .unwrap();
        assert_eq!(mode(), kept);
    }
}

#[test]
fn what_the_dead_have_left_is_removed_and_what_the_living_write_is_not() {
    let folder = Scratch::new();
    let path = folder.path("result");
    let abandoned = "result.0123456789abcdef.qrt-partial";
    let others = [
        "result.0123456789abcde.qrt-partial",
        "result.csv.0123456789abcdef.qrt-partial",
        "result.qrt-partial",
    ];
    for name in others.into_iter().chain([abandoned]) {
        fs::write(folder.path(name), "half").unwrap();
    }
    replace_file(&path, |out| {
        out.write_all(b"slow")?;
        out.flush()?;
        assert!(!folder.names().contains(&abandoned.to_owned()));
        // Another process writes the same file, and finishes first.
        write(&path, b"quick")?;
        try_writing(&ResolvedPath::resolve(&path)?)
    })
    .unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"slow");
    let mut left = others.map(str::to_owned).to_vec();
    left.push("result".to_owned());
    left.sort();
    assert_eq!(folder.names(), left);
}

#[test]
fn many_who_write_one_file_do_not_disturb_each_other() {
    let folder = Scratch::new();
    let path = folder.path("result");
    let whole = |writer: u8| vec![writer; 20_000];
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let writers = (0..4).map(|writer| {
            let path = &path;
            scope.spawn(move || (0..100).try_for_each(|_| write(path, &whole(writer))))
        });
        let writers: Vec<_> = writers.collect();
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                if let Ok(found) = fs::read(&path) {
                    assert!((0..4).any(|writer| found == whole(writer)));
                }
            }
        });
        for writer in writers {
            let result = writer.join();
            if !matches!(result, Ok(Ok(()))) {
                done.store(true, Ordering::Relaxed);
            }
            result.unwrap().unwrap();
        }
        done.store(true, Ordering::Relaxed);
    });
    assert_eq!(folder.names(), ["result"]);
}

#[test]
fn whichever_operation_fails_the_old_file_or_the_new_one_is_there() {
    let mut failed = std::collections::BTreeSet::new();
    for old in [None, Some(b"old")] {
        for which in 0.. {
            let folder = Scratch::new();
            let path = folder.path("result");
            if let Some(old) = old {
                fs::write(&path, old).unwrap();
                #[cfg(unix)]
                fs::set_permissions(&path, std::os::unix::fs::PermissionsExt::from_mode(0o600))
                    .unwrap();
            }
            let watched = Watched::new(&folder.path(""), Plan::Fail(which));
            let result = replace_file(&path, |out| {
                out.write_all(&vec![b'x'; 30_000])?;
                out.write_all(b"new")
            });
            let done = watched.done();
            drop(watched);
            let found = fs::read(&path).ok();
            let new = found.as_ref().is_some_and(|found| found.len() == 30_003);
            assert!(new || found.as_deref() == old.map(<[u8; 3]>::as_slice));
            let Some(operation) = done.get(which) else {
                result.unwrap();
                assert!(new);
                break;
            };
            failed.insert(*operation);
            assert_eq!(result.unwrap_err().to_string(), "a fault of this test");
            assert_eq!(new, *operation == Operation::SyncFolder);
            let result = usize::from(found.is_some());
            assert_eq!(folder.names().len(), result, "{operation:?}");
            write(&path, b"again").unwrap();
            assert_eq!(folder.names(), ["result"]);
        }
    }
    let mut all = vec![
        Operation::Create,
        Operation::Write,
        Operation::Sync,
        Operation::Lock,
        Operation::Rename,
        Operation::SyncFolder,
    ];
    if cfg!(unix) {
        all.push(Operation::SetPermissions);
    }
    assert_eq!(failed, all.into_iter().collect());
}

#[test]
fn whenever_the_power_is_cut_the_old_file_or_the_new_one_is_there() {
    let new = vec![b'x'; 30_000];
    for which in 0..12 {
        for kept in 0..16_u32 {
            let folder = Scratch::new();
            let path = folder.path("result");
            fs::write(&path, "old").unwrap();
            let watched = Watched::new(&folder.path(""), Plan::Cut(which));
            let result = write(&path, &new);
            let mut coin = kept;
            watched.after_the_cut(|| {
                coin = coin.rotate_right(1);
                coin & 1 == 1
            });
            let found = fs::read(&path).unwrap();
            assert!(found == b"old" || found == new, "{which}, {kept}");
            assert!(result.is_err() || found != b"old", "{which}, {kept}");
            write(&path, b"again").unwrap();
            assert_eq!(folder.names(), ["result"]);
        }
    }
}
