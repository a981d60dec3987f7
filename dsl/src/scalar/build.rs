//! Constructors of scalar expressions; each simplifies what it can see one or two levels down.
//!
//! Normal form, chosen so that derivatives share work:
//! - constants are folded when the result is finite and stand first; negative factors become a `Neg`;
//! - `Neg` is pulled out of products and absorbed by sums;
//! - a quotient is a product with the shared reciprocal `1/y` (one rounding more than a division); by a constant, with its inverse;
//! - an integer power is a chain of multiplications, on the shared `1/x` for a negative exponent; other powers stay whole, to be split
//!   by [`lower_powers`](super::lower_powers) before code is printed;
//! - sums take out a common factor: `a x + a y = a (x + y)`;
//! - a `Select` with a zero arm moves outwards through products, so nothing is multiplied by a value from outside its domain.
//!
//! The value agrees with that of the expression as written up to rounding, wherever the latter is finite.

use super::op::Parity;
use super::{Binary, Id, Node, Pool, Rational, Relation, Symbol, Unary};

/// Integer powers up to this become multiplications.
const LONGEST_CHAIN: u32 = 16;

impl Pool {
    /// A number.
    pub fn constant(&mut self, value: f64) -> Id {
        self.intern(Node::Const(value + 0.0)) // -0 becomes 0
    }

    /// The number 0.
    pub fn zero(&mut self) -> Id {
        self.constant(0.0)
    }

    /// The number 1.
    pub fn one(&mut self) -> Id {
        self.constant(1.0)
    }

    /// The value of a symbol.
    pub fn input(&mut self, symbol: Symbol) -> Id {
        self.intern(Node::Input(symbol))
    }

    /// A function of one argument.
    pub fn unary(&mut self, op: Unary, x: Id) -> Id {
        if let Some(id) = self.folded(self.as_constant(x).map(|c| op.value(c))) {
            return id;
        }
        match (op, self.node(x)) {
            (Unary::Neg, _) => self.neg(x),
            (Unary::Sqrt, _) => self.sqrt(x),
            (Unary::Abs, _) => self.abs(x),
            (Unary::Ln, Node::Unary(Unary::Exp, y)) => y,
            (_, Node::Unary(Unary::Neg, y)) if op.parity() == Parity::Even => self.unary(op, y),
            (_, Node::Unary(Unary::Neg, y)) if op.parity() == Parity::Odd => {
                let value = self.unary(op, y);
                self.neg(value)
            }
            _ => self.intern(Node::Unary(op, x)),
        }
    }

    /// A function of two arguments.
    pub fn binary(&mut self, op: Binary, x: Id, y: Id) -> Id {
        match op {
            Binary::Add => self.add(x, y),
            Binary::Sub => self.sub(x, y),
            Binary::Mul => self.mul(x, y),
            Binary::Div => self.div(x, y),
            Binary::Pow => self.pow(x, y),
            Binary::Min | Binary::Max if x == y => x,
            Binary::Min | Binary::Max | Binary::Atan2 => {
                self.fold_binary(op, x, y).unwrap_or_else(|| self.intern_binary(op, x, y))
            }
        }
    }

    /// `-x`
    pub fn neg(&mut self, x: Id) -> Id {
        match self.node(x) {
            Node::Const(c) => self.constant(-c),
            Node::Unary(Unary::Neg, y) => y,
            Node::Binary(Binary::Sub, y, z) => self.sub(z, y),
            Node::Binary(Binary::Add, c, y) if self.as_constant(c).is_some() => {
                let minus = self.neg(c);
                self.sub(minus, y)
            }
            _ => self.intern(Node::Unary(Unary::Neg, x)),
        }
    }

    /// `|x|`
    pub fn abs(&mut self, x: Id) -> Id {
        match self.node(x) {
            Node::Const(c) => self.constant(c.abs()),
            Node::Unary(Unary::Neg, y) => self.abs(y),
            Node::Unary(Unary::Abs | Unary::Sqrt | Unary::Exp, _) => x,
            Node::Binary(Binary::Mul, y, z) if y == z => x,
            Node::Binary(Binary::Mul, c, y) if self.as_constant(c).is_some_and(|c| c > 0.0) => {
                let y = self.abs(y);
                self.mul(c, y)
            }
            _ => self.intern(Node::Unary(Unary::Abs, x)),
        }
    }

