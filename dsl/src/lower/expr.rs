//! Lowering of expressions, kind by kind.

use super::{
    Condition, FieldInput, Frame, Lowered, Lowering, Place, SymbolKind, Table, Value, algebra, internal,
    unsupported,
};
use crate::model::{
    Arm, Builtin, Expr, ExprKind, FieldId, FunctionId, LetId, LocalId, PairId, Piece, RegionId, Shape, Type,
};
use crate::scalar::{Id, Relation};
use crate::source::Span;

impl<'m> Lowering<'m> {
    /// Lowers an expression at the current place.
    pub(super) fn expr(&mut self, expr: &'m Expr) -> Lowered<Value> {
        use ExprKind as K;
        let span = expr.span;
        Ok(match &expr.kind {
            K::Number(x) => Value::Scalar(self.pool.constant(*x)),
            K::Param(param) => Value::Scalar(self.input(SymbolKind::Parameter(*param))),
            K::Let(id) => self.let_value(*id)?,
            K::Local(id) => self.local(*id, span)?,
            K::Field(field) => self.field(*field, false, span)?,
            K::Test(field) => self.field(*field, true, span)?,
            K::State(state) => Value::Scalar(self.input(SymbolKind::State(*state))),
            K::Coordinate(axis) => self.coordinate(*axis, span)?,
            K::Time => Value::Scalar(self.input(SymbolKind::Time)),
            K::Identity => Value::Tensor(algebra::identity(&mut self.pool)),
            K::Tuple(pair) => self.tuple(&pair[0], &pair[1])?,
            K::Triple(entries) => {
                let [x, y, z] = &**entries;
                Value::Vector([self.scalar_expr(x)?, self.scalar_expr(y)?, self.scalar_expr(z)?])
            }
            K::Negate(a) => {
                let a = self.expr(a)?;
                algebra::negate(&mut self.pool, &a)
            }
            K::Arithmetic(op, a, b) => {
                let (a, b) = (self.expr(a)?, self.expr(b)?);
                algebra::arithmetic(&mut self.pool, *op, &a, &b)
                    .ok_or_else(|| internal(span, "shapes do not fit"))?
            }
            K::Compare(..) | K::And(..) | K::Or(..) | K::Not(_) | K::OutcomeIs(_) => {
                Value::Condition(self.condition(expr)?)
            }
            K::Component(a, i) => {
                let a = self.expr(a)?;
                let vector = algebra::vector(&mut self.pool, &a)
                    .ok_or_else(|| internal(span, "a vector was expected"))?;
                Value::Scalar(vector[*i])
            }
            K::Component2(a, i, j) => {
                let a = self.expr(a)?;
                let a = algebra::tensor_of(&mut self.pool, &a)
                    .ok_or_else(|| internal(span, "a tensor was expected"))?;
                Value::Scalar(a[3 * i + j])
            }
            K::Member(record, i) => match self.expr(record)? {
                Value::Record(members) if *i < members.len() => members[*i].clone(),
                _ => return Err(internal(span, "a record was expected")),
            },
            K::Record(members) => Value::Record(self.exprs(members)?),
            K::Builtin(builtin, arguments) => self.builtin(*builtin, arguments, span)?,
            K::Apply(function, arguments) => {
                let arguments = self.exprs(arguments)?;
                self.apply(*function, arguments, span)?
            }
            K::ApplyLocal(local, arguments) => {
                let (law, arguments) = (self.local(*local, span)?, self.exprs(arguments)?);
                self.apply_law(law, arguments, span)?
            }
            K::Law(function, arguments) => {
                let fixed: Lowered<_> =
                    arguments.iter().map(|a| a.as_ref().map(|a| self.expr(a)).transpose()).collect();
                Value::Law(*function, fixed?)
            }
            K::Rate(a) => {
                let a = self.expr(a)?;
                self.rate(&a, span)?
            }
            K::Diff(a, by) => self.diff(a, by, span)?,
            K::Frozen(a) => self.frozen(a)?,
            K::MatchValue { scrutinee, arms, otherwise, .. } => {
                self.match_value(scrutinee, arms, otherwise)?
            }
            K::MatchRegion(arms, otherwise) => self.match_region(arms, otherwise.as_deref(), span)?,
            K::Reduce(..) | K::Measure(_) | K::Force(..) | K::AtPoint(..) => self.reduce(expr)?,
            K::Normal(domain) => self.normal(domain, span)?,
            K::Gap(pair) => self.gap(*pair, span)?,
            K::PairNormal(pair) => self.pair_normal(*pair, span)?,
            K::ReduceRun(..) | K::AtTime(..) | K::AtEvent(..) => self.run_value(expr)?,
            K::Held(..) => return Err(unsupported(span, "`for` stands only in the condition of an event")),
        })
    }

