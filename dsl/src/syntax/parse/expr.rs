//! Expressions, units and types from pairs; precedence.

use std::sync::LazyLock;

use pest::pratt_parser::{Assoc, Op, PrattParser};

use super::{Builder, Node, Nodes, Rule};
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;
use crate::syntax::ast::{
    Arg, Arm, BinaryOp, Bounds, CompareOp, Dotted, Equation, Expr, ExprKind, Ident, LogicOp, Match,
    NamedExpr, Number, On, Pattern, Range, Set, Shape, Smoothness, Text, TypeExpr, TypeKind, TypedName,
    UnaryOp, UnitExpr, UnitFactor,
};

/// Operands and operators in one expression, counted along the way to its innermost part: a bound on the depth of the
/// tree, whichever way the operators group.
const MAX_DEPTH: usize = 512;

/// Largest exponent of a unit or type, either sign.
const MAX_EXPONENT: i32 = 99;

static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    let left = |rule| Op::infix(rule, Assoc::Left);
    PrattParser::new()
        .op(left(Rule::or))
        .op(left(Rule::and))
        .op(left(Rule::lasting))
        .op(Op::prefix(Rule::not))
        .op(left(Rule::eqeq) | left(Rule::le) | left(Rule::ge) | left(Rule::lt) | left(Rule::gt))
        .op(left(Rule::add) | left(Rule::sub))
        .op(left(Rule::mul) | left(Rule::div))
        .op(Op::prefix(Rule::neg))
        .op(Op::infix(Rule::pow, Assoc::Right))
        .op(Op::postfix(Rule::at))
        .op(Op::postfix(Rule::call) | Op::postfix(Rule::member))
});

impl<'s> Builder<'s> {
    /// `expr` or `arith`.
    pub(super) fn expr(&self, node: Node<'s>) -> Option<Expr> {
        let (span, source, base) = (node.span(), node.source, node.base);
        let pairs = node.pair.into_inner();
        let outside = self.depth.get();
        let depth = outside + pairs.len();
        if depth > MAX_DEPTH {
            let message = format!("this expression has more than {MAX_DEPTH} operands and operators");
            self.report(Diagnostic::error(Code::TooDeep, span, message).help("name parts of it with `let`"));
            return Some(Expr { kind: ExprKind::Hole, span });
        }
        self.depth.set(depth);
        let wrap = |pair| Node { pair, source, base };
        let built = PRECEDENCE
            .map_primary(|pair| self.primary(wrap(pair)))
            .map_prefix(|op, operand| self.prefix(&wrap(op), operand?))
            .map_postfix(|object, op| self.postfix(object?, wrap(op)))
            .map_infix(|left, op, right| self.infix(left?, &wrap(op), right?))
            .parse(pairs);
        self.depth.set(outside);
        built
    }

    fn next_expr(&self, nodes: &mut Nodes<'s>) -> Option<Expr> {
        self.expr(nodes.next()?)
    }

    fn primary(&self, node: Node<'s>) -> Option<Expr> {
        let span = node.span();
        let kind = match node.rule() {
            Rule::ident => ExprKind::Name(node.text().to_owned()),
            Rule::hole => ExprKind::Hole,
            Rule::string => ExprKind::Text(unquote(node.text())),
            Rule::number => ExprKind::Number(self.number(node)?),
            Rule::record => {
                ExprKind::Record(node.nodes().map(|field| self.named(field)).collect::<Option<_>>()?)
            }
            Rule::match_ => ExprKind::Match(Box::new(self.match_(node)?)),
            Rule::group => return self.group(node),
            _ => return None,
        };
        Some(Expr { kind, span })
    }

    fn number(&self, node: Node<'s>) -> Option<Number> {
        let mut nodes = node.nodes();
        let literal = nodes.next()?;
        let text = literal.text().to_owned();
        let mut value: f64 = text.parse().ok()?;
        if !value.is_finite() {
            let message = format!("`{text}` is larger than any double");
            self.report(Diagnostic::error(Code::NumberRange, literal.span(), message));
            value = 0.0;
        }
        Some(Number { value, text, unit: self.unit(&mut nodes)? })
    }

    /// One expression in parentheses, or a tuple.
    fn group(&self, node: Node<'s>) -> Option<Expr> {
        let span = node.span();
        let mut nodes = node.nodes();
        let mut items = Vec::new();
        while let Some(item) = nodes.maybe(Rule::expr) {
            items.push(self.expr(item)?);
        }
        let unit = self.unit(&mut nodes)?;
        if items.len() > 1 {
            return Some(Expr { kind: ExprKind::Tuple { items, unit }, span });
        }
        if let Some(unit) = unit {
            let message = "a unit stands after a number, a tuple or a set, not after parentheses";
            let help = format!("multiply: `(..)*1 {}`", unit.text);
            self.report(Diagnostic::error(Code::UnitNotHere, unit.span, message).help(help));
        }
        items.pop().map(|inner| Expr { span, ..inner })
    }

