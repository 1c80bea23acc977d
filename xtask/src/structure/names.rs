//! Names in a file: the items that it defines, what it imports, and the paths that it uses.
//!
//! Paths are read from the syntax tree, and within macros and attributes from runs of `a::b::c`; of attributes also strings that
//! are paths, as in `#[serde(with = "a::b")]`.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};

use super::module::Module;

/// A path as it stands in a file, and the module that it stands in: that of the file, or one within it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Path as written.
    pub path: Vec<String>,
    /// Module from the root of the crate.
    pub module: Module,
}

/// Names that a file defines, imports and uses; see the head of this file.
#[derive(Debug, Default)]
pub struct Names {
    /// Items at the top of the file and of the modules within it.
    pub defined: BTreeSet<String>,
    /// Target of each imported or re-exported name.
    pub imported: BTreeMap<String, Place>,
    /// Targets of `use …::*`.
    pub globs: Vec<Place>,
    /// Paths in code, and imports that are no re-exports.
    pub used: BTreeSet<Place>,
    /// Modules in files of their own that only tests have.
    pub tests: Vec<Module>,
}

impl Names {
    /// Reads the names in the text of a module.
    pub fn new(module: &Module, text: &str) -> Result<Self, syn::Error> {
        let mut reader = Reader { module: module.clone(), ..Reader::default() };
        reader.visit_file(&syn::parse_file(text)?);
        let Reader { mut names, bound, .. } = reader;
        names.used.retain(|place| place.path.len() > 1 || !bound.contains(&place.path[0]));
        Ok(names)
    }

    /// Adds the names of another file of the same module.
    pub fn join(&mut self, other: Self) {
        self.defined.extend(other.defined);
        self.imported.extend(other.imported);
        self.globs.extend(other.globs);
        self.used.extend(other.used);
        self.tests.extend(other.tests);
    }
}

#[derive(Default)]
struct Reader {
    names: Names,
    module: Module,
    is_within_item: bool,
    /// Variables and parameters: such a name alone is no item.
    bound: BTreeSet<String>,
}

impl Reader {
    fn place(&self, path: Vec<String>) -> Place {
        Place { path, module: self.module.clone() }
    }

    fn uses(&mut self, path: Vec<String>) {
        let place = self.place(path);
        self.names.used.insert(place);
    }

    /// Records every leaf of `use a::{b, c as d, e::*}`.
    fn import(&mut self, tree: &syn::UseTree, stem: &[String], is_reexport: bool) {
        let join = |name: &syn::Ident| [stem, &[name.to_string()]].concat();
        let (path, name) = match tree {
            syn::UseTree::Path(path) => return self.import(&path.tree, &join(&path.ident), is_reexport),
            syn::UseTree::Group(group) => {
                return group.items.iter().for_each(|tree| self.import(tree, stem, is_reexport));
            }
            syn::UseTree::Glob(_) => (stem.to_vec(), None),
            syn::UseTree::Name(name) if name.ident == "self" => (stem.to_vec(), stem.last().cloned()),
            syn::UseTree::Name(name) => (join(&name.ident), Some(name.ident.to_string())),
            syn::UseTree::Rename(name) if name.ident == "self" => (stem.to_vec(), Some(name.rename.to_string())),
            syn::UseTree::Rename(name) => (join(&name.ident), Some(name.rename.to_string())),
        };
        if !is_reexport {
            self.uses(path.clone());
        }
        let place = self.place(path);
        match name {
            Some(name) => drop(self.names.imported.insert(name, place)),
            None => self.names.globs.push(place),
        }
    }

    /// Records paths among tokens; strings that are paths only where `with_strings`.
    fn tokens(&mut self, tokens: TokenStream, with_strings: bool) {
        let mut path: Vec<String> = vec![];
        let mut colons = 0;
        for token in tokens {
            match &token {
                TokenTree::Ident(name) if colons == 2 || path.is_empty() => path.push(name.to_string()),
                TokenTree::Punct(mark) if mark.as_char() == ':' && colons < 2 && !path.is_empty() => {
                    colons += 1;
                    continue;
                }
                other => {
                    self.uses_some(&mut path);
                    match other {
                        TokenTree::Ident(name) => path.push(name.to_string()),
                        TokenTree::Group(group) => self.tokens(group.stream(), with_strings),
                        TokenTree::Literal(literal) if with_strings => self.string(&literal.to_string()),
                        _ => (),
                    }
                }
            }
            colons = 0;
        }
        self.uses_some(&mut path);
    }

    fn uses_some(&mut self, path: &mut Vec<String>) {
        if !path.is_empty() {
            self.uses(std::mem::take(path));
        }
    }

    /// Records a string that is a path.
    fn string(&mut self, literal: &str) {
        let inner = literal.trim_matches('"');
        if let Ok(path) = syn::parse_str::<syn::Path>(inner) {
            self.visit_path(&path);
        }
    }
}

