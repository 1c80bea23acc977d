//! Six joints, one with friction: drive current from all angles.
//!
//! ```text
//! i = g₀ + Σ_j g_j q_j + Σ_j g_jj q_j² + f sgn q̇_m + b q̇_m + J q̈_m
//! ```
//!
//! Squares make a twentieth of what the linear part does. One to three of the last terms are there, all of one joint.

use crate::small_rigs::bench::{Bench, Input, Named, Ports, sized, spread};
use crate::small_rigs::draw::Draw;
use crate::small_rigs::drive::Drive;
use crate::small_rigs::plants::plant::{Free, Plant};
use crate::small_rigs::plants::term::Term;
use crate::small_rigs::recorded::Signal;

const JOINTS: usize = 6;

/// Returns the ports: six angles in, a current out.
pub fn ports(draw: &mut Draw) -> Ports {
    let actuator = |j: usize| {
        let (middle, half) = (draw.between(-0.8, 0.8), draw.scale(0.3, 1.5));
        Input::new(&format!("q{}", j + 1), "rad", middle - half, middle + half)
    };
    Ports {
        title: "A six-axis robot: current of a drive from all angles (simulated)",
        actuators: (0..JOINTS).map(actuator).collect(),
        contexts: vec![],
        output: Signal::new("current", "A"),
    }
}

/// Returns the index of the joint that the current depends on.
pub fn joint(draw: &mut Draw) -> usize {
    draw.index(JOINTS)
}

/// Returns a robot with causes of error in one of its joints.
pub fn build(ports: &Ports, joint: usize, drive: &Drive, draw: &mut Draw) -> Bench {
    let mut bench = Bench::new(Plant::sum(joint));
    let scale = draw.scale(0.05, 5.0);
    let mut map = vec![Free::new("offset", scale * draw.between(-1.0, 1.0), "A").of_scale(scale)];
    let spreads: Vec<f64> = drive.actuators.iter().map(|course| spread(course)).collect();
    map.extend((0..JOINTS).map(|j| {
        let share = draw.between(-0.6, 0.6) * scale / spreads[j];
        Free::new(format!("slope_{}", j + 1), share, "A/rad").of_scale(scale / spreads[j])
    }));
    map.extend((0..JOINTS).map(|j| {
        let share = 0.05 * draw.between(-1.0, 1.0) * scale / spreads[j].powi(2);
        Free::new(format!("square_{}", j + 1), share, "A/rad^2").of_scale(scale / spreads[j].powi(2))
    }));
    bench.given_term(Term::Map { squares: true }, map);
    let name = ports.actuators[joint].signal.name.as_str();
    let count = 1 + draw.index(3);
    let chosen = draw.subset(3, count);
    let mut size = || scale * draw.scale(0.1, 0.6);
    let (dry, wet, mass) = (size(), size(), size());
    if chosen.contains(&0) {
        let soft = 0.02 * spread(&drive.motion[1]);
        let level = sized(&Term::Friction { centre: None }, &[1.0, soft], drive, dry);
        let free = [Free::new("friction_current", level, "A"), Free::positive("soft", soft, "rad/s")];
        bench.term(&Named::new("coulomb_friction", Some(name)), Term::Friction { centre: None }, free);
    }
    if chosen.contains(&1) {
        let damping = Free::new("damping_current", sized(&Term::Viscous, &[1.0], drive, wet), "A*s/rad");
        bench.term(&Named::new("viscous_friction", Some(name)), Term::Viscous, [damping]);
    }
    if chosen.contains(&2) {
        let inertia = Free::new("mass_current", sized(&Term::Inertia, &[1.0], drive, mass), "A*s^2/rad");
        bench.term(&Named::new("inertia", Some(name)), Term::Inertia, [inertia]);
    }
    bench
}
