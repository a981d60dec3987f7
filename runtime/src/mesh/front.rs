//! Fills a Delaunay triangulation with points by an advancing front.
//!
//! A cell that is too large and borders an edge of the outline or a finished cell gets a new point above that edge,
//! where it makes an equilateral triangle of the wanted size; never farther than the centre of its empty circle
//! (Rebay 1993, *Efficient unstructured mesh generation by means of Delaunay triangulation and Bowyer-Watson
//! algorithm*, J. Comput. Phys. 106).

use super::delaunay::{Delaunay, Edges, Face, corners, face_regions};
use super::sizing::SizeField;
use ansatz_geometry::{Point, point};
use spade::handles::{DirectedEdgeHandle, FixedVertexHandle};
use spade::{CdtEdge, Point2, PositionInTriangulation, Triangulation as _};

type Edge<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), CdtEdge<()>, ()>;

/// A cell is too large where an equilateral triangle in its circumscribed circle has edges longer than this many
/// wanted sizes.
const TOO_LARGE: f64 = 1.35;
/// A new point keeps this many wanted sizes away from all others.
const APART: f64 = 0.6;

/// A cell to be divided.
struct Proposal {
    base: f64,
    face: Face,
    corners: [usize; 3],
    points: [Point; 2],
}

/// Which faces are too large, by face index, with the vertices for which that was found.
type Verdicts = Vec<([usize; 3], bool)>;

/// Adds inner points until no cell is too large.
pub(crate) fn advance(mesh: &mut Delaunay, edges: &Edges, field: &SizeField<'_>) {
    let mut verdicts = Verdicts::new();
    loop {
        judge(mesh, &mut verdicts, field);
        let mut front = front(mesh, edges, field, &verdicts);
        if front.is_empty() {
            return;
        }
        front.sort_by(|a, b| a.base.total_cmp(&b.base));
        for proposal in front {
            // Insertions earlier in this round may have replaced the face.
            if corners(mesh, proposal.face) == proposal.corners {
                let accepted = proposal.points.into_iter().find(|&p| accepts(mesh, proposal.face, p, field));
                match accepted {
                    Some([x, y]) => insert(mesh, Point2::new(x, y), proposal.corners[0]),
                    None => verdicts[proposal.face.index()].1 = false,
                }
            }
        }
    }
}

fn insert(mesh: &mut Delaunay, p: Point2<f64>, near: usize) {
    // Only coordinates that are not finite or extreme are refused, and those are refused by `accepts`.
    let _ = mesh.insert_with_hint(p, FixedVertexHandle::from_index(near));
}

/// Judges the faces that are new since the last time.
fn judge(mesh: &Delaunay, verdicts: &mut Verdicts, field: &SizeField<'_>) {
    verdicts.resize(mesh.num_all_faces(), ([usize::MAX; 3], false));
    for face in mesh.inner_faces() {
        let (corners, verdict) = (corners(mesh, face.fix()), &mut verdicts[face.index()]);
        if verdict.0 != corners {
            *verdict = (corners, is_too_large(face.positions().map(Into::into), field));
        }
    }
}

/// The cells that are too large and border the outline or a finished cell.
fn front(mesh: &Delaunay, edges: &Edges, field: &SizeField<'_>, verdicts: &Verdicts) -> Vec<Proposal> {
    let regions = face_regions(mesh, edges);
    let waiting: Vec<bool> =
        regions.iter().zip(verdicts).map(|(region, verdict)| region.is_some() && verdict.1).collect();
    let is_base = |edge: &Edge<'_>| edge.is_constraint_edge() || !waiting[edge.rev().face().fix().index()];
    let waiting_faces = mesh.inner_faces().filter(|face| waiting[face.index()]);
    let proposals = waiting_faces.filter_map(|face| {
        let bases = face.adjacent_edges().into_iter().filter(is_base);
        let base = bases.min_by(|a, b| a.length_2().total_cmp(&b.length_2()))?;
        let centre: Point = face.circumcenter().into();
        let ends = base.positions().map(Into::into);
        Some(Proposal {
            base: base.length_2(),
            face: face.fix(),
            corners: verdicts[face.index()].0,
            points: [apex(ends, centre, field), centre],
        })
    });
    proposals.collect()
}

fn is_too_large(triangle: [Point; 3], field: &SizeField<'_>) -> bool {
    let [a, b, c] = triangle;
    let (ab, ac) = (point::sub(b, a), point::sub(c, a));
    let sides = point::norm(ab) * point::norm(ac) * point::distance(b, c);
    let radius = sides / (2.0 * point::cross(ab, ac));
    3f64.sqrt() * radius > TOO_LARGE * field.at(point::centroid(triangle))
}

/// The point above the middle of a base edge that makes two edges of the wanted size, not beyond `centre`.
fn apex([a, b]: [Point; 2], centre: Point, field: &SizeField<'_>) -> Point {
    let middle = point::lerp(a, b, 0.5);
    let (reach, half) = (point::distance(centre, middle), 0.5 * point::distance(a, b));
    let wanted = field.at(middle).max(1.2 * half);
    let height = (wanted * wanted - half * half).sqrt();
    if height < reach { point::lerp(middle, centre, height / reach) } else { centre }
}

/// Whether a point for `face` is seen from it, keeps its distance from other points and stays off the outline.
fn accepts(mesh: &Delaunay, face: Face, p: Point, field: &SizeField<'_>) -> bool {
    let at = Point2::new(p[0], p[1]);
    let from = mesh.face(face);
    if !point::is_finite(p) || mesh.intersects_constraint(from.center(), at) {
        return false;
    }
    let around = match mesh.locate_with_hint(at, from.vertices()[0].fix()) {
        PositionInTriangulation::OnFace(face) => mesh.face(face),
        PositionInTriangulation::OnEdge(edge) => match mesh.directed_edge(edge).face().as_inner() {
            Some(face) => face,
            None => return false,
        },
        _ => return false,
    };
    let keep = APART * field.at(p);
    let far = |q: Point2<f64>| point::distance(q.into(), p) >= keep;
    around.adjacent_edges().into_iter().all(|edge| {
        let behind = edge.rev();
        let neighbours = [edge, behind.next(), behind.prev()];
        let visible = if edge.is_constraint_edge() { &neighbours[..1] } else { &neighbours[1..] };
        visible.iter().all(|edge| far(edge.from().position()) && far(edge.to().position()) && clears(edge, p))
    })
}

/// Whether `p` is outside the circle whose diameter is an edge of the outline.
fn clears(edge: &Edge<'_>, p: Point) -> bool {
    let [a, b] = edge.positions().map(|end| point::sub(end.into(), p));
    !edge.is_constraint_edge() || point::dot(a, b) > 0.0
}
