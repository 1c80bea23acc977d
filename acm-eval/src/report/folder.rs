//! The folder of a report.
//!
//! ```text
//! OUT/report.json   what the report consists of, so that the next one in its place leaves nothing of it behind
//! OUT/report.html
//! OUT/figures/      .svg and .png, and .csv of lines and dots
//! OUT/tables/       .csv and .tex
//! ```
//!
//! A report takes the place of an earlier one, and of nothing else: a folder that holds anything else is left alone, and so is
//! a data set. Reports that have no `report.json` are known by their page and by having nothing else beside it.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, ErrorKind, Write},
    path::{Component, Path, PathBuf},
};

use acm_datasets::files::{atomic::replace, regular};
use serde::{Deserialize, Serialize};

use crate::{error::EvalError, ownership};

const LIST: &str = "report.json";
/// Name of the page.
pub const PAGE: &str = "report.html";
/// Folders of a report, with the extensions of their files.
const FOLDERS: [(&str, &[&str]); 2] = [("figures", &["svg", "png", "csv"]), ("tables", &["csv", "tex"])];
/// Name of the program in every list, and on every page.
const MAKER: &str = "acm-eval report";

/// A folder that a report may be written to.
#[derive(Debug)]
pub struct ReportFolder {
    root: PathBuf,
    /// Files of the earlier report, relative to the folder.
    former: BTreeSet<String>,
    written: BTreeSet<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct List {
    made_by: String,
    files: BTreeSet<String>,
}

impl ReportFolder {
    /// Makes the folder if need be.
    ///
    /// # Errors
    /// It holds something else than a report, lies in a data set, or cannot be read or made; nothing is written then.
    pub fn claim(root: &Path) -> Result<Self, EvalError> {
        if let Some(set) = ownership::data_set(root) {
            return Err(foreign(root, format!("{} is a data set", set.display())));
        }
        let former = if root.is_dir() { former(root)? } else { BTreeSet::new() };
        let folder = Self { root: root.into(), former, written: BTreeSet::new() };
        for name in std::iter::once("").chain(FOLDERS.map(|(name, _)| name)) {
            let place = root.join(name);
            fs::create_dir_all(&place).map_err(|source| EvalError::write(&place, source))?;
        }
        // Whatever ends this early, the folder is a report's from now on.
        folder.list(&folder.former)?;
        Ok(folder)
    }

    /// Writes a file of the report, `figures/rmse.svg`, atomically.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn put(&mut self, name: &str, bytes: &[u8]) -> Result<PathBuf, EvalError> {
        let path = self.root.join(name);
        whole(&path, bytes)?;
        self.written.insert(name.into());
        Ok(path)
    }

    /// Removes the remaining files of the earlier report.
    ///
    /// # Errors
    /// A file cannot be written or removed.
    pub fn finish(self) -> Result<(), EvalError> {
        for name in self.former.difference(&self.written) {
            let path = self.root.join(name);
            match fs::remove_file(&path) {
                Err(source) if source.kind() != ErrorKind::NotFound => return Err(EvalError::write(&path, source)),
                _ => {}
            }
        }
        self.list(&self.written)
    }

    fn list(&self, files: &BTreeSet<String>) -> Result<(), EvalError> {
        let path = self.root.join(LIST);
        let text = serde_json::to_string_pretty(&List { made_by: MAKER.into(), files: files.clone() });
        let text = text.map_err(|error| EvalError::write(&path, error.into()))?;
        whole(&path, format!("{text}\n").as_bytes())
    }
}

fn whole(path: &Path, bytes: &[u8]) -> Result<(), EvalError> {
    replace(path, |file| file.write_all(bytes)).map_err(|source| EvalError::write(path, source))
}

