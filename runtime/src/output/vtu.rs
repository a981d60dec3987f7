//! VTK unstructured grids (.vtu) with curved quadratic triangles or edges and node data, and the time series (.pvd) that lists them.
//!
//! Format: *VTK File Formats* (Kitware), XML, appended raw data compressed with zlib. Axisymmetric models lie in the plane as x = r, y = z.

use crate::error::Error;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// VTK's number of the 6-node triangle.
const QUADRATIC_TRIANGLE: u8 = 22;
/// VTK's number of the 3-node edge.
const QUADRATIC_EDGE: u8 = 21;
/// Region number of edges.
const NO_REGION: i32 = -1;

/// Node values of one quantity.
pub struct PointData {
    /// Name with unit.
    pub name: String,
    /// 1, 3 (vector) or 9 (tensor) values per node.
    pub components: usize,
    /// Node by node.
    pub values: Vec<f64>,
}

/// Cells, edges and nodes of a file.
#[derive(Default)]
pub struct Grid {
    /// In-plane coordinates.
    pub points: Vec<[f64; 2]>,
    /// 6 nodes per cell: vertices, then mid-edges.
    pub cells: Vec<[u32; 6]>,
    /// Region number of each cell.
    pub regions: Vec<u16>,
    /// 3 nodes per edge of a path: ends, then middle.
    pub edges: Vec<[u32; 3]>,
    /// Edges around regions, for pictures: ends, then middle.
    pub outline: Vec<[u32; 3]>,
}

/// Writes one frame.
pub fn write(path: &Path, grid: &Grid, data: &[PointData]) -> Result<(), Error> {
    let mut appended = Appended::default();
    let points: Vec<f64> = grid.points.iter().flat_map(|p| [p[0], p[1], 0.0]).collect();
    let mut xml = String::new();
    let (nodes, cells, edges) = (grid.points.len(), grid.cells.len(), grid.edges.len());
    let elements = cells + edges;
    xml.push_str("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n");
    let _ = writeln!(xml, "<Piece NumberOfPoints=\"{nodes}\" NumberOfCells=\"{elements}\">");
    xml.push_str("<PointData>\n");
    for item in data {
        appended.floats(&mut xml, &item.name, item.components, &item.values)?;
    }
    xml.push_str("</PointData>\n<CellData>\n");
    let of_cells = grid.regions.iter().map(|&region| i32::from(region));
    let regions: Vec<u8> =
        of_cells.chain(grid.edges.iter().map(|_| NO_REGION)).flat_map(i32::to_le_bytes).collect();
    appended.array(&mut xml, "Int32", "region", 1, &regions)?;
    xml.push_str("</CellData>\n<Points>\n");
    appended.floats(&mut xml, "Points", 3, &points)?;
    xml.push_str("</Points>\n<Cells>\n");
    let members = grid.cells.iter().flatten().chain(grid.edges.iter().flatten());
    let connectivity: Vec<u8> = members.flat_map(|&n| i64::from(n).to_le_bytes()).collect();
    let last = 6 * cells as i64;
    let ends = (1..=cells as i64).map(|k| 6 * k).chain((1..=edges as i64).map(|k| last + 3 * k));
    let offsets: Vec<u8> = ends.flat_map(i64::to_le_bytes).collect();
    let types = [vec![QUADRATIC_TRIANGLE; cells], vec![QUADRATIC_EDGE; edges]].concat();
    appended.array(&mut xml, "Int64", "connectivity", 1, &connectivity)?;
    appended.array(&mut xml, "Int64", "offsets", 1, &offsets)?;
    appended.array(&mut xml, "UInt8", "types", 1, &types)?;
    xml.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    let mut bytes = xml.into_bytes();
    bytes.extend_from_slice(&appended.bytes);
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    std::fs::write(path, bytes).map_err(|e| super::cannot_write(path, &e))
}

/// Compressed arrays behind the XML.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    fn floats(
        &mut self,
        xml: &mut String,
        name: &str,
        components: usize,
        values: &[f64],
    ) -> Result<(), Error> {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.array(xml, "Float64", name, components, &bytes)
    }

    /// One block: number of blocks, block size, size of a last partial block, compressed sizes, data.
    fn array(
        &mut self,
        xml: &mut String,
        kind: &str,
        name: &str,
        components: usize,
        raw: &[u8],
    ) -> Result<(), Error> {
        let offset = self.bytes.len();
        let name = escape(name);
        let _ = writeln!(
            xml,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{offset}\"/>"
        );
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        let compressed = encoder.write_all(raw).and_then(|()| encoder.finish());
        let compressed = compressed.map_err(|e| super::cannot_write(Path::new("frame"), &e))?;
        let blocks = u64::from(!raw.is_empty());
        let mut header = vec![blocks, raw.len() as u64, 0];
        header.extend((blocks > 0).then_some(compressed.len() as u64));
        self.bytes.extend(header.iter().flat_map(|h| h.to_le_bytes()));
        if blocks > 0 {
            self.bytes.extend_from_slice(&compressed);
        }
        Ok(())
    }
}

fn escape(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

/// Writes the list of frames (time, file name) that viewers open.
pub fn write_series(path: &Path, frames: &[(f64, String)]) -> Result<(), Error> {
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (time, file) in frames {
        let _ = writeln!(xml, "<DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>");
    }
    xml.push_str("</Collection>\n</VTKFile>\n");
    std::fs::write(path, xml).map_err(|e| super::cannot_write(path, &e))
}
