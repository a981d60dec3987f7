//! What can be wrong with a geometry, as data; displayed as what, where and what now.

use crate::point::{self, Point};
use std::fmt;

/// Two ends that should be one point and are not.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// Segment on one side, and where it ends.
    pub from: (String, Point),
    /// Segment on the other side, and where it ends; none where no other end is free.
    pub to: Option<(String, Point)>,
}

/// One fault of a geometry. Positions and lengths are in coherent model units.
#[derive(Debug, Clone, PartialEq)]
pub enum GeometryError {
    /// The end of an arc is not on the circle that its start defines.
    EndOffCircle {
        /// Path or `path.label`.
        name: String,
        /// Centre of the circle.
        centre: Point,
        /// Distance of the start from the centre.
        radius: f64,
        /// End as given.
        to: Point,
        /// Distance of the end from the centre.
        reached: f64,
    },
    /// `intersect` of two circles that have no common point.
    CirclesApart {
        /// Centre and radius of each.
        circles: [(Point, f64); 2],
        /// Distance between the centres.
        apart: f64,
    },
    /// A coordinate is not a number, or infinite.
    NotFinite {
        /// Path or `path.label`.
        name: String,
        /// Its start as evaluated.
        from: Point,
        /// Its end as evaluated.
        to: Point,
    },
    /// A line or arc without extent.
    ZeroLength {
        /// Path or `path.label`.
        name: String,
        /// Where it is.
        at: Point,
    },
    /// A curve reaches across the line of symmetry.
    NegativeRadius {
        /// Path or `path.label`.
        name: String,
        /// Smallest first coordinate reached.
        r: f64,
    },
    /// A segment does not start where the one before it ends.
    BrokenPath {
        /// Name of the path.
        path: String,
        /// The two ends.
        gap: Gap,
    },
    /// A loop names a path or segment that does not exist.
    UnknownPart {
        /// Region with the loop.
        region: String,
        /// Name as written.
        part: String,
    },
    /// A loop uses `axis` in a model without a line of symmetry.
    NoAxis {
        /// Region with the loop.
        region: String,
    },
    /// A loop does not close.
    NotClosed {
        /// Region with the loop.
        region: String,
        /// The two ends closest to each other.
        gap: Gap,
        /// Whether `axis` would close it.
        on_axis: bool,
    },
    /// More than two ends of a loop meet in one point.
    Branch {
        /// Region with the loop.
        region: String,
        /// The segments that meet.
        names: Vec<String>,
        /// Where they meet.
        at: Point,
    },
    /// Two curves meet elsewhere than at a shared end point.
    Crossing {
        /// Path or `path.label` of each.
        names: [String; 2],
        /// One point where they meet.
        at: Point,
    },
    /// Two curves run along each other.
    Coincident {
        /// Path or `path.label` of each.
        names: [String; 2],
        /// One point on both.
        at: Point,
    },
    /// Two regions cover the same ground.
    Overlap {
        /// The regions.
        regions: [String; 2],
        /// A point within both.
        at: Point,
    },
}

impl std::error::Error for GeometryError {}

impl fmt::Display for GeometryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use GeometryError as E;
        match self {
            E::EndOffCircle { name, centre, radius, to, reached } => write!(
                f,
                "arc `{name}` does not reach its end: {} is {reached} from the centre {}, its start {radius}; \
                 give an end on that circle, e.g. polar(centre, radius, angle)",
                At(to),
                At(centre)
            ),
            E::CirclesApart { circles: [a, b], apart } => write!(
                f,
                "the circles about {} with radius {} and about {} with radius {} do not meet: their centres are \
                 {apart} apart; change a radius or a centre",
                At(&a.0),
                a.1,
                At(&b.0),
                b.1
            ),
            E::NotFinite { name, from, to } => write!(
                f,
                "`{name}` from {} to {} is not made of finite numbers; check the parameters in its sqrt, acos and \
                 divisions",
                At(from),
                At(to)
            ),
            E::ZeroLength { name, at } => {
                write!(
                    f,
                    "`{name}` has no length: it starts and ends at {}; remove it or move an end",
                    At(at)
                )
            }
            E::NegativeRadius { name, r } => write!(
                f,
                "`{name}` crosses the axis: it reaches r = {r}; keep it at r >= 0 in an axisymmetric model"
            ),
            E::BrokenPath { path, gap } => {
                write!(f, "path `{path}` is broken: {gap}; start each segment where the one before it ends")
            }
            E::UnknownPart { region, part } => {
                write!(f, "the loop of region `{region}` names `{part}`, which is no path or path.label")
            }
            E::NoAxis { region } => write!(
                f,
                "the loop of region `{region}` uses `axis`, but the model is not axisymmetric; name a path instead"
            ),
            E::NotClosed { region, gap, on_axis } => {
                let remedy = match on_axis {
                    true => "add `axis` to the loop",
                    false => "let both share one point, or add the path between them",
                };
                write!(f, "the loop of region `{region}` is not closed: {gap}; {remedy}")
            }
            E::Branch { region, names, at } => write!(
                f,
                "the loop of region `{region}` branches at {}, where `{}` meet; list the parts of one closed loop",
                At(at),
                names.join("`, `")
            ),
            E::Crossing { names: [a, b], at } if a == b => {
                write!(f, "`{a}` crosses itself at {}; keep it simple", At(at))
            }
            E::Crossing { names: [a, b], at } => write!(
                f,
                "`{a}` and `{b}` cross at {}; move one of them, or split both there so that they share an end point",
                At(at)
            ),
            E::Coincident { names: [a, b], at } => write!(
                f,
                "`{a}` and `{b}` run along each other near {}; use one path for both regions there",
                At(at)
            ),
            E::Overlap { regions: [a, b], at } => write!(
                f,
                "regions `{a}` and `{b}` overlap, e.g. at {}; add the inner one's paths to the loop of the outer one, \
                 or drop one region",
                At(at)
            ),
        }
    }
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, p) = &self.from;
        match &self.to {
            Some((other, q)) => write!(
                f,
                "a gap of {:.3e} between the end {} of `{name}` and the end {} of `{other}`",
                point::distance(*p, *q),
                At(p),
                At(q)
            ),
            None => write!(f, "nothing meets the end {} of `{name}`", At(p)),
        }
    }
}

/// A position with six significant digits.
struct At<'a>(&'a Point);

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", short(self.0[0]), short(self.0[1]))
    }
}

/// `x` rounded to six significant digits, without trailing zeros.
fn short(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x) + 0.0
}
