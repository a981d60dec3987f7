//! Tables over time as CSV: a header `name [unit]`, then one row for each output time.

use crate::error::Error;
use crate::generated::Table;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// A CSV file that grows with the run; every row is on disk when it is written, so that a run that ends early leaves a readable table.
pub struct TableWriter {
    path: PathBuf,
    file: BufWriter<File>,
}

impl TableWriter {
    /// Creates the file and writes its header.
    pub fn create(folder: &Path, table: &Table) -> Result<Self, Error> {
        let path = folder.join(table.file);
        let file = File::create(&path).map_err(|e| super::cannot_write(&path, &e))?;
        let mut writer = Self { path, file: BufWriter::new(file) };
        let names: Vec<String> = table.columns.iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect();
        writer.line(&names.join(","))?;
        Ok(writer)
    }

    /// Appends a row of display values.
    pub fn row(&mut self, values: &[f64]) -> Result<(), Error> {
        let cells: Vec<String> = values.iter().map(|v| format!("{}", Significant(*v))).collect();
        self.line(&cells.join(","))
    }

    fn line(&mut self, text: &str) -> Result<(), Error> {
        writeln!(self.file, "{text}")
            .and_then(|()| self.file.flush())
            .map_err(|e| super::cannot_write(&self.path, &e))
    }
}

/// A number with 12 significant digits, in the shortest form that reads back the same.
struct Significant(f64);

impl std::fmt::Display for Significant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let rounded: f64 = format!("{:.11e}", self.0).parse().unwrap_or(self.0);
        let plain = rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs());
        if plain { write!(f, "{rounded}") } else { write!(f, "{rounded:e}") }
    }
}

#[cfg(test)]
mod tests {
    use super::Significant;

    #[test]
    fn numbers_are_short_and_exact_to_twelve_digits() {
        assert_eq!(Significant(0.1 + 0.2).to_string(), "0.3");
        assert_eq!(Significant(1.0 / 3.0).to_string(), "0.333333333333");
        assert_eq!(Significant(-2.5e-7).to_string(), "-2.5e-7");
        assert_eq!(Significant(0.0).to_string(), "0");
    }
}
