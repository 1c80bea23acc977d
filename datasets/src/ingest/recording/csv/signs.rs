//! Separators of cells and decimal separators that a manifest or a configuration may give.

/// A given separator that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrongSign {
    /// `separator` or `decimal`.
    pub key: &'static str,
    /// The given text.
    pub value: String,
    /// What to write.
    pub remedy: &'static str,
}

/// Returns the first of the given separators that cannot be used.
pub(crate) fn wrong_sign(separator: Option<&str>, decimal: Option<&str>) -> Option<WrongSign> {
    let wrong = |key, value: &str, remedy| Some(WrongSign { key, value: value.to_string(), remedy });
    match (separator, decimal) {
        (Some(sign), _) if ![",", ";", "\t", "|", " "].contains(&sign) => {
            wrong("separator", sign, "write \",\" \";\" \"\\t\" \"|\" or a space")
        }
        (_, Some(sign)) if ![",", "."].contains(&sign) => wrong("decimal", sign, "write \",\" or \".\""),
        (Some(cells), Some(sign)) if cells == sign => {
            wrong("decimal", sign, "it also separates the cells: correct `separator` or `decimal`")
        }
        _ => None,
    }
}
