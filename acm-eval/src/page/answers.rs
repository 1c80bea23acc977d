//! Interactive parts of a page: a script, its style, and the numbers that it reads, all in the page.
//!
//! ```text
//! Drawing::plotted ─▶ <script type="application/json" class="plotted"> ─┐
//! Drawing::space   ─▶ <script type="application/json" class="space">   ─┤
//! Table::csv       ─▶ <script type="application/json" class="csv">     ─┴─ live/*.js ─▶ cursor, zoom, arm, order, downloads
//! ```
//!
//! Without the script the figures stand as they are. Nothing is fetched.

use maud::{Markup, PreEscaped, html};

use crate::figures::Drawing;
use crate::figures::plotted::numbers;

/// Style rules for the elements that the script adds.
pub const STYLE: &str = include_str!("live.css");
/// Script of the page: one function of pieces, each with its purpose at its head; the last one starts it.
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("live/elements.js"),
    include_str!("live/save.js"),
    include_str!("live/tables.js"),
    include_str!("live/figure.js"),
    include_str!("live/pointer.js"),
    include_str!("live/zoom.js"),
    include_str!("live/keys.js"),
    include_str!("live/panel.js"),
    include_str!("live/read.js"),
    include_str!("live/marks.js"),
    include_str!("live/redraw.js"),
    include_str!("live/cursor.js"),
    include_str!("live/balloon.js"),
    include_str!("live/projection.js"),
    include_str!("live/space.js"),
    include_str!("live/controls.js"),
    include_str!("live/stage.js"),
    include_str!("live/say.js"),
    include_str!("live/start.js"),
    "})();\n"
);

/// A table longer than this, in bytes, is only in its file.
const LONGEST: usize = 200_000;

/// Writes the script, after all elements that it reads.
pub fn script() -> Markup {
    html! { script { (PreEscaped(SCRIPT)) } }
}

/// Writes the numbers of a figure, inside its `figure` element. `name` is that of its files; the cursors of one trial
/// of one data set, `set`, move together.
pub fn plotted(name: &str, set: &str, drawing: &Drawing) -> Markup {
    html! {
        @if !drawing.plotted.is_empty() {
            script.plotted type="application/json" data-name=(name) data-set=(set) {
                (PreEscaped(numbers::json(&drawing.plotted)))
            }
        }
        @if let Some(space) = &drawing.space {
            script.space type="application/json" data-name=(name) data-set=(set) {
                (PreEscaped(numbers::embedded(&serde_json::json!(space.rounded()).to_string())))
            }
        }
    }
}

/// Writes the numbers of a table, for a button beside the link to `file`.
pub fn csv(file: &str, text: &str) -> Markup {
    let json = serde_json::Value::from(text).to_string();
    html! {
        @if text.len() <= LONGEST {
            script.csv type="application/json" data-file=(file) { (PreEscaped(numbers::embedded(&json))) }
        }
    }
}