    fn named(&self, node: Node<'s>) -> Option<NamedExpr> {
        let mut nodes = node.nodes();
        Some(NamedExpr { name: nodes.ident()?, value: self.next_expr(&mut nodes)? })
    }

    fn match_(&self, node: Node<'s>) -> Option<Match> {
        let mut nodes = node.nodes();
        let scrutinee = self.next_expr(&mut nodes)?;
        let mut arms = Vec::new();
        while let Some(arm) = nodes.maybe(Rule::arm) {
            arms.push(self.arm(arm)?);
        }
        let smoothness = match nodes.next().map(|node| node.text()) {
            Some("C1") => Smoothness::C1,
            Some("jumps") => Smoothness::Jumps,
            _ => Smoothness::C0,
        };
        Some(Match { scrutinee, arms, smoothness })
    }

    fn arm(&self, node: Node<'s>) -> Option<Arm> {
        let span = node.span();
        let mut nodes = node.nodes();
        let first = nodes.next()?;
        let pattern = match first.rule() {
            Rule::lt => Pattern::Less(self.next_expr(&mut nodes)?),
            Rule::le => Pattern::LessEqual(self.next_expr(&mut nodes)?),
            Rule::otherwise => Pattern::Else(first.span()),
            Rule::dotted => Pattern::Region(self.dotted(first)),
            _ => return None,
        };
        Some(Arm { pattern, value: self.next_expr(&mut nodes)?, span })
    }

    fn prefix(&self, op: &Node<'s>, operand: Expr) -> Option<Expr> {
        let kind = match op.rule() {
            Rule::neg => UnaryOp::Neg,
            Rule::not => UnaryOp::Not,
            _ => return None,
        };
        let op_span = op.span();
        let span = op_span.to(operand.span);
        Some(Expr { kind: ExprKind::Unary { op: kind, op_span, operand: Box::new(operand) }, span })
    }

    fn postfix(&self, object: Expr, op: Node<'s>) -> Option<Expr> {
        let span = object.span.to(op.span());
        let kind = match op.rule() {
            Rule::at => ExprKind::At { value: Box::new(object), place: Box::new(self.place(op.only()?)?) },
            Rule::member => {
                self.refuse_after_place(&object, &op);
                ExprKind::Member { object: Box::new(object), member: op.nodes().ident()? }
            }
            Rule::call => {
                self.refuse_after_place(&object, &op);
                ExprKind::Call { callee: Box::new(object), args: self.args(op)? }
            }
            _ => return None,
        };
        Some(Expr { kind, span })
    }

    /// `x@f(a)` reads as a call of `x@f`: nobody means that.
    fn refuse_after_place(&self, object: &Expr, op: &Node<'s>) {
        if let ExprKind::At { place, .. } = &object.kind
            && place.span.end == object.span.end
        {
            let message = "after `@` stands a name, or an expression in parentheses";
            let help = format!("write `@({}{})`", self.source.slice(place.span), op.text());
            self.report(Diagnostic::error(Code::Expected, op.span(), message).help(help));
        }
    }

    fn place(&self, node: Node<'s>) -> Option<Expr> {
        if node.rule() == Rule::group {
            return self.group(node);
        }
        let mut parts = self.dotted(node).parts.into_iter();
        let first = parts.next()?;
        let start = Expr { kind: ExprKind::Name(first.text), span: first.span };
        Some(parts.fold(start, |object, member| {
            let span = object.span.to(member.span);
            Expr { kind: ExprKind::Member { object: Box::new(object), member }, span }
        }))
    }

    fn infix(&self, left: Expr, op: &Node<'s>, right: Expr) -> Option<Expr> {
        let (op_span, span) = (op.span(), left.span.to(right.span));
        let rule = op.rule();
        if let Some(op) = compare_op(rule) {
            self.refuse_chain(&left, op_span, &right);
            return Some(Expr {
                kind: ExprKind::Compare { op, op_span, left: Box::new(left), right: Box::new(right) },
                span,
            });
        }
        let (left, right) = (Box::new(left), Box::new(right));
        let kind = match rule {
            Rule::and => ExprKind::Logic { op: LogicOp::And, op_span, left, right },
            Rule::or => ExprKind::Logic { op: LogicOp::Or, op_span, left, right },
            Rule::lasting => ExprKind::Lasting { condition: left, time: right },
            rule => ExprKind::Binary { op: binary_op(rule)?, op_span, left, right },
        };
        Some(Expr { kind, span })
    }

