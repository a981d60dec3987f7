//! The geometry at the default parameters.

use super::values_of;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::Forms;
use crate::form::settings::Path;
use crate::lower::piece_name;
use crate::model::{self, Frame, Model, Piece};
use crate::scalar::Id;
use crate::source::Span;
use ansatz_geometry::{Geometry, GeometryError, LoopPart, PathBuilder, Region, Turn};

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
    for error in errors {
        let diagnostic = Diagnostic::error(code(&error), span(model, &error), error.to_string());
        sink.push(diagnostic.here("with the default parameters"));
    }
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
    let path = name.split('.').next().unwrap_or_default();
    let paths = model.geometry.paths.iter().filter(|p| p.name == path).map(|p| p.span);
    let regions = model.geometry.regions.iter().filter(|r| r.name == *name).map(|r| r.span);
    paths.chain(regions).next().unwrap_or_default()
}
