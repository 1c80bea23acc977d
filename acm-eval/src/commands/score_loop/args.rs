//! Options of `acm-eval score-loop`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use acm_eval::question::criteria;
use acm_eval::scoring::Seeds;
use acm_eval::scoring::figures::Look;
use acm_sim::twin::undeclared::{ALL_NULLS, Design, INSIDE, Kind, OUTSIDE, PAIRS};
use acm_trace::search::criteria::Criteria;
use clap::{Args, ValueEnum};

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval score-loop --kind inside             one cause, 60 campaigns of each design: top-1, truth in set
  acm-eval score-loop --several 60              two to six causes: precision, recall, F of each design
  acm-eval score-loop --seeds 0 --nulls 1000    names where no effect is present, also of the first 200
  acm-eval score-loop --kind outside            a cause that the library lacks: no sure wrong name
  acm-eval score-loop --kind inside --without-own
      The same with the true effect's own entry taken out of the library.
  acm-eval score-loop --small-rigs 10           ten rigs of each of seven kinds beside the arm
  acm-eval score-loop --pool runs/score --figure runs/score/reliability
      Runs nothing: rows of earlier runs together, and their reliability diagram (SVG, PNG).
  acm-eval score-loop --pool runs/a runs/b      figures of each folder, one row each
  acm-eval score-loop --criterion price=0.05 --several 5
      A constant of the search changed; an unknown name lists those that there are.
  acm-eval score-loop --aliases acm-eval/src/scoring/aliases/table.json
      Measures which effects these data cannot distinguish, and writes the table.
  acm-eval score-loop --first-seed 14007 --seeds 1 --design rich
      One line again. `acm-data generate --undeclared 14007` writes that campaign out.

Seeds are those of one list: development (14001 on), with which rules may be chosen, or report (37001 on), for \
published figures only.

With --out, each row is written when it is done, and the same command continues an interrupted run.

A line of a campaign: errors on held-out trials in mm, `before` the best of nominal, static map and
recalibrated; F is the share of the removable error that is gone.
  top-1   ok: the true name. alias: a name that these data cannot distinguish from it. WRONG, none.
          quiet: nothing is named for sure where nothing should be. FALSE: something is named there.
          spur.: an effect is found where none is present, and not named for sure.
  set     whether the truth is among the names found and those that explain as much (one: of two).
  since   start: acts in all trials. after: not while the nominal model was calibrated.
  found   first = what explains as much, then the others.

Exit codes: 0 done, whatever the score; 2 usage; 4 file system.";

