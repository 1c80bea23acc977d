//! Lines: one output of one held-out trial over time, measured and predicted, and below it the residual of each model.

use acm_core::display::labelled;
use acm_trace::finding::{Finding, Trace};

use super::{
    axes::{Axes, BELOW, LEFT, Stroke},
    colours::{AFTER, MEASURED, NOMINAL},
    scale::Scale,
    sheet::{Mark, Sheet},
};
use crate::closed_loop::outcome::after;
use crate::figures::Drawing;
use crate::figures::canvas::palette;
use crate::figures::plotted::{PlottedPanel, Series, TIME};
use crate::figures::short::short;

/// Caption title.
pub const QUESTION: &str = "What does that look like over time?";

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 240.0;
/// Height of the lower panel, which shows the residual.
const BELOW_HEIGHT: f64 = 170.0;
/// A step this many times the median step is a gap in the recording, and in the lines.
const GAP: f64 = 5.0;

/// Draws two panels.
pub fn draw(finding: &Finding) -> Vec<Drawing> {
    finding.figures.trace.iter().filter_map(|trace| one(finding, trace)).collect()
}

fn one(finding: &Finding, trace: &Trace) -> Option<Drawing> {
    let curves = [
        (&trace.measured, Stroke { colour: MEASURED, width: 4.5, dashes: None }),
        (&trace.nominal, Stroke { colour: NOMINAL, width: 1.6, dashes: None }),
        (&trace.after, Stroke { colour: AFTER, width: 1.8, dashes: Some("7 3") }),
    ];
    let samples = trace.time.len();
    if samples == 0 || curves.iter().all(|(values, _)| values.is_empty()) {
        return None;
    }
    let legend = [
        ("measured", MEASURED, Mark::Line(None)),
        ("nominal model", NOMINAL, Mark::Line(None)),
        (after(finding), AFTER, Mark::Line(Some("7 3"))),
    ];
    let mut sheet = Sheet::new(WIDTH, 34.0 + HEIGHT + BELOW + BELOW_HEIGHT + BELOW, &legend, &finding.data);
    let x = Scale::holding(trace.time.iter().copied(), 10);
    let panel = |top, height, y| Axes { left: LEFT, top, width: WIDTH - LEFT - 24.0, height, x, y };
    let motion = Scale::holding(curves.iter().flat_map(|(values, _)| values.iter().copied()), 5);
    let above = panel(sheet.top + 30.0, HEIGHT, motion);
    let unit = &finding.errors.unit;
    let output = short(&trace.output, 16);
    let (title, y_label) = (format!("Trial {}", short(&trace.trial, 60)), labelled(&output, unit));
    above.draw(&mut sheet, &title, "", &y_label);
    let mut plotted = vec![];
    for ((values, stroke), (name, ..)) in curves.into_iter().zip(legend) {
        draw_pieces(&mut sheet, &above, &trace.time, values, stroke);
        plotted.push(series(name, &trace.time, values, stroke));
    }
    let of_trial = |panel: PlottedPanel| PlottedPanel { trial: trace.trial.clone(), ..panel };
    sheet.plotted.push(of_trial(above.plotted(&title, TIME, &y_label, plotted)));
    let missed = curves[1..].iter().map(|(values, stroke)| (difference(&trace.measured, values), *stroke));
    let missed: Vec<(Vec<f64>, Stroke)> = missed.collect();
    let scale = Scale::holding(missed.iter().flat_map(|(values, _)| values.iter().copied()), 4);
    let below = panel(above.top + HEIGHT + 34.0, BELOW_HEIGHT, scale);
    let y_label = labelled(&format!("missed in {output}"), unit);
    below.draw(&mut sheet, "", TIME, &y_label);
    below.level(&mut sheet, 0.0, palette::INK, 1.0);
    let mut plotted = vec![];
    for ((values, stroke), (name, ..)) in missed.iter().zip(&legend[1..]) {
        draw_pieces(&mut sheet, &below, &trace.time, values, *stroke);
        plotted.push(series(name, &trace.time, values, *stroke));
    }
    sheet.plotted.push(of_trial(below.plotted("", TIME, &y_label, plotted)));
    let look = if !finding.adds() { NOTHING_FOUND } else { FOUND };
    Some(sheet.finish(format!("{LINES}\n{look}")))
}

fn difference(measured: &[f64], modelled: &[f64]) -> Vec<f64> {
    measured.iter().zip(modelled).map(|(measured, modelled)| measured - modelled).collect()
}

fn draw_pieces(sheet: &mut Sheet, axes: &Axes, time: &[f64], values: &[f64], stroke: Stroke) {
    for piece in pieces(time, values) {
        axes.curve(sheet, piece, stroke);
    }
    sheet.series += 1;
}

/// Returns the values of a line in the plot.
fn series(name: &str, time: &[f64], values: &[f64], stroke: Stroke) -> Series {
    let pieces = pieces(time, values).into_iter();
    let is_number = |point: &(f64, f64)| point.1.is_finite();
    let pieces = pieces.map(|piece| piece.into_iter().filter(is_number).collect()).collect();
    Series { width: stroke.width, pieces, ..Series::line(name, stroke.colour, stroke.dashes.is_some(), &[]) }
}

/// Returns (time, value), cut at gaps.
fn pieces(time: &[f64], values: &[f64]) -> Vec<Vec<(f64, f64)>> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite()).collect();
    steps.sort_by(f64::total_cmp);
    let longest = steps.get(steps.len() / 2).map_or(f64::INFINITY, |median| GAP * median);
    let points: Vec<(f64, f64)> = time.iter().copied().zip(values.iter().copied()).collect();
    points.chunk_by(|a, b| b.0 - a.0 <= longest).map(<[_]>::to_vec).collect()
}

const LINES: &str = "A stretch of a held-out trial. Above, grey and thick, what was measured, on which a good model \
    lies; below, measured minus modelled.";

const FOUND: &str = "Were the effect wrong, the dashed line below would leave zero in the same places as the nominal \
    model, or in new ones. Where both leave zero together, something else is missing.";

const NOTHING_FOUND: &str = "Nothing was added, so the two models are alike. Below, an even fuzz is noise; waves, \
    ramps and jumps are not.";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_in_the_recording_is_a_gap_in_the_line() {
        let time = [0.0, 0.1, 0.2, 0.3, 5.0, 5.1];
        let lengths: Vec<usize> = pieces(&time, &[1.0; 6]).iter().map(Vec::len).collect();
        assert_eq!(lengths, [4, 2]);
        assert!(pieces(&[], &[]).is_empty() && pieces(&[1.0], &[2.0]).len() == 1);
    }
}
