//! Routines over constants: the contents of their registers, without the numbers of their bits.
//!
//! The content of some bits of a register is named by the list of changes that made it. A statement
//! that is the inverse of one of them, and reads the same operands, removes that change from the
//! list. All later changes must then change other bits, or be additions or exclusive ors as the
//! statement itself is. A change that is left at the end of a scratch register's scope has never
//! been uncomputed. A branch and a loop are changes like others, undone as wholes.

use super::blame;
use super::keys::{key, key_of};
use crate::reversible::dim::{Linear, Loop, apart, least};
use crate::reversible::ir::{Place, Register, Statement, StatementKind as K, Term, Update};
use crate::reversible::problem::Problems;
use proc_macro2::TokenStream;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// The class of a change. Sums may be undone in any order, and so may exclusive ors.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Sum,
    Xor,
    Other,
}

/// Some bits of a register, or all: the first and their number.
#[derive(Clone, PartialEq, Eq)]
struct RegisterBits {
    register: String,
    bits: Option<[Linear; 2]>,
}

impl RegisterBits {
    fn all(register: &Register) -> Self {
        Self::from_place(&Place {
            register: Rc::new(register.clone()),
            part: None,
        })
    }

    /// Returns the bits of a place. The bits of an array are counted through all of its registers.
    fn from_place(Place { register, part }: &Place) -> Self {
        let bits = match (&register.element, register.format.width.known()) {
            (None, _) => part.clone(),
            (Some(_), None) => None,
            (Some(element), Some(width)) => {
                let [first, bits] = part.clone().unwrap_or([0.into(), width.into()]);
                Some([element.times(width).plus(&first), bits])
            }
        };
        Self {
            register: register.name.to_string(),
            bits,
        }
    }

    /// True if the two may have a bit in common.
    fn meets(&self, other: &Self, loops: &[Loop]) -> bool {
        let bits = self.bits.as_ref().zip(other.bits.as_ref());
        self.register == other.register && bits.is_none_or(|(a, b)| !apart(a, b, loops))
    }

    /// Returns the bits that these are in any pass of a loop.
    fn in_passes(&self, around: &Loop) -> Self {
        let bits = self.bits.as_ref().map(|[first, width]| {
            let around = std::slice::from_ref(around);
            let end = least(&first.plus(width).times(-1), around).times(-1);
            let first = least(first, around);
            [first.clone(), end.minus(&first)]
        });
        Self {
            bits,
            register: self.register.clone(),
        }
    }

    fn key(&self) -> String {
        match &self.bits {
            Some([first, width]) => format!("{}[{first}; {width}]", self.register),
            None => self.register.clone(),
        }
    }
}

/// A change that has not been undone.
#[derive(Clone)]
struct Change {
    part: RegisterBits,
    /// The change and its target: equal for equal effects.
    key: String,
    /// The key of the change that would undo this one.
    undone_by: String,
    /// The two keys without the registers that are read.
    effects: blame::Texts,
    class: Class,
    source: TokenStream,
}

/// A number for each content of some bits.
#[derive(Default)]
struct Names(HashMap<String, u64>);

impl Names {
    fn number(&mut self, content: String) -> u64 {
        let next = self.0.len() as u64;
        *self.0.entry(content).or_insert(next)
    }
}

pub(super) struct Tracker<'a> {
    problems: &'a mut Problems,
    names: Names,
    loops: Vec<Loop>,
}

/// The registers of one block, by name.
#[derive(Default)]
struct Frame {
    /// Their contents at the beginning of the block.
    before: BTreeMap<String, u64>,
    changes: BTreeMap<String, Vec<Change>>,
    read: Vec<RegisterBits>,
    /// Bits that have been read or changed.
    touched: Vec<RegisterBits>,
    changed: BTreeSet<String>,
}

impl Frame {
    fn touch(&mut self, parts: &[RegisterBits]) {
        for part in parts {
            if !self.touched.contains(part) {
                self.touched.push(part.clone());
            }
        }
    }