/// Options of the command.
#[derive(Args)]
pub struct ScoreArgs {
    /// Campaigns of each design
    #[arg(long, default_value_t = 60, value_name = "N")]
    pub seeds: u64,
    /// Seed of the first campaign, instead of the first of the list
    #[arg(long, value_name = "SEED")]
    pub first_seed: Option<u64>,
    /// How actuators and vehicle move: rich (speeds, steps and altitudes vary), paper (they hardly do)
    #[arg(long, value_enum, default_value_t = Designs::Both)]
    pub design: Designs,
    /// Mechanisms, dealt in turn instead of drawn: backlash, slip, backlash+creep, white,
    /// several3, …, or all of a group: inside, outside, pairs, nulls
    #[arg(long = "kind", value_name = "NAME", num_args = 1.., value_parser = kinds)]
    pub kinds: Vec<Kinds>,
    /// Take the true effect's own entry out of the library, and count how often nothing is named for sure
    #[arg(long)]
    pub without_own: bool,
    /// Number of further campaigns without an effect: white noise, coloured noise, 16 mm of misfit,
    /// encoder noise, unrecorded offsets in turn, designs in turn
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub nulls: u64,
    /// Instead: this many campaigns of each design with two to six causes, and how often sure names are right
    #[arg(long, value_name = "N", conflicts_with_all = ["kinds", "without_own", "nulls", "first_seed"])]
    pub several: Option<u64>,
    /// Instead: this many small rigs of each of seven kinds, beside an oracle fit of the true structure
    #[arg(long, value_name = "N", conflicts_with_all = ["kinds", "without_own", "nulls", "first_seed"])]
    pub small_rigs: Option<u64>,
    /// Seeds of these: development (from 14001 on), or report (from 37001 on; not for choosing anything)
    #[arg(long, value_enum, default_value_t = List::Development, value_name = "LIST")]
    pub seed_list: List,
    /// Change the search, such as search.samples=8000; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Change a constant of the search, such as price=0.05; may be repeated
    #[arg(long = "criterion", value_name = "NAME=VALUE", value_parser = criterion)]
    pub criteria: Vec<String>,
    /// Folder for the rows, a line each (single.jsonl, several.jsonl, small_rigs.jsonl), and the figures (.json)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Campaigns at the same time; each uses all cores where it can
    #[arg(long, default_value = "1", value_name = "N")]
    pub jobs: NonZeroUsize,
    /// Run nothing: figures over the rows of folders that --out named
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["several", "small_rigs", "kinds", "out"])]
    pub pool: Vec<PathBuf>,
    /// Draw the reliability diagram of the rows: NAME.svg and NAME.png
    #[arg(long, value_name = "NAME")]
    pub figure: Option<PathBuf>,
    /// Print tables as Markdown
    #[arg(long)]
    pub markdown: bool,
    /// Instead: measure which effects data of each kind cannot distinguish, and write the table to FILE
    #[arg(long, value_name = "FILE", conflicts_with_all = ["several", "small_rigs", "kinds", "pool", "out", "figure"])]
    pub aliases: Option<PathBuf>,
}

/// A list of seeds.
#[derive(Clone, Copy, ValueEnum)]
pub enum List {
    Development,
    Report,
}

/// Designs that are tried.
#[derive(Clone, Copy, ValueEnum)]
pub enum Designs {
    Rich,
    Paper,
    Both,
}

/// One kind, or all of a group.
#[derive(Clone)]
pub struct Kinds(Vec<Kind>);

fn kinds(name: &str) -> Result<Kinds, String> {
    let ones = |causes: &[_]| causes.iter().copied().map(Kind::One).collect();
    let known = || Kind::all().into_iter().map(Kind::name).collect::<Vec<String>>().join(" ");
    Ok(Kinds(match name {
        "inside" => ones(&INSIDE),
        "outside" => ones(&OUTSIDE),
        "pairs" => PAIRS.into_iter().map(|(one, two)| Kind::Two(one, two)).collect(),
        "nulls" => ALL_NULLS.into_iter().map(Kind::Null).collect(),
        name => {
            let kind = Kind::find(name);
            let unknown = || format!("there is no such kind; known: inside outside pairs nulls {}", known());
            vec![kind.ok_or_else(unknown)?]
        }
    }))
}

fn criterion(edit: &str) -> Result<String, String> {
    criteria::set(&mut Criteria::default(), edit).map(|()| edit.to_string())
}

impl ScoreArgs {
    /// Returns the list of seeds.
    pub fn seeds_of(&self) -> Seeds {
        match self.seed_list {
            List::Development => Seeds::Development,
            List::Report => Seeds::Report,
        }
    }

    /// Returns the designs, richest first.
    pub fn designs(&self) -> Vec<Design> {
        match self.design {
            Designs::Rich => vec![Design::Rich],
            Designs::Paper => vec![Design::Paper],
            Designs::Both => vec![Design::Rich, Design::Paper],
        }
    }

    /// Returns the kinds, groups resolved.
    pub fn kinds(&self) -> Vec<Kind> {
        self.kinds.iter().flat_map(|kinds| kinds.0.clone()).collect()
    }

    /// Returns the style of tables.
    pub fn look(&self) -> Look {
        if self.markdown { Look::Markdown } else { Look::Terminal }
    }
}
