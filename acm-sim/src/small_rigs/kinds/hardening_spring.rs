//! A mass on a spring that hardens: position from the place of its drive.
//!
//! ```text
//! u → (saturation) → (delay) → z̈ = ω²·(u − z − h z³) − 2ζω ż → map → y
//! ```

use crate::small_rigs::bench::{Bench, Input, Named, Ports};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::kinds::parts::{dead_time, map, still};
use crate::small_rigs::plan::Plan;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::recorded::Signal;

/// Returns the ports: position of the drive in, position of the mass out.
pub fn ports(draw: &mut Draw) -> Ports {
    let half = draw.scale(0.002, 0.1);
    Ports {
        title: "A mass on a spring: its place from that of the drive (simulated)",
        actuators: vec![Input::new("drive", "m", -half, half)],
        contexts: vec![],
        output: Signal::new("place", "m"),
    }
}

/// Returns a spring with its causes of error.
pub fn build(ports: &Ports, plan: &Plan, draw: &mut Draw) -> Bench {
    let (input, mut bench) = (&ports.actuators[0], Bench::new(Plant::chain()));
    let half = 0.5 * input.range();
    if draw.happens(0.25) {
        let cut = Free::positive("cut", half * draw.between(0.1, 0.3), "m");
        bench.stage(&Named::new("saturation", Some("drive")), Stage::Saturation { limit: half }, [cut]);
    }
    if draw.happens(0.35) {
        dead_time(&mut bench, "drive", plan.pace, draw);
    }
    let period = Free::positive("period", plan.pace * draw.scale(0.4, 2.0), "s");
    let ratio = Free::positive("damping", draw.between(0.08, 0.7), "1");
    let cube = Free::positive("cube", draw.scale(0.1, 2.0) / (half * half), "1/m^2");
    let named = Named::new("nonlinear_stiffness", Some("drive")).called("hardening_stiffness");
    let free = bench.cause(&named, [period, still(ratio), cube]);
    bench.given_stage(Stage::Hardening, free);
    map(&mut bench, input, input.range() * draw.between(0.8, 1.2), "m", 1, draw);
    bench
}
