//! Resolution of a path to the file that defines its item: imports and re-exports are followed to their end.

use std::collections::BTreeMap;

use super::module::Module;
use super::names::{Names, Place};

/// The files of a crate by their modules.
pub type Files = BTreeMap<Module, Names>;

/// Largest number of imports that are followed one after the other. Imports of a correct program have no cycles, but
/// globs may have, and branch: each divides what is left by four.
const DEEPEST: usize = 16;

/// Returns the file that defines the item at a place; none where that is a module or stands in another crate.
pub fn definition(files: &Files, place: &Place) -> Option<Module> {
    from_place(files, place, DEEPEST)
}

fn from_place(files: &Files, place: &Place, deepest: usize) -> Option<Module> {
    let first = place.path.first()?;
    let ups = place.path.iter().take_while(|name| *name == "super").count();
    if first == "crate" {
        from_root(files, &place.path[1..], deepest)
    } else if first == "self" {
        from_root(files, &[&place.module, &place.path[1..]].concat(), deepest)
    } else if ups > 0 {
        let base = &place.module[..place.module.len().saturating_sub(ups)];
        from_root(files, &[base, &place.path[ups..]].concat(), deepest)
    } else {
        relative(files, place, deepest)
    }
}

/// Returns a path without `crate`, `self` or `super`: of an item or a module here, or of another crate.
fn relative(files: &Files, place: &Place, deepest: usize) -> Option<Module> {
    let path = [place.module.as_slice(), &place.path].concat();
    let (file, rest) = split(files, &path);
    let is_child = file.len() > place.module.len();
    let knows = |names: &Names, name: &String| names.defined.contains(name) || names.imported.contains_key(name);
    let is_here = files.get(&file).zip(rest.first()).is_some_and(|(names, name)| knows(names, name));
    if is_child || is_here { from_root(files, &path, deepest) } else { through_globs(files, &file, rest, deepest) }
}

/// Returns a path from the root of the crate.
fn from_root(files: &Files, path: &[String], deepest: usize) -> Option<Module> {
    let (file, rest) = split(files, path);
    let name = rest.first()?;
    let names = files.get(&file)?;
    if names.defined.contains(name) || deepest == 0 {
        return Some(file);
    }
    match names.imported.get(name) {
        Some(place) => {
            let path = [place.path.as_slice(), &rest[1..]].concat();
            from_place(files, &Place { path, module: place.module.clone() }, deepest - 1)
        }
        // What is neither defined nor imported, a macro made.
        None => through_globs(files, &file, rest, deepest).or(Some(file)),
    }
}

/// Returns an item that a file has by `use …::*`.
fn through_globs(files: &Files, file: &Module, rest: &[String], deepest: usize) -> Option<Module> {
    let name = rest.first()?;
    let globs = &files.get(file)?.globs;
    globs.iter().filter(|_| deepest > 0).find_map(|glob| {
        let path = [glob.path.as_slice(), rest].concat();
        let found = from_place(files, &Place { path, module: glob.module.clone() }, deepest / 4)?;
        files.get(&found)?.defined.contains(name).then_some(found)
    })
}

/// Returns the file that a path leads into, and what follows.
fn split<'p>(files: &Files, path: &'p [String]) -> (Module, &'p [String]) {
    let length = (0..=path.len()).rev().find(|&length| files.contains_key(&path[..length])).unwrap_or(0);
    (path[..length].to_vec(), &path[length..])
}

#[cfg(test)]
mod tests {
    use super::super::module::module;
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn a_re_export_is_followed_to_the_file_that_defines() {
        let texts = [
            ("", "mod a; mod b; pub use a::{Item, other::*}; make_items!{}"),
            ("a", "mod other; pub use other::Item; pub fn own() {}"),
            ("a::other", "pub struct Item; pub enum Many { One } mod inner { pub fn deep() {} }"),
            ("b", "use std::fs; use crate::a; use crate::Many::{self, *}; fn here() {}"),
        ];
        let file = |(path, text): (&str, &str)| (module(path), Names::new(&module(path), text).unwrap());
        let files: Files = texts.into_iter().map(file).collect();
        let of = |path: &str| {
            let place = Place { path: module(path), module: module("b") };
            definition(&files, &place).map(|file| file.join("::"))
        };
        let cases = [
            ("crate::Item", Some("a::other")),
            ("crate::Item::new", Some("a::other")),
            ("super::Many::One", Some("a::other")),
            ("Many::One", Some("a::other")),
            ("a::own", Some("a")),
            ("a::Item", Some("a::other")),
            ("crate::a::other::inner::deep", Some("a::other")),
            ("here", Some("b")),
            ("self::here", Some("b")),
            ("crate::Made", Some("")),
            ("crate::a", None),
            ("a", None),
            ("fs::read", None),
            ("serde::Serialize", None),
            ("value", None),
        ];
        cases.iter().for_each(|(path, file)| assert_eq!(of(path).as_deref(), *file, "{path}"));
    }
}
