//! Messages of the TOML parser and of serde in plain words, with a remedy.

use crate::text::spelling::meant;

/// Bytes of a message: a name, a value or a list in it may be as long as a file.
pub const LONGEST: usize = 4000;

/// Bytes of one part of a message.
const LONGEST_PART: usize = 900;

/// A part of a message, cut where it is longer than anybody reads.
pub fn short(text: &str) -> String {
    cut(text, LONGEST_PART)
}

/// A text of `most` bytes or little more.
pub fn cut(text: &str, most: usize) -> String {
    if text.len() <= most {
        return text.to_string();
    }
    let end = text.char_indices().map(|(at, _)| at).take_while(|at| *at <= most).last().unwrap_or(0);
    format!("{}…", &text[..end])
}

/// Serde names Rust's types; a reader of TOML knows others.
pub fn in_words(message: &str) -> String {
    let plain = cut(message.lines().next().unwrap_or_default(), 600);
    let plain = ["expected struct ", "expected internally tagged enum "].iter().fold(plain, |text, start| {
        let parts =
            text.split_once(start).map(|(before, after)| (before, after.trim_start_matches(char::is_alphanumeric)));
        parts.map_or(text.clone(), |(before, after)| format!("{before}expected a table{after}"))
    });
    [
        ("expected usize", "expected a whole number, 0 or more"),
        ("expected u64", "expected a whole number from 0 to 9223372036854775807"),
        ("expected f64", "expected a number"),
        ("expected a sequence", "expected a list"),
        ("invalid type: sequence", "invalid type: a list"),
        ("invalid type: map", "invalid type: a table"),
        ("expected a map", "expected a table"),
        ("expected path string", "expected a path in quotes"),
        ("expected a string", "expected a text in quotes"),
        ("invalid type: unit variant, expected string only", "invalid type: expected a text in quotes"),
        ("expected variant identifier", "expected a text in quotes"),
        ("expected a boolean", "expected true or false"),
        ("invalid type: string", "invalid type: the text"),
        ("invalid type: floating point", "invalid type: the number"),
        ("invalid type: boolean", "invalid type: the truth value"),
        ("string or table", "a text in quotes, or a table"),
        ("duplicate key", "the key is there twice"),
    ]
    .iter()
    .fold(plain, |text, (rust, words)| text.replace(rust, words))
}

/// Remedy for serde's `message`; `example` names an example of such a file.
pub fn remedy(message: &str, example: &str) -> String {
    let mut names = message.split('`').skip(1).step_by(2);
    let written = names.next().unwrap_or_default();
    let meant = meant(written, names).map_or(String::new(), |name| format!("did you mean `{name}`? If not, "));
    if message.starts_with("unknown field") {
        format!("{meant}remove the key, or use one of the names above; {example} shows such a file")
    } else if message.starts_with("unknown variant") {
        format!("{meant}use one of the names above")
    } else if message.starts_with("missing field") {
        format!("write the key `{}`; {example} shows such a file", cut(written, 120))
    } else if message.contains("floating point") && (message.contains("usize") || message.contains("u64")) {
        "write it without a decimal point and without an exponent: 1000 for 1e3".into()
    } else {
        "write a value of the expected type, or leave the key out for its default".into()
    }
}

/// Fault of a text without any key, and its remedy; `example` names an example of such a file.
pub fn empty(text: &str, example: &str) -> Option<(&'static str, String)> {
    let mut lines =
        text.trim_start_matches('\u{feff}').lines().map(str::trim).filter(|line| !line.is_empty()).peekable();
    let what = if lines.peek().is_none() { "the file is empty" } else { "the file has nothing but comments" };
    let help = format!("write at least one key, or name another file; {example} shows such a file");
    lines.all(|line| line.starts_with('#')).then_some((what, help))
}

/// Remedy for text that is not TOML.
pub fn syntax_remedy(message: &str) -> &'static str {
    if message.starts_with("duplicate key") {
        "delete one of the two, or join the tables"
    } else if message.contains("recursion") {
        "write fewer brackets inside one another"
    } else {
        "mend the TOML: text needs quotes, numbers a decimal point, brackets their counterpart"
    }
}

/// The dotted key that is being written at a byte, as far as lines tell: text that is no TOML has no tree to ask.
pub fn key_near(text: &str, at: usize) -> Option<String> {
    let end = text.get(at..)?.find('\n').map_or(text.len(), |length| at + length);
    let mut name = None;
    let header = text.get(..end)?.lines().rev().find_map(|line| {
        let line = line.trim();
        if let Some(header) = line.strip_prefix('[').filter(|_| !line.contains('=')) {
            return Some(header.trim_start_matches('[').split(']').next().unwrap_or_default().trim().to_string());
        }
        let key = line.split_once('=').map_or(line, |(key, _)| key).trim();
        if name.is_none() && !key.is_empty() && !key.starts_with('#') {
            name = Some(key.to_string());
        }
        None
    });
    let parts: Vec<String> = header.into_iter().chain(name).filter(|part| !part.is_empty()).collect();
    (!parts.is_empty()).then(|| cut(&parts.join("."), 120))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn the_key_that_is_being_written_is_told_from_the_lines() {
        let text = "a = 1\n[windows]\n# of samples\nlength = = 5\n\n[training]\nepochs\n";
        let near = |part: &str| key_near(text, text.find(part).unwrap_or(0));
        assert_eq!(near("1").as_deref(), Some("a"));
        assert_eq!(near("= 5").as_deref(), Some("windows.length"));
        assert_eq!(near("epochs").as_deref(), Some("training.epochs"));
        assert_eq!(near("[training]").as_deref(), Some("training"));
        assert_eq!(key_near("", 0), None);
        assert_eq!(key_near("ä", 1), None);
    }

    /// Expected texts written by hand.
    #[test]
    fn types_are_those_of_a_file() {
        for (serde, words) in [
            ("invalid type: integer `3`, expected struct Search", "invalid type: integer `3`, expected a table"),
            (
                "invalid type: string \"x\", expected internally tagged enum Schedule",
                "invalid type: the text \"x\", expected a table",
            ),
            ("invalid type: unit variant, expected string only", "invalid type: expected a text in quotes"),
            (
                "invalid type: integer `3`, expected variant identifier",
                "invalid type: integer `3`, expected a text in quotes",
            ),
        ] {
            assert_eq!(in_words(serde), words);
        }
    }

    #[test]
    fn a_long_part_is_cut_between_letters() {
        assert_eq!(short("abc"), "abc");
        let cut = short(&"ä".repeat(2000));
        assert!(cut.len() <= LONGEST_PART + 6 && cut.ends_with("ä…"), "{}", cut.len());
    }
}
