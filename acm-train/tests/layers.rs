//! The six layers of this crate: a file imports from layers below its own, and within its layer without a cycle.
//!
//! ```text
//! store < config < learn < run < schedule < cli < main, lib
//! ```
//!
//! What is read is the text of `src`: every `use crate::…` and `use super::…`, and every `crate::…` and `super::…` within code.
//! A `mod` counts as an import, so that no file imports from the root of its own layer, which lists them all. Comments and
//! what follows the first `#[cfg(test)]`, its tests, do not count. What is called as a method is not seen.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// From the lowest up.
const LAYERS: [&str; 6] = ["store", "config", "learn", "run", "schedule", "cli"];

/// Names of a module, from the root of the crate.
type Module = Vec<String>;

#[test]
fn a_file_imports_from_layers_below_its_own() {
    let files = files();
    assert!(files.len() > 100, "only {} files were read", files.len());
    let wrong: Vec<String> =
        edges(&files).into_iter().filter(|(from, to)| layer(to) > layer(from)).map(arrow).collect();
    assert!(wrong.is_empty(), "these go up:\n{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let edges = edges(&files());
    let back = edges.iter().filter(|(from, to)| reached(to, &edges).contains(from)).cloned();
    let circles: Vec<String> = back.map(arrow).collect();
    assert!(circles.is_empty(), "these import each other in a cycle:\n{}", circles.join("\n"));
}

#[test]
fn every_file_is_in_a_layer() {
    for module in files().keys().filter(|module| !module.is_empty()) {
        assert!(LAYERS.contains(&module[0].as_str()), "{} is in no layer", module.join("::"));
    }
}

/// Oracle: by hand.
#[test]
fn paths_are_found_as_rust_reads_them() {
    let module = |path: &str| path.split("::").map(String::from).collect::<Module>();
    let text = "use crate::{a::{self, B}, c::D as E};\nuse super::f;\n// crate::no\nfn g() { super::super::h::i(); }\n\
                use std::fs;\npub(super) mod o;\n#[cfg(test)]\nmod tests { use crate::no; }\n";
    let found: BTreeSet<Module> = paths(text, &module("m::n")).into_iter().collect();
    let expected = ["a", "a::B", "c::D", "m::f", "h::i", "m::n::o"].map(module);
    assert_eq!(found, expected.into_iter().collect());
}

/// Text by module; `lib.rs` and `main.rs` are the root, which is above all layers.
fn files() -> BTreeMap<Module, String> {
    let root = std::path::absolute("src").unwrap();
    let mut folders = vec![root.clone()];
    let mut files = BTreeMap::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => {
                    // `lib.rs` and `main.rs` are both the root.
                    let text: &mut String = files.entry(module(&root, &path)).or_default();
                    text.push_str(&fs::read_to_string(&path).unwrap());
                }
            }
        }
    }
    files
}

fn module(root: &Path, file: &Path) -> Module {
    let below: PathBuf = file.strip_prefix(root).unwrap().with_extension("");
    let names = below.iter().map(|name| name.to_str().unwrap().to_string());
    names.filter(|name| !["mod", "lib", "main"].contains(&name.as_str())).collect()
}

/// Which layer a module is on; the root is above them.
fn layer(module: &Module) -> usize {
    module.first().map_or(LAYERS.len(), |name| LAYERS.iter().position(|layer| layer == name).unwrap_or(LAYERS.len()))
}

/// Each file with each other that it names.
fn edges(files: &BTreeMap<Module, String>) -> BTreeSet<(Module, Module)> {
    let of = |(from, text): (&Module, &String)| {
        let named = paths(text, from).into_iter().map(|path| file_of(path, files));
        named.filter(|to| to != from).map(|to| (from.clone(), to)).collect::<Vec<_>>()
    };
    files.iter().flat_map(of).collect()
}

/// All files that one imports, and those that they import.
fn reached(start: &Module, edges: &BTreeSet<(Module, Module)>) -> BTreeSet<Module> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![start.clone()]);
    while let Some(file) = open.pop() {
        if seen.insert(file.clone()) {
            open.extend(edges.iter().filter(|(from, _)| *from == file).map(|(_, to)| to.clone()));
        }
    }
    seen
}

/// The file that a path ends in; what follows is an item of it.
fn file_of(mut path: Module, files: &BTreeMap<Module, String>) -> Module {
    while !files.contains_key(&path) {
        path.pop();
    }
    path
}

/// All paths within the crate that a text names.
fn paths(text: &str, module: &Module) -> Vec<Module> {
    let code = text.split("\n#[cfg(test)]\n").next().unwrap_or_default();
    let code: String =
        code.lines().map(|line| line.split("//").next().unwrap_or_default().to_string() + "\n").collect();
    let mut found = vec![];
    for root in ["crate::", "super::"] {
        for (start, _) in code.match_indices(root) {
            let before = code[..start].chars().next_back().unwrap_or(' ');
            if !before.is_alphanumeric() && !['_', ':'].contains(&before) {
                found.extend(leaves(&code[start..]));
            }
        }
    }
    let children = code.lines().filter_map(|line| Some(line.strip_suffix(';')?.rsplit_once("mod ")?.1.to_string()));
    let children = children.map(|name| [module.as_slice(), &[name]].concat());
    found.into_iter().map(|path| absolute(&path, module)).chain(children).collect()
}

/// `a::{b, c::{self, d}}` is `a::b`, `a::c` and `a::c::d`.
fn leaves(text: &str) -> Vec<Module> {
    let end = text.find(|c: char| !c.is_alphanumeric() && !['_', ':'].contains(&c)).unwrap_or(text.len());
    let names =
        |path: &str| path.split("::").filter(|name| !name.is_empty() && *name != "self").map(String::from).collect();
    let stem: Module = names(&text[..end]);
    if !text[..end].ends_with("::") || !text[end..].starts_with('{') {
        return vec![stem];
    }
    let below = branches(&text[end + 1..]).into_iter().flat_map(|branch| leaves(branch.trim_start()));
    below.map(|path| [stem.clone(), path].concat()).collect()
}

/// The parts between commas up to the brace that closes, without those that are empty.
fn branches(text: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, vec![]);
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    parts.retain(|part| !part.trim().is_empty());
    parts
}

/// A path from the root of the crate.
fn absolute(path: &[String], module: &Module) -> Module {
    let ups = path.iter().take_while(|name| *name == "super").count();
    let base = if path[0] == "crate" { &[][..] } else { &module[..module.len().saturating_sub(ups)] };
    let rest = if path[0] == "crate" { &path[1..] } else { &path[ups..] };
    [base, rest].concat()
}

fn arrow((from, to): (Module, Module)) -> String {
    let name = |module: &Module| if module.is_empty() { "the root".into() } else { module.join("::") };
    format!("{} → {}", name(&from), name(&to))
}
