//! What a run folder holds, byte for byte, as far as two runs of one question must agree.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// Every file below a folder by its path there. The lock says who held the folder and is left out; of a record, the time it
/// took and the hash over it.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    collect(folder, folder, &mut found);
    found
}

fn collect(root: &Path, folder: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        let lock = path.file_name().is_some_and(|name| name == ".lock");
        match path.is_dir() {
            true => collect(root, &path, found),
            false if lock => {}
            false => {
                let bytes = timeless(&path, fs::read(&path).unwrap());
                found.insert(path.strip_prefix(root).unwrap().into(), bytes);
            }
        }
    }
}

fn timeless(path: &Path, bytes: Vec<u8>) -> Vec<u8> {
    if path.extension().is_none_or(|extension| extension != "json") {
        return bytes;
    }
    let text = String::from_utf8(bytes).unwrap_or_else(|_| panic!("{} is no text", path.display()));
    let of_time = |line: &&str| ["\"seconds\":", "\"sha256\":"].iter().any(|key| line.trim_start().starts_with(key));
    text.lines().filter(|line| !of_time(line)).collect::<Vec<_>>().join("\n").into_bytes()
}

/// The first difference of two folders, in words.
pub fn difference(a: &BTreeMap<PathBuf, Vec<u8>>, b: &BTreeMap<PathBuf, Vec<u8>>) -> Option<String> {
    let names: std::collections::BTreeSet<&PathBuf> = a.keys().chain(b.keys()).collect();
    names.into_iter().find_map(|name| match (a.get(name), b.get(name)) {
        (Some(one), Some(other)) if one == other => None,
        (Some(one), Some(other)) => {
            let at = one.iter().zip(other).position(|(x, y)| x != y).unwrap_or(one.len().min(other.len()));
            Some(format!("{} differs from byte {at}", name.display()))
        }
        (Some(_), None) => Some(format!("{} is missing", name.display())),
        (None, _) => Some(format!("{} is too many", name.display())),
    })
}
