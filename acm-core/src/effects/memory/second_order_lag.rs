//! Second-order lag: ÿ + 2ζω ẏ + ω² y = ω² x, at rest at the first sample.
//!
//! With a signal slope m, the deviation e = y − x + 2ζm/ω oscillates freely, with s = ω √(1 − ζ²):
//!
//! ```text
//! e_k = e^{−ζωh} ((cos sh + ζω sin(sh)/s) e_{k−1} + sin(sh)/s ė_{k−1})
//! ė_k = e^{−ζωh} ((cos sh − ζω sin(sh)/s) ė_{k−1} − ω² sin(sh)/s e_{k−1})
//! ```

use super::beside::Beside;
use super::{Last, Point, State};

/// The step of the last interval h, unit 1/ω and damping ζ.
pub type Swing = Last<(f64, f64, f64), Stride>;

/// A step as a linear map, the same for all signals with these time stamps. Its inputs are the deviation before, the speed, and the
/// rise of the signal. A constant signal stays as it is, bit for bit.
#[derive(Debug, Clone, Copy, Default)]
pub struct Stride {
    /// Weights of the deviation after the step.
    off: [f64; 3],
    /// Weights of the new speed.
    speed: [f64; 3],
}

impl Stride {
    pub(super) fn new(h: f64, unit: f64, damping: f64) -> Self {
        if h > 0.0 && unit > 1e-9 {
            let (cosine, sine) = swing(h / unit, damping);
            let (stays, moves) = (cosine + damping * sine, sine * unit);
            let (keeps, pulls) = (cosine - damping * sine, sine / unit);
            let behind = 2.0 * damping * unit;
            let lags = (behind * (stays - 1.0) - moves) / h;
            Self { off: [stays, moves, lags], speed: [-pulls, keeps, (1.0 - keeps - pulls * behind) / h] }
        } else {
            Self { off: [0.0; 3], speed: [0.0, 0.0, if h > 0.0 { 1.0 / h } else { 0.0 }] }
        }
    }

    /// Returns y and its speed after the step, in which the signal goes from `past` to `x`.
    #[inline]
    pub(super) fn take(&self, y: f64, speed: f64, past: f64, x: f64) -> (f64, f64) {
        let (off, rise) = (y - past, x - past);
        let of = |weights: &[f64; 3]| weights[0] * off + weights[1] * speed + weights[2] * rise;
        (x + of(&self.off), of(&self.speed))
    }

    /// Returns the change of y and of its speed per unit of the signal after the step.
    pub(super) fn of_input(&self) -> (f64, f64) {
        (1.0 + self.off[2], self.speed[2])
    }
}

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct SecondOrderLag {
    before: Option<Point>,
    y: f64,
    speed: f64,
}

impl State for SecondOrderLag {}

impl SecondOrderLag {
    /// The sprung signal at the next sample; `unit` is 1/ω, s, `damping` is ζ. Signals with the same
    /// time stamps share `last`.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, (unit, damping): (f64, f64), last: &mut Swing) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        let stride = last.of((h, unit, damping), || Stride::new(h, unit, damping));
        self.before = Some(Point { time, x });
        self.go(&stride, past, x)
    }

    /// The speed at the last sample.
    pub fn speed(&self) -> f64 {
        self.speed
    }
}

impl Beside for SecondOrderLag {
    type Shape = (f64, f64);
    type Stride = Stride;

    fn stride(h: f64, (unit, damping): Self::Shape) -> Stride {
        Stride::new(h, unit, damping)
    }

    #[inline]
    fn go(&mut self, stride: &Stride, past: f64, x: f64) -> f64 {
        (self.y, self.speed) = stride.take(self.y, self.speed, past, x);
        self.y
    }

    fn before(&mut self) -> &mut Option<Point> {
        &mut self.before
    }
}

/// e^{−ζa} cos(sa) and e^{−ζa} sin(sa)/s with s = √(1 − ζ²), continued through ζ = 1, where s is imaginary beyond.
fn swing(angle: f64, damping: f64) -> (f64, f64) {
    let square = 1.0 - damping * damping;
    let s = square.abs().sqrt();
    let fade = (-damping * angle).exp();
    if s * angle < 1e-4 {
        let bent = square * angle * angle;
        (fade * (1.0 - bent / 2.0), fade * angle * (1.0 - bent / 6.0))
    } else if square > 0.0 {
        (fade * (s * angle).cos(), fade * (s * angle).sin() / s)
    } else {
        let (slow, fast) = ((-(damping - s) * angle).exp(), (-(damping + s) * angle).exp());
        (0.5 * (slow + fast), 0.5 * (slow - fast) / s)
    }
}
