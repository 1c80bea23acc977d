//! The header names inputs and outputs as the manifest does, with the unit that C takes and that of the manifest.

use acm_export::{Origin, c99};
use acm_stream::{AverageParts, Label, Labels, ManifestUnit, MemberParts, Nominal, Parts};

use crate::alone::alone;
use crate::robots::{augmented, hanging};

fn header(average: &AverageParts) -> String {
    let origin = Origin { name: "arm".into(), source: String::new(), recorded: None };
    let file = c99::export_average(average, &origin).expect("it can be written").remove(0);
    String::from_utf8(file.bytes).expect("text")
}

fn label(name: &str, si: &str, manifest: Option<(&str, f64, f64)>) -> Label {
    let manifest = manifest.map(|(unit, factor, offset)| ManifestUnit { unit: unit.into(), factor, offset });
    Label { manifest, ..Label::in_si(name, si) }
}

fn labelled() -> Parts {
    let column = |label: Label| Label { column: Some("w".into()), ..label };
    let labels = Labels {
        inputs: vec![
            label("joint 1", "rad", Some(("deg", 0.5, 0.0))),
            label("joint-1", "m", None),
            column(label("wind", "1", Some(("%", 0.01, 0.0)))),
            label("t*/", "K", Some(("°C", 1.0, 273.15))),
        ],
        outputs: ["x", "y", "z", "x2", "y2", "z2"].map(|name| label(name, "m", None)).to_vec(),
    };
    Parts { labels: Some(labels), ..alone(Nominal::Model(hanging())) }
}

#[test]
fn the_header_has_the_names_and_both_units() {
    let text = header(&AverageParts::of_one(labelled()));
    for line in [
        "ARM_ACTUATOR_JOINT_1 = 0, /* joint 1: rad (manifest: deg; a value in deg times 0.5 is SI) */",
        "ARM_ACTUATOR_JOINT_1_2 = 1, /* joint-1: m */",
        "ARM_CONTEXT_WIND = 2, /* wind, column w: 1 (manifest: %; a value in % times 0.01 is SI) */",
        "ARM_CONTEXT_T = 3, /* t* /: K (manifest: degC; a value in degC times 1.0 + 273.15 is SI) */",
        "ARM_OUTPUT_X = 0, /* x: m */",
        "ARM_OUTPUT_Z2 = 5, /* z2: m */",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

/// A file of an earlier version has no labels: the nominal model knows its signals.
#[test]
fn without_labels_those_of_the_nominal_model_stand_there() {
    let parts = Parts { labels: None, ..alone(Nominal::Augmented(augmented(vec![]))) };
    let text = header(&AverageParts::of_one(parts));
    for line in [
        "ARM_ACTUATOR_Q2 = 1, /* q2: m */",
        "ARM_CONTEXT_ALTITUDE = 3, /* altitude: m */",
        "ARM_ACCELERATION_Y = 5, /* acceleration_y: m/s^2 */",
        "ARM_OUTPUT_Z1 = 2, /* z1: m */",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

#[test]
fn an_average_has_the_names_of_the_members_that_read_them() {
    let inputs = ["idle", "w", "t", "q2", "q1"].map(String::from).to_vec();
    let member = |weight| MemberParts { parts: labelled(), places: vec![4, 3, 1, 2], weight };
    let text = header(&AverageParts { inputs, members: vec![member(0.25), member(0.75)], interval: None });
    for line in [
        "ARM_UNREAD_IDLE = 0,",
        "ARM_CONTEXT_WIND = 1,",
        "ARM_CONTEXT_T = 2,",
        "ARM_ACTUATOR_JOINT_1 = 3,",
        "ARM_ACTUATOR_JOINT_1_2 = 4,",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
}
