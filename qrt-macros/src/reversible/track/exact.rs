//! Routines whose widths and bounds are all known, bit by bit: each statement is run on
//! polynomials, loops pass by pass, branches where their condition holds and where it fails.
//!
//! Contents with equal polynomials are equal: a scratch register is uncomputed when it holds 0
//! again, by whichever statements.

mod read;

use super::blame::{Change, Log, Texts};
use super::content::{Content, Sums};
use super::polynomial::{Atoms, Bit as Poly};
use crate::reversible::emit;
use crate::reversible::ir::{
    Bit, Place, Register, Statement, StatementKind as K, Term, Update, inverse,
};
use crate::reversible::problem::Problems;
use crate::reversible::source::text;
use proc_macro2::TokenStream;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;
use syn::{ExprPath, Ident};

/// The most changed bits, those of every pass of a loop included; beyond, loops are tracked whole.
const MOST_STEPS: usize = 20_000;

/// A call of a function: its name, the words that it read, and those that it changed.
type Called = (String, Vec<u32>, Vec<u32>);

/// The reason why a routine cannot be run: a number is not known, or there are too many steps.
pub(super) struct Unknown;

type Known<T> = Result<T, Unknown>;

#[derive(Default)]
pub(super) struct Exact {
    atoms: Atoms,
    sums: Sums,
    registers: BTreeMap<String, Content>,
    loops: Vec<(Ident, i64)>,
    /// The guards of the branches around.
    guards: String,
    steps: usize,
    log: Log,
    pub(super) problems: Problems,
    /// Bits that the `within!`s around have read or changed.
    touched: Vec<BTreeSet<(String, usize)>>,
    /// Registers that the branches around have changed by other means than addition.
    rewritten: Vec<BTreeSet<String>>,
    /// Updates as texts, by their places in the routine.
    texts: HashMap<usize, Rc<Texts>>,
    /// The contents of changed registers before each call, by the call that would undo it.
    calls: HashMap<Called, Vec<Content>>,
}

impl Exact {
    /// Begins a routine.
    pub(super) fn new(parameters: &[Rc<Register>]) -> Known<Self> {
        let mut exact = Self::default();
        for register in parameters {
            let width = exact.known(&register.format.width)? as usize;
            for name in exact.names(register)? {
                let bits = exact.atoms.bits(&name, width);
                let content = Content::from_bits(&bits, &exact.sums);
                exact.registers.insert(name, content);
            }
        }
        Ok(exact)
    }

    /// Returns the name of a register, or the names of all of an array's.
    fn names(&self, register: &Register) -> Known<Vec<String>> {
        match (&register.array, &register.element) {
            (Some(array), None) => {
                let one = |place| format!("{}[{place}]", register.name);
                Ok((0..self.known(&array.length)?).map(one).collect())
            }
            _ => Ok(vec![self.name(register)?]),
        }
    }

    fn name(&self, register: &Register) -> Known<String> {
        Ok(match &register.element {
            Some(element) => format!("{}[{}]", register.name, self.known(element)?),
            None => register.name.to_string(),
        })
    }

    pub(super) fn statements(&mut self, statements: &[Statement]) -> Known<()> {
        statements.iter().try_for_each(|one| self.statement(one))
    }

    fn statement(&mut self, statement: &Statement) -> Known<()> {
        let source = &statement.source;
        self.step(1)?;
        match &statement.kind {
            K::Update(place, terms) => {
                for (update, term) in terms {
                    self.update(place, *update, term, source)?;
                }
            }
            K::Swap(a, b) => self.swap([self.name(a)?, self.name(b)?], source),
            K::Call {
                path,
                inverse,
                arguments,
            } => {
                let mut registers = Vec::new();
                for (register, change, _) in arguments {
                    let names = self.names(register)?.into_iter();
                    registers.extend(names.map(|name| (name, *change)));
                }
                self.call(path, *inverse, &registers, source);
            }
            K::If(condition, holds, fails) => self.branch(condition, holds, fails)?,
            K::For {
                variable,
                bounds: [first, end],
                reversed,
                body,
            } => {
                let (first, end) = (self.known(first)?, self.known(end)?);
                let passes = (first..end).map(|pass| match reversed {
                    true => first + end - 1 - pass,
                    false => pass,
                });
                for pass in passes {
                    self.loops.push((variable.clone(), pass));
                    self.step(1)?;
                    self.statements(body)?;
                    self.loops.pop();
                }
            }
            K::Within(within, apply) => self.within(within, apply)?,
            K::Scratch(register, body) => {
                let names = self.names(register)?;
                let width = self.known(&register.format.width)? as usize;
                let begin = self.log.len();
                for name in &names {
                    self.registers.insert(name.clone(), Content::zero(width));
                }
                self.statements(body)?;
                let mut dirty = Vec::new();
                for name in &names {
                    if !self.bits(name).iter().all(Poly::is_zero) {
                        dirty.push(name.clone());
                    }
                }
                let name = &register.name;
                self.log
                    .check(begin, name, [&names, &dirty], &mut self.problems);
                for name in &names {
                    self.registers.remove(name);
                }
            }
            K::Zero(register) => {
                let name = self.name(register)?;
                let width = self.known(&register.format.width)? as usize;
                self.registers.insert(name.clone(), Content::zero(width));
                self.log.claim(name);
            }
            K::Block(body) => self.statements(body)?,
        }
        Ok(())
    }

