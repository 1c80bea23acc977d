//! Averages of several estimators in one source. Oracle: the average in Rust, which shares no code with it.

use std::process::Command;

use acm_core::InterSample;
use acm_core::effects::{ALL, Carrier};
use acm_stream::{AverageParts, MemberParts, Nominal, Parts, StateRule};

use crate::alone::alone;
use crate::compile::{assert_equal_average, compilers, link, through, written_average};
use crate::robots::{augmented, bodies, ensemble, hanging, parts, rig, small, term};

/// Members with equal weights, each of which reads the inputs in another order than a sample has them.
fn average(members: Vec<Parts>) -> AverageParts {
    let weight = 1.0 / members.len() as f64;
    let widest = members.iter().map(Parts::width).max().expect("a member");
    // One input that nobody reads stands first, and the others stand from the last to the first.
    let places = |parts: &Parts| (0..parts.width()).map(|k| widest - k).collect();
    let member = |parts: Parts| MemberParts { places: places(&parts), parts, weight };
    let inputs = (0..=widest).map(|k| format!("input {k}")).collect();
    AverageParts { inputs, members: members.into_iter().map(member).collect(), interval: None }
}

/// Two networks of other kinds and state rules on other nominal models, and a model without a network.
fn mixed() -> AverageParts {
    let terms = ["dead_time", "backlash"].map(|name| term(name, Carrier::Rig, &rig())).to_vec();
    let loaded = augmented(terms).with_inter_sample(&InterSample::Quartic(vec![1]));
    let one = parts(small(), Nominal::Augmented(loaded.clone()), StateRule::Window(4));
    let other = ensemble(parts(bodies().remove(16), Nominal::Model(hanging()), StateRule::Running), 2);
    let nominal = Parts { tip: 3..6, ..alone(Nominal::Augmented(loaded)) };
    average(vec![one, other, tip_of(nominal)])
}

/// The model alone with three of its outputs.
fn tip_of(parts: Parts) -> Parts {
    let own = Parts::alone(parts.signals.clone(), parts.nominal.clone(), parts.tip.clone(), 0.1);
    own.expect("three outputs of it")
}

#[test]
fn an_average_answers_as_in_rust() {
    assert_equal_average("three members", &mixed(), 5000);
    let two = [small(), bodies().remove(0)].map(|body| parts(body, Nominal::Model(hanging()), StateRule::Running));
    assert_equal_average("two networks on one arm", &average(two.to_vec()), 5000);
    assert_equal_average("one", &average(vec![two[0].clone()]), 500);
}

/// Names of every effect and network in one file: no two of them meet.
#[test]
fn every_part_fits_beside_every_other() {
    let rig = rig();
    let of = |effect: &&dyn acm_core::effects::Effect| {
        let carrier = *effect.carriers(&rig).last()?;
        Some(tip_of(Parts {
            tip: 3..6,
            ..alone(Nominal::Augmented(augmented(vec![term(effect.name(), carrier, &rig)])))
        }))
    };
    let mut members: Vec<Parts> = ALL.iter().filter_map(of).collect();
    members.extend(bodies().into_iter().map(|body| parts(body, Nominal::Model(hanging()), StateRule::Running)));
    println!("{} members", members.len());
    assert_equal_average("every effect and network", &average(members), 500);
}

#[test]
fn compilers_find_nothing_and_its_own_test_passes() {
    for cc in compilers() {
        let folder = written_average(&mixed());
        let flags = ["-O1", "-DSELFTEST", "-Wconversion", "-Wshadow", "-fsanitize=address,undefined"];
        let program = link(cc, &folder, &["estimator.c"], &flags);
        let output = Command::new(program).output().expect("it runs");
        assert!(output.status.success(), "{cc}: {}", String::from_utf8_lossy(&output.stdout));
    }
}

/// Oracle: the answers of a new trial, after the member whose delay is full has refused a sample.
#[test]
fn where_a_later_member_refuses_all_begin_anew() {
    let Some(cc) = compilers().first().copied() else { return };
    let model = Nominal::Augmented(augmented(vec![term("dead_time", Carrier::Rig, &rig())]));
    let two = average(vec![
        parts(small(), Nominal::Model(hanging()), StateRule::Running),
        tip_of(Parts { tip: 3..6, ..alone(model) }),
    ]);
    let folder = written_average(&two);
    let program = link(cc, &folder, &["estimator.c", "drive.c"], &["-O1", "-DESTIMATOR_MEMBER2_EFFECT_1_ROOM=6"]);
    let mut samples = acm_export::rehearsal::samples_of_average(&two, 20);
    samples.iter_mut().for_each(|sample| sample.elapsed = 1e-4);
    let found = through(&program, &samples);
    let refused = found.iter().position(|answer| answer[0] == 6.0).expect("a delay that is full");
    let again = through(&program, &samples[refused + 1..]);
    assert_eq!(found[refused + 1..], again[..]);
}