impl<'a> Visit<'a> for Reader {
    fn visit_item(&mut self, item: &'a syn::Item) {
        if is_for_tests(attributes(item)) {
            if let syn::Item::Mod(inner) = item {
                self.names.tests.extend(inner.content.is_none().then(|| inside(&self.module, &inner.ident)));
            }
            return;
        }
        if let (false, Some(name)) = (self.is_within_item, name(item)) {
            self.names.defined.insert(name.to_string());
        }
        let outside = std::mem::replace(&mut self.is_within_item, !matches!(item, syn::Item::Mod(_)));
        visit::visit_item(self, item);
        self.is_within_item = outside;
    }

    fn visit_item_mod(&mut self, item: &'a syn::ItemMod) {
        let outer = self.module.clone();
        self.module = inside(&outer, &item.ident);
        visit::visit_item_mod(self, item);
        self.module = outer;
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        self.import(&item.tree, &[], !matches!(item.vis, syn::Visibility::Inherited));
    }

    fn visit_impl_item(&mut self, item: &'a syn::ImplItem) {
        let attributes = match item {
            syn::ImplItem::Fn(item) => &item.attrs,
            syn::ImplItem::Const(item) => &item.attrs,
            _ => &vec![],
        };
        if !is_for_tests(attributes) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_pat_ident(&mut self, pattern: &'a syn::PatIdent) {
        self.bound.insert(pattern.ident.to_string());
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.leading_colon.is_none() {
            self.uses(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'a syn::Macro) {
        self.uses(call.path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        self.tokens(call.tokens.clone(), false);
    }

    fn visit_attribute(&mut self, attribute: &'a syn::Attribute) {
        if let syn::Meta::List(list) = &attribute.meta {
            self.tokens(list.tokens.clone(), true);
        }
    }
}

/// Returns a module within another.
fn inside(module: &Module, name: &syn::Ident) -> Module {
    [module.as_slice(), &[name.to_string()]].concat()
}

/// Returns whether `#[cfg(test)]` stands above an item.
fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    let is_test = |attribute: &syn::Attribute| match &attribute.meta {
        syn::Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        _ => false,
    };
    attributes.iter().any(is_test)
}

fn attributes(item: &syn::Item) -> &[syn::Attribute] {
    match item {
        syn::Item::Const(item) => &item.attrs,
        syn::Item::Enum(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        syn::Item::Macro(item) => &item.attrs,
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Static(item) => &item.attrs,
        syn::Item::Struct(item) => &item.attrs,
        syn::Item::Trait(item) => &item.attrs,
        syn::Item::Type(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Returns the name of an item that a path can end in.
fn name(item: &syn::Item) -> Option<&syn::Ident> {
    match item {
        syn::Item::Const(item) => Some(&item.ident),
        syn::Item::Enum(item) => Some(&item.ident),
        syn::Item::Fn(item) => Some(&item.sig.ident),
        syn::Item::Macro(item) => item.ident.as_ref(),
        syn::Item::Mod(item) if item.content.is_some() => Some(&item.ident),
        syn::Item::Static(item) => Some(&item.ident),
        syn::Item::Struct(item) => Some(&item.ident),
        syn::Item::Trait(item) => Some(&item.ident),
        syn::Item::Type(item) => Some(&item.ident),
        syn::Item::Union(item) => Some(&item.ident),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::module::module;
    use super::*;

    const TEXT: &str = "use crate::{a::{self, B}, c::D as E};\npub use super::f;\n// crate::no\n\
        #[serde(with = \"crate::text\", default)]\nstruct S { of: T }\n\
        fn g(l: T) { super::h::i(vec![a::j, k], l); }\nuse super::p::*;\nmod o;\nmod q { use super::r; }\n\
        #[cfg(test)]\nmod bench;\n#[cfg(test)]\nmod tests { use crate::no; }\n";

    fn names() -> Names {
        Names::new(&module("m::n"), TEXT).unwrap()
    }

    /// Oracle: by hand.
    #[test]
    fn paths_are_found_as_rust_reads_them() {
        let used: BTreeSet<String> = names().used.iter().map(|place| place.path.join("::")).collect();
        let expected = [
            "T",
            "a::j",
            "crate::a",
            "crate::a::B",
            "crate::c::D",
            "crate::text",
            "default",
            "k",
            "super::h::i",
            "super::p",
            "super::r",
            "vec",
            "with",
        ];
        assert_eq!(used.into_iter().collect::<Vec<_>>(), expected);
    }

    /// Oracle: by hand.
    #[test]
    fn items_and_imports_have_their_names() {
        let names = names();
        let place = |path: &str, at: &str| Place { path: module(path), module: module(at) };
        let imported = [
            ("B", "crate::a::B", "m::n"),
            ("E", "crate::c::D", "m::n"),
            ("a", "crate::a", "m::n"),
            ("f", "super::f", "m::n"),
            ("r", "super::r", "m::n::q"),
        ];
        let imported = imported.map(|(name, path, at)| (name.to_string(), place(path, at)));
        assert_eq!(names.imported.into_iter().collect::<Vec<_>>(), imported);
        assert_eq!(names.defined.into_iter().collect::<Vec<_>>(), ["S", "g", "q"]);
        assert_eq!(names.globs, [place("super::p", "m::n")]);
        assert_eq!(names.tests, [module("m::n::bench")]);
    }
}
