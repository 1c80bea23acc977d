//! The rig and the records of a small set.

use acm_datasets::rig::{record, rig};
use acm_datasets::{Campaign, Role, Trial};

use super::set::{self, Set};

const VEHICLE: &str = "[vehicle]\nposition = [\"px\", \"py\", \"pz\"]\nunit = \"m\"\n[roles]";

fn learned(campaign: &Campaign) -> Vec<&Trial> {
    campaign.trials(Role::Development).collect()
}

/// Oracle: the manifest of the set, and its rows converted by hand: ms, deg, cm, mm.
#[test]
fn signals_have_names_units_and_the_range_of_the_trials_in_use() {
    let set = Set::new();
    let condition = |name: &str| format!("[conditions.\"{name}\"]\npayload = {{ value = 45, unit = \"g\" }}\n");
    let all = ["a", "b", "c", "d"].map(condition).concat();
    set.edit("manifest.toml", "[roles]", &format!("{all}[conditions.a.room]\nvalue = 3\nunit = \"1\"\n[roles]"));
    let campaign = set.campaign();
    let rig = rig(&campaign, &learned(&campaign));
    let degrees = [set::rows(0), set::rows(1)].concat().into_iter().map(|row| row[1]);
    let low = degrees.clone().fold(f64::INFINITY, f64::min).to_radians();
    let high = degrees.fold(f64::NEG_INFINITY, f64::max).to_radians();
    let q = &rig.actuators[0];
    assert_eq!((q.name.as_str(), q.unit.as_str(), rig.outputs[0].unit.as_str()), ("q", "rad", "m"));
    assert!((q.low - low).abs() < 1e-15 && (q.high - high).abs() < 1e-15);
    let names: Vec<&str> = rig.contexts.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["h", "payload"], "a condition that one trial lacks is no signal");
    assert_eq!((rig.contexts[0].low, rig.contexts[0].high), (0.125, 0.135));
    assert_eq!((rig.contexts[1].low, rig.contexts[1].unit.as_str()), (0.045, "kg"));
    assert_eq!((rig.throttle, rig.altitude, rig.payload), (None, Some(0), Some(1)));
    assert_eq!((rig.carried, rig.arm.is_none()), (false, true));
    assert!((rig.step - 0.1).abs() < 1e-12 && (rig.duration - 5.9).abs() < 1e-12);
    let record = record(&campaign, &campaign.trials[1]);
    assert_eq!((record.samples(), record.contexts.len(), record.acceleration.len()), (60, 2, 0));
    assert_eq!((record.contexts[0][7], record.contexts[1][59]), (0.135, 0.045));
}

#[test]
fn a_set_without_trials_in_use_has_a_rig_too() {
    let campaign = Set::new().campaign();
    let rig = rig(&campaign, &[]);
    assert_eq!((rig.actuators[0].low, rig.actuators[0].high, rig.step, rig.duration), (0.0, 0.0, 0.0, 0.0));
}

/// Oracle: 1.5 t² has the acceleration 3.
#[test]
fn a_carrier_that_moves_has_an_acceleration() {
    let set = Set::new();
    set.edit("manifest.toml", "[roles]", VEHICLE);
    with_place(&set);
    let campaign = set.campaign();
    assert!(rig(&campaign, &learned(&campaign)).carried);
    let [x, y, z] = <[Vec<f64>; 3]>::try_from(record(&campaign, &campaign.trials[0]).acceleration).expect("three");
    assert!(x.iter().all(|a| (a - 3.0).abs() < 1e-9), "{x:?}");
    assert!(y.iter().chain(&z).all(|a| a.abs() < 1e-9));
}

/// A part of a trial is seen with the inputs before it, from the trial's first sample on.
#[test]
fn a_part_of_a_trial_has_the_inputs_before_it() {
    let set = Set::new();
    set.edit("manifest.toml", "\"a\", \"b\"", "\"b\"");
    let parts = "head = { until = 2.0, role = \"development\" }\ntail = { role = \"held_out\" }";
    set.edit("manifest.toml", "[roles]", &format!("[cut.a]\n{parts}\n[roles]"));
    let campaign = set.campaign();
    let tail = record(&campaign, campaign.trial("a:tail").expect("tail"));
    assert_eq!((tail.samples(), tail.time[0], tail.actuator_rates[0].len()), (60, 0.0, 60));
}

#[test]
fn an_arm_knows_which_way_is_down() {
    let down = |lines: &str| {
        let set = Set::new();
        set.edit("manifest.toml", "column = \"y\"\nunit = \"mm\"", &marker());
        with_place(&set);
        set.edit(
            "manifest.toml",
            "[roles]",
            &format!("[arm]\nlength = {{ value = 50, unit = \"cm\" }}\n{lines}[roles]"),
        );
        let campaign = set.campaign();
        let arm = rig(&campaign, &learned(&campaign)).arm.expect("an arm");
        assert_eq!(arm.length, 0.5);
        [arm.down.x, arm.down.y, arm.down.z]
    };
    assert_eq!(down(""), [0.0, 0.0, -1.0]);
    assert_eq!(down("axis = \"x\"\n"), [0.0, 0.0, -1.0]);
    assert_eq!(down("axis = \"-y\"\n"), [0.0, -1.0, 0.0], "an arm along -y hangs");
    assert_eq!(down("axis = \"-y\"\ndown = \"z\"\n"), [0.0, 0.0, 1.0]);
}

/// Three outputs: the place in the tables.
fn marker() -> String {
    let output = |name: &str| format!("column = \"{name}\"\nunit = \"m\"\n");
    ["px", "py", "pz"].map(output).join("[[measured]]\n")
}

/// Adds a place to every table: 1.5 t² in x, and still in y and z.
fn with_place(set: &Set) {
    for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
        let line = |r: &[f64; 4]| {
            let t = r[0] / 1000.0;
            format!("{},{},{},{},{},7,-2\n", r[0], r[1], r[2], r[3], 1.5 * t * t)
        };
        let rows: String = set::rows(i).iter().map(line).collect();
        set.write(&format!("run_{name}.csv"), &format!("t,q,h,y,px,py,pz\n{rows}"));
    }
}
