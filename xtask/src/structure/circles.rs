//! Cycles of files that need each other: they can only be read, moved or tested together.

use std::collections::{BTreeMap, BTreeSet};

use super::module::{Module, listed, shown};
use super::needs::Needs;

/// Describes each cycle with its arrows and the paths that tie them.
pub fn complaints(name: &str, needs: &Needs) -> Vec<String> {
    circles(needs).iter().map(|circle| complaint(name, needs, circle)).collect()
}

/// Returns the sets of files in which each file reaches every other.
fn circles(needs: &Needs) -> BTreeSet<Vec<Module>> {
    let reached: BTreeMap<&Module, BTreeSet<&Module>> = needs.keys().map(|file| (file, reached(needs, file))).collect();
    let circle = |file: &Module| -> Vec<Module> {
        let others = reached[file].iter().filter(|other| reached[*other].contains(file));
        others.map(|other| (*other).clone()).collect()
    };
    needs.keys().map(circle).filter(|circle| !circle.is_empty()).collect()
}

/// Returns all files that one needs, and those that they need.
fn reached<'n>(needs: &'n Needs, start: &Module) -> BTreeSet<&'n Module> {
    let mut seen = BTreeSet::new();
    let mut open: Vec<&Module> = needs[start].keys().collect();
    while let Some(file) = open.pop() {
        if seen.insert(file) {
            open.extend(needs[file].keys());
        }
    }
    seen
}

fn complaint(name: &str, needs: &Needs, circle: &[Module]) -> String {
    let mut text = format!("{name}: {} files go in a circle", circle.len());
    for from in circle {
        for (to, paths) in needs[from].iter().filter(|(to, _)| circle.contains(to)) {
            text += &format!("\n    {} → {}: {}", shown(from), shown(to), listed(paths));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::needs::by_hand;
    use super::*;

    /// Oracle: by hand: a → b → c → a is a circle, d → e is none, and d → a makes none of d.
    #[test]
    fn a_circle_is_found_once_and_whole() {
        let needs = by_hand(&[("a", "b"), ("b", "c"), ("c", "a"), ("d", "e"), ("d", "a")]);
        let found = complaints("crate", &needs);
        assert_eq!(found, ["crate: 3 files go in a circle\n    a → b: b::x\n    b → c: c::x\n    c → a: a::x"]);
        assert!(complaints("crate", &by_hand(&[("a", "b"), ("a", "c"), ("b", "c")])).is_empty());
    }
}
