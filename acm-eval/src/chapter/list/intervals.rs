//! Differences of an ablation with their intervals, variant by variant.

use acm_train::schedule::study::{paired::Difference, table::pairs};
use kuva::{
    plot::{LinePlot, scatter::ScatterPlot},
    render::{annotations::ReferenceLine, plots::Plot},
};

use super::List;
use crate::chapter::Shown;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::legend::{Key, Mark};
use crate::figures::canvas::{Panels, palette, panel};

/// Draws one row for each variant but the first, one mark for each base.
pub fn draw(list: &List) -> Vec<Shown> {
    let groups = list.groups();
    let mut names: Vec<&str> = vec![];
    for (name, _) in groups.iter().flat_map(|group| group.rows.iter().skip(1)) {
        if !names.contains(name) {
            names.push(name);
        }
    }
    names.reverse();
    if names.is_empty() {
        return vec![];
    }
    let factor = list.display.factor;
    let (mut plots, mut low, mut high) = (vec![], 0.0_f64, 0.0_f64);
    for ((place, group), (_, colour)) in groups.iter().enumerate().zip(list.colours()) {
        let Some((first, others)) = group.rows.split_first() else { continue };
        let lift = 0.24 * ((groups.len() - 1) as f64 / 2.0 - place as f64);
        let mut dots = vec![];
        for (name, runs) in others {
            let Some(difference) = Difference::of(&pairs(first.1.records, runs.records)) else { continue };
            let row = names.iter().position(|known| known == name).unwrap_or(0) as f64 + 1.0 + lift;
            let (mean, reach) = (factor * difference.mean, factor * difference.reach.unwrap_or(0.0));
            (low, high) = (low.min(mean - reach), high.max(mean + reach));
            let bar = LinePlot::new().with_data([(mean - reach, row), (mean + reach, row)]);
            plots.push(Plot::Line(bar.with_color(colour).with_stroke_width(3.0)));
            dots.push((mean, row));
        }
        plots.push(Plot::Scatter(ScatterPlot::new().with_data(dots).with_color(colour).with_size(4.5)));
    }
    let total = list.total();
    let x = list.display.label(&format!("{total} RMSE more than with {}", reference(&groups)));
    let y = Scale { low: 0.5, high: names.len() as f64 + 0.5, step: 1.0 };
    let layout = panel("", (&x, Scale::around(low, high, 8)), ("", y))
        .with_y_categories(names.iter().map(ToString::to_string).collect())
        .with_reference_line(ReferenceLine::vertical(0.0).with_color(palette::INK));
    let key = |base: &str, colour: &str| Key { label: base.into(), colour: colour.into(), mark: Mark::Dot };
    let legend = list.colours().into_iter().map(|(base, colour)| key(base, colour)).collect();
    let explanation = "Dots: mean difference of the error in cross-validation to the model with everything, in pairs of the \
        same fold and seed; right of zero, the error grew. Bars: Student's 95 % intervals of that mean. A bar across zero: \
        these runs cannot tell."
        .to_string();
    let size = (880.0, 90.0 + 44.0 * names.len() as f64);
    let series = plots.len();
    let drawing = Panels { columns: 1, panels: vec![(plots, layout)], size, legend }.draw(
        &list.first().data,
        series,
        explanation,
    );
    vec![Shown { name: "differences", question: "What does each change cost?".into(), drawing }]
}

fn reference(groups: &[acm_train::schedule::study::table::Group]) -> String {
    groups.iter().find_map(|group| group.rows.first()).map_or(String::new(), |(name, _)| (*name).to_string())
}
