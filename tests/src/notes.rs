//! An observer that keeps what it hears.

use ansatz::Error;
use ansatz::observer::{Frame, Observer};

/// Rows and frames of a run.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    /// Rows of each table, in the order in which they came: (table, values in display units).
    pub rows: Vec<(usize, Vec<f64>)>,
    /// Frames.
    pub frames: Vec<Frame>,
}

impl Observer for Notes {
    fn row(&mut self, table: usize, values: &[f64]) -> Result<(), Error> {
        self.rows.push((table, values.to_vec()));
        Ok(())
    }
    fn frame(&mut self, frame: Frame) -> Result<(), Error> {
        self.frames.push(frame);
        Ok(())
    }
}
