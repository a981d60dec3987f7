//! Scalar expressions as Rust, in two dialects: plain `f64`, and SIMD lanes where every number is one per element.

use std::collections::{BTreeMap, BTreeSet};

use super::ident;
use crate::lower::{Lowering, SymbolKind};
use crate::scalar::schedule::{Schedule, Stage};
use crate::scalar::{Binary, Id, Node, Pool, Rational, Relation, Unary};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// What numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// `f64`.
    Plain,
    /// `Lane<S>`, with the token `s` in scope.
    Lanes,
}

/// How tightly a printed formula binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    /// `if`: binds nothing.
    Choice,
    Sum,
    Product,
    Prefix,
    Postfix,
}

type Formula = (TokenStream, Binding);

/// Names for the inputs and statements of one function.
#[derive(Debug)]
pub struct Names {
    taken: BTreeSet<String>,
    statements: BTreeMap<Id, Ident>,
    symbols: BTreeMap<SymbolKind, Ident>,
    temporaries: usize,
}

impl Names {
    /// No names but those in scope anyway.
    pub fn new(taken: &[&str]) -> Names {
        Names {
            taken: taken.iter().map(|name| (*name).to_owned()).collect(),
            statements: BTreeMap::new(),
            symbols: BTreeMap::new(),
            temporaries: 0,
        }
    }

    /// The name of a symbol.
    pub fn symbol(&mut self, lowering: &Lowering<'_>, kind: SymbolKind) -> Ident {
        if let Some(name) = self.symbols.get(&kind) {
            return name.clone();
        }
        let name = self.unused(&crate::lower::symbol_name(lowering, kind));
        self.symbols.insert(kind, name.clone());
        name
    }

    /// Gives a symbol a name that is in scope already.
    pub fn set_symbol(&mut self, kind: SymbolKind, name: Ident) {
        self.symbols.insert(kind, name);
    }

    /// Names a statement after its hint, or with the next number.
    fn statement(&mut self, lowering: &Lowering<'_>, id: Id) -> Ident {
        let name = match lowering.hints.get(&id) {
            Some(hint) => self.unused(hint),
            None => {
                self.temporaries += 1;
                self.unused(&format!("t{}", self.temporaries))
            }
        };
        self.statements.insert(id, name.clone());
        name
    }

    /// The name of a statement, if it has one.
    pub fn statement_name(&self, id: Id) -> Option<Ident> {
        self.statements.get(&id).cloned()
    }

    /// The name under which a node is read: that of its statement or symbol.
    pub fn name_of(&self, lowering: &Lowering<'_>, id: Id) -> Option<Ident> {
        match lowering.pool.node(id) {
            Node::Input(symbol) => self.symbols.get(&lowering.symbols.kind(symbol)).cloned(),
            _ => self.statement_name(id),
        }
    }

    /// `name`, or `name_2` and so on where that is taken.
    pub fn unused(&mut self, name: &str) -> Ident {
        let mut numbered = name.to_owned();
        let mut number = 1;
        while !self.taken.insert(numbered.clone()) {
            number += 1;
            numbered = format!("{name}_{number}");
        }
        ident(&numbered)
    }
}

/// Prints formulas of one schedule.
#[derive(Clone, Copy, Debug)]
pub struct Printer<'a, 'm> {
    /// Pool and symbols.
    pub lowering: &'a Lowering<'m>,
    /// Which nodes have names.
    pub schedule: &'a Schedule,
    /// What numbers are.
    pub dialect: Dialect,
}

