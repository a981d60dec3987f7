//! Domains: where something holds, is integrated or reduced. Regions, paths, their labels, contact pairs, and sums of them.

use super::shape::settle;
use super::{Checked, Checker, Env, Meaning, Reported, Slot};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Domain, Expr, ExprKind, Pair, PairId, PathId, Piece, Reduction, Shape, Type};
use crate::resolve::scope::{Symbol, Word};
use crate::source::Span;
use crate::syntax::ast::{self, BinaryOp, ExprKind as Syntax, On};
use ansatz_units::Dimension;

/// What the pieces of a domain are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Cells of regions.
    Cells,
    /// Edges of paths.
    Edges,
    /// A contact pair or its first side.
    Contact,
}

impl Kind {
    /// The kind of one piece.
    pub(crate) fn of(piece: Piece) -> Self {
        match piece {
            Piece::Region(_) => Self::Cells,
            Piece::Path(_) | Piece::Segment(..) | Piece::Axis => Self::Edges,
            Piece::First(_) | Piece::Pair(_) => Self::Contact,
        }
    }

    /// What integrals over such a domain count, also in plane models, which are per unit depth.
    pub(crate) fn measure(self) -> Dimension {
        match self {
            Self::Cells => Dimension::LENGTH.pow(3),
            Self::Edges | Self::Contact => Dimension::LENGTH.pow(2),
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Cells => "this is a region",
            Self::Edges => "this is a path",
            Self::Contact => "this is a contact pair",
        }
    }
}

/// The kind of a domain, which has at least one piece.
pub(crate) fn kind(domain: &Domain) -> Kind {
    domain.pieces.first().map_or(Kind::Cells, |piece| Kind::of(*piece))
}

