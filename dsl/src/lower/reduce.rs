//! Lowering of what takes whole fields or whole runs to one number.

use super::{
    Lowered, Lowering, Part, Quantity, QuantityKind, Region, SymbolKind, Value, internal, symbol_name,
    unsupported,
};
use crate::check::walk::deep;
use crate::model::{
    Builtin, Domain, EventId, Expr, ExprKind, FieldId, PairId, PathId, Piece, Reduction, RegionId, Shape,
    Sides, Type,
};
use crate::scalar::{Id, symbols_of};
use crate::source::Span;
use ansatz_units::Dimension;
use std::collections::BTreeSet;

/// A number that a finished run gives.
#[derive(Clone, Debug, PartialEq)]
pub enum RunValue {
    /// Smallest or largest value over the steps between two times, or over all.
    Extreme(Reduction, Id, Option<[Id; 2]>),
    /// Value at a time.
    AtTime(Id, Id),
    /// Value when an event fired first.
    AtEvent(Id, EventId),
    /// 1 if the event is the outcome, else 0.
    Outcome(EventId),
}

impl RunValue {
    /// The scalars that are evaluated at single times.
    pub fn roots(&self) -> Vec<Id> {
        match self {
            RunValue::Extreme(_, of, range) => range.iter().flatten().copied().chain([*of]).collect(),
            RunValue::AtTime(of, time) => vec![*of, *time],
            RunValue::AtEvent(of, _) => vec![*of],
            RunValue::Outcome(_) => Vec::new(),
        }
    }
}

impl<'m> Lowering<'m> {
    /// Lowers a reduction over space, a measure, a resultant or a value at a point.
    pub(super) fn reduce(&mut self, expr: &'m Expr) -> Lowered<Value> {
        match &expr.kind {
            ExprKind::Measure(domain) => Ok(Value::Scalar(self.measure(domain)?)),
            ExprKind::Reduce(reduction, of, domain) => match domain.pieces.as_slice() {
                &[Piece::Pair(pair, sides)] => {
                    self.reduce_pair(*reduction, of, (pair, sides, domain.current), expr)
                }
                _ => self.reduce_region(*reduction, of, domain, expr),
            },
            ExprKind::AtPoint(of, point) => self.at_point(of, point, expr),
            ExprKind::Force(block, domain) => {
                let field = self.field_of_force(&domain.pieces, domain.span)?;
                let whole = self.naming().to_owned();
                let pair = [0, 1].map(|k| {
                    self.name_after(&format!("{whole}_{}", self.model.coordinates.names[k]));
                    self.quantity(QuantityKind::Force(*block, domain.pieces.clone(), field, k), expr)
                });
                self.name_after(&whole);
                Ok(self.in_plane(pair))
            }
            _ => Err(internal(expr.span, "no reduction")),
        }
    }

    /// Lowers a reduction over time, or a value at a time or event.
    pub(super) fn run_value(&mut self, expr: &'m Expr) -> Lowered<Value> {
        let value = match &expr.kind {
            ExprKind::ReduceRun(reduction, of, range) => {
                let range = match range {
                    Some((from, to)) => Some([self.global_scalar(from)?, self.global_scalar(to)?]),
                    None => None,
                };
                RunValue::Extreme(*reduction, self.global_scalar(of)?, range)
            }
            ExprKind::AtTime(of, time) => {
                RunValue::AtTime(self.global_scalar(of)?, self.global_scalar(time)?)
            }
            ExprKind::AtEvent(of, event) => RunValue::AtEvent(self.global_scalar(of)?, *event),
            _ => return Err(internal(expr.span, "no value of a run")),
        };
        Ok(Value::Scalar(self.run_symbol(value)))
    }

    /// Lowers a reduction over the points of surfaces of a pair.
    fn reduce_pair(
        &mut self,
        reduction: Reduction,
        of: &'m Expr,
        (pair, sides, current): (PairId, Sides, bool),
        expr: &'m Expr,
    ) -> Lowered<Value> {
        let components = self.components_on_pair(of, pair)?;
        self.without_fields(&components, of.span)?;
        let integral = |lowering: &mut Self, value: Id| {
            lowering.quantity(QuantityKind::PairIntegral(pair, sides, current, value), expr)
        };
        let reduced: Vec<Id> = match reduction {
            Reduction::Min | Reduction::Max => components
                .into_iter()
                .map(|value| self.quantity(QuantityKind::PairExtreme(reduction, pair, sides, value), expr))
                .collect(),
            Reduction::Integral => components.into_iter().map(|value| integral(self, value)).collect(),
            Reduction::Mean => {
                let one = self.pool.one();
                let area = integral(self, one);
                let mean = |value| {
                    let sum = integral(self, value);
                    self.pool.div(sum, area)
                };
                components.into_iter().map(mean).collect()
            }
        };
        Ok(Value::from_components(&reduced))
    }

