//! Parameters: the typed struct that users fill, and the table that settings are checked against.

use super::body::closure;
use super::body::list;
use super::expression::number;
use super::layout::Slots;
use super::{docs, ident};
use crate::form::Forms;
use crate::form::settings::{Bounds, Parameter};
use crate::model::Param;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `struct Parameters`, its defaults and its values in order.
pub fn structure(forms: &Forms<'_>) -> TokenStream {
    let model = forms.lowering.model;
    let fields = model.params.iter().map(|param| {
        let (name, unit) = (ident(&param.name), model.units.unit_of(param.dimension));
        let text = if param.doc.is_empty() { format!("`{}`", param.name) } else { param.doc.clone() };
        let doc = docs(&if param.dimension.is_number() { text } else { format!("{text} \\[{unit}\\]") });
        quote!(#doc pub #name: f64)
    });
    let names: Vec<_> = model.params.iter().map(|param| ident(&param.name)).collect();
    let positions = (0..names.len()).map(Literal::usize_unsuffixed);
    let count = Literal::usize_unsuffixed(names.len());
    let doc = docs(&format!("Parameters of `{}`, in its coherent units.", model.name));
    quote! {
        #doc
        #[derive(Clone, Debug, PartialEq)]
        #[allow(non_snake_case)]
        pub struct Parameters { #(#fields,)* }

        impl Default for Parameters {
            fn default() -> Self {
                let mut g = [0.0; #count];
                for (k, parameter) in PROGRAM.parameters.iter().enumerate() {
                    g[k] = (parameter.default)(&g);
                }
                Self { #(#names: g[#positions],)* }
            }
        }

        impl Parameters {
            /// All values, in the order of the model.
            pub fn values(&self) -> Vec<f64> {
                Vec::from([#(self.#names),*])
            }
        }
    }
}

/// The entries of `Program::parameters`.
pub fn table(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let (params, settings) = (&forms.lowering.model.params, forms.settings.parameters.clone());
    let entries: Vec<TokenStream> =
        params.iter().zip(&settings).map(|(param, setting)| entry(forms, slots, param, setting)).collect();
    quote!(&[#(#entries),*])
}

fn entry(forms: &mut Forms<'_>, slots: &Slots, param: &Param, setting: &Parameter) -> TokenStream {
    let lowering = &mut forms.lowering;
    let default = closure(lowering, slots, setting.default);
    let unbounded = quote!(|_| (f64::NEG_INFINITY, f64::INFINITY));
    let (range, choices) = match &setting.bounds {
        Bounds::Any => (unbounded, quote!(|_| None)),
        Bounds::Range(ends) => {
            (list(lowering, slots, ends, &|values| quote!((#(#values),*))), quote!(|_| None))
        }
        Bounds::Set(set) => {
            (unbounded, list(lowering, slots, set, &|values| quote!(Some(Vec::from([#(#values),*])))))
        }
    };
    let (name, doc, (si, unit)) = (&param.name, &param.doc, &param.unit);
    let unit_value = number(lowering.model.units.to_internal(*si, param.dimension));
    let exponents = param.dimension.exponents().iter().map(|exponent| {
        let (n, d) =
            (Literal::i32_unsuffixed(exponent.numerator()), Literal::i32_unsuffixed(exponent.denominator()));
        quote!((#n, #d))
    });
    quote!(Parameter {
        name: #name,
        doc: #doc,
        dimension: [#(#exponents),*],
        unit: #unit,
        unit_value: #unit_value,
        default: #default,
        range: #range,
        choices: #choices,
    })
}
