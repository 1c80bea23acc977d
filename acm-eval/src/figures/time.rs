//! Lines: distance from the measured tip over time, one panel per held-out trial; more than two networks have a row each,
//! before the nominal model in grey, for their lines would hide each other.

use std::ops::Range;

use kuva::{
    plot::LinePlot,
    render::{layout::Layout, plots::Plot},
};

use super::Drawing;
use super::canvas::axis::Scale;
use super::canvas::legend::{Key, Mark};
use super::canvas::{Panels, panel};
use super::short::short;
use crate::run::predictions::{HELD_OUT, Predictions};
use crate::section::estimator::Estimator;
use crate::section::{Section, natural};

/// Caption title.
pub const QUESTION: &str = "When is the model off, and when does learning help?";

/// Points of one line in one trial, at most; longer trials are drawn as root mean squares over so many samples each.
const POINTS: usize = 500;
/// Largest number of panels where all lines of a trial share one.
const PANELS: usize = 12;
/// Largest number of networks that share a panel.
const TOGETHER: usize = 2;
/// Largest number of trials where each network has a row of its own.
const APART: usize = 3;

/// Data of one line.
struct Line<'a> {
    estimator: &'a Estimator,
    table: &'a Predictions,
    max_gap: f64,
}

/// A piece of a line between two gaps: whose it is, and its points.
type Piece<'a> = (&'a Estimator, Vec<(f64, f64)>);

/// Draws nominal model and networks; a gap in the recording is a gap in the line.
pub fn draw(section: &Section) -> Option<Drawing> {
    let lines = lines(section);
    let mut trials: Vec<&str> = lines.first()?.table.trials(HELD_OUT).iter().map(|trial| trial.trial).collect();
    trials.sort_by_key(|trial| natural(trial));
    trials.dedup();
    let total = trials.len();
    let networks = lines.iter().filter(|line| line.estimator.network).count();
    let apart = networks > TOGETHER;
    trials.truncate(if apart { APART } else { PANELS });
    let bin = |trial: &str| {
        let samples: usize = rows_of(lines[0].table, trial).map(|rows| rows.len()).sum();
        samples.div_ceil(POINTS).max(1)
    };
    let binned = trials.iter().map(|trial| bin(trial)).max().unwrap_or(1);
    let curves: Vec<Vec<Piece>> = trials.iter().map(|trial| all_pieces(section, &lines, trial, bin(trial))).collect();
    let samples: Vec<Vec<Piece>> = trials.iter().map(|trial| all_pieces(section, &lines, trial, 1)).collect();
    let highest = curves.iter().flatten().flat_map(|(_, piece)| piece).fold(0.0_f64, |high, point| high.max(point.1));
    let panels = |curves: &[Vec<Piece>]| match apart {
        true => rows(section, &lines, &trials, curves, highest),
        false => together(section, &trials, curves, highest),
    };
    let finer = panels(&samples).into_iter().map(|(plots, _)| plots).collect();
    let panels = panels(&curves);
    let series = panels.iter().map(|(plots, _)| plots.len()).sum();
    let legend = lines
        .iter()
        .map(|line| Key { label: line.estimator.label.clone(), colour: line.estimator.colour.into(), mark: Mark::Line })
        .collect();
    let explanation = explanation(section, total, trials.len(), binned);
    let (columns, height) = match (apart, total) {
        (true, _) => (trials.len(), 210.0),
        (false, 1) => (1, 330.0),
        (false, _) => (1, 250.0),
    };
    let size = (880.0 / columns as f64, height);
    let panels = Panels { columns, panels, size, legend };
    let mut drawing = panels.draw_finer(Some(finer), &section.data, series, explanation);
    for (panel, trial) in drawing.plotted.iter_mut().zip(trials.iter().cycle()) {
        panel.trial = (*trial).into();
    }
    Some(drawing)
}

/// Returns the pieces of all lines of a trial.
fn all_pieces<'a>(section: &Section, lines: &[Line<'a>], trial: &str, bin: usize) -> Vec<Piece<'a>> {
    let of = |line: &Line<'a>| {
        let estimator = line.estimator;
        pieces(section, line, trial, bin).into_iter().map(move |piece| (estimator, piece))
    };
    lines.iter().flat_map(of).collect()
}

/// Returns a panel for each trial, all lines in it.
fn together(section: &Section, trials: &[&str], curves: &[Vec<Piece>], highest: f64) -> Vec<(Vec<Plot>, Layout)> {
    let panel = |(trial, curves): (&&str, &Vec<Piece>)| {
        one(section, &format!("Trial {trial}"), &curves.iter().collect::<Vec<_>>(), highest, 8)
    };
    trials.iter().zip(curves).map(panel).collect()
}

