//! Listings of kernels, for `ansatz expand` and snapshots.

use std::fmt::Write;

use super::cost::Cost;
use super::{Flux, Job, Kernel};
use crate::lower::{Lowering, input_name, symbol_name};
use crate::scalar::Id;
use crate::scalar::print::listing;

/// The kernel as text: shape, cost, statements and sums.
pub fn kernel(kernel: &Kernel, lowering: &Lowering<'_>) -> String {
    let mut text = String::new();
    let cost = Cost::of(kernel);
    let uses: Vec<String> = kernel
        .uses
        .iter()
        .map(|one| {
            format!(
                "{} ({} nodes x {})",
                lowering.model.fields[one.field.0].name,
                one.nodes(),
                one.components
            )
        })
        .collect();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "kernel {}: {:?}, {} points, {}",
        kernel.name,
        kernel.cell,
        cost.points,
        uses.join(", ")
    );
    let _ = writeln!(
        text,
        "  per point: geometry {}, interpolation {}, law {}, accumulation {}; {} temporaries, {} bytes per element",
        cost.geometry, cost.interpolation, cost.point, cost.accumulation, cost.temporaries, cost.bytes
    );
    let roots: Vec<(String, Id)> = labels(kernel, lowering).into_iter().zip(kernel.job.roots()).collect();
    let body = listing(&lowering.pool, &roots, &kernel.schedule, &|symbol| {
        symbol_name(lowering, lowering.symbols.kind(symbol))
    });
    for line in body.lines() {
        let _ = writeln!(text, "  {line}");
    }
    text
}

fn labels(kernel: &Kernel, lowering: &Lowering<'_>) -> Vec<String> {
    let name = |input| input_name(lowering.model, input);
    let flux = |flux: &[Flux]| -> Vec<String> {
        flux.iter().map(|(test, _)| format!("flux[{}]", name(*test))).collect()
    };
    match &kernel.job {
        Job::Value(_) => vec![String::from("value")],
        Job::Residual(rows) => flux(rows),
        Job::Columns(columns) => columns.iter().flat_map(|column| flux(column)).collect(),
        Job::Tangent(rows, tangent) => {
            let mut labels = flux(rows);
            for (test, row) in tangent.tests.iter().zip(&tangent.entries) {
                for (trial, _) in tangent.trials.iter().zip(row).filter(|(_, entry)| entry.is_some()) {
                    labels.push(format!("tangent[{}, {}]", name(*test), name(*trial)));
                }
            }
            labels
        }
    }
}

/// One line per kernel.
pub fn cost_table<'a>(kernels: impl IntoIterator<Item = &'a Kernel>) -> String {
    let mut text = String::from(
        "kernel                               points prelude geometry interp.   law   acc.  total temps  bytes\n",
    );
    for kernel in kernels {
        let cost = Cost::of(kernel);
        let _ = writeln!(
            text,
            "{:<36} {:>6} {:>7} {:>8} {:>7} {:>5} {:>6} {:>6} {:>5} {:>6}",
            kernel.name,
            cost.points,
            cost.prelude,
            cost.geometry,
            cost.interpolation,
            cost.point,
            cost.accumulation,
            cost.operations(),
            cost.temporaries,
            cost.bytes
        );
    }
    text
}
