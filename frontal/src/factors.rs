//! Factors of matrices with one pattern: storage that is kept, and the walk over the fronts that fills it.

use crate::analysis::{Analysis, Front};
use crate::error::Error;
use crate::front::{Blocks, Scratch, assemble, eliminate};
use crate::pattern::{Kind, Pattern};
use crate::pivot::{Pivots, Threshold};
use crate::schedule::{Place, Schedule};

/// Pivots of a scaled matrix below this are rounding errors.
const ZERO_PIVOT: f64 = 1e-13;
/// What replaces them.
const SUBSTITUTE: f64 = 1e-8;

/// Factors of a matrix.
pub struct Factors {
    pub(crate) analysis: Analysis,
    pub(crate) values: Vec<f64>,
    /// Row that every column changed places with, counted from the first of its front.
    pub(crate) exchanges: Vec<u32>,
    pub(crate) schedule: Schedule,
    sites: Vec<Site>,
    /// Factorisations so far.
    factorisations: usize,
    /// Right-hand sides in the order of elimination, the numbers of an equation side by side.
    pub(crate) work: Vec<f64>,
}

/// Memory for the fronts that are eliminated one after the other.
struct Site {
    stacks: [Vec<f64>; 2],
    scratch: Scratch,
}

/// A front and where its factors go.
type Task<'a> = (usize, &'a mut [f64], &'a mut [u32]);

/// A matrix to factor.
#[derive(Clone, Copy)]
struct Job<'a> {
    analysis: &'a Analysis,
    places: &'a [Place],
    entries: &'a [f64],
    threshold: Threshold,
}

impl Factors {
    /// Allocates all memory that factorisations and solves with one right-hand side need.
    ///
    /// # Errors
    /// [`Error::TooLarge`].
    pub fn new(analysis: Analysis) -> Result<Self, Error> {
        Self::with_threads(analysis, 1)
    }

    /// As [`Self::new`], for factorisations and solutions on several threads.
    ///
    /// Results differ from those on one thread by no more than the order of sums inside large products and from separate subtrees.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_threads(analysis: Analysis, threads: usize) -> Result<Self, Error> {
        let schedule = Schedule::new(&analysis, threads);
        let site = |[first, second]: &[usize; 2]| {
            Ok(Site { stacks: [zeros(*first)?, zeros(*second)?], scratch: Scratch::default() })
        };
        Ok(Self {
            values: zeros(analysis.values)?,
            exchanges: vec![0; analysis.size()],
            sites: schedule.stacks.iter().map(site).collect::<Result<_, Error>>()?,
            schedule,
            factorisations: 0,
            work: Vec::new(),
            analysis,
        })
    }

    /// The same for factorisations on some number of threads; if it changes, the matrix is to be factored anew.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on_threads(self, threads: usize) -> Result<Self, Error> {
        if threads == self.threads() {
            return Ok(self);
        }
        let factorisations = self.factorisations;
        Ok(Self { factorisations, ..Self::with_threads(self.analysis, threads)? })
    }

    /// Structure of the factors.
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// Threads that factorisations use.
    pub fn threads(&self) -> usize {
        (self.sites.len() - 1).max(1)
    }

    /// Looks for a better order of elimination once so much was factored that it is worth the time: to be called before a factorisation, with
    /// the pattern and the weak unknowns of [`Analysis::new`]. The same sequence of calls gives the same orders.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn reorder(&mut self, pattern: Pattern<'_>, weak: &[u32]) -> Result<(), Error> {
        if self.analysis.deserves_effort(self.factorisations) {
            *self = Self::with_threads(Analysis::thorough(pattern, weak)?, self.threads())?;
        }
        Ok(())
    }

    /// Factors the matrix with `entries` at the positions of the pattern, the largest near one.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for Cholesky.
    pub fn factor(&mut self, entries: &[f64]) -> Result<Pivots, Error> {
        self.factorisations += 1;
        let threads = self.threads();
        let largest = largest_magnitude(entries);
        let threshold = Threshold { zero: ZERO_PIVOT * largest, substitute: SUBSTITUTE * largest };
        let job = Job { analysis: &self.analysis, places: &self.schedule.places, entries, threshold };
        let mut tasks = tasks(&self.schedule, &self.analysis, &mut self.values, &mut self.exchanges);
        let (Some((last, workers)), Some(last_tasks)) = (self.sites.split_last_mut(), tasks.pop()) else {
            return Err(Error::NoEquations);
        };
        let shares = std::thread::scope(|scope| {
            let start = |(tasks, site)| scope.spawn(move || job.run(tasks, site, &[], 1));
            let running: Vec<_> = tasks.into_iter().zip(&mut *workers).map(start).collect();
            running.into_iter().map(|share| share.join()).collect::<Vec<_>>()
        });
        let mut outcome = Ok(Pivots::NONE);
        for share in shares {
            let share = share.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            outcome = merge(outcome, share);
        }
        if outcome.is_ok() {
            outcome = merge(outcome, job.run(last_tasks, last, workers, threads));
        }
        outcome.map_err(|turn| Error::NotPositive { equation: self.analysis.order[turn] as usize })
    }

    /// Blocks of a front.
    pub(crate) fn blocks(&self, front: &Front) -> (&[f64], &[f64], &[f64]) {
        let (square, rest) = self.values[front.values.clone()].split_at(front.width * front.width);
        let (below, rest) = rest.split_at(front.width * front.padded());
        let right = if self.analysis.kind == Kind::Unsymmetric { rest } else { below };
        (square, below, &right[..below.len()])
    }
}

