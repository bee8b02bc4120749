//! Tests of tables and their page.

use super::table::Table;
use super::*;
use crate::scratch::Scratch;
use qrt_core::inspect::Inspection;
use qrt_core::oracle::{CallCost, Oracles};
use qrt_scene::front::parse;
use qrt_scene::{Estimator, Sequence};

/// A lamp over a floor, seen obliquely; two rays.
const LIT: &str = "
name: lit & \"floor\"
camera: { perspective: { eye: [0, 1, 2], target: [0, 0.4, 0], vfov: 60 } }
film: { width: 6, height: 4 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  lamp: { emitter: { radiance: [3, 2, 1] } }
geometry:
  - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: floor }
  - quad: { vertices: [[-1, 1.5, -1], [1, 1.5, -1], [1, 1.5, 1], [-1, 1.5, 1]], material: lamp }
sampling: { path_bits: 6, depths: [{ bits: [8, 8] }, { bits: [8, 8] }], lights: none }
precision: { fraction: 10 }
comparator: { bits: 6 }
counting: { phase_bits: 5, estimator: sine }
";

fn scene(text: &str) -> ValidScene {
    parse(text, "lit.yaml", &[], "".as_ref()).unwrap().valid
}

fn quick() -> TradeOptions<'static> {
    TradeOptions {
        quick: true,
        pixels: Some(8),
        ..TradeOptions::default()
    }
}

/// A table's lines without their seconds and checksums.
fn timeless(folder: &Scratch) -> Vec<String> {
    let text = std::fs::read_to_string(folder.path("trade.csv")).unwrap();
    let without = |line: &str| Some(line.rsplitn(3, ',').nth(2)?.to_owned());
    text.lines().filter_map(without).collect()
}

#[test]
fn written_rows_survive_the_removal_of_their_folder() {
    let settings = sweep::settings(&scene(LIT).parameters(), true);
    let row = |at: usize| Row {
        setting: settings[at],
        queries: 7.0,
        cost: CallCost {
            toffoli: 100,
            qubits: 10,
        },
        mean: 0.5,
        errors: [Band::default(); ERRORS.len()],
        seconds: 1.0,
    };
    let header = vec![("seed", "0".to_owned())];
    let rows = |path: &Path| {
        let found = table::read(path, &header, &settings);
        found.map_or(0, |found| found.rows.iter().flatten().count())
    };
    let folder = Scratch::new();
    let path = folder.path("own/trade.csv");
    std::fs::create_dir(folder.path("own")).unwrap();
    let mut table = Table::open(&path, &header, &settings).unwrap();
    for at in 0..3 {
        std::fs::remove_dir_all(folder.path("own")).unwrap();
        table.append(at, &row(at)).unwrap();
        assert_eq!(rows(&path), at + 1);
    }
}

#[test]
fn parts_of_the_error_fall_with_their_own_parameter_alone() {
    let folder = Scratch::new();
    let measured = trade(&scene(LIT), &folder.path(""), &quick()).unwrap();
    assert!(measured.left_out.is_empty());
    let error = |sweep: Sweep, at: usize| -> Vec<f64> {
        measured
            .rows_of(sweep)
            .map(|row| row.errors[at].value)
            .collect()
    };
    let falls = |errors: &[f64]| errors[0] > 4.0 * errors[errors.len() - 1];
    let same = |errors: &[f64]| errors.windows(2).all(|pair| pair[0] == pair[1]);
    let [paths, comparators, width, counting, depth] = [0, 1, 2, 3, 4];
    for (sweep, own) in [
        (Sweep::Comparator, comparators),
        (Sweep::Fraction, width),
        (Sweep::Depth, depth),
    ] {
        assert!(
            falls(&error(sweep, own)),
            "{sweep:?}: {:?}",
            error(sweep, own)
        );
    }
    assert!(same(&error(Sweep::Comparator, paths)) && same(&error(Sweep::Comparator, depth)));
    assert!(same(&error(Sweep::Fraction, paths)) && same(&error(Sweep::Fraction, comparators)));
    for other in [paths, comparators, width, depth] {
        assert!(same(&error(Sweep::Counting, other)), "{other}");
    }
    for name in [Estimator::Sine, Estimator::Auto] {
        let rows = measured.rows_of(Sweep::Counting);
        let rows = rows.filter(|row| row.setting.estimator == name);
        let errors: Vec<f64> = rows.map(|row| row.errors[counting].value).collect();
        assert!(falls(&errors), "{name}: {errors:?}");
    }
    let net = measured.rows_of(Sweep::Paths);
    let net = net.filter(|row| row.setting.sequence == Sequence::DigitalNet);
    let net: Vec<f64> = net.map(|row| row.errors[paths].value).collect();
    assert!(falls(&net), "{net:?}");
    // The real model has no numbers of finite width, and the gates' numbers are those of the fixed
    // machine.
    let [real, fixed, gates] = error(Sweep::Model, width)[..] else {
        panic!("three models");
    };
    assert!(real == 0.0 && fixed > 0.0 && fixed == gates);
    // Depths are the scene's two and two more.
    assert_eq!(measured.rows_of(Sweep::Depth).count(), 4);
}

