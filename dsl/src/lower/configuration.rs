//! Paths as they are after deformation: `on current(D)` has the measure and the normals of the moved path.
//!
//! Points stay material points: coordinates, gradients and `along` are those of the reference. With the unit tangent T of the reference path
//! and s its arc length, the moved path has the tangent t = T + du/ds, and current over reference area is |t| (r + u_r)/r, the last factor in
//! axisymmetric models only.

use super::{Lowered, Lowering, Place, Region, SymbolKind, Value, internal, unsupported};
use crate::model::{Domain, FieldId, Frame, Shape};
use crate::scalar::Id;
use crate::source::Span;
use ansatz_units::Dimension;

impl<'m> Lowering<'m> {
    /// [`Self::on_parts`] of a domain over which one integrates, in the configuration that it names.
    pub fn in_configuration<T>(
        &mut self,
        domain: &Domain,
        lower: impl FnMut(&mut Self) -> Lowered<T>,
    ) -> Lowered<Vec<(Region, T)>> {
        let region = Region::of(domain).ok_or_else(|| {
            unsupported(domain.span, "cells, edges and pairs cannot be mixed in one domain")
        })?;
        let moved_by = if domain.current { Some(self.mover_of(domain)?) } else { None };
        let epoch = self.next_epoch();
        let outer =
            (std::mem::replace(&mut self.moved_by, moved_by), std::mem::replace(&mut self.epoch, epoch));
        let parts = self.on_parts(&region, lower);
        (self.moved_by, self.epoch) = outer;
        parts
    }

    /// A density per area of the configuration in which one integrates, per reference area.
    pub fn measured(&mut self, density: Id, span: Span) -> Lowered<Id> {
        let Some(displacement) = self.moved_by else { return Ok(density) };
        let tangent = self.moved_tangent(displacement, span)?;
        let mut ratio = self.length(tangent);
        if self.model.coordinates.frame == Frame::Axisymmetric {
            let u = self.field(displacement, false, span)?;
            let hoop = self.hoop(&u, span)?;
            let (hoop, one) = (self.scalar(&hoop, span)?, self.pool.one());
            let widening = self.pool.add(one, hoop);
            ratio = self.pool.mul(ratio, widening);
        }
        Ok(self.pool.mul(ratio, density))
    }

    /// `normal(path)`: the unit normal to the right of its direction.
    pub(super) fn normal_of_path(&mut self, span: Span) -> Lowered<Value> {
        if !matches!(self.place, Place::Edges(_)) {
            return Err(internal(span, "a normal away from edges"));
        }
        let [a, b] = match self.moved_by {
            None => self.tangent(),
            Some(displacement) => {
                let tangent = self.moved_tangent(displacement, span)?;
                let length = self.length(tangent);
                tangent.map(|component| self.pool.div(component, length))
            }
        };
        let right = [b, self.pool.neg(a)];
        Ok(self.in_plane(right))
    }

    /// A unit normal of the reference path as it stands after deformation: on the same side.
    pub(super) fn moved_normal(&mut self, normal: [Id; 2], span: Span) -> Lowered<[Id; 2]> {
        if self.moved_by.is_none() {
            return Ok(normal);
        }
        let [a, b] = self.tangent();
        let right = [b, self.pool.neg(a)];
        let side = self.pool.dot(&normal, &right);
        let Value::Vector(moved) = self.normal_of_path(span)? else {
            return Err(internal(span, "a normal is a vector"));
        };
        Ok(self.model.coordinates.frame.axes().map(|axis| self.pool.mul(side, moved[axis])))
    }

    fn tangent(&mut self) -> [Id; 2] {
        [0, 1].map(|axis| self.input(SymbolKind::Tangent(axis)))
    }

    /// In-plane components of the derivative of the current position by the reference arc length.
    fn moved_tangent(&mut self, displacement: FieldId, span: Span) -> Lowered<[Id; 2]> {
        let u = self.field(displacement, false, span)?;
        let Value::Vector(slope) = self.along(&u, span)? else {
            return Err(internal(span, "a displacement is a vector"));
        };
        let axes = self.model.coordinates.frame.axes();
        let reference = self.tangent();
        Ok([0, 1].map(|k: usize| self.pool.add(reference[k], slope[axes[k]])))
    }

    fn length(&mut self, tangent: [Id; 2]) -> Id {
        let square = self.pool.dot(&tangent, &tangent);
        self.pool.sqrt(square)
    }

    /// The displacement that moves a domain: the first field of vectors of a length that lives on all of it.
    fn mover_of(&self, domain: &Domain) -> Lowered<FieldId> {
        let moves = |field: &crate::model::Field| {
            field.shape == Shape::Vector
                && field.dimension == Dimension::LENGTH
                && self.model.without(field, domain).is_none()
        };
        let found = self.model.fields.iter().position(moves).map(FieldId);
        found.ok_or_else(|| {
            let problem = unsupported(domain.span, "no displacement moves this path");
            Box::new(problem.help("`current(..)` needs a field `u: Vector[Length]` that lives on all of it"))
        })
    }
}
