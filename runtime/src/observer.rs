//! What a running simulation tells the outside: steps, events, table rows and field frames. Writers, progress bars and tests are observers.

use crate::error::Error;
use crate::mesh::Mesh;

/// An accepted step.
#[derive(Clone, Debug)]
pub struct Step<'a> {
    /// Number of the step, from 1.
    pub number: usize,
    /// Time at its end.
    pub time: f64,
    /// Its size.
    pub size: f64,
    /// Newton iterations it took, over all stages.
    pub iterations: usize,
    /// Globals at its end.
    pub globals: &'a [f64],
}

/// An event that fired.
#[derive(Clone, Debug, PartialEq)]
pub struct Fired {
    /// Index into the program's events.
    pub event: usize,
    /// When.
    pub time: f64,
}

/// Node values of a field frame: its nodes are the mesh nodes of its regions in ascending order.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Index into the program's frames.
    pub frame: usize,
    /// Time.
    pub time: f64,
    /// Values of each column, node by node, component by component \[internal units\].
    pub columns: Vec<Vec<f64>>,
    /// The mesh, where it is another one than at the beginning.
    pub mesh: Option<Mesh>,
}

/// Follows a run. Every method may stop the run by an error.
pub trait Observer {
    /// The mesh is ready.
    fn begin(&mut self, _mesh: &Mesh) -> Result<(), Error> {
        Ok(())
    }
    /// A step was accepted.
    fn step(&mut self, _step: &Step<'_>) -> Result<(), Error> {
        Ok(())
    }
    /// A table has a new row (display units).
    fn row(&mut self, _table: usize, _values: &[f64]) -> Result<(), Error> {
        Ok(())
    }
    /// Whether [`Self::frame`] does anything: frames that nobody wants are not sampled.
    fn wants_frames(&self) -> bool {
        false
    }
    /// A frame is due.
    fn frame(&mut self, _frame: Frame) -> Result<(), Error> {
        Ok(())
    }
    /// An event fired.
    fn fired(&mut self, _event: &Fired) -> Result<(), Error> {
        Ok(())
    }
}

/// Two observers as one; the first hears everything first.
pub struct Both<'a>(pub &'a mut dyn Observer, pub &'a mut dyn Observer);

impl Observer for Both<'_> {
    fn begin(&mut self, mesh: &Mesh) -> Result<(), Error> {
        self.0.begin(mesh)?;
        self.1.begin(mesh)
    }
    fn step(&mut self, step: &Step<'_>) -> Result<(), Error> {
        self.0.step(step)?;
        self.1.step(step)
    }
    fn row(&mut self, table: usize, values: &[f64]) -> Result<(), Error> {
        self.0.row(table, values)?;
        self.1.row(table, values)
    }
    fn wants_frames(&self) -> bool {
        self.0.wants_frames() || self.1.wants_frames()
    }
    fn frame(&mut self, frame: Frame) -> Result<(), Error> {
        self.0.frame(frame.clone())?;
        self.1.frame(frame)
    }
    fn fired(&mut self, fired: &Fired) -> Result<(), Error> {
        self.0.fired(fired)?;
        self.1.fired(fired)
    }
}
