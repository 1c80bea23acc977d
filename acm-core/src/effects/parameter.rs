//! What is known of a parameter of an effect: its unit, its neutral value, its typical size, its bounds.

/// Distance that counts as on a bound, in typical sizes.
const AT_BOUND: f64 = 1e-3;

/// So that the parameter of a signal that does not move still has a scale to divide by.
const SMALLEST_SCALE: f64 = 1e-30;

/// One parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterSpec {
    /// Such as `width_q1`.
    pub name: String,
    /// SI.
    pub unit: String,
    /// The value at which the effect is silent (with all others at theirs).
    pub neutral: f64,
    /// A typical size: steps of differences and initial guesses are fractions of it.
    pub scale: f64,
    /// Smallest possible value.
    pub lower: f64,
    /// Largest possible value.
    pub upper: f64,
    /// Whether it may depend on a context signal, θ = θ0 + θ1·c: sizes of the effect may, shapes do not.
    pub may_vary: bool,
    /// Whether the effect only adds to the outputs and in proportion to it, y_m += Σ_j θ_j φ_j(t; other parameters), with
    /// 0 as its neutral value. For θ1 of a context too.
    pub linear: bool,
    /// Whether the lower and the upper bound are limits that rigs reach, as with inextensible tendons: a value may lie there.
    pub is_limit: [bool; 2],
}

impl ParameterSpec {
    /// The size of an effect: silent at 0, unbounded until [`ParameterSpec::within`] is called, may vary with a context.
    pub fn size(name: impl Into<String>, unit: impl Into<String>, scale: f64) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            neutral: 0.0,
            scale: if scale.is_finite() { scale.max(SMALLEST_SCALE) } else { 1.0 },
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            may_vary: true,
            linear: false,
            is_limit: [false; 2],
        }
    }

    /// The shape of an effect, such as a decay rate: neutral at `value`, and does not vary with a context.
    pub fn shape(name: impl Into<String>, unit: impl Into<String>, value: f64, scale: f64) -> Self {
        Self { neutral: value, may_vary: false, ..Self::size(name, unit, scale) }
    }

    /// A known value of the rig that no fit may change: both bounds at `value`, so that a saved effect keeps it.
    pub fn known(name: impl Into<String>, unit: impl Into<String>, value: f64) -> Self {
        Self { lower: value, upper: value, ..Self::shape(name, unit, value, value.abs()) }
    }

    /// Whether a fit may change it: a known value has equal bounds, and so has a size of an actuator at rest.
    pub fn is_free(&self) -> bool {
        self.lower < self.upper
    }

    /// The nearest value within the bounds.
    pub fn inside(&self, value: f64) -> f64 {
        value.max(self.lower).min(self.upper)
    }

    /// Smallest and largest value along a trial in which the parameter depends on a context. A linear parameter has no
    /// bounds there: its effect has to stay proportional to θ0 and θ1.
    pub fn along(&self) -> [f64; 2] {
        if self.linear { [f64::NEG_INFINITY, f64::INFINITY] } else { [self.lower, self.upper] }
    }

    /// Whether a value rests on a bound that is neither the neutral value nor a limit that rigs reach.
    pub fn is_at_bound(&self, value: f64) -> bool {
        let rests = |bound: f64| bound != self.neutral && (value - bound).abs() < AT_BOUND * self.scale;
        self.is_free() && (rests(self.lower) && !self.is_limit[0] || rests(self.upper) && !self.is_limit[1])
    }

    /// With a lower bound that rigs reach.
    #[must_use]
    pub fn from_limit(self) -> Self {
        Self { is_limit: [true, self.is_limit[1]], ..self }
    }

    /// With an upper bound that rigs reach.
    #[must_use]
    pub fn up_to_limit(self) -> Self {
        Self { is_limit: [self.is_limit[0], true], ..self }
    }

    /// With bounds, extended to include the neutral value.
    pub fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower: lower.min(self.neutral), upper: upper.max(self.neutral), ..self }
    }
}
