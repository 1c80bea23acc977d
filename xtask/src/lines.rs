//! Lines of code of each crate: those of `src` that are neither blank, nor a comment, nor in an item for tests alone.

use std::path::Path;

use syn::visit::{self, Visit};
use syn::{Attribute, File, Item, Meta};

use crate::structure::files::StructureError;
use crate::structure::{crates, source};

/// A line for each crate of the workspace in `root`, and their sum.
///
/// # Errors
/// A file that cannot be read, or is no Rust.
pub fn table(root: &Path) -> Result<Vec<String>, StructureError> {
    let mut counted = vec![];
    for name in crates(root)? {
        let files = source::texts(&root.join(&name).join("src"))?;
        let lines: usize = files.iter().map(|file| count(&file.text)).sum();
        counted.push((name, lines));
    }
    let sum = counted.iter().map(|(_, lines)| lines).sum();
    counted.push(("all".into(), sum));
    Ok(counted.into_iter().map(|(name, lines)| format!("{lines:>7}  {name}")).collect())
}

/// Lines of code of a file.
fn count(text: &str) -> usize {
    let mut tests = Tests::default();
    syn::parse_file(text).into_iter().for_each(|file: File| tests.visit_file(&file));
    let is_code = |(at, line): &(usize, &str)| {
        let line = line.trim();
        !(line.is_empty() || line.starts_with("//") || tests.0.iter().any(|[from, to]| (*from..=*to).contains(at)))
    };
    (1..).zip(text.lines()).filter(is_code).count()
}

/// First and last lines of items for tests alone.
#[derive(Default)]
struct Tests(Vec<[usize; 2]>);

impl Visit<'_> for Tests {
    fn visit_item(&mut self, item: &Item) {
        let attributes: &[Attribute] = match item {
            Item::Mod(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            Item::Const(item) => &item.attrs,
            Item::Struct(item) => &item.attrs,
            _ => &[],
        };
        if attributes.iter().any(is_for_tests) {
            let span = syn::spanned::Spanned::span(item);
            self.0.push([span.start().line, span.end().line]);
        } else {
            visit::visit_item(self, item);
        }
    }
}

/// `#[cfg(test)]`.
fn is_for_tests(attribute: &Attribute) -> bool {
    let Meta::List(list) = &attribute.meta else { return false };
    list.path.is_ident("cfg") && list.tokens.to_string() == "test"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn comments_blanks_and_tests_do_not_count() {
        let text = "//! Head.\n\nuse a::b;\n\n/// A number.\nfn one() -> u8 {\n    // One.\n    1 // one\n}\n\n\
                    #[cfg(test)]\nmod tests {\n    fn two() {}\n}\n\nmod inner {\n    #[cfg(test)]\n    use c::d;\n}\n";
        assert_eq!(count(text), 6);
        assert_eq!(count("#[cfg(feature = \"test\")]\nfn one() {}\n"), 2);
    }
}
