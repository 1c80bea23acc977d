//! Folders that hold so many files that their listing explains nothing.

use std::path::Path;

use super::files::{StructureError, entries, is_rust};

/// Files that a folder may hold; those of its folders are their own.
const MOST: usize = 15;

/// Describes each folder below `folder` that holds too many files, by its path from `root`.
pub fn complaints(root: &Path, folder: &Path) -> Result<Vec<String>, StructureError> {
    let entries = entries(folder)?;
    let files = entries.iter().filter(|path| is_rust(path)).count();
    let shown = folder.strip_prefix(root).unwrap_or(folder).display().to_string();
    let mut all =
        Vec::from_iter((files > MOST).then(|| format!("{shown}: {files} files; at most {MOST}, or sub-modules in it")));
    for inner in entries.iter().filter(|path| path.is_dir()) {
        all.extend(complaints(root, inner)?);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Oracle: by hand: 16 files are too many, 15 and a folder of 15 are not.
    #[test]
    fn a_folder_counts_its_own_files() {
        let root = std::env::temp_dir().join(format!("xtask-folders-{}", std::process::id()));
        let inner = root.join("src/inner");
        fs::create_dir_all(&inner).unwrap();
        for k in 0..MOST {
            fs::write(root.join(format!("src/f{k}.rs")), "").unwrap();
            fs::write(inner.join(format!("f{k}.rs")), "").unwrap();
        }
        let found = complaints(&root, &root.join("src")).unwrap();
        fs::write(inner.join("one_more.rs"), "").unwrap();
        let more = complaints(&root, &root.join("src")).unwrap();
        fs::remove_dir_all(&root).unwrap();
        assert_eq!(found, Vec::<String>::new());
        assert_eq!(more, ["src/inner: 16 files; at most 15, or sub-modules in it"]);
    }
}
