//! A question about sequences: one TOML file with `study = "sequences"`.
//!
//! ```toml
//! study    = "sequences"
//! question = "Is the next position known from irregular samples?"
//! target   = "every"                 # or "last"
//! loss     = "mean_square"           # or "cross_entropy": one logit for each label 0 or 1
//! elapsed  = "measured"              # or "one"
//! nominal  = "persistence"           # or "none": what the network's answer is added to
//! scale    = "together"              # or "each": by what targets are divided
//! seeds    = [1, 2, 3]
//! [data]
//! kind    = "table"                  # or "bit_stream_xor"
//! folder  = "recordings"
//! time    = "t"
//! time_unit = "ms"                   # left out: "s"
//! inputs  = ["x", "v"]
//! targets = ["x"]
//! ahead   = 1
//! [control]                          # the same network with other elapsed times
//! elapsed = "one"
//! ```

use acm_datasets::sequences::{Asked, bit_stream::BitStream, table::Rules, table::Tables};
use acm_models::{NetworkConfig, device};
use serde::{Deserialize, Serialize};

use super::error::ConfigError;
use super::experiment::Elapsed;
use super::parse::decode::decode;
use super::parse::fault::Fault;
use super::parse::source::Source;
use super::read::name_the_default_network;
use super::training::TrainingConfig;
use super::training::loss::Loss;
use super::validate::network_fault;

/// Largest number of bits in streams. More do not fit into memory as sequences.
const MOST_BITS: usize = 1 << 28;

/// A question about sequences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Question {
    /// Kind of the study: `sequences`.
    pub study: String,
    /// Question in one sentence.
    pub question: String,
    /// Device, as in an experiment.
    pub device: String,
    /// Steps that are supervised.
    pub target: Asked,
    /// Loss function.
    pub loss: Loss,
    /// Elapsed times that the network receives.
    pub elapsed: Elapsed,
    /// Base that the network's output is added to.
    #[serde(skip_serializing_if = "is_default")]
    pub nominal: Persistence,
    /// Divisor of the targets.
    #[serde(skip_serializing_if = "is_default")]
    pub scale: Scale,
    /// Seeds of the initial weights and of the order of batches.
    pub seeds: Vec<u64>,
    /// Whether each run is scored on the test part at its end.
    #[serde(skip_serializing_if = "is_true")]
    pub test: bool,
    /// Source of the sequences.
    pub data: Data,
    /// Control: the same networks with other elapsed times.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control: Option<Control>,
    /// The network and its sizes.
    pub network: NetworkConfig,
    /// Optimizer, epochs, batches.
    pub training: TrainingConfig,
}

/// Source of the sequences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Data {
    /// Streams of bits that are generated.
    BitStreamXor(BitStream),
    /// Tables of any origin.
    Table(Tables),
}

/// Base that a network's output is added to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Persistence {
    /// No base.
    #[default]
    None,
    /// Last known value of each target, which is among the inputs.
    Persistence,
}

/// Divisor of the targets in the loss.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Each target by its own spread. All targets count alike, whatever their units.
    #[default]
    Each,
    /// All targets by one divisor, the root mean square of their spreads. The loss is then proportional to the mean
    /// square error in the targets' own unit, which all share.
    Together,
}

/// A second row: what differs from the first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Control {
    /// Elapsed times that the network receives.
    pub elapsed: Elapsed,
    /// Number of epochs, where fewer suffice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub epochs: Option<usize>,
}

impl Default for Question {
    fn default() -> Self {
        Self {
            study: "sequences".into(),
            question: "What does elapsed time tell?".into(),
            device: "flex".into(),
            target: Asked::Last,
            loss: Loss::MeanSquare,
            elapsed: Elapsed::Measured,
            nominal: Persistence::None,
            scale: Scale::Each,
            seeds: vec![1, 2, 3],
            test: true,
            data: Data::BitStreamXor(BitStream::default()),
            control: None,
            network: NetworkConfig::default(),
            training: TrainingConfig::default(),
        }
    }
}

