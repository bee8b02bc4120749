//! What each register holds: that scratch registers are zero again, and that what a `within!` read
//! is there when it is undone.
//!
//! A register's content is named by the list of changes that made it. A statement that is the
//! inverse of the last of them, and reads what that read, takes it off the list again; neighbouring
//! additions may be undone in any order, and so may neighbouring exclusive ors. What is left at the
//! end of a scratch register's scope has never been uncomputed.

use super::dim::Linear;
use super::ir::{Bit, Register, Statement, StatementKind as K, Term, Update};
use super::problem::Problems;
use super::scope::{text, type_text};
use proc_macro2::TokenStream;
use qrt_core::syntax::codes;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Changes that may be undone in any order have one class.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Sum,
    Xor,
    Other,
}

/// A change that has not been undone.
#[derive(Clone)]
struct Change {
    /// What was done, and to what: equal for equal effects.
    key: String,
    /// The key of the change that would undo this one.
    undone_by: String,
    /// The two keys without the registers that are read.
    effects: [String; 2],
    class: Class,
    source: TokenStream,
}

/// A number for each content that a register can have.
#[derive(Default)]
struct Names(HashMap<String, u64>);

impl Names {
    fn of(&mut self, content: String) -> u64 {
        let next = self.0.len() as u64;
        *self.0.entry(content).or_insert(next)
    }
}

pub(super) struct Tracker<'a> {
    problems: &'a mut Problems,
    names: Names,
}

/// Registers as they are in one block, by name.
#[derive(Default)]
struct Frame {
    /// What they held at its begin.
    before: BTreeMap<String, u64>,
    changes: BTreeMap<String, Vec<Change>>,
    /// Registers that have been read or changed.
    touched: BTreeSet<String>,
    changed: BTreeSet<String>,
}

impl Frame {
    fn inside(&self, names: &mut Names) -> Self {
        let known = self.before.keys().chain(self.changes.keys());
        let contents = known.map(|name| (name.clone(), self.content(name, names)));
        Self {
            before: contents.collect(),
            ..Self::default()
        }
    }

    /// The name of a register's content.
    fn content(&self, register: &str, names: &mut Names) -> u64 {
        let base = self.before.get(register).copied();
        let base = base.unwrap_or_else(|| names.of(format!("begin {register}")));
        let Some(changes) = self.changes.get(register).filter(|all| !all.is_empty()) else {
            return base;
        };
        let mut content = format!("{base}");
        for run in changes.chunk_by(|a, b| a.class == b.class && a.class != Class::Other) {
            let mut keys: Vec<&str> = run.iter().map(|change| change.key.as_str()).collect();
            keys.sort_unstable();
            content.extend([" (", &keys.join("; "), ")"]);
        }
        names.of(content)
    }

    /// Takes note of a change of one or several registers.
    fn change(
        &mut self,
        written: &BTreeSet<String>,
        read: &BTreeSet<String>,
        (done, undone_by): (&str, &str),
        class: Class,
        source: &TokenStream,
        names: &mut Names,
    ) {
        self.touched.extend(read.iter().chain(written).cloned());
        self.changed.extend(written.iter().cloned());
        let others = read.difference(written);
        let from: Vec<String> = others
            .map(|name| format!("{name}={}", self.content(name, names)))
            .collect();
        let from = from.join(",");
        let change = Change {
            key: format!("{done} from {from}"),
            undone_by: format!("{undone_by} from {from}"),
            effects: [done, undone_by].map(str::to_owned),
            class,
            source: source.clone(),
        };
        if self.take_back(written, &change) {
            return;
        }
        // What several registers become depends on what all of them were.
        let mut change = change;
        if written.len() > 1 {
            let were: Vec<u64> = written
                .iter()
                .map(|name| self.content(name, names))
                .collect();
            change.key = format!("{} of {were:?}", change.key);
        }
        for name in written {
            self.changes
                .entry(name.clone())
                .or_default()
                .push(change.clone());
        }
    }

    fn take_back(&mut self, written: &BTreeSet<String>, change: &Change) -> bool {
        let mut places = Vec::new();
        for name in written {
            let Some(changes) = self.changes.get(name) else {
                return false;
            };
            let place = changes
                .iter()
                .enumerate()
                .rev()
                .find_map(|(place, earlier)| {
                    if earlier.undone_by == change.key {
                        return Some(Some(place));
                    }
                    let passes = earlier.class == change.class && change.class != Class::Other;
                    (!passes).then_some(None)
                });
            let Some(Some(place)) = place else {
                return false;
            };
            places.push((name, place));
        }
        for (name, place) in places {
            if let Some(changes) = self.changes.get_mut(name) {
                changes.remove(place);
            }
        }
        true
    }

