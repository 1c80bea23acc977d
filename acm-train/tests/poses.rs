//! Poses of the nominal arm: an arm of constant curvature is an arc of a circle, in every point and at the tip.

mod campaign;

use std::collections::BTreeMap;

use acm_datasets::files::table::{Column, read_parquet};
use acm_train::run::nominal::poses::{self, Place, Poses};
use campaign::{Campaign, MANIFEST, TRIALS, inputs};

/// Length of the arm, m.
const LENGTH: f64 = 0.5;

const ARM: &str = r#"
[arm]
length       = { value = 0.5, unit = "m" }
axis         = "-z"
strain       = { basis = "legendre", order = 0 }
actuation    = { degree = 1 }
registration = { kind = "fixed" }

[conditions.h1]
payload = { value = 45.0, unit = "g" }
"#;

/// The arc of a circle that hangs along −z from the origin and bends by q1 towards x and by q2 towards y, at arc length s.
fn arc(q1: f64, q2: f64, s: f64) -> [f64; 3] {
    let curvature = (q1 * q1 + q2 * q2).sqrt();
    let out = (1.0 - (curvature * s).cos()) / curvature;
    [out * q1 / curvature, out * q2 / curvature, -(curvature * s).sin() / curvature]
}

fn tip(trial: usize, k: usize) -> [f64; 3] {
    let [q1, q2, _] = inputs(trial, k);
    arc(q1, q2, LENGTH)
}

/// The campaign with an arm, whose wind is a throttle.
fn campaign() -> Campaign {
    let campaign = Campaign::with(tip);
    let throttle = MANIFEST.replace("column = \"wind\"", "column = \"wind\"\nquantity = \"throttle\"");
    campaign.write("data/manifest.toml", &format!("{throttle}{ARM}"));
    campaign
}

fn learned(campaign: &Campaign) -> Option<Poses> {
    campaign.learn("run", &["--set", "protocol.seeds=[1]", "--set", "training.epochs=1"]);
    poses::read(&campaign.path("run")).unwrap()
}

/// Place of a sample in its trial, which is at 10 Hz.
fn sample(time: f64) -> usize {
    (10.0 * time).round() as usize
}

#[test]
fn an_arm_of_constant_curvature_is_an_arc() {
    let campaign = campaign();
    let poses = learned(&campaign).unwrap();
    assert_eq!(poses.run, "final-seed1");
    for (trial, name) in TRIALS.iter().enumerate().filter(|(_, name)| name.starts_with('h')) {
        let own = poses.trials.iter().find(|own| own.trial == *name).unwrap();
        assert!(own.time.len() > 50 && own.points.len() == own.time.len(), "{} samples", own.time.len());
        for (time, points) in own.time.iter().zip(&own.points) {
            let [q1, q2, _] = inputs(trial, sample(*time));
            for (k, point) in points.iter().enumerate() {
                let wanted = arc(q1, q2, LENGTH * k as f64 / (points.len() - 1) as f64);
                for (found, wanted) in point.iter().zip(wanted) {
                    assert!((found - wanted).abs() < 2e-5, "{name}, {time} s, point {k}: {found}, not {wanted}");
                }
            }
        }
    }
}

/// The tip of an arm is what the table of predictions calls nominal, at its own time stamps.
#[test]
fn tips_are_those_of_the_table() {
    let campaign = campaign();
    let poses = learned(&campaign).unwrap();
    let table: BTreeMap<String, Column> =
        read_parquet(&campaign.path("run/predictions/final-seed1.parquet")).unwrap().into_iter().collect();
    let numbers = |name: &str| table[name].numbers().unwrap();
    let (trials, parts) = (table["trial"].text().unwrap(), table["part"].text().unwrap());
    let mut compared = 0;
    for row in (0..trials.len()).filter(|&row| parts[row] == "held_out") {
        let own = poses.trials.iter().find(|own| own.trial == trials[row]).unwrap();
        let place = own.time.iter().position(|time| *time == numbers("time")[row]).unwrap();
        let tip = own.points[place].last().unwrap();
        for (found, output) in tip.iter().zip(["x", "y", "z"]) {
            assert!((found - numbers(&format!("nominal_{output}"))[row]).abs() <= 0.5e-6 + 1e-12);
        }
        compared += 1;
    }
    assert!(compared > 100, "{compared} rows");
}

/// Oracle: 45 g weigh 0.4413 N; the throttle is the formula of the campaign.
#[test]
fn loads_are_those_that_the_data_tell_of() {
    let campaign = campaign();
    let poses = learned(&campaign).unwrap();
    let of = |name: &str| poses.trials.iter().find(|own| own.trial == name).unwrap();
    let names = |name: &str| of(name).loads.iter().map(|load| load.name.as_str()).collect::<Vec<_>>();
    assert_eq!(names("h1"), ["weight", "payload", "downwash"]);
    assert_eq!(names("h2"), ["weight", "downwash"]);
    let h1 = of("h1");
    assert!(h1.loads.iter().all(|load| load.direction == [0.0, 0.0, -1.0]));
    assert!(h1.loads[0].size.is_empty() && h1.loads[1].place == Place::Tip && h1.loads[1].unit == "N");
    assert!(h1.loads[1].size.iter().all(|newton| (newton - 0.441_299).abs() < 1e-5), "{:?}", h1.loads[1].size[0]);
    for (time, throttle) in h1.time.iter().zip(&h1.loads[2].size) {
        assert!((throttle - inputs(4, sample(*time))[2]).abs() < 1e-12);
    }
}

#[test]
fn a_model_without_an_arm_has_no_poses() {
    assert!(learned(&Campaign::new()).is_none());
}
