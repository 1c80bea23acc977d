//! `acm-eval score-loop`: how well close-loop finds simulated effects.

mod args;
mod attempts;
mod results;

use std::io::{Write, stderr};
use std::path::Path;

use acm_eval::error::EvalError;
use acm_eval::question::config::LoopConfig;
use acm_eval::question::criteria;
use acm_eval::scoring::aliases::measure;
use acm_eval::scoring::answer::Answer;
use acm_eval::scoring::figures::{
    Figures, RigScore, SeveralRow, compared, pooled_table, rig_heading, rig_line, rig_table, several_heading,
    several_line, several_table,
};
use acm_eval::scoring::kept::{self, Header, Kept};
use acm_eval::scoring::single::{Score, heading, line, table};
use acm_eval::scoring::{LENGTH, Plan, Tried, attempt, attempt_several, attempt_small_rig, several_tasks};
use acm_eval::terminal::print;
use acm_sim::small_rigs::Kind as RigKind;
use acm_trace::trace::Options;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

pub use args::{EXAMPLES, ScoreArgs};
use attempts::attempts;
use results::{claim, claim_pictures, draw, keep, write};

/// Files of figures.
const SCORES: [&str; 3] = ["score.json", "several.json", "small_rigs.json"];

/// Largest number of trials that counts as few.
const FEW_TRIALS: usize = 6;

/// Prints a line as each campaign is done, then the table.
pub fn run(args: &ScoreArgs) -> Result<(), EvalError> {
    // Checked before the work starts.
    args.figure.as_ref().map_or(Ok(()), |name| claim_pictures(name))?;
    args.aliases.as_ref().map_or(Ok(()), |file| claim(file))?;
    args.out.as_ref().map_or(Ok(()), |out| SCORES.iter().try_for_each(|name| claim(&out.join(name))))?;
    if let Some(file) = &args.aliases {
        return aliases(file);
    }
    if !args.pool.is_empty() {
        return pool(args);
    }
    let asked = Asked::new(args)?;
    let mut answers = vec![];
    if let Some(many) = args.several {
        answers.extend(asked.several(many)?);
    }
    if let Some(many) = args.small_rigs {
        answers.extend(asked.small_rigs(many)?);
    }
    if args.several.is_none() && args.small_rigs.is_none() {
        answers.extend(asked.single()?);
    }
    args.figure.as_ref().map_or(Ok(()), |name| draw(name, &answers))
}

/// The command with its search resolved.
struct Asked<'a> {
    args: &'a ScoreArgs,
    options: Options,
    configuration: Value,
}

impl<'a> Asked<'a> {
    fn new(args: &'a ScoreArgs) -> Result<Self, EvalError> {
        let (config, _) = LoopConfig::for_folder(Path::new("."), &args.set)?;
        let mut options = config.options();
        for edit in &args.criteria {
            criteria::set(&mut options.criteria, edit).map_err(EvalError::Usage)?;
        }
        let configuration = json!({ "effects": config.effects, "search": config.search, "criteria": format!("{:?}", options.criteria) });
        Ok(Self { args, options, configuration })
    }

    /// Returns the campaigns of one cause, of pairs, of none.
    fn single(&self) -> Result<Vec<Answer>, EvalError> {
        let tasks = self.plan()?.tasks();
        print(&heading())?;
        let rows = self.rows("single", &tasks, |task| attempt(task, &self.options), line)?;
        let answers = rows.iter().map(|row| row.answer.clone()).collect();
        let score = Score::new(rows, self.configuration.clone());
        print(&format!("\n{}", table(&score, self.args.look())))?;
        keep(self.args, "score.json", &score)?;
        Ok(answers)
    }

