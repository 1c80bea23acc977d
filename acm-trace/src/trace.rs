//! From a prepared case to the effects that it lacks, and the models that are compared.

mod inter_sample;

use acm_core::InterSample;
use acm_core::augmented::AugmentedModel;
use acm_core::response::Response;

use crate::agreement::excess;
use crate::assemble::Assembled;
use crate::baselines::{self, RECALIBRATED, baselines, is_improved_on, problem, start};
use crate::diagnose::noise_floor::{noise_floor, noise_floor_of};
use crate::diagnose::residuals;
use crate::finding::Step;
use crate::fit::design::design;
use crate::fit::gram::left_out;
use crate::fit::offsets::{Offsets, offsets};
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::fit::unrecorded::past::{common, histories};
use crate::prepared::Prepared;
use crate::search::confidence::{Chosen, Kept, kept};
use crate::search::criteria::Criteria;
use crate::search::scan::{Losses, cross_validate};
use crate::search::select::{self, Found, Search, Selected, Trials, sum};
use crate::series::Series;
use crate::series::before::Before;

use inter_sample::{is_moved, may_go_otherwise, told_between};

pub use crate::options::Options;

/// Result of the search.
#[derive(Debug, Clone)]
pub struct Traced<'a> {
    /// Trials of the last search.
    pub problem: Problem<'a>,
    /// State without any effect.
    pub bare: State,
    /// Sums of squares of the state without effects, block by block, left out.
    pub bare_losses: Losses,
    /// Sums of squares of the state with the effects that are named.
    pub named_losses: Losses,
    /// State with effects, minor ones among them.
    pub last: State,
    /// Sums of squares of the state with effects.
    pub last_losses: Losses,
    /// Steps of the search.
    pub steps: Vec<Step>,
    /// Effects that were chosen instead of each effect that is named, with its label.
    pub chosen: Vec<(String, Chosen)>,
    /// Sets with one more effect that predict better, by less than acceptance needs.
    pub larger: Vec<State>,
    /// Offsets of trials that no recorded signal predicts, where there are any.
    pub offsets: Option<Offsets>,
    /// Root mean square of the noise, weighted outputs together.
    pub noise: f64,
    /// Nominal, static map, recalibrated.
    pub baselines: [AugmentedModel; 3],
    /// Model with effects.
    pub after: Assembled,
    /// Actuator history of each trial; empty where none has one.
    pub histories: Vec<Option<Before>>,
    /// History that most of the trials share, if any.
    pub common: Option<Before>,
}

impl Traced<'_> {
    /// Returns the mean square left out: without effects, with those that are named, and with all.
    pub fn mean_squares(&self) -> [f64; 3] {
        let all = [&self.bare_losses, &self.named_losses, &self.last_losses];
        all.map(|losses| sum(losses) / self.problem.rows().max(1) as f64)
    }

    /// Returns what was chosen in the place of each effect of the last state, in their order; none for the minor ones, which come
    /// after those of the same label.
    pub fn named(&self) -> Vec<Option<&Chosen>> {
        let mut left: Vec<&(String, Chosen)> = self.chosen.iter().collect();
        let mut of = |label: String| {
            let at = left.iter().position(|(own, _)| *own == label)?;
            Some(&left.remove(at).1)
        };
        self.last.effects.iter().map(|placed| of(placed.label(self.problem.rig))).collect()
    }
}

