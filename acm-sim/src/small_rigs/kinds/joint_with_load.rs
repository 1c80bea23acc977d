//! A joint under load: torque from its motion.
//!
//! ```text
//! τ = g₀ + g₁ q + J q̈ + b q̇ + f (1 + g (load − c₀)) sgn q̇ + s e^(−(q̇/v_s)²) sgn q̇ + G sin(q + φ)
//! ```
//!
//! One to four of inertia, viscous friction, Coulomb friction, Stribeck's friction and gravity are there; Stribeck's only
//! beside Coulomb's. Each moves the torque by 8–60 % of what the static part does.

use crate::small_rigs::bench::{Bench, Input, Named, Ports, sized, spread};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::drive::Drive;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::term::Term;
use crate::small_rigs::recorded::Signal;

/// Returns the ports: angle in, torque out; a load is recorded in a third of the draws.
pub fn ports(draw: &mut Draw) -> Ports {
    let (middle, half) = (draw.between(-0.5, 0.5), draw.scale(0.15, 1.5));
    let load = draw.happens(0.35).then(|| Input::new("load", "kg", 0.2, draw.between(1.0, 5.0)));
    Ports {
        title: "A joint with a load: torque from its angle (simulated)",
        actuators: vec![Input::new("angle", "rad", middle - half, middle + half)],
        contexts: load.into_iter().collect(),
        output: Signal::new("torque", "N*m"),
    }
}

/// Returns a joint with its causes of error.
pub fn build(ports: &Ports, drive: &Drive, draw: &mut Draw) -> Bench {
    let mut bench = Bench::new(Plant::sum(0));
    let stiffness = draw.sign() * draw.scale(0.3, 30.0);
    let scale = stiffness.abs() * spread(&drive.actuators[0]);
    bench.given_term(
        Term::Map { squares: false },
        [
            Free::new("offset", draw.between(-1.0, 1.0) * scale, "N*m").of_scale(scale),
            Free::new("stiffness", stiffness, "N*m/rad"),
        ],
    );
    let count = 1 + draw.index(4);
    let chosen = draw.subset(4, count);
    let size = |draw: &mut Draw| scale * draw.scale(0.08, 0.6);
    if chosen.contains(&0) {
        let mass = sized(&Term::Inertia, &[1.0], drive, size(draw));
        bench.term(&Named::new("inertia", Some("angle")), Term::Inertia, [Free::new("mass_torque", mass, "kg*m^2")]);
    }
    if chosen.contains(&1) {
        let damping = sized(&Term::Viscous, &[1.0], drive, size(draw));
        let free = Free::new("damping_torque", damping, "N*m*s/rad");
        bench.term(&Named::new("viscous_friction", Some("angle")), Term::Viscous, [free]);
    }
    if chosen.contains(&2) {
        let sticks = count < 4 && draw.happens(0.3);
        dry(&mut bench, ports, drive, draw, scale, sticks);
    }
    if chosen.contains(&3) {
        let phase = draw.between(-1.0, 1.0);
        let weight = sized(&Term::Gravity, &[1.0, phase], drive, size(draw));
        let free = [Free::new("weight", weight, "N*m"), Free::new("phase", phase, "rad").of_scale(0.3)];
        bench.term(&Named::new("joint_gravity", Some("angle")), Term::Gravity, free);
    }
    bench
}

/// Adds Coulomb friction, with a level that depends on a recorded load, and with more at low speed where `sticks`.
fn dry(bench: &mut Bench, ports: &Ports, drive: &Drive, draw: &mut Draw, scale: f64, sticks: bool) {
    let usual = spread(&drive.motion[1]);
    let soft = draw.scale(0.01, 0.05) * usual;
    let level = sized(&Term::Friction { centre: None }, &[1.0, soft], drive, scale * draw.scale(0.08, 0.6));
    let mut free = vec![Free::new("friction_torque", level, "N*m"), Free::positive("soft", soft, "rad/s")];
    let load = ports.contexts.first();
    if let Some(load) = load {
        free.push(Free::new("growth", draw.between(0.5, 0.9) / load.range(), "1/kg"));
    }
    let called = if load.is_some() { "load_dependent_friction" } else { "coulomb_friction" };
    let named = Named::new("coulomb_friction", Some("angle")).called(called);
    bench.term(&named, Term::Friction { centre: load.map(Input::centre) }, free);
    if sticks {
        let speed = draw.between(0.2, 0.6) * usual;
        let more = sized(&Term::Stick, &[1.0, speed], drive, scale * draw.scale(0.05, 0.3));
        let free = [Free::new("extra", more, "N*m"), Free::positive("speed", speed, "rad/s")];
        bench.term(&Named::new("stribeck_friction", Some("angle")), Term::Stick, free);
    }
}
