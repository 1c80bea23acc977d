//! Motion of q1 by a person with a joystick: strokes of varied speed, partial reversals, dwells.
//!
//! ```text
//! q(u) = q_a + (q_b − q_a)·(10u³ − 15u⁴ + 6u⁵),   u = (t − t_a)/(t_b − t_a)
//! ```
//!
//! Each stroke has minimum jerk (Flash & Hogan 1985), so speed differs along a stroke and between strokes.
//! At one constant speed the sign of q̇1 would give the whole history away.

use super::random::{between, happens, normal};
use super::settings::ExcitationSettings;
use rand_chacha::ChaCha8Rng;

/// One stroke, or a dwell when both ends are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stroke {
    start: f64,
    duration: f64,
    from: f64,
    to: f64,
}

/// The course of q1 over a trial, rad over s.
#[derive(Clone, Debug, PartialEq)]
pub struct Reciprocation {
    strokes: Vec<Stroke>,
}

impl Reciprocation {
    /// Returns a course from `start` until at least `end`.
    pub fn new(
        settings: &ExcitationSettings,
        amplitude: f64,
        start: f64,
        end: f64,
        generator: &mut ChaCha8Rng,
    ) -> Self {
        let first = between(generator, [-amplitude, amplitude]);
        let mut course = Course { strokes: Vec::new(), time: start, place: first };
        let mut side = if happens(generator, 0.5) { 1.0 } else { -1.0 };
        while course.time < end {
            let goal = side * amplitude * (1.0 - settings.shortfall * between(generator, [0.0, 1.0]));
            while happens(generator, settings.partial) {
                course.reverse_partly(settings, goal, amplitude, generator);
            }
            course.go(settings, goal, generator);
            side = -side;
        }
        Self { strokes: course.strokes }
    }

    /// Returns q1 at a time; the ends are held outside the course.
    pub fn at(&self, time: f64) -> f64 {
        let next = self.strokes.partition_point(|stroke| stroke.start <= time);
        let stroke = self.strokes[next.saturating_sub(1)];
        let u = ((time - stroke.start) / stroke.duration).clamp(0.0, 1.0);
        stroke.from + (stroke.to - stroke.from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    }
}

struct Course {
    strokes: Vec<Stroke>,
    time: f64,
    place: f64,
}

impl Course {
    fn go(&mut self, settings: &ExcitationSettings, goal: f64, generator: &mut ChaCha8Rng) {
        let [slow, fast] = settings.speed_limits;
        let speed = settings.speed * (settings.speed_spread * normal(generator)).exp();
        // A stroke takes at least 0.3 s: a hand cannot do less.
        let duration = ((goal - self.place).abs() / speed.clamp(slow, fast)).max(0.3);
        self.push(goal, duration);
        if happens(generator, settings.dwell) {
            let duration = between(generator, settings.dwell_time);
            self.push(goal, duration);
        }
    }

    fn reverse_partly(&mut self, settings: &ExcitationSettings, goal: f64, amplitude: f64, generator: &mut ChaCha8Rng) {
        let turn = self.place + between(generator, [0.25, 0.85]) * (goal - self.place);
        let back = between(generator, settings.partial_length) * (self.place - goal).signum();
        self.go(settings, turn, generator);
        self.go(settings, (turn + back).clamp(-amplitude, amplitude), generator);
    }

    fn push(&mut self, to: f64, duration: f64) {
        self.strokes.push(Stroke { start: self.time, duration, from: self.place, to });
        self.time += duration;
        self.place = to;
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Purpose, Seeds};
    use super::*;

    fn course() -> Reciprocation {
        let mut generator = Seeds::both(2).stream(1, Purpose::Excitation);
        Reciprocation::new(&ExcitationSettings::default(), 3.0, -12.0, 200.0, &mut generator)
    }

    #[test]
    fn course_is_continuous_bounded_and_visits_both_sides() {
        let course = course();
        let values: Vec<f64> = (0..21_200).map(|k| course.at(-12.0 + 0.01 * f64::from(k))).collect();
        assert!(values.iter().all(|value| value.abs() <= 3.0));
        // A minimum-jerk stroke peaks at 15/8 of its mean speed, here at most 0.9 rad/s.
        assert!(values.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.01 * 0.9 * 1.9));
        assert!(values.iter().any(|value| *value > 2.5) && values.iter().any(|value| *value < -2.5));
    }

    #[test]
    fn speeds_vary_and_dwells_occur() {
        let course = course();
        let speed = |t: f64| (course.at(t + 0.05) - course.at(t - 0.05)).abs() / 0.1;
        let speeds: Vec<f64> = (0..2000).map(|k| speed(0.1 * f64::from(k))).collect();
        let still = speeds.iter().filter(|v| **v < 1e-9).count();
        assert!(still > 40 && still < 800, "{still} of 2000 samples at rest");
        assert!(speeds.iter().any(|v| *v > 0.6));
    }
}