    /// Refuses fields at the points of a pair.
    pub(crate) fn without_fields(&self, roots: &[Id], span: Span) -> Lowered<()> {
        let is_field = |symbol: &crate::scalar::Symbol| {
            use SymbolKind as K;
            matches!(self.symbols.kind(*symbol), K::Field(_) | K::FieldRate(_) | K::Frozen(_) | K::Test(_))
        };
        match symbols_of(&self.pool, roots).iter().find(|symbol| is_field(symbol)) {
            None => Ok(()),
            Some(&symbol) => {
                let name = symbol_name(self, self.symbols.kind(symbol));
                Err(unsupported(span, format!("`{name}` cannot be read at the points of a contact pair")))
            }
        }
    }

    fn reduce_region(
        &mut self,
        reduction: Reduction,
        of: &'m Expr,
        domain: &Domain,
        expr: &'m Expr,
    ) -> Lowered<Value> {
        let divisor = match reduction {
            Reduction::Mean => Some(self.measure_of(domain)?),
            _ => None,
        };
        let extreme = matches!(reduction, Reduction::Min | Reduction::Max);
        let parts = self.in_configuration(domain, |lowering| {
            let value = lowering.expr(of)?;
            let value = lowering.shaped(value, &of.ty);
            let components = value.components(&mut lowering.pool);
            if extreme {
                return Ok(components);
            }
            components.into_iter().map(|component| lowering.measured(component, domain.span)).collect()
        })?;
        let region = region_of(domain)?;
        let size = parts.iter().map(|(_, components)| components.len()).min().unwrap_or(0);
        let reduced: Vec<Id> = (0..size)
            .map(|k| match reduction {
                Reduction::Min | Reduction::Max => {
                    let values = parts.iter().map(|(_, components)| components[k]).collect();
                    Ok(self.quantity(QuantityKind::Extreme(reduction, region.clone(), values), expr))
                }
                Reduction::Integral => self.integral(&parts, k, None, expr),
                Reduction::Mean if domain.current => {
                    let integral = self.integral(&parts, k, None, expr)?;
                    Ok(divisor.map_or(integral, |area| self.pool.div(integral, area)))
                }
                Reduction::Mean => self.integral(&parts, k, divisor, expr),
            })
            .collect::<Lowered<_>>()?;
        Ok(Value::from_components(&reduced))
    }

    /// The measure of a domain in its configuration.
    fn measure_of(&mut self, domain: &Domain) -> Lowered<Id> {
        if !domain.current {
            return self.measure(domain);
        }
        let parts = self.in_configuration(domain, |lowering| {
            let one = lowering.pool.one();
            lowering.measured(one, domain.span)
        })?;
        let parts = parts.into_iter().map(|(region, density)| Part { region, density }).collect();
        Ok(self.share_quantity(QuantityKind::Integral(parts), Dimension::LENGTH.pow(2), domain.span))
    }

    /// Integral of component `k` of the parts' densities.
    fn integral(
        &mut self,
        parts: &[(Region, Vec<Id>)],
        k: usize,
        divisor: Option<Id>,
        expr: &'m Expr,
    ) -> Lowered<Id> {
        let mut densities = Vec::new();
        for (region, components) in parts {
            let density = divisor.map_or(components[k], |divisor| self.pool.div(components[k], divisor));
            if let Region::Edges(pieces) = region
                && let Some(side) = self.side_of(pieces, density, expr.span)?
            {
                return Ok(self.quantity(QuantityKind::Side(pieces.clone(), side, density), expr));
            }
            if self.pool.as_constant(density) != Some(0.0) {
                densities.push(Part { region: region.clone(), density });
            }
        }
        if densities.is_empty() {
            Ok(self.pool.zero())
        } else {
            Ok(self.quantity(QuantityKind::Integral(densities), expr))
        }
    }

    fn at_point(&mut self, of: &'m Expr, point: &'m Expr, expr: &'m Expr) -> Lowered<Value> {
        let place = self.global(point)?;
        let axes = self.model.coordinates.frame.axes();
        let Value::Vector(x) = place else { return Err(internal(point.span, "a point was expected")) };
        let region = self.around_points(of, expr.span)?;
        let parts = self.on_parts(&region, |lowering| {
            let value = lowering.expr(of)?;
            let value = lowering.shaped(value, &of.ty);
            Ok(value.components(&mut lowering.pool))
        })?;
        let size = parts.iter().map(|(_, components)| components.len()).min().unwrap_or(0);
        let values: Vec<Id> = (0..size)
            .map(|k| {
                let by_region = parts.iter().map(|(_, components)| components[k]).collect();
                self.quantity(QuantityKind::Point([x[axes[0]], x[axes[1]]], region.clone(), by_region), expr)
            })
            .collect();
        Ok(Value::from_components(&values))
    }