    /// Lowers a scalar at the current place.
    pub(super) fn scalar_expr(&mut self, expr: &'m Expr) -> Lowered<Id> {
        let value = self.expr(expr)?;
        self.scalar(&value, expr.span)
    }

    fn exprs(&mut self, list: &'m [Expr]) -> Lowered<Vec<Value>> {
        list.iter().map(|expr| self.expr(expr)).collect()
    }

    fn let_value(&mut self, id: LetId) -> Lowered<Value> {
        if let Some(value) = self.overrides.get(&id).or_else(|| self.known_lets.get(&(id, self.epoch))) {
            return Ok(value.clone());
        }
        let definition = &self.model.lets[id.0];
        let outer = std::mem::replace(&mut self.naming, definition.name.clone());
        let frame = std::mem::take(&mut self.frame);
        let value = self.expr(&definition.value);
        (self.naming, self.frame) = (outer, frame);
        let value = value?;
        self.hint(&value, &definition.name);
        self.known_lets.insert((id, self.epoch), value.clone());
        Ok(value)
    }

    /// A function argument, or a let of the function, lowered where it is used so that `diff` sees through it.
    fn local(&mut self, id: LocalId, span: Span) -> Lowered<Value> {
        let frame = &self.frame;
        if let Some(value) = frame.values.get(&id).or_else(|| frame.known.get(&(id, self.epoch))) {
            return Ok(value.clone());
        }
        let Some(&expr) = frame.lets.get(&id) else {
            return Err(internal(span, "a local name has no value"));
        };
        let value = self.expr(expr)?;
        self.hint(&value, &self.model.locals[id.0]);
        self.frame.known.insert((id, self.epoch), value.clone());
        Ok(value)
    }

    /// Binds a local name to `value` while `lower` runs.
    pub(super) fn with_local<T>(
        &mut self,
        id: LocalId,
        value: Value,
        lower: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let epoch = self.next_epoch();
        let outer = std::mem::replace(&mut self.epoch, epoch);
        let hidden = self.frame.values.insert(id, value);
        let result = lower(self);
        match hidden {
            Some(value) => self.frame.values.insert(id, value),
            None => self.frame.values.remove(&id),
        };
        self.epoch = outer;
        result
    }

    /// Binds a let to `value` while `lower` runs.
    pub(super) fn with_let<T>(&mut self, id: LetId, value: Value, lower: impl FnOnce(&mut Self) -> T) -> T {
        let epoch = self.next_epoch();
        let outer = std::mem::replace(&mut self.epoch, epoch);
        let hidden = self.overrides.insert(id, value);
        let result = lower(self);
        match hidden {
            Some(value) => self.overrides.insert(id, value),
            None => self.overrides.remove(&id),
        };
        self.epoch = outer;
        result
    }

    fn apply(&mut self, id: FunctionId, arguments: Vec<Value>, span: Span) -> Lowered<Value> {
        let function = &self.model.functions[id.0];
        if arguments.len() != function.arguments.len() {
            return Err(internal(span, "a function has another number of arguments"));
        }
        let mut frame = Frame::default();
        for ((local, ty), value) in function.arguments.iter().zip(arguments) {
            let value = self.shaped(value, ty);
            frame.values.insert(*local, value);
        }
        frame.lets = function.lets.iter().map(|(local, expr)| (*local, expr)).collect();
        let outer = std::mem::replace(&mut self.frame, frame);
        let result = self.expr(&function.result);
        self.frame = outer;
        let result = result?;
        self.hint(&result, &function.name);
        Ok(result)
    }

