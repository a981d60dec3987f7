//! Loads: what they are times what they work on is virtual work, or virtual power where the rest of the balance is one.

use super::physics::{energy, measured_words, per_measure};
use super::work::{balances, dimension, is_work, varied, words};
use super::{domain, unit};
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::model::{Domain, Expr, ExprKind, Frame, Model, Shape, StatementKind};
use crate::source::{SourceMap, Span};
use ansatz_units::Dimension;

/// A load and what it works on.
struct Load<'m> {
    quantity: &'m Expr,
    force: &'m Expr,
    domain: Option<&'m Domain>,
    /// Dimensions of the two.
    dimensions: [Dimension; 2],
}

/// Reports loads that are neither.
pub(super) fn check(model: &Model, sources: &SourceMap, sink: &mut Sink) {
    let known = balances(model);
    for statement in model.blocks.iter().flat_map(|block| &block.statements) {
        let StatementKind::Load(quantity, force, domain) = &statement.kind else { continue };
        let Some((fields, work, _)) = varied(model, &statement.kind) else { continue };
        let (Some(q), Some(f)) = (dimension(quantity), dimension(force)) else { continue };
        if !is_work(work) {
            let balance = fields
                .iter()
                .find_map(|field| Some((model.fields[field.0].name.as_str(), *known.get(field)?)));
            let load = Load { quantity, force, domain: domain.as_ref(), dimensions: [q, f] };
            sink.push(load.diagnostic(model, sources, balance));
        }
    }
}

impl Load<'_> {
    /// "this load is a Force, but `on nucleus` needs a Pressure", with the balance that says so: its field, its integral and a statement of it.
    fn diagnostic(
        &self,
        model: &Model,
        sources: &SourceMap,
        balance: Option<(&str, (Dimension, Span))>,
    ) -> Diagnostic {
        let total = balance.map_or(energy(), |(_, (total, _))| total);
        let [q, f] = self.dimensions;
        let want = per_measure(total, self.domain) / q;
        let place = self
            .domain
            .map_or_else(|| "without `on` it".into(), |d| format!("`on {}`", sources.slice(d.span)));
        let message = format!("this load is {}, but {place} needs {}", described(f), described(want));
        let this = |e: &Expr| format!("this is {}", unit::words(&model.units, &e.ty));
        let mut diagnostic = Diagnostic::error(Code::LoadDimension, self.force.span, message)
            .here(this(self.force))
            .label(self.quantity.span, this(self.quantity));
        if let Some(domain) = self.domain {
            diagnostic = diagnostic.label(domain.span, measured_words(domain));
            if domain::kind(domain) != domain::Kind::Contact
                && f == want * domain::kind(domain).measure()
                && let Some(help) = self.spread(sources, domain)
            {
                diagnostic = diagnostic.help(help);
            }
        }
        if let Some((name, (_, other))) = balance.filter(|_| total != energy()) {
            diagnostic = diagnostic
                .label(other, format!("a term of the same balance: its integral is {}", described(total)))
                .help(format!(
                    "the balance of `{name}` is one of powers: load times quantity is a power as well"
                ));
        }
        if model.coordinates.frame == Frame::PlaneStrain
            && self.domain.is_none()
            && f * Dimension::LENGTH == want
        {
            let unit = model.units.unit_of(Dimension::LENGTH);
            diagnostic = diagnostic.help(format!(
                "a plane model is 1 {unit} deep: what acts per depth is a total after multiplication by `(1 {unit})`"
            ));
        }
        diagnostic
    }

    /// Help for a total where a density is needed: its first parameter over the measure of the domain.
    fn spread(&self, sources: &SourceMap, domain: &Domain) -> Option<String> {
        let (q, d) = (sources.slice(self.quantity.span), sources.slice(domain.span));
        let measure = if domain::kind(domain) == domain::Kind::Cells { "volume" } else { "area" };
        let (text, total) = (sources.slice(self.force.span), leading_total(self.force)?);
        let name = sources.slice(total.span);
        let first = self.force.span.start;
        let (start, end) = (total.span.start.checked_sub(first)?, total.span.end.checked_sub(first)?);
        let (before, after) = (text.get(..start as usize)?, text.get(end as usize..)?);
        Some(format!(
            "`{name}` looks like a total; spread it: `load {q} with {before}{name}/{measure}({d}){after} on {d};`"
        ))
    }
}

/// `a Force`, `an Energy`, `a Force/Area`.
fn described(dimension: Dimension) -> String {
    let text = words(dimension);
    let article = if text.starts_with(['A', 'E', 'I', 'O', 'U']) { "an" } else { "a" };
    format!("{article} {text}")
}

/// The first parameter or `let` with a dimension in a product.
fn leading_total(e: &Expr) -> Option<&Expr> {
    match &e.kind {
        ExprKind::Param(_) | ExprKind::Let(_) | ExprKind::State(_) => super::shape::value(&e.ty)
            .filter(|(shape, dimension)| *shape == Shape::Scalar && !dimension.is_number())
            .map(|_| e),
        ExprKind::Negate(a) => leading_total(a),
        ExprKind::Arithmetic(crate::model::Arithmetic::Mul, a, b) => {
            leading_total(a).or_else(|| leading_total(b))
        }
        ExprKind::Arithmetic(crate::model::Arithmetic::Div, a, _) => leading_total(a),
        _ => None,
    }
}
