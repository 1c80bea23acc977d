//! Figures of README and book: what a command printed, in marked blocks.
//!
//! ````text
//! <!-- example: cargo run -p acm-eval -- close-loop first -->
//! ```text
//! lines that the command prints; a line "…" stands for any number of others
//! ```
//! <!-- /example -->
//! ````
//!
//! `slow example` marks a command that takes minutes, or reads data that are not part of the repository. It is run where it is asked for.

mod block;
mod programs;
mod rows;

use std::fs;
use std::path::{Path, PathBuf};

use programs::Programs;

use crate::structure::files::{StructureError, entries, read};

/// Files and folders with blocks.
const PLACES: [&str; 2] = ["README.md", "book/src"];

/// Commands to run.
pub enum Wanted<'a> {
    /// All that are not slow.
    Quick,
    /// Those that contain one of these words.
    Of(&'a [&'a str]),
}

/// Prints blocks anew, and returns what cannot be printed. With `check` nothing is written, and a block that differs is a complaint; so is a number
/// of a table in README that the block of the same command does not hold.
///
/// # Errors
/// A file that cannot be read or written.
pub fn renew(root: &Path, wanted: &Wanted, check: bool) -> Result<Vec<String>, StructureError> {
    let (mut complaints, mut all, programs) = (vec![], vec![], Programs::new(root));
    for file in files(root)? {
        let text = read(&file)?;
        let mut new = text.clone();
        for block in block::all(&text) {
            let place = format!("{}: {}", file.strip_prefix(root).unwrap_or(&file).display(), block.command);
            let is_wanted = match wanted {
                Wanted::Quick => !block.is_slow,
                Wanted::Of(words) => words.iter().any(|word| block.command.contains(word)),
            };
            let printed = is_wanted.then(|| programs.output(&block.command).map(|output| block.renewed(&output)));
            match printed {
                None => {}
                Some(Err(why)) => complaints.push(format!("{place}: {why}")),
                Some(Ok(None)) => complaints.push(format!("{place}: prints no such lines")),
                Some(Ok(Some(lines))) if check && lines != block.lines => {
                    complaints.push(format!("{place}: prints other lines; cargo xtask figures puts them there"));
                }
                Some(Ok(Some(lines))) => new = new.replacen(&block.text(&block.lines), &block.text(&lines), 1),
            }
            all.push(block);
        }
        if new != text {
            fs::write(&file, new).map_err(|source| StructureError::Read { path: file, source })?;
        }
    }
    complaints.extend(rows::complaints(&read(&root.join("README.md"))?, &all));
    Ok(complaints)
}

fn files(root: &Path) -> Result<Vec<PathBuf>, StructureError> {
    let mut files = vec![];
    for place in PLACES.map(|place| root.join(place)) {
        let found = if place.is_dir() { entries(&place)? } else { vec![place] };
        files.extend(found.into_iter().filter(|file| file.extension().is_some_and(|extension| extension == "md")));
    }
    Ok(files)
}
