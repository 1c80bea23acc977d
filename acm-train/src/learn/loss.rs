//! What a fit minimises.
//!
//! ```text
//! loss = Σ (p − t)² / N,   ∂loss/∂p = 2 (p − t) / N
//! ```
//!
//! | symbol | meaning                                                          | unit         |
//! | ------ | ---------------------------------------------------------------- | ------------ |
//! | `p, t` | predictions and targets: windows × supervised steps × outputs    | standardised |
//! | `N`    | how many there are in the batch                                  | –            |

/// Mean square of the difference to `targets` as a function of predictions: of those from the `first` on, it writes the
/// derivatives and returns the share of the loss.
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

#[cfg(test)]
mod tests {
    /// Oracle: by hand, whole and in two parts.
    #[test]
    fn parts_add_up() {
        let targets = [1.0, 2.0, 3.0, 4.0];
        let loss = super::mean_square(&targets);
        let mut derivatives = [0.0; 4];
        let whole = loss(0, &[2.0, 2.0, 1.0, 5.0], &mut derivatives);
        assert_eq!((whole, derivatives), (1.5, [0.5, 0.0, -1.0, 0.5]));
        let first = loss(0, &[2.0, 2.0], &mut [0.0; 2]);
        assert_eq!(first + loss(2, &[1.0, 5.0], &mut [0.0; 2]), whole);
    }
}
