//! Frequency with which learning does harm where there is nothing to learn, and helps where there is little; and
//! coverage of the intervals.
//!
//! ```text
//! cargo run --release -p acm-train --example nothing_to_learn -- [NOTHING [LITTLE [INTERVALS]]]      20, 10 and 0 where left out
//! ```
//!
//! Each set is learned from as `acm-train` learns: six folds, one final run, held-out trials once. What one gets is the
//! nominal model where the verdict says that no network is worth it, else the network of the final run. Intervals come from 18
//! development trials, each with a noise of its own size, and are to hold 90 % of 10 further trials.

mod planted;

use std::{error::Error, fs, process::ExitCode};

use acm_train::config;
use acm_train::run::evaluation::intervals;
use acm_train::run::evaluation::verdict::{self, Answer};
use acm_train::run::progress::Progress;
use acm_train::run::record::{RunRecord, Stage};
use acm_train::run::stop::Stop;
use acm_train::schedule::job;
use acm_train::schedule::request::Request;
use planted::{Planted, Residual};

/// Result of one data set.
struct Outcome {
    residual: Residual,
    /// Error of the final network on held-out trials, as a share of the nominal model's.
    network: f64,
    worth_it: bool,
    /// Gain over the folds and its standard error, as shares of the nominal model's error there.
    gain: [f64; 2],
    /// Level of the intervals, and the share of held-out samples that they cover, over both outputs.
    level: f64,
    held: f64,
}

impl Outcome {
    /// Returns the error of the model that the verdict selects, as a share of the nominal model's.
    fn got(&self) -> f64 {
        if self.worth_it { self.network } else { 1.0 }
    }
}

fn main() -> ExitCode {
    match study() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn study() -> Result<(), Box<dyn Error>> {
    let counts: Vec<u64> = std::env::args().skip(1).map(|text| text.parse()).collect::<Result<_, _>>()?;
    let count = |k: usize, otherwise: u64| counts.get(k).copied().unwrap_or(otherwise);
    let (nothing, little, scales) = (count(0, 20), count(1, 10), count(2, 0));
    let (progress, stop) = (Progress::new(true), Stop::on_signals()?);
    let of = |seed: u64| Residual::NOTHING[seed as usize % Residual::NOTHING.len()];
    let asked = (0..nothing).map(|seed| (seed, of(seed))).chain((0..little).map(|seed| (seed, Residual::Little)));
    let asked = asked.chain((0..scales).map(|seed| (seed, Residual::Scales)));
    let mut outcomes = vec![];
    for (seed, residual) in asked {
        let trials = if residual == Residual::Scales { [18, 10] } else { [6, 2] };
        let outcome = one(&Planted { seed, residual, trials }, &progress, &stop)?;
        println!(
            "{:>9} {seed:>3}: gain over folds {:.2} ± {:.2} %, network {:.4}, got {:.4} of the nominal error; {:.1} % intervals hold \
             {:.1} %",
            residual.name(),
            100.0 * outcome.gain[0],
            100.0 * outcome.gain[1],
            outcome.network,
            outcome.got(),
            100.0 * outcome.level,
            100.0 * outcome.held
        );
        outcomes.push(outcome);
    }
    for residual in Residual::NOTHING.into_iter().chain([Residual::Little]) {
        tell(residual.name(), outcomes.iter().filter(|one| one.residual == residual).collect());
    }
    tell("nothing", outcomes.iter().filter(|one| Residual::NOTHING.contains(&one.residual)).collect());
    tell_intervals(&outcomes.iter().filter(|one| one.residual == Residual::Scales).collect::<Vec<_>>());
    Ok(())
}

fn one(planted: &Planted, progress: &Progress, stop: &Stop) -> Result<Outcome, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    planted.write(&folder.path().join("data"))?;
    let file = folder.path().join("experiment.toml");
    fs::write(&file, planted::EXPERIMENT)?;
    let (experiment, source) = config::read(&file, &[])?;
    let out = folder.path().join("run");
    let records = job::run(experiment, &source, &Request::new(&out, progress, stop))?;
    let verdict = verdict::of(&records.iter().collect::<Vec<_>>()).ok_or("no records")?;
    let network = ratio(&records).ok_or("no final run")?;
    let intervals = intervals::of(&records.iter().collect::<Vec<_>>(), &out)?.ok_or("no intervals")?;
    let held: Vec<f64> = intervals.outputs.iter().filter_map(|of| of.held_out).collect();
    Ok(Outcome {
        residual: planted.residual,
        network,
        gain: [verdict.gain, verdict.standard_error].map(|gain| gain.unwrap_or(f64::NAN) / nominal(&records)),
        worth_it: verdict.answer == Answer::WorthIt,
        level: intervals.level,
        held: held.iter().sum::<f64>() / held.len() as f64,
    })
}

/// Returns the mean error of the nominal model on the trials that were left out.
fn nominal(records: &[RunRecord]) -> f64 {
    let errors = records.iter().filter(|record| record.stage != Stage::Final);
    let errors: Vec<f64> = errors.map(|record| record.validation.estimators["nominal"].rmse_total).collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}

fn ratio(records: &[RunRecord]) -> Option<f64> {
    let last = records.iter().find(|record| record.stage == Stage::Final)?;
    let estimators = &last.held_out.as_ref()?.estimators;
    Some(estimators.get(&last.experiment.kind())?.rmse_total / estimators.get("nominal")?.rmse_total)
}

fn tell_intervals(outcomes: &[&Outcome]) {
    let Some(first) = outcomes.first() else { return };
    let count = outcomes.len() as f64;
    let inside = outcomes.iter().filter(|one| (0.85..=0.95).contains(&one.held)).count() as f64;
    println!(
        "intervals: {} sets; said to hold {:.0} %, hold {:.1} % on the mean; 85 to 95 % in {:.0} % of the sets",
        outcomes.len(),
        100.0 * first.level,
        100.0 * outcomes.iter().map(|one| one.held).sum::<f64>() / count,
        100.0 * inside / count
    );
}

fn tell(name: &str, outcomes: Vec<&Outcome>) {
    let share = |holds: &dyn Fn(&Outcome) -> bool| {
        100.0 * outcomes.iter().filter(|one| holds(one)).count() as f64 / outcomes.len().max(1) as f64
    };
    println!(
        "{name:>9}: {} sets; at most 1.01 of the nominal error {:.1} % (the final network alone {:.1} %), better than nominal {:.1} % ({:.1} %), worth it {:.1} %",
        outcomes.len(),
        share(&|one| one.got() <= 1.01),
        share(&|one| one.network <= 1.01),
        share(&|one| one.got() < 1.0),
        share(&|one| one.network < 1.0),
        share(&|one| one.worth_it),
    );
}
