//! Bodies of loads on an arm.

use super::pieces::{carrier, plain_body};
use super::{Asked, Body};

/// Weight at the tip, own weight, wash, wash near the base, side loads: columns of loads; what tendons hold follows six later.
const HELD: usize = 6;

/// Adds `size` to one load, and minus its share `held` to what tendons hold of it.
pub fn load(column: usize, size: &str, held: &str) -> String {
    format!("    x[{column}] += {size};\n    x[{}] -= {held} * ({size});\n", column + HELD)
}

pub fn jet(drag: &str, decay: &str, held: &str) -> String {
    let loads = load(2, &format!("drag * (1.0 - {decay})"), held) + &load(3, &format!("drag * {decay}"), held);
    format!("    const double drag = {drag};\n{loads}")
}

pub fn ground_effect(asked: &Asked) -> Option<Body> {
    let altitude = carrier(asked)?;
    let throttle = asked.inputs.actuators + asked.theta[4] as usize;
    let code = format!(
        "    const double height = in[{altitude}] > 0.0 ? in[{altitude}] : 0.0;\n{}",
        jet(&format!("v[0] * in[{throttle}] * exp_d(-height / v[1])"), "v[2]", "v[3]")
    );
    let equation = "g = b u exp(-max(h, 0)/h_0), wash = g (1 - d), near = g d, held = -c of them";
    Some(Body { needs: vec!["exp_d"], ..plain_body(equation, code) })
}
