//! Values of an effect's parameters at each sample: constant, or following a context signal.

use super::ParameterSpec;

/// Values of an effect's parameters along a trial.
#[derive(Debug, Clone, Copy)]
pub struct Values<'a> {
    specs: &'a [ParameterSpec],
    base: &'a [f64],
    varying: Option<Varying<'a>>,
}

/// How values vary with a signal.
#[derive(Debug, Clone, Copy)]
struct Varying<'a> {
    /// θ1 of every parameter.
    slope: &'a [f64],
    /// θ2 of every parameter, and the ends of the signal's range; none where values are straight in it.
    bow: Option<(&'a [f64], [f64; 2])>,
    /// c [T].
    context: &'a [f64],
}

impl<'a> Values<'a> {
    /// The same values at every sample.
    pub fn constant(specs: &'a [ParameterSpec], base: &'a [f64]) -> Self {
        Self { specs, base, varying: None }
    }

    /// θ0 + θ1·c(t), within the bounds of each parameter ([`ParameterSpec::along`]).
    pub fn varying(specs: &'a [ParameterSpec], base: &'a [f64], slope: &'a [f64], context: &'a [f64]) -> Self {
        Self { specs, base, varying: Some(Varying { slope, bow: None, context }) }
    }

    /// θ0 + θ1·c(t) + θ2 (c(t) − a)(c(t) − b), within the bounds of each parameter: θ0 and θ1 are those of the line through the values at
    /// the ends a and b of the signal's range.
    pub fn bowed(self, bow: &'a [f64], ends: [f64; 2]) -> Self {
        Self { varying: self.varying.map(|varying| Varying { bow: Some((bow, ends)), ..varying }), ..self }
    }

    /// Number of parameters.
    pub fn count(&self) -> usize {
        self.specs.len()
    }

    /// Whether they are the same at every sample.
    pub fn are_constant(&self) -> bool {
        self.varying.is_none()
    }

    /// Largest value that parameter `j` may have along the trial.
    pub fn largest(&self, j: usize) -> f64 {
        if self.varying.is_some() { self.specs[j].along()[1] } else { self.base[j] }
    }

    /// Whether parameter `j` is zero at every sample.
    pub fn is_zero(&self, j: usize) -> bool {
        let rests = |Varying { slope, bow, .. }: Varying| slope[j] == 0.0 && bow.is_none_or(|(bow, _)| bow[j] == 0.0);
        self.base[j] == 0.0 && self.varying.is_none_or(rests)
    }

    /// Value of parameter `j` at sample `t`.
    #[inline]
    pub fn at(&self, j: usize, t: usize) -> f64 {
        match &self.varying {
            None => self.base[j],
            Some(varying) => self.varied(varying, j, t),
        }
    }

    fn varied(&self, Varying { slope, bow, context }: &Varying, j: usize, t: usize) -> f64 {
        let context = context.get(t).copied().unwrap_or(0.0);
        let [lower, upper] = self.specs[j].along();
        let bow = bow.map_or(0.0, |(bow, [a, b])| bow[j] * (context - a) * (context - b));
        (self.base[j] + slope[j] * context + bow).max(lower).min(upper)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. A value that is zero without the signal need not be zero with it.
    #[test]
    fn zero_at_every_sample() {
        let (base, slope, context) = ([0.0, 0.0, 2.0], [0.0, 1.0, 0.0], [0.0, 3.0]);
        let zeros = |values: Values| [0, 1, 2].map(|j| values.is_zero(j));
        assert_eq!(zeros(Values::constant(&[], &base)), [true, true, false]);
        let straight = Values::varying(&[], &base, &slope, &context);
        assert_eq!(zeros(straight), [true, false, false]);
        assert_eq!(zeros(straight.bowed(&[1.0, 0.0, 0.0], [0.0, 3.0])), [false, false, false]);
    }
}
