//! Lines in bands: mean ± standard deviation of each component against the swept actuator, slice by slice.

use kuva::{
    plot::{BandPlot, LinePlot},
    render::{annotations::ReferenceLine, layout::Layout, plots::Plot},
};

use super::{
    Study,
    size::{colour, slices},
};
use crate::figures::Drawing;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::legend::{Key, Mark};
use crate::figures::canvas::{Panels, palette, panel};

/// Caption title.
pub const QUESTION: &str = "How does the residual depend on the configuration of the arm?";

/// Draws a panel per component.
pub fn draw(study: &Study) -> Option<Drawing> {
    let record = &study.record;
    let bins = || record.slices.iter().flat_map(|slice| &slice.bins);
    let fold = |(low, high): (f64, f64), (a, b): (f64, f64)| (low.min(a), high.max(b));
    let empty = (f64::INFINITY, f64::NEG_INFINITY);
    let (left, right) = bins().map(|bin| (bin.q - record.middle, bin.q - record.middle)).fold(empty, fold);
    let (low, high) = bins()
        .flat_map(|bin| bin.mean.iter().zip(&bin.sd))
        .map(|(mean, sd)| (study.shown(mean - sd), study.shown(mean + sd)))
        .fold(empty, fold);
    let scales = (Scale::tight(left, right, 4), Scale::around(low, high, 10));
    let panels: Vec<(Vec<Plot>, Layout)> = (0..record.outputs.len()).map(|o| one(study, o, scales)).collect();
    let line = |key: Key| Key { mark: Mark::Line, ..key };
    let legend = slices(study).into_iter().map(line).collect();
    let explanation = format!(
        "Mean of measured − nominal (line) ± one standard deviation of the samples (band) in {} bins over {1}* = {1} − \
         {2:.3}; bins with fewer than {3} samples are left out. All panels have one scale.",
        record.asked.bins,
        study.swept().name,
        record.middle,
        record.asked.least_in_bin
    );
    let series = panels.len() * record.slices.len();
    let columns = panels.len().min(3);
    (bins().count() > 0)
        .then(|| Panels { columns, panels, size: (310.0, 330.0), legend }.draw(&record.data, series, explanation))
}

fn one(study: &Study, o: usize, (x, y): (Scale, Scale)) -> (Vec<Plot>, Layout) {
    let (record, output) = (&study.record, &study.record.outputs[o]);
    let (mut bands, mut lines) = (vec![], vec![]);
    for (k, slice) in record.slices.iter().enumerate() {
        let q: Vec<f64> = slice.bins.iter().map(|bin| bin.q - record.middle).collect();
        let edge = |sign: f64| -> Vec<f64> {
            slice.bins.iter().map(|bin| study.shown(bin.mean[o] + sign * bin.sd[o])).collect()
        };
        let band = BandPlot::new(q.clone(), edge(-1.0), edge(1.0)).with_color(colour(k)).with_opacity(0.18);
        bands.push(Plot::Band(band));
        let points: Vec<(f64, f64)> = q.into_iter().zip(edge(0.0)).collect();
        lines.push(Plot::Line(LinePlot::new().with_data(points).with_color(colour(k)).with_stroke_width(2.2)));
    }
    let title = format!("({}) Δ{output}", char::from(b'd' + o.min(20) as u8));
    let zero = ReferenceLine::horizontal(0.0).with_color(palette::INK).with_stroke_width(1.0).with_dasharray("none");
    let label = study.display.label(&format!("Δ{output}"));
    let layout = panel(&title, (&study.swept().centred(), x), (&label, y)).with_reference_line(zero);
    (bands.into_iter().chain(lines).collect(), layout)
}
