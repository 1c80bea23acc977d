//! The numbers of a figure, for the script that reads them back ([`crate::page::answers`]) and for a file.
//!
//! ```text
//! plots and limits of a panel ─┐
//! where the panel was drawn ───┴─▶ PlottedPanel ─┬─▶ JSON beside the figure, thinned
//!                                                └─▶ CSV file, whole    (numbers.rs)
//! ```
//!
//! Only panels of lines and dots have them: a bar is a cell of a table.

pub mod numbers;
pub mod space;
mod thin;

use kuva::{
    plot::{LinePlot, LineStyle, scatter::ScatterPlot},
    render::{layout::Layout, plots::Plot, render::Primitive},
};
use serde::Serialize;

use super::canvas::legend::{Key, Mark};

/// Label of an axis that is time: cursors of such panels move together.
pub const TIME: &str = "time [s]";

/// Panel of a figure: its position, its axes and its series.
#[derive(Debug, Clone, PartialEq)]
pub struct PlottedPanel {
    /// Title above the panel.
    pub title: String,
    /// Trial whose time its horizontal axis is; empty where it is of none.
    pub trial: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether a unit is equally long on both axes.
    pub is_equal: bool,
    /// Left, top, width and height of the plot area, px of the figure.
    pub area: [f64; 4],
    /// Series that are drawn.
    pub series: Vec<Series>,
    /// Horizontal bands behind the series: from, to, colour.
    pub bands: Vec<(f64, f64, String)>,
}

/// Axis of a panel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Axis {
    /// Quantity and unit, `time [s]`.
    pub label: String,
    /// Value at its left or lower end.
    pub from: f64,
    /// Value at its right or upper end.
    pub to: f64,
}

/// One line, or the dots of one colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Meaning.
    pub name: String,
    /// Colour, `#rrggbb`.
    pub colour: String,
    /// Shape: `line`, `dashes` or `dot`.
    pub mark: &'static str,
    /// Stroke width, px.
    pub width: f64,
    /// Points in pieces; between two pieces the line is interrupted.
    pub pieces: Vec<Vec<(f64, f64)>>,
}

impl Series {
    /// Returns a line through all points whose values are numbers, interrupted at the others.
    pub fn line(name: &str, colour: &str, dashed: bool, points: &[(f64, f64)]) -> Self {
        let is_number = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
        let pieces = points.chunk_by(|a, b| is_number(a) == is_number(b)).filter(|piece| is_number(&piece[0]));
        let mark = if dashed { "dashes" } else { "line" };
        let pieces = pieces.map(<[_]>::to_vec).collect();
        Self { name: name.into(), colour: colour.into(), mark, width: 1.6, pieces }
    }

    /// Creates a series of dots.
    pub fn dots(name: &str, colour: &str, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), colour: colour.into(), mark: "dot", width: 0.0, pieces: vec![points] }
    }

    /// Returns the number of points.
    pub fn points(&self) -> usize {
        self.pieces.iter().map(Vec::len).sum()
    }
}

/// Returns a panel from the plots that the plotting library draws, its area not yet known; nothing where it holds
/// anything but lines and dots on linear axes.
pub fn panel(plots: &[Plot], layout: &Layout, legend: &[Key]) -> Option<PlottedPanel> {
    let series = plots.iter().map(|plot| of_plot(plot, legend)).collect::<Option<Vec<Series>>>()?;
    if layout.x_categories.is_some() || layout.y_categories.is_some() || layout.log_x || layout.log_y {
        return None;
    }
    let words = |words: &Option<String>| words.clone().unwrap_or_default();
    Some(PlottedPanel {
        title: words(&layout.title),
        trial: String::new(),
        x: Axis { label: words(&layout.x_label), from: layout.x_axis_min?, to: layout.x_axis_max? },
        y: Axis { label: words(&layout.y_label), from: layout.y_axis_min?, to: layout.y_axis_max? },
        is_equal: layout.equal_aspect,
        area: [0.0; 4],
        series: numbered(joined(series)),
        bands: vec![],
    })
}

/// Returns the panels with their areas.
pub fn placed(panels: Vec<Option<PlottedPanel>>, areas: &[[f64; 4]]) -> Vec<PlottedPanel> {
    if areas.len() != panels.len() {
        return vec![];
    }
    panels.into_iter().zip(areas).filter_map(|(panel, area)| Some(at(panel?, *area))).collect()
}

fn at(mut panel: PlottedPanel, area: [f64; 4]) -> PlottedPanel {
    if panel.is_equal {
        let limits = [panel.x.from, panel.x.to, panel.y.from, panel.y.to];
        [panel.x.from, panel.x.to, panel.y.from, panel.y.to] = alike(limits, area);
    }
    PlottedPanel { area, ..panel }
}

/// Returns the limits with those of one axis moved apart, so that a unit is equally long on both axes.
fn alike([low, high, bottom, top]: [f64; 4], [_, _, width, height]: [f64; 4]) -> [f64; 4] {
    let scale = (width / (high - low)).min(height / (top - bottom));
    let around = |a: f64, b: f64, length: f64| {
        let (middle, half) = ((a + b) / 2.0, length / (2.0 * scale));
        (middle - half, middle + half)
    };
    let ((low, high), (bottom, top)) = (around(low, high, width), around(bottom, top, height));
    [low, high, bottom, top]
}

fn of_plot(plot: &Plot, legend: &[Key]) -> Option<Series> {
    match plot {
        Plot::Line(line) => Some(of_line(line, legend)),
        Plot::Scatter(dots) => Some(of_dots(dots, legend)),
        _ => None,
    }
}

