//! A motor with a static nonlinearity before its lag (Hammerstein) or behind it (Wiener): speed from voltage.
//!
//! ```text
//! Hammerstein   u → dead zone | saturation | u + a u² + b u³ → (delay) → lag → map → y
//! Wiener        u → (delay) → lag → u + a u² + b u³ → map → (lag of the sensor) → y
//! ```
//!
//! The cubic is a part of the static map and no cause on either side of the lag: a polynomial nominal model takes it up. Before
//! the lag, it makes the lag one of the output. Ljung (1999), System Identification, 5.1.

use crate::small_rigs::bench::{Bench, Input, Named, Ports};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::kinds::parts::{dead_time, lag, lag_behind_map, late_sensor, map};
use crate::small_rigs::plan::Plan;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::recorded::Signal;

/// Returns the ports: voltage in, speed out.
pub fn ports(draw: &mut Draw) -> Ports {
    let half = draw.scale(1.0, 48.0);
    Ports {
        title: "A motor: speed from voltage (simulated)",
        actuators: vec![Input::new("voltage", "V", -half, half)],
        contexts: vec![],
        output: Signal::new("speed", "rad/s"),
    }
}

/// Returns a motor with its causes of error.
pub fn build(ports: &Ports, plan: &Plan, draw: &mut Draw) -> Bench {
    let (input, mut bench) = (&ports.actuators[0], Bench::new(Plant::chain()));
    let before = draw.happens(0.65);
    let smooth = before && nonlinearity(&mut bench, input, draw) == Before::Cubic;
    if draw.happens(0.3) {
        dead_time(&mut bench, "voltage", plan.pace, draw);
    }
    if smooth {
        lag_behind_map(&mut bench, plan.pace, draw);
    } else {
        lag(&mut bench, "voltage", plan.pace, draw);
    }
    if !before {
        bench.given_stage(Stage::Bend, cubic(input, draw));
    }
    map(&mut bench, input, draw.scale(5.0, 300.0), "rad/s", 1, draw);
    if !before && draw.happens(0.4) {
        late_sensor(&mut bench, plan.pace, draw);
    }
    bench
}

/// Element before the lag.
#[derive(PartialEq)]
enum Before {
    /// A dead zone or a stop: a cause.
    Corner,
    /// A cubic: a part of the static map.
    Cubic,
}

fn nonlinearity(bench: &mut Bench, input: &Input, draw: &mut Draw) -> Before {
    let half = 0.5 * input.range();
    match draw.index(3) {
        0 => {
            let width = Free::positive("half_width_voltage", half * draw.between(0.05, 0.25), "V");
            bench.stage(&Named::new("dead_zone", Some("voltage")), Stage::DeadZone, [width]);
        }
        1 => {
            let cut = Free::positive("cut", half * draw.between(0.1, 0.4), "V");
            bench.stage(&Named::new("saturation", Some("voltage")), Stage::Saturation { limit: half }, [cut]);
        }
        _ => {
            bench.given_stage(Stage::Bend, cubic(input, draw));
            return Before::Cubic;
        }
    }
    Before::Corner
}

fn cubic(input: &Input, draw: &mut Draw) -> [Free; 2] {
    let half = 0.5 * input.range();
    let square = Free::new("square", draw.between(-0.25, 0.25) / half, "1/V").of_scale(0.1 / half);
    let cube = Free::new("cube", draw.between(-0.25, 0.3) / (half * half), "1/V^2").of_scale(0.1 / (half * half));
    [square, cube]
}
