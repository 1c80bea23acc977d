//! Dry friction over a part of an interval: r = f v̄/√(v̄² + w²) at the mean v̄ of the speeds at both ends.
//!
//! The part ends at the speed v₁ = u − b r, where u is what it would be without friction, so that
//!
//! ```text
//! r = f s/√(s² + 4w²),   s = v₀ + u − b r
//! ```
//!
//! has one solution for b ≥ 0. Newton's method from the side of the larger |r| converges monotonically. Second order in the
//! part, and stable for every f, w and b.

/// Smallest transition speed.
const LEAST: f64 = 1e-12;

/// Most steps of Newton's method; the error is squared by each.
const STEPS: usize = 50;

/// Change of r, in f, below which it is found: the next would be its square, times f b/w at most.
const FOUND: f64 = 1e-9;

/// See the head of this file.
#[derive(Debug, Clone, Copy)]
pub struct Friction {
    /// f, in the unit of the input.
    pub force: f64,
    /// w: speed at which f/√2 act.
    pub transition: f64,
}

impl Friction {
    /// No friction.
    pub const NONE: Self = Self { force: 0.0, transition: 1.0 };

    /// Returns r; `sum` is v₀ + u, `brakes` is b.
    pub fn over(self, sum: f64, brakes: f64) -> f64 {
        let wide = 2.0 * self.transition.max(LEAST);
        if !(self.force > 0.0) || sum == 0.0 || !sum.is_finite() {
            return 0.0;
        }
        let (size, wide) = (sum.abs(), wide * wide);
        // No larger than without the brake; where it would reverse the motion, the mean speed is 0.
        let most = self.force * size / (size * size + wide).sqrt();
        let mut r = if brakes * most > size { size / brakes } else { most };
        for _ in 0..STEPS {
            let speed = size - brakes * r;
            let share = 1.0 / (speed * speed + wide);
            let steep = self.force * share.sqrt();
            let step = (r - steep * speed) / (1.0 + brakes * steep * wide * share);
            r -= step;
            if step.abs() <= FOUND * self.force {
                break;
            }
        }
        r.copysign(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: bisection of the equation.
    #[test]
    fn it_solves_the_equation_however_stiff_it_is() {
        for force in [1e-3, 0.4, 50.0] {
            for transition in [1e-9, 1e-3, 2.0] {
                for brakes in [0.0, 1e-4, 0.3, 1e3] {
                    for sum in [-3.0, -1e-4, 0.0, 1e-9, 0.7, 1e3] {
                        let off = |r: f64| {
                            let mean = 0.5 * (sum - brakes * r);
                            r - force * mean / mean.hypot(transition)
                        };
                        let (mut low, mut high) = (-force, force);
                        for _ in 0..200 {
                            let middle = 0.5 * (low + high);
                            if off(middle) < 0.0 { low = middle } else { high = middle }
                        }
                        let found = Friction { force, transition }.over(sum, brakes);
                        assert!(
                            (found - low).abs() < 1e-9 * force,
                            "{force} {transition} {brakes} {sum}: {found} for {low}"
                        );
                    }
                }
            }
        }
    }
}
