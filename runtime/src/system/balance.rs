//! The balance of the fields: its residual, its tangent and the outer products of the functionals.

use super::System;
use super::contact::{Curvature, GlobalColumns, PairOn};
use super::newton::StageProblem;
use super::observables::ObservableOn;
use super::states::Stage as StateStage;
use super::terms::At;
use super::ties::Tied;
use super::unknowns::NONE;
use crate::error::Cause;
use crate::solve::border::Products;
use crate::solve::dense::squares;

/// The linearised balance at one point: residual, matrix values (kept in the system) and what functionals add to the matrix.
#[derive(Clone, Debug, Default)]
pub struct Balance {
    /// Residual per equation.
    pub residual: Vec<f64>,
    /// Sum of outer products of columns, one entry per equation.
    pub products: OuterProducts,
}

/// Columns one after another, one entry per equation.
#[derive(Clone, Debug)]
pub enum OuterProducts {
    /// sum_k w_k c_k c_k^T, where functionals act like springs between each other.
    Weighted {
        /// Columns c.
        columns: Vec<f64>,
        /// Weights w.
        weights: Vec<f64>,
    },
    /// sum_j b_j c_j^T with c_j = grad Z_j.
    General {
        /// Columns b.
        b: Vec<f64>,
        /// Columns c.
        c: Vec<f64>,
    },
}

impl Default for OuterProducts {
    fn default() -> Self {
        Self::Weighted { columns: Vec::new(), weights: Vec::new() }
    }
}

impl OuterProducts {
    /// `y -= (sum of outer products) x`.
    pub fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        let [left, right] = self.factors().map(|columns| columns.chunks(x.len().max(1)));
        for (k, (b, c)) in left.zip(right).enumerate() {
            let weight = if let Self::Weighted { weights, .. } = self { weights[k] } else { 1.0 };
            let along: f64 = c.iter().zip(x).map(|(c, x)| c * x).sum();
            add(y, -weight * along, b);
        }
    }

    /// The columns that are multiplied with each other, all of the left and all of the right factors.
    pub fn factors(&self) -> [&[f64]; 2] {
        match self {
            Self::Weighted { columns, .. } => [columns, columns],
            Self::General { b, c } => [b, c],
        }
    }

    /// As the solver takes them.
    pub fn columns(&self) -> Products<'_> {
        match self {
            Self::Weighted { columns, weights } => Products::Weighted { columns, weights },
            Self::General { b, c } => Products::General { b, c },
        }
    }
}

impl System {
    /// Evaluates the functionals at y and writes them into y and the globals.
    pub(super) fn evaluate_functionals(&mut self, y: &mut [f64], rates: &[f64]) {
        let first = self.program.layout.functionals[0];
        for (k, functional) in self.functionals.iter_mut().enumerate() {
            let at = At { y, rates, g: &self.g, alpha: 0.0 };
            let value = functional.value(&self.unknowns, at);
            y[self.unknowns.functionals + k] = value;
            self.g[first + k] = value;
        }
    }

    /// Brings everything scalar in line with the field unknowns in y: rates, functionals, states and their places in y and the globals.
    pub(super) fn settle(
        &mut self,
        problem: &StageProblem<'_>,
        y: &mut [f64],
        rates: &mut [f64],
    ) -> Result<(), Cause> {
        let layout = self.program.layout;
        self.g[layout.time] = problem.time;
        problem.rates(y, rates, 0..self.unknowns.states);
        self.follow(problem, y, rates);
        self.evaluate_functionals(y, rates);
        problem.rates(y, rates, self.unknowns.functionals..self.unknowns.length);
        for k in 0..self.functionals.len() {
            self.g[layout.functional_rates[0] + k] = rates[self.unknowns.functionals + k];
        }
        let states = self.unknowns.states..self.unknowns.functionals;
        self.g[layout.states[0]..layout.states[1]].copy_from_slice(&y[states.clone()]);
        if let Some(solver) = &mut self.states {
            let stage = StateStage { alpha: problem.alpha, base: &problem.base[states.clone()] };
            solver.solve(&mut self.g, stage).map_err(|place| Cause::States(place.into()))?;
        }
        y[states.clone()].copy_from_slice(&self.g[layout.states[0]..layout.states[1]]);
        problem.rates(y, rates, states);
        Ok(())
    }

