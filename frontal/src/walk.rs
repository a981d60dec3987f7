//! Forward and back substitution with all fronts, separate subtrees on threads of their own.

use crate::factors::Factors;
use std::thread;

/// Factors with fewer entries than this are not worth threads.
const WORTHWHILE: usize = 200_000;

/// What stands for one equation: the number of one right-hand side, or those of several.
pub(crate) trait Entry: Copy + Send + Sync {
    /// Nothing.
    const ZERO: Self;
    /// Adds number by number.
    fn add(&mut self, other: &Self);
    /// Forward substitution with some fronts, one after the other.
    fn forward(factors: &Factors, fronts: &[u32], x: &mut [Self]);
    /// Back substitution with some fronts, the last one first.
    fn back(factors: &Factors, fronts: &[u32], x: &mut [Self]);
}

impl Factors {
    /// Solves in place, equations in the order of elimination.
    pub(crate) fn walk<T: Entry>(&self, x: &mut [T]) {
        let Some((above, shares)) = self.schedule.sites.split_last() else { return };
        let mut parts: Vec<Vec<T>> = shares.iter().map(|_| vec![T::ZERO; x.len()]).collect();
        let given = &*x;
        self.for_shares(shares, &mut parts, &|share: &[u32], part: &mut [T]| {
            self.for_own(share, |own| part[own.clone()].copy_from_slice(&given[own]));
            T::forward(self, share, part);
        });
        for (share, part) in shares.iter().zip(&parts) {
            self.for_own(share, |own| x[own.clone()].copy_from_slice(&part[own]));
            self.for_own(above, |own| x[own.clone()].iter_mut().zip(&part[own]).for_each(|(x, y)| x.add(y)));
        }
        T::forward(self, above, x);
        T::back(self, above, x);
        let solved = &*x;
        self.for_shares(shares, &mut parts, &|share: &[u32], part: &mut [T]| {
            self.for_own(above, |own| part[own.clone()].copy_from_slice(&solved[own]));
            T::back(self, share, part);
        });
        for (share, part) in shares.iter().zip(&parts) {
            self.for_own(share, |own| x[own.clone()].copy_from_slice(&part[own]));
        }
    }

    /// Calls `visit` with the unknowns that each of some fronts eliminates.
    fn for_own(&self, fronts: &[u32], mut visit: impl FnMut(std::ops::Range<usize>)) {
        for &front in fronts {
            let front = &self.analysis.fronts[front as usize];
            visit(front.first..front.first + front.width);
        }
    }

    /// Does a job for every share, the first on this thread, and all of them if threads would not pay.
    fn for_shares<T: Entry>(
        &self,
        shares: &[Vec<u32>],
        parts: &mut [Vec<T>],
        job: &(impl Fn(&[u32], &mut [T]) + Sync),
    ) {
        let alone = self.analysis.factor_entries() < WORTHWHILE;
        thread::scope(|scope| {
            for (k, (share, part)) in shares.iter().zip(parts).enumerate().rev() {
                if alone || k == 0 {
                    job(share, part);
                } else {
                    scope.spawn(move || job(share, part));
                }
            }
        });
    }
}
