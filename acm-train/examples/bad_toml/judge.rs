//! Reads a spoiled file as the program does, and judges the message.

use std::{fs, path::Path};

use acm_datasets::manifest;
use acm_train::{
    TrainError,
    config::{self, Kind, Source, decode, kind, read_question},
    run::RunError,
    schedule::{
        descriptive::{nominal, residual},
        study::list,
    },
};

use crate::{
    spoil::Case,
    whole::{EXPERIMENT, Reader},
};

/// Bytes that a message may have.
pub const LONGEST: usize = 4096;

/// Writes the files that are read beside the spoiled file.
pub fn prepare(folder: &Path) -> std::io::Result<()> {
    fs::write(folder.join("experiment.toml"), EXPERIMENT)
}

/// Reads `folder/file` with its reader.
pub fn read(reader: Reader, folder: &Path, file: &str) -> Result<(), TrainError> {
    if reader == Reader::Manifest {
        return Ok(manifest::read(folder).map(|_| ()).map_err(RunError::from)?);
    }
    let mut source = Source::read(&folder.join(file), &[])?;
    match (reader, kind(&source)?) {
        (Reader::Experiment, _) | (_, None) => Ok(config::of_source(&mut source).map(|_| ())?),
        (_, Some(Kind::Nominal)) => {
            let asked: nominal::File = decode(&source, "experiments/nominal.toml")?;
            Ok(source.refuse_first(asked.faults())?)
        }
        (_, Some(Kind::Residual)) => {
            let asked: residual::File = decode(&source, "experiments/residual.toml")?;
            Ok(source.refuse_first(asked.faults())?)
        }
        (_, Some(Kind::Sequences)) => Ok(read_question(&mut source).map(|_| ())?),
        (_, Some(Kind::Best)) => {
            let list = list::read(&source, Kind::Best)?;
            Ok(list.base.iter().try_for_each(|base| list.member(&source, base, "", vec![]).map(|_| ()))?)
        }
        (_, Some(kind)) => {
            let list = list::read(&source, kind)?;
            let Some(sweep) = &list.sweep else { return Ok(list.members(&source).map(|_| ())?) };
            let settings = sweep.next(&[], &[], 1).into_iter();
            Ok(settings.enumerate().try_for_each(|(i, setting)| {
                list.member(&source, &list.base[0], &format!("setting {i}"), setting).map(|_| ())
            })?)
        }
    }
}

/// Returns the fault of the message for a spoiled file; nothing if it names file, line, column and key, says what to
/// do, and is short.
pub fn complaint(case: &Case, code: u8, message: &str) -> Option<String> {
    let said = place(message, case.file);
    let here = said.is_some_and(|(line, column)| line == case.line && (1..=case.length + 1).contains(&column));
    let head = message.split('╭').next().unwrap_or_default();
    let remedy = message.contains("help:") || (case.reader == Reader::Manifest && head.contains(';'));
    let wrong = [
        (code != 2, "the exit code is not 2"),
        (!here, "the place is not that of the key"),
        (!head.contains(&case.key), "the key is not named"),
        (!remedy, "no remedy"),
        (message.len() > LONGEST, "longer than 4 kB"),
        (message.contains("panicked"), "a panic"),
    ];
    let wrong: Vec<&str> = wrong.iter().filter(|(wrong, _)| *wrong).map(|(_, what)| *what).collect();
    (!wrong.is_empty()).then(|| {
        let shown: String = message.chars().take(600).collect();
        format!("{} (line {}, key {}): {}\n{shown}", case.name, case.line, case.key, wrong.join(", "))
    })
}

/// Returns the line and the column that stand behind the file's name.
fn place(message: &str, file: &str) -> Option<(usize, usize)> {
    let (_, rest) = message.split_once(&format!("{file}:"))?;
    let mut numbers = rest.splitn(3, ':');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}
