//! A tendon in a sheath: displacement of its far end from the pulled displacement and the bend of the sheath.
//!
//! ```text
//! u → (delay) → play of half-width w + g·(bend − c₀), or many plays → (lag) → map → (+ k·(bend − c₀)) → y
//! ```

use crate::small_rigs::bench::{Bench, Input, Named, Ports};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::kinds::parts::{dead_time, lag, map};
use crate::small_rigs::plan::Plan;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::stage::Stage;
use crate::small_rigs::recorded::Signal;

/// Returns the ports: pull and bend in, displacement out.
pub fn ports(draw: &mut Draw) -> Ports {
    Ports {
        title: "A tendon in a bent sheath: way of its far end (simulated)",
        actuators: vec![Input::new("pull", "m", 0.0, draw.scale(0.004, 0.08))],
        contexts: vec![Input::new("bend", "rad", 0.0, draw.between(0.5, 3.0))],
        output: Signal::new("way", "m"),
    }
}

/// Returns a sheath with its causes of error.
pub fn build(ports: &Ports, plan: &Plan, draw: &mut Draw) -> Bench {
    let (input, bend, mut bench) = (&ports.actuators[0], &ports.contexts[0], Bench::new(Plant::chain()));
    if draw.happens(0.25) {
        dead_time(&mut bench, "pull", plan.pace, draw);
    }
    let width = input.range() * draw.scale(0.02, 0.12);
    if draw.happens(0.7) {
        // From nearly nothing in a straight sheath to nearly twice as much in a bent one.
        let growth = width * draw.between(0.6, 1.8) / bend.range();
        let free = [Free::positive("width_pull", width, "m"), Free::new("growth", growth, "m/rad")];
        let named = Named::new("backlash", Some("pull")).called("bend_dependent_play");
        bench.stage(&named, Stage::Play { centre: Some(bend.centre()) }, free);
    } else {
        let share = Free::positive("share", draw.between(0.5, 1.0), "1");
        let width = Free::positive("width", 2.0 * width, "m");
        let named = Named::new("prandtl_ishlinskii", Some("pull")).called("many_plays");
        bench.stage(&named, Stage::Spread, [share, Free { neutral: width.value, ..width }]);
    }
    if draw.happens(0.35) {
        lag(&mut bench, "pull", plan.pace, draw);
    }
    let span = input.range() * draw.between(0.7, 1.1);
    map(&mut bench, input, span, "m", 2, draw);
    if draw.happens(0.4) {
        let free = Free::new("sensitivity_way", draw.sign() * span * draw.between(0.05, 0.25) / bend.range(), "m/rad");
        bench.stage(&Named::new("context_term", Some("bend")), Stage::Context { centre: bend.centre() }, [free]);
    }
    bench
}