    /// Square root; NaN for negative `x`.
    pub fn sqrt(&mut self, x: Id) -> Id {
        if let Some(id) = self.folded(self.as_constant(x).map(f64::sqrt)) {
            return id;
        }
        match self.node(x) {
            Node::Binary(Binary::Mul, y, z) if y == z => self.abs(y),
            _ => self.intern(Node::Unary(Unary::Sqrt, x)),
        }
    }

    /// `x + y`
    pub fn add(&mut self, x: Id, y: Id) -> Id {
        if let Some(id) = self.fold_binary(Binary::Add, x, y) {
            return id;
        }
        let (x, y) = self.ordered(x, y);
        match (self.node(x), self.node(y)) {
            (Node::Const(0.0), _) => return y,
            (_, Node::Unary(Unary::Neg, z)) => return self.sub(x, z),
            (Node::Unary(Unary::Neg, z), _) => return self.sub(y, z),
            (Node::Const(c), Node::Binary(op @ (Binary::Add | Binary::Sub), d, z)) => {
                if let Some(sum) = self.folded(self.as_constant(d).map(|d| c + d)) {
                    return self.binary(op, sum, z);
                }
            }
            _ => {}
        }
        self.collected(Binary::Add, x, y).unwrap_or_else(|| self.intern(Node::Binary(Binary::Add, x, y)))
    }

    /// `x - y`
    pub fn sub(&mut self, x: Id, y: Id) -> Id {
        if x == y {
            return self.zero();
        }
        if let Some(id) = self.fold_binary(Binary::Sub, x, y) {
            return id;
        }
        match (self.node(x), self.node(y)) {
            (Node::Const(0.0), _) => return self.neg(y),
            (_, Node::Const(d)) => {
                let minus = self.constant(-d);
                return self.add(x, minus);
            }
            (_, Node::Unary(Unary::Neg, z)) => return self.add(x, z),
            (Node::Unary(Unary::Neg, z), _) => {
                let sum = self.add(z, y);
                return self.neg(sum);
            }
            (Node::Const(c), Node::Binary(op @ (Binary::Add | Binary::Sub), d, z)) => {
                if let Some(rest) = self.folded(self.as_constant(d).map(|d| c - d)) {
                    let opposite = if op == Binary::Add { Binary::Sub } else { Binary::Add };
                    return self.binary(opposite, rest, z);
                }
            }
            _ => {}
        }
        self.collected(Binary::Sub, x, y).unwrap_or_else(|| self.intern(Node::Binary(Binary::Sub, x, y)))
    }

    /// `x y`
    pub fn mul(&mut self, x: Id, y: Id) -> Id {
        if let Some(id) = self.fold_binary(Binary::Mul, x, y) {
            return id;
        }
        let (x, y) = self.ordered(x, y);
        match (self.node(x), self.node(y)) {
            (Node::Const(0.0), _) if !self.is_reciprocal_of_zero(y) => return x,
            (Node::Const(1.0), _) => return y,
            (Node::Const(c), _) if c < 0.0 => {
                let size = self.constant(-c);
                return self.mul_neg(size, y);
            }
            (_, Node::Unary(Unary::Neg, z)) => return self.mul_neg(x, z),
            (Node::Unary(Unary::Neg, z), _) => return self.mul_neg(z, y),
            (Node::Unary(Unary::Sqrt, z), Node::Unary(Unary::Sqrt, w)) if z == w => return z,
            (_, select @ Node::Select { .. }) if self.has_zero_arm(&select) => {
                return self.map_arms(select, |pool, arm| pool.mul(x, arm));
            }
            (select @ Node::Select { .. }, _) if self.has_zero_arm(&select) => {
                return self.map_arms(select, |pool, arm| pool.mul(arm, y));
            }
            _ => {}
        }
        self.merged_constants(x, y).unwrap_or_else(|| self.intern(Node::Binary(Binary::Mul, x, y)))
    }

