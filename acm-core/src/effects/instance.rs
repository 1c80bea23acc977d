//! An effect as it acts on one rig: with what carries it, its parameters, and the context signal on which they may depend.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::own::{Own, OwnError, definition::Definition};
use super::{ALL, Carrier, Effect, Memory, Mode, ParameterSpec, Record, Rig, Site, Values, find};

/// See the head of this file. Values θ: those of the effect, then θ1 of each parameter that depends on the context.
#[derive(Clone)]
pub struct Instance {
    origin: Origin,
    carrier: Carrier,
    context: Option<Carrier>,
    /// Ends of the signal's range, where values are quadratic in the signal.
    ends: Option<[f64; 2]>,
    /// Of the effect alone.
    specs: Vec<ParameterSpec>,
    /// Indices of the parameters that depend on the context.
    varying: Vec<usize>,
    /// All, as the fit sees them.
    parameters: Vec<ParameterSpec>,
}

/// Where an effect comes from.
#[derive(Clone)]
enum Origin {
    Library(&'static dyn Effect),
    Own(Arc<Own>),
}

/// An effect with its values, as it is stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// Stable name of the effect.
    pub effect: String,
    /// What carries it.
    pub carrier: Carrier,
    /// The signal on which parameters depend.
    pub context: Option<Carrier>,
    /// θ, as an [`Instance`] orders them; SI.
    pub values: Vec<f64>,
    /// Definition of an effect from a file; then no other file is needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub definition: Option<Definition>,
}

/// Remedy for a model that another version wrote.
const AGAIN: &str = "run close-loop again with this version, or load the model with the one that wrote it";

impl Instance {
    /// An effect with constant parameters.
    pub fn new(effect: &'static dyn Effect, carrier: Carrier, rig: &Rig) -> Self {
        Self::of(Origin::Library(effect), carrier, rig)
    }

    /// An effect of one's own on its rig, with constant parameters.
    pub fn own(effect: &Arc<Own>, carrier: Carrier, rig: &Rig) -> Self {
        Self::of(Origin::Own(Arc::clone(effect)), carrier, rig)
    }

    fn of(origin: Origin, carrier: Carrier, rig: &Rig) -> Self {
        let specs = origin.effect().parameters(rig, carrier);
        Self { origin, carrier, context: None, ends: None, parameters: specs.clone(), specs, varying: vec![] }
    }