    fn apply_law(&mut self, law: Value, arguments: Vec<Value>, span: Span) -> Lowered<Value> {
        let Value::Law(function, fixed) = law else { return Err(internal(span, "a law was expected")) };
        let mut given = arguments.into_iter();
        let all: Option<Vec<Value>> =
            fixed.into_iter().map(|argument| argument.or_else(|| given.next())).collect();
        let all = all.ok_or_else(|| internal(span, "a law has another number of arguments"))?;
        self.apply(function, all, span)
    }

    /// Gives a literal 0 the shape that its type asks for.
    pub(super) fn shaped(&mut self, value: Value, ty: &Type) -> Value {
        let (Value::Zero, Type::Value(shape, _)) = (&value, ty) else { return value };
        let zero = self.pool.zero();
        match shape {
            Shape::Scalar => Value::Scalar(zero),
            Shape::Vector => Value::Vector([zero; 3]),
            Shape::Tensor => Value::Tensor([zero; 9]),
        }
    }

    fn tuple(&mut self, first: &'m Expr, second: &'m Expr) -> Lowered<Value> {
        let pair = [self.scalar_expr(first)?, self.scalar_expr(second)?];
        Ok(self.in_plane(pair))
    }

    /// The vector with these in-plane components.
    pub(super) fn in_plane(&mut self, pair: [Id; 2]) -> Value {
        let axes = self.model.coordinates.frame.axes();
        let mut vector = [self.pool.zero(); 3];
        (vector[axes[0]], vector[axes[1]]) = (pair[0], pair[1]);
        Value::Vector(vector)
    }

    fn coordinate(&mut self, axis: usize, span: Span) -> Lowered<Value> {
        if self.place == Place::Global {
            return Err(internal(span, "a coordinate outside a domain"));
        }
        Ok(Value::Scalar(self.input(SymbolKind::Coordinate(axis))))
    }

    pub(super) fn field(&mut self, field: FieldId, test: bool, span: Span) -> Lowered<Value> {
        if matches!(self.place, Place::Global) {
            return Err(unsupported(
                span,
                "a field has no value here; take its mean, its integral or its value at a point",
            ));
        }
        let kind = match (test, self.frozen) {
            (true, _) => SymbolKind::Test,
            (false, true) => SymbolKind::Frozen,
            (false, false) => SymbolKind::Field,
        };
        let input = |component| kind(FieldInput { field, component, derivative: None });
        match self.model.fields[field.0].shape {
            Shape::Scalar => Ok(Value::Scalar(self.input(input(0)))),
            Shape::Vector => {
                let pair = [self.input(input(0)), self.input(input(1))];
                Ok(self.in_plane(pair))
            }
            Shape::Tensor => Err(unsupported(span, "fields of tensors are not supported")),
        }
    }

    fn builtin(&mut self, builtin: Builtin, arguments: &'m [Expr], span: Span) -> Lowered<Value> {
        let values = self.exprs(arguments)?;
        match (builtin, values.as_slice()) {
            (Builtin::Grad, [of]) => self.grad(of, span),
            (Builtin::Along, [of]) => self.along(of, span),
            (Builtin::Hoop, [of]) => self.hoop(of, span),
            (Builtin::Perp, [of]) => {
                let v = algebra::vector(&mut self.pool, of)
                    .ok_or_else(|| internal(span, "a vector was expected"))?;
                let [a, b] = self.model.coordinates.frame.axes().map(|axis| v[axis]);
                let turned = [self.pool.neg(b), a];
                Ok(self.in_plane(turned))
            }
            (Builtin::Div, [of]) => match self.grad(of, span)? {
                Value::Tensor(gradient) => Ok(Value::Scalar(algebra::trace(&mut self.pool, &gradient))),
                other => Ok(other),
            },
            (Builtin::Polar, [centre, radius, angle]) => {
                let turn = self.unit_vector(angle, span)?;
                let offset =
                    algebra::arithmetic(&mut self.pool, crate::model::Arithmetic::Mul, radius, &turn);
                offset
                    .and_then(|offset| {
                        algebra::arithmetic(&mut self.pool, crate::model::Arithmetic::Add, centre, &offset)
                    })
                    .ok_or_else(|| internal(span, "`polar` takes a point, a length and an angle"))
            }
            _ => {
                let value = algebra::builtin(&mut self.pool, builtin, &values);
                let value = value.ok_or_else(|| internal(span, "shapes do not fit"))?;
                self.hint_builtin(builtin, arguments.first(), &value);
                Ok(value)
            }
        }
    }