    /// Gives tied unknowns the values, or rates, of their partners.
    fn follow(&self, problem: &StageProblem<'_>, y: &mut [f64], rates: &mut [f64]) {
        for &Tied { unknown, partner, rate } in &self.ties {
            y[unknown] = if rate { rates[partner] } else { y[partner] };
            problem.rates(y, rates, unknown..unknown + 1);
        }
    }

    /// Coefficient of each coupling at the present globals.
    fn coefficients(&self) -> Vec<f64> {
        self.program.couplings.as_ref().map_or(Vec::new(), |couplings| {
            let mut out = vec![0.0; couplings.terms.len()];
            (couplings.coefficients)(&self.g, &mut out);
            out
        })
    }

    /// Residual of all field unknowns (held ones included: there it is minus the reaction), of one physics block or of all.
    pub(super) fn unknown_residual(
        &mut self,
        at_y: &[f64],
        rates: &[f64],
        alpha: f64,
        block: Option<usize>,
    ) -> Vec<f64> {
        let mut residual = vec![0.0; self.unknowns.length];
        let wanted = |b: usize| block.is_none_or(|only| only == b);
        let coefficients = self.coefficients();
        let at = At { y: at_y, rates, g: &self.g, alpha };
        self.assembly.add_residual(at, wanted, &mut residual);
        for pair in self.pairs.iter_mut().filter(|pair| pair.acts()) {
            pair.update(&self.mesh, &self.unknowns, at_y);
            pair.add_residual(&self.unknowns, &self.g, &wanted, &mut residual);
        }
        if let Some(couplings) = &self.program.couplings {
            for (term, c) in couplings.terms.iter().zip(coefficients) {
                if wanted(term.block) {
                    let functional = &mut self.functionals[term.functional];
                    functional.evaluate_gradient(&self.unknowns, at);
                    add(&mut residual, c, &functional.gradient);
                }
            }
        }
        self.hand_on(&mut residual);
        if block.is_none() {
            self.take_ramp_away(&mut residual);
        }
        residual
    }

    /// Linearises the balance at a settled point; matrix values go to `self.values`.
    pub(super) fn linearise(
        &mut self,
        y: &[f64],
        rates: &[f64],
        alpha: f64,
        curvature: Curvature,
    ) -> Balance {
        let mut residual = vec![0.0; self.unknowns.length];
        let coefficients = self.coefficients();
        let at = At { y, rates, g: &self.g, alpha };
        self.assembly.linearise(at, &mut residual, &mut self.values);
        for pair in self.pairs.iter_mut().filter(|pair| pair.acts()) {
            pair.update(&self.mesh, &self.unknowns, y);
            let matrix = (&self.pattern, &self.equations[..]);
            pair.add_tangent(&self.unknowns, &self.g, matrix, curvature, &mut residual, &mut self.values);
        }
        for functional in &mut self.functionals {
            functional.evaluate_gradient(&self.unknowns, at);
        }
        if let Some(couplings) = &self.program.couplings {
            let mut unused = vec![0.0; residual.len()];
            for (term, c) in couplings.terms.iter().zip(&coefficients) {
                let functional = &mut self.functionals[term.functional];
                add(&mut residual, *c, &functional.gradient);
                functional.add_curvature(at, *c, &mut self.values, &mut unused);
            }
        }
        self.multiply_columns_of_rates(alpha);
        self.hand_on(&mut residual);
        self.take_ramp_away(&mut residual);
        let products = self.outer_products(y, rates, alpha);
        Balance { residual: self.restrict(&residual), products }
    }

