//! `qrt!`: from tokens to a checked scene, and from there to Rust.
//!
//! The tokens become the same tree that YAML text becomes, with the tokens' numbers for places, and
//! the one checker does the rest. A problem at a path in the tree is shown at the path's tokens.

mod advice;
mod body;
mod earlier;
mod emit;
mod expression;
mod fault;
mod film;
mod header;
mod input;
mod loops;
mod names;
mod parts;
mod records;
mod tokens;
mod values;

pub(crate) use body::Origin;
pub(crate) use fault::Faults;
pub(crate) use input::expand;
#[cfg(test)]
pub(crate) use {input::Read, input::read, tokens::Table};

use body::Body;
use header::Header;
use qrt_scene::front::{Files, Loaded, of_tree};
use qrt_scene::valid::ValidScene;
use qrt_syntax::tree::{Node, Span};
use qrt_syntax::{At, Problem, Step, Structure, What, codes};
use std::path::Path as FilePath;

/// The words before the errors of a file.
const REFUSED: &str = "this file is not a scene that qrt can take";

/// A scene of a macro, and the places of its parts.
#[derive(Debug)]
pub(crate) struct Parsed {
    /// Attributes, visibility and name of the type that stands for it.
    pub(crate) header: Header,
    /// The labels of its primitives, by their number in the scene; empty for a scene of a file.
    pub(crate) primitives: Vec<Origin>,
    /// The labels of its rays, by the number of bounces before each; empty for a scene of a file.
    pub(crate) rays: Vec<Origin>,
    source: Source,
}

#[derive(Debug)]
enum Source {
    /// The tokens of the macro themselves.
    Tokens(Box<Written>),
    /// A scene file, and the scene that was read from it.
    File(Box<Loaded>),
    /// Nothing, since the scene could not be read.
    Nothing,
}

/// A scene that the macro spells out.
#[derive(Debug)]
struct Written {
    tree: Node,
    body: Body,
}

impl Parsed {
    /// Creates a scene of a file.
    fn of_file(header: Header, loaded: Loaded) -> Self {
        let source = Source::File(Box::new(loaded));
        Self {
            source,
            ..Self::nothing(header)
        }
    }

    /// Creates a scene of which only the name could be read.
    fn nothing(header: Header) -> Self {
        Self {
            header,
            primitives: Vec::new(),
            rays: Vec::new(),
            source: Source::Nothing,
        }
    }

    /// Adds problems that were found in the scene, each at its place.
    pub(crate) fn report(&self, problems: Vec<Problem>, faults: &mut Faults) {
        match &self.source {
            Source::Tokens(written) => {
                for problem in &problems {
                    self.place(written, problem, faults);
                }
            }
            Source::File(loaded) => {
                let report = loaded.report(problems);
                self.header.report(REFUSED, &report, faults);
            }
            Source::Nothing => {}
        }
    }

    /// Adds the scene's warnings: requests that have no effect.
    pub(crate) fn warnings(&self, valid: &ValidScene, faults: &mut Faults) {
        match &self.source {
            Source::File(loaded) => {
                if let Some(report) = loaded.warnings() {
                    self.header.report("of this file", &report, faults);
                }
            }
            _ => self.report(valid.warnings().to_vec(), faults),
        }
    }

    /// Adds a problem at its tokens, unless it may only follow from a key that could not be read.
    fn place(&self, written: &Written, problem: &Problem, faults: &mut Faults) {
        let Written { tree, body } = written;
        let Some(path) = problem.path() else {
            return;
        };
        let found = tree.resolve(path);
        let reader = &body.reader;
        let is_missing = matches!(problem.what, What::Structure(Structure::MissingKeys { .. }));
        if is_missing && reader.incomplete.contains(&found.node.span) {
            return;
        }
        let expression = (found.node.span.source as usize)
            .checked_sub(1)
            .and_then(|index| reader.expressions.get(index));
        if let Some(expression) = expression.filter(|_| problem.within.is_some()) {
            return expression.report(problem, &reader.names, faults);
        }
        let origin = match &path.0[..] {
            [Step::Key(key), Step::Item(index), ..] if key == "geometry" => {
                self.primitives.get(*index)
            }
            [
                Step::Key(sampling),
                Step::Key(depths),
                Step::Item(index),
                ..,
            ] if sampling == "sampling" && depths == "depths" => self.rays.get(*index),
            _ => None,
        };
        let words = advice::description(&problem.what);
        let fault = faults.add(words.code, found.span, words.message);
        // The message has stated the expected value already.
        let is_said = [codes::WRONG_TYPE, codes::WRONG_LENGTH, codes::MISSING_KEY];
        if !words.label.is_empty() && !is_said.contains(&words.code) {
            fault.note(words.label);
        }
        if let Some(At::Path(path)) = &problem.also {
            fault.also(tree.resolve(path).span, format!("{} is", words.also));
        }
        fault.help = words.help;
        if let Some(origin) = origin {
            if let Some(label) = &origin.label {
                fault.note(format!("in the {} `{label}`", origin.kind));
            }
            if !origin.pass.is_empty() {
                fault.in_pass(&origin.pass);
            }
        }
    }
}

/// Checks the scene that `body` and `name` describe. Returns it if it is valid, and reports all its
/// errors otherwise.
fn check(
    header: Header,
    mut body: Body,
    name: Span,
    root: &FilePath,
    faults: &mut Faults,
) -> (Parsed, Option<ValidScene>) {
    let tree = body.tree(&header.scene_name(), name);
    faults.append(std::mem::take(&mut body.reader.faults));
    let parsed = Parsed {
        header,
        primitives: body.primitives.clone(),
        rays: body.rays.clone(),
        source: Source::Tokens(Box::new(Written { tree, body })),
    };
    let Source::Tokens(written) = &parsed.source else {
        return (parsed, None);
    };
    match of_tree(&written.tree, Files::below(root, "".as_ref())) {
        Ok(valid) => (parsed, Some(valid)),
        Err(problems) => {
            parsed.report(problems, faults);
            (parsed, None)
        }
    }
}
