//! Listings of kernels, for `ansatz expand` and snapshots.

use std::fmt::Write;

use super::cost::{BYTES_PER_NS, Cost, FLOPS_PER_NS};
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
        "  per element: map {}, {} bytes; per point: geometry {}, interpolation {}, law {}, accumulation {}; {} temporaries",
        cost.map,
        cost.bytes,
        cost.geometry,
        cost.interpolation,
        cost.point,
        cost.accumulation,
        cost.temporaries
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

/// One line per kernel: flops per element and where they go, bytes, and the least time that both allow.
pub fn cost_table<'a>(kernels: impl IntoIterator<Item = &'a Kernel>) -> String {
    let mut text = format!(
        "Flops and bytes per element with straight edges; geometry to acc. per point; prelude per batch.\n\
         Least time on a core with {FLOPS_PER_NS} flop/ns and {BYTES_PER_NS} byte/ns.\n\n\
         kernel                               points prelude   map geometry interp.   law   acc. temps  flops  bytes flop/byte     ns\n",
    );
    for kernel in kernels {
        let cost = Cost::of(kernel);
        let _ = writeln!(
            text,
            "{:<36} {:>6} {:>7} {:>5} {:>8} {:>7} {:>5} {:>6} {:>5} {:>6} {:>6} {:>9.1} {:>6.1}",
            kernel.name,
            cost.points,
            cost.prelude,
            cost.map,
            cost.geometry,
            cost.interpolation,
            cost.point,
            cost.accumulation,
            cost.temporaries,
            cost.operations(),
            cost.bytes,
            cost.intensity(),
            cost.nanoseconds()
        );
    }
    text
}
