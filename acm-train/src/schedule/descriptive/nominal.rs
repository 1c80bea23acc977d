//! The nominal study: number of strain orders, and accuracy of the calibrated model.
//!
//! | part              | data                                          | models                                         |
//! | ----------------- | --------------------------------------------- | ---------------------------------------------- |
//! | orders            | one planar calibration trial, binned and raw  | Legendre orders, actuation map frozen or refitted |
//! | fitted            | all calibration trials                        | polynomial; strain in two steps; strain, joint |
//! | left out          | each calibration trial, fitted to the others  | the same three                                 |
//!
//! ```toml
//! study    = "nominal"
//! question = "How well does the nominal model know the arm at rest?"
//! base     = "cfc.toml"
//! [nominal_study]
//! trial = "17"
//! ```

mod asked;
mod baseline;
mod orders;
mod print;
mod record;
mod tables;

use std::collections::BTreeMap;

use acm_core::{ArmSpec, NominalSpec};
use acm_datasets::{Role, Trial};
use nalgebra::DMatrix;

pub use asked::{Asked, File};
pub use record::{Errors, Fitted, ModelRow, NominalStudy, OrderRow, OrderStudy, TrialErrors};

use super::{base::Base, folder::DescriptiveFolder, sweep};
use crate::config::{Kind, Source, decode};
use crate::run::nominal::choose;
use crate::run::record::versions::versions;
use crate::schedule::error::ScheduleError;
use crate::schedule::request::Request;

/// Reads the study file, computes, writes, and returns the tables to print.
///
/// # Errors
/// The file asks for what cannot be, the data have no arm or no calibration trials, or a fit is impossible.
pub fn conduct(study: &Source, request: &Request) -> Result<String, ScheduleError> {
    let file: File = decode(study, "experiments/nominal.toml")?;
    study.refuse_first(file.faults())?;
    let base = Base::read(&file.base, study, request)?;
    let arm = arm(&base, study)?;
    let trials: Vec<&Trial> = base.campaign.trials(Role::Calibration).collect();
    let swept = sweep::swept(&trials);
    let planar = planar(&file, &trials, swept, study)?;
    let folder = DescriptiveFolder::claim(request.out, request.resume)?;
    let mut record = NominalStudy {
        format: crate::run::record::FORMAT,
        kind: Kind::Nominal,
        question: file.question,
        config: study.file_name(),
        asked: Asked { trial: Some(planar.name.clone()), ..file.nominal_study },
        experiment: base.experiment.clone(),
        data: base.data.clone(),
        versions: versions(),
        outputs: base.campaign.manifest.output_names(),
        actuators: sweep::actuators(&base.campaign),
        swept,
        middle: sweep::middle(&trials, swept),
        orders: OrderStudy::default(),
        models: vec![],
        tables: BTreeMap::new(),
        notes: vec![],
    };
    folder.refuse_other(&record)?;
    request.progress.note(&format!("orders of trial {}", planar.name));
    let orders = orders::study(planar, &base.campaign, &arm, &record)?;
    let (samples, bins) = (tables::samples(planar, &orders, &record), tables::bins(&orders, &record));
    folder.table("orders", &samples, &mut record.tables)?;
    folder.table("bins", &bins, &mut record.tables)?;
    record.orders = orders.study;
    let baseline = baseline::study(&trials, &base, &arm, request, &mut record.notes)?;
    let tip = |trial: &&Trial| trial.measured.columns_range(base.campaign.tip_columns()).into_owned();
    let measured: Vec<DMatrix<f64>> = trials.iter().map(tip).collect();
    let table = tables::calibration(&trials, &measured, &baseline, &record);
    folder.table("calibration", &table, &mut record.tables)?;
    record.models = baseline.iter().map(|model| model.row(&trials, &measured)).collect();
    folder.record(&record)?;
    Ok(print::text(&record, folder.root()))
}

/// Returns the arm of the base experiment.
fn arm(base: &Base, study: &Source) -> Result<ArmSpec, ScheduleError> {
    let refuse = |what: String, help: &str| Err(Box::new(study.complaint(&["base".into()], what, help)).into());
    let choice = choose(&base.experiment.nominal, &base.source, &base.campaign.manifest)?;
    let Some(NominalSpec::Strain(arm)) = choice.spec() else {
        let what = format!("`base` has no strain model to study: the nominal model of {} is another", base.data.name);
        return refuse(what, "name an experiment whose data describe an [arm] and whose [nominal] is \"strain\"");
    };
    match base.campaign.trials(Role::Calibration).any(|trial| trial.samples() > 0) {
        true => Ok(arm.clone()),
        false => refuse(
            format!("`base` has no trials to calibrate on: {} has none of role calibration", base.data.name),
            "give trials the role calibration in the manifest",
        ),
    }
}

/// Returns the trial of the order study: the one that the file names, or the one that bends the arm in one plane.
fn planar<'a>(file: &File, trials: &[&'a Trial], swept: usize, study: &Source) -> Result<&'a Trial, ScheduleError> {
    let names: Vec<&str> = trials.iter().map(|trial| trial.name.as_str()).collect();
    let found = match &file.nominal_study.trial {
        Some(name) => trials.iter().find(|trial| trial.name == *name).copied(),
        None => sweep::planar(trials, swept),
    };
    found.ok_or_else(|| {
        let asked = file.nominal_study.trial.as_deref().unwrap_or_default();
        let what = format!("`nominal_study.trial` is \"{asked}\", which is no calibration trial");
        let help = format!("they are {}; leave the key out for the one that bends in one plane", names.join(", "));
        let key = ["nominal_study".to_string(), "trial".to_string()];
        Box::new(study.complaint(&key, what, help)).into()
    })
}