/// Returns a row of panels for each network, a column for each trial; in each the nominal model, then the network.
fn rows(
    section: &Section,
    lines: &[Line],
    trials: &[&str],
    curves: &[Vec<Piece>],
    highest: f64,
) -> Vec<(Vec<Plot>, Layout)> {
    let mut panels = vec![];
    for network in lines.iter().map(|line| line.estimator).filter(|estimator| estimator.network) {
        for (trial, curves) in trials.iter().zip(curves) {
            let shown = |(whose, _): &&Piece| !whose.network || *whose == network;
            let curves: Vec<&Piece> = curves.iter().filter(shown).collect();
            panels.push(one(section, &format!("{}, trial {trial}", short(&network.label, 26)), &curves, highest, 4));
        }
    }
    panels
}

fn lines(section: &Section) -> Vec<Line<'_>> {
    let shown = section.estimators.iter().filter(|estimator| estimator.network || estimator.key == "nominal");
    shown
        .filter_map(|estimator| {
            let (record, table) = section.median_seed(estimator)?;
            Some(Line { estimator, table, max_gap: record.experiment.windows.gap() })
        })
        .collect()
}

fn rows_of<'a>(table: &'a Predictions, trial: &'a str) -> impl Iterator<Item = Range<usize>> + 'a {
    table.trials(HELD_OUT).into_iter().filter(move |rows| rows.trial == trial).map(|rows| rows.rows)
}

/// Returns the line of one trial, cut at gaps: (time in s, root mean square distance over `bin` samples in display
/// units).
fn pieces(section: &Section, line: &Line, trial: &str, bin: usize) -> Vec<Vec<(f64, f64)>> {
    let time = line.table.time();
    let estimate = if line.estimator.network { "predicted" } else { line.estimator.key.as_str() };
    let square = |row| (line.table.distance(estimate, &section.outputs, row) * section.display.factor).powi(2);
    let point = |rows: Range<usize>| {
        let n = rows.len() as f64;
        (time[rows.clone()].iter().sum::<f64>() / n, (rows.map(square).sum::<f64>() / n).sqrt())
    };
    rows_of(line.table, trial)
        .flat_map(|rows| segments(time, rows, line.max_gap))
        .map(|segment| segment.clone().step_by(bin).map(|start| point(start..(start + bin).min(segment.end))).collect())
        .collect()
}

/// Cuts `rows` where the time between two of them is longer than `max_gap` and than one and a half median steps
/// (targets may be further apart than samples).
fn segments(time: &[f64], rows: Range<usize>, max_gap: f64) -> Vec<Range<usize>> {
    let mut steps: Vec<f64> = rows.clone().skip(1).map(|row| time[row] - time[row - 1]).collect();
    steps.sort_by(f64::total_cmp);
    let longest = max_gap.max(1.5 * steps.get(steps.len() / 2).copied().unwrap_or(0.0));
    let mut found = vec![rows.start..rows.start];
    for row in rows {
        match found.last_mut() {
            Some(last) if last.end == last.start || time[row] - time[row - 1] <= longest => last.end = row + 1,
            _ => found.push(row..row + 1),
        }
    }
    found
}

fn one(section: &Section, title: &str, curves: &[&Piece], highest: f64, ticks: usize) -> (Vec<Plot>, Layout) {
    let times = || curves.iter().flat_map(|(_, piece)| piece.iter().map(|point| point.0));
    let (first, last) = times().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
    let y = section.display.label(&format!("{} error", section.total()));
    let x = Scale::tight(first, last, ticks);
    let layout = panel(title, ("time [s]", x), (&y, Scale::around(0.0, highest, 4)));
    let line = |(estimator, piece): &&Piece| {
        let width = if estimator.network { 1.6 } else { 1.8 };
        Plot::Line(LinePlot::new().with_data(piece.clone()).with_color(estimator.colour).with_stroke_width(width))
    };
    (curves.iter().map(line).collect(), layout)
}

fn explanation(section: &Section, total: usize, drawn: usize, bin: usize) -> String {
    let seeds: Vec<String> = section
        .networks()
        .filter_map(|network| Some(format!("{} seed {}", network.label, section.median_seed(network)?.0.seed)))
        .collect();
    let left_out = match total - drawn {
        0 => String::new(),
        more => format!(" {more} further trials are in the tables only."),
    };
    let binned = match bin {
        1 => String::new(),
        bin => format!(
            " Each point is the root mean square over up to {bin} consecutive time stamps; under the cursor, and where \
             one zooms in, are single ones."
        ),
    };
    let what = match section.data.unit.as_str() {
        "m" => "Distance between estimated and measured tip",
        _ => "Root of the sum of squared errors over all outputs",
    };
    format!(
        "{what}. Gaps in the recording are gaps in the lines. Networks: the seed \
         with the median error ({}).{binned}{left_out}",
        seeds.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_at_a_gap_and_not_at_the_stride() {
        let time = [0.0, 1.0, 2.0, 5.0, 6.0, 6.9];
        assert_eq!(segments(&time, 0..6, 0.5), [0..3, 3..6]);
        assert_eq!(segments(&time, 0..6, 4.0), [0..6]);
        assert_eq!(segments(&time, 3..4, 0.5), [3..4]);
    }
}
