//! Axis limits, and ticks at round numbers.

/// Limits and tick distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
    /// Distance between ticks: 1, 2 or 5 times a power of ten.
    pub step: f64,
}

impl Scale {
    /// Returns the narrowest round limits around `[low, high]` with about `ticks` intervals.
    pub fn around(low: f64, high: f64, ticks: usize) -> Self {
        let span = if high > low { high - low } else { low.abs().max(1.0) };
        let step = round_step(span / ticks as f64);
        let high = if high > low { high } else { low + span };
        Self { low: (low / step).floor() * step, high: (high / step).ceil() * step, step }
    }

    /// Returns exactly `[low, high]`, with ticks at round numbers.
    pub fn tight(low: f64, high: f64, ticks: usize) -> Self {
        let step = Self::around(low, high, ticks).step;
        if high > low { Self { low, high, step } } else { Self::around(low, high, ticks) }
    }
}

fn round_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| raw <= f * power * (1.0 + 1e-9));
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_round_and_hold_the_data() {
        assert_eq!(Scale::around(0.0, 44.9, 5), Scale { low: 0.0, high: 50.0, step: 10.0 });
        assert_eq!(Scale::around(-0.3, 0.97, 5), Scale { low: -0.5, high: 1.0, step: 0.5 });
        assert_eq!(Scale::around(0.0, 0.0, 5), Scale { low: 0.0, high: 1.0, step: 0.2 });
        assert_eq!(Scale::tight(3.7, 131.2, 8), Scale { low: 3.7, high: 131.2, step: 20.0 });
    }
}
