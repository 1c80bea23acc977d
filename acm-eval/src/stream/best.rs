//! From the folder of a study of the best model to the winner beside a robot: the mean over its members, each the mean over its
//! final runs.

use std::path::{Path, PathBuf};

use crate::chapter::{best, best_sequences};
use crate::error::EvalError;
use acm_stream::{AverageParts, MemberParts};
use acm_train::{
    run::record::{RunRecord, Stage, read_records},
    schedule::study::best::record::FILE,
};

use super::{
    saved::{self, Request, Saved},
    wiring::Wiring,
};

/// The winner with all that it needs beside a robot.
pub struct SavedBest {
    /// Parts of the average.
    pub parts: AverageParts,
    /// Columns of the inputs.
    pub wiring: Wiring,
    /// Domain that its networks were trained in.
    pub domain: acm_datasets::Domain,
    /// Name of the winner.
    pub id: String,
    /// Run folder and name of each network of it.
    pub networks: Vec<(PathBuf, String)>,
    /// One line about the data, for people.
    pub title: String,
}

/// Returns whether a folder is one of such a study.
pub fn is_one(folder: &Path) -> bool {
    folder.join(FILE).is_file()
}

/// Reads the study, its winner's runs, and their data for the scalers.
///
/// # Errors
/// A winner that was not trained to the end or has no form beside a robot; or as [`saved::load`].
pub fn load(request: &Request) -> Result<SavedBest, EvalError> {
    if let Some(id) = request.id {
        let what = format!("{}: --network {id} names a run, and this is a study", request.run.display());
        return Err(EvalError::Usage(format!("{what}; give a run folder below it, or leave --network out")));
    }
    if best_sequences::is_one(request.run)? {
        let what = format!("{}: the winner predicts sequences, which have no robot", request.run.display());
        return Err(EvalError::Usage(format!("{what}; its networks are in runs/")));
    }
    let record = best::read(request.run)?;
    let refuse = |what: String| Err(EvalError::Usage(format!("{}: {what}", request.run.display())));
    if !record.winner.trained {
        return refuse("nothing was trained to the end; run the study again with protocol.final = true".into());
    }
    if !record.chosen().streams {
        return refuse(format!(
            "the winner is {}, and an outside baseline has no form beside a robot; with robot = true in [best] of the study, \
             what is chosen has one",
            record.chosen().name()
        ));
    }
    let (mut all, mut networks): (Vec<(Saved, f64)>, _) = (vec![], vec![]);
    let share = 1.0 / record.winner.members.len() as f64;
    for member in &record.winner.members {
        let folder = request.run.join(&member.folder);
        let own = Request { run: &folder, id: None, data: request.data, windows: request.windows };
        let runs = match member.learned {
            true => learned(&own)?,
            false => saved::alone(&own)?,
        };
        let weight = share / runs.len() as f64;
        let learned = runs.iter().filter(|saved| saved.parts.has_network());
        networks.extend(learned.map(|saved| (folder.clone(), saved.id.clone())));
        all.extend(runs.into_iter().map(|saved| (saved, weight)));
    }
    let mut wirings = all.iter().map(|(saved, _)| &saved.wiring);
    let first = wirings.next().ok_or_else(|| EvalError::NoRecords { path: request.run.into() })?.clone();
    let wiring = wirings.fold(first, Wiring::with);
    let (domain, title) = (all[0].0.domain.clone(), all[0].0.title.clone());
    let inputs = wiring.inputs.iter().map(|column| column.name.clone()).collect();
    let member = |(saved, weight): (Saved, f64)| MemberParts {
        places: wiring.places(&saved.wiring),
        parts: saved.parts,
        weight,
    };
    let members = all.into_iter().map(member).collect();
    let parts = AverageParts { inputs, members, interval: saved::interval(request.run)? };
    Ok(SavedBest { parts, wiring, domain, id: record.chosen().name(), networks, title })
}

/// Returns the final runs of a member.
fn learned(request: &Request) -> Result<Vec<Saved>, EvalError> {
    let runs: Vec<RunRecord> = read_records(request.run)?.into_iter().filter(|run| run.stage == Stage::Final).collect();
    runs.iter().map(|run| saved::load(&Request { id: Some(&run.id), ..*request })).collect()
}
