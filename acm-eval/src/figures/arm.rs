//! The arm in space along held-out trials, with the measured tip and that of each model, and the residual as an arrow.
//! Drawn at the sample with the largest error of the nominal model; the page's script shows all of them.

mod gather;

use kuva::{
    plot::{LinePlot, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot},
};

use super::Drawing;
use super::canvas::axis::Scale;
use super::canvas::axonometry::{Eye, arrow};
use super::canvas::legend::{Key, Mark};
use super::canvas::{Panels, palette, panel};
use super::plotted::space::{Space, SpaceTrial};
use crate::section::Section;

/// Caption title.
pub const QUESTION: &str = "Where is the arm, and which way does the model miss its tip?";

/// Drawn elements of a trial: the arm, the arrow, and tips with their colours, in the plane of the paper.
struct Seen {
    arm: Vec<(f64, f64)>,
    arrow: Vec<(f64, f64)>,
    tips: Vec<((f64, f64), String)>,
}

/// Draws a panel for each trial; nothing where the outputs are no place in space.
pub fn draw(section: &Section) -> Option<Drawing> {
    let space = gather::space(section)?;
    let worst: Vec<usize> = space.trials.iter().map(worst).collect();
    let seen: Vec<Seen> = space.trials.iter().zip(&worst).map(|(trial, t)| look(&space, trial, *t)).collect();
    let scales = scales(&seen);
    let panels: Vec<_> = (space.trials.iter().zip(&worst))
        .zip(&seen)
        .map(|((trial, t), seen)| {
            one(section, &format!("Trial {}, {:.2} s", trial.trial, trial.time[*t]), seen, scales)
        })
        .collect();
    let series = panels.iter().map(|(plots, _)| plots.len()).sum();
    let columns = panels.len();
    let width = if columns == 1 { 620.0 } else { 310.0 };
    let legend = legend(&space);
    let explanation = gather::explanation(section, &space);
    let mut drawing = Panels { columns, panels, size: (width, 400.0), legend }.draw(&section.data, series, explanation);
    drawing.plotted.clear();
    drawing.space = Some(space);
    Some(drawing)
}

/// Returns the index of the sample of a trial with the largest error of the nominal model.
fn worst(trial: &SpaceTrial) -> usize {
    let missed = gather::missed(trial);
    (0..missed.len()).max_by(|&a, &b| missed[a].total_cmp(&missed[b])).unwrap_or(0)
}

fn look(space: &Space, trial: &SpaceTrial, t: usize) -> Seen {
    let eye = Eye::at(-60.0, 18.0);
    let sees = |point: [f64; 3]| eye.sees(space.frame.map(|axis| (0..3).map(|k| axis[k] * point[k]).sum()));
    let (measured, nominal) = (trial.tips[0].points[t], trial.tips[1].points[t]);
    let head = std::array::from_fn(|k| nominal[k] + space.magnified * (measured[k] - nominal[k]));
    Seen {
        arm: trial.arm.get(t).into_iter().flatten().map(|&point| sees(point)).collect(),
        arrow: arrow(sees(nominal), sees(head)),
        tips: trial.tips.iter().map(|tip| (sees(tip.points[t]), tip.colour.clone())).collect(),
    }
}

/// Returns one scale for all panels, around everything that is drawn.
fn scales(seen: &[Seen]) -> (Scale, Scale) {
    let all = || seen.iter().flat_map(|s| s.arm.iter().chain(&s.arrow).chain(s.tips.iter().map(|(place, _)| place)));
    let fold = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
    let empty = (f64::INFINITY, f64::NEG_INFINITY);
    let (left, right) = all().map(|place| place.0).fold(empty, fold);
    let (low, high) = all().map(|place| place.1).fold(empty, fold);
    (Scale::around(left, right, 4), Scale::around(low, high, 5))
}

fn one(section: &Section, title: &str, seen: &Seen, (x, y): (Scale, Scale)) -> (Vec<Plot>, Layout) {
    let line = |points: &Vec<(f64, f64)>, colour: &str, width: f64| {
        Plot::Line(LinePlot::new().with_data(points.clone()).with_color(colour).with_stroke_width(width))
    };
    let mut plots = vec![];
    if !seen.arm.is_empty() {
        plots.push(line(&seen.arm, palette::ARM, 2.6));
    }
    plots.push(line(&seen.arrow, palette::VERMILLION, 2.0));
    for (place, colour) in &seen.tips {
        plots.push(Plot::Scatter(ScatterPlot::new().with_data([*place]).with_color(colour.as_str()).with_size(4.5)));
    }
    let (right, up) = (section.display.label("to the right"), section.display.label("up on the paper"));
    (plots, panel(title, (&right, x), (&up, y)).with_equal_aspect())
}

fn legend(space: &Space) -> Vec<Key> {
    let key = |label: &str, colour: &str, mark| Key { label: label.into(), colour: colour.into(), mark };
    let arm = space.has_arm().then(|| key("nominal arm", palette::ARM, Mark::Line));
    let residual = format!("residual, ×{}", space.magnified);
    let tips = space.trials.first().into_iter().flat_map(|trial| &trial.tips);
    let tips = tips.map(|tip| key(&format!("tip, {}", tip.name), &tip.colour, Mark::Dot));
    arm.into_iter().chain([key(&residual, palette::VERMILLION, Mark::Line)]).chain(tips).collect()
}
