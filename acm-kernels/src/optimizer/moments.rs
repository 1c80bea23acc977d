//! State of an optimizer.

/// Size below which an average square is negligible: its root, times Adam's largest correction of 32, is less than half
/// of the last digit of ε = 10⁻⁸. Smaller ones would become subnormal numbers, which are slow.
pub(super) const FAINT_SQUARE: f32 = 1e-34;

/// Running averages, one value for each parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Moments {
    /// Number of steps taken.
    pub steps: u64,
    /// Average gradient; stays zero in RMSprop.
    pub first: Vec<f32>,
    /// Average squared gradient.
    pub second: Vec<f32>,
}

impl Moments {
    /// Returns the moments before the first step, for `count` parameters.
    pub fn new(count: usize) -> Self {
        Self { steps: 0, first: vec![0.0; count], second: vec![0.0; count] }
    }
}
