//! Static equilibrium of the arm at one instant, by Newton's method with the exact derivative.
//!
//! ```text
//! r_i(θ) = k_i·[θ_i + past_i + W·θ_i] − m_i(θ) − (1 − c)·Q_i(θ) = 0,    c = Σ_t T_t·share_t / EA
//! ```
//!
//! | symbol | meaning                                       | source       |
//! | `k_i`  | stiffness of the joint, N·m/rad               | here         |
//! | past, W | relaxation of the backbone                   | `creep`      |
//! | `m_i`  | moment of the tendons, N·m                    | `tendons`    |
//! | share  | what friction in the sheath lets pass         | `sheath`     |
//! | `Q_i`  | moment of dead loads, N·m                     | `rod`        |
//! | `c`    | axial compression, 1                          | here         |
//!
//! Friction depends on the speed (ℓ − ℓ_before)/Δ of this very step (implicit Euler), so the solution is an
//! equilibrium with all forces of its own instant. The step is halved while the residual does not fall
//! (Deuflhard, Newton Methods for Nonlinear Problems (2011), ch. 3).

use crate::twin::mechanics::rod::Chain;
use crate::twin::mechanics::sheath::Sheath;
use crate::twin::mechanics::tendons::{DIRECTIONS, TENDONS, give_back, tension};
use crate::twin::settings::TwinSettings;
use nalgebra::{DMatrix, DVector, Rotation3, Vector3};

/// Loads and states of the arm at one instant.
#[derive(Clone, Debug)]
pub struct Instant<'a> {
    /// All constants of the simulator.
    pub settings: &'a TwinSettings,
    /// Attitude of the attachment.
    pub base: Rotation3<f64>,
    /// Stiffness of each coordinate, N·m/rad.
    pub stiffness: &'a DVector<f64>,
    /// Relaxation moments left by the past, in units of stiffness, rad.
    pub past: DVector<f64>,
    /// Weight of the present in the relaxation, 1.
    pub newest_weight: f64,
    /// Elongation of each tendon in the straight arm with the pulley at its present angle, m.
    pub taken_up: [f64; TENDONS],
    /// Tendon length released one step ago, m.
    pub given_before: [f64; TENDONS],
    /// Sheath of each tendon.
    pub sheaths: &'a [Sheath; TENDONS],
    /// Dead loads at the joint centres and the tip, N.
    pub loads: &'a [Vector3<f64>],
    /// Time step, s.
    pub step: f64,
}

/// Equilibrium of the arm.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Joint angles, rad.
    pub angles: DVector<f64>,
    /// Tendon length released by bending, m.
    pub given: [f64; TENDONS],
    /// Axial compression, 1.
    pub compression: f64,
    /// Tip relative to the attachment, compressed, m.
    pub tip: Vector3<f64>,
    /// Largest moment left, N·m.
    pub residual: f64,
    /// Newton iterations used.
    pub iterations: usize,
}

/// Error: no equilibrium within the iterations allowed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("no equilibrium within {iterations} Newton iterations: {residual:e} N·m are left")]
pub struct NotBalanced {
    /// Largest moment left, N·m.
    pub residual: f64,
    /// Newton iterations used.
    pub iterations: usize,
}

/// Forces and moments of one trial configuration.
struct Balance {
    residual: DVector<f64>,
    given: [f64; TENDONS],
    forces: [f64; TENDONS],
    slopes: [f64; TENDONS],
    moments: DVector<f64>,
    compression: f64,
}

