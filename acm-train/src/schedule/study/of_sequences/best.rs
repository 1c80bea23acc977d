//! Choice of the best of several questions about the same sequences.
//!
//! ```text
//! runs/<name>/
//!   study.json                  StudyRecord: every question that was run
//!   best.json                   BestOfSequences: every candidate, what was chosen, and its test scores
//!   predictions/best.parquet    predictions of the winner for the test part
//!   runs/<base>/                a run folder of each question
//! ```
//!
//! 1. The networks of each base are trained. They are scored on the validation part alone.
//! 2. Candidates are the prediction without a network ([`constant`]), the mean over the seeds of each base, regressions on the last
//!    steps ([`regressions`]), and averages ([`crate::schedule::study::best::average`]).
//! 3. The simplest candidate within one standard error of the best, or 1 % of its error, is chosen
//!    ([`crate::schedule::study::best::candidate`]). Errors are paired by sequence. It has to be better than the prediction without a
//!    network by more than chance (95 %); else that prediction is chosen.
//! 4. The winner predicts the test part, once. With `test = false` the study ends before.

mod constant;
mod features;
mod judged;
pub mod record;
mod regressions;
mod ridge;
pub mod text;
mod trees;

use acm_datasets::files::table::write_parquet;
use nalgebra::DMatrix;

use self::constant::Constant;
use self::judged::Judged;
use self::record::{BestOfSequences, Tested};
use self::regressions::Regression;
use crate::config::{Kind, Loss, Question, Source, read_question};
use crate::learn::ensemble;
use crate::run::RunError;
use crate::run::record::{FORMAT, Versions, versions::versions};
use crate::run::sequences::plan::{Plan, plans};
use crate::run::sequences::record::DataRecord;
use crate::run::sequences::scores::{scores, targets};
use crate::run::sequences::together::predicted;
use crate::run::sequences::train::{Runs, columns};
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::request::{Engine, Request};
use crate::schedule::sequences::{Answered, answer};
use crate::schedule::study::best::average::{self, Pool};
use crate::schedule::study::best::candidate::{Candidate, choose};
use crate::schedule::study::best::record::FILE;
use crate::schedule::study::fold_errors::FoldErrors;
use crate::schedule::study::list::{Base, List, slug};
use crate::schedule::study::paired::Difference;
use crate::schedule::study::record::{MemberRecord, StudyRecord, folder};
use crate::store::{StoreError, StudyFolder, hashed};

/// Finds the model to be used, and returns the table with the reasons.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(list: &List, source: &Source, request: &Request) -> Result<String, ScheduleError> {
    let asked = list.best.clone().unwrap_or_default();
    if asked.robot || asked.augmented.is_some() {
        let key = if asked.robot { "robot" } else { "loop" };
        return Err(usage(
            format!("best.{key} is set, and the bases are questions about sequences"),
            "delete it: sequences have neither a robot nor a nominal model",
        ));
    }
    if !matches!(request.engine, Engine::Local) {
        return Err(usage(
            "lists of questions about sequences are computed here".into(),
            "leave --engine out, or submit the questions one by one",
        ));
    }
    let study = StudyFolder::hold(request.out, request.hold())?;
    let entrants = list.base.iter().map(|base| Entrant::new(list, source, base)).collect::<Result<Vec<_>, _>>()?;
    let members = entrants.iter().map(Entrant::member).collect();
    let (question, config) = (list.question.clone(), source.file_name());
    let stamp = StudyRecord { format: FORMAT, kind: Kind::Best, question, config, members };
    hashed::write(&study.path("study.json"), &stamp)?;
    let trained = train(&entrants, request)?;
    let (candidates, steps, places) = compare(&trained, asked.average);
    let test = match entrants.iter().all(|entrant| entrant.tests) {
        true => Some(test(&entrants, &trained, &places, &study, request)?),
        false => None,
    };
    let record = BestOfSequences {
        format: FORMAT,
        kind: Kind::Best,
        question: stamp.question,
        config: stamp.config,
        sequences: trained.data,
        versions: trained.versions,
        loss: if entrants[0].question.loss == Loss::CrossEntropy { "cross-entropy" } else { "MSE" }.into(),
        units: trained.judged.count(),
        candidates,
        steps,
        test,
    };
    hashed::write(&study.path(FILE), &record)?;
    Ok(text::of(&record, request.out))
}

