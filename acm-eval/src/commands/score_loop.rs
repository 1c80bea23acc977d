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

use acm_datasets::atomic;
use acm_eval::{
    error::EvalError,
    loop_config::LoopConfig,
    scoring::{
        Answer, Figures, Plan, RigScore, Score, Seeds, attempt, attempt_several, attempt_small_rig, heading, line,
        rig_heading, rig_line, rig_table, several_heading, several_line, several_table, several_tasks, table,
    },
    terminal::print,
};
use acm_sim::small_rigs::Kind as RigKind;
use acm_sim::twin::undeclared::{Design, Kind};
use acm_trace::trace::Options;
use clap::{Args, ValueEnum};
use serde::Serialize;
use serde_json::Value;

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval score-loop                             60 seeds of each design, and what they come to
  acm-eval score-loop --seeds 0 --nulls 60        false alarms where nothing is the matter
  acm-eval score-loop --without-own               does it abstain when it does not know the effect?
  acm-eval score-loop --kind backlash --seeds 5   five campaigns of each design with backlash
  acm-eval score-loop --several 20                20 campaigns of each design with two to six causes
  acm-eval score-loop --small-rigs 10             ten rigs of each of seven kinds beside the arm
  acm-eval score-loop --first-seed 1007 --seeds 1 --design rich
      One line again. `acm-data generate --undeclared 1007` writes that campaign out.

A line of a campaign: errors on held-out trials in mm, `before` the best of nominal, static map and
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
    /// Instead: so many campaigns of each design with two to six causes, and how right the names are that are sure
    #[arg(long, value_name = "N", conflicts_with_all = ["kinds", "without_own", "nulls", "first_seed"])]
    several: Option<u64>,
    /// Instead: so many small rigs of each of seven kinds, beside what whoever knows their structure predicts
    #[arg(long, value_name = "N", conflicts_with_all = ["kinds", "without_own", "nulls", "first_seed"])]
    small_rigs: Option<u64>,
    /// Seeds of these: development (from 14001 on), or report (from 15001 on; never to choose anything by)
    #[arg(long, value_enum, default_value_t = List::Development, value_name = "LIST")]
    seed_list: List,
    /// Change the search, such as search.samples=8000; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Folder for score.json, several.json or small_rigs.json, which have every row
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Campaigns at the same time; each uses all cores where it can
    #[arg(long, default_value = "1", value_name = "N")]
    jobs: NonZeroUsize,
}

#[derive(Clone, Copy, ValueEnum)]
enum List {
    Development,
    Report,
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
    let configuration = serde_json::json!({ "effects": config.effects, "search": config.search });
    if let Some(many) = args.several {
        several(args, many, &config.options(), &configuration)?;
    }
    if let Some(many) = args.small_rigs {
        small_rigs(args, many, &config.options(), &configuration)?;
    }
    if args.several.is_some() || args.small_rigs.is_some() {
        return Ok(());
    }
    let tasks = plan(args).tasks();
    print(&heading())?;
    let rows = attempts(&tasks, args.jobs, |task| attempt(task, &config.options()), line)?;
    let score = Score::new(rows, configuration);
    print(&format!("\n{}", table(&score)))?;
    keep(args, "score.json", &score)
}

/// Campaigns of two to six causes.
fn several(args: &ScoreArgs, many: u64, options: &Options, configuration: &Value) -> Result<(), EvalError> {
    let tasks = several_tasks(seeds(args), many, &designs(args));
    print(&several_heading())?;
    let rows = attempts(&tasks, args.jobs, |task| attempt_several(task, options), several_line)?;
    let answers: Vec<Answer> = rows.iter().map(|row| row.answer.clone()).collect();
    let figures = Figures::new(&answers);
    print(&format!("\n{}", several_table(&figures)))?;
    let score = serde_json::json!({
        "format": 1, "version": env!("CARGO_PKG_VERSION"), "configuration": configuration, "seeds": seeds(args),
        "figures": figures, "rows": rows,
    });
    keep(args, "several.json", &score)
}

/// Small rigs of every kind.
fn small_rigs(args: &ScoreArgs, many: u64, options: &Options, configuration: &Value) -> Result<(), EvalError> {
    let of = |kind: RigKind| seeds(args).take(many).map(move |seed| (kind, seed));
    let tasks: Vec<(RigKind, u64)> = RigKind::ALL.into_iter().flat_map(of).collect();
    print(&rig_heading())?;
    let rows = attempts(&tasks, args.jobs, |task| attempt_small_rig(*task, options), rig_line)?;
    let figures = RigScore::new(&rows);
    print(&format!("\n{}", rig_table(&figures)))?;
    let score = serde_json::json!({
        "format": 1, "version": env!("CARGO_PKG_VERSION"), "configuration": configuration, "seeds": seeds(args),
        "figures": figures, "rows": rows,
    });
    keep(args, "small_rigs.json", &score)
}

fn seeds(args: &ScoreArgs) -> Seeds {
    match args.seed_list {
        List::Development => Seeds::Development,
        List::Report => Seeds::Report,
    }
}

/// Writes a score where a folder is named.
fn keep(args: &ScoreArgs, name: &str, score: &impl Serialize) -> Result<(), EvalError> {
    let Some(out) = &args.out else { return Ok(()) };
    let file = out.join(name);
    let text = serde_json::to_vec_pretty(score).map_err(|e| EvalError::write(&file, e.into()))?;
    atomic::write_bytes(&file, &text).map_err(EvalError::Table)?;
    print(&file.display().to_string())
}

fn designs(args: &ScoreArgs) -> Vec<Design> {
    match args.design {
        Designs::Rich => vec![Design::Rich],
        Designs::Paper => vec![Design::Paper],
        Designs::Both => vec![Design::Rich, Design::Paper],
    }
}

fn plan(args: &ScoreArgs) -> Plan {
    Plan {
        seeds: args.seeds,
        first: args.first_seed,
        designs: designs(args),
        kinds: args.kinds.clone(),
        nulls: args.nulls,
        without_own: args.without_own,
    }
}

/// Rows in the order of the tasks, whichever was done first.
fn attempts<K: Sync, T: Send>(
    tasks: &[K],
    jobs: NonZeroUsize,
    attempt: impl Fn(&K) -> Result<T, EvalError> + Sync,
    line: impl Fn(&T) -> String + Sync,
) -> Result<Vec<T>, EvalError> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Result<T, EvalError>)>> = Mutex::new(Vec::new());
    let work = || {
        while let Some((k, task)) = {
            let k = next.fetch_add(1, Ordering::SeqCst);
            tasks.get(k).map(|task| (k, task))
        } {
            let row = attempt(task);
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
