//! Chains of nodes for tests.

use super::Point;

/// Nodes of `edges` quadratic edges on an arc (angles in radians), each edge `growth` times as long as the last.
pub fn arc(center: Point, radius: f64, [from, to]: [f64; 2], edges: usize, growth: f64) -> Vec<Point> {
    let lengths: Vec<f64> = (0..edges).map(|i| growth.powi(i as i32)).collect();
    let total: f64 = lengths.iter().sum();
    let mut angle = from;
    let at = |angle: f64| [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()];
    let mut nodes = vec![at(from)];
    for length in lengths {
        let step = 0.5 * (to - from) * length / total;
        nodes.extend([at(angle + step), at(angle + 2.0 * step)]);
        angle += 2.0 * step;
    }
    nodes
}

/// Nodes of `edges` quadratic edges on a closed circle, counterclockwise.
pub fn circle(center: Point, radius: f64, edges: usize) -> Vec<Point> {
    let mut nodes = arc(center, radius, [0.0, std::f64::consts::TAU], edges, 1.0);
    nodes.pop();
    nodes
}

/// Smooth deformation without symmetry, of a size near 0.1 over unit lengths.
pub fn deformed([x, y]: Point) -> Point {
    [x + 0.1 * (1.3 * y + 0.4 * x).sin() + 0.05 * x * y, y + 0.08 * (1.7 * x - 0.3 * y).cos() - 0.03 * x * x]
}

/// Derivative of a function of node positions by central differences, step 1e-6: error about 1e-9.
pub fn central<const N: usize>(
    positions: &[Point],
    (node, component): (usize, usize),
    function: impl Fn(&[Point]) -> [f64; N],
) -> [f64; N] {
    let step = 1e-6;
    let moved = |by: f64| {
        let mut positions = positions.to_vec();
        positions[node][component] += by;
        function(&positions)
    };
    let (plus, minus) = (moved(step), moved(-step));
    std::array::from_fn(|i| (plus[i] - minus[i]) / (2.0 * step))
}