#[test]
fn the_total_is_measured_against_the_limit() {
    let folder = Scratch::new();
    let measured = trade(&scene(LIT), &folder.path(""), &quick()).unwrap();
    let row = measured.scene().unwrap();
    let [r, c, w, t, _, total] = row.errors.map(|band| band.value);
    // Independent parts add up in squares, and none cancels another altogether.
    assert!(total <= r + c + w + t && total > 0.3 * (r * r + c * c + w * w + t * t).sqrt());
    assert_eq!(row.queries, 3.0 * 31.0);
    assert_eq!(row.toffoli_x_queries(), 93.0 * row.cost.toffoli as f64);
    // The cost is the one that an inspection of the same scene finds.
    let parameters = row.setting.parameters(&scene(LIT).parameters());
    let same = scene(LIT).with_parameters(parameters).unwrap();
    let inspected = Inspection::most_expensive(&Oracles::new(&same), None).unwrap();
    assert_eq!(row.cost.toffoli, inspected.total().toffoli);
    assert_eq!(row.cost.qubits, u64::from(inspected.qubits));
}

#[test]
fn an_interrupted_table_is_gone_on_with_to_the_same_table() {
    let (whole, cut) = (Scratch::new(), Scratch::new());
    let all = trade(&scene(LIT), &whole.path(""), &quick()).unwrap();
    let text = std::fs::read_to_string(whole.path("trade.csv")).unwrap();
    assert_eq!(all.resumed, 0);
    // Cuts the table off after some rows, in the middle of one.
    let end = text.match_indices('\n').nth(20).unwrap().0 + 30;
    std::fs::write(cut.path("trade.csv"), &text[..end]).unwrap();
    let rest = trade(&scene(LIT), &cut.path(""), &quick()).unwrap();
    assert_eq!(rest.resumed, 19);
    assert_eq!(timeless(&cut), timeless(&whole));
    let names = folder_names(&whole);
    assert_eq!(names, folder_names(&cut));
    // Plots without seconds have the same bytes.
    for name in names
        .iter()
        .filter(|name| std::path::Path::new(name).extension() == Some("svg".as_ref()))
    {
        if name != "front-seconds.svg" {
            let [a, b] = [&whole, &cut].map(|folder| std::fs::read(folder.path(name)).unwrap());
            assert_eq!(a, b, "{name}");
        }
    }
    let again = trade(&scene(LIT), &cut.path(""), &quick()).unwrap();
    assert_eq!(again.resumed, again.rows.len());
}

