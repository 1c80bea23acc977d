//! A slow tank: temperature from heater power, or level from the flow of a pump.
//!
//! ```text
//! heated   u → (delay) → lag, or a chain of two → map → (+ k·(ambient − c₀)) → y
//! with a hole   u → (delay) → θ ż = b·u − √z → + offset → (lag of the sensor) → y
//! ```
//!
//! Power and flow are shares of the largest. Sampled every 1–20 s. A chain of two lags is a spring of a damping ratio of one or more.

use crate::small_rigs::bench::{Bench, Input, Named, Ports};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::kinds::parts::{dead_time, lag, late_sensor, map, second_order};
use crate::small_rigs::plan::Plan;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::recorded::Signal;

/// Returns the ports: power in and temperature out, or flow in and level out.
pub fn ports(draw: &mut Draw) -> Ports {
    if draw.happens(0.4) {
        return Ports {
            title: "A tank with an outlet: level from the pump's flow (simulated)",
            actuators: vec![Input::new("flow", "1", 0.25, 1.0)],
            contexts: vec![],
            output: Signal::new("level", "m"),
        };
    }
    let ambient = draw.happens(0.5).then(|| Input::new("ambient", "K", 288.0, draw.between(292.0, 302.0)));
    Ports {
        title: "A heated tank: temperature from the heater's power (simulated)",
        actuators: vec![Input::new("power", "1", 0.0, draw.between(0.5, 1.0))],
        contexts: ambient.into_iter().collect(),
        output: Signal::new("temperature", "K"),
    }
}

/// Returns a tank with its causes of error.
pub fn build(ports: &Ports, plan: &Plan, draw: &mut Draw) -> Bench {
    let (input, mut bench) = (&ports.actuators[0], Bench::new(Plant::chain()));
    if draw.happens(0.5) {
        dead_time(&mut bench, &input.signal.name, plan.pace, draw);
    }
    if ports.output.unit == "m" {
        outlet(&mut bench, plan, draw);
        return bench;
    }
    if draw.happens(0.5) {
        lag(&mut bench, "power", plan.pace, draw);
    } else {
        second_order(&mut bench, "power", plan.pace, [1.05, 1.6], draw);
    }
    let span = draw.scale(5.0, 60.0);
    map(&mut bench, input, span, "K", 1, draw);
    if let Some(ambient) = ports.contexts.first() {
        let free = Free::new("sensitivity_temperature", span * draw.between(0.1, 0.4) / ambient.range(), "1");
        bench.stage(&Named::new("context_term", Some("ambient")), Stage::Context { centre: ambient.centre() }, [free]);
    }
    bench
}

fn outlet(bench: &mut Bench, plan: &Plan, draw: &mut Draw) {
    let gain = draw.scale(0.3, 1.2);
    // A small change about half of the flow takes θ·b.
    let theta = Free::positive("theta", plan.pace * draw.scale(0.1, 0.8) / gain, "s/m^0.5");
    let named = Named::new("outflow", Some("flow")).called("torricelli_outflow");
    let free = bench.cause(&named, [theta]);
    let gain = Free { neutral: gain, ..Free::positive("gain", gain, "m^0.5") };
    bench.given_stage(Stage::Outflow, free.into_iter().chain([gain]));
    let offset = Free::new("offset", draw.between(-0.2, 0.2), "m").of_scale(0.1);
    bench.given_stage(Stage::Map { degree: 0 }, [offset]);
    if draw.happens(0.3) {
        late_sensor(bench, plan.pace, draw);
    }
}
