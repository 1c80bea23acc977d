//! `acm-data describe`: what a data set holds, in tables and lines.

use std::path::Path;

use acm_datasets::{DataError, describe};

use crate::Set;

pub fn run(set: &Set, picture: Option<&Path>, text: &mut String) -> Result<(), DataError> {
    let data = super::open(set, None)?;
    text.push_str(&describe::description(&data, &set.folder, set.max_gap, picture)?);
    Ok(())
}
