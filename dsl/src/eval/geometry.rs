//! The geometry at the default parameters.

use super::values_of;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::Forms;
use crate::form::settings::Path;
use crate::lower::piece_name;
use crate::model::{self, Frame, Model, Piece};
use crate::scalar::Id;
use crate::source::Span;
use ansatz_geometry::{Doubt, Geometry, GeometryError, LoopPart, PathBuilder, Region, Turn};

/// What the geometry is judged by.
const DEFAULTS: &str = "with the default parameters";

/// Builds the geometry and reports what is wrong with it, on the path or region.
pub(super) fn check(forms: &Forms<'_>, parameters: &[f64], sink: &mut Sink) {
    let model = forms.lowering.model;
    let mut errors = Vec::new();
    let mut geometry =
        Geometry { axisymmetric: model.coordinates.frame == Frame::Axisymmetric, ..Geometry::default() };
    for (definition, path) in model.geometry.paths.iter().zip(&forms.settings.paths) {
        match build(forms, definition, path, parameters) {
            Ok(path) => geometry.paths.push(path),
            Err(found) => errors.extend(found),
        }
    }
    geometry.regions = model
        .geometry
        .regions
        .iter()
        .map(|region| Region::new(&region.name, region.boundary.iter().map(|&piece| part(model, piece))))
        .collect();
    if errors.is_empty() {
        errors = geometry.check();
    }
    if errors.is_empty() {
        geometry.doubts().iter().for_each(|doubt| sink.push(doubtful(model, doubt)));
    }
    for error in errors {
        let mut diagnostic =
            Diagnostic::error(code(&error), span(model, &error), error.fault()).here(DEFAULTS);
        if let Some(other) = second(model, &error) {
            diagnostic = diagnostic.label(other, "the other one");
        }
        sink.push(error.advice().into_iter().fold(diagnostic, Diagnostic::help));
    }
}

/// Warns of a path that may not be attached as it is meant to be.
fn doubtful(model: &Model, doubt: &Doubt) -> Diagnostic {
    let diagnostic =
        Diagnostic::warning(Code::LooseEnd, named(model, doubt.path()), doubt.to_string()).here(DEFAULTS);
    let (diagnostic, other) = match doubt {
        Doubt::LooseEnd { other, .. } | Doubt::Crossing { other, .. } => (
            diagnostic.label(named(model, other), "the other one"),
            other.split('.').next().unwrap_or_default(),
        ),
        Doubt::EndInside { region, .. } => {
            (diagnostic.label(named(model, region), "the region"), region.as_str())
        }
    };
    diagnostic.help(format!(
        "paths are joined where both have an end of a segment: divide a path of `{other}` there and use the same point for both"
    ))
}

fn build(
    forms: &Forms<'_>,
    definition: &model::Path,
    path: &Path,
    parameters: &[f64],
) -> Result<ansatz_geometry::Path, Vec<GeometryError>> {
    let point = |ids: &[Id; 2]| {
        let values = values_of(&forms.lowering, ids, parameters, &[]);
        [values[0], values[1]]
    };
    let mut builder = PathBuilder::from(&definition.name, point(&path.start));
    for (segment, lowered) in definition.segments.iter().zip(&path.segments) {
        let label = segment.label.as_deref();
        let to = point(&lowered.to);
        builder = match &lowered.arc {
            None => builder.line(label, to),
            Some((centre, model::Turn::Clockwise)) => builder.arc(label, point(centre), Turn::Cw, to),
            Some((centre, model::Turn::Counterclockwise)) => builder.arc(label, point(centre), Turn::Ccw, to),
        };
    }
    builder.build()
}

fn part(model: &Model, piece: Piece) -> LoopPart {
    let name = piece_name(model, piece);
    match piece {
        Piece::Axis => LoopPart::Axis,
        Piece::Segment(path, _) => {
            let path = &model.geometry.paths[path.0].name;
            LoopPart::segment(path, name.rsplit('.').next().unwrap_or_default())
        }
        _ => LoopPart::path(&name),
    }
}

fn code(error: &GeometryError) -> Code {
    use GeometryError as E;
    match error {
        E::Overlap { .. } | E::Crossing { .. } | E::Coincident { .. } => Code::Overlap,
        E::ZeroLength { .. } | E::NotFinite { .. } => Code::EmptyPatch,
        _ => Code::OpenLoop,
    }
}

/// Where the first thing that an error names is declared.
fn span(model: &Model, error: &GeometryError) -> Span {
    use GeometryError as E;
    let name: &str = match error {
        E::EndOffCircle { name, .. }
        | E::NotFinite { name, .. }
        | E::ZeroLength { name, .. }
        | E::NegativeRadius { name, .. } => name,
        E::BrokenPath { path, .. } => path,
        E::UnknownPart { region, .. }
        | E::NoAxis { region }
        | E::NotClosed { region, .. }
        | E::Branch { region, .. } => region,
        E::Crossing { names, .. } | E::Coincident { names, .. } => &names[0],
        E::Overlap { regions, .. } => &regions[0],
        E::CirclesApart { .. } => "",
    };
    named(model, name)
}

/// Where the second thing that an error names is declared.
fn second(model: &Model, error: &GeometryError) -> Option<Span> {
    use GeometryError as E;
    match error {
        E::Crossing { names: [a, b], .. } | E::Coincident { names: [a, b], .. } if a != b => {
            Some(named(model, b))
        }
        E::Overlap { regions: [_, b], .. } => Some(named(model, b)),
        E::NotClosed { gap, .. } => gap.to.as_ref().map(|(name, _)| named(model, name)),
        _ => None,
    }
}

/// Where `path`, `path.label` or a region is declared.
fn named(model: &Model, name: &str) -> Span {
    let path = name.split('.').next().unwrap_or_default();
    let paths = model.geometry.paths.iter().filter(|p| p.name == path).map(|p| p.span);
    let regions = model.geometry.regions.iter().filter(|r| r.name == *name).map(|r| r.span);
    paths.chain(regions).next().unwrap_or_default()
}
