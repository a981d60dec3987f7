//! Domains: where something holds, is integrated or reduced. Regions, paths, their labels, contact pairs, and sums of them.

use super::pair::is_pair;
use super::{Checked, Checker, Env, Meaning, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Domain, Pair, PathId, Piece, Sides};
use crate::resolve::scope::{Symbol, Word};
use crate::source::Span;
use crate::syntax::ast::{self, BinaryOp, ExprKind as Syntax};
use ansatz_units::Dimension;

/// What the pieces of a domain are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Cells of regions.
    Cells,
    /// Edges of paths.
    Edges,
    /// First or last points of paths.
    Ends,
    /// A contact pair or one side of it.
    Contact,
}

impl Kind {
    /// The kind of one piece.
    pub(crate) fn of(piece: Piece) -> Self {
        match piece {
            Piece::Region(_) => Self::Cells,
            Piece::Path(_) | Piece::Segment(..) | Piece::Axis => Self::Edges,
            Piece::Start(_) | Piece::End(_) => Self::Ends,
            Piece::Pair(..) => Self::Contact,
        }
    }

    /// What integrals over such a domain count, also in plane models, which are per unit depth.
    pub(crate) fn measure(self) -> Dimension {
        match self {
            Self::Cells => Dimension::LENGTH.pow(3),
            Self::Edges | Self::Contact => Dimension::LENGTH.pow(2),
            Self::Ends => Dimension::LENGTH,
        }
    }

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Cells => "this is a region",
            Self::Edges => "this is a path",
            Self::Ends => "this is an end of a path",
            Self::Contact => "this is a contact pair",
        }
    }
}

/// A piece of a domain where it is named.
#[derive(Clone, Copy, Debug)]
struct Named {
    piece: Piece,
    /// Inside `current(..)`.
    current: bool,
    span: Span,
}

/// The kind of a domain, which has at least one piece.
pub(crate) fn kind(domain: &Domain) -> Kind {
    domain.pieces.first().map_or(Kind::Cells, |piece| Kind::of(*piece))
}

