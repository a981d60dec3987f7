//! The discretised model: everything of a compiled program on one mesh with one set of parameters.
//!
//! y = (field unknowns, states, functionals). Given the field unknowns, functionals are evaluated and the states solved for exactly; what Newton's
//! method sees is the balance of the fields alone, whose tangent is the sparse matrix of the integrals plus a few outer products, one
//! for each functional:
//! K + sum_j b_j (grad Z_j)^T, with b_j = sum_k (d c_k / d Z_j) grad Z_k + d R / d (states) . d (states) / d Z_j.

mod assembly;
mod balance;
mod broyden;
mod contact;
mod convergence;
mod elements;
mod frames;
mod functionals;
mod globals;
mod levels;
mod newton;
mod observables;
mod place;
mod point;
mod probe;
mod ramp;
mod scalars;
mod shares;
mod sides;
mod start;
mod states;
mod terms;
mod ties;
mod transfer;
mod unknowns;

pub use balance::Balance;
pub use frames::FrameSampler;
pub use newton::{NewtonReport, StageProblem};
pub use place::Place;
pub use point::{Sampler, node_places};
pub use probe::Probe;
pub use terms::At;
pub use transfer::Transfer;
pub use unknowns::{FieldNumbers, Unknowns, domain_nodes, path_edges, region_cells};

use crate::error::Error;
use crate::generated::{Program, Solve};
use crate::mesh::{Follower, Mesh};
use crate::settings::solution;
use crate::solve::border::BorderedSolver;
use crate::solve::sparse::{MatrixKind, SparsePattern};
use crate::time::control::with_step_bounds;
use assembly::Assembly;
use contact::PairOn;
use functionals::FunctionalOn;
use levels::Level;
use observables::ObservableOn;
use ramp::Ramp;
use start::HeldUnknown;
use states::StateSolver;
use std::num::NonZeroUsize;
use terms::{Layout, Term};
use ties::Tied;
use unknowns::NONE;

/// A compiled model on a mesh.
pub struct System {
    /// The compiled model.
    pub program: &'static Program,
    /// The mesh.
    pub mesh: Mesh,
    /// What meshes the moving regions, in the program's order.
    followers: Vec<Follower>,
    /// How often the moving regions were meshed.
    pub meshings: usize,
    /// Numbering of y.
    pub unknowns: Unknowns,
    /// Settings of the solution.
    pub settings: Solve,
    /// Globals as of the last evaluation.
    pub g: Vec<f64>,
    held: Vec<HeldUnknown>,
    /// Unknowns that follow others.
    ties: Vec<Tied>,
    /// Equation of each field unknown, or [`NONE`] where it is held; that of its partner where it is tied.
    equations: Vec<u32>,
    /// Unknown of each equation.
    free: Vec<u32>,
    assembly: Assembly,
    functionals: Vec<FunctionalOn>,
    pairs: Vec<PairOn>,
    observables: Vec<ObservableOn>,
    states: Option<StateSolver>,
    kind: MatrixKind,
    pattern: SparsePattern,
    solver: BorderedSolver,
    /// Threads that assemble and factor.
    threads: NonZeroUsize,
    /// Matrix values and one spare entry for what belongs to held unknowns; behind them, where there are ties to rates, the same again for the
    /// columns that d rate / d value multiplies.
    values: Vec<f64>,
    /// The factors of the last stage, if they may serve the next one.
    factored: Option<newton::Factored>,
    /// Size of the forces that balanced each other in each field in the last stage; none before.
    forces: Vec<f64>,
    /// Place of each equation's diagonal entry in the values.
    diagonal: Vec<usize>,
    /// Typical edge length of a cell.
    cell_size: f64,
    /// The last factorisation met negative pivots: the next one starts with the indefinite method.
    indefinite: bool,
    /// Negative pivots of a stable tangent: those of the first stage solved, none unless the model is a saddle point problem.
    stable_pivots: Option<usize>,
    /// Place of the stabilised tangent that helped last among those that are tried.
    stabiliser: usize,
    /// Scalar fields whose level nothing fixes; `None` before the first start.
    levels: Option<Vec<Level>>,
    /// What a stationary solution has reached on its way, while it is on one.
    ramp: Option<Ramp>,
}

