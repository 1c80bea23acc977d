//! The search as a whole: from the nominal model to the effects that it lacks.
//!
//! 1. The nominal model is calibrated, and a static map learned, on calibration trials (on the development trials where there
//!    are none). From then on the calibration floats within its own 99 % ellipsoid.
//! 2. Rounds of [`crate::search`]: add, let a parameter depend on a context, exchange, take away; until nothing wins.
//! 3. An effect that acts in the calibration trials too makes them trials like the others: calibration, map and effects are
//!    then fitted to both together.

use acm_core::calibration::CalibrationError;
use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;
use acm_core::response::Response;
use acm_core::rig::Rig;
use acm_core::static_map::StaticMap;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::case::{Case, Trial};
use crate::evaluate::{self, Point, StateFrom, Tip};
use crate::finding::{Candidate, Step};
use crate::fit::{Scored, fit, score};
use crate::ground::{self, Nominal};
use crate::noise_floor::{noise_floor, noise_floor_of};
use crate::remainder::{Remainder, TrialRemainder};
use crate::search::{self, Move, Round, Rules, Scale, Tried, compare};
use crate::series::{Series, number_blocks};
use crate::setup::Setup;

/// How to search.
#[derive(Debug, Clone)]
pub struct Options {
    /// When an effect counts.
    pub rules: Rules,
    /// Samples that the search looks at.
    pub samples: usize,
    /// Of everything that is drawn.
    pub seed: u64,
    /// Names of the effects that may be found; all where empty.
    pub only: Vec<String>,
    /// Names of effects that are passed over.
    pub without: Vec<String>,
}

impl Default for Options {
    fn default() -> Self {
        Self { rules: Rules::default(), samples: 2500, seed: 1, only: vec![], without: vec![] }
    }
}

/// The parts of a case that do not change during the search.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// What is to be explained.
    pub case: Case,
    /// As calibrated.
    pub nominal: Nominal,
    /// Trials that an effect is found on.
    pub development: Vec<Series>,
    /// Trials that calibrate; empty where there are none of their own.
    pub calibration: Vec<Series>,
    /// Whether blocks are trials.
    pub by_trial: bool,
    /// Of each output.
    pub weight: Vec<f64>,
    /// Effects that may be found, in every way that they can act.
    pub library: Vec<Instance>,
}

/// Where the search ended.
#[derive(Debug, Clone)]
pub struct Traced<'a> {
    /// Around the last model.
    pub setup: Setup<'a>,
    /// Without any effect, around the same calibration trials.
    pub bare: Scored,
    /// Around which `bare` was fitted.
    pub bare_setup: Setup<'a>,
    /// With effects.
    pub last: Scored,
    /// Of what was tried.
    pub steps: Vec<Step>,
    /// Names of equivalent effects at the step at which each of the last effects came in.
    pub equivalent: Vec<Vec<String>>,
    /// At which step each of the last effects came in.
    pub order: Vec<usize>,
    /// The static map of the calibration trials, before any effect.
    pub map: Option<StaticMap>,
    /// Root mean square of the noise, weighted outputs together.
    pub floor: f64,
    /// Mean square left out with the first effect (or pair) alone.
    pub first: f64,
    /// Whether calibration trials became trials like the others.
    pub joined: bool,
    /// The trials that the last fit saw.
    pub series: &'a [Series],
}

/// Calibrates the nominal model and prepares every trial.
///
/// # Errors
/// A calibration that is impossible.
pub fn prepare(mut case: Case, options: &Options) -> Result<Prepared, CalibrationError> {
    let nominal = ground::calibrate_nominal(&mut case)?;
    let mut development = thinned(&case.development, &case, options);
    let by_trial = number_blocks(&mut development);
    let mut calibration = thinned(&case.calibration, &case, options);
    number_blocks(&mut calibration);
    let allowed = |instance: &Instance| {
        let name = instance.effect().name().to_string();
        (options.only.is_empty() || options.only.contains(&name)) && !options.without.contains(&name)
    };
    let library = Instance::all(&case.rig).into_iter().filter(allowed).filter(|i| is_covered(i, &case)).collect();
    let weight = weights(&case);
    Ok(Prepared { case, nominal, development, calibration, by_trial, weight, library })
}

