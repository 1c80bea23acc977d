//! Location of the data files of a manifest.
//!
//! Looked for in this order; the first folder that holds a file of any pattern is taken:
//! 1. the folder given on the command line (then nowhere else);
//! 2. beside the manifest;
//! 3. `$ACM_SHARED/<table.folder>`;
//! 4. `../shared/<table.folder>` from the current directory.
//!
//! What is read lies below that folder, below the manifest's, or in the shared data: a link that leads elsewhere is refused,
//! so that a data set from another person shows nothing but its own files.

use std::path::{Path, PathBuf};

use crate::error::DataError;
use crate::ingest::recording::visible;
use crate::manifest::Manifest;

/// No recording needs more bytes in one file: reading takes a few times its size in memory.
pub const FILE_LIMIT: u64 = 4 << 30;

/// More files than this are a mistaken pattern.
pub const COUNT_LIMIT: usize = 20_000;

/// The data files of a set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DataFiles {
    /// The folder that holds them.
    pub folder: PathBuf,
    /// Paths relative to `folder`, sorted, each once.
    pub files: Vec<PathBuf>,
    /// Tables in the folder that no pattern matches.
    pub unmatched: Vec<PathBuf>,
    /// Tables in the folder that are compressed, and so match no pattern of tables.
    pub packed: Vec<PathBuf>,
}

/// Finds the data files.
///
/// # Errors
/// No folder has any of them: the message names every place that was looked at. A pattern that matches nothing in the
/// folder that was taken is among the `problems`.
pub fn locate(
    manifest: &Manifest,
    beside: &Path,
    given: Option<&Path>,
    problems: &mut Vec<DataError>,
) -> Result<DataFiles, DataError> {
    let places = places(manifest, beside, given);
    let found = places.iter().find(|(_, folder)| manifest.patterns().iter().any(|p| !matches(folder, p).is_empty()));
    let Some((_, folder)) = found else { return Err(missing(manifest, &places)) };
    let mut files = Vec::new();
    for pattern in &manifest.patterns() {
        let matched = matches(folder, pattern);
        if matched.is_empty() {
            problems.push(DataError::PatternWithoutFile { folder: folder.clone(), pattern: pattern.clone() });
        }
        files.extend(matched);
    }
    files.sort();
    files.dedup();
    if files.len() > COUNT_LIMIT {
        let message =
            format!("{}: the patterns match {} files, past the limit of {COUNT_LIMIT}", folder.display(), files.len());
        return Err(DataError::Usage(message + "; narrow `files` in [table]"));
    }
    let allowed = allowed(folder, beside);
    files.retain(|file| match strays(&folder.join(file), &allowed) {
        None => true,
        Some(target) => {
            let (path, folder) = (folder.join(file), folder.clone());
            problems.push(DataError::LeavesFolder { path, target, folder });
            false
        }
    });
    files.retain(|file| match file.to_string_lossy().contains(char::is_control) {
        false => true,
        true => {
            let (folder, name) = (folder.clone(), visible(&file.to_string_lossy()));
            problems.push(DataError::ControlInName { folder, name });
            false
        }
    });
    let (unmatched, packed) = (unmatched(manifest, folder, &files), packed(manifest, folder, &files));
    Ok(DataFiles { folder: folder.clone(), files, unmatched, packed })
}

/// Tables that no pattern matches, as warnings.
pub(crate) fn warnings(folder: &Path, unmatched: &[PathBuf], packed: &[PathBuf]) -> Vec<String> {
    let folder = folder.display();
    let strange = (!unmatched.is_empty()).then(|| {
        let names = names(unmatched);
        format!("{folder}: no pattern matches {names}; add a pattern to `files` or to `ignore` in [table]")
    });
    let compressed = (!packed.is_empty()).then(|| {
        let (names, verb) = (names(packed), if packed.len() == 1 { "is" } else { "are" });
        format!("{folder}: {names} {verb} compressed and not read; decompress, or add to `ignore` in [table]")
    });
    strange.into_iter().chain(compressed).collect()
}

/// The first ten of them, and how many more.
fn names(files: &[PathBuf]) -> String {
    let shown = files.iter().take(10).map(|f| visible(&f.to_string_lossy())).collect::<Vec<_>>().join(", ");
    if files.len() > 10 { format!("{shown} and {} more", files.len() - 10) } else { shown }
}

