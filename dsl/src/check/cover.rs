//! Where things live: cells are in one region, edges bound one or two, or none where only a field lives on their path.

use crate::model::{Domain, Field, Model, PathId, Piece, RegionId, Sides};

impl Model {
    /// The first piece of a domain that is none of these regions, nor bounds one.
    pub(crate) fn uncovered(&self, domain: &Domain, regions: &[RegionId]) -> Option<Piece> {
        let carriers: Vec<Piece> = regions.iter().map(|region| Piece::Region(*region)).collect();
        self.beyond(domain, &carriers)
    }

    /// The first piece of a domain on which a field does not live; a field whose own domain is faulty says nothing.
    pub(crate) fn without(&self, field: &Field, domain: &Domain) -> Option<Piece> {
        if field.domain.pieces.is_empty() { None } else { self.beyond(domain, &field.domain.pieces) }
    }

    /// The first piece of a domain that is no part of another one.
    pub(crate) fn outside(&self, domain: &Domain, whole: &Domain) -> Option<Piece> {
        self.beyond(domain, &whole.pieces)
    }

    /// The first piece that two domains share; points where pieces end do not count.
    pub(crate) fn shared(&self, a: &Domain, b: &Domain) -> Option<Piece> {
        let in_other = |of: &Domain, other: &Domain| {
            let simple = of.pieces.iter().flat_map(|piece| self.surfaces(*piece));
            let carried = |piece: &Piece| other.pieces.iter().any(|carrier| self.carries(*carrier, *piece));
            simple.into_iter().find(carried)
        };
        in_other(a, b).or_else(|| in_other(b, a))
    }

    fn beyond(&self, domain: &Domain, carriers: &[Piece]) -> Option<Piece> {
        let simple = domain.pieces.iter().flat_map(|piece| self.surfaces(*piece));
        simple.into_iter().find(|piece| !carriers.iter().any(|carrier| self.carries(*carrier, *piece)))
    }

    /// A contact piece as its surfaces, a path as its segments where only those bound regions.
    fn surfaces(&self, piece: Piece) -> Vec<Piece> {
        match piece {
            Piece::Pair(id, sides) => {
                let pair = &self.pairs[id.0];
                let meant: &[&Domain] = match sides {
                    Sides::First => &[&pair.first],
                    Sides::Second => &[&pair.second],
                    Sides::Both => &[&pair.first, &pair.second],
                };
                meant.iter().flat_map(|side| &side.pieces).flat_map(|piece| self.surfaces(*piece)).collect()
            }
            Piece::Path(id) => self.segments(id),
            other => vec![other],
        }
    }

    fn segments(&self, path: PathId) -> Vec<Piece> {
        (0..self.geometry.paths[path.0].segments.len()).map(|at| Piece::Segment(path, at)).collect()
    }

    /// Whether what lives on `carrier` has values on `piece`, which is no whole path.
    fn carries(&self, carrier: Piece, piece: Piece) -> bool {
        match (carrier, piece) {
            (Piece::Region(a), Piece::Region(b)) => a == b,
            (_, Piece::Start(path)) => self.carries(carrier, Piece::Segment(path, 0)),
            (_, Piece::End(path)) => {
                let last = self.geometry.paths[path.0].segments.len().saturating_sub(1);
                self.carries(carrier, Piece::Segment(path, last))
            }
            (Piece::Region(region), edge) => self.bounds(region, edge),
            (Piece::Path(p), Piece::Segment(q, _)) => p == q,
            (a, b) => a == b,
        }
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
