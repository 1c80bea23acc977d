//! Offsets between clocks and what the loop says of a delay. Oracle: a delay planted by the formula of `delayed`; intervals of
//! independent errors add in squares.

#![allow(missing_docs)]

mod delayed;

use acm_datasets::Campaign;
use delayed::{DELAY, MANIFEST, Rig};
use serde_json::Value;

/// Actuators and outputs as two sources of the same files; `offset` brings the first to the second.
fn manifest(offset: &str) -> String {
    let (head, tail) = MANIFEST.split_once("[table]").expect("a table");
    let signals = tail.split_once("[[actuator]]").expect("signals").1;
    let of = |name: &str, key: &str| {
        format!(
            "[[source]]\nname = {name:?}\nfiles = [\"*.csv\"]\ntime = {{ column = \"t\", unit = \"s\" }}\n{key}\n\n"
        )
    };
    let signals = signals.replace("\"q\"", "\"in.q\"").replace("\"x\"", "\"out.x\"");
    let head = head.replace("source    =", "provenance =");
    [&head, &of("out", "clock = \"reference\""), &of("in", offset), "[[actuator]]", &signals].concat()
}

fn close(rig: &Rig, out: &str, offset: &str) -> Value {
    rig.write("arm/manifest.toml", &manifest(offset));
    rig.close(&["arm", "--set", "effects.only=[\"dead_time\", \"actuator_lag\"]"], out).1
}

/// Value and interval of the delay.
fn delay(found: &Value) -> [f64; 3] {
    assert_eq!(found["effects"][0]["name"], "dead_time", "{}", found["sentence"]);
    let delay = &found["effects"][0]["parameters"][0];
    [&delay["value"], &delay["interval"][0], &delay["interval"][1]].map(|number| number.as_f64().expect("a number"))
}

fn cautions(found: &Value) -> Vec<&str> {
    let all = found["cautions"].as_array().expect("a list").iter();
    all.filter_map(Value::as_str).filter(|caution| caution.contains("clock")).collect()
}

#[test]
fn an_estimated_offset_is_a_caution_and_widens_a_delay_and_a_given_one_is_not() {
    let rig = Rig::new();
    let given = close(&rig, "given", "offset = { value = 0.0, unit = \"s\" }");
    let estimated = close(
        &rig,
        "estimated",
        "offset = { estimate = \"estimate\", by = [\"out.x\", \"in.x\"], around = 0.0, within = 1.0 }",
    );
    assert_eq!(cautions(&given), [""; 0]);
    let said = cautions(&estimated);
    assert!(
        said.len() == 1 && said[0].contains("source `in` was estimated") && said[0].contains("dead time"),
        "{said:?}"
    );
    let campaign = Campaign::read(&rig.path("arm"), None).expect("read");
    let clock = campaign.alignments.iter().map(|alignment| alignment.interval).fold(0.0, f64::max);
    assert!(clock > 1e-4, "{clock}");
    let ([a, low, high], [b, wide_low, wide_high]) = (delay(&given), delay(&estimated));
    assert!((a - DELAY).abs() < 0.01 && (b - DELAY).abs() < 0.01, "{a} {b}");
    let half = 0.5 * (high - low);
    let wide = 0.5 * (wide_high - wide_low);
    let added = half.hypot(clock);
    assert!(
        (wide / added - 1.0).abs() < 0.2 * (added / half - 1.0),
        "{half} and {clock} make {added}, and it is {wide}"
    );
}
