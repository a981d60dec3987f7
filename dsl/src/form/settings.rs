//! Everything that depends on parameters alone: defaults, bounds, geometry, mesh sizes, starts, the settings of the solution.

use super::Builder;
use crate::diagnostic::{Code, Diagnostic};
use crate::lower::{Lowered, Lowering, SymbolKind, Value, internal, unsupported};
use crate::model::{self, Domain, Expr, Integrator, PairId, Piece, SegmentKind, Sides, Start, Turn};
use crate::scalar::{Id, symbols_of};

/// A parameter.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Parameter {
    pub default: Id,
    pub bounds: Bounds,
}

/// Allowed values of a parameter.
#[derive(Clone, Debug)]
pub enum Bounds {
    /// Any.
    Any,
    /// Between two, both included.
    Range([Id; 2]),
    /// One of these.
    Set(Vec<Id>),
}

/// A state.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct State {
    /// Whether the start value is given, not solved for.
    pub fixed: bool,
    /// Start value or guess.
    pub start: Id,
    pub bounds: Option<[Id; 2]>,
}

/// A path of the geometry.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Path {
    pub start: [Id; 2],
    pub segments: Vec<Segment>,
}

/// A piece of a path.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Segment {
    pub to: [Id; 2],
    /// Centre and sense of an arc; `None` for a line.
    pub arc: Option<([Id; 2], Turn)>,
}

/// Mesh sizes.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Mesh {
    pub sizes: Vec<(Id, Option<Domain>)>,
    /// Sizes on surfaces of pairs, functions of the gap.
    pub gap_sizes: Vec<(Id, PairId, Sides)>,
    pub growth: Id,
    pub quality: Id,
}

/// Settings of the solution.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Solve {
    pub time: Option<[Id; 2]>,
    pub integrator: Integrator,
    pub max_step: Id,
    pub min_step: Id,
    pub step_tolerance: Id,
    pub newton_tolerance: Id,
    pub newton_iterations: Id,
}

/// All of it.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Settings {
    pub parameters: Vec<Parameter>,
    pub states: Vec<State>,
    pub paths: Vec<Path>,
    pub mesh: Mesh,
    /// Search distance of each pair.
    pub searches: Vec<Id>,
    pub solve: Solve,
}

impl<'m> Builder<'m> {
    /// Lowers all settings; `None` if one cannot be.
    pub(super) fn settings(&mut self) -> Option<Settings> {
        let model = self.lowering.model;
        Some(Settings {
            parameters: self.all(&model.params, parameter)?,
            states: self.all(&model.states, state)?,
            paths: self.all(&model.geometry.paths, path)?,
            mesh: self.attempt(|lowering| mesh(lowering, &model.mesh))?,
            searches: self.all(&model.pairs, |lowering, pair| lowering.global_scalar(&pair.search))?,
            solve: self.attempt(|lowering| solve(lowering, &model.solve))?,
        })
    }

    /// Lowers each of a list, so that every problem is found; `None` if there is one.
    fn all<S, T>(
        &mut self,
        list: &'m [S],
        lower: impl Fn(&mut Lowering<'m>, &'m S) -> Lowered<T>,
    ) -> Option<Vec<T>> {
        let lowered: Vec<Option<T>> =
            list.iter().map(|one| self.attempt(|lowering| lower(lowering, one))).collect();
        lowered.into_iter().collect()
    }
}

fn parameter<'m>(lowering: &mut Lowering<'m>, param: &'m model::Param) -> Lowered<Parameter> {
    let default = lowering.global_scalar(&param.default)?;
    let bounds = match &param.bounds {
        None => Bounds::Any,
        Some(model::Bounds::Range(low, high)) => {
            Bounds::Range([lowering.global_scalar(low)?, lowering.global_scalar(high)?])
        }
        Some(model::Bounds::Set(values)) => {
            let values: Lowered<Vec<Id>> = values.iter().map(|value| lowering.global_scalar(value)).collect();
            Bounds::Set(values?)
        }
    };
    Ok(Parameter { default, bounds })
}

fn state<'m>(lowering: &mut Lowering<'m>, state: &'m model::State) -> Lowered<State> {
    let bounds = match &state.bounds {
        Some((low, high)) => Some([lowering.global_scalar(low)?, lowering.global_scalar(high)?]),
        None => None,
    };
    let start = match (&state.start, bounds) {
        (Start::Value(value) | Start::Guess(value), _) => lowering.global_scalar(value)?,
        (Start::Solved, Some([low, high])) => {
            let (sum, half) = (lowering.pool.add(low, high), lowering.pool.constant(0.5));
            lowering.pool.mul(half, sum)
        }
        (Start::Solved, None) => lowering.pool.zero(),
    };
    Ok(State { fixed: matches!(state.start, Start::Value(_)), start, bounds })
}

