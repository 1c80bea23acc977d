//! Changes of the set of effects: one more, one less, another, two more, or a size that depends on a signal.

use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;
use acm_core::rig::Rig;

use crate::fit::Scored;
use crate::setup::Setup;

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

/// The set with one more effect.
pub fn add(setup: &Setup, current: &Scored, new: &Instance) -> Move {
    let starts = new.initial_guesses(setup.rig);
    insert(&current.fit.instances, &current.fit.theta, new, &starts)
}

/// A load at the tip that grows with the payload from nothing: what the payload is expected to do, so that it is always tried.
pub fn add_payload(setup: &Setup, current: &Scored, load: &Instance) -> Option<Move> {
    let payload = setup.rig.payload.filter(|_| load.effect().traits().is_carried)?;
    let new = load.with_context(Carrier::Context(payload), setup.rig)?;
    let largest = setup.rig.contexts[payload].magnitude();
    let own = new.own_parameters();
    let of = |mut start: Vec<f64>| {
        start[own] = start[0] / largest;
        start[0] = 0.0;
        start
    };
    let starts: Vec<Vec<f64>> = new.initial_guesses(setup.rig).into_iter().map(of).collect();
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
    insert(&rest.instances, &rest.starts[0], new, &new.initial_guesses(setup.rig))
}

/// The set with two more effects.
pub fn add_both(setup: &Setup, current: &Scored, first: (&Instance, &[f64]), second: &Instance) -> Move {
    let one = insert(&current.fit.instances, &current.fit.theta, first.0, &[first.1.to_vec()]);
    let mut both = insert(&one.instances, &one.starts[0], second, &second.initial_guesses(setup.rig));
    let shifted = if both.new[0] <= one.new[0] { one.new[0] + 1 } else { one.new[0] };
    both.new.push(shifted);
    both
}

/// Signals on which the size of an effect may depend: contexts, and for friction the actuators too.
pub fn modulators(instance: &Instance, rig: &Rig) -> Vec<Carrier> {
    let traits = instance.effect().traits();
    if traits.is_constant {
        return vec![];
    }
    let actuators = if traits.follows_pressure { rig.actuators.len() } else { 0 };
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
