//! The residual study: residual of the nominal model in flight, by component, altitude and configuration.
//!
//! ```text
//! residual = measured − nominal,   in the domain that the calibration covers
//! ```
//!
//! It only describes: nothing is chosen by it. Held-out trials may be among what it describes, and it says so.
//!
//! ```toml
//! study    = "residual"
//! question = "What does the nominal model miss in flight?"
//! base     = "cfc.toml"
//! [residual_study]
//! roles = ["development", "held_out"]
//! ```

mod altitude;
mod asked;
mod backbone;
pub mod described;
mod print;
mod record;
mod slices;
mod tables;

use std::collections::BTreeMap;

use acm_datasets::{Role, Trial};
use nalgebra::DMatrix;

pub use asked::{Asked, File};
use described::Described;
pub use record::{AltitudeGroup, Backbone, ResidualStudy, RoleErrors, Slice, SliceBin, TrialResidual};

use super::{base::Base, folder::DescriptiveFolder, rms::Rms, sweep};
use crate::config::{Kind, Source, decode};
use crate::run::nominal::predict;
use crate::run::record::versions::versions;
use crate::schedule::error::ScheduleError;
use crate::schedule::request::Request;

/// Reads the study file, computes, writes, and returns the tables to print.
///
/// # Errors
/// The file asks for what cannot be, no trial is left, or the nominal model cannot be calibrated.
pub fn conduct(study: &Source, request: &Request) -> Result<String, ScheduleError> {
    let file: File = decode(study, "experiments/residual.toml")?;
    study.refuse_first(file.faults())?;
    let base = Base::read(&file.base, study, request)?;
    let mut notes = vec![];
    let trials = trials(&file.residual_study.roles, &base, study, &mut notes)?;
    let altitude = altitude::column(&file.residual_study, &base.campaign, study, &mut notes)?;
    let folder = DescriptiveFolder::claim(request.out, request.resume)?;
    let swept = sweep::swept(&trials);
    let (pair, source) = base.calibrated()?;
    let mut record = ResidualStudy {
        format: crate::run::record::FORMAT,
        kind: Kind::Residual,
        question: file.question,
        config: study.file_name(),
        asked: file.residual_study,
        experiment: base.experiment.clone(),
        data: base.data.clone(),
        versions: versions(),
        calibrated_on: pair.trials.clone(),
        nominal: source,
        outputs: base.campaign.manifest.output_names(),
        actuators: sweep::actuators(&base.campaign),
        swept,
        middle: sweep::middle(&trials, swept),
        overall: Rms::of(&DMatrix::zeros(0, 0)),
        roles: vec![],
        trials: vec![],
        altitudes: vec![],
        slices: vec![],
        backbones: vec![],
        tables: BTreeMap::new(),
        notes: vec![],
    };
    folder.refuse_other(&record)?;
    let tip = base.campaign.tip_columns();
    let described: Vec<Described> = trials
        .iter()
        .map(|trial| {
            let nominal = predict(&pair, trial).0.columns_range(tip.clone()).into_owned();
            let measured = trial.measured.columns_range(tip.clone()).into_owned();
            Described { trial, residual: &measured - &nominal, measured, nominal }
        })
        .collect();
    let table = tables::residual(&described, altitude, &record);
    folder.table("residual", &table, &mut record.tables)?;
    record.overall = Rms::of_all(described.iter().map(|d| &d.residual));
    record.roles = roles(&described);
    record.slices = slices::slices(&described, &record, &mut notes);
    record.trials = described.iter().map(|d| one(d, altitude, &record.slices)).collect();
    if altitude.is_some() {
        record.altitudes = altitude::groups(&described, &record);
    }
    record.backbones = backbone::backbones(&pair, &record, &mut notes);
    record.notes = notes;
    folder.record(&record)?;
    Ok(print::text(&record, folder.root()))
}

/// Returns the trials of the requested roles that have samples left.
fn trials<'a>(
    roles: &[Role],
    base: &'a Base,
    study: &Source,
    notes: &mut Vec<String>,
) -> Result<Vec<&'a Trial>, ScheduleError> {
    let (kept, empty): (Vec<&Trial>, Vec<&Trial>) =
        base.campaign.trials.iter().filter(|trial| roles.contains(&trial.role)).partition(|trial| trial.samples() > 0);
    for trial in empty {
        notes.push(format!("Trial {} has no sample in the calibrated domain and is left out.", trial.name));
    }
    if roles.contains(&Role::HeldOut) && kept.iter().any(|trial| trial.role == Role::HeldOut) {
        notes.push("Held-out trials are among those described. Choose nothing by what is seen here.".into());
    }
    if !kept.is_empty() {
        return Ok(kept);
    }
    let key = ["residual_study".to_string(), "roles".to_string()];
    let what = format!("`residual_study.roles` leaves no trial of {} with samples", base.data.name);
    let help = "name other roles, or widen inputs.domain_filter of the base experiment";
    Err(Box::new(study.complaint(&key, what, help)).into())
}

/// Returns the errors of each role by itself.
fn roles(described: &[Described]) -> Vec<RoleErrors> {
    [Role::Calibration, Role::Development, Role::HeldOut, Role::Excluded]
        .into_iter()
        .filter_map(|role| {
            let own: Vec<&Described> = described.iter().filter(|d| d.trial.role == role).collect();
            (!own.is_empty()).then(|| RoleErrors {
                role: role.name().into(),
                trials: own.iter().map(|d| d.trial.name.clone()).collect(),
                rms: Rms::of_all(own.iter().map(|d| &d.residual)),
            })
        })
        .collect()
}

fn one(described: &Described, altitude: Option<usize>, slices: &[Slice]) -> TrialResidual {
    let trial = described.trial;
    TrialResidual {
        trial: trial.name.clone(),
        role: trial.role.name().into(),
        altitude: altitude.map(|column| trial.context.column(column).mean()),
        slice: slices.iter().position(|slice| slice.trials.contains(&trial.name)).unwrap_or(0),
        mean: described.residual.column_iter().map(|column| column.mean()).collect(),
        rms: Rms::of(&described.residual),
    }
}
