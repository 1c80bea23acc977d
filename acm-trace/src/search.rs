//! Which effects the model lacks: forward, exchange and backward steps, each judged on blocks left out.
//!
//! 1. Every candidate is fitted from every start with the model linear in its actuators (two steps), and ranked.
//! 2. The best are fitted with the true model, and scored on blocks left out.
//! 3. The best is accepted if it gains enough: over the noise, over what is left, and over the spread between blocks.
//! 4. All that are as good within one standard error of the paired difference are equivalent; the one with the fewest
//!    parameters stands for them.
//!
//! Where no single effect passes, pairs are tried: two effects can be useful only together.

use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;
use acm_core::rig::Rig;
use rayon::prelude::*;

use crate::evaluate::{Tip, free};
use crate::fit::{Fitted, Scored, fit, score};
use crate::setup::Setup;

/// What a search may do.
#[derive(Debug, Clone)]
pub struct Rules {
    /// Effects at most.
    pub most: usize,
    /// Root of the mean square that an effect must gain, as a share of the noise.
    pub gain: f64,
    /// Share of what is left over the noise that the first effect must explain.
    pub first_share: f64,
    /// The same for those after it.
    pub next_share: f64,
    /// The same for effects that are a function of the actuators alone ([`is_static`]): they compete with everything at rest
    /// that the nominal model does not have.
    pub static_share: [f64; 2],
    /// The same for two effects at once.
    pub pair_share: f64,
    /// Improvement in standard errors of the paired difference.
    pub significance: f64,
    /// Near the noise an effect must gain this share of all that was to be removed: there, what is left is mostly that the
    /// forms of earlier effects are not quite right.
    pub near_noise_share: f64,
    /// Up to how many times the noise is near.
    pub near_noise: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            most: 4,
            gain: 0.4,
            first_share: 0.12,
            next_share: 0.08,
            static_share: [0.5, 0.3],
            pair_share: 0.5,
            significance: 2.0,
            near_noise_share: 0.08,
            near_noise: 1.5,
        }
    }
}

/// One change of the set of effects.
#[derive(Debug, Clone)]
pub struct Move {
    /// The set after it.
    pub instances: Vec<Instance>,
    /// θ to start from.
    pub starts: Vec<Vec<Vec<f64>>>,
    /// Index in `instances` of the effect that is new or changed.
    pub new: Vec<usize>,
}

/// A fitted candidate.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Indices of what is new in it.
    pub new: Vec<usize>,
    /// Fit and scores.
    pub scored: Scored,
}

/// Candidates of one round, best first.
#[derive(Debug, Clone)]
pub struct Round {
    /// All that were fitted with the true model.
    pub tried: Vec<Tried>,
}

/// How two sets of effects compare on blocks left out.
#[derive(Debug, Clone, Copy)]
pub struct Comparison {
    /// Mean over blocks of the fall in mean square.
    pub gain: f64,
    /// Its standard error.
    pub error: f64,
}

