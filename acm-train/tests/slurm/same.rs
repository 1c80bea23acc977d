//! Whether two folders of runs are the same: every file, byte for byte, but for what is of one of them alone (locks, and
//! what Slurm was told) and the wall-clock time in records, whose hash is over that too.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// Files that differ or are in one folder alone.
pub fn differences(one: &Path, other: &Path) -> Vec<String> {
    let (one, other) = (files(one), files(other));
    let names = one.keys().chain(other.keys());
    let mut differing: Vec<String> =
        names.filter(|name| one.get(*name) != other.get(*name)).map(|name| name.display().to_string()).collect();
    differing.dedup();
    differing
}

/// Records below a folder of runs.
pub fn records(folder: &Path) -> Vec<PathBuf> {
    let is_record = |path: &PathBuf| path.parent().is_some_and(|parent| parent.ends_with("records"));
    paths(folder).into_iter().filter(|path| is_record(path) && path.extension().is_some_and(|e| e == "json")).collect()
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let inside = |path: PathBuf| {
        let name = path.strip_prefix(folder).unwrap().to_path_buf();
        let own = name.starts_with("slurm") || name.file_name().is_some_and(|name| name == ".lock");
        (!own).then(|| (name, timeless(&path)))
    };
    paths(folder).into_iter().filter_map(inside).collect()
}

fn timeless(path: &Path) -> Vec<u8> {
    let bytes = fs::read(path).unwrap();
    if !path.parent().is_some_and(|parent| parent.ends_with("records")) {
        return bytes;
    }
    let text = String::from_utf8(bytes).unwrap();
    let timed = |line: &&str| !line.starts_with("  \"seconds\":") && !line.starts_with("  \"sha256\":");
    text.lines().filter(timed).collect::<Vec<_>>().join("\n").into_bytes()
}

fn paths(folder: &Path) -> Vec<PathBuf> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        match entry.file_type() {
            Ok(kind) if kind.is_dir() => found.extend(paths(&entry.path())),
            _ => found.push(entry.path()),
        }
    }
    found.sort();
    found
}
