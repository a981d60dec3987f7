//! The driver: every stage in order, with what goes in and what comes out.
//!
//! | stage | module | from | to |
//! |---|---|---|---|
//! | 1 parse, 2 resolve | [`syntax`], [`resolve`](crate::resolve) | texts | its `Program` |
//! | 3 check | [`check`] | program | [`Model`]: names, shapes, dimensions |
//! | 4 lower, vary | [`form`], [`lower`](crate::lower), [`derive`](crate::derive) | model | [`Forms`]: fluxes and tangents in scalars |
//! | evaluate | [`eval`] | forms | geometry, laws and tests at the default parameters |
//! | 5 kernels | [`kernel`] | forms | [`Plan`]: loops over quadrature points |
//! | 6 emit | [`emit`] | forms, kernels | Rust |
//!
//! Pure: no files, no clock, no randomness. The same texts give the same bytes.

use crate::diagnostic::{Diagnostic, Sink};
use crate::emit::Plan;
use crate::eval::LawTests;
use crate::form::Forms;
use crate::model::Model;
use crate::resolve::{Loader, assemble};
use crate::source::SourceMap;
use crate::{check, emit, eval, form, kernel, syntax};
use sha2::{Digest, Sha256};

/// What compiling gave.
#[derive(Debug)]
pub struct Compilation {
    /// All texts that were read.
    pub sources: SourceMap,
    /// Everything to tell the user, by place.
    pub diagnostics: Vec<Diagnostic>,
    /// The result, if there are no errors.
    pub output: Option<Output>,
}

/// A compiled model.
#[derive(Debug)]
pub struct Output {
    /// Name of the model.
    pub name: String,
    /// The Rust text of its module.
    pub rust: String,
    /// Results of the tests that need no run.
    pub law_tests: LawTests,
    /// Whether tests need a run.
    pub has_run_tests: bool,
    /// Printable stages, by name.
    stages: Vec<(&'static str, String)>,
}

impl Output {
    /// The text of a stage, for `ansatz expand --stage`.
    pub fn stage(&self, name: &str) -> Option<&str> {
        self.stages.iter().find(|(stage, _)| *stage == name).map(|(_, text)| text.as_str())
    }

    /// Names of all stages, in order.
    pub fn stage_names(&self) -> Vec<&'static str> {
        self.stages.iter().map(|(stage, _)| *stage).collect()
    }
}

/// Compiles the text `text`, called `name` in messages; `load` finds the files that it names.
pub fn compile(name: &str, text: &str, load: &mut Loader<'_>) -> Compilation {
    let mut sources = SourceMap::new();
    let mut sink = Sink::new();
    let main = sources.add(name, text);
    let program = assemble(main, &mut sources, load, &mut sink);
    let model = if sink.has_errors() { None } else { check::check(&program, &sources, &mut sink) };
    let output = model.and_then(|model| translate(&model, &sources, &mut sink));
    Compilation { sources, diagnostics: sink.finish(), output }
}

/// From the checked model to Rust; `None` after an error.
fn translate(model: &Model, sources: &SourceMap, sink: &mut Sink) -> Option<Output> {
    let mut forms = match form::build(model) {
        Ok(forms) => forms,
        Err(problems) => {
            problems.into_iter().for_each(|problem| sink.push(problem));
            return None;
        }
    };
    eval::check(&mut forms, sink);
    let law_tests = eval::law_tests(&mut forms, sources, sink);
    if sink.has_errors() {
        return None;
    }
    let plan = Plan::new(&mut forms, hash(sources));
    let rust = match emit::rust(&mut forms, &plan, sources) {
        Ok(rust) => rust,
        Err(problem) => {
            sink.push(*problem);
            return None;
        }
    };
    let has_run_tests = model.tests.iter().any(|test| test.needs_run);
    let stages = stages(model, &forms, &plan, sources, &rust);
    Some(Output { name: model.name.clone(), rust, law_tests, has_run_tests, stages })
}

/// Printed stages.
fn stages(
    model: &Model,
    forms: &Forms<'_>,
    plan: &Plan,
    sources: &SourceMap,
    rust: &str,
) -> Vec<(&'static str, String)> {
    // The texts were parsed before without an error.
    let trees = sources.iter().map(|source| syntax::print::outline(&syntax::parse(source, &mut Sink::new())));
    let kernels = plan.kernels();
    let listed: Vec<String> = kernels.iter().map(|one| kernel::print::kernel(one, &forms.lowering)).collect();
    vec![
        ("ast", trees.collect()),
        ("model", model.print()),
        ("form", form::print::forms(forms, sources)),
        ("kernel", listed.join("\n")),
        ("cost", kernel::print::cost_table(kernels)),
        ("rust", rust.to_owned()),
    ]
}

/// SHA-256 of all texts, in the order in which they were read.
fn hash(sources: &SourceMap) -> String {
    let mut hasher = Sha256::new();
    for source in sources.iter() {
        hasher.update(source.text.as_bytes());
        hasher.update([0]);
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
