//! Working memory and matrices in the library's terms.

use super::error::LinearError;
use crate::solve::sparse::SparsePattern;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::SymbolicSparseColMat;

/// Working memory that only grows.
pub struct Scratch {
    memory: MemBuffer,
    request: StackReq,
}

impl Scratch {
    /// Memory for the largest of several requests.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`].
    pub fn new(requests: &[StackReq]) -> Result<Self, LinearError> {
        let request = StackReq::any_of(requests);
        let memory = MemBuffer::try_new(request).map_err(|_| LinearError::TooLarge)?;
        Ok(Self { memory, request })
    }

    /// The memory, enlarged if `request` needs more than any before.
    ///
    /// # Errors
    /// [`LinearError::TooLarge`].
    pub fn stack_for(&mut self, request: StackReq) -> Result<&mut MemStack, LinearError> {
        let either = self.request.or(request);
        if either != self.request {
            *self = Self::new(&[either])?;
        }
        Ok(self.stack())
    }

    /// The memory.
    pub fn stack(&mut self) -> &mut MemStack {
        MemStack::new(&mut self.memory)
    }
}

/// A pattern in the library's terms.
pub fn symbolic_matrix(pattern: &SparsePattern) -> SymbolicSparseColMat<u32> {
    let size = pattern.size();
    let (column_starts, rows) = (pattern.column_starts().to_vec(), pattern.rows().to_vec());
    SymbolicSparseColMat::new_checked(size, size, column_starts, None, rows)
}

/// Zeros, or an error instead of an abort when memory does not suffice.
///
/// # Errors
/// [`LinearError::TooLarge`].
pub fn zeros(length: usize) -> Result<Vec<f64>, LinearError> {
    let mut values = Vec::new();
    values.try_reserve_exact(length).map_err(|_| LinearError::TooLarge)?;
    values.resize(length, 0.0);
    Ok(values)
}
