//! Parameter values from outside: `NAME=VALUE`, such as `r_g="1.2 um"`, checked for name, unit and range; and the settings of a run that follow
//! from them.

use crate::error::Error;
use crate::generated::{Parameter, Program, Solve, Trigger};
use ansatz_units::{Dimension, Rational, nearest, parse_quantity};
use std::cmp::Ordering;
use std::num::NonZeroUsize;

/// Threads that can be asked for; more would only wait for each other.
pub const MOST_THREADS: usize = 256;

/// Values of all parameters in the model's units: those set, and defaults for the rest (defaults may depend on parameters before them).
///
/// # Errors
/// [`Error::Parameter`] naming the parameter: unknown, not a quantity, of another dimension, out of its range.
pub fn resolve(program: &Program, settings: &[(String, String)]) -> Result<Vec<f64>, Error> {
    let mut given = vec![None; program.parameters.len()];
    for (name, text) in settings {
        let index = find(program, name)?;
        given[index] = Some(value(program, &program.parameters[index], text)?);
    }
    let mut g = vec![0.0; program.layout.length];
    let first = program.layout.parameters[0];
    for (k, parameter) in program.parameters.iter().enumerate() {
        g[first + k] = given[k].unwrap_or_else(|| (parameter.default)(&g));
    }
    let values = g[first..first + program.parameters.len()].to_vec();
    check(program, &g, &values)?;
    Ok(values)
}

/// Checks every value against its range or list.
///
/// # Errors
/// [`Error::Parameter`] naming the first parameter that is out of range, and what is allowed.
pub fn check(program: &Program, g: &[f64], values: &[f64]) -> Result<(), Error> {
    for (parameter, &value) in program.parameters.iter().zip(values) {
        let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
        let shown = |x: f64| format!("{}{unit}", display(x / parameter.unit_value));
        if let Some(choices) = (parameter.choices)(g) {
            let close = |c: &f64| (c - value).abs() <= 1e-12 * c.abs();
            if !choices.iter().any(close) {
                let list: Vec<String> = choices.iter().map(|c| shown(*c)).collect();
                let message =
                    format!("`{}` = {} is not one of {}", parameter.name, shown(value), list.join(", "));
                return Err(Error::Parameter(message));
            }
        }
        let (low, high) = (parameter.range)(g);
        if value.is_nan()
            || value < low * (1.0 - low.signum() * 1e-12)
            || value > high * (1.0 + high.signum() * 1e-12)
        {
            let allowed = format!("{} .. {}", shown(low), shown(high));
            let message = format!("`{}` = {} is out of its range {allowed}", parameter.name, shown(value));
            return Err(Error::Parameter(message));
        }
    }
    Ok(())
}

/// Settings of the solution with the parameters in `g`, if a run can start with them and with the intervals and durations of the events.
///
/// # Errors
/// [`Error::Model`] naming what is not positive, or a time that ends before it starts.
pub fn solution(program: &Program, g: &[f64]) -> Result<Solve, Error> {
    let solve = (program.solve)(g);
    if solve.time.is_some_and(|(start, end)| start.partial_cmp(&end) != Some(Ordering::Less)) {
        return Err(Error::Model(String::from("the time of a run must end after it starts")));
    }
    // What the model does not name is infinite, or zero.
    let step = |name, size: f64| {
        let value = if size.is_nan() { String::new() } else { format!(": {size}") };
        format!("`{name}{value}` in `step` is no finite time above 0")
    };
    require(solve.max_step > 0.0, || step("max", solve.max_step))?;
    require(solve.min_step >= 0.0, || step("min", solve.min_step))?;
    for tolerance in [solve.step_tolerance, solve.newton_tolerance] {
        require(tolerance > 0.0, || format!("`tolerance: {tolerance}` is not above 0"))?;
    }
    require(solve.newton_iterations > 0, || {
        String::from("`iterations` in `newton` is no whole number above 0")
    })?;
    for event in program.events {
        let name = event.name;
        match event.trigger {
            Trigger::Every(period) => require(period(g) > 0.0, || {
                format!("the event `{name}` would fire every {}, which is no time above 0", period(g))
            })?,
            Trigger::When { duration, .. } => require(duration(g) >= 0.0, || {
                format!(
                    "the condition of `{name}` would have to last {}, which is no time of 0 or more",
                    duration(g)
                )
            })?,
            Trigger::EveryStep => {}
        }
    }
    Ok(solve)
}

/// A step that a model names by parameters \[internal time\]: itself where it is a finite time above 0, else one that [`solution`] refuses, as
/// infinity and 0 stand for steps that are not named.
#[must_use]
pub fn named_step(size: f64) -> f64 {
    if size == f64::INFINITY || size == 0.0 { f64::NAN } else { size }
}

/// A number of iterations that follows from parameters; 0, which [`solution`] refuses, where it is no whole number above 0.
#[must_use]
pub fn whole(number: f64) -> usize {
    // Negative and infinite numbers saturate, and then differ from what they were.
    let count = number as usize;
    if count as f64 == number { count } else { 0 }
}

