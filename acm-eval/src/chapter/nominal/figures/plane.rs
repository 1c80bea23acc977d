//! Lines: the tip's path in the plane of the order study, the lowest order against each higher one.

use kuva::{
    plot::{LinePlot, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot},
};

use super::{Study, orders::name};
use crate::figures::Drawing;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::legend::{Key, Mark, dashes};
use crate::figures::canvas::{Panels, palette, panel};

/// Caption title.
pub const QUESTION: &str = "What path of the tip does each strain order predict?";

/// Draws a panel per order above the lowest.
pub fn draw(study: &Study) -> Option<Drawing> {
    let mut orders: Vec<usize> = study.record.orders.rows.iter().map(|row| row.order).collect();
    orders.sort_unstable();
    let (&lowest, higher) = orders.split_first()?;
    let limits = limits(study, &orders);
    let panels: Vec<(Vec<Plot>, Layout)> =
        higher.iter().enumerate().map(|(k, &order)| one(study, lowest, order, k, limits)).collect();
    let key = |label: &str, colour: &str, mark| Key { label: label.into(), colour: colour.into(), mark };
    let legend = vec![
        key("measured, binned", palette::INK, Mark::Dot),
        key(&format!("{}, map frozen", name(lowest)), palette::VERMILLION, Mark::Line),
        key(&format!("{}, map refitted", name(lowest)), palette::PURPLE, Mark::Dashes),
        key("order of the panel, map frozen", palette::BLUE, Mark::Line),
    ];
    let explanation = format!(
        "Trial {}: tip in the plane of {} and {} over {} bins. Map frozen: actuation map of the linear fit; map refitted: a \
         map of its own. A constant strain in one plane has a single path, whatever its map: the map says how far along \
         the path the tip is.",
        study.record.orders.trial, study.record.orders.plane[0], study.record.orders.plane[1], study.record.orders.bins
    );
    let series = 4 * panels.len();
    let columns = panels.len().min(3);
    (!panels.is_empty())
        .then(|| Panels { columns, panels, size: (310.0, 260.0), legend }.draw(&study.record.data, series, explanation))
}

/// Returns the path of an estimate, by rising swept actuator.
fn path(study: &Study, estimate: &str) -> Vec<(f64, f64)> {
    let table = &study.bins;
    let of = |output: &str| table.column(&format!("{estimate}_{output}"));
    let ([u, v], factor) = (&study.record.orders.plane, study.display.factor);
    let q = table.column(&format!("actuator_{}", study.swept().name));
    let mut rows: Vec<usize> = (0..q.len()).collect();
    rows.sort_by(|&a, &b| q[a].total_cmp(&q[b]));
    rows.into_iter().map(|row| (factor * of(u)[row], factor * of(v)[row])).collect()
}

/// Returns the limits of both axes over all panels.
fn limits(study: &Study, orders: &[usize]) -> [Scale; 2] {
    let estimates = orders.iter().flat_map(|order| [format!("order{order}_frozen"), format!("order{order}_refitted")]);
    let points: Vec<(f64, f64)> =
        estimates.chain(["measured".to_string()]).flat_map(|estimate| path(study, &estimate)).collect();
    let around = |of: fn(&(f64, f64)) -> f64, ticks| {
        let fold = |(low, high): (f64, f64), point| (low.min(of(point)), high.max(of(point)));
        let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold);
        Scale::around(low, high, ticks)
    };
    [around(|point| point.0, 4), around(|point| point.1, 5)]
}

fn one(study: &Study, lowest: usize, order: usize, k: usize, [x, y]: [Scale; 2]) -> (Vec<Plot>, Layout) {
    let line = |estimate: String, colour: &str| {
        LinePlot::new().with_data(path(study, &estimate)).with_color(colour).with_stroke_width(2.0)
    };
    let dots = ScatterPlot::new().with_data(path(study, "measured")).with_color(palette::INK).with_size(2.6);
    let plots = vec![
        Plot::Line(line(format!("order{lowest}_frozen"), palette::VERMILLION)),
        Plot::Line(line(format!("order{lowest}_refitted"), palette::PURPLE).with_line_style(dashes())),
        Plot::Line(line(format!("order{order}_frozen"), palette::BLUE)),
        Plot::Scatter(dots),
    ];
    let title = format!("({}) {} and {}", char::from(b'g' + k.min(10) as u8), name(lowest), name(order));
    let [u, v] = study.record.orders.plane.each_ref().map(|name| study.display.label(name));
    let layout = panel(&title, (&u, x), (&v, y));
    (plots, layout.with_equal_aspect())
}
