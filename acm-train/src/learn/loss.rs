//! Loss functions.
//!
//! ```text
//! mean_square     loss = Σ (p − t)² / N                              ∂loss/∂p = 2 (p − t) / N
//! cross_entropy   loss = Σ (max(p, 0) − p t + ln(1 + e^{−|p|})) / N  ∂loss/∂p = (σ(p) − t) / N
//! ```
//!
//! | symbol | meaning                                                          | unit         |
//! | ------ | ---------------------------------------------------------------- | ------------ |
//! | `p, t` | predictions and targets: windows × supervised steps × outputs    | standardised |
//! |        | of cross-entropy: the logit, and the label 0 or 1                | –            |
//! | `N`    | how many there are in the batch; those that do not count are     | –            |
//! |        | no part of it, and their derivative is zero                      |              |
//!
//! The sum of cross-entropy is −t ln σ(p) − (1 − t) ln(1 − σ(p)), written so that no exponential overflows.

use crate::config::Loss;

impl Loss {
    /// Returns the share of one prediction in the sum.
    pub fn of(self, prediction: f32, target: f32) -> f64 {
        let (p, t) = (f64::from(prediction), f64::from(target));
        match self {
            Self::MeanSquare => (p - t).powi(2),
            Self::CrossEntropy => p.max(0.0) - p * t + (-p.abs()).exp().ln_1p(),
        }
    }

    /// Returns the derivative of that share by the prediction.
    fn slope(self, prediction: f32, target: f32) -> f64 {
        let (p, t) = (f64::from(prediction), f64::from(target));
        match self {
            Self::MeanSquare => 2.0 * (p - t),
            Self::CrossEntropy => 1.0 / (1.0 + (-p).exp()) - t,
        }
    }
}

/// Returns the mean square of the difference to `targets` as a function of predictions: of those from the `first` on,
/// it writes the derivatives and returns the share of the loss.
pub fn mean_square(targets: &[f32]) -> impl Fn(usize, &[f32], &mut [f32]) -> f64 + Sync {
    let count = targets.len() as f64;
    move |first, predictions, derivatives| {
        let targets = &targets[first..first + predictions.len()];
        let mut sum = 0.0;
        for ((derivative, p), t) in derivatives.iter_mut().zip(predictions).zip(targets) {
            let difference = f64::from(p - t);
            *derivative = (2.0 * difference / count) as f32;
            sum += difference * difference;
        }
        sum / count
    }
}

/// Computes the loss as [`mean_square`] does, with a loss of choice, over those predictions that are `counted`.
pub fn masked(loss: Loss, targets: &[f32], counted: &[bool]) -> impl Fn(usize, &[f32], &mut [f32]) -> f64 + Sync {
    let count = counted.iter().filter(|counted| **counted).count().max(1) as f64;
    move |first, predictions, derivatives| {
        let mut sum = 0.0;
        for (i, (derivative, &p)) in derivatives.iter_mut().zip(predictions).enumerate() {
            *derivative = 0.0;
            if counted[first + i] {
                let t = targets[first + i];
                *derivative = (loss.slope(p, t) / count) as f32;
                sum += loss.of(p, t);
            }
        }
        sum / count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, whole and in two parts.
    #[test]
    fn parts_add_up() {
        let targets = [1.0, 2.0, 3.0, 4.0];
        let loss = mean_square(&targets);
        let mut derivatives = [0.0; 4];
        let whole = loss(0, &[2.0, 2.0, 1.0, 5.0], &mut derivatives);
        assert_eq!((whole, derivatives), (1.5, [0.5, 0.0, -1.0, 0.5]));
        let first = loss(0, &[2.0, 2.0], &mut [0.0; 2]);
        assert_eq!(first + loss(2, &[1.0, 5.0], &mut [0.0; 2]), whole);
    }

    /// Oracle: by hand. The second of three does not count, so the mean is over two.
    #[test]
    fn what_does_not_count_has_no_derivative() {
        let (targets, counted) = ([1.0, 9.0, 3.0], [true, false, true]);
        let loss = masked(Loss::MeanSquare, &targets, &counted);
        let mut derivatives = [7.0; 3];
        assert_eq!(loss(0, &[2.0, 0.0, 1.0], &mut derivatives), 2.5);
        assert_eq!(derivatives, [1.0, 0.0, -2.0]);
        let mut last = [7.0; 1];
        assert_eq!((loss(2, &[1.0], &mut last), last), (2.0, [-2.0]));
    }

    /// Oracle: −ln of the probability of the label, σ by its definition; the limits for logits that overflow e^p; and the
    /// central difference.
    #[test]
    fn cross_entropy_is_that_of_the_label() {
        for (p, t) in [(0.0, 0.0), (0.3, 1.0), (-2.0, 1.0), (2.5, 0.0), (5.0, 1.0)] {
            let odd = 1.0 / (1.0 + f64::exp(-f64::from(p)));
            let probability = if t == 1.0 { odd } else { 1.0 - odd };
            assert!((Loss::CrossEntropy.of(p, t) + probability.ln()).abs() < 1e-12);
            let step = 1.0 / 64.0;
            let difference = Loss::CrossEntropy.of(p + step, t) - Loss::CrossEntropy.of(p - step, t);
            let slope = Loss::CrossEntropy.slope(p, t);
            assert!((difference / f64::from(2.0 * step) - slope).abs() < 1e-4, "{slope}");
        }
        assert_eq!(Loss::CrossEntropy.of(1e4, 0.0), 1e4);
        assert_eq!(Loss::CrossEntropy.of(-1e4, 1.0), 1e4);
        assert_eq!(Loss::CrossEntropy.of(1e4, 1.0), 0.0);
        assert_eq!(Loss::CrossEntropy.slope(-1e4, 1.0), -1.0);
    }
}
