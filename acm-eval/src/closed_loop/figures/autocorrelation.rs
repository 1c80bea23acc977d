//! Lines: autocorrelation of the residual, before and after, with the band of white noise.

use acm_trace::finding::Finding;

use super::{
    axes::{Axes, BELOW, LEFT, Stroke},
    colours::{AFTER, NOISE_PALE, NOMINAL},
    scale::Scale,
    sheet::{Mark, Sheet},
};
use crate::figures::Drawing;
use crate::figures::canvas::palette;
use crate::figures::plotted::{PlottedPanel, Series};

/// Caption title.
pub const QUESTION: &str = "Is what is left noise?";

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 270.0;

/// Draws one panel.
pub fn draw(finding: &Finding) -> Vec<Drawing> {
    let correlation = &finding.left.autocorrelation;
    let curves = [(&correlation.before, NOMINAL, None), (&correlation.after, AFTER, Some("7 3"))];
    if correlation.lag.len() < 2 || curves.iter().all(|(values, ..)| values.len() < 2) {
        return vec![];
    }
    let legend = [
        ("before: nominal model", NOMINAL, Mark::Line(None)),
        ("after: what is left", AFTER, Mark::Line(Some("7 3"))),
        ("white noise, 95 % of lags", NOISE_PALE, Mark::Area),
    ];
    let mut sheet = Sheet::new(WIDTH, 16.0 + HEIGHT + BELOW, &legend, &finding.data);
    let numbers = curves.iter().flat_map(|(values, ..)| values.iter().copied()).filter(|value| value.abs() <= 1.0);
    let lowest = numbers.fold(-correlation.white.abs().min(1.0), f64::min).min(-0.1);
    let x = Scale::from_zero(correlation.lag.iter().copied(), 10);
    let axes = Axes {
        left: LEFT,
        top: sheet.top + 12.0,
        width: WIDTH - LEFT - 24.0,
        height: HEIGHT,
        x,
        y: Scale::exactly(1.1 * lowest, 1.05, 6),
    };
    let white = correlation.white.abs().min(1.0);
    if let (Some(high), Some(low)) = (axes.at(0.0, white), axes.at(0.0, -white)) {
        sheet.area(axes.left, high.1, axes.width, low.1 - high.1, NOISE_PALE);
    }
    axes.draw(&mut sheet, "", "lag [s]", "autocorrelation");
    axes.level(&mut sheet, 0.0, palette::INK, 1.0);
    let mut plotted = vec![];
    for ((values, colour, dashes), (name, ..)) in curves.into_iter().zip(legend) {
        let points = correlation.lag.iter().copied().zip(values.iter().map(|value| value.clamp(-1.0, 1.0)));
        let points: Vec<(f64, f64)> = points.collect();
        plotted.push(Series::line(name, colour, dashes.is_some(), &points));
        axes.curve(&mut sheet, points, Stroke { colour, width: 1.9, dashes });
        sheet.series += 1;
    }
    let panel = axes.plotted("", "lag [s]", "autocorrelation", plotted);
    sheet.plotted.push(PlottedPanel { bands: vec![(-white, white, NOISE_PALE.into())], ..panel });
    vec![sheet.finish(EXPLANATION)]
}

const EXPLANATION: &str = "How alike what is missed at one moment and a lag later are: 1 means the same, 0 means that \
    the one says nothing about the other. Mean over outputs and trials.\n\
    Where nothing but white noise is left, the dashed line stays in the grey band from the first lag on. A long tail \
    would mean that something slow is left, waves something periodic, and a line like that before an effect that \
    explains nothing.";
