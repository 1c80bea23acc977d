//! The structure that every crate of the workspace keeps.
//!
//! | check | what |
//! | --- | --- |
//! | [`circles`] | no files need each other in a circle |
//! | [`floors`] | a file of acm-train needs files of its own floor and of those below it |
//! | [`folders`] | no folder holds more than fifteen files of its own |
//! | [`members`] | ARCHITECTURE.md says how many crates there are |
//!
//! File A needs file B where A names an item that is defined in B. A re-export is followed to the file that defines the item;
//! it is no need of the file that it stands in, and neither is a `mod`. Tests (`#[cfg(test)]`) do not count. What is called as
//! a method, and what a macro makes of names that it is not given as paths, is not seen.

mod circles;
pub mod files;
mod floors;
mod folders;
mod heads;
mod members;
mod module;
mod names;
mod needs;
mod resolve;
pub mod source;

use std::path::{Path, PathBuf};

use files::{StructureError, entries, read};

/// Returns the faults of the workspace in `root`, one line each.
pub fn complaints(root: &Path) -> Result<Vec<String>, StructureError> {
    let crates = crates(root)?;
    let mut all = Vec::from_iter(members::complaints(&read(&root.join("ARCHITECTURE.md"))?, crates.len()));
    for name in &crates {
        let folder = root.join(name).join("src");
        let needs = needs::needs(&source::files(&folder)?);
        all.extend(circles::complaints(name, &heads::without(name, &needs)));
        all.extend(floors::complaints(name, &needs));
        all.extend(folders::complaints(root, &folder)?);
    }
    Ok(all)
}

/// Returns the folders with a manifest and sources, in order.
pub fn crates(root: &Path) -> Result<Vec<String>, StructureError> {
    let is_crate = |path: &PathBuf| path.join("Cargo.toml").is_file() && path.join("src").is_dir();
    let found = entries(root)?.into_iter().filter(is_crate);
    Ok(found.filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned())).collect())
}
