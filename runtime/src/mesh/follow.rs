//! Meshes of moving regions: a region between bodies whose surface is theirs, in its present shape.
//!
//! A [`Follower`] knows which edges of the bodies' mesh go around its region. At any displacement of the bodies it fills what lies between them with
//! new cells that share the bodies' curved edges, node by node; only the pieces on the axis of symmetry are divided anew. From there the cells go
//! along with the bodies as long as they keep their shape.

use super::assemble::{Draft, assemble};
use super::filling::Filling;
use super::film::FilmSize;
use super::outline::{Chain, Outline};
use super::sizing::SizeField;
use super::triangulate::triangulate;
use super::{CellEdge, Mesh, MeshError, MeshSizing, PathEdge};
use ansatz_geometry::{Curve, Geometry, Piece, Point, Source, point};
use std::collections::BTreeMap;

/// One side of a loop around the region.
#[derive(Debug, Clone, Copy)]
enum Side {
    /// A segment of a path, by its place in [`Mesh::paths`]; against its direction where reversed.
    Surface { path: usize, reversed: bool },
    /// A piece of the axis between two vertices of the geometry, in the direction of travel.
    Axis { ends: [usize; 2] },
}

/// Cells are made anew where the size wanted at the surface has fallen below this part of what it was.
const SHRUNK: f64 = 0.7;

/// A region that follows the bodies around it.
pub struct Follower {
    region: String,
    sides: Vec<Side>,
    largest: f64,
    growth: f64,
    quality: f64,
    films: Vec<FilmSize>,
    filling: Option<Filling>,
}

impl Follower {
    /// The region with index `region` of a checked geometry, with films in it.
    ///
    /// # Errors
    /// The loop of the region does not close.
    pub fn new(
        geometry: &Geometry,
        region: usize,
        sizing: &MeshSizing,
        films: Vec<FilmSize>,
    ) -> Result<Self, MeshError> {
        let boundary = geometry.boundary(region).map_err(MeshError::Geometry)?;
        let mut first = Vec::new();
        let mut count = 0;
        for path in &geometry.paths {
            first.push(count);
            count += path.segments.len();
        }
        let side = |piece: &Piece| match piece.source {
            Source::Segment { path, segment } => {
                Side::Surface { path: first[path] + segment, reversed: piece.reversed }
            }
            Source::Axis => Side::Axis { ends: piece.ends },
        };
        let region = geometry.regions[region].name.clone();
        let largest = sizing.largest_in(&region, geometry);
        let sides = boundary.pieces().map(side).collect();
        let (growth, quality) = (sizing.growth, sizing.quality);
        Ok(Self { region, sides, largest, growth, quality, films, filling: None })
    }

    /// Adds the region, in the shape that it has where the bodies' nodes lie at `positions`, to a mesh.
    ///
    /// # Errors
    /// [`MeshError::Overlap`] where surfaces run into each other.
    pub fn attach(&mut self, mesh: &mut Mesh, positions: &[Point]) -> Result<(), MeshError> {
        self.filling = None;
        let outline = self.outline(mesh, positions)?;
        let overlap = |at| MeshError::Overlap { region: self.region.clone(), at };
        let sizes = self.point_sizes(&outline)?;
        let field = self.size_field(&outline, &sizes);
        let triangles = triangulate(&outline, &field).map_err(|(at, _)| overlap(at))?;
        let part = assemble(Draft {
            points: triangles.points,
            cells: triangles.cells,
            regions: vec![self.region.clone()],
            chains: outline.chains,
            corners: Vec::new(),
        });
        if part.cells.is_empty() {
            return Err(overlap(outline.points.first().copied().unwrap_or_default()));
        }
        let first_node = mesh.nodes.len();
        self.join(mesh, &part);
        self.filling = Filling::new(part, first_node, sizes).ok();
        Ok(())
    }

    /// Lets the cells go along to where the bodies' nodes lie at `positions`; false where that would make them too flat, or leave them too large for a
    /// film that has become thinner, and nothing was moved.
    ///
    /// # Errors
    /// [`MeshError::BadFilmSize`].
    pub fn advance(&mut self, mesh: &mut Mesh, positions: &[Point]) -> Result<bool, MeshError> {
        let loops = Loops::around(self.surfaces(), mesh, positions);
        let sizes = self.point_sizes(&loops.outline)?;
        let surfaces: Vec<usize> = self.surfaces().map(|(path, _)| path).collect();
        let Some(filling) = &mut self.filling else { return Ok(false) };
        if sizes.iter().zip(&filling.sizes).any(|(now, then)| *now < SHRUNK * then) {
            return Ok(false);
        }
        let edges = surfaces.iter().map(|&path| mesh.paths[path].edges.as_slice());
        let Some(nodes) = filling.moved(edges, positions, self.quality) else { return Ok(false) };
        mesh.nodes[filling.first_node..][..nodes.len()].copy_from_slice(&nodes);
        Ok(true)
    }

    /// Mesh paths of the bodies around the region, in the order of its own.
    fn surfaces(&self) -> impl Iterator<Item = (usize, bool)> {
        self.sides.iter().filter_map(|side| match *side {
            Side::Surface { path, reversed } => Some((path, reversed)),
            Side::Axis { .. } => None,
        })
    }