/// Searches; `joined` holds calibration and development trials.
pub fn trace<'a>(
    prepared: &'a Prepared,
    joined: &[Series],
    options: &'a Options,
    mut progress: impl FnMut(&Step),
) -> Traced<'a> {
    let criteria = &options.criteria;
    let baselines = baselines(prepared, joined, criteria);
    let as_recorded = Recorded::default();
    let [problem, quick] = as_recorded.trials(prepared, joined, 0.0);
    let mut steps = vec![];
    let mut tell = |step: &select::Step| {
        let told = told(step);
        progress(&told);
        steps.push(told);
    };
    let mut share = 0.0;
    let (mut pass, mut found): (usize, Option<State>) = (0, None);
    let concluded = loop {
        // Effects within trials show once trial offsets are removed.
        let (problem, quick) = (problem.with_offsets(share), quick.with_offsets(share));
        let mut search = search(prepared, options, Trials { problem: &problem, quick: &quick });
        let selected =
            search.run(&start(prepared), found.as_ref().map(|state| Found { state, losses: None }), &mut tell);
        let of = |state: &State| offsets_left(&problem.with_offsets(0.0), state);
        let at_first = || (pass == 0).then(|| of(&selected.bare)).flatten();
        let left = of(&selected.last).or_else(at_first).map_or(0.0, |offsets| offsets.share);
        if pass == PASSES || (left - share).abs() <= SETTLED {
            break concluded(prepared, joined, options, as_recorded, search, selected, &mut tell);
        }
        (pass, found, share) = (pass + 1, Some(selected.last), left);
    };
    finished(prepared, concluded, (steps, baselines), criteria)
}

/// What is kept of a search, its trials, and these at the inputs after effects where they differ.
struct Concluded<'a> {
    kept: Kept,
    /// The trials as they were recorded.
    plain: Problem<'a>,
    problem: Problem<'a>,
    about: Option<Problem<'a>>,
    histories: Vec<Option<Before>>,
}

/// Inter-sample behaviour and history of the trials of a search.
#[derive(Debug, Clone, Default)]
struct Recorded {
    /// Inter-sample behaviour of actuators.
    inter_sample: InterSample,
    /// Actuator history of each trial, where known; empty where none has one.
    histories: Vec<Option<Before>>,
    /// Number of searches with other histories.
    rounds: usize,
}

/// Largest number of searches with other histories.
const ROUNDS: usize = 3;

impl Recorded {
    /// Returns the trials of a search, and these with fewer samples for a quick look.
    fn trials<'a>(&self, prepared: &'a Prepared, joined: &[Series], share: f64) -> [Problem<'a>; 2] {
        let series: Vec<Series> = match &self.inter_sample {
            InterSample::Straight => joined.to_vec(),
            between => joined.iter().map(|series| series.between(between)).collect(),
        };
        let quick = quickened(prepared, &series);
        let begun = |series: &[Series]| -> Vec<Series> {
            let before = |s: usize| self.histories.get(s).and_then(Option::as_ref);
            let of = |(s, series): (usize, &Series)| before(s).map_or_else(|| series.clone(), |b| series.begun(b));
            series.iter().enumerate().map(of).collect()
        };
        let problem = problem(prepared, &begun(&series)).with_offsets(share);
        let quick = quick.map_or_else(|| problem.clone(), |q| baselines::problem(prepared, &begun(&q)));
        [problem, quick.with_offsets(share)]
    }

    /// Returns these trials without history; `problem` has them as they are in use.
    fn plain<'a>(&self, prepared: &'a Prepared, joined: &[Series], problem: &Problem<'a>) -> Problem<'a> {
        if self.histories.is_empty() {
            return problem.clone();
        }
        let [plain, _] = Self { histories: vec![], ..self.clone() }.trials(prepared, joined, problem.offset_share);
        plain
    }
}

