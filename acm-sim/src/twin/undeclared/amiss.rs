//! Imperfections of a campaign: noise of the tip; of several mechanisms also encoder noise, offsets, time stamps, number of trials.
//!
//! | drawn | range |
//! | --- | --- |
//! | encoder noise | 0–5 mrad |
//! | offset of the tip from trial to trial | none in half of the draws, else 0–15 mm (3-D RMS) |
//! | error of the stamps | none in half of the draws, else 0–10 ms |
//! | trials | the usual 17 in two of five draws, else 1–20, each order of magnitude alike |
//!
//! With less than six trials none calibrates; a single one is not held out.

use super::super::random::{Purpose, Seeds, between, happens, normal};
use super::super::settings::MeasurementSettings;
use super::design::COUNTS;
use super::kind::{Kind, Null};
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;

/// Imperfections besides mechanisms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amiss {
    /// White noise of the tip per axis, standard deviation, m.
    pub white: f64,
    /// Coloured noise of the tip per axis, standard deviation, m.
    pub coloured: f64,
    /// Encoder noise, rad.
    pub encoder: f64,
    /// Offset of the tip per axis, standard deviation, m.
    pub offset: f64,
    /// Error of the stamps, standard deviation, s.
    pub stamps: f64,
    /// Trials of calibration, of development, held out.
    pub counts: [usize; 3],
}

/// White noise of the tip, and coloured noise of the null that has it, per axis, m.
const WHITE: f64 = 1.5e-3;
const COLOURED: f64 = 2.5e-3;

/// Largest encoder noise (rad), offset (3-D, m) and error of stamps (s).
const ENCODER: f64 = 5e-3;
const OFFSET: f64 = 0.015;
const STAMPS: f64 = 0.010;

impl Amiss {
    /// Returns the default imperfections.
    pub fn usual() -> Self {
        let encoder = MeasurementSettings::default().encoder_noise;
        Self { white: WHITE, coloured: 0.0, encoder, offset: 0.0, stamps: 0.0, counts: COUNTS }
    }

    /// Returns the imperfections drawn for a kind.
    pub fn new(kind: Kind, generator: &mut ChaCha8Rng) -> Self {
        let usual = Self::usual();
        match kind {
            Kind::Null(Null::Coloured) => Self { coloured: COLOURED, ..usual },
            Kind::Null(Null::Encoder) => Self { encoder: between(generator, [0.0, ENCODER]), ..usual },
            Kind::Null(Null::Offsets) => Self { offset: offset(generator), ..usual },
            Kind::Several(_) => Self {
                encoder: between(generator, [0.0, ENCODER]),
                offset: if happens(generator, 0.5) { offset(generator) } else { 0.0 },
                stamps: if happens(generator, 0.5) { between(generator, [0.0, STAMPS]) } else { 0.0 },
                counts: if happens(generator, 0.4) { COUNTS } else { counts(generator) },
                ..usual
            },
            _ => usual,
        }
    }

    /// Returns the same trials without noise, offsets and errors of the stamps.
    pub fn without_noise(self) -> Self {
        Self { white: 0.0, coloured: 0.0, encoder: 0.0, offset: 0.0, stamps: 0.0, ..self }
    }

    /// Returns whether its encoders are worse than usual.
    pub fn has_encoders(&self) -> bool {
        self.encoder != Self::usual().encoder
    }

    /// Returns the shift of the tip in a trial, m.
    pub fn shift(&self, trial: usize, seeds: &Seeds) -> Vector3<f64> {
        let mut generator = seeds.stream(trial, Purpose::Registration);
        self.offset * Vector3::from([0; 3].map(|_| normal(&mut generator)))
    }

    /// Returns the recorded time stamps of a trial, s.
    pub fn stamps(&self, times: &[f64], trial: usize, seeds: &Seeds) -> Vec<f64> {
        if self.stamps == 0.0 {
            return times.to_vec();
        }
        let mut generator = seeds.stream(trial, Purpose::Circulation);
        // Less than half of the shortest step of 60 ms, so that time goes on.
        let mut off = |time: f64| time + (self.stamps * normal(&mut generator)).clamp(-0.025, 0.025);
        let stamps = times.iter().enumerate().map(|(k, time)| if k == 0 { *time } else { off(*time) });
        stamps.map(|time| (time * 1e4).round() / 1e4).collect()
    }
}

fn offset(generator: &mut ChaCha8Rng) -> f64 {
    between(generator, [0.0, OFFSET]) / 3f64.sqrt()
}

fn counts(generator: &mut ChaCha8Rng) -> [usize; 3] {
    let many = between(generator, [0.0, 20.99f64.ln()]).exp() as usize;
    match many {
        0 | 1 => [0, 1, 0],
        2..=5 => [0, many - 1, 1],
        _ => {
            let (rest, held) = ((0.3 * many as f64).round() as usize, (0.18 * many as f64).round() as usize);
            [rest, many - rest - held, held]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_keep_within_their_ranges() {
        let mut totals = std::collections::BTreeSet::new();
        for seed in 0..300 {
            let drawn = Amiss::new(Kind::Several(3), &mut Seeds::both(seed).stream(1, Purpose::Tilt));
            assert!((0.0..=ENCODER).contains(&drawn.encoder) && (0.0..=STAMPS).contains(&drawn.stamps));
            assert!((0.0..=OFFSET).contains(&(drawn.offset * 3f64.sqrt())));
            let [calibration, development, held] = drawn.counts;
            assert!(development >= 1 && (held >= 1 || calibration + development == 1), "{drawn:?}");
            totals.insert(drawn.counts.iter().sum::<usize>());
        }
        assert_eq!(totals, (1..=20).collect(), "one to twenty trials");
        let calm = Amiss::new(Kind::Null(Null::White), &mut Seeds::both(1).stream(1, Purpose::Tilt));
        assert!(calm == Amiss::usual() && !calm.has_encoders());
    }

    #[test]
    fn stamps_go_on_and_are_off_as_stated() {
        let times: Vec<f64> = (0..2000).map(|k| 0.06 * f64::from(k)).collect();
        let stamps = Amiss { stamps: 0.008, ..Amiss::usual() }.stamps(&times, 3, &Seeds::both(4));
        assert!(stamps.windows(2).all(|pair| pair[1] > pair[0]) && stamps[0] == 0.0);
        let square = times.iter().zip(&stamps).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / times.len() as f64;
        assert!((square.sqrt() - 0.008).abs() < 5e-4, "{}", square.sqrt());
    }
}