/// Returns the files of the report that a folder holds; none in an empty one.
fn former(root: &Path) -> Result<BTreeSet<String>, EvalError> {
    let unread = |source| EvalError::read(root, source);
    if let Some(list) = list_of(root).map_err(unread)? {
        return Ok(list.files.into_iter().filter(|name| is_inside(name)).collect());
    }
    let own = |name: &str| name == PAGE || FOLDERS.iter().any(|(folder, _)| *folder == name);
    if let Some(name) = ownership::first_foreign(root, own).map_err(unread)? {
        return Err(foreign(root, format!("it holds {name}")));
    }
    let page = root.join(PAGE);
    if page.exists() && !regular::read(&page).map_err(unread)?.windows(MAKER.len()).any(|part| part == MAKER.as_bytes())
    {
        return Err(foreign(root, format!("its {PAGE} is none of this program")));
    }
    let mut files = BTreeSet::new();
    for (folder, extensions) in FOLDERS {
        let place = root.join(folder);
        if !place.exists() {
            continue;
        }
        if let Some(name) = ownership::first_foreign(&place, |name| has(name, extensions)).map_err(unread)? {
            return Err(foreign(root, format!("it holds {folder}/{name}")));
        }
        // Without a page there was no report: the pictures and tables belong to the user.
        if !page.exists()
            && let Some(name) = ownership::first_foreign(&place, |_| false).map_err(unread)?
        {
            return Err(foreign(root, format!("it holds {folder}/{name} and no {PAGE}")));
        }
        for entry in fs::read_dir(&place).map_err(unread)? {
            let name = entry.map_err(unread)?.file_name().to_string_lossy().into_owned();
            files.extend(has(&name, extensions).then(|| format!("{folder}/{name}")));
        }
    }
    Ok(files)
}

/// Returns the list that a report left, if it is one.
fn list_of(root: &Path) -> io::Result<Option<List>> {
    match regular::read(&root.join(LIST)) {
        Ok(bytes) => Ok(serde_json::from_slice(&bytes).ok().filter(|list: &List| list.made_by == MAKER)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Returns whether a name from a list is one that a report would give, within its folder.
fn is_inside(name: &str) -> bool {
    let parts: Vec<Component> = Path::new(name).components().collect();
    match parts.as_slice() {
        [Component::Normal(folder), Component::Normal(file)] => {
            FOLDERS.iter().any(|(known, extensions)| **folder == **known && has(&file.to_string_lossy(), extensions))
        }
        _ => name == PAGE,
    }
}

fn has(name: &str, extensions: &[&str]) -> bool {
    Path::new(name).extension().is_some_and(|found| extensions.iter().any(|known| found == *known))
}

fn foreign(root: &Path, what: String) -> EvalError {
    EvalError::NotOwned { folder: root.into(), made: "a report", what }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_earlier_report_left_goes_and_nothing_else() {
        let root = tempfile::tempdir().unwrap();
        let out = root.path().join("page");
        let write = |names: &[&str]| {
            let mut folder = ReportFolder::claim(&out).unwrap();
            names.iter().for_each(|name| drop(folder.put(name, b"x").unwrap()));
            folder.finish().unwrap();
        };
        write(&["report.html", "figures/a.svg", "tables/b.csv"]);
        fs::write(out.join("figures/mine.svg"), "").unwrap();
        fs::write(out.join("notes.txt"), "").unwrap();
        write(&["report.html", "tables/c.csv"]);
        let there = |name: &str| out.join(name).exists();
        assert!(there("tables/c.csv") && there("figures/mine.svg") && there("notes.txt"));
        assert!(!there("figures/a.svg") && !there("tables/b.csv"));
    }

    #[test]
    fn figures_and_tables_without_a_page_are_somebodys() {
        for (folder, file) in [("figures", "mine.svg"), ("tables", "mine.csv")] {
            let root = tempfile::tempdir().unwrap();
            fs::create_dir(root.path().join(folder)).unwrap();
            fs::write(root.path().join(folder).join(file), "").unwrap();
            let refused = ReportFolder::claim(root.path()).unwrap_err();
            assert!(refused.exit_code() == 2 && refused.to_string().contains(file), "{refused}");
            assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
        }
    }

    #[test]
    fn a_list_that_leads_elsewhere_is_not_followed() {
        let root = tempfile::tempdir().unwrap();
        let out = root.path().join("page");
        fs::create_dir(&out).unwrap();
        fs::write(root.path().join("thesis.tex"), "").unwrap();
        fs::write(root.path().join("a.svg"), "").unwrap();
        let list =
            r#"{"made_by": "acm-eval report", "files": ["../thesis.tex", "figures/../../a.svg", "/etc/hosts.csv"]}"#;
        fs::write(out.join(LIST), list).unwrap();
        ReportFolder::claim(&out).unwrap().finish().unwrap();
        assert!(root.path().join("thesis.tex").exists() && root.path().join("a.svg").exists());
    }
}
