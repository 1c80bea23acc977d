//! The six layers of acm-train: a file needs files of its own layer and of those below it.
//!
//! ```text
//! store < config < learn < run < schedule < cli < main, lib
//! ```

use super::module::{Module, listed, shown};
use super::needs::Needs;

/// Crates with layers, from the lowest up; the root is above all of them.
const FLOORS: [(&str, &[&str]); 1] = [("acm-train", &["store", "config", "learn", "run", "schedule", "cli"])];

/// Describes needs of higher layers, and files in no layer.
pub fn complaints(name: &str, needs: &Needs) -> Vec<String> {
    let of_crate = FLOORS.iter().find(|(of, _)| *of == name);
    of_crate.map_or(vec![], |(_, floors)| against(name, needs, floors))
}

fn against(name: &str, needs: &Needs, floors: &[&str]) -> Vec<String> {
    let floor = |module: &Module| match module.first() {
        None => Some(floors.len()),
        Some(first) => floors.iter().position(|floor| floor == first),
    };
    let mut all = vec![];
    for (from, others) in needs {
        let Some(own) = floor(from) else {
            all.push(format!("{name}: {} is on no floor", shown(from)));
            continue;
        };
        for (to, paths) in others.iter().filter(|(to, _)| floor(to).is_some_and(|floor| floor > own)) {
            all.push(format!("{name}: {} → {} goes up: {}", shown(from), shown(to), listed(paths)));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::needs::by_hand;
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn what_goes_up_is_named() {
        let needs = by_hand(&[("low::a", "high::b"), ("high::b", "low::c"), ("", "high::b"), ("high", "")]);
        let found = against("crate", &needs, &["low", "high"]);
        assert_eq!(found, ["crate: high → the root goes up: ::x", "crate: low::a → high::b goes up: high::b::x"]);
        let found = against("crate", &by_hand(&[("high::b", "low::a"), ("odd", "low::a")]), &["low", "high"]);
        assert_eq!(found, ["crate: odd is on no floor"]);
    }
}
