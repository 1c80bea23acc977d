//! From run folders to a folder with one page, its figures and its tables.
//!
//! ```text
//! OUT/report.html                     everything, in one file
//! OUT/figures/<data>-<figure>.svg     and .png
//! OUT/tables/<data>-<table>.csv
//! ```

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use acm_datasets::atomic::replace;

use crate::{
    error::EvalError,
    figures::{self, Drawing, Figure},
    page,
    run::Run,
    section::{Section, sections},
    tables::{self, Table},
};

/// One section with all that is shown of it.
pub struct Chapter {
    /// The data and the runs.
    pub section: Section,
    /// Start of the names of its files: the data set's name, made fit for a file name and unique on the page.
    pub slug: String,
    /// Its tables.
    pub tables: Vec<Table>,
    /// Its figures.
    pub figures: Vec<(&'static Figure, Drawing)>,
}

/// A report in memory.
pub struct Report {
    /// One per data set.
    pub chapters: Vec<Chapter>,
    /// What was typed to make it.
    pub command: String,
}

impl Report {
    /// Reads run folders and draws everything.
    ///
    /// # Errors
    /// See [`Run::read`] and [`sections`]; or the same folder is given twice.
    pub fn of(folders: &[PathBuf], command: String) -> Result<Self, EvalError> {
        let mut seen: Vec<PathBuf> = Vec::new();
        for folder in folders {
            let place = folder.canonicalize().unwrap_or_else(|_| folder.clone());
            if seen.contains(&place) {
                return Err(EvalError::Twice { path: folder.clone() });
            }
            seen.push(place);
        }
        let runs = folders.iter().map(|folder| Run::read(folder)).collect::<Result<Vec<_>, _>>()?;
        let mut chapters: Vec<Chapter> = Vec::new();
        for section in sections(runs)? {
            let slug = slug(&section, &chapters);
            let tables = tables::ALL.iter().filter_map(|make| make(&section)).collect();
            let figures = figures::ALL.iter().filter_map(|figure| Some((figure, (figure.draw)(&section)?))).collect();
            chapters.push(Chapter { section, slug, tables, figures });
        }
        Ok(Self { chapters, command })
    }

    /// Writes the page, the figures and the tables into `out`; returns the page's path.
    ///
    /// # Errors
    /// A folder or file cannot be written, or a figure cannot be drawn.
    pub fn write(&self, out: &Path) -> Result<PathBuf, EvalError> {
        for folder in [out.to_path_buf(), out.join("figures"), out.join("tables")] {
            std::fs::create_dir_all(&folder).map_err(|source| EvalError::write(&folder, source))?;
        }
        for chapter in &self.chapters {
            for table in &chapter.tables {
                let file = out.join("tables").join(format!("{}-{}.csv", chapter.slug, table.name));
                whole(&file, table.csv().as_bytes())?;
            }
            for (figure, drawing) in &chapter.figures {
                let name = format!("{}-{}", chapter.slug, figure.name);
                let svg = drawing.svg(&name, figure.question, &self.command);
                whole(&out.join("figures").join(format!("{name}.svg")), svg.as_bytes())?;
                whole(&out.join("figures").join(format!("{name}.png")), &drawing.png(&name)?)?;
            }
        }
        let page = out.join("report.html");
        whole(&page, page::html(self).as_bytes())?;
        Ok(page)
    }
}

/// Where a report goes when the command line does not say: into the run, or beside the runs when there are several.
pub fn default_folder(runs: &[PathBuf]) -> PathBuf {
    match runs {
        [one] => one.join("report"),
        [first, ..] => first.parent().unwrap_or(Path::new("")).join("report"),
        [] => PathBuf::from("report"),
    }
}

/// Letters, digits and hyphens of the data set's name; a number where two sets have the same.
fn slug(section: &Section, before: &[Chapter]) -> String {
    let name = section.data.name.to_ascii_lowercase();
    let words: Vec<&str> = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let name = if words.is_empty() { "data".to_string() } else { words.join("-") };
    let taken = |slug: &String| before.iter().any(|chapter| chapter.slug == *slug);
    let numbered = (2..).map(|n| format!("{name}-{n}"));
    std::iter::once(name.clone()).chain(numbered).find(|slug| !taken(slug)).unwrap_or(name)
}

/// A reader never meets half a file: it is written beside its place and moved there.
fn whole(path: &Path, bytes: &[u8]) -> Result<(), EvalError> {
    replace(path, |file| file.write_all(bytes)).map_err(|source| EvalError::write(path, source))
}
