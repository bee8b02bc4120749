//! Checks that every figure of speed names its source: the machine, the number of threads, the commit
//! and the command. Figures that are the same on every machine say `any machine` and need no
//! threads.
//!
//! In a table of `docs/figures.md` the column `measured` holds the first three and the column
//! `command` the last. In a sentence all four stand behind the figure, in any order: "1.46 million
//! paths a second (Zen 5, 1 thread, `c4f441f`, `cargo bench --bench machines -- fixed`)".

use super::page::{Page, pages, report};
use std::fs;

/// Page of the figures, and of the table of machines.
const FIGURES: &str = "docs/figures.md";
/// Other pages outside of the book whose figures are checked.
const BESIDE: [&str; 2] = ["README.md", "ARCHITECTURE.md"];
/// The machine of a figure that depends on none.
const ANY: &str = "any machine";

/// Words of a sentence that states a measured speed.
const SPEEDS: [&str; 10] = [
    "million paths/s",
    "e11 gates/s",
    "paths a second",
    "gates a second",
    "rays a second",
    "processor time",
    "of a processor",
    "seconds of one core",
    "microseconds a shot",
    "after a change",
];
/// Words of a sentence that derives its figures from others, or refers to them.
const POINTERS: [&str; 2] = ["figures.md", "by the same"];

/// Returns the names of the machines: the first column of the table under "Machines".
fn machines(figures: &str) -> Vec<String> {
    let section = figures.split("\n## Machines\n").nth(1).unwrap_or_default();
    let rows = section.lines().skip_while(|line| !line.starts_with('|'));
    rows.take_while(|line| line.starts_with('|'))
        .skip(2)
        .filter_map(|row| cells(row).first().map(ToString::to_string))
        .collect()
}

/// Returns the cells of a table's row.
fn cells(row: &str) -> Vec<&str> {
    let row = row.trim().trim_start_matches('|').trim_end_matches('|');
    row.split(" | ")
        .map(|cell| cell.trim_matches(['|', ' ']))
        .collect()
}

/// True if `text` names a commit: seven to forty hexadecimal digits in backticks.
fn names_commit(text: &str) -> bool {
    text.split('`').skip(1).step_by(2).any(|code| {
        (7..=40).contains(&code.len())
            && code.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
    })
}

/// True if `text` names a command: code that begins with a program or a script.
fn names_command(text: &str) -> bool {
    const PROGRAMS: [&str; 4] = ["cargo ", "qrt ", "benches/", "rustc "];
    text.split('`')
        .skip(1)
        .step_by(2)
        .any(|code| PROGRAMS.iter().any(|program| code.starts_with(program)))
}

/// True if `text` names the number of threads of the measurement.
fn names_threads(text: &str) -> bool {
    let words: Vec<&str> = text
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    words.windows(2).any(|pair| {
        pair[0].parse::<u32>().is_ok() && matches!(pair[1], "thread" | "threads" | "processes")
    })
}

/// Lists the parts of a measurement's provenance that `text` lacks.
fn missing(text: &str, machines: &[String]) -> Vec<&'static str> {
    let any = text.contains(ANY);
    let mut missing = Vec::new();
    if !any
        && !machines
            .iter()
            .any(|machine| text.contains(machine.as_str()))
    {
        missing.push("the machine");
    }
    if !any && !names_threads(text) {
        missing.push("the number of threads");
    }
    if !names_commit(text) {
        missing.push("the commit");
    }
    missing
}

/// Returns blocks of lines between empty lines, with the number of their first line, without fences.
fn paragraphs(text: &str) -> Vec<(usize, String)> {
    let mut all = Vec::new();
    let mut block = (1, String::new());
    let mut fenced = false;
    for (number, line) in (1..).zip(text.lines()) {
        let is_fence = line.trim_start().starts_with("```");
        let starts = line.starts_with("- ") || line.starts_with("# ");
        if fenced || is_fence || line.trim().is_empty() || starts {
            all.push(std::mem::take(&mut block));
        }
        if is_fence {
            fenced = !fenced;
        } else if !fenced && !line.trim().is_empty() {
            if block.1.is_empty() {
                block.0 = number;
            }
            block.1.push_str(line);
            block.1.push('\n');
        }
    }
    all.push(block);
    all.retain(|(_, text)| !text.is_empty());
    all
}

