//! The paper of a figure: white, the meaning of colours above, the name of the data below.

use acm_trace::finding::Data;
use kuva::render::{
    color::Color,
    render::{Primitive, Scene, TextAnchor},
};

use crate::figures::Drawing;
use crate::figures::canvas::palette;
use crate::figures::plotted::PlottedPanel;
use crate::figures::short::short;

/// Size of ticks and small words, px of a figure that is 900 px wide.
pub const SMALL: u32 = 13;
/// Size of labels and legends.
pub const TEXT: u32 = 14;
/// Height of a row of the legend, px.
const ROW: f64 = 22.0;

/// Shape of a legend entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line, with dashes of this pattern where there is one.
    Line(Option<&'static str>),
    /// A dot.
    Dot,
    /// A filled area.
    Area,
}

/// One entry of the legend: meaning, colour, shape.
pub type Key<'a> = (&'a str, &'a str, Mark);

/// A figure that is being drawn.
pub struct Sheet {
    /// Elements that are drawn so far.
    pub scene: Scene,
    /// Upper end of the body, below the legend, px.
    pub top: f64,
    /// Number of drawn series.
    pub series: usize,
    /// The numbers of its panels.
    pub plotted: Vec<PlottedPanel>,
}

impl Sheet {
    /// Creates a sheet of this width with room for a body of this height.
    pub fn new(width: f64, height: f64, legend: &[Key], data: &Data) -> Self {
        Self::of(width, height, legend, &data.name, data.synthetic)
    }

    /// Creates a sheet for data of this name.
    pub fn of(width: f64, height: f64, legend: &[Key], name: &str, synthetic: bool) -> Self {
        let rows = rows(legend, width);
        let top = if rows.is_empty() { 6.0 } else { ROW * rows.len() as f64 + 8.0 };
        let mut scene = Scene::new(width, top + height + 26.0);
        scene.text_color = Some(palette::INK.into());
        let mut sheet = Self { scene, top, series: 0, plotted: vec![] };
        for (row, keys) in rows.iter().enumerate() {
            keys.iter().for_each(|(x, key)| sheet.key(*x, 8.0 + ROW * (row as f64 + 0.5), key));
        }
        let (words, colour) = match synthetic {
            true => (format!("{} — SYNTHETIC DATA, made by a simulator", short(name, 60)), palette::WARNING),
            false => (short(name, 100), palette::FAINT),
        };
        let y = sheet.scene.height - 8.0;
        sheet.words(16.0, y, &words, SMALL, TextAnchor::Start, colour, synthetic);
        sheet
    }

    /// Returns the finished figure. Lines of the explanation become paragraphs.
    pub fn finish(self, explanation: impl Into<String>) -> Drawing {
        let Self { scene, series, plotted, .. } = self;
        Drawing { scene, explanation: explanation.into(), series, plotted, space: None }
    }

    /// Draws words at a position.
    #[allow(clippy::too_many_arguments)] // a place, what, and how
    pub fn words(&mut self, x: f64, y: f64, words: &str, size: u32, anchor: TextAnchor, colour: &str, bold: bool) {
        let content = literal(words);
        self.scene.add(Primitive::Text { x, y, content, size, anchor, rotate: None, bold, color: Some(colour.into()) });
    }

    /// Draws words that climb at this angle, degrees.
    pub fn climbing(&mut self, x: f64, y: f64, words: &str, angle: f64, anchor: TextAnchor) {
        let (content, color) = (literal(words), Some(palette::INK.into()));
        let rotate = Some(-angle);
        self.scene.add(Primitive::Text { x, y, content, size: TEXT, anchor, rotate, bold: false, color });
    }

    /// Draws a straight line.
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64, dashes: Option<&str>) {
        self.scene.add(Primitive::Line {
            x1: from.0,
            y1: from.1,
            x2: to.0,
            y2: to.1,
            stroke: colour.into(),
            stroke_width: width,
            stroke_dasharray: dashes.map(String::from),
        });
    }

    /// Draws a filled box.
    pub fn area(&mut self, x: f64, y: f64, width: f64, height: f64, fill: impl Into<Color>) {
        let (fill, opacity) = (fill.into(), None);
        self.scene.add(Primitive::Rect { x, y, width, height, fill, stroke: None, stroke_width: None, opacity });
    }

    /// Draws a translucent box.
    pub fn shade(&mut self, x: f64, y: f64, width: f64, height: f64, fill: &str, opacity: f64) {
        let (fill, opacity) = (Color::from(fill), Some(opacity));
        self.scene.add(Primitive::Rect { x, y, width, height, fill, stroke: None, stroke_width: None, opacity });
    }

    /// Draws a dot.
    pub fn dot(&mut self, (cx, cy): (f64, f64), r: f64, colour: &str) {
        let fill = colour.into();
        self.scene.add(Primitive::Circle { cx, cy, r, fill, fill_opacity: None, stroke: None, stroke_width: None });
    }

    fn key(&mut self, x: f64, y: f64, (label, colour, mark): &Key) {
        match mark {
            Mark::Line(dashes) => self.line((x, y), (x + 24.0, y), colour, 2.5, *dashes),
            Mark::Dot => self.dot((x + 12.0, y), 5.0, colour),
            Mark::Area => self.area(x + 2.0, y - 7.0, 20.0, 14.0, *colour),
        }
        self.words(x + 30.0, y + 5.0, label, TEXT, TextAnchor::Start, palette::INK, false);
    }
}

/// Returns the keys from left to right, in as many rows as it takes.
fn rows<'a, 'b>(legend: &'b [Key<'a>], width: f64) -> Vec<Vec<(f64, &'b Key<'a>)>> {
    let mut rows: Vec<Vec<(f64, &Key)>> = Vec::new();
    let mut x = f64::INFINITY;
    for key in legend {
        let needed = 46.0 + 0.58 * f64::from(TEXT) * key.0.chars().count() as f64;
        if x + needed > width {
            rows.push(vec![]);
            x = 16.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push((x, key));
        }
        x += needed;
    }
    rows
}

/// Escapes dollar signs. The plotting library reads the text between two of them as mathematics.
fn literal(words: &str) -> String {
    words.replace('$', "\\$")
}