    /// The registers that have been changed and not been restored.
    fn left(&self) -> BTreeSet<String> {
        let left = self
            .changes
            .iter()
            .filter(|(_, changes)| !changes.is_empty());
        left.map(|(name, _)| name.clone()).collect()
    }
}

impl<'a> Tracker<'a> {
    pub(super) fn new(problems: &'a mut Problems) -> Self {
        Self {
            problems,
            names: Names::default(),
        }
    }

    /// Looks through a routine's body.
    pub(super) fn body(&mut self, statements: &[Statement]) {
        self.block(statements, &mut Frame::default());
    }

    fn block(&mut self, statements: &[Statement], frame: &mut Frame) {
        for statement in statements {
            self.statement(statement, frame);
        }
    }

    fn inside(&mut self, statements: &[Statement], frame: &Frame) -> Frame {
        let mut inside = frame.inside(&mut self.names);
        self.block(statements, &mut inside);
        inside
    }

    fn statement(&mut self, statement: &Statement, frame: &mut Frame) {
        let source = &statement.source;
        match &statement.kind {
            K::Update(place, terms) => {
                let written = [place.register.name.to_string()].into();
                for (update, term) in terms {
                    let one = |update| {
                        let kind = K::Update(place.clone(), vec![(update, term.clone())]);
                        key(&kind)
                    };
                    let (class, back) = match update {
                        Update::Add => (Class::Sum, Update::Subtract),
                        Update::Subtract => (Class::Sum, Update::Add),
                        Update::Xor => (Class::Xor, Update::Xor),
                    };
                    let read = read(term);
                    // What depends on the register's other bits has its place in the order.
                    let class = if read.is_disjoint(&written) {
                        class
                    } else {
                        Class::Other
                    };
                    let keys = (one(*update), one(back));
                    let keys = (keys.0.as_str(), keys.1.as_str());
                    frame.change(&written, &read, keys, class, source, &mut self.names);
                }
            }
            K::Swap(..) | K::Call { .. } => {
                let (mut written, mut read) = (BTreeSet::new(), BTreeSet::new());
                if let K::Call { arguments, .. } = &statement.kind {
                    for (register, change, _) in arguments {
                        let all = if *change { &mut written } else { &mut read };
                        all.insert(register.name.to_string());
                    }
                }
                if let K::Swap(a, b) = &statement.kind {
                    written.extend([a, b].map(|register| register.name.to_string()));
                }
                self.whole(statement, &written, &read, source, frame);
            }
            K::If(condition, holds, fails) => {
                let mut touched = BTreeSet::new();
                condition.reads(&mut |place| {
                    touched.insert(place.register.name.to_string());
                });
                let inside = [holds, fails].map(|body| self.inside(body, frame));
                self.compound(statement, touched, &inside, frame);
            }
            K::For { body, .. } => {
                let inside = [self.inside(body, frame)];
                self.compound(statement, BTreeSet::new(), &inside, frame);
            }
            K::Within(within, apply) => self.within(statement, within, apply, frame),
            K::Scratch(register, body) => self.scratch(register, body, frame),
            K::Block(body) => self.block(body, frame),
        }
    }

    /// The effect of a statement that contains others: the changes that are left of these.
    fn compound(
        &mut self,
        statement: &Statement,
        mut touched: BTreeSet<String>,
        inside: &[Frame],
        frame: &mut Frame,
    ) {
        let mut left = BTreeSet::new();
        for part in inside {
            touched.extend(part.touched.iter().cloned());
            frame.changed.extend(part.changed.iter().cloned());
            left.extend(part.left());
        }
        let first = inside
            .iter()
            .flat_map(|part| part.changes.values().flatten())
            .next();
        let source = first.map_or_else(|| statement.source.clone(), |first| first.source.clone());
        if left.is_empty() {
            frame.touched.extend(touched);
        } else {
            self.whole(statement, &left, &touched, &source, frame);
        }
    }

    fn whole(
        &mut self,
        statement: &Statement,
        written: &BTreeSet<String>,
        read: &BTreeSet<String>,
        source: &TokenStream,
        frame: &mut Frame,
    ) {
        let keys = (key(&statement.kind), key(&statement.inverse().kind));
        let keys = (keys.0.as_str(), keys.1.as_str());
        frame.change(written, read, keys, Class::Other, source, &mut self.names);
    }

    fn within(
        &mut self,
        statement: &Statement,
        within: &[Statement],
        apply: &[Statement],
        frame: &mut Frame,
    ) {
        let computed = self.inside(within, frame);
        let mut begin = frame.inside(&mut self.names);
        for name in &computed.touched {
            let content = computed.content(name, &mut self.names);
            begin.before.insert(name.clone(), content);
        }
        self.block(apply, &mut begin);
        for name in begin.left().intersection(&computed.touched) {
            let source = begin.changes[name][0].source.clone();
            let message =
                format!("`{name}` is what the `within!` before was computed from or into");
            let help = "change it before or after the two, so that what was computed can be undone";
            self.problems.add(codes::REV_WITHIN, source, &message, help);
        }
        frame.changed.extend(computed.changed.iter().cloned());
        let touched = computed.touched;
        self.compound(statement, touched, &[begin], frame);
    }