    /// The loops as they lie now, surfaces first.
    fn outline(&self, mesh: &Mesh, positions: &[Point]) -> Result<Outline, MeshError> {
        let mut loops = Loops::around(self.surfaces(), mesh, positions);
        let sizes = self.point_sizes(&loops.outline)?;
        let field = self.size_field(&loops.outline, &sizes);
        for side in &self.sides {
            let Side::Axis { ends } = *side else { continue };
            // Regions keep the axis on their left, so that the pieces run downwards; the path runs upwards.
            let ends = [ends[1], ends[0]].map(|vertex| loops.number(mesh.corners[vertex], positions));
            let chain = self.divide_axis(&mut loops.outline, ends, &field)?;
            loops.outline.chains.push(chain);
        }
        loops.outline.boundary_points = loops.outline.points.len();
        Ok(loops.outline)
    }

    fn divide_axis(
        &self,
        outline: &mut Outline,
        ends: [usize; 2],
        field: &SizeField<'_>,
    ) -> Result<Chain, MeshError> {
        let [from, to] = ends.map(|end| outline.points[end]);
        if to[1] <= from[1] {
            return Err(MeshError::Overlap { region: self.region.clone(), at: from });
        }
        let (inner, middles) =
            outline.divide_curve(&Curve::Line { from, to }, field, &|| String::from("axis"))?;
        let points = [ends[0]].into_iter().chain(inner).chain([ends[1]]).collect();
        Ok(Chain { path: "axis".into(), label: None, points, middles, sides: [None, Some(0)] })
    }

    /// Cells start with the size of the edges around them, or that of the film there.
    fn point_sizes(&self, outline: &Outline) -> Result<Vec<f64>, MeshError> {
        let mut smallest = vec![self.largest; outline.points.len()];
        for [a, b] in outline.chains.iter().flat_map(Chain::edges) {
            let length = point::distance(outline.points[a], outline.points[b]);
            for end in [a, b] {
                smallest[end] = smallest[end].min(length);
            }
        }
        self.films.iter().try_for_each(|film| film.limit(outline, &mut smallest))?;
        Ok(smallest)
    }

    /// Sizes that grow inwards from those at the points.
    fn size_field(&self, outline: &Outline, sizes: &[f64]) -> SizeField<'static> {
        let points = sizes.iter().copied().zip(outline.points.iter().copied());
        SizeField::around(points, self.largest, self.growth)
    }

    /// Appends the cells of the region behind those of a mesh.
    fn join(&self, mesh: &mut Mesh, part: &Mesh) {
        let (first_node, first_cell) = (mesh.nodes.len() as u32, mesh.cells.len() as u32);
        let region = mesh.regions.len() as u16;
        let moved = |node: u32| node + first_node;
        for ((path, _), own) in self.surfaces().zip(&part.paths) {
            for (edge, own) in mesh.paths[path].edges.iter().zip(&own.edges) {
                mesh.links.extend((0..3).map(|k| [moved(own.nodes[k]), edge.nodes[k]]));
            }
        }
        mesh.links.sort_unstable();
        mesh.links.dedup();
        mesh.nodes.extend(&part.nodes);
        mesh.cells.extend(part.cells.iter().map(|cell| cell.map(moved)));
        mesh.cell_region.extend(part.cell_region.iter().map(|_| region));
        mesh.regions.push(self.region.clone());
        let side = |side: CellEdge| CellEdge { cell: side.cell + first_cell, ..side };
        for mut path in part.paths.iter().cloned() {
            path.seen_from = Some(self.region.clone());
            for edge in &mut path.edges {
                *edge = PathEdge {
                    nodes: edge.nodes.map(moved),
                    left: edge.left.map(side),
                    right: edge.right.map(side),
                };
            }
            mesh.paths.push(path);
        }
    }
}

/// An outline in the making: each node of the bodies around a region is one of its points.
struct Loops {
    outline: Outline,
    place: BTreeMap<u32, usize>,
}

impl Loops {
    /// Surfaces of bodies, each by its place in [`Mesh::paths`] and whether the region is on its other side.
    fn around(surfaces: impl Iterator<Item = (usize, bool)>, mesh: &Mesh, positions: &[Point]) -> Self {
        let mut loops = Self { outline: Outline::default(), place: BTreeMap::new() };
        for (path, reversed) in surfaces {
            let surface = &mesh.paths[path];
            let Some(first) = surface.edges.first() else { continue };
            let mut points = vec![loops.number(first.nodes[0], positions)];
            points.extend(surface.edges.iter().map(|edge| loops.number(edge.nodes[1], positions)));
            let middles = surface.edges.iter().map(|edge| positions[edge.nodes[2] as usize]).collect();
            let sides = if reversed { [None, Some(0)] } else { [Some(0), None] };
            loops.outline.chains.push(Chain {
                path: surface.path.clone(),
                label: surface.label.clone(),
                points,
                middles,
                sides,
            });
        }
        loops
    }

    /// The point at a node of the bodies.
    fn number(&mut self, node: u32, positions: &[Point]) -> usize {
        let points = &mut self.outline.points;
        *self.place.entry(node).or_insert_with(|| {
            points.push(positions[node as usize]);
            points.len() - 1
        })
    }
}