/// Bins of an actuator's range, and the share of them that an effect periodic in it must have been seen in.
const BINS: (usize, f64) = (25, 0.7);

/// Trials that a drift must be seen in: in fewer, anything slow is as good.
const DRIFTING_TRIALS: usize = 3;

/// Whether the trials say anything about an effect where it would act. One that is periodic in an actuator needs its range to
/// be covered, or it swings freely where nothing was recorded; a drift must begin anew in several trials.
fn is_covered(instance: &Instance, case: &Case) -> bool {
    match (instance.carrier(), instance.effect().name()) {
        (Carrier::Actuator(a), "encoder_periodic") => {
            let all = || case.development.iter().flat_map(|trial| &trial.record.actuators[a]).copied();
            let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
            let mut seen = [false; BINS.0];
            for q in all() {
                let bin = (BINS.0 as f64 * (q - low) / (high - low)) as usize;
                seen[bin.min(BINS.0 - 1)] = true;
            }
            seen.iter().filter(|seen| **seen).count() as f64 >= BINS.1 * BINS.0 as f64
        }
        (_, name) if name.ends_with("_drift") => case.development.len() >= DRIFTING_TRIALS,
        _ => true,
    }
}

/// Every k-th sample, so that as many numbers are compared as `samples` of three outputs have.
fn thinned(trials: &[Trial], case: &Case, options: &Options) -> Vec<Series> {
    let total: usize = trials.iter().map(|trial| trial.record.samples()).sum();
    let numbers = total * case.rig.outputs.len().max(2);
    let stride = numbers.div_ceil(3 * options.samples.max(1)).max(1);
    trials.iter().map(|trial| Series::new(trial, stride)).collect()
}

/// One for outputs of one unit; else what makes the spread of each output 1.
fn weights(case: &Case) -> Vec<f64> {
    let outputs = &case.rig.outputs;
    if outputs.iter().all(|output| output.unit == outputs[0].unit) {
        return vec![1.0; outputs.len()];
    }
    outputs.iter().map(|output| 1.0 / output.span().max(f64::MIN_POSITIVE)).collect()
}

/// Searches.
pub fn trace<'a>(
    prepared: &'a Prepared,
    joined_series: &'a [Series],
    options: &'a Options,
    mut progress: impl FnMut(&Step),
) -> Traced<'a> {
    let mut search = Search::start(prepared, joined_series, options);
    progress(&search.steps[0]);
    let reported = |search: &Search, from: usize, progress: &mut dyn FnMut(&Step)| {
        search.steps[from..].iter().for_each(progress);
    };
    while search.last.fit.instances.len() < options.rules.most {
        let from = search.steps.len();
        let grew = search.grow();
        if grew {
            search.join_calibration();
            search.vary();
            search.exchange();
            search.shrink();
        }
        let stands = search.stands();
        reported(&search, from, &mut progress);
        if !grew || !stands {
            break;
        }
    }
    search.finish()
}

/// Effects that a calibration of the actuation takes up where they act in its trials.
const TAKEN_UP: [&str; 3] = ["static_gain", "coupling", "scale"];

/// Candidates that are also tried with their size depending on context signals.
const VARIED: usize = 5;

struct Search<'a> {
    prepared: &'a Prepared,
    joined_series: &'a [Series],
    options: &'a Options,
    setup: Setup<'a>,
    bare: Scored,
    bare_setup: Setup<'a>,
    last: Scored,
    steps: Vec<Step>,
    equivalent: Vec<Vec<String>>,
    order: Vec<usize>,
    map: Option<StaticMap>,
    floor: f64,
    doubt: f64,
    first: f64,
    joined: bool,
}

