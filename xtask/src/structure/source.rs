//! The files of a crate: `src/a/b.rs` and `src/a/b/mod.rs` are `a::b`, `lib.rs` and `main.rs` are both the root.

use std::collections::BTreeMap;
use std::path::Path;

use super::files::{StructureError, entries, is_rust, read};
use super::module::Module;
use super::names::Names;

/// Returns the definitions, imports and names of each module of a crate, without files for tests alone.
pub fn files(src: &Path) -> Result<BTreeMap<Module, Names>, StructureError> {
    let mut files: BTreeMap<Module, Names> = BTreeMap::new();
    texts(src)?.into_iter().for_each(|file| files.entry(file.module).or_default().join(file.names));
    Ok(files)
}

/// One file of a crate.
pub struct File {
    pub module: Module,
    pub text: String,
    pub names: Names,
}

/// The files of a crate, without those for tests alone.
pub fn texts(src: &Path) -> Result<Vec<File>, StructureError> {
    let mut files: Vec<File> = vec![];
    let mut folders = vec![src.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for path in entries(&folder)? {
            if path.is_dir() {
                folders.push(path);
            } else if is_rust(&path) {
                let module = module(src, &path);
                let text = read(&path)?;
                let names = Names::new(&module, &text);
                let names = names.map_err(|source| StructureError::Parse { path, source })?;
                files.push(File { module, names, text });
            }
        }
    }
    let tests: Vec<Module> = files.iter().flat_map(|file| file.names.tests.clone()).collect();
    files.retain(|file| !tests.iter().any(|test| file.module.starts_with(test)));
    Ok(files)
}

/// Returns the module that a file is.
fn module(src: &Path, file: &Path) -> Module {
    let below = file.strip_prefix(src).unwrap_or(file).with_extension("");
    let mut names: Module = below.iter().map(|name| name.to_string_lossy().into_owned()).collect();
    let is_root = |name: &String| names.len() == 1 && ["lib", "main"].contains(&name.as_str());
    if names.last().is_some_and(|name| name == "mod" || is_root(name)) {
        names.pop();
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the rules of the language, by hand.
    #[test]
    fn a_file_is_the_module_that_its_path_says() {
        let of = |path: &str| module(Path::new("src"), &Path::new("src").join(path)).join("::");
        let cases = [("lib.rs", ""), ("main.rs", ""), ("a.rs", "a"), ("a/mod.rs", "a"), ("a/lib.rs", "a::lib")];
        assert!(cases.iter().all(|(path, module)| of(path) == *module));
    }
}
