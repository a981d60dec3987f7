//! Field frames on disk, written by a thread of their own while the run goes on: a .vtu file each, the .pvd list and a picture.

use super::snapshot::{self, Snapshot};
use super::vtu::{self, Grid, PointData};
use crate::error::Error;
use crate::generated::{Domain, FrameColumn, Program};
use crate::mesh::Mesh;
use crate::observer::Frame;
use crate::system::{domain_nodes, path_edges, region_cells};
use std::path::PathBuf;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

/// Frames that may wait for the writer.
const WAITING: usize = 8;

/// Writes the frames of a run.
pub struct FrameWriter {
    sender: Option<SyncSender<Frame>>,
    thread: Option<JoinHandle<Result<(), Error>>>,
}

impl FrameWriter {
    /// Starts the thread; files go to `folder`.
    pub fn start(folder: PathBuf, program: &'static Program, mesh: &Mesh) -> Result<Self, Error> {
        let grids = program.frames.iter().map(|f| grid(mesh, f.domain)).collect::<Result<Vec<_>, _>>()?;
        let (sender, receiver) = sync_channel::<Frame>(WAITING);
        let thread = std::thread::spawn(move || {
            let mut series = vec![Vec::new(); grids.len()];
            for frame in receiver {
                write_frame(&folder, program, &grids, &mut series, &frame)?;
            }
            Ok(())
        });
        Ok(Self { sender: Some(sender), thread: Some(thread) })
    }

    /// Queues a frame; waits if the writer is behind.
    pub fn send(&mut self, frame: Frame) -> Result<(), Error> {
        let accepted = self.sender.as_ref().is_some_and(|s| s.send(frame).is_ok());
        if accepted { Ok(()) } else { self.finish() }
    }

    /// Waits until all is written.
    pub fn finish(&mut self) -> Result<(), Error> {
        self.sender = None;
        let stopped = || Error::Model(String::from("the writer of field frames stopped"));
        self.thread.take().map_or(Ok(()), |t| t.join().unwrap_or_else(|_| Err(stopped())))
    }
}

impl Drop for FrameWriter {
    /// Frames in the queue still reach the disk when a run ends by an error.
    fn drop(&mut self) {
        let _ = self.finish();
    }
}

fn grid(mesh: &Mesh, domain: Domain) -> Result<Grid, Error> {
    let nodes = domain_nodes(mesh, domain)?;
    let position = |n: u32| nodes.binary_search(&n).unwrap_or(0) as u32;
    let mut grid =
        Grid { points: nodes.iter().map(|&n| mesh.nodes[n as usize]).collect(), ..Grid::default() };
    match domain {
        Domain::Cells(regions) => {
            for region in regions {
                for cell in region_cells(mesh, region)? {
                    grid.cells.push(mesh.cells[cell].map(position));
                    grid.regions.push(mesh.cell_region[cell]);
                }
            }
        }
        Domain::Edges(paths) | Domain::Ends(paths) => {
            for path in paths {
                grid.edges.extend(path_edges(mesh, path)?.into_iter().map(|edge| edge.map(position)));
            }
        }
    }
    Ok(grid)
}

fn write_frame(
    folder: &std::path::Path,
    program: &Program,
    grids: &[Grid],
    series: &mut [Vec<(f64, String)>],
    frame: &Frame,
) -> Result<(), Error> {
    let frames = &program.frames[frame.frame];
    let present = frame.mesh.as_ref().map(|mesh| grid(mesh, frames.domain)).transpose()?;
    let grid = present.as_ref().unwrap_or(&grids[frame.frame]);
    let stem = if grids.len() == 1 { String::from("fields") } else { format!("fields{}", frame.frame) };
    let number = series[frame.frame].len();
    let file = format!("{stem}_{number:05}.vtu");
    let data: Vec<PointData> = frames
        .columns
        .iter()
        .zip(&frame.columns)
        .map(|(column, values)| PointData {
            name: format!("{} [{}]", column.name, column.unit),
            components: column.components,
            values: in_plane(program, column, values),
        })
        .collect();
    vtu::write(&folder.join(&file), grid, &data)?;
    series[frame.frame].push((frame.time, file));
    vtu::write_series(&folder.join(format!("{stem}.pvd")), &series[frame.frame])?;
    let is_displacement = |c: &FrameColumn| c.components == 3 && c.unit == program.base_units[0];
    let moved = frames.columns.iter().position(is_displacement);
    let shown = frames.columns.iter().position(|c| c.components == 1);
    let Some(shown) = shown else { return Ok(()) };
    let vectors = |k: usize| data[k].values.chunks(3).map(|v| [v[0], v[1]]);
    let displacement: Vec<[f64; 2]> = match moved {
        Some(k) => vectors(k).map(|u| u.map(|x| x * frames.columns[k].unit_value)).collect(),
        None => vec![[0.0; 2]; grid.points.len()],
    };
    let drawn = frames.columns.iter().position(|c| c.components == 3 && !is_displacement(c));
    let arrows: Vec<[f64; 2]> = drawn.map_or_else(Vec::new, |k| vectors(k).collect());
    let picture = folder.join(format!("{}_{number:05}.png", frames.columns[shown].name));
    let about = drawn.map_or_else(String::new, |k| format!(", arrows: {}", frames.columns[k].name));
    let caption = format!("t = {:.2} {}{about}", frame.time, program.base_units[2]);
    let title = &data[shown].name;
    snapshot::write(
        &picture,
        &Snapshot {
            grid,
            displacement: &displacement,
            values: &data[shown].values,
            arrows: &arrows,
            title,
            caption: &caption,
        },
    )
}

/// Display values with vectors and tensors turned from the model's frame into that of the file: in-plane x and y first.
fn in_plane(program: &Program, column: &FrameColumn, values: &[f64]) -> Vec<f64> {
    let order = if program.axisymmetric { [0, 2, 1] } else { [0, 1, 2] };
    let shown = |v: f64| v / column.unit_value;
    match column.components {
        3 => values.chunks(3).flat_map(|v| order.map(|i| shown(v[i]))).collect(),
        9 => values
            .chunks(9)
            .flat_map(|v| order.into_iter().flat_map(move |i| order.map(|j| shown(v[3 * i + j]))))
            .collect(),
        _ => values.iter().map(|v| shown(*v)).collect(),
    }
}
