//! Sets of real measurements, where the shared ones are at hand: each is checked, and its roles are what its head says.

use acm_datasets::rig::{record, rig};
use acm_datasets::{Campaign, Role, Trial};

use super::trunk::shared;

fn campaign(set: &str, data: &str) -> Option<Campaign> {
    let Some(data) = shared().map(|root| root.join("data").join(data)).filter(|folder| folder.is_dir()) else {
        eprintln!("skipped: no shared measurements of {data}");
        return None;
    };
    let folder = std::path::absolute(set).unwrap();
    let campaign = Campaign::check(&folder, Some(&data), 50, 5.0).unwrap_or_else(|e| panic!("{e}"));
    assert!(campaign.warnings.is_empty(), "{:?}", campaign.warnings);
    Some(campaign)
}

fn trials(campaign: &Campaign) -> Vec<(&str, Role, usize)> {
    campaign.trials.iter().map(|t| (t.name.as_str(), t.role, t.samples())).collect()
}

/// Oracle: the files' numbers of lines, and the first row as it is written.
#[test]
fn the_pneumatic_cylinder() {
    let Some(campaign) = campaign("pneumatic-cylinder", "pneumatic-cylinder") else { return };
    let (development, held_out) = (Role::Development, Role::HeldOut);
    let expected = [
        ("circle_1bar", development, 7139),
        ("circle_3bar", held_out, 7834),
        ("circle_5bar", held_out, 10321),
        ("circle_7bar", development, 8720),
    ];
    assert_eq!(trials(&campaign), expected);
    let used: Vec<&Trial> = campaign.trials(Role::Development).collect();
    let rig = rig(&campaign, &used);
    assert_eq!((rig.actuators[0].name.as_str(), rig.actuators[0].unit.as_str()), ("p", "Pa"));
    assert!((rig.actuators[0].low - 93_400.0).abs() < 1e-6 && (rig.actuators[0].high - 707_300.0).abs() < 1e-6);
    assert_eq!((rig.contexts[0].unit.as_str(), rig.outputs[0].unit.as_str(), rig.arm.is_some()), ("m", "N", false));
    assert!((rig.step - 0.01).abs() < 0.002, "{}", rig.step);
    let record = record(&campaign, &campaign.trials[0]);
    assert_eq!((record.time[1], record.contexts[0][0]), (0.011, -0.009 / 1000.0));
}

/// Oracle: the file's number of lines, and 70 % of its last time stamp.
#[test]
fn the_fatigue_rig() {
    let Some(campaign) = campaign("faster", "faster") else { return };
    let parts = trials(&campaign);
    assert_eq!(
        (parts[0].0, parts[0].1, parts[1].0, parts[1].1),
        ("faster:head", Role::Development, "faster:tail", Role::HeldOut)
    );
    assert_eq!(parts[0].2 + parts[1].2, 21_275);
    assert!((parts[0].2 as f64 / 21_275.0 - 0.7).abs() < 0.001);
    assert!((campaign.trials[1].time[0] - 0.7 * 164.94).abs() < 0.02, "time stays that of the record");
    let rig = rig(&campaign, &campaign.trials(Role::Development).collect::<Vec<_>>());
    assert!(rig.contexts.is_empty(), "what follows from the force is no input");
    assert_eq!((rig.throttle, rig.altitude, rig.payload), (None, None, None));
}

/// Oracle: 105 s of 150 s at 20 Hz; the conditions as they are written.
#[test]
fn the_trunk_with_a_payload() {
    let Some(campaign) = campaign("asl-trunk-payload", "asl-trunk") else { return };
    let expected = [
        ("run1_0g:head", Role::Calibration, 2100),
        ("run1_0g:tail", Role::Development, 900),
        ("run1_200g:head", Role::Development, 2100),
        ("run1_200g:tail", Role::HeldOut, 900),
        ("run2_0g", Role::Excluded, 3000),
    ];
    assert_eq!(trials(&campaign), expected);
    let rig = rig(&campaign, &campaign.trials(Role::Development).collect::<Vec<_>>());
    let payload = &rig.contexts[rig.payload.expect("a payload")];
    assert_eq!((payload.low, payload.high, payload.unit.as_str()), (0.0, 0.2, "kg"));
    assert_eq!(rig.arm.map(|arm| [arm.length, arm.down.y]), Some([0.312, -1.0]));
    assert_eq!(record(&campaign, &campaign.trials[3]).contexts[0], vec![0.2; 3000]);
}
