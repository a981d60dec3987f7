//! A small raster: filled triangles with interpolated values, lines, text, written as PNG. Drawn at twice the size and averaged down.

use crate::error::Error;
use font8x8::UnicodeFonts;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Samples per pixel and direction.
const FINE: usize = 2;

/// Colour, red green blue.
pub type Rgb = [u8; 3];

/// The picture while it is drawn; coordinates are pixels from the upper left corner.
pub struct Canvas {
    width: usize,
    height: usize,
    fine: Vec<Rgb>,
}

impl Canvas {
    /// A white canvas.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, fine: vec![[255; 3]; width * height * FINE * FINE] }
    }

    fn set(&mut self, x: i64, y: i64, colour: Rgb) {
        let (w, h) = ((self.width * FINE) as i64, (self.height * FINE) as i64);
        if (0..w).contains(&x) && (0..h).contains(&y) {
            self.fine[(y * w + x) as usize] = colour;
        }
    }

    /// Fills a triangle; `colour` maps the linearly interpolated value.
    pub fn triangle(&mut self, corners: [[f64; 2]; 3], values: [f64; 3], colour: impl Fn(f64) -> Rgb) {
        let p = corners.map(|c| c.map(|v| v * FINE as f64 - 0.5));
        let per_area = cross(p[0], p[1], p[2]).recip();
        if !per_area.is_finite() {
            return;
        }
        let bound = |axis: usize, size: usize| {
            let low = p.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min).ceil().max(0.0) as i64;
            let high = p.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max).floor();
            (low, high.min((size * FINE) as f64) as i64)
        };
        let ((x0, x1), (y0, y1)) = (bound(0, self.width), bound(1, self.height));
        for y in y0..=y1 {
            for x in x0..=x1 {
                let q = [x as f64, y as f64];
                let l =
                    [cross(p[1], p[2], q), cross(p[2], p[0], q), cross(p[0], p[1], q)].map(|l| l * per_area);
                if l.iter().all(|&l| l >= -1e-9) {
                    self.set(x, y, colour(l[0] * values[0] + l[1] * values[1] + l[2] * values[2]));
                }
            }
        }
    }

    /// A line one pixel wide.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb) {
        let steps =
            ((to[0] - from[0]).abs().max((to[1] - from[1]).abs()) * FINE as f64).ceil().clamp(1.0, 1e5);
        for k in 0..=steps as usize {
            let s = k as f64 / steps;
            let at = [0, 1].map(|i| ((from[i] + s * (to[i] - from[i])) * FINE as f64) as i64);
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                self.set(at[0] + dx, at[1] + dy, colour);
            }
        }
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, corner: [f64; 2], size: [f64; 2], colour: Rgb) {
        let [x, y, w, h] = [corner[0], corner[1], size[0], size[1]].map(|v| (v * FINE as f64).round() as i64);
        for row in y..y + h {
            for column in x..x + w {
                self.set(column, row, colour);
            }
        }
    }

    /// Text, 8 pixels a letter wide and high, its upper left corner at `at`.
    pub fn text(&mut self, at: [f64; 2], text: &str, colour: Rgb) {
        let size = FINE as i64;
        for (k, letter) in text.chars().enumerate() {
            let glyph = font8x8::BASIC_FONTS.get(letter).unwrap_or([0; 8]);
            for (row, bits) in glyph.iter().enumerate() {
                for column in (0..8).filter(|c| bits >> c & 1 == 1) {
                    let x = (at[0] as i64 + 8 * k as i64 + column) * size;
                    let y = (at[1] as i64 + row as i64) * size;
                    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                        self.set(x + dx, y + dy, colour);
                    }
                }
            }
        }
    }

    /// Averages down and writes the file.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let wide = self.width * FINE;
        let mut pixels = Vec::with_capacity(self.width * self.height * 3);
        for y in 0..self.height {
            for x in 0..self.width {
                for channel in 0..3 {
                    let at = |i: usize, j: usize| {
                        u32::from(self.fine[(y * FINE + i) * wide + x * FINE + j][channel])
                    };
                    pixels.push(((at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1) + 2) / 4) as u8);
                }
            }
        }
        let file = File::create(path).map_err(|e| super::cannot_write(path, &e))?;
        let mut encoder = png::Encoder::new(BufWriter::new(file), self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fast);
        let written = encoder.write_header().and_then(|mut w| w.write_image_data(&pixels));
        written.map_err(|e| super::cannot_write(path, &e))
    }
}

/// Twice the signed area of a triangle.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