    fn refuse_chain(&self, left: &Expr, op: Span, right: &Expr) {
        if let ExprKind::Compare { left: first, right: middle, op_span, .. } = &left.kind
            && left.span == first.span.to(middle.span)
        {
            let text = |span| self.source.slice(span);
            let (left, middle, op_text, right) =
                (text(left.span), text(middle.span), text(op), text(right.span));
            let diagnostic = Diagnostic::error(Code::ChainedComparison, op, "comparisons do not chain")
                .label(*op_span, "the first comparison")
                .help(format!("compare twice: `{left} and {middle} {op_text} {right}`"));
            self.report(diagnostic);
        }
    }

    /// `call`: the arguments in parentheses.
    pub(super) fn args(&self, node: Node<'s>) -> Option<Vec<Arg>> {
        node.nodes().map(|arg| self.arg(arg)).collect()
    }

    fn arg(&self, node: Node<'s>) -> Option<Arg> {
        let span = node.span();
        let mut nodes = node.nodes();
        let name = nodes.maybe(Rule::key).map(|key| key.ident());
        let value = self.next_expr(&mut nodes)?;
        let on = match nodes.next() {
            None => None,
            Some(within) => {
                let mut ends = within.nodes();
                let low = self.next_expr(&mut ends)?;
                Some(match ends.next() {
                    None => On::Domain(low),
                    Some(high) => On::Times(Range { low, high: self.expr(high)? }),
                })
            }
        };
        Some(Arg { name, value, on, span })
    }

    /// `dotted`
    pub(super) fn dotted(&self, node: Node<'s>) -> Dotted {
        let span = node.span();
        Dotted { parts: node.nodes().map(|part| part.ident()).collect(), span }
    }

    /// `string`
    pub(super) fn quoted(&self, node: &Node<'s>) -> Text {
        Text { value: unquote(node.text()), span: node.span() }
    }

    /// `range`
    pub(super) fn range(&self, node: Node<'s>) -> Option<Range> {
        let mut ends = node.nodes();
        Some(Range { low: self.next_expr(&mut ends)?, high: self.next_expr(&mut ends)? })
    }

    /// `set`
    pub(super) fn set(&self, node: Node<'s>) -> Option<Set> {
        let span = node.span();
        let mut nodes = node.nodes();
        let mut items = Vec::new();
        while let Some(item) = nodes.maybe(Rule::expr) {
            items.push(self.expr(item)?);
        }
        Some(Set { items, unit: self.unit(&mut nodes)?, span })
    }

    /// `bounds`
    pub(super) fn bounds(&self, node: Node<'s>) -> Option<Bounds> {
        let inner = node.only()?;
        match inner.rule() {
            Rule::set => Some(Bounds::Set(self.set(inner)?)),
            _ => Some(Bounds::Range(self.range(inner)?)),
        }
    }

    /// `eqn`
    pub(super) fn equation(&self, node: Node<'s>) -> Option<Equation> {
        let span = node.span();
        let mut sides = node.nodes();
        let left = self.next_expr(&mut sides)?;
        let right = sides.find(|side| side.rule() == Rule::arith)?;
        Some(Equation { left, right: self.expr(right)?, span })
    }

    /// An optional `unit`: `Some(None)` where none is written.
    fn unit(&self, nodes: &mut Nodes<'s>) -> Option<Option<UnitExpr>> {
        match nodes.maybe(Rule::unit) {
            None => Some(None),
            Some(unit) => self.unit_expr(unit.only()?).map(Some),
        }
    }

    /// `brac` or `bare`
    pub(super) fn unit_expr(&self, node: Node<'s>) -> Option<UnitExpr> {
        let (text, span) = (node.text().to_owned(), node.span());
        let mut factors = Vec::new();
        match node.rule() {
            Rule::brac => self.unit_product(node.only()?, 1, &mut factors)?,
            _ => self.unit_factor(node, 1, &mut factors)?,
        }
        Some(UnitExpr { text, factors, span })
    }

    fn unit_product(&self, node: Node<'s>, power: i32, factors: &mut Vec<UnitFactor>) -> Option<()> {
        let mut sign = 1;
        for part in node.nodes() {
            match part.rule() {
                Rule::mul => sign = 1,
                Rule::div => sign = -1,
                _ => self.unit_factor(part, sign * power, factors)?,
            }
        }
        Some(())
    }