/// Continues the search from what was found, with other histories and inter-sample behaviour, as long as J falls.
fn concluded<'a>(
    prepared: &'a Prepared,
    joined: &[Series],
    options: &'a Options,
    recorded: Recorded,
    mut search: Search<'_, 'a>,
    selected: Selected,
    tell: &mut dyn FnMut(&select::Step),
) -> Concluded<'a> {
    let mut others = vec![];
    if recorded.rounds < ROUNDS && !selected.last.effects.is_empty() {
        let plain = recorded.plain(prepared, joined, search.problem);
        let play = search.with_one_play(&selected.last);
        for state in std::iter::once(selected.last.clone()).chain(play) {
            let model = Assembled::new(search.problem, &state).map(|assembled| assembled.model());
            let histories = model.and_then(|model| histories(&plain, &state, &model));
            others.extend(histories.map(|histories| {
                let behind = histories.iter().flatten().count();
                let other = Recorded { histories, rounds: recorded.rounds + 1, ..recorded.clone() };
                (format!("start of {behind} trials"), other, Some(state))
            }));
        }
    }
    if !selected.last.effects.is_empty() {
        for inter_sample in may_go_otherwise(prepared, &recorded.inter_sample, &search, &selected) {
            let change = told_between(prepared, &inter_sample);
            // A continued search would keep effects that imitate errors of linear interpolation.
            let is_bent = matches!(inter_sample, InterSample::Quartic(_));
            let (rounds, state) = if is_bent { (0, None) } else { (ROUNDS, Some(selected.last.clone())) };
            others.push((change, Recorded { inter_sample, rounds, ..recorded.clone() }, state));
        }
    }
    for (change, other, state) in others {
        let [problem, quick] = other.trials(prepared, joined, search.problem.offset_share);
        if state.is_none() && !is_moved(&problem, &selected, &options.criteria) {
            continue;
        }
        let mut again = self::search(prepared, options, Trials { problem: &problem, quick: &quick });
        let on_from = state.as_ref().map(|state| {
            let losses = Some(&selected.last_losses).filter(|_| state.keeps(&selected.last, problem.rig));
            Found { state, losses }
        });
        let found = again.run(&start(prepared), on_from, &mut *tell);
        let compared = again.compared(&change, &selected, &found);
        tell(&compared);
        if compared.accepted {
            return concluded(prepared, joined, options, other, again, found, tell);
        }
    }
    let plain = recorded.plain(prepared, joined, search.problem);
    let problem = search.problem.clone();
    let (kept, about) = named(search, selected, &problem, tell);
    Concluded { kept, plain, problem, about, histories: recorded.histories }
}

/// What is kept of a search, and its trials at the inputs after effects where they differ.
fn named<'a>(
    mut search: Search<'_, 'a>,
    selected: Selected,
    problem: &Problem<'a>,
    tell: &mut dyn FnMut(&select::Step),
) -> (Kept, Option<Problem<'a>>) {
    let mut kept = kept(&mut search, selected, tell);
    let about = problem.about(&kept.with_minor.0);
    if let Some(about) = &about {
        kept.with_minor = search.on(about).polished_again(kept.with_minor);
    }
    (kept, about)
}

/// Largest number of searches after the first.
const PASSES: usize = 2;

/// Change of the share of offsets below which the search is not repeated.
const SETTLED: f64 = 0.1;

fn search<'p, 'a>(prepared: &'p Prepared, options: &'p Options, trials: Trials<'p, 'a>) -> Search<'p, 'a> {
    Search::new(trials, &prepared.library, &options.criteria, options.seed, prepared.may_correct_clock())
}

/// Returns the offsets of trials in the residuals of a state when they are left out.
fn offsets_left(problem: &Problem, state: &State) -> Option<Offsets> {
    let residual = left_out(&design(problem, state), &problem.blocks, state.form.ridge)?;
    offsets(problem, &residual)
}

/// Samples of all trials together that a quick look at a candidate compares.
const QUICK: usize = 1000;

/// Returns the trials with fewer samples, for a quick look; none where they have few.
fn quickened(prepared: &Prepared, joined: &[Series]) -> Option<Vec<Series>> {
    let fewer = (joined.iter().map(Series::samples).sum::<usize>() / QUICK).max(1);
    // Inter-sample values must be kept.
    let is_straight = |series: &Series| series.inter_sample == InterSample::Straight;
    let every = if joined.iter().all(is_straight) { prepared.every } else { 1 };
    let quick = |series: &Series| series.decimated(every, fewer);
    (every > 1 || fewer > 1).then(|| joined.iter().map(quick).collect())
}

