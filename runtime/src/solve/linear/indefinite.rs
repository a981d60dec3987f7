//! Factors of a symmetric matrix that is not positive definite: supernodal Bunch-Kaufman.
//!
//! It pivots only inside a supernode, so a matrix with zeros on its diagonal may defeat
//! it; the pivots tell, and the caller then turns to LU.

use super::error::LinearError;
use super::matrix::ScaledMatrix;
use super::storage::{Scratch, symbolic_matrix, zeros};
use super::sweep::{Factor, Row, Supernodes};
use crate::lane::BATCH;
use crate::solve::sparse::SparsePattern;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::{
    self, SupernodalIntranodeLbltRef, SymbolicSupernodalCholesky,
};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

/// Always supernodal: measured no slower than simplicial from a hundred equations upwards, and the
/// simplicial form has no pivoting. Any negative threshold has this effect, also for diagonal matrices.
const SUPERNODAL: SupernodalThreshold = SupernodalThreshold(-1.0);

/// Fewer columns than this are solved one by one.
const FEW: usize = 3;

/// What the pivots say about a factored matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivots {
    /// Number of negative eigenvalues.
    pub negative: usize,
    /// Smallest magnitude; not a number when the factorisation broke down.
    pub smallest: f64,
    /// Equation of the smallest pivot.
    pub equation: usize,
}

impl Pivots {
    const NONE: Self = Self { negative: 0, smallest: f64::INFINITY, equation: 0 };

    /// Accounts for one pivot; the first that is not a number stays.
    fn add(&mut self, equation: usize, magnitude: f64, negative: usize) {
        self.negative += negative;
        let smaller = magnitude < self.smallest || magnitude.is_nan();
        if smaller && !self.smallest.is_nan() {
            (self.smallest, self.equation) = (magnitude, equation);
        }
    }
}

/// Storage for the factors of indefinite matrices with one pattern.
pub struct IndefiniteFactor {
    symbolic: SymbolicCholesky<u32>,
    /// Pattern in elimination order.
    pattern: SymbolicSparseColMat<u32>,
    /// Position among the original entries of every entry.
    sources: Vec<u32>,
    entries: Vec<f64>,
    /// Original number of the equation to eliminate at each turn.
    order: Vec<u32>,
    nodes: Supernodes,
    /// Position of every pivot among the values of the factor.
    diagonal: Vec<usize>,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    /// Exchanges inside supernodes.
    forward: Vec<u32>,
    inverse: Vec<u32>,
    permuted: Vec<f64>,
    rows: Vec<Row>,
    scratch: Scratch,
}

impl IndefiniteFactor {
    /// Orders a symmetric pattern and allocates the factor.
    ///
    /// # Errors
    /// [`LinearError::NoEquations`], [`LinearError::TooLarge`].
    pub fn new(pattern: &SparsePattern) -> Result<Self, LinearError> {
        let symbolic = analyse(pattern)?;
        let size = symbolic.nrows();
        let order = match symbolic.perm() {
            Some(order) => order.arrays().0.to_vec(),
            None => (0..size as u32).collect(),
        };
        let (pattern, sources) = pattern.reordered(&order);
        let structure = supernodes(&symbolic);
        let nodes = gather(structure);
        let scratch = Scratch::new(&[
            supernodal::factorize_supernodal_numeric_intranode_lblt_scratch::<u32, f64>(
                structure,
                Par::Seq,
                Default::default(),
            ),
            structure.solve_in_place_scratch::<f64>(1, Par::Seq),
        ])?;
        Ok(Self {
            diagonal: nodes.diagonal(),
            nodes,
            rows: Vec::new(),
            values: zeros(symbolic.len_val())?,
            pattern: symbolic_matrix(&pattern),
            entries: vec![0.0; sources.len()],
            sources,
            order,
            subdiagonal: vec![0.0; size],
            forward: vec![0; size],
            inverse: vec![0; size],
            permuted: vec![0.0; size],
            scratch,
            symbolic,
        })
    }

    /// Bunch-Kaufman `L B L^T` with pivots of one and two rows.
    pub fn factor(&mut self, matrix: &ScaledMatrix) -> Pivots {
        for (entry, &source) in self.entries.iter_mut().zip(&self.sources) {
            *entry = matrix.values()[source as usize];
        }
        self.subdiagonal.fill(0.0);
        supernodal::factorize_supernodal_numeric_intranode_lblt(
            &mut self.values,
            &mut self.subdiagonal,
            &mut self.forward,
            &mut self.inverse,
            SparseColMatRef::new(self.pattern.as_ref(), &self.entries),
            supernodes(&self.symbolic),
            Par::Seq,
            self.scratch.stack(),
            Default::default(),
        );
        let pivots = self.block_pivots();
        Pivots { equation: self.order[pivots.equation] as usize, ..pivots }
    }

    /// Signs and sizes of the one- and two-row pivots, with equations in elimination order.
    fn block_pivots(&self) -> Pivots {
        let mut pivots = Pivots::NONE;
        let mut k = 0;
        while k < self.diagonal.len() {
            let (equation, first) = (self.forward[k] as usize, self.values[self.diagonal[k]]);
            let coupling = self.subdiagonal[k];
            if coupling == 0.0 || k + 1 == self.diagonal.len() {
                pivots.add(equation, first.abs(), usize::from(first < 0.0));
                k += 1;
            } else {
                let second = self.values[self.diagonal[k + 1]];
                let determinant = first * second - coupling * coupling;
                let largest = first.abs().max(second.abs()).max(coupling.abs());
                let negative = if determinant < 0.0 { 1 } else { 2 * usize::from(first < 0.0) };
                pivots.add(equation, determinant.abs() / largest, negative);
                k += 2;
            }
        }
        pivots
    }

