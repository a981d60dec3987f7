//! The functions that the language has built in, with their shapes and dimensions.

use super::shape::{settle, value};
use super::{Checked, Checker, Env, Reported};
use crate::diagnostic::{Code, Diagnostic};
use crate::model::{Builtin, Expr, ExprKind, ScalarFunction, Shape, Type};
use crate::resolve::scope::Symbol;
use crate::source::Span;
use crate::syntax::ast;
use ansatz_units::{Dimension, Rational};

/// Functions whose arguments are values.
const PLAIN: [(&str, Builtin); 33] = [
    ("sqrt", Builtin::Scalar(ScalarFunction::Sqrt)),
    ("exp", Builtin::Scalar(ScalarFunction::Exp)),
    ("ln", Builtin::Scalar(ScalarFunction::Ln)),
    ("sin", Builtin::Scalar(ScalarFunction::Sin)),
    ("cos", Builtin::Scalar(ScalarFunction::Cos)),
    ("tan", Builtin::Scalar(ScalarFunction::Tan)),
    ("asin", Builtin::Scalar(ScalarFunction::Asin)),
    ("acos", Builtin::Scalar(ScalarFunction::Acos)),
    ("atan", Builtin::Scalar(ScalarFunction::Atan)),
    ("sinh", Builtin::Scalar(ScalarFunction::Sinh)),
    ("cosh", Builtin::Scalar(ScalarFunction::Cosh)),
    ("tanh", Builtin::Scalar(ScalarFunction::Tanh)),
    ("abs", Builtin::Scalar(ScalarFunction::Abs)),
    ("min", Builtin::Min),
    ("max", Builtin::Max),
    ("atan2", Builtin::Atan2),
    ("det", Builtin::Det),
    ("tr", Builtin::Trace),
    ("transpose", Builtin::Transpose),
    ("inverse", Builtin::Inverse),
    ("sym", Builtin::Sym),
    ("dev", Builtin::Dev),
    ("diag", Builtin::Diag),
    ("dot", Builtin::Dot),
    ("inner", Builtin::Inner),
    ("outer", Builtin::Outer),
    ("cross", Builtin::Cross),
    ("norm", Builtin::Norm),
    ("grad", Builtin::Grad),
    ("div", Builtin::Div),
    ("along", Builtin::Along),
    ("hoop", Builtin::Hoop),
    ("perp", Builtin::Perp),
];

/// Functions that look at more than the values of their arguments.
const SPECIAL: [&str; 15] = [
    "polar", "dt", "diff", "frozen", "test", "mean", "integral", "area", "volume", "length", "force", "pair",
    "loop", "run", "normal",
];

/// The function of values of that name.
pub(super) fn find(name: &str) -> Option<Builtin> {
    PLAIN.iter().find(|(known, _)| *known == name).map(|(_, builtin)| *builtin)
}

/// The name of a function of values.
pub(super) fn name(builtin: Builtin) -> &'static str {
    PLAIN.iter().find(|(_, known)| *known == builtin).map_or("polar", |(name, _)| name)
}

/// Whether the name is that of a function that looks at more than values.
pub(super) fn is_special(name: &str) -> bool {
    SPECIAL.contains(&name)
}

/// Names of all functions of the language.
pub(super) fn names<'a>() -> impl Iterator<Item = &'a str> {
    PLAIN.iter().map(|(name, _)| *name).chain(SPECIAL)
}

