//! Triangular solves with supernodal factors, ones on their diagonal, for eight right-hand sides at a time.
//!
//! The numbers of one equation lie side by side in a row, so that every entry of the factor, which
//! is read from memory once, is multiplied with a whole row.

use crate::lane::{BATCH, Lane, Simd};

/// Columns of a supernode that are treated together.
const PANEL: usize = 4;

/// One number for each of eight right-hand sides.
pub type Row = [f64; BATCH];

/// Structure of a supernodal factor.
///
/// Every supernode is a block of consecutive columns with the same rows below the block, stored
/// densely, column after column, the square block above the rows.
#[derive(Debug)]
pub struct Supernodes {
    nodes: Vec<Supernode>,
    rows: Vec<u32>,
}

/// Where one supernode lies.
#[derive(Clone, Copy, Debug)]
struct Supernode {
    first: usize,
    width: usize,
    rows: (usize, usize),
    values: usize,
}

/// A triangular factor `L` with the structure of some supernodes; its diagonal is one, whatever is stored there.
#[derive(Clone, Copy)]
pub struct Factor<'a> {
    /// Structure.
    pub nodes: &'a Supernodes,
    /// Entries.
    pub values: &'a [f64],
    /// Equation of every column: pivoting may exchange those of one supernode.
    pub order: &'a [u32],
}

impl Supernodes {
    /// Gathers supernodes given as (first column, number of columns, rows below, start of values).
    pub fn new<'a>(nodes: impl Iterator<Item = (usize, usize, &'a [u32], usize)>) -> Self {
        let mut rows = Vec::new();
        let nodes = nodes
            .map(|(first, width, below, values)| {
                let begin = rows.len();
                rows.extend_from_slice(below);
                Supernode { first, width, rows: (begin, rows.len()), values }
            })
            .collect();
        Self { nodes, rows }
    }

    /// Position of the diagonal entry of every column among the values of the factor.
    pub fn diagonal(&self) -> Vec<usize> {
        let positions = |node: &Supernode| {
            let (begin, height) = (node.values, node.height());
            (0..node.width).map(move |column| begin + column * (height + 1))
        };
        self.nodes.iter().flat_map(positions).collect()
    }
}

impl Factor<'_> {
    /// Solves `L y = x` in place for eight right-hand sides.
    pub fn solve(&self, x: &mut [Row]) {
        let factor = self;
        crate::vectorize!(lower_lanes(factor: &Factor<'_>, x: &mut [Row]));
    }

    /// Solves `L^T y = x` in place for eight right-hand sides.
    pub fn solve_transposed(&self, x: &mut [Row]) {
        let factor = self;
        crate::vectorize!(transposed_lanes(factor: &Factor<'_>, x: &mut [Row]));
    }
}

impl Supernode {
    /// Number of rows of the dense block.
    fn height(&self) -> usize {
        self.width + self.rows.1 - self.rows.0
    }
}

/// A few columns of a supernode with the equations that their rows stand for.
struct Panel<'a, const WIDTH: usize> {
    /// Entries from the first diagonal entry of the panel downwards.
    columns: [&'a [f64]; WIDTH],
    /// Equations of the panel and of the columns after it in the supernode.
    own: &'a [u32],
    below: &'a [u32],
}

#[inline(always)]
fn lower_lanes<S: Simd>(s: S, o: usize, factor: &Factor<'_>, x: &mut [Row]) {
    for node in &factor.nodes.nodes {
        let full = node.width - node.width % PANEL;
        for column in (0..full).step_by(PANEL) {
            Panel::<PANEL>::new(factor, node, column).lower(s, o, x);
        }
        for column in full..node.width {
            Panel::<1>::new(factor, node, column).lower(s, o, x);
        }
    }
}

#[inline(always)]
fn transposed_lanes<S: Simd>(s: S, o: usize, factor: &Factor<'_>, x: &mut [Row]) {
    for node in factor.nodes.nodes.iter().rev() {
        let full = node.width - node.width % PANEL;
        for column in (full..node.width).rev() {
            Panel::<1>::new(factor, node, column).transposed(s, o, x);
        }
        for column in (0..full).step_by(PANEL).rev() {
            Panel::<PANEL>::new(factor, node, column).transposed(s, o, x);
        }
    }
}

impl<'a, const WIDTH: usize> Panel<'a, WIDTH> {
    #[inline(always)]
    fn new(factor: &Factor<'a>, node: &Supernode, column: usize) -> Self {
        let height = node.height();
        let begin = node.values + column * height;
        Self {
            columns: std::array::from_fn(|k| {
                &factor.values[begin + k * height + column..begin + (k + 1) * height]
            }),
            own: &factor.order[node.first + column..node.first + node.width],
            below: &factor.nodes.rows[node.rows.0..node.rows.1],
        }
    }

    /// Offset in the columns and equation of every row under the panel's triangle.
    #[inline(always)]
    fn rows(&self) -> impl Iterator<Item = (usize, usize)> {
        let equations = self.own[WIDTH..].iter().chain(self.below);
        (WIDTH..).zip(equations.map(|&equation| equation as usize))
    }

    /// Numbers of the panel's own equations.
    #[inline(always)]
    fn load<S: Simd>(&self, s: S, o: usize, x: &[Row]) -> [Lane<S>; WIDTH] {
        std::array::from_fn(|k| Lane::load(s, &x[self.own[k] as usize], o))
    }

    /// Solves with the triangle of the panel and takes the solution out of the rows below.
    #[inline(always)]
    fn lower<S: Simd>(&self, s: S, o: usize, x: &mut [Row]) {
        let mut y = self.load(s, o, x);
        for k in 0..WIDTH {
            for p in 0..k {
                y[k] = Lane::splat(s, -self.columns[p][k]).mul_add(y[p], y[k]);
            }
            y[k].store(&mut x[self.own[k] as usize], o);
        }
        for (offset, equation) in self.rows() {
            let mut value = Lane::load(s, &x[equation], o);
            for (column, y) in self.columns.iter().zip(y) {
                value = Lane::splat(s, -column[offset]).mul_add(y, value);
            }
            value.store(&mut x[equation], o);
        }
    }

    /// Takes the solution of the rows below out of the panel and solves with its triangle.
    #[inline(always)]
    fn transposed<S: Simd>(&self, s: S, o: usize, x: &mut [Row]) {
        let mut y = self.load(s, o, x);
        for (offset, equation) in self.rows() {
            let value = Lane::load(s, &x[equation], o);
            for (column, y) in self.columns.iter().zip(&mut y) {
                *y = Lane::splat(s, -column[offset]).mul_add(value, *y);
            }
        }
        for k in (0..WIDTH).rev() {
            for p in k + 1..WIDTH {
                y[k] = Lane::splat(s, -self.columns[k][p]).mul_add(y[p], y[k]);
            }
            y[k].store(&mut x[self.own[k] as usize], o);
        }
    }
}