fn usage(what: String, help: &str) -> ScheduleError {
    ScheduleError::Usage { what, help: help.into() }
}

/// A base: its question without test and control.
struct Entrant {
    name: String,
    source: Source,
    question: Question,
    /// Whether its file asks for a test.
    tests: bool,
}

impl Entrant {
    fn new(list: &List, source: &Source, base: &Base) -> Result<Self, ScheduleError> {
        let mut source = list.source_of(source, base, "", &[])?;
        let question = read_question(&mut source)?;
        let tests = question.test;
        Ok(Self {
            name: base.name.clone(),
            source,
            question: Question { test: false, control: None, ..question },
            tests,
        })
    }

    fn member(&self) -> MemberRecord {
        MemberRecord { id: slug(&self.name), base: self.name.clone(), variant: String::new(), values: vec![] }
    }

    /// Returns its sequences and finished runs.
    fn trained(&self, request: &Request) -> Result<Answered, ScheduleError> {
        self.answer(&Request { resume: true, ..*request }, false)
    }

    /// Runs its question.
    fn answer(&self, request: &Request, told: bool) -> Result<Answered, ScheduleError> {
        let out = folder(request.out, &slug(&self.name));
        match answer(&self.question, &self.source, &Request { out: &out, ..*request }, told)? {
            Answer::Finished(answered) => Ok(answered),
            Answer::Waiting(text) => Err(usage(text, "leave --engine out")),
        }
    }
}

/// Predictions of all entrants for the validation part.
struct Trained {
    data: DataRecord,
    versions: Versions,
    judged: Judged,
    /// Names, the prediction without a network first.
    names: Vec<String>,
    /// Fitted numbers.
    numbers: Vec<usize>,
    /// Predictions [N×O].
    predicted: Vec<DMatrix<f64>>,
    /// Regressions on the inputs of the first entrant, whose places are behind the entrants.
    regressions: Vec<Regression>,
}

/// Trains the networks of all entrants, then fits the regressions.
fn train(entrants: &[Entrant], request: &Request) -> Result<Trained, ScheduleError> {
    let mut trained: Option<Trained> = None;
    for entrant in entrants {
        let Answered { data, set, records, folder, .. } = entrant.answer(request, trained.is_none())?;
        let judged = Judged::new(&set.validation, entrant.question.loss);
        let own = trained.get_or_insert_with(|| {
            let constant = Constant::of(&entrant.question, &set);
            Trained {
                data,
                versions: versions(),
                judged: Judged::new(&set.validation, entrant.question.loss),
                names: vec![constant.name().into()],
                numbers: vec![constant.numbers()],
                predicted: vec![constant.predict(&set.validation)],
                regressions: vec![],
            }
        });
        if !own.judged.same(&judged) {
            return Err(usage(
                format!("{:?} has other targets than {:?}", entrant.name, entrants[0].name),
                "give all bases the same targets, parts and loss; inputs may differ",
            ));
        }
        let said = records.iter().map(|record| predicted(&folder.root().join(&record.predictions), &set, record));
        own.predicted.push(ensemble::mean(said.collect::<Result<Vec<_>, _>>()?));
        own.names.push(entrant.name.clone());
        own.numbers.push(records.iter().map(|record| record.parameters).sum());
    }
    let mut trained = trained.expect("a list has a base");
    let Answered { set, .. } = entrants[0].trained(request)?;
    let constant = Constant::of(&entrants[0].question, &set);
    trained.regressions = regressions::fit(&set, &constant, &trained.judged, entrants[0].question.loss)?;
    for regression in &trained.regressions {
        trained.predicted.push(regression.predict(&set.validation));
        trained.names.push(regression.name().into());
        trained.numbers.push(regression.numbers());
    }
    Ok(trained)
}

