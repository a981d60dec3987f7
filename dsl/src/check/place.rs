//! Do values exist where they are used? A field lives on its regions, a gap on its pair, a state in a run; one number in time cannot vary in
//! space, and a parameter is known before everything else.

use super::context::{Context, Ingredient, ingredient};
use super::domain::piece_words;
use super::walk::{Definition, check_exprs, deep, no_circles};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{
    Action, Bounds, Builtin, Domain, Every, Expr, ExprKind, Field, Model, ParamId, Piece, RegionId,
    SegmentKind, Start, StatementKind, Trigger,
};
use crate::source::Span;
use std::collections::BTreeSet;

/// Reports everything that is used where it does not exist.
pub(super) fn check(model: &Model, sink: &mut Sink) {
    if !no_circles(model, sink) {
        return;
    }
    let mut placer = Placer { model, sink, reductions: Vec::new(), seen_reductions: BTreeSet::new() };
    placer.definitions();
    placer.params();
    placer.geometry();
    placer.unknowns();
    placer.physics();
    placer.run();
    placer.output();
    placer.tests();
    while let Some((inner, domain)) = placer.reductions.pop() {
        placer.place(inner, Context::on(domain));
    }
}

struct Placer<'m, 's> {
    model: &'m Model,
    sink: &'s mut Sink,
    /// Integrands that are still to be placed on the domains of their reductions.
    reductions: Vec<(&'m Expr, &'m Domain)>,
    seen_reductions: BTreeSet<Span>,
}

