//! Pictures of the deformed bodies coloured by one scalar, with a colour bar, and with arrows for a vector.

use super::arrows;
use super::canvas::{Canvas, Rgb};
use super::vtu::Grid;
use crate::error::Error;
use std::collections::BTreeMap;
use std::path::Path;

/// Triangles per edge of a cell: curved edges look curved.
const PARTS: usize = 3;
/// Largest size; a wide body makes a picture less tall, at least as tall as its bar.
const PICTURE: [usize; 2] = [640, 800];
const MARGIN: f64 = 40.0;
const BAR: f64 = 110.0;
const BAR_HEIGHT: f64 = 300.0;
const INK: Rgb = [30; 3];

/// What to draw.
pub struct Snapshot<'a> {
    /// Reference grid.
    pub grid: &'a Grid,
    /// In-plane displacement of each node.
    pub displacement: &'a [[f64; 2]],
    /// Value of each node.
    pub values: &'a [f64],
    /// In-plane vector of each node, drawn as an arrow; empty for none.
    pub arrows: &'a [[f64; 2]],
    /// Title, such as `strain_zz [1]`.
    pub title: &'a str,
    /// Second line, such as `t = 85 s`.
    pub caption: &'a str,
}

/// Draws and writes a PNG.
pub fn write(path: &Path, snapshot: &Snapshot<'_>) -> Result<(), Error> {
    let position = |n: u32| {
        let (p, u) = (snapshot.grid.points[n as usize], snapshot.displacement[n as usize]);
        [p[0] + u[0], p[1] + u[1]]
    };
    let view = View::new(snapshot.grid, position);
    let mut canvas = Canvas::new(PICTURE[0], view.height());
    let range = Range::of(snapshot.values);
    for cell in &snapshot.grid.cells {
        let corners = cell.map(|n| view.pixel(position(n)));
        let values = cell.map(|n| snapshot.values[n as usize]);
        draw_cell(&mut canvas, corners, values, &range);
    }
    for edge in outline(snapshot.grid) {
        draw_edge(&mut canvas, edge.map(|n| view.pixel(position(n))));
    }
    for edge in &snapshot.grid.edges {
        let values = edge.map(|n| snapshot.values[n as usize]);
        draw_curve(&mut canvas, edge.map(|n| view.pixel(position(n))), values, &range);
    }
    let arrows: Vec<_> =
        snapshot.arrows.iter().zip(0..).map(|(&arrow, n)| (view.pixel(position(n)), arrow)).collect();
    arrows::draw(&mut canvas, &arrows, INK);
    draw_bar(&mut canvas, &range);
    canvas.text([MARGIN, 10.0], snapshot.title, INK);
    canvas.text([MARGIN, 24.0], snapshot.caption, INK);
    canvas.write(path)
}

/// Maps model coordinates to pixels. The frame holds the body before and after its deformation: a series of pictures keeps it until the body leaves it.
struct View {
    low: [f64; 2],
    high: [f64; 2],
    scale: f64,
}

impl View {
    fn new(grid: &Grid, position: impl Fn(u32) -> [f64; 2]) -> Self {
        let bound = |axis: usize, best: fn(f64, f64) -> f64, start: f64| {
            let both = |(n, p): (usize, &[f64; 2])| best(p[axis], position(n as u32)[axis]);
            grid.points.iter().enumerate().map(both).fold(start, best)
        };
        let low = [0, 1].map(|a| bound(a, f64::min, f64::INFINITY));
        let high = [0, 1].map(|a| bound(a, f64::max, f64::NEG_INFINITY));
        let wide = (PICTURE[0] as f64 - 2.0 * MARGIN - BAR) / (high[0] - low[0]);
        let tall = (PICTURE[1] as f64 - 2.0 * MARGIN) / (high[1] - low[1]);
        Self { low, high, scale: wide.min(tall) }
    }

    /// Height of the picture.
    fn height(&self) -> usize {
        let body = (self.high[1] - self.low[1]) * self.scale;
        ((body + 2.0 * MARGIN).max(BAR_HEIGHT + 3.0 * MARGIN).ceil() as usize).min(PICTURE[1])
    }

    fn pixel(&self, p: [f64; 2]) -> [f64; 2] {
        [MARGIN + (p[0] - self.low[0]) * self.scale, MARGIN + (self.high[1] - p[1]) * self.scale]
    }
}

/// Symmetric about zero where the values have both signs; outermost 0.5 % of the nodes saturate.
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    fn of(values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let at = |part: f64| {
            sorted.get((part * (sorted.len().max(1) - 1) as f64) as usize).copied().unwrap_or(0.0)
        };
        let (low, high) = (at(0.005), at(0.995));
        let (low, high) =
            if low < 0.0 && high > 0.0 { (-high.max(-low), high.max(-low)) } else { (low, high) };
        if high - low > 1e-12 {
            Self { low, high }
        } else {
            Self { low: low - 0.5e-12, high: high + 0.5e-12 }
        }
    }

    fn colour(&self, value: f64) -> Rgb {
        let s = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        let both_signs = self.low < 0.0 && self.high > 0.0;
        let gradient = if both_signs { colorous::RED_BLUE } else { colorous::VIRIDIS };
        let c = gradient.eval_continuous(if both_signs { 1.0 - s } else { s });
        [c.r, c.g, c.b]
    }
}

