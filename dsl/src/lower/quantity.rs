//! Scalars made from whole fields: means, integrals, extremes, values at a point, resultants. Equal ones are one.

use crate::model::{BlockId, Domain, FieldId, PairId, PathId, Piece, Reduction, RegionId};
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
    /// Smallest or largest function of the gap over a pair.
    PairExtreme(Reduction, PairId, Id),
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
            QuantityKind::Side(_, _, value) | QuantityKind::PairExtreme(_, _, value) => vec![*value],
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

/// Cells or edges, as emitted code lists them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Region {
    /// Cells of regions, ascending.
    Cells(Vec<RegionId>),
    /// Edges of paths and segments, ascending.
    Edges(Vec<Piece>),
}

impl Region {
    /// Cells or edges of a domain; `None` for contact pairs and mixtures, which checked models exclude.
    pub fn of(domain: &Domain) -> Option<Region> {
        let cells: Vec<RegionId> = domain
            .pieces
            .iter()
            .filter_map(|piece| if let Piece::Region(region) = piece { Some(*region) } else { None })
            .collect();
        if cells.len() == domain.pieces.len() {
            return Some(Region::Cells(cells));
        }
        let edge = |piece: &Piece| matches!(piece, Piece::Path(PathId(_)) | Piece::Segment(..) | Piece::Axis);
        domain.pieces.iter().all(edge).then(|| Region::Edges(domain.pieces.clone()))
    }
}