    /// Every effect with each of its carriers on this rig.
    pub fn all(rig: &Rig) -> Vec<Instance> {
        let ways = |effect: &&'static dyn Effect| {
            let effect = *effect;
            effect.carriers(rig).into_iter().map(move |carrier| Instance::new(effect, carrier, rig))
        };
        ALL.iter().flat_map(ways).collect()
    }

    /// An effect of one's own with each of its carriers on its rig.
    pub fn all_own(effect: &Arc<Own>, rig: &Rig) -> Vec<Instance> {
        effect.carriers(rig).into_iter().map(|carrier| Instance::own(effect, carrier, rig)).collect()
    }

    /// The same with θ = θ0 + θ1·c for each parameter that may vary. None where no parameter may, c is constant, or c is the carrier;
    /// but a static effect of a context may vary with its carrier, and is then quadratic in it.
    pub fn with_context(&self, context: Carrier, rig: &Rig) -> Option<Instance> {
        let signal = context.signal(rig)?;
        let free = |j: &usize| self.specs[*j].may_vary && self.specs[*j].is_free();
        let varying: Vec<usize> = (0..self.specs.len()).filter(free).collect();
        let bends = self.effect().traits().is_static && matches!(context, Carrier::Context(_));
        if varying.is_empty() || !signal.varies() || (self.carrier == context && !bends) {
            return None;
        }
        let slopes = varying.iter().map(|&j| {
            let spec = &self.specs[j];
            let name = format!("{} per {}", spec.name, signal.name);
            let unit = format!("{} per {}", spec.unit, signal.unit);
            let slope = ParameterSpec::size(name, unit, spec.scale / signal.magnitude());
            ParameterSpec { linear: spec.linear, ..slope }
        });
        let parameters = self.specs.iter().cloned().chain(slopes).collect();
        Some(Instance { context: Some(context), varying, parameters, ..self.clone() })
    }

    /// The same with θ2 (c − a)(c − b) added, where a and b are the ends of the signal's range; none without a context, or if added.
    pub fn with_bow(&self, rig: &Rig) -> Option<Instance> {
        let signal = self.context?.signal(rig)?;
        if self.is_bowed() {
            return None;
        }
        let bows = self.varying.iter().map(|&j| {
            let spec = &self.specs[j];
            let name = format!("{} per {}²", spec.name, signal.name);
            let unit = format!("{} per {}²", spec.unit, signal.unit);
            let bow = ParameterSpec::size(name, unit, spec.scale / signal.magnitude().powi(2));
            ParameterSpec { linear: spec.linear, ..bow }
        });
        let parameters = self.parameters.iter().cloned().chain(bows).collect();
        Some(Instance { ends: Some([signal.low, signal.high]), parameters, ..self.clone() })
    }

    /// Whether its values are quadratic in a signal.
    pub fn is_bowed(&self) -> bool {
        self.ends.is_some()
    }

    /// The ends a and b between which the line is bowed.
    pub fn ends(&self) -> Option<[f64; 2]> {
        self.ends
    }

    /// The stored effect on this rig.
    ///
    /// # Errors
    /// A name that is not known, or a number of values that does not fit: in words.
    pub fn restore(term: &Term, rig: &Rig) -> Result<Instance, String> {
        let origin = Origin::stored(term, rig)?;
        let effect = origin.effect();
        let missing = |context| format!("{} depends on a signal that the rig lacks ({context:?})", term.effect);
        if !effect.carriers(rig).contains(&term.carrier) {
            return Err(format!("{} cannot act on this rig by {:?}", term.effect, term.carrier));
        }
        let plain = Instance::of(origin.clone(), term.carrier, rig);
        let instance = match term.context {
            None => plain,
            Some(context) => plain.with_context(context, rig).ok_or_else(|| missing(context))?,
        };
        let instance = match instance.with_bow(rig) {
            Some(bowed) if bowed.parameters.len() == term.values.len() => bowed,
            _ => instance,
        };
        let (found, needed) = (term.values.len(), instance.parameters.len());
        if found != needed || term.values.iter().any(|value| !value.is_finite()) {
            return Err(format!("{} has {found} values where {needed} finite ones are needed; {AGAIN}", term.effect));
        }
        Ok(instance)
    }

    /// To be stored, with its values.
    pub fn term(&self, theta: &[f64]) -> Term {
        let definition = match &self.origin {
            Origin::Library(_) => None,
            Origin::Own(own) => Some(own.definition().clone()),
        };
        let (effect, values) = (self.effect().name().into(), theta.to_vec());
        Term { effect, carrier: self.carrier, context: self.context, values, definition }
    }

    /// The effect.
    pub fn effect(&self) -> &dyn Effect {
        self.origin.effect()
    }

    /// Whether it is defined by a file.
    pub fn is_own(&self) -> bool {
        matches!(self.origin, Origin::Own(_))
    }

    /// What carries it.
    pub fn carrier(&self) -> Carrier {
        self.carrier
    }

    /// The signal on which its parameters depend.
    pub fn context(&self) -> Option<Carrier> {
        self.context
    }

    /// Where it acts.
    pub fn site(&self) -> Site {
        self.effect().site()
    }

    /// Indices of the effect's own parameters that depend on the context; their slopes follow the own parameters in this order.
    pub fn varying(&self) -> &[usize] {
        &self.varying
    }

    /// Place in the order of action.
    pub fn order(&self) -> usize {
        ALL.iter().position(|effect| effect.name() == self.effect().name()).unwrap_or(ALL.len())
    }

    /// All parameters.
    pub fn parameters(&self) -> &[ParameterSpec] {
        &self.parameters
    }

    /// How many of them belong to the effect itself; the rest are slopes with the context.
    pub fn own_parameters(&self) -> usize {
        self.specs.len()
    }

    /// Values to start a fit from ([`Effect::initial_guesses`]), slopes with the context at 0.
    pub fn initial_guesses(&self, rig: &Rig) -> Vec<Vec<f64>> {
        let slopes = vec![0.0; self.parameters.len() - self.specs.len()];
        let guesses = self.effect().initial_guesses(rig, self.carrier);
        guesses.into_iter().map(|guess| [guess, slopes.clone()].concat()).collect()
    }

    /// Name, with the carrier where an effect has several: `coulomb_friction(x)`.
    pub fn label(&self, rig: &Rig) -> String {
        let carrier = self.carrier.signal(rig).map_or(String::new(), |signal| format!("({})", signal.name));
        let context = self.context.and_then(|c| c.signal(rig)).map_or(String::new(), |c| format!(" × {}", c.name));
        let context = if self.is_bowed() { format!("{context}²") } else { context };
        format!("{}{carrier}{context}", self.effect().name())
    }

    /// Acts on the columns of its site, of a whole trial.
    pub fn act(&self, theta: &[f64], record: &Record, columns: &mut [Vec<f64>]) {
        let (own, slopes) = theta.split_at(self.specs.len());
        let slopes = if self.context.is_some() { self.all_slopes(slopes) } else { vec![] };
        self.proceed(own, &slopes, record, &mut Memory::of_whole_trial(), columns);
    }

    /// Acts on the next samples. With a context, `slopes` has one entry for each of the effect's `own` values, and a second one for
    /// each where they are quadratic in it.
    fn proceed(&self, own: &[f64], slopes: &[f64], record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let varying = |signal| {
            let (slope, bow) = slopes.split_at(own.len());
            let straight = Values::varying(&self.specs, own, slope, signal);
            self.ends.map_or(straight, |ends| straight.bowed(bow, ends))
        };
        let values = match self.context {
            Some(Carrier::Context(c)) => varying(&record.contexts[c]),
            Some(Carrier::Actuator(a)) => varying(&record.actuators[a]),
            _ => Values::constant(&self.specs, own),
        };
        self.effect().proceed(self.carrier, values, record, memory, columns);
    }

    /// Time constant of an unknown initial state, s.
    pub fn memory(&self, theta: &[f64]) -> Option<f64> {
        self.effect().memory(Values::constant(&self.specs, &theta[..self.specs.len()]))
    }

    /// Decay of each part of that state, slowest first.
    pub fn modes(&self, theta: &[f64]) -> impl Iterator<Item = Mode> + use<> {
        let values = Values::constant(&self.specs, &theta[..self.specs.len()]);
        let (effect, frequency) = (self.effect(), self.effect().swinging(values));
        let memories = effect.memory(values).into_iter().chain(effect.second_memory(values));
        memories.map(move |memory| Mode { memory, frequency })
    }

    fn all_slopes(&self, slopes: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.specs.len() * if self.is_bowed() { 2 } else { 1 }];
        let places = self.varying.iter().copied().chain(self.varying.iter().map(|j| self.specs.len() + j));
        places.zip(slopes).for_each(|(j, slope)| all[j] = *slope);
        all
    }
}