impl Checker<'_> {
    /// Positional arguments of a built-in function.
    fn positional(&mut self, name: &ast::Ident, count: usize, args: &[ast::Arg], span: Span) -> Checked<()> {
        if let Some(arg) = args.iter().find_map(|arg| arg.name.as_ref()) {
            let message = format!("the arguments of `{}` have no names", name.text);
            return Err(self.report(Diagnostic::error(Code::UnknownArgument, arg.span, message)));
        }
        let code = match args.len() {
            n if n == count => return Ok(()),
            n if n < count => Code::MissingArgument,
            _ => Code::TooManyArguments,
        };
        let plural = if count == 1 { "" } else { "s" };
        let message = format!("`{}` takes {count} argument{plural}, not {}", name.text, args.len());
        Err(self.report(Diagnostic::error(code, span, message)))
    }

    pub(super) fn call_plain(
        &mut self,
        builtin: Builtin,
        name: &ast::Ident,
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        if matches!(builtin, Builtin::Min | Builtin::Max) {
            if let [arg] = args
                && arg.on.is_some()
            {
                return self.reduce(name, arg, span, env);
            }
            if args.len() < 2 {
                let message = format!("`{}` takes two or more values, or one and a domain", name.text);
                let help = format!("write `{}(a, b)` or `{}(e on D)`", name.text, name.text);
                return Err(self.report(Diagnostic::error(Code::MissingArgument, span, message).help(help)));
            }
        } else {
            self.positional(name, arity(builtin), args, span)?;
        }
        let items: Vec<Checked<Expr>> = args
            .iter()
            .map(|arg| {
                self.no_domain(arg)?;
                self.expr(&arg.value, env)
            })
            .collect();
        let mut items = items.into_iter().collect::<Checked<Vec<_>>>()?;
        let ty = self.plain_type(builtin, name, &mut items, span)?;
        let keep = matches!(builtin, Builtin::Min | Builtin::Max) && ty == Type::Zero;
        let items = if keep { items } else { items.into_iter().map(settle).collect() };
        Ok(Expr { kind: ExprKind::Builtin(builtin, items), ty, span })
    }

    /// The type of a built-in function of values.
    fn plain_type(
        &mut self,
        builtin: Builtin,
        name: &ast::Ident,
        items: &mut [Expr],
        span: Span,
    ) -> Checked<Type> {
        let scalar = |d| Type::Value(Shape::Scalar, d);
        let what = format!("the argument of `{}`", name.text);
        Ok(match builtin {
            Builtin::Scalar(ScalarFunction::Abs) => scalar(self.scalar(&items[0], &what)?),
            Builtin::Scalar(ScalarFunction::Sqrt) => {
                let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
                scalar(self.scalar(&items[0], &what)?.pow(half))
            }
            Builtin::Scalar(_) => {
                self.need_number(&items[0], &what)?;
                Type::NUMBER
            }
            Builtin::Min | Builtin::Max | Builtin::Atan2 | Builtin::Diag => {
                let ty = self.all_same(items, span, &format!("take `{}` of", name.text))?;
                for item in items.iter() {
                    self.scalar(item, &format!("each argument of `{}`", name.text))?;
                }
                match (builtin, value(&ty)) {
                    (Builtin::Atan2, _) => Type::NUMBER,
                    (Builtin::Diag, Some((_, d))) => Type::Value(Shape::Tensor, d),
                    _ => ty,
                }
            }
            Builtin::Det => scalar(self.shaped(&items[0], Shape::Tensor, name)?.pow(3)),
            Builtin::Trace => scalar(self.shaped(&items[0], Shape::Tensor, name)?),
            Builtin::Transpose | Builtin::Sym | Builtin::Dev => {
                Type::Value(Shape::Tensor, self.shaped(&items[0], Shape::Tensor, name)?)
            }
            Builtin::Inverse => {
                Type::Value(Shape::Tensor, Dimension::NUMBER / self.shaped(&items[0], Shape::Tensor, name)?)
            }
            Builtin::Dot | Builtin::Outer | Builtin::Cross | Builtin::Inner => {
                let shape = if builtin == Builtin::Inner { Shape::Tensor } else { Shape::Vector };
                let product = self.shaped(&items[0], shape, name)? * self.shaped(&items[1], shape, name)?;
                match builtin {
                    Builtin::Outer => Type::Value(Shape::Tensor, product),
                    Builtin::Cross => Type::Value(Shape::Vector, product),
                    _ => scalar(product),
                }
            }
            Builtin::Norm => match self.operand(&items[0])? {
                (Shape::Scalar, _) => {
                    return Err(self.wrong_shape(
                        &items[0],
                        name,
                        "a vector or a tensor; of scalars take `abs`",
                    ));
                }
                (_, d) => scalar(d),
            },
            Builtin::Grad => match self.operand(&items[0])? {
                (Shape::Scalar, d) => Type::Value(Shape::Vector, d / Dimension::LENGTH),
                (Shape::Vector, d) => Type::Value(Shape::Tensor, d / Dimension::LENGTH),
                (Shape::Tensor, _) => return Err(self.wrong_shape(&items[0], name, "a scalar or a vector")),
            },
            Builtin::Along => {
                let (shape, d) = self.operand(&items[0])?;
                Type::Value(shape, d / Dimension::LENGTH)
            }
            Builtin::Perp => Type::Value(Shape::Vector, self.shaped(&items[0], Shape::Vector, name)?),
            Builtin::Div | Builtin::Hoop => {
                scalar(self.shaped(&items[0], Shape::Vector, name)? / Dimension::LENGTH)
            }
            Builtin::Polar => Type::POSITION,
        })
    }

    /// Requires a shape; a literal 0 has it. Gives the dimension.
    fn shaped(&mut self, e: &Expr, shape: Shape, name: &ast::Ident) -> Checked<Dimension> {
        match self.operand(e)? {
            (have, dimension) if have == shape || e.ty == Type::Zero => Ok(dimension),
            _ => Err(self.wrong_shape(e, name, if shape == Shape::Tensor { "a tensor" } else { "a vector" })),
        }
    }

    fn wrong_shape(&mut self, e: &Expr, name: &ast::Ident, wanted: &str) -> Reported {
        let words = self.words(&e.ty);
        self.report(
            Diagnostic::error(Code::ShapeMismatch, e.span, format!("`{}` takes {wanted}", name.text))
                .here(format!("this is {words}")),
        )
    }

    pub(super) fn call_special(
        &mut self,
        name: &ast::Ident,
        args: &[ast::Arg],
        span: Span,
        env: &Env,
    ) -> Checked<Expr> {
        match name.text.as_str() {
            "mean" | "integral" => {
                self.positional(name, 1, args, span)?;
                self.reduce(name, &args[0], span, env)
            }
            "area" | "volume" | "length" => {
                self.positional(name, 1, args, span)?;
                self.measure(name, &args[0].value, span, env)
            }
            "normal" => {
                self.positional(name, 1, args, span)?;
                self.normal(&args[0].value, span, env)
            }
            "force" => {
                self.positional(name, 2, args, span)?;
                self.force(&args[0].value, &args[1].value, span, env)
            }
            "dt" | "frozen" | "test" => {
                self.positional(name, 1, args, span)?;
                self.of_one(name, &args[0].value, span, env)
            }
            "diff" => {
                self.positional(name, 2, args, span)?;
                self.diff(&args[0].value, &args[1].value, span, env)
            }
            "polar" => {
                let names = ["centre", "radius", "angle"].map(str::to_owned);
                let given = self.arguments(
                    name,
                    &names,
                    &[Type::POSITION, Type::LENGTH, Type::NUMBER],
                    args,
                    span,
                    env,
                )?;
                let items = self.no_holes(given, name)?;
                Ok(Expr { kind: ExprKind::Builtin(Builtin::Polar, items), ty: Type::POSITION, span })
            }
            "run" => Err(self.report(
                Diagnostic::error(
                    Code::Unsupported,
                    span,
                    "runs with other parameters inside a test are not supported",
                )
                .help("write a `sweep`"),
            )),
            _ => {
                let help = match name.text.as_str() {
                    "pair" => {
                        "a pair is the value of a `let` of the file: `let touch = pair(a, b, search: 1 um);`"
                    }
                    _ => "a loop is the value of a region: `region core = loop(wall, axis);`",
                };
                let message = format!("`{}` makes no value", name.text);
                Err(self.report(Diagnostic::error(Code::Misplaced, span, message).help(help)))
            }
        }
    }

    /// `dt(e)`, `frozen(e)`, `test(u)`.
    fn of_one(&mut self, name: &ast::Ident, arg: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        let e = self.settled(arg, env)?;
        let (shape, dimension) = self.operand(&e)?;
        let (kind, ty) = match (name.text.as_str(), &e.kind) {
            ("dt", _) => (ExprKind::Rate(Box::new(e)), Type::Value(shape, dimension / Dimension::TIME)),
            ("test", ExprKind::Field(id)) => (ExprKind::Test(*id), e.ty.clone()),
            ("test", _) => {
                let fields = self.names_of(|symbol| matches!(symbol, Symbol::Field(_))).join("`, `");
                let diagnostic =
                    Diagnostic::error(Code::WrongKind, arg.span, "only fields have test functions");
                return Err(self.report(diagnostic.help(format!("the fields are `{fields}`"))));
            }
            _ => {
                let ty = e.ty.clone();
                (ExprKind::Frozen(Box::new(e)), ty)
            }
        };
        Ok(Expr { kind, ty, span })
    }

    /// `diff(e, x)`.
    fn diff(&mut self, e: &ast::Expr, x: &ast::Expr, span: Span, env: &Env) -> Checked<Expr> {
        let (e, x) = (self.settled(e, env), self.settled(x, env));
        let (e, x) = (e?, x?);
        if !matches!(x.kind, ExprKind::Local(_) | ExprKind::Let(_)) {
            return Err(self.report(
                Diagnostic::error(Code::WrongKind, x.span, "derivatives are taken by an argument or a `let`")
                    .help(
                        "give the quantity a name first: `let x = ..;`, and use that name in what is derived",
                    ),
            ));
        }
        let ((s, d), (t, by)) = (self.operand(&e)?, self.operand(&x)?);
        let shape = match (s, t) {
            (shape, Shape::Scalar) | (Shape::Scalar, shape) => shape,
            _ => {
                return Err(self.report(
                    Diagnostic::error(Code::ShapeMismatch, span, "one of the two must be a scalar")
                        .label(e.span, format!("this is {}", self.words(&e.ty)))
                        .label(x.span, format!("this is {}", self.words(&x.ty))),
                ));
            }
        };
        Ok(Expr { kind: ExprKind::Diff(Box::new(e), Box::new(x)), ty: Type::Value(shape, d / by), span })
    }
}

fn arity(builtin: Builtin) -> usize {
    match builtin {
        Builtin::Diag | Builtin::Polar => 3,
        Builtin::Atan2
        | Builtin::Dot
        | Builtin::Inner
        | Builtin::Outer
        | Builtin::Cross
        | Builtin::Min
        | Builtin::Max => 2,
        _ => 1,
    }
}
