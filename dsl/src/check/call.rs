//! Calls: functions of the model and its library, and laws. Functions of the language are in `builtin`.

use super::{Binding, Checked, Checker, Env, Meaning, Reported, Signature, builtin};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Expr, ExprKind, Type};
use crate::resolve::scope::Symbol;
use crate::source::Span;
use crate::syntax::ast;

/// An argument that is a value or an open place.
type Given = Option<Expr>;

impl Checker<'_> {
    /// `f(a, name: b)` in all its forms.
    pub(super) fn call(
        &mut self,
        callee: &ast::Expr,
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let Some(name) = callee.as_name() else {
            return Err(self.not_callable(callee.span, "only a name can be called"));
        };
        if let Some((_, binding)) = env.locals.iter().rev().find(|(known, _)| *known == name.text) {
            return self.call_binding(&binding.clone(), &name, args, span, env);
        }
        let symbol = self.symbol(&name.text, env);
        match symbol {
            Some(Symbol::Function(at)) => return self.call_function(at, &name, args, span, env),
            Some(Symbol::Broken) => return Err(Reported),
            Some(Symbol::Let(at)) => {
                if let Some(law) = self.law_of(at, name.span)? {
                    return self.call_law(law, &name, args, span, env);
                }
            }
            _ => {}
        }
        if let Some(builtin) = builtin::find(&name.text) {
            return self.call_plain(builtin, &name, args, span, env);
        }
        if builtin::is_special(&name.text) {
            return self.call_special(&name, args, span, env);
        }
        match symbol {
            Some(symbol) => {
                let message = format!("`{}` is {}, not a function", name.text, symbol.words());
                Err(self.not_callable(name.span, &message))
            }
            None => Err(self.unknown_function(&name, env)),
        }
    }

    fn not_callable(&mut self, span: Span, message: &str) -> Reported {
        self.report(
            Diagnostic::error(Code::NotCallable, span, message)
                .help("a product is written with `*`, also before parentheses"),
        )
    }

    fn unknown_function(&mut self, name: &ast::Ident, env: &Env) -> Reported {
        let own = self.scopes[env.module].iter().filter(|(_, symbol)| matches!(symbol, Symbol::Function(_)));
        let candidates: Vec<&str> = own.map(|(known, _)| known).chain(builtin::names()).collect();
        let mut diagnostic =
            Diagnostic::error(Code::UnknownName, name.span, format!("there is no function `{}`", name.text))
                .help_did_you_mean(&name.text, candidates);
        let declaration = format!("fn {}(", name.text);
        for module in crate::library::MODULES.iter().filter(|module| module.text.contains(&declaration)) {
            diagnostic =
                diagnostic.help(format!("the library has one: `use std::{}::{};`", module.name, name.text));
        }
        let diagnostic = self.was_dropped(&name.text, diagnostic);
        self.report(diagnostic)
    }

    /// The law that a `let` names, if it names one.
    fn law_of(&mut self, at: usize, span: Span) -> Checked<Option<Expr>> {
        let Meaning::Value(id) = self.meaning(at, span)? else { return Ok(None) };
        Ok(self.let_value(id).filter(|value| matches!(value.kind, ExprKind::Law(..))).cloned())
    }

    fn call_binding(
        &mut self,
        binding: &Binding,
        name: &ast::Ident,
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let local = match binding {
            Binding::Broken => return Err(Reported),
            Binding::Local(id) => Some((*id, self.locals[id.0].1.clone())),
            Binding::Let(_) => None,
        };
        let Some((id, Type::Law(types, result))) = local else {
            if let Some(builtin) = builtin::find(&name.text) {
                return self.call_plain(builtin, name, args, span, env);
            }
            return Err(self.not_callable(name.span, &format!("`{}` is a value, not a function", name.text)));
        };
        let names: Vec<String> = (1..=types.len()).map(|k| k.to_string()).collect();
        let given = self.arguments(name, &names, &types, args, span, env)?;
        let all = self.no_holes(given, name)?;
        Ok(Expr { kind: ExprKind::ApplyLocal(id, all), ty: *result, span })
    }

    /// `W(F)` where `let W = Psi(_, G);`: the function with the open places filled.
    fn call_law(
        &mut self,
        law: Expr,
        name: &ast::Ident,
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let (ExprKind::Law(function, fixed), Type::Law(types, result)) = (law.kind, law.ty) else {
            return Err(Reported);
        };
        let names: Vec<String> = (1..=types.len()).map(|k| k.to_string()).collect();
        let given = self.arguments(name, &names, &types, args, span, env)?;
        let mut open = self.no_holes(given, name)?.into_iter();
        let all = fixed.into_iter().filter_map(|argument| argument.or_else(|| open.next())).collect();
        Ok(Expr { kind: ExprKind::Apply(function, all), ty: *result, span })
    }

    pub(super) fn no_holes(&mut self, given: Vec<Given>, name: &ast::Ident) -> Checked<Vec<Expr>> {
        let all = given.into_iter().collect::<Option<Vec<_>>>();
        all.ok_or_else(|| {
            let message = format!("`{}` is a law already: none of its arguments can stay open", name.text);
            self.report(Diagnostic::error(Code::Misplaced, name.span, message))
        })
    }

    /// A function of the model or library, applied or with open places.
    fn call_function(
        &mut self,
        at: usize,
        name: &ast::Ident,
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        let Signature { arguments, result } = self.signature(at)?;
        let names: Vec<String> = arguments.iter().map(|(id, _)| self.locals[id.0].0.clone()).collect();
        let types: Vec<Type> = arguments.into_iter().map(|(_, ty)| ty).collect();
        let given = self.arguments(name, &names, &types, args, span, env)?;
        let function = self.function_id(at);
        if given.iter().all(Option::is_some) {
            let all = given.into_iter().flatten().collect();
            return Ok(Expr { kind: ExprKind::Apply(function, all), ty: result, span });
        }
        let open =
            types.into_iter().zip(&given).filter(|(_, given)| given.is_none()).map(|(ty, _)| ty).collect();
        Ok(Expr { kind: ExprKind::Law(function, given), ty: Type::Law(open, Box::new(result)), span })
    }

    /// The arguments of a call in the order of declaration.
    pub(super) fn arguments(
        &mut self,
        callee: &ast::Ident,
        names: &[String],
        types: &[Type],
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Vec<Given>> {
        let mut slots: Vec<Option<Checked<Given>>> = vec![None; names.len()];
        let mut fault = None;
        for (position, arg) in args.iter().enumerate() {
            match self.argument_slot(callee, names, arg, position) {
                Ok(at) if slots[at].is_some() => {
                    let message = format!("argument `{}` of `{}` is given twice", names[at], callee.text);
                    fault = Some(self.report(Diagnostic::error(Code::TooManyArguments, arg.span, message)));
                }
                Ok(at) => slots[at] = Some(self.argument(callee, &names[at], &types[at], arg, env)),
                Err(reported) => fault = Some(reported),
            }
        }
        if fault.is_none()
            && let Some(missing) = slots.iter().position(Option::is_none)
        {
            let message = format!("argument `{}` of `{}` is missing", names[missing], callee.text);
            let signature =
                names.iter().zip(types).map(|(name, ty)| format!("{name}: {}", super::unit::type_text(ty)));
            let help = format!("`{}` takes ({})", callee.text, signature.collect::<Vec<_>>().join(", "));
            fault = Some(self.report(Diagnostic::error(Code::MissingArgument, span, message).help(help)));
        }
        match fault {
            Some(reported) => Err(reported),
            None => slots.into_iter().flatten().collect(),
        }
    }

    /// Which argument `arg` is.
    fn argument_slot(
        &mut self,
        callee: &ast::Ident,
        names: &[String],
        arg: &ast::Arg,
        position: usize,
    ) -> Checked<usize> {
        if let Some(name) = &arg.name {
            return names.iter().position(|known| *known == name.text).ok_or_else(|| {
                let message = format!("`{}` has no argument `{}`", callee.text, name.text);
                let known = names.iter().map(String::as_str);
                self.report(
                    Diagnostic::error(Code::UnknownArgument, name.span, message)
                        .help_did_you_mean(&name.text, known),
                )
            });
        }
        if position < names.len() {
            return Ok(position);
        }
        let plural = if names.len() == 1 { "" } else { "s" };
        let message = format!("`{}` takes {} argument{plural}", callee.text, names.len());
        Err(self.report(Diagnostic::error(Code::TooManyArguments, arg.span, message).here("one too many")))
    }

    fn argument(
        &mut self,
        callee: &ast::Ident,
        name: &str,
        ty: &Type,
        arg: &ast::Arg,
        env: &Env,
    ) -> Checked<Given> {
        self.no_domain(arg)?;
        if matches!(arg.value.kind, ast::ExprKind::Hole) {
            return Ok(None);
        }
        self.typed(&arg.value, ty, &format!("argument `{name}` of `{}`", callee.text), env).map(Some)
    }

    pub(super) fn no_domain(&mut self, arg: &ast::Arg) -> Checked<()> {
        let span = match &arg.on {
            None => return Ok(()),
            Some(ast::On::Domain(domain)) => domain.span,
            Some(ast::On::Times(range)) => range.span(),
        };
        Err(self.report(
            Diagnostic::error(Code::Misplaced, span, "this function runs over no domain")
                .help("`on` stands in `mean`, `integral`, `min` and `max`"),
        ))
    }
}
