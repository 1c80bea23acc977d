//! Figures in dark mode: no background, and a dark counterpart of each colour.
//!
//! Figures are drawn on white, and stay so in their files. On the page a style sheet takes their paper away and, where the
//! reader prefers the dark, exchanges each colour. Print is light whatever the reader prefers.

use crate::closed_loop::figures::colours::{AFTER_PALE, CELL, MEASURED, NOISE_PALE, NOMINAL_PALE};
use crate::figures::canvas::palette::{
    ARM, BLUE, FAINT, GREEN, GREY, GRID, INK, ORANGE, PALE_GREY, PURPLE, SKY, VERMILLION, WARNING,
};

/// A colour on white, and the same on a dark page.
pub const PAIRS: &[(&str, &str)] = &[
    (INK, "#e8e6e3"),
    (GRID, "#34383e"),
    (FAINT, "#aaa7a2"),
    (WARNING, "#ffab7a"),
    (ORANGE, "#f0b63a"),
    (GREEN, "#2fc79b"),
    (BLUE, "#5aaeea"),
    (VERMILLION, "#ff8a4c"),
    (PURPLE, "#e79bc7"),
    (SKY, "#a9dcfa"),
    (GREY, "#a6a6a6"),
    (PALE_GREY, "#7f8288"),
    (ARM, "#7fa3c7"),
    (MEASURED, "#8a8d92"),
    (NOMINAL_PALE, "#7d5134"),
    (AFTER_PALE, "#37597a"),
    (NOISE_PALE, "#34383e"),
    (CELL, "#62b6f0"),
    ("white", "#16181b"),
    ("#ffffff", "#16181b"),
];

/// Selector of figures, and of the keys of the arm in space.
const WHERE: &str = ":is(.sheet,.reads)";

/// Returns the style rules for them.
pub fn rules() -> String {
    let rule = |(light, dark): &(&str, &str)| {
        format!("{WHERE} [fill=\"{light}\"]{{fill:{dark}}}{WHERE} [stroke=\"{light}\"]{{stroke:{dark}}}\n")
    };
    let rules: String = PAIRS.iter().map(rule).collect();
    // The last rule wins: the paper is the only thing that is as wide as a figure.
    let paper = ".sheet rect[width=\"100%\"]{fill:none}\n";
    format!("@media screen and (prefers-color-scheme: dark) {{\n{rules}}}\n{paper}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the relative luminance (WCAG 2.1).
    fn luminance(colour: &str) -> f64 {
        let channel = |k: usize| f64::from(u8::from_str_radix(&colour[k..k + 2], 16).unwrap()) / 255.0;
        let linear = |c: f64| if c <= 0.03928 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
        0.2126 * linear(channel(1)) + 0.7152 * linear(channel(3)) + 0.0722 * linear(channel(5))
    }

    fn contrast(a: &str, b: &str) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// Oracle: the formula of WCAG 2.1, which asks for 3 : 1 of lines and 4.5 : 1 of words.
    #[test]
    fn lines_and_words_stand_out_in_the_light_and_in_the_dark() {
        let background = [GRID, NOMINAL_PALE, AFTER_PALE, NOISE_PALE, MEASURED, "white", "#ffffff"];
        for (light, dark) in PAIRS.iter().filter(|(light, _)| !background.contains(light)) {
            let least = if [INK, FAINT, WARNING].contains(light) { 4.5 } else { 3.0 };
            assert!(contrast(light, "#ffffff") >= least, "{light} on white: {}", contrast(light, "#ffffff"));
            assert!(contrast(dark, "#16181b") >= least, "{dark} in the dark: {}", contrast(dark, "#16181b"));
        }
    }
}
