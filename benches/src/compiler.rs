//! What each stage of the compiler takes for a model.

use crate::clock::Clock;
use ansatz_dsl::check::check;
use ansatz_dsl::diagnostic::{Sink, render};
use ansatz_dsl::emit::{self, Plan};
use ansatz_dsl::resolve::{Loaded, assemble};
use ansatz_dsl::source::SourceMap;
use ansatz_dsl::{eval, form};
use std::path::Path;

/// Compiles a model; seconds of each stage, in order.
///
/// # Errors
/// The text of the compiler's messages, or that the file cannot be read.
pub fn stages(file: &Path) -> Result<Vec<(&'static str, f64)>, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let (mut sources, mut sink) = (SourceMap::new(), Sink::new());
    let main = sources.add(file.display().to_string(), text);
    let mut load = |path: &str, from: &str| {
        let file = Path::new(from).parent().unwrap_or(Path::new("")).join(path);
        let text = std::fs::read_to_string(&file).map_err(|e| e.to_string())?;
        Ok(Loaded { name: file.display().to_string(), text })
    };
    let mut times = Vec::new();
    let program = timed(&mut times, "parse_s", || assemble(main, &mut sources, &mut load, &mut sink));
    let model = timed(&mut times, "check_s", || check(&program, &sources, &mut sink));
    let Some(model) = model else { return Err(render(&sink.finish(), &sources)) };
    let forms = timed(&mut times, "form_s", || form::build(&model));
    let mut forms = forms.map_err(|problems| render(&problems, &sources))?;
    timed(&mut times, "evaluate_s", || {
        eval::check(&mut forms, &mut sink);
        eval::law_tests(&mut forms, &sources, &mut sink)
    });
    let plan = timed(&mut times, "kernel_s", || Plan::new(&mut forms, String::new()));
    let rust = timed(&mut times, "emit_s", || emit::rust(&mut forms, &plan, &sources));
    rust.map_err(|problem| render(&[*problem], &sources))?;
    Ok(times)
}

fn timed<T>(times: &mut Vec<(&'static str, f64)>, stage: &'static str, run: impl FnOnce() -> T) -> T {
    let clock = Clock::start();
    let result = run();
    times.push((stage, clock.seconds()));
    result
}
