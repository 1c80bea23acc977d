//! Data sets of which it is known how much there is to learn. The nominal prediction is in the data, so the residual is
//! what is planted, to the bit.
//!
//! | residual | per output                                                        | oracle gains |
//! | -------- | ----------------------------------------------------------------- | ------------ |
//! | white    | n, standard normal                                                | 0            |
//! | coloured | c_k = 0.95 c_{k−1} + √(1 − 0.95²) n                               | 0            |
//! | offsets  | n/2 + one standard normal value for each trial                    | 0            |
//! | little   | √p s(inputs) + √(1 − p) n, with 1 − √(1 − p) from 5 % to 15 %     | 5–15 %       |
//! | scales   | s(inputs) + a n, with a from 0.25 to 1 drawn for each trial       | more         |
//!
//! All times 10 mm. s is wind · q1 and the rate of q2, each with unit variance over the set.

use std::{fmt::Write, fs, io, path::Path};

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const SAMPLES: usize = 250;
const SCALE: f64 = 0.01;

/// Error of the nominal model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Residual {
    White,
    Coloured,
    Offsets,
    Little,
    Scales,
}

impl Residual {
    /// Residuals that hold nothing to learn.
    pub const NOTHING: [Self; 3] = [Self::White, Self::Coloured, Self::Offsets];

    pub fn name(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::Coloured => "coloured",
            Self::Offsets => "offsets",
            Self::Little => "little",
            Self::Scales => "scales",
        }
    }
}

/// One data set.
pub struct Planted {
    pub seed: u64,
    pub residual: Residual,
    /// Development trials and held-out trials.
    pub trials: [usize; 2],
}

/// Inputs q1, q2, wind, and the rate of q2.
type Inputs = [f64; 4];

impl Planted {
    /// Writes manifest and tables.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        let [development, held_out] = ["d", "h"].map(|role| self.names(role));
        fs::write(folder.join("manifest.toml"), manifest(&development, &held_out))?;
        let trials: Vec<String> = ["c1".into()].into_iter().chain(development).chain(held_out).collect();
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(self.residual as u64);
        let gain = 0.05 + 0.1 * uniform(&mut random);
        let share = if self.residual == Residual::Little { 1.0 - (1.0 - gain) * (1.0 - gain) } else { 0.0 };
        let inputs: Vec<Vec<Inputs>> = trials.iter().map(|_| motion(&mut random)).collect();
        let signal = standardised(&inputs);
        for ((name, inputs), signal) in trials.iter().zip(&inputs).zip(&signal) {
            let missed = self.missed(signal, share, &mut random);
            fs::write(folder.join(format!("{name}.csv")), table(inputs, &missed))?;
        }
        Ok(())
    }

    fn names(&self, role: &str) -> Vec<String> {
        let count = if role == "d" { self.trials[0] } else { self.trials[1] };
        (1..=count).map(|k| format!("{role}{k}")).collect()
    }

    fn missed(&self, signal: &[[f64; 2]], share: f64, random: &mut ChaCha8Rng) -> Vec<[f64; 2]> {
        let offset = [normal(random), normal(random)];
        let mut slow = [normal(random), normal(random)];
        let scale = 0.25 + 0.75 * uniform(random);
        let mut sample = |s: &[f64; 2]| {
            let white = [normal(random), normal(random)];
            slow = [0, 1].map(|o| 0.95 * slow[o] + (1.0 - 0.95f64 * 0.95).sqrt() * white[o]);
            [0, 1].map(|o| match self.residual {
                Residual::White => white[o],
                Residual::Coloured => slow[o],
                Residual::Offsets => 0.5 * white[o] + offset[o],
                Residual::Little => share.sqrt() * s[o] + (1.0 - share).sqrt() * white[o],
                Residual::Scales => s[o] + scale * white[o],
            })
        };
        signal.iter().map(|s| sample(s).map(|value| SCALE * value)).collect()
    }
}

