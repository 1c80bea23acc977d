//! `acm-eval score-loop`: how well close-loop finds effects that it was not told of.

use std::{
    io::Write,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use acm_datasets::{
    atomic,
    twin::undeclared::{Design, Kind},
};
use acm_eval::{
    error::EvalError,
    loop_config::LoopConfig,
    scoring::{Plan, Row, Score, Task, attempt, heading, line, table},
    terminal::print,
};
use acm_trace::trace::Options;
use clap::{Args, ValueEnum};

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval score-loop                             60 seeds of each design, and what they come to
  acm-eval score-loop --seeds 0 --nulls 60        false alarms where nothing is the matter
  acm-eval score-loop --without-own               does it abstain when it does not know the effect?
  acm-eval score-loop --kind backlash --seeds 5   five campaigns of each design with backlash
  acm-eval score-loop --first-seed 1007 --seeds 1 --design rich
      One line again. `acm-data generate --undeclared 1007` writes that campaign out.

A line of a campaign: errors on untouched trials in mm, `before` the best of nominal, static map and
recalibrated; F is the share of the removable error that is gone.
  top-1   ok: the true name. alias: a name that these data cannot tell from it. WRONG, none.
          quiet: nothing is named for sure where nothing should be. FALSE: something is named there.
          spur.: an effect is found where nothing is the matter, and not named for sure.
  set     whether the truth is among the names found and those that explain as much (one: of two).
  since   start: acts in all trials. after: not while the nominal model was calibrated.
  found   first = what explains as much, then the others.

Exit codes: 0 done, whatever the score; 2 usage; 4 file system.";

/// What may be asked for.
#[derive(Args)]
pub struct ScoreArgs {
    /// Campaigns of each design; a seed draws what is the matter, so that twenty in a row hold a fixed share of each class
    #[arg(long, default_value_t = 60, value_name = "N")]
    seeds: u64,
    /// Seed of the first campaign
    #[arg(long, default_value_t = 1001, value_name = "SEED")]
    first_seed: u64,
    /// How actuators and vehicle move: rich (speeds, steps and altitudes vary), paper (they hardly do)
    #[arg(long, value_enum, default_value_t = Designs::Both)]
    design: Designs,
    /// What is the matter, dealt in turn instead of drawn: backlash, slip, backlash+creep, white,
    /// several3, …
    #[arg(long = "kind", value_name = "NAME", num_args = 1.., value_parser = kind)]
    kinds: Vec<Kind>,
    /// Take the true effect's own entry out of the library, and count how often nothing is named for sure
    #[arg(long)]
    without_own: bool,
    /// As many more campaigns of each design with nothing the matter: white noise, coloured noise, 16 mm of misfit,
    /// encoder noise, unrecorded offsets
    #[arg(long, default_value_t = 0, value_name = "N")]
    nulls: u64,
    /// Change the search, such as search.samples=8000; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Folder for score.json, which has every row
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Campaigns at the same time; each uses all cores where it can
    #[arg(long, default_value = "1", value_name = "N")]
    jobs: NonZeroUsize,
}

#[derive(Clone, Copy, ValueEnum)]
enum Designs {
    Rich,
    Paper,
    Both,
}

fn kind(name: &str) -> Result<Kind, String> {
    let known = || Kind::all().into_iter().map(Kind::name).collect::<Vec<String>>().join(" ");
    Kind::find(name).ok_or_else(|| format!("there is no such kind; known: {}", known()))
}

/// Prints a line as each campaign is done, then the table.
pub fn run(args: &ScoreArgs) -> Result<(), EvalError> {
    let (config, _) = LoopConfig::for_folder(Path::new("."), &args.set)?;
    let tasks = plan(args).tasks();
    print(&heading())?;
    let rows = attempts(&tasks, &config.options(), args.jobs)?;
    let configuration = serde_json::json!({ "effects": config.effects, "search": config.search });
    let score = Score::new(rows, configuration);
    print(&format!("\n{}", table(&score)))?;
    if let Some(out) = &args.out {
        let file = out.join("score.json");
        let text = serde_json::to_vec_pretty(&score).map_err(|e| EvalError::write(&file, e.into()))?;
        atomic::write_bytes(&file, &text).map_err(EvalError::Table)?;
        print(&file.display().to_string())?;
    }
    Ok(())
}

fn plan(args: &ScoreArgs) -> Plan {
    let designs = match args.design {
        Designs::Rich => vec![Design::Rich],
        Designs::Paper => vec![Design::Paper],
        Designs::Both => vec![Design::Rich, Design::Paper],
    };
    Plan {
        seeds: args.seeds,
        first: args.first_seed,
        designs,
        kinds: args.kinds.clone(),
        nulls: args.nulls,
        without_own: args.without_own,
    }
}

/// Rows in the order of the plan, whichever was done first.
fn attempts(tasks: &[Task], options: &Options, jobs: NonZeroUsize) -> Result<Vec<Row>, EvalError> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Result<Row, EvalError>)>> = Mutex::new(Vec::new());
    let work = || {
        while let Some((k, task)) = {
            let k = next.fetch_add(1, Ordering::SeqCst);
            tasks.get(k).map(|task| (k, task))
        } {
            let row = attempt(task, options);
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            match &row {
                // A reader that went away is no reason to stop.
                Ok(row) => drop(writeln!(std::io::stdout(), "{}", line(row))),
                Err(_) => next.store(tasks.len(), Ordering::SeqCst),
            }
            done.push((k, row));
        }
    };
    thread::scope(|scope| (0..jobs.get()).for_each(|_| drop(scope.spawn(work))));
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(k, _)| *k);
    done.into_iter().map(|(_, row)| row).collect()
}
