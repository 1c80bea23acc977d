//! Legend of a figure: keys from left to right, in as many rows as needed.

use kuva::{
    plot::LineStyle,
    render::{
        color::Color,
        render::{Primitive, Scene, TextAnchor},
    },
};

use super::{
    lettering::{TEXT, text},
    palette,
};

/// One entry of a legend.
pub struct Key {
    /// Meaning.
    pub label: String,
    /// Colour, `#rrggbb`.
    pub colour: String,
    /// Shape.
    pub mark: Mark,
}

/// The shape of a legend entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A filled bar.
    Bar,
    /// A solid line.
    Line,
    /// A dashed line.
    Dashes,
    /// A dot.
    Dot,
}

/// Returns a style whose dashes stay separate where line ends are round.
pub fn dashes() -> LineStyle {
    LineStyle::Custom("5 6".into())
}

/// Height of a row of the legend, px.
pub const ROW: f64 = 22.0;

/// Arranges entries from left to right, in as many rows as the width requires.
pub fn legend_rows(legend: &[Key], width: f64) -> Vec<Vec<(f64, &Key)>> {
    let mut rows: Vec<Vec<(f64, &Key)>> = Vec::new();
    let mut x = f64::INFINITY;
    for key in legend {
        let needed = 44.0 + 0.62 * f64::from(TEXT) * key.label.chars().count() as f64;
        if x + needed > width {
            rows.push(vec![]);
            x = 16.0;
        }
        rows.last_mut().expect("a row was opened").push((x, key));
        x += needed;
    }
    rows
}

/// Draws one key, its left end at `x`, its middle at height `y`.
pub fn draw_key(scene: &mut Scene, x: f64, y: f64, key: &Key) {
    let fill = Color::from(key.colour.as_str());
    let line = |dash: Option<&str>| Primitive::Line {
        x1: x,
        y1: y,
        x2: x + 24.0,
        y2: y,
        stroke: fill.clone(),
        stroke_width: 2.5,
        stroke_dasharray: dash.map(String::from),
    };
    scene.add(match key.mark {
        Mark::Line => line(None),
        Mark::Dashes => line(Some("4 6")),
        Mark::Bar => Primitive::Rect {
            x: x + 4.0,
            y: y - 7.0,
            width: 16.0,
            height: 14.0,
            fill,
            stroke: None,
            stroke_width: None,
            opacity: None,
        },
        Mark::Dot => Primitive::Circle {
            cx: x + 12.0,
            cy: y,
            r: 5.0,
            fill,
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        },
    });
    scene.add(text(x + 30.0, y + 5.0, key.label.clone(), TEXT, TextAnchor::Start, palette::INK, false));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_legend_takes_another_row() {
        let key = || Key { label: "a network of some name".into(), colour: "#000000".into(), mark: Mark::Line };
        let keys: Vec<Key> = (0..5).map(|_| key()).collect();
        let rows = legend_rows(&keys, 600.0);
        assert_eq!(rows.iter().map(Vec::len).sum::<usize>(), 5);
        assert_eq!(rows.len(), 3);
    }
}
