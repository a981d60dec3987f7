//! Line plots of table columns over time, as SVG: one picture per column, and one for all columns without unit.

use crate::error::Error;
use crate::generated::{Column, Table};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;

const SIZE: (u32, u32) = (800, 450);
const COLOURS: [RGBColor; 6] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(148, 103, 189),
    RGBColor(255, 127, 14),
    RGBColor(23, 190, 207),
];

type Fault = Box<dyn std::error::Error>;

/// Draws the columns of a finished table against its first column. `rows` are display values. Returns the files' names.
pub fn write(folder: &Path, table: &Table, rows: &[Vec<f64>]) -> Result<Vec<String>, Error> {
    let Some((_, columns)) = table.columns.split_first() else { return Ok(Vec::new()) };
    let stem = table.file.trim_end_matches(".csv");
    let mut names = Vec::new();
    let (pure, dimensional): (Vec<usize>, Vec<usize>) =
        (1..=columns.len()).partition(|&k| table.columns[k].unit == "1");
    let together = (!pure.is_empty()).then_some((String::from("fractions"), pure));
    let alone = dimensional.into_iter().map(|k| (file_safe(table.columns[k].name), vec![k]));
    for (name, group) in together.into_iter().chain(alone) {
        let file = format!("{stem}_{name}.svg");
        let path = folder.join(&file);
        draw(&path, table.columns, &group, rows).map_err(|e| super::cannot_write(&path, &e))?;
        names.push(file);
    }
    Ok(names)
}

fn file_safe(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect()
}

fn draw(path: &Path, columns: &[Column], group: &[usize], rows: &[Vec<f64>]) -> Result<(), Fault> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    draw_lines(&root, columns, group, rows)?;
    root.present()?;
    Ok(())
}

fn draw_lines(
    root: &DrawingArea<SVGBackend<'_>, Shift>,
    columns: &[Column],
    group: &[usize],
    rows: &[Vec<f64>],
) -> Result<(), Fault> {
    let label = |k: usize| format!("{} [{}]", columns[k].name, columns[k].unit);
    let times = bounds(rows.iter().map(|r| r[0]));
    let values = bounds(group.iter().flat_map(|&k| rows.iter().map(move |r| r[k])));
    let title = if let [k] = group { label(*k) } else { String::from("[1]") };
    let mut chart = ChartBuilder::on(root)
        .margin(16)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(times.0..times.1, values.0..values.1)?;
    chart.configure_mesh().light_line_style(WHITE).x_desc(label(0)).y_desc(title).draw()?;
    for (&k, colour) in group.iter().zip(COLOURS.iter().cycle()) {
        let points = rows.iter().map(|r| (r[0], r[k])).filter(|p| p.1.is_finite());
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
            .label(label(k))
            .legend(|(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], colour.stroke_width(2)));
    }
    if group.len() > 1 {
        chart.configure_series_labels().background_style(WHITE).border_style(BLACK.mix(0.3)).draw()?;
    }
    Ok(())
}

/// Smallest and largest finite value with 5 % room; never empty.
fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let room = if high > low { 0.05 * (high - low) } else { 0.5 * high.abs().max(1e-12) };
    (low - room, high + room)
}