impl System {
    /// Puts a program with these parameters on a mesh.
    pub fn new(program: &'static Program, parameters: &[f64], mesh: Mesh) -> Result<Self, Error> {
        Self::following(program, parameters, mesh, Vec::new())
    }

    /// The same on a mesh whose moving regions `followers` mesh anew.
    pub fn following(
        program: &'static Program,
        parameters: &[f64],
        mesh: Mesh,
        followers: Vec<Follower>,
    ) -> Result<Self, Error> {
        let mut system = Self::without_pattern(program, parameters, mesh, followers)?;
        let y = vec![0.0; system.unknowns.length];
        system.rebuild_pattern(&y)?;
        Ok(system)
    }

    /// All but the pattern of the matrix, which depends on who touches whom.
    fn without_pattern(
        program: &'static Program,
        parameters: &[f64],
        mesh: Mesh,
        followers: Vec<Follower>,
    ) -> Result<Self, Error> {
        let unknowns = Unknowns::new(program, &mesh)?;
        let g = globals::constants(program, parameters, &mesh)?;
        let held = start::held_unknowns(program, &mesh, &unknowns)?;
        let ties = ties::tied_unknowns(program, &mesh, &unknowns)?;
        let (equations, free) = start::number_equations(&unknowns, held.iter().map(|h| h.unknown), &ties);
        let terms: Vec<Term> =
            program.integrals.iter().map(|i| Term::new(i, &mesh, &unknowns)).collect::<Result<_, _>>()?;
        let functionals: Vec<FunctionalOn> = program
            .functionals
            .iter()
            .map(|f| FunctionalOn::new(f, &mesh, &unknowns, &g))
            .collect::<Result<_, _>>()?;
        let pairs = contact::prepare(program, &mesh, &g)?;
        let observables = observables::prepare(program, &mesh, &unknowns, &ties, &g)?;
        let symmetric = in_the_matrix(&terms, &functionals).all(|t| t.integral.symmetric)
            && !pairs.iter().any(PairOn::is_loaded)
            && ties.is_empty();
        let kind = if symmetric { MatrixKind::Symmetric } else { MatrixKind::Unsymmetric };
        let pattern = SparsePattern::from_elements(free.len(), kind, []);
        let solver = analyse(&pattern, NonZeroUsize::MIN)?;
        let states = program.state_system.as_ref().map(|system| {
            let bounds = program.states.iter().map(|s| (s.bounds)(&g)).collect();
            StateSolver::new(system, program.layout, bounds)
        });
        let cell_size = typical_edge(&mesh);
        let settings = with_step_bounds(solution(program, &g)?);
        Ok(Self {
            program,
            settings,
            mesh,
            followers,
            meshings: 1,
            unknowns,
            g,
            held,
            ties,
            equations,
            free,
            assembly: Assembly::new(terms),
            functionals,
            pairs,
            observables,
            states,
            kind,
            pattern,
            solver,
            threads: NonZeroUsize::MIN,
            values: Vec::new(),
            diagonal: Vec::new(),
            factored: None,
            forces: Vec::new(),
            cell_size,
            indefinite: false,
            stable_pivots: None,
            stabiliser: 0,
            levels: None,
            ramp: None,
        })
    }

    /// Assembles and factors on some threads from now on, one at first; see [`Simulation::use_threads`](crate::Simulation::use_threads).
    ///
    /// # Errors
    /// Want of memory for the factors.
    pub fn use_threads(&mut self, threads: NonZeroUsize) -> Result<(), Error> {
        self.threads = threads;
        self.solver.use_threads(threads.get()).map_err(|e| Error::Model(e.to_string()))?;
        self.factored = None;
        self.share_out();
        self.locate();
        Ok(())
    }

    /// Threads that assemble and factor.
    pub fn threads(&self) -> NonZeroUsize {
        self.threads
    }

