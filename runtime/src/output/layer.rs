//! What one `fields` statement shows at one time, turned from the model's frame and units into those of files and pictures.

use super::vtu::{Grid, PointData};
use crate::generated::{FrameColumn, Frames, Program};
use crate::observer::Frame;
use std::sync::Arc;

/// Node values on a grid, ready to be written and drawn.
pub struct Layer {
    /// Where: cells of regions or edges of paths.
    pub grid: Arc<Grid>,
    /// All columns, named with their units.
    pub data: Vec<PointData>,
    /// In-plane displacement of each node: the first column of vectors that are lengths; zero without one.
    pub displacement: Vec<[f64; 2]>,
    /// Name of the first column of other vectors.
    pub arrows: Option<&'static str>,
    /// In-plane vector of each node, drawn as an arrow; empty without such a column.
    pub vectors: Vec<[f64; 2]>,
}

impl Layer {
    /// The layer of a frame.
    pub fn new(program: &Program, grid: Arc<Grid>, frame: &Frame) -> Self {
        let columns = program.frames[frame.frame].columns;
        let data: Vec<PointData> =
            columns.iter().zip(&frame.columns).map(|(c, values)| point_data(program, c, values)).collect();
        let is_vector = |c: &FrameColumn| c.components == 3;
        let is_displacement = |c: &FrameColumn| is_vector(c) && c.unit == program.base_units[0];
        let in_plane = |k: usize| data[k].values.chunks(3).map(|v| [v[0], v[1]]);
        let displacement = match columns.iter().position(is_displacement) {
            Some(k) => in_plane(k).map(|u| u.map(|x| x * columns[k].unit_value)).collect(),
            None => vec![[0.0; 2]; grid.points.len()],
        };
        let drawn = columns.iter().position(|c| is_vector(c) && !is_displacement(c));
        let arrows = drawn.map(|k| columns[k].name);
        let vectors = drawn.map_or_else(Vec::new, |k| in_plane(k).collect());
        Self { grid, data, displacement, arrows, vectors }
    }

    /// In-plane position of a node as it has moved.
    pub fn position(&self, node: u32) -> [f64; 2] {
        let (p, u) = (self.grid.points[node as usize], self.displacement[node as usize]);
        [p[0] + u[0], p[1] + u[1]]
    }
}

/// Numbers of the columns that a picture can show by colours.
pub fn scalars(frames: &Frames) -> impl Iterator<Item = usize> {
    (0..frames.columns.len()).filter(|&k| frames.columns[k].components == 1)
}

/// Display values with vectors and tensors turned from the model's frame into that of the file: in-plane x and y first.
fn point_data(program: &Program, column: &FrameColumn, values: &[f64]) -> PointData {
    let order = if program.axisymmetric { [0, 2, 1] } else { [0, 1, 2] };
    let shown = |v: f64| v / column.unit_value;
    let values = match column.components {
        3 => values.chunks(3).flat_map(|v| order.map(|i| shown(v[i]))).collect(),
        9 => values
            .chunks(9)
            .flat_map(|v| order.into_iter().flat_map(move |i| order.map(|j| shown(v[3 * i + j]))))
            .collect(),
        _ => values.iter().map(|v| shown(*v)).collect(),
    };
    PointData { name: format!("{} [{}]", column.name, column.unit), components: column.components, values }
}
