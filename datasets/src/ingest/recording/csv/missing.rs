//! Spellings of a missing value.

/// Spellings in lower case, beside those of NaN.
const MISSING: &[&str] =
    &["na", "n/a", "#n/a", "#na", "<na>", "n.a.", "nat", "null", "none", "nil", "missing", "-", "--", ".", "\\n"];

/// Whether a cell says that there is no value: `NaN`, `-nan(ind)`, `1.#QNAN`, `#N/A`, `null`, `-`.
pub(crate) fn is_missing(cell: &str) -> bool {
    if cell.is_empty() || cell.len() > 20 || cell.as_bytes()[0].is_ascii_digit() && !cell.contains('#') {
        return cell.is_empty();
    }
    let lower = cell.to_ascii_lowercase();
    let unsigned = lower.trim_start_matches(['+', '-']);
    let nan = unsigned.strip_prefix("nan").or(unsigned.strip_prefix("qnan")).or(unsigned.strip_prefix("snan"));
    nan.is_some_and(|rest| rest.is_empty() || (rest.starts_with('(') && rest.ends_with(')')))
        || ["1.#qnan", "1.#snan", "1.#ind", "1.#nan"].iter().any(|windows| unsigned.starts_with(windows))
        || MISSING.contains(&lower.as_str())
}

#[cfg(test)]
mod tests {
    use super::is_missing;

    /// Oracle: what the C libraries of Linux and Windows, R, pandas, spreadsheets and databases write.
    #[test]
    fn missing_values_have_many_spellings() {
        let missing =
            "nan NaN -nan NAN(ind) -nan(ind) nan(0x8) 1.#QNAN -1.#IND00 <NA> NA N/A #N/A NaT null NULL None - . \\N";
        missing.split(' ').for_each(|cell| assert!(is_missing(cell), "{cell}"));
        assert!(is_missing(""));
        "0 1.5 -2 1e5 inf -inf 1.#INF #DIV/0! nano ? nan5 none1 -1"
            .split(' ')
            .for_each(|cell| assert!(!is_missing(cell), "{cell}"));
    }
}
