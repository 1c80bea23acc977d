//! Names of modules.

use std::collections::BTreeSet;

/// Names of a module from the root of its crate.
pub type Module = Vec<String>;

/// Returns the module of a path; the root where it is empty.
pub fn module(path: &str) -> Module {
    path.split("::").filter(|name| !name.is_empty()).map(String::from).collect()
}

/// Returns a module as people write it.
pub fn shown(module: &Module) -> String {
    if module.is_empty() { "the root".into() } else { module.join("::") }
}

/// Returns the paths as people read them: of those that end alike, the longest.
pub fn listed(paths: &BTreeSet<String>) -> String {
    let is_end = |path: &&str| paths.iter().any(|other| other.ends_with(&format!("::{path}")));
    let whole: Vec<&str> = paths.iter().map(String::as_str).filter(|path| !is_end(path)).collect();
    whole.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn an_item_is_listed_once() {
        let paths = ["A", "super::a::A", "b", "c::b", "d"].map(String::from);
        assert_eq!(listed(&paths.into()), "c::b, d, super::a::A");
    }
}
