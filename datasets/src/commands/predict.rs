//! `acm-data predict`: recordings with the predictions of a program.

use std::ffi::OsString;
use std::fmt::Write;
use std::path::Path;

use acm_datasets::DataError;
use acm_datasets::predict::{self, Program, TABLE};

use super::progress::Progress;
use crate::Set;

pub fn run(set: &Set, out: &Path, program: &[OsString], text: &mut String) -> Result<(), DataError> {
    let program = Program::new(program.to_vec())?;
    let data = super::open(set, None)?;
    let (progress, mut done) = (Progress::new(), 0);
    let samples = predict::write(&data.manifest, data.all(), out, &format!("`{}`", program.name()), |given| {
        progress.show(done, data.entries.len());
        done += 1;
        program.answers(given)
    });
    progress.end();
    let _ = writeln!(text, "{}: {} rows", out.join(TABLE).display(), samples?);
    let chosen = if data.manifest.arm.is_some() { " --set nominal.model=predicted" } else { "" };
    super::next(text, "acm-eval", "close-loop", out, chosen);
    Ok(())
}
