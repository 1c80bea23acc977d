//! Lists of trial names for messages and tables.

use std::borrow::Borrow;

/// Number of names that are shown of a longer list.
const NAMED: usize = 30;

/// Returns the names with `separator` between them, or the first few and how many more.
pub fn some(names: &[impl Borrow<str>], separator: &str) -> String {
    match names.len() {
        few if few <= NAMED => names.join(separator),
        many => format!("{} and {} more", names[..NAMED].join(separator), many - NAMED),
    }
}

#[cfg(test)]
mod tests {
    use super::some;

    #[test]
    fn a_long_list_is_cut_and_counted() {
        let names: Vec<String> = (0..1000).map(|k| format!("{k:03}")).collect();
        assert_eq!(some(&names[..2], ", "), "000, 001");
        assert!(some(&names, " ").ends_with("028 029 and 970 more"));
    }
}