impl<'a> Search<'a> {
    fn start(prepared: &'a Prepared, joined_series: &'a [Series], options: &'a Options) -> Self {
        let setup = initial_setup(prepared);
        let delta = setup.centre.clone();
        let bare = score(&setup, fit(&setup, &[], &[], &delta, Tip::Exact, 3), Tip::Exact);
        let floor = floor(&setup, &bare, prepared);
        let setup = within_ellipsoid(Setup { noise: variance(floor, &setup), ..setup });
        let bare = score(&setup, fit(&setup, &[], &[], &delta, Tip::Exact, 3), Tip::Exact);
        let mut search = Self {
            prepared,
            joined_series,
            options,
            map: setup.response.map().cloned(),
            bare_setup: setup.clone(),
            setup,
            last: bare.clone(),
            bare,
            steps: vec![],
            equivalent: vec![],
            order: vec![],
            floor,
            doubt: doubt(prepared, floor),
            first: f64::INFINITY,
            joined: false,
        };
        search.record("nominal".into(), None, &[]);
        search
    }

    fn finish(self) -> Traced<'a> {
        Traced {
            series: self.setup.series,
            setup: self.setup,
            bare: self.bare,
            bare_setup: self.bare_setup,
            last: self.last,
            steps: self.steps,
            equivalent: self.equivalent,
            order: self.order,
            map: self.map,
            first: self.first,
            floor: self.floor,
            joined: self.joined,
        }
    }

    fn scale(&self) -> Scale {
        Scale { bare: self.bare.mean_square(), floor: self.floor, doubt: self.doubt }
    }

    /// Adds the best effect, or the best pair; whether one was good enough.
    fn grow(&mut self) -> bool {
        let new = self.absent();
        let mut moves: Vec<Move> = new.iter().map(|new| search::add(&self.setup, &self.last, new)).collect();
        moves.extend(new.iter().filter_map(|new| search::add_payload(&self.setup, &self.last, new)));
        let mut round = search::round(&self.setup, &self.last, moves);
        self.let_candidates_vary(&mut round);
        if self.accept_best(&round) || self.grow_by_two(&new, &round) {
            return true;
        }
        self.record("nothing else wins".into(), None, &round.tried);
        false
    }

    /// The best candidates once more, with their size depending on each context signal: some effects explain nothing as long as
    /// they have one size for all.
    fn let_candidates_vary(&self, round: &mut Round) {
        let near = round
            .tried
            .first()
            .is_none_or(|best| best.scored.mean_square() < (self.options.rules.near_noise * self.floor).powi(2));
        if near {
            return;
        }
        let of = |tried: &Tried| self.varied(&tried.scored, tried.new[0]);
        let moves: Vec<Move> = round.tried.iter().take(VARIED).flat_map(of).collect();
        round.tried.extend(search::round(&self.setup, &self.last, moves).tried);
        round.tried.sort_by(|a, b| a.scored.mean_square().total_cmp(&b.scored.mean_square()));
    }

    /// Effects that are not in the set.
    fn absent(&self) -> Vec<Instance> {
        let is_in = |new: &Instance| {
            self.last
                .fit
                .instances
                .iter()
                .any(|old| old.effect().name() == new.effect().name() && old.carrier() == new.carrier())
        };
        // What acts in the calibration trials too and is straight in the actuators, the calibration has taken up.
        let in_calibration = self.joined || self.prepared.calibration.is_empty();
        let taken_up = |new: &Instance| in_calibration && TAKEN_UP.contains(&new.effect().name());
        self.prepared.library.iter().filter(|new| !is_in(new) && !taken_up(new)).cloned().collect()
    }

    fn accept_best(&mut self, round: &Round) -> bool {
        let Some(best) = round.tried.first() else { return false };
        let enough = search::is_enough(&self.options.rules, self.scale(), &self.last, &best.scored);
        if !enough {
            return false;
        }
        let equal = search::equivalent(&self.last, &round.tried, self.floor);
        let pick = equal.first().copied().unwrap_or(0);
        let name = |k: &usize| self.new_names(&round.tried[*k]);
        let mut names: Vec<String> = Vec::new();
        for k in &equal {
            name(k).into_iter().for_each(|name| {
                if !names.contains(&name) {
                    names.push(name)
                }
            });
        }
        let tried = round.tried[pick].clone();
        let significance = compare(&self.last.left_out, &tried.scored.left_out).significance();
        let label = format!("+ {}", self.labels(&tried).join(" + "));
        self.insert_equivalents(&tried, names);
        let is_first = self.last.fit.instances.is_empty();
        self.settle(tried.scored);
        if is_first {
            self.first = self.last.mean_square();
        }
        self.record(label, Some(significance), &round.tried);
        true
    }

    fn new_names(&self, tried: &Tried) -> Vec<String> {
        tried.new.iter().map(|&i| tried.scored.fit.instances[i].effect().name().to_string()).collect()
    }

    fn labels(&self, tried: &Tried) -> Vec<String> {
        tried.new.iter().map(|&i| tried.scored.fit.instances[i].label(self.setup.rig)).collect()
    }

    fn insert_equivalents(&mut self, tried: &Tried, names: Vec<String>) {
        let mut new = tried.new.clone();
        new.sort_unstable();
        for &i in &new {
            let own = tried.scored.fit.instances[i].effect().name().to_string();
            let mut all = vec![own.clone()];
            all.extend(names.iter().filter(|name| **name != own && tried.new.len() == 1).cloned());
            self.equivalent.insert(i, all);
            self.order.insert(i, self.steps.len());
        }
    }

    /// Two effects that are useful only together.
    fn grow_by_two(&mut self, new: &[Instance], single: &Round) -> bool {
        if !self.last.fit.instances.is_empty() || self.options.rules.most < 2 {
            return false;
        }
        let mut moves: Vec<Move> = Vec::new();
        for first in single.tried.iter().take(4) {
            let i = first.new[0];
            let (instance, theta) = (&first.scored.fit.instances[i], &first.scored.fit.theta[i]);
            for second in new {
                if second.effect().name() != instance.effect().name() {
                    moves.push(search::add_both(&self.setup, &self.last, (instance, theta), second));
                }
            }
        }
        let round = search::round(&self.setup, &self.last, moves);
        self.accept_best(&round)
    }

    /// Effect `i` with its size depending on each signal that it may depend on.
    fn varied(&self, scored: &Scored, i: usize) -> Vec<Move> {
        let signals = search::modulators(&scored.fit.instances[i], self.setup.rig).into_iter();
        signals.filter_map(|signal| search::vary(&self.setup, scored, i, signal)).collect()
    }

    /// Lets effects depend on context signals, where that wins.
    fn vary(&mut self) {
        let of = |i: usize| self.varied(&self.last, i);
        let moves: Vec<Move> = (0..self.last.fit.instances.len()).flat_map(of).collect();
        let round = search::round(&self.setup, &self.last, moves);
        let Some(best) = round.tried.first() else { return };
        if !search::is_enough(&self.options.rules, self.scale(), &self.last, &best.scored) {
            return;
        }
        let significance = compare(&self.last.left_out, &best.scored.left_out).significance();
        let label = self.labels(best).join(" + ");
        let best = best.clone();
        self.settle(best.scored);
        self.record(label, Some(significance), &round.tried);
    }

    /// Opens every chosen effect again.
    fn exchange(&mut self) {
        for _ in 0..2 {
            let effects = self.last.fit.instances.len();
            if effects < 2 || !(0..effects).any(|i| self.exchange_one(i)) {
                return;
            }
        }
    }

    fn exchange_one(&mut self, i: usize) -> bool {
        let new = self.absent();
        let moves = new.iter().map(|new| search::exchange(&self.setup, &self.last, i, new)).collect();
        let round = search::round(&self.setup, &self.last, moves);
        let Some(best) = round.tried.first() else { return false };
        let comparison = compare(&self.last.left_out, &best.scored.left_out);
        let left = (self.last.mean_square() - self.floor.powi(2)).max(0.0);
        let larger = best.scored.fit.parameters() > self.last.fit.parameters();
        let share = if larger { self.options.rules.next_share } else { 0.02 };
        let least = (0.15 * self.floor.powi(2)).max(share * left);
        if comparison.gain < least || comparison.significance() < 2.0 {
            return false;
        }
        let old = self.last.fit.instances[i].label(self.setup.rig);
        let label = format!("{old} → {}", self.labels(best).join(" + "));
        let best = best.clone();
        self.equivalent.remove(i);
        self.order.remove(i);
        let names = self.new_names(&best);
        self.insert_equivalents(&best, names);
        self.settle(best.scored);
        self.record(label, Some(comparison.significance()), &round.tried);
        true
    }

    /// Takes away what is no longer needed.
    fn shrink(&mut self) {
        while self.last.fit.instances.len() > 1 {
            let moves: Vec<Move> = (0..self.last.fit.instances.len()).map(|i| search::remove(&self.last, i)).collect();
            let fits: Vec<Scored> = moves
                .iter()
                .map(|change| {
                    let fit =
                        fit(&self.setup, &change.instances, &change.starts[0], &self.last.fit.delta, Tip::Exact, 8);
                    score(&self.setup, fit, Tip::Exact)
                })
                .collect();
            let whole = self.bare.mean_square() - self.last.mean_square();
            let superfluous = fits.iter().enumerate().position(|(_, rest)| {
                let loss = compare(&rest.left_out, &self.last.left_out);
                loss.gain < 0.02 * whole.max(0.0) && loss.significance() < 2.0 || loss.significance() < 1.0
            });
            let Some(i) = superfluous else { return };
            let label = format!("− {}", self.last.fit.instances[i].label(self.setup.rig));
            self.equivalent.remove(i);
            self.order.remove(i);
            self.settle(fits[i].clone());
            self.record(label, None, &[]);
        }
    }

    /// Whether what is left of a pair still gains enough on its own; else nothing was found.
    fn stands(&mut self) -> bool {
        let alone = self.last.fit.instances.len() == 1;
        if !alone || search::is_enough(&self.options.rules, self.scale(), &self.bare, &self.last) {
            return true;
        }
        (self.setup, self.last) = (self.bare_setup.clone(), self.bare.clone());
        (self.equivalent, self.order, self.joined) = (vec![], vec![], false);
        self.record("none of them alone".into(), None, &[]);
        false
    }

    /// Moves the reference to the new model, and fits and scores it there.
    fn settle(&mut self, scored: Scored) {
        self.setup = relinearised(&self.setup, &scored.fit.instances, &scored.fit.theta, &scored.fit.delta);
        let zero = DVector::zeros(self.setup.calibrated());
        let fit = fit(&self.setup, &scored.fit.instances, &scored.fit.theta, &zero, Tip::Exact, 8);
        self.last = score(&self.setup, fit, Tip::Exact);
    }

    fn record(&mut self, model: String, significance: Option<f64>, tried: &[Tried]) {
        let candidates = tried.iter().map(|tried| Candidate {
            name: self.labels(tried).join(" + "),
            error: tried.scored.mean_square().sqrt(),
            parameters: tried.scored.fit.parameters(),
        });
        let candidates = candidates.collect();
        let error = self.last.mean_square().sqrt();
        self.steps.push(Step { model, error, significance, candidates });
    }

    /// Calibration trials join the others where the effects explain them too.
    fn join_calibration(&mut self) {
        if self.joined || self.prepared.calibration.is_empty() {
            return;
        }
        let Some(joined) = joined(self.prepared, self.joined_series, &self.setup, &self.last, self.floor) else {
            return;
        };
        self.joined = true;
        (self.setup, self.last) = (joined.setup, joined.last);
        (self.bare_setup, self.bare) = (joined.bare_setup, joined.bare);
        self.record("effect acts in the calibration trials too".into(), None, &[]);
    }
}