/// Returns all candidates, the steps to the averages, and the places of the members of the chosen one.
fn compare(trained: &Trained, most: usize) -> (Vec<Candidate>, Vec<average::Step>, Vec<usize>) {
    let mean = |places: &[usize]| ensemble::mean(places.iter().map(|&place| trained.predicted[place].clone()));
    let errors = |places: &[usize]| trained.judged.errors(&mean(places));
    let all: Vec<usize> = (0..trained.names.len()).collect();
    let pool = Pool { names: &trained.names, may: &all, error: |places: &[usize]| errors(places).mean() };
    let (averages, steps) = average::grow(&pool, most);
    let sets: Vec<Vec<usize>> = all.iter().map(|&place| vec![place]).chain(averages).collect();
    let candidate = |places: &Vec<usize>| {
        let names = places.iter().map(|&place| trained.names[place].clone()).collect();
        Candidate::new(names, places.iter().map(|&place| trained.numbers[place]).sum(), errors(places))
    };
    let mut candidates: Vec<Candidate> = sets.iter().map(candidate).collect();
    let mut chosen = choose(&mut candidates, false);
    if !is_better(&candidates[chosen].errors, &candidates[0].errors) {
        candidates[chosen].chosen = false;
        (candidates[0].as_good, candidates[0].chosen, chosen) = (true, true, 0);
    }
    (candidates, steps, sets[chosen].clone())
}

/// Returns whether errors are smaller than those without a network: the 95 % interval of the difference, paired by sequence, lies
/// below zero. One standard error would not do, for each network has chosen its epoch on the same sequences.
fn is_better(own: &FoldErrors, without: &FoldErrors) -> bool {
    let pairs: Vec<(f64, f64)> = without.0.iter().copied().zip(own.0.iter().copied()).collect();
    Difference::of(&pairs).is_some_and(|difference| difference.mean + difference.reach.unwrap_or(0.0) < 0.0)
}

/// Lets the winner, the mean of the candidates at `places`, predict the test part.
fn test(
    entrants: &[Entrant],
    trained: &Trained,
    places: &[usize],
    study: &StudyFolder,
    request: &Request,
) -> Result<Tested, ScheduleError> {
    let stopped = || ScheduleError::Stopped { folder: request.out.into(), finished: 0, planned: places.len() };
    // All entrants have these targets.
    let Answered { set, .. } = entrants[0].trained(request)?;
    let constant = Constant::of(&entrants[0].question, &set);
    let mut said = vec![];
    for &place in places {
        if place == 0 {
            said.push(constant.predict(&set.test));
            continue;
        }
        let Some(entrant) = entrants.get(place - 1) else {
            said.push(trained.regressions[place - 1 - entrants.len()].predict(&set.test));
            continue;
        };
        let own = entrant.trained(request)?;
        let runs = Runs::new(&entrant.question, &own.data, &own.set, &own.folder, request.progress, request.stop);
        let seeds = plans(&entrant.question);
        let of_seed = |plan: &Plan| runs.predict_test(plan)?.ok_or_else(stopped);
        said.push(ensemble::mean(seeds.iter().map(of_seed).collect::<Result<Vec<_>, ScheduleError>>()?));
    }
    let loss = entrants[0].question.loss;
    let winner = ensemble::mean(said);
    let path = study.path("predictions/best.parquet");
    let folder = path.parent().expect("below the study");
    std::fs::create_dir_all(folder).map_err(|error| StoreError::io("make", folder, error))?;
    write_parquet(&path, &columns(loss, &set.outputs, &[("test", &set.test, &winner)])).map_err(RunError::from)?;
    let score = |said: &DMatrix<f64>| scores(set.test.len(), said, &targets(&set.test), loss);
    Ok(Tested {
        winner: score(&winner),
        constant_name: trained.names[0].clone(),
        constant: score(&constant.predict(&set.test)),
        predictions: "predictions/best.parquet".into(),
        predictions_sha256: hashed::of_file(&path)?,
    })
}
