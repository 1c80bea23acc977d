//! Published recordings, made into data sets: one file a source, one line in [`ALL`].

mod asl_trunk;
mod walker2d;

use std::path::Path;

use crate::error::DataError;

/// The files that an import wrote, relative to its output folder, with their numbers of rows.
pub type Imported = Vec<(String, usize)>;

/// A published source of recordings.
pub struct Source {
    /// As given on the command line.
    pub name: &'static str,
    /// Description, and where to get it.
    pub about: &'static str,
    /// Makes the data set: from a folder as published, into a new folder.
    pub import: fn(&Path, &Path) -> Result<Imported, DataError>,
}

/// Every known source.
pub const ALL: &[Source] = &[asl_trunk::SOURCE, walker2d::SOURCE];