/// An effect with its values and its memory, for a trial in pieces.
#[derive(Debug)]
pub struct Running {
    instance: Instance,
    own: Vec<f64>,
    slopes: Vec<f64>,
    memory: Memory,
}

impl Running {
    /// State before the first sample; `theta` as in [`Instance::act`].
    pub fn new(instance: &Instance, theta: &[f64]) -> Self {
        let (own, slopes) = theta.split_at(instance.specs.len());
        let slopes = instance.all_slopes(slopes);
        Self { instance: instance.clone(), own: own.to_vec(), slopes, memory: Memory::default() }
    }

    /// Where it acts.
    pub fn site(&self) -> Site {
        self.instance.site()
    }

    /// Acts on the next samples. After the first piece, pieces that are no longer allocate nothing.
    pub fn proceed(&mut self, record: &Record, columns: &mut [Vec<f64>]) {
        self.instance.proceed(&self.own, &self.slopes, record, &mut self.memory, columns);
    }

    /// Back to before the first sample of a trial.
    pub fn restart(&mut self) {
        self.memory.restart();
    }

    /// Its memory.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Restores a memory that was taken from it ([`Running::memory`]).
    pub fn remember(&mut self, memory: &Memory) {
        self.memory.clone_from(memory);
    }
}

impl Origin {
    fn effect(&self) -> &dyn Effect {
        match self {
            Origin::Library(effect) => *effect,
            Origin::Own(own) => &**own,
        }
    }

    /// The effect that a term names, or defines.
    fn stored(term: &Term, rig: &Rig) -> Result<Self, String> {
        match &term.definition {
            None => find(&term.effect)
                .map(Origin::Library)
                .ok_or_else(|| format!("effect {:?} is not known to this version; {AGAIN}", term.effect)),
            Some(definition) if definition.name != term.effect => {
                Err(format!("effect {:?} has the definition of {:?}; {AGAIN}", term.effect, definition.name))
            }
            Some(definition) => {
                Own::new(definition, rig).map(Origin::Own).map_err(|error: OwnError| format!("{error}; {AGAIN}"))
            }
        }
    }
}

impl std::fmt::Debug for Instance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} by {:?}", self.effect().name(), self.carrier)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Signal;

    #[test]
    fn a_term_of_another_version_is_refused_with_a_remedy() {
        let signal = |name: &str| Signal { name: name.into(), unit: "rad".into(), low: -1.0, high: 1.0 };
        let rig = Rig {
            actuators: vec![signal("q")],
            contexts: vec![],
            outputs: vec![signal("y")],
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: None,
            step: 0.01,
            duration: 10.0,
        };
        let term = |effect: &str, values: &[f64]| Term {
            effect: effect.into(),
            carrier: Carrier::Rig,
            context: None,
            values: values.to_vec(),
            definition: None,
        };
        assert!(Instance::restore(&term("dead_time", &[0.2]), &rig).is_ok());
        for (term, said) in
            [(term("dead_time", &[0.2, 0.1]), "dead_time has 2 values"), (term("dead_times", &[0.2]), "\"dead_times\"")]
        {
            let message = Instance::restore(&term, &rig).unwrap_err();
            assert!(message.contains(said) && message.contains("run close-loop again"), "{message}");
        }
    }
}