    /// `x / y`, a product with the reciprocal.
    pub fn div(&mut self, x: Id, y: Id) -> Id {
        if let Some(id) = self.fold_binary(Binary::Div, x, y) {
            return id;
        }
        let reciprocal = self.recip(y);
        self.mul(x, reciprocal)
    }

    /// `1 / x`
    pub fn recip(&mut self, x: Id) -> Id {
        if let Some(id) = self.folded(self.as_constant(x).map(f64::recip)) {
            return id;
        }
        match self.node(x) {
            Node::Unary(Unary::Neg, y) => {
                let value = self.recip(y);
                return self.neg(value);
            }
            Node::Binary(Binary::Div, _, y) => return y,
            Node::Binary(Binary::Mul, c, y) => {
                if let Some(inverse) = self.folded(self.as_constant(c).map(f64::recip)) {
                    let value = self.recip(y);
                    return self.mul(inverse, value);
                }
            }
            _ => {}
        }
        let one = self.one();
        self.intern(Node::Binary(Binary::Div, one, x))
    }

    /// `x^y`; NaN for negative `x` unless `y` is an integer constant.
    pub fn pow(&mut self, x: Id, y: Id) -> Id {
        if let Some(id) = self.fold_binary(Binary::Pow, x, y) {
            return id;
        }
        match self.as_constant(y).and_then(Rational::from_f64) {
            Some(exponent) => self.power(x, exponent),
            None => self.intern(Node::Binary(Binary::Pow, x, y)),
        }
    }

    /// `x^p`; NaN for negative `x` unless `p` is an integer.
    pub fn power(&mut self, x: Id, p: Rational) -> Id {
        if let Some(id) = self.folded(self.as_constant(x).map(|c| p.power(c))) {
            return id;
        }
        let minus_one = Rational::integer(-1);
        let inner = match self.node(x) {
            Node::Power(y, q) if q.as_integer().is_none() => q.times(p).map(|pq| (y, pq)),
            Node::Unary(Unary::Sqrt, y) => {
                Rational::new(p.numerator().into(), 2 * i64::from(p.denominator())).map(|half| (y, half))
            }
            Node::Binary(Binary::Div, _, y) => p.times(minus_one).map(|opposite| (y, opposite)),
            _ => None,
        };
        if let Some((y, q)) = inner {
            return self.power(y, q);
        }
        match p.as_integer() {
            Some(n) if n.unsigned_abs() <= LONGEST_CHAIN => self.integer_power(x, n),
            _ if p == Rational::HALF => self.sqrt(x),
            _ => self.intern(Node::Power(x, p)),
        }
    }

    /// `x` squared.
    pub fn square(&mut self, x: Id) -> Id {
        self.mul(x, x)
    }

    /// The smaller of `x` and `y`.
    pub fn min(&mut self, x: Id, y: Id) -> Id {
        self.binary(Binary::Min, x, y)
    }

    /// The larger of `x` and `y`.
    pub fn max(&mut self, x: Id, y: Id) -> Id {
        self.binary(Binary::Max, x, y)
    }

    /// `then` where `lhs relation rhs` holds, `otherwise` elsewhere.
    pub fn select(&mut self, relation: Relation, lhs: Id, rhs: Id, then: Id, otherwise: Id) -> Id {
        let known = match (self.as_constant(lhs), self.as_constant(rhs)) {
            (Some(l), Some(r)) => Some(relation.holds(l, r)),
            _ if lhs == rhs => Some(relation == Relation::LessEqual),
            _ => None,
        };
        if let Some(holds) = known {
            return if holds { then } else { otherwise };
        }
        let same = |node| matches!(node, Node::Select { relation: r, lhs: a, rhs: b, .. } if (r, a, b) == (relation, lhs, rhs));
        let then = match self.node(then) {
            node @ Node::Select { then: first, .. } if same(node) => first,
            _ => then,
        };
        let otherwise = match self.node(otherwise) {
            node @ Node::Select { otherwise: second, .. } if same(node) => second,
            _ => otherwise,
        };
        if then == otherwise {
            return then;
        }
        self.intern(Node::Select { relation, lhs, rhs, then, otherwise })
    }

