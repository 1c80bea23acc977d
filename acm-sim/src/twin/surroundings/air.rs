//! Unrecorded disturbances of the mean wind: turbulence and the varying circulation of the room.
//!
//! ```text
//! u = ū + σ·|ū|·(g_e + g_0)/√2 + σ_c·2v_h·S(h)·c
//! ```
//!
//! | symbol | meaning                                                      | unit |
//! | `ū`    | mean wind                                                    | m/s  |
//! | `g_e`  | gust of one of five eddies along the arm, unit variance      | 1    |
//! | `g_0`  | gust that the whole arm shares, unit variance                | 1    |
//! | `c`    | direction and strength of the room's circulation now         | 1    |
//! | `S(h)` | how strong the circulation is at this altitude (see `wind`)  | 1    |
//!
//! All are stationary Gaussian processes with exponential covariance, as in the usual gust models
//! (Hoblit, Gust Loads on Aircraft (1988)).

use crate::twin::random::{Gusts, Purpose, Seeds};
use crate::twin::schedule::TrialPlan;
use crate::twin::settings::TwinSettings;
use crate::twin::surroundings::wind::circulation_strength;
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;

/// Number of eddies along the arm: each is as long as a fifth of it, about the size of a contracted wake.
const EDDIES: usize = 5;

/// Turbulence and room circulation of one trial.
pub struct Air {
    turbulence: Gusts,
    turbulence_source: ChaCha8Rng,
    column: Gusts,
    circulation: Gusts,
    circulation_source: ChaCha8Rng,
    now: Vec<f64>,
    wandering: Vector3<f64>,
}

impl Air {
    /// Returns the air of a trial, in its stationary distribution.
    pub fn new(settings: &TwinSettings, plan: &TrialPlan, seeds: &Seeds) -> Self {
        let spread = &settings.unrecorded;
        let step = settings.solver.step;
        let mut turbulence_source = seeds.stream(plan.number, Purpose::Turbulence);
        let mut circulation_source = seeds.stream(plan.number, Purpose::Circulation);
        Self {
            turbulence: Gusts::new(3 * EDDIES, step, spread.turbulence_time, &mut turbulence_source),
            column: Gusts::new(3, step, spread.turbulence_time, &mut turbulence_source),
            circulation: Gusts::new(3, step, spread.circulation_time, &mut circulation_source),
            turbulence_source,
            circulation_source,
            now: vec![0.0; 3 * EDDIES],
            wandering: Vector3::zeros(),
        }
    }

    /// Advances by one step.
    pub fn advance(&mut self) {
        let common = self.column.advance(&mut self.turbulence_source).to_vec();
        let local = self.turbulence.advance(&mut self.turbulence_source);
        // Half of each gust's variance is common to the whole arm.
        self.now = local.iter().enumerate().map(|(k, value)| (value + common[k % 3]) / 2.0f64.sqrt()).collect();
        self.wandering = Vector3::from_column_slice(self.circulation.advance(&mut self.circulation_source));
    }

    /// Returns the disturbance of the mean wind at a point of the arm (joints first, the tip last), m/s.
    pub fn disturbance(
        &self,
        settings: &TwinSettings,
        point: usize,
        mean: &Vector3<f64>,
        hover: f64,
        altitude: f64,
    ) -> Vector3<f64> {
        let spread = &settings.unrecorded;
        let eddy = (point * EDDIES / settings.arm.joints).min(EDDIES - 1);
        let gust = Vector3::from_column_slice(&self.now[3 * eddy..3 * eddy + 3]);
        let room = circulation_strength(&settings.wind, altitude);
        spread.turbulence * mean.norm() * gust + spread.circulation * 2.0 * hover * room * self.wandering
    }
}
