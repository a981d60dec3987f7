//! A compiled model with parameter values, ready to run: geometry, mesh, discretised system, run, record.

use crate::error::{Cause, Error, SolveError};
use crate::generated::{GapSize, Program, Solve};
use crate::mesh::{FilmSize, Follower, Mesh, MeshError, MeshSizing};
use crate::observer::Observer;
use crate::record::{End, RunRecord};
use crate::settings;
use crate::system::{At, FrameSampler, StageProblem, System, Transfer};
use crate::time::integrator::Point;
use crate::time::run::{Plan, run};
use crate::time::{Group, ImplicitSystem, Stage};
use ansatz_geometry::Geometry;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::rc::Rc;

#[cfg(test)]
mod tests;

/// A simulation of one model with one set of parameters.
pub struct Simulation {
    discretised: Discretised,
    record: RunRecord,
}

impl Simulation {
    /// Makes the mesh and the discretised system. `parameters` are the values of all parameters in the model's order and units.
    ///
    /// # Errors
    /// A parameter out of its range, a geometry that is not valid with these parameters, a mesh that cannot be made, or a model that does not fit it.
    pub fn new(program: &'static Program, parameters: &[f64]) -> Result<Self, Error> {
        let mut g = vec![0.0; program.layout.length];
        g[program.layout.parameters[0]..program.layout.parameters[1]].copy_from_slice(parameters);
        settings::check(program, &g, parameters)?;
        let geometry = (program.geometry)(&g).map_err(|faults| mesh_error(MeshError::Geometry(faults)))?;
        let sizing = (program.sizing)(&g);
        let moving: Vec<&str> = program.moving.iter().map(|moving| moving.region).collect();
        let mut mesh = Mesh::generate_bodies(&geometry, &sizing, &moving).map_err(mesh_error)?;
        let mut followers = followers(program, &geometry, &sizing, &g)?;
        let at_rest = mesh.nodes.clone();
        for follower in &mut followers {
            follower.attach(&mut mesh, &at_rest).map_err(mesh_error)?;
        }
        Self::put_on(program, parameters, mesh, followers)
    }

    /// The same on a mesh from elsewhere.
    ///
    /// # Errors
    /// [`Error::Model`] if the model names places that the mesh does not have.
    pub fn on_mesh(program: &'static Program, parameters: &[f64], mesh: Mesh) -> Result<Self, Error> {
        if let Some(moving) = program.moving.first() {
            let message = format!("`{}` moves, so its mesh is made from the model's geometry", moving.region);
            return Err(Error::Model(message));
        }
        Self::put_on(program, parameters, mesh, Vec::new())
    }

    fn put_on(
        program: &'static Program,
        parameters: &[f64],
        mesh: Mesh,
        followers: Vec<Follower>,
    ) -> Result<Self, Error> {
        let system = System::following(program, parameters, mesh, followers)?;
        let frames = samplers(&system)?;
        let discretised = Discretised { system, frames };
        Ok(Self { discretised, record: RunRecord::new(program.events) })
    }

    /// Assembles and factors on some threads from now on; one at first. Sums of integrals have the same bits on any number of threads, factors
    /// differ by no more than the order of sums inside large products.
    ///
    /// # Errors
    /// [`Error::Model`] for want of memory.
    pub fn use_threads(&mut self, threads: NonZeroUsize) -> Result<(), Error> {
        self.discretised.system.use_threads(threads)
    }

    /// Start and end of a run that ends at `until` at the latest [internal time]; (0, 0) for a stationary model.
    pub fn span(&self, until: Option<f64>) -> (f64, f64) {
        let (start, end) = self.discretised.system.settings.time.unwrap_or((0.0, 0.0));
        (start, until.map_or(end, |until| end.min(until)))
    }

    /// Runs from the start to the end of the model's time, or `until` if that is earlier. Returns the [outcome](RunRecord::outcome).
    ///
    /// # Errors
    /// There is no consistent start, the equations could not be solved on the way, or the observer failed. After a failed solve the record holds
    /// what was reached, and all output up to there was written.
    pub fn run(&mut self, observer: &mut dyn Observer, until: Option<f64>) -> Result<&'static str, Error> {
        let program = self.discretised.system.program;
        let settings = self.discretised.system.settings;
        let settings = Solve { time: settings.time.map(|_| self.span(until)), ..settings };
        let Program { events, tables, frames, .. } = program;
        observer.begin(&self.discretised.system.mesh)?;
        let y = self.discretised.system.start()?;
        self.record = run(&mut self.discretised, Plan { settings, events, tables, frames }, y, observer)?;
        match self.record.end() {
            End::Diverged(error) => Err(Error::Solve(error.clone())),
            End::Finished | End::Stopped(_) => Ok(self.record.outcome()),
        }
    }

    /// Record of the last run, empty before the first.
    pub fn record(&self) -> &RunRecord {
        &self.record
    }

    /// The discretised model by itself.
    pub fn into_system(self) -> System {
        self.discretised.system
    }

    /// The discretised model.
    pub fn system(&self) -> &System {
        &self.discretised.system
    }
}