    /// What functionals add to the matrix: sum_j b_j (grad Z_j)^T, of which b_j = sum_k M_kj grad Z_k + the tangent of integrals that read
    /// functionals or states.
    fn outer_products(&mut self, y: &[f64], rates: &[f64], alpha: f64) -> OuterProducts {
        let (count, states) = (self.functionals.len(), self.program.states.len());
        let mut of_states = vec![0.0; states * count];
        if let Some(solver) = &mut self.states {
            solver.sensitivity(&self.g, alpha, &mut of_states);
        }
        let mixing = self.mixing(alpha, &of_states);
        let of_pairs = self.pairs.iter().any(PairOn::reads_globals);
        let read_by_integrals =
            of_pairs || self.assembly.terms.iter().any(|term| term.integral.global_tangent.is_some());
        let plain = !read_by_integrals && self.ties.is_empty();
        let squares = if plain { squares(count, &mixing) } else { None };
        if let Some(squares) = squares {
            let columns = squares.iter().flat_map(|(_, square)| self.blend_of_gradients(square)).collect();
            return OuterProducts::Weighted { columns, weights: squares.iter().map(|(w, _)| *w).collect() };
        }
        let mut columns = vec![vec![0.0; self.unknowns.length]; count];
        self.add_global_tangents(y, rates, alpha, &of_states, &mut columns);
        columns.iter_mut().for_each(|column| self.hand_on(column));
        let integrals = columns.iter().flat_map(|column| self.restrict(column));
        let loads = mixing.chunks(count.max(1)).flat_map(|column| self.blend_of_gradients(column));
        let b = integrals.zip(loads).map(|(a, b)| a + b).collect();
        let c = self.functionals.iter().flat_map(|f| self.restrict_columns(&f.gradient, alpha)).collect();
        OuterProducts::General { b, c }
    }

    /// M_kj, column after column: how the load on functional k changes with functional j.
    fn mixing(&self, alpha: f64, of_states: &[f64]) -> Vec<f64> {
        let (count, states) = (self.functionals.len(), self.program.states.len());
        let mut mixing = vec![0.0; count * count];
        let Some(couplings) = &self.program.couplings else { return mixing };
        let width = states + count;
        let mut derivatives = vec![0.0; couplings.terms.len() * width];
        (couplings.derivatives)(&self.g, alpha, &mut derivatives);
        for (term, row) in couplings.terms.iter().zip(derivatives.chunks(width)) {
            for j in 0..count {
                let through_states: f64 = (0..states).map(|s| row[s] * of_states[s * count + j]).sum();
                mixing[j * count + term.functional] += row[states + j] + through_states;
            }
        }
        mixing
    }

    /// sum_k factor_k grad Z_k, one entry per equation.
    fn blend_of_gradients(&self, factors: &[f64]) -> Vec<f64> {
        let mut blend = vec![0.0; self.unknowns.length];
        for (functional, factor) in self.functionals.iter().zip(factors) {
            add(&mut blend, *factor, &functional.gradient);
        }
        self.hand_on(&mut blend);
        self.restrict(&blend)
    }

    /// Integrals and loads on pairs that read states or functionals: their share of the columns b_j.
    fn add_global_tangents(
        &mut self,
        y: &[f64],
        rates: &[f64],
        alpha: f64,
        of_states: &[f64],
        columns: &mut [Vec<f64>],
    ) {
        let (states, count) = (self.program.states.len(), columns.len());
        let at = At { y, rates, g: &self.g, alpha };
        let of_pairs =
            self.pairs.iter().flat_map(|pair| pair.global_tangents(&self.unknowns, &self.g, alpha));
        let mut all: Vec<GlobalColumns> = of_pairs.collect();
        for term in &mut self.assembly.terms {
            let Some(tangent) = &term.integral.global_tangent else { continue };
            let mut by_slot = vec![vec![0.0; y.len()]; tangent.slots.len()];
            term.add_global_tangent(at, tangent, &mut by_slot);
            all.push((tangent.slots, by_slot));
        }
        for (slots, by_slot) in &all {
            for (slot, by) in slots.iter().zip(by_slot) {
                for (j, column) in columns.iter_mut().enumerate() {
                    let factor = match slot.checked_sub(states) {
                        Some(functional) => f64::from(u8::from(functional == j)),
                        None => of_states[slot * count + j],
                    };
                    add(column, factor, by);
                }
            }
        }
    }

