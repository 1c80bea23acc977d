//! Bars: error of each strain order.

use acm_train::schedule::descriptive::nominal::OrderRow;

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::bars::{Bar, highest, keys, panel_of};
use crate::figures::canvas::{Panels, palette};

/// Caption title.
pub const QUESTION: &str = "How many strain orders does the arm need?";

/// Draws a group per order, a bar per protocol and data.
pub fn draw(study: &Study) -> Option<Drawing> {
    let orders = &study.record.orders;
    let bar = |label: &str, colour, of: fn(&OrderRow) -> f64| Bar {
        label: label.into(),
        colour,
        values: orders.rows.iter().map(|row| of(row) * study.display.factor).collect(),
    };
    let bars = [
        bar("map frozen, binned", palette::BLUE, |row| row.frozen.binned),
        bar("map frozen, raw", palette::SKY, |row| row.frozen.raw),
        bar("map refitted, binned", palette::VERMILLION, |row| row.refitted.binned),
        bar("map refitted, raw", palette::ORANGE, |row| row.refitted.raw),
    ];
    let groups: Vec<String> = orders.rows.iter().map(|row| name(row.order)).collect();
    let [u, v] = &orders.plane;
    let title = format!("(a) Trial {}", orders.trial);
    let y = study.display.label(&format!("{u}–{v} RMSE"));
    let panel = panel_of(&title, "strain basis", &y, &groups, &bars, highest(&bars));
    let explanation = format!(
        "Root mean square error in the plane of {u} and {v} on trial {}. Every model is fitted to {} bins over {}, and \
         scored on them (binned) and on all {} samples (raw). Map frozen: the actuation map is that of the linear fit; map \
         refitted: each order has its own. The paper's steep fall from constant to linear strain is the frozen one.",
        orders.trial,
        orders.bins,
        study.swept().name,
        orders.samples
    );
    let panels = Panels { columns: 1, panels: vec![panel], size: (860.0, 340.0), legend: keys(&bars) };
    (!groups.is_empty()).then(|| panels.draw(&study.record.data, 4 * groups.len(), explanation))
}

/// Returns the name of an order.
pub fn name(order: usize) -> String {
    match order {
        0 => "constant".into(),
        1 => "linear".into(),
        2 => "quadratic".into(),
        3 => "cubic".into(),
        higher => format!("order {higher}"),
    }
}