impl Instant<'_> {
    /// Finds the equilibrium next to `start`, working in `chain`.
    ///
    /// # Errors
    /// Newton's method finds none within the iterations allowed.
    pub fn solve(&self, start: &DVector<f64>, chain: &mut Chain) -> Result<Equilibrium, NotBalanced> {
        let mut angles = start.clone();
        let mut balance = self.balance(&angles, chain);
        for iterations in 0..=self.settings.solver.iterations {
            let residual = balance.residual.amax();
            if residual < self.settings.solver.tolerance {
                return Ok(found(angles, &balance, chain, iterations));
            }
            let Some(step) = self.newton_step(&angles, &balance, chain) else { break };
            (angles, balance) = self.shortened(&angles, &balance, &step, chain);
        }
        let iterations = self.settings.solver.iterations;
        Err(NotBalanced { residual: balance.residual.amax(), iterations })
    }

    /// Halves the Newton step until the residual falls; a hundredth of it is taken in any case.
    fn shortened(
        &self,
        angles: &DVector<f64>,
        balance: &Balance,
        step: &DVector<f64>,
        chain: &mut Chain,
    ) -> (DVector<f64>, Balance) {
        let mut share = (0.3 / step.amax()).min(1.0);
        loop {
            let trial = angles - share * step;
            let next = self.balance(&trial, chain);
            if next.residual.norm() < balance.residual.norm() * (1.0 - 1e-4 * share) || share < 0.01 {
                return (trial, next);
            }
            share *= 0.5;
        }
    }

    fn newton_step(&self, angles: &DVector<f64>, balance: &Balance, chain: &Chain) -> Option<DVector<f64>> {
        let step = self.jacobian(angles, balance, chain).lu().solve(&balance.residual)?;
        step.iter().all(|value| value.is_finite()).then_some(step)
    }

    fn balance(&self, angles: &DVector<f64>, chain: &mut Chain) -> Balance {
        let settings = self.settings;
        let given = give_back(&settings.tendons, angles.as_slice());
        let mut forces = [0.0; TENDONS];
        let mut slopes = [0.0; TENDONS];
        for tendon in 0..TENDONS {
            let pull = tension(&settings.tendons, self.taken_up[tendon] - given[tendon]);
            let speed = (given[tendon] - self.given_before[tendon]) / self.step;
            let pass = self.sheaths[tendon].pass(&settings.sheath, speed);
            forces[tendon] = pull.force * pass.share;
            slopes[tendon] = pull.force * pass.slope / self.step - pull.stiffness * pass.share;
        }
        let compression = forces.iter().sum::<f64>() / settings.arm.axial_stiffness;
        chain.place(&self.base, angles, settings.arm.length / chain.joints() as f64);
        let mut moments = DVector::zeros(angles.len());
        chain.moments(self.loads, &mut moments);
        let bending = pair_forces(&forces);
        let residual = DVector::from_fn(angles.len(), |i, _| {
            self.stiffness[i] * (angles[i] + self.past[i] + self.newest_weight * angles[i])
                - settings.tendons.radius * bending[i % 2] * (0.5 * angles[i]).cos()
                - (1.0 - compression) * moments[i]
        });
        Balance { residual, given, forces, slopes, moments, compression }
    }

    fn jacobian(&self, angles: &DVector<f64>, balance: &Balance, chain: &Chain) -> DMatrix<f64> {
        let radius = self.settings.tendons.radius;
        let size = angles.len();
        let mut jacobian = DMatrix::zeros(size, size);
        chain.moment_derivative(self.loads, &mut jacobian);
        jacobian *= balance.compression - 1.0;
        let bending = pair_forces(&balance.forces);
        let lever = DVector::from_fn(size, |i, _| radius * (0.5 * angles[i]).cos());
        // Slope of a pair's moment, and of the compression, per metre that its first tendon gives back.
        let mut pair_slope = [0.0; 2];
        let mut shortening = [0.0; 2];
        for (tendon, (axis, sign)) in DIRECTIONS.into_iter().enumerate() {
            pair_slope[axis] += balance.slopes[tendon];
            shortening[axis] += sign * balance.slopes[tendon] / self.settings.arm.axial_stiffness;
        }
        for column in 0..size {
            let axis = column % 2;
            for row in 0..size {
                let tendons = if row % 2 == axis { pair_slope[axis] * lever[row] } else { 0.0 };
                jacobian[(row, column)] += (shortening[axis] * balance.moments[row] - tendons) * lever[column];
            }
            let turned = 0.5 * radius * bending[axis] * (0.5 * angles[column]).sin();
            jacobian[(column, column)] += self.stiffness[column] * (1.0 + self.newest_weight) + turned;
        }
        jacobian
    }
}

fn found(angles: DVector<f64>, balance: &Balance, chain: &Chain, iterations: usize) -> Equilibrium {
    Equilibrium {
        angles,
        given: balance.given,
        compression: balance.compression,
        tip: chain.points[chain.joints()] * (1.0 - balance.compression),
        residual: balance.residual.amax(),
        iterations,
    }
}

/// Returns the difference of tension of the two tendons of each pair, N.
fn pair_forces(forces: &[f64; TENDONS]) -> [f64; 2] {
    let mut pairs = [0.0; 2];
    for (force, (axis, sign)) in forces.iter().zip(DIRECTIONS) {
        pairs[axis] += sign * force;
    }
    pairs
}

