//! Mutated files: each is to be refused with a message that names it.

use std::{
    collections::BTreeMap,
    fs,
    panic::{AssertUnwindSafe, catch_unwind},
};

use rand::{SeedableRng, seq::IndexedRandom};
use rand_chacha::ChaCha8Rng;

use crate::faults::{
    mutation::{ALL, Mutation},
    saved::Saved,
};

/// What became of the mutated files.
#[derive(Debug, Default)]
pub struct Outcome {
    /// All.
    pub files: usize,
    /// Refused with a message that names the file and is short enough to be read.
    pub refused: usize,
    /// Read as something else than what was written.
    pub silent: usize,
    /// Read as what was written, although the bytes are others.
    pub equal: usize,
    /// Readers that panicked.
    pub panics: usize,
    /// How many of each kind of file.
    pub kinds: BTreeMap<String, usize>,
    /// What was not refused as it should be.
    pub faults: Vec<String>,
}

/// No message is longer.
const LONGEST: usize = 4096;

/// Mutates `files` by turns, `count` times in all.
pub fn mutate(files: &[Saved], count: usize, seed: u64) -> Outcome {
    let folder = tempfile::tempdir().unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut outcome = Outcome::default();
    for saved in files {
        let path = folder.path().join(&saved.file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, &saved.bytes).unwrap();
        (saved.read)(&path).unwrap_or_else(|fault| panic!("{}, as it was written: {fault}", saved.name));
    }
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    for saved in files.iter().cycle().take(count) {
        one(saved, folder.path(), &mut random, &mut outcome);
    }
    std::panic::set_hook(hook);
    outcome
}

fn one(saved: &Saved, folder: &std::path::Path, random: &mut ChaCha8Rng, outcome: &mut Outcome) {
    let (mutation, bytes) = changed(saved, random);
    let path = folder.join(&saved.file);
    fs::write(&path, &saved.bytes).unwrap();
    let whole = (saved.read)(&path);
    fs::write(&path, &bytes).unwrap();
    outcome.files += 1;
    *outcome.kinds.entry(saved.name.clone()).or_default() += 1;
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let fault = match catch_unwind(AssertUnwindSafe(|| (saved.read)(&path))) {
        Ok(Err(message)) if message.contains(&name) && message.len() < LONGEST => {
            outcome.refused += 1;
            return;
        }
        Ok(Err(message)) => format!("its message is {message}"),
        Ok(Ok(content)) if Ok(&content) == whole.as_ref() => {
            outcome.equal += 1;
            "it was read as what was written".into()
        }
        Ok(Ok(_)) => {
            outcome.silent += 1;
            "it was read as something else".into()
        }
        Err(_) => {
            outcome.panics += 1;
            "its reader panicked".into()
        }
    };
    outcome.faults.push(format!("{}, {}: {fault}", saved.name, mutation.name));
}

/// Other bytes than those that were written.
fn changed(saved: &Saved, random: &mut ChaCha8Rng) -> (Mutation, Vec<u8>) {
    loop {
        let mutation = *ALL.choose(random).unwrap_or(&ALL[0]);
        let bytes = (mutation.apply)(&saved.bytes, random);
        if bytes != saved.bytes {
            return (mutation, bytes);
        }
    }
}