impl<'m> Placer<'m, '_> {
    /// Integrals stand on their own domains, wherever they are used.
    fn definitions(&mut self) {
        let lets = self.model.lets.iter().map(|item| &item.value);
        let functions = self.model.functions.iter();
        let bodies =
            functions.flat_map(|item| item.lets.iter().map(|(_, value)| value).chain([&item.result]));
        for e in lets.chain(bodies) {
            self.reductions_in(e);
        }
    }

    fn reductions_in(&mut self, e: &'m Expr) {
        self.reduction(e);
        e.children().into_iter().for_each(|child| self.reductions_in(child));
    }

    /// Notes the integrand of a reduction for its own domain.
    fn reduction(&mut self, e: &'m Expr) {
        if let ExprKind::Reduce(_, inner, domain) = &e.kind
            && self.seen_reductions.insert(e.span)
        {
            self.reductions.push((inner, domain));
        }
    }

    fn params(&mut self) {
        for (at, param) in self.model.params.iter().enumerate() {
            self.place(&param.default, Context::CONSTANT);
            match &param.bounds {
                Some(Bounds::Range(low, high)) => self.all([low, high], Context::CONSTANT),
                Some(Bounds::Set(items)) => self.all(items, Context::CONSTANT),
                None => {}
            }
            self.declared_before(ParamId(at));
        }
    }

    /// Defaults use earlier parameters only, so that they can be given in order.
    fn declared_before(&mut self, id: ParamId) {
        let mut later = None;
        let model = self.model;
        deep(model, &model.params[id.0].default, &mut |e| match e.kind {
            ExprKind::Param(other) if other > id => later = later.or(Some(other)),
            _ => {}
        });
        if let Some(other) = later {
            let (param, other) = (&model.params[id.0], &model.params[other.0]);
            let message =
                format!("the default of `{}` uses `{}`, which is declared after it", param.name, other.name);
            self.sink.push(
                Diagnostic::error(Code::NotConstant, param.default.span, message)
                    .label(other.span, "declared here")
                    .help(format!("move `param {}` before it", other.name)),
            );
        }
    }

    fn geometry(&mut self) {
        for path in &self.model.geometry.paths {
            self.place(&path.start, Context::CONSTANT);
            for segment in &path.segments {
                self.place(&segment.to, Context::CONSTANT);
                if let SegmentKind::Arc { about, .. } = &segment.kind {
                    self.place(about, Context::CONSTANT);
                }
            }
        }
        let mesh = &self.model.mesh;
        for (size, domain) in &mesh.sizes {
            self.place(size, Context::mesh_size(domain.as_ref()));
        }
        self.all(mesh.growth.iter().chain(&mesh.quality), Context::CONSTANT);
        self.all(self.model.pairs.iter().map(|pair| &pair.search), Context::CONSTANT);
    }

    fn unknowns(&mut self) {
        for field in &self.model.fields {
            if let Start::Value(e) | Start::Guess(e) = &field.start {
                self.place(e, Context::field_start(&field.domain));
            }
        }
        for state in &self.model.states {
            if let Start::Value(e) | Start::Guess(e) = &state.start {
                self.place(e, Context::START);
            }
            if let Some((low, high)) = &state.bounds {
                self.all([low, high], Context::CONSTANT);
            }
        }
    }

    fn physics(&mut self) {
        for statement in self.model.blocks.iter().flat_map(|block| &block.statements) {
            match &statement.kind {
                StatementKind::Energy(density, domain) => self.place(density, on_or_global(domain.as_ref())),
                StatementKind::Residual(form, domain) => self.place(form, Context::weak(domain)),
                StatementKind::Load(quantity, force, domain) => {
                    self.all([quantity, force], on_or_global(domain.as_ref()));
                }
                StatementKind::Hold(field, _, held, domain) => {
                    self.place(held, Context::on(domain));
                    self.field_on(&self.model.fields[field.0], domain, statement.span, None);
                }
                StatementKind::Tie(tie, domain) => {
                    for field in [tie.field, tie.partner] {
                        self.tied_on(&self.model.fields[field.0], domain, statement.span);
                    }
                }
                StatementKind::Equation(a, b) => self.all([a, b], Context::GLOBAL),
            }
        }
    }

    fn run(&mut self) {
        for event in &self.model.events {
            match &event.trigger {
                Trigger::When(condition) => self.place(condition, Context::EVENT),
                Trigger::Every(time) => self.place(time, Context::CONSTANT),
                Trigger::EveryStep => {}
            }
            for action in &event.actions {
                if let Action::Set(_, value) = action {
                    self.place(value, Context::GLOBAL);
                }
            }
        }
        let solve = &self.model.solve;
        let times = solve.time.iter().flat_map(|(from, to)| [from, to]);
        let numbers = [&solve.step_tolerance, &solve.newton_tolerance, &solve.newton_iterations];
        self.all(times.chain(&solve.max_step).chain(&solve.min_step).chain(numbers), Context::CONSTANT);
    }

    fn output(&mut self) {
        let output = &self.model.output;
        let frames = output.frames.iter().map(|frames| &frames.every);
        let intervals =
            frames.chain(output.tables.iter().map(|table| &table.every)).chain(&output.checkpoint);
        for every in intervals {
            if let Every::Time(time) = every {
                self.place(time, Context::CONSTANT);
            }
        }
        for frames in &output.frames {
            self.all(frames.columns.iter().map(|column| &column.value), Context::on(&frames.domain));
        }
        for table in &output.tables {
            self.all(table.columns.iter().map(|column| &column.value), Context::GLOBAL);
        }
        for sweep in &self.model.sweeps {
            self.all(sweep.axes.iter().flat_map(|(_, values)| values.iter().flatten()), Context::CONSTANT);
            self.all(sweep.columns.iter().filter_map(|(_, value)| value.as_ref()), Context::RESULT);
        }
    }

    fn tests(&mut self) {
        for check in self.model.tests.iter().flat_map(|test| &test.checks) {
            self.all(check_exprs(check), Context::TEST);
        }
    }

    fn all<'e>(&mut self, items: impl IntoIterator<Item = &'m Expr>, context: Context<'e>)
    where
        'm: 'e,
    {
        items.into_iter().for_each(|item| self.place(item, context));
    }

    fn place(&mut self, e: &'m Expr, context: Context<'_>) {
        self.walk(e, context, None, &mut BTreeSet::new());
    }

    /// `via` is where a definition is used whose inside is walked.
    fn walk(
        &mut self,
        e: &'m Expr,
        context: Context<'_>,
        via: Option<Span>,
        seen: &mut BTreeSet<Definition>,
    ) {
        if let Some(found) = ingredient(e)
            && !context.known.contains(&found)
        {
            return self.not_known(e, found, context, via);
        }
        if let Some(domain) = context.domain {
            self.exists(e, domain, via);
        }
        match &e.kind {
            ExprKind::Reduce(..) => return self.reduction(e),
            ExprKind::ReduceRun(_, inner, times) => {
                self.walk(inner, Context::GLOBAL, via, &mut BTreeSet::new());
                for time in times.iter().flat_map(|(from, to)| [from, to]) {
                    self.walk(time, Context::CONSTANT, via, &mut BTreeSet::new());
                }
                return;
            }
            ExprKind::AtTime(inner, place) => {
                self.walk(inner, Context::GLOBAL, via, &mut BTreeSet::new());
                self.walk(place, Context::CONSTANT, via, &mut BTreeSet::new());
                return;
            }
            ExprKind::AtEvent(inner, _) => {
                return self.walk(inner, Context::GLOBAL, via, &mut BTreeSet::new());
            }
            ExprKind::AtPoint(_, place) => {
                return self.walk(place, Context::CONSTANT, via, &mut BTreeSet::new());
            }
            _ => {}
        }
        for child in e.children() {
            self.walk(child, context, via, seen);
        }
        if let Some(definition) = Definition::of(e)
            && seen.insert(definition)
        {
            for body in definition.bodies(self.model) {
                self.walk(body, context, via.or(Some(e.span)), seen);
            }
        }
    }

    /// Something is used where it is not known.
    fn not_known(&mut self, e: &Expr, found: Ingredient, context: Context<'_>, via: Option<Span>) {
        let what = self.words(e);
        let pointwise = matches!(
            found,
            Ingredient::Field | Ingredient::Coordinate | Ingredient::Region | Ingredient::Gap
        );
        let global = context.known.contains(&Ingredient::State);
        let test = context.known.contains(&Ingredient::Run);
        let (code, message, help) = match found {
            Ingredient::Test => {
                (Code::Misplaced, format!("{what} stands in residuals only"), "write `residual .. on D;`")
            }
            Ingredient::Held => (
                Code::Misplaced,
                format!("{what} stands in conditions of events only"),
                "`event e when .. for 60 s;`",
            ),
            Ingredient::Run => {
                (Code::NeedsRun, format!("{what} is known only after it"), "it stands in tests and sweeps")
            }
            _ if pointwise && global => (
                Code::VariesInSpace,
                format!("{what} varies in space, and one number is needed here"),
                "reduce it to a number: `mean(e on D)`, `integral`, `min` or `max`",
            ),
            _ if test => (
                Code::NeedsRun,
                format!("{what} changes during a run, and a test has no time of its own"),
                "say when: `e@(50 s)`, `e@event`, `max(e on run)`",
            ),
            _ => (
                Code::NotConstant,
                format!("{what} is not known before the run"),
                "only parameters and constants can be used here",
            ),
        };
        let mut diagnostic = Diagnostic::error(code, via.unwrap_or(e.span), message);
        if via.is_some_and(|via| via != e.span) {
            diagnostic = diagnostic.label(e.span, "it comes in here");
        }
        self.sink.push(diagnostic.help(help));
    }

    fn words(&self, e: &Expr) -> String {
        let model = self.model;
        match &e.kind {
            ExprKind::Field(id) => format!("field `{}`", model.fields[id.0].name),
            ExprKind::Test(id) => format!("`test({})`", model.fields[id.0].name),
            ExprKind::State(id) => format!("state `{}`", model.states[id.0].name),
            ExprKind::Coordinate(i) => format!("coordinate `{}`", model.coordinates.names[*i]),
            ExprKind::Normal(_) => "a normal".into(),
            ExprKind::Builtin(..) => "a derivative in space".into(),
            ExprKind::Gap(id) => format!("`{}.gap`", model.pairs[id.0].name),
            ExprKind::PairNormal(id) => format!("`{}.normal`", model.pairs[id.0].name),
            ExprKind::Time => "the time `t`".into(),
            ExprKind::MatchRegion(..) => "a choice by region".into(),
            ExprKind::Reduce(..) | ExprKind::AtPoint(..) => "a value of the solution".into(),
            ExprKind::Force(..) => "a force".into(),
            ExprKind::Measure(_) => "a measure of the mesh".into(),
            ExprKind::Held(..) => "`for`".into(),
            _ => "a value of the run".into(),
        }
    }

    /// Whether the value exists on the domain.
    fn exists(&mut self, e: &Expr, domain: &Domain, via: Option<Span>) {
        match &e.kind {
            ExprKind::Field(id) | ExprKind::Test(id) => {
                self.field_on(&self.model.fields[id.0], domain, via.unwrap_or(e.span), Some(e.span));
            }
            ExprKind::Normal(_) if super::domain::kind(domain) != super::domain::Kind::Edges => {
                self.missing(via.unwrap_or(e.span), e.span, domain, "a normal exists on paths only".into());
            }
            ExprKind::Normal(of) if super::domain::kind(of) == super::domain::Kind::Edges => {
                if let Some(piece) = self.model.outside(domain, of) {
                    let message = format!("this normal is not that of {}", self.piece(piece));
                    self.missing(via.unwrap_or(e.span), e.span, domain, message);
                }
            }
            ExprKind::Builtin(Builtin::Along, _)
                if super::domain::kind(domain) != super::domain::Kind::Edges =>
            {
                let message = "a derivative along a path exists on paths only".into();
                self.missing(via.unwrap_or(e.span), e.span, domain, message);
            }
            ExprKind::Gap(id) | ExprKind::PairNormal(id) => {
                let here = domain.pieces.iter().all(|piece| matches!(piece, Piece::Pair(p, _) if p == id));
                if !here {
                    let (name, what) = (&self.model.pairs[id.0].name, self.words(e));
                    let message = format!("{what} exists on the surfaces of `{name}` only");
                    self.missing(via.unwrap_or(e.span), e.span, domain, message);
                }
            }
            ExprKind::MatchRegion(arms, None) => {
                let covered: Vec<RegionId> = arms.iter().map(|(region, _)| *region).collect();
                if let Some(piece) = self.model.uncovered(domain, &covered) {
                    let names =
                        covered.iter().map(|r| format!("`{}`", self.model.geometry.regions[r.0].name));
                    let message = format!("this choice by region has no arm for {}", self.piece(piece));
                    let help =
                        format!("it has {}; add an arm or `else`", names.collect::<Vec<_>>().join(", "));
                    let mut diagnostic = Diagnostic::error(Code::IncompleteMatch, e.span, message)
                        .label(domain.span, "it is needed here")
                        .help(help);
                    if let Some(via) = via.filter(|via| *via != e.span) {
                        diagnostic = diagnostic.label(via, "through this");
                    }
                    self.sink.push(diagnostic);
                }
            }
            _ => {}
        }
    }

    fn missing(&mut self, place: Span, inner: Span, domain: &Domain, message: String) {
        let mut diagnostic =
            Diagnostic::error(Code::NotOnDomain, place, message).label(domain.span, "it is needed here");
        if inner != place {
            diagnostic = diagnostic.label(inner, "it comes in here");
        }
        self.sink.push(diagnostic);
    }

    fn field_on(&mut self, field: &Field, domain: &Domain, place: Span, inner: Option<Span>) {
        if let Some(piece) = self.model.without(field, domain) {
            let message = format!("field `{}` does not exist on {}", field.name, self.piece(piece));
            self.missing(place, inner.unwrap_or(place), domain, message);
        }
    }

    /// Both fields of a tie exist on its surface, such as that between a fluid and a body.
    fn tied_on(&mut self, field: &Field, domain: &Domain, place: Span) {
        let Some(piece) = self.model.without(field, domain) else { return };
        let (name, here) = (&field.name, self.piece(piece));
        let lives: Vec<String> = field.domain.pieces.iter().map(|piece| self.piece(*piece)).collect();
        let lives = lives.join(", ");
        let message = format!("field `{name}` cannot be tied on {here}, where it does not exist");
        self.sink.push(
            Diagnostic::error(Code::NotOnDomain, place, message)
                .label(domain.span, "it is needed here")
                .label(field.span, format!("`{name}` lives on {lives}"))
                .help(format!(
                    "a tie joins two fields where both exist: {here} does not bound what `{name}` lives on"
                )),
        );
    }

    fn piece(&self, piece: Piece) -> String {
        piece_words(&self.model.geometry, &self.model.pairs, piece)
    }
}

fn on_or_global(domain: Option<&Domain>) -> Context<'_> {
    domain.map_or(Context::GLOBAL, Context::on)
}
