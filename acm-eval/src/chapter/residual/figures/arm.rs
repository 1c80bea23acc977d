//! Lines in space: nominal arms over a slice, and at each tip the mean residual as an arrow.

use acm_train::schedule::descriptive::residual::Backbone;
use kuva::{
    plot::LinePlot,
    render::{annotations::TextAnnotation, layout::Layout, plots::Plot},
};

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::axonometry::{Eye, arrow};
use crate::figures::canvas::legend::{Key, Mark};
use crate::figures::canvas::{Panels, palette, panel};

/// Caption title.
pub const QUESTION: &str = "Which way does the tip go from where the nominal model says that it is?";

/// Magnification of the arrows relative to the residual.
const MAGNIFIED: f64 = 3.0;
/// Largest number of slices.
const PANELS: usize = 6;

/// Draws a panel per slice.
pub fn draw(study: &Study) -> Option<Drawing> {
    let record = &study.record;
    let eye = Eye::at(-60.0, 18.0);
    let all: Vec<(f64, f64)> = record.backbones.iter().flat_map(|arm| seen(study, arm, eye)).collect();
    let fold = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
    let empty = (f64::INFINITY, f64::NEG_INFINITY);
    let (left, right) = all.iter().map(|point| point.0).fold(empty, fold);
    let (low, high) = all.iter().map(|point| point.1).fold(empty, fold);
    let across = Scale::around(left, right, 4);
    // Room over the arms for the three axes.
    let axes = 0.2 * (across.high - across.low);
    let scales = (across, Scale::around(low, high + 1.5 * axes, 5));
    let origin = (across.low + 0.3 * axes, high + 0.4 * axes);
    let slices: Vec<usize> =
        (0..record.slices.len()).filter(|slice| record.backbones.iter().any(|arm| arm.slice == *slice)).collect();
    let panels: Vec<(Vec<Plot>, Layout)> = slices
        .iter()
        .take(PANELS)
        .enumerate()
        .map(|(k, &slice)| one(study, slice, k, eye, scales, (origin, axes)))
        .collect();
    let arrow = format!("mean residual at the tip, ×{MAGNIFIED}");
    let legend = vec![
        Key { label: "nominal arm".into(), colour: palette::ARM.into(), mark: Mark::Line },
        Key { label: arrow, colour: palette::VERMILLION.into(), mark: Mark::Line },
        Key { label: "axes".into(), colour: palette::INK.into(), mark: Mark::Line },
    ];
    let explanation = format!(
        "Axonometric view, azimuth −60°, elevation 18°. Nominal arms at up to {} values of {} in each slice, from the base \
         to the tip; arrows point from the nominal tip to where the tip is on average, {MAGNIFIED} times as long. Only the \
         tip is measured, so nothing is said of the arm between.",
        record.asked.backbones,
        study.swept().name
    );
    let series = 2 * record.backbones.iter().filter(|arm| slices.iter().take(PANELS).any(|s| *s == arm.slice)).count();
    let columns = panels.len().min(3);
    (!panels.is_empty())
        .then(|| Panels { columns, panels, size: (310.0, 400.0), legend }.draw(&record.data, series, explanation))
}

/// Returns an arm's points and its arrow's head on the paper.
fn seen(study: &Study, arm: &Backbone, eye: Eye) -> Vec<(f64, f64)> {
    arm.points.iter().copied().chain([head(study, arm)]).map(|point| eye.sees(point.map(|x| study.shown(x)))).collect()
}

/// Returns the end of an arm's arrow, m.
fn head(study: &Study, arm: &Backbone) -> [f64; 3] {
    let mean = &study.record.slices[arm.slice].bins[arm.bin].mean;
    let tip = arm.points.last().copied().unwrap_or_default();
    std::array::from_fn(|o| tip[o] + MAGNIFIED * mean.get(o).copied().unwrap_or(0.0))
}

/// Draws one slice; the last argument gives the origin and the length of the three axes.
fn one(
    study: &Study,
    slice: usize,
    k: usize,
    eye: Eye,
    (x, y): (Scale, Scale),
    (origin, length): ((f64, f64), f64),
) -> (Vec<Plot>, Layout) {
    let line = |points: Vec<(f64, f64)>, colour: &str, width: f64| {
        Plot::Line(LinePlot::new().with_data(points).with_color(colour).with_stroke_width(width))
    };
    let mut plots = vec![];
    let title = format!("({}) {}", char::from(b'g' + k as u8), study.held(&study.record.slices[slice]));
    let (right, up) = (study.display.label("to the right"), study.display.label("up on the paper"));
    let mut layout = panel(&title, (&right, x), (&up, y)).with_equal_aspect();
    for (axis, name) in study.record.outputs.iter().enumerate().take(3) {
        let mut unit = [0.0; 3];
        unit[axis] = length;
        let (u, v) = eye.sees(unit);
        plots.push(line(vec![origin, (origin.0 + u, origin.1 + v)], palette::INK, 1.2));
        let (a, b) = (origin.0 + 1.18 * u, origin.1 + 1.18 * v);
        layout = layout.with_annotation(TextAnnotation::new(name.as_str(), a, b).with_color(palette::INK));
    }
    for arm in study.record.backbones.iter().filter(|arm| arm.slice == slice) {
        let mut points = seen(study, arm, eye);
        let (Some(head), Some(&tip)) = (points.pop(), points.last()) else { continue };
        plots.push(line(points, palette::ARM, 2.2));
        plots.push(line(arrow(tip, head), palette::VERMILLION, 2.0));
    }
    (plots, layout)
}
