//! Edges as seen from one side: normals, and gradients, which differ between the two sides of a path.

use super::{
    Derivative, FieldInput, Lowered, Lowering, Place, Region, SymbolKind, Value, internal, unsupported,
};
use crate::model::{Domain, Piece, RegionId};
use crate::scalar::{Id, symbols_of};
use crate::source::Span;
use std::collections::BTreeSet;

impl Lowering<'_> {
    /// `normal(D)` at a point of edges.
    pub(super) fn normal(&mut self, domain: &Domain, span: Span) -> Lowered<Value> {
        if !matches!(self.place, Place::Edges(_)) {
            return Err(internal(span, "a normal away from edges"));
        }
        let Some(Region::Cells(regions)) = Region::of(domain) else {
            return self.normal_of_path(span);
        };
        let side = self.sides.iter().position(|known| *known == regions).unwrap_or_else(|| {
            self.sides.push(regions);
            self.sides.len() - 1
        });
        let normal = [0, 1].map(|k| self.input(SymbolKind::Normal(side, k)));
        let normal = self.moved_normal(normal, span)?;
        Ok(self.in_plane(normal))
    }

    /// The regions from whose cells an integrand on edges is to be evaluated, if it matters: those that its normals point out of, else those in
    /// which its gradients live. Each piece has one of them on one side only.
    pub(super) fn side_of(
        &self,
        pieces: &[Piece],
        density: Id,
        span: Span,
    ) -> Lowered<Option<Vec<RegionId>>> {
        let mut sides = BTreeSet::new();
        let mut fields = BTreeSet::new();
        for symbol in symbols_of(&self.pool, &[density]) {
            match self.symbols.kind(symbol) {
                SymbolKind::Normal(side, _) => drop(sides.insert(side)),
                SymbolKind::Field(input) | SymbolKind::FieldRate(input) if is_gradient(input) => {
                    fields.insert(input.field);
                }
                _ => {}
            }
        }
        if sides.len() > 1 {
            return Err(unsupported(span, "an integral looks from one side: use one normal in it"));
        }
        let live = |region: &RegionId| {
            fields.iter().all(|f| self.model.fields[f.0].domain.pieces.contains(&Piece::Region(*region)))
        };
        let regions: Vec<RegionId> = match sides.first() {
            Some(&side) => self.sides[side].clone(),
            None if fields.is_empty() => return Ok(None),
            None => (0..self.model.geometry.regions.len()).map(RegionId).filter(live).collect(),
        };
        for piece in pieces {
            let here: Vec<RegionId> =
                self.bounded_by(&[*piece]).into_iter().filter(|region| regions.contains(region)).collect();
            let name = super::piece_name(self.model, *piece);
            match here.as_slice() {
                [one] if live(one) => {}
                [_] => {
                    return Err(unsupported(
                        span,
                        format!("a gradient is not known on this side of `{name}`"),
                    ));
                }
                [] => return Err(unsupported(span, format!("`{name}` does not bound these regions"))),
                _ => {
                    let problem = unsupported(span, format!("`{name}` has two sides here, with two values"));
                    let help = "say which side with `normal(region)`, or reduce on one region's own boundary";
                    return Err(Box::new(problem.help(help)));
                }
            }
        }
        Ok(Some(regions))
    }
}

/// Whether the input has different values on the two sides of an edge.
pub(crate) fn is_gradient(input: FieldInput) -> bool {
    matches!(input.derivative, Some(Derivative::Coordinate(_)))
}
