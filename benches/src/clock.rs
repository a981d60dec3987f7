//! Time that this thread spent computing, so that neighbours on a shared machine count little; for several threads, time on the clock.

use std::time::Instant;

/// Runs of which the median is taken.
const RUNS: usize = 7;
/// Least time of one run [s]: long against the ticks of the system's account.
const LEAST: f64 = 0.2;

/// A point in time from which computing time is counted.
pub struct Clock {
    wall: Instant,
    account: Option<f64>,
}

impl Clock {
    /// Starts counting.
    pub fn start() -> Self {
        Self { wall: Instant::now(), account: account() }
    }

    /// Starts counting what some threads do together: time on the clock if it is more than one.
    pub fn on(threads: usize) -> Self {
        let clock = Self::start();
        if threads > 1 { Self { account: None, ..clock } } else { clock }
    }

    /// Seconds of computing since the start; of waiting too where the system keeps no account.
    pub fn seconds(&self) -> f64 {
        match (self.account, account()) {
            (Some(start), Some(now)) => now - start,
            _ => self.wall.elapsed().as_secs_f64(),
        }
    }
}

/// Seconds that the scheduler gave this thread so far (Linux).
fn account() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

/// Median time of one call \[s\], after a first call that does not count.
pub fn median(mut call: impl FnMut()) -> f64 {
    call();
    let mut times: Vec<f64> = (0..RUNS).map(|_| mean_of_a_run(&mut call)).collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2]
}

/// Time of one call that uses some threads \[s\]: the median computing time on one, the least on the clock on several, to which waiting for
/// neighbours on the machine only adds.
pub fn time_on(threads: usize, mut call: impl FnMut()) -> f64 {
    if threads == 1 {
        return median(call);
    }
    let (start, mut least) = (Instant::now(), f64::INFINITY);
    while start.elapsed().as_secs_f64() < RUNS as f64 * LEAST {
        let wall = Instant::now();
        call();
        least = least.min(wall.elapsed().as_secs_f64());
    }
    least
}

/// Mean time of as many calls as the least time takes.
fn mean_of_a_run(call: &mut impl FnMut()) -> f64 {
    let (clock, wall, mut calls) = (Clock::start(), Instant::now(), 0);
    while calls == 0 || wall.elapsed().as_secs_f64() < LEAST {
        call();
        calls += 1;
    }
    clock.seconds() / f64::from(calls)
}
