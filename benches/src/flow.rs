//! P3: stationary incompressible flow with quadratic velocities and linear pressures, on the peers' meshes.

use crate::clock::median;
use ansatz::generated::Program;
use ansatz::mesh::{Mesh, mesh_of_triangles, structured_rectangle};
use ansatz::system::{StageProblem, System};
use ansatz::{Error, error};

/// Names of the boundaries by their number in a mesh file.
const BOUNDARIES: [&str; 4] = ["wall", "inlet", "outlet", "cylinder"];

/// A flow ready to be solved.
pub struct Flow {
    system: System,
    start: Vec<f64>,
}

/// A flow that was solved.
pub struct Flowing {
    /// Newton iterations.
    pub iterations: usize,
    /// Results by name.
    pub results: Vec<(&'static str, f64)>,
}

impl Flowing {
    /// A result by its name.
    pub fn result(&self, name: &str) -> Option<f64> {
        self.results.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }
}

impl Flow {
    /// Flow past a cylinder, DFG benchmark 2D-1, on a mesh given as the text of a file: see [`read_mesh`].
    ///
    /// # Errors
    /// A text that is no mesh.
    pub fn past_cylinder(mesh: &str) -> Result<Self, Error> {
        let mesh = read_mesh(mesh).ok_or_else(|| Error::Mesh("the file is no list of triangles".into()))?;
        Self::new(&crate::dfg::PROGRAM, &crate::dfg::Parameters::default().values(), mesh)
    }

    /// Lid-driven cavity at Reynolds number 1000 on n x n x 2 triangles.
    ///
    /// # Errors
    /// None with the shipped model.
    pub fn cavity(n: usize) -> Result<Self, Error> {
        let mesh = structured_rectangle(n, n, |s, t| [s, t]);
        Self::new(&crate::cavity::PROGRAM, &crate::cavity::Parameters::default().values(), mesh)
    }

    fn new(program: &'static Program, values: &[f64], mesh: Mesh) -> Result<Self, Error> {
        let mut system = System::new(program, values, mesh)?;
        let start = system.start()?;
        Ok(Self { system, start })
    }

    /// Unknowns, held ones included.
    pub fn unknowns(&self) -> usize {
        self.system.unknowns.length
    }

    /// Cells of the mesh.
    pub fn cells(&self) -> usize {
        self.system.mesh.cells.len()
    }

    /// Solves it. Results: the columns of the model's table behind the time, and for the cavity the extremes of u at x = 1/2 and of v at
    /// y = 1/2 over the nodes there.
    ///
    /// # Errors
    /// [`Error::Solve`] if there is no way to a solution.
    pub fn run(&mut self) -> Result<Flowing, Error> {
        let mut y = self.start.clone();
        let rates = vec![0.0; y.len()];
        let problem = StageProblem { time: 0.0, alpha: 0.0, base: &rates };
        let report = self.system.solve_stationary(&problem, &mut y).map_err(error::Error::from)?;
        let g = self.system.observe(0.0, &y, &rates);
        let columns = self.system.program.tables.iter().flat_map(|table| table.columns).skip(1);
        let mut results: Vec<_> = columns.map(|column| (column.name, (column.value)(&g))).collect();
        if self.system.program.name == crate::cavity::PROGRAM.name {
            let (u, v) = (self.on_midline(&y, 0), self.on_midline(&y, 1));
            results.push(("umin", u.iter().copied().fold(f64::INFINITY, f64::min)));
            results.push(("vmax", v.iter().copied().fold(f64::NEG_INFINITY, f64::max)));
            results.push(("vmin", v.iter().copied().fold(f64::INFINITY, f64::min)));
        }
        Ok(Flowing { iterations: report.iterations, results })
    }

    /// Time of one assembly of residual and tangent \[s\], measured apart from the solve.
    ///
    /// # Errors
    /// None with the shipped models.
    pub fn assembly(&mut self) -> Result<f64, Error> {
        let problem = StageProblem { time: 0.0, alpha: 0.0, base: &self.start };
        let probe = self.system.probe(&problem, &self.start);
        let mut probe = probe.map_err(|cause| Error::Model(cause.to_string()))?;
        Ok(median(|| probe.assemble()))
    }

    /// A component of the velocity at the nodes half-way along its own direction.
    fn on_midline(&self, y: &[f64], component: usize) -> Vec<f64> {
        let velocity = &self.system.unknowns.fields[0];
        let nodes = self.system.mesh.nodes.iter().enumerate();
        let midline = nodes.filter(|(_, x)| (x[component] - 0.5).abs() < 1e-9);
        midline.filter_map(|(node, _)| velocity.unknown(node, component)).map(|unknown| y[unknown]).collect()
    }
}

/// The mesh of a text: numbers of points, triangles and boundary edges; a line `x y label` for each point, `a b c label` for each triangle and
/// `a b label` for each edge, points numbered from 1. Labels of edges: 1 wall, 2 inlet, 3 outlet, 4 cylinder. `None` if it is something else.
pub fn read_mesh(text: &str) -> Option<Mesh> {
    let mut lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let counts: Vec<usize> = lines.next()?.iter().map(|word| word.parse()).collect::<Result<_, _>>().ok()?;
    let &[points, triangles, edges] = counts.as_slice() else { return None };
    let point = |line: Vec<&str>| Some([line.first()?.parse().ok()?, line.get(1)?.parse().ok()?]);
    let points: Vec<[f64; 2]> = lines.by_ref().take(points).map(point).collect::<Option<_>>()?;
    let count = points.len();
    let index = |word: Option<&&str>| word?.parse::<usize>().ok()?.checked_sub(1).filter(|&i| i < count);
    let triangle = |line: Vec<&str>| Some([index(line.first())?, index(line.get(1))?, index(line.get(2))?]);
    let triangles: Vec<_> = lines.by_ref().take(triangles).map(triangle).collect::<Option<_>>()?;
    let edge = |line: Vec<&str>| {
        let name = BOUNDARIES.get(index(line.get(2))?)?;
        Some(((*name).into(), [index(line.first())?, index(line.get(1))?]))
    };
    let edges: Vec<_> = lines.take(edges).map(edge).collect::<Option<_>>()?;
    Some(mesh_of_triangles("water", points, &triangles, &edges))
}
