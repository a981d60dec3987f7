//! The pattern of a sparse matrix as callers hand it over, and the graph that orderings work on.

/// Whether a matrix equals its transpose, which decides what is stored and how it is factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Positive definite, only the lower triangle stored: Cholesky.
    Symmetric,
    /// All entries stored; the pattern is that of a symmetric matrix or nearly so: LU.
    Unsymmetric,
}

/// Positions of the entries of a square matrix in compressed columns, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Pattern<'a> {
    /// What is stored.
    pub kind: Kind,
    /// Start of every column in `rows`; one more than there are columns.
    pub starts: &'a [u32],
    /// Row of every entry.
    pub rows: &'a [u32],
}

impl Pattern<'_> {
    /// Number of equations.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Range of the entries of a column.
    pub fn column(&self, column: usize) -> std::ops::Range<usize> {
        self.starts[column] as usize..self.starts[column + 1] as usize
    }

    /// Calls `visit(position, row, column)` for every entry, column by column.
    pub fn for_each(&self, mut visit: impl FnMut(usize, usize, usize)) {
        for column in 0..self.size() {
            let range = self.column(column);
            for (position, &row) in range.clone().zip(&self.rows[range]) {
                visit(position, row as usize, column);
            }
        }
    }

    /// Subtracts the product: `y -= A x`, with `values` the entries of `A`.
    pub fn subtract_product(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        for (column, &factor) in x.iter().enumerate() {
            let range = self.column(column);
            let entries = self.rows[range.clone()].iter().zip(&values[range]);
            match self.kind {
                Kind::Unsymmetric => entries.for_each(|(&row, a)| y[row as usize] -= a * factor),
                Kind::Symmetric => {
                    let mut dot = 0.0;
                    for (&row, a) in entries {
                        if row as usize == column {
                            dot += a * factor;
                        } else {
                            y[row as usize] -= a * factor;
                            dot += a * x[row as usize];
                        }
                    }
                    y[column] -= dot;
                }
            }
        }
    }
}

/// Undirected graph without loops: the neighbours of every node, ascending.
#[derive(Clone, Debug)]
pub(crate) struct Graph {
    pub starts: Vec<u32>,
    pub neighbours: Vec<u32>,
}

impl Graph {
    /// The equations that share an entry above or below the diagonal.
    pub fn of(pattern: Pattern<'_>) -> Self {
        let lists = Self { starts: pattern.starts.to_vec(), neighbours: pattern.rows.to_vec() };
        let by_row = lists.transposed();
        if by_row.neighbours == lists.neighbours && by_row.starts == lists.starts {
            return by_row.without_loops();
        }
        // Ascending, as the pattern itself need not be.
        let by_column = by_row.transposed();
        by_row.united(&by_column)
    }

    /// The edges between different nodes.
    fn without_loops(mut self) -> Self {
        let (mut begin, mut kept) = (0, 0);
        for node in 0..self.size() {
            let end = self.starts[node + 1] as usize;
            for k in begin..end {
                let neighbour = self.neighbours[k];
                if neighbour as usize != node {
                    self.neighbours[kept] = neighbour;
                    kept += 1;
                }
            }
            begin = end;
            self.starts[node + 1] = kept as u32;
        }
        self.neighbours.truncate(kept);
        self
    }

    /// The same edges in the other direction, ascending.
    fn transposed(&self) -> Self {
        let mut starts = vec![0_u32; self.size() + 1];
        self.neighbours.iter().for_each(|&end| starts[end as usize + 1] += 1);
        (0..self.size()).for_each(|k| starts[k + 1] += starts[k]);
        let mut next = starts.clone();
        let mut neighbours = vec![0; self.neighbours.len()];
        for node in 0..self.size() {
            for &end in self.around(node) {
                let place = &mut next[end as usize];
                neighbours[*place as usize] = node as u32;
                *place += 1;
            }
        }
        Self { starts, neighbours }
    }

    /// The edges of two graphs, each once and without loops; lists ascend.
    fn united(&self, other: &Self) -> Self {
        let mut starts = Vec::with_capacity(self.starts.len());
        let mut neighbours = Vec::with_capacity(self.neighbours.len());
        starts.push(0);
        for node in 0..self.size() {
            let (mut a, mut b) = (self.around(node), other.around(node));
            let begin = neighbours.len();
            while let Some(&next) = [a.first(), b.first()].into_iter().flatten().min() {
                a = a.strip_prefix(&[next]).unwrap_or(a);
                b = b.strip_prefix(&[next]).unwrap_or(b);
                if next as usize != node && neighbours[begin..].last() != Some(&next) {
                    neighbours.push(next);
                }
            }
            starts.push(neighbours.len() as u32);
        }
        Self { starts, neighbours }
    }

    /// Number of nodes.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Neighbours of a node, ascending.
    pub fn around(&self, node: usize) -> &[u32] {
        &self.neighbours[self.starts[node] as usize..self.starts[node + 1] as usize]
    }
}

/// The inverse of a permutation.
pub(crate) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old as usize] = new as u32;
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_graph_is_the_same_whichever_triangles_are_stored_and_in_whatever_order() {
        let graph = |kind, starts: &[u32], rows: &[u32]| {
            let Graph { starts, neighbours } = Graph::of(Pattern { kind, starts, rows });
            (starts, neighbours)
        };
        let expected = (vec![0, 1, 3, 4, 4], vec![1, 0, 2, 1]);
        let both = graph(Kind::Unsymmetric, &[0, 2, 5, 7, 8], &[0, 1, 0, 1, 2, 1, 2, 3]);
        let unordered = graph(Kind::Unsymmetric, &[0, 2, 5, 7, 8], &[1, 0, 2, 0, 1, 2, 1, 3]);
        let lower = graph(Kind::Symmetric, &[0, 2, 4, 5, 6], &[0, 1, 1, 2, 2, 3]);
        assert_eq!([both, unordered, lower], [(); 3].map(|()| expected.clone()));
    }
}