/// Calibration and development trials together.
struct Joined<'a> {
    setup: Setup<'a>,
    last: Scored,
    bare_setup: Setup<'a>,
    bare: Scored,
}

/// Share of what is left over the noise in the calibration trials that the effects have to explain.
const JOIN_SHARE: f64 = 0.3;

/// Times the mean square of the development trials alone that all trials together may have.
const JOIN_LOSS: f64 = 1.5;

fn joined<'a>(
    prepared: &'a Prepared,
    series: &'a [Series],
    setup: &Setup<'a>,
    last: &Scored,
    floor: f64,
) -> Option<Joined<'a>> {
    let noise = setup.noise;
    let bare_on = |series: &'a [Series], response: Response| {
        ground::bare(&prepared.case, series, response, &prepared.weight, noise)
    };
    // The calibration trials with the effects as found, calibrated again.
    let plain = Response::new(prepared.nominal.model.clone(), None, down(prepared));
    let before = free_fit(bare_on(&prepared.calibration, plain.clone()), &[], &[]);
    let instances = &last.fit.instances;
    let frozen = free_fit(bare_on(&prepared.calibration, plain.clone()), instances, &last.fit.theta);
    let (noise_square, last_square) = (floor * floor, last.mean_square());
    let (was, is) = (before.1.mean_square(), frozen.1.mean_square());
    let comparison = compare(&before.1.left_out, &frozen.1.left_out);
    if was - is < JOIN_SHARE * (was - noise_square).max(0.2 * noise_square) || comparison.significance() < 2.0 {
        return None;
    }
    // Together: calibration and effects at once, then the map of what is left in the calibration trials, then both again.
    let (together, scored) = free_fit(bare_on(series, plain.clone()), instances, &last.fit.theta);
    let at_rest = on_calibration(prepared, &together, &scored, noise);
    let map =
        ground::static_map(&at_rest, Point { delta: &DVector::zeros(at_rest.calibrated()), ..scored.fit.point() });
    let (setup, last) =
        free_fit(Setup { response: together.response.with_map(map), ..together }, instances, &scored.fit.theta);
    // Together they must be explained about as well as the development trials were alone.
    if scored_on(&setup, &last) > JOIN_LOSS * last_square.max(noise_square) {
        return None;
    }
    let (bare_setup, bare) = free_fit(bare_on(series, setup.response.clone()), &[], &[]);
    Some(Joined { setup, last, bare_setup, bare })
}