    /// Sum of the terms; 0 if there are none.
    pub fn sum(&mut self, terms: impl IntoIterator<Item = Id>) -> Id {
        let zero = self.zero();
        terms.into_iter().fold(zero, |sum, term| self.add(sum, term))
    }

    /// Product of the factors; 1 if there are none.
    pub fn product(&mut self, factors: impl IntoIterator<Item = Id>) -> Id {
        let one = self.one();
        factors.into_iter().fold(one, |product, factor| self.mul(product, factor))
    }

    /// `sum_i x_i y_i` over the common length.
    pub fn dot(&mut self, x: &[Id], y: &[Id]) -> Id {
        let zero = self.zero();
        x.iter().zip(y).fold(zero, |sum, (&x, &y)| {
            let term = self.mul(x, y);
            self.add(sum, term)
        })
    }

    /// The constant, if it is finite.
    fn folded(&mut self, value: Option<f64>) -> Option<Id> {
        value.filter(|v| v.is_finite()).map(|v| self.constant(v))
    }

    fn fold_binary(&mut self, op: Binary, x: Id, y: Id) -> Option<Id> {
        let (x, y) = (self.as_constant(x)?, self.as_constant(y)?);
        self.folded(Some(op.value(x, y)))
    }

    fn intern_binary(&mut self, op: Binary, x: Id, y: Id) -> Id {
        let (x, y) = if op.commutes() { self.ordered(x, y) } else { (x, y) };
        self.intern(Node::Binary(op, x, y))
    }

    /// Constants first, then by age.
    fn ordered(&self, x: Id, y: Id) -> (Id, Id) {
        let key = |id| (self.as_constant(id).is_none(), id);
        if key(x) <= key(y) { (x, y) } else { (y, x) }
    }

    fn mul_neg(&mut self, x: Id, y: Id) -> Id {
        let product = self.mul(x, y);
        self.neg(product)
    }

    /// `x` as `c y`.
    pub(crate) fn split_constant(&self, x: Id) -> Option<(Id, Id)> {
        match self.node(x) {
            Node::Binary(Binary::Mul, c, y) if self.as_constant(c).is_some() => Some((c, y)),
            _ => None,
        }
    }

    /// A product with the constants of both sides in one: `(c x) (d y) = x ((c d) y)` and `c (x (d y)) = x ((c d) y)`.
    fn merged_constants(&mut self, x: Id, y: Id) -> Option<Id> {
        if self.as_constant(x).is_some() {
            let (d, z, other) = self.inner_constant(y)?;
            let c = self.fold_binary(Binary::Mul, x, d)?;
            let scaled = self.mul(c, z);
            return Some(other.map_or(scaled, |other| self.mul(other, scaled)));
        }
        let ((c, x), (d, y)) = (self.split_constant(x)?, self.split_constant(y)?);
        let c = self.fold_binary(Binary::Mul, c, d)?;
        let scaled = self.mul(c, y);
        Some(self.mul(x, scaled))
    }

    /// `(d, z, w)` if `x` is `d z` or `w (d z)`.
    fn inner_constant(&self, x: Id) -> Option<(Id, Id, Option<Id>)> {
        if let Some((d, z)) = self.split_constant(x) {
            return Some((d, z, None));
        }
        let Node::Binary(Binary::Mul, a, b) = self.node(x) else { return None };
        let inner = |id, other| self.split_constant(id).map(|(d, z)| (d, z, Some(other)));
        inner(a, b).or_else(|| inner(b, a))
    }

    pub(super) fn integer_power(&mut self, x: Id, n: i32) -> Id {
        match n {
            ..0 => {
                let reciprocal = self.recip(x);
                self.chain(reciprocal, n.unsigned_abs())
            }
            _ => self.chain(x, n.unsigned_abs()),
        }
    }

    fn chain(&mut self, x: Id, n: u32) -> Id {
        match n {
            0 => self.one(),
            1 => x,
            _ if n.is_multiple_of(2) => {
                let half = self.chain(x, n / 2);
                self.square(half)
            }
            _ => {
                let less = self.chain(x, n - 1);
                self.mul(x, less)
            }
        }
    }

