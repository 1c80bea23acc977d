//! The numbers of a figure as text: thinned as JSON for the page, whole as CSV for a file.

use serde::Serialize;

use super::thin::thinned;
use super::{Axis, PlottedPanel, Series, TIME};
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

/// Returns the panels as JSON for a page, at most 2000 points a series; `null` is a gap.
pub fn json(panels: &[PlottedPanel]) -> String {
    let series: usize = panels.iter().map(|panel| panel.series.len()).sum();
    let most = POINTS.min(FIGURE / series.max(1)).max(100);
    let panels: Vec<PanelJson> = panels.iter().map(|panel| panel_json(panel, most)).collect();
    let text = serde_json::json!({ "panels": panels }).to_string();
    embedded(&text)
}

/// Escapes a text so that it cannot end a script, whatever names the data have.
pub fn embedded(json: &str) -> String {
    json.replace('<', "\\u003c")
}

fn panel_json(panel: &PlottedPanel, most: usize) -> PanelJson<'_> {
    let time = panel.x.label == TIME;
    let together = is_common(&panel.series).then(|| chosen(&panel.series, most));
    let series = panel.series.iter().map(|series| match &together {
        Some(kept) => series_json(series, kept),
        None => series_json(series, &chosen(std::slice::from_ref(series), most)),
    });
    PanelJson {
        title: &panel.title,
        trial: &panel.trial,
        time,
        dotted: !time && panel.series.iter().any(|series| series.mark == "dot" && series.points() > 1),
        x: &panel.x,
        y: &panel.y,
        area: panel.area.map(|px| (px * 100.0).round() / 100.0),
        series: series.collect(),
        bands: &panel.bands,
    }
}

/// Returns whether all are lines over the same abscissae, in the same pieces.
fn is_common(series: &[Series]) -> bool {
    let Some(first) = series.first() else { return false };
    let alike =
        |a: &Vec<(f64, f64)>, b: &Vec<(f64, f64)>| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.0 == b.0);
    series.iter().all(|other| {
        let mut pieces = first.pieces.iter().zip(&other.pieces);
        other.mark != "dot" && first.pieces.len() == other.pieces.len() && pieces.all(|(a, b)| alike(a, b))
    })
}

/// Returns the indices to keep in each piece of `series`, which have the same abscissae: lines keep their outline; of
/// dots, which have no order, every k-th stays.
fn chosen(series: &[Series], most: usize) -> Vec<Vec<usize>> {
    let first = &series[0];
    let total = first.points().max(1);
    let of_piece = |index: usize, length: usize| {
        let share = (most * length).div_ceil(total.max(most));
        let pieces: Vec<&[(f64, f64)]> = series.iter().map(|series| series.pieces[index].as_slice()).collect();
        match first.mark {
            "dot" => (0..length).step_by(length.div_ceil(share.max(1)).max(1)).collect(),
            _ => thinned(&pieces, share),
        }
    };
    first.pieces.iter().enumerate().map(|(index, piece)| of_piece(index, piece.len())).collect()
}

fn series_json<'a>(series: &'a Series, kept: &[Vec<usize>]) -> SeriesJson<'a> {
    let (mut x, mut y) = (vec![], vec![]);
    for (index, (piece, kept)) in series.pieces.iter().zip(kept).enumerate() {
        if index > 0 {
            x.push(None);
            y.push(None);
        }
        x.extend(kept.iter().map(|place| Some(digits(piece[*place].0))));
        y.extend(kept.iter().map(|place| Some(digits(piece[*place].1))));
    }
    SeriesJson { name: &series.name, colour: &series.colour, mark: series.mark, width: series.width, x, y }
}

/// Rounds to six significant digits; a reader is shown four.
pub(super) fn digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Writes every number: a line for each point, with its panel and its series.
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
    fn lines_over_the_same_time_keep_the_same_times() {
        let mut panel = panel(5000, "line");
        let shifted = panel.series[0].pieces[0].iter().map(|(x, y)| (*x, y * y)).collect();
        panel.series.push(Series { pieces: vec![shifted], ..panel.series[0].clone() });
        let read: serde_json::Value = serde_json::from_str(&json(&[panel])).unwrap();
        let of = |k: usize| &read["panels"][0]["series"][k];
        assert_eq!((of(0)["x"] == of(1)["x"], of(0)["x"].as_array().unwrap().len()), (true, 2000));
        assert_ne!(of(0)["y"], of(1)["y"]);
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