impl Checker<'_> {
    /// The domain that an expression names, in the reference configuration; its pieces are all cells, all edges or all contact.
    pub(super) fn domain(&mut self, e: &ast::Expr, env: &Env) -> Checked<Domain> {
        let domain = self.integrated(e, env)?;
        if domain.current {
            return Err(self.report(
                Diagnostic::error(Code::NotOnDomain, e.span, "the reference configuration is meant here")
                    .help("`current(..)` stands in energies, residuals, loads, `mean` and `integral`"),
            ));
        }
        Ok(domain)
    }

    /// The domain that an expression names, over which one integrates in the reference or the current configuration.
    pub(super) fn integrated(&mut self, e: &ast::Expr, env: &Env) -> Checked<Domain> {
        let domain = self.places(e, env)?;
        match kind(&domain) {
            Kind::Ends => Err(self.report(
                Diagnostic::error(
                    Code::NotOnDomain,
                    e.span,
                    "an end of a path is a point, which has no area",
                )
                .help("`hold` and mesh sizes stand there; the value at a point is `e@(x, y)`"),
            )),
            Kind::Cells if domain.current => {
                let what = "integrals over the current configuration of regions are not supported";
                Err(self.report(
                    Diagnostic::error(Code::Unsupported, e.span, what)
                        .help("multiply by the change of volume: `integral(det(F(u)) on D)`"),
                ))
            }
            _ => Ok(domain),
        }
    }

    /// The places that an expression names: a domain, or ends of paths.
    pub(super) fn places(&mut self, e: &ast::Expr, env: &Env) -> Checked<Domain> {
        let mut pieces = Vec::new();
        self.pieces(e, env, &mut pieces)?;
        self.one_kind(&pieces, e.span)?;
        Ok(joined(pieces, e.span))
    }

    /// The regions and paths on which a field lives.
    pub(super) fn carrier(&mut self, e: &ast::Expr) -> Checked<Domain> {
        let mut pieces = Vec::new();
        self.pieces(e, &Env::default(), &mut pieces)?;
        let carries =
            |named: &&Named| matches!(Kind::of(named.piece), Kind::Cells | Kind::Edges) && !named.current;
        match pieces.iter().find(|named| !carries(named)) {
            None => Ok(joined(pieces, e.span)),
            Some(Named { piece, span, .. }) => Err(self.report(
                Diagnostic::error(Code::NotOnDomain, *span, "a field lives on regions and paths")
                    .here(Kind::of(*piece).words()),
            )),
        }
    }

    /// Refuses pieces of different kinds and configurations.
    fn one_kind(&mut self, pieces: &[Named], span: Span) -> Checked<()> {
        let Some(first) = pieces.first() else { return Ok(()) };
        let words = |named: &Named, other: &Named| match (named.current, other.current) {
            (true, false) => "this is measured as it has moved",
            (false, true) => "this is measured in the reference configuration",
            _ => Kind::of(named.piece).words(),
        };
        let same =
            |other: &&Named| Kind::of(first.piece) == Kind::of(other.piece) && first.current == other.current;
        match pieces.iter().find(|other| !same(other)) {
            None => Ok(()),
            Some(other) => Err(self.report(
                Diagnostic::error(Code::MixedDomain, span, "these make no common domain")
                    .label(first.span, words(first, other))
                    .label(other.span, words(other, first))
                    .help("write one statement for each"),
            )),
        }
    }

    fn pieces(&mut self, e: &ast::Expr, env: &Env, into: &mut Vec<Named>) -> Checked<()> {
        match &e.kind {
            Syntax::Binary { op: BinaryOp::Add, left, right, .. } => {
                let (a, b) = (self.pieces(left, env, into), self.pieces(right, env, into));
                a.and(b)
            }
            Syntax::Name(name) => self.named_pieces(name, e.span, env, into),
            Syntax::Member { object, member } => {
                if let Some(pair) = self.pair_named(object, env)? {
                    let piece = self.side(pair, member)?;
                    into.push(Named { piece, current: false, span: e.span });
                    return Ok(());
                }
                let path = self.path_named(object, env)?;
                self.labelled(path, member, e.span, into)
            }
            Syntax::Call { callee, args } => match (callee.as_name(), args.as_slice()) {
                (Some(name), [arg]) if matches!(name.text.as_str(), "current" | "reference") => {
                    let before = into.len();
                    self.pieces(&arg.value, env, into)?;
                    into[before..].iter_mut().for_each(|named| named.current = name.text == "current");
                    Ok(())
                }
                _ => Err(self.no_domain_here(e.span)),
            },
            _ => Err(self.no_domain_here(e.span)),
        }
    }

    fn no_domain_here(&mut self, span: Span) -> Reported {
        self.report(
            Diagnostic::error(Code::WrongKind, span, "a domain is needed here")
                .help("domains are regions, paths, `path.label`, contact pairs, and sums of them"),
        )
    }

    fn named_pieces(&mut self, name: &str, span: Span, env: &Env, into: &mut Vec<Named>) -> Checked<()> {
        let symbol =
            if env.locals.iter().any(|(known, _)| known == name) { None } else { self.symbol(name, env) };
        let piece = match symbol {
            Some(Symbol::Region(id)) => Piece::Region(id),
            Some(Symbol::Path(id)) => Piece::Path(id),
            Some(Symbol::Word(Word::Axis)) => Piece::Axis,
            Some(Symbol::Broken) => return Err(Reported),
            Some(Symbol::Let(at)) => match self.meaning(at, span)? {
                Meaning::Domain(domain) => {
                    let current = domain.current;
                    into.extend(domain.pieces.iter().map(|&piece| Named { piece, current, span }));
                    return Ok(());
                }
                Meaning::Pair(pair) => Piece::Pair(pair, Sides::Both),
                Meaning::Value(_) => return Err(self.wrong_domain(name, "a value", span)),
            },
            Some(other) => return Err(self.wrong_domain(name, other.words(), span)),
            None if env.locals.iter().any(|(known, _)| known == name) => {
                return Err(self.wrong_domain(name, "a value", span));
            }
            None => return Err(self.unknown_domain(name, span)),
        };
        into.push(Named { piece, current: false, span });
        Ok(())
    }

    fn wrong_domain(&mut self, name: &str, words: &str, span: Span) -> Reported {
        self.report(
            Diagnostic::error(Code::WrongKind, span, format!("`{name}` is {words}, not a domain"))
                .help("domains are regions, paths, `path.label`, contact pairs, and sums of them"),
        )
    }

    fn unknown_domain(&mut self, name: &str, span: Span) -> Reported {
        let places =
            |symbol| matches!(symbol, Symbol::Region(_) | Symbol::Path(_) | Symbol::Let(_) | Symbol::Broken);
        let candidates = self.names_of(places);
        let mut diagnostic =
            Diagnostic::error(Code::UnknownName, span, format!("there is no region or path `{name}`"))
                .help_did_you_mean(name, candidates);
        let labels = self
            .geometry
            .paths
            .iter()
            .flat_map(|path| path.segments.iter().map(move |segment| (path, segment)));
        if let Some((path, _)) =
            labels.into_iter().find(|(_, segment)| segment.label.as_deref() == Some(name))
        {
            diagnostic = diagnostic.help(format!("a label belongs to its path: `{}.{name}`", path.name));
        }
        for help in self.known_places() {
            diagnostic = diagnostic.help(help);
        }
        let diagnostic = self.was_dropped(name, diagnostic);
        self.report(diagnostic)
    }

    /// Every name of places, a line for each kind.
    fn known_places(&self) -> Vec<String> {
        let named = |is: &dyn Fn(Symbol) -> bool| {
            let names = self.scopes[0].iter().filter(|(_, symbol)| is(*symbol));
            names.map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        };
        let value = |at: usize| &self.lets[at].ast.value;
        let pair = |symbol| matches!(symbol, Symbol::Let(at) if is_pair(value(at)));
        let sum = |symbol| {
            let places = |at| !is_pair(value(at)) && self.names_places(value(at), &Env::default(), 0);
            matches!(symbol, Symbol::Let(at) if places(at))
        };
        let kinds = [
            ("regions", named(&|symbol| matches!(symbol, Symbol::Region(_)))),
            ("paths", named(&|symbol| matches!(symbol, Symbol::Path(_)))),
            ("sums", named(&sum)),
            ("pairs", named(&pair)),
        ];
        let known = kinds.into_iter().filter(|(_, names)| !names.is_empty());
        known.map(|(kind, names)| format!("{kind}: {names}")).collect()
    }

    fn path_named(&mut self, e: &ast::Expr, env: &Env) -> Checked<PathId> {
        let Some(name) = e.as_name() else { return Err(self.no_domain_here(e.span)) };
        match self.symbol(&name.text, env) {
            Some(Symbol::Path(id)) => Ok(id),
            Some(Symbol::Broken) => Err(Reported),
            Some(other) => {
                let message = format!("`{}` is {}, which has no labels", name.text, other.words());
                Err(self.report(Diagnostic::error(Code::WrongKind, e.span, message)))
            }
            None => Err(self.unknown_domain(&name.text, e.span)),
        }
    }

    fn labelled(
        &mut self,
        path: PathId,
        label: &ast::Ident,
        span: Span,
        into: &mut Vec<Named>,
    ) -> Checked<()> {
        let labels: Vec<Option<String>> = self.path_labels(path);
        let before = into.len();
        let found = labels.iter().enumerate().filter(|(_, known)| known.as_deref() == Some(&label.text));
        into.extend(found.map(|(at, _)| Named { piece: Piece::Segment(path, at), current: false, span }));
        if into.len() > before {
            return Ok(());
        }
        let end = match label.text.as_str() {
            "start" => Some(Piece::Start(path)),
            "end" => Some(Piece::End(path)),
            _ => None,
        };
        if let Some(end) = end {
            into.push(Named { piece: end, current: false, span });
            return Ok(());
        }
        let known: Vec<&str> = labels.iter().flatten().map(String::as_str).collect();
        let message = format!("path `{}` has no label `{}`", self.geometry.paths[path.0].name, label.text);
        let mut diagnostic = Diagnostic::error(Code::UnknownMember, label.span, message)
            .help_did_you_mean(&label.text, known.iter().copied());
        if !known.is_empty() {
            diagnostic = diagnostic.help(format!("its labels are `{}`", known.join("`, `")));
        }
        Err(self.report(diagnostic))
    }

    /// Whether the value of a `let` names places rather than a number; circles are left to the elaboration.
    pub(super) fn names_places(&self, e: &ast::Expr, env: &Env, depth: usize) -> bool {
        match &e.kind {
            Syntax::Binary { op: BinaryOp::Add, left, .. } => self.names_places(left, env, depth),
            Syntax::Member { object, member } => match &object.kind {
                Syntax::Name(name) => match self.symbol(name, env) {
                    Some(Symbol::Path(_)) => true,
                    Some(Symbol::Let(at)) => {
                        matches!(member.text.as_str(), "first" | "second")
                            && is_pair(&self.lets[at].ast.value)
                    }
                    _ => false,
                },
                _ => false,
            },
            Syntax::Name(name) => match self.symbol(name, env) {
                Some(Symbol::Region(_) | Symbol::Path(_) | Symbol::Word(Word::Axis)) => true,
                Some(Symbol::Let(at)) => {
                    let value = &self.lets[at].ast.value;
                    depth < self.lets.len() && (is_pair(value) || self.names_places(value, env, depth + 1))
                }
                _ => false,
            },
            Syntax::Call { callee, .. } => {
                callee.as_name().is_some_and(|name| matches!(name.text.as_str(), "current" | "reference"))
            }
            _ => false,
        }
    }

    pub(super) fn piece_words(&self, piece: Piece) -> String {
        piece_words(&self.geometry, &self.pairs, piece)
    }

    /// Labels of the segments of a path, by position.
    fn path_labels(&self, path: PathId) -> Vec<Option<String>> {
        self.geometry.paths[path.0].segments.iter().map(|segment| segment.label.clone()).collect()
    }
}