/// Returns two sines per signal, with frequencies and phases of the trial's own.
fn motion(random: &mut ChaCha8Rng) -> Vec<Inputs> {
    let waves: Vec<[f64; 3]> = (0..6)
        .map(|_| [0.3 + 0.9 * uniform(random), 0.2 + uniform(random), std::f64::consts::TAU * uniform(random)])
        .collect();
    let sum = |signal: usize, of: &dyn Fn([f64; 3]) -> f64| of(waves[2 * signal]) + of(waves[2 * signal + 1]);
    let at = |k: usize| {
        let t = 0.1 * k as f64;
        let value = |signal| sum(signal, &|[a, w, phase]| a * (w * t + phase).sin());
        [value(0), value(1), value(2), sum(1, &|[a, w, phase]| a * w * (w * t + phase).cos())]
    };
    (0..SAMPLES).map(at).collect()
}

/// Standardises wind · q1 and the rate of q2 to mean 0 and variance 1 over all trials.
fn standardised(inputs: &[Vec<Inputs>]) -> Vec<Vec<[f64; 2]>> {
    let raw = |[q1, _, wind, rate]: &Inputs| [wind * q1, *rate];
    let all: Vec<[f64; 2]> = inputs.iter().flatten().map(raw).collect();
    let n = all.len() as f64;
    let mean = [0, 1].map(|o| all.iter().map(|s| s[o]).sum::<f64>() / n);
    let spread = [0, 1].map(|o| (all.iter().map(|s| (s[o] - mean[o]).powi(2)).sum::<f64>() / n).sqrt());
    let unit = |s: &Inputs| [0, 1].map(|o| (raw(s)[o] - mean[o]) / spread[o]);
    inputs.iter().map(|trial| trial.iter().map(unit).collect()).collect()
}

fn table(inputs: &[Inputs], missed: &[[f64; 2]]) -> String {
    let mut text = String::from("t,q1,q2,wind,x,y,px,py\n");
    for (k, ([q1, q2, wind, _], [mx, my])) in inputs.iter().zip(missed).enumerate() {
        let (px, py) = (0.2 * q1, 0.15 * q2);
        let _ = writeln!(text, "{},{q1},{q2},{wind},{},{},{px},{py}", k as f64 / 10.0, px + mx, py + my);
    }
    text
}

fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// Draws from the standard normal distribution. Box and Muller (1958).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (radius, angle) = (1.0 - uniform(random), uniform(random));
    (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
}

/// Returns the manifest; each fold leaves out one development trial of six, or a sixth of more.
fn manifest(development: &[String], held_out: &[String]) -> String {
    let fold = |k: usize| development.iter().skip(k).step_by(6).collect::<Vec<_>>();
    let folds: Vec<_> = (0..6).map(fold).collect();
    format!("{HEAD}development = {development:?}\nheld_out = {held_out:?}\n\n[folds]\nvalidation = {folds:?}\n")
}

const HEAD: &str = r#"
name      = "planted"
title     = "Planted residuals"
licence   = "CC0"
source    = "examples/nothing_to_learn"
synthetic = true

[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time  = { column = "t", unit = "s" }

[[actuator]]
column = "q1"
unit   = "rad"
[[actuator]]
column = "q2"
unit   = "rad"

[[context]]
column = "wind"
unit   = "1"

[[measured]]
column = "x"
unit   = "m"
[[measured]]
column = "y"
unit   = "m"

[[predicted]]
column = "px"
unit   = "m"
[[predicted]]
column = "py"
unit   = "m"

[roles]
calibration = ["c1"]
"#;

/// Experiment with a small network, trained long enough to overfit.
pub const EXPERIMENT: &str = r#"
question = "Is there anything to learn?"
data     = "data"

[inputs]
domain_filter = "none"
channels      = ["q1", "q2", "rate(q1)", "rate(q2)", "wind"]

[windows]
length = 5
reach  = 5

[network]
kind  = "gru"
units = 8

[training]
epochs        = 30
learning_rate = 5e-3
patience      = 10

[protocol]
cross_validation = true
seeds            = [1]
"#;
