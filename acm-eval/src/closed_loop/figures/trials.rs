//! Dots: error of each held-out trial by the nominal model, the best baseline, and with the effects.

use acm_core::display::labelled;
use acm_trace::finding::{Finding, TrialErrors};
use kuva::render::render::TextAnchor;

use super::{
    axes::{Axes, BELOW},
    colours::{AFTER, BEFORE, NOISE, NOMINAL},
    scale::Scale,
    sheet::{Mark, SMALL, Sheet},
};
use crate::closed_loop::outcome::after;
use crate::figures::Drawing;
use crate::figures::canvas::palette;
use crate::figures::short::short;

/// Caption title.
pub const QUESTION: &str = "Is it better in every held-out trial?";

const WIDTH: f64 = 900.0;
const LEFT: f64 = 210.0;
const ROW: f64 = 26.0;
/// Trials that are drawn, at most; the table has all.
pub const SHOWN: usize = 40;

/// Draws one row for each trial.
pub fn draw(finding: &Finding) -> Vec<Drawing> {
    let trials = &finding.figures.trials;
    let shown = &trials[..trials.len().min(SHOWN)];
    if shown.is_empty() {
        return vec![];
    }
    let legend = [
        ("nominal model", NOMINAL, Mark::Dot),
        ("best baseline", BEFORE, Mark::Dot),
        (after(finding), AFTER, Mark::Dot),
        ("white noise", NOISE, Mark::Line(Some("6 4"))),
    ];
    let height = ROW * shown.len() as f64;
    let mut sheet = Sheet::new(WIDTH, height + BELOW + 16.0, &legend, &finding.data);
    let floor = finding.errors.noise;
    let x = Scale::from_zero(shown.iter().flat_map(errors).chain([floor]), 8);
    let axes = Axes {
        left: LEFT,
        top: sheet.top + 6.0,
        width: WIDTH - LEFT - 30.0,
        height,
        x,
        y: Scale::exactly(0.0, 1.0, 1),
    };
    axes.draw_across(&mut sheet, &labelled("root mean square error", &finding.errors.unit));
    axes.upright(&mut sheet, floor, NOISE);
    for (index, trial) in shown.iter().enumerate() {
        row(&mut sheet, &axes, axes.top + ROW * (index as f64 + 0.5), trial);
    }
    sheet.series = 3 * shown.len();
    vec![sheet.finish(explanation(finding))]
}

fn errors(trial: &TrialErrors) -> [f64; 3] {
    [trial.nominal, trial.best_baseline, trial.after]
}

fn row(sheet: &mut Sheet, axes: &Axes, y: f64, trial: &TrialErrors) {
    let right = axes.left + axes.width;
    sheet.line((axes.left, y), (right, y), palette::GRID, 1.0, None);
    sheet.words(LEFT - 12.0, y + 4.5, &short(&trial.name, 24), SMALL, TextAnchor::End, palette::INK, false);
    if let (Some(before), Some(after)) = (axes.across(trial.best_baseline), axes.across(trial.after)) {
        let colour = if after <= before { AFTER } else { NOMINAL };
        sheet.line((before, y), (after, y), colour, 2.0, None);
    }
    for (value, colour) in errors(trial).into_iter().zip([NOMINAL, BEFORE, AFTER]) {
        if let Some(x) = axes.across(value) {
            sheet.dot((x, y), 5.0, colour);
        }
    }
}

fn explanation(finding: &Finding) -> String {
    let more = match finding.figures.trials.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(" {more} further trials are in the table only."),
    };
    let look = match !finding.adds() {
        true => {
            "Nothing was added, so the two ends of each line lie close together. Trials in which every model is worse \
                 than in others are the ones to look at."
        }
        false => {
            "What belongs to the robot helps in every trial. Had the effect been fitted to a peculiarity of some \
                  trials, its dots would lie right of the best baseline in others, and the line between them would be \
                  orange-red."
        }
    };
    format!(
        "One row for each trial (or block of a record) that took no part; the line joins the best baseline with the \
         model after.{more}\n\
         {look}"
    )
}
