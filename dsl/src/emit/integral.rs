//! Integrals and their kernels.

use super::fields::domain;
use super::layout::Slots;
use super::tables::Tables;
use super::{ident, kernel, place};
use crate::form::Term;
use crate::kernel::{Kernel, Kernels};
use crate::lower::Lowering;
use crate::source::SourceMap;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Emitted kernels, and the tables that they read.
#[derive(Debug, Default)]
pub struct Emitted {
    /// Kernel functions.
    pub functions: Vec<TokenStream>,
    /// Quadrature and basis tables.
    pub tables: Tables,
    /// Whether an integral without variation occurs.
    pub uses_no_variation: bool,
}

impl Emitted {
    /// `Integral { .. }`, with its kernels added to the functions.
    pub fn integral(
        &mut self,
        lowering: &Lowering<'_>,
        slots: &Slots,
        sources: &SourceMap,
        term: &Term,
        kernels: &Kernels,
    ) -> TokenStream {
        let (name, place) = (term.name.replacen(' ', ": ", 1), place(sources, term.span));
        let about = format!("`{}`, {place}", term.name);
        let block = Literal::usize_unsuffixed(term.block.map_or(0, |block| block.0));
        let domain = domain(lowering.model, &term.region, term.uses.iter().copied());
        let uses = term.uses.iter().map(|field| {
            let field = Literal::usize_unsuffixed(field.0);
            quote!(Use { field: #field })
        });
        let uses: Vec<TokenStream> = uses.collect();
        let mut emit = |kernel: &Kernel, what: &str| {
            self.functions.push(kernel::kernel(
                kernel,
                lowering,
                slots,
                &mut self.tables,
                &format!("{about}: {what}"),
            ));
            ident(&kernel.name)
        };
        let optional =
            |name: Option<proc_macro2::Ident>| name.map_or(quote!(None), |name| quote!(Some(#name)));
        let value = optional(kernels.value.as_ref().map(|kernel| emit(kernel, "the integral.")));
        let tangent = optional(
            kernels.tangent.as_ref().map(|kernel| emit(kernel, "its variation and the tangent of it.")),
        );
        let global = match &kernels.columns {
            None => quote!(None),
            Some((kinds, kernel)) => {
                let slots = kinds.iter().map(|&kind| Literal::usize_unsuffixed(slots.unknown(kind)));
                let kernel = emit(kernel, "its variation, differentiated by states and functionals.");
                quote!(Some(GlobalTangent { slots: &[#(#slots),*], kernel: #kernel }))
            }
        };
        let residual = match &kernels.residual {
            Some(kernel) => emit(kernel, "its variation."),
            None => {
                self.uses_no_variation = true;
                ident("no_variation")
            }
        };
        let (rates, symmetric) = (kernels.all().any(Kernel::reads_rates), term.symmetric);
        quote!(Integral {
            name: #name,
            place: #place,
            block: #block,
            domain: #domain,
            uses: &[#(#uses),*],
            rates: #rates,
            symmetric: #symmetric,
            value: #value,
            residual: #residual,
            tangent: #tangent,
            global_tangent: #global,
        })
    }

    /// The kernel of integrals that nothing varies.
    pub fn no_variation(&self) -> TokenStream {
        if !self.uses_no_variation {
            return TokenStream::new();
        }
        quote! {
            /// The variation of an integral that depends on no unknown, or whose variation nobody asks for.
            fn no_variation(_: &Batch<'_>, _: &[f64], out: &mut [Row]) {
                out.fill(Row::ZERO);
            }
        }
    }
}