impl Printer<'_, '_> {
    /// `let` statements of a stage.
    pub fn statements(&self, stage: Stage, names: &mut Names) -> Vec<TokenStream> {
        let mut statements = Vec::new();
        for &id in self.schedule.statements(stage) {
            let formula = self.node(id, names).0;
            let name = names.statement(self.lowering, id);
            statements.push(quote!(let #name = #formula;));
        }
        statements
    }

    /// The value of a node where it is used: its name, or its formula.
    pub fn value(&self, id: Id, names: &Names) -> TokenStream {
        self.used(id, names).0
    }

    fn pool(&self) -> &Pool {
        &self.lowering.pool
    }

    fn used(&self, id: Id, names: &Names) -> Formula {
        match names.statements.get(&id) {
            Some(name) => (quote!(#name), Binding::Postfix),
            None => self.node(id, names),
        }
    }

    /// In parentheses where it binds less tightly than asked for.
    fn bound(&self, id: Id, names: &Names, least: Binding) -> TokenStream {
        let (formula, binding) = self.used(id, names);
        if binding < least { quote!((#formula)) } else { formula }
    }

    fn node(&self, id: Id, names: &Names) -> Formula {
        match self.pool().node(id) {
            Node::Const(value) => self.constant(value),
            Node::Input(symbol) => {
                let kind = self.lowering.symbols.kind(symbol);
                let name = names
                    .symbols
                    .get(&kind)
                    .cloned()
                    .unwrap_or_else(|| ident(&crate::lower::symbol_name(self.lowering, kind)));
                (quote!(#name), Binding::Postfix)
            }
            Node::Unary(Unary::Neg, x) => {
                let x = self.bound(x, names, Binding::Prefix);
                (quote!(-#x), Binding::Prefix)
            }
            Node::Unary(op, x) => {
                let (x, method) = (self.bound(x, names, Binding::Postfix), ident(op.name()));
                (quote!(#x.#method()), Binding::Postfix)
            }
            Node::Binary(op, x, y) => self.binary(id, op, [x, y], names),
            Node::Power(x, exponent) => (self.power(x, exponent, names), Binding::Postfix),
            Node::Select { relation, lhs, rhs, then, otherwise } => {
                self.select(relation, [lhs, rhs], [then, otherwise], names)
            }
        }
    }

    fn constant(&self, value: f64) -> Formula {
        let number = number(value);
        match self.dialect {
            Dialect::Lanes => (quote!(Lane::splat(s, #number)), Binding::Postfix),
            Dialect::Plain if value < 0.0 => (number, Binding::Prefix),
            Dialect::Plain => (number, Binding::Postfix),
        }
    }

    fn binary(&self, id: Id, op: Binary, [x, y]: [Id; 2], names: &Names) -> Formula {
        if let Some((x, y)) = self.schedule.quotient(self.pool(), id) {
            let (x, y) = (self.bound(x, names, Binding::Product), self.bound(y, names, Binding::Prefix));
            return (quote!(#x / #y), Binding::Product);
        }
        if let Some(fused) = self.fused(op, [x, y], names) {
            return fused;
        }
        let infix = |sign: TokenStream, left: Binding, right: Binding| {
            let (x, y) = (self.bound(x, names, left), self.bound(y, names, right));
            quote!(#x #sign #y)
        };
        match op {
            Binary::Add => (infix(quote!(+), Binding::Sum, Binding::Product), Binding::Sum),
            Binary::Sub => (infix(quote!(-), Binding::Sum, Binding::Product), Binding::Sum),
            Binary::Mul => (infix(quote!(*), Binding::Product, Binding::Prefix), Binding::Product),
            Binary::Div => (infix(quote!(/), Binding::Product, Binding::Prefix), Binding::Product),
            Binary::Pow | Binary::Min | Binary::Max | Binary::Atan2 => {
                let (x, y) = (self.receiver(x, names), self.value(y, names));
                let method = ident(if op == Binary::Pow { "powf" } else { op.name() });
                (quote!(#x.#method(#y)), Binding::Postfix)
            }
        }
    }

    /// A receiver of a method; a bare literal would have no type.
    fn receiver(&self, id: Id, names: &Names) -> TokenStream {
        match (self.pool().as_constant(id), self.dialect) {
            (Some(value), Dialect::Plain) => {
                let literal = Literal::f64_suffixed(value.abs());
                if value < 0.0 { quote!((-#literal)) } else { quote!(#literal) }
            }
            _ => self.bound(id, names, Binding::Postfix),
        }
    }

    /// A sum with an unnamed product, as one fused operation of lanes.
    fn fused(&self, op: Binary, [x, y]: [Id; 2], names: &Names) -> Option<Formula> {
        if self.dialect == Dialect::Plain {
            return None;
        }
        let product = |id: Id| match self.pool().node(id) {
            Node::Binary(Binary::Mul, a, b) if !names.statements.contains_key(&id) => {
                self.schedule.quotient(self.pool(), id).is_none().then_some((a, b))
            }
            _ => None,
        };
        let postfix = |id| self.bound(id, names, Binding::Postfix);
        let negated = |id| match self.pool().as_constant(id) {
            Some(value) => self.constant(-value).0,
            None => {
                let x = self.bound(id, names, Binding::Prefix);
                quote!((-#x))
            }
        };
        let formula = match (op, product(x), product(y)) {
            (Binary::Add, _, Some((a, b))) => {
                let (a, b, x) = (postfix(a), self.value(b, names), self.value(x, names));
                quote!(#a.mul_add(#b, #x))
            }
            (Binary::Add, Some((a, b)), None) => {
                let (a, b, y) = (postfix(a), self.value(b, names), self.value(y, names));
                quote!(#a.mul_add(#b, #y))
            }
            (Binary::Sub, _, Some((a, b))) => {
                let (a, b, x) = (negated(a), self.value(b, names), self.value(x, names));
                quote!(#a.mul_add(#b, #x))
            }
            (Binary::Sub, Some((a, b)), None) => {
                let (a, b, y) = (postfix(a), self.value(b, names), self.bound(y, names, Binding::Prefix));
                quote!(#a.mul_add(#b, -#y))
            }
            _ => return None,
        };
        Some((formula, Binding::Postfix))
    }

    fn power(&self, x: Id, exponent: Rational, names: &Names) -> TokenStream {
        let base = self.receiver(x, names);
        let (n, d) = (exponent.numerator(), exponent.denominator());
        let (n_literal, d_literal) = (Literal::i32_unsuffixed(n), Literal::i32_unsuffixed(d));
        match (self.dialect, exponent.as_integer()) {
            (Dialect::Plain, Some(_)) | (Dialect::Lanes, Some(_)) => quote!(#base.powi(#n_literal)),
            (Dialect::Lanes, None) => quote!(#base.rational_power(#n_literal, #d_literal)),
            (Dialect::Plain, None) => {
                let (n, d) = (number(f64::from(n)), number(f64::from(d)));
                quote!(#base.powf(#n / #d))
            }
        }
    }

    fn select(
        &self,
        relation: Relation,
        [lhs, rhs]: [Id; 2],
        [then, otherwise]: [Id; 2],
        names: &Names,
    ) -> Formula {
        let (then, otherwise) = (self.value(then, names), self.value(otherwise, names));
        if self.dialect == Dialect::Lanes {
            let (lhs, rhs) = (self.bound(lhs, names, Binding::Postfix), self.value(rhs, names));
            let method = ident(if relation == Relation::Less { "less" } else { "less_equal" });
            return (quote!(#lhs.#method(#rhs).select(#then, #otherwise)), Binding::Postfix);
        }
        if let Some(switch) = self.switch(rhs) {
            return (quote!(if switches[#switch] { #then } else { #otherwise }), Binding::Choice);
        }
        let (lhs, rhs) = (self.value(lhs, names), self.value(rhs, names));
        let sign = if relation == Relation::Less { quote!(<) } else { quote!(<=) };
        (quote!(if #lhs #sign #rhs { #then } else { #otherwise }), Binding::Choice)
    }

    /// The number of a switch, where that is what is compared.
    fn switch(&self, id: Id) -> Option<Literal> {
        match self.pool().node(id) {
            Node::Input(symbol) => match self.lowering.symbols.kind(symbol) {
                SymbolKind::Switch(number) => Some(Literal::usize_unsuffixed(number)),
                _ => None,
            },
            _ => None,
        }
    }
}

/// A number as a literal expression, with its sign; not finite ones by name.
pub fn number(value: f64) -> TokenStream {
    if value.is_nan() {
        return quote!(f64::NAN);
    }
    let magnitude = match value.abs() {
        f64::INFINITY => quote!(f64::INFINITY),
        x => literal(x),
    };
    if value.is_sign_negative() && value != 0.0 { quote!(-#magnitude) } else { magnitude }
}

/// A finite positive number or zero, in scientific notation where that is shorter.
fn literal(value: f64) -> TokenStream {
    let plain = Literal::f64_unsuffixed(value);
    let scientific = format!("{value:e}");
    match scientific.parse::<Literal>() {
        Ok(short) if short.to_string().len() + 2 < plain.to_string().len() => quote!(#short),
        _ => quote!(#plain),
    }
}
