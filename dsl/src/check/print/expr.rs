//! Expressions as text, with the parentheses that they need.

use crate::check::builtin;
use crate::check::unit::unit_text;
use crate::model::{
    Arithmetic, Expr, ExprKind, Frame, FunctionId, Model, Reduction, Relation, Smoothness, Type,
};

/// How tightly an expression binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Or,
    And,
    For,
    Not,
    Compare,
    Sum,
    Product,
    Sign,
    Power,
    At,
    Tight,
}

impl Model {
    /// An expression as text.
    pub(super) fn expr(&self, e: &Expr) -> String {
        self.bound(e).0
    }

    pub(super) fn list(&self, items: &[Expr]) -> String {
        items.iter().map(|item| self.expr(item)).collect::<Vec<_>>().join(", ")
    }

    /// Name of a vector component.
    pub(super) fn axis(&self, i: usize) -> &str {
        let [a, b] = &self.coordinates.names;
        match (self.coordinates.frame, i) {
            (_, 0) => a,
            (Frame::Axisymmetric, 1) => "theta",
            (Frame::PlaneStrain, 2) => "z",
            _ => b,
        }
    }

    /// `e` with parentheses where it binds less tightly than `at_least`.
    fn within(&self, e: &Expr, at_least: Binding) -> String {
        match self.bound(e) {
            (text, binding) if binding >= at_least => text,
            (text, _) => format!("({text})"),
        }
    }

    /// Text and how tightly it binds.
    fn bound(&self, e: &Expr) -> (String, Binding) {
        match &e.kind {
            ExprKind::Negate(a) => (format!("-{}", self.within(a, Binding::Sign)), Binding::Sign),
            ExprKind::Arithmetic(op, a, b) => self.arithmetic(*op, a, b),
            ExprKind::Compare(relation, a, b) => {
                let (a, b) = (self.within(a, Binding::Sum), self.within(b, Binding::Sum));
                (format!("{a} {} {b}", symbol(*relation)), Binding::Compare)
            }
            ExprKind::And(a, b) => (
                format!("{} and {}", self.within(a, Binding::And), self.within(b, Binding::For)),
                Binding::And,
            ),
            ExprKind::Or(a, b) => {
                (format!("{} or {}", self.within(a, Binding::Or), self.within(b, Binding::And)), Binding::Or)
            }
            ExprKind::Not(a) => (format!("not {}", self.within(a, Binding::Not)), Binding::Not),
            ExprKind::Held(a, time) => (
                format!("{} for {}", self.within(a, Binding::Not), self.within(time, Binding::Sum)),
                Binding::For,
            ),
            ExprKind::AtPoint(a, place) | ExprKind::AtTime(a, place) => {
                (format!("{}@{}", self.within(a, Binding::At), self.parenthesised(place)), Binding::At)
            }
            ExprKind::AtEvent(a, id) => {
                (format!("{}@{}", self.within(a, Binding::At), self.events[id.0].name), Binding::At)
            }
            ExprKind::OutcomeIs(id) => (format!("outcome == {}", self.events[id.0].name), Binding::Compare),
            _ => (self.primary(e), Binding::Tight),
        }
    }

    fn parenthesised(&self, e: &Expr) -> String {
        match e.kind {
            ExprKind::Tuple(_) => self.expr(e),
            _ => format!("({})", self.expr(e)),
        }
    }

    fn arithmetic(&self, op: Arithmetic, a: &Expr, b: &Expr) -> (String, Binding) {
        let (sign, own, right) = match op {
            Arithmetic::Add => (" + ", Binding::Sum, Binding::Sum),
            Arithmetic::Sub => (" - ", Binding::Sum, Binding::Product),
            Arithmetic::Mul => ("*", Binding::Product, Binding::Product),
            Arithmetic::Div => ("/", Binding::Product, Binding::Sign),
            Arithmetic::Pow => ("^", Binding::Power, Binding::Power),
        };
        let left = if op == Arithmetic::Pow { Binding::At } else { own };
        (format!("{}{sign}{}", self.within(a, left), self.within(b, right)), own)
    }

