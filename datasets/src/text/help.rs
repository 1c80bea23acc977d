//! Help texts, wrapped to the terminal.
//!
//! The text is written in lines of any length; it is joined to paragraphs and wrapped once.
//!
//! | a line                                    | goes on                                      |
//! | ----------------------------------------- | -------------------------------------------- |
//! | a paragraph                               | below its own indent                         |
//! | `  key   what it means`                   | below the second column                      |
//! | `  a long command      what it does`      | its second column on a line of its own       |

use textwrap::{Options, WordSeparator::AsciiSpace, WordSplitter::NoHyphenation, wrap};

use crate::text::terminal::width;

/// Help is no wider than this, whatever the terminal.
const WIDEST: usize = 100;
/// And no narrower.
const NARROWEST: usize = 40;
/// Indent of commands and of lines of a file, which are not joined.
const LISTED: usize = 2;
/// Indent of what a command does.
const BELOW: usize = 6;

/// The text in lines that fit.
pub fn help(text: &str) -> String {
    let width = width().unwrap_or(WIDEST).clamp(NARROWEST, WIDEST);
    paragraphs(text).iter().map(|paragraph| wrapped(paragraph, width)).collect::<Vec<_>>().join("\n")
}

/// Joins each line to the one before where it goes on below it.
fn paragraphs(text: &str) -> Vec<String> {
    let mut paragraphs: Vec<String> = vec![];
    let mut hanging = None;
    for line in text.lines() {
        let goes_on = !line.trim().is_empty() && indent(line) != LISTED && hanging == Some(indent(line));
        match paragraphs.last_mut() {
            Some(last) if goes_on => *last = format!("{last} {}", line.trim_start()),
            _ => {
                hanging = (!line.trim().is_empty()).then(|| second_column(line).unwrap_or(indent(line)));
                paragraphs.push(line.to_string());
            }
        }
    }
    paragraphs
}

fn wrapped(line: &str, width: usize) -> String {
    let options = Options::new(width).break_words(false).word_separator(AsciiSpace).word_splitter(NoHyphenation);
    let below = |hanging: usize| " ".repeat(hanging);
    let fits = textwrap::core::display_width(line) <= width;
    match second_column(line) {
        _ if fits => line.to_string(),
        Some(column) if column <= width / 3 => wrap(line, options.subsequent_indent(&below(column))).join("\n"),
        Some(column) => {
            let (command, what) = line.split_at(line.char_indices().nth(column).map_or(line.len(), |(at, _)| at));
            let indented = below(BELOW);
            let what = wrap(what, options.initial_indent(&indented).subsequent_indent(&indented)).join("\n");
            format!("{}\n{what}", command.trim_end())
        }
        // A command that goes on cannot be taken for the next one.
        None if indent(line) == LISTED => wrap(line, options.subsequent_indent(&below(2 * BELOW))).join("\n"),
        None => wrap(line, options.subsequent_indent(&below(indent(line)))).join("\n"),
    }
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Where the second column of a list begins: after two spaces or more, in an indented line.
fn second_column(line: &str) -> Option<usize> {
    let letters: Vec<char> = line.chars().collect();
    let first = indent(line);
    let gap = (first..letters.len().saturating_sub(1)).find(|&k| letters[k] == ' ' && letters[k + 1] == ' ')?;
    let second = (gap..letters.len()).find(|&k| letters[k] != ' ')?;
    (first > 0).then_some(second)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: joined and wrapped by hand.
    #[test]
    fn lines_are_joined_and_wrapped_once() {
        let text =
            "A long paragraph\nof two lines.\n  run it\n      does this\n      and that\n  key   first\n        second";
        let joined = ["A long paragraph of two lines.", "  run it", "      does this and that", "  key   first second"];
        assert_eq!(paragraphs(text), joined);
        assert_eq!(wrapped("  out      the folder that takes it all", 36), {
            "  out      the folder that takes it\n           all"
        });
        assert_eq!(wrapped("    deep words in one line", 16), "    deep words\n    in one line");
        assert_eq!(wrapped("  a quite long command    does it all", 30), "  a quite long command\n      does it all");
    }
}