    /// Solves in place for the columns of `x`, as many numbers each as there are equations.
    pub fn solve(&mut self, x: &mut [f64]) {
        for columns in x.chunks_mut(BATCH * self.diagonal.len()) {
            if columns.len() < FEW * self.diagonal.len() {
                columns.chunks_exact_mut(self.diagonal.len()).for_each(|column| self.solve_one(column));
            } else {
                self.solve_batch(columns);
            }
        }
    }

    /// Solves for one column.
    fn solve_one(&mut self, x: &mut [f64]) {
        let size = self.diagonal.len();
        let structure = supernodes(&self.symbolic);
        let pivoting = PermRef::new_checked(&self.forward, &self.inverse, size);
        let factor = SupernodalIntranodeLbltRef::new(structure, &self.values, &self.subdiagonal, pivoting);
        // into elimination order and that of the pivots in one go
        for (value, &turn) in self.permuted.iter_mut().zip(&self.forward) {
            *value = x[self.order[turn as usize] as usize];
        }
        let unknowns = MatMut::from_column_major_slice_mut(&mut self.permuted, size, 1);
        factor.solve_in_place_no_numeric_permute_with_conj(
            Conj::No,
            unknowns,
            Par::Seq,
            self.scratch.stack(),
        );
        for (value, &turn) in self.permuted.iter().zip(&self.forward) {
            x[self.order[turn as usize] as usize] = *value;
        }
    }

    /// Solves for at most eight columns in one sweep over the factor.
    fn solve_batch(&mut self, x: &mut [f64]) {
        let size = self.diagonal.len();
        self.rows.resize(size, [0.0; BATCH]);
        for (row, &equation) in self.rows.iter_mut().zip(&self.order) {
            let values = x[equation as usize..].iter().step_by(size);
            row.iter_mut().zip(values).for_each(|(number, value)| *number = *value);
        }
        let (nodes, values, order) = (&self.nodes, &self.values, &self.forward);
        let factor = Factor { nodes, values, order };
        factor.solve(&mut self.rows);
        solve_blocks(values, &self.diagonal, &self.subdiagonal, order, &mut self.rows);
        factor.solve_transposed(&mut self.rows);
        for (row, &equation) in self.rows.iter().zip(&self.order) {
            let values = x[equation as usize..].iter_mut().step_by(size);
            values.zip(row).for_each(|(value, number)| *value = *number);
        }
    }
}

/// Solves with the one- and two-row pivots of Bunch-Kaufman.
fn solve_blocks(values: &[f64], diagonal: &[usize], subdiagonal: &[f64], order: &[u32], x: &mut [Row]) {
    let mut k = 0;
    while k < diagonal.len() {
        let (first, coupling) = (values[diagonal[k]], subdiagonal[k]);
        let i = order[k] as usize;
        if coupling == 0.0 || k + 1 == diagonal.len() {
            x[i].iter_mut().for_each(|x| *x /= first);
            k += 1;
        } else {
            // divided by the coupling, which is not small beside the diagonal of a two-row pivot
            let (a, b) = (first / coupling, values[diagonal[k + 1]] / coupling);
            let scale = (coupling * (a * b - 1.0)).recip();
            let j = order[k + 1] as usize;
            let (mut upper, mut lower) = (x[i], x[j]);
            for (p, q) in upper.iter_mut().zip(&mut lower) {
                (*p, *q) = ((b * *p - *q) * scale, (a * *q - *p) * scale);
            }
            (x[i], x[j]) = (upper, lower);
            k += 2;
        }
    }
}

/// Approximate minimum degree order and the structure of the factor that goes with it.
fn analyse(pattern: &SparsePattern) -> Result<SymbolicCholesky<u32>, LinearError> {
    if pattern.size() == 0 {
        return Err(LinearError::NoEquations);
    }
    factorize_symbolic_cholesky(
        symbolic_matrix(pattern).as_ref(),
        Side::Lower,
        SymmetricOrdering::Amd,
        CholeskySymbolicParams { supernodal_flop_ratio_threshold: SUPERNODAL, ..Default::default() },
    )
    .map_err(|_| LinearError::TooLarge)
}

/// The structure of the factor.
fn supernodes(symbolic: &SymbolicCholesky<u32>) -> &SymbolicSupernodalCholesky<u32> {
    match symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(structure) => structure,
        SymbolicCholeskyRaw::Simplicial(_) => {
            unreachable!("{SUPERNODAL:?} never chooses the simplicial form")
        }
    }
}

/// The structure of the factor as [`super::sweep`] sees it.
fn gather(structure: &SymbolicSupernodalCholesky<u32>) -> Supernodes {
    Supernodes::new((0..structure.n_supernodes()).map(|s| {
        let first = structure.supernode_begin()[s] as usize;
        let width = structure.supernode_end()[s] as usize - first;
        (first, width, structure.supernode(s).pattern(), structure.col_ptr_for_val()[s] as usize)
    }))
}
