//! The sparsity pattern of an assembled matrix: which entries exist and where their values lie.
//!
//! Assembly asks the pattern once for the position of every element entry and afterwards only adds
//! to a plain slice of values; [`super::linear`] factors such a slice. The pattern holds free
//! equations only: whoever numbers the unknowns leaves the constrained ones out.

use ansatz_frontal::{Kind, Pattern};

/// Whether a matrix equals its transpose, which decides what is stored and how it is factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixKind {
    /// Equal to its transpose; only the lower triangle is stored.
    Symmetric,
    /// Symmetric pattern, unsymmetric values; every entry is stored.
    Unsymmetric,
}

/// Positions of the entries of a square sparse matrix in compressed columns.
///
/// Rows ascend within a column and every diagonal entry is present.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SparsePattern {
    kind: MatrixKind,
    column_starts: Vec<u32>,
    rows: Vec<u32>,
}

impl SparsePattern {
    /// Builds the pattern of `size` equations in which all equations of one element are coupled.
    ///
    /// Each item of `elements` lists the free equations of one element; repetitions do no harm.
    /// The result does not depend on the order of the elements.
    ///
    /// # Panics
    /// When an element names an equation that is not below `size`.
    pub fn from_elements<'a>(
        size: usize,
        kind: MatrixKind,
        elements: impl IntoIterator<Item = &'a [u32]>,
    ) -> Self {
        let elements = Incidence::new(size, elements);
        let mut starts = Vec::with_capacity(size + 1);
        let mut columns = Vec::new();
        let mut last_row_of_column = vec![u32::MAX; size];
        starts.push(0);
        for row in 0..size as u32 {
            columns.push(row);
            last_row_of_column[row as usize] = row;
            for &column in elements.around(row).flatten() {
                let stored = kind == MatrixKind::Unsymmetric || row > column;
                if stored && last_row_of_column[column as usize] != row {
                    last_row_of_column[column as usize] = row;
                    columns.push(column);
                }
            }
            starts.push(columns.len() as u32);
        }
        Self::from_rows(kind, &starts, &columns)
    }

    /// The pattern with the columns of each row, in any order: taken row after row, entries come to their columns in ascending order.
    fn from_rows(kind: MatrixKind, starts: &[u32], columns: &[u32]) -> Self {
        let size = starts.len() - 1;
        let mut column_starts = vec![0; size + 1];
        columns.iter().for_each(|&column| column_starts[column as usize + 1] += 1);
        (0..size).for_each(|k| column_starts[k + 1] += column_starts[k]);
        let (mut next, mut rows) = (column_starts.clone(), vec![0; columns.len()]);
        for (row, range) in starts.windows(2).enumerate() {
            for &column in &columns[range[0] as usize..range[1] as usize] {
                let place = &mut next[column as usize];
                rows[*place as usize] = row as u32;
                *place += 1;
            }
        }
        Self { kind, column_starts, rows }
    }

    /// Number of equations.
    pub fn size(&self) -> usize {
        self.column_starts.len() - 1
    }

    /// Number of stored entries: the length of a slice of values.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// Symmetric or not.
    pub fn kind(&self) -> MatrixKind {
        self.kind
    }

    /// Start of every column in [`Self::rows`] and in the values; `size + 1` numbers.
    pub fn column_starts(&self) -> &[u32] {
        &self.column_starts
    }

    /// Row of every stored entry.
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Range of the entries of `column` in the rows and in the values.
    pub fn column(&self, column: usize) -> std::ops::Range<usize> {
        self.column_starts[column] as usize..self.column_starts[column + 1] as usize
    }

    /// Index of the entry (`row`, `column`) in the values, or `None` when the matrix has none there.
    ///
    /// A symmetric matrix answers with the same index for both triangles.
    pub fn position(&self, row: u32, column: u32) -> Option<usize> {
        let (row, column) = match self.kind {
            MatrixKind::Symmetric => (row.max(column), row.min(column)),
            MatrixKind::Unsymmetric => (row, column),
        };
        let range = self.column(column as usize);
        self.rows[range.clone()].binary_search(&row).ok().map(|k| range.start + k)
    }

    /// Positions of a dense block of entries among the values: that of (`equations[i]`, `equations[j]`) goes to `block[i * n + j]`, as [`Self::position`]
    /// would tell, and [`Self::entries`] where one of the two is no equation. The pattern must couple all equations of the block.
    ///
    /// `places` is scratch, one number per row.
    pub(crate) fn block_positions(&self, equations: &[Option<u32>], places: &mut [u32], block: &mut [u32]) {
        let n = equations.len();
        block.fill(self.entries() as u32);
        for (j, column) in equations.iter().enumerate().filter_map(|(j, e)| Some((j, (*e)?))) {
            for position in self.column(column as usize) {
                places[self.rows[position] as usize] = position as u32;
            }
            for (i, row) in equations.iter().enumerate().filter_map(|(i, e)| Some((i, (*e)?))) {
                if self.kind == MatrixKind::Unsymmetric {
                    block[i * n + j] = places[row as usize];
                } else if row >= column {
                    let position = places[row as usize];
                    (block[i * n + j], block[j * n + i]) = (position, position);
                }
            }
        }
    }

    /// The pattern as the factorisation sees it.
    pub(super) fn view(&self) -> Pattern<'_> {
        let kind = match self.kind {
            MatrixKind::Symmetric => Kind::Symmetric,
            MatrixKind::Unsymmetric => Kind::Unsymmetric,
        };
        Pattern { kind, starts: &self.column_starts, rows: &self.rows }
    }

    /// Calls `visit(position, row, column)` for every stored entry, column by column.
    pub fn for_each(&self, visit: impl FnMut(usize, usize, usize)) {
        self.view().for_each(visit);
    }

    /// The pattern with its equations renumbered: new equation `k` is old equation `order[k]`.
    ///
    /// Also returns the position among the old entries of every new entry.
    pub fn reordered(&self, order: &[u32]) -> (Self, Vec<u32>) {
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let mut entries = Vec::with_capacity(self.entries());
        self.for_each(|position, row, column| {
            let (row, column) = (place[row], place[column]);
            entries.push(match self.kind {
                MatrixKind::Symmetric => (row.max(column), row.min(column), position as u32),
                MatrixKind::Unsymmetric => (row, column, position as u32),
            });
        });
        Self::from_entries(self.kind, self.size(), &entries)
    }

    /// Both triangles of the pattern, as if it were unsymmetric.
    ///
    /// Also returns the position among the stored entries of every entry.
    pub fn expanded(&self) -> (Self, Vec<u32>) {
        if self.kind == MatrixKind::Unsymmetric {
            return (self.clone(), (0..self.entries() as u32).collect());
        }
        let mut entries = Vec::with_capacity(2 * self.entries());
        self.for_each(|position, row, column| {
            entries.push((row as u32, column as u32, position as u32));
            if row != column {
                entries.push((column as u32, row as u32, position as u32));
            }
        });
        Self::from_entries(MatrixKind::Unsymmetric, self.size(), &entries)
    }

    /// Sorts distinct entries (row, column, source) into compressed columns with their sources.
    fn from_entries(kind: MatrixKind, size: usize, entries: &[(u32, u32, u32)]) -> (Self, Vec<u32>) {
        let (_, by_row) = counting_sort(size, entries, |entry| entry.0);
        let (column_starts, by_column) = counting_sort(size, &by_row, |entry| entry.1);
        let rows = by_column.iter().map(|entry| entry.0).collect();
        let sources = by_column.iter().map(|entry| entry.2).collect();
        (Self { kind, column_starts, rows }, sources)
    }

    /// Subtracts the product: `y -= A x`, with `values` the entries of `A`.
    pub fn subtract_product(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        self.view().subtract_product(values, x, y);
    }
}