/// Lists the rows of a table of figures without provenance.
///
/// A table without the columns `measured` and `command` may have a paragraph `below` it that begins
/// with "Measured: " and names the provenance of all rows.
fn wrong_rows(table: &str, below: &str, first: usize, machines: &[String]) -> Vec<String> {
    let mut lines = table.lines();
    let head = cells(lines.next().unwrap_or_default());
    let place = |name: &str| head.iter().position(|cell| *cell == name);
    let (Some(measured), Some(command)) = (place("measured"), place("command")) else {
        let said = below.starts_with("Measured: ")
            && missing(below, machines).is_empty()
            && names_command(below);
        let wrong = format!("{FIGURES}:{first}: a table that does not say where it is from");
        return if said { Vec::new() } else { vec![wrong] };
    };
    let rows = (first + 2..).zip(lines.skip(1));
    rows.filter_map(|(line, row)| {
        let cells = cells(row);
        let cell = |place: usize| cells.get(place).copied().unwrap_or_default();
        let mut missing = missing(cell(measured), machines);
        if !names_command(cell(command)) {
            missing.push("the command");
        }
        (!missing.is_empty()).then(|| format!("{FIGURES}:{line}: no {}", missing.join(", no ")))
    })
    .collect()
}

/// Lists the sentences of a page that give a speed without provenance.
fn wrong_sentences(path: &str, text: &str, machines: &[String]) -> Vec<String> {
    let of_prose = |(_, text): &(usize, String)| !text.starts_with('|');
    let paragraphs = paragraphs(text).into_iter().filter(of_prose);
    paragraphs
        .filter_map(|(line, text)| {
            let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
            let states = SPEEDS.iter().any(|speed| flat.contains(speed));
            if !states || POINTERS.iter().any(|pointer| flat.contains(pointer)) {
                return None;
            }
            let mut missing = missing(&flat, machines);
            if !names_command(&flat) {
                missing.push("the command");
            }
            (!missing.is_empty()).then(|| format!("{path}:{line}: no {}", missing.join(", no ")))
        })
        .collect()
}

#[test]
fn every_table_of_figures_names_machine_threads_commit_and_command() {
    let text = fs::read_to_string(FIGURES).unwrap();
    let machines = machines(&text);
    assert!(machines.len() > 1, "{machines:?}");
    let mut tables = 0;
    let mut failures = Vec::new();
    let all = paragraphs(&text);
    for (place, (line, table)) in all.iter().enumerate() {
        // The table of the machines has no measurements.
        if table.starts_with('|') && !table.starts_with("| name |") {
            tables += 1;
            let below = all.get(place + 1).map_or("", |(_, text)| text.as_str());
            failures.extend(wrong_rows(table, below, *line, &machines));
        }
    }
    report(&failures);
    assert!(tables >= 5, "only {tables} tables were found");
}

#[test]
fn every_speed_in_a_sentence_names_machine_threads_commit_and_command() {
    let figures = fs::read_to_string(FIGURES).unwrap();
    let machines = machines(&figures);
    let mut failures = wrong_sentences(FIGURES, &figures, &machines);
    for path in BESIDE {
        let text = fs::read_to_string(path).unwrap();
        failures.extend(wrong_sentences(path, &text, &machines));
    }
    for Page { name, text } in pages() {
        failures.extend(wrong_sentences(
            &format!("book/src/{name}"),
            &text,
            &machines,
        ));
    }
    report(&failures);
}

#[test]
fn a_figure_without_a_source_is_found() {
    let machines = vec!["Zen 5".to_owned()];
    let told = "Some 3 million paths a second (Zen 5, 1 thread, `abcdef0`, `cargo bench`).";
    assert!(wrong_sentences("page", told, &machines).is_empty());
    for (left_out, what) in [
        ("Zen 5, ", "the machine"),
        ("1 thread, ", "the number of threads"),
        ("`abcdef0`, ", "the commit"),
        (", `cargo bench`", "the command"),
    ] {
        let text = format!("First.\n\n{}", told.replace(left_out, ""));
        let found = wrong_sentences("page", &text, &machines);
        assert_eq!(found, [format!("page:3: no {what}")]);
    }
    let table = "| what | measured | command |\n|---|---|---|\n\
                 | a | Zen 5, 2 threads, `abcdef0` | `cargo bench` |\n\
                 | b | any machine, `abcdef0` | `qrt inspect` |\n\
                 | c | Zen 4, 2 threads, `abcdef0` | |\n";
    let found = wrong_rows(table, "", 10, &machines);
    assert_eq!(
        found,
        [format!("{FIGURES}:14: no the machine, no the command")]
    );
    let bare = "| what | figure |\n|---|---|\n| a | 1 |\n";
    let below = "Measured: Zen 5, 2 threads, `abcdef0`, `cargo bench`.";
    assert!(wrong_rows(bare, below, 1, &machines).is_empty());
    assert_eq!(wrong_rows(bare, "", 1, &machines).len(), 1);
}