/// Returns the stiffness of every coordinate of a tapered arm, N·m/rad: EI at the joint over the element length.
pub fn joint_stiffness(settings: &TwinSettings) -> DVector<f64> {
    let arm = &settings.arm;
    let element = arm.length / arm.joints as f64;
    DVector::from_fn(2 * arm.joints, |i, _| {
        let place = ((i / 2) as f64 + 0.5) / arm.joints as f64;
        arm.stiffness * (1.0 - arm.taper * place) / element
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::mechanics::sheath::Sheath;
    use crate::twin::mechanics::tendons::preload;

    fn loads(joints: usize) -> Vec<Vector3<f64>> {
        (0..=joints).map(|k| Vector3::new(0.02 * (k as f64).sin(), 0.03, -0.05)).collect()
    }

    /// Oracle: central differences of the residual, with taut and slack tendons that move in their sheaths.
    #[test]
    fn jacobian_matches_finite_differences() {
        let mut settings = TwinSettings::default();
        settings.arm.joints = 5;
        let sheaths = [0, 0, 1, 1].map(|pair| Sheath::new(&settings.sheath, pair));
        let (stiffness, loads) = (joint_stiffness(&settings), loads(5));
        let angles = DVector::from_fn(10, |i, _| 0.12 + 0.05 * (i as f64).sin());
        let given = give_back(&settings.tendons, angles.as_slice());
        let instant = Instant {
            settings: &settings,
            base: Rotation3::from_euler_angles(3.1, 0.05, 0.02),
            stiffness: &stiffness,
            past: DVector::from_fn(10, |i, _| 0.01 * i as f64),
            newest_weight: 0.7,
            taken_up: [given[0] + 6e-3, given[1] + 1e-4, given[2] + 4e-3, given[3] - 2e-3],
            given_before: given.map(|length| length - 2e-4),
            sheaths: &sheaths,
            loads: &loads,
            step: 0.05,
        };
        let mut chain = Chain::new(5);
        let balance = instant.balance(&angles, &mut chain);
        let jacobian = instant.jacobian(&angles, &balance, &chain);
        for column in 0..10 {
            let (mut up, mut down) = (angles.clone(), angles.clone());
            up[column] += 1e-6;
            down[column] -= 1e-6;
            let slope =
                (instant.balance(&up, &mut chain).residual - instant.balance(&down, &mut chain).residual) / 2e-6;
            let error = (slope - jacobian.column(column)).amax();
            assert!(error < 1e-5 * jacobian.amax(), "column {column}: {error:e}");
        }
    }

    /// Returns the equilibrium of an arm without weight, its tendons at rest, at a tip load.
    fn settle(joints: usize, taken_up: [f64; TENDONS], tip_load: Vector3<f64>) -> Equilibrium {
        let mut settings = TwinSettings::default();
        settings.arm.joints = joints;
        settings.arm.taper = 0.0;
        settings.arm.axial_stiffness = 1e12;
        settings.sheath.direct = 1e-3;
        settings.sheath.level = [0.0; 2];
        settings.sheath.ageing = 0.0;
        let sheaths = [0, 0, 1, 1].map(|pair| Sheath::new(&settings.sheath, pair));
        let stiffness = joint_stiffness(&settings);
        let mut loads = vec![Vector3::zeros(); joints + 1];
        loads[joints] = tip_load;
        let instant = Instant {
            settings: &settings,
            base: Rotation3::identity(),
            stiffness: &stiffness,
            past: DVector::zeros(2 * joints),
            newest_weight: 0.0,
            taken_up,
            given_before: [0.0; TENDONS],
            sheaths: &sheaths,
            loads: &loads,
            // So long a step makes the tendons creep: friction is then below a thousandth.
            step: 1e9,
        };
        match instant.solve(&DVector::zeros(2 * joints), &mut Chain::new(joints)) {
            Ok(found) => found,
            Err(error) => panic!("{error}"),
        }
    }

    /// Oracle: Euler–Bernoulli cantilever, δ = F·L³/(3·EI).
    #[test]
    fn slack_arm_bends_like_a_cantilever_under_a_small_tip_load() {
        let settings = TwinSettings::default();
        let expected = 0.01 * settings.arm.length.powi(3) / (3.0 * settings.arm.stiffness);
        for axis in 0..2 {
            let mut load = Vector3::zeros();
            load[axis] = 0.01;
            let found = settle(32, [-10.0; TENDONS], load).tip[axis];
            assert!((found / expected - 1.0).abs() < 3e-3, "axis {axis}: {found} {expected}");
        }
    }

    /// Oracle: a tendon at distance r makes a constant moment, so the arm is a circular arc of curvature T·r/EI
    /// with tip at (1 − cos Θ, sin Θ)·L/Θ.
    #[test]
    fn pulled_arm_is_a_circular_arc() {
        let settings = TwinSettings::default();
        let pull = preload(&settings.tendons, 5.0);
        // Find what to take up so that 5 N remain in the bent arm: Θ = T·r·L/EI.
        let angle = 5.0 * settings.tendons.radius * settings.arm.length / settings.arm.stiffness;
        let found = settle(64, [pull + settings.tendons.radius * angle, -10.0, -10.0, -10.0], Vector3::zeros());
        let radius = settings.arm.length / angle;
        let (x, z) = (radius * (1.0 - angle.cos()), radius * angle.sin());
        assert!((found.tip - Vector3::new(x, 0.0, z)).norm() < 1e-3, "{} {x} {z}", found.tip);
        assert!(found.residual < settings.solver.tolerance);
    }

    /// Oracle: the beam-column, δ = (F/P)·(tan kL/k − L), k = √(P/EI), on both sides of Euler's load π²EI/(4L²). Above
    /// it the straight branch still is an equilibrium, an unstable one, that leans against the side load.
    #[test]
    fn pressed_arm_leans_like_a_beam_column_below_and_above_the_euler_load() {
        let arm = TwinSettings::default().arm;
        let euler = std::f64::consts::PI.powi(2) * arm.stiffness / (4.0 * arm.length * arm.length);
        for press in [0.5 * euler, 1.5 * euler] {
            let side = 1e-4 * euler;
            let k = (press / arm.stiffness).sqrt();
            let expected = side / press * ((k * arm.length).tan() / k - arm.length);
            let found = settle(32, [-10.0; TENDONS], Vector3::new(side, 0.0, -press)).tip.x;
            assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
        }
    }
}
