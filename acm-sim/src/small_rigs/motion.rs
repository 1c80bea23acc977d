//! Motion of an input: strokes of minimum jerk between random levels, or a sum of sines that fades in.
//!
//! ```text
//! stroke  u = a + (b − a)·(10 s³ − 15 s⁴ + 6 s⁵),  s = (t − t₀)/T
//! sines   u = c + w(t)·Σ a_i sin(2π f_i t + φ_i),  w = 10 s³ − 15 s⁴ + 6 s⁵ over the first stroke's time
//! ```
//!
//! Both begin at rest. Flash & Hogan (1985), J. Neuroscience 5(7).

use super::draw::Draw;
use std::f64::consts::TAU;

/// Form of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Strokes with dwells between them.
    Strokes,
    /// A sum of four sines.
    Sines,
}

/// One input over one trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    centre: f64,
    fade: f64,
    /// Strokes: start, duration, from, to.
    strokes: Vec<[f64; 4]>,
    /// Sines: amplitude, frequency (Hz), phase.
    sines: Vec<[f64; 3]>,
}

impl Motion {
    /// Draws an input between `low` and `high` whose strokes take about `pace` seconds.
    pub fn new(style: Style, low: f64, high: f64, pace: f64, duration: f64, draw: &mut Draw) -> Self {
        let mut motion = Self { centre: draw.between(low, high), fade: pace, strokes: vec![], sines: vec![] };
        match style {
            Style::Strokes => motion.strokes = strokes(motion.centre, [low, high], pace, duration, draw),
            Style::Sines => {
                motion.centre = 0.5 * (low + high);
                let size = 0.5 * (high - low) / 2.5;
                let sine = |k: i32| {
                    let frequency = draw.between(0.8, 1.2) / (2.0 * pace) * 0.5f64.powi(k);
                    [size * draw.between(0.7, 1.2), frequency, draw.between(0.0, TAU)]
                };
                motion.sines = (0..4).map(sine).collect();
            }
        }
        motion
    }

    /// Returns the value at a time, s.
    pub fn at(&self, time: f64) -> f64 {
        let next = self.strokes.partition_point(|stroke| stroke[0] <= time);
        let level = match next.checked_sub(1).map(|last| self.strokes[last]) {
            Some([start, duration, from, to]) => from + (to - from) * smooth((time - start) / duration),
            None => self.centre,
        };
        let wave = |sine: &[f64; 3]| sine[0] * (TAU * sine[1] * time + sine[2]).sin();
        level + smooth(time / self.fade) * self.sines.iter().map(wave).sum::<f64>()
    }
}

fn strokes(start: f64, [low, high]: [f64; 2], pace: f64, duration: f64, draw: &mut Draw) -> Vec<[f64; 4]> {
    let (mut all, mut time, mut level) = (Vec::new(), 0.2 * pace, start);
    while time < duration {
        let mut goal = draw.between(low, high);
        if (goal - level).abs() < 0.3 * (high - low) {
            // Short strokes say little: to the far end instead.
            goal = if level < 0.5 * (low + high) { high } else { low } + 0.2 * (goal - level);
        }
        let goal = goal.clamp(low, high);
        let takes = pace * draw.scale(0.7, 1.6);
        all.push([time, takes, level, goal]);
        level = goal;
        time += takes + if draw.happens(0.4) { pace * draw.between(0.2, 1.5) } else { 0.0 };
    }
    all
}

fn smooth(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the largest acceleration of a stroke is 5.7735·d/T² (Flash & Hogan).
    #[test]
    fn stroke_has_the_acceleration_of_minimum_jerk() {
        let motion = Motion { centre: 0.0, fade: 1.0, strokes: vec![[1.0, 2.0, 0.0, 0.5]], sines: vec![] };
        let h = 1e-4;
        let bend = |t: f64| (motion.at(t - h) - 2.0 * motion.at(t) + motion.at(t + h)) / (h * h);
        let peak = (0..4000).map(|n| bend(1e-3 * f64::from(n))).fold(0.0, f64::max);
        assert!((peak - 5.7735 * 0.5 / 4.0).abs() < 1e-3, "{peak}");
    }

    #[test]
    fn inputs_begin_at_rest_and_keep_within_their_range() {
        for (style, seed) in [(Style::Strokes, 1), (Style::Sines, 2)] {
            let motion = Motion::new(style, -1.0, 2.0, 0.5, 20.0, &mut Draw::new(1, seed, 0));
            let values: Vec<f64> = (0..2000).map(|n| motion.at(0.01 * f64::from(n))).collect();
            assert!(values.iter().all(|v| (-1.6..2.6).contains(v)));
            assert!((values[1] - values[0]).abs() < 1e-4 * 3.0, "{style:?}");
            let range = values.iter().fold(f64::MIN, |a, b| a.max(*b)) - values.iter().fold(f64::MAX, |a, b| a.min(*b));
            assert!(range > 1.5, "{style:?} {range}");
        }
    }
}