impl Checker<'_> {
    /// The domain that an expression names; its pieces are all cells, all edges or all contact.
    pub(super) fn domain(&mut self, e: &ast::Expr, env: &Env) -> Checked<Domain> {
        let mut pieces = Vec::new();
        self.pieces(e, env, &mut pieces)?;
        let first = pieces.first().copied();
        for (piece, span) in &pieces {
            if let Some((one, place)) = first
                && Kind::of(one) != Kind::of(*piece)
            {
                return Err(self.report(
                    Diagnostic::error(Code::MixedDomain, e.span, "these make no common domain")
                        .label(place, Kind::of(one).words())
                        .label(*span, Kind::of(*piece).words())
                        .help("write one statement for each"),
                ));
            }
        }
        let mut pieces: Vec<Piece> = pieces.into_iter().map(|(piece, _)| piece).collect();
        let whole = pieces.clone();
        pieces.retain(|piece| !matches!(piece, Piece::Segment(path, _) if whole.contains(&Piece::Path(*path))));
        pieces.sort_unstable();
        pieces.dedup();
        Ok(Domain { pieces, span: e.span })
    }

    fn pieces(&mut self, e: &ast::Expr, env: &Env, into: &mut Vec<(Piece, Span)>) -> Checked<()> {
        match &e.kind {
            Syntax::Binary { op: BinaryOp::Add, left, right, .. } => {
                let (a, b) = (self.pieces(left, env, into), self.pieces(right, env, into));
                a.and(b)
            }
            Syntax::Name(name) => self.named_pieces(name, e.span, env, into),
            Syntax::Member { object, member } => {
                if let Some(pair) = self.pair_named(object, env)? {
                    into.push((self.side(pair, member)?, e.span));
                    return Ok(());
                }
                let path = self.path_named(object, env)?;
                self.labelled(path, member, e.span, into)
            }
            Syntax::Call { callee, args } => match (callee.as_name(), args.as_slice()) {
                (Some(name), [arg]) if name.text == "reference" => self.pieces(&arg.value, env, into),
                (Some(name), [_]) if name.text == "current" => Err(self.report(
                    Diagnostic::error(Code::Unsupported, e.span, "integrals over the current configuration are not supported")
                        .help("without `current(..)` the reference configuration is meant"),
                )),
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

    fn named_pieces(&mut self, name: &str, span: Span, env: &Env, into: &mut Vec<(Piece, Span)>) -> Checked<()> {
        let symbol = if env.locals.iter().any(|(known, _)| known == name) { None } else { self.symbol(name, env) };
        let piece = match symbol {
            Some(Symbol::Region(id)) => Piece::Region(id),
            Some(Symbol::Path(id)) => Piece::Path(id),
            Some(Symbol::Word(Word::Axis)) => Piece::Axis,
            Some(Symbol::Broken) => return Err(Reported),
            Some(Symbol::Let(at)) => match self.meaning(at, span)? {
                Meaning::Domain(domain) => {
                    into.extend(domain.pieces.iter().map(|piece| (*piece, span)));
                    return Ok(());
                }
                Meaning::Pair(pair) => Piece::Pair(pair),
                Meaning::Value(_) => return Err(self.wrong_domain(name, "a value", span)),
            },
            Some(other) => return Err(self.wrong_domain(name, other.words(), span)),
            None if env.locals.iter().any(|(known, _)| known == name) => {
                return Err(self.wrong_domain(name, "a value", span));
            }
            None => return Err(self.unknown_domain(name, span)),
        };
        into.push((piece, span));
        Ok(())
    }

    fn wrong_domain(&mut self, name: &str, words: &str, span: Span) -> Reported {
        self.report(
            Diagnostic::error(Code::WrongKind, span, format!("`{name}` is {words}, not a domain"))
                .help("domains are regions, paths, `path.label`, contact pairs, and sums of them"),
        )
    }

    fn unknown_domain(&mut self, name: &str, span: Span) -> Reported {
        let places = |symbol| matches!(symbol, Symbol::Region(_) | Symbol::Path(_) | Symbol::Let(_) | Symbol::Broken);
        let candidates = self.names_of(places);
        let mut diagnostic = Diagnostic::error(Code::UnknownName, span, format!("there is no region or path `{name}`"))
            .help_did_you_mean(name, candidates);
        let labels = self.geometry.paths.iter().flat_map(|path| path.segments.iter().map(move |segment| (path, segment)));
        if let Some((path, _)) = labels.into_iter().find(|(_, segment)| segment.label.as_deref() == Some(name)) {
            diagnostic = diagnostic.help(format!("a label belongs to its path: `{}.{name}`", path.name));
        }
        self.report(diagnostic)
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

    fn labelled(&mut self, path: PathId, label: &ast::Ident, span: Span, into: &mut Vec<(Piece, Span)>) -> Checked<()> {
        let labels: Vec<Option<String>> = self.path_labels(path);
        let before = into.len();
        let found = labels.iter().enumerate().filter(|(_, known)| known.as_deref() == Some(&label.text));
        into.extend(found.map(|(at, _)| (Piece::Segment(path, at), span)));
        if into.len() > before {
            return Ok(());
        }
        let known: Vec<&str> = labels.iter().flatten().map(String::as_str).collect();
        let message = format!("the path has no label `{}`", label.text);
        let mut diagnostic =
            Diagnostic::error(Code::UnknownMember, label.span, message).help_did_you_mean(&label.text, known.iter().copied());
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
                    Some(Symbol::Let(at)) => member.text == "first" && is_pair(&self.lets[at].ast.value),
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

    /// The pair that a name stands for, if it does.
    pub(super) fn pair_named(&mut self, e: &ast::Expr, env: &Env) -> Checked<Option<PairId>> {
        let Syntax::Name(name) = &e.kind else { return Ok(None) };
        if env.locals.iter().any(|(known, _)| known == name) {
            return Ok(None);
        }
        match self.symbol(name, env) {
            Some(Symbol::Let(at)) if is_pair(&self.lets[at].ast.value) => match self.meaning(at, e.span)? {
                Meaning::Pair(id) => Ok(Some(id)),
                _ => Ok(None),
            },
            _ => Ok(None),
        }
    }

    fn side(&mut self, pair: PairId, side: &ast::Ident) -> Checked<Piece> {
        match side.text.as_str() {
            "first" => Ok(Piece::First(pair)),
            "second" => Err(self.report(
                Diagnostic::error(Code::Unsupported, side.span, "integrals over the second side are not supported")
                    .help("name the surfaces in the other order, or integrate `on` the pair for both sides"),
            )),
            _ => {
                let message = format!("a pair has no side `{}`", side.text);
                Err(self.report(
                    Diagnostic::error(Code::UnknownMember, side.span, message).help_did_you_mean(&side.text, ["first"]),
                ))
            }
        }
    }

    /// `touch.gap` as a value.
    pub(super) fn pair_member(&mut self, pair: PairId, member: &ast::Ident, span: Span) -> Checked<Expr> {
        match member.text.as_str() {
            "gap" => Ok(Expr { kind: ExprKind::Gap(pair), ty: Type::LENGTH, span }),
            "normal" | "other" => {
                let message = format!("`.{}` of a pair is not supported", member.text);
                Err(self.report(Diagnostic::error(Code::Unsupported, member.span, message)))
            }
            "first" | "second" => {
                let message = format!("`.{}` is a side of the pair, not a value", member.text);
                Err(self.report(Diagnostic::error(Code::WrongKind, span, message)))
            }
            _ => {
                let message = format!("a pair has no member `{}`", member.text);
                let diagnostic = Diagnostic::error(Code::UnknownMember, member.span, message)
                    .help_did_you_mean(&member.text, ["gap", "first"]);
                Err(self.report(diagnostic.help("it has `.gap` and the side `.first`")))
            }
        }
    }

    /// `pair(a, b, search: d)` as the value of a `let`.
    pub(super) fn pair(&mut self, name: &ast::Ident, args: &[ast::Arg], span: Span) -> Checked<PairId> {
        let env = Env::default();
        let [first, second, search] = args else {
            return Err(self.pair_form(span));
        };
        if first.name.is_some() || second.name.is_some() || search.name.as_ref().is_none_or(|name| name.text != "search") {
            return Err(self.pair_form(span));
        }
        let (a, b) = (self.surface(&first.value, &env), self.surface(&second.value, &env));
        let distance = self.typed(&search.value, &Type::LENGTH, "the search distance", &env);
        let (a, b, distance) = (a?, b?, distance?);
        if let Some(shared) = a.pieces.iter().find(|piece| b.pieces.iter().any(|other| overlap(**piece, *other))) {
            let words = self.piece_words(*shared);
            return Err(self.report(
                Diagnostic::error(Code::BadPair, span, "a surface cannot touch itself")
                    .label(a.span, format!("{words} is on this side"))
                    .label(b.span, "and on this one")
                    .help("name two surfaces without common parts"),
            ));
        }
        self.pairs.push(Pair { name: name.text.clone(), first: a, second: b, search: settle(distance), span });
        Ok(PairId(self.pairs.len() - 1))
    }

    fn pair_form(&mut self, span: Span) -> Reported {
        self.report(
            Diagnostic::error(Code::MissingArgument, span, "a pair is two surfaces and a search distance")
                .help("write `pair(nucleus, endo + cavity, search: 1.5 um)`"),
        )
    }

    /// A domain of edges.
    fn surface(&mut self, e: &ast::Expr, env: &Env) -> Checked<Domain> {
        let domain = self.domain(e, env)?;
        if kind(&domain) == Kind::Edges && !domain.pieces.contains(&Piece::Axis) {
            return Ok(domain);
        }
        Err(self.report(Diagnostic::error(Code::BadPair, e.span, "a contact surface is made of paths")))
    }

    pub(super) fn piece_words(&self, piece: Piece) -> String {
        piece_words(&self.geometry, &self.pairs, piece)
    }

    /// `mean(e on D)`, `max(e on run)`, `min(e on 30 s .. 70 s)`.
    pub(super) fn reduce(&mut self, name: &ast::Ident, arg: &ast::Arg, span: Span, env: &Env) -> Checked<Expr> {
        let reduction = match name.text.as_str() {
            "min" => Reduction::Min,
            "max" => Reduction::Max,
            "mean" => Reduction::Mean,
            _ => Reduction::Integral,
        };
        let value = self.settled(&arg.value, env);
        let times = match &arg.on {
            Some(On::Domain(domain)) if !self.is_word(domain, Word::Run, env) => {
                if let Syntax::Call { callee, .. } = &domain.kind
                    && self.is_word(callee, Word::Run, env)
                {
                    return self.expr(domain, env);
                }
                let domain = self.domain(domain, env);
                return self.reduce_domain(reduction, value?, domain?, span);
            }
            Some(On::Domain(_)) => None,
            Some(On::Times(range)) => {
                let low = self.typed(&range.low, &Type::TIME, "a stretch of time", env);
                let high = self.typed(&range.high, &Type::TIME, "a stretch of time", env);
                Some((Box::new(low?), Box::new(high?)))
            }
            None => {
                let help = format!("write `{}(e on D)`", name.text);
                let message = format!("`{}` needs a domain", name.text);
                return Err(self.report(Diagnostic::error(Code::MissingArgument, span, message).help(help)));
            }
        };
        let value = value?;
        let dimension = self.scalar(&value, "what is followed over the run")?;
        let dimension = if reduction == Reduction::Integral { dimension * Dimension::TIME } else { dimension };
        let kind = ExprKind::ReduceRun(reduction, Box::new(value), times);
        Ok(Expr { kind, ty: Type::Value(Shape::Scalar, dimension), span })
    }

    fn reduce_domain(&mut self, reduction: Reduction, value: Expr, domain: Domain, span: Span) -> Checked<Expr> {
        let (shape, dimension) = self.operand(&value)?;
        if domain.pieces.contains(&Piece::Axis) {
            return Err(self.no_measure(domain.span));
        }
        if matches!(reduction, Reduction::Min | Reduction::Max) && shape != Shape::Scalar {
            return Err(self.need_scalar(&value, "the smallest and the largest are defined for scalars"));
        }
        let dimension = if reduction == Reduction::Integral { dimension * kind(&domain).measure() } else { dimension };
        let kind = ExprKind::Reduce(reduction, Box::new(value), domain);
        Ok(Expr { kind, ty: Type::Value(shape, dimension), span })
    }

    fn no_measure(&mut self, span: Span) -> Reported {
        self.report(Diagnostic::error(Code::NotOnDomain, span, "the axis has no area"))
    }

    /// `area(D)`, `volume(D)`; `length(D)` is the length of a path in its plane.
    pub(super) fn measure(&mut self, name: &ast::Ident, e: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        let domain = self.domain(e, env)?;
        if domain.pieces.contains(&Piece::Axis) {
            return Err(self.no_measure(domain.span));
        }
        let of = kind(&domain);
        let fits = match name.text.as_str() {
            "area" => of != Kind::Cells,
            "volume" => of == Kind::Cells,
            _ => false,
        };
        if fits {
            return Ok(Expr { kind: ExprKind::Measure(domain), ty: Type::Value(Shape::Scalar, of.measure()), span });
        }
        let proper = if of == Kind::Cells { "volume" } else { "area" };
        let message = format!("the measure of this domain is its {proper}");
        Err(self.report(
            Diagnostic::error(Code::NotOnDomain, span, message)
                .label(e.span, of.words())
                .help(format!("write `{proper}({})`", self.sources.slice(e.span)))
                .help("paths stand for surfaces and regions for volumes; plane models count per unit depth"),
        ))
    }

    /// `force(block, D)`: the resultant that a block puts on a surface.
    pub(super) fn force(&mut self, block: &ast::Expr, on: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        let domain = self.domain(on, env);
        let symbol = block.as_name().and_then(|name| self.symbol(&name.text, env));
        let id = match symbol {
            Some(Symbol::Block(id)) => id,
            Some(Symbol::Broken) => return Err(Reported),
            _ => {
                let name = block.as_name().map_or(String::new(), |name| name.text);
                let blocks = self.names_of(|symbol| matches!(symbol, Symbol::Block(_)));
                let diagnostic = Diagnostic::error(Code::WrongKind, block.span, "the name of a physics block is needed here")
                    .help_did_you_mean(&name, blocks.iter().copied())
                    .help(format!("the blocks are `{}`", blocks.join("`, `")));
                return Err(self.report(diagnostic));
            }
        };
        let dimension = Dimension::named("Force").unwrap_or(Dimension::NUMBER);
        let kind = ExprKind::Force(id, domain?);
        Ok(Expr { kind, ty: Type::Value(Shape::Vector, dimension), span })
    }

    /// Labels of the segments of a path, by position.
    fn path_labels(&self, path: PathId) -> Vec<Option<String>> {
        self.geometry.paths[path.0].segments.iter().map(|segment| segment.label.clone()).collect()
    }

    /// What a `let` of the file or geometry names.
    pub(super) fn meaning(&mut self, at: usize, span: Span) -> Checked<Meaning> {
        match &self.lets[at].slot {
            Slot::Done(meaning) => return Ok(meaning.clone()),
            Slot::Broken => return Err(Reported),
            Slot::Busy => {
                self.lets[at].slot = Slot::Broken;
                let name = &self.lets[at].ast.name;
                let message = format!("`{}` is defined by itself", name.text);
                return Err(self.report(Diagnostic::error(Code::Cycle, name.span, message).label(span, "used here")));
            }
            Slot::Waiting => {}
        }
        self.lets[at].slot = Slot::Busy;
        let elaborated = self.let_meaning(at);
        if matches!(self.lets[at].slot, Slot::Broken) {
            return Err(Reported);
        }
        self.lets[at].slot = elaborated.as_ref().map_or(Slot::Broken, |meaning| Slot::Done(meaning.clone()));
        elaborated
    }
}

/// Whether the value of a `let` is a contact pair.
pub(super) fn is_pair(e: &ast::Expr) -> bool {
    matches!(&e.kind, Syntax::Call { callee, .. } if callee.as_name().is_some_and(|name| name.text == "pair"))
}

/// Whether two pieces of edges share an edge.
fn overlap(a: Piece, b: Piece) -> bool {
    match (a, b) {
        (Piece::Path(p), Piece::Segment(q, _)) | (Piece::Segment(q, _), Piece::Path(p)) => p == q,
        _ => a == b,
    }
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
                None => format!("segment {} of `{}`", at + 1, path.name),
            }
        }
        Piece::Axis => "`axis`".into(),
        Piece::First(id) => format!("`{}.first`", pairs[id.0].name),
        Piece::Pair(id) => format!("`{}`", pairs[id.0].name),
    }
}
