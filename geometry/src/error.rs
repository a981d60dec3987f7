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
        f.write_str(&self.fault())?;
        self.advice().map_or(Ok(()), |advice| write!(f, "; {advice}"))
    }
}

impl GeometryError {
    /// What is wrong, and where.
    pub fn fault(&self) -> String {
        use GeometryError as E;
        match self {
            E::EndOffCircle { name, centre, radius, to, reached } => format!(
                "arc `{name}` does not reach its end: {} is {} from the centre {}, its start {}",
                At(to),
                short(*reached),
                At(centre),
                short(*radius)
            ),
            E::CirclesApart { circles: [a, b], apart } => format!(
                "the circles about {} with radius {} and about {} with radius {} do not meet: their centres are {apart} apart",
                At(&a.0),
                a.1,
                At(&b.0),
                b.1
            ),
            E::NotFinite { name, from, to } => {
                format!("`{name}` from {} to {} is not made of finite numbers", At(from), At(to))
            }
            E::ZeroLength { name, at } => format!("`{name}` has no length: it starts and ends at {}", At(at)),
            E::NegativeRadius { name, r } => format!("`{name}` crosses the axis: it reaches r = {r}"),
            E::BrokenPath { path, gap } => format!("path `{path}` is broken: {gap}"),
            E::UnknownPart { region, part } => {
                format!("the loop of region `{region}` names `{part}`, which is no path or path.label")
            }
            E::NoAxis { region } => {
                format!("the loop of region `{region}` uses `axis`, but the model is not axisymmetric")
            }
            E::NotClosed { region, gap, .. } => format!("the loop of region `{region}` is not closed: {gap}"),
            E::Branch { region, names, at } => format!(
                "the loop of region `{region}` branches at {}, where `{}` meet",
                At(at),
                names.join("`, `")
            ),
            E::Crossing { names: [a, b], at } if a == b => format!("`{a}` crosses itself at {}", At(at)),
            E::Crossing { names: [a, b], at } => format!("`{a}` and `{b}` cross at {}", At(at)),
            E::Coincident { names: [a, b], at } => {
                format!("`{a}` and `{b}` run along each other near {}", At(at))
            }
            E::Overlap { regions: [a, b], at } => {
                format!("regions `{a}` and `{b}` overlap, e.g. at {}", At(at))
            }
        }
    }

    /// What to do about it, where that is not plain.
    pub fn advice(&self) -> Option<&'static str> {
        use GeometryError as E;
        Some(match self {
            E::EndOffCircle { .. } => "give an end on that circle, e.g. polar(centre, radius, angle)",
            E::CirclesApart { .. } => "change a radius or a centre",
            E::NotFinite { .. } => "check the parameters in its sqrt, acos and divisions",
            E::ZeroLength { .. } => "remove it or move an end",
            E::NegativeRadius { .. } => "keep it at r >= 0 in an axisymmetric model",
            E::BrokenPath { .. } => "start each segment where the one before it ends",
            E::UnknownPart { .. } => return None,
            E::NoAxis { .. } => "name a path instead",
            E::NotClosed { on_axis: true, .. } => "add `axis` to the loop",
            E::NotClosed { .. } => "let both share one point, or add the path between them",
            E::Branch { .. } => "list the parts of one closed loop",
            E::Crossing { names: [a, b], .. } if a == b => "keep it simple",
            E::Crossing { .. } => "move one of them, or split both there so that they share an end point",
            E::Coincident { .. } => "use one path for both regions there",
            E::Overlap { .. } => {
                "add the inner one's paths to the loop of the outer one, or move or drop one region"
            }
        })
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
pub(crate) struct At<'a>(pub &'a Point);

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", short(self.0[0]), short(self.0[1]))
    }
}

/// `x` rounded to six significant digits, without trailing zeros.
fn short(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x) + 0.0
}
