//! Control characters in a file that another person wrote: an escape sequence in a name would reach every terminal and log in
//! which the name is printed. A text may have tabs and line ends; any other is refused where it is read.

use std::ops::Range;

use toml::de::DeTable;

use super::walk::each;

/// The first key or text of a TOML file that has one, and what to do.
pub(super) fn find(text: &str) -> Option<(Range<usize>, String)> {
    each(DeTable::parse(text).ok()?.get_ref(), &mut vec![], &mut |key, at, value| {
        let text = value.get_ref().as_str().and_then(|text| in_text(text, value.span()));
        key.last().and_then(|name| in_text(name, at)).or(text)
    })
}

fn in_text(text: &str, span: Range<usize>) -> Option<(Range<usize>, String)> {
    let text = text.replace("\r\n", "\n");
    let control = text.chars().find(|c| is_control(*c))?;
    let message = format!("the text has the control character {}; delete it", control.escape_unicode());
    Some((span, message))
}

/// Characters that move the cursor, ring or recolour; a tab and a line end are text.
fn is_control(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
}

/// A message in which they are written by their number, as `\u{1b}`.
pub(super) fn escaped(message: &str) -> String {
    let one = |c: char| if is_control(c) { c.escape_unicode().to_string() } else { c.to_string() };
    message.chars().map(one).collect()
}

/// The text with a mark of the same length in the place of each; a line end of Windows is one of its own.
pub(super) fn masked(text: &str) -> String {
    let mark = |c: char| match is_control(c) {
        true if c.len_utf8() == 1 => '?',
        true => '¿',
        false => c,
    };
    text.split("\r\n").map(|line| line.chars().map(mark).collect::<String>()).collect::<Vec<_>>().join("\r\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand; places do not move.
    #[test]
    fn control_characters_are_found_and_masked() {
        let found = |text: &str| find(text).map(|(span, message)| (text[span].to_string(), message));
        assert_eq!(found("a = \"x\ty\"\nb = '''\nz\n'''"), None);
        let (place, message) = found("a = [1, {c = \"r\\u001b[31m\"}]").unwrap_or_default();
        assert_eq!(place, "\"r\\u001b[31m\"");
        assert_eq!(message, "the text has the control character \\u{1b}; delete it");
        assert!(found("[t]\n\"k\\u0007\" = 1").is_some_and(|(place, _)| place.starts_with("\"k")));
        assert!(find("a = \"x\\ry\"").is_some() && find("a = \"\"\"\r\nx\r\n\"\"\"").is_none());
        assert_eq!(masked("a\rb\r\nc\r\n"), "a?b\r\nc\r\n");
        assert_eq!(escaped("a\u{1b}b\nc\u{9b}"), "a\\u{1b}b\nc\\u{9b}");
        let text = "a\u{1b}\u{9b}ä\n";
        assert_eq!((masked(text).as_str(), masked(text).len()), ("a?¿ä\n", text.len()));
    }
}