/// Quadratic basis of the 6-node triangle at barycentric coordinates.
fn quadratic(l: [f64; 3]) -> [f64; 6] {
    let [a, b, c] = l;
    [a * (2.0 * a - 1.0), b * (2.0 * b - 1.0), c * (2.0 * c - 1.0), 4.0 * a * b, 4.0 * b * c, 4.0 * c * a]
}

fn draw_cell(canvas: &mut Canvas, corners: [[f64; 2]; 6], values: [f64; 6], range: &Range) {
    let at = |i: usize, j: usize| {
        let (b, c) = (i as f64 / PARTS as f64, j as f64 / PARTS as f64);
        let phi = quadratic([1.0 - b - c, b, c]);
        let mut x = [0.0; 2];
        let mut value = 0.0;
        for k in 0..6 {
            x[0] += phi[k] * corners[k][0];
            x[1] += phi[k] * corners[k][1];
            value += phi[k] * values[k];
        }
        (x, value)
    };
    let mut fill =
        |p: [([f64; 2], f64); 3]| canvas.triangle(p.map(|q| q.0), p.map(|q| q.1), |v| range.colour(v));
    for i in 0..PARTS {
        for j in 0..PARTS - i {
            fill([at(i, j), at(i + 1, j), at(i, j + 1)]);
            if i + j + 2 <= PARTS {
                fill([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
}

/// Edges `[start, end, middle]` with one cell, or between two regions.
fn outline(grid: &Grid) -> Vec<[u32; 3]> {
    let mut edges: BTreeMap<u32, ([u32; 3], Vec<u16>)> = BTreeMap::new();
    for (cell, &region) in grid.cells.iter().zip(&grid.regions) {
        for (a, b, middle) in [(0, 1, 3), (1, 2, 4), (2, 0, 5)] {
            edges
                .entry(cell[middle])
                .or_insert(([cell[a], cell[b], cell[middle]], Vec::new()))
                .1
                .push(region);
        }
    }
    let border = |regions: &[u16]| regions.len() == 1 || regions[0] != regions[1];
    edges.into_values().filter(|(_, regions)| border(regions)).map(|(edge, _)| edge).collect()
}

/// Value at the parameter `s` of an edge from its start, end and middle.
fn on_edge([a, b, m]: [f64; 3], s: f64) -> f64 {
    a * (1.0 - s) * (1.0 - 2.0 * s) + b * s * (2.0 * s - 1.0) + m * 4.0 * s * (1.0 - s)
}

fn edge_point(nodes: [[f64; 2]; 3], s: f64) -> [f64; 2] {
    [0, 1].map(|i| on_edge(nodes.map(|node| node[i]), s))
}

fn draw_edge(canvas: &mut Canvas, nodes: [[f64; 2]; 3]) {
    for k in 0..PARTS {
        let [from, to] = [k, k + 1].map(|k| edge_point(nodes, k as f64 / PARTS as f64));
        canvas.line(from, to, INK);
    }
}

/// An edge of a curve, which has no cells to show its values.
fn draw_curve(canvas: &mut Canvas, nodes: [[f64; 2]; 3], values: [f64; 3], range: &Range) {
    for k in 0..PARTS {
        let [from, to] = [k, k + 1].map(|k| edge_point(nodes, k as f64 / PARTS as f64));
        let colour = range.colour(on_edge(values, (k as f64 + 0.5) / PARTS as f64));
        for shift in [-1.0, 0.0, 1.0] {
            canvas.line([from[0] + shift, from[1]], [to[0] + shift, to[1]], colour);
            canvas.line([from[0], from[1] + shift], [to[0], to[1] + shift], colour);
        }
    }
}

fn draw_bar(canvas: &mut Canvas, range: &Range) {
    let (x, top, height) = (PICTURE[0] as f64 - BAR + 10.0, MARGIN + 40.0, BAR_HEIGHT);
    let rows = 150;
    for k in 0..rows {
        let s = 1.0 - k as f64 / (rows - 1) as f64;
        let colour = range.colour(range.low + s * (range.high - range.low));
        let step = height / rows as f64;
        canvas.rectangle([x, top + k as f64 * step], [18.0, step + 0.5], colour);
    }
    for k in 0..5 {
        let s = k as f64 / 4.0;
        let value = range.low + s * (range.high - range.low);
        canvas.text([x + 24.0, top + (1.0 - s) * height - 4.0], &short(value), INK);
    }
}

/// At most 8 characters.
fn short(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&value.abs()) {
        let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 5) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}")
    }
}
