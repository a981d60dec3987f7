//! Expressions and types as text.

use crate::syntax::ast::{
    Arg, Arm, BinaryOp, Bounds, Expr, ExprKind, LogicOp, Match, Number, On, Pattern, Range, Set, Shape,
    Smoothness, TypeExpr, TypeKind, TypedName, UnaryOp, UnitExpr,
};

/// How tightly a form binds, loosest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Or,
    And,
    Lasting,
    Not,
    Compare,
    Sum,
    Product,
    Negation,
    Power,
    Place,
    Postfix,
    Primary,
}

/// The expression in one line, with as few parentheses as it needs: it parses to the same tree.
pub fn expr_to_string(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number(number) => number_to_string(number),
        ExprKind::Text(text) => format!("\"{text}\""),
        ExprKind::Name(name) => name.clone(),
        ExprKind::Hole => String::from("_"),
        ExprKind::Member { object, member } => {
            format!("{}.{}", at_least(object, Level::Postfix), member.text)
        }
        ExprKind::Call { callee, args } => {
            format!("{}({})", at_least(callee, Level::Postfix), list(args, arg_to_string))
        }
        ExprKind::At { value, place } => {
            format!("{}@{}", at_least(value, Level::Place), place_to_string(place))
        }
        ExprKind::Tuple { items, unit } => {
            format!("({}){}", list(items, expr_to_string), suffix(unit.as_ref()))
        }
        ExprKind::Record(fields) => {
            let field =
                |f: &crate::syntax::ast::NamedExpr| format!("{}: {}", f.name.text, expr_to_string(&f.value));
            format!("({})", list(fields, field))
        }
        ExprKind::Unary { op: UnaryOp::Neg, operand, .. } => {
            format!("-{}", at_least(operand, Level::Negation))
        }
        ExprKind::Unary { op: UnaryOp::Not, operand, .. } => format!("not {}", at_least(operand, Level::Not)),
        ExprKind::Binary { op, left, right, .. } => binary_to_string(*op, left, right),
        ExprKind::Compare { op, left, right, .. } => {
            format!("{} {} {}", at_least(left, Level::Sum), op.symbol(), at_least(right, Level::Sum))
        }
        ExprKind::Logic { op, left, right, .. } => {
            let (own, next) = match op {
                LogicOp::And => (Level::And, Level::Lasting),
                LogicOp::Or => (Level::Or, Level::And),
            };
            format!("{} {} {}", at_least(left, own), op.symbol(), at_least(right, next))
        }
        ExprKind::Lasting { condition, time } => {
            format!("{} for {}", at_least(condition, Level::Lasting), at_least(time, Level::Not))
        }
        ExprKind::Match(m) => match_to_string(m),
    }
}

/// The number with its unit, as written.
pub fn number_to_string(number: &Number) -> String {
    format!("{}{}", number.text, suffix(number.unit.as_ref()))
}

/// The type as written, white space aside.
pub fn type_to_string(ty: &TypeExpr) -> String {
    match &ty.kind {
        TypeKind::One => String::from("1"),
        TypeKind::Named(name) => name.clone(),
        TypeKind::Shaped { shape, element } => {
            let shape = match shape {
                Shape::Vector => "Vector",
                Shape::Tensor => "Tensor",
            };
            element
                .as_ref()
                .map_or(String::from(shape), |element| format!("{shape}[{}]", type_to_string(element)))
        }
        TypeKind::Function { args, result } => {
            format!("fn({}) -> {}", list(args, type_to_string), type_to_string(result))
        }
        TypeKind::Record(fields) => format!("({})", list(fields, typed_to_string)),
        TypeKind::Product(left, right) => format!("{}*{}", type_to_string(left), type_to_string(right)),
        TypeKind::Quotient(left, right) => format!("{}/{}", type_to_string(left), type_to_string(right)),
        TypeKind::Power(base, power) => format!("{}^{power}", type_to_string(base)),
    }
}

/// What follows `in`.
pub fn bounds_to_string(bounds: &Bounds) -> String {
    match bounds {
        Bounds::Range(range) => range_to_string(range),
        Bounds::Set(set) => set_to_string(set),
    }
}

pub(super) fn range_to_string(range: &Range) -> String {
    format!("{} .. {}", at_least(&range.low, Level::Sum), at_least(&range.high, Level::Sum))
}

pub(super) fn set_to_string(set: &Set) -> String {
    format!("{{{}}}{}", list(&set.items, expr_to_string), suffix(set.unit.as_ref()))
}

pub(super) fn typed_to_string(typed: &TypedName) -> String {
    format!("{}: {}", typed.name.text, type_to_string(&typed.ty))
}

