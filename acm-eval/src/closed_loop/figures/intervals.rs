//! Bars from left to right: error on held-out trials before and after, each with its interval, and the noise.

use acm_core::display::labelled;
use acm_trace::finding::{Estimate, Finding};
use kuva::render::render::TextAnchor;

use super::{
    axes::{Axes, BELOW},
    colours::{AFTER, BEFORE, NOISE, NOMINAL},
    scale::Scale,
    sheet::{Mark, Sheet, TEXT},
};
use crate::closed_loop::outcome::{Outcome, Row};
use crate::closed_loop::quantity::plain;
use crate::figures::Drawing;
use crate::figures::canvas::palette;

/// Caption title.
pub const QUESTION: &str = "How far off is the model on trials that took no part, before and after?";

const WIDTH: f64 = 900.0;
const LEFT: f64 = 250.0;
const RIGHT: f64 = 90.0;
const ROW: f64 = 40.0;

/// Draws one row for each model; the noise as a line through all of them.
pub fn draw(finding: &Finding) -> Vec<Drawing> {
    let outcome = Outcome::of(finding);
    let rows = outcome.rows();
    let numbers = rows.iter().flat_map(|row| [row.error.value, row.error.interval[0], row.error.interval[1]]);
    let x = Scale::from_zero(numbers.chain([outcome.noise]), 8);
    let height = ROW * rows.len() as f64;
    let legend = [
        ("error", palette::INK, Mark::Dot),
        ("95 % interval", palette::INK, Mark::Line(None)),
        ("white noise: no model gets below it", NOISE, Mark::Line(Some("6 4"))),
    ];
    let mut sheet = Sheet::new(WIDTH, height + BELOW + 10.0, &legend, &finding.data);
    let axes =
        Axes { left: LEFT, top: sheet.top, width: WIDTH - LEFT - RIGHT, height, x, y: Scale::exactly(0.0, 1.0, 1) };
    axes.draw_across(&mut sheet, &labelled("root mean square error on held-out trials", outcome.unit));
    axes.upright(&mut sheet, outcome.noise, NOISE);
    for (index, row) in rows.iter().enumerate() {
        let y = axes.top + ROW * (index as f64 + 0.5);
        bar(&mut sheet, &axes, y, row, outcome.decimals);
    }
    sheet.series = rows.len();
    let conclusion = if outcome.found { FOUND } else { NOTHING_FOUND };
    vec![sheet.finish(format!("{BARS} {conclusion}"))]
}

fn bar(sheet: &mut Sheet, axes: &Axes, y: f64, row: &Row, decimals: usize) {
    let colour = match (row.is_after, row.is_best_baseline) {
        (true, _) => AFTER,
        (_, true) => BEFORE,
        _ => NOMINAL,
    };
    let strong = row.is_after || row.is_best_baseline;
    sheet.words(LEFT - 12.0, y + 5.0, &row.name(), TEXT, TextAnchor::End, palette::INK, strong);
    let Estimate { value, interval: [low, high] } = row.error;
    if let (Some(from), Some(to)) = (axes.across(low), axes.across(high)) {
        sheet.line((from, y), (to, y), colour, 5.0, None);
        [from, to].iter().for_each(|&x| sheet.line((x, y - 7.0), (x, y + 7.0), colour, 2.0, None));
    }
    if let Some(x) = axes.across(value) {
        sheet.dot((x, y), 6.5, colour);
    }
    let shown = plain(value, decimals);
    sheet.words(WIDTH - RIGHT + 14.0, y + 5.0, &shown, TEXT, TextAnchor::Start, palette::INK, strong);
}

const BARS: &str = "Dots are errors on trials from which nothing was fitted, bars their 95 % intervals: how far the \
    error could move had other trials been recorded.";

const FOUND: &str = "An effect is worth what the last row gains over the best baseline, not over the nominal model \
    alone: calibrating again removes a part of many errors without explaining them.\n\
    Were the effect wrong, or true in some trials only, the last row would stand where the best baseline stands, or to \
    the right of it. All rows are the same trials, so a gain can be sure although two bars overlap.";

const NOTHING_FOUND: &str = "Nothing was added, so the last row gains nothing over calibrating again.\n\
    Had an effect been found that belongs to the robot, the last row would stand left of the others, nearer to the \
    noise.";
