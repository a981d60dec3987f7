//! Arrows of a vector over a picture: one in each square of a raster, so that they do not hide each other.

use super::canvas::{Canvas, Rgb};
use std::collections::BTreeMap;

/// Width of a square of the raster [pixels].
const RASTER: f64 = 16.0;
/// Length of the longest arrow [pixels].
const LONGEST: f64 = 24.0;
/// Shorter ones are left out [pixels].
const SHORTEST: f64 = 6.0;
/// Length of the two strokes of the head, as a part of the arrow.
const HEAD: f64 = 0.35;
/// Cosine and sine of the angle between head and shaft.
const SPREAD: [f64; 2] = [0.866, 0.5];

/// A pixel and a vector there, or the shaft drawn for it.
type Arrow = ([f64; 2], [f64; 2]);

/// Draws vectors at pixels, y upwards in the vectors.
pub fn draw(canvas: &mut Canvas, vectors: &[Arrow], ink: Rgb) {
    shafts(vectors).into_iter().for_each(|(at, shaft)| arrow(canvas, at, shaft, ink));
}

/// The arrows to be drawn, y downwards: in each square of the raster the one nearest to its middle. Lengths follow the square root of the magnitude,
/// so that slow parts show their direction too; the largest vector gets the full length.
fn shafts(vectors: &[Arrow]) -> Vec<Arrow> {
    let largest = vectors.iter().map(|(_, v)| v[0].hypot(v[1])).fold(0.0, f64::max);
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec::new();
    }
    let shaft = |k: usize| {
        let (at, vector) = vectors[k];
        let magnitude = vector[0].hypot(vector[1]);
        let length = LONGEST * (magnitude / largest).sqrt();
        (length >= SHORTEST).then(|| (at, [vector[0], -vector[1]].map(|x| x * length / magnitude)))
    };
    spread(vectors).into_iter().filter_map(shaft).collect()
}

/// The vector nearest to the middle of each square of the raster.
fn spread(vectors: &[Arrow]) -> Vec<usize> {
    let mut squares: BTreeMap<[i64; 2], (f64, usize)> = BTreeMap::new();
    for (k, (at, _)) in vectors.iter().enumerate() {
        let square = at.map(|x| (x / RASTER).floor() as i64);
        let off = [0, 1].map(|i| at[i] / RASTER - square[i] as f64 - 0.5);
        let distance = off[0].hypot(off[1]);
        let nearest = squares.entry(square).or_insert((distance, k));
        if distance < nearest.0 {
            *nearest = (distance, k);
        }
    }
    squares.into_values().map(|(_, k)| k).collect()
}

/// An arrow centred at `at`, in ink on a light seam.
fn arrow(canvas: &mut Canvas, at: [f64; 2], shaft: [f64; 2], ink: Rgb) {
    let [tail, tip] = [-0.5, 0.5].map(|s| [0, 1].map(|i| at[i] + s * shaft[i]));
    let [c, s] = SPREAD.map(|x| x * HEAD);
    let stroke = |side: f64| {
        [tip[0] - c * shaft[0] + side * s * shaft[1], tip[1] - c * shaft[1] - side * s * shaft[0]]
    };
    let lines = [(tail, tip), (tip, stroke(1.0)), (tip, stroke(-1.0))];
    for (from, to) in lines {
        for shift in [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]] {
            let moved = |p: [f64; 2]| [p[0] + shift[0], p[1] + shift[1]];
            canvas.line(moved(from), moved(to), [255; 3]);
        }
    }
    lines.into_iter().for_each(|(from, to)| canvas.line(from, to, ink));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_arrow_a_square_and_none_too_short_to_be_seen() {
        let at = |x: f64| [x, 0.5 * RASTER];
        let vectors = [
            (at(0.4 * RASTER), [0.0, 4.0]),
            (at(0.1 * RASTER), [3.0, 0.0]),
            (at(1.5 * RASTER), [1.0, 0.0]),
            (at(2.5 * RASTER), [0.01, 0.0]),
        ];
        let drawn = shafts(&vectors);
        assert_eq!(drawn.len(), 2, "the second shares its square with the first, the last is slow");
        assert_eq!(drawn[0], (vectors[0].0, [0.0, -LONGEST]), "pixels count downwards");
        assert_eq!(drawn[1].1, [0.5 * LONGEST, 0.0], "a quarter of the speed, half of the length");
    }

    #[test]
    fn nothing_that_moves_is_no_arrow() {
        assert!(shafts(&[([8.0, 8.0], [0.0, 0.0])]).is_empty());
        assert!(shafts(&[]).is_empty());
    }
}