/// The folders below which data files may lie, without links.
fn allowed(folder: &Path, beside: &Path) -> Vec<PathBuf> {
    let shared = std::env::var_os("ACM_SHARED").map(PathBuf::from);
    let all = [Some(folder.to_path_buf()), Some(beside.to_path_buf()), shared, Some("../shared".into())];
    // the empty path is the current directory
    let real =
        |path: PathBuf| if path.as_os_str().is_empty() { Path::new(".").canonicalize() } else { path.canonicalize() };
    all.into_iter().flatten().filter_map(|path| real(path).ok()).collect()
}

/// Where a file leads to, if that is outside of all folders that are allowed.
fn strays(path: &Path, allowed: &[PathBuf]) -> Option<PathBuf> {
    let target = path.canonicalize().ok()?;
    (!allowed.iter().any(|folder| target.starts_with(folder))).then_some(target)
}

fn places(manifest: &Manifest, beside: &Path, given: Option<&Path>) -> Vec<(String, PathBuf)> {
    if let Some(folder) = given {
        return vec![("given on the command line".into(), folder.to_path_buf())];
    }
    let mut places = vec![("beside the manifest".to_string(), beside.to_path_buf())];
    if let Some(folder) = &manifest.table.folder {
        if let Some(shared) = std::env::var_os("ACM_SHARED") {
            places.push(("$ACM_SHARED".into(), Path::new(&shared).join(folder)));
        }
        places.push(("../shared".into(), Path::new("../shared").join(folder)));
    }
    places
}

/// Files of a pattern, relative to the folder.
pub(crate) fn matches(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    // the names that come back have no `./` in front
    let folder = folder.strip_prefix(".").unwrap_or(folder);
    let Some(root) = folder.to_str() else { return Vec::new() };
    let full = if root.is_empty() { pattern.to_string() } else { format!("{}/{pattern}", glob::Pattern::escape(root)) };
    let Ok(paths) = glob::glob(&full) else { return Vec::new() };
    let files = paths.filter_map(Result::ok).filter(|p| !p.is_dir());
    files.filter_map(|p| p.strip_prefix(folder).ok().map(Path::to_path_buf)).collect()
}

fn unmatched(manifest: &Manifest, folder: &Path, files: &[PathBuf]) -> Vec<PathBuf> {
    let ignored: Vec<PathBuf> = manifest.table.ignore.iter().flat_map(|p| matches(folder, p)).collect();
    let mut tables: Vec<PathBuf> = ["*.csv", "*.parquet"].iter().flat_map(|p| matches(folder, p)).collect();
    tables.sort();
    tables.retain(|t| files.binary_search(t).is_err() && !ignored.contains(t));
    tables
}

/// Compressed tables beside the others: `run.csv.gz`, `run.parquet.zst`.
fn packed(manifest: &Manifest, folder: &Path, files: &[PathBuf]) -> Vec<PathBuf> {
    let ignored: Vec<PathBuf> = manifest.table.ignore.iter().flat_map(|p| matches(folder, p)).collect();
    let table = |path: &PathBuf| {
        let within = path.file_stem().map(PathBuf::from).unwrap_or_default();
        let extension = within.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        crate::ingest::recording::packed(path).is_some()
            && ["csv", "tsv", "txt", "parquet"].contains(&extension.as_str())
    };
    let mut found = matches(folder, "*");
    found.retain(|path| table(path) && files.binary_search(path).is_err() && !ignored.contains(path));
    found.sort();
    found
}

fn missing(manifest: &Manifest, places: &[(String, PathBuf)]) -> DataError {
    let patterns = manifest.patterns().join(", ");
    let line = |(how, folder): &(String, PathBuf)| {
        let why = match folder.is_dir() {
            true => {
                let packed = packed(manifest, folder, &[]);
                let hint = if packed.is_empty() { String::new() } else { format!("; decompress {}", names(&packed)) };
                format!("no file matches {patterns}{hint}")
            }
            false => "no such folder".to_string(),
        };
        format!("  {} ({how}): {why}\n", folder.display())
    };
    let shared = match (&manifest.table.folder, std::env::var_os("ACM_SHARED")) {
        (Some(folder), None) if places.len() > 1 => format!("  $ACM_SHARED/{folder}: ACM_SHARED is not set\n"),
        _ => String::new(),
    };
    let obtain = match manifest.obtain.as_str() {
        "" => "put the files beside the manifest, or name their folder with --data DIR".to_string(),
        obtain => format!("to obtain them: {obtain}"),
    };
    let places = places.iter().map(line).collect::<String>() + &shared;
    DataError::MissingData { name: manifest.name.clone(), places, obtain }
}
