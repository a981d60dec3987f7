//! Parameters, and the ranges and sets of values that quantities may take.

use super::shape::settle;
use super::{Checked, Checker, Declared, Env, Reported, Slot, zero};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Bounds, Expr, Param, ParamId, Shape, Type};
use crate::syntax::ast;
use ansatz_units::Dimension;

impl Checker<'_> {
    /// A parameter, elaborated when it is first met.
    pub(super) fn param(&mut self, id: ParamId) -> Checked<&Param> {
        if matches!(self.params[id.0].slot, Slot::Waiting) {
            self.params[id.0].slot = Slot::Busy;
            let Declared { ast, .. } = self.params[id.0];
            let param = self.waited_for(&ast.name, |checker| checker.new_param(id));
            let broken = matches!(self.params[id.0].slot, Slot::Broken);
            self.params[id.0].slot = param.ok().filter(|_| !broken).map_or(Slot::Broken, Slot::Done);
        }
        if matches!(self.params[id.0].slot, Slot::Busy) {
            self.params[id.0].slot = Slot::Broken;
            let name = &self.params[id.0].ast.name;
            let message = format!("the default of `{}` uses its own value", name.text);
            return Err(self.report(Diagnostic::error(Code::Cycle, name.span, message)));
        }
        match &self.params[id.0].slot {
            Slot::Done(param) => Ok(param),
            _ => Err(Reported),
        }
    }

    fn new_param(&mut self, id: ParamId) -> Checked<Param> {
        let Declared { docs, ast, .. } = self.params[id.0];
        let env = Env::default();
        let declared = ast.ty.as_ref().map(|ty| self.ty(ty)).transpose()?;
        let Some(default) = &ast.value else {
            let message = format!("parameter `{}` has no value", ast.name.text);
            return Err(self.report(
                Diagnostic::error(Code::MissingArgument, ast.name.span, message)
                    .help("only parts have inputs without a value; write `= ..`"),
            ));
        };
        let value = match &declared {
            Some(ty) => self.typed(default, ty, &format!("`{}`", ast.name.text), &env)?,
            None => self.settled(default, &env)?,
        };
        let dimension = self.scalar(&value, "a parameter")?;
        let ty = Type::Value(Shape::Scalar, dimension);
        let bounds = ast.bounds.as_ref().map(|bounds| self.bounds(bounds, &ty, &ast.name)).transpose()?;
        let unit = self.written_unit(default, dimension);
        Ok(Param {
            name: ast.name.text.clone(),
            doc: docs.to_owned(),
            dimension,
            default: value,
            bounds,
            unit,
            span: ast.name.span,
        })
    }

    /// Size in SI and text of the unit in which a default is written.
    fn written_unit(&mut self, default: &ast::Expr, dimension: Dimension) -> (f64, String) {
        let number = match &default.kind {
            ast::ExprKind::Unary { operand, .. } => &operand.kind,
            kind => kind,
        };
        if let ast::ExprKind::Number(ast::Number { unit: Some(written), .. }) = number
            && let Ok(unit) = self.unit(written)
        {
            let text = written.text.trim_start_matches('[').trim_end_matches(']').trim();
            return (unit.factor_to_si(), text.to_owned());
        }
        (self.units.scale(dimension), super::unit::unit_text(&self.units, dimension))
    }

    /// `in a .. b` or `in {a, b}` of a quantity.
    fn bounds(&mut self, bounds: &ast::Bounds, ty: &Type, name: &ast::Ident) -> Checked<Bounds> {
        let what = format!("a bound of `{}`", name.text);
        match bounds {
            ast::Bounds::Range(range) => {
                let (low, high) = self.range(range, ty, &what)?;
                Ok(Bounds::Range(low, high))
            }
            ast::Bounds::Set(set) => Ok(Bounds::Set(self.set(set, ty, &what, &Env::default())?)),
        }
    }

    pub(super) fn range(&mut self, range: &ast::Range, ty: &Type, what: &str) -> Checked<(Expr, Expr)> {
        let env = Env::default();
        let (low, high) = (self.typed(&range.low, ty, what, &env), self.typed(&range.high, ty, what, &env));
        Ok((low?, high?))
    }

    /// Members of a set, each of the given type.
    pub(super) fn set(&mut self, set: &ast::Set, ty: &Type, what: &str, env: &Env) -> Checked<Vec<Expr>> {
        let items = self.members(&set.items, set.unit.as_ref(), env)?;
        let items: Vec<Checked<Expr>> = items.into_iter().map(|item| self.expect(item, ty, what)).collect();
        items.into_iter().collect()
    }

    /// Values in braces or parentheses, each with the unit behind them if there is one.
    pub(super) fn members(
        &mut self,
        items: &[ast::Expr],
        unit: Option<&ast::UnitExpr>,
        env: &Env,
    ) -> Checked<Vec<Expr>> {
        let values: Vec<Checked<Expr>> = items.iter().map(|item| self.expr(item, env)).collect();
        let unit = unit.map(|unit| self.unit(unit)).transpose()?;
        let values = values.into_iter().collect::<Checked<Vec<_>>>()?;
        let Some(unit) = unit else { return Ok(values) };
        for value in &values {
            self.need_number(value, "what has its unit behind the bracket")?;
        }
        Ok(values.into_iter().map(|value| self.with_unit(settle(value), unit)).collect())
    }

    /// The parameters, faulty ones as zero.
    pub(super) fn taken_params(&mut self) -> Vec<Param> {
        let taken = self.params.iter().map(|declared| match &declared.slot {
            Slot::Done(param) => param.clone(),
            _ => Param {
                name: declared.ast.name.text.clone(),
                doc: String::new(),
                dimension: Dimension::NUMBER,
                default: zero(declared.ast.name.span),
                bounds: None,
                unit: (1.0, "1".into()),
                span: declared.ast.name.span,
            },
        });
        taken.collect()
    }
}
