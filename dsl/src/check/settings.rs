//! `mesh { .. }` and `solve { .. }`: settings by name.

use super::frame::default_solve;
use super::{Checked, Checker, Env, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Expr, Integrator, Solve, Type};
use crate::source::Span;
use crate::syntax::ast::{self, ExprKind as Syntax, Setting, SettingValue};

impl Checker<'_> {
    /// The settings of a mesh block, added to those of earlier blocks.
    pub(super) fn mesh(&mut self, settings: &[Setting]) {
        for setting in settings {
            let _ = self.mesh_setting(setting);
        }
    }

    fn mesh_setting(&mut self, setting: &Setting) -> Checked<()> {
        let name = setting.name.text.as_str();
        let ty = match name {
            "size" => Type::LENGTH,
            "growth" | "quality" => Type::NUMBER,
            _ => return Err(self.unknown_setting(&setting.name, &["size", "growth", "quality"])),
        };
        let value = self
            .setting_value(setting)
            .and_then(|e| self.typed(e, &ty, &setting_words(setting), &Env::default()));
        let domain = setting.domain.as_ref().map(|domain| self.places(domain, &Env::default())).transpose();
        let (value, domain) = (value?, domain?);
        if name == "size" {
            self.rest.mesh.sizes.push((value, domain));
            return Ok(());
        }
        if let Some(domain) = domain {
            let message = format!("`{name}` holds for the whole mesh");
            return Err(self.report(Diagnostic::error(Code::Misplaced, domain.span, message)));
        }
        let slot = if name == "growth" { &mut self.rest.mesh.growth } else { &mut self.rest.mesh.quality };
        *slot = Some(value);
        Ok(())
    }

    fn unknown_setting(&mut self, name: &ast::Ident, known: &[&str]) -> Reported {
        let list = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        self.report(
            Diagnostic::error(Code::UnknownName, name.span, format!("there is no setting `{}`", name.text))
                .help_did_you_mean(&name.text, known.iter().copied())
                .help(format!("the settings are {list}")),
        )
    }

    fn setting_value<'s>(&mut self, setting: &'s Setting) -> Checked<&'s ast::Expr> {
        match &setting.value {
            SettingValue::Expr(e) => Ok(e),
            SettingValue::Range(range) => {
                let message = format!("`{}` is one value, not a range", setting.name.text);
                Err(self.report(Diagnostic::error(Code::WrongKind, range.span(), message)))
            }
        }
    }

    /// The settings of a solve block, added to those of earlier blocks.
    pub(super) fn solve(&mut self, settings: &[Setting]) {
        let mut solve = self.rest.solve.take().unwrap_or_else(default_solve);
        for setting in settings {
            let _ = self.solve_setting(setting, &mut solve);
        }
        self.rest.solve = Some(solve);
    }

    fn solve_setting(&mut self, setting: &Setting, solve: &mut Solve) -> Checked<()> {
        if let Some(domain) = &setting.domain {
            let message = "settings of `solve` hold everywhere";
            return Err(self.report(Diagnostic::error(Code::Misplaced, domain.span, message)));
        }
        match setting.name.text.as_str() {
            "time" => match &setting.value {
                SettingValue::Range(range) => {
                    solve.time = Some(self.range(range, &Type::TIME, "the time of a run")?);
                    Ok(())
                }
                SettingValue::Expr(e) => Err(self.report(
                    Diagnostic::error(Code::WrongKind, e.span, "the time of a run is a range")
                        .help("write `time = 0 s .. 250 s;`"),
                )),
            },
            "step" => self.step(setting, solve),
            "nonlinear" => self.nonlinear(setting, solve),
            "linear" => self.method(setting, &["direct"]).map(|_| ()),
            _ => Err(self.unknown_setting(&setting.name, &["time", "step", "nonlinear", "linear"])),
        }
    }

    /// `name(..)` as the value of a setting, one of the known methods.
    fn method<'s>(&mut self, setting: &'s Setting, known: &[&str]) -> Checked<(ast::Ident, &'s [ast::Arg])> {
        let e = self.setting_value(setting)?;
        let list = known.iter().map(|name| format!("`{name}(..)`")).collect::<Vec<_>>().join(", ");
        if let Syntax::Call { callee, args } = &e.kind
            && let Some(name) = callee.as_name()
        {
            if known.contains(&name.text.as_str()) {
                return Ok((name, args));
            }
            let message = format!("there is no method `{}`", name.text);
            let diagnostic = Diagnostic::error(Code::UnknownName, name.span, message)
                .help_did_you_mean(&name.text, known.iter().copied())
                .help(format!("`{}` is one of {list}", setting.name.text));
            return Err(self.report(diagnostic));
        }
        let message = format!("`{}` is a method with its settings", setting.name.text);
        Err(self.report(Diagnostic::error(Code::WrongKind, e.span, message).help(format!("write {list}"))))
    }

    fn step(&mut self, setting: &Setting, solve: &mut Solve) -> Checked<()> {
        let (name, args) = self.method(setting, &["sdirk2", "euler"])?;
        solve.integrator = if name.text == "sdirk2" { Integrator::Sdirk2 } else { Integrator::BackwardEuler };
        for arg in args {
            let known = ["max", "min", "tolerance"];
            let Ok(at) = self.option(&name, arg, &known) else { continue };
            let ty = if at == 2 { Type::NUMBER } else { Type::TIME };
            let Ok(value) = self.option_value(arg, &ty) else { continue };
            match at {
                0 => solve.max_step = Some(value),
                1 => solve.min_step = Some(value),
                _ => solve.step_tolerance = value,
            }
        }
        Ok(())
    }

    fn nonlinear(&mut self, setting: &Setting, solve: &mut Solve) -> Checked<()> {
        let (name, args) = self.method(setting, &["newton"])?;
        for arg in args {
            let Ok(at) = self.option(&name, arg, &["tolerance", "iterations", "search"]) else { continue };
            if at == 2 {
                self.search(&arg.value);
            } else if let Ok(value) = self.option_value(arg, &Type::NUMBER) {
                let slot = if at == 0 { &mut solve.newton_tolerance } else { &mut solve.newton_iterations };
                *slot = value;
            }
        }
        Ok(())
    }

    /// `search: residual`, the only line search.
    fn search(&mut self, e: &ast::Expr) {
        if e.as_name().is_none_or(|name| name.text != "residual") {
            self.sink.push(
                Diagnostic::error(Code::UnknownName, e.span, "there is no such line search")
                    .help("write `search: residual`"),
            );
        }
    }

    /// Which option of a method an argument sets.
    fn option(&mut self, method: &ast::Ident, arg: &ast::Arg, known: &[&str]) -> Checked<usize> {
        let (text, span): (&str, Span) =
            arg.name.as_ref().map_or(("", arg.span), |name| (&name.text, name.span));
        known.iter().position(|name| *name == text).ok_or_else(|| {
            let list = known.iter().map(|name| format!("`{name}:`")).collect::<Vec<_>>().join(", ");
            let message = match text {
                "" => format!("the settings of `{}` have names", method.text),
                _ => format!("`{}` has no setting `{text}`", method.text),
            };
            self.report(
                Diagnostic::error(Code::UnknownArgument, span, message)
                    .help_did_you_mean(text, known.iter().copied())
                    .help(format!("it has {list}")),
            )
        })
    }

    fn option_value(&mut self, arg: &ast::Arg, ty: &Type) -> Checked<Expr> {
        let name = arg.name.as_ref().map_or("", |name| name.text.as_str());
        self.typed(&arg.value, ty, &format!("`{name}`"), &Env::default())
    }
}

fn setting_words(setting: &Setting) -> String {
    format!("the mesh setting `{}`", setting.name.text)
}