    fn read(&mut self, parts: &[RegisterBits]) {
        self.touch(parts);
        for part in parts {
            if !self.read.contains(part) {
                self.read.push(part.clone());
            }
        }
    }

    /// Returns the parts whose changes have not been undone: one for each register.
    fn left(&self) -> Vec<RegisterBits> {
        let left = self.changes.values().filter_map(|changes| {
            let (first, others) = changes.split_first()?;
            let same = others.iter().all(|other| other.part == first.part);
            let bits = first.part.bits.clone().filter(|_| same);
            let register = first.part.register.clone();
            Some(RegisterBits { register, bits })
        });
        left.collect()
    }
}

impl<'a> Tracker<'a> {
    pub(super) fn new(problems: &'a mut Problems) -> Self {
        Self {
            problems,
            names: Names::default(),
            loops: Vec::new(),
        }
    }

    /// Checks a routine's body.
    pub(super) fn body(&mut self, statements: &[Statement]) {
        self.block(statements, &mut Frame::default());
    }

    fn block(&mut self, statements: &[Statement], frame: &mut Frame) {
        for statement in statements {
            self.statement(statement, frame);
        }
    }

    /// Begins a block within another, before its first statement.
    fn begin(&mut self, frame: &Frame) -> Frame {
        let known = frame.before.keys().chain(frame.changes.keys());
        let contents = known.map(|register| {
            let (register, bits) = (register.clone(), None);
            let content = self.content(
                &RegisterBits {
                    register: register.clone(),
                    bits,
                },
                frame,
            );
            (register, content)
        });
        Frame {
            before: contents.collect(),
            ..Frame::default()
        }
    }

    fn inside(&mut self, statements: &[Statement], frame: &Frame) -> Frame {
        let mut inside = self.begin(frame);
        self.block(statements, &mut inside);
        inside
    }

    /// Returns the name of the content of some bits.
    fn content(&mut self, part: &RegisterBits, frame: &Frame) -> u64 {
        let base = frame.before.get(&part.register).copied();
        let base = base.unwrap_or_else(|| self.names.number(format!("begin {}", part.register)));
        let changes = frame.changes.get(&part.register).into_iter().flatten();
        let changes: Vec<&Change> = changes
            .filter(|change| change.part.meets(part, &self.loops))
            .collect();
        if changes.is_empty() {
            return base;
        }
        let mut content = format!("{base}");
        for run in changes.chunk_by(|a, b| a.class == b.class && a.class != Class::Other) {
            let mut keys: Vec<&str> = run.iter().map(|change| change.key.as_str()).collect();
            keys.sort_unstable();
            content.extend([" (", &keys.join("; "), ")"]);
        }
        self.names.number(content)
    }

    /// Records a change of one or several registers.
    fn change(
        &mut self,
        [written, read]: [&[RegisterBits]; 2],
        effects: &blame::Texts,
        class: Class,
        source: &TokenStream,
        frame: &mut Frame,
    ) {
        frame.read(read);
        frame.touch(written);
        frame
            .changed
            .extend(written.iter().map(|part| part.register.clone()));
        let mut from = Vec::new();
        for part in read {
            if !self.meets_any(part, written) {
                from.push(format!("{}={}", part.key(), self.content(part, frame)));
            }
        }
        from.sort_unstable();
        from.dedup();
        let from = from.join(",");
        let [mut key, undone_by] = effects
            .clone()
            .map(|effect| format!("{effect} from {from}"));
        if self.take_back(written, &key, class, frame) {
            return;
        }
        // The new contents of several registers depend on the old contents of all of them.
        if written.len() > 1 {
            let were: Vec<u64> = written
                .iter()
                .map(|part| self.content(part, frame))
                .collect();
            key = format!("{key} of {were:?}");
        }
        for part in written {
            let change = Change {
                part: part.clone(),
                key: key.clone(),
                undone_by: undone_by.clone(),
                effects: effects.clone(),
                class,
                source: source.clone(),
            };
            let changes = frame.changes.entry(part.register.clone()).or_default();
            changes.push(change);
        }
    }