    /// Returns the campaigns of two to six causes: of each design, of few and of many trials, then of all.
    fn several(&self, many: u64) -> Result<Vec<Answer>, EvalError> {
        let tasks = several_tasks(self.args.seeds_of(), many, &self.args.designs());
        print(&several_heading())?;
        let rows = self.rows("several", &tasks, |task| attempt_several(task, &self.options), several_line)?;
        let answers: Vec<Answer> = rows.iter().map(|row| row.answer.clone()).collect();
        let of = |is: &dyn Fn(&SeveralRow) -> bool| {
            let own: Vec<Answer> = rows.iter().filter(|row| is(row)).map(|row| row.answer.clone()).collect();
            Figures::new(&own)
        };
        let designs = self.args.designs();
        let mut sets: Vec<(String, Figures)> =
            designs.iter().map(|design| (design.name().to_string(), of(&|row| row.design == *design))).collect();
        sets.push((format!("up to {FEW_TRIALS} trials"), of(&|row| row.trials <= FEW_TRIALS)));
        sets.push(("more trials".into(), of(&|row| row.trials > FEW_TRIALS)));
        let figures = Figures::new(&answers);
        print(&format!("\n{}\n\n{}", compared(&sets, self.args.look()), several_table(&figures, self.args.look())))?;
        self.keep("several.json", json!({ "figures": figures, "sets": sets, "rows": rows }))?;
        Ok(answers)
    }

    /// Runs small rigs of every kind.
    fn small_rigs(&self, many: u64) -> Result<Vec<Answer>, EvalError> {
        let of = |kind: RigKind| self.args.seeds_of().take(many).map(move |seed| (kind, seed));
        let tasks: Vec<(RigKind, u64)> = RigKind::ALL.into_iter().flat_map(of).collect();
        print(&rig_heading())?;
        let rows = self.rows("small_rigs", &tasks, |task| attempt_small_rig(*task, &self.options), rig_line)?;
        let figures = RigScore::new(&rows);
        print(&format!("\n{}", rig_table(&figures, self.args.look())))?;
        self.keep("small_rigs.json", json!({ "figures": figures, "rows": rows }))?;
        Ok(rows.into_iter().map(|row| row.answer).collect())
    }

    fn rows<K: Tried + Sync, T: Serialize + DeserializeOwned + Clone + Send + Sync>(
        &self,
        name: &str,
        tasks: &[K],
        attempt: impl Fn(&K) -> Result<T, EvalError> + Sync,
        line: impl Fn(&T) -> String + Sync,
    ) -> Result<Vec<T>, EvalError> {
        let open = |out: &std::path::PathBuf| {
            Kept::open(&out.join(format!("{name}.jsonl")), &Header::new(self.configuration.clone())?)
        };
        let kept = self.args.out.as_ref().map(open).transpose()?;
        attempts(tasks, self.args.jobs, kept.as_ref(), attempt, line)
    }

    /// Writes figures and rows with what made them.
    fn keep(&self, name: &str, mut score: Value) -> Result<(), EvalError> {
        score["format"] = json!(2);
        score["version"] = json!(env!("CARGO_PKG_VERSION"));
        score["configuration"] = self.configuration.clone();
        score["seeds"] = json!(self.args.seeds_of());
        keep(self.args, name, &score)
    }

    fn plan(&self) -> Result<Plan, EvalError> {
        let args = self.args;
        if args.first_seed.is_none() && args.seeds.saturating_add(args.nulls) > LENGTH {
            let what = format!("a list has {LENGTH} seeds, and --seeds and --nulls ask for more");
            return Err(EvalError::Usage(format!("{what}; give --seeds 0, or fewer")));
        }
        Ok(Plan {
            seeds: args.seeds,
            first: args.first_seed.unwrap_or_else(|| args.seeds_of().first()),
            designs: args.designs(),
            kinds: args.kinds(),
            nulls: args.nulls,
            without_own: args.without_own,
        })
    }
}

/// Prints the figures over the rows of folders: of all together where there is one folder, else of each.
fn pool(args: &ScoreArgs) -> Result<(), EvalError> {
    let folders: Vec<Vec<Answer>> = args.pool.iter().map(|folder| kept::answers(folder)).collect::<Result<_, _>>()?;
    match &folders[..] {
        [one] => print(&pooled_table(&Figures::new(one), args.look()))?,
        all => {
            let name =
                |folder: &std::path::PathBuf| folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let sets = args.pool.iter().zip(all).map(|(folder, answers)| (name(folder), Figures::new(answers)));
            print(&compared(&sets.collect::<Vec<_>>(), args.look()))?;
        }
    }
    args.figure.as_ref().map_or(Ok(()), |name| draw(name, &folders.concat()))
}

/// Measures the table of aliases.
fn aliases(file: &Path) -> Result<(), EvalError> {
    let command = format!("acm-eval score-loop --aliases {}", file.display());
    let table = measure(&command, |place| drop(writeln!(stderr(), "{place}")))?;
    write(file, &table)
}
