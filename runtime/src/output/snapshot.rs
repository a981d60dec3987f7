//! Pictures of deformed bodies and of what is between them, coloured by scalars with a colour bar each, and with arrows for vectors.

use super::arrows;
use super::canvas::{Canvas, Rgb};
use super::layer::Layer;
use crate::error::Error;
use std::path::Path;

/// Triangles per edge of a cell: curved edges look curved.
const PARTS: usize = 3;
/// Largest size; a wide body makes a picture less tall, at least as tall as its bar.
const PICTURE: [usize; 2] = [640, 800];
const MARGIN: f64 = 40.0;
const BAR: f64 = 110.0;
const BAR_HEIGHT: f64 = 300.0;
const INK: Rgb = [30; 3];
/// Steps of a bar of colours.
const COLOURS: usize = 256;

/// A layer and the number of its column that gives the colours; without one, a path is a line in ink.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// What to draw.
    pub layer: &'a Layer,
    /// Column of scalars.
    pub scalar: Option<usize>,
}

impl Shown<'_> {
    fn values(&self) -> Option<&[f64]> {
        self.scalar.map(|k| &self.layer.data[k].values[..])
    }

    fn title(&self) -> Option<&str> {
        self.scalar.map(|k| &self.layer.data[k].name[..])
    }
}

/// The caption of a picture.
pub fn at_time(time: f64, unit: &str) -> String {
    format!("t = {time:.2} {unit}")
}

/// Draws layers over each other and writes a PNG.
pub fn write(path: &Path, layers: &[Shown<'_>], caption: &str) -> Result<(), Error> {
    let view = View::new(layers);
    let mut canvas = Canvas::new(PICTURE[0], view.height());
    let ranges: Vec<_> = layers.iter().map(|shown| shown.values().map(Range::of)).collect();
    for (shown, range) in layers.iter().zip(&ranges) {
        draw_layer(&mut canvas, &view, shown, range.as_ref());
    }
    let titles: Vec<&str> = layers.iter().filter_map(Shown::title).collect();
    let bars: Vec<_> = ranges.iter().flatten().zip(&titles).collect();
    let slot = (view.height() as f64 - 2.0 * MARGIN) / bars.len().max(1) as f64;
    for (k, (range, title)) in bars.into_iter().enumerate() {
        draw_bar(&mut canvas, [MARGIN + k as f64 * slot, slot], range, (titles.len() > 1).then_some(title));
    }
    let arrows = layers.iter().filter_map(|shown| shown.layer.arrows).map(|name| format!(", arrows: {name}"));
    canvas.text([MARGIN, 10.0], &titles.join(", "), INK);
    canvas.text([MARGIN, 24.0], &format!("{caption}{}", arrows.collect::<String>()), INK);
    canvas.write(path)
}

fn draw_layer(canvas: &mut Canvas, view: &View, shown: &Shown<'_>, range: Option<&Range>) {
    let (layer, grid) = (shown.layer, &shown.layer.grid);
    let pixel = |n: u32| view.pixel(layer.position(n));
    let coloured = shown.values().zip(range);
    if let Some((values, range)) = coloured {
        for cell in &grid.cells {
            draw_cell(canvas, cell.map(pixel), cell.map(|n| values[n as usize]), range);
        }
    }
    for edge in &grid.outline {
        draw_edge(canvas, edge.map(pixel));
    }
    for edge in &grid.edges {
        let colour = |s: f64| {
            coloured.map_or(INK, |(values, range)| range.colour(on_edge(edge.map(|n| values[n as usize]), s)))
        };
        draw_curve(canvas, edge.map(pixel), colour);
    }
    let arrows: Vec<_> = layer.vectors.iter().zip(0..).map(|(&arrow, n)| (pixel(n), arrow)).collect();
    arrows::draw(canvas, &arrows, INK);
}

/// Maps model coordinates to pixels. The frame holds the body before and after its deformation: a series of pictures keeps it until the body leaves it.
struct View {
    low: [f64; 2],
    high: [f64; 2],
    scale: f64,
}

impl View {
    fn new(layers: &[Shown<'_>]) -> Self {
        let ends = |layer: &Layer| {
            let both = |n: usize| [layer.grid.points[n], layer.position(n as u32)];
            (0..layer.grid.points.len()).flat_map(both).collect::<Vec<_>>()
        };
        let points: Vec<[f64; 2]> = layers.iter().flat_map(|shown| ends(shown.layer)).collect();
        let bound = |axis: usize, best: fn(f64, f64) -> f64, start: f64| {
            points.iter().map(|p| p[axis]).fold(start, best)
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
    /// From the lowest value to the highest.
    colours: Vec<Rgb>,
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
        let constant = if high - low > 1e-12 { 0.0 } else { 0.5e-12 };
        Self { low: low - constant, high: high + constant, colours: colours(low < 0.0 && high > 0.0) }
    }

    fn colour(&self, value: f64) -> Rgb {
        let s = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.colours[((s * COLOURS as f64) as usize).min(COLOURS - 1)]
    }
}

/// Blue over white to red for values of both signs, else dark to bright.
fn colours(both_signs: bool) -> Vec<Rgb> {
    let gradient = if both_signs { colorous::RED_BLUE } else { colorous::VIRIDIS };
    let colour = |k: usize| {
        let k = if both_signs { COLOURS - 1 - k } else { k };
        let colour = gradient.eval_rational(k, COLOURS);
        [colour.r, colour.g, colour.b]
    };
    (0..COLOURS).map(colour).collect()
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

/// An edge of a curve, which has no cells to show its values: colours from its start at 0 to its end at 1.
fn draw_curve(canvas: &mut Canvas, nodes: [[f64; 2]; 3], colour: impl Fn(f64) -> Rgb) {
    for k in 0..PARTS {
        let [from, to] = [k, k + 1].map(|k| edge_point(nodes, k as f64 / PARTS as f64));
        let colour = colour((k as f64 + 0.5) / PARTS as f64);
        for shift in [-1.0, 0.0, 1.0] {
            canvas.line([from[0] + shift, from[1]], [to[0] + shift, to[1]], colour);
            canvas.line([from[0], from[1] + shift], [to[0], to[1] + shift], colour);
        }
    }
}

/// The bar of a range, in the slot from the pixel `top` on; with a title where there are several.
fn draw_bar(canvas: &mut Canvas, [top, slot]: [f64; 2], range: &Range, title: Option<&str>) {
    let (x, top, height) = (PICTURE[0] as f64 - BAR + 10.0, top + 40.0, BAR_HEIGHT.min(slot - 60.0));
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
    if let Some(title) = title {
        let left = PICTURE[0] as f64 - 8.0 * title.chars().count() as f64 - 4.0;
        canvas.text([left.min(x), top - 22.0], title, INK);
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
