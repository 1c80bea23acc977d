//! Cells: share of one effect that another can imitate in these data.

use acm_trace::finding::Separability;
use kuva::render::render::TextAnchor;

use super::{
    colours,
    sheet::{SMALL, Sheet},
};
use crate::closed_loop::quantity::UNKNOWN;
use crate::closed_loop::words::effect_words;
use crate::figures::Drawing;
use crate::figures::canvas::palette;
use crate::figures::short::short;

/// Name of the files, and of the anchor on the page.
pub const NAME: &str = "matrix";
/// Caption title.
pub const QUESTION: &str = "How much of each effect could another one imitate in these data?";

const CELL: f64 = 28.0;
const ROW: f64 = 24.0;
const LEFT: f64 = 210.0;
const ABOVE: f64 = 172.0;
/// Distance between the effects and the column of recalibration.
const APART: f64 = 10.0;
/// Effects that are drawn, at most; the list of pairs has the closest of all.
pub const SHOWN: usize = 60;

/// Draws a row for each effect, a column for each imitator, and one for recalibration; none without effects.
pub fn draw(separability: &Separability) -> Option<Drawing> {
    let names = &separability.effects[..separability.effects.len().min(SHOWN)];
    if names.is_empty() {
        return None;
    }
    let (width, height) = (CELL * names.len() as f64, ROW * names.len() as f64);
    let total = (LEFT + width + APART + CELL + 90.0).max(520.0);
    let mut sheet = Sheet::new(total, ABOVE + height + 10.0, &[], &separability.data);
    let (left, top) = (LEFT, sheet.top + ABOVE);
    let extra = left + width + APART;
    for (index, name) in names.iter().enumerate() {
        let (x, y) = (left + CELL * index as f64, top + ROW * index as f64);
        sheet.climbing(x + CELL / 2.0 + 4.0, top - 8.0, &short(&effect_words(name), 24), 60.0, TextAnchor::Start);
        sheet.words(
            left - 10.0,
            y + 16.5,
            &short(&effect_words(name), 26),
            SMALL,
            TextAnchor::End,
            palette::INK,
            false,
        );
        for other in 0..names.len() {
            let place = (left + CELL * other as f64, y);
            if index == other {
                sheet.area(place.0 + 1.0, place.1 + 1.0, CELL - 2.0, ROW - 2.0, palette::GRID);
            } else {
                let share = separability.imitated.get(index).and_then(|row| row.get(other));
                cell(&mut sheet, place, share.copied());
            }
        }
        cell(&mut sheet, (extra, y), separability.by_recalibration.get(index).copied());
    }
    sheet.climbing(extra + CELL / 2.0 + 4.0, top - 8.0, "recalibration", 60.0, TextAnchor::Start);
    sheet.words(left - 10.0, top - 8.0, "this effect ↓   imitated by →", SMALL, TextAnchor::End, palette::FAINT, false);
    sheet.series = names.len() * (names.len() - 1) + names.len();
    Some(sheet.finish(explanation(separability)))
}

/// Draws a percentage on a background that is the darker the larger it is: lightness alone shows the number.
fn cell(sheet: &mut Sheet, (x, y): (f64, f64), share: Option<f64>) {
    let share = share.filter(|share| share.is_finite()).map(|share| share.clamp(0.0, 1.0));
    let opacity = share.map_or(0.0, |share| 0.045 + 0.955 * share);
    sheet.shade(x + 1.0, y + 1.0, CELL - 2.0, ROW - 2.0, colours::CELL, opacity);
    let words = share.map_or(UNKNOWN.to_string(), |share| format!("{:.0}", 100.0 * share));
    let colour = if share.is_some_and(|share| share > 0.55) { "#ffffff" } else { palette::INK };
    let strong = share.is_some_and(|share| share >= 0.9);
    sheet.words(x + CELL / 2.0, y + 16.0, &words, 12, TextAnchor::Middle, colour, strong);
}

fn explanation(separability: &Separability) -> String {
    let more = match separability.effects.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(" {more} further effects are not drawn."),
    };
    format!(
        "Percent of the mean square of the effect in the row that the effect in the column, together with \
         recalibration, can take over, when every effect moves the outputs by {}. Strong: these data cannot tell the \
         two apart, however small the noise. The last column is recalibration alone: what it takes over will be found \
         as a wrong calibration, not as an effect.{more}\n\
         Had the actuators moved at one speed only, a delay and play would look alike, and both be strong; with \
         more varied trials the matrix pales.",
        acm_core::display::shown(separability.size, &separability.unit)
    )
}
