//! A report as files.

use std::path::{Path, PathBuf};

use super::Report;
use crate::chapter::Shown;
use crate::error::EvalError;
use crate::page;
use crate::report::folder::{PAGE, ReportFolder};

impl Report {
    /// Writes the page, the figures and the tables into `out`, in the place of an earlier report; returns the page's path.
    ///
    /// # Errors
    /// The folder holds something else ([`ReportFolder::claim`]), a folder or file cannot be written, or a figure cannot be
    /// drawn.
    pub fn write(&self, out: &Path) -> Result<PathBuf, EvalError> {
        let mut folder = ReportFolder::claim(out)?;
        for chapter in &self.chapters {
            for table in &chapter.tables {
                let name = format!("tables/{}-{}", chapter.slug, table.name);
                folder.put(&format!("{name}.csv"), table.csv().as_bytes())?;
                folder.put(&format!("{name}.tex"), table.latex(&chapter.data).as_bytes())?;
            }
            for Shown { name, question, drawing } in &chapter.figures {
                let name = format!("{}-{name}", chapter.slug);
                folder.put(&format!("figures/{name}.svg"), drawing.svg(&name, question, &self.command).as_bytes())?;
                folder.put(&format!("figures/{name}.png"), &drawing.png(&name)?)?;
                if let Some(csv) = drawing.csv() {
                    folder.put(&format!("figures/{name}.csv"), csv.as_bytes())?;
                }
            }
        }
        let page = folder.put(PAGE, page::html(self).as_bytes())?;
        folder.finish()?;
        Ok(page)
    }
}
