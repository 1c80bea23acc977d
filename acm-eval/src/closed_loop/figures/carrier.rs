//! Dots and loops: residual against the signal that carries an effect, before and after.
//!
//! The heavy lines are means over twelfths of the axis, apart for samples at which the signal rises and falls: an
//! effect with memory moves them apart, and a mean over both would hide it.

use acm_core::display::{Display, labelled};
use acm_trace::finding::{CarrierFigure, Finding};

use super::{
    axes::{Axes, BELOW, LEFT, Stroke},
    colours::{AFTER, AFTER_PALE, NOMINAL, NOMINAL_PALE},
    scale::Scale,
    sheet::{Mark, Sheet},
};
use crate::closed_loop::words::{capitalized, effect_words};
use crate::figures::Drawing;
use crate::figures::canvas::palette;
use crate::figures::plotted::Series;
use crate::figures::short::short;

/// Caption title.
pub const QUESTION: &str = "Does what the model misses follow the signal, and does the effect take it away?";

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 300.0;
/// Largest number of dots in a panel.
const DOTS: usize = 2000;
/// Number of parts of the axis over which means are taken.
const BINS: usize = 12;
/// A mean of fewer samples is not drawn.
const FEWEST: usize = 3;

/// Draws one figure for each effect: a panel before, a panel after, on the same axes.
pub fn draw(finding: &Finding) -> Vec<Drawing> {
    finding.figures.carriers.iter().filter_map(|carrier| one(finding, carrier)).collect()
}

/// Sample: the signal in the axis' unit, the error, and whether the signal rises here.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    x: f64,
    y: f64,
    rises: bool,
    continues: bool,
}

fn one(finding: &Finding, carrier: &CarrierFigure) -> Option<Drawing> {
    let axis = Display::for_axis(&carrier.unit);
    let factor = axis.factor;
    let panels = [points(carrier, &carrier.before, factor), points(carrier, &carrier.after, factor)];
    if panels.iter().all(Vec::is_empty) {
        return None;
    }
    let both = || panels.iter().flatten();
    let scales = (Scale::holding(both().map(|p| p.x), 6), Scale::holding(both().map(|p| p.y), 6));
    let mut legend = vec![("before: nominal model", NOMINAL, Mark::Dot), ("after", AFTER, Mark::Dot)];
    match panels.iter().any(|points| branches(points).len() > 1) {
        true => legend.extend([
            ("mean, signal rising", palette::INK, Mark::Line(None)),
            ("mean, signal falling", palette::INK, Mark::Line(Some("5 3"))),
        ]),
        false => legend.push(("mean", palette::INK, Mark::Line(None))),
    }
    let mut sheet = Sheet::new(WIDTH, 34.0 + HEIGHT + BELOW, &legend, &finding.data);
    let width = (WIDTH - 2.0 * LEFT - 20.0) / 2.0;
    let signal = short(&carrier.signal, 36);
    let x_label = axis.label(&signal);
    let y_label = labelled(&format!("missed in {}", short(&carrier.output, 16)), &finding.errors.unit);
    let looks = [("before", NOMINAL, NOMINAL_PALE), ("after", AFTER, AFTER_PALE)];
    for (index, (points, look)) in panels.iter().zip(looks).enumerate() {
        let left = LEFT + index as f64 * (width + LEFT);
        let axes = Axes { left, top: sheet.top + 30.0, width, height: HEIGHT, x: scales.0, y: scales.1 };
        axes.draw(&mut sheet, look.0, &x_label, &y_label);
        let dots = Series::dots(legend[index].0, look.1, points.iter().map(|p| (p.x, p.y)).collect());
        sheet.plotted.push(axes.plotted(look.0, &x_label, &y_label, vec![dots]));
        panel(&mut sheet, &axes, points, look);
    }
    Some(sheet.finish(explanation(finding, carrier)))
}

fn panel(sheet: &mut Sheet, axes: &Axes, points: &[Point], (_, colour, pale): (&str, &str, &str)) {
    for piece in points.chunk_by(|_, next| next.continues) {
        let stroke = Stroke { colour: pale, width: 0.8, dashes: None };
        axes.curve(sheet, piece.iter().map(|p| (p.x, p.y)), stroke);
    }
    let every = points.len().div_ceil(DOTS).max(1);
    axes.dots(sheet, points.iter().step_by(every).map(|p| (p.x, p.y)), 2.0, colour, 0.45);
    axes.level(sheet, 0.0, palette::INK, 1.0);
    let branches = branches(points);
    for (branch, dashes) in branches.iter().zip([None, Some("5 3")]) {
        axes.curve(sheet, means(branch, &axes.x), Stroke { colour: palette::INK, width: 2.4, dashes });
    }
    sheet.series += 1 + branches.len();
}

