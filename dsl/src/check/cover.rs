//! Which regions a domain belongs to: cells are in one, edges bound one or two.

use crate::model::{Domain, Model, PairId, PathId, Piece, RegionId};

impl Domain {
    /// The regions among the pieces.
    pub(super) fn regions(&self) -> Vec<RegionId> {
        let regions = self.pieces.iter().filter_map(|piece| match piece {
            Piece::Region(id) => Some(*id),
            _ => None,
        });
        regions.collect()
    }
}

impl Model {
    /// The first piece of a domain that is none of these regions, nor bounds one.
    pub(super) fn uncovered(&self, domain: &Domain, regions: &[RegionId]) -> Option<Piece> {
        let simple = domain.pieces.iter().flat_map(|piece| self.surfaces(*piece));
        simple.into_iter().find(|piece| match piece {
            Piece::Region(id) => !regions.contains(id),
            edge => !regions.iter().any(|id| self.bounds(*id, *edge)),
        })
    }

    /// A contact piece as its surfaces, a path as its segments where only those bound regions.
    fn surfaces(&self, piece: Piece) -> Vec<Piece> {
        let pair = |id: PairId| &self.pairs[id.0];
        match piece {
            Piece::First(id) => {
                pair(id).first.pieces.iter().flat_map(|piece| self.surfaces(*piece)).collect()
            }
            Piece::Pair(id) => {
                let both = pair(id).first.pieces.iter().chain(&pair(id).second.pieces);
                both.flat_map(|piece| self.surfaces(*piece)).collect()
            }
            Piece::Path(id) => self.segments(id),
            other => vec![other],
        }
    }

    fn segments(&self, path: PathId) -> Vec<Piece> {
        (0..self.geometry.paths[path.0].segments.len()).map(|at| Piece::Segment(path, at)).collect()
    }

    /// Whether an edge is on the boundary of a region; a region whose loop is faulty says nothing.
    fn bounds(&self, id: RegionId, edge: Piece) -> bool {
        let boundary = &self.geometry.regions[id.0].boundary;
        let on = |known: &Piece| match (*known, edge) {
            (Piece::Path(p), Piece::Segment(q, _)) => p == q,
            (a, b) => a == b,
        };
        boundary.is_empty() || boundary.iter().any(on)
    }
}