    /// A symbol, `1` or a product in parentheses, with its exponent.
    fn unit_factor(&self, node: Node<'s>, power: i32, factors: &mut Vec<UnitFactor>) -> Option<()> {
        let mut nodes = node.nodes();
        let base = nodes.next()?;
        let exponent = self.exponent(nodes).saturating_mul(power);
        if exponent.abs() > MAX_EXPONENT {
            self.report(exponent_range(base.span()));
        }
        match base.rule() {
            Rule::usym => factors.push(UnitFactor { symbol: base.ident(), exponent }),
            Rule::uprod => self.unit_product(base, exponent, factors)?,
            _ => {}
        }
        Some(())
    }

    /// The integer behind `^`, 1 where there is none.
    fn exponent(&self, nodes: Nodes<'s>) -> i32 {
        let mut nodes = nodes;
        let Some(node) = nodes.find(|node| node.rule() == Rule::uexp) else { return 1 };
        match node.text().parse::<i32>() {
            Ok(exponent) if exponent.abs() <= MAX_EXPONENT => exponent,
            _ => {
                self.report(exponent_range(node.span()));
                1
            }
        }
    }

    /// `ty`
    pub(super) fn ty(&self, node: Node<'s>) -> Option<TypeExpr> {
        let mut nodes = node.nodes();
        let mut left = self.type_factor(nodes.next()?)?;
        while let (Some(op), Some(right)) = (nodes.next(), nodes.next()) {
            let right = self.type_factor(right)?;
            let span = left.span.to(right.span);
            let (a, b) = (Box::new(left), Box::new(right));
            let kind =
                if op.rule() == Rule::div { TypeKind::Quotient(a, b) } else { TypeKind::Product(a, b) };
            left = TypeExpr { kind, span };
        }
        Some(left)
    }

    fn type_factor(&self, node: Node<'s>) -> Option<TypeExpr> {
        let span = node.span();
        let mut nodes = node.nodes();
        let base = nodes.next()?;
        let base_span = base.span();
        let kind = match base.rule() {
            Rule::uone => TypeKind::One,
            Rule::ident => TypeKind::Named(base.text().to_owned()),
            Rule::shaped => self.shaped(base)?,
            Rule::law => {
                let mut parts = base.nodes().map(|part| self.ty(part)).collect::<Option<Vec<_>>>()?;
                let result = Box::new(parts.pop()?);
                TypeKind::Function { args: parts, result }
            }
            Rule::rec_ty => {
                TypeKind::Record(base.nodes().map(|field| self.typed(field)).collect::<Option<_>>()?)
            }
            _ => return None,
        };
        match self.exponent(nodes) {
            1 => Some(TypeExpr { kind, span }),
            power => {
                let base = TypeExpr { kind, span: base_span };
                Some(TypeExpr { kind: TypeKind::Power(Box::new(base), power), span })
            }
        }
    }

    fn shaped(&self, node: Node<'s>) -> Option<TypeKind> {
        let mut nodes = node.nodes();
        let shape = if nodes.next()?.text() == "Vector" { Shape::Vector } else { Shape::Tensor };
        let element = match nodes.next() {
            None => None,
            Some(element) => Some(Box::new(self.ty(element)?)),
        };
        Some(TypeKind::Shaped { shape, element })
    }

    /// `farg`
    pub(super) fn typed(&self, node: Node<'s>) -> Option<TypedName> {
        let mut nodes = node.nodes();
        Some(TypedName { name: nodes.ident()?, ty: self.ty(nodes.next()?)? })
    }

    /// A name and the type behind it, where one is written.
    pub(super) fn maybe_typed(&self, nodes: &mut Nodes<'s>) -> Option<(Ident, Option<TypeExpr>)> {
        let name = nodes.ident()?;
        let ty = match nodes.maybe(Rule::ty) {
            None => None,
            Some(ty) => Some(self.ty(ty)?),
        };
        Some((name, ty))
    }
}

fn exponent_range(span: Span) -> Diagnostic {
    let message = format!("an exponent of a unit or type lies between -{MAX_EXPONENT} and {MAX_EXPONENT}");
    Diagnostic::error(Code::NumberRange, span, message)
}

fn unquote(literal: &str) -> String {
    literal.trim_matches('"').to_owned()
}

fn compare_op(rule: Rule) -> Option<CompareOp> {
    Some(match rule {
        Rule::eqeq => CompareOp::Equal,
        Rule::lt => CompareOp::Less,
        Rule::le => CompareOp::LessEqual,
        Rule::gt => CompareOp::Greater,
        Rule::ge => CompareOp::GreaterEqual,
        _ => return None,
    })
}

fn binary_op(rule: Rule) -> Option<BinaryOp> {
    Some(match rule {
        Rule::add => BinaryOp::Add,
        Rule::sub => BinaryOp::Sub,
        Rule::mul => BinaryOp::Mul,
        Rule::div => BinaryOp::Div,
        Rule::pow => BinaryOp::Pow,
        _ => return None,
    })
}
