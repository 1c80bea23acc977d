//! Every kind of network, over ten thousand steps with gaps.

use acm_core::NominalModel;
use acm_stream::{Nominal, StateRule};

use crate::compile::assert_equal;
use crate::robots::{bodies, ensemble, hanging, parts, small};

#[test]
fn every_network_answers_as_in_rust() {
    for body in bodies() {
        let what = format!("{body:?}");
        let parts = parts(body, Nominal::Model(NominalModel::None { outputs: 3 }), StateRule::Running);
        assert_equal(&what, &parts, 10_000);
    }
}

/// States run on and in windows; each network's weights differ.
#[test]
fn ensembles_answer_as_in_rust() {
    for (k, body) in bodies().into_iter().enumerate().step_by(3) {
        let state = if k % 2 == 0 { StateRule::Running } else { StateRule::Window(5) };
        let one = parts(body, Nominal::Model(NominalModel::None { outputs: 3 }), state);
        assert_equal(&format!("three of {:?}", one.network.body), &ensemble(one, 3), 500);
    }
}

#[test]
fn windows_answer_as_in_rust() {
    for body in bodies().into_iter().step_by(4) {
        for length in [1, 4, 50] {
            let what = format!("windows of {length}: {body:?}");
            let parts =
                parts(body.clone(), Nominal::Model(NominalModel::None { outputs: 3 }), StateRule::Window(length));
            assert_equal(&what, &parts, 500);
        }
    }
}

#[test]
fn ranges_may_be_unknown() {
    let mut parts = parts(small(), Nominal::Model(hanging()), StateRule::Running);
    parts.ranges = None;
    assert_equal("no ranges", &parts, 500);
}
