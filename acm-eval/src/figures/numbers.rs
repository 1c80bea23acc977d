//! The numbers of a figure as text: thinned as JSON for the page, whole as CSV for a file.

use serde::Serialize;

use super::{
    plotted::{Axis, PlottedPanel, Series, TIME},
    thin::thinned,
};
use crate::tables::quoted;

/// Points of a series on the page, at most.
const POINTS: usize = 2000;
/// Points of a figure on the page, at most, so that a page of many trials stays small.
const FIGURE: usize = 24_000;

#[derive(Serialize)]
struct PanelJson<'a> {
    title: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    trial: &'a str,
    time: bool,
    dotted: bool,
    x: &'a Axis,
    y: &'a Axis,
    area: [f64; 4],
    series: Vec<SeriesJson<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    bands: &'a [(f64, f64, String)],
}

#[derive(Serialize)]
struct SeriesJson<'a> {
    name: &'a str,
    colour: &'a str,
    mark: &'static str,
    width: f64,
    x: Vec<Option<f64>>,
    y: Vec<Option<f64>>,
}

/// The panels as JSON that can stand in a page, at most 2000 points a series; `null` is a gap.
pub fn json(panels: &[PlottedPanel]) -> String {
    let series: usize = panels.iter().map(|panel| panel.series.len()).sum();
    let most = POINTS.min(FIGURE / series.max(1)).max(100);
    let panels: Vec<PanelJson> = panels.iter().map(|panel| panel_json(panel, most)).collect();
    let text = serde_json::json!({ "panels": panels }).to_string();
    embedded(&text)
}

/// Text that ends no script, whatever names the data have.
pub fn embedded(json: &str) -> String {
    json.replace('<', "\\u003c")
}

fn panel_json(panel: &PlottedPanel, most: usize) -> PanelJson<'_> {
    let time = panel.x.label == TIME;
    PanelJson {
        title: &panel.title,
        trial: &panel.trial,
        time,
        dotted: !time && panel.series.iter().any(|series| series.mark == "dot" && series.points() > 1),
        x: &panel.x,
        y: &panel.y,
        area: panel.area.map(|px| (px * 100.0).round() / 100.0),
        series: panel.series.iter().map(|series| series_json(series, most)).collect(),
        bands: &panel.bands,
    }
}

fn series_json(series: &Series, most: usize) -> SeriesJson<'_> {
    let (mut x, mut y) = (vec![], vec![]);
    let total = series.points().max(1);
    for (index, piece) in series.pieces.iter().enumerate() {
        if index > 0 {
            x.push(None);
            y.push(None);
        }
        let share = (most * piece.len()).div_ceil(total.max(most));
        for kept in chosen(series, piece, share) {
            x.push(Some(digits(piece[kept].0)));
            y.push(Some(digits(piece[kept].1)));
        }
    }
    SeriesJson { name: &series.name, colour: &series.colour, mark: series.mark, width: series.width, x, y }
}

/// Lines keep their outline; of dots, which have no order, every k-th stays.
fn chosen(series: &Series, piece: &[(f64, f64)], share: usize) -> Vec<usize> {
    match series.mark {
        "dot" => (0..piece.len()).step_by(piece.len().div_ceil(share.max(1)).max(1)).collect(),
        _ => thinned(piece, share),
    }
}

/// Six significant digits; a reader is shown four.
fn digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Every number: a line for each point, with its panel and its series.
pub fn csv(panels: &[PlottedPanel]) -> String {
    let mut lines = vec!["panel,series,x axis,x,y axis,y".to_string()];
    for panel in panels {
        for series in &panel.series {
            let head = [&panel.title, &series.name].map(|words| quoted(words)).join(",");
            let (x_axis, y_axis) = (quoted(&panel.x.label), quoted(&panel.y.label));
            let points = series.pieces.iter().flatten();
            lines.extend(points.map(|(x, y)| format!("{head},{x_axis},{x},{y_axis},{y}")));
        }
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(points: usize, mark: &'static str) -> PlottedPanel {
        let axis = |label: &str| Axis { label: label.into(), from: 0.0, to: 1.0 };
        let points = (0..points).map(|k| (k as f64, (0.1 * k as f64).sin())).collect();
        let series = Series { mark, ..Series::dots("</script>, a", "#000000", points) };
        let title = "Trial 1".to_string();
        let (trial, area, bands) = (String::new(), [0.0; 4], vec![]);
        let (x, y, series) = (axis(TIME), axis("error [mm]"), vec![series]);
        PlottedPanel { title, trial, x, y, is_equal: false, area, series, bands }
    }

    #[test]
    fn the_page_has_two_thousand_points_and_the_file_all() {
        for mark in ["line", "dot"] {
            let panel = panel(20_000, mark);
            let text = json(std::slice::from_ref(&panel));
            let read: serde_json::Value = serde_json::from_str(&text).unwrap();
            let there = read["panels"][0]["series"][0]["x"].as_array().unwrap().len();
            assert_eq!(there, 2000, "{mark}");
            assert!(!text.contains("</script"), "a name ends the script");
            assert_eq!(csv(&[panel]).lines().count(), 20_001);
        }
    }

    #[test]
    fn a_gap_is_null_and_a_file_is_quoted() {
        let mut panel = panel(2, "line");
        panel.series[0].pieces.push(vec![(5.0, 1.0 / 3.0)]);
        let read: serde_json::Value = serde_json::from_str(&json(std::slice::from_ref(&panel))).unwrap();
        assert_eq!(read["panels"][0]["series"][0]["x"].to_string(), "[0.0,1.0,null,5.0]");
        assert_eq!(read["panels"][0]["series"][0]["y"][3].to_string(), "0.333333");
        let file = csv(&[panel]);
        assert!(file.ends_with("Trial 1,\"</script>, a\",time [s],5,error [mm],0.3333333333333333\n"), "{file}");
    }
}