    /// `(cos a, sin a)` in the plane.
    fn unit_vector(&mut self, angle: &Value, span: Span) -> Lowered<Value> {
        let angle = self.scalar(angle, span)?;
        let pair =
            [crate::scalar::Unary::Cos, crate::scalar::Unary::Sin].map(|op| self.pool.unary(op, angle));
        Ok(self.in_plane(pair))
    }

    fn frozen(&mut self, of: &'m Expr) -> Lowered<Value> {
        let epoch = self.next_epoch();
        let outer = (std::mem::replace(&mut self.frozen, true), std::mem::replace(&mut self.epoch, epoch));
        let value = self.expr(of);
        (self.frozen, self.epoch) = outer;
        value
    }

    fn match_value(&mut self, scrutinee: &'m Expr, arms: &'m [Arm], otherwise: &'m Expr) -> Lowered<Value> {
        let x = self.scalar_expr(scrutinee)?;
        let mut result = self.expr(otherwise)?;
        for arm in arms.iter().rev() {
            let (bound, value) = (self.scalar_expr(&arm.bound)?, self.expr(&arm.value)?);
            let relation = if arm.inclusive { Relation::LessEqual } else { Relation::Less };
            result = self.select(relation, [x, bound], &value, &result, arm.value.span)?;
        }
        Ok(result)
    }

    fn select(
        &mut self,
        relation: Relation,
        [x, bound]: [Id; 2],
        then: &Value,
        otherwise: &Value,
        span: Span,
    ) -> Lowered<Value> {
        let (then, otherwise) = match (then, otherwise) {
            (Value::Zero, Value::Zero) => return Ok(Value::Zero),
            (Value::Zero, other) => (other.map(&mut self.pool, &mut |pool, _| pool.zero()), other.clone()),
            (other, Value::Zero) => (other.clone(), other.map(&mut self.pool, &mut |pool, _| pool.zero())),
            (then, otherwise) => (then.clone(), otherwise.clone()),
        };
        let (a, b) = (then.components(&mut self.pool), otherwise.components(&mut self.pool));
        if a.is_empty() || a.len() != b.len() {
            return Err(unsupported(span, "the arms of a `match` must be scalars, vectors or tensors"));
        }
        let selected: Vec<Id> = a
            .iter()
            .zip(&b)
            .map(|(&then, &otherwise)| self.pool.select(relation, x, bound, then, otherwise))
            .collect();
        Ok(Value::from_components(&selected))
    }

    fn match_region(
        &mut self,
        arms: &'m [(RegionId, Expr)],
        otherwise: Option<&'m Expr>,
        span: Span,
    ) -> Lowered<Value> {
        let regions = match &self.place {
            Place::Cells(regions) | Place::Edges(regions) => regions.clone(),
            Place::Global | Place::Pair(_) => {
                return Err(unsupported(span, "there is no region here to choose by"));
            }
        };
        let mut values = Vec::new();
        if let (true, Some(otherwise)) = (regions.is_empty(), otherwise) {
            return self.expr(otherwise);
        }
        for region in &regions {
            let arm = arms.iter().find(|(r, _)| r == region).map(|(_, arm)| arm).or(otherwise);
            let arm = arm.ok_or_else(|| {
                unsupported(
                    span,
                    format!("no arm for region `{}`", self.model.geometry.regions[region.0].name),
                )
            })?;
            values.push(self.expr(arm)?);
        }
        self.by_region(values, span)
    }

