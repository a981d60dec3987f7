//! P2 and P4: whole nonlinear solves in four load steps, on the peers' meshes.

use crate::clock::time_on;
use ansatz::generated::Program;
use ansatz::mesh::{Mesh, structured_rectangle};
use ansatz::observer::{Observer, Step};
use ansatz::system::{StageProblem, System};
use ansatz::{Error, Simulation};
use std::num::NonZeroUsize;

/// A solve that ran.
pub struct Solved {
    /// The last row of the model's table: its end time and results.
    pub results: Vec<f64>,
    /// Newton iterations of each step.
    pub iterations: Vec<usize>,
    /// Newton iterations of the whole run, those that measure the rates at the start included.
    pub total: usize,
}

/// A problem ready to be solved.
pub struct Solve {
    program: &'static Program,
    values: Vec<f64>,
    simulation: Simulation,
}

impl Solve {
    /// P2, Cook's membrane on n x n x 2 triangles. Results: time, displacement of the upper right corner in both directions.
    ///
    /// # Errors
    /// None with the shipped model.
    pub fn cook(n: usize) -> Result<Self, Error> {
        let mesh = structured_rectangle(n, n, |s, t| [48.0 * s, 44.0 * s + t * (44.0 - 28.0 * s)]);
        let values = crate::cook::Parameters::default().values();
        Self::new(&crate::cook::PROGRAM, &values, mesh)
    }

    /// P4, a sphere pressed into a cylinder on n x n x 2 triangles, finer towards the first contact. Results: time, displacement of that
    /// point, force per radian.
    ///
    /// # Errors
    /// None with the shipped model.
    pub fn sphere(n: usize) -> Result<Self, Error> {
        let mesh = structured_rectangle(n, n, |s, t| [2.0 * s.powf(1.5), 2.0 * (1.0 - (1.0 - t).powf(1.5))]);
        let values = crate::sphere::Parameters::default().values();
        Self::new(&crate::sphere::PROGRAM, &values, mesh)
    }

    fn new(program: &'static Program, values: &[f64], mesh: Mesh) -> Result<Self, Error> {
        let simulation = Simulation::on_mesh(program, values, mesh)?;
        Ok(Self { program, values: values.to_vec(), simulation })
    }

    /// Solves on some threads from now on, one at first.
    ///
    /// # Errors
    /// Want of memory.
    pub fn use_threads(&mut self, threads: NonZeroUsize) -> Result<(), Error> {
        self.simulation.use_threads(threads)
    }

    /// Unknowns, held ones included.
    pub fn unknowns(&self) -> usize {
        self.simulation.system().unknowns.length
    }

    /// Cells of the mesh.
    pub fn cells(&self) -> usize {
        self.simulation.system().mesh.cells.len()
    }

    /// Solves it.
    ///
    /// # Errors
    /// [`Error::Solve`] if Newton's method does not converge.
    pub fn run(&mut self) -> Result<Solved, Error> {
        let mut notes = Notes::default();
        self.simulation.run(&mut notes, None)?;
        let total = self.simulation.record().statistics().iterations;
        Ok(Solved { results: notes.row, iterations: notes.iterations, total })
    }

    /// Time of one assembly of residual and tangent \[s\], measured apart from the solve.
    ///
    /// # Errors
    /// None with the shipped models.
    pub fn assembly(&self) -> Result<f64, Error> {
        let mesh = self.simulation.system().mesh.clone();
        let mut system = System::new(self.program, &self.values, mesh)?;
        let threads = self.simulation.system().threads();
        system.use_threads(threads)?;
        let y = vec![0.0; system.unknowns.length];
        let problem = StageProblem { time: 0.0, alpha: 0.0, base: &y };
        let mut probe = system.probe(&problem, &y).map_err(|cause| Error::Model(cause.to_string()))?;
        Ok(time_on(threads.get(), || probe.assemble()))
    }
}

#[derive(Default)]
struct Notes {
    row: Vec<f64>,
    iterations: Vec<usize>,
}

impl Observer for Notes {
    fn step(&mut self, step: &Step<'_>) -> Result<(), Error> {
        self.iterations.push(step.iterations);
        Ok(())
    }
    fn row(&mut self, _: usize, values: &[f64]) -> Result<(), Error> {
        self.row = values.to_vec();
        Ok(())
    }
}