pub(super) fn arg_to_string(arg: &Arg) -> String {
    let name = arg.name.as_ref().map_or(String::new(), |name| format!("{}: ", name.text));
    let on = match &arg.on {
        None => String::new(),
        Some(On::Domain(domain)) => format!(" on {}", at_least(domain, Level::Sum)),
        Some(On::Times(range)) => format!(" on {}", range_to_string(range)),
    };
    format!("{name}{}{on}", expr_to_string(&arg.value))
}

/// The items, each turned into text, with commas between them.
pub(super) fn list<T>(items: &[T], text: impl Fn(&T) -> String) -> String {
    items.iter().map(text).collect::<Vec<_>>().join(", ")
}

fn binary_to_string(op: BinaryOp, left: &Expr, right: &Expr) -> String {
    let (left_level, right_level, space) = match op {
        BinaryOp::Add | BinaryOp::Sub => (Level::Sum, Level::Product, " "),
        BinaryOp::Mul | BinaryOp::Div => (Level::Product, Level::Negation, ""),
        BinaryOp::Pow => (Level::Place, Level::Power, ""),
    };
    format!("{}{space}{}{space}{}", at_least(left, left_level), op.symbol(), at_least(right, right_level))
}

fn match_to_string(m: &Match) -> String {
    let smoothness = match m.smoothness {
        Smoothness::C0 => "",
        Smoothness::C1 => " C1",
        Smoothness::Jumps => " jumps",
    };
    format!("match {} {{ {} }}{smoothness}", at_least(&m.scrutinee, Level::Sum), list(&m.arms, arm_to_string))
}

fn arm_to_string(arm: &Arm) -> String {
    let pattern = match &arm.pattern {
        Pattern::Less(bound) => format!("< {}", at_least(bound, Level::Sum)),
        Pattern::LessEqual(bound) => format!("<= {}", at_least(bound, Level::Sum)),
        Pattern::Region(region) => region.text(),
        Pattern::Else(_) => String::from("else"),
    };
    format!("{pattern} => {}", expr_to_string(&arm.value))
}

/// A place is a dotted name, a tuple, or anything in parentheses.
fn place_to_string(place: &Expr) -> String {
    match &place.kind {
        ExprKind::Tuple { .. } => expr_to_string(place),
        _ if is_dotted(place) => expr_to_string(place),
        _ => format!("({})", expr_to_string(place)),
    }
}

fn is_dotted(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Name(_) => true,
        ExprKind::Member { object, .. } => is_dotted(object),
        _ => false,
    }
}

/// The expression, in parentheses if it binds more loosely than `level`.
fn at_least(expr: &Expr, level: Level) -> String {
    let text = expr_to_string(expr);
    if level_of(expr, level) < level { format!("({text})") } else { text }
}

/// How tightly `expr` binds where `wanted` is asked for: nothing may follow a unit directly, so behind one only the
/// operators from products on are safe.
fn level_of(expr: &Expr, wanted: Level) -> Level {
    let behind_unit = if wanted > Level::Negation { Level::Negation } else { Level::Primary };
    match &expr.kind {
        ExprKind::Number(Number { unit: Some(_), .. }) | ExprKind::Tuple { unit: Some(_), .. } => behind_unit,
        ExprKind::Number(_) if wanted == Level::Postfix => Level::Place,
        ExprKind::Number(_) | ExprKind::Text(_) | ExprKind::Name(_) | ExprKind::Hole => Level::Primary,
        ExprKind::Tuple { .. } | ExprKind::Record(_) => Level::Primary,
        ExprKind::Match(_) => behind_unit,
        ExprKind::Member { .. } | ExprKind::Call { .. } => Level::Postfix,
        ExprKind::At { .. } => Level::Place,
        ExprKind::Unary { op: UnaryOp::Neg, .. } => Level::Negation,
        ExprKind::Unary { op: UnaryOp::Not, .. } => Level::Not,
        ExprKind::Binary { op, .. } => match op {
            BinaryOp::Add | BinaryOp::Sub => Level::Sum,
            BinaryOp::Mul | BinaryOp::Div => Level::Product,
            BinaryOp::Pow => Level::Power,
        },
        ExprKind::Compare { .. } => Level::Compare,
        ExprKind::Lasting { .. } => Level::Lasting,
        ExprKind::Logic { op: LogicOp::And, .. } => Level::And,
        ExprKind::Logic { op: LogicOp::Or, .. } => Level::Or,
    }
}

fn suffix(unit: Option<&UnitExpr>) -> String {
    unit.map_or(String::new(), |unit| format!(" {}", unit.text))
}
