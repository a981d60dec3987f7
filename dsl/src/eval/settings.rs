//! Settings of mesh, pairs and solver at the default parameters: sizes are positive, a run ends after it starts.

use super::values_of;
use crate::diagnostic::{Code, Diagnostic, Sink};
use crate::form::Forms;
use crate::model::Expr;
use crate::scalar::Id;

/// A setting by name, the values that it can have, and the help where it has another one.
struct Rule {
    name: &'static str,
    holds: fn(f64) -> bool,
    needs: &'static str,
    help: &'static str,
}

const SIZE: Rule = Rule {
    name: "the size of a mesh",
    holds: positive,
    needs: "a length above 0",
    help: "write the length of an edge, such as a tenth of the smallest thing to resolve",
};
const GROWTH: Rule =
    Rule { name: "`growth`", holds: |x| x > 1.0, needs: "above 1", help: "write e.g. `growth = 1.25`" };
const QUALITY: Rule = Rule {
    name: "`quality`",
    holds: |x| (0.0..1.0).contains(&x),
    needs: "from 0 to 1",
    help: "write e.g. `quality = 0.3`",
};
const SEARCH: Rule = Rule {
    name: "the search distance of a pair",
    holds: positive,
    needs: "a length above 0",
    help: "search as far as the law acts",
};
const STEP: Rule =
    Rule { name: "a time step", holds: positive, needs: "a time above 0", help: "write e.g. `max: 0.1 s`" };
const TOLERANCE: Rule =
    Rule { name: "a tolerance", holds: positive, needs: "above 0", help: "write e.g. `tolerance: 1e-8`" };
const ITERATIONS: Rule = Rule {
    name: "`iterations`",
    holds: |x| x >= 1.0,
    needs: "at least 1",
    help: "write e.g. `iterations: 25`",
};

fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

/// Reports settings with which no run can start.
pub(super) fn check(forms: &Forms<'_>, parameters: &[f64], sink: &mut Sink) {
    let (model, settings) = (forms.lowering.model, &forms.settings);
    let number = |id: Id| values_of(&forms.lowering, &[id], parameters, &[])[0];
    let mut found: Vec<(&Rule, &Expr, Id)> = Vec::new();
    let sizes = model.mesh.sizes.iter().zip(&settings.mesh.sizes);
    found.extend(sizes.map(|((size, _), (id, _))| (&SIZE, size, *id)));
    found.extend(model.mesh.growth.iter().map(|e| (&GROWTH, e, settings.mesh.growth)));
    found.extend(model.mesh.quality.iter().map(|e| (&QUALITY, e, settings.mesh.quality)));
    found.extend(model.pairs.iter().zip(&settings.searches).map(|(pair, &id)| (&SEARCH, &pair.search, id)));
    let (said, meant) = (&model.solve, &settings.solve);
    found.extend(said.max_step.iter().map(|e| (&STEP, e, meant.max_step)));
    found.extend(said.min_step.iter().map(|e| (&STEP, e, meant.min_step)));
    found.push((&TOLERANCE, &said.step_tolerance, meant.step_tolerance));
    found.push((&TOLERANCE, &said.newton_tolerance, meant.newton_tolerance));
    found.push((&ITERATIONS, &said.newton_iterations, meant.newton_iterations));
    for (rule, e, id) in found {
        let value = number(id);
        if !(rule.holds)(value) {
            let message = format!("{} is {}, and this is {}", rule.name, rule.needs, shown(value));
            sink.push(bad(e, message).help(rule.help));
        }
    }
    if let (Some((start, end)), Some(ids)) = (&said.time, meant.time) {
        let [from, to] = ids.map(number);
        if to.partial_cmp(&from) != Some(std::cmp::Ordering::Greater) {
            let message = "the time of a run must end after it starts";
            sink.push(
                bad(end, message.into()).label(start.span, "it starts here").help("write `0 s .. 250 s`"),
            );
        }
    }
}

fn bad(e: &Expr, message: String) -> Diagnostic {
    Diagnostic::error(Code::BadSetting, e.span, message).here("with the default parameters")
}

/// A number in the units of the model, without the noise of its last digits.
fn shown(x: f64) -> String {
    format!("{x:.6e}").parse::<f64>().unwrap_or(x).to_string()
}