    /// Where a value at a point is looked up: in the regions that carry all its fields, or where one of them lives on paths only or it has
    /// derivatives along a path, on the paths that do.
    fn around_points(&self, of: &'m Expr, span: Span) -> Lowered<Region> {
        let model = self.model;
        let (mut fields, mut along) = (BTreeSet::new(), false);
        deep(model, of, &mut |e| match e.kind {
            ExprKind::Field(field) => drop(fields.insert(field)),
            ExprKind::Builtin(Builtin::Along, _) => along = true,
            _ => {}
        });
        let in_cells = |field: &FieldId| {
            model.fields[field.0].domain.pieces.iter().any(|piece| matches!(piece, Piece::Region(_)))
        };
        let carries_all = |piece: &Piece| {
            let domain = Domain { pieces: vec![*piece], current: false, span };
            fields.iter().all(|field| model.without(&model.fields[field.0], &domain).is_none())
        };
        if !along && fields.iter().all(in_cells) {
            let regions = (0..model.geometry.regions.len()).map(RegionId);
            let regions: Vec<RegionId> =
                regions.filter(|&region| carries_all(&Piece::Region(region))).collect();
            if regions.is_empty() {
                return Err(unsupported(span, "no region carries all the fields of this value"));
            }
            return Ok(Region::Cells(regions));
        }
        let labelled = |(path, definition): (usize, &crate::model::Path)| {
            let labels =
                definition.segments.iter().enumerate().filter(|(_, segment)| segment.label.is_some());
            let segments = labels.map(move |(at, _)| Piece::Segment(PathId(path), at));
            std::iter::once(Piece::Path(PathId(path))).chain(segments).collect::<Vec<_>>()
        };
        let pieces = model.geometry.paths.iter().enumerate().flat_map(labelled);
        let mut paths: Vec<Piece> = pieces.filter(carries_all).collect();
        let whole = paths.clone();
        paths.retain(|piece| !matches!(piece, Piece::Segment(p, _) if whole.contains(&Piece::Path(*p))));
        if paths.is_empty() {
            return Err(unsupported(span, "no path carries all the fields of this value"));
        }
        Ok(Region::Edges(paths))
    }

    /// The reference measure of a domain.
    fn measure(&mut self, domain: &Domain) -> Lowered<Id> {
        let region = region_of(domain)?;
        let position = self.measures.iter().position(|known| *known == region).unwrap_or_else(|| {
            self.measures.push(region);
            self.measures.len() - 1
        });
        Ok(self.input(SymbolKind::Measure(position)))
    }

    /// The symbol of a quantity that an expression makes.
    fn quantity(&mut self, kind: QuantityKind, expr: &Expr) -> Id {
        let dimension = if let Type::Value(_, dimension) = &expr.ty { *dimension } else { Dimension::NUMBER };
        self.share_quantity(kind, dimension, expr.span)
    }

    /// The symbol of a quantity, shared by equal ones and named after the innermost `let`.
    pub(crate) fn share_quantity(&mut self, kind: QuantityKind, dimension: Dimension, span: Span) -> Id {
        let position = self.quantities.iter().position(|q| q.kind == kind).unwrap_or_else(|| {
            let name = self.unused_name();
            self.quantities.push(Quantity { name, dimension, kind, span });
            self.quantities.len() - 1
        });
        self.input(SymbolKind::Quantity(position))
    }

    fn unused_name(&self) -> String {
        let taken = |name: &str| self.quantities.iter().any(|q| q.name == name);
        let numbered = (2..).map(|n| format!("{}_{n}", self.naming));
        std::iter::once(self.naming.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or_default()
    }

    /// The field that moves both surfaces of a pair.
    pub(crate) fn displacement_of(&self, pair: PairId) -> Lowered<FieldId> {
        let pair = &self.model.pairs[pair.0];
        let pieces: Vec<Piece> = pair.first.pieces.iter().chain(&pair.second.pieces).copied().collect();
        self.field_of_force(&pieces, pair.span)
    }

    /// The vector field whose unknowns carry forces on these edges: a displacement where there is one.
    pub(crate) fn field_of_force(&self, pieces: &[Piece], span: Span) -> Lowered<FieldId> {
        let domain = Domain { pieces: pieces.to_vec(), current: false, span };
        let lives = |field: &crate::model::Field| {
            field.shape == Shape::Vector && self.model.without(field, &domain).is_none()
        };
        let fields: Vec<usize> =
            (0..self.model.fields.len()).filter(|&f| lives(&self.model.fields[f])).collect();
        let displacement = fields.iter().find(|&&f| self.model.fields[f].dimension == Dimension::LENGTH);
        displacement
            .or(fields.first())
            .map(|&f| FieldId(f))
            .ok_or_else(|| unsupported(span, "no vector field lives on these edges"))
    }
}

fn region_of(domain: &Domain) -> Lowered<Region> {
    Region::of(domain)
        .ok_or_else(|| unsupported(domain.span, "cells, edges and pairs cannot be mixed in one domain"))
}
