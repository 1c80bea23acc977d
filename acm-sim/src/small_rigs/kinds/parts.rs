//! Stages that several rigs share, drawn relative to the pace and the range of their input.

use crate::small_rigs::bench::{Bench, Input, Named};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::plants::plant::Free;
use crate::small_rigs::plants::stage::Stage;

/// Adds a dead time of 4–40 % of a stroke.
pub fn dead_time(bench: &mut Bench, signal: &str, pace: f64, draw: &mut Draw) {
    let free = Free::positive("delay", pace * draw.scale(0.04, 0.4), "s");
    bench.stage(&Named::new("dead_time", Some(signal)), Stage::Delay, [free]);
}

/// Adds a first-order lag of 5–50 % of a stroke, before the map.
pub fn lag(bench: &mut Bench, signal: &str, pace: f64, draw: &mut Draw) {
    slow(bench, &Named::new("actuator_lag", Some(signal)), pace, draw);
}

/// Adds a lag behind a static map that is not a cause, as a nominal model with that map sees it.
pub fn lag_behind_map(bench: &mut Bench, pace: f64, draw: &mut Draw) {
    slow(bench, &Named::new("measurement_lag", None).called("lag_behind_map"), pace, draw);
}

fn slow(bench: &mut Bench, named: &Named, pace: f64, draw: &mut Draw) {
    let free = Free::positive("tau", pace * draw.scale(0.05, 0.5), "s");
    bench.stage(named, Stage::Lag, [free]);
}

/// Adds a first-order lag of 5–30 % of a stroke, behind the map.
pub fn late_sensor(bench: &mut Bench, pace: f64, draw: &mut Draw) {
    let free = Free::positive("tau", pace * draw.scale(0.05, 0.3), "s");
    bench.stage(&Named::new("measurement_lag", None), Stage::Lag, [free]);
}

/// Adds a linear spring of a period of 30–200 % of a stroke.
pub fn second_order(bench: &mut Bench, signal: &str, pace: f64, damping: [f64; 2], draw: &mut Draw) {
    let period = Free::positive("period", pace * draw.scale(0.3, 2.0), "s");
    let ratio = Free::positive("damping", draw.between(damping[0], damping[1]), "1");
    bench.stage(&Named::new("second_order_lag", Some(signal)), Stage::Second, [period, still(ratio)]);
}

/// Returns a damping ratio that keeps its value where its cause is absent.
pub fn still(free: Free) -> Free {
    Free { neutral: free.value, lower: 0.02, ..free }
}

/// Adds a static map from the input's range to an output of this span; squares bend it by up to a tenth.
pub fn map(bench: &mut Bench, input: &Input, span: f64, unit: &str, degree: usize, draw: &mut Draw) {
    let slope = draw.sign() * span / input.range();
    let offset = Free::new("offset", draw.between(-1.0, 1.0) * span - slope * input.centre(), unit).of_scale(span);
    let mut free = vec![offset, Free::new("slope", slope, "")];
    if degree > 1 {
        let square = draw.between(-0.1, 0.1) * slope / input.range();
        free.push(Free::new("square", square, "").of_scale(slope.abs() / input.range()));
    }
    bench.given_stage(Stage::Map { degree }, free);
}
