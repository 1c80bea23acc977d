//! Lines: loss of training and validation per epoch, all seeds, with the kept epoch marked.

use acm_train::{
    learn::Epoch,
    run::record::{RunRecord, Stage},
};
use kuva::{
    plot::{LinePlot, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot},
};

use super::Drawing;
use super::canvas::axis::Scale;
use super::canvas::legend::{Key, Mark};
use super::canvas::{Panels, palette, panel};
use crate::{run::Run, section::Section};

/// Caption title.
pub const QUESTION: &str = "Did training settle, and which epoch was kept?";

/// Draws one panel per run, three in a row.
pub fn draw(section: &Section) -> Option<Drawing> {
    let highest = section
        .runs
        .iter()
        .flat_map(shown)
        .flat_map(|record| &record.epochs)
        .fold(0.0_f64, |high, epoch| high.max(epoch.train_loss).max(epoch.validation_loss));
    if highest == 0.0 {
        return None;
    }
    let panels: Vec<_> = section
        .networks()
        .map(|network| one(&network.label, network.colour, &section.runs[network.run], highest))
        .collect();
    let series = section.runs.iter().map(|run| 3 * shown(run).count()).sum();
    let key = |label: &str, mark| Key { label: label.into(), colour: palette::FAINT.into(), mark };
    let legend = vec![key("training", Mark::Dashes), key("validation", Mark::Line), key("kept epoch", Mark::Dot)];
    let columns = panels.len().min(3);
    let size = (if columns == 1 { 720.0 } else { 880.0 / columns as f64 }, 320.0);
    let stage = if section.runs.iter().all(|run| run.finals().next().is_some()) { "seed" } else { "seed or fold" };
    let explanation = format!(
        "Mean squared error of the standardised residual (1 = the spread of the training part), one pair of lines per \
         {stage}. The weights of the epoch with the smallest validation loss were kept."
    );
    let explanation = explanation + &rows_of_baselines(section);
    Some(Panels { columns, panels, size, legend }.draw(&section.data, series, explanation))
}

/// Writes a note in place of the curves where no network was trained.
fn rows_of_baselines(section: &Section) -> String {
    let there = |kind: &str| section.runs.iter().any(|run| run.kind() == kind);
    let ridge = " An epoch of a ridge regression is a penalty, from the largest down.";
    let trees = " An epoch of boosted trees is a round, which adds a tree to each output.";
    [("ridge", ridge), ("boosted_trees", trees)]
        .into_iter()
        .filter(|(kind, _)| there(kind))
        .map(|(_, text)| text)
        .collect()
}

/// Returns the final records where there are any, else those of the folds.
fn shown(run: &Run) -> impl Iterator<Item = &RunRecord> {
    let finals = run.finals().next().is_some();
    run.records.iter().filter(move |record| !finals || record.stage == Stage::Final)
}

fn one(label: &str, colour: &str, run: &Run, highest: f64) -> (Vec<Plot>, Layout) {
    let last = shown(run).flat_map(|record| &record.epochs).map(|epoch| epoch.epoch).max().unwrap_or(1);
    let (x, y) = (Scale::tight(0.0, 1.03 * last as f64, 5), Scale::around(0.0, highest, 5));
    let layout = panel(label, ("epoch", x), ("loss (standardised)", y));
    (shown(run).flat_map(|record| curves(record, colour)).collect(), layout)
}

/// Returns the epochs of a record, with epoch 0 where there is one.
fn all(record: &RunRecord) -> impl Iterator<Item = &Epoch> {
    record.epoch_zero.iter().chain(&record.epochs)
}

fn curves(record: &RunRecord, colour: &str) -> [Plot; 3] {
    let line = |loss: fn(&Epoch) -> f64| {
        let points: Vec<(f64, f64)> = all(record).map(|epoch| (epoch.epoch as f64, loss(epoch))).collect();
        LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.1)
    };
    let kept = all(record).filter(|epoch| epoch.epoch == record.best_epoch);
    let kept = kept.map(|epoch| (epoch.epoch as f64, epoch.validation_loss));
    [
        Plot::Line(line(|epoch| epoch.train_loss).with_dashed()),
        Plot::Line(line(|epoch| epoch.validation_loss)),
        Plot::Scatter(ScatterPlot::new().with_data(kept).with_color(colour).with_size(4.5)),
    ]
}
