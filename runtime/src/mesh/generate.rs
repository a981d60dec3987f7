//! Makes a mesh from a geometry, refining where the first attempt is not good enough.

use super::assemble::{Draft, assemble};
use super::outline::Outline;
use super::quality::cell_quality;
use super::sizing::SizeField;
use super::triangulate::{Triangles, triangulate};
use super::{Mesh, MeshError, MeshSizing};
use ansatz_geometry::{Boundary, Geometry, Point, Region, point};

/// Meshes made, each finer than the one before where that one was too coarse or of too low quality.
const ATTEMPTS: usize = 8;

impl Mesh {
    /// Meshes all regions of a geometry. Paths that bound no region are divided into edges without cells.
    ///
    /// # Errors
    /// A fault of the geometry or the sizes, or a mesh that stays below the wanted quality.
    pub fn generate(geometry: &Geometry, sizing: &MeshSizing) -> Result<Mesh, MeshError> {
        Self::generate_bodies(geometry, sizing, &[])
    }

    /// Meshes all regions but those named, which a [`Follower`](super::Follower) fills.
    ///
    /// # Errors
    /// As [`Mesh::generate`].
    pub fn generate_bodies(
        geometry: &Geometry,
        sizing: &MeshSizing,
        without: &[&str],
    ) -> Result<Mesh, MeshError> {
        let faults = geometry.check();
        if !faults.is_empty() {
            return Err(MeshError::Geometry(faults));
        }
        let boundaries: Result<Vec<Boundary>, _> =
            (0..geometry.regions.len()).map(|region| geometry.boundary(region)).collect();
        let boundaries = boundaries.map_err(MeshError::Geometry)?;
        let mut field = SizeField::new(geometry, &boundaries, sizing)?;
        let stays = |region: &Region| !without.contains(&region.name.as_str());
        let regions: Vec<Region> = geometry.regions.iter().filter(|region| stays(region)).cloned().collect();
        let around = geometry.regions.iter().zip(&boundaries).filter(|(region, _)| stays(region));
        let around: Vec<Boundary> = around.map(|(_, boundary)| boundary.clone()).collect();
        let bodies = Geometry { regions, ..geometry.clone() };
        let mut attempts = 1;
        loop {
            match attempt(&bodies, &around, &field, sizing.quality) {
                Ok(mesh) => return Ok(mesh),
                Err(Shortcoming { error, finer }) if finer.is_empty() || attempts == ATTEMPTS => {
                    return Err(error);
                }
                Err(shortcoming) => shortcoming.finer.iter().for_each(|&(at, size)| field.refine(at, size)),
            }
            attempts += 1;
        }
    }
}

/// Why a mesh was not accepted, and the sizes that may help.
struct Shortcoming {
    error: MeshError,
    finer: Vec<(Point, f64)>,
}

/// A mesh for the sizes of `field`, if each cell is at least as good as wanted.
fn attempt(
    geometry: &Geometry,
    boundaries: &[Boundary],
    field: &SizeField<'_>,
    wanted: f64,
) -> Result<Mesh, Shortcoming> {
    let outline = Outline::new(geometry, boundaries, field)
        .map_err(|error| Shortcoming { error, finer: Vec::new() })?;
    let triangles = triangulate(&outline, field).map_err(|(at, length)| Shortcoming {
        error: MeshError::Entangled { at },
        finer: vec![(at, 0.5 * length)],
    })?;
    let mesh = assemble(draft(geometry, outline, triangles));
    let worst = mesh.quality();
    if worst.smallest >= wanted {
        return Ok(mesh);
    }
    let error = MeshError::Quality {
        region: mesh.regions[usize::from(mesh.cell_region[worst.worst_cell])].clone(),
        at: centroid(&mesh.cell_nodes(worst.worst_cell)),
        found: worst.smallest,
        wanted,
    };
    let cells = (0..mesh.cells.len()).map(|cell| mesh.cell_nodes(cell));
    let bad = cells.filter(|nodes| cell_quality(nodes) < wanted);
    Err(Shortcoming { error, finer: bad.map(|nodes| (centroid(&nodes), finer_size(&nodes))).collect() })
}

/// Joins triangles and outline; points of paths without region follow the inner points.
fn draft(geometry: &Geometry, outline: Outline, triangles: Triangles) -> Draft {
    let Outline { points: divided, boundary_points, mut chains, mut corners } = outline;
    let mut points = triangles.points;
    let shift = points.len() - boundary_points;
    points.extend(&divided[boundary_points..]);
    let renumber = |k: &mut usize| *k += if *k < boundary_points { 0 } else { shift };
    chains.iter_mut().flat_map(|chain| &mut chain.points).for_each(renumber);
    corners.iter_mut().for_each(renumber);
    let regions = geometry.regions.iter().map(|region| region.name.clone()).collect();
    Draft { points, cells: triangles.cells, regions, chains, corners }
}

fn centroid(&[a, b, c, ..]: &[Point; 6]) -> Point {
    point::centroid([a, b, c])
}

/// A size that divides the longest edge of a cell and is no larger than its shortest.
fn finer_size([a, b, c, ..]: &[Point; 6]) -> f64 {
    let lengths = [point::distance(*a, *b), point::distance(*b, *c), point::distance(*c, *a)];
    let longest = lengths.into_iter().fold(0.0, f64::max);
    lengths.into_iter().fold(0.5 * longest, f64::min)
}
