//! Lines: loss of training and validation per epoch, a panel for each row of the question, all seeds.

use acm_train::{learn::Epoch, run::sequences::record::SequenceRecord};
use kuva::{plot::LinePlot, render::layout::Layout, render::plots::Plot};

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::axis::Scale;
use crate::figures::canvas::legend::{Key, Mark};
use crate::figures::canvas::{Panels, palette, panel};

/// Caption title.
pub const QUESTION: &str = "What is learned, epoch by epoch, with the time between samples and without it?";

/// Draws a panel for each row.
pub fn draw(study: &Study) -> Option<Drawing> {
    let epochs = || study.runs.iter().flat_map(|run| &run.epochs);
    let highest = epochs().fold(0.0_f64, |high, epoch| high.max(epoch.train_loss).max(epoch.validation_loss));
    if highest == 0.0 {
        return None;
    }
    let rows = study.rows();
    let panels: Vec<(Vec<Plot>, Layout)> = rows.iter().map(|(told, runs)| one(told, runs, highest)).collect();
    let key = |label: &str, mark| Key { label: label.into(), colour: palette::FAINT.into(), mark };
    let legend = vec![key("training", Mark::Dashes), key("validation", Mark::Line)];
    let explanation = "Mean loss over the sequences, one pair of lines per seed. The weights of the epoch with the smallest \
                       validation loss were kept.";
    let columns = panels.len();
    let size = (if columns == 1 { 720.0 } else { 880.0 / columns as f64 }, 320.0);
    Some(Panels { columns, panels, size, legend }.draw(&study.data, 2 * study.runs.len(), explanation.into()))
}

fn one(told: &str, runs: &[&SequenceRecord], highest: f64) -> (Vec<Plot>, Layout) {
    let last = runs.iter().map(|run| run.epochs.len()).max().unwrap_or(1);
    let (x, y) = (Scale::tight(0.0, 1.03 * last as f64, 5), Scale::around(0.0, highest, 5));
    let line = |run: &SequenceRecord, loss: fn(&Epoch) -> f64| {
        let points: Vec<(f64, f64)> = run.epochs.iter().map(|epoch| (epoch.epoch as f64, loss(epoch))).collect();
        LinePlot::new().with_data(points).with_color(palette::BLUE).with_stroke_width(1.1)
    };
    let lines = runs.iter().flat_map(|run| {
        [
            Plot::Line(line(run, |epoch| epoch.train_loss).with_dashed()),
            Plot::Line(line(run, |epoch| epoch.validation_loss)),
        ]
    });
    (lines.collect(), panel(told, ("epoch", x), ("loss", y)))
}
