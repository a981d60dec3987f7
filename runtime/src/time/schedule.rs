//! When something periodic is due: at multiples of a period, or at the end of every step.

/// Part of a period by which a time may miss a multiple and still count as it.
const SLACK: f64 = 1e-9;

/// Times that are due, in order.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// `None`: every step.
    period: Option<f64>,
    /// Multiple of the period that is due next.
    multiple: f64,
}

impl Schedule {
    /// Due at the end of every step.
    pub fn every_step() -> Self {
        Self { period: None, multiple: 0.0 }
    }

    /// Due at the multiples of `period` from `start` on. A period that is not positive is never due.
    pub fn multiples(period: f64, start: f64) -> Self {
        Self { period: Some(period), multiple: (start / period - SLACK).ceil() }
    }

    /// Due time after those taken; `None` for every step, or never.
    pub fn next(&self) -> Option<f64> {
        self.period.filter(|period| *period > 0.0).map(|period| self.multiple * period)
    }

    /// Takes the times that are due up to `end`, the end of a step; a multiple that is `end` up to rounding is `end` itself.
    pub fn take(&mut self, end: f64) -> Vec<f64> {
        let Some(period) = self.period else { return vec![end] };
        let mut due = Vec::new();
        while let Some(time) = self.next().filter(|time| *time <= end + SLACK * period) {
            let is_end = (time - end).abs() <= SLACK * period;
            due.push(if is_end { end } else { time });
            self.multiple += 1.0;
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_do_not_drift_and_meet_the_end_of_a_step() {
        let mut schedule = Schedule::multiples(0.1, 0.0);
        assert_eq!(schedule.take(0.0), vec![0.0]);
        let end = (0..3).fold(0.0, |t, _| t + 0.1);
        assert_eq!(schedule.take(end), vec![0.1, 0.2, end]);
        assert_eq!(schedule.take(0.35), Vec::<f64>::new());
        assert_eq!(schedule.next(), Some(0.4));
    }

    #[test]
    fn a_late_start_begins_at_the_next_multiple() {
        assert_eq!(Schedule::multiples(0.5, 1.2).take(2.0), vec![1.5, 2.0]);
    }

    #[test]
    fn every_step_is_its_end_and_a_zero_period_never_due() {
        assert_eq!(Schedule::every_step().take(0.7), vec![0.7]);
        assert_eq!(Schedule::multiples(0.0, 0.0).take(1.0), Vec::<f64>::new());
    }
}