/// In-plane coordinates of a point.
fn point<'m>(lowering: &mut Lowering<'m>, expr: &'m Expr) -> Lowered<[Id; 2]> {
    let axes = lowering.model.coordinates.frame.axes();
    match lowering.global(expr)? {
        Value::Vector(x) => Ok(axes.map(|axis| x[axis])),
        Value::Zero => Ok([lowering.pool.zero(); 2]),
        _ => Err(internal(expr.span, "a point was expected")),
    }
}

fn path<'m>(lowering: &mut Lowering<'m>, path: &'m model::Path) -> Lowered<Path> {
    let start = point(lowering, &path.start)?;
    let mut segments = Vec::new();
    for segment in &path.segments {
        let arc = match &segment.kind {
            SegmentKind::Line => None,
            SegmentKind::Arc { about, turn } => Some((point(lowering, about)?, *turn)),
        };
        segments.push(Segment { to: point(lowering, &segment.to)?, arc });
    }
    Ok(Path { start, segments })
}

fn mesh<'m>(lowering: &mut Lowering<'m>, mesh: &'m model::MeshSettings) -> Lowered<Mesh> {
    let (mut sizes, mut gap_sizes) = (Vec::new(), Vec::new());
    for (size, domain) in &mesh.sizes {
        let pieces = domain.as_ref().map_or(&[][..], |domain| &domain.pieces);
        if let [Piece::Pair(..), ..] = pieces {
            gap_sizes.extend(gap_size(lowering, size, pieces)?);
        } else {
            sizes.push((lowering.global_scalar(size)?, domain.clone()));
        }
    }
    Ok(Mesh {
        sizes,
        gap_sizes,
        growth: or_constant(lowering, mesh.growth.as_ref(), 1.25)?,
        quality: or_constant(lowering, mesh.quality.as_ref(), 0.3)?,
    })
}

/// A size on surfaces of pairs: what lies between them is meshed before anything else is known.
fn gap_size<'m>(
    lowering: &mut Lowering<'m>,
    size: &'m Expr,
    pieces: &[Piece],
) -> Lowered<Vec<(Id, PairId, Sides)>> {
    if lowering.model.moving.is_empty() {
        let message = "a mesh size on a pair is for a region that moves between its surfaces, and none does";
        let help = "say `moving D by u;`, or give sizes on the paths: `size = 0.1 um on nucleus + endo.rim;`";
        return Err(Box::new(Diagnostic::error(Code::Misplaced, size.span, message).help(help)));
    }
    let mut sizes = Vec::new();
    for piece in pieces {
        let Piece::Pair(pair, sides) = *piece else { continue };
        let id = lowering.scalar_on_pair(size, pair)?;
        let normal = |symbol| matches!(lowering.symbols.kind(symbol), SymbolKind::PairNormal(..));
        if symbols_of(&lowering.pool, &[id]).into_iter().any(normal) {
            return Err(unsupported(size.span, "a mesh size that depends on the direction of a surface"));
        }
        sizes.push((id, pair, sides));
    }
    Ok(sizes)
}

fn or_constant<'m>(lowering: &mut Lowering<'m>, expr: Option<&'m Expr>, otherwise: f64) -> Lowered<Id> {
    expr.map_or_else(|| Ok(None), |expr| lowering.global_scalar(expr).map(Some))
        .map(|id| id.unwrap_or_else(|| lowering.pool.constant(otherwise)))
}

fn solve<'m>(lowering: &mut Lowering<'m>, solve: &'m model::Solve) -> Lowered<Solve> {
    let time = match &solve.time {
        Some((from, to)) => Some([lowering.global_scalar(from)?, lowering.global_scalar(to)?]),
        None => None,
    };
    Ok(Solve {
        time,
        integrator: solve.integrator,
        max_step: or_constant(lowering, solve.max_step.as_ref(), f64::INFINITY)?,
        min_step: or_constant(lowering, solve.min_step.as_ref(), 0.0)?,
        step_tolerance: lowering.global_scalar(&solve.step_tolerance)?,
        newton_tolerance: lowering.global_scalar(&solve.newton_tolerance)?,
        newton_iterations: lowering.global_scalar(&solve.newton_iterations)?,
    })
}
