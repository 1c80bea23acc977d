//! Trials whose first sample is reached on a way that was not recorded.

use acm_core::nominal::NominalSpec;
use acm_trace::case::Trial;
use acm_trace::finding::Finding;
use rand::RngExt;

use crate::bench::{Bench, STEP, effect, found, is_near, names, parameter, press, told};
use crate::motion::random;

const NOISE: f64 = 0.01;

fn straight(contexts: Vec<[&'static str; 2]>) -> Bench {
    Bench { nominal: NominalSpec::Polynomial { degree: 1 }, noise: vec![NOISE], ..press(contexts) }
}

/// Traces eight trials, with three more held out.
fn traced(bench: &Bench, trial: impl Fn(&str, usize) -> Trial) -> Finding {
    let of = |part: &str, trials: std::ops::Range<usize>| trials.map(|k| trial(part, k)).collect();
    found(bench.case(vec![], of("d", 0..8), of("u", 8..11)))
}

/// Where a play of this half width, which may vary, ends up at each sample, from a place anywhere in it.
fn played(q: &[f64], width: impl Fn(usize) -> f64, place: f64) -> Vec<f64> {
    let first = q[0] + place * width(0);
    let step = |z: &mut f64, (t, q): (usize, &f64)| {
        *z = z.max(q - width(t)).min(q + width(t));
        Some(4.0 * *z)
    };
    q.iter().enumerate().scan(first, step).collect()
}

/// A play of 0.3 to either side, which every trial begins at one end of: where motion is slow, it lasts.
#[test]
fn a_play_begins_where_its_trial_left_it() {
    let bench = straight(vec![]);
    let finding = traced(&bench, |name, k| {
        let drive = bench.drive(k, 400, 81, &[]);
        let place = if random(500 + k as u64).random_bool(0.5) { 0.95 } else { -0.95 };
        bench.trial(name, &drive, &[played(&drive.q()[0], |_| 0.3, place)])
    });
    assert_eq!(names(&finding), ["backlash"], "{}", told(&finding));
    let width = parameter(effect(&finding, "backlash"), "width_q1");
    assert!((width.value / 0.3 - 1.0).abs() < 0.01, "{width:?}");
    assert!(!finding.before.is_empty(), "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// A play that grows with the square of a recorded bend.
#[test]
fn a_width_may_be_bowed_over_a_signal() {
    let bench = straight(vec![["bend", "rad"]]);
    let width = |bend: f64| 0.1 + 0.02 * bend + 0.08 * bend * bend;
    let finding = traced(&bench, |name, k| {
        let bend = [0.0, 0.5, 1.0, 1.5, 2.0][k % 5];
        let drive = bench.drive(k, 400, 82, &[bend]);
        bench.trial(name, &drive, &[played(&drive.q()[0], |_| width(bend), 0.0)])
    });
    let [play] = &finding.effects[..] else { panic!("{}", told(&finding)) };
    let value = |name: &str| parameter(play, name).value;
    for bend in [0.0, 1.0, 2.0] {
        let line = value("width_q1") + value("width_q1 per bend") * bend;
        let found = line + value("width_q1 per bend²") * bend * (bend - 2.0);
        assert!((found / width(bend) - 1.0).abs() < 0.02, "{found} at {bend}: {}", told(&finding));
    }
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// A mass on a spring, 3 s and damping 0.1, follows its actuator; it swings when a trial begins, as it was struck.
#[test]
fn an_oscillator_may_swing_at_the_start() {
    let bench = straight(vec![]);
    let finding = traced(&bench, |name, k| {
        let drive = bench.drive(k, 400, 83, &[]);
        let (omega, zeta) = (std::f64::consts::TAU / 3.0, 0.1);
        let q = &drive.q()[0];
        let (mut z, mut v) = (q[0], 0.0);
        let mut draw = random(900 + k as u64);
        (z, v) = (z + draw.random_range(-0.5..0.5), v + draw.random_range(-2.0..2.0));
        let mut y = vec![4.0 * z];
        for pair in q.windows(2) {
            // Semi-implicit Euler in 2000 steps between samples.
            for n in 0..2000 {
                let x = pair[0] + (pair[1] - pair[0]) * (f64::from(n) + 0.5) / 2000.0;
                v += STEP / 2000.0 * (omega * omega * (x - z) - 2.0 * zeta * omega * v);
                z += STEP / 2000.0 * v;
            }
            y.push(4.0 * z);
        }
        bench.trial(name, &drive, &[y])
    });
    assert_eq!(names(&finding), ["second_order_lag"], "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// Where a mass on a spring is at each sample that follows a signal from rest, and its speed over ω, by semi-implicit Euler in 2000 steps
/// between samples.
fn sprung(q: &[f64], period: f64, damping: f64) -> Vec<[f64; 2]> {
    let omega = std::f64::consts::TAU / period;
    let (mut z, mut v) = (q[0], 0.0);
    let mut all = vec![[z, 0.0]];
    for pair in q.windows(2) {
        for n in 0..2000 {
            let x = pair[0] + (pair[1] - pair[0]) * (f64::from(n) + 0.5) / 2000.0;
            v += STEP / 2000.0 * (omega * omega * (x - z) - 2.0 * damping * omega * v);
            z += STEP / 2000.0 * v;
        }
        all.push([z, v / omega]);
    }
    all
}

/// Two masses on springs of their own, 3 and 1.1 s, both of which the sensor sees.
#[test]
fn vibrations_of_a_structure_add_up() {
    let bench = straight(vec![]);
    let finding = traced(&bench, |name, k| {
        let drive = bench.drive(k, 400, 84, &[]);
        let [slow, fast] = [(3.0, 0.05), (1.1, 0.03)].map(|(period, damping)| sprung(&drive.q()[0], period, damping));
        let y = slow.iter().zip(&fast).map(|([z, _], [w, rate])| 4.0 * z + 2.0 * w + rate);
        bench.trial(name, &drive, &[y.collect()])
    });
    let mut periods: Vec<f64> = finding.effects.iter().map(|effect| parameter(effect, "period").value).collect();
    periods.sort_by(f64::total_cmp);
    assert!(periods.len() == 2 && (periods[0] / 1.1 - 1.0).abs() < 0.005, "{}", told(&finding));
    assert!((periods[1] / 3.0 - 1.0).abs() < 0.005, "{}", told(&finding));
    assert!(names(&finding).contains(&"vibration_mode"), "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// Six plays of different width in parallel, which the trials begin at one end of.
#[test]
fn plays_in_parallel_are_a_hysteresis_of_several_elements() {
    let bench = straight(vec![]);
    let finding = traced(&bench, |name, k| {
        let drive = bench.drive(k, 400, 85, &[]);
        let widths = [0.05, 0.12, 0.2, 0.3, 0.4, 0.5];
        let each = widths.map(|width| played(&drive.q()[0], |_| width, -0.9));
        let y = (0..400).map(|t| each.iter().map(|play| play[t]).sum::<f64>() / 6.0);
        bench.trial(name, &drive, &[y.collect()])
    });
    assert_eq!(names(&finding), ["output_prandtl_ishlinskii"], "{}", told(&finding));
    let start = parameter(effect(&finding, "output_prandtl_ishlinskii"), "start");
    assert!((start.value - 0.9).abs() < 0.1, "{start:?}");
    assert!(finding.errors.after.value < 1.25 * NOISE, "{}", told(&finding));
}
