//! Bars: root mean square error by coordinate and over all, whiskers ± sd over seeds.

use acm_train::run::record::Score;
use kuva::{
    plot::{BarPlot, LinePlot},
    render::{annotations::ReferenceLine, layout::Layout, plots::Plot},
};

use super::Drawing;
use super::canvas::axis::Scale;
use super::canvas::legend::{Key, Mark};
use super::canvas::{Panels, palette, panel};
use crate::section::Section;
use crate::section::estimator::Estimator;
use crate::spread::Spread;

/// Caption title.
pub const QUESTION: &str = "How far is each model from what was measured?";

/// Width of a group of bars; groups are 1 apart.
const WIDTH: f64 = 0.82;

/// Draws one group of bars per coordinate, one bar per estimator.
pub fn draw(section: &Section) -> Option<Drawing> {
    let shown: Vec<&Estimator> = section.estimators.iter().filter(|e| section.held_out(e).next().is_some()).collect();
    let mut groups: Vec<String> = section.outputs.clone();
    groups.push(section.total().into());
    let bar = |estimator: &Estimator, group: usize| {
        let of = |score: &Score| score.rmse.get(group).copied().unwrap_or(score.rmse_total) * section.display.factor;
        estimator.spread(&section.held_out(estimator).map(of).collect::<Vec<_>>())
    };
    let y = section.display.label("RMSE on held-out trials");
    let explanation = format!(
        "Root mean square error on the held-out trials by coordinate and over all of them ({}). Whiskers: ± one sample \
         standard deviation over seeds. Lower is better.",
        groups[groups.len() - 1]
    );
    bars(section, &shown, &groups, bar, &y, explanation)
}

/// Draws grouped bars with whiskers; shared with the figure of R².
pub fn bars(
    section: &Section,
    shown: &[&Estimator],
    groups: &[String],
    bar: impl Fn(&Estimator, usize) -> Option<Spread>,
    y: &str,
    explanation: String,
) -> Option<Drawing> {
    if shown.is_empty() {
        return None;
    }
    let mut plot = BarPlot::new().with_width(WIDTH);
    let (mut whiskers, mut low, mut high) = (vec![], 0.0_f64, 0.0_f64);
    for (index, group) in groups.iter().enumerate() {
        let mut values = vec![];
        for (place, estimator) in shown.iter().enumerate() {
            let spread = bar(estimator, index)?;
            let sd = spread.sd.unwrap_or(0.0);
            (low, high) = (low.min(spread.mean - sd), high.max(spread.mean + sd));
            values.push((spread.mean, estimator.colour));
            whiskers
                .extend(spread.sd.filter(|sd| *sd > 0.0).map(|sd| whisker(index, place, shown.len(), spread.mean, sd)));
        }
        plot = plot.with_group(group.as_str(), values);
    }
    let x = Scale { low: 0.5, high: groups.len() as f64 + 0.5, step: 1.0 };
    let layout: Layout = panel("", ("coordinate", x), (y, Scale::around(low, high, 5)))
        .with_x_categories(groups.to_vec())
        .with_tick_size(14);
    let legend =
        shown.iter().map(|e| Key { label: e.label.clone(), colour: e.colour.into(), mark: Mark::Bar }).collect();
    let layout = if low < 0.0 { layout.with_reference_line(zero()) } else { layout };
    let plots = std::iter::once(Plot::Bar(plot)).chain(whiskers.into_iter().flatten()).collect();
    let panels = vec![(plots, layout)];
    Some(Panels { columns: 1, panels, size: (860.0, 360.0), legend }.draw(
        &section.data,
        shown.len() * groups.len(),
        explanation,
    ))
}

/// Returns a stem with two caps, centred on bar `place` of `bars` in `group`.
fn whisker(group: usize, place: usize, bars: usize, mean: f64, sd: f64) -> [Plot; 3] {
    let bar = WIDTH / bars as f64;
    let x = group as f64 + 1.0 - WIDTH / 2.0 + bar * (place as f64 + 0.5);
    let (low, high, cap) = (mean - sd, mean + sd, (0.25 * bar).min(0.05));
    let line = |from: (f64, f64), to: (f64, f64)| {
        Plot::Line(LinePlot::new().with_data([from, to]).with_color(palette::INK).with_stroke_width(1.5))
    };
    [line((x, low), (x, high)), line((x - cap, low), (x + cap, low)), line((x - cap, high), (x + cap, high))]
}

fn zero() -> ReferenceLine {
    ReferenceLine::horizontal(0.0).with_color(palette::INK).with_stroke_width(1.0).with_dasharray("none")
}
