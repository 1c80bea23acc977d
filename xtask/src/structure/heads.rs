//! Files at the head of a folder that declare what its members share, as a trait does with the list of its
//! implementations: imports of such a file from its own folder make no cycle. In every other folder the head may use
//! its members, or they the head.

use super::module::{Module, module};
use super::needs::Needs;

/// Heads of each crate; an empty name is its root.
const HEADS: [(&str, &[&str]); 4] = [
    ("acm-core", &["effects", "tip_model"]),
    ("acm-eval", &["chapter::list", "chapter::nominal", "chapter::residual", "chapter::sequences", "page", "tables"]),
    ("acm-export", &["c99", "c99::effects", "c99::effects::bodies"]),
    (
        "datasets",
        &[
            "",
            "commands",
            "formats",
            "generate::undeclared",
            "manifest",
            "ingest::recording",
            "ingest::recording::dialect",
            "recordings",
            "sequences::table",
            "sources",
        ],
    ),
];

/// Returns the needs without those of heads for files in their own folders.
pub fn without(name: &str, needs: &Needs) -> Needs {
    let of_crate = HEADS.iter().find(|(of, _)| *of == name).map_or(&[][..], |(_, heads)| heads);
    let heads: Vec<Module> = of_crate.iter().map(|head| module(head)).collect();
    but(needs, &heads)
}

fn but(needs: &Needs, heads: &[Module]) -> Needs {
    let mut needs = needs.clone();
    for head in heads {
        if let Some(own) = needs.get_mut(head) {
            own.retain(|file, _| !file.starts_with(head));
        }
    }
    needs
}

#[cfg(test)]
mod tests {
    use super::super::needs::by_hand;
    use super::*;

    /// Oracle: by hand: of a head only what is in its own folder is left out.
    #[test]
    fn a_head_may_list_its_folder() {
        let needs = by_hand(&[("a", "a::b"), ("a", "c"), ("a::b", "a"), ("c", "a::b")]);
        let mut expected = by_hand(&[("a", "c"), ("a::b", "a"), ("c", "a::b")]);
        expected.entry(module("a::b")).or_default();
        assert_eq!(but(&needs, &[module("a")]), expected);
    }
}
