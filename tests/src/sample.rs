//! Random but valid data for the functions of a compiled model: globals, batches of elements.

use ansatz::generated::{Batch, Domain, Integral, Program, Row, Space};

/// Numbers that look random and are the same in every run (a linear congruential generator).
pub struct Random(u64);

impl Random {
    /// Starts a sequence.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// The next number in -1 .. 1.
    pub fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// The next number in `low .. high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.signed() + 1.0)
    }
}

/// Globals: parameters at their defaults, measures of some size, states inside their bounds, everything else random.
pub fn globals(program: &Program, random: &mut Random) -> Vec<f64> {
    let layout = program.layout;
    let mut g: Vec<f64> = (0..layout.length).map(|_| random.within(0.1, 1.0)).collect();
    for (k, parameter) in program.parameters.iter().enumerate() {
        g[layout.parameters[0] + k] = (parameter.default)(&g);
    }
    (program.constants)(&mut g);
    for (k, state) in program.states.iter().enumerate() {
        let (low, high) = (state.bounds)(&g);
        let inside = low.is_finite() && high.is_finite();
        let near = (state.value)(&g);
        g[layout.states[0] + k] = match inside {
            true => low + (high - low) * random.within(0.2, 0.8),
            false => near + random.within(0.05, 0.5),
        };
    }
    g
}

/// Eight elements with values of their unknowns.
pub struct Elements {
    /// Position of the region in the integral's domain.
    pub region: usize,
    /// See [`Batch::nodes`].
    pub nodes: Vec<Row>,
    /// See [`Batch::straight`].
    pub straight: bool,
    /// See [`Batch::values`].
    pub values: Vec<Row>,
    /// See [`Batch::rates`].
    pub rates: Vec<Row>,
    /// See [`Batch::alpha`].
    pub alpha: f64,
}

impl Elements {
    /// Curved elements of the size of one internal unit, away from the axis, with moderate strains.
    pub fn new(program: &Program, integral: &Integral, g: &[f64], random: &mut Random) -> Self {
        let cells = matches!(integral.domain, Domain::Cells(_));
        let regions = if let Domain::Cells(names) = integral.domain { names.len() } else { 1 };
        let corners: &[[f64; 2]] =
            if cells { &[[1.0, 0.0], [2.0, 0.2], [1.3, 1.1]] } else { &[[1.0, 0.0], [2.0, 0.3]] };
        let mut nodes: Vec<[Row; 2]> =
            corners.iter().map(|c| c.map(|x| Row::from_fn(|_| x + 0.1 * random.signed()))).collect();
        let edges: &[[usize; 2]] = if cells { &[[0, 1], [1, 2], [2, 0]] } else { &[[0, 1]] };
        for [a, b] in edges {
            let middle = |i: usize| Row::from_fn(|lane| 0.5 * (nodes[*a][i][lane] + nodes[*b][i][lane]));
            let bent = [middle(0), middle(1)].map(|row| Row(row.map(|x| x + 0.02 * random.signed())));
            nodes.push(bent);
        }
        let mut values = Vec::new();
        for used in integral.uses {
            let field = &program.fields[used.field];
            let carrying = match field.space {
                Space::P1 => corners.len(),
                Space::P2 => nodes.len(),
            };
            for node in &nodes[..carrying] {
                let mut start = vec![0.0; field.components];
                (field.start)([node[0][0], node[1][0]], g, &mut start);
                values.extend(
                    start.iter().map(|&x| Row::from_fn(|_| x + 0.05 * x.abs().max(1.0) * random.signed())),
                );
            }
        }
        let rates = values.iter().map(|_| Row::from_fn(|_| 0.3 * random.signed())).collect();
        let region = (random.within(0.0, regions as f64) as usize).min(regions - 1);
        Self {
            region,
            nodes: nodes.into_iter().flatten().collect(),
            straight: false,
            values,
            rates,
            alpha: random.within(0.5, 3.0),
        }
    }

    /// As a kernel sees them.
    pub fn batch(&self) -> Batch<'_> {
        Batch {
            region: self.region,
            nodes: &self.nodes,
            straight: self.straight,
            values: &self.values,
            rates: &self.rates,
            alpha: self.alpha,
        }
    }

    /// The same with straight edges, said to be `straight` or not.
    pub fn straightened(&self, straight: bool) -> Self {
        let mut nodes = self.nodes.clone();
        let corners = (nodes.len() / 2).div_ceil(2);
        for edge in 0..nodes.len() / 2 - corners {
            for axis in 0..2 {
                let [a, b] = [edge, (edge + 1) % corners].map(|corner| nodes[2 * corner + axis]);
                nodes[2 * (corners + edge) + axis] = Row::from_fn(|lane| 0.5 * (a[lane] + b[lane]));
            }
        }
        Self { nodes, straight, values: self.values.clone(), rates: self.rates.clone(), ..*self }
    }

    /// The same with one local unknown moved by `by` in every lane, and its rate with it.
    pub fn moved(&self, unknown: usize, by: f64) -> Self {
        let (mut values, mut rates) = (self.values.clone(), self.rates.clone());
        values[unknown].iter_mut().for_each(|x| *x += by);
        rates[unknown].iter_mut().for_each(|x| *x += self.alpha * by);
        Self { nodes: self.nodes.clone(), values, rates, ..*self }
    }
}
