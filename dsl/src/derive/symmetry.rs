//! Whether a square matrix of expressions is symmetric, which decides how it is stored.

use crate::scalar::{Id, Pool, Symbol, eval};

/// How far two probed entries may differ, relative to the larger.
const TOLERANCE: f64 = 1e-10;
/// Number of points at which all entries must be finite and agree.
const POINTS: usize = 8;
/// Points tried before giving up on finding enough inside the domain.
const ATTEMPTS: u64 = 64;

/// What is known about `A = A^T`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Mirrored entries are the same expression: a proof.
    Structural,
    /// Mirrored entries agree at pseudo-random points: evidence, not a proof.
    Probed,
    /// Some pair of entries differs, or no points inside the domain were found.
    None,
}

/// Symmetry of the `n x n` matrix given by rows; `entries.len()` is `n^2`, any other length is [`Symmetry::None`].
///
/// Where mirrored entries are different expressions, both are evaluated at 8 fixed pseudo-random points with every symbol in
/// 0.5 .. 1.5. A matrix that is symmetric there and not elsewhere (a `Select` no point reaches) would be misjudged.
pub fn is_symmetric(pool: &Pool, entries: &[Id]) -> Symmetry {
    let n = entries.len().isqrt();
    if n * n != entries.len() {
        return Symmetry::None;
    }
    let pairs: Vec<(Id, Id)> = (0..n)
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .map(|(i, j)| (entries[i * n + j], entries[j * n + i]))
        .filter(|(a, b)| a != b)
        .collect();
    if pairs.is_empty() {
        return Symmetry::Structural;
    }
    let roots: Vec<Id> = pairs.iter().flat_map(|&(a, b)| [a, b]).collect();
    if agree(pool, &roots) { Symmetry::Probed } else { Symmetry::None }
}

/// Whether consecutive roots agree at enough points.
fn agree(pool: &Pool, roots: &[Id]) -> bool {
    let mut inside = 0;
    for attempt in 0..ATTEMPTS {
        let values = eval(pool, roots, &|symbol| probe(attempt, symbol));
        if values.iter().any(|v| !v.is_finite()) {
            continue;
        }
        if values.chunks_exact(2).any(|pair| differ(pair[0], pair[1])) {
            return false;
        }
        inside += 1;
        if inside == POINTS {
            return true;
        }
    }
    false
}

fn differ(a: f64, b: f64) -> bool {
    (a - b).abs() > TOLERANCE * a.abs().max(b.abs()).max(1e-300)
}

/// Pseudo-random value in 0.5 .. 1.5 (SplitMix64 of the attempt and the symbol).
fn probe(attempt: u64, symbol: Symbol) -> f64 {
    let mut bits = (attempt << 32 | u64::from(symbol.0)).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^= bits >> 31;
    0.5 + (bits >> 11) as f64 / (1u64 << 53) as f64
}
