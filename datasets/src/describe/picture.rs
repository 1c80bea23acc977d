//! Signals on the common clock, drawn: a panel a signal, a block a trial, as SVG.
//!
//! Each line goes from the least to the greatest value in every third of a pixel, so that nothing is averaged away, and ends at
//! gaps. Where an offset was estimated, a first panel lays the two columns that it was estimated from on top of each other, each
//! scaled to its own range: what is on the right clock moves together.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use acm_core::display::significant;

use crate::error::DataError;
use crate::files::{atomic, owned};
use crate::join::{Alignment, How, Line};
use crate::recordings::Recordings;

/// Trials that are drawn.
const TRIALS: usize = 6;

/// px: width of the picture, of the labels at its left and right, height of a panel and of a title.
const WIDTH: f64 = 1000.0;
const LEFT: f64 = 270.0;
const RIGHT: f64 = 90.0;
const PANEL: f64 = 64.0;
const TITLE: f64 = 34.0;

/// Points of a line, at most: three for each px.
const BINS: usize = 3 * 640;

/// A step over so many median steps is a gap.
const GAP: f64 = 5.0;

/// Text, secondary text, grid; then sources. Of figures elsewhere: Okabe and Ito (2008), darkened for white.
const INK: &str = "#222222";
const FAINT: &str = "#5c5c5c";
const GRID: &str = "#dddddd";
const SOURCES: [&str; 6] = ["#0072b2", "#bd8200", "#009e73", "#c46d9d", "#d55e00", "#3796cf"];

/// How the title of every picture begins.
const OWN: &str = "<title>Signals of ";

/// Several lines between two limits.
struct Panel<'a> {
    /// Beside the upper and the lower limit.
    limits: (String, String),
    lines: Vec<(&'a Line, &'static str, (f64, f64))>,
}

/// Writes the picture; how many trials it shows.
pub fn write(data: &Recordings, path: &Path) -> Result<usize, DataError> {
    owned::claim(path, |head| head.windows(OWN.len()).any(|part| part == OWN.as_bytes()))?;
    let (mut body, mut y, mut count) = (String::new(), 12.0, 0);
    for entry in data.entries.iter().take(TRIALS) {
        let lines = data.on_one_clock(&entry.name)?;
        let colours = colours(&lines);
        let own: Vec<&Alignment> = data.alignments.iter().filter(|a| a.trial == entry.name).collect();
        let panels = panels(&lines, &own, &colours);
        let span = span(&lines, &own);
        let title = format!("{} ({})", entry.name, entry.role.name().replace('_', " "));
        text(&mut body, (16.0, y + 18.0), &title, ("start", INK, 15, true));
        y += TITLE;
        for panel in &panels {
            draw(&mut body, panel, y, span);
            y += PANEL + 8.0;
        }
        axis(&mut body, y - 8.0, span);
        y += 34.0;
        count += 1;
    }
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {y}\" width=\"{WIDTH}\" height=\"{y}\" role=\"img\" \
         font-family=\"system-ui, 'Segoe UI', 'DejaVu Sans', Arial, sans-serif\">\n{OWN}{} on the common clock</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        escaped(&data.manifest.name)
    );
    atomic::write_bytes(path, (head + &body + "</svg>\n").as_bytes())?;
    Ok(count)
}

/// A colour for each source, in the order of the lines.
fn colours(lines: &[Line]) -> BTreeMap<&str, &'static str> {
    let mut colours = BTreeMap::new();
    for line in lines {
        let next = SOURCES[colours.len() % SOURCES.len()];
        colours.entry(line.source.as_str()).or_insert(next);
    }
    colours
}

/// The reference's time with a twentieth of it on both sides; all of a trial without a reference.
fn span(lines: &[Line], own: &[&Alignment]) -> (f64, f64) {
    let reference = own.iter().find(|a| a.how == How::Same).map(|a| a.source.as_str());
    let of = lines.iter().filter(|line| reference.is_none_or(|name| line.source == name));
    let times = of.flat_map(|line| [line.time.first(), line.time.last()]).flatten();
    let (low, high) = times.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(*t), b.max(*t)));
    let margin = 0.05 * (high - low);
    if low < high { (low - margin, high + margin) } else { (0.0, 1.0) }
}

fn panels<'a>(lines: &'a [Line], own: &[&Alignment], colours: &BTreeMap<&str, &'static str>) -> Vec<Panel<'a>> {
    let of = |line: &'a Line| (line, colours[line.source.as_str()], range(&line.values));
    let mut panels = Vec::new();
    for alignment in own {
        let How::Estimated { reference, column, correlation } = &alignment.how else { continue };
        let ends = |line: &&Line, name: &String| line.name.split_once('.').is_some_and(|(_, own)| own == name);
        let find =
            |name, source: bool| lines.iter().find(|l| ends(l, name) && (l.source == alignment.source) == source);
        let (Some(first), Some(second)) = (find(reference, false), find(column, true)) else { continue };
        panels.push(Panel {
            limits: (format!("t {:+.3} s", alignment.offset), format!("corr. {correlation:.2}")),
            lines: vec![of(first), of(second)],
        });
    }
    for line in lines {
        let (low, high) = range(&line.values);
        let unit = line.unit.as_deref().filter(|unit| *unit != "1").map_or(String::new(), |unit| format!(" {unit}"));
        let limits = (format!("{}{unit}", significant(high, 3)), significant(low, 3));
        panels.push(Panel { limits, lines: vec![of(line)] });
    }
    panels
}