    /// Removes the change that this one undoes from the list. False if there is none.
    fn take_back(
        &self,
        written: &[RegisterBits],
        key: &str,
        class: Class,
        frame: &mut Frame,
    ) -> bool {
        let mut places = Vec::new();
        for part in written {
            let Some(changes) = frame.changes.get(&part.register) else {
                return false;
            };
            let mut latest_first = changes.iter().enumerate().rev();
            let place = latest_first.find_map(|(place, earlier)| {
                if earlier.undone_by == key && earlier.part == *part {
                    return Some(Some(place));
                }
                let passes = earlier.class == class && class != Class::Other
                    || !earlier.part.meets(part, &self.loops);
                (!passes).then_some(None)
            });
            let Some(Some(place)) = place else {
                return false;
            };
            places.push((&part.register, place));
        }
        for (register, place) in places {
            if let Some(changes) = frame.changes.get_mut(register) {
                changes.remove(place);
            }
        }
        true
    }

    fn statement(&mut self, statement: &Statement, frame: &mut Frame) {
        let source = &statement.source;
        match &statement.kind {
            K::Update(place, terms) => {
                for (update, term) in terms {
                    let one = |update| key(&K::Update(place.clone(), vec![(update, term.clone())]));
                    let (class, back) = match update {
                        Update::Add => (Class::Sum, Update::Subtract),
                        Update::Subtract => (Class::Sum, Update::Add),
                        Update::Xor => (Class::Xor, Update::Xor),
                    };
                    let parts = [&[RegisterBits::from_place(place)][..], &read(term)];
                    self.change(parts, &[one(*update), one(back)], class, source, frame);
                }
            }
            K::Swap(a, b) => {
                let written = [a, b].map(|register| RegisterBits::all(register));
                self.whole(statement, [&written, &[]], source, frame);
            }
            K::Call { arguments, .. } => {
                let (written, read): (Vec<_>, Vec<_>) =
                    arguments.iter().partition(|(_, change, _)| *change);
                let [written, read] = [written, read].map(|all| -> Vec<RegisterBits> {
                    all.iter()
                        .map(|(register, ..)| RegisterBits::all(register))
                        .collect()
                });
                self.whole(statement, [&written, &read], source, frame);
            }
            K::If(condition, holds, fails) => {
                let mut read = Vec::new();
                condition.reads(&mut |place| read.push(RegisterBits::from_place(&place)));
                let inside = [holds, fails].map(|body| self.inside(body, frame));
                self.compound(statement, read, &inside, frame);
            }
            K::For {
                variable,
                bounds,
                body,
                ..
            } => {
                let around = (variable.clone(), bounds.clone());
                self.loops.push(around.clone());
                let mut inside = self.inside(body, frame);
                self.loops.pop();
                for part in inside.touched.iter_mut().chain(&mut inside.read) {
                    *part = part.in_passes(&around);
                }
                for change in inside.changes.values_mut().flatten() {
                    change.part = change.part.in_passes(&around);
                }
                self.compound(statement, Vec::new(), &[inside], frame);
            }
            K::Within(within, apply) => self.within(statement, within, apply, frame),
            K::Scratch(register, body) => self.scratch(register, body, frame),
            K::Zero(register) => drop(frame.changes.remove(&register.name.to_string())),
            K::Block(body) => self.block(body, frame),
        }
    }