#[test]
fn portions_of_a_table_make_the_table_and_what_they_lack_is_measured() {
    let folders = [0; 4].map(|_| Scratch::new());
    let [whole, first, second, merged] = &folders;
    let all = trade(&scene(LIT), &whole.path(""), &quick()).unwrap();
    for (number, folder) in [first, second].into_iter().enumerate() {
        let portion = Portion::new(number as u32, 2).unwrap();
        let part = trade(
            &scene(LIT),
            &folder.path(""),
            &TradeOptions { portion, ..quick() },
        )
        .unwrap();
        assert!(part.rows.len().abs_diff(all.rows.len() / 2) <= 1);
        assert_eq!(folder_names(folder), ["trade.csv"]);
    }
    let parts = [second.path(""), first.path("")];
    let both = TradeOptions {
        parts: &parts,
        ..quick()
    };
    let made = trade(&scene(LIT), &merged.path(""), &both).unwrap();
    assert_eq!((made.resumed, made.damaged), (all.rows.len(), 0));
    assert!(timeless(merged) == timeless(whole));
    assert_eq!(folder_names(merged), folder_names(whole));

    // With one of the two parts alone, and a damaged row in it, the rest is measured.
    let table = second.path("trade.csv");
    let text = std::fs::read_to_string(&table).unwrap();
    let last = text.trim_end().rfind(',').unwrap();
    std::fs::write(&table, format!("{},00000000\n", &text[..last])).unwrap();
    let again = Scratch::new();
    let one = TradeOptions {
        parts: &parts[..1],
        ..quick()
    };
    let made = trade(&scene(LIT), &again.path(""), &one).unwrap();
    assert_eq!((made.resumed, made.damaged), (all.rows.len() / 2 - 1, 1));
    assert!(timeless(&again) == timeless(whole));
    // A table of another scene and a missing table are refused.
    let other = scene(&LIT.replace("radiance: [3", "radiance: [4"));
    let error = trade(&other, &Scratch::new().path(""), &one)
        .unwrap_err()
        .to_string();
    assert!(error.contains("another scene hash"), "{error}");
    let missing = [whole.path("nothing")];
    let none = TradeOptions {
        parts: &missing,
        ..quick()
    };
    let error = trade(&scene(LIT), &Scratch::new().path(""), &none).unwrap_err();
    assert!(matches!(error, TradeError::File { .. }), "{error}");
}

#[test]
fn a_damaged_row_is_measured_again_wherever_it_is_damaged() {
    let (whole, damaged) = (Scratch::new(), Scratch::new());
    trade(&scene(LIT), &whole.path(""), &quick()).unwrap();
    let text = std::fs::read_to_string(whole.path("trade.csv")).unwrap();
    let rows = text.lines().count() - 2;
    let third = text.match_indices('\n').nth(1).unwrap().0 + 1;
    let path = damaged.path("trade.csv");
    let (mut bytes, mut hurt) = (text.clone().into_bytes(), std::collections::BTreeSet::new());
    // Writes a digit, a comma or a byte that is not text into figures, settings and checksums.
    for (number, byte) in [(3, b'7'), (9, b','), (14, 0xff), (22, b'0'), (23, b'x')] {
        let start = text.match_indices('\n').nth(number + 1).unwrap().0 + 1;
        let end = start + text[start..].find('\n').unwrap();
        let at = start + (end - start) * number / 24;
        bytes[at] = if bytes[at] == byte { byte ^ 1 } else { byte };
        hurt.insert(number);
    }
    assert!(bytes[..third] == text.as_bytes()[..third]);
    std::fs::write(&path, &bytes).unwrap();
    let again = trade(&scene(LIT), &damaged.path(""), &quick()).unwrap();
    assert_eq!(
        (again.damaged, again.resumed),
        (hurt.len(), rows - hurt.len())
    );
    assert_eq!(timeless(&damaged), timeless(&whole));
    let mended = std::fs::read_to_string(&path).unwrap();
    for (number, (line, before)) in mended.lines().zip(text.lines()).skip(2).enumerate() {
        assert!(line == before || hurt.contains(&number), "{line}");
    }
    let last = trade(&scene(LIT), &damaged.path(""), &quick()).unwrap();
    assert_eq!((last.damaged, last.resumed), (0, rows));
}

#[test]
fn two_do_not_measure_into_one_table() {
    let folder = Scratch::new();
    let path = folder.path("trade.csv");
    let first = std::fs::File::create(&path).unwrap();
    first.try_lock().unwrap();
    let error = trade(&scene(LIT), &folder.path(""), &quick()).unwrap_err();
    assert!(matches!(error, TradeError::InUse { .. }) && !error.is_refusal());
    assert_eq!(std::fs::read(&path).unwrap(), b"");
}