/// Stable sort by a key below `size`; also returns where every key starts.
fn counting_sort<T: Copy>(size: usize, items: &[T], key: impl Fn(&T) -> u32) -> (Vec<u32>, Vec<T>) {
    let mut starts = vec![0; size + 1];
    for item in items {
        starts[key(item) as usize + 1] += 1;
    }
    for k in 0..size {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut sorted = items.to_vec();
    for item in items {
        let place = &mut next[key(item) as usize];
        sorted[*place as usize] = *item;
        *place += 1;
    }
    (starts, sorted)
}

/// The elements around each equation, in compressed form.
struct Incidence {
    element_starts: Vec<usize>,
    equations: Vec<u32>,
    around_starts: Vec<u32>,
    around: Vec<(u32, u32)>,
}

impl Incidence {
    fn new<'a>(size: usize, elements: impl IntoIterator<Item = &'a [u32]>) -> Self {
        let (mut element_starts, mut equations, mut uses) = (vec![0], Vec::new(), Vec::new());
        for (number, element) in elements.into_iter().enumerate() {
            equations.extend_from_slice(element);
            element_starts.push(equations.len());
            uses.extend(element.iter().map(|&equation| (equation, number as u32)));
        }
        let (around_starts, around) = counting_sort(size, &uses, |use_| use_.0);
        Self { element_starts, equations, around_starts, around }
    }

    /// Equations of each element that holds `equation`.
    fn around(&self, equation: u32) -> impl Iterator<Item = &[u32]> {
        let equation = equation as usize;
        let range = self.around_starts[equation] as usize..self.around_starts[equation + 1] as usize;
        self.around[range].iter().map(|&(_, element)| {
            let element = element as usize;
            &self.equations[self.element_starts[element]..self.element_starts[element + 1]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELEMENTS: [&[u32]; 2] = [&[2, 0], &[3, 2, 2]];

    #[test]
    fn symmetric_pattern_stores_the_lower_triangle_and_every_diagonal() {
        let pattern = SparsePattern::from_elements(4, MatrixKind::Symmetric, ELEMENTS);
        assert_eq!(pattern.column_starts(), [0, 2, 3, 5, 6]);
        assert_eq!(pattern.rows(), [0, 2, 1, 2, 3, 3]);
        assert_eq!(pattern.position(0, 2), Some(1));
        assert_eq!(pattern.position(2, 0), Some(1));
        assert_eq!(pattern.position(3, 0), None);
    }

    #[test]
    fn unsymmetric_pattern_stores_both_triangles() {
        let pattern = SparsePattern::from_elements(4, MatrixKind::Unsymmetric, ELEMENTS);
        assert_eq!(pattern.rows(), [0, 2, 1, 0, 2, 3, 2, 3]);
        assert_ne!(pattern.position(0, 2), pattern.position(2, 0));
    }

    #[test]
    fn positions_of_a_block_are_those_of_its_entries() {
        let equations = [Some(3), None, Some(2)];
        for kind in [MatrixKind::Symmetric, MatrixKind::Unsymmetric] {
            let pattern = SparsePattern::from_elements(4, kind, ELEMENTS);
            let mut block = [0; 9];
            pattern.block_positions(&equations, &mut [0; 4], &mut block);
            for (k, &place) in block.iter().enumerate() {
                let entry = equations[k / 3].zip(equations[k % 3]);
                let position = entry.and_then(|(row, column)| pattern.position(row, column));
                assert_eq!(place as usize, position.unwrap_or(pattern.entries()), "{kind:?}, {k}");
            }
        }
    }

    #[test]
    fn pattern_does_not_depend_on_the_order_of_elements() {
        let forward = SparsePattern::from_elements(4, MatrixKind::Symmetric, ELEMENTS);
        let backward = SparsePattern::from_elements(4, MatrixKind::Symmetric, ELEMENTS.into_iter().rev());
        assert_eq!(forward, backward);
    }

    #[test]
    fn both_kinds_multiply_alike() {
        let x = [1.0, -2.0, 3.0, 5.0];
        let products = [MatrixKind::Symmetric, MatrixKind::Unsymmetric].map(|kind| {
            let pattern = SparsePattern::from_elements(4, kind, ELEMENTS);
            let mut values = vec![0.0; pattern.entries()];
            pattern.for_each(|position, row, column| {
                values[position] = (1 + row + column + row * column) as f64
            });
            let mut y = [0.0; 4];
            pattern.subtract_product(&values, &x, &mut y);
            y
        });
        assert_eq!(products[0], [-10.0, 8.0, -90.0, -116.0]);
        assert_eq!(products[0], products[1]);
    }
}