    fn scratch(&mut self, register: &Register, body: &[Statement], frame: &mut Frame) {
        let name = register.name.to_string();
        // A name of its own, also if another block has used it.
        frame.before.insert(
            name.clone(),
            self.names
                .of(format!("zero {name}: {}", type_text(&register.ty))),
        );
        self.block(body, frame);
        let dirty = frame.changes.remove(&name).unwrap_or_default();
        if let Some(first) = dirty.first() {
            let message = format!("computed here, never uncomputed: `{name}` is not 0 at its end");
            let mut later = dirty.iter().skip(1);
            let late = later.find(|later| later.effects[0] == first.effects[1]);
            let help = match late {
                Some(late) => format!(
                    "`{}` does not undo it: what it reads has changed in between",
                    text(&late.source)
                ),
                None if dirty.len() > 1 => {
                    "compute it in `within! { .. }` and use it in `apply! { .. }`".to_owned()
                }
                None => format!(
                    "write `within! {{ {}; }} apply! {{ .. }}` around what uses it",
                    text(&first.source)
                ),
            };
            self.problems
                .add(codes::REV_DIRTY, &first.source, &message, &help);
        } else if !frame.changed.contains(&name) {
            let message = format!("nothing is computed into `{name}`");
            self.problems
                .add(codes::REV_UNUSED, &register.name, &message, "remove it");
        }
        frame.changed.remove(&name);
        frame.touched.remove(&name);
    }
}

fn read(term: &Term) -> BTreeSet<String> {
    let mut read = BTreeSet::new();
    let mut visit = |place: super::ir::Place| {
        read.insert(place.register.name.to_string());
    };
    match term {
        Term::Number(number) => number.reads(&mut visit),
        Term::Bit(bit, _) => bit.reads(&mut visit),
    }
    read
}

/// Equal for statements that do the same.
fn key(kind: &K) -> String {
    match kind {
        K::Update(place, terms) => {
            let part = |[first, width]: &[Linear; 2]| format!("[{first}; {width}]");
            let part = place.part.as_ref().map_or_else(String::new, part);
            let mut terms: Vec<String> = terms
                .iter()
                .map(|(u, t)| format!("{u:?} {}", term(t)))
                .collect();
            terms.sort_unstable();
            format!("{}{part} {}", place.register.name, terms.join(", "))
        }
        K::Swap(a, b) => format!(
            "swap {} {}",
            a.name.clone().min(b.name.clone()),
            a.name.clone().max(b.name.clone())
        ),
        K::Call {
            path,
            inverse,
            arguments,
        } => {
            let function = super::emit::function(path, *inverse);
            let arguments: Vec<String> = arguments
                .iter()
                .map(|(register, change, _)| format!("{} {change}", register.name))
                .collect();
            format!("{}({})", text(function), arguments.join(", "))
        }
        K::If(condition, holds, fails) => {
            format!(
                "if {} {{{}}} {{{}}}",
                bit(condition),
                keys(holds),
                keys(fails)
            )
        }
        K::For {
            variable,
            bounds: [first, end],
            reversed,
            body,
        } => format!(
            "for {variable} {first}..{end} {reversed} {{{}}}",
            keys(body)
        ),
        K::Within(within, apply) => format!("within {{{}}} {{{}}}", keys(within), keys(apply)),
        K::Scratch(register, body) => {
            format!(
                "let {}: {} {{{}}}",
                register.name,
                type_text(&register.ty),
                keys(body)
            )
        }
        K::Block(body) => keys(body),
    }
}

fn keys(statements: &[Statement]) -> String {
    let keys = statements.iter().map(|statement| key(&statement.kind));
    keys.collect::<Vec<_>>().join("; ")
}

fn term(term: &Term) -> String {
    match term {
        Term::Number(number) => text(&number.source),
        Term::Bit(Bit::Constant(value), _) => value.to_string(),
        Term::Bit(value, _) => bit(value),
    }
}

fn bit(value: &Bit) -> String {
    match value {
        Bit::Constant(value) => value.to_string(),
        Bit::At(register, index) => format!("{}[{index}]", register.name),
        Bit::Not(inner) => format!("!{}", bit(inner)),
        Bit::And(a, b) => format!("({} & {})", bit(a), bit(b)),
        Bit::Xor(a, b) => format!("({} ^ {})", bit(a), bit(b)),
        Bit::Less(a, b) => format!("({} < {})", text(&a.source), text(&b.source)),
        Bit::Equal(a, b) => format!("({} == {})", text(&a.source), text(&b.source)),
    }
}