#[cfg(unix)]
#[test]
fn a_table_that_is_a_link_is_left_alone() {
    let folder = Scratch::new();
    std::fs::write(folder.path("thesis"), "a thesis").unwrap();
    for target in ["thesis", "missing"] {
        let path = folder.path("trade.csv");
        std::os::unix::fs::symlink(target, &path).unwrap();
        let error = trade(&scene(LIT), &folder.path(""), &quick()).unwrap_err();
        assert!(error.to_string().contains("regular file"), "{error}");
        std::fs::remove_file(&path).unwrap();
    }
    assert_eq!(std::fs::read(folder.path("thesis")).unwrap(), b"a thesis");
    assert_eq!(folder.names(), ["thesis"]);
}

#[test]
fn a_table_that_lost_its_name_is_nobodys() {
    // Several threads open the table at a time. Only one holds it, although its file is created,
    // replaced and removed meanwhile.
    use std::sync::atomic::{AtomicU32, Ordering};
    let folder = Scratch::new();
    let path = folder.path("trade.csv");
    let (holders, finished) = (AtomicU32::new(0), AtomicU32::new(0));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while finished.load(Ordering::SeqCst) < 200 {
                    match table::Table::open(&path, &vec![], &[]) {
                        Err(TradeError::InUse { .. }) => {}
                        opened => {
                            let table = opened.unwrap();
                            assert_eq!(holders.fetch_add(1, Ordering::SeqCst), 0);
                            // Once the file is removed, another thread may hold a new file of that
                            // name.
                            holders.fetch_sub(1, Ordering::SeqCst);
                            if finished.fetch_add(1, Ordering::SeqCst).is_multiple_of(2) {
                                std::fs::remove_file(&path).unwrap();
                            }
                            drop(table);
                        }
                    }
                }
            });
        }
    });
}

#[test]
fn any_changed_byte_of_a_row_is_noticed() {
    let row = "paths,fixed,sine,1.0e0";
    let line = format!("{row},{:08x}", crc32fast::hash(row.as_bytes()));
    assert_eq!(table::checked(&line), Some(row));
    for at in 0..line.len() {
        for bit in 0..7 {
            let mut changed = line.clone().into_bytes();
            changed[at] ^= 1 << bit;
            let changed = String::from_utf8(changed).unwrap();
            assert_eq!(table::checked(&changed), None, "{changed}");
        }
    }
}

fn folder_names(folder: &Scratch) -> Vec<String> {
    let mut names = folder.names();
    names.sort();
    names
}

