//! `acm-data check`: everything that is wrong, and what to do about it.

use acm_datasets::text::hint::argument;
use acm_datasets::{DataError, describe};

use crate::Set;

pub fn run(set: &Set, window: usize, text: &mut String) -> Result<(), DataError> {
    let data = super::open(set, Some(window))?;
    text.push_str(&describe::checked(&data));
    let data = set.data.as_ref().map_or(String::new(), |data| format!(" --data {}", argument(data.display())));
    super::next(text, "acm-eval", "close-loop", &set.folder, &data);
    Ok(())
}
