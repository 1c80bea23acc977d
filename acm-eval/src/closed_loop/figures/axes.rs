//! Two axes with ticks, and curves in them.

use kuva::render::{
    color::Color,
    render::{Primitive, TextAnchor},
};

use super::{
    scale::Scale,
    sheet::{SMALL, Sheet, TEXT},
};
use crate::figures::canvas::palette;
use crate::figures::plotted::{Axis, PlottedPanel, Series};

/// Position of a panel on its sheet, and the meaning of its axes.
#[derive(Debug, Clone, Copy)]
pub struct Axes {
    /// Left end of the horizontal axis, px.
    pub left: f64,
    /// Upper end of the vertical axis, px.
    pub top: f64,
    /// Width, px.
    pub width: f64,
    /// Height, px.
    pub height: f64,
    /// Horizontal axis.
    pub x: Scale,
    /// Vertical axis.
    pub y: Scale,
}

/// Style of a curve.
#[derive(Debug, Clone, Copy)]
pub struct Stroke<'a> {
    /// Colour, `#rrggbb`.
    pub colour: &'a str,
    /// Width, px.
    pub width: f64,
    /// Dash pattern.
    pub dashes: Option<&'a str>,
}

/// Room for the labels of the vertical axis, px.
pub const LEFT: f64 = 70.0;
/// Room for the labels of the horizontal axis, px.
pub const BELOW: f64 = 50.0;

impl Axes {
    /// Returns the position of a point; none where it is no number or outside.
    pub fn at(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((self.across(x)?, self.up(y)?))
    }

    /// Returns the horizontal position of a value.
    pub fn across(&self, x: f64) -> Option<f64> {
        Some(self.left + self.width * self.x.share(x)?)
    }

    fn up(&self, y: f64) -> Option<f64> {
        Some(self.top + self.height * (1.0 - self.y.share(y)?))
    }

    /// Draws a horizontal line at `y` through the panel, where it lies inside.
    pub fn level(&self, sheet: &mut Sheet, y: f64, colour: &str, width: f64) {
        if let Some(y) = self.up(y) {
            sheet.line((self.left, y), (self.left + self.width, y), colour, width, None);
        }
    }

    /// Draws a dashed vertical line at `x` through the panel, where it lies inside.
    pub fn upright(&self, sheet: &mut Sheet, x: f64, colour: &str) {
        if let Some(x) = self.across(x) {
            sheet.line((x, self.top), (x, self.top + self.height), colour, 1.8, Some("6 4"));
        }
    }

    /// Draws grid, axes, ticks and labels; the panel's title above, where it has one.
    pub fn draw(&self, sheet: &mut Sheet, title: &str, x_label: &str, y_label: &str) {
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        for (tick, label) in self.y.ticks() {
            let Some(y) = self.up(tick) else { continue };
            sheet.line((self.left, y), (right, y), palette::GRID, 1.0, None);
            sheet.words(self.left - 8.0, y + 4.5, &label, SMALL, TextAnchor::End, palette::INK, false);
        }
        self.draw_across(sheet, x_label);
        sheet.line((self.left, self.top), (self.left, bottom), palette::INK, 1.2, None);
        sheet.climbing(self.left - 54.0, self.top + self.height / 2.0, y_label, 90.0, TextAnchor::Middle);
        let middle = self.left + self.width / 2.0;
        sheet.words(middle, self.top - 9.0, title, 15, TextAnchor::Middle, palette::INK, true);
    }

    /// Returns the panel's numbers, for the page to read back.
    pub fn plotted(&self, title: &str, x_label: &str, y_label: &str, series: Vec<Series>) -> PlottedPanel {
        let axis = |label: &str, scale: &Scale| Axis { label: label.into(), from: scale.low, to: scale.high };
        PlottedPanel {
            title: title.into(),
            trial: String::new(),
            x: axis(x_label, &self.x),
            y: axis(y_label, &self.y),
            is_equal: false,
            area: [self.left, self.top, self.width, self.height],
            series,
            bands: vec![],
        }
    }

    /// Draws the horizontal axis alone.
    pub fn draw_across(&self, sheet: &mut Sheet, label: &str) {
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        for (tick, label) in self.x.ticks() {
            let Some(x) = self.across(tick) else { continue };
            sheet.line((x, self.top), (x, bottom), palette::GRID, 1.0, None);
            sheet.words(x, bottom + 18.0, &label, SMALL, TextAnchor::Middle, palette::INK, false);
        }
        sheet.line((self.left, bottom), (right, bottom), palette::INK, 1.2, None);
        let middle = self.left + self.width / 2.0;
        sheet.words(middle, bottom + 40.0, label, TEXT, TextAnchor::Middle, palette::INK, false);
    }

    /// Draws a line through points, cut where one is no number.
    pub fn curve(&self, sheet: &mut Sheet, points: impl IntoIterator<Item = (f64, f64)>, stroke: Stroke) {
        let mut piece: Vec<(f64, f64)> = vec![];
        for point in points.into_iter().map(Some).chain([None]) {
            match point.and_then(|(x, y)| self.at(x, y)) {
                Some(place) => piece.push(place),
                None => flush(sheet, std::mem::take(&mut piece), stroke),
            }
        }
    }

    /// Draws dots.
    pub fn dots(
        &self,
        sheet: &mut Sheet,
        points: impl IntoIterator<Item = (f64, f64)>,
        r: f64,
        colour: &str,
        opacity: f64,
    ) {
        let places = points.into_iter().filter_map(|(x, y)| self.at(x, y));
        let (cx, cy): (Vec<f64>, Vec<f64>) = places.unzip();
        let (fill, fill_opacity) = (Color::from(colour), Some(opacity));
        sheet.scene.add(Primitive::CircleBatch { cx, cy, r, fill, fill_opacity, stroke: None, stroke_width: None });
    }
}

fn flush(sheet: &mut Sheet, points: Vec<(f64, f64)>, stroke: Stroke) {
    if points.len() > 1 {
        sheet.scene.add(Primitive::PolyLine {
            points,
            stroke: stroke.colour.into(),
            stroke_width: stroke.width,
            stroke_dasharray: stroke.dashes.map(String::from),
        });
    }
}
