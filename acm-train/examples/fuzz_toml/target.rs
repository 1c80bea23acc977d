//! Properties that hold for any text: an experiment or a message, no panic, no more than 4 kB.

use std::{
    fs, io,
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
};

use acm_train::explain;

use crate::{
    judge::{self, LONGEST},
    whole::Whole,
};

/// Reads the bytes in place of a file in order; what does not hold.
pub fn wrong(whole: &Whole, folder: &Path, bytes: &[u8]) -> io::Result<Option<String>> {
    judge::prepare(folder)?;
    fs::write(folder.join(whole.file), bytes)?;
    let read = catch_unwind(AssertUnwindSafe(|| judge::read(whole.reader, folder, whole.file)));
    Ok(match read {
        Err(_) => Some("it panicked".into()),
        Ok(Ok(())) => None,
        Ok(Err(error)) => {
            let code = error.exit_code();
            let text = explain(error);
            let fits = code == 2 && text.contains(whole.file) && text.len() <= LONGEST;
            (!fits).then(|| format!("code {code}, {} bytes: {text:.300}", text.len()))
        }
    })
}
