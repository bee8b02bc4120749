//! Statements: their changes, and the check that these can be undone.

use super::advice;
use super::dim::Linear;
use super::ir::{Bit, Place, Register, Statement, StatementKind as K};
use super::scope::Scope;
use super::signature;
use super::source::{bare, begin, text};
use proc_macro2::TokenStream;
use qrt_syntax::codes;
use quote::{ToTokens, quote};
use std::rc::Rc;
use syn::{BinOp, Block, Expr, Ident, Local, Pat, Stmt, StmtMacro, Type};

impl Scope {
    /// Reads a block. Its scratch registers are known up to its end.
    pub(super) fn block(&mut self, block: &Block) -> Vec<Statement> {
        let around = std::mem::replace(&mut self.block, self.registers.len());
        let statements = self.statements(&block.stmts);
        self.block = around;
        statements
    }

    fn statements(&mut self, statements: &[Stmt]) -> Vec<Statement> {
        let known = self.registers.len();
        let mut done = Vec::new();
        let mut rest = statements;
        while let [first, others @ ..] = rest {
            rest = others;
            match first {
                Stmt::Local(local) => {
                    let Some(register) = self.scratch(local) else {
                        self.unusable.extend(declared(&local.pat));
                        continue;
                    };
                    let register = Rc::new(register);
                    self.registers.push(register.clone());
                    let body = self.statements(rest);
                    done.push(Statement {
                        kind: K::Scratch(register, body),
                        source: quote!(#local),
                    });
                    break;
                }
                Stmt::Macro(call) => {
                    let (paired, taken) = self.macros(call, others);
                    rest = &others[taken..];
                    done.extend(paired);
                }
                Stmt::Item(item) => {
                    let message = "an item cannot stand inside a reversible function";
                    let help = "write it outside";
                    self.problems.add(codes::REV_STATEMENT, item, message, help);
                }
                Stmt::Expr(expression, _) => done.extend(self.statement(expression)),
            }
        }
        self.registers.truncate(known);
        done
    }

    fn scratch(&mut self, local: &Local) -> Option<Register> {
        let Pat::Type(typed) = &local.pat else {
            return self.no_scratch(&local.pat, "a scratch register needs a format");
        };
        let Pat::Ident(name) = &*typed.pat else {
            return self.no_scratch(&typed.pat, "a scratch register needs a name");
        };
        let Some(init) = &local.init else {
            return self.no_scratch(local, "a scratch register begins as 0");
        };
        let value = &init.expr;
        let begin = match (&**value, &*typed.ty) {
            (Expr::Repeat(all), Type::Array(_)) => &all.expr,
            _ => value,
        };
        let zero = super::scope::integer(begin) == Some(0)
            || matches!(&**begin, Expr::Lit(lit) if quote!(#lit).to_string() == "false");
        if !zero || init.diverge.is_some() {
            return self.no_scratch(value, "a scratch register begins as 0");
        }
        if name.mutability.is_none() {
            return self.no_scratch(name, "a scratch register is there to be changed");
        }
        let name = name.ident.clone();
        self.check_free(&name);
        let constants = self.constants.clone();
        let (demands, problems) = (&mut self.demands, &mut self.problems);
        let (array, ty) = signature::array(&typed.ty, &constants, demands, problems)?;
        let format = signature::format(ty, &constants, demands, problems)?;
        Some(Register {
            name,
            ty: ty.clone(),
            array,
            element: None,
            computed: signature::computed(ty, &format, &constants),
            format,
            parameter: false,
            mutable: true,
        })
    }

    /// Reports a declaration that is not one of a scratch register.
    #[cfg_attr(test, track_caller)]
    fn no_scratch<T>(&mut self, place: impl ToTokens, message: &str) -> Option<T> {
        let help = "write `let mut t: UInt<8> = 0;`";
        self.problems.add(codes::REV_SCRATCH, place, message, help);
        None
    }

    /// Reads `within! { .. } apply! { .. }`. Returns the statement, and the number of statements
    /// after the first that it takes.
    fn macros(&mut self, call: &StmtMacro, others: &[Stmt]) -> (Option<Statement>, usize) {
        let path = &call.mac.path;
        let pair = "write `within! { .. } apply! { .. }`";
        if path.is_ident("assert_zero") {
            return (self.zero(call), 0);
        }
        if !path.is_ident("within") {
            let (code, message, help) = if path.is_ident("apply") {
                (
                    codes::REV_PAIR,
                    "`apply!` without a `within!` before it",
                    pair,
                )
            } else {
                let help =
                    "only `within! { .. } apply! { .. }` and `assert_zero!(t)` can stand here";
                (codes::REV_CALL, "a macro is not reversible", help)
            };
            self.problems.add(code, path, message, help);
            return (None, 0);
        }
        let apply = match others {
            [Stmt::Macro(apply), ..] if apply.mac.path.is_ident("apply") => apply,
            _ => {
                let message = "`within!` without an `apply!` after it";
                self.problems.add(codes::REV_PAIR, path, message, pair);
                return (None, 0);
            }
        };
        let mut part = |call: &StmtMacro| match call.mac.parse_body_with(Block::parse_within) {
            Ok(stmts) => self.block(&Block {
                brace_token: syn::token::Brace::default(),
                stmts,
            }),
            Err(error) => {
                self.problems.raw(&error);
                Vec::new()
            }
        };
        let (within, apply_part) = (part(call), part(apply));
        let statement = Statement {
            kind: K::Within(within, apply_part),
            source: quote!(#path),
        };
        (Some(statement), 1)
    }

    /// Reads `assert_zero!(t)`.
    fn zero(&mut self, call: &StmtMacro) -> Option<Statement> {
        let tokens = &call.mac.tokens;
        let name = syn::parse2::<Ident>(tokens.clone()).ok();
        let own = self.registers[self.block.min(self.registers.len())..].iter();
        let mut own = own.filter(|known| !known.parameter && !known.is_array());
        let register = name.and_then(|name| own.find(|known| known.name == name).cloned());
        let Some(register) = register else {
            let message = "a claim of 0 is of a scratch register of the same block";
            let help = "write `assert_zero!(t);` in the block of `let mut t: UInt<8> = 0;`";
            if tokens.is_empty() {
                self.problems
                    .add(codes::REV_ZERO, &call.mac.path, message, help);
            } else {
                self.problems.add(codes::REV_ZERO, tokens, message, help);
            }
            return None;
        };
        let kind = K::Zero(register);
        let source = quote!(#call);
        Some(Statement { kind, source })
    }

    fn statement(&mut self, expression: &Expr) -> Option<Statement> {
        let source = quote!(#expression);
        self.here = begin(&source);
        let kind = match expression {
            Expr::Binary(binary) => return self.update(binary, source),
            Expr::Call(call) => return self.call(call, source),
            Expr::MethodCall(call) => return self.method(call, source),
            Expr::If(branch) => self.branch(branch)?,
            Expr::ForLoop(turns) => self.turns(turns)?,
            Expr::Block(block) if block.label.is_none() => K::Block(self.block(&block.block)),
            Expr::Macro(call) => {
                let call = StmtMacro {
                    attrs: Vec::new(),
                    mac: call.mac.clone(),
                    semi_token: None,
                };
                return self.macros(&call, &[]).0;
            }
            _ => {
                self.no_statement(expression);
                return None;
            }
        };
        Some(Statement { kind, source })
    }

    fn no_statement(&mut self, expression: &Expr) {
        let (code, place, message, help) = match expression {
            Expr::Assign(assign) => {
                let left = bare(&assign.left);
                let help = advice::assignment(&left, &assign.right, self.is_bit(&assign.left));
                let place = assign.eq_token.to_token_stream();
                let message = format!("an assignment forgets what was in `{left}`");
                self.problems
                    .add(codes::REV_ASSIGNMENT, place, &message, &help);
                return;
            }
            Expr::Return(_) | Expr::Break(_) | Expr::Continue(_) | Expr::Try(_) => {
                self.not_an_expression(expression);
                return;
            }
            Expr::While(turns) => {
                let place = turns.while_token.to_token_stream();
                let message = "how often this runs is not known where the routine is compiled";
                (
                    codes::REV_LOOP,
                    place,
                    message,
                    "write `for i in 0..8`, with constant bounds",
                )
            }
            Expr::Loop(turns) => {
                let place = turns.loop_token.to_token_stream();
                let message = "how often this runs is not known where the routine is compiled";
                (
                    codes::REV_LOOP,
                    place,
                    message,
                    "write `for i in 0..8`, with constant bounds",
                )
            }
            Expr::Match(choice) => (
                codes::REV_STATEMENT,
                choice.match_token.to_token_stream(),
                "`match` has no inverse",
                "write `if` on bits or comparisons",
            ),
            Expr::Closure(_) => (
                codes::REV_STATEMENT,
                quote!(#expression),
                "a closure has no inverse",
                "write the statements where they run, or a reversible function",
            ),
            Expr::Reference(_) => (
                codes::REV_STATEMENT,
                quote!(#expression),
                "a reference changes nothing",
                "`&` and `&mut` stand in calls only",
            ),
            _ => (
                codes::REV_STATEMENT,
                quote!(#expression),
                "this statement changes no register",
                "write an update such as `a += b`, `if`, `for`, a call or a block",
            ),
        };
        self.problems.add(code, place, message, help);
    }

    fn update(&mut self, binary: &syn::ExprBinary, source: TokenStream) -> Option<Statement> {
        use super::ir::Update::{Add, Subtract, Xor};
        let update = match binary.op {
            BinOp::AddAssign(_) => Add,
            BinOp::SubAssign(_) => Subtract,
            BinOp::BitXorAssign(_) => Xor,
            operator => {
                self.no_update(binary, operator);
                return None;
            }
        };
        let target = self.place(&binary.left)?;
        self.may_change(&target, &binary.left);
        let whole = target.part.is_none() && target.register.format.width.known() != Some(1);
        if update != Xor
            && !whole
            && !(target.part.is_none() && target.register.format.kind != super::ir::Kind::Bool)
        {
            let shown = text(&binary.left);
            let message = format!("a carry would leave `{shown}`");
            let help = format!("write `{shown} ^= ..`, or add to the whole register");
            self.problems
                .add(codes::REV_OPERATOR, binary.op, &message, &help);
            return None;
        }
        self.fraction = target.register.format.fraction.known();
        self.updated = Some(binary.clone());
        let is_bit = self.is_bit(&binary.left);
        let kind = if update == Xor && !is_bit && self.is_bitwise(&binary.right) {
            self.bitwise(&target, &binary.right, &source)
        } else {
            let terms = self.terms(update, &target, &binary.right);
            terms.map(|terms| K::Update(target.clone(), terms))
        };
        self.fraction = None;
        self.updated = None;
        self.writes.push((target, quote!(#binary)));
        let kind = kind?;
        Some(Statement { kind, source })
    }

    fn no_update(&mut self, binary: &syn::ExprBinary, operator: BinOp) {
        let shown = text(operator);
        let Some(help) = advice::no_update(binary) else {
            let message = "this statement changes no register";
            let help = "write an update such as `a += b`";
            self.problems
                .add(codes::REV_STATEMENT, binary, message, help);
            return;
        };
        let message = match operator {
            BinOp::MulAssign(_) => format!("`{shown}` has no inverse: 0 times anything is 0"),
            _ => format!("`{shown}` has no inverse: it forgets bits"),
        };
        self.problems
            .add(codes::REV_OPERATOR, operator, &message, &help);
    }

    #[cfg_attr(test, track_caller)]
    pub(super) fn may_change(&mut self, target: &Place, source: impl ToTokens) {
        if !target.register.mutable {
            let name = &target.register.name;
            let ty = target.register.type_text();
            let message = format!("`{name}` can only be read");
            let help = format!("take it as `{name}: &mut {ty}`");
            self.problems
                .add(codes::REV_READ_ONLY, source, &message, &help);
        }
    }

    fn branch(&mut self, branch: &syn::ExprIf) -> Option<K> {
        let condition = self.bit(&branch.cond);
        if let Some(Bit::Constant(_)) = condition {
            let message = "this condition is the same on every path";
            let help = "write the branch itself, or leave it out";
            self.problems
                .add(codes::REV_NOT_A_BIT, &branch.cond, message, help);
        }
        let before = self.writes.len();
        let holds = self.block(&branch.then_branch);
        let fails = match branch.else_branch.as_ref().map(|(_, fails)| &**fails) {
            Some(Expr::Block(block)) => self.block(&block.block),
            Some(other) => self.statement(other).into_iter().collect(),
            None => Vec::new(),
        };
        let condition = condition?;
        let mut reads = Vec::new();
        condition.reads(&mut |place| reads.push(place));
        for place in before..self.writes.len() {
            let (written, source) = self.writes[place].clone();
            if let Some(read) = reads.iter().find(|read| !self.apart(read, &written)) {
                let shown = text(&branch.cond);
                let message = format!("`{}` decides whether this runs", read.register);
                let help = format!(
                    "write `flag ^= {shown}; if flag {{ .. }}`, with a parameter `flag: &mut Bool` \
                     that tells the caller which way it went"
                );
                self.problems
                    .add(codes::REV_CONDITION, source, &message, &help);
            }
        }
        Some(K::If(condition, holds, fails))
    }

    fn turns(&mut self, turns: &syn::ExprForLoop) -> Option<K> {
        let help = "write `for i in 0..8` or `for i in (0..8).rev()`, with constant bounds";
        let variable = match &*turns.pat {
            Pat::Ident(name) => name.ident.clone(),
            Pat::Wild(wild) => Ident::new("_", wild.underscore_token.span),
            pattern => {
                let message = "a loop's variable is a single name";
                self.problems.add(codes::REV_LOOP, pattern, message, help);
                return None;
            }
        };
        let (range, reversed) = match &*turns.expr {
            Expr::MethodCall(call) if call.method == "rev" && call.args.is_empty() => {
                (&*call.receiver, true)
            }
            other => (other, false),
        };
        let mut range = range;
        while let Expr::Paren(inner) = range {
            range = &inner.expr;
        }
        let before = self.problems.count();
        let bounds = match range {
            Expr::Range(range) => self.bounds(range),
            _ => None,
        };
        let Some(bounds) = bounds else {
            if self.problems.count() == before {
                let message = "how often this runs is not known where the routine is compiled";
                self.problems
                    .add(codes::REV_LOOP, &turns.expr, message, help);
            }
            return None;
        };
        if variable != "_" {
            self.check_free(&variable);
        }
        self.loops.push((variable.clone(), bounds.clone()));
        self.check_passes(&turns.expr);
        let body = self.block(&turns.body);
        self.loops.pop();
        Some(K::For {
            variable,
            bounds,
            reversed,
            body,
        })
    }

    /// Reports more passes of the loops around than a program could hold: each pass becomes
    /// operations of its own.
    fn check_passes(&mut self, place: &Expr) {
        const MOST: i64 = 1_000_000;
        let around = self.loops.clone();
        let passes: Vec<Linear> = around
            .iter()
            .map(|(_, [first, end])| self.least(&first.minus(end)).times(-1))
            .collect();
        let known: Option<Vec<i64>> = passes.iter().map(Linear::known).collect();
        let Some(known) = known else {
            let message = "QRT0811: a loop of more than 1,000,000 passes";
            if let [(_, [first, end])] = &around[..] {
                self.holds(&end.minus(first).times(-1).plus(&MOST.into()), message);
            } else {
                let message = "QRT0811: loops within loops of more than 1,000,000 passes in all";
                let passes = passes.iter().map(Linear::signed_tokens);
                let product = quote!({
                    let mut __all: ::core::primitive::i64 = 1;
                    #({
                        let __passes = #passes;
                        __all = __all.saturating_mul(if __passes > 0 { __passes } else { 0 });
                    })*
                    __all <= #MOST
                });
                self.demand(product, message);
            }
            return;
        };
        let all = known
            .into_iter()
            .fold(1_i64, |all, passes| all.saturating_mul(passes.max(0)));
        if all > MOST {
            let message = format!("{all} passes, each of which becomes gates of its own");
            let help = "write loops of 1,000,000 passes or fewer, and call the function again";
            self.problems.add(codes::REV_LOOP, place, &message, help);
        }
    }

    fn bounds(&mut self, range: &syn::ExprRange) -> Option<[Linear; 2]> {
        let start = self.linear(range.start.as_ref()?)?;
        let end = self.linear(range.end.as_ref()?)?;
        Some(match range.limits {
            syn::RangeLimits::HalfOpen(_) => [start, end],
            syn::RangeLimits::Closed(_) => [start, end.plus(&1.into())],
        })
    }
}

/// Returns the name that a declaration gives.
fn declared(pattern: &Pat) -> Option<Ident> {
    match pattern {
        Pat::Ident(name) => Some(name.ident.clone()),
        Pat::Type(typed) => declared(&typed.pat),
        _ => None,
    }
}
