//! Natural order of names: run2 before run10.

use std::cmp::Ordering;

/// Compares by runs of digits as numbers and everything else by character.
pub(crate) fn compare(a: &str, b: &str) -> Ordering {
    let (mut x, mut y) = (a, b);
    loop {
        let (p, q) = (digits(x), digits(y));
        let step = if p > 0 && q > 0 {
            let (m, n) = (x[..p].trim_start_matches('0'), y[..q].trim_start_matches('0'));
            (x, y) = (&x[p..], &y[q..]);
            m.len().cmp(&n.len()).then_with(|| m.cmp(n))
        } else {
            let (c, d) = (x.chars().next(), y.chars().next());
            if c.is_none() && d.is_none() {
                return a.cmp(b); // 01 and 1 differ still
            }
            x = &x[c.map_or(0, char::len_utf8)..];
            y = &y[d.map_or(0, char::len_utf8)..];
            c.cmp(&d)
        };
        if step != Ordering::Equal {
            return step;
        }
    }
}

fn digits(text: &str) -> usize {
    text.bytes().take_while(u8::is_ascii_digit).count()
}

#[cfg(test)]
mod tests {
    use super::compare;

    #[test]
    fn numbers_are_counted_and_words_are_spelled() {
        let mut names = ["10", "9", "run10", "run2", "1", "run2_b", "run2_a10", "run2_a9", "01", "ä", ""];
        names.sort_by(|a, b| compare(a, b));
        assert_eq!(names, ["", "01", "1", "9", "10", "run2", "run2_a9", "run2_a10", "run2_b", "run10", "ä"]);
    }
}