    /// Adds what acts on tied unknowns to what acts on their partners.
    pub(super) fn hand_on(&self, residual: &mut [f64]) {
        for tied in &self.ties {
            residual[tied.partner] += std::mem::take(&mut residual[tied.unknown]);
        }
    }

    /// Entries of a vector over unknowns that have an equation, in the equations' order.
    pub(super) fn restrict(&self, full: &[f64]) -> Vec<f64> {
        self.free.iter().map(|&u| full[u as usize]).collect()
    }

    /// Entries of a derivative by unknowns, likewise; tied unknowns count for their partners, `alpha` times where they are rates.
    fn restrict_columns(&self, full: &[f64], alpha: f64) -> Vec<f64> {
        let mut columns = full.to_vec();
        for tied in &self.ties {
            columns[tied.partner] += columns[tied.unknown] * if tied.rate { alpha } else { 1.0 };
        }
        self.restrict(&columns)
    }

    /// Adds the second matrix, of the columns of rates, to the first.
    fn multiply_columns_of_rates(&mut self, alpha: f64) {
        let (first, second) = self.values.split_at_mut(self.pattern.entries() + 1);
        first.iter_mut().zip(second).for_each(|(value, of_rate)| *value += alpha * *of_rate);
    }

    /// Name of an equation's unknown and its place, such as `u.z at (1.53, 0.02)`.
    pub(super) fn name_equation(&self, equation: usize) -> String {
        let unknown = self.free.get(equation).copied().unwrap_or(NONE) as usize;
        let (field, component, node) = self.unknowns.describe(unknown);
        let x = self.mesh.nodes[node];
        let field = &self.program.fields[field];
        let named = field.component_names.get(component).filter(|name| !name.is_empty());
        let suffix = named.map_or(String::new(), |name| format!(".{name}"));
        format!("{}{suffix} at ({:.4}, {:.4}) {}", field.name, x[0], x[1], self.program.base_units[0])
    }

    /// All globals, observables included, at given unknowns and rates.
    pub fn observe(&mut self, time: f64, y: &[f64], rates: &[f64]) -> Vec<f64> {
        let layout = self.program.layout;
        let (states, functionals) = (self.unknowns.states, self.unknowns.functionals);
        self.g[layout.time] = time;
        self.g[layout.states[0]..layout.states[1]].copy_from_slice(&y[states..functionals]);
        self.g[layout.state_rates[0]..layout.state_rates[1]].copy_from_slice(&rates[states..functionals]);
        self.g[layout.functionals[0]..layout.functionals[1]].copy_from_slice(&y[functionals..]);
        self.g[layout.functional_rates[0]..layout.functional_rates[1]].copy_from_slice(&rates[functionals..]);
        for pair in &mut self.pairs {
            pair.update(&self.mesh, &self.unknowns, y);
        }
        let mut observables = std::mem::take(&mut self.observables);
        for (k, observable) in observables.iter_mut().enumerate() {
            let value = self.evaluate_observable(observable, y, rates);
            self.g[layout.observables[0] + k] = value;
        }
        self.observables = observables;
        self.g.clone()
    }

    fn evaluate_observable(&mut self, observable: &mut ObservableOn, y: &[f64], rates: &[f64]) -> f64 {
        match observable {
            ObservableOn::Value(value) => {
                let at = At { y, rates, g: &self.g, alpha: 0.0 };
                value.evaluate(&self.unknowns, &self.pairs, at)
            }
            ObservableOn::Force { block, unknowns } => {
                let residual = self.unknown_residual(y, rates, 0.0, Some(*block));
                -unknowns.iter().map(|&u| residual[u]).sum::<f64>()
            }
        }
    }
}

/// `sum += factor * vector`, skipping a zero factor.
fn add(sum: &mut [f64], factor: f64, vector: &[f64]) {
    if factor != 0.0 {
        sum.iter_mut().zip(vector).for_each(|(s, v)| *s += factor * v);
    }
}

/// Euclidean norm.
pub fn norm(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}
