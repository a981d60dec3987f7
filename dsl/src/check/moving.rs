//! Regions that follow bodies: `moving D by u;`, and the ties that let their fields follow those of bodies.

use super::domain::piece_words;
use super::shape::settle;
use super::{Checked, Checker, Env, Reported};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{
    Action, Expr, ExprKind, Field, FieldId, Model, Moving, Piece, RegionId, Shape, StatementKind, Tie, Type,
};
use crate::source::{SourceMap, Span};
use crate::syntax::ast;
use ansatz_units::Dimension;

impl Checker<'_> {
    /// `moving D by u;`
    pub(super) fn moving(&mut self, item: &ast::Moving, span: Span) {
        // What is wrong has been said.
        let _ = self.moving_regions(item, span);
    }

    fn moving_regions(&mut self, item: &ast::Moving, span: Span) -> Checked<()> {
        let env = Env::default();
        let displacement = match &item.motion {
            ast::Motion::Given(by) => self.settled(by, &env)?,
            ast::Motion::Solved { .. } => {
                return Err(self.report(
                    Diagnostic::error(Code::Unsupported, span, "mesh motion by equations is not supported")
                        .help("`moving D by u;` lets the region follow the displacement of the bodies around it"),
                ));
            }
        };
        let ExprKind::Field(by) = displacement.kind else {
            return Err(self.report(
                Diagnostic::error(
                    Code::WrongKind,
                    displacement.span,
                    "a region moves by a displacement field",
                )
                .help("name the field of the bodies around it: `moving cytosol by u;`"),
            ));
        };
        self.expect(displacement, &Type::POSITION, "what moves a region")?;
        let domain = self.domain(&item.domain, &env)?;
        for piece in &domain.pieces {
            match *piece {
                Piece::Region(region) => self.rest.moving.push(Moving { region, by, span: domain.span }),
                other => {
                    let words = piece_words(&self.geometry, &self.pairs, other);
                    let message = format!("{words} is no region");
                    let diagnostic = Diagnostic::error(Code::WrongKind, domain.span, message);
                    return Err(
                        self.report(diagnostic.help("regions move; their surfaces follow the bodies"))
                    );
                }
            }
        }
        Ok(())
    }

    /// `tie a == b on D;`
    pub(super) fn tie(
        &mut self,
        equation: &ast::Equation,
        domain: Option<&ast::Expr>,
        span: Span,
        env: &Env,
    ) -> Checked<StatementKind> {
        let (a, b) = (self.expr(&equation.left, env), self.expr(&equation.right, env));
        let domain = domain.map(|domain| self.domain(domain, env)).transpose();
        let (mut a, mut b) = (a?, b?);
        self.same(&mut a, &mut b, equation.span, "tie")?;
        let (a, b) = (settle(a), settle(b));
        let (follower, partner, rate) = match (field_of(&a), field_of(&b)) {
            (Some((field, false)), Some((partner, rate))) => (field, partner, rate),
            (Some((partner, true)), Some((field, false))) => (field, partner, true),
            _ => return Err(self.no_tie(span)),
        };
        match domain? {
            Some(domain) => Ok(StatementKind::Tie(Tie { field: follower, partner, rate }, domain)),
            None => Err(self.report(
                Diagnostic::error(Code::MissingArgument, span, "fields are tied on a domain")
                    .help("write `tie v == dt(u) on D;`"),
            )),
        }
    }

    fn no_tie(&mut self, span: Span) -> Reported {
        self.report(
            Diagnostic::error(
                Code::WrongKind,
                span,
                "a tie makes a whole field equal to another field or to its rate",
            )
            .help("write `tie v == dt(u) on D;`, for all components at once"),
        )
    }
}

/// A field, or the rate of one (true).
fn field_of(e: &Expr) -> Option<(FieldId, bool)> {
    match &e.kind {
        ExprKind::Field(field) => Some((*field, false)),
        ExprKind::Rate(inner) => match inner.kind {
            ExprKind::Field(field) => Some((field, true)),
            _ => None,
        },
        _ => None,
    }
}