/// Mean square left out in the trials that the first search saw: development trials come last.
fn scored_on(setup: &Setup, scored: &Scored) -> f64 {
    let (mut squares, mut count) = (0.0, 0usize);
    for (series, residual) in setup.series.iter().zip(&scored.residual) {
        squares += residual.norm_squared();
        count += series.counts.iter().filter(|counts| **counts).count();
    }
    squares / count.max(1) as f64
}

/// What calibration and map miss in a calibration trial that they have not seen, over the noise: the median of the trials.
fn doubt(prepared: &Prepared, floor: f64) -> f64 {
    let trials = &prepared.calibration;
    if trials.len() < 3 {
        return 0.0;
    }
    let plain = Response::new(prepared.nominal.model.clone(), None, None);
    let missed = |c: usize| {
        let others: Vec<Series> = trials.iter().enumerate().filter(|(k, _)| *k != c).map(|(_, s)| s.clone()).collect();
        let again = recalibrated(prepared, &others, plain.clone(), 1.0);
        let bare = ground::bare(&prepared.case, &others, again.clone(), &prepared.weight, 1.0);
        let zero = DVector::zeros(bare.calibrated());
        let nothing = Point { instances: &[], theta: &[], delta: &zero };
        let map = ground::static_map(&bare, nothing);
        let alone = std::slice::from_ref(&trials[c]);
        let mapped = ground::bare(&prepared.case, alone, again.with_map(map), &prepared.weight, 1.0);
        let residual = evaluate::residual(&mapped, 0, nothing, Tip::Exact, StateFrom::Trial);
        let count = trials[c].counts.iter().filter(|counts| **counts).count();
        (residual.norm_squared() / count.max(1) as f64 - floor * floor).max(0.0).sqrt()
    };
    let mut all: Vec<f64> = (0..trials.len()).into_par_iter().map(missed).collect();
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

fn on_calibration<'a>(prepared: &'a Prepared, together: &Setup<'a>, scored: &Scored, noise: f64) -> Setup<'a> {
    let free = together.calibrated();
    let prior = (DMatrix::zeros(free, free), DVector::zeros(free));
    let (instances, theta) = (&scored.fit.instances, &scored.fit.theta);
    Setup::new(
        &prepared.case.rig,
        &prepared.calibration,
        together.response.clone(),
        instances,
        theta,
        prepared.weight.clone(),
        noise,
        prior,
    )
}

fn down(prepared: &Prepared) -> Option<nalgebra::Vector3<f64>> {
    prepared.case.rig.arm.as_ref().map(|arm| arm.down)
}

/// Fits effects and calibration with no prior, moving the reference along.
pub fn free_fit<'a>(setup: Setup<'a>, instances: &[Instance], theta: &[Vec<f64>]) -> (Setup<'a>, Scored) {
    let free = setup.calibrated();
    let loose = Setup { precision: DMatrix::zeros(free, free), centre: DVector::zeros(free), ..setup };
    let mut setup = relinearised(&loose, instances, theta, &DVector::zeros(free));
    let mut theta = theta.to_vec();
    for _ in 0..4 {
        let step = fit(&setup, instances, &theta, &DVector::zeros(free), Tip::Exact, 4);
        setup = relinearised(&setup, instances, &step.theta, &step.delta);
        theta = step.theta;
    }
    let last = fit(&setup, instances, &theta, &DVector::zeros(free), Tip::Exact, 2);
    let scored = score(&setup, last, Tip::Exact);
    (setup, scored)
}

