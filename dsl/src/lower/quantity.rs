//! Scalars made from whole fields: means, integrals, extremes, values at a point, resultants. Equal ones are one.

use crate::model::{BlockId, Domain, FieldId, PairId, Piece, Reduction, RegionId, Sides};
use crate::scalar::Id;
use crate::source::Span;
use ansatz_units::Dimension;

/// A scalar made from fields.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Quantity {
    pub name: String,
    pub dimension: Dimension,
    pub kind: QuantityKind,
    pub span: Span,
}

/// How a [`Quantity`] comes from fields.
#[derive(Clone, Debug, PartialEq)]
pub enum QuantityKind {
    /// Integral over cells or edges; a mean has its density divided by the measure.
    Integral(Vec<Part>),
    /// Integral over edges as seen from the cells of these regions: of gradients and normals.
    Side(Vec<Piece>, Vec<RegionId>, Id),
    /// Smallest or largest value over the nodes of cells or edges.
    Extreme(Reduction, Region, Vec<Id>),
    /// Value at a reference point, which may lie in any of the regions.
    Point([Id; 2], Region, Vec<Id>),
    /// Smallest or largest value over surfaces of a pair.
    PairExtreme(Reduction, PairId, Sides, Id),
    /// Integral over the points of surfaces of a pair that the other one faces, per area as it has moved (`true`) or of the reference shape.
    PairIntegral(PairId, Sides, bool, Id),
    /// In-plane component of the resultant that a block puts on edges.
    Force(BlockId, Vec<Piece>, FieldId, usize),
}

impl QuantityKind {
    /// The scalars at points that it is made from.
    pub fn densities(&self) -> Vec<Id> {
        match self {
            QuantityKind::Integral(parts) => parts.iter().map(|part| part.density).collect(),
            QuantityKind::Extreme(_, _, values) => values.clone(),
            QuantityKind::Point(at, _, values) => at.iter().chain(values).copied().collect(),
            QuantityKind::Side(_, _, value)
            | QuantityKind::PairExtreme(_, _, _, value)
            | QuantityKind::PairIntegral(_, _, _, value) => vec![*value],
            QuantityKind::Force(..) => Vec::new(),
        }
    }
}

/// A density on a part of a domain.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Part {
    pub region: Region,
    pub density: Id,
}

/// Cells, edges or points, as emitted code lists them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Region {
    /// Cells of regions, ascending.
    Cells(Vec<RegionId>),
    /// Edges of paths and segments, ascending.
    Edges(Vec<Piece>),
    /// First and last points of paths, ascending.
    Ends(Vec<Piece>),
}

impl Region {
    /// Cells, edges or ends of a domain; `None` for contact pairs and mixtures.
    pub fn of(domain: &Domain) -> Option<Region> {
        match Region::parts(domain).as_slice() {
            [one] => Some(one.clone()),
            _ => None,
        }
    }

    /// The cells, the edges and the ends of a domain, as far as there are any; nothing for contact pairs.
    pub fn parts(domain: &Domain) -> Vec<Region> {
        let pieces = |wanted: fn(&Piece) -> bool| -> Vec<Piece> {
            domain.pieces.iter().copied().filter(wanted).collect()
        };
        let cells = domain.pieces.iter().filter_map(|piece| match piece {
            Piece::Region(region) => Some(*region),
            _ => None,
        });
        let edges = pieces(|piece| matches!(piece, Piece::Path(_) | Piece::Segment(..) | Piece::Axis));
        let ends = pieces(|piece| matches!(piece, Piece::Start(_) | Piece::End(_)));
        let parts = [Region::Cells(cells.collect()), Region::Edges(edges), Region::Ends(ends)];
        parts.into_iter().filter(|part| !part.is_empty()).collect()
    }

    fn is_empty(&self) -> bool {
        match self {
            Region::Cells(regions) => regions.is_empty(),
            Region::Edges(pieces) | Region::Ends(pieces) => pieces.is_empty(),
        }
    }
}
