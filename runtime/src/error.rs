//! What can go wrong when a compiled model runs. Every variant says what, where in model terms, and what to do now.

use crate::settings::counted;
use std::fmt;
use std::path::PathBuf;

/// An error of a simulation.
#[derive(Debug)]
pub enum Error {
    /// A parameter from outside does not exist, has the wrong unit or lies out of range; the text says which and what is allowed.
    Parameter(String),
    /// The geometry does not close, crosses itself or overlaps with these parameters.
    Geometry(Vec<String>),
    /// The mesh could not be made.
    Mesh(String),
    /// The model's text asks for something that does not fit the mesh, such as a path without edges.
    Model(String),
    /// The equations could not be solved.
    Solve(Box<SolveError>),
    /// A file or folder could not be written.
    Output {
        /// The file or folder.
        path: PathBuf,
        /// The system's word.
        cause: String,
    },
}

/// Why a solve failed, with the worst term and place.
#[derive(Clone, Debug)]
pub struct SolveError {
    /// What happened.
    pub cause: Cause,
    /// Time [internal units].
    pub time: f64,
    /// Step size when it was given up; 0 where there is no time.
    pub step: f64,
    /// Newton iterations of the last attempt.
    pub iterations: usize,
    /// Relative residual reached.
    pub residual: f64,
    /// The unknown with the largest residual, such as `u.z at (1.53, 0.02)`.
    pub place: String,
    /// Contributions of the physics blocks there, largest first.
    pub terms: Vec<(String, f64)>,
}

/// Causes of a failed solve.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// Newton's method used all its iterations, or its line search found no decrease.
    NoConvergence,
    /// The solution is unstable: the tangent has this many negative pivots.
    Unstable(usize),
    /// The matrix is singular at an unknown.
    Singular(String),
    /// A value became infinite or undefined, as when an element turns inside out.
    NotFinite,
    /// Nothing fixes the level of this field, and the sources in its equation do not cancel, as where more flows into a closed box than out.
    Unbalanced(&'static str),
    /// The small system of states has no solution; the text names the equation.
    States(String),
    /// A moving region cannot be meshed where the last step has left its bodies.
    Mesh(String),
}

impl Cause {
    /// What to try, where the cause alone does not say it.
    fn advice(&self) -> Option<&'static str> {
        match self {
            Self::NoConvergence | Self::NotFinite => Some(
                "try: a smaller load or largest step, a finer mesh at that place, a milder value of a parameter; a body that folds or a law with a \
                 negative modulus has no solution to be found (docs/language/solve.md)",
            ),
            Self::Singular(_) => Some(
                "is there a `hold` for every body, a `tie` or a `hold` for every flow? What may move without any force, or has no equation at all, makes the \
                 tangent singular",
            ),
            Self::Unstable(_) | Self::Unbalanced(_) | Self::States(_) | Self::Mesh(_) => None,
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoConvergence => write!(f, "Newton's method did not converge"),
            Self::Unstable(n) => write!(f, "the equilibrium found is unstable ({n} negative pivots)"),
            Self::Singular(unknown) => write!(f, "the tangent is singular at {unknown}"),
            Self::Mesh(why) => write!(f, "{why}"),
            Self::NotFinite => {
                write!(f, "a value is not finite: an element has turned inside out or a law left its domain")
            }
            Self::Unbalanced(field) => write!(
                f,
                "nothing fixes the level of `{field}`, and its equation does not balance: what is held and what is applied leave something over; \
                 let the held values cancel, or hold nothing on a part of the boundary"
            ),
            Self::States(equation) => write!(f, "the states could not be solved for: {equation}"),
        }
    }
}

impl SolveError {
    fn describe_residual(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let iterations = counted(self.iterations, "iteration");
        writeln!(f, "  {iterations}, relative residual {:.2e}", self.residual)?;
        writeln!(f, "  largest residual: {}", self.place)?;
        self.terms.iter().try_for_each(|(term, value)| writeln!(f, "    {term:<40} {value:+.4e}"))
    }
}

impl fmt::Display for SolveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Cause::Mesh(why) = &self.cause {
            return writeln!(f, "{why} (after the step to t = {:.6})", self.time);
        }
        match self.step {
            0.0 => writeln!(f, "{}", self.cause)?,
            step => writeln!(f, "{} at t = {:.6}, step {step:.3e}", self.cause, self.time)?,
        }
        if !matches!(self.cause, Cause::Singular(_)) {
            self.describe_residual(f)?;
        }
        self.cause.advice().map_or(Ok(()), |advice| writeln!(f, "  {advice}"))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(text) | Self::Model(text) => f.write_str(text),
            Self::Geometry(errors) => {
                writeln!(f, "the geometry is not valid with these parameters:")?;
                errors.iter().try_for_each(|e| writeln!(f, "  {e}"))
            }
            Self::Mesh(text) => write!(f, "the mesh could not be made: {text}"),
            Self::Solve(error) => error.fmt(f),
            Self::Output { path, cause } => {
                write!(f, "cannot write `{}`: {cause}; choose another folder with --out", path.display())
            }
        }
    }
}

impl std::error::Error for Error {}
impl std::error::Error for SolveError {}

impl From<SolveError> for Error {
    fn from(error: SolveError) -> Self {
        Self::Solve(Box::new(error))
    }
}