fn require(holds: bool, message: impl Fn() -> String) -> Result<(), Error> {
    if holds { Ok(()) } else { Err(Error::Model(message() + "; change what it follows from")) }
}

/// Splits `NAME=VALUE`.
///
/// # Errors
/// [`Error::Parameter`] when there is no `=`.
pub fn split(setting: &str) -> Result<(String, String), Error> {
    let message = || format!("`{setting}` is no setting: write NAME=VALUE, such as --set r=\"1.2 um\"");
    let (name, value) = setting.split_once('=').ok_or_else(|| Error::Parameter(message()))?;
    Ok((name.trim().into(), value.trim().into()))
}

/// A number as people write it: 12 significant digits at most.
pub fn display(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// `1 iteration`, `3 iterations`.
pub fn counted(count: usize, word: &str) -> String {
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}

/// A time such as `50 s`, in the model's unit.
///
/// # Errors
/// [`Error::Parameter`] when it is no time.
pub fn time(program: &Program, text: &str) -> Result<f64, Error> {
    let wrong = |why: String| {
        Error::Parameter(format!("`{text}` is no time: {why}; write it with a unit, such as \"50 s\""))
    };
    let (si, dimension) = parse_quantity(text).map_err(|e| wrong(e.to_string()))?;
    if dimension == Dimension::TIME {
        Ok(si / scale(program, dimension))
    } else {
        Err(wrong(format!("it is {}", dimension.describe())))
    }
}

/// A number of threads such as `2`.
///
/// # Errors
/// [`Error::Parameter`] when it is no whole number from 1 to [`MOST_THREADS`].
pub fn threads(text: &str) -> Result<NonZeroUsize, Error> {
    let number = text.parse().ok().filter(|threads: &NonZeroUsize| threads.get() <= MOST_THREADS);
    let wrong = || {
        format!("`{text}` is no number of threads: write one from 1 to {MOST_THREADS}, such as --threads 2")
    };
    number.ok_or_else(|| Error::Parameter(wrong()))
}

/// Refuses an end of a run outside the time `(start, end)` of a model \[internal time\].
///
/// # Errors
/// [`Error::Parameter`] with the times in seconds.
pub fn check_end(program: &Program, (start, end): (f64, f64), until: f64) -> Result<(), Error> {
    if start < until && until <= end {
        return Ok(());
    }
    let seconds = |t: f64| format!("{} s", display(t * scale(program, Dimension::TIME)));
    Err(Error::Parameter(if start == end {
        String::from("the run cannot be ended by `--until`: the model is solved once, it has no time")
    } else {
        let [start, end, until] = [start, end, until].map(seconds);
        format!(
            "the run cannot end at {until}: its time is {start} .. {end}; give one within, or change `time` in `solve`"
        )
    }))
}

fn find(program: &Program, name: &str) -> Result<usize, Error> {
    if let Some(index) = program.parameters.iter().position(|p| p.name == name) {
        return Ok(index);
    }
    let names = program.parameters.iter().map(|p| p.name);
    let hint = match nearest(name, names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => String::from("--help lists them"),
    };
    Err(Error::Parameter(format!("the model `{}` has no parameter `{name}`; {hint}", program.name)))
}

fn value(program: &Program, parameter: &Parameter, text: &str) -> Result<f64, Error> {
    let name = parameter.name;
    let (si, dimension) =
        parse_quantity(text).map_err(|e| Error::Parameter(format!("`{name}={text}` is no quantity: {e}")))?;
    let wanted = dimension_of(parameter);
    if dimension != wanted {
        let unit = parameter.unit;
        let message = format!(
            "`{name}` is {} and needs a unit such as {unit}, but `{text}` is {}",
            wanted.describe(),
            dimension.describe()
        );
        return Err(Error::Parameter(message));
    }
    Ok(si / scale(program, wanted))
}

/// Dimension of a parameter.
fn dimension_of(parameter: &Parameter) -> Dimension {
    let exponent = |(n, d)| Rational::new(n, d).unwrap_or(Rational::ZERO);
    Dimension::from_exponents(parameter.dimension.map(exponent))
}

/// SI value of one internal unit of a dimension.
fn scale(program: &Program, dimension: Dimension) -> f64 {
    let power = |(base, exponent): (f64, &Rational)| base.powf(exponent.to_f64());
    program.base_scales.into_iter().zip(dimension.exponents()).map(power).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_named_step_that_is_none_is_told_from_one_that_is_not_named() {
        assert_eq!(named_step(0.5), 0.5);
        assert_eq!(named_step(-1.0), -1.0);
        assert!(named_step(f64::INFINITY).is_nan() && named_step(0.0).is_nan());
    }

    #[test]
    fn parts_of_iterations_count_as_none() {
        assert_eq!(whole(25.0), 25);
        for number in [2.5, -1.0, f64::INFINITY, f64::NAN] {
            assert_eq!(whole(number), 0, "{number}");
        }
    }
}
