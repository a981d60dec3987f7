//! Derivatives that the language writes: `dt`, `grad`, `along` and `diff`. All use the exact chain rule of the scalar stage.

use super::value::tensor;
use super::{Derivative, FieldInput, Lowered, Lowering, SymbolKind, Value, internal, unsupported};
use crate::derive;
use crate::model::{Expr, ExprKind, Frame};
use crate::scalar::{Id, Symbol, substitute, symbols_of};
use crate::source::Span;

impl<'m> Lowering<'m> {
    /// `dt(value)`: the chain rule over fields, states, functionals and time.
    pub(super) fn rate(&mut self, value: &Value, span: Span) -> Lowered<Value> {
        self.chain(value, span, &mut |lowering, kind| {
            Ok(match kind {
                SymbolKind::Time => Some(lowering.pool.one()),
                SymbolKind::State(state) => Some(lowering.input(SymbolKind::StateRate(state))),
                SymbolKind::Quantity(quantity) => Some(lowering.input(SymbolKind::QuantityRate(quantity))),
                SymbolKind::Field(input) | SymbolKind::Frozen(input) => {
                    Some(lowering.input(SymbolKind::FieldRate(input)))
                }
                SymbolKind::Bound(k) => Some(lowering.input(SymbolKind::BoundRate(k))),
                SymbolKind::StateRate(_)
                | SymbolKind::QuantityRate(_)
                | SymbolKind::FieldRate(_)
                | SymbolKind::BoundRate(_) => {
                    return Err(unsupported(
                        span,
                        "second time derivatives are not supported; declare the velocity as an unknown",
                    ));
                }
                SymbolKind::Gap(_) | SymbolKind::PairNormal(..) => {
                    return Err(unsupported(span, "the rate of a gap or of its normal is not supported"));
                }
                _ => None,
            })
        })
    }

    /// `grad(value)`: of a scalar a vector, of a vector the tensor `d v_i / d x_j`, with the terms of curved coordinates.
    pub(super) fn grad(&mut self, value: &Value, span: Span) -> Lowered<Value> {
        let zero = self.pool.zero();
        if matches!(value, Value::Zero) {
            return Ok(Value::Zero);
        }
        let by = |direction| Derivative::Coordinate(direction);
        let along = [self.partial(value, by(0), span)?, self.partial(value, by(1), span)?];
        let axes = self.model.coordinates.frame.axes();
        match (value, along) {
            (Value::Scalar(_), [Value::Scalar(a), Value::Scalar(b)]) => {
                let mut gradient = [zero; 3];
                (gradient[axes[0]], gradient[axes[1]]) = (a, b);
                Ok(Value::Vector(gradient))
            }
            (Value::Vector(v), [Value::Vector(a), Value::Vector(b)]) => {
                let mut gradient = tensor(|i, j| {
                    if j == axes[0] {
                        a[i]
                    } else if j == axes[1] {
                        b[i]
                    } else {
                        zero
                    }
                });
                if self.model.coordinates.frame == Frame::Axisymmetric {
                    self.add_hoop(&mut gradient, v);
                }
                Ok(Value::Tensor(gradient))
            }
            _ => Err(unsupported(span, "only scalars and vectors have a gradient here")),
        }
    }

    /// The column of a cylindrical gradient that comes from the turning base vectors: `v_r / r` and `-v_theta / r`.
    fn add_hoop(&mut self, gradient: &mut [Id; 9], v: &[Id; 3]) {
        let r = self.input(SymbolKind::Coordinate(0));
        let hoop = self.pool.div(v[0], r);
        let turned = self.pool.div(v[1], r);
        gradient[4] = hoop;
        gradient[1] = self.pool.neg(turned);
    }

    /// `along(value)`: the derivative of every component by the arc length of the path.
    pub(super) fn along(&mut self, value: &Value, span: Span) -> Lowered<Value> {
        self.partial(value, Derivative::Along, span)
    }

    /// `hoop(v)`: `v_r/r` in axisymmetric models, else zero.
    pub(super) fn hoop(&mut self, value: &Value, span: Span) -> Lowered<Value> {
        match (value, self.model.coordinates.frame) {
            (Value::Vector(v), Frame::Axisymmetric) => {
                let r = self.input(SymbolKind::Coordinate(0));
                Ok(Value::Scalar(self.pool.div(v[0], r)))
            }
            (Value::Vector(_) | Value::Zero, _) => Ok(Value::Scalar(self.pool.zero())),
            _ => Err(internal(span, "a vector was expected")),
        }
    }

