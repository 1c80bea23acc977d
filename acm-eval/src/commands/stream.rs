//! `acm-eval stream`: a trained network beside a robot, line by line.

use std::{
    io,
    path::{Path, PathBuf},
};

use acm_datasets::Domain;
use acm_datasets::files::{atomic, owned};
use acm_eval::{
    error::EvalError,
    stream::{
        best::{self, SavedBest},
        robot::Robot,
        saved::{Request, Saved, load},
        session::{Count, Session},
        wiring::Wiring,
    },
    terminal::print,
};
use acm_stream::{Average, Estimator};
use acm_train::store::hashed;
use clap::Args;

/// Above the options, in full.
pub const ABOUT: &str = "\
Estimates the outputs sample by sample, from lines on standard input, with a trained network

Reads samples as they come, as CSV with a header or as one JSON object a line, and answers each line at once: what the \
nominal model with the network says, and what the nominal model says alone. Columns are named as in the manifest, and \
values are in its units, both ways. Columns that are not needed are passed over, so a recording can be sent as it is.";

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval stream runs/cfc < trial.csv
      Answers of the network with the smallest validation loss, one line for each line of trial.csv
  robot-log | acm-eval stream runs/cfc | controller
      In a loop: an answer leaves before the next line is read
  echo '{\"t\": 0.0, \"q1\": 0.2, \"q2\": -0.1, \"altitude\": 1.2, \"throttle\": 0.5}' | acm-eval stream runs/cfc
      JSON objects instead of CSV
  acm-eval stream runs/cfc --network final-seed3 --windows < trial.csv
      A certain network; its state over windows as in training and scoring, not since the start
  acm-eval stream runs/best < trial.csv
      The winner of a study of the best model: the mean over its members and their final runs
  acm-eval stream runs/cfc --save robot.json
      For a program without files of runs and without burn: acm_stream::Parts::from_json(&bytes), which
      refuses a file with a changed bit, then acm_stream::Estimator::new(parts) and
      estimator.step(&inputs, elapsed), all in SI units; estimator.in_range() stands beside the answer, and is
      none where the file was saved before there were ranges. It knows no domain: the program decides
      between step and step_unseen. Of a study of the best model: acm_stream::AverageParts::from_json, and
      acm_stream::Average::new

What comes back, for outputs x, y, z:
  t,x,y,z,nominal_x,nominal_y,nominal_z,history,in_range
history counts the samples since the start or the last gap. Training scores a network once a window is
full, 50 samples by default: earlier answers rest on less. in_range says whether every channel of the
network lies between the smallest and the largest value that it had in training, rates of change among
them: true or false. Outside the network extrapolates, and its answer is worth nothing by itself.

A time between two samples over the experiment's windows.max_gap starts the network's state anew, as in
training; effects of the nominal model go on. An empty line begins a new trial. A line that is no sample is
answered by empty cells (or an object with \"error\") and a message on standard error, and changes nothing:
a cell that is no number, a number that is not finite or leads to one, a JSON line that is no object, a byte
that is not UTF-8, a line of more than 1 MiB, which is passed over to its end.
Where the actuators are outside of inputs.domain_filter, the network is not asked, as in training: the answer
is the nominal model's, with a history of 0. --everywhere asks it all the same.

Of a set of several sources, a line has the columns as the manifest names them (motors.q1) and `time` in s, all on the reference's
clock: bring them together first, as acm-data join does with recordings.

What a model with effects may need beside the recording's columns: acceleration_x, acceleration_y,
acceleration_z of the carrier, m/s^2. Rates of change see no future here: they are late by one sample.

The run's data set must be there: the scalers are computed from it, and it is checked to be the same.

Exit codes: 0 every line was answered; 2 usage; 3 data, or lines that were no sample; 4 file system.";

/// What may be asked for.
#[derive(Args)]
pub struct StreamArgs {
    /// Run folder, as acm-train wrote it, such as runs/cfc, or the folder of a study = "best"
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Which network of the run, such as final-seed1 [default: of the final ones that with the smallest validation loss]
    #[arg(long, value_name = "ID")]
    network: Option<String>,
    /// Give the network a window of samples for each answer, as it was scored; takes windows.length times as long
    #[arg(long)]
    windows: bool,
    /// Ask the network also outside of the experiment's inputs.domain_filter
    #[arg(long)]
    everywhere: bool,
    /// Write the estimator as JSON instead, for a program of your own with the crate acm-stream, and read no lines
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Folder with the tables of the run's data set, where they do not lie beside its manifest
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

/// Answers until standard input ends.
pub fn run(args: &StreamArgs) -> Result<(), EvalError> {
    if let Some(file) = &args.save {
        owned::claim(file, is_saved).map_err(EvalError::Table)?;
    }
    let request =
        Request { run: &args.run, id: args.network.as_deref(), data: args.data.as_deref(), windows: args.windows };
    if best::is_one(&args.run) {
        let SavedBest { parts, wiring, domain, id, title, .. } = best::load(&request)?;
        if let Some(file) = &args.save {
            return save(parts.to_json(), file);
        }
        let mean = Average::new(parts).map_err(|error| unfit(args, &error))?;
        return answer(args, Robot::Mean(mean), wiring, domain, &format!("{title}: {id}"));
    }
    let Saved { parts, wiring, domain, id, title, doubt } = load(&request)?;
    let estimator = Estimator::new(parts).map_err(|error| unfit(args, &error))?;
    if let Some(doubt) = doubt {
        eprintln!("warning: {doubt}");
    }
    if let Some(file) = &args.save {
        return save(estimator.parts().to_json(), file);
    }
    answer(args, Robot::One(Box::new(estimator)), wiring, domain, &format!("{title}: {id}"))
}

fn unfit(args: &StreamArgs, error: &impl std::fmt::Display) -> EvalError {
    EvalError::Data(format!("{}: {error}", args.run.display()))
}

fn answer(args: &StreamArgs, robot: Robot, wiring: Wiring, domain: Domain, who: &str) -> Result<(), EvalError> {
    eprintln!("{who} of {}, waiting for {}", args.run.display(), wanted(&wiring));
    let mut session = Session::new(robot, wiring, (!args.everywhere).then_some(domain));
    let Count { answered, refused } =
        session.run(io::stdin().lock(), io::stdout().lock(), |line| eprintln!("{line}"))?;
    match refused {
        0 => Ok(()),
        _ => Err(EvalError::Data(format!("{refused} of {} lines were no sample; see above", answered + refused))),
    }
}

/// Saves the estimator in one file that needs neither the run nor its data.
fn save(bytes: serde_json::Result<Vec<u8>>, file: &Path) -> Result<(), EvalError> {
    let bytes = bytes.map_err(|error| EvalError::write(file, error.into()))?;
    atomic::write_bytes(file, &bytes).map_err(EvalError::Table)?;
    print(&file.display().to_string())
}

/// Returns whether a file begins as an estimator or an average does that was saved.
fn is_saved(head: &[u8]) -> bool {
    ["signals", "inputs"].iter().any(|key| hashed::begins(head, key))
}

/// Returns the columns that lines must have, with their units.
fn wanted(wiring: &Wiring) -> String {
    let columns = wiring.time().into_iter().chain(&wiring.inputs);
    columns.map(|column| format!("{} [{}]", column.name, column.unit.name)).collect::<Vec<_>>().join(", ")
}