impl Job<'_> {
    /// Eliminates fronts one after the other; `done` holds the sites of other children.
    ///
    /// # Errors
    /// The turn of a pivot of Cholesky that is not positive.
    fn run(
        self,
        tasks: Vec<Task<'_>>,
        site: &mut Site,
        done: &[Site],
        threads: usize,
    ) -> Result<Pivots, usize> {
        let mut pivots = Pivots::NONE;
        for task in tasks {
            pivots = pivots.and(self.eliminate(task, site, done, threads)?);
        }
        Ok(pivots)
    }

    fn eliminate(
        self,
        (k, values, exchanges): Task<'_>,
        site: &mut Site,
        done: &[Site],
        threads: usize,
    ) -> Result<Pivots, usize> {
        let analysis = self.analysis;
        let (front, place) = (&analysis.fronts[k], self.places[k]);
        let [even, odd] = &mut site.stacks;
        let (own, others) = if place.stack == 0 { (even, odd) } else { (odd, even) };
        let remainder = &mut own[place.offset..][..front.remainder()];
        values.fill(0.0);
        for &(source, target) in &analysis.entries[front.entries.clone()] {
            values[target as usize] += self.entries[source as usize];
        }
        let mut blocks = Blocks::of(front, analysis.kind, values);
        let fresh = front.children.is_empty();
        if !fresh {
            remainder.fill(0.0);
        }
        for child in analysis.children(front) {
            let Place { site, stack, offset } = self.places[child];
            let child = &analysis.fronts[child];
            let stack = if site == place.site { &*others } else { &done[site].stacks[stack] };
            let source = &stack[offset..][..child.remainder()];
            assemble(analysis, (front, &mut blocks, remainder), (child, source));
        }
        let remainder = (remainder, fresh);
        eliminate(
            front,
            analysis.kind,
            blocks,
            remainder,
            (exchanges, self.threshold),
            &mut site.scratch,
            threads,
        )
    }
}

/// The fronts of every site.
fn tasks<'a>(
    schedule: &Schedule,
    analysis: &Analysis,
    mut values: &'a mut [f64],
    mut exchanges: &'a mut [u32],
) -> Vec<Vec<Task<'a>>> {
    let list = |site: &Vec<u32>| Vec::with_capacity(site.len());
    let mut tasks: Vec<Vec<Task<'a>>> = schedule.sites.iter().map(list).collect();
    for (k, (front, place)) in analysis.fronts.iter().zip(&schedule.places).enumerate() {
        let (own, rest) = values.split_at_mut(front.values.len());
        let (rows, others) = exchanges.split_at_mut(front.width);
        tasks[place.site].push((k, own, rows));
        (values, exchanges) = (rest, others);
    }
    tasks
}

/// Pivots of two parts; the earlier failure.
fn merge(a: Result<Pivots, usize>, b: Result<Pivots, usize>) -> Result<Pivots, usize> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok(a.and(b)),
        (Err(a), Err(b)) => Err(a.min(b)),
        (Err(turn), _) | (_, Err(turn)) => Err(turn),
    }
}

/// The largest magnitude, found in several places at a time.
fn largest_magnitude(entries: &[f64]) -> f64 {
    let (chunks, rest) = entries.as_chunks::<8>();
    let mut largest = [0.0_f64; 8];
    for chunk in chunks {
        largest.iter_mut().zip(chunk).for_each(|(largest, entry)| *largest = largest.max(entry.abs()));
    }
    largest.iter().chain(rest).fold(0.0, |largest, entry| largest.max(entry.abs()))
}

/// Zeros, or an error instead of an abort when memory does not suffice.
fn zeros(length: usize) -> Result<Vec<f64>, Error> {
    // What was just reserved and given back is there; memory that comes as zeros is not touched before it is used.
    Vec::<f64>::new().try_reserve_exact(length).map_err(|_| Error::TooLarge)?;
    Ok(vec![0.0; length])
}