    fn partial(&mut self, value: &Value, by: Derivative, span: Span) -> Lowered<Value> {
        self.chain(value, span, &mut |lowering, kind| {
            let (make, input): (fn(FieldInput) -> SymbolKind, FieldInput) = match (kind, by) {
                (SymbolKind::Coordinate(axis), Derivative::Coordinate(direction)) => {
                    return Ok((axis == direction).then(|| lowering.pool.one()));
                }
                (SymbolKind::Coordinate(axis), Derivative::Along) => {
                    return Ok(Some(lowering.input(SymbolKind::Tangent(axis))));
                }
                (SymbolKind::Tangent(axis), Derivative::Along) => {
                    return Ok(Some(lowering.input(SymbolKind::Curvature(axis))));
                }
                (SymbolKind::Tangent(_) | SymbolKind::Curvature(_) | SymbolKind::Normal(..), _) => {
                    return Err(unsupported(span, "this derivative of the shape of a path is not known"));
                }
                (SymbolKind::Field(input), _) => (SymbolKind::Field, input),
                (SymbolKind::FieldRate(input), _) => (SymbolKind::FieldRate, input),
                (SymbolKind::Frozen(input), _) => (SymbolKind::Frozen, input),
                (SymbolKind::Test(input), _) => (SymbolKind::Test, input),
                (SymbolKind::Bound(_) | SymbolKind::BoundRate(_), _) => {
                    return Err(unsupported(span, "a gradient of the variable of `diff`"));
                }
                _ => return Ok(None),
            };
            if input.derivative.is_some() {
                return Err(unsupported(
                    span,
                    "second derivatives in space are not supported; declare the gradient as a field",
                ));
            }
            Ok(Some(lowering.input(make(FieldInput { derivative: Some(by), ..input }))))
        })
    }

    /// Derivative of every component when each symbol moves at the rate that `rate_of` gives its kind.
    fn chain(
        &mut self,
        value: &Value,
        span: Span,
        rate_of: &mut dyn FnMut(&mut Self, SymbolKind) -> Lowered<Option<Id>>,
    ) -> Lowered<Value> {
        if matches!(value, Value::Zero) {
            return Ok(Value::Zero);
        }
        let roots = value.components(&mut self.pool);
        if roots.is_empty() {
            return Err(internal(span, "only scalars, vectors and tensors have derivatives"));
        }
        let mut rates = Vec::new();
        for symbol in symbols_of(&self.pool, &roots) {
            if let Some(rate) = rate_of(self, self.symbols.kind(symbol))? {
                rates.push((symbol, rate));
            }
        }
        Ok(Value::from_components(&derive::tangent(&mut self.pool, &roots, &rates)))
    }

    /// `diff(of, by)`: `by` is bound to fresh variables, the result differentiated, and the value of `by` put back.
    pub(super) fn diff(&mut self, of: &'m Expr, by: &'m Expr, span: Span) -> Lowered<Value> {
        let at = self.expr(by)?;
        let at = self.shaped(at, &by.ty);
        let at = at.components(&mut self.pool);
        let variables: Vec<Id> = at.iter().map(|_| self.fresh()).collect();
        let variable = Value::from_components(&variables);
        let value = match by.kind {
            ExprKind::Local(local) => self.with_local(local, variable, |lowering| lowering.expr(of))?,
            ExprKind::Let(id) => self.with_let(id, variable, |lowering| lowering.expr(of))?,
            _ => {
                return Err(unsupported(
                    by.span,
                    "`diff` differentiates by a name: a function argument or a `let`",
                ));
            }
        };
        let symbols: Vec<Symbol> = symbols_of(&self.pool, &variables).into_iter().collect();
        let derivatives = self.partial_derivatives(&value, &symbols, span)?;
        self.put_back(&derivatives, &symbols, &at, span)
    }

    fn partial_derivatives(&mut self, value: &Value, symbols: &[Symbol], span: Span) -> Lowered<Vec<Id>> {
        let roots = value.components(&mut self.pool);
        match (roots.as_slice(), symbols) {
            ([], _) => Err(internal(span, "`diff` of something without components")),
            ([root], _) => Ok(derive::gradient(&mut self.pool, *root, symbols)),
            (_, [symbol]) => Ok(derive::derivative(&mut self.pool, &roots, *symbol)),
            _ => Err(unsupported(span, "`diff` of a vector or tensor by a vector or tensor")),
        }
    }

    /// Puts values in the place of bound variables, and their rates in the place of bound rates.
    fn put_back(&mut self, derivatives: &[Id], symbols: &[Symbol], at: &[Id], span: Span) -> Lowered<Value> {
        let mut images: Vec<(Symbol, Id)> = symbols.iter().copied().zip(at.iter().copied()).collect();
        let used = symbols_of(&self.pool, derivatives);
        for (symbol, &value) in symbols.iter().zip(at) {
            let SymbolKind::Bound(k) = self.symbols.kind(*symbol) else { continue };
            let Some(rate) = self.symbols.find(SymbolKind::BoundRate(k)).filter(|rate| used.contains(rate))
            else {
                continue;
            };
            if let Value::Scalar(moving) = self.rate(&Value::Scalar(value), span)? {
                images.push((rate, moving));
            }
        }
        let image = |symbol| images.iter().find(|(s, _)| *s == symbol).map(|(_, id)| *id);
        Ok(Value::from_components(&substitute(&mut self.pool, derivatives, &image)))
    }
}
