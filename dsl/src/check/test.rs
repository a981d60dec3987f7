//! Tests: what a model claims of itself.

use super::shape::{coerce, settle};
use super::{Binding, Checked, Checker, Env, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Check, Expr, ExprKind, Shape, Test, Type, Values};
use crate::syntax::ast::{self, CheckKind, Over, Tolerance};

impl Checker<'_> {
    /// A `test` item.
    pub(super) fn test(&mut self, ast: &ast::Test) {
        if self.rest.tests.iter().any(|other| other.title == ast.title.value) {
            let message = format!("there are two tests \"{}\"", ast.title.value);
            self.sink.push(Diagnostic::error(Code::DuplicateName, ast.title.span, message));
        }
        let checks = self.checks(&ast.checks, &mut Env::default());
        let needs_run = checks.iter().any(|check| self.needs_run(check));
        self.rest.tests.push(Test {
            title: ast.title.value.clone(),
            checks,
            needs_run,
            span: ast.title.span,
        });
    }

    /// The statements that are right.
    fn checks(&mut self, checks: &[ast::Check], env: &mut Env) -> Vec<Check> {
        let depth = env.locals.len();
        let done = checks.iter().filter_map(|check| self.check_statement(check, env).ok()).collect();
        env.locals.truncate(depth);
        done
    }

    fn check_statement(&mut self, check: &ast::Check, env: &mut Env) -> Checked<Check> {
        match &check.kind {
            CheckKind::Let(item) => {
                let value = self.let_value_of(item, env);
                let Ok(value) = value else {
                    env.bind(&item.name, Binding::Broken);
                    return Err(Reported);
                };
                let id = self.local(&item.name.text, value.ty.clone());
                env.bind(&item.name, Binding::Local(id));
                Ok(Check::Let(id, value))
            }
            CheckKind::Each { name, over, checks } => self.each(name, over, checks, env),
            CheckKind::Expect(condition) => Ok(Check::Holds(self.condition(condition, env)?, check.span)),
            CheckKind::Near { left, right, tolerance } => self.near(left, right, tolerance, check.span, env),
        }
    }

    fn each(
        &mut self,
        name: &ast::Ident,
        over: &Over,
        checks: &[ast::Check],
        env: &mut Env,
    ) -> Checked<Check> {
        let values = self.values_over(over, env);
        let depth = env.locals.len();
        let binding = match &values {
            Ok((ty, _)) => Binding::Local(self.local(&name.text, ty.clone())),
            Err(Reported) => Binding::Broken,
        };
        env.bind(name, binding.clone());
        let checks = self.checks(checks, env);
        env.locals.truncate(depth);
        match (values, binding) {
            (Ok((_, values)), Binding::Local(id)) => Ok(Check::Each(id, values, checks)),
            _ => Err(Reported),
        }
    }

    /// What a loop runs over, and the type of its variable.
    fn values_over(&mut self, over: &Over, env: &Env) -> Checked<(Type, Values)> {
        match over {
            Over::Steps { range, by } => {
                let (from, to, by) =
                    (self.expr(&range.low, env), self.expr(&range.high, env), self.expr(by, env));
                let mut items = [from?, to?, by?];
                let ty = self.all_same(&mut items, range.span(), "run between")?;
                let [from, to, by] = items.map(settle);
                self.scalar(&to, "the end of a loop")?;
                let ty = if ty == Type::Zero { Type::NUMBER } else { ty };
                Ok((ty, Values::Range { from, to, by }))
            }
            Over::Set(set) => {
                let mut items = self.members(&set.items, set.unit.as_ref(), env)?;
                let ty = self.all_same(&mut items, set.span, "make a set of")?;
                let ty = if ty == Type::Zero { Type::NUMBER } else { ty };
                Ok((ty, Values::Set(items.into_iter().map(settle).collect())))
            }
        }
    }

    fn near(
        &mut self,
        left: &ast::Expr,
        right: &ast::Expr,
        tolerance: &Tolerance,
        span: crate::source::Span,
        env: &Env,
    ) -> Checked<Check> {
        let (value, expected) = (self.expr(left, env), self.expr(right, env));
        let (tolerance, percent) = match tolerance {
            Tolerance::Absolute(e) => (self.expr(e, env), false),
            Tolerance::Percent(e) => (self.typed(e, &Type::NUMBER, "a percentage", env), true),
        };
        let (mut value, mut expected, mut tolerance) = (value?, expected?, tolerance?);
        self.same(&mut value, &mut expected, span, "compare")?;
        let (value, expected) = (settle(value), settle(expected));
        let (_, dimension) = self.operand(&value)?;
        if !percent {
            let ty = Type::Value(Shape::Scalar, dimension);
            coerce(&mut tolerance, &ty);
            tolerance = self.expect(tolerance, &ty, "the tolerance")?;
        }
        Ok(Check::Near { value, expected, tolerance, percent, span })
    }

    /// Whether a check reads a run: its outcome, an event, a time or the whole of it.
    fn needs_run(&self, check: &Check) -> bool {
        match check {
            Check::Let(_, value) => self.reads_run(value),
            Check::Each(_, _, checks) => checks.iter().any(|check| self.needs_run(check)),
            Check::Holds(condition, _) => self.reads_run(condition),
            Check::Near { value, expected, tolerance, .. } => {
                [value, expected, tolerance].into_iter().any(|e| self.reads_run(e))
            }
        }
    }

    fn reads_run(&self, e: &Expr) -> bool {
        let own = matches!(
            e.kind,
            ExprKind::ReduceRun(..) | ExprKind::AtTime(..) | ExprKind::AtEvent(..) | ExprKind::OutcomeIs(_)
        );
        let named = match &e.kind {
            ExprKind::Let(id) => self.let_value(*id).is_some_and(|value| self.reads_run(value)),
            _ => false,
        };
        own || named || e.children().into_iter().any(|child| self.reads_run(child))
    }
}
