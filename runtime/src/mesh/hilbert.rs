//! Position along a Hilbert curve: points close to each other in the plane mostly stay close in this order.

use ansatz_geometry::Point;

/// Bits for each coordinate.
const BITS: u32 = 16;

/// Index along the Hilbert curve through the box `[low, high]`.
pub(crate) fn hilbert_index(p: Point, [low, high]: [Point; 2]) -> u32 {
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    let cells = f64::from((1u32 << BITS) - 1);
    let [mut x, mut y] = [0, 1].map(|k| ((p[k] - low[k]) / side * cells) as u32);
    let mut index = 0;
    for level in (0..BITS).rev() {
        let (right, upper) = ((x >> level) & 1, (y >> level) & 1);
        index = index << 2 | ((3 * right) ^ upper);
        if upper == 0 {
            if right == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    index
}