#[test]
fn the_table_of_something_else_is_refused() {
    let folder = Scratch::new();
    let path = folder.path("trade.csv");
    let refused = |words: &str, options: &TradeOptions<'_>, text: &str| {
        let error = trade(&scene(text), &folder.path(""), options).unwrap_err();
        assert!(error.is_refusal(), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    std::fs::write(&path, "x,y\n1,2\n").unwrap();
    refused("line 1 is no row", &quick(), LIT);
    let header = |seed: u64, text: &str| {
        format!(
            "# qrt trade: version={}, build={}, scene_hash={}, seed={seed}, pixels=8, quick=true\n",
            env!("CARGO_PKG_VERSION"),
            build(),
            scene(text).fingerprint()
        )
    };
    std::fs::write(&path, header(1, LIT)).unwrap();
    refused("another seed: 1, not 0", &quick(), LIT);
    let other = LIT.replace("radiance: [3", "radiance: [4");
    std::fs::write(&path, header(0, &other)).unwrap();
    refused("another scene hash", &quick(), LIT);
    std::fs::write(&path, header(0, LIT)).unwrap();
    let more = TradeOptions {
        pixels: Some(9),
        ..quick()
    };
    refused("another pixels: 8, not 9", &more, LIT);
    let black = LIT.replace("[3, 2, 1]", "[0, 0, 0]");
    std::fs::remove_file(&path).unwrap();
    refused("is black", &quick(), &black);
}

/// Checks that the advised change is a row of the table, with the error that the advice states.
#[test]
fn the_advice_is_a_change_that_was_measured() {
    let folder = Scratch::new();
    let mut measured = trade(&scene(LIT), &folder.path(""), &quick()).unwrap();
    let said = advice::sentences(&measured);
    let largest = &said[0];
    assert!(
        largest.starts_with("The largest part of the error is that of "),
        "{largest}"
    );
    let most = said
        .iter()
        .find(|line| line.starts_with("Most for its price: --set "));
    let most = most.expect("more queries lessen the error of counting");
    let sets: Vec<String> = (most.split("--set ").skip(1))
        .map(|set| set.split([' ', ',']).next().unwrap().to_owned())
        .collect();
    let changed = parse(LIT, "lit.yaml", &sets, "".as_ref()).unwrap();
    let changed = Setting::from_parameters(&changed.valid.parameters());
    let row = measured.rows.iter().find(|row| {
        let sweep = row.setting.sweep;
        row.setting == Setting { sweep, ..changed }
    });
    let row = row.expect("it was measured");
    let total = row.errors[5].value;
    assert!(
        most.contains(&format!("a total error of {:.2} %", 100.0 * total)),
        "{most}"
    );
    assert!(total < 0.9 * measured.rows[0].errors[5].value);
    // Without an error there is no advice.
    for band in &mut measured.rows[0].errors {
        band.value = 0.0;
    }
    assert!(advice::sentences(&measured).is_empty());
}

#[test]
fn the_page_is_whole_and_asks_nobody() {
    let folder = Scratch::new();
    let measured = trade(&scene(LIT), &folder.path(""), &quick()).unwrap();
    let page = std::fs::read_to_string(folder.path("index.html")).unwrap();
    assert!(page.contains("lit &amp; &quot;floor&quot;: speed against accuracy"));
    assert!(!page.contains("NaN") && !page.contains(">inf"));
    assert!(page.contains("<h2>What to change next</h2>") && page.contains("<details open>"));
    assert!(page.contains("radiance: [3, 2, 1]"), "the scene's text");
    assert!(
        page.contains(">paths,<br>E_R</th>")
            && page.contains("<b>paths, E_R</b>: their exact mean"),
        "what an error is of"
    );
    assert!(!page.contains("e_r"), "one spelling");
    let picture = page
        .matches("<img src=\"data:image/png;base64,iVBORw0KGgo")
        .count();
    assert_eq!(picture, usize::from(cfg!(feature = "png")));
    let at = |words: &str| page.find(words).unwrap_or(usize::MAX);
    assert!(at("<div class=\"scene") < at("<h2>What to change next"));
    // Only the names of formats are addresses.
    for part in page.split("http").skip(1) {
        assert!(part.starts_with("://www.w3.org/2000/svg"), "{part:.60}");
    }
    for name in folder.names() {
        if let Some(figure) = name.strip_suffix(".svg") {
            assert!(
                page.contains(&format!("<figure id=\"{figure}\">")),
                "{figure}"
            );
        }
    }
    assert_eq!(page.matches("<figure id=").count(), 13);
    let summary = measured.summary();
    for words in [
        "slope of E_T over queries: monte-carlo -0.",
        "against random paths",
        "against the net, classically",
    ] {
        assert!(summary.contains(words), "{summary}");
    }
    for rival in [
        "quasi-Monte Carlo",
        "next-event",
        "multiple importance",
        "Heisenberg",
    ] {
        assert!(page.contains(rival), "{rival}");
    }
}

mod rivals;

#[test]
fn each_circuit_of_a_table_is_compiled_once() {
    let folder = Scratch::new();
    let scene = scene(LIT);
    let made = trade(&scene, &folder.path(""), &quick()).unwrap();
    let own = scene.parameters();
    let mut circuits = Vec::new();
    for row in made.rows.iter().filter(|row| !row.setting.sweep.is_rival()) {
        let changed = row.setting.parameters(&own);
        let fraction = changed.precision.fraction;
        let circuit = (
            changed.sampling,
            fraction,
            changed.comparator,
            changed.circuit,
        );
        if !circuits.contains(&circuit) {
            circuits.push(circuit);
        }
    }
    assert!(circuits.len() > 5);
    // No lamp is sampled, so all pixels are of one class.
    assert_eq!(scene.recordings(), circuits.len() as u64);
}
