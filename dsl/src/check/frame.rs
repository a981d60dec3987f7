//! Units, coordinates, and the finished model.

use super::{Checker, Env};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{
    Coordinates, Expr, ExprKind, Field, Frame, MeshSettings, Model, Output, Solve, State, Sweep, Test, Type,
};
use crate::resolve::Program;
use crate::source::Span;
use crate::syntax::ast::{self, ItemKind};
use ansatz_units::{UnitSystem, UnitSystemError};

/// What is elaborated in the order of the items.
#[derive(Debug, Default)]
pub(crate) struct Rest {
    pub(crate) fields: Vec<Field>,
    pub(crate) states: Vec<State>,
    pub(crate) moving: Vec<crate::model::Moving>,
    pub(crate) mesh: MeshSettings,
    pub(crate) solve: Option<Solve>,
    pub(crate) output: Output,
    pub(crate) sweeps: Vec<Sweep>,
    pub(crate) tests: Vec<Test>,
}

/// The coherent system of the `units` item; SI if there is none or it is faulty.
pub(super) fn units(program: &Program, sink: &mut Sink) -> UnitSystem {
    let symbols = program.items.iter().find_map(|item| match &item.kind {
        ItemKind::Units(symbols) => Some(symbols),
        _ => None,
    });
    let Some(symbols) = symbols else { return UnitSystem::default() };
    let texts: Vec<&str> = symbols.iter().map(|symbol| symbol.text.as_str()).collect();
    UnitSystem::new(&texts).unwrap_or_else(|error| {
        sink.push(units_error(&error, symbols));
        UnitSystem::default()
    })
}

fn units_error(error: &UnitSystemError, symbols: &[ast::Ident]) -> Diagnostic {
    let all = symbols.first().zip(symbols.last()).map_or_else(Span::default, |(a, b)| a.span.to(b.span));
    let place = |index: usize| symbols.get(index).map_or(all, |symbol| symbol.span);
    match error {
        UnitSystemError::Unknown { index, symbol } => {
            Diagnostic::error(Code::UnknownUnit, place(*index), format!("`{symbol}` is no unit"))
                .help_unit(symbol)
        }
        UnitSystemError::Number { index, .. }
        | UnitSystemError::Redundant { index, .. }
        | UnitSystemError::Contradiction { index, .. } => {
            Diagnostic::error(Code::UnitDimension, place(*index), error.to_string())
        }
        UnitSystemError::Insufficient { .. } => {
            Diagnostic::error(Code::UnitDimension, all, error.to_string())
                .help("give a length, a time and a force or mass: `units um, s, nN;`")
        }
    }
}

/// The `coordinates` item; plane `x`, `y` if it is missing or faulty.
pub(super) fn coordinates(program: &Program, sink: &mut Sink) -> Coordinates {
    let fallback = Coordinates { frame: Frame::PlaneStrain, names: ["x".into(), "y".into()] };
    let item = program.items.iter().find_map(|item| match &item.kind {
        ItemKind::Coordinates(coordinates) => Some((coordinates, item.span)),
        _ => None,
    });
    let Some((item, span)) = item else {
        let geometry = program.items.iter().find(|item| matches!(item.kind, ItemKind::Geometry(_)));
        if let Some(geometry) = geometry.filter(|_| !sink.has_errors()) {
            let place = Span { end: geometry.span.start, ..geometry.span };
            sink.push(
                Diagnostic::error(
                    Code::MissingArgument,
                    place,
                    "the model has a geometry and no coordinates",
                )
                .help("write `coordinates axisymmetric(r, z);` or `coordinates plane_strain(x, y);`"),
            );
        }
        return fallback;
    };
    let Some(frame) = frame(&item.kind, sink) else { return fallback };
    match item.args.as_slice() {
        [a, b] if a.name.is_none() && b.name.is_none() => match (a.value.as_name(), b.value.as_name()) {
            (Some(a), Some(b)) if a.text != b.text => return Coordinates { frame, names: [a.text, b.text] },
            _ => {}
        },
        _ => {}
    }
    let help = format!(
        "write `coordinates {}({});`",
        item.kind.text,
        if frame == Frame::Axisymmetric { "r, z" } else { "x, y" }
    );
    sink.push(Diagnostic::error(Code::Expected, span, "two names are needed for the coordinates").help(help));
    fallback
}

fn frame(kind: &ast::Ident, sink: &mut Sink) -> Option<Frame> {
    match kind.text.as_str() {
        "axisymmetric" => Some(Frame::Axisymmetric),
        "plane_strain" => Some(Frame::PlaneStrain),
        "cartesian" => {
            sink.push(Diagnostic::error(
                Code::Unsupported,
                kind.span,
                "models in three dimensions are not supported",
            ));
            None
        }
        other => {
            let known = ["axisymmetric", "plane_strain", "cartesian"];
            sink.push(
                Diagnostic::error(
                    Code::UnknownName,
                    kind.span,
                    format!("there are no coordinates `{other}`"),
                )
                .help_did_you_mean(other, known)
                .help("write `axisymmetric(r, z)` or `plane_strain(x, y)`"),
            );
            None
        }
    }
}

/// Puts the model together; faulty items leave placeholders, so that ids stay in step.
pub(super) fn assemble(mut checker: Checker<'_>, program: &Program) -> Model {
    let params = checker.taken_params();
    let functions = checker.taken_functions();
    let solve = checker.rest.solve.take().unwrap_or_else(default_solve);
    Model {
        name: program.name.clone(),
        doc: program.docs.clone(),
        units: checker.units,
        coordinates: checker.coordinates,
        params,
        lets: checker.values,
        functions,
        locals: checker.locals.into_iter().map(|(name, _)| name).collect(),
        geometry: checker.geometry,
        mesh: checker.rest.mesh,
        fields: checker.rest.fields,
        states: checker.rest.states,
        pairs: checker.pairs,
        blocks: checker.blocks,
        events: checker.events,
        moving: checker.rest.moving,
        solve,
        output: checker.rest.output,
        sweeps: checker.rest.sweeps,
        tests: checker.rest.tests,
    }
}

/// Settings of a model that states none: stationary, Newton to 1e-8 in at most 25 iterations.
pub(super) fn default_solve() -> Solve {
    let number = |value: f64| Expr { kind: ExprKind::Number(value), ty: Type::NUMBER, span: Span::default() };
    Solve {
        time: None,
        integrator: crate::model::Integrator::Sdirk2,
        max_step: None,
        min_step: None,
        step_tolerance: number(1e-4),
        newton_tolerance: number(1e-8),
        newton_iterations: number(25.0),
    }
}

impl Checker<'_> {
    /// The first moment of the run, for `e@start`.
    pub(super) fn start_time(&mut self, span: Span) -> super::Checked<Expr> {
        let range = self.program.items.iter().find_map(|item| match &item.kind {
            ItemKind::Solve(settings) => settings.iter().find_map(|setting| match &setting.value {
                ast::SettingValue::Range(range) if setting.name.text == "time" => Some(range),
                _ => None,
            }),
            _ => None,
        });
        match range {
            Some(range) => self.typed(&range.low, &Type::TIME, "the start of the run", &Env::default()),
            None => Err(self.report(
                Diagnostic::error(Code::NeedsRun, span, "the model has no time range")
                    .help("a stationary model has one solution: write `e@(0 s)` or `max(e on run)`")
                    .help("a model in time says how long: `solve { time = 0 s .. 250 s; }`"),
            )),
        }
    }
}