/// Least and greatest value.
fn range(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
}

fn x(time: f64, (low, high): (f64, f64)) -> f64 {
    LEFT + (WIDTH - LEFT - RIGHT) * (time - low) / (high - low)
}

fn draw(body: &mut String, panel: &Panel, top: f64, span: (f64, f64)) {
    let _ = writeln!(
        body,
        "<rect x=\"{LEFT}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{PANEL}\" fill=\"none\" stroke=\"{GRID}\"/>",
        WIDTH - LEFT - RIGHT
    );
    let middle = top + PANEL / 2.0 + 4.0 - 8.0 * (panel.lines.len() - 1) as f64;
    for (k, (line, colour, _)) in panel.lines.iter().enumerate() {
        text(body, (LEFT - 8.0, middle + 16.0 * k as f64), &short(&line.name), ("end", colour, 12, false));
    }
    text(body, (WIDTH - RIGHT + 6.0, top + 11.0), &panel.limits.0, ("start", FAINT, 11, false));
    text(body, (WIDTH - RIGHT + 6.0, top + PANEL - 3.0), &panel.limits.1, ("start", FAINT, 11, false));
    for (line, colour, (low, high)) in &panel.lines {
        let y = |value: f64| {
            let part = if high > low { (value - low) / (high - low) } else { 0.5 };
            top + PANEL - 4.0 - (PANEL - 8.0) * part
        };
        for piece in pieces(line, span) {
            let points: Vec<String> = piece.iter().map(|(t, v)| format!("{:.1},{:.1}", x(*t, span), y(*v))).collect();
            let points = points.join(" ");
            let _ = writeln!(
                body,
                "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.2\"/>"
            );
        }
    }
}

/// The parts of a line between gaps, thinned to the least and the greatest value of each bin.
fn pieces(line: &Line, span: (f64, f64)) -> Vec<Vec<(f64, f64)>> {
    let inside = |t: &f64| (span.0..=span.1).contains(t);
    let seen = line.time.iter().zip(&line.values).filter(|(t, v)| inside(t) && v.is_finite());
    let points: Vec<(f64, f64)> = seen.map(|(t, v)| (*t, *v)).collect();
    let mut steps: Vec<f64> = line.time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let gap = GAP * steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY);
    let bin = |t: f64| (BINS as f64 * (t - span.0) / (span.1 - span.0)) as usize;
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    for (k, point) in points.iter().enumerate() {
        if k == 0 || point.0 - points[k - 1].0 > gap {
            pieces.push(Vec::new());
        }
        let Some(piece) = pieces.last_mut() else { continue };
        match piece.as_mut_slice() {
            [.., a, b] if bin(a.0) == bin(point.0) => {
                // two points stand for a bin: its least and its greatest value
                let (low, high) = (a.1.min(b.1).min(point.1), a.1.max(b.1).max(point.1));
                (a.1, b.1) = if a.1 <= b.1 { (low, high) } else { (high, low) };
            }
            _ => piece.push(*point),
        }
    }
    pieces
}

/// Round times below the last panel.
fn axis(body: &mut String, y: f64, span: (f64, f64)) {
    let rough = (span.1 - span.0) / 6.0;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|step| *step >= rough).unwrap_or(power);
    let (first, last) = ((span.0 / step).ceil() as i64, (span.1 / step).floor() as i64);
    let decimals = -step.log10().floor().min(0.0) as usize;
    for k in first..=last {
        let (time, at) = (k as f64 * step, x(k as f64 * step, span));
        let _ = writeln!(body, "<path d=\"M{at:.1} {y:.1}v5\" stroke=\"{FAINT}\"/>");
        text(body, (at, y + 18.0), &format!("{time:.decimals$} s"), ("middle", FAINT, 11, false));
    }
}

fn text(body: &mut String, (x, y): (f64, f64), words: &str, (anchor, colour, size, bold): (&str, &str, u32, bool)) {
    let weight = if bold { " font-weight=\"600\"" } else { "" };
    let words = escaped(words);
    let _ = writeln!(
        body,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\" font-size=\"{size}\"{weight}>{words}</text>"
    );
}

/// The end of a name that is too long for its place.
fn short(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= 42 {
        name.to_string()
    } else {
        format!("…{}", letters[letters.len() - 41..].iter().collect::<String>())
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