/// The setup around another point; δ is then measured from there.
pub fn relinearised<'a>(
    setup: &Setup<'a>,
    instances: &[Instance],
    theta: &[Vec<f64>],
    delta: &DVector<f64>,
) -> Setup<'a> {
    let moved: Vec<f64> = setup.response.parameters().iter().zip(delta.iter()).map(|(p, d)| p + d).collect();
    let response = setup.response.with_parameters(&moved);
    let prior = (setup.precision.clone(), &setup.centre - delta);
    Setup::new(setup.rig, setup.series, response, instances, theta, setup.weight.clone(), setup.noise, prior)
}

/// Nominal model, map and precision from the calibration trials, around the development trials.
fn initial_setup(prepared: &Prepared) -> Setup<'_> {
    let case = &prepared.case;
    let plain = Response::new(prepared.nominal.model.clone(), None, down(prepared));
    let trials = if prepared.calibration.is_empty() { &prepared.development } else { &prepared.calibration };
    let bare = ground::bare(case, trials, plain, &prepared.weight, 1.0);
    let zero = DVector::zeros(bare.calibrated());
    let nothing = Point { instances: &[], theta: &[], delta: &zero };
    // A map of the trials in which an effect is sought would swallow the effect.
    let map = if prepared.calibration.is_empty() { None } else { ground::static_map(&bare, nothing) };
    let mapped = ground::bare(case, trials, bare.response.with_map(map), &prepared.weight, 1.0);
    let around = ground::bare(case, &prepared.development, mapped.response.clone(), &prepared.weight, 1.0);
    if prepared.calibration.is_empty() {
        return around;
    }
    around.with_precision(ground::precision(&mapped, nothing))
}

