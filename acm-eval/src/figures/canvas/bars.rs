//! Grouped bars without whiskers: groups along x, in each a bar per series.

use kuva::{
    plot::BarPlot,
    render::{layout::Layout, plots::Plot},
};

use super::axis::Scale;
use super::legend::{Key, Mark};
use super::panel;

/// One bar of every group.
pub struct Bar {
    /// Meaning.
    pub label: String,
    /// Colour of the bar.
    pub colour: &'static str,
    /// Height in each group, in the order of the groups.
    pub values: Vec<f64>,
}

/// Returns a panel of grouped bars from 0 to `highest`.
pub fn panel_of(title: &str, x: &str, y: &str, groups: &[String], bars: &[Bar], highest: f64) -> (Vec<Plot>, Layout) {
    let mut plot = BarPlot::new().with_width(0.82);
    for (place, group) in groups.iter().enumerate() {
        let values: Vec<(f64, &str)> = bars.iter().map(|bar| (bar.values[place], bar.colour)).collect();
        plot = plot.with_group(group.as_str(), values);
    }
    let across = Scale { low: 0.5, high: groups.len() as f64 + 0.5, step: 1.0 };
    let layout = panel(title, (x, across), (y, Scale::around(0.0, highest, 5))).with_x_categories(groups.to_vec());
    (vec![Plot::Bar(plot)], layout)
}

/// Returns the tallest bar.
pub fn highest(bars: &[Bar]) -> f64 {
    bars.iter().flat_map(|bar| &bar.values).fold(0.0, |high, value| high.max(*value))
}

/// Returns the entries of the bars in the legend.
pub fn keys(bars: &[Bar]) -> Vec<Key> {
    bars.iter().map(|bar| Key { label: bar.label.clone(), colour: bar.colour.into(), mark: Mark::Bar }).collect()
}