/// Compares left-out scores, block by block.
pub fn compare(before: &[f64], after: &[f64]) -> Comparison {
    let n = before.len() as f64;
    let differences: Vec<f64> = before.iter().zip(after).map(|(before, after)| before - after).collect();
    let gain = differences.iter().sum::<f64>() / n;
    let variance = differences.iter().map(|d| (d - gain).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    Comparison { gain, error: (variance / n).sqrt() }
}

impl Comparison {
    /// Gain in standard errors.
    pub fn significance(&self) -> f64 {
        self.gain / self.error.max(f64::MIN_POSITIVE)
    }
}

/// Steps of a fit with the true model.
const STEPS: usize = 12;

/// Candidates that are fitted with the true model: at least, at most.
const FITTED: (usize, usize) = (5, 10);

/// Ranks all moves and fits the best.
pub fn round(setup: &Setup, current: &Scored, moves: Vec<Move>) -> Round {
    let moves: Vec<Move> = moves.into_iter().filter(|change| !is_general_map(&change.instances)).collect();
    let ranked: Vec<(f64, Vec<Vec<Vec<f64>>>)> =
        moves.par_iter().map(|change| screen(setup, current, change)).collect();
    let mut order: Vec<usize> = (0..moves.len()).filter(|&k| ranked[k].0.is_finite()).collect();
    order.sort_by(|&a, &b| ranked[a].0.total_cmp(&ranked[b].0));
    let start = current.fit.cost;
    let best = order.first().map_or(0.0, |&k| (start - ranked[k].0).max(0.0));
    let promising = order.iter().filter(|&&k| start - ranked[k].0 > 0.5 * best).count();
    order.truncate(promising.clamp(FITTED.0, FITTED.1));
    let mut tried: Vec<Tried> = order
        .par_iter()
        .map(|&k| {
            let fits = ranked[k]
                .1
                .iter()
                .map(|theta| fit(setup, &moves[k].instances, theta, &current.fit.delta, Tip::Exact, STEPS));
            let best = fits.reduce(|best, next| if next.cost < best.cost { next } else { best });
            best.map(|best| Tried { new: moves[k].new.clone(), scored: score(setup, best, Tip::Exact) })
        })
        .flatten()
        .collect();
    tried.sort_by(|a, b| a.scored.mean_square().total_cmp(&b.scored.mean_square()));
    Round { tried }
}

/// Starts that are fitted, of many.
const STARTS: usize = 3;

/// The starts from which one step leads lowest.
fn promising(setup: &Setup, current: &Scored, change: &Move) -> Vec<Vec<Vec<f64>>> {
    if change.starts.len() <= STARTS {
        return change.starts.clone();
    }
    let after_one = |theta: &Vec<Vec<f64>>| fit(setup, &change.instances, theta, &current.fit.delta, Tip::Linear, 1);
    let mut ends: Vec<Fitted> = change.starts.par_iter().map(after_one).filter(|end| end.cost.is_finite()).collect();
    ends.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    ends.into_iter().take(STARTS).map(|end| end.theta).collect()
}

/// Cost of the best start after two linear steps, and the starts worth a true fit.
fn screen(setup: &Setup, current: &Scored, change: &Move) -> (f64, Vec<Vec<Vec<f64>>>) {
    let delta = &current.fit.delta;
    let mut ends: Vec<(f64, Vec<Vec<f64>>)> = promising(setup, current, change)
        .iter()
        .map(|start| {
            let end = fit(setup, &change.instances, start, delta, Tip::Linear, 2);
            (end.cost, end.theta)
        })
        .filter(|(cost, _)| cost.is_finite())
        .collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(best) = ends.first().map(|end| end.0) else { return (f64::INFINITY, vec![]) };
    (best, ends.into_iter().take(2).filter(|end| end.0 < 1.02 * best).map(|end| end.1).collect())
}

/// The set with one more effect.
pub fn add(setup: &Setup, current: &Scored, new: &Instance) -> Move {
    let starts = new.starts(setup.rig);
    insert(&current.fit.instances, &current.fit.theta, new, &starts)
}

/// A load at the tip that grows with the payload from nothing: what the payload is expected to do, so that it is always tried.
pub fn add_payload(setup: &Setup, current: &Scored, load: &Instance) -> Option<Move> {
    let payload = setup.rig.payload.filter(|_| load.effect().name() == "tip_load")?;
    let new = load.with_context(Carrier::Context(payload), setup.rig)?;
    let largest = setup.rig.contexts[payload].magnitude();
    let own = new.own_parameters();
    let of = |mut start: Vec<f64>| {
        start[own] = start[0] / largest;
        start[0] = 0.0;
        start
    };
    let starts: Vec<Vec<f64>> = new.starts(setup.rig).into_iter().map(of).collect();
    Some(insert(&current.fit.instances, &current.fit.theta, &new, &starts))
}

fn insert(instances: &[Instance], theta: &[Vec<f64>], new: &Instance, starts: &[Vec<f64>]) -> Move {
    let at = instances.iter().position(|old| old.order() > new.order()).unwrap_or(instances.len());
    let mut set = instances.to_vec();
    set.insert(at, new.clone());
    let starts = starts
        .iter()
        .map(|start| {
            let mut all = theta.to_vec();
            all.insert(at, start.clone());
            all
        })
        .collect();
    Move { instances: set, starts, new: vec![at] }
}

/// The set without effect `i`.
pub fn remove(current: &Scored, i: usize) -> Move {
    let (mut instances, mut theta) = (current.fit.instances.clone(), current.fit.theta.clone());
    instances.remove(i);
    theta.remove(i);
    Move { instances, starts: vec![theta], new: vec![] }
}

/// The set with `new` in the place of effect `i`.
pub fn exchange(setup: &Setup, current: &Scored, i: usize, new: &Instance) -> Move {
    let rest = remove(current, i);
    insert(&rest.instances, &rest.starts[0], new, &new.starts(setup.rig))
}

/// The set with two more effects.
pub fn add_both(setup: &Setup, current: &Scored, first: (&Instance, &[f64]), second: &Instance) -> Move {
    let one = insert(&current.fit.instances, &current.fit.theta, first.0, &[first.1.to_vec()]);
    let mut both = insert(&one.instances, &one.starts[0], second, &second.starts(setup.rig));
    let shifted = if both.new[0] <= one.new[0] { one.new[0] + 1 } else { one.new[0] };
    both.new.push(shifted);
    both
}

/// Signals on which the size of an effect may depend: contexts, and for friction the actuators too, such as a pressure.
pub fn modulators(instance: &Instance, rig: &Rig) -> Vec<Carrier> {
    const FRICTION: [&str; 3] = ["coulomb_friction", "viscous_friction", "output_hysteresis"];
    let is_friction = FRICTION.contains(&instance.effect().name());
    let actuators = if is_friction { rig.actuators.len() } else { 0 };
    let contexts = (0..rig.contexts.len()).map(Carrier::Context);
    contexts.chain((0..actuators).map(Carrier::Actuator)).collect()
}

/// The set with effect `i` depending on a signal; none where it cannot.
pub fn vary(setup: &Setup, current: &Scored, i: usize, context: Carrier) -> Option<Move> {
    let old = &current.fit.instances[i];
    if old.context().is_some() {
        return None;
    }
    let new = old.with_context(context, setup.rig)?;
    let mut instances = current.fit.instances.clone();
    let mut theta = current.fit.theta.clone();
    let slopes = new.parameters().len() - old.parameters().len();
    theta[i].extend(std::iter::repeat_n(0.0, slopes));
    instances[i] = new;
    Some(Move { instances, starts: vec![theta], new: vec![i] })
}

/// Whether a set holds two effects that are functions of the actuators alone: together they are a general map, and nobody's
/// effect.
pub fn is_general_map(instances: &[Instance]) -> bool {
    instances.iter().filter(|instance| is_static(instance)).count() > 1
}

/// Whether an effect is rarely what a rig lacks, where a common one explains as much.
fn is_rare(instance: &Instance) -> bool {
    const RARE: [&str; 8] = [
        "viscous_slip",
        "second_order_lag",
        "rate_limit",
        "dead_zone",
        "dry_friction",
        "bouc_wen",
        "prandtl_ishlinskii",
        "measurement_lag",
    ];
    // The weight of the arm itself is one for all trials.
    let varies = instance.effect().name() == "self_weight" && instance.context().is_some();
    varies || RARE.contains(&instance.effect().name())
}

/// Whether several blocks gain more than the noise and hardly any loses: an effect at the ends of a range shows in few trials.
fn is_harmless(current: &Scored, next: &Scored, noise: f64) -> bool {
    let falls = || current.left_out.iter().zip(&next.left_out).map(|(before, after)| before - after);
    let lost = falls().filter(|fall| *fall < -0.1 * noise).count();
    falls().filter(|fall| *fall > noise).count() >= 3 && 10 * lost <= current.left_out.len()
}

/// Whether an effect is a function of the actuators alone.
pub fn is_static(instance: &Instance) -> bool {
    const STATIC: [&str; 12] = [
        "context_term",
        "encoder_periodic",
        "static_gain",
        "saturation",
        "dead_zone",
        "coupling",
        "tip_load",
        "self_weight",
        "side_wind",
        "marker_offset",
        "misregistration",
        "scale",
    ];
    let follows_payload = instance.effect().name() == "tip_load" && instance.context().is_some();
    !follows_payload && STATIC.contains(&instance.effect().name())
}

/// What gains are measured against.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Mean square without any effect, left out.
    pub bare: f64,
    /// Root mean square of the noise.
    pub floor: f64,
    /// Root mean square of what calibration and static map miss in a calibration trial that they have not seen, over the noise:
    /// as much of what is static may be nobody's effect.
    pub doubt: f64,
}

