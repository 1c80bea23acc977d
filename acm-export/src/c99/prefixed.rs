//! Names at file scope with a prefix, so that several estimators fit into one source.

use std::collections::BTreeSet;

/// Gives every name that a text defines at file scope (`static`, `#define`, `typedef`) the prefix, wherever it stands outside of comments
/// and behind no `.` or `->`.
pub fn prefixed(text: &str, prefix: &str) -> String {
    let names: BTreeSet<&str> = text.lines().filter_map(defined).collect();
    let mut found = String::with_capacity(text.len() + text.len() / 8);
    let mut rest = text;
    while let Some(begin) = rest.find("/*") {
        let end = rest[begin..].find("*/").map_or(rest.len(), |end| begin + end + 2);
        rename(&rest[..begin], &names, prefix, &mut found);
        found.push_str(&rest[begin..end]);
        rest = &rest[end..];
    }
    rename(rest, &names, prefix, &mut found);
    found
}

/// Returns the name that a line defines at file scope.
fn defined(line: &str) -> Option<&str> {
    let name = |text: &str| -> usize { text.find(|c| !is_letter(c)).unwrap_or(text.len()) };
    if let Some(rest) = line.strip_prefix("#define ").or_else(|| line.strip_prefix("} ")) {
        return Some(&rest[..name(rest)]).filter(|name| !name.is_empty());
    }
    let rest = line.strip_prefix("static ")?;
    let before = rest[..rest.find(['(', '[', '=', ';']).unwrap_or(rest.len())].trim_end();
    let begin = before.rfind(|c| !is_letter(c)).map_or(0, |at| at + 1);
    Some(&before[begin..]).filter(|name| !name.is_empty())
}

fn rename(code: &str, names: &BTreeSet<&str>, prefix: &str, found: &mut String) {
    let mut rest = code;
    while let Some(begin) = rest.find(is_letter) {
        let end = rest[begin..].find(|c| !is_letter(c)).map_or(rest.len(), |end| begin + end);
        let word = &rest[begin..end];
        found.push_str(&rest[..begin]);
        let is_member = found.ends_with('.') || found.ends_with("->");
        if names.contains(word) && !is_member {
            found.push_str(prefix);
        }
        found.push_str(word);
        rest = &rest[end..];
    }
    found.push_str(rest);
}

/// Returns whether a character belongs to a name; `$` stands before those of the header, which have names of their own.
fn is_letter(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '$'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_at_file_scope_have_the_prefix_and_no_others() {
        let text = "#define N 3 /* N of them */\ntypedef struct {\n    int n;\n} grid;\nstatic const grid *const ALL[N] = { 0 };\n\
                    static int take($name_state *s, int n)\n{\n    return s->take + ALL[0]->n + n * N + $name_take;\n}\n";
        let expected = "#define m1_N 3 /* N of them */\ntypedef struct {\n    int n;\n} m1_grid;\n\
                        static const m1_grid *const m1_ALL[m1_N] = { 0 };\nstatic int m1_take($name_state *s, int n)\n{\n    \
                        return s->take + m1_ALL[0]->n + n * m1_N + $name_take;\n}\n";
        assert_eq!(prefixed(text, "m1_"), expected);
    }
}
