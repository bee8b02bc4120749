//! The frame of all benches, and code that several of them share.
//!
//! A bench has parts, each with promises of its own. `cargo bench --bench machines -- gates` runs
//! the part `gates` alone; without a name, all parts run, and the bench fails if any promise is
//! broken. What follows the names are a part's own arguments, which its page describes.

#![allow(dead_code, reason = "no bench uses all of it")]

pub(crate) mod bodies;
pub(crate) mod growth;
pub(crate) mod knot;
pub(crate) mod load;
pub(crate) mod mesh;
pub(crate) mod processor;
pub(crate) mod programs;
pub(crate) mod scenes;

use std::process::ExitCode;

/// The function of a part: it prints its measurements and judges its promises.
pub(crate) type Measure = fn(&Arguments, &mut Promises);

/// Runs the parts that the command line names, or all.
pub(crate) fn run(parts: &[(&str, Measure)]) -> ExitCode {
    let mut arguments = Arguments::of_command_line();
    let is_part = |word: &String| parts.iter().any(|(name, _)| name == word);
    let count = arguments
        .words
        .iter()
        .take_while(|word| is_part(word))
        .count();
    arguments.parts = arguments.words.drain(..count).collect();
    if let (true, Some(word)) = (arguments.parts.is_empty(), arguments.words.first()) {
        let names: Vec<&str> = parts.iter().map(|(name, _)| *name).collect();
        eprintln!("no part is called `{word}`: there are {}", names.join(", "));
        return ExitCode::FAILURE;
    }
    let mut promises = Promises { kept: true };
    for (name, measure) in parts {
        if arguments.parts.is_empty() || arguments.names(name) {
            println!("\n--- {name} ---");
            measure(&arguments, &mut promises);
        }
    }
    promises.exit()
}

/// Runs a bench of a single part.
pub(crate) fn run_alone(measure: Measure) -> ExitCode {
    let mut promises = Promises { kept: true };
    measure(&Arguments::of_command_line(), &mut promises);
    promises.exit()
}

/// The arguments of the command line.
pub(crate) struct Arguments {
    parts: Vec<String>,
    /// The words that are neither parts nor flags, and the flags.
    words: Vec<String>,
    flags: Vec<String>,
    file: Option<String>,
}

impl Arguments {
    fn of_command_line() -> Self {
        let (mut words, mut flags, mut file) = (Vec::new(), Vec::new(), None);
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                // Cargo adds it.
                "--bench" => {}
                "--csv" => file = Some(arguments.next().expect("--csv FILE")),
                flag if flag.starts_with("--") => flags.push(argument),
                _ => words.push(argument),
            }
        }
        Self {
            parts: Vec::new(),
            words,
            flags,
            file,
        }
    }

    /// True if the part `name` is named.
    pub(crate) fn names(&self, name: &str) -> bool {
        self.parts.iter().any(|part| part == name)
    }

    /// True if `flag` is given, such as `--quick`.
    pub(crate) fn flag(&self, flag: &str) -> bool {
        self.flags.iter().any(|given| given == flag)
    }

    /// Returns the first word behind the parts' names.
    pub(crate) fn word(&self) -> Option<&str> {
        self.words.first().map(String::as_str)
    }

    /// Returns the words behind the parts' names.
    pub(crate) fn words(&self) -> &[String] {
        &self.words
    }

    /// Returns the file of `--csv`.
    pub(crate) fn csv(&self) -> Option<&str> {
        self.file.as_deref()
    }
}

/// The verdict on all promises so far.
pub(crate) struct Promises {
    kept: bool,
}

impl Promises {
    /// Records and prints whether a promise is kept.
    pub(crate) fn judge(&mut self, what: &str, kept: bool) {
        println!("{} {what}", if kept { "kept  " } else { "BROKEN" });
        self.kept &= kept;
    }

    fn exit(&self) -> ExitCode {
        ExitCode::from(u8::from(!self.kept))
    }
}
