//! Binary tree of boxes, refitted to moving boxes, for nearest-first and overlap queries.

use super::Point;

/// Axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub lower: Point,
    /// Upper corner.
    pub upper: Point,
}

impl Bounds {
    /// Holds nothing, infinitely far from every point.
    pub const EMPTY: Self = Self { lower: [f64::INFINITY; 2], upper: [f64::NEG_INFINITY; 2] };

    /// Least box of some points.
    pub fn of(points: impl IntoIterator<Item = Point>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |bounds, point| bounds.union(Self { lower: point, upper: point }))
    }

    /// Least box of two boxes.
    pub fn union(self, other: Self) -> Self {
        Self {
            lower: [0, 1].map(|c| self.lower[c].min(other.lower[c])),
            upper: [0, 1].map(|c| self.upper[c].max(other.upper[c])),
        }
    }

    /// Box grown by a margin on all sides.
    pub fn grown(self, margin: f64) -> Self {
        Self { lower: self.lower.map(|x| x - margin), upper: self.upper.map(|x| x + margin) }
    }

    fn overlaps(self, other: Self) -> bool {
        (0..2).all(|c| self.lower[c] <= other.upper[c] && other.lower[c] <= self.upper[c])
    }

    fn distance(self, point: Point) -> f64 {
        let [x, y] = [0, 1].map(|c| (self.lower[c] - point[c]).max(point[c] - self.upper[c]).max(0.0));
        (x * x + y * y).sqrt()
    }
}

/// Complete binary tree over a sequence of boxes in which neighbours are close to each other.
///
/// Box 1 is the root, boxes 2 i and 2 i + 1 are the children of box i; leaves are padded with empty boxes.
#[derive(Clone, Debug)]
pub struct BoxTree {
    boxes: Vec<Bounds>,
}

impl BoxTree {
    /// Tree of a number of empty boxes.
    pub fn new(count: usize) -> Self {
        Self { boxes: vec![Bounds::EMPTY; 2 * count.next_power_of_two()] }
    }

    /// Sets the boxes, as many as the tree was made for, in their order.
    pub fn refit(&mut self, leaves: impl IntoIterator<Item = Bounds>) {
        let first = self.boxes.len() / 2;
        for (slot, leaf) in self.boxes[first..].iter_mut().zip(leaves) {
            *slot = leaf;
        }
        for i in (1..first).rev() {
            self.boxes[i] = self.boxes[2 * i].union(self.boxes[2 * i + 1]);
        }
    }

    /// Calls `visit(leaf)` for leaves within a distance of a point, nearer boxes first; `visit` returns the distance
    /// that counts from then on (never a greater one).
    pub fn visit_nearest(&self, point: Point, distance: f64, mut visit: impl FnMut(usize) -> f64) {
        if !point.iter().all(|x| x.is_finite()) {
            return;
        }
        let mut limit = distance;
        let mut stack = vec![1];
        while let Some(i) = stack.pop() {
            let distance = self.boxes[i].distance(point);
            if distance > limit || distance == f64::INFINITY {
                continue;
            }
            if let Some(leaf) = i.checked_sub(self.boxes.len() / 2) {
                limit = visit(leaf);
            } else {
                let [left, right] = [2 * i, 2 * i + 1];
                let left_first = self.boxes[left].distance(point) <= self.boxes[right].distance(point);
                stack.extend(if left_first { [right, left] } else { [left, right] });
            }
        }
    }

    /// Leaves whose boxes overlap a box, ascending.
    pub fn overlapping(&self, bounds: Bounds) -> Vec<usize> {
        let (mut leaves, mut stack) = (Vec::new(), vec![1]);
        while let Some(i) = stack.pop() {
            if !self.boxes[i].overlaps(bounds) {
                continue;
            }
            match i.checked_sub(self.boxes.len() / 2) {
                Some(leaf) => leaves.push(leaf),
                None => stack.extend([2 * i + 1, 2 * i]),
            }
        }
        leaves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares() -> BoxTree {
        let mut tree = BoxTree::new(5);
        let corner = |i: usize| [3.0 * i as f64, 0.0];
        tree.refit((0..5).map(|i| Bounds::of([corner(i), [corner(i)[0] + 1.0, 1.0]])));
        tree
    }

    #[test]
    fn nearer_boxes_come_first_and_farther_ones_are_left_out() {
        let mut order = Vec::new();
        squares().visit_nearest([7.2, 0.5], 4.0, |leaf| {
            order.push(leaf);
            4.0
        });
        assert_eq!(order[0], 2);
        order.sort_unstable();
        assert_eq!(order, [1, 2, 3]);
    }

    #[test]
    fn a_lower_limit_ends_the_visit() {
        let mut count = 0;
        squares().visit_nearest([7.2, 0.5], f64::INFINITY, |_| {
            count += 1;
            0.5
        });
        assert_eq!(count, 1);
    }

    #[test]
    fn overlap_finds_boxes_in_order() {
        let tree = squares();
        assert_eq!(tree.overlapping(Bounds::of([[3.5, 0.5], [9.5, 0.6]])), [1, 2, 3]);
        assert_eq!(tree.overlapping(Bounds::of([[1.5, 0.5]]).grown(0.6)), [0]);
        assert!(BoxTree::new(3).overlapping(Bounds::of([[0.0, 0.0]])).is_empty());
    }
}