/// The regions on which a field lives.
fn regions(field: &Field) -> impl Iterator<Item = RegionId> {
    field.domain.pieces.iter().filter_map(|piece| match *piece {
        Piece::Region(region) => Some(region),
        _ => None,
    })
}

/// Reports fields that live on bodies and on moving regions at once, displacements that live where they make things move, and flows that nothing
/// ties to what moves their region.
pub(super) fn check(model: &Model, sources: &SourceMap, sink: &mut Sink) {
    for moving in &model.moving {
        let region = sources.slice(moving.span);
        let by = &model.fields[moving.by.0];
        if regions(by).any(|region| region == moving.region) {
            let message = format!("`{}` lives on `{region}` itself", by.name);
            sink.push(
                Diagnostic::error(Code::Misplaced, moving.span, message)
                    .label(by.span, "declared here")
                    .help("a moving region follows the bodies around it, whose displacement ends at its surface"),
            );
        }
    }
    let moves = |region: &RegionId| model.moving.iter().any(|moving| moving.region == *region);
    for field in &model.fields {
        if let (Some(moving), Some(body)) = (regions(field).find(moves), regions(field).find(|r| !moves(r))) {
            let name = |region: RegionId| &model.geometry.regions[region.0].name;
            let message = format!(
                "`{}` lives on `{}`, which moves, and on `{}`, which does not",
                field.name,
                name(moving),
                name(body)
            );
            sink.push(
                Diagnostic::error(Code::Misplaced, field.span, message)
                    .help("declare two fields, and `tie` them where the regions meet"),
            );
        }
    }
    check_ties(model, sources, sink);
    let stays = |piece: &Piece| !matches!(piece, Piece::Region(region) if moves(region));
    for action in model.events.iter().flat_map(|event| &event.actions) {
        let Action::Remesh(domain) = action else { continue };
        if domain.pieces.iter().any(stays) {
            let message = format!("`{}` is no region that moves", sources.slice(domain.span));
            sink.push(Diagnostic::error(Code::Misplaced, domain.span, message).help(what_moves(model)));
        }
    }
}

/// Warns of regions that move with a flow on them of which nothing is tied to what surrounds it: the flow would not feel how its boundary moves.
fn check_ties(model: &Model, sources: &SourceMap, sink: &mut Sink) {
    let ties = || {
        let statements = model.blocks.iter().flat_map(|block| &block.statements);
        statements.filter_map(|statement| match statement.kind {
            StatementKind::Tie(tie, _) => Some(tie.field),
            _ => None,
        })
    };
    for moving in &model.moving {
        let on_region = |field: &Field| regions(field).any(|region| region == moving.region);
        let is_velocity = |field: &&Field| {
            field.shape == Shape::Vector && field.dimension == Dimension::LENGTH / Dimension::TIME
        };
        let Some(flow) = model.fields.iter().filter(|field| on_region(field)).find(is_velocity) else {
            continue;
        };
        if !ties().any(|field| on_region(&model.fields[field.0])) {
            let (region, flow_name) = (sources.slice(moving.span), &flow.name);
            let by = &model.fields[moving.by.0].name;
            let message = format!("nothing ties `{flow_name}` to how the boundary of `{region}` moves");
            sink.push(
                Diagnostic::warning(Code::Untied, moving.span, message)
                    .label(flow.span, "declared here")
                    .help(format!(
                        "write `tie {flow_name} == dt({by}) on D;`, with the paths D where `{region}` meets bodies"
                    )),
            );
        }
    }
}

/// Help where a region that moves is needed.
fn what_moves(model: &Model) -> String {
    let names = model.moving.iter().map(|moving| model.geometry.regions[moving.region.0].name.as_str());
    match names.collect::<Vec<_>>().as_slice() {
        [] => "`remesh(D)` is for what is declared `moving D by u;`, and nothing is".into(),
        names => format!("`{}` moves; bodies keep their mesh", names.join("`, `")),
    }
}