fn is_true(value: &bool) -> bool {
    *value
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl Default for Control {
    fn default() -> Self {
        Self { elapsed: Elapsed::One, epochs: None }
    }
}

impl Question {
    /// Returns whether a network receives elapsed times as measured, in either row.
    pub fn reads_elapsed(&self) -> bool {
        let measured = |elapsed: Elapsed| elapsed == Elapsed::Measured;
        self.network.reads_elapsed()
            && (measured(self.elapsed) || self.control.as_ref().is_some_and(|control| measured(control.elapsed)))
    }

    /// Returns the rules for the columns of a table.
    pub fn rules(&self) -> Rules {
        Rules { asked: self.target, labels: self.loss == Loss::CrossEntropy }
    }
}

/// Reads the question from `source`, and checks it.
///
/// # Errors
/// A key that is unknown, a value of a wrong type or out of bounds, with its place and a remedy.
pub fn read(source: &mut Source) -> Result<Question, ConfigError> {
    name_the_default_network(&mut source.tree);
    let question: Question = decode(source, "experiments/xor.toml")?;
    source.refuse_first(faults(&question))?;
    Ok(question)
}

fn faults(question: &Question) -> Vec<Fault> {
    let training = question.training.validate().err();
    let device = device(&question.device).err();
    [
        device.map(|e| Fault::new("device", format!("cannot be used: {e}"), "device = \"flex\" computes on any CPU")),
        network_fault(&question.network),
        training.map(|f| Fault::new(&format!("training.{}", f.field), format!("is {}", f.value), f.remedy)),
        seeds(&question.seeds),
        question.control.as_ref().and_then(|control| of_control(question, control)),
        match &question.data {
            Data::BitStreamXor(asked) => streams(question, asked),
            Data::Table(asked) => tables(question, asked).or_else(|| windows(asked)),
        },
        of_nominal(question),
        of_scale(question),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn seeds(seeds: &[u64]) -> Option<Fault> {
    if seeds.is_empty() {
        return Some(Fault::new("seeds", "is empty, so there is nothing to run", "write at least one: seeds = [1]"));
    }
    let twice = (1..seeds.len()).find(|&i| seeds[..i].contains(&seeds[i])).map(|i| seeds[i])?;
    Some(Fault::new("seeds", format!("names seed {twice} twice; both runs would be the same"), "name each seed once"))
}

fn of_control(question: &Question, control: &Control) -> Option<Fault> {
    if let Some(fault) = control.epochs.and_then(|epochs| Fault::count("control.epochs", epochs, 1, 1_000_000, "60")) {
        return Some(fault);
    }
    (control.elapsed == question.elapsed).then(|| {
        let what = format!("is \"{}\", as in the row that it is compared with", control.elapsed.name());
        Fault::new("control.elapsed", what, "write the other one of \"measured\" and \"one\", or leave [control] out")
    })
}

fn of_nominal(question: &Question) -> Option<Fault> {
    if question.nominal == Persistence::None {
        return None;
    }
    let fault = |what: String| {
        Fault::new("nominal", what, "name the target among data.inputs too, or write nominal = \"none\"")
    };
    match &question.data {
        _ if question.loss == Loss::CrossEntropy => {
            Some(fault("is \"persistence\", and a label has no last value".into()))
        }
        Data::BitStreamXor(_) => Some(fault("is \"persistence\", and streams have labels".into())),
        Data::Table(asked) => asked
            .targets
            .iter()
            .find(|target| !asked.inputs.contains(target))
            .map(|target| fault(format!("is \"persistence\", and the target {target:?} is not seen"))),
    }
}

fn of_scale(question: &Question) -> Option<Fault> {
    (question.scale == Scale::Together && question.loss == Loss::CrossEntropy)
        .then(|| Fault::new("scale", "is \"together\", and labels are not divided by anything", "leave the key out"))
}

fn windows(asked: &Tables) -> Option<Fault> {
    let windows = asked.windows?;
    let of = |key: &str, value: usize, least: usize, example: &str| {
        Fault::count(&format!("data.windows.{key}"), value, least, 1_000_000, example)
    };
    of("length", windows.length, 1, "64")
        .or_else(|| of("stride", windows.stride, 1, "16"))
        .or_else(|| of("spare", windows.spare, 0, "0"))
}

fn streams(question: &Question, asked: &BitStream) -> Option<Fault> {
    let many = |count: usize| (1..=10_000_000).contains(&count);
    let count = "write 1 to 10000000";
    if question.loss != Loss::CrossEntropy || question.target != Asked::Last {
        let key = if question.target == Asked::Last { "loss" } else { "target" };
        let help = "write target = \"last\" and loss = \"cross_entropy\"";
        return Some(Fault::new(key, "does not fit data.kind = \"bit_stream_xor\", one label a stream", help));
    }
    if !many(asked.training) {
        return Some(Fault::new("data.training", format!("is {}", asked.training), count));
    }
    if !many(asked.test) {
        return Some(Fault::new("data.test", format!("is {}", asked.test), count));
    }
    if !(3..=4096).contains(&asked.length) {
        let help = "write 3 to 4096; streams have 2 bits to one less than that";
        return Some(Fault::new("data.length", format!("is {}", asked.length), help));
    }
    let bits = asked.training.max(asked.test) * asked.length;
    if bits > MOST_BITS {
        let help = format!("make fewer or shorter streams: {MOST_BITS} bits at most");
        let key = if asked.test > asked.training { "data.test" } else { "data.training" };
        return Some(Fault::new(key, format!("streams of data.length = {} are {bits} bits", asked.length), help));
    }
    if asked.step <= 0.0 {
        let help = "write the time from bit to bit, above 0, for example 1.0";
        return Some(Fault::new("data.step", format!("is {}", asked.step), help));
    }
    (!(asked.validation > 0.0 && asked.validation < 1.0)).then(|| share("data.validation", asked.validation))
}

fn share(key: &str, value: f64) -> Fault {
    Fault::new(key, format!("is {value}"), "write a share of the sequences above 0 and below 1, for example 0.1")
}

fn tables(question: &Question, asked: &Tables) -> Option<Fault> {
    for (key, empty) in [
        ("data.files", asked.files.is_empty()),
        ("data.inputs", asked.inputs.is_empty()),
        ("data.targets", asked.targets.is_empty()),
    ] {
        if empty {
            return Some(Fault::new(key, "is empty", "name at least one"));
        }
    }
    if asked.time.is_some() && asked.elapsed.is_some() {
        return Some(Fault::new(
            "data.elapsed",
            "is set together with data.time, which has the same meaning",
            "delete one of the two",
        ));
    }
    let told = question.elapsed == Elapsed::Measured || question.control.is_some();
    if asked.time.is_none() && asked.elapsed.is_none() && told {
        let help = "name a column of time stamps (data.time) or of elapsed times, or write elapsed = \"one\"";
        return Some(Fault::new("data.time", "and data.elapsed are left out, so no time is measured", help));
    }
    if let (Some(unit), None) = (&asked.time_unit, asked.unit_of_time()) {
        return Some(Fault::new("data.time_unit", format!("is {unit:?}"), "write s, ms, us, ns, min or h"));
    }
    if asked.time_unit.is_some() && asked.time.is_none() && asked.elapsed.is_none() {
        let help = "delete it, or name the column that it is of";
        return Some(Fault::new("data.time_unit", "is set without data.time or data.elapsed", help));
    }
    if let Some(wrong) = asked.wrong_sign() {
        return Some(Fault::new(&format!("data.{}", wrong.key), format!("is {:?}", wrong.value), wrong.remedy));
    }
    if asked.ahead > 1 {
        let help = "write 0 for the row itself, or 1 for the next";
        return Some(Fault::new("data.ahead", format!("is {}", asked.ahead), help));
    }
    let shares = [("data.validation", asked.validation), ("data.test", asked.test)];
    let whole = asked.part.is_none() && asked.validation + asked.test >= 1.0;
    let bad = shares.into_iter().find(|(_, value)| whole || !(*value > 0.0 && *value < 1.0));
    bad.map(|(key, value)| share(key, value))
}
