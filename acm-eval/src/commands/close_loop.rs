//! `acm-eval close-loop`: from recordings and a nominal model to the physical effect that the model lacks.

use acm_eval::closed_loop;
use acm_eval::closed_loop::folder::LoopFolder;
use acm_eval::error::EvalError;
use acm_eval::network_table::Trainings;
use acm_eval::question::Asked;
use acm_eval::terminal::print;
use acm_train::run::{progress::Progress, stop::Stop};

use super::steps::Steps;

/// Text above the options, in full.
pub const ABOUT: &str = "\
Finds the physical effect that a nominal model lacks, and reports the error before and after

Takes recordings and a nominal model, looks at what the model misses, traces it to an effect (a dead time, backlash, a tip \
load, …), puts that effect at its place, fits everything again, and compares on trials that took no part. Or it \
reports that nothing is missing, that no known effect fits, or that these data cannot tell two effects apart.";

/// Examples below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval close-loop my-robot
      Your recordings: a folder with manifest.toml. Result: runs/loop-my-robot/loop.html
  acm-eval close-loop my-robot --data ~/recordings --out first
      The same, with the tables elsewhere, into a folder of your choice.
  acm-eval close-loop my-robot --set search.max_effects=2 --set 'effects.without=[\"creep\"]'
      Two effects at most, and no creep; each --set is a line of a configuration.
  acm-eval close-loop my-robot --effects my_effects.toml
      Effects of your own beside those of the library: equations in a file, with units.
  acm-eval close-loop --config experiments/close-the-loop.toml
      A question in a file, with networks on top.

Your own recordings: write a manifest.toml beside your CSV files. A small one:
  [table]
  files = [\"*.csv\"]                # one file a trial, named after it
  trial = { file = \"(.*)\" }
  time  = { column = \"t\", unit = \"s\" }
  [[actuator]]                     # what is commanded or read back
  column = \"q1\"
  unit   = \"rad\"
  [[measured]]                     # positions, angles, forces, …
  column = \"x\"
  unit   = \"mm\"
  [roles]
  calibration = [\"slow\"]
  development = [\"run1\", \"run2\", \"run3\"]
  held_out    = [\"run4\"]
What else is known at each sample (pressure, throttle, altitude) is a [[context]]; your own model's
prediction is a [[predicted]]; [arm] describes a continuum arm. Without the last two the nominal
model is a polynomial. `acm-data check my-robot` tells what is wrong with a manifest or a table.

What the roles do:
  calibration   Fits the nominal model: slow, or at rest. May be left out; that is weaker.
  development   Here the effect is found. Move every actuator, at several speeds, with reversals
                and pauses; three trials or more.
  held_out      Takes no part until the final numbers. Without any, the last 30 % of each
                development trial are held out.

A configuration names only what differs from the defaults:
  question = \"What does the nominal model lack?\"
  data     = \"my-robot\"
  [nominal]                        # model, degree, length, ...
  degree = 2
  [effects]                        # only = [...], without = [...], file = \"my_effects.toml\"
  without = [\"creep\"]
  [search]                         # max_effects, samples, seed
  max_effects = 3
  [networks]                       # nominal, + effect, + network, + both
  experiment = \"experiments/cfc.toml\"
Of that experiment, data and [nominal] are the loop's own.

Results in DIR: loop.html for people, with its figures (figures/, SVG and PNG) and tables (tables/, CSV)
beside it, loop.json for programs, and model.json, the nominal model with its effects (refuted.json where
held-out trials refute it): acm-train takes it as
[nominal] augmented = \"DIR/model.json\", with recordings of the same robot; it refuses others by their
signals and [arm], and tells where ranges are left. An earlier result is
replaced once the new one is complete; a folder that holds anything else is left alone.

Exit codes: 0 done, whatever was found; 2 usage or configuration; 3 data, with file, row and
column; 4 file system; 5 DIR is in use; 130 stopped by Ctrl-C while networks were trained: the same
command continues.";

/// Writes the result; prints the summary and where the page is.
pub fn run(asked: &Asked) -> Result<(), EvalError> {
    let question = asked.read("loop", |warning| eprintln!("warning: {warning}"))?;
    let trainings = Trainings::of(&question.config, &question.source, &question.campaign, asked.data.as_deref())?;
    let out = LoopFolder::claim(&question.out)?;
    let steps = Steps::new(&question.recordings.case.rig);
    steps.begin("calibrating the nominal model, and looking at what it misses");
    let closed = question.close(|step| steps.tried(step));
    steps.end();
    let mut closed = closed?;
    let mut page = out.write(&closed)?;
    if let Some(trainings) = trainings {
        page = trainings.add(&mut closed, &out, &Progress::new(false), &Stop::on_signals()?)?;
    }
    print(&format!("{}\n\n{}", closed_loop::summary(&closed.finding), page.display()))
}
