//! Points and lines: measured and predicted coordinates against the swept actuator, trial by trial.

use kuva::{
    plot::{LinePlot, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot},
};

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::legend::{Key, Mark, dashes};
use crate::figures::canvas::{Panels, palette, panel};

/// Caption title.
pub const QUESTION: &str = "Where is the tip, and where do the models say that it is?";

/// Points of one trial in one panel, at most.
const POINTS: usize = 250;
/// Points of one predicted curve.
const BINS: usize = 40;

/// Draws a panel per coordinate.
pub fn draw(study: &Study) -> Option<Drawing> {
    let record = &study.record;
    let trials: Vec<&str> = record.models.first()?.fitted.trials.iter().map(|trial| trial.trial.as_str()).collect();
    let strain = record.models.iter().rfind(|model| model.key.starts_with("strain"))?;
    let panels: Vec<(Vec<Plot>, Layout)> =
        record.outputs.iter().enumerate().map(|(o, output)| one(study, &trials, &strain.key, o, output)).collect();
    let mut legend: Vec<Key> = trials
        .iter()
        .enumerate()
        .map(|(k, trial)| Key {
            label: format!("trial {trial}, measured"),
            colour: palette::series(k).into(),
            mark: Mark::Dot,
        })
        .collect();
    legend.push(Key { label: "polynomial".into(), colour: palette::INK.into(), mark: Mark::Line });
    legend.push(Key { label: "strain".into(), colour: palette::INK.into(), mark: Mark::Dashes });
    let explanation = format!(
        "Tip of each calibration trial against {0}* = {0} − {1:.3}, counted from the middle of its range. Points: at most \
         {POINTS} samples of a trial, evenly picked. Lines, in the colour of their trial: what the polynomial (solid) and \
         the strain model ({2}, dashed) say, averaged in {BINS} bins.",
        study.swept().name,
        record.middle,
        strain.label.to_lowercase()
    );
    let series = 3 * trials.len() * panels.len();
    let columns = panels.len().min(3);
    Some(Panels { columns, panels, size: (310.0, 330.0), legend }.draw(&record.data, series, explanation))
}

fn one(study: &Study, trials: &[&str], strain: &str, o: usize, output: &str) -> (Vec<Plot>, Layout) {
    let factor = study.display.factor;
    let table = &study.calibration;
    let q = table.column(&format!("actuator_{}", study.swept().name));
    let of = |estimate: &str| table.column(&format!("{estimate}_{output}"));
    let centred = |row: usize| q[row] - study.record.middle;
    let (mut dots, mut lines) = (vec![], vec![]);
    for (k, trial) in trials.iter().enumerate() {
        let (rows, colour) = (table.rows(trial), palette::series(k));
        let every = rows.len().div_ceil(POINTS).max(1);
        let points: Vec<(f64, f64)> =
            rows.iter().step_by(every).map(|&row| (centred(row), factor * of("measured")[row])).collect();
        let plot = ScatterPlot::new().with_data(points).with_color(colour).with_size(1.6);
        dots.push(Plot::Scatter(ScatterPlot { marker_opacity: Some(0.35), ..plot }));
        for (estimate, dashed) in [("polynomial", false), (strain, true)] {
            let samples: Vec<(f64, f64)> = rows.iter().map(|&row| (centred(row), factor * of(estimate)[row])).collect();
            let line = LinePlot::new().with_data(binned(samples)).with_color(colour).with_stroke_width(1.8);
            lines.push(Plot::Line(if dashed { line.with_line_style(dashes()) } else { line }));
        }
    }
    let limits = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let (left, right) = limits(&mut (0..q.len()).map(centred));
    let (low, high) = limits(&mut of("measured").iter().map(|value| factor * value));
    let title = format!("({}) {output} of the tip", char::from(b'd' + o.min(20) as u8));
    let (x, y) = (study.swept().centred(), study.display.label(output));
    let layout = panel(&title, (&x, Scale::tight(left, right, 4)), (&y, Scale::around(low, high, 5)));
    (dots.into_iter().chain(lines).collect(), layout)
}

/// Returns the means of points in bins of equal width along x.
fn binned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let (low, high) = points
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| (low.min(point.0), high.max(point.0)));
    let mut sums = vec![(0.0, 0.0, 0.0); BINS];
    for (x, y) in points {
        let bin = ((BINS as f64 * (x - low) / (high - low)) as usize).min(BINS - 1);
        sums[bin] = (sums[bin].0 + 1.0, sums[bin].1 + x, sums[bin].2 + y);
    }
    sums.into_iter().filter(|sum| sum.0 > 0.0).map(|(n, x, y)| (x / n, y / n)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn points_in_one_bin_are_one_point() {
        assert_eq!(binned(vec![(0.0, 1.0), (0.01, 3.0), (1.0, 7.0)]), [(0.005, 2.0), (1.0, 7.0)]);
        assert_eq!(binned(vec![(2.0, 1.0), (2.0, 2.0)]), [(2.0, 1.5)]);
    }
}