    fn step(&mut self, steps: usize) -> Known<()> {
        self.steps += steps;
        if self.steps > MOST_STEPS {
            return Err(Unknown);
        }
        Ok(())
    }

    fn update(
        &mut self,
        place: &Place,
        update: Update,
        term: &Term,
        source: &TokenStream,
    ) -> Known<()> {
        let name = self.name(&place.register)?;
        let width = self.registers.get(&name).map_or(0, Content::width);
        let part = match &place.part {
            Some([first, bits]) => [self.known(first)? as usize, self.known(bits)? as usize],
            None => [0, width],
        };
        self.step(part[1])?;
        let added = match term {
            Term::Number(number) => self.word(number, part[1])?,
            Term::Bit(bit, _) => vec![self.bit(bit)?],
        };
        self.touch(&name, part[0]..part[0] + part[1]);
        let word = self.atoms.word(&added);
        let at = format!("{}{name}[{part:?}]", self.guards);
        let backwards = match update {
            Update::Add => Update::Subtract,
            Update::Subtract => Update::Add,
            Update::Xor => Update::Xor,
        };
        let texts = self.texts(place, [update, backwards], term);
        self.log.push(Change {
            register: name.clone(),
            done: format!("{at} {update:?} {word}"),
            undone_by: format!("{at} {backwards:?} {word}"),
            texts,
            source: source.clone(),
        });
        if update == Update::Xor {
            let mut bits = self.bits(&name);
            for (bit, added) in bits.iter_mut().skip(part[0]).zip(&added) {
                *bit = bit.xor(added);
            }
            self.rewrite(&name, &bits);
            return Ok(());
        }
        let factor = if update == Update::Add { 1 } else { u64::MAX };
        if let Some(content) = self.registers.get_mut(&name) {
            content.add(&added, factor, &self.sums);
        }
        Ok(())
    }

    /// Returns an update and its inverse as texts, which are the same in all passes of the loops
    /// around.
    fn texts(&mut self, place: &Place, updates: [Update; 2], term: &Term) -> Rc<Texts> {
        let one = |update| K::Update(place.clone(), vec![(update, term.clone())]);
        let texts = || Rc::new(updates.map(|update| super::keys::key(&one(update))));
        if self.log.again {
            // These statements are copies, which report nothing.
            return Rc::default();
        }
        let known = self.texts.entry(std::ptr::from_ref(term).addr());
        known.or_insert_with(texts).clone()
    }

    /// Replaces the bits of a register.
    fn rewrite(&mut self, name: &str, bits: &[Poly]) {
        let content = Content::from_bits(bits, &self.sums);
        self.replace(name, content);
    }

    fn replace(&mut self, name: &str, content: Content) {
        self.registers.insert(name.to_owned(), content);
        if let Some(rewritten) = self.rewritten.last_mut() {
            rewritten.insert(name.to_owned());
        }
    }

    fn swap(&mut self, [a, b]: [String; 2], source: &TokenStream) {
        let (Some(in_a), Some(in_b)) = (
            self.registers.get(&a).cloned(),
            self.registers.get(&b).cloned(),
        ) else {
            return;
        };
        let key = format!("{}swap {} {}", self.guards, (&a).min(&b), (&a).max(&b));
        for (name, content) in [(&a, in_b), (&b, in_a)] {
            self.touch(name, 0..content.width());
            self.log.push(Change {
                register: name.clone(),
                done: key.clone(),
                undone_by: key.clone(),
                texts: [key.clone(), key.clone()].into(),
                source: source.clone(),
            });
            self.replace(name, content);
        }
    }

