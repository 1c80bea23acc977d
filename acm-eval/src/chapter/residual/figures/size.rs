//! Bars and points: how large the residual is, over all and by altitude.

use acm_train::{run::names::some, schedule::descriptive::rms::Rms};
use kuva::{
    plot::{BarPlot, LinePlot, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot},
};

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::bars::{Bar, highest, keys, panel_of};
use crate::figures::canvas::legend::{Key, Mark};
use crate::figures::canvas::{Panels, palette, panel};
use crate::unit::total_name;

/// Caption title.
pub const QUESTION: &str = "How large is the residual, and does it depend on altitude?";

/// Draws panel (a), and (b) and (c) where altitudes are known.
pub fn draw(study: &Study) -> Option<Drawing> {
    let record = &study.record;
    let groups: Vec<&Rms> = record.altitudes.iter().map(|group| &group.rms).collect();
    let (all, by_altitude) = (bars(study, &[&record.overall]), bars(study, &groups));
    let trials = record.trials.iter().map(|trial| study.shown(trial.rms.total));
    let high = trials.fold(highest(&all).max(highest(&by_altitude)), f64::max);
    let y = study.display.label("RMS residual");
    let mut panels = vec![overall(&all, &y, high)];
    let (mut legend, mut series) = (keys(&all), all.len());
    if groups.len() > 1 {
        let names: Vec<String> = record.altitudes.iter().map(|group| format!("{:.2}", group.altitude)).collect();
        panels.push(panel_of("(b) By altitude", "mean altitude [m]", &y, &names, &by_altitude, high));
        panels.push(against(study, &y, high));
        legend.extend(slices(study));
        let total = total_name(&record.data.unit, record.outputs.len());
        legend.push(Key {
            label: format!("{total}, all trials of an altitude"),
            colour: TOTAL.into(),
            mark: Mark::Line,
        });
        series += by_altitude.len() * names.len() + record.trials.len() + 1;
    }
    let roles: Vec<String> = record
        .roles
        .iter()
        .map(|role| format!("{} {}", role.role.replace('_', " "), some(&role.trials, ", ")))
        .collect();
    let explanation = format!(
        "Root mean square of measured − nominal in the calibrated domain, trials {}. Altitudes: means over trials that lie \
         within {} m of a neighbour. In (c) a point is one trial, and the line joins all samples of each altitude.",
        roles.join("; "),
        record.asked.altitude_tolerance
    );
    let columns = panels.len();
    let size = (if columns == 1 { 720.0 } else { 310.0 }, 330.0);
    Some(Panels { columns, panels, size, legend }.draw(&record.data, series, explanation))
}

const TOTAL: &str = palette::GREY;

/// Returns a bar per component and one for the distance.
fn bars(study: &Study, groups: &[&Rms]) -> Vec<Bar> {
    let (data, outputs) = (&study.record.data, &study.record.outputs);
    let bar = |label: String, colour, of: &dyn Fn(&Rms) -> f64| Bar {
        label,
        colour,
        values: groups.iter().map(|rms| study.shown(of(rms))).collect(),
    };
    let component =
        |(o, output): (usize, &String)| bar(format!("Δ{output}"), palette::series(o), &|rms| rms.components[o]);
    let total = bar(total_name(&data.unit, outputs.len()).into(), TOTAL, &|rms| rms.total);
    outputs.iter().enumerate().map(component).chain([total]).collect()
}

/// Returns a bar per component, each under its name.
fn overall(bars: &[Bar], y: &str, high: f64) -> (Vec<Plot>, Layout) {
    let names: Vec<String> = bars.iter().map(|bar| bar.label.clone()).collect();
    let (_, layout) = panel_of("(a) All trials", "component", y, &names, &[], high);
    let each = |plot: BarPlot, bar: &Bar| plot.with_group(bar.label.as_str(), vec![(bar.values[0], bar.colour)]);
    (vec![Plot::Bar(bars.iter().fold(BarPlot::new().with_width(0.7), each))], layout)
}

/// Returns the trials as points, altitudes as a line.
fn against(study: &Study, y: &str, high: f64) -> (Vec<Plot>, Layout) {
    let record = &study.record;
    let line = record.altitudes.iter().map(|group| (group.altitude, study.shown(group.rms.total)));
    let line = LinePlot::new().with_data(line.collect::<Vec<_>>()).with_color(TOTAL).with_stroke_width(2.0);
    let mut plots = vec![Plot::Line(line)];
    for slice in 0..record.slices.len() {
        let own = record.trials.iter().filter(|trial| trial.slice == slice);
        let points: Vec<(f64, f64)> =
            own.filter_map(|trial| Some((trial.altitude?, study.shown(trial.rms.total)))).collect();
        let dots = ScatterPlot::new().with_data(points).with_color(colour(slice)).with_size(4.5);
        plots.push(Plot::Scatter(ScatterPlot { marker_opacity: Some(0.75), ..dots }));
    }
    let altitudes = record.trials.iter().filter_map(|trial| trial.altitude);
    let (low, top) = altitudes.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, top), h| (low.min(h), top.max(h)));
    let margin = 0.05 * (top - low);
    let x = Scale::tight(low - margin, top + margin, 4);
    let title = format!("(c) {} by trial", total_name(&record.data.unit, record.outputs.len()));
    (plots, panel(&title, ("mean altitude [m]", x), (y, Scale::around(0.0, high, 5))))
}

/// Returns the colour of a slice, apart from those of the components.
pub fn colour(slice: usize) -> &'static str {
    palette::series(slice + 3)
}

/// Returns the keys of the slices.
pub fn slices(study: &Study) -> Vec<Key> {
    let slices = study.record.slices.iter().enumerate();
    slices.map(|(k, slice)| Key { label: study.held(slice), colour: colour(k).into(), mark: Mark::Dot }).collect()
}
