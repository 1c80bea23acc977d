//! From run folders to a folder with one page, its figures and its tables.
//!
//! ```text
//! OUT/report.html                     everything, in one file
//! OUT/report.json                     the names of all files
//! OUT/figures/<data>-<figure>.svg     and .png, and .csv where it is lines, dots or an arm
//! OUT/tables/<data>-<table>.csv     and .tex
//! ```

pub mod folder;
mod written;

use std::path::{Path, PathBuf};

use crate::{
    chapter::{self, Chapter, slug, studies},
    error::EvalError,
    run::Run,
    section::sections,
};

/// A report in memory.
pub struct Report {
    /// Chapters: studies, then one for each data set of the runs.
    pub chapters: Vec<Chapter>,
    /// Command line that made it.
    pub command: String,
}

impl Report {
    /// Reads run folders and studies, and draws everything.
    ///
    /// # Errors
    /// See [`Run::read`], [`sections`] and [`chapter::studies`]; or the same folder is given twice.
    pub fn of(folders: &[PathBuf], command: String) -> Result<Self, EvalError> {
        let mut seen: Vec<PathBuf> = Vec::new();
        for folder in folders {
            let place = folder.canonicalize().unwrap_or_else(|_| folder.clone());
            if seen.contains(&place) {
                return Err(EvalError::Twice { path: folder.clone() });
            }
            seen.push(place);
        }
        let (studies, runs): (Vec<&PathBuf>, Vec<&PathBuf>) =
            folders.iter().partition(|folder| studies::is_one(folder));
        let mut chapters: Vec<Chapter> = Vec::new();
        for folder in studies {
            let slug = slug(&studies::name(folder), &chapters);
            chapters.push(studies::chapter(folder, slug)?);
        }
        let runs = runs.into_iter().map(|folder| Run::read(folder)).collect::<Result<Vec<_>, _>>()?;
        for section in sections(runs)? {
            let slug = slug(&section.data.name, &chapters);
            chapters.push(chapter::of_section(&section, slug));
        }
        Ok(Self { chapters, command })
    }
}

/// Returns the default folder of a report: in the run, or beside the runs when there are several.
pub fn default_folder(runs: &[PathBuf]) -> PathBuf {
    match runs {
        [one] => one.join("report"),
        [first, ..] => first.parent().unwrap_or(Path::new("")).join("report"),
        [] => PathBuf::from("report"),
    }
}
