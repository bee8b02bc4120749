//! Tests that a render that is killed at any moment, and again, resumes to the same bytes. It loses at most two
//! seconds of work: of the progress that its bar has shown, all but the last two seconds of processor time is in
//! the checkpoint.
#![cfg(target_os = "linux")]

use crate::common::command::{Folder, worked};
use crate::common::numbers::Numbers;
use crate::common::scene::written;
use qrt::prelude::*;
use std::fs::{self, File};
use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const THREADS: u32 = 2;
const COMMAND: [&str; 6] = ["render", "s.yaml", "-o", "p.exr", "--threads=2", "--resume"];

/// Returns the room with the lamp, with this film and `2^path_bits` paths a pixel.
fn scene(film: &str, path_bits: u32) -> String {
    let room = include_str!("../scenes/box.yaml");
    room.replace("film: { width: 13, height: 11 }", &format!("film: {film}"))
        .replace("path_bits: 10", &format!("path_bits: {path_bits}"))
}

/// A terminal with the bar of a command, and the readings of it: seconds of processor time, and the number of
/// paths that the bar showed then.
struct Watched {
    child: Child,
    bar: JoinHandle<Vec<(f64, u64)>>,
}

/// Returns the last number of paths in a bar: `1,234 of 5,678 paths`.
fn told(text: &str) -> Option<u64> {
    let (before, _) = text.rsplit_once(" paths")?;
    let (before, _) = before.rsplit_once(" of ")?;
    let number = before.rsplit(|c: char| !c.is_ascii_digit() && c != ',');
    number.into_iter().next()?.replace(',', "").parse().ok()
}

impl Watched {
    fn started(folder: &Folder) -> Self {
        use rustix::pty::{OpenptFlags, grantpt, ioctl_tiocgptpeer, openpt, unlockpt};
        use rustix::termios::{Winsize, tcsetwinsize};

        let flags = OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC;
        let terminal = openpt(flags).unwrap();
        grantpt(&terminal).unwrap();
        unlockpt(&terminal).unwrap();
        let size = Winsize {
            ws_row: 40,
            ws_col: 200,
            ws_xpixel: 0,
            ws_ypixel: 0,
        };
        tcsetwinsize(&terminal, size).unwrap();
        let own = ioctl_tiocgptpeer(&terminal, flags).unwrap();
        let mut command = folder.command(&COMMAND);
        command
            .env("TERM", "xterm")
            .stdout(Stdio::null())
            .stderr(Stdio::from(own));
        let child = command.spawn().unwrap();
        // Close this process's copy of the terminal's far end, so that reading ends with the child.
        drop(command);
        let (process, mut terminal) = (child.id(), File::from(terminal));
        let bar = std::thread::spawn(move || {
            let (mut all, mut text) = (Vec::new(), String::new());
            let mut bytes = [0; 4096];
            while let Ok(length @ 1..) = terminal.read(&mut bytes) {
                let now = worked(process);
                text += &String::from_utf8_lossy(&bytes[..length]);
                if let (Some(now), Some(paths)) = (now, told(&text)) {
                    all.push((now, paths));
                }
                // A bar may come in two pieces, so the last line is kept.
                let line = text.rfind(['\r', '\n']).unwrap_or(0);
                text.drain(..line);
            }
            all
        });
        Self { child, bar }
    }

    /// Kills it after `after`; returns the time of that and the readings of its bar, or `None` if it had finished.
    fn killed(mut self, after: Duration) -> Option<(f64, Vec<(f64, u64)>)> {
        std::thread::sleep(after);
        let now = worked(self.child.id());
        self.child.kill().unwrap();
        let status = self.child.wait().unwrap();
        let bar = self.bar.join().unwrap();
        if status.signal() == Some(9) {
            return Some((now.unwrap(), bar));
        }
        assert!(status.success(), "{status}");
        None
    }
}

/// Returns the number of paths in a checkpoint.
fn kept(folder: &Folder, scene: &ValidScene) -> u64 {
    let (cancel, found) = (AtomicBool::new(true), AtomicU64::new(0));
    let progress = |progress: Progress| {
        if let Progress::Started { resumed, .. } = progress {
            found.store(resumed, Ordering::SeqCst);
        }
    };
    // Read a copy, because opening cuts off a torn record.
    let copy = folder.path("copy");
    fs::copy(folder.path("p.exr.qrt-partial"), &copy).unwrap();
    let options = RenderOptions {
        checkpoint: Some(copy.clone()),
        resume: true,
        workers: Workers {
            cancel: Some(&cancel),
            progress: Some(&progress),
            ..Workers::default()
        },
        ..RenderOptions::default()
    };
    // The checkpoint may be complete, so both results are fine.
    let _ = render(scene, &options);
    let _ = fs::remove_file(copy);
    found.into_inner()
}

/// Kills `kills` renders, each `again` times in a row, and resumes each to its end. Returns the greatest loss, in
/// seconds of all threads.
fn survive(film: &str, path_bits: u32, kills: u32, again: u32) -> f64 {
    let text = scene(film, path_bits);
    let scene = written(&text, &[]);
    let folder = Folder::with("s.yaml", &text);
    let start = Instant::now();
    folder.works(&COMMAND);
    let whole = start.elapsed();
    let expected = folder.read("p.exr");
    let mut numbers = Numbers(u64::from(path_bits));
    let (mut killed, mut with_work, mut most) = (0, 0, 0.0_f64);
    // On a busy machine renders take longer than they did alone, and more kills come before any work is kept.
    while killed < kills || with_work <= kills / 4 {
        assert!(killed < 10 * kills, "{with_work} of {killed} had work kept");
        fs::remove_file(folder.path("p.exr")).unwrap();
        for _ in 0..again {
            let part = numbers.below(1 << 20) as f64 / f64::from(1 << 20);
            let after = whole.mul_f64(part / f64::from(again).sqrt());
            let Some((end, bar)) = Watched::started(&folder).killed(after) else {
                break;
            };
            killed += 1;
            let there = folder.path("p.exr.qrt-partial").exists();
            let kept = if there { kept(&folder, &scene) } else { 0 };
            with_work += u32::from(kept > 0);
            // The time at which the bar first showed more than the checkpoint has.
            let lost = bar.iter().find(|(_, paths)| *paths > kept);
            let lost = lost.map_or(0.0, |(then, _)| (end - then) / f64::from(THREADS));
            assert!(lost <= 2.0, "{lost} s of work lost, with {kept} paths kept");
            most = most.max(lost);
        }
        folder.works(&COMMAND);
        assert_eq!(folder.read("p.exr"), expected);
        assert_eq!(folder.names(), ["p.exr", "s.yaml"]);
    }
    println!(
        "{killed} kills within {whole:.1?}, {with_work} with work kept: at most {most:.2} s lost"
    );
    most
}

#[test]
fn twenty_kills_lose_two_seconds_of_work_at_most_and_no_byte() {
    survive("{ width: 20, height: 20 }", 9, 20, 2);
}

#[test]
#[ignore = "takes minutes: what is lost shows in renders that take longer than is lost"]
fn two_hundred_kills_lose_two_seconds_of_work_at_most_and_no_byte() {
    // Checkpoints at the ends of tiles, and within pixels.
    survive("{ width: 32, height: 32 }", 11, 176, 1);
    let lost = survive("{ width: 2, height: 1 }", 24, 24, 4);
    // Some work was lost, or the test would have measured nothing.
    assert!(lost > 0.02, "{lost} s");
}
