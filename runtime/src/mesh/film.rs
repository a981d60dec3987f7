//! Sizes of cells in a film: between two surfaces that come close, as small as the gap there asks for.

use super::MeshError;
use super::outline::{Chain, Outline};
use ansatz_geometry::{Curve, Point, point};
use std::rc::Rc;

/// Cells are not made smaller than this part of the edges they touch, which the bodies have divided.
const FINEST: f64 = 0.125;

/// An upper bound on the size of the cells that touch surfaces which face each other.
#[derive(Clone)]
pub struct FilmSize {
    /// Names of the paths, or of their segments as `path.label`, of each surface.
    pub surfaces: [Vec<&'static str>; 2],
    /// Whether cells at each of them are meant.
    pub at: [bool; 2],
    /// Edge length wanted at a gap, both in coherent model units.
    pub size: Rc<dyn Fn(f64) -> f64>,
}

impl FilmSize {
    /// Lowers the sizes at the points of an outline, which are the lengths of the edges there.
    ///
    /// # Errors
    /// [`MeshError::BadFilmSize`] where the size is not positive.
    pub(super) fn limit(&self, outline: &Outline, sizes: &mut [f64]) -> Result<(), MeshError> {
        let surfaces = self.surfaces.each_ref().map(|names| surface(outline, names));
        for side in (0..2).filter(|&side| self.at[side]) {
            let facing: Vec<Edge> =
                surfaces[1 - side].iter().flat_map(|chain| Edge::along(outline, chain)).collect();
            for &p in surfaces[side].iter().flat_map(|chain| &chain.points) {
                let gap = distance(&facing, outline.points[p]);
                if gap.is_finite() {
                    let size = (self.size)(gap);
                    if !(size > 0.0 && size.is_finite()) {
                        return Err(MeshError::BadFilmSize { size, gap, at: outline.points[p] });
                    }
                    sizes[p] = sizes[p].min(size.max(FINEST * sizes[p]));
                }
            }
        }
        Ok(())
    }
}

/// The chains of a surface.
fn surface<'a>(outline: &'a Outline, names: &[&str]) -> Vec<&'a Chain> {
    let named = |chain: &&Chain| {
        let segment = chain.label.as_ref().map(|label| format!("{}.{label}", chain.path));
        names.iter().any(|name| chain.path == *name || segment.as_deref() == Some(name))
    };
    outline.chains.iter().filter(named).collect()
}

/// A curved edge taken as two straight ones.
struct Edge {
    start: Point,
    middle: Point,
    end: Point,
    /// Distance of the further end from the middle.
    reach: f64,
}

impl Edge {
    /// The edges of a chain.
    fn along<'a>(outline: &'a Outline, chain: &'a Chain) -> impl Iterator<Item = Self> + 'a {
        chain.edges().zip(&chain.middles).map(|([a, b], &middle)| {
            let (start, end) = (outline.points[a], outline.points[b]);
            let reach = point::distance(start, middle).max(point::distance(middle, end));
            Self { start, middle, end, reach }
        })
    }

    fn distance(&self, from: Point) -> f64 {
        let half = |from: Point, to: Point| Curve::Line { from, to };
        half(self.start, self.middle).distance(from).min(half(self.middle, self.end).distance(from))
    }
}

/// Distance of a point from a surface; infinite where there is none.
fn distance(surface: &[Edge], from: Point) -> f64 {
    let nearer = |nearest: f64, edge: &Edge| {
        // No point of the edge is nearer than that.
        let bound = point::distance(edge.middle, from) - edge.reach;
        if bound < nearest { nearest.min(edge.distance(from)) } else { nearest }
    };
    surface.iter().fold(f64::INFINITY, nearer)
}
