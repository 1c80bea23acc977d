//! ARCHITECTURE.md opens with the number of crates; `scripts/check-docs` checks that it names each.

const NUMBERS: [&str; 21] = [
    "No",
    "One",
    "Two",
    "Three",
    "Four",
    "Five",
    "Six",
    "Seven",
    "Eight",
    "Nine",
    "Ten",
    "Eleven",
    "Twelve",
    "Thirteen",
    "Fourteen",
    "Fifteen",
    "Sixteen",
    "Seventeen",
    "Eighteen",
    "Nineteen",
    "Twenty",
];

/// Returns a complaint where the text states another number of crates than there are.
pub fn complaints(architecture: &str, crates: usize) -> Option<String> {
    let number = NUMBERS.get(crates).map_or_else(|| crates.to_string(), ToString::to_string);
    let says = architecture.lines().any(|line| line.starts_with(&format!("{number} crates")));
    (!says).then(|| format!("ARCHITECTURE.md: there are {crates} crates; no line begins with \"{number} crates\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn the_number_of_crates_is_that_of_the_text() {
        assert_eq!(complaints("# Architecture\n\nThree crates: a, b, c.\n", 3), None);
        assert!(complaints("# Architecture\n\nThree crates: a, b, c.\n", 4).unwrap().contains("\"Four crates\""));
    }
}
