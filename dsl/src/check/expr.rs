//! Expressions: from syntax to typed trees. Calls, matches and domains have files of their own.

use super::shape::{coerce, settle, value};
use super::{Binding, Checked, Checker, Env, Meaning, Reported, Slot};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Arithmetic, EventId, Expr, ExprKind, FunctionId, Relation, Shape, Type};
use crate::resolve::scope::{Symbol, Word};
use crate::source::Span;
use crate::syntax::ast::{self, BinaryOp, CompareOp, LogicOp, UnaryOp};
use ansatz_units::Dimension;

impl Checker<'_> {
    /// The typed form of an expression. A literal 0 may still have the type [`Type::Zero`].
    pub(super) fn expr(&mut self, e: &ast::Expr, env: &Env) -> Checked<Expr> {
        let span = e.span;
        match &e.kind {
            ast::ExprKind::Number(number) => self.number(number, span),
            ast::ExprKind::Name(name) => self.name(name, span, env),
            ast::ExprKind::Member { object, member } => self.member(object, member, span, env),
            ast::ExprKind::Call { callee, args } => self.call(callee, args, span, env),
            ast::ExprKind::At { value, place } => self.at(value, place, span, env),
            ast::ExprKind::Tuple { items, unit } => self.tuple(items, unit.as_ref(), span, env),
            ast::ExprKind::Record(members) => self.record(members, span, env),
            ast::ExprKind::Unary { op, operand, .. } => self.unary(*op, operand, span, env),
            ast::ExprKind::Binary { op, left, right, .. } => {
                if let Some(slip) = self.unbracketed(e, env) {
                    return Err(slip);
                }
                let (a, b) = (self.expr(left, env), self.expr(right, env));
                self.arithmetic(operator(*op), a?, b?, span)
            }
            ast::ExprKind::Compare { op, left, right, .. } => self.compare(*op, left, right, span, env),
            ast::ExprKind::Logic { op, left, right, .. } => {
                let (a, b) = (self.condition(left, env), self.condition(right, env));
                let (a, b) = (Box::new(a?), Box::new(b?));
                let kind = match op {
                    LogicOp::And => ExprKind::And(a, b),
                    LogicOp::Or => ExprKind::Or(a, b),
                };
                Ok(Expr { kind, ty: Type::Condition, span })
            }
            ast::ExprKind::Lasting { condition, time } => {
                let (condition, time) =
                    (self.condition(condition, env), self.typed(time, &Type::TIME, "the duration", env));
                let kind = ExprKind::Held(Box::new(condition?), Box::new(time?));
                Ok(Expr { kind, ty: Type::Condition, span })
            }
            ast::ExprKind::Match(m) => self.match_expr(m, span, env),
            ast::ExprKind::Text(_) => {
                Err(self.misplaced(span, "a text is no value", "texts name files and stand in `warn(..)`"))
            }
            ast::ExprKind::Hole => Err(self.misplaced(
                span,
                "`_` leaves an argument of a function open",
                "it stands in calls only: `Psi(_, G)`",
            )),
        }
    }

    fn misplaced(&mut self, span: Span, message: &str, help: &str) -> Reported {
        self.report(Diagnostic::error(Code::Misplaced, span, message).help(help))
    }

    /// An expression of a known type.
    pub(super) fn typed(&mut self, e: &ast::Expr, ty: &Type, what: &str, env: &Env) -> Checked<Expr> {
        let value = self.expr(e, env)?;
        self.expect(value, ty, what)
    }

    /// An expression of any type, no literal 0 left open.
    pub(super) fn settled(&mut self, e: &ast::Expr, env: &Env) -> Checked<Expr> {
        self.expr(e, env).map(settle)
    }

    /// A condition.
    pub(super) fn condition(&mut self, e: &ast::Expr, env: &Env) -> Checked<Expr> {
        let condition = self.expr(e, env)?;
        if condition.ty == Type::Condition {
            return Ok(condition);
        }
        let words = self.words(&condition.ty);
        Err(self.report(
            Diagnostic::error(Code::ShapeMismatch, e.span, "a condition is needed here")
                .here(format!("this is {words}")),
        ))
    }

    fn name(&mut self, name: &str, span: Span, env: &Env) -> Checked<Expr> {
        if let Some((_, binding)) = env.locals.iter().rev().find(|(known, _)| known == name) {
            return self.bound(binding, span);
        }
        let Some(symbol) = self.symbol(name, env) else { return Err(self.unknown(name, span, env)) };
        let scalar = |dimension| Type::Value(Shape::Scalar, dimension);
        let (kind, ty) = match symbol {
            Symbol::Param(id) => (ExprKind::Param(id), scalar(self.param(id)?.dimension)),
            Symbol::Let(at) => match self.meaning(at, span)? {
                Meaning::Value(id) => {
                    (ExprKind::Let(id), self.let_value(id).map_or(Type::NUMBER, |e| e.ty.clone()))
                }
                Meaning::Domain(_) => return Err(self.no_value(name, "a domain", span)),
                Meaning::Pair(_) => return Err(self.no_value(name, "a contact pair", span)),
            },
            Symbol::Function(at) => return self.bare_function(at, span),
            Symbol::Field(id) => (ExprKind::Field(id), self.field_type(id)?),
            Symbol::State(id) => (ExprKind::State(id), scalar(self.state_dimension(id)?)),
            Symbol::Coordinate(i) => (ExprKind::Coordinate(i), Type::LENGTH),
            Symbol::Word(Word::Time) => (ExprKind::Time, Type::TIME),
            Symbol::Word(Word::Pi) => (ExprKind::Number(std::f64::consts::PI), Type::NUMBER),
            Symbol::Word(Word::Position) => {
                let coordinate = |axis| Expr { kind: ExprKind::Coordinate(axis), ty: Type::LENGTH, span };
                (ExprKind::Tuple(Box::new([coordinate(0), coordinate(1)])), Type::POSITION)
            }
            Symbol::Word(Word::Identity) => {
                (ExprKind::Identity, Type::Value(Shape::Tensor, Dimension::NUMBER))
            }
            Symbol::Path(_) | Symbol::Region(_) | Symbol::Block(_) | Symbol::Event(_) | Symbol::Word(_) => {
                return Err(self.no_value(name, symbol.words(), span));
            }
            Symbol::Broken => return Err(Reported),
        };
        Ok(Expr { kind, ty, span })
    }

    fn bound(&self, binding: &Binding, span: Span) -> Checked<Expr> {
        match binding {
            Binding::Local(id) => {
                Ok(Expr { kind: ExprKind::Local(*id), ty: self.locals[id.0].1.clone(), span })
            }
            Binding::Let(id) => {
                let ty = self.let_value(*id).map_or(Type::NUMBER, |e| e.ty.clone());
                Ok(Expr { kind: ExprKind::Let(*id), ty, span })
            }
            Binding::Broken => Err(Reported),
        }
    }

    fn no_value(&mut self, name: &str, words: &str, span: Span) -> Reported {
        let message = format!("`{name}` is {words}, not a value");
        self.report(Diagnostic::error(Code::WrongKind, span, message))
    }

    /// A function by its name alone: a law with all arguments open.
    fn bare_function(&mut self, at: usize, span: Span) -> Checked<Expr> {
        let signature = self.signature(at)?;
        let open = vec![None; signature.arguments.len()];
        let arguments = signature.arguments.into_iter().map(|(_, ty)| ty).collect();
        let ty = Type::Law(arguments, Box::new(signature.result));
        Ok(Expr { kind: ExprKind::Law(self.function_id(at), open), ty, span })
    }

    /// The id of a function that is in use.
    pub(super) fn function_id(&mut self, at: usize) -> FunctionId {
        let known = self.reached.iter().position(|&other| other == at);
        FunctionId(known.unwrap_or_else(|| {
            self.reached.push(at);
            self.reached.len() - 1
        }))
    }

    /// Whether a name is under elaboration.
    fn is_busy(&self, symbol: Symbol) -> bool {
        match symbol {
            Symbol::Let(at) => matches!(self.lets[at].slot, Slot::Busy),
            Symbol::Param(id) => matches!(self.params[id.0].slot, Slot::Busy),
            _ => false,
        }
    }

    /// Reports an unknown name, with the closest one in scope.
    pub(super) fn unknown(&mut self, name: &str, span: Span, env: &Env) -> Reported {
        let locals = env.locals.iter().map(|(known, _)| known.as_str());
        // What is being defined cannot be meant.
        let names = self.scopes[env.module].iter().filter(|(_, symbol)| !self.is_busy(*symbol));
        let names = names.map(|(known, _)| known);
        let words = Word::ALL.into_iter().map(|(known, _)| known);
        let candidates: Vec<&str> = locals.chain(names).chain(words).collect();
        let mut diagnostic = Diagnostic::error(Code::UnknownName, span, format!("`{name}` is not declared"))
            .help_did_you_mean(name, candidates);
        if ansatz_units::Unit::find(name).is_some() {
            diagnostic = diagnostic.help(format!(
                "`{name}` is a unit only right behind a number; longer units stand in brackets"
            ));
        }
        if let Some(place) = self.private(name) {
            diagnostic = diagnostic.label(place, "this one is private to its block");
        }
        let diagnostic = self.was_dropped(name, diagnostic);
        self.report(diagnostic)
    }

    /// Says so where a variant has dropped what a missing name stood for.
    pub(super) fn was_dropped(&self, name: &str, diagnostic: Diagnostic) -> Diagnostic {
        match self.program.dropped.iter().find(|dropped| dropped.text == name) {
            Some(dropped) => diagnostic
                .label(dropped.span, "dropped here")
                .help(format!("what uses `{name}` goes with it: `drop` or `replace` that as well")),
            None => diagnostic,
        }
    }

    /// Where a block of the model declares a `let` of this name for itself.
    fn private(&self, name: &str) -> Option<Span> {
        let lets = |item: &ast::Item| -> Vec<ast::Ident> {
            match &item.kind {
                ast::ItemKind::Physics(block) => {
                    let lets = block.statements.iter().filter_map(|statement| match &statement.kind {
                        ast::StatementKind::Let(item) => Some(item.name.clone()),
                        _ => None,
                    });
                    lets.collect()
                }
                ast::ItemKind::Fn(function) => {
                    let lets = function.locals.iter().filter_map(|item| match item {
                        ast::BodyItem::Let(item) => Some(item.name.clone()),
                        ast::BodyItem::Local(_) => None,
                    });
                    lets.collect()
                }
                _ => Vec::new(),
            }
        };
        self.program.items.iter().flat_map(lets).find(|found| found.text == name).map(|found| found.span)
    }

    fn unary(&mut self, op: UnaryOp, operand: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        match op {
            UnaryOp::Not => {
                let kind = ExprKind::Not(Box::new(self.condition(operand, env)?));
                Ok(Expr { kind, ty: Type::Condition, span })
            }
            UnaryOp::Neg => {
                let a = self.expr(operand, env)?;
                self.operand(&a)?;
                let ty = a.ty.clone();
                Ok(match a.kind {
                    ExprKind::Number(value) => Expr { kind: ExprKind::Number(-value), ty, span },
                    _ => Expr { kind: ExprKind::Negate(Box::new(a)), ty, span },
                })
            }
        }
    }

    fn compare(
        &mut self,
        op: CompareOp,
        left: &ast::Expr,
        right: &ast::Expr,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        if op == CompareOp::Equal && self.is_word(left, Word::Outcome, env) {
            let id = self.event(right, env)?;
            return Ok(Expr { kind: ExprKind::OutcomeIs(id), ty: Type::Condition, span });
        }
        let (a, b) = (self.expr(left, env), self.expr(right, env));
        let (mut a, mut b) = (a?, b?);
        self.same(&mut a, &mut b, span, "compare")?;
        self.scalar(&a, "what is compared")?;
        let relation = match op {
            CompareOp::Equal => Relation::Equal,
            CompareOp::Less => Relation::Less,
            CompareOp::LessEqual => Relation::LessEqual,
            CompareOp::Greater => Relation::Greater,
            CompareOp::GreaterEqual => Relation::GreaterEqual,
        };
        let kind = ExprKind::Compare(relation, Box::new(settle(a)), Box::new(settle(b)));
        Ok(Expr { kind, ty: Type::Condition, span })
    }

    /// Whether `e` is a word of the language that no name hides.
    pub(super) fn is_word(&self, e: &ast::Expr, word: Word, env: &Env) -> bool {
        let ast::ExprKind::Name(name) = &e.kind else { return false };
        let hidden = env.locals.iter().any(|(known, _)| known == name);
        !hidden && self.symbol(name, env) == Some(Symbol::Word(word))
    }

    /// The event that a name stands for.
    fn event(&mut self, e: &ast::Expr, env: &Env) -> Checked<EventId> {
        let Some(name) = e.as_name() else {
            return Err(self.report(Diagnostic::error(
                Code::WrongKind,
                e.span,
                "the name of an event is needed here",
            )));
        };
        match self.symbol(&name.text, env) {
            Some(Symbol::Event(id)) => Ok(id),
            Some(Symbol::Broken) => Err(Reported),
            Some(other) => {
                let message = format!("`{}` is {}, not an event", name.text, other.words());
                Err(self.report(Diagnostic::error(Code::WrongKind, e.span, message)))
            }
            None => {
                let events: Vec<&str> = self.names_of(|symbol| matches!(symbol, Symbol::Event(_)));
                let diagnostic = Diagnostic::error(
                    Code::UnknownName,
                    e.span,
                    format!("there is no event `{}`", name.text),
                )
                .help_did_you_mean(&name.text, events);
                Err(self.report(diagnostic))
            }
        }
    }

    /// Names of the model that stand for a certain kind of thing.
    pub(super) fn names_of(&self, is: fn(Symbol) -> bool) -> Vec<&str> {
        self.scopes[0].iter().filter(|(_, symbol)| is(*symbol)).map(|(name, _)| name).collect()
    }

    fn tuple(
        &mut self,
        items: &[ast::Expr],
        unit: Option<&ast::UnitExpr>,
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let mut items = self.members(items, unit, env)?;
        let ty = self.all_same(&mut items, span, "make a vector of components of")?;
        for item in &items {
            self.scalar(item, "a component")?;
        }
        let dimension = value(&ty).map_or(Dimension::NUMBER, |(_, dimension)| dimension);
        items.iter_mut().for_each(|item| coerce(item, &Type::NUMBER));
        let kind = match items.len() {
            2 => <[Expr; 2]>::try_from(items).ok().map(|items| ExprKind::Tuple(Box::new(items))),
            _ => <[Expr; 3]>::try_from(items).ok().map(|items| ExprKind::Triple(Box::new(items))),
        };
        match kind {
            Some(kind) => Ok(Expr { kind, ty: Type::Value(Shape::Vector, dimension), span }),
            None => Err(self.report(Diagnostic::error(
                Code::ShapeMismatch,
                span,
                "a vector has two or three components",
            ))),
        }
    }

    fn record(&mut self, members: &[ast::NamedExpr], span: Span, env: &Env) -> Checked<Expr> {
        let values: Vec<Checked<Expr>> = members.iter().map(|member| self.expr(&member.value, env)).collect();
        let values = values.into_iter().collect::<Checked<Vec<_>>>()?;
        let types =
            members.iter().zip(&values).map(|(member, value)| (member.name.text.clone(), value.ty.clone()));
        let ty = Type::Record(types.collect());
        Ok(Expr { kind: ExprKind::Record(values), ty, span })
    }

    /// `u.z`, `E.rz`, `q.l1`, `touch.gap`.
    fn member(&mut self, object: &ast::Expr, member: &ast::Ident, span: Span, env: &Env) -> Checked<Expr> {
        if let Some(pair) = self.pair_named(object, env)? {
            return self.pair_member(pair, member, span);
        }
        let object = self.expr(object, env)?;
        let kind = match &object.ty {
            Type::Value(Shape::Vector, dimension) => {
                let at = self.axis_names().iter().position(|name| *name == member.text);
                at.map(|i| {
                    (Type::Value(Shape::Scalar, *dimension), ExprKind::Component(Box::new(object.clone()), i))
                })
            }
            Type::Value(Shape::Tensor, dimension) => {
                let at = self.component_names().iter().position(|name| *name == member.text);
                at.map(|k| {
                    (
                        Type::Value(Shape::Scalar, *dimension),
                        ExprKind::Component2(Box::new(object.clone()), k / 3, k % 3),
                    )
                })
            }
            Type::Record(members) => {
                let at = members.iter().position(|(name, _)| *name == member.text);
                at.map(|i| (members[i].1.clone(), ExprKind::Member(Box::new(object.clone()), i)))
            }
            _ => None,
        };
        match kind {
            Some((ty, kind)) => Ok(Expr { kind, ty, span }),
            None => Err(self.unknown_member(&object, member)),
        }
    }

    fn unknown_member(&mut self, object: &Expr, member: &ast::Ident) -> Reported {
        let names: Vec<String> = match &object.ty {
            Type::Value(Shape::Vector, _) => self.axis_names().to_vec(),
            Type::Value(Shape::Tensor, _) => self.component_names().to_vec(),
            Type::Record(members) => members.iter().map(|(name, _)| name.clone()).collect(),
            _ => Vec::new(),
        };
        let message = format!("there is no member `{}` here", member.text);
        let mut diagnostic = Diagnostic::error(Code::UnknownMember, member.span, message)
            .label(object.span, format!("this is {}", self.words(&object.ty)));
        if !names.is_empty() {
            let list = names.iter().map(|name| format!("`.{name}`")).collect::<Vec<_>>().join(", ");
            diagnostic = diagnostic.help(format!("it has {list}"));
        }
        self.report(diagnostic)
    }

    /// Names of vector components in tensor index order: `r`, `theta`, `z` or `x`, `y`, `z`.
    pub(super) fn axis_names(&self) -> [String; 3] {
        let [a, b] = &self.coordinates.names;
        match self.coordinates.frame {
            crate::model::Frame::Axisymmetric => [a.clone(), "theta".into(), b.clone()],
            crate::model::Frame::PlaneStrain => [a.clone(), b.clone(), "z".into()],
        }
    }

    /// Names of tensor components row by row; the hoop direction is `t`: `rr`, `rt`, `rz`, `tr`, `tt`, ..
    fn component_names(&self) -> [String; 9] {
        let axes = self.axis_names().map(|name| if name == "theta" { "t".to_owned() } else { name });
        std::array::from_fn(|k| format!("{}{}", axes[k / 3], axes[k % 3]))
    }

    /// `e@(0, z_n)`, `e@(50 s)`, `e@start`, `e@event`.
    fn at(&mut self, value: &ast::Expr, place: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        let value = self.expr(value, env);
        if let Some(name) = place.as_name() {
            let start = self.symbol(&name.text, env).is_none() && name.text == "start";
            let kind = if start { None } else { Some(self.event(place, env)?) };
            let value = Box::new(settle(value?));
            let ty = value.ty.clone();
            let kind = match kind {
                Some(event) => ExprKind::AtEvent(value, event),
                None => ExprKind::AtTime(value, Box::new(self.start_time(place.span)?)),
            };
            return Ok(Expr { kind, ty, span });
        }
        let place = self.expr(place, env).map(|mut place| {
            if let Type::Value(Shape::Vector, _) = place.ty {
                super::shape::coerce(&mut place, &Type::POSITION);
            }
            settle(place)
        });
        let value = value.map(settle);
        let (value, place) = (Box::new(value?), Box::new(place?));
        let ty = value.ty.clone();
        let kind = match place.ty {
            Type::TIME => ExprKind::AtTime(value, place),
            Type::POSITION => ExprKind::AtPoint(value, place),
            _ => {
                let words = self.words(&place.ty);
                return Err(self.report(
                    Diagnostic::error(
                        Code::WrongKind,
                        place.span,
                        "after `@` stands a time, a point or an event",
                    )
                    .here(format!("this is {words}"))
                    .help("write e.g. `p@(0, 2 mm)`, `p@(0.5 s)`, `p@start` or `p@NAME` of an event"),
                ));
            }
        };
        Ok(Expr { kind, ty, span })
    }
}

fn operator(op: BinaryOp) -> Arithmetic {
    match op {
        BinaryOp::Add => Arithmetic::Add,
        BinaryOp::Sub => Arithmetic::Sub,
        BinaryOp::Mul => Arithmetic::Mul,
        BinaryOp::Div => Arithmetic::Div,
        BinaryOp::Pow => Arithmetic::Pow,
    }
}