/// Whether an effect gains enough to be accepted.
pub fn is_enough(rules: &Rules, scale: Scale, current: &Scored, next: &Scored) -> bool {
    let comparison = compare(&current.left_out, &next.left_out);
    let Scale { bare, floor, doubt } = scale;
    let noise = floor * floor;
    let left = (current.mean_square() - noise).max(0.0);
    let is_near = current.mean_square() < rules.near_noise.powi(2) * noise;
    if is_near && comparison.gain < rules.near_noise_share * (bare - noise) {
        return false;
    }
    let known = |new: &&Instance| current.fit.instances.iter().any(|old| old.effect().name() == new.effect().name());
    let new: Vec<&Instance> = next.fit.instances.iter().filter(|new| !known(new)).collect();
    let any_static = new.iter().any(|new| is_static(new));
    if any_static && comparison.gain < (2.0 * doubt * doubt).max(noise) {
        return false;
    }
    let share = match (current.fit.instances.is_empty(), any_static) {
        _ if new.len() > 1 => return comparison.gain > rules.pair_share * left && comparison.significance() > 3.0,
        (true, true) => rules.static_share[0],
        (true, false) => rules.first_share,
        (false, true) => rules.static_share[1],
        (false, false) => rules.next_share,
    };
    let consistent = comparison.significance() > rules.significance || is_harmless(current, next, noise);
    comparison.gain > (rules.gain * floor).powi(2) && comparison.gain > share * left && consistent
}

/// Shares of what an effect explains, and of what it leaves over the noise, that may hang on its exact form, which no library
/// has: a simpler effect that comes this close is as good.
const FORM: [f64; 2] = [0.01, 0.5];

/// Indices into `tried` of those as good as the best, the one with the fewest parameters first.
pub fn equivalent(current: &Scored, tried: &[Tried], floor: f64) -> Vec<usize> {
    let Some(best) = tried.first() else { return vec![] };
    let noise = floor * floor;
    let whole = current.mean_square() - best.scored.mean_square();
    let form = (FORM[0] * whole).min(FORM[1] * (best.scored.mean_square() - noise));
    let close = |k: &usize| {
        let worse = compare(&tried[*k].scored.left_out, &best.scored.left_out);
        worse.gain <= worse.error.max(0.1 * noise).max(form) && worse.gain <= 0.1 * whole
    };
    let mut equal: Vec<usize> = (0..tried.len()).filter(close).collect();
    let rare = |k: usize| tried[k].new.iter().any(|&i| is_rare(&tried[k].scored.fit.instances[i]));
    equal.sort_by_key(|&k| (free(&tried[k].scored.fit.instances).len(), rare(k), k));
    equal
}