/// What meshes the moving regions of a geometry.
fn followers(
    program: &'static Program,
    geometry: &Geometry,
    sizing: &MeshSizing,
    g: &[f64],
) -> Result<Vec<Follower>, Error> {
    let films: Vec<FilmSize> = program.gap_sizes.iter().map(|rule| film(program, rule, g)).collect();
    let index = |name: &str| geometry.regions.iter().position(|region| region.name == name);
    let regions = program.moving.iter().filter_map(|moving| index(moving.region));
    let follower = |region| Follower::new(geometry, region, sizing, films.clone()).map_err(mesh_error);
    regions.map(follower).collect()
}

/// A size between the surfaces of a pair; `g` has the parameters.
fn film(program: &'static Program, rule: &'static GapSize, g: &[f64]) -> FilmSize {
    let (pair, g) = (&program.pairs[rule.pair], g.to_vec());
    FilmSize {
        surfaces: [pair.first.to_vec(), pair.second.to_vec()],
        at: [rule.sides.has(0), rule.sides.has(1)],
        size: Rc::new(move |gap| (rule.size)(gap, [0.0; 2], [0.0; 2], &g)),
    }
}

/// One sampler for each kind of frames.
fn samplers(system: &System) -> Result<Vec<FrameSampler>, Error> {
    system.program.frames.iter().map(|frames| FrameSampler::new(frames, &system.mesh)).collect()
}

/// Faults of the geometry are told as such.
fn mesh_error(error: MeshError) -> Error {
    match error {
        MeshError::Geometry(faults) => Error::Geometry(faults.iter().map(ToString::to_string).collect()),
        other => Error::Mesh(other.to_string()),
    }
}

/// The discretised model as the time integration sees it.
struct Discretised {
    system: System,
    frames: Vec<FrameSampler>,
}

impl ImplicitSystem for Discretised {
    fn groups(&self) -> Vec<Group> {
        let unknowns = &self.system.unknowns;
        let with_rates = |k: usize| self.system.program.fields[k].differential;
        let all_follow = !(0..unknowns.fields.len()).any(with_rates);
        let fields = unknowns.fields.iter().enumerate().map(|(k, f)| Group {
            range: f.first..f.first + f.count(),
            // What goes from mesh to mesh has errors of its own. Where no field has rates, steps follow how all of them change.
            tested: !self.system.moves(k) && (with_rates(k) || all_follow),
        });
        let differential = self.system.program.state_system.as_ref().map_or(&[][..], |s| s.differential);
        let first = unknowns.states;
        let state = |(k, &tested): (usize, &bool)| Group { range: first + k..first + k + 1, tested };
        fields.chain(differential.iter().enumerate().map(state)).collect()
    }

    fn algebraic(&self) -> Vec<Range<usize>> {
        let unknowns = &self.system.unknowns;
        let fields = unknowns.fields.iter().zip(self.system.program.fields);
        let follow = fields.filter(|(_, field)| !field.differential);
        follow.map(|(numbers, _)| numbers.first..numbers.first + numbers.count()).collect()
    }

    fn solve_stage(&mut self, stage: &Stage<'_>, y: &mut [f64]) -> Result<usize, SolveError> {
        let problem = StageProblem { time: stage.time, alpha: stage.alpha, base: stage.base };
        let report = if self.system.equation_count() == 0 {
            self.system.solve_scalars(&problem, y)?
        } else if self.system.settings.time.is_none() {
            self.system.solve_stationary(&problem, y)?
        } else {
            self.system.solve_instant(&problem, y)?
        };
        if report.unstable_modes > 0 {
            return Err(SolveError {
                cause: Cause::Unstable(report.unstable_modes),
                time: stage.time,
                step: 0.0,
                iterations: report.iterations,
                residual: report.residual,
                place: String::from("none: the equations hold, but the equilibrium does not attract"),
                terms: Vec::new(),
            });
        }
        Ok(report.iterations)
    }

    fn set_states(&mut self, time: f64, y: &mut [f64], values: &[(usize, f64)]) -> Result<(), SolveError> {
        self.system.set_states(time, y, values)
    }

    fn renew(&mut self, point: &Point, anew: bool) -> Result<Option<Transfer>, SolveError> {
        if !self.system.has_moving_regions() {
            return Ok(None);
        }
        let stuck = |error: Error| SolveError {
            cause: Cause::Mesh(error.to_string()),
            time: point.time,
            step: 0.0,
            iterations: 0,
            residual: 0.0,
            place: String::new(),
            terms: Vec::new(),
        };
        let transfer = self.system.follow_bodies(&point.values, anew).map_err(stuck)?;
        self.frames = samplers(&self.system).map_err(stuck)?;
        Ok(Some(transfer))
    }

    fn present_mesh(&self) -> Option<Mesh> {
        self.system.has_moving_regions().then(|| self.system.mesh.clone())
    }

    fn observe(&mut self, point: &Point) -> Vec<f64> {
        self.system.observe(point.time, &point.values, &point.rates)
    }

    fn sample(&mut self, frame: usize, point: &Point, g: &[f64]) -> Vec<Vec<f64>> {
        let at = At { y: &point.values, rates: &point.rates, g, alpha: 0.0 };
        self.frames[frame].sample(&self.system.unknowns, at)
    }
}
