//! Points and vectors of the plane as plain pairs, with the few operations the geometry needs.

/// A point or vector `[x, y]` (`[r, z]` in axisymmetric models), in coherent model units.
pub type Point = [f64; 2];

/// `a + b`.
pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1]]
}

/// `a - b`.
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// `factor * a`.
pub fn scale(a: Point, factor: f64) -> Point {
    [a[0] * factor, a[1] * factor]
}

/// Scalar product.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Third component of the vector product: positive where `b` points left of `a`.
pub fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Euclidean length.
pub fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Distance between two points.
pub fn distance(a: Point, b: Point) -> f64 {
    norm(sub(a, b))
}

/// `a + s*(b - a)`: `a` at `s = 0`, `b` at `s = 1`.
pub fn lerp(a: Point, b: Point, s: f64) -> Point {
    [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
}

/// Mean of the corners of a triangle.
pub fn centroid([a, b, c]: [Point; 3]) -> Point {
    scale(add(a, add(b, c)), 1.0 / 3.0)
}

/// The vector turned left by a right angle.
pub fn left(a: Point) -> Point {
    [-a[1], a[0]]
}

/// Whether both coordinates are finite numbers.
pub fn is_finite(a: Point) -> bool {
    a[0].is_finite() && a[1].is_finite()
}

/// Smallest box around points: `[lower left, upper right]`; infinite and inverted where there are none.
pub fn bounds<'a>(points: impl IntoIterator<Item = &'a Point>) -> [Point; 2] {
    let empty = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.into_iter().fold(empty, |[low, high], p| {
        [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
    })
}