/// Tightens the prior until the best calibration without effects lies within the 99 % ellipsoid.
fn within_ellipsoid(setup: Setup) -> Setup {
    let free = setup.calibrated();
    let limit = chi_square_99(free as f64);
    let mut tightened = setup.clone();
    for half_decades in 0..=16 {
        let factor = 10f64.powf(0.5 * f64::from(half_decades));
        tightened = setup.with_precision(&setup.precision * factor);
        let fitted = fit(&tightened, &[], &[], &setup.centre, Tip::Exact, 2);
        let away = &fitted.delta - &setup.centre;
        if away.dot(&(&setup.precision * &away)) <= limit {
            break;
        }
    }
    tightened
}

/// Wilson & Hilferty (1931), PNAS 17(12).
fn chi_square_99(freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom.max(1.0));
    freedom * (1.0 - spread + 2.326_347_9 * spread.sqrt()).powi(3)
}

/// Variance of the noise in one weighted output.
fn variance(floor: f64, setup: &Setup) -> f64 {
    (floor * floor / setup.outputs() as f64).max(f64::MIN_POSITIVE)
}

/// From what is left, or from what was measured at the full rate of the recording, whichever is smaller: both are bounds from
/// above.
fn floor(setup: &Setup, scored: &Scored, prepared: &Prepared) -> f64 {
    let left = noise_floor(&remainder(setup, scored, &prepared.case.rig, 0.0));
    let measured = prepared.case.development.iter().map(|trial| {
        let weighted =
            |(column, weight): (nalgebra::DVectorView<f64>, &f64)| column.iter().map(|y| y * weight).collect();
        let columns: Vec<Vec<f64>> = trial.measured.column_iter().zip(&prepared.weight).map(weighted).collect();
        noise_floor_of(&trial.record.time, &columns)
    });
    let (sum, count) = measured.fold((0.0, 0usize), |(sum, count), floor| (sum + floor * floor, count + 1));
    left.min((sum / count.max(1) as f64).sqrt())
}

