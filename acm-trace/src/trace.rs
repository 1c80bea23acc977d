//! The search as a whole: from the nominal model to the effects that it lacks.
//!
//! 1. The nominal model is calibrated, and a static map learned, on calibration trials; from then on the calibration floats
//!    within its own 99 % ellipsoid. Without such trials it is fitted to the development trials, floats freely, and there is no map.
//! 2. Rounds of [`crate::search`], judged by [`crate::rules`]: add, let a parameter depend on a context, exchange, take away; until nothing wins.
//!    Where no single effect passes, pairs are tried: two effects can be useful only together.
//! 3. An effect that acts in the calibration trials too makes them trials like the others: calibration, map and effects are
//!    then fitted to both together.

use acm_core::effects::instance::Instance;
use acm_core::static_map::StaticMap;
use nalgebra::DVector;

use crate::evaluate::Tip;
use crate::finding::{Candidate, Step};
use crate::fit::{Scored, fit, score};
use crate::joining::joined;
use crate::moves::{self, Move};
use crate::moving::relinearised;
use crate::prepared::Prepared;
use crate::rules::{self, Rules, Scale, compare};
use crate::search::{self, Round, Tried};
use crate::series::Series;
use crate::setup::Setup;
use crate::start::{doubt, floor, initial_setup, variance, within_ellipsoid};

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
    let mut sets = vec![search.set()];
    while search.last.fit.instances.len() < options.rules.most {
        let from = search.steps.len();
        let goes_on = search.grow() && search.refine();
        search.steps[from..].iter().for_each(&mut progress);
        // What is added may make another superfluous, which is then added again: a set that was there before ends it.
        if !goes_on || sets.contains(&search.set()) {
            break;
        }
        sets.push(search.set());
    }
    search.finish()
}

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

    /// The effects, by name and signals.
    fn set(&self) -> Vec<String> {
        self.last.fit.instances.iter().map(|instance| instance.label(self.setup.rig)).collect()
    }

    fn scale(&self) -> Scale {
        Scale { bare: self.bare.mean_square(), floor: self.floor, doubt: self.doubt }
    }

    /// Adds the best effect, or the best pair; whether one was good enough.
    fn grow(&mut self) -> bool {
        let new = self.absent();
        let mut moves: Vec<Move> = new.iter().map(|new| moves::add(&self.setup, &self.last, new)).collect();
        moves.extend(new.iter().filter_map(|new| moves::add_payload(&self.setup, &self.last, new)));
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
        let taken_up = |new: &Instance| in_calibration && new.effect().traits().is_calibrated_away;
        self.prepared.library.iter().filter(|new| !is_in(new) && !taken_up(new)).cloned().collect()
    }

    fn accept_best(&mut self, round: &Round) -> bool {
        let Some(best) = round.tried.first() else { return false };
        let enough = rules::is_enough(&self.options.rules, self.scale(), &self.last, &best.scored);
        if !enough {
            return false;
        }
        let equal = rules::equivalent(&self.last, &round.tried, self.floor);
        let pick = equal.first().copied().unwrap_or(0);
        let name = |k: &usize| new_names(&round.tried[*k]);
        let mut names: Vec<String> = Vec::new();
        for k in &equal {
            name(k).into_iter().for_each(|name| {
                if !names.contains(&name) {
                    names.push(name);
                }
            });
        }
        let tried = &round.tried[pick];
        let significance = compare(&self.last.left_out, &tried.scored.left_out).significance();
        let label = format!("+ {}", self.labels(tried).join(" + "));
        self.insert_equivalents(tried, &names);
        let is_first = self.last.fit.instances.is_empty();
        self.settle(&tried.scored);
        if is_first {
            self.first = self.last.mean_square();
        }
        self.record(label, Some(significance), &round.tried);
        true
    }

    fn labels(&self, tried: &Tried) -> Vec<String> {
        tried.new.iter().map(|&i| tried.scored.fit.instances[i].label(self.setup.rig)).collect()
    }

    fn insert_equivalents(&mut self, tried: &Tried, names: &[String]) {
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
                    moves.push(moves::add_both(&self.setup, &self.last, (instance, theta), second));
                }
            }
        }
        let round = search::round(&self.setup, &self.last, moves);
        self.accept_best(&round)
    }

    /// Effect `i` with its size depending on each signal that it may depend on.
    fn varied(&self, scored: &Scored, i: usize) -> Vec<Move> {
        let signals = moves::modulators(&scored.fit.instances[i], self.setup.rig).into_iter();
        signals.filter_map(|signal| moves::vary(&self.setup, scored, i, signal)).collect()
    }

    /// Lets effects depend on context signals, where that wins.
    fn vary(&mut self) {
        let of = |i: usize| self.varied(&self.last, i);
        let moves: Vec<Move> = (0..self.last.fit.instances.len()).flat_map(of).collect();
        let round = search::round(&self.setup, &self.last, moves);
        let Some(best) = round.tried.first() else { return };
        if !rules::is_enough(&self.options.rules, self.scale(), &self.last, &best.scored) {
            return;
        }
        let significance = compare(&self.last.left_out, &best.scored.left_out).significance();
        let label = self.labels(best).join(" + ");
        self.settle(&best.scored);
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
        let moves = new.iter().map(|new| moves::exchange(&self.setup, &self.last, i, new)).collect();
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
        self.equivalent.remove(i);
        self.order.remove(i);
        self.insert_equivalents(best, &new_names(best));
        self.settle(&best.scored);
        self.record(label, Some(comparison.significance()), &round.tried);
        true
    }

    /// Takes away what is no longer needed.
    fn shrink(&mut self) {
        while self.last.fit.instances.len() > 1 {
            let moves: Vec<Move> = (0..self.last.fit.instances.len()).map(|i| moves::remove(&self.last, i)).collect();
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
            self.settle(&fits[i]);
            self.record(label, None, &[]);
        }
    }

    /// Everything that a new effect may change about the others; whether anything of it stands.
    fn refine(&mut self) -> bool {
        self.join_calibration();
        self.vary();
        self.exchange();
        self.shrink();
        self.stands()
    }

    /// Whether what is left of a pair still gains enough on its own; else nothing was found.
    fn stands(&mut self) -> bool {
        let alone = self.last.fit.instances.len() == 1;
        if !alone || rules::is_enough(&self.options.rules, self.scale(), &self.bare, &self.last) {
            return true;
        }
        (self.setup, self.last) = (self.bare_setup.clone(), self.bare.clone());
        (self.equivalent, self.order, self.joined) = (vec![], vec![], false);
        self.record("none of them alone".into(), None, &[]);
        false
    }

    /// Moves the reference to the new model, and fits and scores it there.
    fn settle(&mut self, scored: &Scored) {
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

fn new_names(tried: &Tried) -> Vec<String> {
    tried.new.iter().map(|&i| tried.scored.fit.instances[i].effect().name().to_string()).collect()
}
