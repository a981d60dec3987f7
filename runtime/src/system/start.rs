//! Held unknowns, the numbering of equations, and consistent values at the start.

use super::System;
use super::ties::{Tied, share_equations};
use super::unknowns::{NONE, Unknowns, domain_nodes};
use crate::error::{Cause, Error, SolveError};
use crate::generated::{Program, Start};
use crate::mesh::Mesh;

/// Nodes nearer to the axis than this part of the largest radius are on it; the rest is rounding.
const AXIS: f64 = 1e-12;

/// A field unknown whose value is prescribed.
#[derive(Clone, Debug)]
pub struct HeldUnknown {
    /// The unknown.
    pub unknown: usize,
    /// Which hold of the program prescribes it; `None`: zero, on the axis of symmetry.
    pub hold: Option<usize>,
    /// Reference position.
    pub x: [f64; 2],
}

/// Everything that is held, each unknown once; where holds meet, the last one written wins.
pub fn held_unknowns(program: &Program, mesh: &Mesh, unknowns: &Unknowns) -> Result<Vec<HeldUnknown>, Error> {
    let mut by_unknown: Vec<Option<HeldUnknown>> = vec![None; unknowns.states];
    let mut hold_nodes = |field: usize, component: usize, hold: Option<usize>, nodes: Vec<u32>| {
        for node in nodes {
            if let Some(unknown) = unknowns.fields[field].unknown(node as usize, component) {
                by_unknown[unknown] = Some(HeldUnknown { unknown, hold, x: mesh.nodes[node as usize] });
            }
        }
    };
    if program.axisymmetric {
        let vectors = (0..program.fields.len()).filter(|&f| program.fields[f].components == 2);
        for field in vectors {
            hold_nodes(field, 0, None, axis_nodes(mesh));
        }
    }
    for (k, hold) in program.holds.iter().enumerate() {
        hold_nodes(hold.field, hold.component, Some(k), domain_nodes(mesh, hold.domain)?);
    }
    Ok(by_unknown.into_iter().flatten().collect())
}

/// Nodes on the axis of symmetry, whatever path leads along it.
fn axis_nodes(mesh: &Mesh) -> Vec<u32> {
    let widest = mesh.nodes.iter().fold(0.0, |widest: f64, x| widest.max(x[0]));
    let on_axis = |node: &u32| mesh.nodes[*node as usize][0].abs() <= AXIS * widest;
    (0..mesh.nodes.len() as u32).filter(on_axis).collect()
}

/// Equation of each unknown (or [`NONE`], for those in `without`; that of its partner for tied ones) and unknown of each equation.
pub fn number_equations(
    unknowns: &Unknowns,
    without: impl IntoIterator<Item = usize>,
    ties: &[Tied],
) -> (Vec<u32>, Vec<u32>) {
    let mut equations = vec![0; unknowns.states];
    without.into_iter().for_each(|unknown| equations[unknown] = NONE);
    ties.iter().for_each(|tied| equations[tied.unknown] = NONE);
    let mut free = Vec::new();
    for (unknown, equation) in equations.iter_mut().enumerate() {
        if *equation != NONE {
            *equation = free.len() as u32;
            free.push(unknown as u32);
        }
    }
    share_equations(ties, &mut equations);
    (equations, free)
}

impl System {
    /// Consistent values of all unknowns at the start: fields and fixed states as the model says, functionals evaluated, the other states
    /// from the equations without time derivatives.
    pub fn start(&mut self) -> Result<Vec<f64>, Error> {
        (self.factored, self.stable_pivots, self.forces, self.stabiliser) = (None, None, Vec::new(), 0);
        let time = self.settings.time.map_or(0.0, |(start, _)| start);
        self.g[self.program.layout.time] = time;
        let mut y = vec![0.0; self.unknowns.length];
        self.start_fields(&mut y);
        self.apply_holds(time, &mut y);
        let states = self.program.layout.states[0];
        for (k, state) in self.program.states.iter().enumerate() {
            self.g[states + k] = (state.value)(&self.g);
        }
        let rates = vec![0.0; y.len()];
        self.evaluate_functionals(&mut y, &rates);
        if let Some(solver) = &mut self.states {
            let fixed: Vec<bool> = self.program.states.iter().map(|s| s.start == Start::Fixed).collect();
            solver.start(&mut self.g, &fixed).map_err(|place| start_failed(time, place))?;
        }
        let count = self.program.states.len();
        y[self.unknowns.states..][..count].copy_from_slice(&self.g[states..states + count]);
        self.fix_levels(&y)?;
        Ok(y)
    }

    /// Writes the fields' start into y.
    pub(super) fn start_fields(&self, y: &mut [f64]) {
        for (field, numbers) in self.program.fields.iter().zip(&self.unknowns.fields) {
            let mut out = vec![0.0; field.components];
            for (k, &node) in numbers.nodes.iter().enumerate() {
                (field.start)(self.mesh.nodes[node as usize], &self.g, &mut out);
                y[numbers.first + k * field.components..][..field.components].copy_from_slice(&out);
            }
        }
    }

    /// Writes the prescribed values at `time` into y.
    pub(super) fn apply_holds(&mut self, time: f64, y: &mut [f64]) {
        self.g[self.program.layout.time] = time;
        for held in &self.held {
            let wanted = held.hold.map_or(0.0, |k| (self.program.holds[k].value)(held.x, &self.g));
            y[held.unknown] = self.ramp.as_ref().map_or(wanted, |ramp| ramp.held(held.unknown, wanted));
        }
    }
}

fn start_failed(time: f64, place: &str) -> SolveError {
    SolveError {
        cause: Cause::States(format!(
            "no consistent start: the equation at {place} cannot be met; give its states other start values"
        )),
        time,
        step: 0.0,
        iterations: 0,
        residual: f64::NAN,
        place: place.into(),
        terms: Vec::new(),
    }
}
