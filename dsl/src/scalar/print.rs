//! Listings of scalar expressions, for `ansatz expand` and snapshots.

use std::fmt::Write;

use super::schedule::Schedule;
use super::{Binary, Id, Node, Pool, Symbol, Unary};

/// One line per named node, by stage, then one per root: `t12 = t3*t4`.
///
/// Statements are numbered from 0 in the order they are printed. After each stage that computes something comes its cost.
pub fn listing(
    pool: &Pool,
    roots: &[(String, Id)],
    schedule: &Schedule,
    name: &dyn Fn(Symbol) -> String,
) -> String {
    let order: Vec<Id> = schedule.stages().flat_map(|stage| schedule.statements(stage).to_vec()).collect();
    let mut numbers: Vec<(Id, usize)> = order.iter().enumerate().map(|(n, &id)| (id, n)).collect();
    numbers.sort_unstable();
    let printer = Printer { pool, schedule, numbers, name };
    let mut text = String::new();
    for stage in schedule.stages().filter(|&stage| schedule.cost(stage) > 0) {
        let _ = writeln!(text, "stage {stage}: cost {}", schedule.cost(stage)); // writing to a string cannot fail
        for &id in schedule.statements(stage) {
            let (left, right) = (printer.used(id, Place::Alone), printer.formula(id, Place::Alone));
            let _ = writeln!(text, "  {left} = {right}  // {} uses", schedule.uses(id));
        }
    }
    for (root, id) in roots {
        let _ = writeln!(text, "{root} = {}", printer.used(*id, Place::Alone));
    }
    text
}

/// What surrounds a formula, and so whether it needs parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// Nothing that binds.
    Alone,
    /// A term of a sum after which more follows.
    Sum,
    /// A factor, or what is subtracted.
    Product,
    /// A base, a divisor or what a sign stands before.
    Tight,
}

struct Printer<'a> {
    pool: &'a Pool,
    schedule: &'a Schedule,
    /// Statement numbers, sorted by id.
    numbers: Vec<(Id, usize)>,
    name: &'a dyn Fn(Symbol) -> String,
}

impl Printer<'_> {
    /// The node where it is used: its name, or its formula if it has none.
    fn used(&self, id: Id, place: Place) -> String {
        match self.numbers.binary_search_by_key(&id, |&(id, _)| id) {
            Ok(found) => format!("t{}", self.numbers[found].1),
            Err(_) => self.formula(id, place),
        }
    }

    fn formula(&self, id: Id, place: Place) -> String {
        let (text, binds) = self.bare(id);
        if binds < place { format!("({text})") } else { text }
    }

    /// The formula and the tightest place it can stand in without parentheses.
    fn bare(&self, id: Id) -> (String, Place) {
        let used = |id, place| self.used(id, place);
        if let Some((x, y)) = self.schedule.quotient(self.pool, id) {
            return (format!("{}/{}", used(x, Place::Product), used(y, Place::Tight)), Place::Product);
        }
        match self.pool.node(id) {
            Node::Const(c) => (number(c), if c < 0.0 { Place::Sum } else { Place::Tight }),
            Node::Input(symbol) => ((self.name)(symbol), Place::Tight),
            Node::Unary(Unary::Neg, x) => (format!("-{}", used(x, Place::Product)), Place::Sum),
            Node::Unary(op, x) => (format!("{}({})", op.name(), used(x, Place::Alone)), Place::Tight),
            Node::Binary(op, x, y) => self.binary(op, x, y),
            Node::Power(x, p) => (format!("{}^{p}", used(x, Place::Tight)), Place::Product),
            Node::Select { relation, lhs, rhs, then, otherwise } => {
                let [lhs, rhs, then, otherwise] = [lhs, rhs, then, otherwise].map(|x| used(x, Place::Alone));
                (
                    format!("if {lhs} {} {rhs} {{ {then} }} else {{ {otherwise} }}", relation.sign()),
                    Place::Alone,
                )
            }
        }
    }

    fn binary(&self, op: Binary, x: Id, y: Id) -> (String, Place) {
        let text = |sign: &str, left, right| format!("{}{sign}{}", self.used(x, left), self.used(y, right));
        match op {
            Binary::Add => (text(" + ", Place::Sum, Place::Sum), Place::Sum),
            Binary::Sub => (text(" - ", Place::Sum, Place::Product), Place::Sum),
            Binary::Mul => (text("*", Place::Product, Place::Product), Place::Product),
            Binary::Div => (text("/", Place::Product, Place::Tight), Place::Product),
            Binary::Pow | Binary::Min | Binary::Max | Binary::Atan2 => {
                let arguments = text(", ", Place::Alone, Place::Alone);
                (format!("{}({arguments})", op.name()), Place::Tight)
            }
        }
    }
}

/// Shortest decimal that reads back as the same number, with an exponent where that saves zeros.
fn number(value: f64) -> String {
    let plain = value == 0.0 || (1e-4..1e9).contains(&value.abs());
    if plain { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Rational, Relation};

    /// The listing of one root in the symbols `a`, `b`, `c`, the last of an inner stage.
    fn of(build: impl FnOnce(&mut Pool, [Id; 3]) -> Id) -> String {
        let mut pool = Pool::new();
        let inputs = [0, 1, 2].map(|s| pool.input(Symbol(s)));
        let root = build(&mut pool, inputs);
        let schedule = Schedule::new(&pool, &[root], &|s| u8::from(s.0 == 2));
        listing(&pool, &[("r".into(), root)], &schedule, &|s| ["a", "b", "c"][s.0 as usize].into())
    }

    #[test]
    fn outer_stages_come_first_and_shared_values_have_names() {
        let text = of(|p, [a, b, c]| {
            let sum = p.add(a, b);
            let scaled = p.mul(sum, c);
            let square = p.square(scaled);
            p.div(square, c)
        });
        let expected = "stage 0: cost 1\n  t0 = a + b  // 1 uses\nstage 1: cost 10\n  t1 = c*t0  // 2 uses\nr = t1*t1/c\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn parentheses_stand_where_the_value_needs_them() {
        let formula = |build: fn(&mut Pool, [Id; 3]) -> Id| {
            let text = of(build);
            text.lines().last().unwrap_or_default().to_owned()
        };
        assert_eq!(
            formula(|p, [_, _, c]| {
                let one = p.one();
                let sum = p.add(one, c);
                p.power(sum, Rational::MINUS_THIRD)
            }),
            "r = (1 + c)^(-1/3)"
        );
        assert_eq!(
            formula(|p, [a, _, c]| {
                let choice = p.select(Relation::Less, a, c, a, c);
                p.mul(a, choice)
            }),
            "r = a*(if a < c { a } else { c })"
        );
        assert_eq!(
            formula(|p, [a, b, c]| {
                let product = p.mul(a, c);
                let difference = p.sub(product, c);
                p.sub(b, difference)
            }),
            "r = b - (a*c - c)"
        );
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([2.0, -0.5, 1.381e-23, 0.0].map(number), ["2", "-0.5", "1.381e-23", "0"]);
    }
}
