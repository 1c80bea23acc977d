//! Terms of a joint's torque, in its position q, rate v and acceleration a.
//!
//! | term | equation | values |
//! | --- | --- | --- |
//! | map | g₀ + Σ_j g_j q_j (+ Σ_j g_jj q_j²) | g |
//! | inertia | J a | J |
//! | viscous | b v | b |
//! | friction | f·(1 + g·(c − c₀))·v/√(v² + v₀²) | f, v₀ (, g) |
//! | stick | s·e^(−(v/v_s)²)·v/√(v² + v₀²), v₀ = v_s/10 | s, v_s |
//! | gravity | G sin(q + φ) | G, φ |
//!
//! Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7), with a smooth sign.

use crate::small_rigs::drive::{Drive, interpolate};

/// One term. Values that no oracle fits are fields of the variant.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// Static map of all joints, linear or with squares.
    Map {
        /// Whether it includes squares.
        squares: bool,
    },
    /// Inertial torque.
    Inertia,
    /// Viscous friction, proportional to speed.
    Viscous,
    /// Friction against the motion; its level depends on the first context around a centre where there is one.
    Friction {
        /// Middle of the context.
        centre: Option<f64>,
    },
    /// Additional friction at low speed (Stribeck).
    Stick,
    /// Weight of a link.
    Gravity,
}

impl Term {
    /// Adds the term to the output at the sampling times; `values` begin with its own.
    pub fn add(&self, values: &[f64], drive: &Drive, output: &mut [f64]) {
        let [place, rate, bend] = &drive.motion;
        match self {
            Term::Map { squares } => map(values, *squares, drive, output),
            Term::Inertia => output.iter_mut().zip(bend).for_each(|(y, a)| *y += values[0] * a),
            Term::Viscous => output.iter_mut().zip(rate).for_each(|(y, v)| *y += values[0] * v),
            Term::Friction { centre } => {
                for (k, y) in output.iter_mut().enumerate() {
                    let load = centre.map_or(0.0, |centre| {
                        values[2] * (interpolate(&drive.time, &drive.contexts[0], drive.asked[k]) - centre)
                    });
                    *y += values[0] * (1.0 + load) * sign(rate[k], values[1]);
                }
            }
            Term::Stick => output.iter_mut().zip(rate).for_each(|(y, v)| {
                *y += values[0] * (-(v / values[1].max(1e-12)).powi(2)).exp() * sign(*v, 0.1 * values[1]);
            }),
            Term::Gravity => output.iter_mut().zip(place).for_each(|(y, q)| *y += values[0] * (q + values[1]).sin()),
        }
    }
}

fn map(values: &[f64], squares: bool, drive: &Drive, output: &mut [f64]) {
    let joints = drive.actuators.len();
    for (y, time) in output.iter_mut().zip(&drive.asked) {
        *y += values[0];
        for (j, course) in drive.actuators.iter().enumerate() {
            let q = interpolate(&drive.time, course, *time);
            let square = if squares { values[1 + joints + j] } else { 0.0 };
            *y += q * (values[1 + j] + square * q);
        }
    }
}

/// Returns a smooth sign of a rate.
fn sign(rate: f64, soft: f64) -> f64 {
    rate / (rate * rate + soft * soft).sqrt().max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive() -> Drive {
        Drive {
            time: vec![0.0, 1.0],
            actuators: vec![vec![0.5, 0.5], vec![2.0, 2.0]],
            contexts: vec![vec![3.0, 3.0]],
            asked: vec![0.5],
            motion: [vec![0.5], vec![4.0], vec![-2.0]],
        }
    }

    fn term(term: &Term, values: &[f64]) -> f64 {
        let mut output = [1.0];
        term.add(values, &drive(), &mut output);
        output[0] - 1.0
    }

    /// Oracle: hand arithmetic at q = (0.5, 2), v = 4, a = −2, c = 3.
    #[test]
    fn terms_by_hand() {
        let near = |got: f64, wanted: f64| assert!((got - wanted).abs() < 1e-12, "{got} {wanted}");
        near(term(&Term::Map { squares: false }, &[1.0, 2.0, 3.0]), 1.0 + 1.0 + 6.0);
        near(term(&Term::Map { squares: true }, &[1.0, 2.0, 3.0, 4.0, 5.0]), 8.0 + 1.0 + 20.0);
        near(term(&Term::Inertia, &[0.3]), -0.6);
        near(term(&Term::Viscous, &[0.3]), 1.2);
        near(term(&Term::Friction { centre: None }, &[2.0, 3.0]), 2.0 * 4.0 / 5.0);
        near(term(&Term::Friction { centre: Some(1.0) }, &[2.0, 3.0, 0.25]), 1.5 * 2.0 * 4.0 / 5.0);
        near(term(&Term::Gravity, &[2.0, 0.1]), 2.0 * 0.6f64.sin());
        let soft = 4.0 / (16.0f64 + 0.16).sqrt();
        near(term(&Term::Stick, &[2.0, 4.0]), 2.0 * (-1.0f64).exp() * soft);
    }

    /// Oracle: work over a stroke of minimum jerk from rest to rest: nothing for a mass, 10·b·d²/(7·T) for viscous and
    /// f·d for dry friction, and what a weight gains in height.
    #[test]
    fn work_over_a_stroke_is_in_closed_form() {
        let (way, takes, many) = (0.8, 2.0, 4001);
        let time: Vec<f64> = (0..many).map(|k| takes * f64::from(k) / f64::from(many - 1)).collect();
        let course = |t: &f64| {
            let s = t / takes;
            way * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
        };
        let actuators = vec![time.iter().map(course).collect()];
        let drive = Drive { asked: time.clone(), time, actuators, contexts: vec![], motion: [const { vec![] }; 3] };
        let drive = drive.with_motion(0, 2e-3);
        let work = |term: &Term, values: &[f64]| {
            let mut torque = vec![0.0; drive.asked.len()];
            term.add(values, &drive, &mut torque);
            let power = torque.iter().zip(&drive.motion[1]).map(|(y, v)| y * v);
            power.sum::<f64>() * takes / f64::from(many - 1)
        };
        assert!(work(&Term::Inertia, &[3.0]).abs() < 1e-5);
        assert!((work(&Term::Viscous, &[3.0]) - 3.0 * 10.0 / 7.0 * way * way / takes).abs() < 1e-4);
        assert!((work(&Term::Friction { centre: None }, &[3.0, 1e-4]) - 3.0 * way).abs() < 2e-3);
        let height = (0.1f64).cos() - (0.1 + way).cos();
        assert!((work(&Term::Gravity, &[3.0, 0.1]) - 3.0 * height).abs() < 1e-5);
    }
}
