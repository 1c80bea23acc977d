//! Ownership of result folders: results replace earlier results, and nothing else.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use acm_datasets::files::atomic::DRAFT_PREFIX;

/// Returns the first entry of a folder that is none of `own`; drafts that a process left behind count as absent.
///
/// # Errors
/// The folder cannot be read.
pub fn first_foreign(folder: &Path, own: impl Fn(&str) -> bool) -> io::Result<Option<String>> {
    let mut names = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.file_name().to_string_lossy().into_owned()))
        .collect::<io::Result<Vec<_>>>()?;
    names.sort();
    Ok(names.into_iter().find(|name| !name.starts_with(DRAFT_PREFIX) && !own(name)))
}

/// Returns the data set that a folder is, or lies in. The current directory and those above it are not checked: whoever
/// works in a data set may have results below it.
pub fn data_set(folder: &Path) -> Option<PathBuf> {
    let place = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
    let here = std::env::current_dir().unwrap_or_default();
    let above = place.ancestors().skip(1).take_while(|above| !here.starts_with(above));
    let mut all = std::iter::once(place.as_path()).chain(above);
    all.find(|above| above.join("manifest.toml").is_file()).map(Path::to_path_buf)
}
