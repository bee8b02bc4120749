//! Statements: their changes, and the check that these can be undone.

use super::dim::Linear;
use super::ir::{Bit, Place, Register, Statement, StatementKind as K};
use super::scope::Scope;
use super::signature;
use super::source::{bare, begin, text};
use proc_macro2::TokenStream;
use qrt_scene::syntax::codes;
use quote::{ToTokens, quote};
use std::rc::Rc;
use syn::{BinOp, Block, Expr, Ident, Local, Pat, Stmt, StmtMacro, Type};

impl Scope {
    /// Reads a block. Its scratch registers are known up to its end.
    pub(super) fn block(&mut self, block: &Block) -> Vec<Statement> {
        self.statements(&block.stmts)
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
        if let Some(attribute) = local.attrs.first() {
            self.no_attribute(attribute);
        }
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
        if !path.is_ident("within") {
            let (code, message, help) = if path.is_ident("apply") {
                (
                    codes::REV_PAIR,
                    "`apply!` without a `within!` before it",
                    pair,
                )
            } else {
                let help = "only `within! { .. } apply! { .. }` can stand here";
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
            Ok(statements) => self.statements(&statements),
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

    fn statement(&mut self, expression: &Expr) -> Option<Statement> {
        let source = quote!(#expression);
        self.here = begin(&source);
        if let Some(attribute) = attribute(&source) {
            self.no_attribute(attribute);
            return None;
        }
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
                self.macros(&call, &[]);
                return None;
            }
            _ => {
                self.no_statement(expression);
                return None;
            }
        };
        Some(Statement { kind, source })
    }

    #[cfg_attr(test, track_caller)]
    fn no_attribute(&mut self, attribute: impl ToTokens) {
        let message = "a reversible function's statements take no attributes";
        let help = "put attributes on the function";
        self.problems
            .add(codes::REV_STATEMENT, attribute, message, help);
    }

    fn no_statement(&mut self, expression: &Expr) {
        let (code, place, message, help) = match expression {
            Expr::Assign(assign) => {
                let (left, right) = (bare(&assign.left), bare(&assign.right));
                let help = format!("write `{left} ^= {right}`, `+=` or `-=`");
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
        let terms = self.terms(update, &target, &binary.right);
        self.fraction = None;
        self.writes.push((target.clone(), quote!(#binary)));
        let kind = K::Update(target, terms?);
        Some(Statement { kind, source })
    }

    fn no_update(&mut self, binary: &syn::ExprBinary, operator: BinOp) {
        let (left, right) = (bare(&binary.left), bare(&binary.right));
        let shown = text(operator);
        let (message, help) = match operator {
            BinOp::MulAssign(_) => (
                format!("`{shown}` has no inverse: 0 times anything is 0"),
                format!("write `out += {left} * {right}` into a register that is 0 before"),
            ),
            BinOp::DivAssign(_) | BinOp::RemAssign(_) | BinOp::ShrAssign(_) => (
                format!("`{shown}` has no inverse: it forgets bits"),
                format!("for a power of two, write `out += {left} >> n` into another register"),
            ),
            BinOp::ShlAssign(_) => (
                format!("`{shown}` has no inverse: it forgets bits"),
                format!("write `out += {left} << {right}` into another register"),
            ),
            BinOp::BitAndAssign(_) | BinOp::BitOrAssign(_) => (
                format!("`{shown}` has no inverse: it forgets bits"),
                format!("write `out ^= {left} & {right}` into a bit that is 0 before"),
            ),
            _ => {
                let message = "this statement changes no register";
                let help = "write an update such as `a += b`";
                self.problems
                    .add(codes::REV_STATEMENT, binary, message, help);
                return;
            }
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
                let help =
                    format!("change it after the `if`, or copy `{shown}` into a scratch register");
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
                    let mut all: ::core::primitive::i64 = 1;
                    #({
                        let passes = #passes;
                        all = all.saturating_mul(if passes > 0 { passes } else { 0 });
                    })*
                    all <= #MOST
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

/// Returns the attribute that source text begins with.
fn attribute(source: &TokenStream) -> Option<TokenStream> {
    let mut tokens = source.clone().into_iter();
    let sign = tokens.next().filter(|first| first.to_string() == "#")?;
    let body = tokens.next();
    Some(quote!(#sign #body))
}

/// Returns the name that a declaration gives.
fn declared(pattern: &Pat) -> Option<Ident> {
    match pattern {
        Pat::Ident(name) => Some(name.ident.clone()),
        Pat::Type(typed) => declared(&typed.pat),
        _ => None,
    }
}