    fn call(
        &mut self,
        path: &ExprPath,
        inverse: bool,
        arguments: &[(String, bool)],
        source: &TokenStream,
    ) {
        let of = |change: bool| {
            let chosen = arguments.iter().filter(move |(_, own)| *own == change);
            chosen.map(|(name, _)| name.clone()).collect::<Vec<_>>()
        };
        let (read, changed) = (of(false), of(true));
        let mut words = |names: &[String]| -> Vec<u32> {
            names.iter().map(|name| self.number_of(name)).collect()
        };
        let (read, before) = (words(&read), words(&changed));
        let [done, undo] = [inverse, !inverse].map(|way| text(emit::function(path, way)));
        let contents: Vec<Content> = changed
            .iter()
            .filter_map(|name| self.registers.get(name).cloned())
            .collect();
        let known = (done.clone(), read.clone(), before.clone());
        let after = self.calls.get(&known).cloned().unwrap_or_else(|| {
            let fresh = contents.iter().enumerate().map(|(place, content)| {
                let name = format!("{done} {read:?} {before:?} {place}");
                Content::from_bits(&self.atoms.bits(&name, content.width()), &self.sums)
            });
            fresh.collect()
        });
        for (name, content) in changed.iter().zip(after) {
            self.replace(name, content);
        }
        let end: Vec<u32> = changed.iter().map(|name| self.number_of(name)).collect();
        self.calls
            .insert((undo.clone(), read.clone(), end.clone()), contents);
        for name in changed {
            self.log.push(Change {
                register: name,
                done: format!("{}{done} {read:?} {before:?}", self.guards),
                undone_by: format!("{}{undo} {read:?} {end:?}", self.guards),
                texts: [done.clone(), undo.clone()].into(),
                source: source.clone(),
            });
        }
    }

    fn branch(&mut self, condition: &Bit, holds: &[Statement], fails: &[Statement]) -> Known<()> {
        let condition = self.bit(condition)?;
        if let Some(value) = condition.known() {
            return self.statements(if value { holds } else { fails });
        }
        let (atom, value) = condition.as_guard(&mut self.atoms);
        let before = self.registers.clone();
        let around = self.guards.clone();
        let mut ends = Vec::new();
        self.rewritten.push(BTreeSet::new());
        for (value, body) in [(value, holds), (!value, fails)] {
            let start = before
                .iter()
                .map(|(name, content)| (name.clone(), content.with(atom, value, &self.sums)));
            let start: BTreeMap<String, Content> = start.collect();
            self.step(if body.is_empty() { 0 } else { start.len() })?;
            self.registers.clone_from(&start);
            self.guards = format!("{around}{atom}={value} ");
            self.statements(body)?;
            ends.push((value, start, std::mem::take(&mut self.registers)));
        }
        self.guards = around;
        self.registers.clone_from(&before);
        let rewritten = self.rewritten.pop().unwrap_or_default();
        for (name, own) in before {
            let states = ends
                .iter()
                .map(|(value, start, end)| (*value, &start[&name], &end[&name]));
            let states: Vec<(bool, &Content, &Content)> = states.collect();
            if states.iter().all(|(_, start, end)| start == end) {
                continue;
            }
            if !rewritten.contains(&name) {
                let mut content = own;
                for (value, start, end) in states {
                    let guard = (atom, value);
                    content.add_difference([start, end], guard, &mut self.atoms, &self.sums);
                }
                self.registers.insert(name, content);
                continue;
            }
            let mut on_and_off = [true, false].map(|value| {
                let mut all = states.iter();
                let end = all.find(|(own, ..)| *own == value).map(|(_, _, end)| *end);
                end.map_or_else(Vec::new, |end| end.bits(&mut self.atoms, &mut self.sums))
            });
            let guard = Poly::atom(atom);
            let [on, off] = &mut on_and_off;
            for (off, on) in off.iter_mut().zip(on) {
                *off = off.xor(&guard.and(&on.xor(off), &mut self.atoms));
            }
            let [_, merged] = on_and_off;
            self.rewrite(&name, &merged);
        }
        Ok(())
    }

    fn within(&mut self, within: &[Statement], apply: &[Statement]) -> Known<()> {
        self.touched.push(BTreeSet::new());
        self.statements(within)?;
        let touched = self.touched.pop().unwrap_or_default();
        if let Some(around) = self.touched.last_mut() {
            around.extend(touched.iter().cloned());
        }
        let computed = self.registers.clone();
        let begin = self.log.len();
        self.statements(apply)?;
        let mut changed = BTreeSet::new();
        for (name, before) in &computed {
            let before = before.bits(&mut self.atoms, &mut self.sums);
            let after = self.bits(name);
            let mut bits = before.iter().zip(&after).enumerate();
            if bits.any(|(place, (a, b))| a != b && touched.contains(&(name.clone(), place))) {
                changed.insert(name.clone());
            }
        }
        for name in changed {
            self.log.changed_in_apply(begin, &name, &mut self.problems);
            // One report is enough: the register gets its old content back.
            self.replace(&name, computed[&name].clone());
        }
        let again = std::mem::replace(&mut self.log.again, true);
        self.statements(&inverse(within))?;
        self.log.again = again;
        Ok(())
    }

    fn touch(&mut self, register: &str, bits: std::ops::Range<usize>) {
        if let Some(touched) = self.touched.last_mut() {
            touched.extend(bits.map(|bit| (register.to_owned(), bit)));
        }
    }

    fn bits(&mut self, register: &str) -> Vec<Poly> {
        let content = self.registers.get(register);
        content.map_or_else(Vec::new, |content| {
            content.bits(&mut self.atoms, &mut self.sums)
        })
    }
}
