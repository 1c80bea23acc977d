//! Friction between tendon and sheath: it ages at rest and slips with a logarithm of speed.
//!
//! ```text
//! ψ = a·asinh[ (V/2V0)·exp((ψ0 + b·ln(V0·A/D))/a) ]       friction number, odd in V
//! dA/dt = 1 − |V|·A/D                                     age of the contacts
//! T_arm/T_servo = (2 − ψ)/(2 + ψ)
//! ```
//!
//! | symbol | meaning                                        | unit |
//! | `V`    | speed of the tendon towards the servo          | m/s  |
//! | `A`    | contact age                                    | s    |
//! | `D`    | slip that renews the contacts                  | m    |
//! | `V0`   | reference speed                                | m/s  |
//! | ψ0, a, b | friction number there, effects of speed and age | 1  |
//!
//! The last line is the balance of a sheath whose contact force is the mean tension times the wrap.
//! Dieterich (1979), J. Geophys. Res. 84; regularised by Lapusta et al. (2000), J. Geophys. Res. 105.

use crate::twin::settings::SheathSettings;

/// State of one tendon in its sheath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheath {
    level: f64,
    age: f64,
}

/// Share of tension that passes, and its derivative by speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Ratio T_arm/T_servo, 1.
    pub share: f64,
    /// Derivative of the share by speed, s/m (negative: pulling faster loses more).
    pub slope: f64,
}

impl Sheath {
    /// Returns a tendon of pair 0 or 1 whose contacts are as old as in steady motion at the reference speed.
    pub fn new(settings: &SheathSettings, pair: usize) -> Self {
        Self { level: settings.level[pair], age: settings.slip / settings.speed }
    }

    /// Returns the tension ratio at a speed towards the servo.
    pub fn pass(&self, settings: &SheathSettings, speed: f64) -> Passage {
        let aged = self.level + settings.ageing * (settings.speed * self.age / settings.slip).ln();
        let gain = (aged / settings.direct).exp() / (2.0 * settings.speed);
        let stretched = gain * speed;
        let number = settings.direct * stretched.asinh();
        let by_speed = settings.direct * gain / (1.0 + stretched * stretched).sqrt();
        let share = (2.0 - number) / (2.0 + number);
        Passage { share, slope: -4.0 / (2.0 + number).powi(2) * by_speed }
    }

    /// Advances the contact age by a step at constant speed (exact solution of the age law).
    pub fn accept(&mut self, settings: &SheathSettings, speed: f64, step: f64) {
        let rate = speed.abs() / settings.slip;
        let slipped = rate * step;
        let grown = if slipped < 1e-8 { step } else { -(-slipped).exp_m1() / rate };
        self.age = self.age * (-slipped).exp() + grown;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: central difference.
    #[test]
    fn slope_is_the_derivative_of_the_share() {
        let settings = SheathSettings::default();
        let sheath = Sheath::new(&settings, 0);
        for speed in [-1e-2, -1e-6, 0.0, 3e-7, 5e-3] {
            let d = 1e-9;
            let slope = (sheath.pass(&settings, speed + d).share - sheath.pass(&settings, speed - d).share) / (2.0 * d);
            let found = sheath.pass(&settings, speed).slope;
            assert!((slope - found).abs() < 1e-3 * found.abs() + 1e-5, "{slope} {found}");
        }
    }

    /// Oracle: steady friction is ψ0 + (a − b)·ln(V/V0) (Dieterich).
    #[test]
    fn steady_sliding_has_the_logarithmic_law() {
        let settings = SheathSettings { level: [0.5, 0.5], direct: 0.05, ageing: 0.03, speed: 1e-3, slip: 1e-4 };
        for speed in [1e-4, 1e-3, 1e-2] {
            let mut sheath = Sheath::new(&settings, 0);
            for _ in 0..5000 {
                sheath.accept(&settings, speed, 0.01);
            }
            let share = sheath.pass(&settings, speed).share;
            let number = 2.0 * (1.0 - share) / (1.0 + share);
            let expected = 0.5 + 0.02 * (speed / 1e-3).ln();
            assert!((number - expected).abs() < 1e-4, "{number} {expected}");
        }
    }

    #[test]
    fn contacts_age_at_rest() {
        let settings = SheathSettings::default();
        let mut sheath = Sheath::new(&settings, 0);
        let before = sheath.age;
        sheath.accept(&settings, 0.0, 3.0);
        assert!((sheath.age - before - 3.0).abs() < 1e-12);
    }
}