    fn share_out(&mut self) {
        self.assembly.share(self.threads.get(), &self.mesh, &self.unknowns, &self.ties);
    }

    /// Number of equations that the sparse solver sees.
    pub fn equation_count(&self) -> usize {
        self.free.len()
    }

    /// Stored entries of the matrix.
    pub fn matrix_entries(&self) -> usize {
        self.pattern.entries()
    }

    /// Whether the matrix is symmetric, outer products of functionals apart.
    pub fn is_symmetric(&self) -> bool {
        self.kind == MatrixKind::Symmetric
    }

    /// Collects who couples to whom at `y` and analyses the matrix anew.
    fn rebuild_pattern(&mut self, y: &[f64]) -> Result<(), Error> {
        let mut groups: Vec<Vec<u32>> = Vec::new();
        for term in in_the_matrix(&self.assembly.terms, &self.functionals) {
            groups.extend(term.elements.element_unknowns());
        }
        for pair in self.pairs.iter_mut().filter(|pair| pair.acts()) {
            pair.update(&self.mesh, &self.unknowns, y);
            groups.extend(pair.couplings(&self.unknowns));
        }
        for group in &mut groups {
            group.iter_mut().for_each(|u| *u = self.equations[*u as usize]);
            group.retain(|&equation| equation != NONE);
        }
        self.pattern =
            SparsePattern::from_elements(self.free.len(), self.kind, groups.iter().map(Vec::as_slice));
        self.solver = analyse(&self.pattern, self.threads)?;
        let of_rates = self.ties.iter().any(|tied| tied.rate);
        self.values = vec![0.0; (self.pattern.entries() + 1) * if of_rates { 2 } else { 1 }];
        self.factored = None;
        let diagonal = (0..self.free.len() as u32).filter_map(|i| self.pattern.position(i, i));
        self.diagonal = diagonal.collect();
        self.locate();
        Ok(())
    }

    /// Looks up where in the matrix tangents go.
    fn locate(&mut self) {
        let mut follows = vec![false; self.unknowns.length];
        self.ties.iter().filter(|tied| tied.rate).for_each(|tied| follows[tied.unknown] = true);
        let (pattern, equations, length) = (&self.pattern, &self.equations[..], self.values.len());
        let layout = Layout { pattern, equations, follows: &follows, length };
        self.assembly.locate(layout);
        self.functionals.iter_mut().flat_map(FunctionalOn::terms_mut).for_each(|term| term.locate(layout));
    }
}

/// Terms that have a tangent: neither dead loads nor linear functionals.
fn in_the_matrix<'a>(terms: &'a [Term], functionals: &'a [FunctionalOn]) -> impl Iterator<Item = &'a Term> {
    let of_functionals = functionals.iter().flat_map(|f| f.terms());
    terms.iter().chain(of_functionals).filter(|term| term.integral.tangent.is_some())
}

/// A solver for the pattern. Without any equation it is one for a single equation, which is never asked.
fn analyse(pattern: &SparsePattern, threads: NonZeroUsize) -> Result<BorderedSolver, Error> {
    let single = (pattern.size() == 0).then(|| SparsePattern::from_elements(1, MatrixKind::Symmetric, []));
    let solver = BorderedSolver::new(single.as_ref().unwrap_or(pattern));
    let shared = solver.and_then(|mut solver| solver.use_threads(threads.get()).map(|()| solver));
    shared.map_err(|e| Error::Model(e.to_string()))
}

/// Typical edge length: that of equal cells in the box around a mesh, or of equal edges along its paths where it has no cells.
fn typical_edge(mesh: &Mesh) -> f64 {
    let span = |axis: usize| {
        let values = || mesh.nodes.iter().map(|x| x[axis]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let extent = if mesh.nodes.is_empty() { 0.0 } else { span(0).hypot(span(1)) };
    let edges: usize = mesh.paths.iter().map(|path| path.edges.len()).sum();
    if mesh.cells.is_empty() {
        extent / edges.max(1) as f64
    } else {
        extent / (mesh.cells.len() as f64).sqrt()
    }
}