    fn primary(&self, e: &Expr) -> String {
        match &e.kind {
            ExprKind::Number(value) => self.number(*value, &e.ty),
            ExprKind::Param(id) => self.params[id.0].name.clone(),
            ExprKind::Let(id) => self.lets[id.0].name.clone(),
            ExprKind::Local(id) => self.locals[id.0].clone(),
            ExprKind::Field(id) => self.fields[id.0].name.clone(),
            ExprKind::Test(id) => format!("test({})", self.fields[id.0].name),
            ExprKind::State(id) => self.states[id.0].name.clone(),
            ExprKind::Coordinate(i) => self.coordinates.names[*i].clone(),
            ExprKind::Time => "t".into(),
            ExprKind::Identity => "I".into(),
            ExprKind::Tuple(items) => format!("({})", self.list(items.as_slice())),
            ExprKind::Triple(items) => format!("({})", self.list(items.as_slice())),
            ExprKind::Component(a, i) => format!("{}.{}", self.within(a, Binding::Tight), self.axis(*i)),
            ExprKind::Component2(a, i, j) => {
                let letter = |i: usize| if self.axis(i) == "theta" { "t" } else { self.axis(i) };
                format!("{}.{}{}", self.within(a, Binding::Tight), letter(*i), letter(*j))
            }
            ExprKind::Member(a, i) => match &a.ty {
                Type::Record(members) => format!("{}.{}", self.within(a, Binding::Tight), members[*i].0),
                _ => self.expr(a),
            },
            ExprKind::Record(items) => match &e.ty {
                Type::Record(members) => {
                    let items = members
                        .iter()
                        .zip(items)
                        .map(|((name, _), item)| format!("{name}: {}", self.expr(item)));
                    format!("({})", items.collect::<Vec<_>>().join(", "))
                }
                _ => format!("({})", self.list(items)),
            },
            ExprKind::Builtin(builtin, items) => format!("{}({})", builtin::name(*builtin), self.list(items)),
            ExprKind::Apply(id, items) => format!("{}({})", self.function_name(*id), self.list(items)),
            ExprKind::ApplyLocal(id, items) => format!("{}({})", self.locals[id.0], self.list(items)),
            ExprKind::Law(id, fixed) => {
                let items = fixed.iter().map(|item| item.as_ref().map_or("_".into(), |item| self.expr(item)));
                format!("{}({})", self.function_name(*id), items.collect::<Vec<_>>().join(", "))
            }
            ExprKind::Rate(a) => format!("dt({})", self.expr(a)),
            ExprKind::Diff(a, x) => format!("diff({}, {})", self.expr(a), self.expr(x)),
            ExprKind::Frozen(a) => format!("frozen({})", self.expr(a)),
            ExprKind::MatchValue { scrutinee, arms, otherwise, smoothness } => {
                let arms = arms.iter().map(|arm| {
                    let sign = if arm.inclusive { "<=" } else { "<" };
                    format!("{sign} {} => {}, ", self.expr(&arm.bound), self.expr(&arm.value))
                });
                let promise = match smoothness {
                    Smoothness::C0 => "",
                    Smoothness::C1 => " C1",
                    Smoothness::Jumps => " jumps",
                };
                let arms = arms.collect::<String>();
                format!(
                    "match {} {{ {arms}else => {} }}{promise}",
                    self.expr(scrutinee),
                    self.expr(otherwise)
                )
            }
            ExprKind::MatchRegion(arms, otherwise) => {
                let arms = arms.iter().map(|(id, value)| {
                    format!("{} => {}", self.geometry.regions[id.0].name, self.expr(value))
                });
                let last = otherwise.iter().map(|value| format!("else => {}", self.expr(value)));
                format!("match region {{ {} }}", arms.chain(last).collect::<Vec<_>>().join(", "))
            }
            ExprKind::Reduce(reduction, a, domain) => {
                format!("{}({} on {})", reduction_name(*reduction), self.expr(a), self.domain(domain))
            }
            ExprKind::ReduceRun(reduction, a, times) => {
                let times = times
                    .as_ref()
                    .map_or("run".into(), |(from, to)| format!("{} .. {}", self.expr(from), self.expr(to)));
                format!("{}({} on {times})", reduction_name(*reduction), self.expr(a))
            }
            ExprKind::Measure(domain) => format!("measure({})", self.domain(domain)),
            ExprKind::Force(id, domain) => {
                format!("force({}, {})", self.blocks[id.0].name, self.domain(domain))
            }
            ExprKind::Normal(domain) => format!("normal({})", self.domain(domain)),
            ExprKind::Gap(id) => format!("{}.gap", self.pairs[id.0].name),
            ExprKind::PairNormal(id) => format!("{}.normal", self.pairs[id.0].name),
            _ => self.bound(e).0,
        }
    }

    fn function_name(&self, id: FunctionId) -> &str {
        &self.functions[id.0].name
    }

    /// A number with its coherent unit.
    fn number(&self, value: f64, ty: &Type) -> String {
        let plain = value == 0.0 || (1e-4..1e7).contains(&value.abs());
        let digits = if plain { format!("{value}") } else { format!("{value:e}") };
        let Type::Value(_, dimension) = ty else { return digits };
        if dimension.is_number() || value == 0.0 {
            return digits;
        }
        let unit = unit_text(&self.units, *dimension);
        match ansatz_units::Unit::find(&unit) {
            Some(_) => format!("{digits} {unit}"),
            None => format!("{digits} [{unit}]"),
        }
    }
}

fn symbol(relation: Relation) -> &'static str {
    match relation {
        Relation::Less => "<",
        Relation::LessEqual => "<=",
        Relation::Greater => ">",
        Relation::GreaterEqual => ">=",
        Relation::Equal => "==",
    }
}

fn reduction_name(reduction: Reduction) -> &'static str {
    match reduction {
        Reduction::Min => "min",
        Reduction::Max => "max",
        Reduction::Mean => "mean",
        Reduction::Integral => "integral",
    }
}
