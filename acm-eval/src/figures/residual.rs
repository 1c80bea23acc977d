//! Points: predicted against measured residual, by network and coordinate.

use kuva::{
    plot::{LinePlot, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot},
};

use super::Drawing;
use super::canvas::axis::Scale;
use super::canvas::legend::{Key, Mark};
use super::canvas::{Panels, palette, panel};
use crate::run::predictions::{HELD_OUT, Predictions};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Caption title.
pub const QUESTION: &str = "Does the predicted residual follow the measured one?";

/// Points in one panel, at most.
const POINTS: usize = 600;

/// Draws one row of panels per network, one panel per coordinate; both axes alike, identity dashed.
pub fn draw(section: &Section) -> Option<Drawing> {
    let shown: Vec<(&Estimator, u64, &Predictions)> = section
        .networks()
        .filter_map(|network| section.median_seed(network).map(|(record, table)| (network, record.seed, table)))
        .collect();
    let (_, _, first) = shown.first()?;
    let rows: Vec<usize> = first.trials(HELD_OUT).into_iter().flat_map(|trial| trial.rows).collect();
    let every = rows.len().div_ceil(POINTS).max(1);
    let points = |table: &Predictions, output: &str| -> Vec<(f64, f64)> {
        let rows = table.trials(HELD_OUT).into_iter().flat_map(|trial| trial.rows).step_by(every);
        rows.map(|row| residuals(section, table, output, row)).collect()
    };
    let scales: Vec<Scale> = section
        .outputs
        .iter()
        .map(|output| scale(shown.iter().flat_map(|(_, _, table)| points(table, output))))
        .collect();
    let mut panels = vec![];
    for (network, _, table) in &shown {
        for (output, scale) in section.outputs.iter().zip(&scales) {
            panels.push(one(section, network, output, *scale, points(table, output)));
        }
    }
    let intervals = shown.iter().find_map(|(network, _, _)| section.runs[network.run].intervals.as_ref());
    let legend = shown
        .iter()
        .map(|(network, _, _)| Key { label: network.label.clone(), colour: network.colour.into(), mark: Mark::Dot })
        .chain([Key { label: "predicted = measured".into(), colour: palette::INK.into(), mark: Mark::Dashes }])
        .chain(intervals.map(|_| Key {
            label: "ends of the interval".into(),
            colour: palette::INK.into(),
            mark: Mark::Line,
        }))
        .collect();
    let seeds: Vec<String> = shown.iter().map(|(network, seed, _)| format!("{} seed {seed}", network.label)).collect();
    let explanation = format!(
        "Residual = measured − nominal, on the held-out trials. Both axes of a panel are alike, and so are the panels of \
         one coordinate. {}, for the seed with the median error: {}.",
        match every {
            1 => format!("All {} time stamps", rows.len()),
            _ => format!("{} of {} time stamps, evenly picked", rows.len().div_ceil(every), rows.len()),
        },
        seeds.join(", "),
    ) + &intervals.map_or(String::new(), |intervals| format!(" Solid lines: {}.", intervals.title()));
    let series = panels.len();
    Some(Panels { columns: section.outputs.len(), panels, size: (300.0, 300.0), legend }.draw(
        &section.data,
        series,
        explanation,
    ))
}

/// Returns the measured and predicted residual at one row, in display units.
fn residuals(section: &Section, table: &Predictions, output: &str, row: usize) -> (f64, f64) {
    let of = |estimate: &str| table.column(estimate, output)[row];
    let factor = section.display.factor;
    (factor * (of("measured") - of("nominal")), factor * (of("predicted") - of("nominal")))
}

fn scale(points: impl Iterator<Item = (f64, f64)>) -> Scale {
    let (low, high) =
        points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (x, y)| (low.min(x).min(y), high.max(x).max(y)));
    let margin = 0.04 * (high - low);
    Scale::tight(low - margin, high + margin, 6)
}

fn one(
    section: &Section,
    network: &Estimator,
    output: &str,
    scale: Scale,
    points: Vec<(f64, f64)>,
) -> (Vec<Plot>, Layout) {
    let identity = [(scale.low, scale.low), (scale.high, scale.high)];
    let dots = ScatterPlot::new().with_data(points).with_color(network.colour).with_size(2.2);
    let line = LinePlot::new().with_data(identity).with_color(palette::INK).with_stroke_width(1.2).with_dashed();
    let title = format!("{}, {output}", network.label);
    let half_width = section.runs[network.run].intervals.as_ref().and_then(|intervals| {
        intervals.outputs.iter().find(|of| of.output == output).map(|of| section.display.factor * of.half_width)
    });
    let labels =
        (section.display.label(&format!("measured Δ{output}")), section.display.label(&format!("predicted Δ{output}")));
    let layout = panel(&title, (&labels.0, scale), (&labels.1, scale)).with_equal_aspect();
    let mut plots = vec![Plot::Scatter(ScatterPlot { marker_opacity: Some(0.55), ..dots }), Plot::Line(line)];
    let fits = |width: &&f64| **width < scale.high - scale.low;
    plots.extend(
        half_width.iter().filter(fits).flat_map(|width| [*width, -width]).map(|shift| Plot::Line(edge(scale, shift))),
    );
    (plots, layout)
}

/// Returns an end of the interval, `shift` above the identity, as far as the panel goes.
fn edge(scale: Scale, shift: f64) -> LinePlot {
    let (low, high) = (scale.low.max(scale.low - shift), scale.high.min(scale.high - shift));
    LinePlot::new()
        .with_data([(low, low + shift), (high, high + shift)])
        .with_color(palette::INK)
        .with_stroke_width(0.8)
}
