//! Quadrature rules on the reference cells: all points inside, all weights positive.
//!
//! A rule is stored as the orbits of its points under the symmetries of the cell. Gauss-Legendre points are the roots
//! of the Legendre polynomials; the triangle rules are the fully symmetric ones of Dunavant (1985), *High degree
//! efficient symmetrical Gaussian quadrature rules for the triangle*, Int. J. Numer. Meth. Eng. 21, with the
//! coefficients solved again from the moment equations to the last digit of double precision.

use crate::Cell;

/// Points and weights that integrate polynomials up to `degree` over a reference cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature {
    /// Reference coordinates, `point x dimension`, row after row.
    pub points: Vec<f64>,
    /// One weight per point; they sum to [`Cell::measure`].
    pub weights: Vec<f64>,
    /// Highest total degree that is integrated exactly.
    pub degree: usize,
    /// Reference cell.
    pub cell: Cell,
}

impl Quadrature {
    /// Coordinates and weight of each point.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.points.chunks_exact(self.cell.dimension()).zip(self.weights.iter().copied())
    }

    /// Appends `points`, each with the fraction `w` of the cell as weight.
    fn push<const D: usize>(&mut self, w: f64, points: &[[f64; D]]) {
        self.points.extend(points.as_flattened());
        self.weights.extend(points.iter().map(|_| w * self.cell.measure()));
    }
}

/// The smallest rule on `cell` exact for polynomials of total degree `degree`; `None` beyond the table, which ends at
/// degree 11 on the segment and 8 on the triangle.
pub fn quadrature(cell: Cell, degree: usize) -> Option<Quadrature> {
    let rules = match cell {
        Cell::Segment => SEGMENT_RULES,
        Cell::Triangle => TRIANGLE_RULES,
    };
    let (degree, orbits) = rules.iter().find(|(exact, _)| *exact >= degree)?;
    let mut rule = Quadrature { points: Vec::new(), weights: Vec::new(), degree: *degree, cell };
    for orbit in *orbits {
        orbit.expand(&mut rule);
    }
    Some(rule)
}

/// Points that the symmetries of the cell turn into each other; the last number is the weight of each of them as a
/// fraction of the cell.
enum Orbit {
    /// The centre of the segment.
    Middle(f64),
    /// `x` and `1 - x` on the segment.
    Pair(f64, f64),
    /// The centroid of the triangle.
    Centroid(f64),
    /// Barycentric coordinates `(a, a, 1 - 2 a)` of the triangle in any order.
    Three(f64, f64),
    /// Barycentric coordinates `(a, b, 1 - a - b)` of the triangle in any order.
    Six(f64, f64, f64),
}

impl Orbit {
    /// Appends the points of the orbit to `rule`.
    fn expand(&self, rule: &mut Quadrature) {
        let third = 1.0 / 3.0;
        match *self {
            Orbit::Middle(w) => rule.push(w, &[[0.5]]),
            Orbit::Pair(x, w) => rule.push(w, &[[x], [1.0 - x]]),
            Orbit::Centroid(w) => rule.push(w, &[[third, third]]),
            Orbit::Three(a, w) => {
                let c = 1.0 - 2.0 * a;
                rule.push(w, &[[a, a], [c, a], [a, c]]);
            }
            Orbit::Six(a, b, w) => {
                let c = 1.0 - a - b;
                rule.push(w, &[[a, b], [b, a], [a, c], [c, a], [b, c], [c, b]]);
            }
        }
    }
}

/// Degree and orbits, by ascending degree.
type Rules = &'static [(usize, &'static [Orbit])];

const SEGMENT_RULES: Rules = &[
    (1, &[Orbit::Middle(1.0)]),
    (3, &[Orbit::Pair(0.2113248654051871, 0.5)]),
    (5, &[Orbit::Pair(0.11270166537925831, 0.2777777777777778), Orbit::Middle(0.4444444444444444)]),
    (
        7,
        &[
            Orbit::Pair(0.06943184420297371, 0.17392742256872692),
            Orbit::Pair(0.33000947820757187, 0.32607257743127305),
        ],
    ),
    (
        9,
        &[
            Orbit::Pair(0.046910077030668004, 0.11846344252809454),
            Orbit::Pair(0.23076534494715845, 0.23931433524968324),
            Orbit::Middle(0.28444444444444444),
        ],
    ),
    (
        11,
        &[
            Orbit::Pair(0.03376524289842399, 0.08566224618958518),
            Orbit::Pair(0.16939530676686773, 0.1803807865240693),
            Orbit::Pair(0.38069040695840156, 0.23395696728634552),
        ],
    ),
];

const TRIANGLE_RULES: Rules = &[
    (1, &[Orbit::Centroid(1.0)]),
    (2, &[Orbit::Three(0.16666666666666666, 0.3333333333333333)]),
    (
        4,
        &[
            Orbit::Three(0.4459484909159649, 0.22338158967801147),
            Orbit::Three(0.09157621350977074, 0.10995174365532187),
        ],
    ),
    (
        5,
        &[
            Orbit::Centroid(0.225),
            Orbit::Three(0.4701420641051151, 0.1323941527885062),
            Orbit::Three(0.10128650732345634, 0.12593918054482714),
        ],
    ),
    (
        6,
        &[
            Orbit::Three(0.24928674517091043, 0.11678627572637937),
            Orbit::Three(0.06308901449150223, 0.05084490637020682),
            Orbit::Six(0.053145049844816945, 0.3103524510337844, 0.08285107561837357),
        ],
    ),
    (
        8,
        &[
            Orbit::Centroid(0.14431560767778717),
            Orbit::Three(0.4592925882927232, 0.09509163426728462),
            Orbit::Three(0.1705693077517602, 0.10321737053471824),
            Orbit::Three(0.05054722831703098, 0.03245849762319808),
            Orbit::Six(0.2631128296346381, 0.008394777409957605, 0.027230314174434993),
        ],
    ),
];
