//! When a change of the set of effects is accepted, and what is as good as the best.
//!
//! ```text
//! gain = mean over blocks of (before_b − after_b),   s = its standard error
//! accepted where  gain > (0.4 floor)²,  gain > share (before − floor²),  gain > 2 s
//! equivalent where  worse ≤ max(s, 0.1 floor², what hangs on the form)
//! ```
//!
//! | symbol            | meaning                                                       | unit                |
//! | `before_b, after_b` | mean square on block b, left out                            | of the output, squared |
//! | `floor`           | root mean square of the noise                                 | of the output       |
//! | `share`           | of what is left that an effect must explain                   | 1                   |

use acm_core::effects::instance::Instance;

use crate::evaluate::free;
use crate::fit::Scored;
use crate::search::Tried;

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

/// Whether a set holds two effects that are functions of the actuators alone: together they are a general map, and nobody's
/// effect.
pub fn is_general_map(instances: &[Instance]) -> bool {
    instances.iter().filter(|instance| is_static(instance)).count() > 1
}

/// Whether several blocks gain more than the noise and hardly any loses: an effect at the ends of a range shows in few trials.
fn is_harmless(current: &Scored, next: &Scored, noise: f64) -> bool {
    let falls = || current.left_out.iter().zip(&next.left_out).map(|(before, after)| before - after);
    let lost = falls().filter(|fall| *fall < -0.1 * noise).count();
    falls().filter(|fall| *fall > noise).count() >= 3 && 10 * lost <= current.left_out.len()
}

/// Whether an effect is a function of the actuators alone; a load of the payload's size is not, as it differs between trials.
pub fn is_static(instance: &Instance) -> bool {
    let traits = instance.effect().traits();
    traits.is_static && !(traits.is_carried && instance.context().is_some())
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

/// Indices into `tried` of those as good as the best, the one with the fewest parameters first, and last what rests on a bound.
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
    let bound = |k: usize| tried[k].rests_on_bound();
    let rare = |k: usize| tried[k].new.iter().any(|&i| tried[k].scored.fit.instances[i].effect().traits().is_rare);
    equal.sort_by_key(|&k| (bound(k), free(&tried[k].scored.fit.instances).len(), rare(k), k));
    equal
}