fn of_line(line: &LinePlot, legend: &[Key]) -> Series {
    let dashed = !matches!(line.line_style, LineStyle::Solid);
    let (mark, name) = if dashed { ("dashes", Mark::Dashes) } else { ("line", Mark::Line) };
    let points = line.data.iter().map(|point| (point.x, point.y)).collect();
    let (name, colour) = (named(legend, &line.color, name), line.color.clone());
    Series { name, colour, mark, width: line.stroke_width, pieces: vec![points] }
}

fn of_dots(dots: &ScatterPlot, legend: &[Key]) -> Series {
    let points = dots.data.iter().map(|point| (point.x, point.y)).collect();
    Series::dots(&named(legend, &dots.color, Mark::Dot), &dots.color, points)
}

/// Returns the legend text of a colour and a shape; of the shape alone where colours have another meaning.
fn named(legend: &[Key], colour: &str, mark: Mark) -> String {
    let shaped = |key: &&Key| key.mark == mark;
    let same = legend.iter().find(|key| key.colour == colour && key.mark == mark);
    let same = same.or_else(|| legend.iter().find(shaped)).or_else(|| legend.iter().find(|key| key.colour == colour));
    same.map_or(String::new(), |key| key.label.clone())
}

/// Joins consecutive pieces of one style to one line with gaps.
fn joined(series: Vec<Series>) -> Vec<Series> {
    let mut all: Vec<Series> = vec![];
    for next in series {
        let ends = |before: &Series| before.pieces.last().and_then(|piece| piece.last()).map(|point| point.0);
        let begins = next.pieces.first().and_then(|piece| piece.first()).map(|point| point.0);
        let follows = |before: &&mut Series| {
            let same = (&before.name, &before.colour, before.mark) == (&next.name, &next.colour, next.mark);
            same && next.mark != "dot" && ends(before).zip(begins).is_some_and(|(end, begin)| end < begin)
        };
        match all.iter_mut().find(follows) {
            Some(before) => before.pieces.extend(next.pieces),
            None => all.push(next),
        }
    }
    all
}

/// Numbers the series of one name.
fn numbered(mut series: Vec<Series>) -> Vec<Series> {
    let names: Vec<String> = series.iter().map(|one| one.name.clone()).collect();
    for (index, one) in series.iter_mut().enumerate() {
        let same = |upto: usize| names[..upto].iter().filter(|name| **name == one.name).count();
        if same(names.len()) > 1 {
            one.name = format!("{} {}", one.name, same(index) + 1);
        }
    }
    series
}

/// Returns the plot areas in the order of the panels: the clipped regions of a scene, px.
pub fn areas(elements: &[Primitive]) -> Vec<[f64; 4]> {
    let mut moved = vec![(0.0, 0.0)];
    let mut found = vec![];
    for element in elements {
        let (x, y) = moved.last().copied().unwrap_or_default();
        match element {
            Primitive::GroupStart { transform, .. } => {
                let (dx, dy) = transform.as_deref().and_then(translation).unwrap_or_default();
                moved.push((x + dx, y + dy));
            }
            Primitive::GroupEnd => {
                moved.pop();
            }
            Primitive::ClipStart { x: left, y: top, width, height, .. } => {
                found.push([x + left, y + top, *width, *height]);
            }
            _ => {}
        }
    }
    found
}

/// Parses `translate(6,6)`.
fn translation(transform: &str) -> Option<(f64, f64)> {
    let (x, y) = transform.strip_prefix("translate(")?.strip_suffix(')')?.split_once(',')?;
    Some((x.trim().parse().ok()?, y.trim().parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(colour: &str, points: &[(f64, f64)]) -> Plot {
        Plot::Line(LinePlot::new().with_data(points.to_vec()).with_color(colour))
    }

    fn key(label: &str, colour: &str) -> Key {
        Key { label: label.into(), colour: colour.into(), mark: Mark::Line }
    }

    #[test]
    fn pieces_that_follow_are_one_series_and_others_are_numbered() {
        let layout = Layout::new((0.0, 9.0), (0.0, 1.0))
            .with_x_axis_min(0.0)
            .with_x_axis_max(9.0)
            .with_y_axis_min(0.0)
            .with_y_axis_max(1.0)
            .with_x_label(TIME);
        let plots = vec![
            line("#111111", &[(0.0, 0.5), (1.0, 0.5)]),
            line("#222222", &[(0.0, 0.1), (1.0, 0.2)]),
            line("#111111", &[(5.0, 0.5), (6.0, 0.5)]),
            line("#111111", &[(2.0, 0.9), (3.0, 0.9)]),
        ];
        let found = panel(&plots, &layout, &[key("a", "#111111"), key("b", "#222222")]).unwrap();
        let names: Vec<(&str, usize)> = found.series.iter().map(|s| (s.name.as_str(), s.pieces.len())).collect();
        assert_eq!(names, [("a 1", 2), ("b", 1), ("a 2", 1)]);
    }

    /// Oracle: by hand. On 100 × 50 px, ten by ten units take 5 px a unit, so 20 units lie from left to right.
    #[test]
    fn limits_are_moved_apart_where_units_are_equally_long() {
        assert_eq!(alike([0.0, 10.0, 0.0, 10.0], [0.0, 0.0, 100.0, 50.0]), [-5.0, 15.0, 0.0, 10.0]);
    }

    #[test]
    fn areas_are_found_where_groups_moved_them() {
        let group = |transform: &str| Primitive::GroupStart {
            transform: Some(transform.into()),
            title: None,
            extra_attrs: None,
        };
        let clip = Primitive::ClipStart { x: 1.0, y: 2.0, width: 3.0, height: 4.0, id: String::new() };
        let scene =
            [group("translate(6,7)"), clip.clone(), Primitive::ClipEnd, Primitive::GroupEnd, group("none"), clip];
        assert_eq!(areas(&scene), [[7.0, 9.0, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]]);
    }
}
