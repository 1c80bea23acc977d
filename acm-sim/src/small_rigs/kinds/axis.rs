//! A driven axis: measured position from the commanded one.
//!
//! ```text
//! u → (saturation | dead zone) → (delay) → second-order loop → (play) → map → (lag of the sensor) → y
//! ```
//!
//! The loop is always there, up to three of the others with it.

use crate::small_rigs::bench::{Bench, Input, Named, Ports};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::kinds::parts::{dead_time, late_sensor, map, second_order};
use crate::small_rigs::plan::Plan;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::recorded::Signal;

/// Returns the ports: command in, position out.
pub fn ports(draw: &mut Draw) -> Ports {
    let half = draw.scale(0.005, 0.5);
    Ports {
        title: "A driven axis: measured position from its command (simulated)",
        actuators: vec![Input::new("command", "m", -half, half)],
        contexts: vec![],
        output: Signal::new("position", "m"),
    }
}

/// Returns an axis with its causes of error.
pub fn build(ports: &Ports, plan: &Plan, draw: &mut Draw) -> Bench {
    let (input, mut bench) = (&ports.actuators[0], Bench::new(Plant::chain()));
    let count = draw.index(4);
    let extras = draw.subset(4, count);
    if extras.contains(&0) {
        limit(&mut bench, input, draw);
    }
    if extras.contains(&1) {
        dead_time(&mut bench, "command", plan.pace, draw);
    }
    second_order(&mut bench, "command", plan.pace, [0.15, 1.0], draw);
    if extras.contains(&2) {
        let width = Free::positive("width_command", input.range() * draw.scale(0.01, 0.08), "m");
        bench.stage(&Named::new("backlash", Some("command")), Stage::Play { centre: None }, [width]);
    }
    map(&mut bench, input, input.range() * draw.between(0.9, 1.1), "m", 1, draw);
    if extras.contains(&3) {
        late_sensor(&mut bench, plan.pace, draw);
    }
    bench
}

/// Adds a stop short of the end of the range, or a dead zone about zero.
fn limit(bench: &mut Bench, input: &Input, draw: &mut Draw) {
    let half = 0.5 * input.range();
    if draw.happens(0.5) {
        let cut = Free::positive("cut", half * draw.between(0.1, 0.35), "m");
        bench.stage(&Named::new("saturation", Some("command")), Stage::Saturation { limit: half }, [cut]);
    } else {
        let width = Free::positive("half_width_command", half * draw.between(0.04, 0.2), "m");
        bench.stage(&Named::new("dead_zone", Some("command")), Stage::DeadZone, [width]);
    }
}
