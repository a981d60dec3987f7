//! Sizes of cells in a film: between two surfaces that come close, as small as the gap there asks for.

use super::MeshError;
use super::outline::{Chain, Outline};
use ansatz_geometry::{Curve, Point};
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
            for &p in surfaces[side].iter().flat_map(|chain| &chain.points) {
                let gap = distance(outline, &surfaces[1 - side], outline.points[p]);
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

/// Distance of a point from a surface, each edge taken as two straight ones; infinite where there is none.
fn distance(outline: &Outline, surface: &[&Chain], from: Point) -> f64 {
    let mut nearest = f64::INFINITY;
    for chain in surface {
        for ([a, b], &middle) in chain.edges().zip(&chain.middles) {
            let ends = [outline.points[a], middle, outline.points[b]];
            for half in ends.windows(2) {
                nearest = nearest.min(Curve::Line { from: half[0], to: half[1] }.distance(from));
            }
        }
    }
    nearest
}
