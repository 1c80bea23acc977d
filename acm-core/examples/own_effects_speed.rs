//! Time of effects that a file writes over that of the library's, side by side in one run.
//!
//! Each pair acts in turn on the same record, at the same values; shown is the median of the times, and the ratio of the medians.

use std::time::Instant;

use acm_core::effects::own::{Own, read};
use acm_core::effects::{Carrier, Effect, Values, find};
use acm_core::record::Record;
use acm_core::rig::{Rig, Signal};

const EXAMPLE: &str = include_str!("my_effects.toml");
const SAMPLES: usize = 20_000;
const ROUNDS: usize = 201;

fn signal(name: &str, unit: &str, low: f64, high: f64) -> Signal {
    Signal { name: name.into(), unit: unit.into(), low, high }
}

fn rig(actuators: usize) -> Rig {
    Rig {
        actuators: (1..=actuators).map(|k| signal(&format!("q{k}"), "rad", -1.0, 1.0)).collect(),
        contexts: vec![],
        outputs: ["x", "y", "z"].map(|name| signal(name, "m", -0.3, 0.3)).to_vec(),
        throttle: None,
        altitude: None,
        payload: None,
        carried: false,
        arm: None,
        step: 0.01,
        duration: 0.01 * SAMPLES as f64,
    }
}

fn wave(count: usize, time: &[f64]) -> Vec<Vec<f64>> {
    (0..count).map(|k| time.iter().map(|t| (t * (0.7 + k as f64) + k as f64).sin()).collect()).collect()
}

/// Seconds that `effects` take one after the other on copies of the columns.
fn seconds(effects: &[(&dyn Effect, Carrier, Vec<f64>)], rig: &Rig, record: &Record, columns: &[Vec<f64>]) -> f64 {
    let mut columns = columns.to_vec();
    let specs: Vec<_> = effects.iter().map(|(effect, carrier, _)| effect.parameters(rig, *carrier)).collect();
    let begun = Instant::now();
    for ((effect, carrier, theta), specs) in effects.iter().zip(&specs) {
        effect.act(*carrier, Values::constant(specs, theta), record, &mut columns);
    }
    let seconds = begun.elapsed().as_secs_f64();
    std::hint::black_box(columns);
    seconds
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Effects with their carriers and parameters.
type Acting<'a> = Vec<(&'a dyn Effect, Carrier, Vec<f64>)>;

fn main() {
    let definitions = read(EXAMPLE, "my_effects.toml").expect("definitions");
    let jitter = |k: usize| 0.4 * (0.618 * k as f64).fract();
    println!("{:<28} {:>9} {:>12} {:>12} {:>7}", "effect", "actuators", "library", "own", "ratio");
    for (actuators, is_regular) in [(1, true), (1, false), (2, true), (2, false), (6, false)] {
        let rig = rig(actuators);
        let shake = |k: usize| if is_regular { 0.0 } else { jitter(k) };
        let time: Vec<f64> = (0..SAMPLES).map(|k| 0.01 * (k as f64 + shake(k))).collect();
        let (q, y) = (wave(actuators, &time), wave(3, &time));
        let record = Record::new(time, q.clone(), vec![], vec![]);
        let own: Vec<_> = definitions.iter().map(|d| Own::new(d, &rig).expect("an effect")).collect();
        let library = |name: &str| find(name).expect("an effect");
        let (all, first) = (Carrier::Rig, Carrier::Actuator(0));
        let widths = vec![0.1; actuators];
        let lag = vec![0.4, 0.3];
        let (f, c, window, speed) = (vec![0.02; 3], vec![0.01; 3], 0.05, 0.02);
        let dry = [&f[..], &[speed, window]].concat();
        let viscous = [&c[..], &[window]].concat();
        let friction = [&c[..], &f, &[window, speed]].concat();
        let pairs: [(&str, Acting, Acting, &[Vec<f64>]); 3] = [
            ("backlash", vec![(library("backlash"), all, widths.clone())], vec![(&*own[0], all, widths)], &q),
            (
                "Coulomb + viscous friction",
                vec![(library("coulomb_friction"), first, dry), (library("viscous_friction"), first, viscous)],
                vec![(&*own[1], first, friction)],
                &y,
            ),
            ("second-order lag", vec![(library("second_order_lag"), all, lag.clone())], vec![(&*own[2], all, lag)], &q),
        ];
        for (name, theirs, own, columns) in pairs {
            let (mut a, mut b) = (vec![], vec![]);
            for _ in 0..ROUNDS {
                a.push(seconds(&theirs, &rig, &record, columns));
                b.push(seconds(&own, &rig, &record, columns));
            }
            let per_sample = |times: Vec<f64>| 1e9 * median(times) / SAMPLES as f64;
            let (a, b) = (per_sample(a), per_sample(b));
            let steps = if is_regular { "even steps" } else { "uneven steps" };
            println!("{name:<28} {actuators:>9} {a:>9.1} ns {b:>9.1} ns {:>7.2}  {steps}", b / a);
        }
    }
}
