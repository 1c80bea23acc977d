//! Files that each file needs, with the paths that name them.

use std::collections::{BTreeMap, BTreeSet};

use super::module::Module;
#[cfg(test)]
use super::module::module;
use super::resolve::{Files, definition};

/// Files that each file needs, each with the paths that name it.
pub type Needs = BTreeMap<Module, BTreeMap<Module, BTreeSet<String>>>;

/// Returns the needs of all files of a crate.
pub fn needs(files: &Files) -> Needs {
    let of = |(module, names): (&Module, &super::names::Names)| {
        let mut own: BTreeMap<Module, BTreeSet<String>> = BTreeMap::new();
        for place in &names.used {
            if let Some(file) = definition(files, place).filter(|file| file != module) {
                own.entry(file).or_default().insert(place.path.join("::"));
            }
        }
        (module.clone(), own)
    };
    files.iter().map(of).collect()
}

#[cfg(test)]
pub(super) fn by_hand(arrows: &[(&str, &str)]) -> Needs {
    let mut needs = Needs::new();
    for (from, to) in arrows {
        needs.entry(module(to)).or_default();
        needs.entry(module(from)).or_default().insert(module(to), [format!("{to}::x")].into());
    }
    needs
}

#[cfg(test)]
mod tests {
    use super::super::names::Names;
    use super::*;

    /// Oracle: by hand: `b` names an item of `a`; neither a `mod`, nor a re-export, nor a test is a need.
    #[test]
    fn a_file_needs_what_it_names() {
        let texts = [
            ("", "mod a; mod b; pub use b::B;"),
            ("a", "pub struct A; #[cfg(test)] mod tests { use crate::B; }"),
            ("b", "use crate::a; pub struct B(a::A);"),
        ];
        let module =
            |path: &str| path.split("::").filter(|name| !name.is_empty()).map(String::from).collect::<Module>();
        let file = |(path, text): (&str, &str)| (module(path), Names::new(&module(path), text).unwrap());
        let files: Files = texts.into_iter().map(file).collect();
        let mut expected = by_hand(&[("b", "a")]);
        expected.insert(vec![], BTreeMap::new());
        expected.get_mut(&module("b")).unwrap().insert(module("a"), ["a::A".to_string()].into());
        assert_eq!(needs(&files), expected);
    }
}
