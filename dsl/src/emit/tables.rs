//! Tables of quadrature weights and basis functions, shared by all kernels of a model.

use std::collections::BTreeMap;

use super::expression::number;
use super::ident;
use crate::kernel::Kernel;
use crate::kernel::interpret::tabulate;
use ansatz_elements::{Cell, Element};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

/// The tables asked for so far, in the order of their names.
#[derive(Debug, Default)]
pub struct Tables {
    constants: BTreeMap<String, TokenStream>,
}

impl Tables {
    /// Name of the weights of a kernel's rule: one number per point.
    pub fn weights(&mut self, kernel: &Kernel) -> Ident {
        let name = format!("{}_WEIGHTS", rule_name(kernel));
        let rule = &kernel.rule;
        self.constants.entry(name.clone()).or_insert_with(|| {
            let points = Literal::usize_unsuffixed(rule.weights.len());
            let weights = rule.weights.iter().map(|&weight| number(weight));
            let (name, doc) = (ident(&name), format!(" Weights of the rule of degree {}.", rule.degree));
            quote!(#[doc = #doc] const #name: [f64; #points] = [#(#weights),*];)
        });
        ident(&name)
    }

    /// Name of a basis at the points of a kernel's rule: `[point][node]`.
    pub fn values(&mut self, kernel: &Kernel, element: &Element) -> Ident {
        let name = format!("{}_{}_VALUES", element.name, rule_name(kernel));
        self.constants.entry(name.clone()).or_insert_with(|| {
            let rows = kernel.rule.iter().map(|(xi, _)| {
                let values = tabulate(element, xi).0.into_iter().map(number);
                quote!([#(#values),*])
            });
            let (points, nodes) = size(kernel, element);
            let (name, doc) = (ident(&name), format!(" {} basis functions: `[point][node]`.", element.name));
            quote!(#[doc = #doc] const #name: [[f64; #nodes]; #points] = [#(#rows),*];)
        });
        ident(&name)
    }

    /// Name of the reference gradients of a basis: `[point][node][direction]`.
    pub fn gradients(&mut self, kernel: &Kernel, element: &Element) -> Ident {
        let name = format!("{}_{}_GRADIENTS", element.name, rule_name(kernel));
        self.constants.entry(name.clone()).or_insert_with(|| {
            let rows = kernel.rule.iter().map(|(xi, _)| {
                let nodes = tabulate(element, xi).1.into_iter().map(|gradient| {
                    let entries = gradient.into_iter().map(number);
                    quote!([#(#entries),*])
                });
                quote!([#(#nodes),*])
            });
            let (points, nodes) = size(kernel, element);
            let dimension = Literal::usize_unsuffixed(kernel.cell.dimension());
            let (name, doc) =
                (ident(&name), format!(" {} reference gradients: `[point][node][direction]`.", element.name));
            quote!(#[doc = #doc] const #name: [[[f64; #dimension]; #nodes]; #points] = [#(#rows),*];)
        });
        ident(&name)
    }

    /// All tables.
    pub fn tokens(&self) -> TokenStream {
        let constants = self.constants.values();
        quote!(#(#constants)*)
    }
}

fn size(kernel: &Kernel, element: &Element) -> (Literal, Literal) {
    let [points, nodes] = [kernel.rule.weights.len(), element.nodes().len()].map(Literal::usize_unsuffixed);
    (points, nodes)
}

fn rule_name(kernel: &Kernel) -> String {
    let cell = match kernel.cell {
        Cell::Triangle => "TRIANGLE",
        Cell::Segment => "SEGMENT",
    };
    format!("{cell}_{}", kernel.rule.weights.len())
}
