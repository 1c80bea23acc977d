//! Identity of a run folder, and its finished runs.

use acm_datasets::files::regular;
use serde::Serialize;
use toml::Table;

use super::{NominalRecord, RunRecord, read_nominal, read_record};
use crate::run::sequences::record::{StudyRecord, read_study};
use crate::{
    config::Experiment,
    store::{RunFolder, StoreError, differences, hashed},
};

impl RunFolder {
    /// Writes what is to be run, or checks that it is what this folder was begun for.
    ///
    /// # Errors
    /// The folder belongs to another experiment or other data, or cannot be written.
    pub fn adopt_experiment(&self, experiment: &Experiment, nominal: &NominalRecord) -> Result<(), StoreError> {
        let before = match self.path("nominal.json").exists() {
            true => Some(read_nominal(self.root())?.data.hash),
            false => None,
        };
        let write = || hashed::write(&self.path("nominal.json"), nominal);
        self.adopt(experiment, before, &nominal.data.hash, write)
    }

    /// Adopts a folder for a question about sequences, whose data `study.json` describes.
    ///
    /// # Errors
    /// As [`RunFolder::adopt_experiment`].
    pub fn adopt_question(&self, question: &impl Serialize, study: &StudyRecord) -> Result<(), StoreError> {
        let path = self.path("study.json");
        let before = match path.exists() {
            true => Some(read_study(&path)?.data.hash),
            false => None,
        };
        self.adopt(question, before, &study.data.hash, || hashed::write(&path, study))
    }

    /// Returns the record of a run that is finished.
    ///
    /// # Errors
    /// There is a file, and it is no record; or its table of predictions is missing or not the one it was written with.
    pub fn finished(&self, id: &str) -> Result<Option<RunRecord>, StoreError> {
        let path = self.record(id);
        if !path.exists() {
            return Ok(None);
        }
        let record = read_record(&path)?;
        hashed::same_file(&self.predictions(id), &record.predictions_sha256, &path)?;
        match self.other(&record)? {
            None => Ok(Some(record)),
            Some(why) => Err(StoreError::Changed { file: path, why: format!("it is of another experiment: {why}") }),
        }
    }

    /// Returns the difference of a record's experiment from that of the folder; it may have been copied here.
    fn other(&self, record: &RunRecord) -> Result<Option<String>, StoreError> {
        let path = self.path("experiment.toml");
        let held = match path.exists() {
            true => regular::read_to_string(&path).map_err(|source| StoreError::io("read", path, source))?,
            false => return Ok(None),
        };
        let tables: Option<(Table, Table)> = held.parse().ok().zip(Table::try_from(&record.experiment).ok());
        let list = tables.map(|(held, found)| differences(&held, &found)).unwrap_or_default();
        Ok((!list.is_empty()).then(|| list.join("; ")))
    }
}