/// Returns the samples that are numbers; a signal that stands still keeps its direction, rising or falling.
fn points(carrier: &CarrierFigure, missed: &[f64], factor: f64) -> Vec<Point> {
    let mut found: Vec<Point> = Vec::with_capacity(missed.len());
    let mut broken = true;
    for (k, (&x, &y)) in carrier.x.iter().zip(missed).enumerate() {
        let continues = carrier.continues.get(k).copied().unwrap_or(false) && !broken;
        broken = !(x * factor).is_finite() || !y.is_finite();
        if broken {
            continue;
        }
        let x = x * factor;
        let rises = match found.last() {
            Some(last) if continues && x != last.x => x > last.x,
            Some(last) if continues => last.rises,
            _ => true,
        };
        found.push(Point { x, y, rises, continues });
    }
    found
}

/// Separates rising and falling samples, where there are enough of both; else returns all.
fn branches(points: &[Point]) -> Vec<Vec<Point>> {
    let (rising, falling): (Vec<Point>, Vec<Point>) = points.iter().copied().partition(|p| p.rises);
    let enough = |branch: &[Point]| branch.len() * 10 > points.len();
    if enough(&rising) && enough(&falling) { vec![rising, falling] } else { vec![points.to_vec()] }
}

/// Returns the mean place of the samples in each part of the axis.
fn means(branch: &[Point], x: &Scale) -> Vec<(f64, f64)> {
    let mut sums = [(0usize, 0.0, 0.0); BINS];
    for point in branch {
        let Some(share) = x.share(point.x) else { continue };
        let bin = ((share * BINS as f64) as usize).min(BINS - 1);
        let (count, x, y) = &mut sums[bin];
        (*count, *x, *y) = (*count + 1, *x + point.x, *y + point.y);
    }
    let full = sums.iter().filter(|(count, ..)| *count >= FEWEST);
    full.map(|&(count, x, y)| (x / count as f64, y / count as f64)).collect()
}

fn explanation(finding: &Finding, carrier: &CarrierFigure) -> String {
    let (signal, output) = (short(&carrier.signal, 40), short(&carrier.output, 40));
    let dots = format!(
        "Each dot is one sample of a held-out trial: measured minus modelled {output} against {signal}. Thin lines \
         join samples in order of time, heavy lines are means."
    );
    let loops = match carrier.signal.as_str() {
        "time" => "",
        _ => " Two heavy lines that stand apart are a loop: what is missed depends on where the signal came from.",
    };
    match finding.effects.iter().find(|effect| effect.name == carrier.effect) {
        Some(effect) => format!(
            "{dots}{loops}\n\
             {} is gone from the right panel: a level band around zero should be left. Were the effect wrong, a slope, \
             a bend or a loop would stay there; were it too large, the left picture would come back upside down.",
            short(&capitalized(&effect_words(&effect.name)), 60)
        ),
        None => format!(
            "{dots}{loops}\n\
             No effect was found that follows this signal; it is shown for comparison. Were there one, a slope, a bend \
             or a loop would show on the left and be gone on the right."
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn carrier(x: Vec<f64>, continues: Vec<bool>) -> CarrierFigure {
        let (before, after) = (x.clone(), x.clone());
        let words = || String::from("q1");
        let unit = String::from("rad");
        CarrierFigure { effect: words(), signal: words(), unit, output: words(), x, before, after, continues }
    }

    #[test]
    fn a_signal_rises_and_falls_and_a_gap_starts_anew() {
        let carrier =
            carrier(vec![0.0, 1.0, 1.0, 0.5, f64::NAN, 0.2, 0.1], vec![false, true, true, true, true, true, false]);
        let points = points(&carrier, &carrier.before, 1.0);
        let flags: Vec<(bool, bool)> = points.iter().map(|p| (p.rises, p.continues)).collect();
        assert_eq!(flags, [(true, false), (true, true), (true, true), (false, true), (true, false), (true, false)]);
    }

    /// Oracle: a square loop has the means of its two sides.
    #[test]
    fn a_loop_has_two_means_and_a_ramp_has_one() {
        let at =
            |k: usize, rises| Point { x: k as f64 / 100.0, y: if rises { 1.0 } else { -1.0 }, rises, continues: true };
        let square: Vec<Point> = (0..100).map(|k| at(k, true)).chain((0..100).rev().map(|k| at(k, false))).collect();
        let sides = branches(&square);
        let scale = Scale::exactly(0.0, 1.0, 5);
        assert_eq!(sides.len(), 2);
        assert!(means(&sides[0], &scale).iter().all(|mean| mean.1 == 1.0) && means(&sides[0], &scale).len() == BINS);
        assert!(means(&sides[1], &scale).iter().all(|mean| mean.1 == -1.0));
        assert_eq!(branches(&square[..100]).len(), 1);
    }
}
