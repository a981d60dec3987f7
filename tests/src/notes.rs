//! An observer that keeps what it hears.

use ansatz::Error;
use ansatz::generated::{Program, Table};
use ansatz::observer::{Frame, Observer};

/// Rows and frames of a run.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    /// Rows of each table, in the order in which they came: (table, values in display units).
    pub rows: Vec<(usize, Vec<f64>)>,
    /// Frames.
    pub frames: Vec<Frame>,
}

impl Notes {
    /// The column of that name in the first of a model's tables that has it, in display units.
    ///
    /// # Panics
    /// If no table has it.
    pub fn column(&self, program: &Program, name: &str) -> Vec<f64> {
        let of_table = |table: &Table| table.columns.iter().position(|column| column.name == name);
        let mut found =
            program.tables.iter().enumerate().filter_map(|(k, table)| Some((k, of_table(table)?)));
        let (table, column) = found.next().expect("a table has the column");
        self.rows.iter().filter(|(of, _)| *of == table).map(|(_, row)| row[column]).collect()
    }
}

impl Observer for Notes {
    fn row(&mut self, table: usize, values: &[f64]) -> Result<(), Error> {
        self.rows.push((table, values.to_vec()));
        Ok(())
    }
    fn wants_frames(&self) -> bool {
        true
    }
    fn frame(&mut self, frame: Frame) -> Result<(), Error> {
        self.frames.push(frame);
        Ok(())
    }
}