    /// Records the effect of a statement that contains others: the changes of these that are left.
    fn compound(
        &mut self,
        statement: &Statement,
        mut read: Vec<RegisterBits>,
        inside: &[Frame],
        frame: &mut Frame,
    ) {
        let mut left: Vec<RegisterBits> = Vec::new();
        for part in inside {
            read.extend(part.read.iter().cloned());
            frame.touch(&part.touched);
            frame.changed.extend(part.changed.iter().cloned());
            for part in part.left() {
                let mut known = left.iter_mut();
                match known.find(|other| other.register == part.register) {
                    Some(other) if *other == part => {}
                    Some(other) => other.bits = None,
                    None => left.push(part),
                }
            }
        }
        frame.read(&read);
        let mut changes = inside
            .iter()
            .flat_map(|part| part.changes.values().flatten());
        let Some(first) = changes.next() else {
            return;
        };
        // If nothing reads a changed register, all changes are additions in any order.
        let one_class = first.class != Class::Other && changes.all(|c| c.class == first.class);
        let is_changed =
            |part: &RegisterBits| inside.iter().any(|f| f.changed.contains(&part.register));
        let ordered = !one_class || !adds(statement) || read.iter().any(is_changed);
        let class = if ordered { Class::Other } else { first.class };
        let keys = [statement, &statement.inverse()].map(|one| {
            if ordered {
                return key(&one.kind);
            }
            format!("in any order {}", key_of(&one.kind, false))
        });
        self.change([&left, &read], &keys, class, &first.source, frame);
    }

    fn meets_any(&self, part: &RegisterBits, others: &[RegisterBits]) -> bool {
        others.iter().any(|other| part.meets(other, &self.loops))
    }

    fn whole(
        &mut self,
        statement: &Statement,
        parts: [&[RegisterBits]; 2],
        source: &TokenStream,
        frame: &mut Frame,
    ) {
        let keys = [key(&statement.kind), key(&statement.inverse().kind)];
        self.change(parts, &keys, Class::Other, source, frame);
    }

    fn within(
        &mut self,
        statement: &Statement,
        within: &[Statement],
        apply: &[Statement],
        frame: &mut Frame,
    ) {
        let computed = self.inside(within, frame);
        let mut begin = self.begin(frame);
        for part in &computed.touched {
            let register = part.register.clone();
            let all = RegisterBits {
                register: register.clone(),
                bits: None,
            };
            begin.before.insert(register, self.content(&all, &computed));
        }
        self.block(apply, &mut begin);
        for (register, changes) in &begin.changes {
            let met = changes.iter().find(|change| {
                let mut touched = computed.touched.iter();
                touched.any(|part| part.meets(&change.part, &self.loops))
            });
            if let Some(met) = met {
                blame::within_changed(register, &met.source, self.problems);
            }
        }
        frame.changed.extend(computed.changed.iter().cloned());
        let touched = computed.touched;
        self.compound(statement, touched, &[begin], frame);
    }

    fn scratch(&mut self, register: &Register, body: &[Statement], frame: &mut Frame) {
        let name = register.name.to_string();
        // Its content is zero, even if another block has used the name.
        let zero = format!("zero {name}: {}", register.type_text());
        frame.before.insert(name.clone(), self.names.number(zero));
        self.block(body, frame);
        let dirty = frame.changes.remove(&name).unwrap_or_default();
        let dirty: Vec<(blame::Texts, TokenStream)> = dirty
            .into_iter()
            .map(|change| (change.effects, change.source))
            .collect();
        if !dirty.is_empty() {
            blame::never_uncomputed(&register.name, &dirty, self.problems);
        } else if !frame.changed.contains(&name) {
            blame::nothing_computed(&register.name, self.problems);
        }
        frame.changed.remove(&name);
        frame.touched.retain(|part| part.register != name);
        frame.read.retain(|part| part.register != name);
    }
}

fn read(term: &Term) -> Vec<RegisterBits> {
    let mut read = Vec::new();
    let mut visit = |place: Place| read.push(RegisterBits::from_place(&place));
    match term {
        Term::Number(number) => number.reads(&mut visit),
        Term::Bit(bit, _) => bit.reads(&mut visit),
    }
    read
}

/// True if a statement consists of updates alone.
fn adds(statement: &Statement) -> bool {
    match &statement.kind {
        K::Update(..) => true,
        K::If(_, holds, fails) => holds.iter().chain(fails).all(adds),
        K::For { body, .. } => body.iter().all(adds),
        _ => false,
    }
}