/// What a fit leaves on blocks left out.
pub fn remainder<'r>(setup: &'r Setup, scored: &Scored, rig: &'r Rig, floor: f64) -> Remainder<'r> {
    let trials = setup.series.iter().zip(&setup.references).zip(&scored.residual).map(|((series, reference), r)| {
        TrialRemainder {
            name: &series.name,
            record: &series.thin,
            residual: r.iter().copied().collect(),
            counts: &series.counts,
            slopes: &reference.linear.by_actuator,
            block: &series.block,
        }
    });
    Remainder { rig, trials: trials.collect(), floor }
}

/// The response after calibrating again on `series`, without effects.
pub fn recalibrated(prepared: &Prepared, series: &[Series], response: Response, noise: f64) -> Response {
    let setup = ground::bare(&prepared.case, series, response, &prepared.weight, noise);
    let (setup, scored) = free_fit(setup, &[], &[]);
    let moved = setup.response.parameters();
    let moved: Vec<f64> = moved.iter().zip(scored.fit.delta.iter()).map(|(p, d)| p + d).collect();
    setup.response.with_parameters(&moved)
}

/// Root mean square of what effect `i` does to the outputs of the trials, weighted.
pub fn size(setup: &Setup, scored: &Scored, i: usize) -> f64 {
    let (mut instances, mut theta) = (scored.fit.instances.clone(), scored.fit.theta.clone());
    instances.remove(i);
    theta.remove(i);
    let without = Point { instances: &instances, theta: &theta, delta: &scored.fit.delta };
    let (mut squares, mut count) = (0.0, 0usize);
    for s in 0..setup.series.len() {
        let change = evaluate::residual(setup, s, scored.fit.point(), Tip::Exact, StateFrom::Trial)
            - evaluate::residual(setup, s, without, Tip::Exact, StateFrom::Trial);
        squares += change.norm_squared();
        count += setup.series[s].counts.iter().filter(|counts| **counts).count();
    }
    (squares / count.max(1) as f64).sqrt()
}

impl Prepared {
    /// Whether all outputs are lengths.
    pub fn is_length(&self) -> bool {
        self.case.rig.outputs.iter().all(|output| output.unit == "m")
    }

    /// Unit of the errors: that of all outputs, or the range of each.
    pub fn unit(&self) -> String {
        let outputs = &self.case.rig.outputs;
        let one = outputs.iter().all(|output| output.unit == outputs[0].unit);
        if one { outputs[0].unit.clone() } else { "of each range".into() }
    }
}