    /// One value for all regions: itself if they agree, a table if they are numbers, else the domain has to be split.
    fn by_region(&mut self, values: Vec<Value>, span: Span) -> Lowered<Value> {
        let components: Vec<Vec<Id>> = values.iter().map(|value| value.components(&mut self.pool)).collect();
        let Some(first) = values.first() else {
            return Err(unsupported(span, "no region lies beside this path"));
        };
        if components.iter().all(|c| *c == components[0]) && !components[0].is_empty() {
            return Ok(first.clone());
        }
        if matches!(self.place, Place::Edges(_)) {
            return Err(unsupported(span, "the regions on both sides of the edge differ here"));
        }
        let size = components.iter().map(Vec::len).max().unwrap_or(0);
        let numbers = components.iter().flatten().all(|&x| self.is_number(x));
        if !numbers || components.iter().any(|c| c.len() != size && c.len() != 1) {
            self.split = true;
            return Ok(first.clone());
        }
        let entries: Vec<Id> = (0..size)
            .map(|k| self.table(components.iter().map(|c| c.get(k).copied().unwrap_or(c[0])).collect()))
            .collect();
        Ok(Value::from_components(&entries))
    }

    fn table(&mut self, values: Vec<Id>) -> Id {
        if values.iter().all(|v| *v == values[0]) {
            return values[0];
        }
        let position = self.tables.iter().position(|table| table.values == values).unwrap_or_else(|| {
            self.tables.push(Table { name: self.naming.clone(), values });
            self.tables.len() - 1
        });
        self.input(SymbolKind::Table(position))
    }

    /// Whether the value depends on parameters and measures only.
    pub(super) fn is_number(&self, id: Id) -> bool {
        crate::scalar::symbols_of(&self.pool, &[id])
            .into_iter()
            .all(|s| matches!(self.symbols.kind(s), SymbolKind::Parameter(_) | SymbolKind::Measure(_)))
    }

    /// The regions that the paths and segments bound; the axis bounds those that name it.
    pub(super) fn bounded_by(&self, pieces: &[Piece]) -> Vec<RegionId> {
        let part_of = |piece: &Piece, boundary: &Piece| match (piece, boundary) {
            (Piece::Start(path) | Piece::End(path), Piece::Path(whole) | Piece::Segment(whole, _)) => {
                path == whole
            }
            (Piece::Segment(path, _), Piece::Path(whole)) | (Piece::Path(whole), Piece::Segment(path, _)) => {
                path == whole
            }
            _ => piece == boundary,
        };
        let bounds = |region: &crate::model::Region| {
            pieces.iter().any(|piece| region.boundary.iter().any(|boundary| part_of(piece, boundary)))
        };
        let regions = &self.model.geometry.regions;
        (0..regions.len()).filter(|&r| bounds(&regions[r])).map(RegionId).collect()
    }

    fn gap(&mut self, pair: PairId, span: Span) -> Lowered<Value> {
        self.on_own_pair(pair, span)?;
        Ok(Value::Scalar(self.input(SymbolKind::Gap(pair))))
    }

    fn pair_normal(&mut self, pair: PairId, span: Span) -> Lowered<Value> {
        self.on_own_pair(pair, span)?;
        let components = [0, 1].map(|axis| self.input(SymbolKind::PairNormal(pair, axis)));
        Ok(self.in_plane(components))
    }

    fn on_own_pair(&self, pair: PairId, span: Span) -> Lowered<()> {
        let here = self.place == Place::Pair(pair);
        here.then_some(()).ok_or_else(|| unsupported(span, "a gap has a value only on its own pair"))
    }
}

impl From<Condition> for Value {
    fn from(condition: Condition) -> Value {
        Value::Condition(condition)
    }
}
