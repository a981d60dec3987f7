//! Expectations of tests that read a finished run.

use super::Builder;
use super::observe::observed;
use crate::lower::{Condition, Lowered, Lowering, RunValue, unsupported};
use crate::model::{self, Check};
use crate::scalar::Id;
use crate::source::Span;

/// A test that reads the run.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct RunTest {
    pub title: String,
    pub expectations: Vec<(Span, Expectation)>,
}

/// What is expected.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum Expectation {
    /// A condition.
    Holds(Condition),
    /// Two numbers that agree within an absolute tolerance.
    Near { value: Id, expected: Id, tolerance: Id, unit: String },
}

impl RunTest {
    /// Scalars to be evaluated.
    pub(super) fn roots(&self) -> Vec<Id> {
        self.expectations.iter().flat_map(|(_, expectation)| expectation.roots()).collect()
    }
}

impl Expectation {
    /// Scalars to be evaluated.
    pub fn roots(&self) -> Vec<Id> {
        match self {
            Expectation::Holds(condition) => condition.scalars(),
            Expectation::Near { value, expected, tolerance, .. } => vec![*value, *expected, *tolerance],
        }
    }
}

impl<'m> Builder<'m> {
    /// Lowers the tests that need a run.
    pub(super) fn run_tests(&mut self, rows: &[usize]) -> Vec<RunTest> {
        let tests = self.lowering.model.tests.iter().filter(|test| test.needs_run);
        let tests: Vec<RunTest> =
            tests.filter_map(|test| self.attempt(|lowering| lower_test(lowering, test))).collect();
        self.attempt(|lowering| observe_run_values(lowering, rows));
        tests
    }

    /// Scalars at single times that the tests read.
    pub(super) fn run_roots(&self) -> Vec<Id> {
        self.lowering.run_values.iter().flat_map(RunValue::roots).collect()
    }
}

fn lower_test<'m>(lowering: &mut Lowering<'m>, test: &'m model::Test) -> Lowered<RunTest> {
    let mut expectations = Vec::new();
    for check in &test.checks {
        match check {
            Check::Let(local, value) => lowering.set_local_let(*local, value),
            Check::Each(..) => return Err(unsupported(test.span, "a test of a run cannot contain a loop")),
            Check::Holds(condition, span) => {
                expectations.push((*span, Expectation::Holds(lowering.global_condition(condition)?)));
            }
            Check::Near { value, expected, tolerance, percent, span } => {
                let unit = unit_of(lowering, value);
                let (value, expected) = (lowering.global_scalar(value)?, lowering.global_scalar(expected)?);
                let mut tolerance = lowering.global_scalar(tolerance)?;
                if *percent {
                    let (hundredth, size) = (lowering.pool.constant(0.01), lowering.pool.abs(expected));
                    tolerance = lowering.pool.product([tolerance, hundredth, size]);
                }
                expectations.push((*span, Expectation::Near { value, expected, tolerance, unit }));
            }
        }
    }
    Ok(RunTest { title: test.title.clone(), expectations })
}

/// Internal unit of a value.
fn unit_of(lowering: &Lowering<'_>, value: &model::Expr) -> String {
    match value.ty {
        model::Type::Value(_, dimension) => lowering.model.units.unit_of(dimension),
        _ => String::from("1"),
    }
}

/// Exchanges rates of observables in what the tests read of single times.
fn observe_run_values(lowering: &mut Lowering<'_>, rows: &[usize]) -> Lowered<()> {
    for k in 0..lowering.run_values.len() {
        let observed = match lowering.run_values[k].clone() {
            RunValue::Extreme(reduction, of, range) => {
                RunValue::Extreme(reduction, observed(lowering, rows, of)?, range)
            }
            RunValue::AtTime(of, time) => RunValue::AtTime(observed(lowering, rows, of)?, time),
            RunValue::AtEvent(of, event) => RunValue::AtEvent(observed(lowering, rows, of)?, event),
            outcome @ RunValue::Outcome(_) => outcome,
        };
        lowering.run_values[k] = observed;
    }
    Ok(())
}
