//! The geometry block: paths, their segments and labels, and the regions inside loops of them.

use super::{Checked, Checker, Env, domain, zero};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Path, Piece, Region, RegionId, Segment, SegmentKind, Turn, Type};
use crate::resolve::Program;
use crate::resolve::scope::Symbol;
use crate::source::Span;
use crate::syntax::ast::{self, Geometry, GeometryItem, GeometryKind, ItemKind};

impl<'a> Checker<'a> {
    /// Gives the names of a geometry their meaning; labels are known from here on.
    pub(super) fn declare_geometry(&mut self, geometry: &'a Geometry, span: Span) {
        let items = match geometry {
            Geometry::Built(items) => items,
            Geometry::Imported { file, items } => {
                self.unsupported(None, file.span, "meshes from files");
                return self.declare_broken(items);
            }
            Geometry::Value(_) => return self.unsupported(None, span, "computed geometries"),
        };
        for item in items {
            match &item.kind {
                GeometryKind::Let(value) => self.declare_let(&item.docs, value),
                GeometryKind::Path(path) => {
                    let id = crate::model::PathId(self.geometry.paths.len());
                    self.scopes[0].declare(&path.name, Symbol::Path(id), self.sink);
                    self.geometry.paths.push(outline(path));
                    self.unique_labels(path);
                }
                GeometryKind::Region(region) => {
                    let id = RegionId(self.geometry.regions.len());
                    self.scopes[0].declare(&region.name, Symbol::Region(id), self.sink);
                    let name = region.name.text.clone();
                    self.geometry.regions.push(Region { name, boundary: Vec::new(), span: region.name.span });
                }
                GeometryKind::Regions(_) | GeometryKind::Paths(_) => {
                    let message = "names without a value belong to an imported mesh";
                    self.sink.push(Diagnostic::error(Code::Misplaced, item.span, message));
                }
            }
        }
    }

    fn declare_broken(&mut self, items: &[GeometryItem]) {
        for item in items {
            let names = match &item.kind {
                GeometryKind::Let(item) => vec![&item.name],
                GeometryKind::Path(item) => vec![&item.name],
                GeometryKind::Region(item) => vec![&item.name],
                GeometryKind::Regions(names) | GeometryKind::Paths(names) => {
                    names.iter().filter_map(|name| name.parts.first()).collect()
                }
            };
            names.into_iter().for_each(|name| self.scopes[0].set(name, Symbol::Broken));
        }
    }

    fn unique_labels(&mut self, path: &ast::Path) {
        for (k, label) in path.segments.iter().enumerate().filter_map(|(k, s)| Some((k, s.label.as_ref()?))) {
            let earlier = path.segments[..k]
                .iter()
                .filter_map(|s| s.label.as_ref())
                .find(|other| other.text == label.text);
            if let Some(first) = earlier {
                let message = format!("`{}` has two labels `{}`", path.name.text, label.text);
                self.sink.push(
                    Diagnostic::error(Code::DuplicateName, label.span, message)
                        .label(first.span, "the first"),
                );
            }
        }
    }

    /// Elaborates paths and regions.
    pub(super) fn geometry(&mut self, program: &'a Program) {
        let items = program.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Geometry(Geometry::Built(items)) => Some(items),
            _ => None,
        });
        let (mut path, mut region) = (0, 0);
        for item in items.flatten() {
            match &item.kind {
                GeometryKind::Path(ast) => {
                    self.path(path, ast);
                    path += 1;
                }
                GeometryKind::Region(ast) => {
                    if let Ok(boundary) = self.region_boundary(&ast.value) {
                        self.geometry.regions[region].boundary = boundary;
                    }
                    region += 1;
                }
                _ => {}
            }
        }
    }

    fn path(&mut self, at: usize, ast: &ast::Path) {
        if let Ok(start) = self.point(&ast.start) {
            self.geometry.paths[at].start = start;
        }
        for (k, segment) in ast.segments.iter().enumerate() {
            let kind = self.segment_kind(&segment.curve);
            let to = self.point(&segment.to);
            let slot = &mut self.geometry.paths[at].segments[k];
            if let (Ok(kind), Ok(to)) = (kind, to) {
                (slot.kind, slot.to) = (kind, to);
            }
        }
    }

    fn segment_kind(&mut self, curve: &ast::Curve) -> Checked<SegmentKind> {
        match curve {
            ast::Curve::Line => Ok(SegmentKind::Line),
            ast::Curve::Arc { about, turn } => {
                let turn = match turn {
                    ast::Turn::CounterClockwise => Turn::Counterclockwise,
                    ast::Turn::Clockwise => Turn::Clockwise,
                };
                Ok(SegmentKind::Arc { about: self.point(about)?, turn })
            }
        }
    }

    fn point(&mut self, e: &ast::Expr) -> Checked<crate::model::Expr> {
        self.typed(e, &Type::POSITION, "a point", &Env::default())
    }

    /// The pieces of `loop(..)`.
    fn region_boundary(&mut self, value: &ast::Expr) -> Checked<Vec<Piece>> {
        let args = match &value.kind {
            ast::ExprKind::Call { callee, args }
                if !args.is_empty() && callee.as_name().is_some_and(|name| name.text == "loop") =>
            {
                args
            }
            _ => {
                let message = "a region is the inside of a loop of paths";
                return Err(self.report(
                    Diagnostic::error(Code::WrongKind, value.span, message)
                        .help("write `loop(a, b, axis)`, with paths and `path.label`s"),
                ));
            }
        };
        let mut boundary = Vec::new();
        let mut fault = None;
        for arg in args {
            if let Err(reported) = self.add_to_loop(&arg.value, &mut boundary) {
                fault = Some(reported);
            }
        }
        fault.map_or(Ok(boundary), Err)
    }

    /// Adds the edges of one argument of a loop.
    fn add_to_loop(&mut self, e: &ast::Expr, boundary: &mut Vec<Piece>) -> Checked<()> {
        let domain = self.domain(e, &Env::default())?;
        if domain::kind(&domain) != domain::Kind::Edges {
            return Err(self.report(Diagnostic::error(Code::WrongKind, e.span, "a loop is made of paths")));
        }
        for edge in domain.pieces {
            if boundary.contains(&edge) {
                let message = format!("{} is in this loop twice", self.piece_words(edge));
                return Err(self.report(Diagnostic::error(Code::DuplicateName, e.span, message)));
            }
            boundary.push(edge);
        }
        Ok(())
    }
}

/// A path with its labels and no coordinates.
fn outline(path: &ast::Path) -> Path {
    let segments = path.segments.iter().map(|segment| Segment {
        label: segment.label.as_ref().map(|label| label.text.clone()),
        kind: SegmentKind::Line,
        to: zero(segment.span),
        span: segment.span,
    });
    Path {
        name: path.name.text.clone(),
        start: zero(path.start.span),
        segments: segments.collect(),
        span: path.name.span,
    }
}