/// A domain of these pieces, each once, in ascending order; the labels of a path that is there as a whole say nothing more.
fn joined(pieces: Vec<Named>, span: Span) -> Domain {
    let current = pieces.first().is_some_and(|first| first.current);
    let mut pieces: Vec<Piece> = pieces.into_iter().map(|named| named.piece).collect();
    let whole = pieces.clone();
    pieces.retain(|piece| !matches!(piece, Piece::Segment(path, _) if whole.contains(&Piece::Path(*path))));
    pieces.sort_unstable();
    pieces.dedup();
    Domain { pieces, current, span }
}

/// A piece by its names.
pub(crate) fn piece_words(geometry: &crate::model::Geometry, pairs: &[Pair], piece: Piece) -> String {
    match piece {
        Piece::Region(id) => format!("`{}`", geometry.regions[id.0].name),
        Piece::Path(id) => format!("`{}`", geometry.paths[id.0].name),
        Piece::Segment(id, at) => {
            let path = &geometry.paths[id.0];
            match &path.segments[at].label {
                Some(label) => format!("`{}.{label}`", path.name),
                None if path.segments.len() == 1 => format!("`{}`", path.name),
                None => format!("segment {} of `{}`", at + 1, path.name),
            }
        }
        Piece::Axis => "`axis`".into(),
        Piece::Start(id) => format!("`{}.start`", geometry.paths[id.0].name),
        Piece::End(id) => format!("`{}.end`", geometry.paths[id.0].name),
        Piece::Pair(id, sides) => {
            let name = &pairs[id.0].name;
            match sides {
                Sides::First => format!("`{name}.first`"),
                Sides::Second => format!("`{name}.second`"),
                Sides::Both => format!("`{name}`"),
            }
        }
    }
}
