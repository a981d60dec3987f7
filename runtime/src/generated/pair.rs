//! What the compiler says about contact pairs: their surfaces, energies of the gap, loads on the surfaces.

/// Two surfaces that may meet. Both sides are lists of paths or segments; the bodies lie on the side that their regions say.
#[allow(missing_docs)]
pub struct Pair {
    pub name: &'static str,
    pub first: &'static [&'static str],
    pub second: &'static [&'static str],
    /// Displacement field of the surfaces.
    pub displacement: usize,
    pub search: fn(g: &[f64]) -> f64,
}

/// `size = f(pair.gap) on pair`: upper bound on the size of the cells that touch these surfaces in regions that move.
#[allow(missing_docs)]
pub struct GapSize {
    /// Index into the program's pairs.
    pub pair: usize,
    pub sides: Sides,
    /// Of the gap and the parameters.
    pub size: PairValue,
}

/// Which surfaces of a pair are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Sides {
    First,
    Second,
    Both,
}

impl Sides {
    /// Whether the first (0) or second (1) surface is meant.
    pub fn has(self, side: usize) -> bool {
        matches!((self, side), (Self::Both, _) | (Self::First, 0) | (Self::Second, 1))
    }
}

/// `energy W(pair.gap) on pair.first`, per reference area.
pub struct PairIntegral {
    /// What it is.
    pub name: &'static str,
    /// Where it stands.
    pub place: &'static str,
    /// Physics block.
    pub block: usize,
    /// Pair.
    pub pair: usize,
    /// Surfaces over which it is integrated.
    pub sides: Sides,
    /// (W, dW/dg, d2W/dg2) per reference area of the slave side, at reference point x.
    pub law: fn(gap: f64, x: [f64; 2], g: &[f64]) -> [f64; 3],
}

/// `load u with f on pair`: virtual work at the points of surfaces that the other one faces within the search distance.
pub struct PairLoad {
    /// What it is.
    pub name: &'static str,
    /// Where it stands.
    pub place: &'static str,
    /// Physics block.
    pub block: usize,
    /// Pair.
    pub pair: usize,
    /// Surfaces on which it acts.
    pub sides: Sides,
    /// Per area as it has moved, else per reference area.
    pub current: bool,
    /// Writes four vectors: the flux against the displacement (minus the force per area), and its derivatives by the gap and by both components
    /// of the normal.
    pub law: PairForce,
    /// Derivative of the flux with respect to states and functionals.
    pub global_tangent: Option<PairGlobalTangent>,
}

/// Derivative of the flux of a [`PairLoad`] with respect to some states and functionals.
pub struct PairGlobalTangent {
    /// Which ones: the states are numbered first, then the functionals.
    pub slots: &'static [usize],
    /// Writes one vector for each of them, its rate included with `alpha`.
    pub law: PairForceRate,
}

/// Writes vectors at a point of a pair: of reference position x, on a surface with this unit normal (out of its body, as it has moved).
pub type PairForce = fn(gap: f64, normal: [f64; 2], x: [f64; 2], g: &[f64], out: &mut [[f64; 2]]);
/// The same with `alpha`.
pub type PairForceRate =
    fn(gap: f64, normal: [f64; 2], x: [f64; 2], g: &[f64], alpha: f64, out: &mut [[f64; 2]]);
/// A value at a point of a pair, as for [`PairForce`].
pub type PairValue = fn(gap: f64, normal: [f64; 2], x: [f64; 2], g: &[f64]) -> f64;