    /// `x + y` or `x - y` as one product or one `Select`.
    fn collected(&mut self, op: Binary, x: Id, y: Id) -> Option<Id> {
        if let Some((factor, a, b)) = self.common_factor(x, y) {
            let rest = self.binary(op, a, b);
            return Some(self.mul(factor, rest));
        }
        self.merged_selects(op, x, y)
    }

    /// `(f, a, b)` with `x = f a` and `y = f b`, where pulling `f` out saves a multiplication.
    fn common_factor(&mut self, x: Id, y: Id) -> Option<(Id, Id, Id)> {
        let one = self.one();
        match (self.split_constant(x), self.split_constant(y)) {
            _ if x == y => return Some((x, one, one)),
            (Some((c, z)), _) if z == y => return Some((y, c, one)),
            (_, Some((d, z))) if z == x => return Some((x, one, d)),
            _ => {}
        }
        let (shallow, deep) = (self.factors(x), self.factors(y));
        let (f, a, b) = shallow.iter().find_map(|&(f, a)| {
            let &(_, b) = deep.iter().find(|(g, _)| *g == f)?;
            Some((f, a, b))
        })?;
        let (a, b) = (self.product(a.into_iter().flatten()), self.product(b.into_iter().flatten()));
        Some((f, a, b))
    }

    /// Every factor of a product with the others: `(x, y)` and `(y, x)` of `x y`, and all three of a product of inputs and sums of
    /// two. (Factors of
    /// intermediate products are left alone: those are shared more often than not.)
    fn factors(&self, x: Id) -> Vec<(Id, [Option<Id>; 2])> {
        let pair = |id| match self.node(id) {
            Node::Binary(Binary::Mul, a, b) => Some((a, b)),
            _ => None,
        };
        let Some((a, b)) = pair(x) else { return Vec::new() };
        let mut factors = vec![(a, [Some(b), None]), (b, [Some(a), None])];
        for (inner, other) in [(a, b), (b, a)] {
            if let Some((c, d)) =
                pair(inner).filter(|(c, d)| [*c, *d, other].iter().all(|&id| self.is_leaf(id)))
            {
                factors.extend([(c, [Some(other), Some(d)]), (d, [Some(other), Some(c)])]);
            }
        }
        factors
    }

    /// A constant, an input, or a sum of two such, as `1 + u`.
    fn is_leaf(&self, id: Id) -> bool {
        let plain = |id| matches!(self.node(id), Node::Const(_) | Node::Input(_));
        match self.node(id) {
            Node::Binary(Binary::Add | Binary::Sub, x, y) => plain(x) && plain(y),
            _ => plain(id),
        }
    }

    fn is_zero(&self, id: Id) -> bool {
        self.as_constant(id) == Some(0.0)
    }

    /// Reciprocals of constants are folded unless they are infinite.
    fn is_reciprocal_of_zero(&self, id: Id) -> bool {
        matches!(self.node(id), Node::Binary(Binary::Div, _, y) if self.as_constant(y).is_some())
    }

    fn has_zero_arm(&self, node: &Node) -> bool {
        matches!(*node, Node::Select { then, otherwise, .. } if self.is_zero(then) || self.is_zero(otherwise))
    }

    fn map_arms(&mut self, select: Node, mut f: impl FnMut(&mut Pool, Id) -> Id) -> Id {
        let Node::Select { relation, lhs, rhs, then, otherwise } = select else {
            return self.intern(select);
        };
        let (then, otherwise) = (f(self, then), f(self, otherwise));
        self.select(relation, lhs, rhs, then, otherwise)
    }

    /// Two selects on one condition as one, where that needs at most the one addition.
    fn merged_selects(&mut self, op: Binary, x: Id, y: Id) -> Option<Id> {
        let Node::Select { relation, lhs, rhs, then: a, otherwise: b } = self.node(x) else { return None };
        let Node::Select { relation: r, lhs: l, rhs: s, then: c, otherwise: d } = self.node(y) else {
            return None;
        };
        let free = |p, q| self.is_zero(p) || self.is_zero(q);
        if (relation, lhs, rhs) != (r, l, s) || !(free(a, c) || free(b, d)) {
            return None;
        }
        let then = self.binary(op, a, c);
        let otherwise = self.binary(op, b, d);
        Some(self.select(relation, lhs, rhs, then, otherwise))
    }
}
