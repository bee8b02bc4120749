//! Tests of lines that survive faults, power cuts and the removal of their file.

use super::*;
use crate::disk::faults::{Plan, Watched};
use crate::scratch::Scratch;

/// Returns the lines of the file after its first, if that is complete.
fn lines(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let lines = text.strip_prefix("head\n").unwrap_or_default().lines();
    lines.map(str::to_owned).collect()
}

/// Opens a file and appends three lines to it. Returns the lines that were reported as written.
fn write_three(path: &Path) -> Vec<String> {
    let Ok(Some(mut file)) = LineFile::open(path) else {
        return Vec::new();
    };
    if file.start("head\n").is_err() {
        return Vec::new();
    }
    let lines = ["one", "two", "three"].into_iter();
    let written = lines.take_while(|line| file.append(&format!("{line}\n")).is_ok());
    written.map(str::to_owned).collect()
}

#[test]
fn written_lines_survive_a_power_cut() {
    for cut in 0.. {
        let folder = Scratch::new();
        let path = folder.path("table");
        let watched = Watched::new(&folder.path(""), Plan::Cut(cut));
        let written = write_three(&path);
        let all = watched.done().len() <= cut;
        watched.after_the_cut(|| false);
        assert!(lines(&path).starts_with(&written), "cut {cut}");
        if all {
            assert_eq!(written, ["one", "two", "three"]);
            break;
        }
    }
}

#[test]
fn a_power_cut_leaves_the_replaced_text_or_the_new_one() {
    for cut in 0.. {
        let folder = Scratch::new();
        let path = folder.path("table");
        write_three(&path);
        let watched = Watched::new(&folder.path(""), Plan::Cut(cut));
        let mut file = LineFile::open(&path).ok().flatten();
        let replaced = (file.as_mut())
            .is_some_and(|file| file.replace("head\nnew\n").is_ok() && file.append("2\n").is_ok());
        let all = watched.done().len() <= cut;
        watched.after_the_cut(|| false);
        let lines = lines(&path);
        if replaced {
            assert_eq!(lines, ["new", "2"], "cut {cut}");
        } else {
            let old = lines == ["one", "two", "three"];
            assert!(old || lines.starts_with(&["new".to_owned()]), "cut {cut}");
        }
        if all {
            assert!(replaced);
            break;
        }
    }
}

#[test]
fn a_removed_file_is_noticed_and_replaced_with_its_folder() {
    let folder = Scratch::new();
    let path = folder.path("own/table");
    fs::create_dir(folder.path("own")).unwrap();
    let mut file = LineFile::open(&path).unwrap().unwrap();
    file.start("head\n").unwrap();
    assert!(!file.is_removed().unwrap());
    fs::remove_dir_all(folder.path("own")).unwrap();
    assert!(file.is_removed().unwrap());
    file.replace("head\none\n").unwrap();
    file.append("two\n").unwrap();
    assert!(!file.is_removed().unwrap());
    assert_eq!(lines(&path), ["one", "two"]);
}

#[test]
fn an_open_file_is_opened_once_and_read_from_its_beginning() {
    let folder = Scratch::new();
    let path = folder.path("table");
    write_three(&path);
    let mut file = LineFile::open(&path).unwrap().unwrap();
    assert!(LineFile::open(&path).unwrap().is_none());
    assert_eq!(file.read().unwrap(), b"head\none\ntwo\nthree\n");
    file.truncate("head\none\n".len() as u64).unwrap();
    file.append("2\n").unwrap();
    assert_eq!(file.read().unwrap(), b"head\none\n2\n");
}