fn finished<'a>(
    prepared: &Prepared,
    Concluded { kept, plain, problem: recorded, about, histories }: Concluded<'a>,
    (mut steps, baselines): (Vec<Step>, [Response; 3]),
    criteria: &Criteria,
) -> Traced<'a> {
    let Kept { selected, mut chosen, larger, with_minor } = kept;
    let Selected { bare, bare_losses, last_losses: mut named_losses, .. } = selected;
    let (mut last, mut last_losses) = with_minor;
    let rows = recorded.rows().max(1) as f64;
    let rms = |losses: &Losses| (sum(losses) / rows).sqrt();
    steps.insert(0, without_test("nominal", rms(&bare_losses)));
    let as_recorded = recorded.with_offsets(0.0);
    let recalibrated = cross_validate(&as_recorded, &bare).unwrap_or_else(|| bare_losses.clone());
    let simplest = baselines::simplest(prepared, &as_recorded, &baselines, &recalibrated, criteria.level);
    let problem = about.unwrap_or(recorded);
    let is_changed = !last.effects.is_empty() || last.clock != 0.0;
    let negligible = criteria.negligible * sum(&bare_losses);
    let as_saved = || last_losses.iter().map(|loss| loss * excess(&problem, &last, negligible).exp()).collect();
    // Effects were accepted against the recalibrated baseline.
    let improves = is_changed
        && (simplest == RECALIBRATED
            || is_improved_on(&baselines[simplest], prepared, &problem, &as_saved(), criteria.level));
    let assembled = if improves { Assembled::new(&problem, &last) } else { None };
    let after = assembled.unwrap_or_else(|| {
        if is_changed {
            steps.push(without_test("− all: a baseline predicts as well", rms(&bare_losses)));
        }
        (last, last_losses, named_losses) = (bare.clone(), bare_losses.clone(), bare_losses.clone());
        chosen.clear();
        Assembled::unchanged(&problem, &baselines[simplest])
    });
    let common = common(&plain, &last, &after.model(), &histories);
    let noise = noise(prepared, &problem, &last);
    let offsets = offsets_left(&problem.with_offsets(0.0), &last);
    let baselines = baselines.map(|response| baselines::without_effects(prepared, response));
    Traced {
        problem,
        bare,
        bare_losses,
        named_losses,
        last,
        last_losses,
        steps,
        chosen,
        larger,
        offsets,
        noise,
        baselines,
        after,
        common,
        histories,
    }
}

fn without_test(model: &str, error: f64) -> Step {
    let model = model.into();
    Step { model, error, significance: None, gain: None, by_chance: None, accepted: true, candidates: vec![] }
}

fn told(step: &select::Step) -> Step {
    let candidates = step.candidates.iter();
    let candidates = candidates.map(|(name, error)| crate::finding::Candidate { name: name.clone(), error: *error });
    Step {
        model: step.change.clone(),
        error: step.error,
        significance: Some(step.t),
        gain: Some(step.gain),
        by_chance: step.by_chance,
        accepted: step.accepted,
        candidates: candidates.collect(),
    }
}

/// Estimates the noise from the remaining residual, or from the measurements at the full rate of the recording,
/// whichever is smaller: both are upper bounds.
fn noise(prepared: &Prepared, problem: &Problem, state: &State) -> f64 {
    let left =
        residuals::left_out(problem, state).map_or(f64::INFINITY, |left| noise_floor(&left.remainder(problem, 0.0)));
    let measured = prepared.case.development.iter().map(|trial| {
        let weighted =
            |(column, weight): (nalgebra::DVectorView<f64>, &f64)| column.iter().map(|y| y * weight).collect();
        let columns: Vec<Vec<f64>> = trial.measured.column_iter().zip(&prepared.weight).map(weighted).collect();
        noise_floor_of(&trial.record.time, &columns)
    });
    let (sum, count) = measured.fold((0.0, 0usize), |(sum, count), noise| (sum + noise * noise, count + 1));
    left.min((sum / count.max(1) as f64).sqrt())
}
